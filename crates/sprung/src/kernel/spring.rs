//! The law of a spring, for several at a time.

use super::{LANES, Lanes, six};
use crate::math::COINCIDENT_SQUARED;

/// What the force of springs depends on besides their ends.
#[derive(Clone, Copy)]
pub(super) struct LawLanes<'a> {
    pub stiffness: OneOrEach<'a>,
    pub damping: OneOrEach<'a>,
    pub rest_length: OneOrEach<'a>,
}

/// One value for all lanes, or one for each.
#[derive(Clone, Copy)]
pub(super) enum OneOrEach<'a> {
    Same(f32),
    Each(&'a Lanes),
}

/// Axes e = x_i − x_j and relative velocities w = v_i − v_j of some springs; then, in place of the axes, the forces.
///
/// The arithmetic goes through in short loops over all lanes: a processor can only look ahead so far, and in one long loop
/// would wait for the root and the division of each vector in turn.
///
/// Aligned to cache lines, as vectors that lie across two of them are read and written at half the speed.
#[repr(C, align(64))]
pub(super) struct SpringLanes {
    /// e, and after [`pull`](Self::pull) the force −F on the far end.
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

    /// F = −(k_s(ℓ − L) + k_d(w·u))·u with ℓ = |e|, u = e/ℓ on the near end, and −F left in `axis`, for the lanes whose bit
    /// of `mask` is set; zero for the others, and while the ends coincide. Sums of three go from left to right.
    ///
    /// The root and the division are exact to half an ulp, as IEEE 754 has them, and so the same on every machine.
    #[inline(always)]
    pub fn pull(&mut self, law: LawLanes<'_>, mask: u32) {
        // One loop for each kind of law: the choice is made out here.
        use OneOrEach::{Each, Same};
        match (law.stiffness, law.damping, law.rest_length) {
            (Same(k), Same(d), Same(rest)) => self.tension(mask, |_| (k, d, rest)),
            (Same(k), Same(d), Each(rest)) => self.tension(mask, |lane| (k, d, rest[lane])),
            (Each(k), Each(d), Each(rest)) => {
                self.tension(mask, |lane| (k[lane], d[lane], rest[lane]));
            }
            (k, d, rest) => self.tension(mask, |lane| (k.at(lane), d.at(lane), rest.at(lane))),
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

    /// As [`pull`](Self::pull), for the law (k_s, k_d, L) of each lane.
    #[inline(always)]
    pub fn tension(&mut self, mask: u32, law: impl Fn(usize) -> (f32, f32, f32)) {
        for lane in 0..LANES {
            let (stiffness, damping, rest_length) = law(lane);
            let squared = self.length_squared[lane];
            // Coincident ends have no axis: u = e/10⁻¹⁵ m is then zero, without a branch.
            let squared = if squared > COINCIDENT_SQUARED { squared } else { COINCIDENT_SQUARED };
            let length = squared.sqrt();
            let inverse = 1.0 / length;
            let speed = self.approach[lane] * inverse;
            let tension = (stiffness * (length - rest_length) + damping * speed) * inverse;
            self.tension[lane] = if (mask >> lane) & 1 != 0 { tension } else { 0.0 };
        }
    }
}

impl OneOrEach<'_> {
    #[inline(always)]
    fn at(self, lane: usize) -> f32 {
        match self {
            Self::Same(value) => value,
            Self::Each(values) => values[lane],
        }
    }
}

/// sums += values.
#[inline(always)]
pub(super) fn add(sums: &mut Lanes, values: &Lanes) {
    for lane in 0..LANES {
        sums[lane] += values[lane];
    }
}
