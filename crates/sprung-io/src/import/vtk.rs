//! VTK legacy files, as text or binary (whose numbers begin with the largest byte): POLYDATA, and the lines, triangles, quads,
//! polygons and tetrahedra of an UNSTRUCTURED_GRID. What belongs to points or cells, such as fields, is of no concern here.

use sprung::build::Mesh;
use sprung::{Code, DVec3, Error, Result};

use super::bytes::{Bytes, Order};
use super::words::{Words, quoted};
use super::{Companions, malformed};

/// Cells as they are listed: where each ends, and all their points.
#[derive(Default)]
struct Cells {
    ends: Vec<usize>,
    points: Vec<u32>,
}

impl Cells {
    fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.points[start..end])
    }
}

/// A file being read.
struct Reading<'a> {
    words: Words<'a>,
    is_binary: bool,
    /// 5.1 and later: cells as offsets and connectivity.
    has_offsets: bool,
    mesh: Mesh,
    others: u64,
}

pub(super) fn read(bytes: &[u8], _: &mut Companions<'_>) -> Result<Mesh> {
    let mut words = Words::new(bytes, 1);
    let first = words.rest_of_line();
    let Some(version) = first.strip_prefix(b"# vtk DataFile Version") else {
        return Err(malformed("does not begin with \"# vtk DataFile Version\"; is it a VTK legacy file?"));
    };
    let has_offsets = super::words::float(version.trim_ascii()).is_some_and(|version| version >= 5.0);
    words.end_line();
    words.end_line();
    let is_binary = match words.expect("ASCII or BINARY")? {
        b"ASCII" => false,
        b"BINARY" => true,
        other => return Err(words.not_a(other, "ASCII or BINARY")),
    };
    let mut reading = Reading { words, is_binary, has_offsets, mesh: Mesh::default(), others: 0 };
    reading.sections()?;
    let mut mesh = reading.mesh;
    mesh.warnings.extend(left_out(reading.others));
    Ok(mesh)
}

/// Adds a cell of a type by VTK's number for it; whether it is of a kind that is read.
pub(super) fn add_cell(mesh: &mut Mesh, kind: i64, corners: &[u32]) -> bool {
    match (kind, corners) {
        (1 | 2, _) => {}
        (3 | 4, _) => mesh.lines.extend(corners.windows(2).map(|pair| [pair[0], pair[1]])),
        (5 | 7 | 9, [_, _, _, ..]) => mesh.faces.push(corners),
        (6, [_, _, _, ..]) => {
            for (index, three) in corners.windows(3).enumerate() {
                let turned = [three[0], three[2], three[1]];
                mesh.faces.push(if index % 2 == 0 { three } else { &turned });
            }
        }
        (8, &[a, b, c, d]) => mesh.faces.push(&[a, b, d, c]),
        (10, &[a, b, c, d]) => mesh.tetrahedra.push([a, b, c, d]),
        _ => return false,
    }
    true
}

/// What to say of so many cells of other kinds.
pub(super) fn left_out(others: u64) -> Option<String> {
    let said = || {
        format!(
            "has {others} cells other than lines, triangles, quads, polygons and tetrahedra, which were left out"
        )
    };
    (others > 0).then(said)
}

impl Reading<'_> {
    fn sections(&mut self) -> Result<()> {
        let mut cells = Cells::default();
        while let Some(section) = self.words.next() {
            match section {
                b"DATASET" => match self.words.expect("a kind of data")? {
                    b"POLYDATA" | b"UNSTRUCTURED_GRID" => {}
                    other => {
                        let sentence =
                            format!("is a {}, and POLYDATA and UNSTRUCTURED_GRID are read", quoted(other));
                        return Err(self.words.error(Code::Unsupported, sentence));
                    }
                },
                b"POINTS" => self.points()?,
                b"LINES" => {
                    let lines = self.cells()?;
                    for line in lines.iter() {
                        self.mesh.lines.extend(line.windows(2).map(|pair| [pair[0], pair[1]]));
                    }
                }
                b"POLYGONS" => {
                    let polygons = self.cells()?;
                    polygons.iter().for_each(|polygon| self.add(7, polygon));
                }
                b"TRIANGLE_STRIPS" => {
                    let strips = self.cells()?;
                    strips.iter().for_each(|strip| self.add(6, strip));
                }
                b"VERTICES" => drop(self.cells()?),
                b"CELLS" => cells = self.cells()?,
                b"CELL_TYPES" => {
                    let count: u64 = self.words.integer("a count")?;
                    if count != cells.ends.len() as u64 {
                        let sentence = format!("has {} cells and the types of {count}", cells.ends.len());
                        return Err(self.words.error(Code::Conflict, sentence));
                    }
                    let kinds = self.integers(cells.ends.len(), 4)?;
                    let cells = std::mem::take(&mut cells);
                    kinds.iter().zip(cells.iter()).for_each(|(&kind, cell)| self.add(kind, cell));
                }
                // All geometry comes before these.
                b"POINT_DATA" | b"CELL_DATA" => break,
                b"FIELD" | b"METADATA" => {
                    let sentence = format!("has {} before its geometry, which is not read", quoted(section));
                    return Err(self.words.error(Code::Unsupported, sentence));
                }
                other => return Err(self.words.not_a(other, "a section such as POINTS or CELLS")),
            }
        }
        match cells.ends.len() {
            0 => Ok(()),
            count => {
                let sentence = format!("has {count} cells and the types of none: it is cut short");
                Err(self.words.error(Code::Syntax, sentence))
            }
        }
    }

    /// A cell of a type by its number.
    fn add(&mut self, kind: i64, corners: &[u32]) {
        self.others += u64::from(!add_cell(&mut self.mesh, kind, corners));
    }

    fn points(&mut self) -> Result<()> {
        let count: u64 = self.words.integer("a count")?;
        let kind = self.words.expect("float or double")?;
        let width = match kind {
            b"float" => 4,
            b"double" => 8,
            other => return Err(self.words.not_a(other, "float or double")),
        };
        let values = self.numbers(
            count,
            3,
            width,
            |bytes| {
                if width == 4 { bytes.f32().map(f64::from) } else { bytes.f64() }
            },
            |words| words.float("a coordinate"),
        )?;
        if let Some(place) = values.chunks_exact(3).position(|place| !place.iter().all(|x| x.is_finite())) {
            let sentence = format!("has a coordinate of point {place} that is not a number");
            return Err(self.words.error(Code::OutOfRange, sentence));
        }
        self.mesh.positions = values.chunks_exact(3).map(DVec3::from_slice).collect();
        Ok(())
    }

    fn cells(&mut self) -> Result<Cells> {
        let [first, second]: [u64; 2] = [self.words.integer("a count")?, self.words.integer("a count")?];
        let mut cells = Cells::default();
        let point = |value: i64| {
            u32::try_from(value).map_err(|_| {
                Error::new(Code::NotFound, format!("names point {value}, and points have numbers from 0 on"))
            })
        };
        if self.has_offsets {
            let offsets = self.named(b"OFFSETS", first)?;
            let points = self.named(b"CONNECTIVITY", second)?;
            for pair in offsets.windows(2) {
                let end = usize::try_from(pair[1]).unwrap_or(usize::MAX);
                if pair[0] > pair[1] || end > points.len() {
                    return Err(self
                        .words
                        .error(Code::Conflict, "has offsets that run backwards or beyond the points"));
                }
                cells.ends.push(end);
            }
            if offsets.first().is_some_and(|first| *first != 0) {
                return Err(self.words.error(Code::Conflict, "has offsets that do not begin with 0"));
            }
            let points: Result<Vec<u32>> = points.into_iter().map(point).collect();
            cells.points = points.map_err(|error| error.at_line(self.words.line(), 1))?;
            return Ok(cells);
        }
        let all = self.checked(second, 4)?;
        let mut values = self.integers(all, 4)?.into_iter();
        while let Some(count) = values.next() {
            let count = usize::try_from(count).unwrap_or(usize::MAX);
            if count > values.len() {
                return Err(self
                    .words
                    .error(Code::Conflict, "has a cell with more points than the section has numbers"));
            }
            for value in values.by_ref().take(count) {
                cells.points.push(point(value).map_err(|error| error.at_line(self.words.line(), 1))?);
            }
            cells.ends.push(cells.points.len());
        }
        if cells.ends.len() as u64 != first {
            let sentence = format!("says that it has {first} cells, and has {}", cells.ends.len());
            return Err(self.words.error(Code::Conflict, sentence));
        }
        Ok(cells)
    }

    /// Whole numbers after a name and their type.
    fn named(&mut self, name: &[u8], count: u64) -> Result<Vec<i64>> {
        let found = self.words.expect("OFFSETS or CONNECTIVITY")?;
        if found != name {
            return Err(self.words.not_a(found, &quoted(name)));
        }
        let width = match self.words.expect("a type")? {
            b"vtktypeint64" => 8,
            b"vtktypeint32" => 4,
            other => return Err(self.words.not_a(other, "vtktypeint64 or vtktypeint32")),
        };
        let count = self.checked(count, if self.is_binary { width } else { 1 })?;
        self.integers(count, width)
    }

    /// A count that the rest of the file can bear out.
    fn checked(&self, count: u64, width: u64) -> Result<usize> {
        let least = if self.is_binary { width } else { 1 };
        Bytes::new(self.words.rest(), Order::Big)
            .check_count(count, least, "numbers")
            .map_err(|error| error.at_line(self.words.line(), 1))
    }

    fn integers(&mut self, count: usize, width: u64) -> Result<Vec<i64>> {
        self.numbers(
            count as u64,
            1,
            width,
            |bytes| if width == 4 { bytes.i32().map(i64::from) } else { bytes.i64() },
            |words| words.integer("a whole number"),
        )
    }

    /// `count` times `each` numbers.
    fn numbers<T>(
        &mut self,
        count: u64,
        each: u64,
        width: u64,
        binary: impl Fn(&mut Bytes<'_>) -> Result<T>,
        text: impl Fn(&mut Words<'_>) -> Result<T>,
    ) -> Result<Vec<T>> {
        let count = self.checked(count.saturating_mul(each), width)?;
        let mut values = Vec::with_capacity(count);
        if self.is_binary {
            self.words.end_line();
            let mut bytes = Bytes::new(self.words.rest(), Order::Big);
            for _ in 0..count {
                values.push(binary(&mut bytes)?);
            }
            self.words = Words::new(bytes.rest(), self.words.line());
        } else {
            for _ in 0..count {
                values.push(text(&mut self.words)?);
            }
            self.mesh.warnings.extend(self.words.maybe_cut());
        }
        Ok(values)
    }
}
