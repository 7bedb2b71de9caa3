//! Settling in the solver's own layout is what plain code in the user's order makes of it, bit for bit.

use std::ops::ControlFlow;

use sprung::scene::Scene;
use sprung::solver::SymplecticEuler;
use sprung::{
    Change, Energy, Inline, Material, ModelBuilder, Params, SettleOptions, Simulation, State, Vec3,
};

/// Kinetic damping step by step: whenever the kinetic energy has passed a peak, all points go half a step back and their
/// velocities become zero. Gives the steps.
fn settle(params: &Params, simulation: &Simulation, state: &mut State, residual_force: f64) -> u64 {
    let stop = |state: &mut State| {
        for point in (0..state.position.len()).filter(|&point| !params.is_fixed(point)) {
            let whole = |high: Vec3, low: Vec3| high.as_dvec3() + low.as_dvec3();
            let back = 0.5 * params.dt * whole(state.velocity[point], state.velocity_low[point]);
            let exact = whole(state.position[point], state.position_low[point]) - back;
            state.position[point] = exact.as_vec3();
            state.position_low[point] = (exact - state.position[point].as_dvec3()).as_vec3();
        }
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
    for (name, told) in [("spring", 596), ("chain", 1694), ("jelly", 1072), ("cloth", 2846)] {
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

/// A step keeps another quantity than the energy: whoever merely set velocities to zero would feed the fast vibrations of an
/// undamped network with every stop, until they explode.
#[test]
fn what_has_no_damper_and_a_long_step_comes_to_rest() {
    let mut builder = ModelBuilder::new();
    let points: Vec<usize> = (0..25)
        .map(|point| {
            let mass = if point == 0 { 0.0 } else { 0.02 };
            builder.add_point(Vec3::new(0.0, -0.1 * point as f32, 0.0), mass).expect("allowed")
        })
        .collect();
    for ends in points.windows(2) {
        builder.add_spring(ends[0], ends[1], Material { stiffness: 400.0, damping: 0.0 }).expect("allowed");
    }
    let mut simulation = builder.simulation().expect("allowed");
    // The stiffest vibration has ω = 2√(k/m): dt = 0.003 s is 42 % of what is stable, 0.0067 s is 95 %.
    for dt in [0.003, 0.0067] {
        simulation.reset();
        simulation.change(Change::Dt(dt)).expect("allowed");
        let options = SettleOptions { residual_force: Some(0.01), max_steps: 20_000 };
        let settled = simulation.settle(options).expect("it comes to rest");
        // Each link hangs by the weight below it: the lowest point is Σ j·m·g/k below where it was.
        let sag: f64 = (1..25).map(|links| f64::from(links) * 0.02 * 9.81 / 400.0).sum();
        let lowest = f64::from(simulation.state().position[24].y);
        // Forces of up to 0.01 N at each of 24 points stretch the chain by less than this.
        let left = (1..25).map(|links| f64::from(links) * 0.01 / 400.0).sum::<f64>();
        assert!((lowest + 2.4 + sag).abs() < left, "dt = {dt}: {lowest}, {settled:?}");
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
