//! A net: the mesh's own edges as springs, each with the same stiffness.

use super::weld::weld;
use super::{Mesh, MeshBody, MeshSpring, MeshSurface, counted};
use crate::error::{Code, Error, Result};
use crate::model::{SurfaceKind, WeightedVertex};

/// What a net is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NetMaterial {
    /// Stiffness of each spring, N/m.
    pub stiffness: f64,
    /// Damping of each spring, N·s/m.
    pub damping: f64,
    /// Vertices closer than this are one point, m; `None`: 10⁻⁶ of the mesh's diagonal.
    pub merge: Option<f64>,
}

/// Makes a spring of every edge: every side of a face (and no diagonal), every line, the six edges of every tetrahedron; each
/// once, in the order of their points. Of tetrahedra the surface is the faces that only one of them has.
///
/// # Errors
/// As [`Mesh::check`], and [`Code::Conflict`] for a mesh without edges.
pub fn net(mesh: &Mesh, material: &NetMaterial) -> Result<MeshBody> {
    mesh.check()?;
    let welded = weld(mesh, material.merge);
    let mut warnings = mesh.warnings.clone();
    warnings.extend(welded.warning);

    let tetrahedra = mesh.tetrahedra.iter();
    let six = tetrahedra.flat_map(|&[a, b, c, d]| [[a, b], [a, c], [a, d], [b, c], [b, d], [c, d]]);
    let edges = mesh.faces.sides().chain(mesh.lines.iter().copied()).chain(six);
    let mut ends: Vec<[u32; 2]> = edges
        .map(|edge| edge.map(|vertex| welded.point_of[vertex as usize]))
        .filter(|[a, b]| a != b)
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    ends.sort_unstable();
    ends.dedup();
    if ends.is_empty() {
        return Err(Error::new(Code::Conflict, "has no edges, and a net is made of them"));
    }
    let mut joined = vec![false; welded.points.len()];
    ends.iter().flatten().for_each(|&point| joined[point as usize] = true);
    let alone = joined.iter().filter(|joined| !**joined).count();
    if alone > 0 {
        warnings.push(format!(
            "{} on no edge, and nothing holds them",
            counted(alone, "vertex is", "vertices are")
        ));
    }

    let mut triangles = mesh.faces.triangles();
    let mut kind = SurfaceKind::Cloth;
    if triangles.is_empty() && !mesh.tetrahedra.is_empty() {
        triangles = skin(mesh);
        kind = SurfaceKind::Skin;
    }
    let vertices = welded.merged.then(|| welded.point_of.iter().map(|&p| WeightedVertex::on(p)).collect());
    let surface =
        (!triangles.is_empty()).then_some(MeshSurface { kind, vertices, triangles, stands_for_body: false });
    let spring = |ends| MeshSpring { ends, stiffness: material.stiffness, damping: material.damping };
    Ok(MeshBody {
        points: welded.points,
        masses: Vec::new(),
        springs: ends.into_iter().map(spring).collect(),
        surface,
        point_of_vertex: welded.point_of,
        warnings,
    })
}

/// The faces that only one tetrahedron has, turned outwards.
fn skin(mesh: &Mesh) -> Vec<[u32; 3]> {
    let mut faces: Vec<([u32; 3], [u32; 3])> = Vec::with_capacity(4 * mesh.tetrahedra.len());
    for &[a, b, c, d] in &mesh.tetrahedra {
        let [pa, pb, pc, pd] = [a, b, c, d].map(|vertex| mesh.positions[vertex as usize]);
        let inside_out = (pb - pa).cross(pc - pa).dot(pd - pa) < 0.0;
        for [p, q, r] in [[a, c, b], [a, b, d], [b, c, d], [c, a, d]] {
            let mut key = [p, q, r];
            key.sort_unstable();
            faces.push((key, if inside_out { [p, r, q] } else { [p, q, r] }));
        }
    }
    faces.sort_unstable();
    let single = faces.chunk_by(|one, other| one.0 == other.0).filter(|faces| faces.len() == 1);
    single.map(|faces| faces[0].1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    const MATERIAL: NetMaterial = NetMaterial { stiffness: 10.0, damping: 0.0, merge: None };

    #[test]
    fn a_quad_has_four_edges_and_no_diagonal() {
        let mut mesh =
            Mesh { positions: vec![DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y], ..Mesh::default() };
        mesh.faces.push(&[0, 1, 2, 3]);
        let body = net(&mesh, &MATERIAL).expect("sound");
        let ends: Vec<_> = body.springs.iter().map(|spring| spring.ends).collect();
        assert_eq!(ends, [[0, 1], [0, 3], [1, 2], [2, 3]]);
        assert_eq!(body.surface.expect("it has a face").triangles, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn two_tetrahedra_share_a_face_that_is_not_skin() {
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];
        // The second is written inside out.
        let mesh = Mesh { positions, tetrahedra: vec![[0, 1, 2, 3], [1, 3, 2, 4]], ..Mesh::default() };
        let body = net(&mesh, &MATERIAL).expect("sound");
        assert_eq!(body.springs.len(), 9);
        let surface = body.surface.expect("tetrahedra have a skin");
        // Gauss: a closed surface turned outwards has the volume it encloses, 1/6 and 1/3.
        let volume: f64 = surface
            .triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|vertex| mesh.positions[vertex as usize]);
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        assert_eq!(surface.triangles.len(), 6);
        assert!((volume - 0.5).abs() < 1e-12, "{volume}");
    }
}
