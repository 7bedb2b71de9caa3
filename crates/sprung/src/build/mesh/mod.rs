//! Meshes in: what a mesh file holds, and the three kinds of bodies that are made of it.
//!
//! The engine reads no files. A [`Mesh`] is filled by whoever does; [`cloth`], [`soft_body`] and [`net`] turn it into the
//! points, masses, springs and surface of a [`MeshBody`].

mod cloth;
mod fill;
mod inside;
mod isotropy;
mod net;
mod patches;
mod soft;
mod weld;

use glam::DVec3;

use crate::error::{Code, Error, Result};
use crate::model::{SurfaceKind, WeightedVertex};

pub use cloth::{ClothMaterial, cloth};
pub use net::{NetMaterial, net};
pub(crate) use soft::soft_body_within;
pub use soft::{MOST_CELLS, SoftMaterial, soft_body};
pub use weld::MERGE_SHARE;

/// Vertices that a mesh may have, and likewise corners of faces, lines and tetrahedra.
pub const MOST_VERTICES: usize = 50_000_000;

/// Corners that a face may have to leave as one, in any format; faces of more leave as triangles.
pub const MOST_CORNERS: usize = 255;

/// Largest coordinate of a vertex, in the file's units; larger ones are refused.
const LARGEST: f64 = 1e30;

/// A mesh as a file holds it: vertices in the file's order, and what stands on them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Where each vertex is, in the file's units.
    pub positions: Vec<DVec3>,
    /// The faces: polygons with three corners or more.
    pub faces: Faces,
    /// Lines that belong to no face.
    pub lines: Vec<[u32; 2]>,
    /// Tetrahedra.
    pub tetrahedra: Vec<[u32; 4]>,
    /// Named sets of vertices, in the order of the file.
    pub groups: Vec<MeshGroup>,
    /// Red, green and blue of each vertex, 0 to 1; empty if the file has no colours.
    pub colours: Vec<[f32; 3]>,
    /// What is odd about the file, a sentence each.
    pub warnings: Vec<String>,
}

/// A named set of vertices.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MeshGroup {
    /// Its name.
    pub name: String,
    /// Its vertices, ascending, each once.
    pub vertices: Vec<u32>,
}

/// Polygons, in one list of corners.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faces {
    corners: Vec<u32>,
    /// Where each face's corners end.
    ends: Vec<u32>,
}

impl Faces {
    /// Adds a face with its corners in order.
    pub fn push(&mut self, corners: &[u32]) {
        self.corners.extend_from_slice(corners);
        self.ends.push(self.corners.len() as u32);
    }

    /// How many faces there are.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// How many corners all faces have together.
    pub fn corner_count(&self) -> usize {
        self.corners.len()
    }

    /// The corners of each face.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.corners[start as usize..end as usize])
    }

    /// Every face as a fan of triangles around its first corner.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let fans =
            self.iter().flat_map(|face| face.windows(2).skip(1).map(|side| [face[0], side[0], side[1]]));
        fans.collect()
    }

    /// How many of those triangles each face is; none at all if every face is a triangle. A face of more than
    /// [`MOST_CORNERS`] corners counts as triangles.
    pub fn fans(&self) -> Vec<u32> {
        if self.iter().all(|face| face.len() <= 3) {
            return Vec::new();
        }
        let fan = |face: &[u32]| {
            let triangles = face.len().saturating_sub(2);
            let is_whole = (3..=MOST_CORNERS).contains(&face.len());
            if is_whole {
                std::iter::repeat_n(triangles as u32, 1)
            } else {
                std::iter::repeat_n(1, triangles)
            }
        };
        self.iter().flat_map(fan).collect()
    }

    /// The sides of each face in turn; a side that two faces share comes twice.
    pub fn sides(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        self.iter().flat_map(|face| (0..face.len()).map(|k| [face[k], face[(k + 1) % face.len()]]))
    }
}

impl Mesh {
    /// Checks that coordinates are finite, that all vertices named are there, and that counts fit.
    ///
    /// # Errors
    /// [`Code::OutOfRange`], [`Code::NotFound`], [`Code::Conflict`] or [`Code::TooLarge`], naming the first that is wrong.
    pub fn check(&self) -> Result<()> {
        let counts = [
            ("vertices", self.positions.len()),
            ("corners of faces", self.faces.corner_count()),
            ("lines", self.lines.len()),
            ("tetrahedra", self.tetrahedra.len()),
        ];
        if let Some((what, count)) = counts.into_iter().find(|(_, count)| *count > MOST_VERTICES) {
            let sentence = format!("has {count} {what}, and there may be at most {MOST_VERTICES}");
            return Err(Error::new(Code::TooLarge, sentence));
        }
        if self.positions.is_empty() {
            return Err(Error::new(Code::MissingField, "has no vertices"));
        }
        let bad = |p: &DVec3| p.to_array().iter().any(|x| x.is_nan() || x.abs() > LARGEST);
        if let Some(vertex) = self.positions.iter().position(bad) {
            let place = self.positions[vertex];
            let sentence = format!("puts vertex {vertex} at {place}, and coordinates must be finite numbers");
            return Err(Error::new(Code::OutOfRange, sentence));
        }
        let faces = self.faces.corners.iter();
        let named = faces.chain(self.lines.iter().flatten()).chain(self.tetrahedra.iter().flatten());
        let mut named = named.chain(self.groups.iter().flat_map(|group| &group.vertices));
        if let Some(vertex) = named.find(|&&vertex| vertex as usize >= self.positions.len()) {
            let sentence =
                format!("names vertex {vertex}, and has the vertices 0 to {}", self.positions.len() - 1);
            return Err(Error::new(Code::NotFound, sentence));
        }
        if let Some(face) = self.faces.iter().position(|face| face.len() < 3) {
            let sentence = format!("has a face, number {face}, with fewer than three corners");
            return Err(Error::new(Code::Conflict, sentence));
        }
        if !self.colours.is_empty() && self.colours.len() != self.positions.len() {
            let sentence =
                format!("has {} vertices and {} colours", self.positions.len(), self.colours.len());
            return Err(Error::new(Code::Conflict, sentence));
        }
        Ok(())
    }

    /// The box around all vertices, in the file's units: its smallest and largest coordinates.
    pub(crate) fn extent(&self) -> Option<[DVec3; 2]> {
        weld::extent(self.positions.iter().copied())
    }

    /// The same mesh with all coordinates times `scale`.
    #[must_use]
    pub fn scaled(mut self, scale: f64) -> Self {
        self.positions.iter_mut().for_each(|p| *p *= scale);
        self
    }
}

/// A spring of a body made from a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshSpring {
    /// The two points it joins, the smaller first, as numbers in the body.
    pub ends: [u32; 2],
    /// Stiffness, N/m.
    pub stiffness: f64,
    /// Damping, N·s/m.
    pub damping: f64,
}

/// Points, masses, springs and surface made from a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshBody {
    /// Where the points are, m.
    pub points: Vec<DVec3>,
    /// Their masses, kg; empty where the mesh says nothing about them.
    pub masses: Vec<f64>,
    /// The springs, in the order of their points.
    pub springs: Vec<MeshSpring>,
    /// The surface to draw and export; none where the mesh has none.
    pub surface: Option<MeshSurface>,
    /// For each vertex of the mesh the point that it lies on, or the one that carries most of it.
    pub point_of_vertex: Vec<u32>,
    /// What is odd about the mesh, a sentence each.
    pub warnings: Vec<String>,
}

/// The artist's surface on a body made from a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshSurface {
    /// Open sheet or closed skin.
    pub kind: SurfaceKind,
    /// The mesh's vertices, in its order, by points of the body; `None` where vertices and points are the same.
    pub vertices: Option<Vec<WeightedVertex>>,
    /// Triangles over the mesh's vertices.
    pub triangles: Vec<[u32; 3]>,
    /// How many of them each face of the mesh is, as in [`Faces::fans`].
    pub fans: Vec<u32>,
    /// Whether it is what is meant to be seen of the body; of a net that is its springs.
    pub stands_for_body: bool,
}

/// `12 vertices`, `1 vertex`.
fn counted(count: usize, one: &str, many: &str) -> String {
    if count == 1 { format!("1 {one}") } else { format!("{count} {many}") }
}

/// Adds up what springs side by side have; in the order of their ends, and of entries for the same ends in the order given.
fn summed(mut entries: Vec<([u32; 2], f64)>, damping_time: f64) -> Vec<MeshSpring> {
    entries.sort_by_key(|(ends, _)| *ends);
    let mut springs: Vec<MeshSpring> = Vec::new();
    for (ends, stiffness) in entries {
        match springs.last_mut() {
            Some(last) if last.ends == ends => last.stiffness += stiffness,
            _ => springs.push(MeshSpring { ends, stiffness, damping: 0.0 }),
        }
    }
    // The damping of a Kelvin-Voigt solid: each spring's is its stiffness times one time for all.
    springs.iter_mut().for_each(|spring| spring.damping = spring.stiffness * damping_time);
    springs
}
