//! One `.vtp` file for each frame: a header in XML, and behind it the arrays as they are in memory.
//!
//! The header is the same for every frame, as are the lengths of all arrays. Each array is preceded by its length in
//! bytes (UInt64), and the header says at which offset it begins.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

use sprung::force::FORCES;
use sprung::{Code, DVec3, Error, Model, Result, SpringReading, Vec3};

use super::faces::Face;
use super::numbers::{little, write_all};
use super::sequence::Sequence;
use super::{Frame, Geometry, RunInfo, Written};
use crate::pack::{Pack, Unpack};

const TAIL: &[u8] = b"\n</AppendedData>\n</VTKFile>\n";

/// A sequence of `.vtp` files.
pub struct Layer {
    files: Sequence,
    model: Arc<Model>,
    geometry: Geometry,
    header: String,
    normals: Vec<Vec3>,
    /// Index of the body of each vertex.
    body: Vec<i32>,
    mass: Vec<f32>,
}

/// What an array holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Content {
    Time,
    Positions,
    Velocities,
    Normals,
    Forces,
    Masses,
    Fixed,
    Bodies,
    Points,
    Strains,
    Tensions,
    /// Corners of cells of one kind, and where each cell's end.
    Corners(Cells),
    Ends(Cells),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cells {
    Verts,
    Lines,
    Polys,
}

impl Cells {
    /// How many corners they have together.
    fn corners(self, geometry: &Geometry) -> usize {
        match self {
            Self::Verts => self.count(geometry),
            Self::Lines => 2 * self.count(geometry),
            Self::Polys => geometry.corner_count(),
        }
    }

    /// How many there are. Points are cells of their own only where nothing else would show them.
    fn count(self, geometry: &Geometry) -> usize {
        let (lines, polys) = (geometry.lines().len(), geometry.face_count());
        match self {
            Self::Verts if lines + polys == 0 => geometry.vertex_count(),
            Self::Verts => 0,
            Self::Lines => lines,
            Self::Polys => polys,
        }
    }
}

impl Content {
    /// Name, type, components and their size.
    fn layout(self) -> (&'static str, &'static str, usize, usize) {
        match self {
            Self::Time => ("TimeValue", "Float64", 1, 8),
            Self::Positions => ("Points", "Float32", 3, 4),
            Self::Velocities => ("velocity", "Float32", 3, 4),
            Self::Normals => ("normal", "Float32", 3, 4),
            Self::Forces => ("force", "Float32", 3, 4),
            Self::Masses => ("mass", "Float32", 1, 4),
            Self::Fixed => ("fixed", "UInt8", 1, 1),
            Self::Bodies => ("body", "Int32", 1, 4),
            Self::Points => ("point", "Int32", 1, 4),
            Self::Strains => ("strain", "Float32", 1, 4),
            Self::Tensions => ("tension", "Float32", 1, 4),
            Self::Corners(_) => ("connectivity", "Int32", 1, 4),
            Self::Ends(_) => ("offsets", "Int32", 1, 4),
        }
    }

    fn tuples(self, geometry: &Geometry) -> usize {
        match self {
            Self::Time => 1,
            Self::Strains | Self::Tensions => geometry.lines().len(),
            Self::Corners(cells) => cells.corners(geometry),
            Self::Ends(cells) => cells.count(geometry),
            _ => geometry.vertex_count(),
        }
    }

    fn bytes(self, geometry: &Geometry) -> usize {
        let (_, _, components, size) = self.layout();
        self.tuples(geometry) * components * size
    }
}

/// The elements of a piece, each with its arrays: those of a surface or of points, in the order of the file.
fn elements(geometry: &Geometry) -> Vec<(&'static str, Vec<Content>)> {
    use Content::{
        Bodies, Corners, Ends, Fixed, Forces, Masses, Normals, Points, Positions, Strains, Tensions,
        Velocities,
    };
    let is_surface = geometry.triangle_count() > 0;
    let of_points = if is_surface {
        vec![Velocities, Normals, Bodies, Points]
    } else {
        vec![Velocities, Forces, Masses, Fixed, Bodies, Points]
    };
    let of_cells = if geometry.lines().is_empty() { vec![] } else { vec![Strains, Tensions] };
    let cells = |cells| vec![Corners(cells), Ends(cells)];
    vec![
        ("PointData", of_points),
        ("CellData", of_cells),
        ("Points", vec![Positions]),
        ("Verts", cells(Cells::Verts)),
        ("Lines", cells(Cells::Lines)),
        ("Polys", cells(Cells::Polys)),
    ]
}

/// All arrays, in the order in which they lie in the file.
fn arrays(geometry: &Geometry) -> Vec<Content> {
    let of_piece = elements(geometry).into_iter().flat_map(|(_, arrays)| arrays);
    std::iter::once(Content::Time).chain(of_piece).collect()
}

fn header(geometry: &Geometry) -> String {
    let mut offset = 0;
    let mut array = |content: Content| {
        let (name, kind, components, _) = content.layout();
        let here = offset;
        offset += 8 + content.bytes(geometry);
        let tuples = if content == Content::Time { " NumberOfTuples=\"1\"" } else { "" };
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\"{tuples} \
             format=\"appended\" offset=\"{here}\"/>\n"
        )
    };
    let mut text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" \
                    header_type=\"UInt64\">\n<PolyData>\n"
            .to_owned();
    let _ = write!(text, "<FieldData>\n{}</FieldData>\n", array(Content::Time));
    let [verts, lines, polys] = [Cells::Verts, Cells::Lines, Cells::Polys].map(|cells| cells.count(geometry));
    let _ = writeln!(
        text,
        "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{verts}\" NumberOfLines=\"{lines}\" NumberOfStrips=\"0\" \
         NumberOfPolys=\"{polys}\">",
        geometry.vertex_count()
    );
    for (element, contents) in elements(geometry) {
        let _ = writeln!(text, "<{element}>");
        contents.into_iter().for_each(|content| text += &array(content));
        let _ = writeln!(text, "</{element}>");
    }
    text + "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_"
}

impl Layer {
    /// Begins a sequence.
    pub fn begin(path: &Path, run: &RunInfo, geometry: Geometry) -> Result<Self> {
        Ok(Self::of(Sequence::begin(path)?, run, geometry))
    }

    /// Goes on with a sequence where it was marked.
    pub fn resume(path: &Path, run: &RunInfo, geometry: Geometry, memory: &mut Unpack<'_>) -> Result<Self> {
        Ok(Self::of(Sequence::resume(path, memory)?, run, geometry))
    }

    /// What it takes to go on from here.
    pub fn mark(&mut self, memory: &mut Pack) {
        self.files.mark(memory);
    }

    fn of(files: Sequence, run: &RunInfo, geometry: Geometry) -> Self {
        let body = geometry
            .parts()
            .iter()
            .flat_map(|part| part.vertices.clone().map(|_| part.body.map_or(-1, |body| body as i32)))
            .collect();
        let mass = geometry.points().flatten().map(|point| run.params.point_mass[point]).collect();
        let header = header(&geometry);
        let model = run.model.clone();
        Self { files, model, geometry, header, normals: Vec::new(), body, mass }
    }

    /// Refuses more corners than the 32 bits of a file's indices can count.
    ///
    /// # Errors
    /// [`Code::TooLarge`].
    pub fn check(geometry: &Geometry) -> Result<()> {
        let corners = geometry.vertex_count().max(geometry.corner_count()).max(2 * geometry.lines().len());
        if corners <= i32::MAX as usize {
            return Ok(());
        }
        let sentence = format!("has {corners} corners of springs or faces, and {} are allowed", i32::MAX);
        Err(Error::new(Code::TooLarge, sentence))
    }

    /// The size of every file.
    pub fn bytes(geometry: &Geometry) -> u64 {
        let arrays: usize = arrays(geometry).into_iter().map(|content| 8 + content.bytes(geometry)).sum();
        (header(geometry).len() + arrays + TAIL.len()) as u64
    }

    /// The name of the layer.
    pub fn name(&self) -> &str {
        self.files.path().file_stem().and_then(|stem| stem.to_str()).unwrap_or_default()
    }

    /// Writes a frame and tells its size.
    pub fn write(&mut self, frame: &Frame<'_>) -> Result<u64> {
        self.geometry.take(frame);
        if self.geometry.triangle_count() > 0 {
            self.geometry.normals(&mut self.normals);
        }
        let Self { files, model, geometry, header, normals, body, mass } = self;
        let moment = Moment { model, geometry, frame, normals, body, mass };
        files.write(frame.index, |out| {
            out.write_all(header.as_bytes())?;
            for content in arrays(geometry) {
                out.write_all(&(content.bytes(geometry) as u64).to_le_bytes())?;
                moment.write(out, content)?;
            }
            out.write_all(TAIL)
        })
    }

    /// Removes the file that was written last.
    pub fn take_back(&mut self, bytes: u64) {
        self.files.take_back(bytes);
    }

    /// Ends the sequence.
    pub fn finish(self) -> Result<Written> {
        self.files.finish()
    }
}

/// A frame and all that its arrays are made of.
struct Moment<'a> {
    model: &'a Model,
    geometry: &'a Geometry,
    frame: &'a Frame<'a>,
    normals: &'a [Vec3],
    body: &'a [i32],
    mass: &'a [f32],
}

impl Moment<'_> {
    fn write(&self, out: &mut impl Write, content: Content) -> io::Result<()> {
        let Self { geometry, frame, .. } = *self;
        match content {
            Content::Time => out.write_all(&frame.snapshot.time.to_le_bytes()),
            Content::Positions => vectors(out, geometry.positions()),
            Content::Velocities => vectors(out, geometry.velocities()),
            Content::Normals => vectors(out, self.normals),
            Content::Forces => {
                write_all(out, geometry.points().flatten().map(|point| little(self.force(point))))
            }
            Content::Masses => write_all(out, self.mass.iter().map(|mass| mass.to_le_bytes())),
            Content::Fixed => {
                let points = geometry.points().flatten();
                write_all(out, points.map(|point| [u8::from(frame.params.is_fixed(point))]))
            }
            Content::Bodies => write_all(out, self.body.iter().map(|body| body.to_le_bytes())),
            Content::Points => write_all(out, geometry.points().map(number)),
            Content::Strains => self.of_springs(out, |spring| spring.strain.unwrap_or(f64::NAN)),
            Content::Tensions => self.of_springs(out, |spring| spring.tension),
            Content::Corners(Cells::Verts) => {
                write_all(out, (0..Cells::Verts.count(geometry) as i32).map(i32::to_le_bytes))
            }
            Content::Corners(Cells::Lines) => {
                write_all(out, geometry.lines().iter().flat_map(|line| line.ends).map(u32::to_le_bytes))
            }
            Content::Corners(Cells::Polys) => {
                write_all(out, geometry.faces().flat_map(Face::corners).map(u32::to_le_bytes))
            }
            Content::Ends(Cells::Polys) => {
                let mut end = 0;
                let ends = geometry.faces().map(|face| {
                    end += face.len() as i32;
                    end.to_le_bytes()
                });
                write_all(out, ends)
            }
            Content::Ends(cells) => {
                let count = cells.count(geometry);
                let corners = cells.corners(geometry) / count.max(1);
                write_all(out, (1..=count).map(|cell| ((cell * corners) as i32).to_le_bytes()))
            }
        }
    }

    /// All forces on a point, N, in the file's axes.
    fn force(&self, point: usize) -> Vec3 {
        let Frame { snapshot, params, .. } = *self.frame;
        let forces = FORCES.iter().map(|force| (force.at)(self.model, params, snapshot.into(), point));
        self.geometry.turned(forces.sum::<DVec3>().as_vec3())
    }

    fn of_springs(&self, out: &mut impl Write, value: impl Fn(SpringReading) -> f64) -> io::Result<()> {
        let Frame { snapshot, params, .. } = *self.frame;
        let read = |spring| SpringReading::of(self.model, params, snapshot, spring).map_or(f64::NAN, &value);
        write_all(out, self.geometry.lines().iter().map(|line| (read(line.spring) as f32).to_le_bytes()))
    }
}

/// The number of a vertex's point; −1 for none.
pub(super) fn number(point: Option<usize>) -> [u8; 4] {
    point.map_or(-1, |point| point as i32).to_le_bytes()
}

fn vectors(out: &mut impl Write, vectors: &[Vec3]) -> io::Result<()> {
    write_all(out, vectors.iter().map(|&v| little(v)))
}
