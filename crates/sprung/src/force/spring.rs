//! Springs with axial dampers. The float32 form is in [`kernel`](crate::kernel), where speed is decided.

use glam::DVec3;

use super::{Account, Force, Store};
use crate::math::COINCIDENT_SQUARED;
use crate::model::Model;
use crate::params::Params;
use crate::state::{Moment, State};

pub(crate) const FORCE: Force = Force {
    name: "spring",
    description: "springs with a damper along their axis",
    formula: "f_i = −(k_s(ℓ − L) + k_d (v_i − v_j)·u) u, f_j = −f_i, u = (x_i − x_j)/ℓ",
    store: Store::Elastic,
    account: Account::Dampers,
    potential,
    parts,
    at,
};

/// ½k_s(ℓ − L)² of one spring along e = x_i − x_j, J; zero if it is cut.
pub(crate) fn stored(params: &Params, spring: usize, axis: DVec3) -> f64 {
    if params.spring_cut[spring] {
        return 0.0;
    }
    let stretch = axis.length() - f64::from(params.spring_rest_length[spring]);
    0.5 * f64::from(params.spring_stiffness[spring]) * stretch * stretch
}

/// −k_s(ℓ − L) u and −k_d (w·u) u: the spring's and the damper's force on the first end, N, with e = x_i − x_j and
/// w = v_i − v_j. Zero if it is cut or has no axis.
pub(crate) fn pull_and_brake(params: &Params, spring: usize, axis: DVec3, apart: DVec3) -> (DVec3, DVec3) {
    if params.spring_cut[spring] || axis.length_squared() < f64::from(COINCIDENT_SQUARED) {
        return (DVec3::ZERO, DVec3::ZERO);
    }
    let length = axis.length();
    let u = axis / length;
    let [pull, brake] = tensions(params, spring, length, apart.dot(u));
    (u * -pull, u * -brake)
}

/// k_s(ℓ − L) and k_d·dℓ/dt of one spring that is not cut: how hard spring and damper draw its ends together, N.
pub(crate) fn tensions(params: &Params, spring: usize, length: f64, rate: f64) -> [f64; 2] {
    let stretch = length - f64::from(params.spring_rest_length[spring]);
    [f64::from(params.spring_stiffness[spring]) * stretch, f64::from(params.spring_damping[spring]) * rate]
}

/// Σ ½k_s(ℓ − L)² over the springs that are not cut, J.
fn potential(model: &Model, params: &Params, state: &State) -> f64 {
    let axis = |&[i, j]: &[u32; 2]| state.position64(i as usize) - state.position64(j as usize);
    model.springs.iter().enumerate().map(|(spring, ends)| stored(params, spring, axis(ends))).sum()
}

fn at(model: &Model, params: &Params, moment: Moment<'_>, point: usize) -> DVec3 {
    let mut sum = DVec3::ZERO;
    for &spring in model.springs_at(point) {
        let [i, j] = model.springs[spring as usize].map(|end| end as usize);
        let axis = moment.position(i) - moment.position(j);
        let apart = moment.velocity(i) - moment.velocity(j);
        let (pull, brake) = pull_and_brake(params, spring as usize, axis, apart);
        sum += if point == i { pull + brake } else { -(pull + brake) };
    }
    sum
}

fn parts(model: &Model, params: &Params, state: &State, conservative: &mut [DVec3], rest: &mut [DVec3]) {
    for (spring, &[i, j]) in model.springs.iter().enumerate() {
        let (i, j) = (i as usize, j as usize);
        let axis = state.position64(i) - state.position64(j);
        let apart = state.velocity64(i) - state.velocity64(j);
        let (pull, brake) = pull_and_brake(params, spring, axis, apart);
        conservative[i] += pull;
        conservative[j] -= pull;
        rest[i] += brake;
        rest[j] -= brake;
    }
}
