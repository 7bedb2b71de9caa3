//! All other forces on the points of a block, and their move.

use super::{LANES, Lanes};
use crate::contact::{ContactLaw, Plane};
use glam::Vec3;

/// The bits of a float32 of which one at least is set where it is 2⁻⁶³ or more in size. A velocity component smaller than
/// that, 10⁻¹⁹ m/s, becomes zero: a cloth at rest must not fill with denormal numbers, which are slow and whose treatment
/// differs from host to host.
const NOTABLE_SPEED: u32 = 0x6000_0000;

/// The same for 2⁻⁹⁵. A smaller change of velocity, of 2·10⁻²⁹ m/s, is none: residues of positions and velocities are then
/// multiples of its last bit, or of that of the smallest speed × the smallest step, and never denormal.
const NOTABLE_KICK: u32 = 0x7000_0000;

/// What acts on every point alike.
#[derive(Clone, Copy)]
pub(crate) struct Field<'a> {
    pub gravity: Vec3,
    pub planes: &'a [Plane],
    pub dt: f32,
}

/// What a step makes of the forces on some points. All zero for one that no force can move.
pub(super) struct Response {
    /// dt/m, s/kg: the velocity that a force gives to a point.
    per_force: Lanes,
    /// g·dt, m/s: the velocity that gravity gives to it, along each axis.
    fall: [Lanes; 3],
}

impl Response {
    #[inline(always)]
    pub fn new(inverse_mass: &Lanes, field: Field<'_>) -> Self {
        let mut response = Self { per_force: [0.0; LANES], fall: [[0.0; LANES]; 3] };
        for (per_force, inverse_mass) in response.per_force.iter_mut().zip(inverse_mass) {
            *per_force = inverse_mass * field.dt;
        }
        for (fall, along) in response.fall.iter_mut().zip((field.gravity * field.dt).to_array()) {
            for (fall, &inverse_mass) in fall.iter_mut().zip(inverse_mass) {
                *fall = if inverse_mass > 0.0 { along } else { 0.0 };
            }
        }
        response
    }
}

/// One component of some points' motion, with what rounding dropped.
pub(super) struct Motion<'a> {
    pub position: &'a mut Lanes,
    pub position_low: &'a mut Lanes,
    pub velocity: &'a mut Lanes,
    pub velocity_low: &'a mut Lanes,
}

/// One component, along an axis, of a semi-implicit Euler move: v += f·(dt/m) + g·dt, then x += v·dt, keeping what rounding
/// drops.
#[inline(always)]
pub(super) fn advance(motion: Motion<'_>, force: &[Lanes; 3], response: &Response, axis: usize, dt: f32) {
    let (force, fall, per_force) = (&force[axis], &response.fall[axis], &response.per_force);
    // Into arrays of its own: what may be the same memory as something else cannot be done in vectors.
    let zeros = [0.0; LANES];
    let (mut x, mut x_low, mut v, mut v_low) = (zeros, zeros, zeros, zeros);
    for lane in 0..LANES {
        let kick = force[lane] * per_force[lane] + fall[lane] + motion.velocity_low[lane];
        let kick = if kick.to_bits() & NOTABLE_KICK != 0 { kick } else { 0.0 };
        let (speed, speed_low) = fast_two_sum(motion.velocity[lane], kick);
        v[lane] = if speed.to_bits() & NOTABLE_SPEED != 0 { speed } else { 0.0 };
        v_low[lane] = speed_low;
        let way = v[lane] * dt + motion.position_low[lane];
        (x[lane], x_low[lane]) = fast_two_sum(motion.position[lane], way);
    }
    *motion.position = x;
    *motion.position_low = x_low;
    *motion.velocity = v;
    *motion.velocity_low = v_low;
}

/// Sums of what rounding dropped of positions, which tell whether one of them is not finite: what is dropped of such a one is
/// not either, and of all others it is too little to sum up to infinity.
pub(super) struct Doubt(Lanes);

impl Doubt {
    pub fn new() -> Self {
        Self([0.0; LANES])
    }

    #[inline(always)]
    pub fn look_at(&mut self, [x, y, z]: [&Lanes; 3]) {
        for lane in 0..LANES {
            self.0[lane] += x[lane] + y[lane] + z[lane];
        }
    }

    /// Whether all positions are finite.
    #[inline(always)]
    pub fn finds_all_finite(mut self) -> bool {
        // By halves: in a sum from lane to lane each would wait for the one before.
        let mut half = LANES / 2;
        while half > 0 {
            for lane in 0..half {
                self.0[lane] += self.0[lane + half];
            }
            half /= 2;
        }
        self.0[0].is_finite()
    }
}

/// a + b in float32 and what the rounding dropped (Dekker's Fast2Sum): exact where |a| ≥ |b|. Where an increment b is the
/// larger one, the residue is off by at most an ulp of b, which is as far as b itself is off, a rounded product.
#[inline(always)]
fn fast_two_sum(a: f32, b: f32) -> (f32, f32) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// Adds the push of a plane to the forces on some points: see [`Plane`].
#[inline(always)]
pub(super) fn push_out(plane: &Plane, points: [&Lanes; 6], force: &mut [Lanes; 3]) {
    let [x, y, z, u, v, w] = points;
    let (point, normal) = (plane.point, plane.normal);
    let may_pull = plane.law == ContactLaw::Report;
    let mut push = [0.0; LANES];
    for lane in 0..LANES {
        let depth =
            (point.x - x[lane]) * normal.x + (point.y - y[lane]) * normal.y + (point.z - z[lane]) * normal.z;
        let speed = u[lane] * normal.x + v[lane] * normal.y + w[lane] * normal.z;
        let answer = plane.stiffness * depth - plane.damping * speed;
        let allowed = if may_pull || answer > 0.0 { answer } else { 0.0 };
        push[lane] = if depth > 0.0 { allowed } else { 0.0 };
    }
    for (force, along) in force.iter_mut().zip(normal.to_array()) {
        for lane in 0..LANES {
            force[lane] += push[lane] * along;
        }
    }
}
