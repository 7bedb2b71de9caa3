//! The energy ledger: every joule is somewhere.

mod common;

use std::sync::Arc;

use common::{driven, network, rounding, scenes, simulation, steps, velocity};
use proptest::prelude::*;
use sprung::{
    Change, DVec3, Energy, Grab, Inline, Model, Params, Plane, SettleOptions, Simulation, State, Vec3,
};
use sprung::{force::FORCES, solver::SymplecticEuler};

/// The work of all forces at `state` over the path of one step, J: Σ F_n·(v_n + v_{n+1})·dt/2.
fn work(model: &Model, params: &Params, state: &State, after: &State) -> f64 {
    let mut forces = vec![DVec3::ZERO; model.point_count()];
    let mut rest = forces.clone();
    for force in FORCES {
        (force.parts)(model, params, state, &mut forces, &mut rest);
    }
    let dt = f64::from(params.dt as f32);
    let of_point =
        |at: usize| (forces[at] + rest[at]).dot(velocity(state, at) + velocity(after, at)) * 0.5 * dt;
    (0..model.point_count()).map(of_point).sum()
}

/// How far the change of kinetic energy may be from the work, J: m·v times how far rounding may throw the velocity off.
fn allowed(model: &Model, params: &Params, state: &State, after: &State) -> f64 {
    let off = rounding::of_step(model, params, state);
    let of_point = |(at, [_, dv]): (usize, [f64; 2])| {
        f64::from(params.point_mass[at])
            * (velocity(state, at).length() + velocity(after, at).length())
            * 0.5
            * dv
    };
    off.into_iter().enumerate().map(of_point).sum()
}

fn start(parts: (Model, Params, State)) -> Simulation {
    let mut run = simulation(parts);
    run.keep_ledger(true);
    run
}

fn start_of(name: &str) -> Simulation {
    let scene = scenes::four().into_iter().find(|scene| scene.name == name).expect("one of the four");
    let mut run = scenes::engine(&scene);
    run.keep_ledger(true);
    run
}

/// total − (start + work in − losses + integrator error), J; zero if every joule is accounted for.
fn unaccounted(energy: &Energy) -> f64 {
    let sums = &energy.sums;
    let booked =
        sums.start + sums.work_in - sums.lost_in_dampers - sums.lost_in_contact + sums.integrator_error;
    energy.total() - booked
}

proptest! {
    #![proptest_config(common::cases(100))]

    #[test]
    fn works_add_up_to_the_change_of_kinetic_energy(network in network()) {
        let (model, params, state) = driven(&network);
        let mut state = simulation((model.clone(), params.clone(), state)).state().clone(); // fixed points at rest
        let mut solver = SymplecticEuler::new(model.clone(), &params);
        for _ in 0..20 {
            let before = state.clone();
            solver.step(&params, &mut state, &Inline);
            let gained = Energy::of(&model, &params, &state).kinetic - Energy::of(&model, &params, &before).kinetic;
            let work = work(&model, &params, &before, &state);
            let allowed = allowed(&model, &params, &before, &state);
            prop_assert!((gained - work).abs() <= allowed, "gained {} J, work {} J, allowed {:e}", gained, work, allowed);
        }
    }

    #[test]
    fn every_joule_a_hand_gives_is_accounted_for(
        network in network(),
        hands in prop::collection::vec((any::<prop::sample::Index>(), prop::array::uniform3(-300.0f32..300.0), 0..4), 30),
    ) {
        let (model, params, state) = driven(&network);
        let mut run = start((model.clone(), params.clone(), state));
        let mut off = 0.0;
        for (point, vector, what) in hands {
            let (point, vector) = (point.index(model.point_count()), Vec3::from_array(vector));
            run.change(match what {
                0 => Change::Carry(point, None),
                1 => Change::Place(point, vector * 0.03),
                _ => Change::Carry(point, Some(vector)),
            }).expect("allowed");
            let before = run.state().clone();
            run.step(params.dt).expect("stable");
            off += allowed(&model, run.params(), &before, run.state());
            let energy = run.energy();
            off += 1e-14 * (energy.kinetic + energy.elastic + energy.contact + energy.gravitational.abs() + energy.sums.work_in.abs());
            let left = unaccounted(&energy);
            prop_assert!(left.abs() <= off, "{:e} J of {} J unaccounted for, allowed {:e}", left, energy.total(), off);
        }
    }

    #[test]
    fn every_joule_is_accounted_for(network in network()) {
        let (model, params, state) = driven(&network);
        let mut run = start((model.clone(), params.clone(), state));
        let mut off = 0.0;
        for _ in 0..50 {
            let before = run.state().clone();
            run.step(params.dt).expect("stable");
            off += allowed(&model, &params, &before, run.state());
            let energy = run.energy();
            // Besides the rounding of velocities: that of float64 sums of potentials of this size, at each step.
            off += 1e-14 * (energy.kinetic + energy.elastic + energy.contact + energy.gravitational.abs());
            let left = unaccounted(&energy);
            prop_assert!(left.abs() <= off, "{:e} J of {} J unaccounted for, allowed {:e}", left, energy.total(), off);
        }
    }
}

#[test]
fn nothing_is_unaccounted_for_when_things_change() {
    let mut run = scenes::engine(&scenes::jelly());
    run.keep_ledger(true);
    let mut off = 0.0;
    let mut go = |run: &mut Simulation, count: u64| {
        for _ in 0..count {
            let before = run.state().clone();
            run.step(run.params().dt).expect("stable");
            off += allowed(&run.model().clone(), run.params(), &before, run.state());
            let left = unaccounted(&run.energy());
            assert!(
                left.abs() <= off + 1e-9,
                "{left:e} J unaccounted for at step {}, allowed {off:e}",
                run.state().step
            );
        }
    };
    go(&mut run, 20);
    let springs = run.model().spring_count();
    let changes = [
        Change::Gravity(Vec3::new(2.0, -5.0, 0.0)),
        Change::Stiffness(0..springs, 600.0),
        Change::Damping(0..100, 3.0),
        Change::RestScale(0..springs, 1.02),
        Change::Mass(0..200, 1.5),
        Change::Pin(990..1000, true),
        Change::Cut(0..1000, true),
        Change::Grab(Grab { point: 5, target: Vec3::new(0.0, 40.0, 0.0), stiffness: 200.0, damping: 5.0 }),
        Change::Force(17, Vec3::new(30.0, 0.0, -100.0)),
        Change::Planes(vec![Plane::level(-3.0, 80.0, 5.0)]),
        Change::Cut(0..1000, false),
        Change::Pin(990..1000, false),
        Change::Release(5),
        Change::Dt(0.004),
        Change::Params(Arc::new(run.params().clone())),
    ];
    for change in changes {
        let (total, work_in) = (run.energy().total(), run.state().ledger.work_in);
        run.change(change.clone()).expect("allowed");
        // What the change itself did to the energy is booked, to the last bit that a float64 sum keeps.
        let (jump, booked) = (run.energy().total() - total, run.state().ledger.work_in - work_in);
        assert!(
            (jump - booked).abs() <= 1e-12 * (total.abs() + work_in.abs()),
            "{change:?}: {jump} J, booked {booked} J"
        );
        go(&mut run, 10);
    }
}

/// A hand that tears a corner of the jelly about, faster than anything in it moves and back and forth at each frame.
fn violent_drag(run: &mut Simulation, mut after_each: impl FnMut(&mut Simulation, &State)) {
    let corner = 999;
    for (frame, speed) in [40.0, 400.0, -900.0, 1500.0, -1500.0, 1500.0, -1000.0, 0.0].into_iter().enumerate()
    {
        let side = if frame % 2 == 0 { 0.3 } else { -0.8 };
        run.change(Change::Carry(corner, Some(Vec3::new(side * speed, speed, 0.5 * speed))))
            .expect("allowed");
        for _ in 0..=frame % 3 {
            let before = run.state().clone();
            run.step(run.params().dt).expect("a drag is no blow-up");
            after_each(run, &before);
        }
    }
    run.change(Change::Carry(corner, None)).expect("allowed");
    for _ in 0..60 {
        let before = run.state().clone();
        run.step(run.params().dt).expect("a drag is no blow-up");
        after_each(run, &before);
    }
}

#[test]
fn a_violent_drag_is_booked_to_the_last_joule_and_is_no_blow_up() {
    let mut run = start_of("jelly");
    let mut bare = scenes::engine(&scenes::jelly());
    let mut off = 0.0;
    violent_drag(&mut run, |run, before| {
        off += allowed(run.model(), run.params(), before, run.state());
        let energy = run.energy();
        off += 1e-14 * (energy.total().abs() + energy.elastic + energy.gravitational.abs());
        let left = unaccounted(&energy);
        assert!(
            left.abs() <= off,
            "{left:e} J of {} J at step {}, allowed {off:e}",
            energy.total(),
            before.step
        );
        assert!(!run.is_suspect(), "step {}", run.state().step);
    });
    violent_drag(&mut bare, |_, _| {});
    assert_eq!(run.state_hash(), bare.state_hash());
    // The hand's work is booked whether or not anybody keeps the ledger, and it was a great deal.
    let (booked, bare) = (run.state().ledger.work_in, bare.state().ledger.work_in);
    assert!(booked == bare && booked > 1e5, "{booked} J, {bare} J");
}

#[test]
fn a_hand_gives_what_a_spring_stores() {
    // From rest length 1 m to 3 m at 100 N/m, the other end held: ½·100·2² = 200 J, in however few steps.
    for count in [1u32, 2, 5, 64] {
        let material = sprung::Material { stiffness: 100.0, damping: 0.0 };
        let (model, mut params, state) = common::oscillator(1.0, material, 1.0, 1.0, 0.0);
        params.dt = 0.0078125;
        let mut run = start((model, params, state));
        let speed = 2.0 / (0.0078125 * count as f32);
        run.change(Change::Carry(1, Some(Vec3::X * speed))).expect("allowed");
        steps(&mut run, u64::from(count));
        let energy = run.energy();
        assert!((energy.sums.work_in - 200.0).abs() < 1e-4, "{} J in {count} steps", energy.sums.work_in);
        assert!(energy.sums.integrator_error.abs() < 1e-9 && energy.kinetic == 0.0);
        // Let go, it has the speed that the hand had, and the energy of that speed is the hand's gift too.
        run.change(Change::Carry(1, None)).expect("allowed");
        let kinetic = 0.5 * f64::from(speed) * f64::from(speed);
        assert_eq!(run.energy().kinetic, kinetic);
        assert!((run.energy().sums.work_in - 200.0 - kinetic).abs() < 1e-4);
    }
}

#[test]
fn settling_is_booked_as_work() {
    let mut run = start_of("chain");
    steps(&mut run, 30);
    let before = run.energy();
    run.settle(SettleOptions::default()).expect("it comes to rest");
    let after = run.energy();
    assert!(after.total() < before.total(), "settling takes energy out");
    assert_eq!(after.sums.lost_in_dampers, before.sums.lost_in_dampers);
    let (change, booked) = (after.total() - before.total(), after.sums.work_in - before.sums.work_in);
    assert!((change - booked).abs() < 1e-9 * before.total().abs());
}

#[test]
fn a_push_puts_in_force_times_way() {
    // m = 2 kg from rest under 6 N for n steps: v = 3·t, so ½mv² = 9·t² and all of it is work put in.
    let mut builder = sprung::ModelBuilder::new();
    builder.add_point(Vec3::ZERO, 2.0).expect("allowed");
    let (model, mut params, state) = builder.build().expect("there is a point");
    params.gravity = Vec3::ZERO;
    params.dt = 0.0078125; // 2⁻⁷: exact in float32
    let mut run = simulation((model, params, state));
    run.change(Change::Force(0, Vec3::new(0.0, 6.0, 0.0))).expect("allowed");
    steps(&mut run, 128);
    assert_eq!(run.energy().sums.work_in, 9.0);
    assert_eq!(run.energy().kinetic, 9.0);
    // Let go: nothing more is put in.
    run.change(Change::Force(0, Vec3::ZERO)).expect("allowed");
    steps(&mut run, 128);
    assert_eq!(run.energy().sums.work_in, 9.0);
}

#[test]
fn a_grab_puts_in_what_the_hand_gives() {
    // A hand at 1 m, 8 N/m, undamped: what the point has gained is ½k(1 − (1 − x)²) but for the integrator's error, which
    // is first order in dt.
    let mut builder = sprung::ModelBuilder::new();
    builder.add_point(Vec3::ZERO, 2.0).expect("allowed");
    let (model, mut params, state) = builder.build().expect("there is a point");
    params.gravity = Vec3::ZERO;
    params.dt = 0.001;
    let mut run = simulation((model, params, state));
    run.change(Change::Grab(Grab { point: 0, target: Vec3::X, stiffness: 8.0, damping: 0.0 }))
        .expect("allowed");
    steps(&mut run, 500);
    let x = f64::from(run.state().position[0].x);
    let expected = 0.5 * 8.0 * (1.0 - (1.0 - x) * (1.0 - x));
    let energy = run.energy();
    assert!((energy.kinetic - energy.sums.work_in).abs() < 1e-5);
    // Error of the energy of symplectic Euler: ½dt·|F·v| ≤ ½·0.001·8·2.
    assert!((energy.sums.work_in - expected).abs() < 0.008, "{} J against {expected} J", energy.sums.work_in);
}

/// On the jelly, after its fall (0.93 s: −448, −224 and −112 J) and again when it has hit the plane (1.85 s).
#[test]
fn the_integrators_error_halves_with_dt() {
    let errors = [(0.01, 1u64), (0.005, 2), (0.0025, 4)].map(|(dt, per)| {
        let mut run = scenes::engine(&scenes::jelly());
        run.change(Change::Dt(dt)).expect("allowed");
        run.keep_ledger(true);
        steps(&mut run, 93 * per);
        let fallen = run.energy().sums.integrator_error;
        steps(&mut run, 92 * per);
        [fallen, run.energy().sums.integrator_error]
    });
    // In free fall each step loses ½·m·g²·dt², exactly: ½·1000·9.81²·0.01·0.93 = 447.5 J.
    let expected = 0.5 * 1000.0 * 9.81 * 9.81 * 0.01 * 0.93;
    assert!((errors[0][0] + expected).abs() < 0.02 * expected, "{} J", errors[0][0]);
    for pair in errors.windows(2) {
        for (coarse, fine) in pair[0].into_iter().zip(pair[1]) {
            // C·dt + O(dt²): the second order makes a few per cent of it.
            let ratio = coarse / fine;
            assert!((ratio - 2.0).abs() < 0.1, "{coarse} J became {fine} J");
        }
    }
}
