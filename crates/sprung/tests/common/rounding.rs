//! How far float32 may be from float64 in one step from the same state: counted operation by operation, not tuned.

use super::{U, position, velocity};
use sprung::{Model, Params, State};

/// The force on one point: how far rounding may throw it off, and what went into it.
#[derive(Clone, Copy, Default)]
pub struct OfForce {
    /// How far each contribution may be off, added up, N.
    pub off: f64,
    /// Sizes of the contributions, added up, N.
    pub sizes: f64,
    /// How many contributions were added.
    pub count: f64,
}

impl OfForce {
    fn add(&mut self, off: f64, size: f64) {
        self.off += off;
        self.sizes += size;
        self.count += 1.0;
    }

    /// Everything together, N: n contributions are added up in n rounded additions, each off by u of what is there.
    pub fn total(&self) -> f64 {
        self.off + self.count * U * self.sizes
    }
}

/// The forces of one step, with u = 2⁻²⁴.
///
/// A spring of length ℓ between points no further than r from the origin:
/// - its axis e is that of the *rounded* positions, off by δ = 2u·r (half an ulp at each end), and by u·ℓ more;
/// - ℓ is a sum of squares and a root: 3u·ℓ besides δ. So the stretch is off by δ + 5u·ℓ + u·|ℓ − L|;
/// - u = e·ℓ·(1/ℓ²) turns by 2δ/ℓ and is rounded four times more: 2δ/ℓ + 7u;
/// - the relative speed w·u: velocities are rounded too, 2u·v, and the product is off by 2δ/ℓ + 10u of |w|;
/// - both enter the tension T, which is then multiplied by u: T·(2δ/ℓ + 9u) more.
///
/// A plane sees a depth off by 2u·r + 4u·d, d being the distance to its point, and a speed off by 5u·v; at the very edge
/// one side may touch and the other not yet, and then the damper's whole force is the difference.
pub fn of_forces(model: &Model, params: &Params, state: &State) -> Vec<OfForce> {
    let mut forces = vec![OfForce::default(); state.position.len()];
    let radius = |at: usize| position(state, at).length();
    let speed = |at: usize| velocity(state, at).length();
    for (spring, &[i, j]) in model.springs().iter().enumerate() {
        let (i, j) = (i as usize, j as usize);
        let length = (position(state, i) - position(state, j)).length();
        if params.spring_cut[spring] || length == 0.0 {
            continue;
        }
        let (stiffness, damping) =
            (f64::from(params.spring_stiffness[spring]), f64::from(params.spring_damping[spring]));
        let apart = (velocity(state, i) - velocity(state, j)).length();
        let fastest = speed(i).max(speed(j));
        let delta = 2.0 * U * radius(i).max(radius(j));
        let turn = 2.0 * delta / length;
        let stretch = (length - f64::from(params.spring_rest_length[spring])).abs();
        let tension = stiffness * stretch + damping * apart;
        let off = stiffness * (delta + 5.0 * U * length + U * stretch)
            + damping * (apart * (turn + 10.0 * U) + 2.0 * U * fastest)
            + tension * (turn + 9.0 * U);
        forces[i].add(off, tension);
        forces[j].add(off, tension);
    }
    for (at, force) in forces.iter_mut().enumerate() {
        let weight = f64::from(params.point_mass[at]) * params.gravity.as_dvec3().length();
        force.add(U * weight, weight);
        for plane in &params.planes {
            let away = plane.point.as_dvec3() - position(state, at);
            let depth = away.dot(plane.normal.as_dvec3());
            let edge = U * (2.0 * radius(at) + 4.0 * away.length());
            let (stiffness, brake) = (f64::from(plane.stiffness), f64::from(plane.damping) * speed(at));
            if depth < -edge {
                continue;
            }
            let jump = if depth.abs() <= edge { brake } else { 0.0 };
            let size = stiffness * depth.abs() + brake;
            force.add(stiffness * edge + 5.0 * U * brake + jump + 3.0 * U * size, size);
        }
        if let Some(push) = params.external_forces.get(&at) {
            force.add(0.0, push.as_dvec3().length());
        }
        for grab in params.grabs.iter().filter(|grab| grab.point == at) {
            let pull = f64::from(grab.stiffness) * (grab.target.as_dvec3() - position(state, at)).length();
            let brake = f64::from(grab.damping) * speed(at);
            let off = f64::from(grab.stiffness) * U * radius(at) + U * brake;
            force.add(off + 3.0 * U * (pull + brake), pull + brake);
        }
    }
    forces
}

/// How far one step may be off at each point, in position (m) and velocity (m/s).
///
/// The force is divided by m and multiplied by dt, and dt, 1/m and the sum with what was dropped before are rounded: 5u of
/// dt·F/m; 2⁻⁶³ where a speed counts as zero. x moves by dt times the *rounded* velocity, u·v, rounded twice more.
pub fn of_step(model: &Model, params: &Params, state: &State) -> Vec<[f64; 2]> {
    let of_point = |(at, force): (usize, OfForce)| {
        if params.is_fixed(at) {
            return [0.0, 0.0];
        }
        let by_mass = params.dt / f64::from(params.point_mass[at]);
        let kick = force.sizes * by_mass;
        let dv = force.total() * by_mass + 5.0 * U * kick + 2f64.powi(-63);
        [params.dt * (dv + 3.0 * U * (velocity(state, at).length() + kick)), dv]
    };
    of_forces(model, params, state).into_iter().enumerate().map(of_point).collect()
}
