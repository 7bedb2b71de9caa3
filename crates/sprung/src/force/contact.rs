//! Contact with colliders; their shapes and laws are in [`contact`](crate::contact).

use glam::DVec3;

use super::{Account, Force, Store};
use crate::model::Model;
use crate::params::Params;
use crate::state::{Moment, State};

pub(crate) const FORCE: Force = Force {
    name: "contact",
    description: "planes that push points back out",
    formula: "f_i = (k_c p − k_c,d v_i·n) n while the depth p = (point − x_i)·n > 0; under the law \"push\" never a pull",
    store: Store::Contact,
    account: Account::Contact,
    potential,
    parts,
    at,
};

/// Σ ½k_c·p² of one point over the planes, J; zero if no force can move it.
pub(crate) fn stored(params: &Params, point: usize, position: DVec3) -> f64 {
    if params.is_fixed(point) {
        return 0.0;
    }
    params.planes.iter().map(|plane| plane.potential(position)).sum()
}

/// Σ ½k_c·p² over the touching points that can move, J.
fn potential(_: &Model, params: &Params, state: &State) -> f64 {
    if params.planes.is_empty() {
        return 0.0;
    }
    (0..state.position.len()).map(|point| stored(params, point, state.position64(point))).sum()
}

fn at(_: &Model, params: &Params, moment: Moment<'_>, point: usize) -> DVec3 {
    if params.is_fixed(point) {
        return DVec3::ZERO;
    }
    let of_plane = |plane: &crate::contact::Plane| {
        let (spring, other) = plane.force_parts(moment.position(point), moment.velocity(point));
        spring + other
    };
    params.planes.iter().map(of_plane).sum()
}

fn parts(_: &Model, params: &Params, state: &State, conservative: &mut [DVec3], rest: &mut [DVec3]) {
    for plane in &params.planes {
        for point in (0..conservative.len()).filter(|&point| !params.is_fixed(point)) {
            let (spring, other) = plane.force_parts(state.position64(point), state.velocity64(point));
            conservative[point] += spring;
            rest[point] += other;
        }
    }
}
