//! Every force against its potential, and the step against every force.

mod common;

use common::{Network, driven, network, rounding, velocity};
use proptest::prelude::*;
use sprung::force::{Account, FORCES, Force};
use sprung::{DVec3, Inline, Model, Params, State, solver::SymplecticEuler};

/// The two parts of a force on every point: conservative, and the rest.
fn parts(force: &Force, model: &Model, params: &Params, state: &State) -> [Vec<DVec3>; 2] {
    let mut conservative = vec![DVec3::ZERO; model.point_count()];
    let mut rest = conservative.clone();
    (force.parts)(model, params, state, &mut conservative, &mut rest);
    [conservative, rest]
}

/// −∇potential of one coordinate by a central difference of 2h, and how far that may be off.
fn slope(force: &Force, model: &Model, params: &Params, state: &State, point: usize, axis: usize) -> f64 {
    let potential = |shift: f32| {
        let mut moved = state.clone();
        moved.position_low[point][axis] += shift; // float64 reads both parts: a shift far below an ulp of the position
        (force.potential)(model, params, &moved)
    };
    -(potential(H) - potential(-H)) / (2.0 * f64::from(H))
}

/// 2⁻¹⁷ m: exact in float32, and so are its sums with the residues, which are zero here.
const H: f32 = 1.0 / 131_072.0;

/// How far a central difference may be off at a point.
///
/// Truncation is h²/6·φ''': for a spring, whose φ = ½k(ℓ − L)² has φ''' ≤ 3k(1 + L/ℓ)/ℓ; and round-off is 2⁻⁵³·φ/h,
/// where the heights that make up the energy of gravity may cancel, but not their roundings.
/// A contact begins at depth zero: within h of it the second derivative jumps by k_c, which makes k_c·h.
fn allowed(force: &Force, model: &Model, params: &Params, state: &State) -> f64 {
    let h = f64::from(H);
    let heights = (0..model.point_count()).map(|at| {
        f64::from(params.point_mass[at])
            * params.gravity.as_dvec3().length()
            * common::position(state, at).length()
    });
    let energy = (force.potential)(model, params, state).abs() + heights.sum::<f64>();
    let sharpest = model.springs().iter().enumerate().map(|(spring, &[i, j])| {
        let length = (common::position(state, i as usize) - common::position(state, j as usize)).length();
        let rest = f64::from(params.spring_rest_length[spring]);
        3.0 * f64::from(params.spring_stiffness[spring]) * (1.0 + rest / length) / length
    });
    let contact: f64 = params.planes.iter().map(|plane| f64::from(plane.stiffness)).sum();
    let edge = params
        .planes
        .iter()
        .any(|plane| state.position.iter().any(|&position| plane.depth(position).abs() < 4.0 * H));
    // Many terms are summed: a dozen roundings of the sum. Gravity is linear and has no truncation.
    h * h / 6.0 * sharpest.sum::<f64>()
        + 16.0 * 2f64.powi(-53) * energy / h
        + if edge { contact * h } else { 0.0 }
}

/// Residues away, so that shifts are exact, and points that nearly coincide apart: there no difference is small enough.
fn spread(network: &Network) -> Option<Network> {
    let near = |&(a, b, ..): &(usize, usize, f32, f32, f32)| {
        let (a, b) =
            (DVec3::from_array(network.points[a].0.map(f64::from)), network.points[b].0.map(f64::from));
        (a - DVec3::from_array(b)).length() < 0.1
    };
    let network = Network { low: vec![0.0; network.low.len()], ..network.clone() };
    (!network.springs.iter().any(near)).then_some(network)
}

proptest! {
    #![proptest_config(common::cases(150))]

    #[test]
    fn the_conservative_part_is_minus_the_slope_of_the_potential(network in network()) {
        let Some(network) = spread(&network) else { return Ok(()) };
        let (model, params, state) = driven(&network);
        for force in FORCES {
            let [conservative, _] = parts(force, &model, &params, &state);
            let allowed = allowed(force, &model, &params, &state);
            // A contact has no energy to give at a fixed point, which cannot move.
            for point in (0..model.point_count()).filter(|&point| !params.is_fixed(point)) {
                for (axis, found) in conservative[point].to_array().into_iter().enumerate() {
                    let expected = slope(force, &model, &params, &state, point, axis);
                    prop_assert!(
                        (found - expected).abs() <= allowed,
                        "{}: point {} axis {}: {} N, slope {} N, allowed {:e}", force.name, point, axis, found, expected, allowed
                    );
                }
            }
        }
    }

    #[test]
    fn dampers_and_contact_only_take_energy_out(network in network()) {
        let (model, params, state) = driven(&network);
        for force in FORCES {
            let [_, rest] = parts(force, &model, &params, &state);
            let powers = rest.iter().enumerate().map(|(at, f)| f.dot(velocity(&state, at)));
            let (power, sizes) = powers.fold((0.0, 0.0), |(sum, sizes): (f64, f64), p| (sum + p, sizes + p.abs()));
            match force.account {
                // Fixed points do not move, so their velocities are zero in a run; here they are as random as any.
                Account::Dampers | Account::Contact => prop_assert!(power <= 1e-14 * sizes, "{}: {} W", force.name, power),
                Account::None => prop_assert!(rest.iter().all(|f| *f == DVec3::ZERO), "{} has no rest", force.name),
                Account::WorkIn => {}
            }
        }
    }

    #[test]
    fn the_float32_step_is_the_sum_of_all_forces(network in network()) {
        let (model, params, mut state) = driven(&network);
        // As in a run: fixed points do not move.
        for at in (0..model.point_count()).filter(|&at| params.is_fixed(at)) {
            state.velocity[at] = sprung::Vec3::ZERO;
        }
        let mut sum = vec![DVec3::ZERO; model.point_count()];
        for force in FORCES {
            let [conservative, rest] = parts(force, &model, &params, &state);
            sum.iter_mut().zip(conservative.iter().zip(&rest)).for_each(|(sum, (c, r))| *sum += *c + *r);
        }
        let allowed = rounding::of_step(&model, &params, &state);
        let mut after = state.clone();
        SymplecticEuler::new(model.clone(), &params).step(&params, &mut after, &Inline);
        for (at, [allowed_x, allowed_v]) in allowed.into_iter().enumerate() {
            let kick = if params.is_fixed(at) { DVec3::ZERO } else { sum[at] * params.dt / f64::from(params.point_mass[at]) };
            let expected_v = velocity(&state, at) + kick;
            let expected_x = common::position(&state, at) + expected_v * params.dt;
            let (off_v, off_x) = ((velocity(&after, at) - expected_v).length(), (common::position(&after, at) - expected_x).length());
            prop_assert!(off_v <= allowed_v, "point {}: v off by {:e}, allowed {:e}", at, off_v, allowed_v);
            prop_assert!(off_x <= allowed_x, "point {}: x off by {:e}, allowed {:e}", at, off_x, allowed_x);
        }
    }
}

#[test]
fn every_force_is_named_once_and_explained() {
    for (at, force) in FORCES.iter().enumerate() {
        assert!(FORCES[..at].iter().all(|other| other.name != force.name), "{} stands twice", force.name);
        assert!(!force.description.is_empty() && !force.formula.is_empty(), "{}", force.name);
    }
}
