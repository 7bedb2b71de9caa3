//! How much of each cell of a lattice lies inside a closed surface.
//!
//! Rays run along z through every cell, four by four of them, and are cut where the surface crosses them: each piece inside
//! adds to the cells that it goes through. Along z this is exact, across it a sum over sixteen places.
//!
//! *Ties.* A ray may pass exactly through an edge or a corner. No tolerance decides there, but two yes-or-no questions, each
//! asked once for what triangles share: whether a *corner* lies above the ray's y, and whether an *edge* that goes from below to
//! above crosses that y to the right of the ray. A triangle is hit if exactly one of its two crossing edges is on the right.
//! Summed over a closed surface, each edge counts once for every triangle at it; so the number of hits along any ray is even,
//! and on an oriented surface the hits from behind are as many as those from the front, whatever is rounded.

use glam::DVec3;

use crate::error::{Code, Error, Result};

/// Rays through a cell along each of two axes.
const RAYS: usize = 4;

/// Rays that may be tried against triangles in all: some seconds of work.
const MOST_TRIALS: u64 = 400_000_000;

/// Places where rays may go through the surface in all: 24 bytes each.
const MOST_HITS: usize = 20_000_000;

/// A lattice of cubic cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cells {
    /// The corner with the smallest coordinates, m.
    pub origin: DVec3,
    /// The side of a cell, m.
    pub spacing: f64,
    /// Cells along x, y and z.
    pub counts: [usize; 3],
}

impl Cells {
    pub fn len(&self) -> usize {
        self.counts.iter().product()
    }

    /// z counts fastest.
    pub fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (x * self.counts[1] + y) * self.counts[2] + z
    }
}

/// What counts as inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    /// Where the surface winds around: pieces of it may overlap.
    Winding,
    /// Behind an odd number of faces, whichever way they are turned.
    Parity,
}

/// A place where a ray goes through the surface.
struct Hit {
    /// Which ray.
    ray: u32,
    /// In cells from the lattice's origin.
    height: f64,
    /// +1 from the front of a face, −1 from behind.
    turn: i32,
}

/// The share of each cell that lies inside, 0 to 1.
pub(super) fn shares(
    points: &[DVec3],
    triangles: &[[u32; 3]],
    cells: &Cells,
    rule: Rule,
) -> Result<Vec<f32>> {
    let [columns, rows] = [cells.counts[0] * RAYS, cells.counts[1] * RAYS];
    // In units of rays along x and y, and of cells along z.
    let local: Vec<DVec3> = points
        .iter()
        .map(|&p| (p - cells.origin) / cells.spacing * DVec3::new(RAYS as f64, RAYS as f64, 1.0))
        .collect();
    let spans = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|point| local[point as usize]);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        // Rays stand in the middle of their squares. One more on each side, as rounding may go either way.
        let span = |low: f64, high: f64, count: usize| {
            let first = (low - 1.5).floor().clamp(0.0, count as f64) as usize;
            let end = (high + 1.5).ceil().clamp(0.0, count as f64) as usize;
            first..end.max(first)
        };
        [span(low.x, high.x, columns), span(low.y, high.y, rows)]
    };
    let trials =
        triangles.iter().map(|corners| spans(corners).iter().map(|span| span.len() as u64).product::<u64>());
    let too_many = || {
        let sentence = "has too many large faces for so small a spacing";
        Error::new(Code::TooLarge, sentence).with_fix("make the spacing larger, or the mesh simpler")
    };
    if trials.fold(0u64, u64::saturating_add) > MOST_TRIALS {
        return Err(too_many());
    }

    let mut hits: Vec<Hit> = Vec::new();
    for corners in triangles {
        if hits.len() > MOST_HITS {
            return Err(too_many());
        }
        let [across, along] = spans(corners);
        for row in along {
            let y = row as f64 + 0.5;
            let Some(crossings) = crossings(&local, *corners, y) else { continue };
            for column in across.clone() {
                let x = column as f64 + 0.5;
                let [one, other] = &crossings;
                let turn = i32::from(one.x > x) * one.rises + i32::from(other.x > x) * other.rises;
                if turn != 0 {
                    let ray = (column * rows + row) as u32;
                    hits.push(Hit { ray, height: height(one, other, x), turn });
                }
            }
        }
    }
    // Stable: hits at one height stay in the order of the triangles.
    hits.sort_by(|a, b| a.ray.cmp(&b.ray).then(a.height.total_cmp(&b.height)));

    let mut shares = vec![0.0f32; cells.len()];
    for ray in hits.chunk_by(|one, other| one.ray == other.ray) {
        let (column, row) = (ray[0].ray as usize / rows, ray[0].ray as usize % rows);
        let first = cells.index([column / RAYS, row / RAYS, 0]);
        let cells = &mut shares[first..first + cells.counts[2]];
        let mut winding = 0;
        for pair in ray.windows(2) {
            winding += if rule == Rule::Winding { pair[0].turn } else { 1 };
            let inside = if rule == Rule::Winding { winding != 0 } else { winding % 2 != 0 };
            if inside {
                fill(cells, pair[0].height, pair[1].height);
            }
        }
    }
    Ok(shares)
}

/// Where an edge crosses a row of rays.
struct Crossing {
    x: f64,
    z: f64,
    /// +1 if it goes upwards in the order of the triangle's corners, −1 if downwards.
    rises: i32,
}

/// The two edges of a triangle that cross `y`, if it reaches there.
fn crossings(local: &[DVec3], [a, b, c]: [u32; 3], y: f64) -> Option<[Crossing; 2]> {
    let mut found = [[a, b], [b, c], [c, a]].into_iter().filter_map(|[from, to]| {
        let above = |point: u32| local[point as usize].y > y;
        if above(from) == above(to) {
            return None;
        }
        // The same arithmetic for both triangles at the edge: from the smaller index to the larger.
        let [p, q] = [from.min(to), from.max(to)].map(|point| local[point as usize]);
        let share = (y - p.y) / (q.y - p.y);
        let rises = if above(to) { 1 } else { -1 };
        Some(Crossing { x: p.x + share * (q.x - p.x), z: p.z + share * (q.z - p.z), rises })
    });
    Some([found.next()?, found.next()?])
}

/// The height of a triangle at `x` between two of its edges.
fn height(one: &Crossing, other: &Crossing, x: f64) -> f64 {
    let width = other.x - one.x;
    let share = if width == 0.0 { 0.0 } else { ((x - one.x) / width).clamp(0.0, 1.0) };
    one.z + share * (other.z - one.z)
}

/// Adds a piece of a ray to the cells of its column.
fn fill(cells: &mut [f32], from: f64, to: f64) {
    let top = cells.len() as f64;
    let (from, to) = (from.clamp(0.0, top), to.clamp(0.0, top));
    let first = from as usize;
    for (cell, share) in (first..cells.len()).zip(&mut cells[first..]) {
        let inside = to.min((cell + 1) as f64) - from.max(cell as f64);
        if inside <= 0.0 {
            break;
        }
        *share += inside as f32 / (RAYS * RAYS) as f32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box from `low` to `high`, turned outwards.
    fn cuboid(low: DVec3, high: DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let pick = |k: usize| {
            DVec3::new(
                if k & 1 == 0 { low.x } else { high.x },
                if k & 2 == 0 { low.y } else { high.y },
                if k & 4 == 0 { low.z } else { high.z },
            )
        };
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let halves = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        ((0..8).map(pick).collect(), halves.collect())
    }

    fn lattice(counts: [usize; 3]) -> Cells {
        Cells { origin: DVec3::ZERO, spacing: 1.0, counts }
    }

    #[test]
    fn a_box_fills_its_cells_and_parts_of_those_at_its_borders() {
        let (points, triangles) = cuboid(DVec3::ZERO, DVec3::new(2.0, 1.0, 2.5));
        for rule in [Rule::Winding, Rule::Parity] {
            let shares = shares(&points, &triangles, &lattice([2, 1, 3]), rule).expect("small");
            assert_eq!(shares, [1.0, 1.0, 0.5, 1.0, 1.0, 0.5]);
        }
    }

    #[test]
    fn rays_through_edges_and_corners_are_counted_once() {
        // Corners of an octahedron and the edges between them lie on rays: at 0.125, 0.375, 0.625 and 0.875 of a cell.
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let c = 1.125;
        let points = vec![
            at(c + 1.0, c, 1.5),
            at(c - 1.0, c, 1.5),
            at(c, c + 1.0, 1.5),
            at(c, c - 1.0, 1.5),
            at(c, c, 2.5),
            at(c, c, 0.5),
        ];
        let top = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4]];
        let triangles: Vec<[u32; 3]> = top.into_iter().chain(top.map(|[a, b, _]| [b, a, 5])).collect();
        let cells = lattice([3, 3, 3]);
        for rule in [Rule::Winding, Rule::Parity] {
            let total: f32 = shares(&points, &triangles, &cells, rule).expect("small").iter().sum();
            // Volume 4/3; to second order in the distance of rays, a quarter.
            assert!((f64::from(total) - 4.0 / 3.0).abs() < 0.25 * 0.25, "{total}");
        }
    }

    #[test]
    fn overlapping_boxes_are_a_union_by_winding() {
        let (mut points, mut triangles) = cuboid(DVec3::ZERO, DVec3::new(1.0, 1.0, 2.0));
        let (more, others) = cuboid(DVec3::new(0.0, 0.0, 1.0), DVec3::new(1.0, 1.0, 3.0));
        points.extend(more);
        triangles.extend(others.iter().map(|corners| corners.map(|point| point + 8)));
        let by = |rule| shares(&points, &triangles, &lattice([1, 1, 3]), rule).expect("small");
        assert_eq!(by(Rule::Winding), [1.0, 1.0, 1.0]);
        assert_eq!(by(Rule::Parity), [1.0, 0.0, 1.0]);
    }
}
