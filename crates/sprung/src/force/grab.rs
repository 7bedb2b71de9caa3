//! Grabs: a point pulled towards a place by a spring of rest length zero.

use glam::DVec3;

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

/// k (target − x) − d v, N, in float64.
pub(crate) fn force(grab: &Grab, position: DVec3, velocity: DVec3) -> DVec3 {
    let pull = (grab.target.as_dvec3() - position) * f64::from(grab.stiffness);
    pull - velocity * f64::from(grab.damping)
}

fn at(_: &Model, params: &Params, moment: Moment<'_>, point: usize) -> DVec3 {
    let here = params.grabs.iter().filter(|grab| grab.point == point);
    here.map(|grab| force(grab, moment.position(point), moment.velocity(point))).sum()
}

fn parts(_: &Model, params: &Params, state: &State, _: &mut [DVec3], rest: &mut [DVec3]) {
    for grab in &params.grabs {
        rest[grab.point] += force(grab, state.position64(grab.point), state.velocity64(grab.point));
    }
}
