//! v += a·dt, then x += v·dt, over plain floats, keeping what rounding drops.

use crate::math::two_sum;

/// A velocity component smaller than this becomes zero, m/s: a cloth at rest must not fill with denormal numbers,
/// which are slow and whose treatment differs from host to host.
const NEGLIGIBLE_SPEED: f32 = 1e-20;

/// Rounding residues smaller than this become zero, for the same reason.
const NEGLIGIBLE_RESIDUE: f32 = 1e-30;

/// Exponent bits of a float32; all set in infinities and NaNs.
const EXPONENT: u32 = 0x7f80_0000;

/// Positions and velocities as plain floats, xyz interleaved, each with what rounding dropped.
pub(crate) struct Motion<'a> {
    pub position: &'a mut [f32],
    pub position_low: &'a mut [f32],
    pub velocity: &'a mut [f32],
    pub velocity_low: &'a mut [f32],
}

/// One semi-implicit Euler move with the accelerations `a` (m/s²) and step `dt` (s).
/// A fixed point has a = 0 and v = 0 and stays. Returns whether every position is finite.
///
/// Plain slices and no branch, so that the compiler makes vector code of it.
pub(crate) fn advance(motion: Motion<'_>, acceleration: &[f32], dt: f32) -> bool {
    let n = acceleration.len();
    let (x, x_low) = (&mut motion.position[..n], &mut motion.position_low[..n]);
    let (v, v_low) = (&mut motion.velocity[..n], &mut motion.velocity_low[..n]);
    let mut not_finite = 0u32;
    for c in 0..n {
        let (speed, speed_low) = two_sum(v[c], acceleration[c] * dt + v_low[c]);
        let still = speed.abs() < NEGLIGIBLE_SPEED;
        v[c] = if still { 0.0 } else { speed };
        v_low[c] = if still { 0.0 } else { without_residue(speed_low) };

        let (place, place_low) = two_sum(x[c], v[c] * dt + x_low[c]);
        x[c] = place;
        x_low[c] = without_residue(place_low);
        not_finite |= u32::from(place.to_bits() & EXPONENT == EXPONENT);
    }
    not_finite == 0
}

#[inline(always)]
fn without_residue(value: f32) -> f32 {
    if value.abs() < NEGLIGIBLE_RESIDUE { 0.0 } else { value }
}
