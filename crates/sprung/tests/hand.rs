//! Carrying a point along and putting it somewhere: exact, whatever pulls at it.

mod common;

use common::{driven, network, scenes, simulation, steps};
use proptest::prelude::*;
use sprung::{Change, Code, Inline, Material, ModelBuilder, SettleOptions, Simulation, Vec3, stability};

fn carry(run: &mut Simulation, point: usize, velocity: Option<Vec3>) {
    run.change(Change::Carry(point, velocity)).expect("allowed");
}

#[test]
fn a_carried_point_goes_at_the_hands_velocity_whatever_pulls_at_it() {
    let mut run = scenes::engine(&scenes::jelly());
    let (corner, velocity) = (999, Vec3::new(0.25, 3.0, -1.5));
    let from = common::position(run.state(), corner);
    run.change(Change::Force(corner, Vec3::new(0.0, -1e6, 0.0))).expect("allowed");
    carry(&mut run, corner, Some(velocity));
    steps(&mut run, 300);
    // n products v·dt, each rounded once; their sum keeps what rounding drops.
    let way = velocity.as_dvec3() * f64::from(0.01f32) * 300.0;
    let off = (common::position(run.state(), corner) - from - way).length();
    assert!(off <= 300.0 * common::U * 0.01 * velocity.as_dvec3().length(), "{off:e} m off");
    assert_eq!(run.state().velocity[corner], velocity);
    // Its neighbour was pulled along.
    assert!(run.state().velocity[998].y > 0.0);
}

#[test]
fn a_point_that_is_let_go_keeps_its_velocity_unless_it_is_pinned() {
    let mut run = scenes::engine(&scenes::chain());
    let velocity = Vec3::new(1.0, 2.0, 0.5);
    for point in [0, 14] {
        carry(&mut run, point, Some(velocity));
    }
    assert!(
        run.params().is_fixed(14) && run.params().inverse_mass(14) == 0.0 && !run.params().is_anchored(14)
    );
    let place = run.state().position[0];
    steps(&mut run, 5);
    assert_ne!(run.state().position[0], place, "a hand moves a pinned point, too");
    for point in [0, 14] {
        carry(&mut run, point, None);
    }
    let place = run.state().position[0];
    assert_eq!((run.state().velocity[0], run.state().velocity[14]), (Vec3::ZERO, velocity));
    steps(&mut run, 1);
    // The chain is limp at its end: one step of gravity, and of nothing else that is large.
    assert!((run.state().velocity[14] - velocity).length() < 0.5);
    assert_eq!(run.state().position[0], place);
}

#[test]
fn dampers_feel_the_hands_velocity() {
    let material = Material { stiffness: 0.0, damping: 3.0 };
    let (model, mut params, state) = common::oscillator(2.0, material, 1.0, 1.0, 0.0);
    (params.dt, params.point_mass) = (0.5, std::sync::Arc::new(vec![2.0, 1.0]));
    let mut run = simulation((model, params, state));
    carry(&mut run, 1, Some(Vec3::X * 4.0));
    steps(&mut run, 1);
    // v = k_d·4/m·dt = 3·4/2·0.5
    assert_eq!(run.state().velocity[0], Vec3::X * 3.0);
}

#[test]
fn a_carried_point_counts_as_fixed_for_stability() {
    let scene = scenes::cloth();
    let (mut carried, mut pinned) = (scenes::engine(&scene), scenes::engine(&scene));
    carry(&mut carried, 210, Some(Vec3::X));
    pinned.change(Change::Pin(210..211, true)).expect("allowed");
    let limits = |run: &Simulation| {
        let (model, params, positions) = (run.model(), run.params(), &run.state().position);
        let sharp = stability::sharp(model, params, positions);
        (stability::certified(model, params, positions), stability::every_configuration(model, params), sharp)
    };
    assert_eq!(limits(&carried), limits(&pinned));
    // A grab of the same point pulls at nothing that can move.
    let grab = sprung::Grab { point: 210, target: Vec3::ZERO, stiffness: 1e12, damping: 0.0 };
    carried.change(Change::Grab(grab)).expect("allowed");
    assert_eq!(limits(&carried).0, limits(&pinned).0);
    let work_in = carried.state().ledger.work_in;
    pinned.change(Change::Grab(grab)).expect("allowed");
    steps(&mut carried, 20);
    assert!((carried.state().ledger.work_in - work_in).abs() < 1e4, "the grab's huge force does no work");
}

#[test]
fn a_carried_point_is_held_still_while_a_scene_settles() {
    let mut run = scenes::engine(&scenes::chain());
    carry(&mut run, 14, Some(Vec3::new(0.0, 1.0, 0.0)));
    let place = run.state().position[14];
    run.settle(SettleOptions { residual_force: Some(0.5), ..SettleOptions::default() }).expect("it settles");
    assert_eq!((run.state().position[14], run.state().velocity[14]), (place, Vec3::Y));
    steps(&mut run, 1);
    assert!(run.state().position[14].y > place.y);
}

#[test]
fn a_placed_point_is_there_at_once_and_at_rest() {
    let mut run = scenes::engine(&scenes::chain());
    steps(&mut run, 30);
    let (before, work_in) = (run.energy().total(), run.state().ledger.work_in);
    for place in [Vec3::new(20.0, 5.0, 1.0), Vec3::new(22.0, 6.0, 2.0), Vec3::new(21.0, 1e-40, 3.0)] {
        run.change(Change::Place(14, place)).expect("allowed");
    }
    assert_eq!((run.state().position[14], run.state().velocity[14]), (Vec3::new(21.0, 0.0, 3.0), Vec3::ZERO));
    let jump = run.energy().total() - before;
    let booked = run.state().ledger.work_in - work_in;
    assert!((jump - booked).abs() <= 1e-12 * (before.abs() + jump.abs()), "{jump} J, booked {booked} J");
    // Only the last place is in the log, and leads to the same bits.
    assert_eq!(run.log().len(), 1);
    steps(&mut run, 20);
    let end = run.state().clone();
    run.rewind_to(10).expect("it is recorded");
    run.rewind_to(50).expect("it is recorded");
    assert_eq!(run.state(), &end);
}

#[test]
fn what_a_hand_cannot_do_is_refused() {
    let mut builder = ModelBuilder::new();
    builder.add_point(Vec3::ZERO, 1.0).expect("allowed");
    let mut run = builder.simulation().expect("there is a point");
    for bad in [f32::NAN, f32::INFINITY, 2e9] {
        let bad = Vec3::new(0.0, bad, 0.0);
        for change in [Change::Carry(0, Some(bad)), Change::Place(0, bad)] {
            assert_eq!(run.change(change).map_err(|error| error.code()), Err(Code::OutOfRange));
        }
    }
    for change in [Change::Carry(1, Some(Vec3::X)), Change::Carry(1, None), Change::Place(1, Vec3::X)] {
        assert_eq!(run.change(change).map_err(|error| error.code()), Err(Code::OutOfRange));
    }
    assert!(run.log().is_empty() && run.params().carried.is_empty());
}

proptest! {
    #![proptest_config(common::cases(60))]

    #[test]
    fn a_run_that_hands_meddle_with_replays_to_the_bit(
        network in network(),
        hands in prop::collection::vec(
            (any::<prop::sample::Index>(), prop::array::uniform3(-50.0f32..50.0), 0..5, 0u64..4),
            1..25,
        ),
    ) {
        let (model, params, state) = driven(&network);
        let mut run = simulation((model.clone(), params.clone(), state));
        run.keep_history(4 * 48 * model.point_count());
        for (point, vector, what, count) in hands {
            let (point, vector) = (point.index(model.point_count()), Vec3::from_array(vector));
            run.change(match what {
                0 => Change::Carry(point, None),
                1 => Change::Place(point, vector * 0.2),
                2 => Change::Pin(point..point + 1, vector.x > 0.0),
                _ => Change::Carry(point, Some(vector)),
            }).expect("allowed");
            steps(&mut run, count);
        }
        let (end, params) = (run.state().clone(), run.params().clone());
        for step in [end.step / 2, 0, end.step / 3, end.step] {
            run.rewind_to(step).expect("it is recorded");
        }
        prop_assert_eq!((run.state(), run.params()), (&end, &params));
        // A fresh solver that knows the parameters only takes the same next step.
        let mut again = Simulation::resume(model, params.clone(), end).expect("they fit");
        again.set_workers(std::sync::Arc::new(Inline));
        steps(&mut again, 3);
        steps(&mut run, 3);
        prop_assert_eq!(run.state(), again.state());
    }
}
