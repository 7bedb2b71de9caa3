//! The engine against the naive float64 twin: the four scenes, and one step from any state.

mod common;

use common::motion::twin_of;
use common::twin::{Point, Twin, norm, sub};
use common::{U, network, rounding, scenes};
use proptest::prelude::*;
use sprung::{ContactLaw, Inline, Plane, State, Vec3, solver::SymplecticEuler};

#[test]
fn springs_are_those_of_the_double_loop_in_the_same_order() {
    for scene in scenes::four() {
        let simulation = scenes::engine(&scene);
        let pairs: Vec<[u32; 2]> = scene.twin.springs.iter().map(|s| [s.i as u32, s.j as u32]).collect();
        assert_eq!(pairs.len(), scene.springs, "{}", scene.name);
        assert!(simulation.model().springs() == pairs, "{}: other springs, or another order", scene.name);
        // A rest length is the distance of two rounded positions: each is off by at most half an ulp in x, y and z,
        // and the length is rounded three times.
        for (spring, &rest) in scene.twin.springs.iter().zip(simulation.model().spring_rest_length()) {
            let farthest = norm(scene.twin.points[spring.i].x).max(norm(scene.twin.points[spring.j].x));
            assert!((f64::from(rest) - spring.rest).abs() <= U * (2.0 * farthest + 3.0 * spring.rest));
        }
    }
}

#[test]
fn the_four_scenes_stay_within_a_tenth_of_a_millimetre_for_200_steps() {
    for mut scene in scenes::four() {
        let mut simulation = scenes::engine(&scene);
        for step in 1..=200 {
            simulation.step(scene.dt).expect("the scene is stable");
            scene.twin.step(scene.dt);
            let furthest = furthest_apart(&scene.twin, simulation.state());
            assert!(furthest < 1e-4, "{}: {furthest:e} m apart after step {step}", scene.name);
        }
        // It has moved, so the comparison meant something.
        let moved = furthest_apart(
            &scenes::four().into_iter().find(|s| s.name == scene.name).expect("it").twin,
            simulation.state(),
        );
        assert!(moved > 1.0, "{}", scene.name);
    }
}

fn furthest_apart(twin: &Twin, state: &State) -> f64 {
    let apart = |(point, x): (&Point, &Vec3)| norm(sub(point.x, x.as_dvec3().to_array()));
    twin.points.iter().zip(&state.position).map(apart).fold(0.0, f64::max)
}

#[test]
fn reset_is_bit_for_bit() {
    for scene in scenes::four() {
        let mut simulation = scenes::engine(&scene);
        let (state, params) = (simulation.state().clone(), simulation.params().clone());
        common::steps(&mut simulation, 50);
        simulation.change(sprung::Change::Gravity(Vec3::ZERO)).expect("allowed");
        simulation.change(sprung::Change::Dt(0.003)).expect("allowed");
        common::steps(&mut simulation, 5);
        assert_ne!(simulation.state_hash(), state.hash(), "{}", scene.name);
        simulation.reset();
        assert_eq!((simulation.state(), simulation.params()), (&state, &params), "{}", scene.name);
        // And from there the same run again, as from a fresh start.
        common::steps(&mut simulation, 20);
        let mut fresh = scenes::engine(&scene);
        common::steps(&mut fresh, 20);
        assert_eq!(simulation.state(), fresh.state(), "{}", scene.name);
    }
}

proptest! {
    #![proptest_config(common::cases(400))]

    #[test]
    fn one_step_from_any_state_agrees_within_rounding(network in network(), grounded in any::<bool>()) {
        let (model, mut params, state) = network.build();
        if grounded {
            params.planes.push(Plane { law: ContactLaw::Report, ..Plane::level(-2.0, 50.0, 10.0) });
        }
        let mut twin = twin_of(&model, &params, &state);
        let tolerances = rounding::of_step(&model, &params, &state);
        let mut after = state.clone();
        SymplecticEuler::new(model.clone(), &params).step(&params, &mut after, &Inline);
        twin.step(params.dt);
        for (point, [allowed_x, allowed_v]) in tolerances.into_iter().enumerate() {
            let off_v = norm(sub(twin.points[point].v, common::velocity(&after, point).to_array()));
            let off_x = norm(sub(twin.points[point].x, common::position(&after, point).to_array()));
            prop_assert!(off_v <= allowed_v, "point {}: v off by {:e}, allowed {:e}", point, off_v, allowed_v);
            prop_assert!(off_x <= allowed_x, "point {}: x off by {:e}, allowed {:e}", point, off_x, allowed_x);
        }
    }
}
