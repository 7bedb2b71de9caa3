//! VTK XML unstructured grids (`.vtu`): the same cells as in a legacy file, in a tree of elements whose numbers are text, or
//! bytes in base64 or behind the tree, compressed by zlib or not. The tree is read by the library `quick-xml`; what belongs to
//! points or cells, such as fields, is passed over.

mod array;

use std::borrow::Cow;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use sprung::build::Mesh;
use sprung::build::mesh::MOST_VERTICES;
use sprung::{Code, DVec3, Error, Result};

use self::array::{Array, Context, Form, Kind};
use super::bytes::Order;
use super::vtk::{add_cell, left_out};
use super::words::{count_lines, quoted, quoted_long};
use super::{Companions, malformed};

/// Attributes of an element that are looked at: more than any has.
const MOST_ATTRIBUTES: usize = 64;

/// Bytes that arrays may make when they are read, for each byte of the file and besides: types of cells compress well, and nothing
/// that is honest better than so.
const MOST_FOR_ONE: u64 = 64;
const SPARE: u64 = 64 << 20;

/// The end of a whole file.
const LAST: &[u8] = b"</VTKFile>";

/// A part of the grid: its counts and where its numbers are.
#[derive(Default)]
struct Piece<'a> {
    line: usize,
    points: usize,
    cells: usize,
    places: Option<Array<'a>>,
    connectivity: Option<Array<'a>>,
    offsets: Option<Array<'a>>,
    types: Option<Array<'a>>,
}

/// Where in a piece the tree is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Section {
    Points,
    Cells,
}

pub(super) fn read(bytes: &[u8], _: &mut Companions<'_>) -> Result<Mesh> {
    let mut tree = Tree { bytes, reader: Reader::from_reader(bytes), line: 1, counted: 0 };
    let (context, pieces) = tree.read()?;
    if !bytes.trim_ascii_end().ends_with(LAST) {
        return Err(malformed("ends before </VTKFile>: it is cut short"));
    }
    context.budget.set(SPARE + MOST_FOR_ONE * bytes.len() as u64);
    let (mut mesh, mut others) = (Mesh::default(), 0);
    for piece in pieces {
        let line = piece.line;
        others += add_piece(&mut mesh, piece, &context).map_err(|error| {
            // What an array says has the array's line.
            if error.place().line_column.is_some() { error } else { error.at_line(line, 1) }
        })?;
    }
    mesh.warnings.extend(left_out(others));
    Ok(mesh)
}

/// Adds a part; gives how many cells were left out.
fn add_piece(mesh: &mut Mesh, piece: Piece<'_>, context: &Context<'_>) -> Result<u64> {
    if piece.points == 0 {
        return Ok(0);
    }
    let first = mesh.positions.len();
    if first + piece.points > MOST_VERTICES {
        let sentence = format!("has more than {MOST_VERTICES} points in all");
        return Err(Error::new(Code::TooLarge, sentence));
    }
    let missing =
        |what: &str| Error::new(Code::MissingField, format!("has a Piece with points and without {what}"));
    let places = piece.places.ok_or_else(|| missing("Points"))?;
    let values = places.floats(context, 3 * piece.points)?;
    mesh.positions.extend(values.chunks_exact(3).map(DVec3::from_slice));
    if piece.cells == 0 {
        return Ok(0);
    }
    let offsets = piece.offsets.ok_or_else(|| missing("the offsets of its cells"))?;
    let ends = offsets.integers(context, piece.cells)?;
    let mut last = 0;
    for &end in &ends {
        if end < last || end > MOST_VERTICES as i64 {
            let sentence = format!(
                "has an offset of {end} after {last}, and offsets must not fall, nor be over {MOST_VERTICES}"
            );
            return Err(Error::new(Code::Conflict, sentence).at_line(offsets.line, 1));
        }
        last = end;
    }
    let connectivity = piece.connectivity.ok_or_else(|| missing("the connectivity of its cells"))?;
    let mut corners = Vec::with_capacity(last as usize);
    for corner in connectivity.integers(context, last as usize)? {
        if !(0..piece.points as i64).contains(&corner) {
            let sentence = format!("names point {corner}, and has the points 0 to {}", piece.points - 1);
            return Err(Error::new(Code::NotFound, sentence).at_line(connectivity.line, 1));
        }
        corners.push(first as u32 + corner as u32);
    }
    let types =
        piece.types.ok_or_else(|| missing("the types of its cells"))?.integers(context, piece.cells)?;
    let (mut start, mut others) = (0, 0);
    for (end, kind) in ends.into_iter().zip(types) {
        let end = end as usize;
        others += u64::from(!add_cell(mesh, kind, &corners[start..end]));
        start = end;
    }
    Ok(others)
}

/// The tree of elements being read.
struct Tree<'a> {
    bytes: &'a [u8],
    reader: Reader<&'a [u8]>,
    /// The line of the byte up to which lines are counted.
    line: usize,
    counted: usize,
}

impl<'a> Tree<'a> {
    /// All parts, and what they share.
    fn read(&mut self) -> Result<(Context<'a>, Vec<Piece<'a>>)> {
        let mut context = Context::default();
        let mut pieces: Vec<Piece<'a>> = Vec::new();
        let (mut section, mut is_grid) = (None, false);
        loop {
            let event = self.next()?;
            let (element, is_empty) = match event {
                Event::Start(element) => (element, false),
                Event::Empty(element) => (element, true),
                Event::End(element) => {
                    if matches!(element.name().as_ref(), b"Points" | b"Cells") {
                        section = None;
                    }
                    continue;
                }
                Event::Eof if is_grid => return Ok((context, pieces)),
                Event::Eof => {
                    return Err(malformed("has no element VTKFile; is it a VTK XML file?"));
                }
                _ => continue,
            };
            let name = element.name();
            match (name.as_ref(), pieces.last_mut()) {
                (b"VTKFile", None) => {
                    self.head(&element, &mut context)?;
                    is_grid = true;
                }
                _ if !is_grid => {
                    return Err(malformed("does not begin with the element VTKFile; is it a VTK XML file?"));
                }
                (b"UnstructuredGrid", None) => {}
                (b"Piece", _) => {
                    let piece = self.piece(&element)?;
                    pieces.push(piece);
                    section = None;
                }
                (b"Points", Some(_)) if !is_empty => section = Some(Section::Points),
                (b"Cells", Some(_)) if !is_empty => section = Some(Section::Cells),
                (b"DataArray", Some(piece)) if section.is_some() => {
                    let slot = match (section, attribute(&element, b"Name").as_deref()) {
                        (Some(Section::Points), _) => Some(&mut piece.places),
                        (_, Some(b"connectivity")) => Some(&mut piece.connectivity),
                        (_, Some(b"offsets")) => Some(&mut piece.offsets),
                        (_, Some(b"types")) => Some(&mut piece.types),
                        // Of polyhedra, say, which are left out.
                        _ => None,
                    };
                    match slot {
                        Some(slot) => *slot = Some(self.array(&element, is_empty, section)?),
                        None if is_empty => {}
                        None => self.skip(&element)?,
                    }
                }
                (b"AppendedData", _) if !is_empty => {
                    context.is_base64 = attribute(&element, b"encoding").as_deref() == Some(b"base64");
                    let rest = &self.bytes[(self.reader.buffer_position() as usize).min(self.bytes.len())..];
                    let start = rest.iter().position(|&byte| byte == b'_');
                    let start = start.ok_or_else(|| malformed("has no _ before its appended data"))?;
                    context.appended = Some(&rest[start + 1..]);
                    // What follows need not be XML.
                    return Ok((context, pieces));
                }
                _ if is_empty => {}
                _ => self.skip(&element)?,
            }
        }
    }

    fn next(&mut self) -> Result<Event<'a>> {
        self.reader.read_event().map_err(|error| self.wrong(&error))
    }

    /// Passes over all that is in an element.
    fn skip(&mut self, element: &BytesStart<'_>) -> Result<()> {
        self.reader.read_to_end(element.name()).map(drop).map_err(|error| self.wrong(&error))
    }

    fn wrong(&mut self, error: &quick_xml::Error) -> Error {
        let said = error.to_string();
        let sentence = format!("is not valid XML: {}", quoted_long(said.as_bytes()));
        let at = self.reader.error_position() as usize;
        malformed(sentence).at_line(1 + count_lines(&self.bytes[..at.min(self.bytes.len())]), 1)
    }

    /// The line of the event that was read last.
    fn line(&mut self) -> usize {
        let at = (self.reader.buffer_position() as usize).min(self.bytes.len());
        self.line += count_lines(&self.bytes[self.counted.min(at)..at]);
        self.counted = self.counted.max(at);
        self.line
    }

    fn error(&mut self, code: Code, sentence: impl Into<String>) -> Error {
        Error::new(code, sentence).at_line(self.line(), 1)
    }

    /// What the file says of itself.
    fn head(&mut self, element: &BytesStart<'_>, context: &mut Context<'a>) -> Result<()> {
        let said = |name: &[u8]| attribute(element, name).map(|value| quoted(&value));
        if let Some(other) = said(b"type").filter(|kind| kind != "UnstructuredGrid") {
            let sentence = format!("is a {other}, and UnstructuredGrid is read of VTK XML");
            return Err(self
                .error(Code::Unsupported, sentence)
                .with_fix("save it as a legacy .vtk file or as .ply"));
        }
        context.order = match said(b"byte_order").as_deref() {
            Some("BigEndian") => Order::Big,
            Some("LittleEndian") | None => Order::Little,
            Some(other) => {
                let sentence =
                    format!("has the byte_order \"{other}\", which must be LittleEndian or BigEndian");
                return Err(self.error(Code::OutOfRange, sentence));
            }
        };
        context.header = match said(b"header_type").as_deref() {
            Some("UInt64") => Kind::U64,
            Some("UInt32") | None => Kind::U32,
            Some(other) => {
                let sentence = format!("has the header_type \"{other}\", which must be UInt32 or UInt64");
                return Err(self.error(Code::OutOfRange, sentence));
            }
        };
        context.is_compressed = match said(b"compressor").as_deref() {
            Some("vtkZLibDataCompressor") => true,
            Some("") | None => false,
            Some(other) => {
                let sentence = format!("is compressed by {other}, and vtkZLibDataCompressor is read");
                return Err(self
                    .error(Code::Unsupported, sentence)
                    .with_fix("save it with zlib, or without compression"));
            }
        };
        Ok(())
    }

    fn piece(&mut self, element: &BytesStart<'_>) -> Result<Piece<'a>> {
        let mut counts = [0; 2];
        for (count, name) in counts.iter_mut().zip(["NumberOfPoints", "NumberOfCells"]) {
            let value = attribute(element, name.as_bytes()).unwrap_or_default();
            let number = whole(&value).filter(|&number| number <= MOST_VERTICES as u64);
            *count = number.ok_or_else(|| {
                let said = quoted(&value);
                let sentence =
                    format!("has {name}=\"{said}\", which must be a number from 0 to {MOST_VERTICES}");
                self.error(Code::OutOfRange, sentence)
            })? as usize;
        }
        Ok(Piece { line: self.line(), points: counts[0], cells: counts[1], ..Piece::default() })
    }

    /// An array, up to its end; numbers of points must be three each.
    fn array(
        &mut self,
        element: &BytesStart<'_>,
        is_empty: bool,
        section: Option<Section>,
    ) -> Result<Array<'a>> {
        let line = self.line();
        let wrong = |code, sentence: String| Error::new(code, sentence).at_line(line, 1);
        let said = |name: &[u8]| attribute(element, name).map(|value| quoted(&value)).unwrap_or_default();
        let kind = said(b"type");
        let kind = Kind::of(&kind).ok_or_else(|| {
            wrong(Code::OutOfRange, format!("has an array of the type \"{kind}\", which VTK does not have"))
        })?;
        let components = said(b"NumberOfComponents");
        if section == Some(Section::Points) && components != "3" {
            let sentence = format!("has points of \"{components}\" numbers, and they must have 3");
            return Err(wrong(Code::OutOfRange, sentence));
        }
        let format = said(b"format");
        let offset = attribute(element, b"offset");
        let content = if is_empty { Cow::Borrowed(&b""[..]) } else { self.content()? };
        let form = match (format.as_str(), offset) {
            ("ascii", _) => Form::Text(content),
            ("binary", _) => Form::Base64(content),
            ("appended", Some(offset)) => Form::Appended(whole(&offset).ok_or_else(|| {
                wrong(Code::Syntax, format!("has the offset \"{}\", which is no number", quoted(&offset)))
            })?),
            ("appended", None) => {
                return Err(wrong(Code::MissingField, "has an appended array without an offset".to_owned()));
            }
            _ => {
                let sentence = format!(
                    "has an array of the format \"{format}\", which must be ascii, binary or appended"
                );
                return Err(wrong(Code::OutOfRange, sentence));
            }
        };
        Ok(Array { kind, form, line })
    }

    /// The text of an array, without the elements in it.
    fn content(&mut self) -> Result<Cow<'a, [u8]>> {
        let mut content = Cow::Borrowed(&b""[..]);
        let mut add = |more: Cow<'a, [u8]>| match content.is_empty() {
            true => content = more,
            false => content.to_mut().extend_from_slice(&more),
        };
        loop {
            match self.next()? {
                Event::Text(text) => add(text.into_inner()),
                Event::CData(text) => add(text.into_inner()),
                // Such as the keys of information about it.
                Event::Start(element) => self.skip(&element)?,
                Event::End(_) => return Ok(content),
                Event::Eof => return Err(malformed("ends in the middle of an array: it is cut short")),
                _ => {}
            }
        }
    }
}

/// An attribute of an element, as it is written.
fn attribute<'e>(element: &'e BytesStart<'_>, name: &[u8]) -> Option<Cow<'e, [u8]>> {
    // Without the library's check for attributes that come twice, which compares each with each.
    let mut attributes = element.attributes();
    let mut some = attributes.with_checks(false).take(MOST_ATTRIBUTES).flatten();
    some.find(|attribute| attribute.key.as_ref() == name).map(|attribute| attribute.value)
}

/// A number without a sign.
fn whole(text: &[u8]) -> Option<u64> {
    std::str::from_utf8(text.trim_ascii()).ok()?.parse().ok()
}
