//! How stiffly springs hold their ends, and how much they damp them.
//!
//! With n the unit vector along a spring and h = min(1, L/ℓ), what pulls back on an end that moves is
//!
//! ```text
//! B = k·h·n nᵀ + k(1 − h)·I        of stiffness, N/m: k along the spring, and across it the part that tension gives
//! D = k_d·n nᵀ                     of damping, N·s/m
//! ```
//!
//! and k·I and k_d·I between coincident ends, which have no axis. Both are symmetric: six numbers each. Ends further apart than
//! 10¹⁹ m, whose square is beyond float32's range, count as having none either, which is on the safe side.

use super::spring::LawLanes;
use super::{LANES, Lanes};
use crate::math::COINCIDENT_SQUARED;

/// Numbers of both tensors: xx, yy, zz, xy, xz, yz of stiffness and then of damping.
pub(super) const PARTS: usize = 12;

/// The tensors of one spring.
pub(super) type Tensors = [f32; PARTS];

/// Squared lengths up to here count as coincident, m²: whatever rounding makes of them, the springs that the exact limit takes
/// for coincident are among them.
const COINCIDENT: f32 = COINCIDENT_SQUARED * 1.000_001;

/// The tensors of a spring along e, which need not be of unit length, under the law k_s, k_d, L; zeros if it is not `live`.
#[inline(always)]
pub(super) fn tensors([x, y, z]: [f32; 3], [k, d, rest]: [f32; 3], is_live: bool) -> Tensors {
    let (k, d) = (if is_live { k } else { 0.0 }, if is_live { d } else { 0.0 });
    let squared = x * x + y * y + z * z;
    let inverse = if squared > COINCIDENT { 1.0 / squared.sqrt() } else { 0.0 };
    let has_axis = inverse > 0.0;
    let (x, y, z) = (x * inverse, y * inverse, z * inverse);
    // L/ℓ, which is more than 1 in a spring that is pressed: nothing then holds it across.
    let pressed = rest * inverse;
    let along = k * if pressed < 1.0 { pressed } else { 1.0 };
    let (across, damping_across) = (k - along, if has_axis { 0.0 } else { d });
    let (kx, ky, kz) = (along * x, along * y, along * z);
    let (dx, dy, dz) = (d * x, d * y, d * z);
    [
        kx * x + across,
        ky * y + across,
        kz * z + across,
        kx * y,
        kx * z,
        ky * z,
        dx * x + damping_across,
        dy * y + damping_across,
        dz * z + damping_across,
        dx * y,
        dx * z,
        dy * z,
    ]
}

/// The tensors of springs between points whose positions are given for both ends, in the lanes whose bit of `mask` is set;
/// zeros in the others.
#[inline(always)]
pub(super) fn of_lanes(near: [&Lanes; 3], far: [&Lanes; 3], law: LawLanes<'_>, mask: u32) -> [Lanes; PARTS] {
    // One loop for each kind of law: the choice is made out here.
    match law {
        LawLanes::Same([k, d, rest]) => of_lanes_by(near, far, mask, |_| [k, d, rest]),
        LawLanes::Lengths([k, d], rest) => of_lanes_by(near, far, mask, |lane| [k, d, rest[lane]]),
        LawLanes::Each([k, d, rest]) => of_lanes_by(near, far, mask, |lane| [k[lane], d[lane], rest[lane]]),
    }
}

#[inline(always)]
fn of_lanes_by(
    near: [&Lanes; 3],
    far: [&Lanes; 3],
    mask: u32,
    law: impl Fn(usize) -> [f32; 3],
) -> [Lanes; PARTS] {
    let mut parts = [[0.0; LANES]; PARTS];
    for lane in 0..LANES {
        let axis = [0, 1, 2].map(|axis| near[axis][lane] - far[axis][lane]);
        let tensors = tensors(axis, law(lane), (mask >> lane) & 1 != 0);
        for part in 0..PARTS {
            parts[part][lane] = tensors[part];
        }
    }
    parts
}

/// Adds the tensors of springs, as [`of_lanes`] has them, to the sums of both ends, which are side by side.
#[inline(always)]
pub(super) fn accumulate(
    ends: [[&Lanes; 3]; 2],
    law: LawLanes<'_>,
    mask: u32,
    near: &mut [Lanes; PARTS],
    far: [&mut Lanes; PARTS],
) {
    match law {
        LawLanes::Same([k, d, rest]) => accumulate_by(ends, mask, |_| [k, d, rest], near, far),
        LawLanes::Lengths([k, d], rest) => {
            accumulate_by(ends, mask, |lane| [k, d, rest[lane]], near, far);
        }
        LawLanes::Each([k, d, rest]) => {
            accumulate_by(ends, mask, |lane| [k[lane], d[lane], rest[lane]], near, far);
        }
    }
}

#[inline(always)]
fn accumulate_by(
    ends: [[&Lanes; 3]; 2],
    mask: u32,
    law: impl Fn(usize) -> [f32; 3],
    near: &mut [Lanes; PARTS],
    [a, b, c, d, e, f, g, h, i, j, k, l]: [&mut Lanes; PARTS],
) {
    hand_out(ends, mask, law, near, a, b, c, d, e, f, g, h, i, j, k, l);
}

/// Each far sum is an argument of its own: what comes in an array could be the same place twice, for all that the compiler
/// knows, and it would make no vectors of it. All in one loop, so that nothing is written down in between.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
fn hand_out(
    [near_at, far_at]: [[&Lanes; 3]; 2],
    mask: u32,
    law: impl Fn(usize) -> [f32; 3],
    near: &mut [Lanes; PARTS],
    far_0: &mut Lanes,
    far_1: &mut Lanes,
    far_2: &mut Lanes,
    far_3: &mut Lanes,
    far_4: &mut Lanes,
    far_5: &mut Lanes,
    far_6: &mut Lanes,
    far_7: &mut Lanes,
    far_8: &mut Lanes,
    far_9: &mut Lanes,
    far_10: &mut Lanes,
    far_11: &mut Lanes,
) {
    for lane in 0..LANES {
        let axis = [0, 1, 2].map(|axis| near_at[axis][lane] - far_at[axis][lane]);
        let tensors = tensors(axis, law(lane), (mask >> lane) & 1 != 0);
        for part in 0..PARTS {
            near[part][lane] += tensors[part];
        }
        far_0[lane] += tensors[0];
        far_1[lane] += tensors[1];
        far_2[lane] += tensors[2];
        far_3[lane] += tensors[3];
        far_4[lane] += tensors[4];
        far_5[lane] += tensors[5];
        far_6[lane] += tensors[6];
        far_7[lane] += tensors[7];
        far_8[lane] += tensors[8];
        far_9[lane] += tensors[9];
        far_10[lane] += tensors[10];
        far_11[lane] += tensors[11];
    }
}
