//! Springs with axial dampers. The float32 form is in [`kernel`](crate::kernel), where speed is decided.

use glam::DVec3;

use super::{Account, Force, Store};
use crate::math::COINCIDENT_SQUARED;
use crate::model::Model;
use crate::params::Params;
use crate::state::State;

pub(crate) const FORCE: Force = Force {
    name: "spring",
    description: "springs with a damper along their axis",
    formula: "f_i = −(k_s(ℓ − L) + k_d (v_i − v_j)·u) u, f_j = −f_i, u = (x_i − x_j)/ℓ",
    store: Store::Elastic,
    account: Account::Dampers,
    potential,
    parts,
};

/// Σ ½k_s(ℓ − L)² over the springs that are not cut, J.
fn potential(model: &Model, params: &Params, state: &State) -> f64 {
    let mut energy = 0.0;
    for (spring, &[i, j]) in model.springs.iter().enumerate() {
        if params.spring_cut[spring] {
            continue;
        }
        let length = (state.position64(i as usize) - state.position64(j as usize)).length();
        let stretch = length - f64::from(params.spring_rest_length[spring]);
        energy += 0.5 * f64::from(params.spring_stiffness[spring]) * stretch * stretch;
    }
    energy
}

fn parts(model: &Model, params: &Params, state: &State, conservative: &mut [DVec3], rest: &mut [DVec3]) {
    for (spring, &[i, j]) in model.springs.iter().enumerate() {
        let (i, j) = (i as usize, j as usize);
        let axis = state.position64(i) - state.position64(j);
        if params.spring_cut[spring] || axis.length_squared() < f64::from(COINCIDENT_SQUARED) {
            continue;
        }
        let length = axis.length();
        let u = axis / length;
        let stretch = length - f64::from(params.spring_rest_length[spring]);
        let pull = u * -(f64::from(params.spring_stiffness[spring]) * stretch);
        let approach = (state.velocity64(i) - state.velocity64(j)).dot(u);
        let brake = u * -(f64::from(params.spring_damping[spring]) * approach);
        conservative[i] += pull;
        conservative[j] -= pull;
        rest[i] += brake;
        rest[j] -= brake;
    }
}
