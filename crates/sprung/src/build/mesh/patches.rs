//! Faces as patches of cloth: triangles, and what has two diagonals: quads, and pairs of triangles that make one.

use glam::DVec3;

use super::Mesh;
use super::isotropy::{SEGMENTS, shares};

/// A triangle whose area is below this share of its longest side's square has none.
const FLAT: f64 = 1e-10;

/// Two triangles are a patch only if they lie in one plane so nearly: the cosine of the angle between them, 25°.
const LEVEL: f64 = 0.9;

/// A triangle that stands for cloth.
pub(super) struct Piece {
    pub corners: [u32; 3],
    /// The patch that it is a part of.
    pub patch: usize,
    /// 1, or ½ for the triangles of a patch that is divided both ways.
    pub weight: f64,
    /// m².
    pub area: f64,
}

/// A triangle, or four corners divided both ways: its segments stretch together.
pub(super) struct Patch {
    /// m².
    pub area: f64,
    /// The segments and their S = k·ℓ²/(E·h), m².
    pub segments: Vec<([u32; 2], f64)>,
    /// The share of its stretching that springs for bending take over.
    pub taken: f64,
}

/// All patches of a mesh, and the triangles that they are made of.
#[derive(Default)]
pub(super) struct Patches {
    pub pieces: Vec<Piece>,
    pub patches: Vec<Patch>,
    /// Triangles without an area, which are left out.
    pub flat: usize,
}

impl Patches {
    /// From the faces of a mesh whose vertices became points.
    pub fn new(mesh: &Mesh, point_of: &[u32], points: &[DVec3]) -> Self {
        let mut patches = Self::default();
        let (mut triangles, mut corners) = (Vec::new(), Vec::new());
        for vertices in mesh.faces.iter() {
            corners.clear();
            corners.extend(vertices.iter().map(|&vertex| point_of[vertex as usize]));
            match corners[..] {
                [a, b, c, d] if is_convex(points, [a, b, c, d]) => patches.add_quad(points, [a, b, c, d]),
                _ => triangles.extend(corners.windows(2).skip(1).map(|side| [corners[0], side[0], side[1]])),
            }
        }
        let all = triangles.len();
        triangles.retain(|&corners| has_area(points, corners));
        patches.flat = all - triangles.len();
        let mut paired = vec![false; triangles.len()];
        for (quad, both) in pairs(points, &triangles) {
            both.iter().for_each(|&triangle| paired[triangle] = true);
            patches.add_quad(points, quad);
        }
        for (corners, _) in triangles.into_iter().zip(paired).filter(|(_, paired)| !paired) {
            patches.add_triangle(points, corners);
        }
        patches
    }

    fn add_triangle(&mut self, points: &[DVec3], corners: [u32; 3]) {
        let area = 0.5 * normal(points, corners).length();
        let [a, b, c] = corners;
        let segments = [[a, b], [b, c], [c, a]].map(|[i, j]| ([i.min(j), i.max(j)], area)).to_vec();
        self.pieces.push(Piece { corners, patch: self.patches.len(), weight: 1.0, area });
        self.patches.push(Patch { area, segments, taken: 0.0 });
    }

    fn add_quad(&mut self, points: &[DVec3], [a, b, c, d]: [u32; 4]) {
        let corners = [a, b, c, d];
        // Each lacks the corner of its number.
        let triangles = [[b, c, d], [c, d, a], [d, a, b], [a, b, c]];
        let normals = triangles.map(|corners| normal(points, corners));
        let halves = normals.map(|normal| 0.5 * normal.length());
        let all = normals.iter().copied().sum();
        let found = shares(corners.map(|point| points[point as usize]), all, halves);
        let patch = self.patches.len();
        let pieces = triangles.into_iter().zip(halves);
        self.pieces.extend(pieces.map(|(corners, area)| Piece { corners, patch, weight: 0.5, area }));
        let ends = SEGMENTS.map(|[i, j]| [corners[i].min(corners[j]), corners[i].max(corners[j])]);
        let segments = ends.into_iter().zip(found).collect();
        self.patches.push(Patch { area: 0.5 * halves.iter().sum::<f64>(), segments, taken: 0.0 });
    }
}

/// Twice the area of a triangle, along its normal.
fn normal(points: &[DVec3], corners: [u32; 3]) -> DVec3 {
    let [a, b, c] = corners.map(|point| points[point as usize]);
    (b - a).cross(c - a)
}

fn has_area(points: &[DVec3], corners: [u32; 3]) -> bool {
    let [a, b, c] = corners.map(|point| points[point as usize]);
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    0.5 * normal(points, corners).length() > FLAT * longest
}

/// Whether both diagonals of a quad lie inside it.
fn is_convex(points: &[DVec3], [a, b, c, d]: [u32; 4]) -> bool {
    let triangles = [[a, b, c], [a, c, d], [b, c, d], [b, d, a]];
    let normals = triangles.map(|corners| normal(points, corners));
    let all: DVec3 = normals.iter().copied().sum();
    let upright = normals.iter().all(|one| one.dot(all) > FLAT * all.length_squared());
    upright && triangles.iter().all(|&corners| has_area(points, corners))
}

/// Triangles whose longest side is the same, each with one other at most: the four corners around both, and which they are.
fn pairs(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<([u32; 4], [usize; 2])> {
    // The longest side of each and the corner opposite; of equally long ones that of the smaller numbers.
    let mut longest: Vec<([u32; 2], usize, u32)> = triangles
        .iter()
        .enumerate()
        .map(|(index, &[a, b, c])| {
            let sides = [[a, b, c], [b, c, a], [c, a, b]].map(|[i, j, k]| ([i.min(j), i.max(j)], k));
            let squared =
                |ends: [u32; 2]| points[ends[0] as usize].distance_squared(points[ends[1] as usize]);
            let chosen = sides.into_iter().max_by(|(one, _), (other, _)| {
                squared(*one).total_cmp(&squared(*other)).then(other.cmp(one))
            });
            let (ends, opposite) = chosen.unwrap_or_default();
            (ends, index, opposite)
        })
        .collect();
    longest.sort_unstable();
    let shared = longest.chunk_by(|one, other| one.0 == other.0);
    let quads = shared.filter_map(|both| match *both {
        [([a, b], first, c), (_, second, d)] if c != d => {
            let [one, other] = [normal(points, [a, c, b]), normal(points, [b, d, a])];
            let level = one.dot(other) > LEVEL * one.length() * other.length();
            (level && is_convex(points, [a, c, b, d])).then_some(([a, c, b, d], [first, second]))
        }
        _ => None,
    });
    quads.collect()
}
