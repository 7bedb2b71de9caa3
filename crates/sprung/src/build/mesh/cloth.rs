//! Cloth from a mesh: a material in newtons per metre becomes springs, so that a finer mesh of the same cloth hangs the same.
//!
//! *Stretching.* Van Gelder (1998): a spring along an edge of length ℓ has the stiffness k = E·h·ΣA/ℓ², summed over the
//! triangles at the edge; E·h (N/m) is the membrane's Young modulus times its thickness. Under a uniform strain ε a
//! triangle of area A then holds the energy ½·E·h·A·Σ(nᵀεn)² over its three directions n. For ε = e·I that is ½·E·h·A·3e², in
//! triangles of any shape; in equilateral ones, and in the mean over triangles turned in all directions, it is that of the
//! isotropic membrane with Poisson's ratio 1/3 (both Lamé constants 3/8·E·h). Quads, and pairs of triangles that have their
//! longest side in common, have two diagonals, and with these it can be so, exactly or nearly: see `isotropy.rs`.
//!
//! *Bending.* A hinge with the energy ½·k·θ², k = B·ℓ²/(A₁ + A₂), bends like a plate of stiffness B (N·m): exactly so about any
//! axis for equilateral triangles (Seung and Nelson 1988), and about a grid's axes for squares. Springs pull along lines
//! only, so here the hinge is a spring between the corners opposite the edge, at heights h₁ and h₂, with L between them. A hinge
//! angle θ brings them nearer by δ = h₁h₂θ²/(2L). The energy of a spring goes with δ², and so with θ⁴: it can equal the plate's
//! at one curvature. That is 1/R, R being `bending_radius`, where θ = (h₁ + h₂)/(2R):
//! k = 16·B·R²·ℓ²L²/((A₁ + A₂)·h₁²h₂²·(h₁ + h₂)²). Cloth that is bent less resists less than a plate, cloth that is bent more
//! resists more, whatever the mesh. Such a spring also stretches in the plane; that share is taken from the edges.

use glam::DVec3;

use super::patches::{Patch, Patches};
use super::weld::{extent, weld};
use super::{Mesh, MeshBody, MeshSurface, counted, summed};
use crate::error::{Code, Error, Result};
use crate::model::{SurfaceKind, WeightedVertex};

/// The part of the cloth's stretching stiffness that springs for bending may take over. More would leave too little for
/// the edges where triangles are far from equilateral.
const MOST_SHARE: f64 = 0.25;

/// Faces at an edge between which there may be springs for bending: each is joined to each, and a mesh whose faces all meet in
/// one edge would have as many springs as pairs of faces.
const MOST_AROUND: usize = 16;

/// What a cloth is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClothMaterial {
    /// Mass of a square metre, kg/m².
    pub density: f64,
    /// Stretching stiffness, N/m: the force that stretches a strip as wide as it is long to double length.
    pub stiffness: f64,
    /// Bending stiffness of a strip one metre wide, N·m.
    pub bending: f64,
    /// Radius at which the cloth has this bending stiffness, m; `None`: a tenth of the mesh's diagonal.
    pub bending_radius: Option<f64>,
    /// Damping time τ, s: each spring's damping is its stiffness times τ.
    pub damping: f64,
    /// Vertices closer than this are one point, m; `None`: 10⁻⁶ of the mesh's diagonal.
    pub merge: Option<f64>,
}

/// One side of a piece.
struct Side {
    ends: [u32; 2],
    opposite: u32,
    piece: usize,
}

/// Makes the points, masses and springs of a cloth.
///
/// # Errors
/// As [`Mesh::check`], and [`Code::Conflict`] for a mesh without any area.
pub fn cloth(mesh: &Mesh, material: &ClothMaterial) -> Result<MeshBody> {
    mesh.check()?;
    let welded = weld(mesh, material.merge);
    let mut warnings = mesh.warnings.clone();
    warnings.extend(welded.warning);
    let points = welded.points;
    let Patches { pieces, mut patches, flat } = Patches::new(mesh, &welded.point_of, &points);
    if pieces.is_empty() {
        return Err(Error::new(Code::Conflict, "has no face with an area, and a cloth is made of them"));
    }
    if flat > 0 {
        warnings.push(format!("{} no area and no springs", counted(flat, "triangle has", "triangles have")));
    }

    let mut sides: Vec<Side> = Vec::with_capacity(3 * pieces.len());
    for (index, piece) in pieces.iter().enumerate() {
        let [a, b, c] = piece.corners;
        for [i, j, opposite] in [[a, b, c], [b, c, a], [c, a, b]] {
            sides.push(Side { ends: [i.min(j), i.max(j)], opposite, piece: index });
        }
    }
    sides.sort_by_key(|side| (side.ends, side.piece));

    // Bending first, as it takes its share of stretching away.
    let mut springs: Vec<([u32; 2], f64)> = Vec::new();
    let diagonal = extent(points.iter().copied()).map_or(0.0, |[low, high]| (high - low).length());
    let radius = material.bending_radius.unwrap_or(0.1 * diagonal);
    let (mut crowded, mut overfull, mut capped) = (0, 0, 0);
    for edge in sides.chunk_by(|one, other| one.ends == other.ends) {
        let mut around: Vec<usize> = edge.iter().map(|side| pieces[side.piece].patch).collect();
        around.sort_unstable();
        around.dedup();
        crowded += usize::from(around.len() > 2);
        if material.bending == 0.0 {
            continue;
        }
        if around.len() > MOST_AROUND {
            overfull += 1;
            continue;
        }
        for (index, one) in edge.iter().enumerate() {
            for other in &edge[index + 1..] {
                let [p, q] = [&pieces[one.piece], &pieces[other.piece]];
                if p.patch == q.patch || one.opposite == other.opposite {
                    continue;
                }
                let hinge =
                    Hinge::new(&points, edge[0].ends, [one.opposite, other.opposite], [p.area, q.area]);
                let wanted = hinge.spring(material.bending, radius);
                let whole = material.stiffness * hinge.area / hinge.across_squared;
                let share = (wanted / whole).min(MOST_SHARE);
                if !(whole > 0.0 && share > 0.0) {
                    continue;
                }
                capped += usize::from(wanted > MOST_SHARE * whole);
                let weight = p.weight * q.weight;
                let ends = [one.opposite.min(other.opposite), one.opposite.max(other.opposite)];
                springs.push((ends, weight * share * whole));
                for piece in [p, q] {
                    let patch = &mut patches[piece.patch];
                    patch.taken += weight * share * piece.area / (3.0 * patch.area);
                }
            }
        }
    }
    // Where many faces meet in one edge, their springs for bending could take more than there is.
    for Patch { segments, taken, .. } in &patches {
        for &(ends, share) in segments {
            let [a, b] = ends.map(|point| points[point as usize]);
            let left = share * (1.0 - taken.min(0.9));
            springs.push((ends, material.stiffness * left / (b - a).length_squared()));
        }
    }

    let mut masses = vec![0.0; points.len()];
    for piece in &pieces {
        let third = material.density * piece.weight * piece.area / 3.0;
        piece.corners.iter().for_each(|&corner| masses[corner as usize] += third);
    }
    let loose = masses.iter().filter(|mass| **mass == 0.0).count();
    if loose > 0 && material.density > 0.0 {
        let which = counted(loose, "vertex has", "vertices have");
        warnings.push(format!("{which} no cloth around and so no mass: fixed in space"));
    }
    if crowded > 0 {
        let mut sentence = format!("{} more than two faces", counted(crowded, "edge has", "edges have"));
        if overfull > 0 {
            let which = counted(overfull, "has", "have");
            sentence += &format!(", and {which} more than {MOST_AROUND}: there the cloth folds freely");
        }
        warnings.push(sentence);
    }
    if capped > 0 {
        warnings.push(format!(
            "{} too small for this bending stiffness, and the cloth bends more easily there; a larger stiffness, a smaller \
             bending or bending_radius, or a coarser mesh would do",
            counted(capped, "pair of triangles is", "pairs of triangles are")
        ));
    }
    let vertices = welded.merged.then(|| welded.point_of.iter().map(|&p| WeightedVertex::on(p)).collect());
    Ok(MeshBody {
        springs: summed(springs, material.damping),
        surface: Some(MeshSurface {
            kind: SurfaceKind::Cloth,
            vertices,
            triangles: mesh.faces.triangles(),
            fans: mesh.faces.fans(),
            stands_for_body: true,
        }),
        points,
        masses,
        point_of_vertex: welded.point_of,
        warnings,
    })
}

/// Two triangles at an edge, laid flat.
struct Hinge {
    edge_squared: f64,
    across_squared: f64,
    heights: [f64; 2],
    /// Of both, m².
    area: f64,
}

impl Hinge {
    fn new(points: &[DVec3], edge: [u32; 2], opposite: [u32; 2], areas: [f64; 2]) -> Self {
        let [a, b] = edge.map(|point| points[point as usize]);
        let [c, d] = opposite.map(|point| points[point as usize]);
        let edge_squared = (b - a).length_squared();
        let length = edge_squared.sqrt();
        Self {
            edge_squared,
            across_squared: (d - c).length_squared(),
            heights: areas.map(|area| 2.0 * area / length),
            area: areas[0] + areas[1],
        }
    }

    /// Stiffness of the spring across that holds the energy of a plate of stiffness `bending` bent to `radius`, N/m.
    fn spring(&self, bending: f64, radius: f64) -> f64 {
        let [h1, h2] = self.heights;
        let bent = h1 * h2 * (h1 + h2);
        let shape = self.edge_squared * self.across_squared / (self.area * bent * bent);
        16.0 * bending * radius * radius * shape
    }
}

#[cfg(test)]
#[path = "cloth_tests.rs"]
mod tests;
