//! The layout that the step works in does not matter: a network whose points are numbered in another way moves the same.

mod common;

use common::{Random, network, rounding};
use proptest::prelude::*;
use sprung::scene::{BUILTIN, Kind, Scene};
use sprung::{Inline, Material, Model, ModelBuilder, Params, State, solver::SymplecticEuler};

/// The same scene with its points and springs in a random order; `number[old]` is a point's new number.
struct Renumbered {
    model: Model,
    params: Params,
    state: State,
    number: Vec<usize>,
}

fn shuffled(count: usize, random: &mut Random) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    (1..count).rev().for_each(|last| order.swap(last, random.below(last + 1)));
    order
}

fn renumber(model: &Model, params: &Params, state: &State, random: &mut Random) -> Renumbered {
    let points = shuffled(model.point_count(), random);
    let mut number = vec![0; points.len()];
    points.iter().enumerate().for_each(|(new, &old)| number[old] = new);

    let mut builder = ModelBuilder::new();
    for &old in &points {
        let new = builder.add_point(state.position[old], params.point_mass[old]).expect("allowed");
        builder.set_velocity(new, state.velocity[old]).expect("allowed");
        if params.point_pinned[old] {
            builder.pin(new).expect("it was just made");
        }
    }
    let mut cut = Vec::new();
    for old in shuffled(model.spring_count(), random) {
        let [a, b] = model.springs()[old].map(|point| number[point as usize]);
        let (stiffness, damping) = (params.spring_stiffness[old], params.spring_damping[old]);
        let new = builder.add_spring(a, b, Material { stiffness, damping }).expect("allowed");
        builder.set_rest_length(new, params.spring_rest_length[old]).expect("allowed");
        cut.push(params.spring_cut[old]);
    }
    let (new_model, mut new_params, mut new_state) = builder.build().expect("there are points");
    for (new, &old) in points.iter().enumerate() {
        new_state.position_low[new] = state.position_low[old];
        new_state.velocity_low[new] = state.velocity_low[old];
    }
    (new_params.dt, new_params.gravity, new_params.planes) =
        (params.dt, params.gravity, params.planes.clone());
    new_params.spring_cut = cut.into();
    new_params.external_forces =
        params.external_forces.iter().map(|(&point, &force)| (number[point], force)).collect();
    new_params.grabs = params.grabs.clone();
    new_params.grabs.iter_mut().for_each(|grab| grab.point = number[grab.point]);
    Renumbered { model: new_model, params: new_params, state: new_state, number }
}

/// How far one step of the renumbered scene is from one of the scene itself, for the worst point: in position and velocity,
/// as a share of what rounding may do. Each of the two may be off by the tolerance of a step.
fn worst(model: &Model, params: &Params, state: &State, random: &mut Random) -> f64 {
    let other = renumber(model, params, state, random);
    let step = |model: &Model, params: &Params, state: &State| {
        let mut after = state.clone();
        SymplecticEuler::new(model.clone(), params).step(params, &mut after, &Inline);
        after
    };
    let (here, there) = (step(model, params, state), step(&other.model, &other.params, &other.state));
    let shares =
        rounding::of_step(model, params, state).into_iter().enumerate().map(|(point, [may_x, may_v])| {
            let number = other.number[point];
            let x = (common::position(&here, point) - common::position(&there, number)).length();
            let v = (common::velocity(&here, point) - common::velocity(&there, number)).length();
            let share = |off: f64, may: f64| if off == 0.0 { 0.0 } else { off / (2.0 * may) };
            share(x, may_x).max(share(v, may_v))
        });
    shares.fold(0.0, f64::max)
}

#[test]
fn built_in_scenes_move_the_same_however_their_points_are_numbered() {
    let random = &mut Random(1);
    for scene in BUILTIN.iter().filter(|scene| scene.kind != Kind::Benchmark) {
        let mut run =
            Scene::builtin(scene.name).and_then(|scene| scene.simulation()).expect("it is built in");
        run.steps(40).expect("it is stable");
        let share = worst(run.model(), run.params(), run.state(), random);
        assert!(share <= 1.0, "{}: {share} of what rounding may do", scene.name);
    }
}

proptest! {
    #![proptest_config(common::cases(200))]

    #[test]
    fn random_networks_move_the_same_however_their_points_are_numbered(network in network(), seed in any::<u64>()) {
        let (model, params, state) = common::driven(&network);
        let share = worst(&model, &params, &state, &mut Random(seed));
        prop_assert!(share <= 1.0, "{} of what rounding may do", share);
    }
}
