//! `.usdc`, the binary form of a USD layer, which its makers call a "crate".
//!
//! A library for it wants the whole layer in memory, and a run may be longer than that. The format itself asks for no such
//! thing: it is a bootstrap of 88 bytes, then values in any order, then six tables that say which value belongs to what,
//! and a table of contents. So the arrays of each frame are written as they come, and all else when the run is over:
//!
//! ```text
//! bootstrap | frame | frame | … | values that hold at all times | tables | table of contents
//! ```
//!
//! Every frame takes the same room, and its arrays lie in the same order. Where an array is follows from the number of its
//! frame, and nothing has to be remembered for each.
//!
//! The layout is that of version 0.8.0, which all readers since 2018 know: `pxr/usd/sdf/crateFile.h` and `crateFile.cpp`
//! of OpenUSD (before 2025 in `pxr/usd/usd`), names in quotes below are theirs; and the chapter on the crate format of the
//! AOUSD Core Specification. Numbers are little-endian.

use std::collections::BTreeMap;
use std::io::{self, Write};

use super::coding;
use super::layer::{Attribute, Layer, Prim, Span, Value};

/// "BootStrap": `PXR-USDC`, eight bytes of version, where the table of contents is, and eight unused numbers.
pub const BOOTSTRAP_BYTES: u64 = 88;
/// Version 0.8.0: 64-bit lengths of arrays (0.7.0) and nothing that older readers lack.
const VERSION: [u8; 8] = [0, 8, 0, 0, 0, 0, 0, 0];

/// "ValueRep": type in bits 48 to 55, the value itself or where it is in the lower 48.
const IS_ARRAY: u64 = 1 << 63;
const IS_INLINED: u64 = 1 << 62;

/// "TypeEnum", as far as it is used here.
#[derive(Clone, Copy)]
#[repr(u64)]
enum Type {
    Bool = 1,
    Int = 3,
    Float = 8,
    Double = 9,
    String = 10,
    Token = 11,
    Vec3f = 24,
    TokenVector = 41,
    Specifier = 42,
    Variability = 44,
    TimeSamples = 46,
    DoubleVector = 48,
}

/// "SdfSpecType".
const SPEC_ATTRIBUTE: u32 = 1;
const SPEC_PRIM: u32 = 6;
const SPEC_PSEUDO_ROOT: u32 = 7;

/// How many bytes a frame takes, and where its columns begin in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameLayout {
    pub bytes: u64,
    starts: Vec<u64>,
}

impl FrameLayout {
    /// Of columns with these numbers of vectors.
    pub fn new(columns: &[usize]) -> Self {
        let mut bytes = 0;
        let mut starts = Vec::with_capacity(columns.len());
        for &vectors in columns {
            starts.push(bytes);
            bytes += (array_bytes(vectors) + 7) & !7;
        }
        Self { bytes, starts }
    }

    /// What a frame's share of the tables takes: one value for each column, and its time.
    pub fn table_bytes(&self) -> u64 {
        8 * (self.starts.len() as u64 + 1)
    }
}

/// A length and so many vectors of three floats.
fn array_bytes(vectors: usize) -> u64 {
    8 + 12 * vectors as u64
}

/// Writes one column of a frame. All of a frame's are written one after the other, the first frame behind the bootstrap.
pub fn write_column(out: &mut impl Write, vectors: &[[f32; 3]]) -> io::Result<()> {
    out.write_all(&(vectors.len() as u64).to_le_bytes())?;
    write_floats(out, vectors.as_flattened())?;
    // Values begin at multiples of eight, so that a reader can use them where they lie.
    let odd = vectors.len() % 2 == 1;
    if odd { out.write_all(&[0; 4]) } else { Ok(()) }
}

/// Floats as little-endian bytes, some kilobytes at a time.
pub fn write_floats(out: &mut impl Write, floats: &[f32]) -> io::Result<()> {
    let mut piece = [0; 1 << 12];
    for some in floats.chunks(piece.len() / 4) {
        for (bytes, float) in piece.chunks_exact_mut(4).zip(some) {
            bytes.copy_from_slice(&float.to_le_bytes());
        }
        out.write_all(&piece[..4 * some.len()])?;
    }
    Ok(())
}

/// The bootstrap of a file whose table of contents is at `contents`.
pub fn bootstrap(contents: u64) -> [u8; BOOTSTRAP_BYTES as usize] {
    let mut bytes = [0; BOOTSTRAP_BYTES as usize];
    bytes[..8].copy_from_slice(b"PXR-USDC");
    bytes[8..16].copy_from_slice(&VERSION);
    bytes[16..24].copy_from_slice(&contents.to_le_bytes());
    bytes
}

/// Writes all that follows the frames and tells where the table of contents is.
pub fn write_rest(out: &mut impl Write, layer: &Layer, span: Span) -> io::Result<u64> {
    let frames = FrameLayout::new(&layer.columns);
    let at = BOOTSTRAP_BYTES + frames.bytes * span.count;
    let out = Counted { out, at };
    let mut rest = Rest { out, layer, span, frames, times: None, tables: Tables::default() };
    rest.write()
}

/// A writer that knows where it is in the file.
struct Counted<'a, W> {
    out: &'a mut W,
    at: u64,
}

impl<W: Write> Counted<'_, W> {
    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.out.write_all(bytes)?;
        self.at += bytes.len() as u64;
        Ok(())
    }

    fn put64(&mut self, number: u64) -> io::Result<()> {
        self.put(&number.to_le_bytes())
    }

    /// Bytes and how many they are.
    fn put_sized(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.put64(bytes.len() as u64)?;
        self.put(bytes)
    }

    fn align(&mut self) -> io::Result<()> {
        let missing = self.at.next_multiple_of(8) - self.at;
        self.put(&[0; 8][..missing as usize])
    }
}

/// What the tables hold. Everything refers to everything else by its number in them.
#[derive(Default)]
struct Tables {
    tokens: Vec<String>,
    token_numbers: BTreeMap<String, u32>,
    /// Numbers of tokens.
    strings: Vec<u32>,
    /// Number of the name's token, and the value.
    fields: Vec<(u32, u64)>,
    /// Numbers of fields, set after set, each closed by `u32::MAX`.
    field_sets: Vec<u32>,
    /// Path, field set and kind of each spec.
    specs: Vec<[u32; 3]>,
    /// The tree of paths, depth first: number of the name's token, negative for a property; and the "jump".
    paths: Vec<(i32, i32)>,
}

impl Tables {
    fn token(&mut self, text: &str) -> u32 {
        if let Some(&number) = self.token_numbers.get(text) {
            return number;
        }
        let number = self.tokens.len() as u32;
        self.tokens.push(text.to_owned());
        self.token_numbers.insert(text.to_owned(), number);
        number
    }

    fn string(&mut self, text: &str) -> u32 {
        let token = self.token(text);
        self.strings.push(token);
        self.strings.len() as u32 - 1
    }

    /// Adds the spec of the path that was added last, or of the root, with its fields.
    fn spec(&mut self, path: u32, kind: u32, fields: &[(&str, u64)]) {
        self.specs.push([path, self.field_sets.len() as u32, kind]);
        for &(name, value) in fields {
            let token = self.token(name);
            self.field_sets.push(self.fields.len() as u32);
            self.fields.push((token, value));
        }
        self.field_sets.push(u32::MAX);
    }
}

struct Rest<'a, W> {
    out: Counted<'a, W>,
    layer: &'a Layer,
    span: Span,
    frames: FrameLayout,
    /// The times of all samples, once they are written.
    times: Option<u64>,
    tables: Tables,
}

/// A value that stands in the lower 48 bits.
fn inlined(kind: Type, value: u32) -> u64 {
    IS_INLINED | (kind as u64) << 48 | u64::from(value)
}

/// A value that lies elsewhere in the file.
fn placed(kind: Type, at: u64) -> u64 {
    (kind as u64) << 48 | at
}

impl<W: Write> Rest<'_, W> {
    fn write(&mut self) -> io::Result<u64> {
        // The token with the number 0 is no property's name: those are told from others by a minus.
        self.tables.token("sprung");
        let layer = self.layer;
        self.tables.paths.push((0, -1)); // the root, which has a child and no sibling
        let children = self.token_vector(&[layer.root.name.as_str()])?;
        let fields = [
            ("defaultPrim", self.token_value(&layer.root.name)),
            ("documentation", inlined(Type::String, self.tables.string(&layer.documentation))),
            ("endTimeCode", self.double(self.span.last() as f64)?),
            ("framesPerSecond", self.double(layer.rate)?),
            ("metersPerUnit", self.double(layer.metres_per_unit)?),
            ("primChildren", children),
            ("startTimeCode", self.double(self.span.first as f64)?),
            ("timeCodesPerSecond", self.double(layer.rate)?),
            ("upAxis", self.token_value(layer.up_axis)),
        ];
        self.tables.spec(0, SPEC_PSEUDO_ROOT, &fields);
        self.prim(&layer.root, true)?;
        self.write_tables()
    }

    /// A prim with all below it. Depth first, so that the tree of paths is in the order that its table wants.
    fn prim(&mut self, prim: &Prim, is_last: bool) -> io::Result<()> {
        let path = self.path(&prim.name, false);
        let names: Vec<&str> = prim.attributes.iter().map(|attribute| attribute.name).collect();
        let children: Vec<&str> = prim.children.iter().map(|child| child.name.as_str()).collect();
        let mut fields = vec![
            ("specifier", inlined(Type::Specifier, 0)), // def
            ("typeName", self.token_value(prim.type_name)),
            ("displayName", inlined(Type::String, self.tables.string(&prim.display_name))),
        ];
        if !names.is_empty() {
            fields.push(("properties", self.token_vector(&names)?));
        }
        if !children.is_empty() {
            fields.push(("primChildren", self.token_vector(&children)?));
        }
        self.tables.spec(path, SPEC_PRIM, &fields);

        let below = prim.attributes.len() + prim.children.len();
        for (number, attribute) in prim.attributes.iter().enumerate() {
            self.attribute(attribute)?;
            self.close(path + 1 + number as u32, number + 1 == below);
        }
        for (number, child) in prim.children.iter().enumerate() {
            self.prim(child, prim.attributes.len() + number + 1 == below)?;
        }
        self.close(path, is_last);
        Ok(())
    }

    fn attribute(&mut self, attribute: &Attribute) -> io::Result<()> {
        let path = self.path(attribute.name, true);
        let mut fields = vec![("typeName", self.token_value(attribute.type_name))];
        if attribute.uniform {
            fields.push(("variability", inlined(Type::Variability, 1)));
        }
        if let Some(interpolation) = attribute.interpolation {
            fields.push(("interpolation", self.token_value(interpolation)));
        }
        let name = if matches!(attribute.value, Value::Samples(_)) { "timeSamples" } else { "default" };
        fields.push((name, self.value(&attribute.value)?));
        self.tables.spec(path, SPEC_ATTRIBUTE, &fields);
        Ok(())
    }

    /// Adds a path below the one that is being written and tells its number.
    fn path(&mut self, name: &str, is_property: bool) -> u32 {
        let token = self.tables.token(name).cast_signed();
        self.tables.paths.push((if is_property { -token } else { token }, 0));
        self.tables.paths.len() as u32 - 1
    }

    /// Says of a path, when all below it is there, how the tree goes on: a positive "jump" is the way to its next sibling
    /// while a child comes next, 0 a sibling that comes next, -1 a child without a sibling, -2 neither.
    fn close(&mut self, path: u32, is_last: bool) {
        let below = self.tables.paths.len() as i32 - path.cast_signed();
        let jump = match (below > 1, is_last) {
            (true, false) => below,
            (false, false) => 0,
            (true, true) => -1,
            (false, true) => -2,
        };
        self.tables.paths[path as usize].1 = jump;
    }

    fn value(&mut self, value: &Value) -> io::Result<u64> {
        match value {
            Value::Bool(value) => Ok(inlined(Type::Bool, u32::from(*value))),
            Value::Token(token) => Ok(self.token_value(token)),
            Value::Ints(ints) => {
                let at = self.begin_array(ints.len())?;
                ints.iter().try_for_each(|int| self.out.put(&int.to_le_bytes()))?;
                Ok(IS_ARRAY | placed(Type::Int, at))
            }
            Value::Floats(floats) => {
                let at = self.begin_array(floats.len())?;
                floats.iter().try_for_each(|float| self.out.put(&float.to_le_bytes()))?;
                Ok(IS_ARRAY | placed(Type::Float, at))
            }
            Value::Vec3s(vectors) => {
                let at = self.begin_array(vectors.len())?;
                let floats = vectors.as_flattened();
                floats.iter().try_for_each(|float| self.out.put(&float.to_le_bytes()))?;
                Ok(IS_ARRAY | placed(Type::Vec3f, at))
            }
            Value::Samples(column) => self.samples(*column),
        }
    }

    fn begin_array(&mut self, length: usize) -> io::Result<u64> {
        self.out.align()?;
        let at = self.out.at;
        self.out.put64(length as u64)?;
        Ok(at)
    }

    /// "TimeSamples": the way to the times' value, the way to the values, how many, and each of them. The ways count from
    /// where they stand.
    fn samples(&mut self, column: usize) -> io::Result<u64> {
        let times = self.times()?;
        self.out.align()?;
        let at = self.out.at;
        self.out.put64(8)?;
        self.out.put64(times)?;
        self.out.put64(8)?;
        self.out.put64(self.span.count)?;
        let first = BOOTSTRAP_BYTES + self.frames.starts[column];
        for frame in 0..self.span.count {
            self.out.put64(IS_ARRAY | placed(Type::Vec3f, first + frame * self.frames.bytes))?;
        }
        Ok(placed(Type::TimeSamples, at))
    }

    /// The times of the samples, which all attributes share.
    fn times(&mut self) -> io::Result<u64> {
        if let Some(times) = self.times {
            return Ok(times);
        }
        let at = self.begin_array(self.span.count as usize)?;
        for frame in self.span.first..self.span.first + self.span.count {
            self.out.put(&(frame as f64).to_le_bytes())?;
        }
        let times = placed(Type::DoubleVector, at);
        self.times = Some(times);
        Ok(times)
    }

    fn double(&mut self, value: f64) -> io::Result<u64> {
        self.out.align()?;
        let at = self.out.at;
        self.out.put(&value.to_le_bytes())?;
        Ok(placed(Type::Double, at))
    }

    fn token_value(&mut self, token: &str) -> u64 {
        inlined(Type::Token, self.tables.token(token))
    }

    fn token_vector(&mut self, tokens: &[&str]) -> io::Result<u64> {
        let at = self.begin_array(tokens.len())?;
        for token in tokens {
            let number = self.tables.token(token);
            self.out.put(&number.to_le_bytes())?;
        }
        Ok(placed(Type::TokenVector, at))
    }

    /// The six tables, and the table of contents, whose place it tells.
    fn write_tables(&mut self) -> io::Result<u64> {
        let tables = std::mem::take(&mut self.tables);
        let out = &mut self.out;
        let mut contents = Vec::new();
        let mut begin = |out: &mut Counted<'_, W>, name: &'static str| -> io::Result<()> {
            let end = out.at;
            out.align()?;
            contents.push((name, end, out.at)); // with the end of the table before
            Ok(())
        };
        let column = |numbers: Vec<u32>| coding::stored(&coding::integers(&numbers));

        begin(out, "TOKENS")?;
        let mut text = Vec::new();
        for token in &tables.tokens {
            text.extend(token.as_bytes());
            text.push(0);
        }
        out.put64(tables.tokens.len() as u64)?;
        out.put64(text.len() as u64)?;
        out.put_sized(&coding::stored(&text))?;

        begin(out, "STRINGS")?;
        out.put64(tables.strings.len() as u64)?;
        tables.strings.iter().try_for_each(|token| out.put(&token.to_le_bytes()))?;

        begin(out, "FIELDS")?;
        out.put64(tables.fields.len() as u64)?;
        out.put_sized(&column(tables.fields.iter().map(|field| field.0).collect()))?;
        let values: Vec<u8> = tables.fields.iter().flat_map(|field| field.1.to_le_bytes()).collect();
        out.put_sized(&coding::stored(&values))?;

        begin(out, "FIELDSETS")?;
        out.put64(tables.field_sets.len() as u64)?;
        out.put_sized(&column(tables.field_sets))?;

        begin(out, "PATHS")?;
        let count = tables.paths.len();
        out.put64(count as u64)?; // paths
        out.put64(count as u64)?; // rows of the table that follows: number, name and jump
        out.put_sized(&column((0..count as u32).collect()))?;
        out.put_sized(&column(tables.paths.iter().map(|path| path.0.cast_unsigned()).collect()))?;
        out.put_sized(&column(tables.paths.iter().map(|path| path.1.cast_unsigned()).collect()))?;

        begin(out, "SPECS")?;
        out.put64(tables.specs.len() as u64)?;
        for part in 0..3 {
            out.put_sized(&column(tables.specs.iter().map(|spec| spec[part]).collect()))?;
        }

        // The table of contents: name in 16 bytes, start, length.
        let last_end = out.at;
        out.align()?;
        let at = out.at;
        out.put64(contents.len() as u64)?;
        for (number, &(name, _, start)) in contents.iter().enumerate() {
            let end = contents.get(number + 1).map_or(last_end, |&(_, end, _)| end);
            let mut padded = [0; 16];
            padded[..name.len()].copy_from_slice(name.as_bytes());
            out.put(&padded)?;
            out.put64(start)?;
            out.put64(end - start)?;
        }
        Ok(at)
    }
}
