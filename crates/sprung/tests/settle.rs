//! Settling in the solver's own layout is what plain code in the user's order makes of it, bit for bit.

use std::ops::ControlFlow;

use sprung::scene::Scene;
use sprung::solver::SymplecticEuler;
use sprung::{Energy, Inline, Params, SettleOptions, Simulation, State, Vec3};

/// Kinetic damping step by step: all velocities become zero whenever the kinetic energy has passed a peak. Gives the steps.
fn settle(params: &Params, simulation: &Simulation, state: &mut State, residual_force: f64) -> u64 {
    let stop = |state: &mut State| {
        state.velocity.fill(Vec3::ZERO);
        state.velocity_low.fill(Vec3::ZERO);
    };
    let model = simulation.model();
    let mut solver = SymplecticEuler::new(model.clone(), params);
    let mut asked = solver.clone();
    let mut residual = |state: &State| {
        asked.load(state);
        asked.residual_force(params)
    };
    stop(state);
    let (mut steps, mut before, mut left) = (0, 0.0, residual(state));
    while left > residual_force {
        assert!(solver.step(params, state, &Inline), "it is stable");
        steps += 1;
        let kinetic = Energy::of(model, params, state).kinetic;
        if kinetic < before {
            stop(state);
            (before, left) = (0.0, residual(state));
        } else {
            before = kinetic;
        }
    }
    steps
}

#[test]
fn settling_is_what_plain_code_makes_of_it() {
    // The steps are those that docs/method.md tells.
    for (name, told) in [("spring", 596), ("chain", 1664), ("jelly", 1068), ("cloth", 2924)] {
        let mut simulation =
            Scene::builtin(name).and_then(|scene| scene.simulation()).expect("it is built in");
        let params = simulation.params().clone();
        let weight = f64::from(params.point_mass.iter().copied().fold(0.0, f32::max))
            * params.gravity.as_dvec3().length();
        let force = 1e-3 * weight;
        let mut state = simulation.state().clone();
        let steps = settle(&params, &simulation, &mut state, force);
        let settled = simulation.settle(SettleOptions::default()).expect("it comes to rest");
        assert_eq!((settled.steps, steps), (told, told), "{name}");
        let now = simulation.state();
        assert!(now.position == state.position && now.position_low == state.position_low, "{name}");
    }
}

/// However small the portions, and what was done is in the log.
#[test]
fn in_portions_it_settles_to_the_same_bits() {
    let mut at_once = Scene::builtin("jelly").and_then(|scene| scene.simulation()).expect("it is built in");
    at_once.steps(30).expect("it is stable");
    let begun = at_once.clone();
    let told = at_once.settle(SettleOptions::default()).expect("it comes to rest");
    for portion in [1, 7, 1000] {
        let mut settling = begun.clone().settling(SettleOptions::default());
        let mut portions = 0;
        let mut settled = loop {
            portions += 1;
            let mut left = portion;
            let may_go_on = &mut || {
                left -= 1;
                left >= 0
            };
            match settling.go_on(may_go_on).expect("it comes to rest") {
                ControlFlow::Continue(rest) => settling = rest,
                ControlFlow::Break(simulation) => break simulation,
            }
            assert_eq!(settling.so_far().steps, portions * portion as u64);
        };
        assert_eq!(portions, told.steps.div_ceil(portion as u64));
        assert_eq!((settled.state(), settled.log()), (at_once.state(), at_once.log()));
        let mut at_once = at_once.clone();
        for simulation in [&mut settled, &mut at_once] {
            simulation.steps(50).expect("it is stable");
        }
        assert_eq!(settled.state(), at_once.state());
    }
    let never = SettleOptions { residual_force: Some(0.0), max_steps: 10 };
    let failed =
        begun.clone().settling(never).go_on(&mut || true).map(|_| ()).expect_err("10 steps are too few");
    assert_eq!(Some(failed), begun.clone().settle(never).err());
}
