//! Many steps at once are as many single ones: the same state, the same history, the same blow-up.

mod common;

use common::{Random, assert_same_bits, network, scenes, simulation};
use proptest::prelude::*;
use sprung::{Change, Error, Grab, SettleOptions, Simulation, Vec3};

/// As many steps one by one, until one fails.
fn one_by_one(run: &mut Simulation, count: u64) -> Result<(), Error> {
    (0..count).try_for_each(|_| run.step(run.params().dt))
}

/// Two runs of the same, one in large portions and one step by step.
struct Both {
    at_once: Simulation,
    single: Simulation,
}

impl Both {
    fn new(run: Simulation) -> Self {
        Self { at_once: run.clone(), single: run }
    }

    /// Whether both came as far, and are at the same state with the same history.
    fn steps(&mut self, count: u64, what: &str) -> Result<(), Error> {
        let [a, b] = [self.at_once.steps(count), one_by_one(&mut self.single, count)];
        self.assert_same(what);
        let sentence = |result: &Result<(), Error>| result.as_ref().err().map(ToString::to_string);
        assert_eq!(sentence(&a), sentence(&b), "{what}");
        assert_eq!(a.as_ref().err().map(Error::blow_up), b.as_ref().err().map(Error::blow_up), "{what}");
        b
    }

    fn change(&mut self, change: Change) {
        self.at_once.change(change.clone()).expect("allowed");
        self.single.change(change).expect("allowed");
    }

    fn assert_same(&self, what: &str) {
        assert_same_bits(self.at_once.state(), self.single.state(), what);
        assert_eq!(self.at_once.params(), self.single.params(), "{what}");
        assert_eq!(self.at_once.log(), self.single.log(), "{what}");
        assert_eq!(self.at_once.recorded_steps(), self.single.recorded_steps(), "{what}");
        assert_eq!(self.at_once.history_bytes(), self.single.history_bytes(), "{what}");
        let checkpoints = |run: &Simulation| {
            run.recorded_steps().map(|step| run.checkpoint_before(step)).collect::<Vec<_>>()
        };
        assert_eq!(checkpoints(&self.at_once), checkpoints(&self.single), "{what}");
    }

    /// Goes back and forth.
    fn rewind(&mut self, random: &mut Random, what: &str) {
        let newest = *self.single.recorded_steps().end();
        for step in
            [random.below(newest as usize + 1) as u64, random.below(newest as usize + 1) as u64, newest]
        {
            self.at_once.rewind_to(step).expect("it is recorded");
            self.single.rewind_to(step).expect("it is recorded");
            self.assert_same(what);
        }
    }
}

#[test]
fn scenes_run_the_same_at_once_and_step_by_step() {
    for scene in scenes::four() {
        let random = &mut Random(scene.springs as u64);
        let mut run = scenes::engine(&scene);
        // Room for a few checkpoints, so that some have to go.
        run.keep_history(6 * 48 * run.model().point_count());
        let mut both = Both::new(run);
        let last = both.single.model().point_count() - 1;
        for (count, change) in [
            (100, Change::Gravity(Vec3::new(1.0, -8.0, 0.0))),
            (63, Change::Dt(0.008)),
            (1, Change::Mass(last..last + 1, 0.7)),
            (0, Change::Force(last, Vec3::new(0.0, 3.0, 1.0))),
            (41, Change::Force(last, Vec3::ZERO)),
            (150, Change::Carry(last, Some(Vec3::X))),
            (20, Change::Carry(last, None)),
            (64, Change::Grab(Grab { point: last, target: Vec3::ZERO, stiffness: 9.0, damping: 1.0 })),
            (30, Change::Release(last)),
        ] {
            both.steps(count, scene.name).expect("it is stable");
            both.change(change);
        }
        both.rewind(random, scene.name);
        // A new branch from somewhere in the middle.
        both.at_once.rewind_to(200).expect("it is recorded");
        both.single.rewind_to(200).expect("it is recorded");
        both.steps(77, scene.name).expect("it is stable");
        both.rewind(random, scene.name);
    }
}

#[test]
fn settling_in_between_changes_nothing_of_that() {
    let mut both = Both::new(scenes::engine(&scenes::chain()));
    let options = SettleOptions { residual_force: Some(0.5), ..SettleOptions::default() };
    for count in [30, 45, 7] {
        both.steps(count, "chain").expect("it is stable");
        both.at_once.settle(options).expect("it settles");
        both.single.settle(options).expect("it settles");
        both.assert_same("chain");
    }
    both.steps(99, "chain").expect("it is stable");
    both.rewind(&mut Random(1), "chain");
}

/// Over the limit by little, caught by its energy after a while, and by much, caught as no longer finite; with the ledger on
/// too.
#[test]
fn a_blow_up_comes_at_the_same_step_with_the_same_report() {
    for (dt, ledger) in [(0.0125, false), (0.013, false), (0.05, false), (0.013, true)] {
        let mut run = scenes::engine(&scenes::jelly());
        run.change(Change::Dt(dt)).expect("allowed");
        run.keep_ledger(ledger);
        let mut both = Both::new(run);
        let error = both.steps(2_000, "jelly").expect_err("it is over the limit");
        assert!(error.blow_up().is_some(), "{error}");
        // It goes on from the last good state.
        both.change(Change::Dt(0.005));
        both.steps(50, "jelly").expect("it is stable");
        both.rewind(&mut Random(2), "jelly");
    }
}

/// Whoever looks at a state changes nothing, whichever way he looks.
#[test]
fn looking_at_random_moments_changes_nothing() {
    for scene in scenes::four() {
        let random = &mut Random(5);
        let mut alone = scenes::engine(&scene);
        let mut watched = alone.clone();
        while alone.state().step < 200 {
            let count = 1 + random.below(30) as u64;
            alone.steps(count).expect("it is stable");
            for _ in 0..count {
                watched.step(scene.dt).expect("it is stable");
                match random.below(9) {
                    0 => drop(watched.state().position[0]),
                    1 => drop(watched.snapshot().positions[0]),
                    2 => drop(watched.forces().len()),
                    3 => drop(watched.energy()),
                    4 => drop(watched.state_hash()),
                    5 => drop(watched.is_suspect()),
                    6 => watched = watched.clone(),
                    _ => {}
                }
            }
            assert_same_bits(alone.state(), watched.state(), scene.name);
        }
    }
}

proptest! {
    #![proptest_config(common::cases(40))]

    #[test]
    fn random_networks_run_the_same_at_once_and_step_by_step(
        network in network(),
        dt in prop_oneof![Just(1e-4), 1e-3..3e-2],
        counts in prop::collection::vec(0u64..70, 1..6),
    ) {
        let mut run = simulation(network.build());
        run.change(Change::Dt(dt)).expect("allowed");
        let mut both = Both::new(run);
        for count in counts {
            // Many of them blow up: both at the same step.
            let _blown_up = both.steps(count, "network");
        }
        both.rewind(&mut Random(3), "network");
    }
}

#[test]
fn no_steps_are_nothing_and_too_many_are_refused() {
    let mut run = scenes::engine(&scenes::chain());
    common::steps(&mut run, 100);
    run.rewind_to(40).expect("it is recorded");
    run.steps(0).expect("nothing to do");
    assert_eq!(*run.recorded_steps().end(), 100, "what was recorded stays");
    let error = run.steps(u64::MAX).expect_err("more than can be counted");
    assert_eq!(error.code(), sprung::Code::OutOfRange);
    assert_eq!((run.now().0, *run.recorded_steps().end()), (40, 100));
}

#[test]
fn a_state_that_no_run_can_be_at_is_refused() {
    let run = scenes::engine(&scenes::chain());
    let refused = |spoil: fn(&mut sprung::State)| {
        let mut state = run.state().clone();
        spoil(&mut state);
        let resumed = sprung::Simulation::resume(run.model().clone(), run.params().clone(), state);
        resumed.map(|_| ()).expect_err("it cannot be").code()
    };
    assert_eq!(refused(|state| state.step = u64::MAX), sprung::Code::OutOfRange);
    assert_eq!(refused(|state| state.time = f64::NAN), sprung::Code::OutOfRange);
    assert_eq!(refused(|state| state.ledger.work_in = f64::INFINITY), sprung::Code::OutOfRange);
    assert_eq!(refused(|state| state.ledger.suspect_steps = u64::MAX), sprung::Code::OutOfRange);
}

/// Denormal numbers do not come in with a state, not even at a point that never moves.
#[test]
fn a_state_is_taken_without_denormal_numbers() {
    let run = scenes::engine(&scenes::chain());
    let mut state = run.state().clone();
    state.position_low[0] = Vec3::splat(1e-40);
    state.velocity[3].x = -1e-41;
    let resumed = sprung::Simulation::resume(run.model().clone(), run.params().clone(), state);
    let resumed = resumed.expect("it is allowed");
    let (low, velocity) = (resumed.state().position_low[0], resumed.state().velocity[3].x);
    assert_eq!((low, velocity), (Vec3::ZERO, 0.0));
}
