//! PLY: `vertex` with x, y, z and colours, `face` with a list of vertices, `edge` with two.

use sprung::build::Mesh;
use sprung::{Code, DVec3, Error, Result};

use super::bytes::{Bytes, Order};
use super::words::{Words, quoted};
use super::{Companions, malformed};

/// Elements and properties that a header may name.
const MOST_NAMES: usize = 1000;

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Number {
    fn named(word: &[u8]) -> Option<Self> {
        Some(match word {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    fn bytes(self) -> u64 {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// What stands for full brightness in a colour of this type.
    fn full(self) -> f64 {
        match self {
            Self::U8 => 255.0,
            Self::U16 => 65535.0,
            _ => 1.0,
        }
    }
}

struct Property<'a> {
    name: &'a [u8],
    number: Number,
    /// The type of the count, if this is a list.
    list: Option<Number>,
}

struct Element<'a> {
    name: &'a [u8],
    count: u64,
    properties: Vec<Property<'a>>,
}

/// The numbers after the header.
enum Body<'a> {
    Text(Words<'a>),
    Binary(Bytes<'a>),
}

impl Body<'_> {
    fn next(&mut self, number: Number) -> Result<f64> {
        let bytes = match self {
            Self::Text(words) => {
                let word = words.expect("a number")?;
                let value = std::str::from_utf8(word).ok().and_then(|word| word.parse::<f64>().ok());
                return value.ok_or_else(|| words.not_a(word, "a number"));
            }
            Self::Binary(bytes) => bytes,
        };
        Ok(match number {
            Number::I8 => bytes.i8()?.into(),
            Number::U8 => bytes.u8()?.into(),
            Number::I16 => bytes.i16()?.into(),
            Number::U16 => bytes.u16()?.into(),
            Number::I32 => bytes.i32()?.into(),
            Number::U32 => bytes.u32()?.into(),
            Number::F32 => bytes.f32()?.into(),
            Number::F64 => bytes.f64()?,
        })
    }

    /// Checks that the bytes can hold so many of an element, each of which takes some.
    fn check_count(&self, element: &Element<'_>) -> Result<usize> {
        let least = |property: &Property<'_>| property.list.unwrap_or(property.number).bytes();
        let name = format!("\"{}\"", quoted(element.name));
        match self {
            Self::Binary(bytes) => {
                let each = element.properties.iter().map(least).sum();
                bytes.check_count(element.count, each, &name)
            }
            // Every number has a digit and something that separates it from the next, but for the very last.
            Self::Text(words) => {
                let rest = Bytes::new(words.rest(), Order::Little);
                let each = (2 * element.properties.len() as u64).saturating_sub(1);
                rest.check_count(element.count, each, &name)
            }
        }
    }

    fn error(&self, code: Code, sentence: String) -> Error {
        match self {
            Self::Text(words) => words.error(code, sentence),
            Self::Binary(_) => Error::new(code, sentence),
        }
    }
}

pub(super) fn read(bytes: &[u8], _: &mut Companions<'_>) -> Result<Mesh> {
    let mut words = Words::new(bytes, 1);
    if words.next() != Some(b"ply") {
        return Err(malformed("does not begin with \"ply\"; is it a PLY file?"));
    }
    let (order, elements) = header(&mut words)?;
    let mut body = match order {
        None => Body::Text(words),
        Some(order) => Body::Binary(Bytes::new(words.rest(), order)),
    };
    let mut mesh = Mesh::default();
    for element in &elements {
        if element.count == 0 || element.properties.is_empty() {
            continue;
        }
        let count = body.check_count(element)?;
        match element.name {
            b"vertex" => vertices(element, count, &mut body, &mut mesh)?,
            b"face" => faces(element, count, &mut body, &mut mesh)?,
            b"edge" => edges(element, count, &mut body, &mut mesh)?,
            _ => skip(element, count, &mut body)?,
        }
    }
    if let Body::Text(words) = &body {
        mesh.warnings.extend(words.maybe_cut());
    }
    Ok(mesh)
}

/// The order of bytes, none for text, and what follows. The words are left at the first byte after the header.
fn header<'a>(words: &mut Words<'a>) -> Result<(Option<Order>, Vec<Element<'a>>)> {
    let mut order = None;
    let mut elements: Vec<Element<'a>> = Vec::new();
    let mut names = 0;
    loop {
        let word = words.expect("end_header")?;
        match word {
            b"format" => {
                order = Some(match words.expect("the format")? {
                    b"ascii" => None,
                    b"binary_little_endian" => Some(Order::Little),
                    b"binary_big_endian" => Some(Order::Big),
                    other => {
                        return Err(words.not_a(other, "ascii, binary_little_endian or binary_big_endian"));
                    }
                });
                words.rest_of_line();
            }
            b"comment" | b"obj_info" => {
                words.rest_of_line();
            }
            b"element" => {
                let name = words.expect("an element's name")?;
                elements.push(Element { name, count: words.integer("a count")?, properties: Vec::new() });
            }
            b"property" => {
                let Some(element) = elements.last_mut() else {
                    return Err(words.error(Code::Syntax, "has a property before any element"));
                };
                let first = words.expect("a type")?;
                let number = |word: &'a [u8], words: &Words<'a>| {
                    Number::named(word).ok_or_else(|| words.not_a(word, "a type such as float"))
                };
                let (list, kind) = match first {
                    b"list" => {
                        let word = words.expect("a type")?;
                        let count = number(word, words)?;
                        (Some(count), words.expect("a type")?)
                    }
                    other => (None, other),
                };
                let number = number(kind, words)?;
                element.properties.push(Property { name: words.expect("a property's name")?, number, list });
            }
            b"end_header" => {
                words.end_line();
                let order = order.ok_or_else(|| words.error(Code::Syntax, "says no format"))?;
                return Ok((order, elements));
            }
            other => return Err(words.not_a(other, "element, property or end_header")),
        }
        names += 1;
        if names > MOST_NAMES {
            return Err(words.error(Code::TooLarge, format!("has a header of more than {MOST_NAMES} lines")));
        }
    }
}

fn vertices(element: &Element<'_>, count: usize, body: &mut Body<'_>, mesh: &mut Mesh) -> Result<()> {
    let place =
        |names: &[&[u8]]| element.properties.iter().position(|property| names.contains(&property.name));
    let axes = [place(&[b"x"]), place(&[b"y"]), place(&[b"z"])];
    let [Some(x), Some(y), Some(z)] = axes else {
        return Err(body.error(Code::MissingField, "has vertices without x, y or z".to_owned()));
    };
    let colours = [
        place(&[b"red", b"diffuse_red"]),
        place(&[b"green", b"diffuse_green"]),
        place(&[b"blue", b"diffuse_blue"]),
    ];
    let full = |property: usize| element.properties[property].number.full();
    if !mesh.positions.is_empty() {
        return Err(body.error(Code::Duplicate, "has vertices twice".to_owned()));
    }
    mesh.positions.reserve_exact(count);
    let mut values = vec![0.0; element.properties.len()];
    for vertex in 0..count {
        for (value, property) in values.iter_mut().zip(&element.properties) {
            match property.list {
                None => *value = body.next(property.number)?,
                Some(_) => list(property, body, &mut |_| Ok(()))?,
            }
        }
        let found = DVec3::new(values[x], values[y], values[z]);
        if !found.is_finite() {
            let sentence = format!("puts vertex {vertex} at {found}, and coordinates must be finite numbers");
            return Err(body.error(Code::OutOfRange, sentence));
        }
        mesh.positions.push(found);
        if let [Some(r), Some(g), Some(b)] = colours {
            mesh.colours.push([r, g, b].map(|channel| (values[channel] / full(channel)) as f32));
        }
    }
    Ok(())
}

fn faces(element: &Element<'_>, count: usize, body: &mut Body<'_>, mesh: &mut Mesh) -> Result<()> {
    let is_corners = |property: &Property<'_>| {
        property.list.is_some() && matches!(property.name, b"vertex_indices" | b"vertex_index")
    };
    if !element.properties.iter().any(is_corners) {
        return Err(body.error(Code::MissingField, "has faces without vertex_indices".to_owned()));
    }
    let (mut corners, mut few) = (Vec::new(), 0u64);
    for _ in 0..count {
        for property in &element.properties {
            if property.list.is_none() {
                body.next(property.number)?;
            } else if is_corners(property) {
                corners.clear();
                list(property, body, &mut |value| {
                    corners.push(value);
                    Ok(())
                })?;
            } else {
                list(property, body, &mut |_| Ok(()))?;
            }
        }
        if corners.len() < 3 {
            few += 1;
            continue;
        }
        let checked: Result<Vec<u32>> = corners.iter().map(|&corner| index(corner, body)).collect();
        mesh.faces.push(&checked?);
    }
    if few > 0 {
        mesh.warnings.push(format!("has {few} faces with fewer than three corners, which were left out"));
    }
    Ok(())
}

fn edges(element: &Element<'_>, count: usize, body: &mut Body<'_>, mesh: &mut Mesh) -> Result<()> {
    let place = |name: &[u8]| element.properties.iter().position(|property| property.name == name);
    let (Some(first), Some(second)) = (place(b"vertex1"), place(b"vertex2")) else {
        return skip(element, count, body);
    };
    let mut values = vec![0.0; element.properties.len()];
    for _ in 0..count {
        for (value, property) in values.iter_mut().zip(&element.properties) {
            match property.list {
                None => *value = body.next(property.number)?,
                Some(_) => list(property, body, &mut |_| Ok(()))?,
            }
        }
        mesh.lines.push([index(values[first], body)?, index(values[second], body)?]);
    }
    Ok(())
}

fn skip(element: &Element<'_>, count: usize, body: &mut Body<'_>) -> Result<()> {
    for _ in 0..count {
        for property in &element.properties {
            match property.list {
                None => drop(body.next(property.number)?),
                Some(_) => list(property, body, &mut |_| Ok(()))?,
            }
        }
    }
    Ok(())
}

/// Goes through the numbers of a list. Each takes bytes of the file, so that a wrong count ends soon.
fn list(property: &Property<'_>, body: &mut Body<'_>, take: &mut dyn FnMut(f64) -> Result<()>) -> Result<()> {
    let Some(kind) = property.list else { return Ok(()) };
    let count = body.next(kind)?;
    if !(0.0..=4294967295.0).contains(&count) || count.fract() != 0.0 {
        return Err(body.error(Code::OutOfRange, format!("has a list of {count} entries")));
    }
    for _ in 0..count as u64 {
        take(body.next(property.number)?)?;
    }
    Ok(())
}

/// A vertex's number, which readers of whole meshes check against their count.
fn index(value: f64, body: &Body<'_>) -> Result<u32> {
    if (0.0..=4294967295.0).contains(&value) && value.fract() == 0.0 {
        return Ok(value as u32);
    }
    Err(body
        .error(Code::NotFound, format!("names vertex {value}, and vertices have whole numbers from 0 on")))
}
