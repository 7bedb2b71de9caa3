//! Gravity: the same acceleration for every point.

use glam::DVec3;

use super::{Account, Force, Store};
use crate::model::Model;
use crate::params::Params;
use crate::state::{Moment, State};

pub(crate) const FORCE: Force = Force {
    name: "gravity",
    description: "the same acceleration for every point",
    formula: "f_i = m_i g",
    store: Store::Gravitational,
    account: Account::None,
    potential,
    parts,
    at,
};

/// −m g·x of one point, J; zero if no force can move it.
pub(crate) fn stored(params: &Params, point: usize, position: DVec3) -> f64 {
    let mass = if params.is_fixed(point) { 0.0 } else { f64::from(params.point_mass[point]) };
    -mass * params.gravity.as_dvec3().dot(position)
}

/// −Σ m g·x over the points that can move, J.
fn potential(_: &Model, params: &Params, state: &State) -> f64 {
    (0..state.position.len()).map(|point| stored(params, point, state.position64(point))).sum()
}

fn at(_: &Model, params: &Params, _: Moment<'_>, point: usize) -> DVec3 {
    let mass = if params.is_fixed(point) { 0.0 } else { f64::from(params.point_mass[point]) };
    params.gravity.as_dvec3() * mass
}

fn parts(_: &Model, params: &Params, _: &State, conservative: &mut [DVec3], _: &mut [DVec3]) {
    let gravity = params.gravity.as_dvec3();
    for point in (0..conservative.len()).filter(|&point| !params.is_fixed(point)) {
        conservative[point] += gravity * f64::from(params.point_mass[point]);
    }
}
