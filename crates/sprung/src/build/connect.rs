//! Springs within a radius, through a cell grid.

use glam::Vec3;

use crate::error::Result;
use crate::params::{LENGTH_RANGE, check_in, check_vector};

/// Half the distance from 1 to the next float32: 2⁻²⁴.
const UNIT_ROUNDOFF: f64 = 1.0 / 16_777_216.0;

/// All pairs i < j of positions (m) that are no further apart than `radius` (m), in the order of the double loop
/// `for i { for j in i+1.. }`. `None` if there are more than `limit`; no more memory than that is ever taken.
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
    positions.iter().try_for_each(|&position| check_vector("position", position))?;
    let reach = reach(positions, radius);
    let reach_squared = reach * reach;
    let grid = CellGrid::new(positions, reach);

    let mut pairs = Vec::new();
    let mut partners = Vec::new();
    for (i, &position) in positions.iter().enumerate() {
        // The partners of i beyond i, in the cells around it; sorted, they stand as the double loop finds them.
        partners.clear();
        let here = position.as_dvec3();
        for row in grid.rows_around(position) {
            for &j in row {
                if j as usize > i && positions[j as usize].as_dvec3().distance_squared(here) <= reach_squared
                {
                    partners.push(j);
                }
            }
            if pairs.len() + partners.len() > limit {
                return Ok(None);
            }
        }
        partners.sort_unstable();
        pairs.extend(partners.iter().map(|&j| [i as u32, j]));
    }
    Ok(Some(pairs))
}

/// All pairs [i, j] of a position `a[i]` and a position `b[j]` (m) that are no further apart than `radius` (m), in the
/// order of the double loop `for i { for j { .. } }`, with the comparison of [`pairs_within`]. `None` if there are more
/// than `limit`.
///
/// # Errors
/// [`Code::OutOfRange`](crate::Code::OutOfRange) for a radius that is negative or not finite.
pub fn pairs_between(a: &[Vec3], b: &[Vec3], radius: f32, limit: usize) -> Result<Option<Vec<[u32; 2]>>> {
    check_in("radius", radius, &LENGTH_RANGE)?;
    a.iter().chain(b).try_for_each(|&position| check_vector("position", position))?;
    let reach = reach(a, radius).max(reach(b, radius));
    let grid = CellGrid::new(b, reach);

    let mut pairs = Vec::new();
    let mut partners = Vec::new();
    for (i, &position) in a.iter().enumerate() {
        // A position outside the grid looks around the nearest cell of its border, as near as any partner can be.
        partners.clear();
        let here = position.as_dvec3();
        for row in grid.rows_around(position) {
            let near = |j: &u32| b[*j as usize].as_dvec3().distance_squared(here) <= reach * reach;
            partners.extend(row.iter().copied().filter(near));
            if pairs.len() + partners.len() > limit {
                return Ok(None);
            }
        }
        partners.sort_unstable();
        pairs.extend(partners.iter().map(|&j| [i as u32, j]));
    }
    Ok(Some(pairs))
}

/// The radius with an allowance for the rounding of coordinates and of the radius itself to float32.
fn reach(positions: &[Vec3], radius: f32) -> f64 {
    let largest = positions.iter().fold(0.0f32, |max, position| max.max(position.abs().max_element()));
    f64::from(radius) + 4.0 * (f64::from(largest) + f64::from(radius)) * UNIT_ROUNDOFF
}

/// Points sorted by the cell they lie in. Cells are cubes at least as long as the reach, so that all partners of a
/// point lie in the 27 cells around it; within a cell points stand in ascending order.
struct CellGrid {
    origin: Vec3,
    inverse_size: f64,
    counts: [usize; 3],
    /// Where each cell's points begin in `points`, and the total at the end.
    starts: Vec<u32>,
    points: Vec<u32>,
}

impl CellGrid {
    fn new(positions: &[Vec3], reach: f64) -> Self {
        let low = positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let high = positions.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        let extent =
            if positions.is_empty() { [0.0; 3] } else { (high.as_dvec3() - low.as_dvec3()).to_array() };

        // Larger cells where the reach is small against the extent, so that there are not many more cells than points.
        let most_cells = (2 * positions.len()).max(64) as f64;
        let count_along = |size: f64| extent.map(|length| (length / size).floor() + 1.0);
        let mut size = reach.max(extent.into_iter().fold(0.0, f64::max) * 1e-6).max(1e-30);
        while count_along(size).iter().product::<f64>() > most_cells {
            size *= 1.26;
        }
        let counts = count_along(size).map(|count| count as usize);

        let mut grid =
            Self { origin: low, inverse_size: 1.0 / size, counts, starts: Vec::new(), points: Vec::new() };
        let cells: Vec<u32> =
            positions.iter().map(|&position| grid.flat(grid.cell(position)) as u32).collect();
        // Counting sort by cell.
        let mut starts = vec![0u32; counts.iter().product::<usize>() + 1];
        for &cell in &cells {
            starts[cell as usize + 1] += 1;
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut next = starts.clone();
        let mut points = vec![0u32; positions.len()];
        for (point, &cell) in cells.iter().enumerate() {
            points[next[cell as usize] as usize] = point as u32;
            next[cell as usize] += 1;
        }
        grid.starts = starts;
        grid.points = points;
        grid
    }

    fn cell(&self, position: Vec3) -> [usize; 3] {
        let offset = (position.as_dvec3() - self.origin.as_dvec3()) * self.inverse_size;
        let clamp = |value: f64, axis: usize| (value.floor().max(0.0) as usize).min(self.counts[axis] - 1);
        [clamp(offset.x, 0), clamp(offset.y, 1), clamp(offset.z, 2)]
    }

    fn flat(&self, [x, y, z]: [usize; 3]) -> usize {
        (x * self.counts[1] + y) * self.counts[2] + z
    }

    /// The points of the 27 cells around a position, as up to nine rows of neighbouring cells along z.
    fn rows_around(&self, position: Vec3) -> impl Iterator<Item = &[u32]> {
        let [x, y, z] = self.cell(position);
        let around =
            |centre: usize, axis: usize| centre.saturating_sub(1)..=(centre + 1).min(self.counts[axis] - 1);
        let along_z = around(z, 2);
        let (first, last) = (*along_z.start(), *along_z.end());
        around(x, 0).flat_map(move |x| around(y, 1).map(move |y| (x, y))).map(move |(x, y)| {
            let begin = self.starts[self.flat([x, y, first])] as usize;
            let end = self.starts[self.flat([x, y, last]) + 1] as usize;
            &self.points[begin..end]
        })
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
