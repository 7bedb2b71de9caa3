//! What unusual input means: each case has one defined meaning, as the documentation of `ModelBuilder` says.

mod common;

use common::{simulation, steps};
use sprung::{Change, Code, Error, Grab, Material, ModelBuilder, Plane, Simulation, State, Vec3};

const SPRING: Material = Material { stiffness: 100.0, damping: 2.0 };

/// Points at these places, 1 kg each, without gravity.
fn points(places: &[Vec3]) -> ModelBuilder {
    let mut builder = ModelBuilder::new();
    for &place in places {
        builder.add_point(place, 1.0).expect("allowed");
    }
    builder
}

fn weightless(builder: ModelBuilder) -> Simulation {
    let (model, mut params, state) = builder.build().expect("there are points");
    params.gravity = Vec3::ZERO;
    params.dt = 0.01;
    simulation((model, params, state))
}

/// A refusal names the code, says something, and is one sentence.
fn refused<T: std::fmt::Debug>(result: Result<T, Error>, code: Code) {
    let error = result.expect_err("it must be refused");
    assert_eq!(error.code(), code, "{error}");
    assert!(error.sentence().len() > 10 && !error.sentence().contains('\n'), "{error}");
}

#[test]
fn coincident_points_feel_no_spring_until_they_part() {
    let mut builder = points(&[Vec3::ONE, Vec3::ONE]);
    let spring = builder.add_spring(0, 1, SPRING).expect("coincident points may be joined");
    builder.set_rest_length(spring, 3.0).expect("allowed");
    let mut run = weightless(builder);
    steps(&mut run, 100);
    assert_eq!(run.state().position, [Vec3::ONE; 2], "no axis, no force, and never a NaN");
    // Nudged apart, the spring has an axis and drives them to its rest length.
    run.change(Change::Force(1, Vec3::X)).expect("allowed");
    steps(&mut run, 1);
    run.change(Change::Force(1, Vec3::ZERO)).expect("allowed");
    steps(&mut run, 3000);
    let apart = (run.state().position[1] - run.state().position[0]).length();
    assert!((apart - 3.0).abs() < 1e-4, "{apart} m apart");
}

#[test]
fn a_spring_of_rest_length_zero_always_pulls() {
    let mut builder = points(&[Vec3::ZERO, Vec3::X]);
    let spring = builder.add_spring(0, 1, SPRING).expect("allowed");
    builder.set_rest_length(spring, 0.0).expect("zero is allowed");
    let mut run = weightless(builder);
    steps(&mut run, 1);
    assert!(run.state().velocity[0].x > 0.0 && run.state().velocity[1].x < 0.0);
    steps(&mut run, 3000);
    let state = run.state();
    assert!((state.position[0] - state.position[1]).length() < 1e-4, "they meet, and stay together");
    assert!(state.position.iter().all(|x| (*x - Vec3::X * 0.5).length() < 1e-4), "in the middle");
}

#[test]
fn zero_mass_is_fixed_and_negative_mass_refused() {
    let mut builder = ModelBuilder::new();
    builder.add_point(Vec3::ZERO, 0.0).expect("zero is allowed");
    builder.set_velocity(0, Vec3::X).expect("allowed, and ignored");
    refused(builder.add_point(Vec3::ZERO, -1.0), Code::OutOfRange);
    refused(builder.add_point(Vec3::ZERO, -f32::MIN_POSITIVE), Code::OutOfRange);
    let mut run = simulation(builder.build().expect("there is a point"));
    steps(&mut run, 10);
    assert_eq!((run.state().position[0], run.state().velocity[0]), (Vec3::ZERO, Vec3::ZERO));
    refused(run.change(Change::Mass(0..1, -2.0)), Code::OutOfRange);
    // Given a mass, it falls; given none again, it stops where it is.
    run.change(Change::Mass(0..1, 1.0)).expect("allowed");
    steps(&mut run, 10);
    run.change(Change::Mass(0..1, 0.0)).expect("allowed");
    let place = run.state().position[0];
    steps(&mut run, 10);
    assert!(place.y < 0.0);
    assert_eq!((run.state().position[0], run.state().velocity[0]), (place, Vec3::ZERO));
}

#[test]
fn repeated_springs_act_side_by_side() {
    let of = |springs: usize, stiffness: f32| {
        let mut builder = points(&[Vec3::ZERO, Vec3::X]);
        for _ in 0..springs {
            let material = Material { stiffness, damping: stiffness / 64.0 };
            let spring = builder.add_spring(0, 1, material).expect("repeated springs are allowed");
            builder.set_rest_length(spring, 0.5).expect("allowed");
        }
        let mut run = weightless(builder);
        steps(&mut run, 100);
        run.state_hash()
    };
    // Powers of two, so that even the bits agree.
    assert_eq!(of(2, 64.0), of(1, 128.0));
    assert_eq!(of(4, 32.0), of(1, 128.0));
}

#[test]
fn a_spring_between_fixed_points_is_kept_and_moves_nothing() {
    let mut builder = points(&[Vec3::ZERO, Vec3::X, Vec3::Y]);
    builder.pin(0).expect("there is such a point");
    builder.pin(1).expect("there is such a point");
    let spring = builder.add_spring(0, 1, SPRING).expect("allowed");
    builder.set_rest_length(spring, 9.0).expect("allowed");
    let mut run = weightless(builder);
    let start = run.state().position.clone();
    steps(&mut run, 50);
    assert_eq!(run.model().spring_count(), 1);
    assert_eq!(run.state().position, start);
    // Freed, its end is pushed away.
    run.change(Change::Pin(1..2, false)).expect("allowed");
    steps(&mut run, 5);
    assert!(run.state().position[1].x > 1.0);
}

#[test]
fn ends_are_put_in_order_and_a_spring_needs_two() {
    let mut builder = points(&[Vec3::ZERO, Vec3::X, Vec3::Y]);
    builder.add_spring(2, 0, SPRING).expect("allowed");
    refused(builder.add_spring(1, 1, SPRING), Code::Conflict);
    refused(builder.add_spring(0, 3, SPRING), Code::NotFound);
    let (model, ..) = builder.build().expect("there are points");
    assert_eq!(model.springs(), [[0, 2]]);
}

#[test]
fn what_is_not_a_number_is_refused_everywhere() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let place = Vec3::new(0.0, bad, 0.0);
        let mut builder = points(&[Vec3::ZERO, Vec3::X]);
        refused(builder.add_point(place, 1.0), Code::OutOfRange);
        refused(builder.add_point(Vec3::ZERO, bad), Code::OutOfRange);
        refused(builder.set_velocity(0, place), Code::OutOfRange);
        refused(builder.add_spring(0, 1, Material { stiffness: bad, ..SPRING }), Code::OutOfRange);
        refused(builder.add_spring(0, 1, Material { damping: bad, ..SPRING }), Code::OutOfRange);
        refused(builder.connect_within(0..2, bad, SPRING), Code::OutOfRange);
        builder.add_spring(0, 1, SPRING).expect("allowed");
        refused(builder.set_rest_length(0, bad), Code::OutOfRange);

        let mut run = weightless(builder);
        let before = (run.state().clone(), run.params().clone());
        let grab = Grab { point: 0, target: Vec3::ZERO, stiffness: 1.0, damping: 1.0 };
        let plane = Plane::level(0.0, 1.0, 1.0);
        for change in [
            Change::Dt(f64::from(bad)),
            Change::Gravity(place),
            Change::Planes(vec![plane, Plane { point: place, ..plane }]),
            Change::Planes(vec![Plane { normal: place, ..plane }]),
            Change::Planes(vec![Plane { stiffness: bad, ..plane }]),
            Change::Planes(vec![Plane { damping: bad, ..plane }]),
            Change::Mass(0..2, bad),
            Change::Stiffness(0..1, bad),
            Change::Damping(0..1, bad),
            Change::RestScale(0..1, bad),
            Change::Force(0, place),
            Change::Grab(Grab { target: place, ..grab }),
            Change::Grab(Grab { stiffness: bad, ..grab }),
            Change::Grab(Grab { damping: bad, ..grab }),
        ] {
            refused(run.change(change), Code::OutOfRange);
        }
        refused(run.step(f64::from(bad)), Code::OutOfRange);
        assert_eq!((run.state(), run.params()), (&before.0, &before.1), "a refused change changes nothing");
        assert!(run.log().is_empty());

        let (state, params) = before;
        let arrays: [fn(&mut State) -> &mut Vec<Vec3>; 4] = [
            |state| &mut state.position,
            |state| &mut state.position_low,
            |state| &mut state.velocity,
            |state| &mut state.velocity_low,
        ];
        for array in arrays {
            let mut state = state.clone();
            array(&mut state)[1] = place;
            refused(Simulation::new(run.model().clone(), params.clone(), state), Code::OutOfRange);
        }
    }
}

#[test]
fn indices_that_do_not_exist_are_refused() {
    let mut builder = points(&[Vec3::ZERO, Vec3::X]);
    builder.add_spring(0, 1, SPRING).expect("allowed");
    refused(builder.pin(2), Code::NotFound);
    refused(builder.set_velocity(2, Vec3::X), Code::NotFound);
    refused(builder.set_rest_length(1, 1.0), Code::NotFound);
    refused(builder.connect_within(0..3, 1.0, SPRING), Code::NotFound);
    let mut run = weightless(builder);
    let grab = Grab { point: usize::MAX, target: Vec3::ZERO, stiffness: 1.0, damping: 1.0 };
    #[allow(clippy::reversed_empty_ranges)]
    let backwards = 1..0;
    for change in [
        Change::Mass(0..3, 1.0),
        Change::Pin(2..3, true),
        Change::Pin(backwards, true),
        Change::Stiffness(1..2, 1.0),
        Change::Damping(0..2, 1.0),
        Change::RestScale(0..2, 1.0),
        Change::Cut(0..usize::MAX, true),
        Change::Force(2, Vec3::X),
        Change::Release(2),
        Change::Grab(grab),
    ] {
        refused(run.change(change), Code::OutOfRange);
    }
}

#[test]
fn parts_that_do_not_fit_together_are_refused() {
    let run = weightless(points(&[Vec3::ZERO, Vec3::X]));
    let other = weightless(points(&[Vec3::ZERO]));
    let (model, params, state) = (run.model(), run.params().clone(), run.state().clone());
    refused(Simulation::new(model.clone(), params, other.state().clone()), Code::Conflict);
    refused(Simulation::new(model.clone(), other.params().clone(), state), Code::Conflict);
    refused(ModelBuilder::new().build(), Code::Conflict);
}

#[test]
fn a_point_that_is_pinned_stops_and_keeps_its_mass_for_later() {
    let mut run = weightless(points(&[Vec3::ZERO]));
    run.change(Change::Force(0, Vec3::X)).expect("allowed");
    steps(&mut run, 10);
    run.change(Change::Pin(0..1, true)).expect("allowed");
    let place = run.state().position[0];
    steps(&mut run, 10);
    assert_eq!((run.state().position[0], run.state().velocity[0]), (place, Vec3::ZERO));
    run.change(Change::Pin(0..1, false)).expect("allowed");
    run.change(Change::Pin(0..1, false)).expect("freeing a free point is nothing");
    steps(&mut run, 1);
    assert_eq!(run.state().velocity[0].x, 1.0 / 1.0 * 0.01, "one step of F/m from rest");
}

#[test]
fn a_cut_spring_is_not_there_until_it_is_mended() {
    let stretched = || {
        let mut builder = points(&[Vec3::ZERO, Vec3::X]);
        builder.add_spring(0, 1, SPRING).expect("allowed");
        builder.set_rest_length(0, 0.5).expect("allowed");
        weightless(builder)
    };
    let mut run = stretched();
    run.change(Change::Cut(0..1, true)).expect("allowed");
    assert_eq!(run.energy().elastic, 0.0);
    steps(&mut run, 20);
    assert_eq!(run.state().velocity, [Vec3::ZERO; 2]);
    run.change(Change::Cut(0..1, false)).expect("allowed");
    assert_eq!(run.energy().elastic, 0.5 * 100.0 * 0.25);
    let mut whole = stretched();
    steps(&mut run, 20);
    steps(&mut whole, 20);
    assert_eq!(run.state().position, whole.state().position);
}

/// 64³ points 1 m apart, joined along edges, 3·n²·(n − 1), and across faces, 6·n·(n − 1)²; the radius of √2 + 0.001 leaves
/// out the diagonals through space.
#[test]
fn a_quarter_of_a_million_points_connect_with_the_right_count() {
    let n = 64;
    let mut builder = ModelBuilder::new();
    for at in 0..n * n * n {
        let place = Vec3::new((at / (n * n)) as f32, (at / n % n) as f32, (at % n) as f32);
        builder.add_point(place, 1.0).expect("allowed");
    }
    let springs = builder.connect_within(0..n * n * n, 2f32.sqrt() + 0.001, SPRING).expect("under the limit");
    assert_eq!(springs, 0..3 * n * n * (n - 1) + 6 * n * (n - 1) * (n - 1));
    assert_eq!(springs.len(), 2_298_240);
}

#[test]
fn too_many_springs_are_refused_before_they_are_made() {
    let mut builder = points(&[Vec3::ZERO; 100]);
    builder.allow_springs(1000);
    refused(builder.connect_within(0..100, 1.0, SPRING), Code::TooLarge);
    assert_eq!(builder.spring_count(), 0);
}
