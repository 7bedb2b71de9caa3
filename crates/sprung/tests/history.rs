//! Rewind, branch, reset, save and continue: always the same bits.

mod common;

use std::ops::ControlFlow;
use std::sync::Arc;

use common::{scenes, steps};
use proptest::prelude::*;
use sprung::{Change, Code, ContactLaw, Event, Grab, Params, Plane, SettleOptions, Simulation, Vec3};

/// One of every kind of change, for a scene with at least 15 points and 14 springs.
fn every_change() -> Vec<Change> {
    let plane = Plane { law: ContactLaw::Push, ..Plane::level(5.0, 60.0, 4.0) };
    vec![
        Change::Gravity(Vec3::new(0.5, -3.0, 1.0)),
        Change::Dt(0.007),
        Change::Substeps(3),
        Change::Planes(vec![plane]),
        Change::Mass(3..6, 1.7),
        Change::Pin(8..10, true),
        Change::Stiffness(0..7, 150.0),
        Change::Damping(5..9, 1.0),
        Change::RestScale(2..12, 0.9),
        Change::Cut(11..12, true),
        Change::Force(4, Vec3::new(0.0, 20.0, -3.0)),
        Change::Grab(Grab { point: 12, target: Vec3::new(20.0, 30.0, 4.0), stiffness: 90.0, damping: 2.0 }),
        Change::Pin(8..10, false),
        Change::Cut(11..12, false),
        Change::Release(12),
        Change::Mass(0..1, 2.0),
        Change::Force(4, Vec3::ZERO),
        Change::Dt(0.01),
        Change::Carry(6, Some(Vec3::new(1.0, 2.0, -3.0))),
        Change::Place(3, Vec3::new(7.0, 22.0, 1.0)),
        Change::Carry(6, None),
        Change::Carry(0, Some(Vec3::new(0.0, 1.0, 0.0))),
        Change::Params(all_at_once()),
        Change::Params(all_but_the_pin()),
    ]
}

fn all_but_the_pin() -> Arc<Params> {
    let mut params = Params::clone(&all_at_once());
    Arc::make_mut(&mut params.point_pinned)[13] = false;
    params.dt = 0.009;
    Arc::new(params)
}

/// The chain's own parameters but for some of every kind.
fn all_at_once() -> Arc<Params> {
    let mut params = scenes::engine(&scenes::chain()).params().clone();
    params.dt = 0.008;
    params.gravity = Vec3::new(0.0, -8.0, 2.0);
    Arc::make_mut(&mut params.point_mass)[7] = 2.5;
    Arc::make_mut(&mut params.point_pinned)[13] = true;
    Arc::make_mut(&mut params.spring_stiffness)[4] = 120.0;
    params.external_forces.insert(9, Vec3::X);
    Arc::new(params)
}

/// A chain to which everything is done; the hashes on arriving at each step and after what was done there.
fn eventful(bytes: usize) -> (Simulation, Vec<u64>) {
    let mut run = scenes::engine(&scenes::chain());
    run.keep_history(bytes);
    let mut arrived = vec![run.state_hash()];
    let mut go = |run: &mut Simulation, count: u64| {
        for _ in 0..count {
            steps(run, 1);
            arrived.push(run.state_hash());
        }
    };
    for (index, change) in every_change().into_iter().enumerate() {
        go(&mut run, 9);
        run.change(change).expect("allowed");
        if index == 5 {
            run.settle(SettleOptions { residual_force: Some(0.5), ..SettleOptions::default() })
                .expect("it settles");
            run.change(Change::Pin(8..9, false)).expect("allowed");
        }
    }
    go(&mut run, 150);
    (run, arrived)
}

/// Where a step has events, rewinding shows the state after them; the hashes were taken on arrival.
fn hash_after_events(run: &Simulation, arrived: &[u64], step: usize) -> Option<u64> {
    let touched = run.log().iter().any(|(at, event)| {
        use Change::{Carry, Mass, Params, Pin, Place};
        let moves = matches!(
            event,
            Event::Settle(_) | Event::Change(Pin(..) | Mass(..) | Params(_) | Carry(..) | Place(..))
        );
        *at == step as u64 && moves
    });
    (!touched).then(|| arrived[step])
}

#[test]
fn rewinding_to_any_step_gives_the_same_bits_whatever_was_done() {
    // Nothing but the first state, room for two checkpoints, and as much as there is by default.
    for bytes in [0, 2 * 15 * 48, 8 << 10, 64 << 20] {
        let (mut run, arrived) = eventful(bytes);
        let (end, params) = (run.state().clone(), run.params().clone());
        let newest = run.state().step as usize;
        // Back one by one, forth in strides, then criss-cross.
        let backwards = (0..=newest).rev();
        let forwards = (0..=newest).step_by(7);
        let across = (0..40).map(|k| k * 7919 % (newest + 1));
        for step in backwards.chain(forwards).chain(across) {
            run.rewind_to(step as u64).expect("it is recorded");
            assert_eq!(run.state().step, step as u64);
            if let Some(expected) = hash_after_events(&run, &arrived, step) {
                assert_eq!(run.state_hash(), expected, "step {step} with {bytes} bytes of history");
            }
        }
        run.rewind_to(newest as u64).expect("it is recorded");
        assert_eq!(run.state(), &end, "all of the state, time and ledger too");
        assert_eq!(run.params(), &params);
        assert!(run.rewind_to(newest as u64 + 1).is_err(), "what never was cannot be gone to");
    }
}

#[test]
fn every_kind_of_change_is_in_the_list() {
    // A new kind must be added to the list above: this match then no longer compiles.
    let kind = |change: &Change| match change {
        Change::Dt(_) => 0,
        Change::Substeps(_) => 1,
        Change::Gravity(_) => 2,
        Change::Planes(_) => 3,
        Change::Mass(..) => 4,
        Change::Pin(..) => 5,
        Change::Stiffness(..) => 6,
        Change::Damping(..) => 7,
        Change::RestScale(..) => 8,
        Change::Cut(..) => 9,
        Change::Force(..) => 10,
        Change::Grab(_) => 11,
        Change::Release(_) => 12,
        Change::Params(_) => 13,
        Change::Carry(..) => 14,
        Change::Place(..) => 15,
    };
    let mut seen = [false; 16];
    every_change().iter().for_each(|change| seen[kind(change)] = true);
    assert_eq!(seen, [true; 16]);
}

#[test]
fn all_parameters_at_once_are_as_one_by_one() {
    let changes = || every_change().into_iter().filter(|change| !matches!(change, Change::Params(_)));
    let mut one_by_one = scenes::engine(&scenes::chain());
    let own = Arc::new(one_by_one.params().clone());
    steps(&mut one_by_one, 30);
    let mut at_once = one_by_one.clone();
    let before = at_once.energy().total();
    changes().try_for_each(|change| one_by_one.change(change)).expect("allowed");
    at_once.change(Change::Params(Arc::new(one_by_one.params().clone()))).expect("allowed");
    assert_eq!(at_once.params(), one_by_one.params());
    // What it adds to the energy is work put in.
    let jump = at_once.energy().total() - before;
    assert!((jump - at_once.state().ledger.work_in).abs() <= 1e-12 * before.abs());
    // Undone, nothing is left of it but that it was done: the points that no pin had stopped go on as before.
    let mut untouched = scenes::engine(&scenes::chain());
    steps(&mut untouched, 30);
    at_once.change(Change::Params(own.clone())).expect("allowed");
    assert_eq!((at_once.params(), at_once.state_hash()), (&*own, untouched.state_hash()));
    assert_eq!((at_once.log().len(), at_once.state().ledger.work_in), (1, 0.0));
}

#[test]
fn of_parameters_set_over_and_over_between_two_steps_only_the_last_count() {
    let mut run = scenes::engine(&scenes::chain());
    steps(&mut run, 30);
    let own = run.params().clone();
    let mut once = run.clone();
    for value in 1..=100u8 {
        let mut params = own.clone();
        Arc::make_mut(&mut params.spring_stiffness)[0] = f32::from(value);
        // In between it does what cannot be taken back by setting it back: a pin stops a point, a step's length the clock.
        Arc::make_mut(&mut params.point_pinned)[usize::from(value % 15)] = true;
        params.dt = if value < 100 { 0.003 } else { 0.01 };
        run.change(Change::Params(Arc::new(params))).expect("allowed");
        assert!(run.change(Change::Mass(0..99, 1.0)).is_err(), "what is refused is nothing done");
    }
    once.change(Change::Params(Arc::new(run.params().clone()))).expect("allowed");
    assert_eq!((run.state(), run.log()), (once.state(), once.log()), "the ledger too, to the bit");
    assert_ne!(run.state().ledger.work_in, 0.0);
    steps(&mut run, 20);
    let end = run.state().clone();
    for step in [10, 30, 50] {
        run.rewind_to(step).expect("it is recorded");
    }
    assert_eq!(run.state(), &end);
    // Once more at a step that was gone back to.
    run.rewind_to(30).expect("it is recorded");
    run.change(Change::Params(Arc::new(own))).expect("allowed");
    let mut untouched = scenes::engine(&scenes::chain());
    steps(&mut untouched, 30);
    assert_eq!((run.state(), run.log().len()), (untouched.state(), 1));
    steps(&mut run, 5);
    steps(&mut untouched, 5);
    assert_eq!(run.state(), untouched.state(), "nor does the solver know anything else");
}

#[test]
fn a_parameter_that_is_set_twice_at_a_step_was_set_once() {
    let level = |height| vec![Plane { law: ContactLaw::Push, ..Plane::level(height, 60.0, 4.0) }];
    let twice = [
        (Change::Gravity(Vec3::X), Change::Gravity(Vec3::Y)),
        (Change::Planes(level(24.9)), Change::Planes(level(3.0))),
        (Change::Mass(3..6, 0.0), Change::Mass(3..6, 2.0)),
        (Change::Pin(3..6, true), Change::Pin(3..6, false)),
        (Change::Stiffness(0..7, 1.0), Change::Stiffness(0..7, 300.0)),
        (Change::Damping(0..7, 1.0), Change::Damping(0..7, 0.5)),
        (Change::RestScale(0..7, 0.1), Change::RestScale(0..7, 1.1)),
        (Change::Cut(2..3, true), Change::Cut(2..3, false)),
        (Change::Force(4, Vec3::X), Change::Force(4, Vec3::ZERO)),
        (Change::Substeps(3), Change::Substeps(4)),
        (Change::Params(all_at_once()), Change::Params(all_but_the_pin())),
    ];
    for (first, last) in twice {
        let mut run = scenes::engine(&scenes::chain());
        steps(&mut run, 30);
        let mut once = run.clone();
        once.change(last.clone()).expect("allowed");
        run.change(first.clone()).expect("allowed");
        let _packed = run.forces();
        run.change(last.clone()).expect("allowed");
        assert_eq!((run.log(), run.params()), (once.log(), once.params()), "{first:?}, {last:?}");
        steps(&mut run, 5);
        steps(&mut once, 5);
        assert_eq!(run.state(), once.state(), "{first:?}, {last:?}");
    }
    // Of other springs, or with something in between, nothing is forgotten.
    let mut run = scenes::engine(&scenes::chain());
    for change in [
        Change::Stiffness(0..7, 1.0),
        Change::Stiffness(0..8, 2.0),
        Change::Stiffness(0..7, 3.0),
        Change::Dt(0.003),
        Change::Dt(0.01),
        Change::Stiffness(0..7, 4.0),
    ] {
        run.change(change).expect("allowed");
    }
    assert_eq!(run.log().len(), 6);
}

#[test]
fn parameters_that_do_not_fit_are_refused_whole() {
    let mut run = scenes::engine(&scenes::chain());
    let before = run.params().clone();
    let refused = |edit: &dyn Fn(&mut Params)| {
        let mut params = before.clone();
        edit(&mut params);
        Change::Params(Arc::new(params))
    };
    for change in [
        refused(&|params| params.dt = f64::NAN),
        refused(&|params| Arc::make_mut(&mut params.point_mass)[3] = -1.0),
        refused(&|params| params.spring_cut = Arc::new(vec![true])),
        refused(&|params| params.external_forces = [(15, Vec3::X)].into()),
    ] {
        assert!(run.change(change).is_err());
        assert_eq!(run.params(), &before);
    }
    assert!(run.log().is_empty());
}

#[test]
fn checkpoints_are_dense_in_the_recent_past_and_reach_back_to_the_first_step() {
    let mut run = scenes::engine(&scenes::chain());
    let room = 20;
    run.keep_history(room * 15 * 48);
    let newest = 30_000;
    steps(&mut run, newest);
    assert_eq!(run.recorded_steps(), 0..=newest);
    // What a replay costs, in steps: at most a share of how long ago it was, and next to nothing for the last second.
    let cost = |ago: u64| newest - ago - run.checkpoint_before(newest - ago);
    assert!((0..500).all(|ago| cost(ago) < 200), "{:?}", (0..500).map(cost).max());
    for ago in [1000, 3000, 10_000, 20_000, 29_000] {
        assert!(cost(ago) <= ago / 2 + 128, "{ago} steps ago costs {} steps", cost(ago));
    }
    // The bound holds, but for the first state, which is kept in any case.
    assert!(run.history_bytes() <= (room + 1) * 15 * 48, "{} bytes", run.history_bytes());
    assert!(run.history_bytes() >= room / 2 * 15 * 48, "{} bytes", run.history_bytes());
    let end = run.state().clone();
    for step in [0, 29_990, 12_345] {
        run.rewind_to(step).expect("it is recorded");
    }
    run.rewind_to(newest).expect("it is recorded");
    assert_eq!(run.state(), &end);
}

#[test]
fn a_replay_in_small_portions_ends_at_the_same_bits() {
    let (mut run, arrived) = eventful(8 << 10);
    let newest = *run.recorded_steps().end();
    for target in [newest, 3, 100, newest - 1] {
        let checkpoint = run.checkpoint_before(target);
        assert!(checkpoint <= target);
        run.rewind_to(checkpoint).expect("it is recorded");
        while run.state().step < target {
            run.rewind_to(target.min(run.state().step + 5)).expect("it is recorded");
        }
        if let Some(expected) = hash_after_events(&run, &arrived, target as usize) {
            assert_eq!(run.state_hash(), expected);
        }
    }
    assert_eq!(run.recorded_steps(), 0..=newest, "looking around drops nothing");
}

#[test]
fn settling_that_is_broken_off_drops_nothing() {
    let (mut run, arrived) = eventful(64 << 20);
    let (newest, events) = (*run.recorded_steps().end(), run.log().len());
    run.rewind_to(100).expect("it is recorded");
    let here = run.state().clone();
    let never = SettleOptions { residual_force: Some(0.0), max_steps: 300 };
    let broken_off = run.settle_with(never, &mut |_| ControlFlow::Break(()));
    assert_eq!(broken_off.map_err(|error| error.code()), Err(Code::Interrupted));
    assert_eq!(run.settle(never).map_err(|error| error.code()), Err(Code::NotSettled));
    assert!(run.change(Change::Mass(0..99, 1.0)).is_err(), "nor does a change that is refused");
    assert_eq!((run.state(), run.log().len(), run.recorded_steps()), (&here, events, 0..=newest));
    run.rewind_to(newest).expect("it is recorded");
    assert_eq!(run.state_hash(), arrived[newest as usize]);
}

#[test]
fn a_clone_is_the_ghost_of_the_earlier_run() {
    let (mut run, arrived) = eventful(64 << 20);
    let newest = *run.recorded_steps().end();
    run.rewind_to(120).expect("it is recorded");
    let mut ghost = run.clone();
    run.change(Change::Gravity(Vec3::X)).expect("allowed");
    steps(&mut run, 10);
    assert_eq!(run.recorded_steps(), 0..=130);
    assert_eq!(ghost.recorded_steps(), 0..=newest);
    ghost.rewind_to(newest).expect("it is recorded");
    assert_eq!(ghost.state_hash(), arrived[newest as usize]);
}

#[test]
fn parameters_in_the_log_count_as_memory() {
    let mut run = scenes::engine(&scenes::cloth());
    let springs = run.model().spring_count();
    let before = run.history_bytes();
    let set = |run: &mut Simulation, value: f32| {
        let mut params = run.params().clone();
        Arc::make_mut(&mut params.spring_stiffness)[0] = value;
        run.change(Change::Params(Arc::new(params))).expect("allowed");
        run.history_bytes()
    };
    let with_one = set(&mut run, 1.0);
    assert!(with_one - before >= 4 * springs);
    assert_eq!(
        set(&mut run, 2.0),
        with_one,
        "set again at the same step, they take the place of those before"
    );
    steps(&mut run, 1);
    assert_eq!(set(&mut run, 3.0) - with_one, with_one - before);
    // Another branch takes nothing with it.
    run.rewind_to(0).expect("it is recorded");
    assert_eq!(set(&mut run, 4.0), with_one);
}

#[test]
fn checkpoints_make_room_for_what_was_done() {
    let mut run = scenes::engine(&scenes::cloth());
    let state = 48 * run.model().point_count();
    let array = 4 * run.model().spring_count();
    let budget = 20 * state;
    run.keep_history(budget);
    let first = run.history_bytes();
    for step in 0..4000u16 {
        steps(&mut run, 1);
        if step % 50 == 25 {
            let mut params = run.params().clone();
            Arc::make_mut(&mut params.spring_stiffness)[0] = f32::from(step);
            run.change(Change::Params(Arc::new(params))).expect("allowed");
        }
        // What was done is never forgotten, and a quarter is left to checkpoints in any case.
        let log = run.log().len() * (array + size_of::<(u64, Event)>());
        let most = budget.max(log + budget / 4);
        assert!(run.history_bytes() <= first + most, "{} bytes of {budget}", run.history_bytes());
    }
    assert!(run.log().len() * array > budget, "the log alone would fill it");
    assert!(run.checkpoint_before(3990) > 3800, "and still the past is near");
}

proptest! {
    #![proptest_config(common::cases(40))]

    /// Steps, changes and seeks in any order: at every turn, the state is that of a fresh run of what the log says.
    #[test]
    fn seeking_and_changing_at_random_never_loses_a_bit(
        acts in prop::collection::vec(
            (0usize..30, prop_oneof![Just(0u64), 0u64..90], any::<prop::sample::Index>()),
            1..16,
        ),
        room in 0usize..12,
    ) {
        let mut run = scenes::engine(&scenes::chain());
        run.keep_history(room * 15 * 48);
        for (what, count, place) in acts {
            match every_change().get(what) {
                Some(change) if count % 2 == 0 => run.change(change.clone()).expect("allowed"),
                _ => {
                    let step = place.index(*run.recorded_steps().end() as usize + 1);
                    run.rewind_to(step as u64).expect("it is recorded");
                }
            }
            for _ in 0..count {
                let _blown_up = run.step(run.params().dt);
            }
        }
        let newest = *run.recorded_steps().end();
        run.rewind_to(newest).expect("it is recorded");
        let (state, params) = (run.state().clone(), run.params().clone());
        let again = fresh_run_of(run.log(), newest);
        prop_assert_eq!((again.state(), again.params()), (&state, &params));
    }
}

#[test]
fn going_on_from_the_past_drops_the_future() {
    let (mut run, arrived) = eventful(64 << 20);
    run.rewind_to(100).expect("it is recorded");
    let events = run.log().len();
    // Looking around keeps the future …
    run.rewind_to(200).expect("it is recorded");
    assert_eq!(run.log().len(), events);
    assert_eq!(run.state_hash(), arrived[200]);
    // … doing something drops it.
    run.rewind_to(100).expect("it is recorded");
    run.change(Change::Gravity(Vec3::Y)).expect("allowed");
    assert!(run.log().len() < events && run.log().iter().all(|(at, _)| *at <= 100));
    assert!(run.rewind_to(101).is_err());
    steps(&mut run, 30);
    let branch = run.state().clone();
    assert_ne!(run.state_hash(), arrived[130]);
    run.rewind_to(40).expect("it is recorded");
    assert_eq!(run.state_hash(), arrived[40]);
    run.rewind_to(130).expect("it is recorded");
    assert_eq!(run.state(), &branch);
}

#[test]
fn the_log_repeats_a_run_on_a_fresh_simulation() {
    let (run, _) = eventful(64 << 20);
    let again = fresh_run_of(run.log(), run.state().step);
    assert_eq!(again.state(), run.state());
}

/// The chain, with all done to it that a log says, up to a step.
fn fresh_run_of(log: &[(u64, Event)], newest: u64) -> Simulation {
    let mut again = scenes::engine(&scenes::chain());
    let mut log = log.iter().peekable();
    loop {
        while let Some((_, event)) = log.next_if(|(at, _)| *at == again.state().step) {
            match event {
                Event::Change(change) => again.change(change.clone()).expect("allowed before"),
                Event::Settle(options) => drop(again.settle(*options).expect("it settled before")),
            }
        }
        if again.state().step == newest {
            return again;
        }
        steps(&mut again, 1);
    }
}

#[test]
fn keeping_history_anew_starts_the_run_here() {
    let (mut run, _) = eventful(64 << 20);
    let here = run.state().clone();
    let params = run.params().clone();
    let first = {
        let mut fresh = run.clone();
        fresh.reset();
        fresh.state_hash()
    };
    run.keep_history(1 << 20);
    assert!(run.log().is_empty());
    steps(&mut run, 20);
    assert!(run.rewind_to(here.step - 1).is_err());
    run.rewind_to(here.step).expect("the first step of this history");
    assert_eq!((run.state(), run.params()), (&here, &params));
    steps(&mut run, 3);
    // A reset goes to where the simulation began, whatever became of its history.
    run.reset();
    assert_eq!(run.state_hash(), first);
}

#[test]
fn a_saved_state_goes_on_as_if_it_had_never_stopped() {
    for scene in scenes::four() {
        let mut run = scenes::engine(&scene);
        run.keep_ledger(true);
        steps(&mut run, 33);
        run.change(Change::Dt(0.007)).expect("allowed");
        run.change(Change::Gravity(Vec3::new(0.0, -5.0, 1.0))).expect("allowed");
        steps(&mut run, 40);
        let mut saved = Simulation::resume(run.model().clone(), run.params().clone(), run.state().clone())
            .expect("they fit");
        saved.keep_ledger(true);
        assert_eq!(saved.state(), run.state(), "{}", scene.name);
        steps(&mut run, 50);
        steps(&mut saved, 50);
        assert_eq!(saved.state(), run.state(), "{}: time and ledger too", scene.name);
    }
}

#[test]
fn a_settled_state_that_was_saved_does_not_look_like_a_blow_up() {
    // Settling books the energy it takes out as work of negative sign: a new simulation that kept that, but began its
    // books anew, would see all of it as energy from nowhere.
    let mut run = scenes::engine(&scenes::cloth());
    steps(&mut run, 40);
    run.settle(SettleOptions { residual_force: Some(0.05), ..SettleOptions::default() }).expect("it settles");
    for begin in [Simulation::new, Simulation::resume] {
        let (model, params, state) = (run.model().clone(), run.params().clone(), run.state().clone());
        let mut saved = begin(model, params, state).expect("they fit");
        assert!(!saved.is_suspect());
        steps(&mut saved, 100);
    }
}

/// Whoever never goes back may change things for hours: the log begins anew, and the motion is the same.
#[test]
fn a_long_log_can_be_forgotten() {
    let run = |forgets: bool| {
        let mut run = scenes::engine(&scenes::chain());
        let mut longest = 0;
        for change in 0..3000 {
            let force = Vec3::new(0.0, (change % 7) as f32, 0.0);
            run.change(Change::Force(14, force)).expect("allowed");
            run.steps(1).expect("it is stable");
            if forgets {
                run.forget_long_log();
            }
            longest = longest.max(run.log().len());
        }
        (run.state_hash(), longest)
    };
    let (kept, forgotten) = (run(false), run(true));
    assert_eq!(kept.0, forgotten.0);
    assert_eq!(kept.1, 3000);
    assert!(forgotten.1 <= 1025, "{}", forgotten.1);
}
