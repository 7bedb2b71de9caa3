//! Springs within a radius, through a cell grid.

use glam::Vec3;

use super::cells::{CellGrid, Located};
use crate::error::Result;
use crate::params::{LENGTH_RANGE, check_in, check_vectors};

/// Half the distance from 1 to the next float32: 2⁻²⁴.
const UNIT_ROUNDOFF: f64 = 1.0 / 16_777_216.0;

/// All pairs i < j of positions (m) that are no further apart than `radius` (m), in the order of the double loop
/// `for i { for j in i+1.. }`. `None` if there are more than `limit`; no more than that are ever made.
///
/// Points are float32, so a pair meant to lie exactly at the radius may be a rounding error further apart. The comparison
/// therefore allows for the rounding of the coordinates: distance ≤ radius + 4·2⁻²⁴·(largest |coordinate| + radius),
/// computed in float64. For the chain of the report (radius 2, coordinates up to 28) that is 7 µm.
///
/// ```
/// use sprung::{Vec3, build::pairs_within};
/// let points = [Vec3::ZERO, Vec3::X, Vec3::new(2.0, 0.0, 0.0)];
/// assert_eq!(pairs_within(&points, 1.0, 100)?, Some(vec![[0, 1], [1, 2]]));
/// # Ok::<(), sprung::Error>(())
/// ```
///
/// # Errors
/// [`Code::OutOfRange`](crate::Code::OutOfRange) for a radius that is negative or a number that is not finite.
pub fn pairs_within(positions: &[Vec3], radius: f32, limit: usize) -> Result<Option<Vec<[u32; 2]>>> {
    check_in("radius", radius, &LENGTH_RANGE)?;
    check_vectors("position", positions)?;
    let reach = reach(positions, radius);
    let grid = CellGrid::new(positions, reach);

    // Cell by cell: all points of a cell have the same candidates, and each two cells meet once.
    let mut found = Vec::new();
    let mut candidates = Candidates::default();
    for (cell, points) in grid.cells() {
        candidates.begin();
        candidates.add(points);
        grid.ahead_of(cell, |points| candidates.add(points));
        candidates.end();
        for (place, point) in points.iter().enumerate() {
            // Of its own cell the points beyond it.
            let near = candidates.near(place + 1, point.position, reach);
            if found.len() + near.len() > limit {
                return Ok(None);
            }
            found.extend(near.iter().map(|&other| [point.index.min(other), point.index.max(other)]));
        }
    }
    drop(grid);
    Ok(Some(in_order(&found, positions.len())))
}

/// All pairs [i, j] of a position `a[i]` and a position `b[j]` (m) that are no further apart than `radius` (m), in the
/// order of the double loop `for i { for j { .. } }`, with the comparison of [`pairs_within`]. `None` if there are more
/// than `limit`.
///
/// # Errors
/// [`Code::OutOfRange`](crate::Code::OutOfRange) for a radius that is negative or not finite.
pub fn pairs_between(a: &[Vec3], b: &[Vec3], radius: f32, limit: usize) -> Result<Option<Vec<[u32; 2]>>> {
    check_in("radius", radius, &LENGTH_RANGE)?;
    check_vectors("position", a)?;
    check_vectors("position", b)?;
    let reach = reach(a, radius).max(reach(b, radius));
    let grid = CellGrid::new(b, reach);

    let mut pairs = Vec::new();
    let mut candidates = Candidates::default();
    let mut candidates_of = None;
    for (i, &position) in a.iter().enumerate() {
        // A position outside the grid looks around the nearest cell of its border, as near as any partner can be.
        let cell = grid.cell(position);
        if candidates_of.replace(cell) != Some(cell) {
            candidates.begin();
            grid.around(cell, |points| candidates.add(points));
            candidates.end();
        }
        let near = candidates.near(0, position, reach);
        if pairs.len() + near.len() > limit {
            return Ok(None);
        }
        // Sorted, they stand as the double loop finds them.
        near.sort_unstable();
        pairs.extend(near.iter().map(|&j| [i as u32, j]));
    }
    Ok(Some(pairs))
}

/// The radius with an allowance for the rounding of coordinates and of the radius itself to float32.
fn reach(positions: &[Vec3], radius: f32) -> f64 {
    let largest = positions.iter().fold(0.0f32, |max, position| max.max(position.abs().max_element()));
    f64::from(radius) + 4.0 * (f64::from(largest) + f64::from(radius)) * UNIT_ROUNDOFF
}

/// Pairs i < j of so many points in the order of the double loop.
fn in_order(pairs: &[[u32; 2]], points: usize) -> Vec<[u32; 2]> {
    // A counting sort by i, and then each point's few partners.
    let mut next = vec![0usize; points];
    for &[i, _] in pairs {
        next[i as usize] += 1;
    }
    let mut total = 0;
    for begin in &mut next {
        total += std::mem::replace(begin, total);
    }
    let mut sorted = vec![[0; 2]; total];
    for &pair in pairs {
        let place = &mut next[pair[0] as usize];
        sorted[*place] = pair;
        *place += 1;
    }
    // Each point's pairs now end where those of the next were to begin.
    let mut begin = 0;
    for end in next {
        sorted[begin..end].sort_unstable_by_key(|&[_, j]| j);
        begin = end;
    }
    sorted
}

/// Points that may be near those of one cell, in memory that is used again.
#[derive(Default)]
struct Candidates {
    points: Vec<Located>,
    /// The same points, x, y and z apart, so that distances are computed in vector code.
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    distance_squared: Vec<f64>,
    near: Vec<u32>,
}

impl Candidates {
    /// None so far.
    fn begin(&mut self) {
        self.points.clear();
    }

    fn add(&mut self, points: &[Located]) {
        self.points.extend_from_slice(points);
    }

    /// All are there.
    fn end(&mut self) {
        let axes = [&mut self.x, &mut self.y, &mut self.z];
        for (axis, coordinates) in axes.into_iter().enumerate() {
            coordinates.clear();
            coordinates.extend(self.points.iter().map(|point| f64::from(point.position[axis])));
        }
        self.near.resize(self.points.len().max(self.near.len()), 0);
    }

    /// The numbers of the candidates from the first so many on that are within `reach` (m), in no particular order.
    fn near(&mut self, first: usize, here: Vec3, reach: f64) -> &mut [u32] {
        let here = here.as_dvec3();
        let (x, y, z) = (&self.x[first..], &self.y[first..], &self.z[first..]);
        self.distance_squared.clear();
        self.distance_squared.extend(x.iter().zip(y).zip(z).map(|((&x, &y), &z)| {
            let (x, y, z) = (x - here.x, y - here.y, z - here.z);
            x * x + y * y + z * z
        }));
        // One in four or so is near, in no pattern that a processor could guess: so no branch. Each number is written down,
        // and the next one overwrites it unless it counts.
        let mut count = 0;
        for (&distance_squared, point) in self.distance_squared.iter().zip(&self.points[first..]) {
            self.near[count] = point.index;
            count += usize::from(distance_squared <= reach * reach);
        }
        &mut self.near[..count]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The report's double loop, as written.
    fn double_loop(positions: &[Vec3], radius: f32) -> Vec<[u32; 2]> {
        let reach = reach(positions, radius);
        let mut pairs = Vec::new();
        for i in 0..positions.len() {
            for j in i + 1..positions.len() {
                if positions[i].as_dvec3().distance_squared(positions[j].as_dvec3()) <= reach * reach {
                    pairs.push([i as u32, j as u32]);
                }
            }
        }
        pairs
    }

    proptest! {
        #[test]
        fn same_springs_in_the_same_order_as_the_double_loop(
            points in prop::collection::vec(prop::array::uniform3(-8i32..8), 0..120),
            scale in prop::sample::select(vec![1.0f32, 0.1, 1e-3, 1e4]),
            radius in 0.0f32..6.0,
        ) {
            // Whole multiples of the scale: many coincident points, and many pairs exactly at the radius.
            let points: Vec<Vec3> = points.iter().map(|p| Vec3::from_array(p.map(|c| c as f32 * scale))).collect();
            for radius in [radius * scale, radius.round() * scale] {
                let found = pairs_within(&points, radius, usize::MAX).expect("the radius is allowed");
                prop_assert_eq!(found, Some(double_loop(&points, radius)));
            }
        }
    }

    /// Points to go wrong with: clusters far from each other, a diagonal in a large box, many at one place, huge
    /// coordinates; the radius fits some of the distances.
    fn awkward() -> impl Strategy<Value = (Vec<Vec3>, f32)> {
        let radius = prop::sample::select(vec![0.0f32, 1e-30, 0.5, 1.0, 2.5, 64.0, 1e6, 1e9]);
        let place = prop::sample::select(vec![
            Vec3::ZERO,
            Vec3::new(3.0, 0.0, 0.0),
            Vec3::new(1e4, -2e4, 5.0),
            Vec3::splat(-1e6),
            Vec3::new(1e9, 1e9, -1e9),
            Vec3::new(-1e9, 0.0, 1e9),
        ]);
        let offset = prop::array::uniform3(-2i8..3).prop_map(|p| Vec3::from_array(p.map(f32::from)));
        let cluster = (place, prop::collection::vec(offset, 0..40), 0.0f32..2.0);
        let clusters = prop::collection::vec(cluster, 0..4).prop_map(|clusters| {
            let points = clusters.into_iter().flat_map(|(place, offsets, scale)| {
                offsets.into_iter().map(move |offset| place + offset * scale)
            });
            points.map(|point| point.clamp(Vec3::splat(-1e9), Vec3::splat(1e9))).collect()
        });
        let diagonal = (0usize..60, 0.1f32..1e6)
            .prop_map(|(count, step)| (0..count).map(|i| Vec3::splat(i as f32 * step)).collect());
        let together = (0usize..30).prop_map(|count| vec![Vec3::new(0.1, -7.0, 1e9); count]);
        (prop_oneof![4 => clusters, 2 => diagonal, 1 => together], radius)
    }

    proptest! {
        #[test]
        fn awkward_points_have_the_springs_of_the_double_loop((points, radius) in awkward(), shift in any::<usize>()) {
            // In another order of the numbers too.
            let mut turned = points.clone();
            turned.rotate_left(shift.checked_rem(points.len()).unwrap_or(0));
            turned.reverse();
            for points in [points, turned] {
                let found = pairs_within(&points, radius, usize::MAX).expect("the points are allowed");
                prop_assert_eq!(found, Some(double_loop(&points, radius)));
            }
        }

        #[test]
        fn awkward_points_apart_have_the_springs_of_the_double_loop((a, radius) in awkward(), (b, _) in awkward()) {
            let all: Vec<Vec3> = a.iter().chain(&b).copied().collect();
            let reach = reach(&all, radius);
            let mut double_loop = Vec::new();
            for (i, p) in a.iter().enumerate() {
                for (j, q) in b.iter().enumerate() {
                    if p.as_dvec3().distance_squared(q.as_dvec3()) <= reach * reach {
                        double_loop.push([i as u32, j as u32]);
                    }
                }
            }
            let found = pairs_between(&a, &b, radius, usize::MAX).expect("the points are allowed");
            prop_assert_eq!(found, Some(double_loop));
        }
    }

    #[test]
    fn a_long_chain_with_a_point_far_out_is_joined_link_by_link() {
        // As a box of equal cells this would be all in one cell, or in 10¹⁶ of them.
        let count = 100_000u32;
        let mut points: Vec<Vec3> = (0..count).map(|i| Vec3::splat(i as f32)).collect();
        points.push(Vec3::new(-1e6, 1e6, 0.0));
        let pairs = pairs_within(&points, 1.8, usize::MAX).expect("allowed").expect("no limit");
        assert!(pairs.into_iter().eq((1..count).map(|i| [i - 1, i])));
    }

    proptest! {
        #[test]
        fn pairs_between_are_those_of_the_double_loop(
            a in prop::collection::vec(prop::array::uniform3(-8i32..8), 0..60),
            b in prop::collection::vec(prop::array::uniform3(-3i32..12), 0..60),
            radius in 0i32..6,
        ) {
            let points = |list: &[[i32; 3]]| list.iter().map(|p| Vec3::from_array(p.map(|c| c as f32))).collect::<Vec<_>>();
            let (a, b) = (points(&a), points(&b));
            let mut double_loop = Vec::new();
            for (i, p) in a.iter().enumerate() {
                for (j, q) in b.iter().enumerate() {
                    if p.distance_squared(*q) <= (radius * radius) as f32 {
                        double_loop.push([i as u32, j as u32]);
                    }
                }
            }
            let found = pairs_between(&a, &b, radius as f32, usize::MAX).expect("the radius is allowed");
            prop_assert_eq!(found, Some(double_loop));
        }
    }

    #[test]
    fn more_than_the_limit_is_none_without_making_them() {
        let points = vec![Vec3::ZERO; 100_000]; // five thousand million pairs
        assert_eq!(pairs_within(&points, 1.0, 1000), Ok(None));
    }

    #[test]
    fn a_radius_that_is_not_a_number_is_refused() {
        assert!(pairs_within(&[Vec3::ZERO], f32::NAN, 10).is_err());
        assert!(pairs_within(&[Vec3::ZERO], -1.0, 10).is_err());
        assert!(pairs_within(&[Vec3::ZERO, Vec3::INFINITY], 1.0, 10).is_err());
        assert!(pairs_between(&[Vec3::ZERO], &[Vec3::NAN], 1.0, 10).is_err());
    }
}
