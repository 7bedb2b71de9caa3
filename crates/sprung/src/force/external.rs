//! Constant forces on single points.

use glam::DVec3;

use super::{Account, Force, Store};
use crate::model::Model;
use crate::params::Params;
use crate::state::{Moment, State};

pub(crate) const FORCE: Force = Force {
    name: "external",
    description: "constant forces on single points",
    formula: "f_i = F_i",
    store: Store::None,
    account: Account::WorkIn,
    potential: |_, _, _| 0.0,
    parts,
    at,
};

fn at(_: &Model, params: &Params, _: Moment<'_>, point: usize) -> DVec3 {
    params.external_forces.get(&point).map_or(DVec3::ZERO, |force| force.as_dvec3())
}

/// The pushed points and the forces on them, in float64.
pub(crate) fn forces(params: &Params) -> impl Iterator<Item = (usize, DVec3)> {
    params.external_forces.iter().map(|(&point, &force)| (point, force.as_dvec3()))
}

fn parts(_: &Model, params: &Params, _: &State, _: &mut [DVec3], rest: &mut [DVec3]) {
    forces(params).for_each(|(point, force)| rest[point] += force);
}
