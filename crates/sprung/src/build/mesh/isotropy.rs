//! How the stretching of a patch of four corners is shared among its sides and diagonals, so that it favours no direction.
//!
//! With S = k·ℓ²/(E·h) for each of the six segments and θ for its direction, the energy under a uniform strain is that of the
//! isotropic membrane exactly if ΣS = 3A, ΣS·cos2θ = ΣS·sin2θ = 0 and ΣS·cos4θ = ΣS·sin4θ = 0 (the strain's own angle enters by
//! twice and four times itself, and nothing else does). Six unknowns and five equations: of all solutions the one nearest to Van
//! Gelder's S is taken. A square gets 3/8·A for each of its sides and 3/4·A for each diagonal.

use glam::DVec3;

/// The least that any of the six segments keeps, as a share of the area: where a patch is so long or so slanted that the exact
/// solution would have springs that push, the way to it is gone only so far.
const LEAST: f64 = 0.05;

/// The segments of a patch, as pairs of its corners.
pub(super) const SEGMENTS: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [1, 3]];

/// S of each segment. The corners go around the patch; `normal` is its own, and `halves` are the areas of the triangles that
/// lack the corners 0, 1, 2 and 3.
pub(super) fn shares(corners: [DVec3; 4], normal: DVec3, halves: [f64; 4]) -> [f64; 6] {
    let area = 0.5 * halves.iter().sum::<f64>();
    // Van Gelder's, in the mean of both divisions: half of each triangle for each of its sides.
    let van_gelder = SEGMENTS.map(|[a, b]| {
        (0..4)
            .filter(|&left_out| left_out != a && left_out != b)
            .map(|left_out| 0.5 * halves[left_out])
            .sum::<f64>()
    });
    let normal = normal.normalize_or_zero();
    let first = (corners[2] - corners[0]).reject_from(normal).normalize_or_zero();
    let second = normal.cross(first);
    let columns = SEGMENTS.map(|[a, b]| {
        let along = corners[b] - corners[a];
        let (x, y) = (along.dot(first), along.dot(second));
        let squared = x * x + y * y;
        let (cos, sin) = ((x * x - y * y) / squared, 2.0 * x * y / squared);
        [1.0, cos, sin, cos * cos - sin * sin, 2.0 * cos * sin]
    });
    let mut missing = [3.0 * area, 0.0, 0.0, 0.0, 0.0];
    let mut normal_matrix = [[0.0; 5]; 5];
    for (column, share) in columns.iter().zip(van_gelder) {
        for row in 0..5 {
            missing[row] -= column[row] * share;
            for other in 0..5 {
                normal_matrix[row][other] += column[row] * column[other];
            }
        }
    }
    let multipliers = solved(normal_matrix, missing);
    let change = columns.map(|column| (0..5).map(|row| column[row] * multipliers[row]).sum::<f64>());
    let least = LEAST * area;
    let mut way = 1.0f64;
    for (share, change) in van_gelder.iter().zip(change) {
        if share + change < least {
            way = way.min(((share - least) / -change).max(0.0));
        }
    }
    std::array::from_fn(|k| van_gelder[k] + way * change[k])
}

/// Gaussian elimination of a symmetric matrix that has no negative eigenvalue. Equations that say nothing new, as those of
/// the sines do for a square, are left out.
fn solved(mut matrix: [[f64; 5]; 5], mut right: [f64; 5]) -> [f64; 5] {
    for column in 0..5 {
        // Without pivoting: diagonal entries of what is left are the squares of what an equation adds, at most 6.
        if matrix[column][column] < 1e-9 {
            matrix[column] = [0.0; 5];
            matrix.iter_mut().for_each(|row| row[column] = 0.0);
            matrix[column][column] = 1.0;
            right[column] = 0.0;
            continue;
        }
        for row in column + 1..5 {
            let factor = matrix[row][column] / matrix[column][column];
            let above = matrix[column];
            matrix[row].iter_mut().zip(above).for_each(|(entry, above)| *entry -= factor * above);
            right[row] -= factor * right[column];
        }
    }
    for column in (0..5).rev() {
        right[column] /= matrix[column][column];
        let known = right[column];
        (0..column).for_each(|row| right[row] -= matrix[row][column] * known);
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_gets_three_eighths_and_three_quarters() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let found = shares(corners, DVec3::Z, [0.5; 4]);
        for (share, exact) in found.iter().zip([0.375, 0.375, 0.375, 0.375, 0.75, 0.75]) {
            assert!((share - exact).abs() < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn a_long_strip_keeps_springs_that_pull() {
        let corners = [DVec3::ZERO, DVec3::X * 9.0, DVec3::new(9.0, 1.0, 0.0), DVec3::Y];
        let found = shares(corners, DVec3::Z, [4.5; 4]);
        assert!(found.iter().all(|share| *share > 0.04 * 9.0), "{found:?}");
        // Uniform stretching stays exact on the way.
        assert!((found.iter().sum::<f64>() - 27.0).abs() < 1e-9, "{found:?}");
    }
}
