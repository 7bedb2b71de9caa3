//! Symmetric 3×3 matrices and their eigenvalues, by Jacobi's rotations.

use glam::DVec3;

/// A symmetric 3×3 matrix; `m[i][j]` with i ≤ j is used, the rest is ignored.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Symmetric3 {
    pub m: [[f64; 3]; 3],
}

/// The three planes of rotation (p, q) and the third axis r.
const ROTATIONS: [(usize, usize, usize); 3] = [(0, 1, 2), (0, 2, 1), (1, 2, 0)];

/// Jacobi converges quadratically: from the fourth sweep on nothing but rounding is left. The rest are for safety.
const MAX_SWEEPS: usize = 8;

impl Symmetric3 {
    /// Adds `along`·n nᵀ + `across`·(I − n nᵀ) for a unit vector n.
    #[inline]
    pub fn add(&mut self, n: DVec3, along: f64, across: f64) {
        let scaled = n * (along - across);
        self.m[0][0] += scaled.x * n.x + across;
        self.m[1][1] += scaled.y * n.y + across;
        self.m[2][2] += scaled.z * n.z + across;
        self.m[0][1] += scaled.x * n.y;
        self.m[0][2] += scaled.x * n.z;
        self.m[1][2] += scaled.y * n.z;
    }

    /// An upper bound of the largest eigenvalue, tight to rounding: rotate until nearly diagonal, then Gershgorin's
    /// discs, which hold whatever is left beside the diagonal.
    pub fn largest_eigenvalue(mut self) -> f64 {
        self.diagonalise(|_, _, _, _| {});
        let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = self.m;
        let (xy, xz, yz) = (xy.abs(), xz.abs(), yz.abs());
        (xx + (xy + xz)).max(yy + (xy + yz)).max(zz + (xz + yz))
    }

    /// The eigenvector of unit length that belongs to the largest eigenvalue.
    pub fn top_eigenvector(mut self) -> [f64; 3] {
        let mut vectors = [DVec3::X, DVec3::Y, DVec3::Z];
        self.diagonalise(|p, q, cos, sin| {
            let (at_p, at_q) = (vectors[p], vectors[q]);
            vectors[p] = at_p * cos - at_q * sin;
            vectors[q] = at_p * sin + at_q * cos;
        });
        let values = [self.m[0][0], self.m[1][1], self.m[2][2]];
        let first_two = if values[0] >= values[1] { 0 } else { 1 };
        vectors[if values[first_two] >= values[2] { first_two } else { 2 }].to_array()
    }

    /// Cyclic Jacobi: each rotation makes one off-diagonal entry zero and the sum of squares beside the diagonal smaller.
    ///
    /// tan φ is the smaller root of t² + 2θt − 1 = 0, θ = (a_qq − a_pp)/(2a_pq), so that |φ| ≤ 45° (Golub and Van Loan,
    /// *Matrix Computations*, §8.5). An overflowing θ gives t = 0, which is right.
    fn diagonalise(&mut self, mut rotated: impl FnMut(usize, usize, f64, f64)) {
        let m = &mut self.m;
        for _ in 0..MAX_SWEEPS {
            let beside = m[0][1].abs() + m[0][2].abs() + m[1][2].abs();
            let diagonal = m[0][0].abs() + m[1][1].abs() + m[2][2].abs();
            if beside <= 1e-17 * diagonal {
                return;
            }
            for (p, q, r) in ROTATIONS {
                if m[p][q] == 0.0 {
                    continue;
                }
                let theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
                let t = 1.0f64.copysign(theta) / (theta.abs() + (theta * theta + 1.0).sqrt());
                let cos = 1.0 / (t * t + 1.0).sqrt();
                let sin = t * cos;
                let shift = t * m[p][q];
                m[p][p] -= shift;
                m[q][q] += shift;
                m[p][q] = 0.0;
                let (pr, qr) = ((p.min(r), p.max(r)), (q.min(r), q.max(r)));
                let (at_p, at_q) = (m[pr.0][pr.1], m[qr.0][qr.1]);
                m[pr.0][pr.1] = cos * at_p - sin * at_q;
                m[qr.0][qr.1] = sin * at_p + cos * at_q;
                rotated(p, q, cos, sin);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, SymmetricEigen};
    use proptest::prelude::*;

    use super::*;

    fn times(a: &Symmetric3, v: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|i| (0..3).map(|j| a.m[i.min(j)][i.max(j)] * v[j]).sum())
    }

    proptest! {
        #[test]
        fn agrees_with_a_library_solve_and_is_never_below(
            entries in prop::array::uniform6(-1.0f64..1.0),
            exponents in prop::array::uniform6(-6i32..1),
            power in -12i32..24,
        ) {
            let [xx, yy, zz, xy, xz, yz]: [f64; 6] =
                std::array::from_fn(|i| entries[i] * 10f64.powi(exponents[i] + power));
            let ours = Symmetric3 { m: [[xx, xy, xz], [0.0, yy, yz], [0.0, 0.0, zz]] };
            let theirs = SymmetricEigen::new(Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz));
            let size = theirs.eigenvalues.abs().max();
            // Both solves are backward stable: each eigenvalue is off by a few roundings of the largest.
            let tolerance = 32.0 * f64::EPSILON * size;
            prop_assert!((ours.largest_eigenvalue() - theirs.eigenvalues.max()).abs() <= tolerance);
            let v = ours.top_eigenvector();
            let av = times(&ours, v);
            let quotient: f64 = (0..3).map(|i| v[i] * av[i]).sum();
            prop_assert!((quotient - theirs.eigenvalues.max()).abs() <= tolerance);
            prop_assert!((v.iter().map(|c| c * c).sum::<f64>() - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn zero_huge_and_tiny_are_no_trouble() {
        assert_eq!(Symmetric3::default().largest_eigenvalue(), 0.0);
        for size in [1e-300, 1e-40, 1e40, 1e150] {
            let mut a = Symmetric3::default();
            a.add(DVec3::new(0.6, 0.8, 0.0), size, 0.0);
            assert!((a.largest_eigenvalue() / size - 1.0).abs() < 1e-15);
        }
        // One entry so small that θ overflows.
        let lopsided = Symmetric3 { m: [[1e200, 1e-200, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]] };
        assert_eq!(lopsided.largest_eigenvalue(), 1e200);
    }
}
