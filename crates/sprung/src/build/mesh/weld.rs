//! Vertices that lie on one another become one point: files repeat them along seams, and some at every corner.

use std::collections::HashMap;

use glam::DVec3;

use super::{Mesh, counted};

/// Vertices nearer than this are merged unless something else is said, as a share of the mesh's diagonal: some twenty times
/// the rounding of float32 coordinates, in which most files are written.
pub const MERGE_SHARE: f64 = 1e-6;

/// Vertices as points.
pub(super) struct Welded {
    /// The points, each at the first vertex that made it, in the order of these.
    pub points: Vec<DVec3>,
    /// The point of each vertex.
    pub point_of: Vec<u32>,
    /// Whether any two vertices share a point.
    pub merged: bool,
    /// What to say of it.
    pub warning: Option<String>,
}

/// Merges vertices no further apart than `tolerance` (m); 0 merges none. Each goes to the first of the earlier points that
/// is near enough, so that the result follows from the order of the file alone.
pub(super) fn weld(mesh: &Mesh, tolerance: Option<f64>) -> Welded {
    let vertices = &mesh.positions;
    let [low, high] = mesh.extent().unwrap_or_default();
    let diagonal = (high - low).length();
    let tolerance = tolerance.unwrap_or(MERGE_SHARE * diagonal);
    // A cell is as wide as the tolerance, so only the cells around a vertex have to be looked through. They are counted from the
    // mesh's own corner: from an origin far away all vertices might lie in the last one that can be numbered. The table is asked,
    // and never gone through: its order does not matter.
    let cell_of = |p: DVec3| ((p - low) / tolerance).floor().to_array().map(|x| x as i64);
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let (mut points, mut point_of) = (Vec::new(), Vec::with_capacity(vertices.len()));
    // With a tolerance of zero, or one below the rounding of the coordinates, there is nothing to find.
    let possible = tolerance > 0.0 && (1e15 * tolerance > diagonal);
    for &vertex in vertices {
        let near = if possible { nearby(&cells, &points, vertex, cell_of(vertex), tolerance) } else { None };
        point_of.push(near.unwrap_or_else(|| {
            let index = points.len() as u32;
            points.push(vertex);
            if possible {
                cells.entry(cell_of(vertex)).or_default().push(index);
            }
            index
        }));
    }
    let merged = points.len() < vertices.len();
    let warning = merged.then(|| {
        let many = counted(vertices.len(), "vertex", "vertices");
        format!(
            "{many} became {}: those closer than {tolerance:.2e} m were merged",
            counted(points.len(), "point", "points")
        )
    });
    Welded { points, point_of, merged, warning }
}

/// The first point near enough to a vertex.
fn nearby(
    cells: &HashMap<[i64; 3], Vec<u32>>,
    points: &[DVec3],
    vertex: DVec3,
    cell: [i64; 3],
    tolerance: f64,
) -> Option<u32> {
    let mut found: Option<u32> = None;
    for offset in 0..27 {
        let around = [offset / 9 - 1, offset / 3 % 3 - 1, offset % 3 - 1];
        let place = [0, 1, 2].map(|axis| cell[axis].saturating_add(around[axis]));
        let near = |&&point: &&u32| (points[point as usize] - vertex).length() <= tolerance;
        let first = cells.get(&place).and_then(|inside| inside.iter().filter(near).min());
        found = found.into_iter().chain(first.copied()).min();
    }
    found
}

/// The box around some places: its smallest and largest coordinates.
pub(super) fn extent(places: impl Iterator<Item = DVec3>) -> Option<[DVec3; 2]> {
    places.map(|p| [p, p]).reduce(|[low, high], [p, _]| [low.min(p), high.max(p)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(places: &[[f64; 3]]) -> Mesh {
        Mesh { positions: places.iter().map(|&p| DVec3::from_array(p)).collect(), ..Mesh::default() }
    }

    #[test]
    fn near_vertices_become_one_point_across_cell_borders() {
        // 0.999999 and 1.000001 lie in different cells of width 1e-5.
        let welded = weld(&mesh(&[[0.999999, 0.0, 0.0], [1.000001, 0.0, 0.0], [2.0, 0.0, 0.0]]), Some(1e-5));
        assert_eq!(welded.point_of, [0, 0, 1]);
        assert!(welded.merged);
        let apart = weld(&mesh(&[[0.0; 3], [0.0; 3]]), Some(0.0));
        assert_eq!(apart.point_of, [0, 1]);
    }

    /// The table is laid out from the mesh's own corner: counted from a far origin, all vertices would lie in its last cell.
    #[test]
    fn a_mesh_far_away_takes_no_more_than_a_look_each() {
        let axis = |steps: usize| 1e18 + 1000.0 * steps as f64;
        let places: Vec<[f64; 3]> =
            (0..200_000).map(|k| [axis(k / 3600), axis(k / 60 % 60), axis(k % 60)]).collect();
        let welded = weld(&mesh(&places), None);
        assert_eq!(welded.points.len(), places.len());
    }

    #[test]
    fn a_million_duplicates_take_no_more_than_a_look_each() {
        let places: Vec<[f64; 3]> = (0..1_000_000).map(|k| [f64::from(k % 4), 0.0, 0.0]).collect();
        let welded = weld(&mesh(&places), None);
        assert_eq!(welded.points.len(), 4);
        assert!(
            welded.warning.is_some_and(|sentence| sentence.starts_with("1000000 vertices became 4 points"))
        );
    }
}
