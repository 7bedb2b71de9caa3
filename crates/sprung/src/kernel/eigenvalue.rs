//! The largest eigenvalue of a symmetric 3×3 matrix, without a loop and with one branch that is a choice of numbers: fit for
//! lanes.
//!
//! With μ the mean of the eigenvalues, A − μI = √p·N and p = |A − μI|²/6, the eigenvalues of N are 2·cos of φ/3 and of that
//! ± 120°, where cos φ = r = ½ det N (Smith 1961, *Eigenvalues of a symmetric 3×3 matrix*). So the largest is
//!
//! ```text
//! λ = μ + √p·x        x = 2·cos(φ/3) = 2·cos(⅔·acos s)        s = cos(φ/2) = √((1 + r)/2)
//! ```
//!
//! and x, as a function of s from 0 to 1, is so smooth that a polynomial of degree six is within 3.8·10⁻⁷ of it.
//!
//! *Where the two largest eigenvalues nearly coincide*, as in a flat cloth, r is near −1 and s near 0: the rounding of r would
//! become its root. There s comes from sin φ, which loses nothing: with G = N² − 2I − rN, what is left of N² after its parts
//! along I and N have been taken out,
//!
//! ```text
//! |G|² = 6·sin²φ        s² = sin²φ/(2(1 − r)) = |G|²/(12(1 − r))
//! ```
//!
//! One division is enough: both forms of s² are quotients of polynomials in the entries of A − μI, p and √p.
//!
//! *The error.* Let u = 2⁻²⁴. The mean is off by 4u·μ and the trace of A − μ̂I by three times that, which moves an eigenvalue
//! by as much at the most: 12u·μ. In units of √p all entries of A − μ̂I, its cofactors and G are at most 3 and off by a few u;
//! hence r by 30u at the most and s, where it comes from G, by 12u. As dx/dr ≤ ⅓ for r ≥ 0 and dx/ds ≤ 1.16, x is off by 14u,
//! with its polynomial by 20u. With √p ≤ μ, which is so for every matrix without a negative eigenvalue, and 8u of √p·x for the
//! roundings of √p and of the last product and sum, the sum is at most [`ERROR`]·u·λ.

/// The most by which an eigenvalue is off, in proportion and in units of u = 2⁻²⁴; for matrices without a negative eigenvalue.
pub(super) const ERROR: f64 = 40.0;

/// The bits of a float's exponent.
const EXPONENT: u32 = 0xff << 23;

/// To scale by a power of two loses nothing: matrices are, so that their mean is from 2¹² to 2¹³ and the fourth power of p in
/// range. The sum of the exponents of such a mean and of the scale, but for where the mean is next to nothing.
const EXPONENTS: u32 = (127 + 127 + 12) << 23;

/// The least exponent that is scaled so.
const LEAST_EXPONENT: u32 = 16 << 23;

/// The least p of a scaled matrix: beside the mean its root is nothing.
const LEAST: f32 = 1e-8;

/// 2·cos(⅔·acos s) by powers of s, within 3.8·10⁻⁷ for s from 0 to 1: through the seven nodes of Chebyshev.
const POLYNOMIAL: [f32; 7] =
    [1.000_000_4, 1.154_663_8, -0.221_610_94, 0.102_949_53, -0.052_799_5, 0.021_003_507, -0.004_206_982];

/// The largest eigenvalue of the matrix xx, yy, zz, xy, xz, yz, off by no more than [`ERROR`] says and 10⁻⁴⁰. Infinite or NaN
/// where an entry is.
#[inline(always)]
pub(super) fn largest([xx, yy, zz, xy, xz, yz]: [f32; 6]) -> f32 {
    let mean = (xx + yy + zz) * (1.0 / 3.0);
    let exponent = (mean.to_bits() & EXPONENT).max(LEAST_EXPONENT);
    let scale = f32::from_bits(EXPONENTS - exponent);
    // A − μI, scaled.
    let (xx, yy, zz) = ((xx - mean) * scale, (yy - mean) * scale, (zz - mean) * scale);
    let (xy, xz, yz) = (xy * scale, xz * scale, yz * scale);
    let p = ((xx * xx + yy * yy + zz * zz) + 2.0 * (xy * xy + xz * xz + yz * yz)) * (1.0 / 6.0);
    let p = if p > LEAST { p } else { LEAST };
    let size = p.sqrt();
    // Its cofactors are N² − 3I by p, as the trace of N is 0 and that of N² is 6.
    let (co_xx, co_yy, co_zz) = (yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy);
    let (co_xy, co_xz, co_yz) = (xz * yz - xy * zz, xy * yz - xz * yy, xy * xz - yz * xx);
    let determinant = xx * co_xx + xy * co_xy + xz * co_xz;
    // G by p².
    let half = 0.5 * determinant;
    let (g_xx, g_yy, g_zz) =
        (p * (co_xx + p) - half * xx, p * (co_yy + p) - half * yy, p * (co_zz + p) - half * zz);
    let (g_xy, g_xz, g_yz) = (p * co_xy - half * xy, p * co_xz - half * xz, p * co_yz - half * yz);
    let g = (g_xx * g_xx + g_yy * g_yy + g_zz * g_zz) + 2.0 * (g_xy * g_xy + g_xz * g_xz + g_yz * g_yz);
    // r is the determinant by this.
    let whole = 2.0 * (p * size);
    let (above, below) = if determinant > 0.0 {
        (whole + determinant, 2.0 * whole)
    } else {
        (g * size, 6.0 * (p * p * p) * (whole - determinant))
    };
    let s = (above / below).sqrt();
    let [c0, c1, c2, c3, c4, c5, c6] = POLYNOMIAL;
    let x = c0 + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * (c5 + s * c6)))));
    // The scale's own exponent is at most 250, so that there is a number that undoes it.
    mean + size * x * f32::from_bits((254 << 23) - scale.to_bits())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// In float64, by rotations.
    fn exact(entries: [f32; 6]) -> f64 {
        crate::stability::largest_eigenvalue(entries.map(f64::from))
    }

    proptest! {
        /// Sums of a few products v vᵀ, as springs make them: with one, two or three directions, in all proportions.
        #[test]
        fn it_is_as_near_as_it_says(
            vectors in prop::collection::vec((prop::array::uniform3(-1.0f32..1.0), -12i32..3), 1..5),
            all in prop::option::of(-20i32..3),
            flat: bool,
            power in -90i32..50,
        ) {
            let size = 2f32.powi(power);
            let mut a = [0.0f32; 6];
            for ([x, y, z], exponent) in vectors {
                let z = if flat { 0.0 } else { z };
                let weight = size * 2f32.powi(exponent);
                let products = [x * x, y * y, z * z, x * y, x * z, y * z];
                a.iter_mut().zip(products).for_each(|(sum, product)| *sum += weight * product);
            }
            if let Some(exponent) = all {
                let more = size * 2f32.powi(exponent);
                a[0] += more;
                a[1] += more;
                a[2] += if flat { 0.0 } else { more };
            }
            let (found, expected) = (f64::from(largest(a)), exact(a));
            let u = 0.5 * f64::from(f32::EPSILON);
            prop_assert!(
                (found - expected).abs() <= ERROR * u * expected + 1e-40,
                "{a:?}: {found} and {expected}, {} u", (found / expected - 1.0) / u
            );
        }
    }

    #[test]
    fn nothing_and_what_is_no_number_are_themselves() {
        assert!(largest([0.0; 6]).abs() < 1e-38);
        assert_eq!(largest([7.0, 7.0, 7.0, 0.0, 0.0, 0.0]), 7.0);
        for wrong in [f32::INFINITY, f32::NAN] {
            for entry in 0..6 {
                let mut a = [1.0; 6];
                a[entry] = wrong;
                assert!(!largest(a).is_finite(), "{a:?}");
            }
        }
    }
}
