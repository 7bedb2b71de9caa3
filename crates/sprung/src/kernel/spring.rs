//! The law of a spring, for several at a time.

use super::{LANES, Lanes, six};
use crate::math::COINCIDENT_SQUARED;

/// What the force of springs depends on besides their ends: k_s (N/m), k_d (N·s/m) and L (m).
#[derive(Clone, Copy)]
pub(super) enum LawLanes<'a> {
    /// The same for all lanes.
    Same([f32; 3]),
    /// The same k_s and k_d, and an L for each.
    Lengths([f32; 2], &'a Lanes),
    /// All three for each.
    Each([&'a Lanes; 3]),
}

/// Axes e = x_i − x_j of some springs, what else of their ends goes into the force, and then the force itself.
///
/// The arithmetic goes through in short loops over all lanes: a processor can only look ahead so far, and in one long loop
/// would wait for the root and the division of each vector in turn.
///
/// Aligned to cache lines, as vectors that lie across two of them are read and written at half the speed.
#[repr(C, align(64))]
pub(super) struct SpringLanes {
    /// e.
    pub axis: [Lanes; 3],
    /// |e|².
    length_squared: Lanes,
    /// w·e.
    approach: Lanes,
    /// The force divided by the length.
    tension: Lanes,
}

impl SpringLanes {
    pub fn new() -> Self {
        let zeros = [0.0; LANES];
        Self { axis: [zeros; 3], length_squared: zeros, approach: zeros, tension: zeros }
    }

    /// Takes the axes of springs between points whose positions and velocities (x y z u v w) are given for both ends.
    #[inline(always)]
    pub fn fetch(&mut self, near: [&Lanes; 6], far: [&Lanes; 6]) {
        let [ex, ey, ez] = &mut self.axis;
        for lane in 0..LANES {
            let [x, y, z, u, v, w] = six([0, 1, 2, 3, 4, 5], |part| near[part][lane] - far[part][lane]);
            (ex[lane], ey[lane], ez[lane]) = (x, y, z);
            self.length_squared[lane] = x * x + y * y + z * z;
            self.approach[lane] = u * x + v * y + w * z;
        }
    }

    /// The tensions of the lanes whose bit of `mask` is set; zero for the others.
    #[inline(always)]
    pub fn pull(&mut self, law: LawLanes<'_>, mask: u32) {
        // One loop for each kind of law: the choice is made out here.
        match law {
            LawLanes::Same([k, d, rest]) => self.pull_by(mask, |_| [k, d, rest]),
            LawLanes::Lengths([k, d], rest) => self.pull_by(mask, |lane| [k, d, rest[lane]]),
            LawLanes::Each([k, d, rest]) => self.pull_by(mask, |lane| [k[lane], d[lane], rest[lane]]),
        }
    }

    /// The same for the law (k_s, k_d, L) of each lane.
    #[inline(always)]
    pub fn pull_by(&mut self, mask: u32, law: impl Fn(usize) -> [f32; 3]) {
        for lane in 0..LANES {
            let tension = tension(self.length_squared[lane], self.approach[lane], law(lane));
            self.tension[lane] = if (mask >> lane) & 1 != 0 { tension } else { 0.0 };
        }
    }

    /// Adds the forces along one axis to both ends.
    #[inline(always)]
    pub fn hand_out(&self, axis: usize, near: &mut Lanes, far: &mut Lanes) {
        for lane in 0..LANES {
            let force = self.axis[axis][lane] * self.tension[lane];
            near[lane] -= force;
            far[lane] += force;
        }
    }

    /// The force on the far end, −F, along one axis.
    #[inline(always)]
    pub fn force(&self, axis: usize) -> Lanes {
        let mut force = [0.0; LANES];
        for (lane, force) in force.iter_mut().enumerate() {
            *force = self.axis[axis][lane] * self.tension[lane];
        }
        force
    }
}

/// T/ℓ of a spring from |e|² and w·e: the force on its near end is F = −T·u = −(T/ℓ)·e, with T = k_s(ℓ − L) + k_d(w·u),
/// ℓ = |e| and u = e/ℓ. Hence T/ℓ = (k_s(ℓ − L)·ℓ + k_d(w·e))/ℓ², where the root need not be waited for by the division.
///
/// Both are exact to half an ulp, as IEEE 754 has them, and so the same on every machine. A spring of length L has T = 0.
#[inline(always)]
pub(super) fn tension(squared: f32, approach: f32, [stiffness, damping, rest_length]: [f32; 3]) -> f32 {
    // Coincident ends have no axis: u = e/10⁻¹⁵ m is then zero, without a branch.
    let squared = if squared > COINCIDENT_SQUARED { squared } else { COINCIDENT_SQUARED };
    let length = squared.sqrt();
    let inverse = 1.0 / squared;
    (stiffness * (length - rest_length) * length + damping * approach) * inverse
}

/// sums += values.
#[inline(always)]
pub(super) fn add(sums: &mut Lanes, values: &Lanes) {
    for lane in 0..LANES {
        sums[lane] += values[lane];
    }
}
