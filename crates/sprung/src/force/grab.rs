//! Grabs: a point pulled towards a place by a spring of rest length zero.

use glam::{DVec3, Vec3};

use super::{Account, Force, Store};
use crate::model::Model;
use crate::params::{Grab, Params};
use crate::state::{Moment, State};

/// A hand may move its end at will, so all of its work counts as put in from outside; it stores nothing of the system's.
pub(crate) const FORCE: Force = Force {
    name: "grab",
    description: "a point pulled towards a place",
    formula: "f_i = k (target − x_i) − d v_i",
    store: Store::None,
    account: Account::WorkIn,
    potential: |_, _, _| 0.0,
    parts,
    at,
};

pub(crate) fn accumulate(params: &Params, state: &State, forces: &mut [Vec3]) {
    for grab in &params.grabs {
        let pull = (grab.target - state.position[grab.point]) * grab.stiffness;
        forces[grab.point] += pull - state.velocity[grab.point] * grab.damping;
    }
}

/// The grabbed points and the forces on them, in float64.
pub(crate) fn forces<'a>(params: &'a Params, state: &'a State) -> impl Iterator<Item = (usize, DVec3)> + 'a {
    params.grabs.iter().map(|grab| (grab.point, force(grab, state.into())))
}

fn force(grab: &Grab, moment: Moment<'_>) -> DVec3 {
    let pull = (grab.target.as_dvec3() - moment.position(grab.point)) * f64::from(grab.stiffness);
    pull - moment.velocity(grab.point) * f64::from(grab.damping)
}

fn at(_: &Model, params: &Params, moment: Moment<'_>, point: usize) -> DVec3 {
    params.grabs.iter().filter(|grab| grab.point == point).map(|grab| force(grab, moment)).sum()
}

fn parts(_: &Model, params: &Params, state: &State, _: &mut [DVec3], rest: &mut [DVec3]) {
    forces(params, state).for_each(|(point, force)| rest[point] += force);
}
