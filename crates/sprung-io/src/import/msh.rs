//! Gmsh `.msh`, versions 2.2 and 4.1, as text or binary: nodes, lines, triangles, quads and tetrahedra, and physical groups by
//! name. Of elements with nodes along their sides the corners are taken.

use std::collections::HashMap;

use sprung::build::Mesh;
use sprung::{Code, DVec3, Error, Result};

use super::bytes::{Bytes, Order};
use super::words::{Words, quoted};
use super::{Companions, Groups, malformed};

/// Nodes of an element by its type number, 0 for one that does not exist.
const NODES: [usize; 32] = [
    0, 2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27, 18, 14, 1, 8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5, 6, 20,
    35, 56,
];

/// What an element is, and how many of its nodes are corners.
fn corners_of(kind: i64) -> (Kind, usize) {
    match kind {
        1 | 8 | 26..=28 => (Kind::Line, 2),
        2 | 9 | 20..=25 => (Kind::Face, 3),
        3 | 10 | 16 => (Kind::Face, 4),
        4 | 11 | 29..=31 => (Kind::Tetrahedron, 4),
        15 => (Kind::Point, 1),
        _ => (Kind::Other, 0),
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Point,
    Line,
    Face,
    Tetrahedron,
    Other,
}

/// Numbers as text or as bytes.
enum Numbers<'a> {
    Text(Words<'a>),
    Binary(Bytes<'a>),
}

impl Numbers<'_> {
    /// A whole number of 32 bits in binary.
    fn int(&mut self, what: &str) -> Result<i64> {
        match self {
            Self::Text(words) => words.integer(what),
            Self::Binary(bytes) => bytes.i32().map(i64::from),
        }
    }

    /// One of 64 bits in binary.
    fn size(&mut self, what: &str) -> Result<i64> {
        match self {
            Self::Text(words) => words.integer(what),
            Self::Binary(bytes) => bytes.i64(),
        }
    }

    fn float(&mut self, what: &str) -> Result<f64> {
        let value = match self {
            Self::Text(words) => return words.float(what),
            Self::Binary(bytes) => bytes.f64()?,
        };
        if value.is_finite() {
            return Ok(value);
        }
        Err(Error::new(Code::OutOfRange, format!("has {value} where {what} must be")))
    }

    /// A count of things that take at least so many bytes each as text, and as binary.
    fn count(&self, count: i64, text: u64, binary: u64, what: &str) -> Result<usize> {
        let Ok(count) = u64::try_from(count) else {
            return Err(Error::new(Code::OutOfRange, format!("says that it has {count} {what}")));
        };
        match self {
            Self::Text(words) => Bytes::new(words.rest(), Order::Little).check_count(count, text, what),
            Self::Binary(bytes) => bytes.check_count(count, binary, what),
        }
    }
}

/// A file being read.
struct Reading {
    mesh: Mesh,
    groups: Groups,
    /// Names of physical groups by dimension and number.
    names: HashMap<(i64, i64), String>,
    /// Physical groups of entities, by dimension and number; version 4 only.
    physical: HashMap<(i64, i64), Vec<i64>>,
    /// The vertex of each node's number.
    vertices: HashMap<i64, u32>,
    others: u64,
    curved: u64,
}

pub(super) fn read(bytes: &[u8], _: &mut Companions<'_>) -> Result<Mesh> {
    let mut words = Words::new(bytes, 1);
    if words.next() != Some(b"$MeshFormat") {
        return Err(malformed("does not begin with $MeshFormat; is it a Gmsh file of version 2 or 4?"));
    }
    let version = words.float("a version")?;
    let is_binary = words.integer::<u8>("0 for text or 1 for binary")? == 1;
    let size: u32 = words.integer("the size of a number")?;
    let is_four = (4.1..5.0).contains(&version);
    if !(is_four || (2.0..3.0).contains(&version)) {
        let sentence = format!("is of version {version}, and versions 2.2 and 4.1 are read");
        return Err(words
            .error(Code::Unsupported, sentence)
            .with_fix("save it anew with Mesh.MshFileVersion = 4.1"));
    }
    if size != 8 {
        return Err(words.error(Code::Unsupported, format!("has numbers of {size} bytes, and 8 are read")));
    }
    words.end_line();
    let mut order = Order::Little;
    if is_binary {
        let mut one = Bytes::new(words.rest(), Order::Little);
        order = match one.u32()? {
            1 => Order::Little,
            0x0100_0000 => Order::Big,
            _ => return Err(malformed("says that it is binary, and the number 1 does not follow")),
        };
        words = Words::new(one.rest(), words.line());
    }
    let mut reading = Reading {
        mesh: Mesh::default(),
        groups: Groups::default(),
        names: HashMap::new(),
        physical: HashMap::new(),
        vertices: HashMap::new(),
        others: 0,
        curved: 0,
    };
    while let Some(section) = words.next() {
        let known = matches!(section, b"$Nodes" | b"$Elements" | b"$Entities");
        if !known || (section == b"$Entities" && !is_four) {
            if section == b"$PhysicalNames" {
                reading.names(&mut words)?;
            } else if section.starts_with(b"$") && !section.starts_with(b"$End") {
                skip(&mut words, section)?;
            }
            continue;
        }
        let mut numbers = if is_binary {
            words.end_line();
            Numbers::Binary(Bytes::new(words.rest(), order))
        } else {
            Numbers::Text(words.clone())
        };
        match section {
            // Version 2 has its one count as text in binary files, too.
            b"$Nodes" | b"$Elements" if !is_four => {
                let count: i64 = words.integer("a count")?;
                if is_binary {
                    words.end_line();
                    numbers = Numbers::Binary(Bytes::new(words.rest(), order));
                } else {
                    numbers = Numbers::Text(words.clone());
                }
                match section {
                    b"$Nodes" => reading.nodes_2(count, &mut numbers)?,
                    _ => reading.elements_2(count, &mut numbers, is_binary)?,
                }
            }
            b"$Entities" => reading.entities(&mut numbers)?,
            b"$Nodes" => reading.nodes_4(&mut numbers)?,
            _ => reading.elements_4(&mut numbers)?,
        }
        let line = words.line();
        words = match numbers {
            Numbers::Text(words) => words,
            Numbers::Binary(bytes) => Words::new(bytes.rest(), line),
        };
        // A file that is cut, or whose count is too small, would be read as if it were whole.
        let end = String::from_utf8_lossy(section).replace('$', "$End");
        let found = words.expect(&end)?;
        if found != end.as_bytes() {
            return Err(words.not_a(found, &end));
        }
    }
    Ok(reading.finish())
}

/// Goes on after the end of a section that is of no concern.
fn skip(words: &mut Words<'_>, section: &[u8]) -> Result<()> {
    let end = [b"$End", &section[1..]].concat();
    let rest = words.rest();
    let found = rest.windows(end.len()).position(|window| window == end);
    let Some(found) = found else {
        return Err(words.error(Code::Syntax, format!("has no end of the section \"{}\"", quoted(section))));
    };
    *words = Words::new(&rest[found + end.len()..], words.line() + super::words::count_lines(&rest[..found]));
    Ok(())
}

impl Reading {
    fn names(&mut self, words: &mut Words<'_>) -> Result<()> {
        let count: u64 = words.integer("a count")?;
        for _ in 0..count {
            let dimension = words.integer("a dimension")?;
            let number = words.integer("a number")?;
            let name = words.rest_of_line();
            self.names.insert((dimension, number), quoted(name.trim_ascii()).trim_matches('"').to_owned());
        }
        Ok(())
    }

    fn add_node(&mut self, number: i64, place: DVec3) -> Result<()> {
        let vertex = self.mesh.positions.len() as u32;
        self.mesh.positions.push(place);
        match self.vertices.insert(number, vertex) {
            None => Ok(()),
            Some(_) => Err(Error::new(Code::Duplicate, format!("has node {number} twice"))),
        }
    }

    fn add_element(&mut self, kind: i64, nodes: &[i64], group: Option<usize>) -> Result<()> {
        let (what, count) = corners_of(kind);
        if what == Kind::Other {
            self.others += 1;
            return Ok(());
        }
        self.curved += u64::from(nodes.len() > count);
        let mut corners = [0; 4];
        for (corner, node) in corners.iter_mut().zip(&nodes[..count]) {
            let Some(&vertex) = self.vertices.get(node) else {
                return Err(Error::new(Code::NotFound, format!("names node {node}, which is not there")));
            };
            *corner = vertex;
        }
        match what {
            Kind::Line => self.mesh.lines.push([corners[0], corners[1]]),
            Kind::Face => self.mesh.faces.push(&corners[..count]),
            Kind::Tetrahedron => self.mesh.tetrahedra.push(corners),
            Kind::Point | Kind::Other => {}
        }
        group.map_or(Ok(()), |group| self.groups.extend(group, &corners[..count]))
    }

    /// The group of a physical number.
    fn group(&mut self, dimension: i64, number: i64) -> usize {
        let name = self.names.get(&(dimension, number)).cloned();
        self.groups.named(&name.unwrap_or_else(|| format!("{number}")))
    }

    fn nodes_2(&mut self, count: i64, numbers: &mut Numbers<'_>) -> Result<()> {
        let count = numbers.count(count, 8, 28, "nodes")?;
        for _ in 0..count {
            let number = numbers.int("a node's number")?;
            let place = DVec3::new(numbers.float("x")?, numbers.float("y")?, numbers.float("z")?);
            self.add_node(number, place)?;
        }
        Ok(())
    }

    fn elements_2(&mut self, count: i64, numbers: &mut Numbers<'_>, is_binary: bool) -> Result<()> {
        // In binary files elements come in runs of one type, which say their numbers of tags and of elements first.
        let count = numbers.count(count, 6, 4, "elements")?;
        let mut nodes = Vec::new();
        let mut done = 0;
        while done < count {
            let first = numbers.int("an element's number")?;
            let (kind, run) =
                if is_binary { (first, numbers.int("a count")?) } else { (numbers.int("a type")?, 1) };
            let tags = numbers.int("a count of tags")?;
            let tags = numbers.count(tags, 2, 4, "tags")?;
            let size = size_of_element(kind)?;
            let run = numbers.count(run, 2, 4 * (1 + tags + size) as u64, "elements")?;
            for _ in 0..run {
                if is_binary {
                    numbers.int("an element's number")?;
                }
                let mut physical = 0;
                for tag in 0..tags {
                    let value = numbers.int("a tag")?;
                    physical = if tag == 0 { value } else { physical };
                }
                nodes.clear();
                for _ in 0..size {
                    nodes.push(numbers.int("a node's number")?);
                }
                let dimension = dimension_of(kind);
                let group = (physical != 0).then(|| self.group(dimension, physical));
                self.add_element(kind, &nodes, group)?;
            }
            // A run of nothing would never end.
            done += run.max(1);
        }
        Ok(())
    }

    fn entities(&mut self, numbers: &mut Numbers<'_>) -> Result<()> {
        let mut counts = [0; 4];
        for count in &mut counts {
            *count = numbers.size("a count of entities")?;
        }
        for (dimension, count) in (0i64..).zip(counts) {
            let floats = if dimension == 0 { 3 } else { 6 };
            let count = numbers.count(count, 2 * (floats + 2), 4 + 8 * (floats + 1), "entities")?;
            for _ in 0..count {
                let tag = numbers.int("an entity's number")?;
                for _ in 0..floats {
                    numbers.float("a coordinate")?;
                }
                let physical = numbers.size("a count of groups")?;
                let physical = numbers.count(physical, 2, 4, "groups")?;
                for _ in 0..physical {
                    let number = numbers.int("a group's number")?;
                    self.physical.entry((dimension, tag)).or_default().push(number);
                }
                if dimension > 0 {
                    let borders = numbers.size("a count of borders")?;
                    let borders = numbers.count(borders, 2, 4, "borders")?;
                    for _ in 0..borders {
                        numbers.int("an entity's number")?;
                    }
                }
            }
        }
        Ok(())
    }

    fn nodes_4(&mut self, numbers: &mut Numbers<'_>) -> Result<()> {
        let blocks = numbers.size("a count of blocks")?;
        let blocks = numbers.count(blocks, 8, 20, "blocks of nodes")?;
        for what in ["a count of nodes", "the smallest number", "the largest number"] {
            numbers.size(what)?;
        }
        let mut tags = Vec::new();
        for _ in 0..blocks {
            let dimension = numbers.int("a dimension")?;
            numbers.int("an entity's number")?;
            let parametric = numbers.int("0 or 1")? != 0;
            let count = numbers.size("a count of nodes")?;
            let count = numbers.count(count, 8, 32, "nodes")?;
            tags.clear();
            for _ in 0..count {
                tags.push(numbers.size("a node's number")?);
            }
            for &tag in &tags {
                let place = DVec3::new(numbers.float("x")?, numbers.float("y")?, numbers.float("z")?);
                self.add_node(tag, place)?;
                for _ in 0..if parametric { dimension.clamp(0, 3) } else { 0 } {
                    numbers.float("a parameter")?;
                }
            }
        }
        Ok(())
    }

    fn elements_4(&mut self, numbers: &mut Numbers<'_>) -> Result<()> {
        let blocks = numbers.size("a count of blocks")?;
        let blocks = numbers.count(blocks, 8, 20, "blocks of elements")?;
        for what in ["a count of elements", "the smallest number", "the largest number"] {
            numbers.size(what)?;
        }
        let mut nodes = Vec::new();
        for _ in 0..blocks {
            let dimension = numbers.int("a dimension")?;
            let entity = numbers.int("an entity's number")?;
            let kind = numbers.int("a type")?;
            let size = size_of_element(kind)?;
            let count = numbers.size("a count of elements")?;
            let count = numbers.count(count, 2 * (1 + size) as u64, 8 * (1 + size) as u64, "elements")?;
            let physical = self.physical.get(&(dimension, entity)).and_then(|groups| groups.first()).copied();
            let group = physical.map(|number| self.group(dimension, number));
            for _ in 0..count {
                numbers.size("an element's number")?;
                nodes.clear();
                for _ in 0..size {
                    nodes.push(numbers.size("a node's number")?);
                }
                self.add_element(kind, &nodes, group)?;
            }
        }
        Ok(())
    }

    fn finish(self) -> Mesh {
        let mut mesh = self.mesh;
        mesh.groups = self.groups.finish();
        if self.others > 0 {
            let sentence = format!(
                "has {} elements other than lines, triangles, quads and tetrahedra, which were left out",
                self.others
            );
            mesh.warnings.push(sentence);
        }
        if self.curved > 0 {
            mesh.warnings.push(format!(
                "has {} elements with nodes along their sides, which were left out",
                self.curved
            ));
        }
        mesh
    }
}

/// Nodes of an element of this type.
fn size_of_element(kind: i64) -> Result<usize> {
    let size = usize::try_from(kind).ok().and_then(|kind| NODES.get(kind)).copied().unwrap_or(0);
    if size > 0 {
        return Ok(size);
    }
    Err(Error::new(Code::Unsupported, format!("has elements of type {kind}, which are not known")))
}

fn dimension_of(kind: i64) -> i64 {
    match corners_of(kind).0 {
        Kind::Point => 0,
        Kind::Line => 1,
        Kind::Face => 2,
        Kind::Tetrahedron | Kind::Other => 3,
    }
}
