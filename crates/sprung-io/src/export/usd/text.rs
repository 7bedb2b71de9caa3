//! `.usda`: a USD layer as text.
//!
//! All samples of an attribute stand together. Until the run is over they wait, frame after frame and as binary numbers, in
//! one temporary file; the room that they will take as text is set aside meanwhile. Numbers are as short as they can be and
//! still read back to the same float32.

use std::io::{self, Write};
use std::path::Path;

use sprung::Result;

use super::crate_file::write_floats;
use super::layer::{Attribute, Layer, Prim, Span, Value};
use crate::export::spool::{Length, Reserve};
use crate::export::{Mark, Progress};
use crate::files::{PartialFile, write_error};
use crate::pack::{Pack, Unpack};

/// Bytes that a vector takes: three numbers of nine digits, a point and often a sign, and what stands between them.
const VECTOR_BYTES: u64 = 40;
/// The most that a vector takes, and a sample besides its vectors.
const MOST_VECTOR_BYTES: u64 = 80;
const MOST_SAMPLE_BYTES: u64 = 80;
/// What the temporary file holds.
const SAMPLES: &str = "samples";

/// About how long a text with so many frames is.
pub fn bytes(layer: &Layer, frames: u64) -> u64 {
    around(layer) + frames * (VECTOR_BYTES * vectors(layer) + 20 * layer.columns.len() as u64)
}

/// How many vectors a frame has.
fn vectors(layer: &Layer) -> u64 {
    layer.columns.iter().map(|&vectors| vectors as u64).sum()
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
    samples: Samples,
    /// For the whole text.
    reserve: Reserve,
    /// How long the text of the samples is.
    text_bytes: u64,
}

/// The columns of all frames.
struct Samples {
    file: PartialFile,
    /// Where in a frame each column lies, and how many bytes it has.
    places: Vec<(u64, usize)>,
    frame_bytes: u64,
    whole: Span,
}

impl Text {
    /// Begins a file for frames of this layer; with `keep` what waits beside it has a name.
    pub fn create(path: &Path, layer: &Layer, keep: bool) -> Result<Self> {
        let file = PartialFile::create(path)?;
        let samples = PartialFile::spool(path, SAMPLES, keep)?;
        Self::with(path, layer, file, samples, Span::default(), 0)
    }

    /// Goes on with a file where it was marked.
    pub fn resume(path: &Path, layer: &Layer, mark: &Mark) -> Result<Self> {
        let [file, samples] = mark.files_of(path)?;
        let mut memory = Unpack::new(&mark.memory);
        let (first, text_bytes) = (memory.u64()?, memory.u64()?);
        memory.end()?;
        let (columns, vectors) = (layer.columns.len() as u64, vectors(layer));
        let most = mark.frames.saturating_mul(MOST_VECTOR_BYTES * vectors + MOST_SAMPLE_BYTES * columns);
        let fits = (file.bytes, samples.head) == (0, 0)
            && mark.frames.checked_mul(12 * vectors) == Some(samples.bytes)
            && first.checked_add(mark.frames).is_some()
            && text_bytes <= most;
        if !fits {
            return Err(Mark::strange(path));
        }
        let [file, samples] = [file, samples].map(|mark| PartialFile::resume(path, mark));
        Self::with(path, layer, file?, samples?, Span { first, count: mark.frames }, text_bytes)
    }

    fn with(
        path: &Path,
        layer: &Layer,
        file: PartialFile,
        samples: PartialFile,
        whole: Span,
        text_bytes: u64,
    ) -> Result<Self> {
        let mut reserve = Reserve::beside(path)?;
        // A little more than is counted: the span will have more digits.
        reserve.add(around(layer) + 64 + text_bytes).map_err(|error| write_error(path, &error))?;
        Ok(Self { file, samples: Samples::new(layer, samples, whole), reserve, text_bytes })
    }

    pub fn path(&self) -> &Path {
        self.file.path()
    }

    /// The frames that are in it.
    pub fn span(&self) -> Span {
        self.samples.whole
    }

    /// Takes the columns of one more frame.
    pub fn frame(&mut self, index: u64, columns: &[Vec<[f32; 3]>]) -> Result<()> {
        self.take(index, columns).map_err(|error| {
            // What has come of it goes, so that another may be tried. If that fails, so will the end.
            let _ = self.samples.file.roll_back();
            write_error(self.file.path(), &error)
        })
    }

    fn take(&mut self, index: u64, columns: &[Vec<[f32; 3]>]) -> io::Result<()> {
        let mut text = Length(0);
        columns.iter().try_for_each(|column| write_sample(&mut text, index, column))?;
        self.reserve.add(text.0)?;
        self.samples.take(index, columns)?;
        self.text_bytes += text.0;
        Ok(())
    }

    /// How far it has got.
    pub fn mark(&mut self) -> io::Result<Mark> {
        let Self { file, samples, text_bytes, .. } = self;
        let mut memory = Pack::new();
        memory.u64(samples.whole.first).u64(*text_bytes);
        let files = vec![file.mark("", 0)?, samples.file.mark(SAMPLES, 0)?];
        Ok(Mark { frames: samples.whole.count, files, memory: memory.into_bytes() })
    }

    /// Completes the file and tells how many bytes and frames it has.
    pub fn finish(self, layer: &Layer, progress: &mut Progress<'_>) -> Result<(u64, u64)> {
        let Self { mut file, mut samples, mut reserve, .. } = self;
        let span = samples.whole;
        let mut complete = || {
            samples.file.roll_back()?;
            reserve.give_back()?;
            let all = span.count * samples.frame_bytes;
            let mut done = 0;
            write_layer(&mut file, layer, span, &mut |out, column| {
                for frame in 0..span.count {
                    let vectors = samples.read(frame, column)?;
                    write_sample(out, span.first + frame, &vectors)?;
                    done += 12 * vectors.len() as u64;
                    // Asked to break off, it goes on: the motion is all there, and what is left is a copy.
                    let _ = progress(done as f64 / all as f64);
                }
                Ok(())
            })
        };
        complete().map_err(|error| write_error(file.path(), &error))?;
        let bytes = file.finish()?;
        // Not before: a run that is killed until then needs them.
        samples.file.discard();
        Ok((bytes, span.count))
    }
}

impl Samples {
    fn new(layer: &Layer, file: PartialFile, whole: Span) -> Self {
        let mut frame_bytes = 0;
        let places = layer.columns.iter().map(|&vectors| {
            let place = (frame_bytes, 12 * vectors);
            frame_bytes += place.1 as u64;
            place
        });
        let places = places.collect();
        Self { file, places, frame_bytes, whole }
    }

    fn take(&mut self, index: u64, columns: &[Vec<[f32; 3]>]) -> io::Result<()> {
        columns.iter().try_for_each(|column| write_floats(&mut self.file, column.as_flattened()))?;
        self.file.commit()?;
        if self.whole.count == 0 {
            self.whole.first = index;
        }
        self.whole.count += 1;
        Ok(())
    }

    /// A column of one frame, counted from the first that is there.
    fn read(&mut self, frame: u64, column: usize) -> io::Result<Vec<[f32; 3]>> {
        let (start, bytes) = self.places[column];
        let mut read = vec![0; bytes];
        self.file.read_at(frame * self.frame_bytes + start, &mut read)?;
        let float = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
        Ok(read.chunks_exact(12).map(|b| [float(&b[..4]), float(&b[4..8]), float(&b[8..])]).collect())
    }
}

/// A line of samples: a frame's number and the vectors.
fn write_sample(out: &mut impl Write, index: u64, vectors: &[[f32; 3]]) -> io::Result<()> {
    write!(out, "            {index}: ")?;
    write_vectors(out, vectors)?;
    out.write_all(b",\n")
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
