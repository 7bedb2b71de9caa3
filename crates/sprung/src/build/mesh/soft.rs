//! A soft body from a closed mesh: filled with points at a spacing, as stiff as its material at any spacing.

use glam::DVec3;

use super::fill::Filling;
use super::inside::{Cells, Rule, shares};
use super::weld::{extent, weld};
use super::{Mesh, MeshBody, MeshSurface, counted};
use crate::build::DEFAULT_MAX_SPRINGS;
use crate::error::{Code, Error, Result};
use crate::model::SurfaceKind;

/// Cells that the lattice around a mesh may have, filled or not.
pub const MOST_CELLS: usize = 1 << 24;

/// What a soft body is made of, and how finely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftMaterial {
    /// Distance of neighbouring points, m.
    pub spacing: f64,
    /// Mass of a cubic metre, kg/m³.
    pub density: f64,
    /// Young's modulus, Pa. Poisson's ratio is 1/4, as it is in every solid of such springs.
    pub stiffness: f64,
    /// Damping time τ, s: each spring's damping is its stiffness times τ.
    pub damping: f64,
    /// Vertices closer than this are one, m; `None`: 10⁻⁶ of the mesh's diagonal.
    pub merge: Option<f64>,
}

/// Fills a closed mesh with points and ties its surface to them.
///
/// The points are the corners of all cubic cells that meet the inside, so the outermost lie up to a spacing outside of the
/// surface; the lattice begins at the smallest coordinates of the mesh. How masses and springs follow from density and Young's
/// modulus is told in the source beside this, with its derivation.
///
/// # Errors
/// As [`Mesh::check`]; [`Code::Conflict`] for a mesh that is not closed or has no volume, [`Code::TooLarge`] for a spacing too
/// small to be filled with [`MOST_CELLS`] cells, or with [`DEFAULT_MAX_SPRINGS`] springs.
pub fn soft_body(mesh: &Mesh, material: &SoftMaterial) -> Result<MeshBody> {
    soft_body_within(mesh, material, DEFAULT_MAX_SPRINGS as u64)
}

/// As [`soft_body`], with another limit on springs.
pub(crate) fn soft_body_within(mesh: &Mesh, material: &SoftMaterial, most_springs: u64) -> Result<MeshBody> {
    mesh.check()?;
    let welded = weld(mesh, material.merge);
    let mut warnings = mesh.warnings.clone();
    warnings.extend(welded.warning);
    let points = welded.points;
    let (mut surface, fans) = (mesh.faces.triangles(), mesh.faces.fans());
    let at_points = |corners: &[u32; 3]| corners.map(|vertex| welded.point_of[vertex as usize]);
    let triangles: Vec<[u32; 3]> =
        surface.iter().map(at_points).filter(|[a, b, c]| a != b && b != c && c != a).collect();
    let on_surface = || triangles.iter().flatten().map(|&point| points[point as usize]);
    let Some([low, high]) = extent(on_surface()) else {
        return Err(Error::new(Code::Conflict, "has no faces, and a soft body needs a closed surface"));
    };

    let rule = closed(&triangles, &points)?;
    if rule == Rule::Parity {
        let sentence = "some faces are turned the other way than their neighbours; inside is what lies behind an odd number of faces";
        warnings.push(sentence.to_owned());
    }
    let cells = lattice(low, high, material.spacing)?;
    let shares = shares(&points, &triangles, &cells, rule)?;
    let cube = cells.spacing * cells.spacing * cells.spacing;
    let sampled = cube * shares.iter().map(|&share| f64::from(share)).sum::<f64>();
    // Gauss: exact, where the surface neither overlaps itself nor is turned in parts.
    let signed: f64 = triangles
        .iter()
        .map(|corners| {
            let [a, b, c] = corners.map(|point| points[point as usize] - low);
            a.dot(b.cross(c)) / 6.0
        })
        .sum();
    let agree = (signed.abs() - sampled).abs() < 0.05 * sampled;
    let volume = if rule == Rule::Winding && agree { signed.abs() } else { sampled };
    if volume <= 0.0 {
        let sentence = format!("encloses nothing that a spacing of {} m would find", material.spacing);
        return Err(Error::new(Code::Conflict, sentence).with_fix("make the spacing smaller"));
    }
    if rule == Rule::Winding && signed < 0.0 {
        warnings.push("its faces are turned inwards, and were turned around".to_owned());
        surface.iter_mut().for_each(|corners| corners.swap(1, 2));
        // The triangles of a face turned around are a fan from the other end.
        let mut rest = &mut surface[..];
        fans.iter().filter_map(|&fan| rest.split_off_mut(..fan as usize)).for_each(<[_]>::reverse);
    }

    let filling = Filling::new(cells, shares, on_surface(), most_springs)?;
    if filling.volume() > 2.0 * volume {
        warnings.push(format!(
            "most cells of {} m are hardly filled, and its motion will be coarse; a smaller spacing would do better",
            material.spacing
        ));
    }
    let vertices: Vec<_> = mesh.positions.iter().map(|&place| filling.embed(place)).collect();
    let heaviest =
        |weights: [f32; 4]| (0..4).max_by(|&a, &b| weights[a].total_cmp(&weights[b]).then(b.cmp(&a)));
    let point_of_vertex =
        vertices.iter().map(|vertex| vertex.points[heaviest(vertex.weights).unwrap_or(0)]).collect();
    Ok(MeshBody {
        masses: filling.masses(material.density, volume),
        springs: filling.springs(material.stiffness, volume, material.damping, most_springs)?,
        surface: Some(MeshSurface {
            kind: SurfaceKind::Skin,
            vertices: Some(vertices),
            triangles: surface,
            fans,
            stands_for_body: true,
        }),
        point_of_vertex,
        points: filling.points,
        warnings,
    })
}

/// Whether every edge has an even number of faces, and whether neighbours are turned alike.
fn closed(triangles: &[[u32; 3]], points: &[DVec3]) -> Result<Rule> {
    let mut sides: Vec<([u32; 2], bool)> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .map(|[a, b]| ([a.min(b), a.max(b)], a < b))
        .collect();
    sides.sort_unstable();
    let (mut open, mut first_open, mut alike) = (0, None, true);
    for edge in sides.chunk_by(|one, other| one.0 == other.0) {
        if edge.len() % 2 != 0 {
            open += 1;
            first_open.get_or_insert(edge[0].0);
        }
        alike &= 2 * edge.iter().filter(|(_, forward)| *forward).count() == edge.len();
    }
    if let Some([a, b]) = first_open {
        let [a, b] = [a, b].map(|point| points[point as usize]);
        let which = counted(open, "edge has a face", "edges have faces");
        let sentence = format!("is not closed: {which} on one side only, one of them from {a} to {b} m");
        return Err(Error::new(Code::Conflict, sentence).with_fix("close its holes, or make a cloth of it"));
    }
    Ok(if alike { Rule::Winding } else { Rule::Parity })
}

/// Cells around a box, from its smallest coordinates on.
fn lattice(low: DVec3, high: DVec3, spacing: f64) -> Result<Cells> {
    // A whole number of cells is that in spite of rounding.
    let counts = ((high - low) / spacing - 1e-6).ceil().max(DVec3::ONE).to_array();
    let all: f64 = counts.iter().product();
    if all.is_nan() || all > MOST_CELLS as f64 {
        let size = high - low;
        let sentence = format!(
            "is {spacing} m, and the mesh, {size} m in size, may have at most {MOST_CELLS} cells of that"
        );
        return Err(Error::new(Code::TooLarge, sentence)
            .with_fix("make the spacing larger")
            .at_field("spacing"));
    }
    Ok(Cells { origin: low, spacing, counts: counts.map(|count| count as usize) })
}

#[cfg(test)]
#[path = "soft_tests.rs"]
mod tests;
