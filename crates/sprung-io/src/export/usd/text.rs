//! `.usda`: a USD layer as text.
//!
//! All samples of an attribute stand together, so each column of the frames grows as text in a temporary file of its own
//! and is moved to its place at the end. Numbers are as short as they can be and still read back to the same float32.

use std::io::{self, Write};
use std::path::Path;

use sprung::Result;

use super::layer::{Attribute, Layer, Prim, Span, Value};
use crate::export::Progress;
use crate::export::spool::{Length, Reserve, Spool};
use crate::files::{PartialFile, write_error};

/// Bytes that a vector takes: three numbers of nine digits, a point and often a sign, and what stands between them.
const VECTOR_BYTES: u64 = 40;

/// About how long a text with so many frames is.
pub fn bytes(layer: &Layer, frames: u64) -> u64 {
    let vectors: u64 = layer.columns.iter().map(|&vectors| vectors as u64).sum();
    around(layer) + frames * (VECTOR_BYTES * vectors + 20 * layer.columns.len() as u64)
}

/// How long the text around the samples is.
fn around(layer: &Layer) -> u64 {
    let mut length = Length(0);
    // It takes everything.
    let _ = write_layer(&mut length, layer, Span::default(), &mut |_, _| Ok(()));
    length.0
}

/// A text being written.
pub struct Text {
    file: PartialFile,
    columns: Vec<Spool>,
    /// For the text around the samples.
    reserve: Reserve,
    whole: Span,
}

impl Text {
    /// Begins a file for frames of this layer.
    pub fn create(path: &Path, layer: &Layer) -> Result<Self> {
        let file = PartialFile::create(path)?;
        let columns = layer.columns.iter().map(|_| Spool::beside(path)).collect::<Result<_>>()?;
        let mut reserve = Reserve::beside(path)?;
        // A little more than is counted: the span will have more digits.
        reserve.add(around(layer) + 64).map_err(|error| write_error(path, &error))?;
        Ok(Self { file, columns, reserve, whole: Span::default() })
    }

    pub fn path(&self) -> &Path {
        self.file.path()
    }

    /// Takes the columns of one more frame.
    pub fn frame(&mut self, index: u64, columns: &[Vec<[f32; 3]>]) -> Result<()> {
        self.take(index, columns).map_err(|error| {
            // What has come of it goes, so that another may be tried. If that fails, so will the end.
            let _ = self.columns.iter_mut().try_for_each(Spool::roll_back);
            write_error(self.file.path(), &error)
        })
    }

    fn take(&mut self, index: u64, columns: &[Vec<[f32; 3]>]) -> io::Result<()> {
        for (spool, column) in self.columns.iter_mut().zip(columns) {
            write!(spool, "            {index}: ")?;
            write_vectors(spool, column)?;
            spool.write_all(b",\n")?;
        }
        self.columns.iter_mut().try_for_each(Spool::commit)?;
        if self.whole.count == 0 {
            self.whole.first = index;
        }
        self.whole.count += 1;
        Ok(())
    }

    /// Completes the file and tells how many bytes and frames it has.
    pub fn finish(self, layer: &Layer, progress: &mut Progress<'_>) -> Result<(u64, u64)> {
        let Self { mut file, columns, mut reserve, whole } = self;
        reserve.give_back().map_err(|error| write_error(file.path(), &error))?;
        let all: u64 = columns.iter().map(Spool::whole).sum();
        let mut done = 0;
        let mut moved = |bytes| {
            done += bytes;
            // Asked to break off, it goes on: the motion is all there, and what is left is a copy.
            let _ = progress(done as f64 / all as f64);
        };
        let mut columns: Vec<Option<Spool>> = columns.into_iter().map(Some).collect();
        let written = write_layer(&mut file, layer, whole, &mut |out, column| {
            columns[column].take().map_or(Ok(()), |mut spool| spool.move_to(out, &mut moved))
        });
        written.map_err(|error| write_error(file.path(), &error))?;
        Ok((file.finish()?, whole.count))
    }
}

/// Writes the text; `samples` puts those of a column in their place.
fn write_layer<W: Write>(
    out: &mut W,
    layer: &Layer,
    span: Span,
    samples: &mut dyn FnMut(&mut W, usize) -> io::Result<()>,
) -> io::Result<()> {
    let quoted = |text: &str| Quoted(text).to_string();
    writeln!(out, "#usda 1.0\n(")?;
    writeln!(out, "    defaultPrim = {}", quoted(&layer.root.name))?;
    writeln!(out, "    doc = {}", quoted(&layer.documentation))?;
    writeln!(out, "    endTimeCode = {}", span.last())?;
    writeln!(out, "    framesPerSecond = {}", layer.rate)?;
    writeln!(out, "    metersPerUnit = {}", layer.metres_per_unit)?;
    writeln!(out, "    startTimeCode = {}", span.first)?;
    writeln!(out, "    timeCodesPerSecond = {}", layer.rate)?;
    writeln!(out, "    upAxis = {}\n)\n", quoted(layer.up_axis))?;
    write_prim(out, &layer.root, 0, samples)
}

fn write_prim<W: Write>(
    out: &mut W,
    prim: &Prim,
    depth: usize,
    samples: &mut dyn FnMut(&mut W, usize) -> io::Result<()>,
) -> io::Result<()> {
    let indent = "    ".repeat(depth);
    let (name, display_name) = (Quoted(&prim.name), Quoted(&prim.display_name));
    writeln!(out, "{indent}def {} {name} (", prim.type_name)?;
    writeln!(out, "{indent}    displayName = {display_name}\n{indent})\n{indent}{{")?;
    for attribute in &prim.attributes {
        write_attribute(out, attribute, depth + 1, samples)?;
    }
    for (number, child) in prim.children.iter().enumerate() {
        if number > 0 || !prim.attributes.is_empty() {
            writeln!(out)?;
        }
        write_prim(out, child, depth + 1, samples)?;
    }
    writeln!(out, "{indent}}}")
}

fn write_attribute<W: Write>(
    out: &mut W,
    attribute: &Attribute,
    depth: usize,
    samples: &mut dyn FnMut(&mut W, usize) -> io::Result<()>,
) -> io::Result<()> {
    let indent = "    ".repeat(depth);
    let Attribute { name, type_name, uniform, interpolation, value } = attribute;
    let uniform = if *uniform { "uniform " } else { "" };
    if let Value::Samples(column) = value {
        if let Some(interpolation) = interpolation {
            writeln!(
                out,
                "{indent}{type_name} {name} (\n{indent}    interpolation = \"{interpolation}\"\n{indent})"
            )?;
        }
        writeln!(out, "{indent}{type_name} {name}.timeSamples = {{")?;
        samples(out, *column)?;
        return writeln!(out, "{indent}}}");
    }
    write!(out, "{indent}{uniform}{type_name} {name} = ")?;
    match value {
        Value::Bool(value) => write!(out, "{}", u8::from(*value))?,
        Value::Token(token) => write!(out, "{}", Quoted(token))?,
        Value::Ints(ints) => write_list(out, ints, |out, int| write!(out, "{int}"))?,
        Value::Floats(floats) => {
            let mut digits = zmij::Buffer::new();
            write_list(out, floats, |out, float| out.write_all(digits.format(*float).as_bytes()))?;
        }
        Value::Vec3s(vectors) => write_vectors(out, vectors)?,
        Value::Samples(_) => {}
    }
    if let Some(interpolation) = interpolation {
        write!(out, " (\n{indent}    interpolation = \"{interpolation}\"\n{indent})")?;
    }
    writeln!(out)
}

fn write_list<T, W: Write>(
    out: &mut W,
    items: &[T],
    mut write_item: impl FnMut(&mut W, &T) -> io::Result<()>,
) -> io::Result<()> {
    out.write_all(b"[")?;
    for (number, item) in items.iter().enumerate() {
        if number > 0 {
            out.write_all(b", ")?;
        }
        write_item(out, item)?;
    }
    out.write_all(b"]")
}

fn write_vectors(out: &mut impl Write, vectors: &[[f32; 3]]) -> io::Result<()> {
    let mut digits = zmij::Buffer::new();
    write_list(out, vectors, |out, vector| {
        for (before, component) in ["(", ", ", ", "].into_iter().zip(vector) {
            out.write_all(before.as_bytes())?;
            out.write_all(digits.format(*component).as_bytes())?;
        }
        out.write_all(b")")
    })
}

/// A text in quotation marks, with what cannot stand there escaped.
struct Quoted<'a>(&'a str);

impl std::fmt::Display for Quoted<'_> {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.write_str("\"")?;
        for c in self.0.chars() {
            match c {
                '"' | '\\' => write!(out, "\\{c}")?,
                '\n' => out.write_str("\\n")?,
                '\t' => out.write_str("\\t")?,
                _ if c.is_control() => out.write_str(" ")?,
                _ => write!(out, "{c}")?,
            }
        }
        out.write_str("\"")
    }
}
