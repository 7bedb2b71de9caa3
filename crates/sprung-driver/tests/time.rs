//! Going back and forth, branches, replay, and the run that a branch left.

mod common;

use common::{at, check, edit, frames, now, open, source};
use sprung::{Change, Vec3};
use sprung_driver::{Command, Driver, Handle, Options, Pull};

fn gravity(g: f32) -> Change {
    Change::Gravity(Vec3::new(0.0, g, 0.0))
}

#[test]
fn playing_from_the_past_replays_every_bit_and_every_change() {
    let mut handle = open("chain");
    handle.send(Command::Play(true));
    frames(&mut handle, 30);
    handle.send(edit("gravity", gravity(-3.0)));
    frames(&mut handle, 30);
    handle.send(edit("gravity", gravity(5.0)));
    frames(&mut handle, 30);
    handle.send(Command::Play(false));
    let newest = now(&mut handle);
    let states: Vec<_> = (0..=newest.step).step_by(17).map(|step| at(&mut handle, step)).collect();

    at(&mut handle, 10);
    assert_eq!(handle.report().params.gravity.y, -9.81);
    handle.send(Command::Play(true));
    let mut steps = 10;
    while steps < newest.step {
        handle.pass(0.01);
        let report = handle.report();
        check(&report);
        steps = report.now.step;
        if let Some(state) = states.iter().find(|state| state.step == steps) {
            assert_eq!(report.now, *state);
        }
        assert_eq!(report.timeline.newest.0, newest.step.max(steps), "nothing is forgotten");
    }
    assert_eq!(handle.report().params.gravity.y, 5.0);
    assert!(at(&mut handle, newest.step) == newest);

    // And on beyond the newest: as if it had never stopped.
    handle.send(Command::Play(true));
    frames(&mut handle, 30);
    handle.send(Command::Play(false));
    let beyond = now(&mut handle);
    let mut straight = open("chain");
    straight.send(Command::Play(true));
    let report = handle.report();
    for (step, label) in report.timeline.marks.iter() {
        while now(&mut straight).step < *step {
            straight.send(Command::Step);
        }
        assert_eq!(label, "gravity");
        let g = if straight.report().params.gravity.y == -9.81 { -3.0 } else { 5.0 };
        straight.send(edit("gravity", gravity(g)));
    }
    while now(&mut straight).step < beyond.step {
        straight.send(Command::Step);
    }
    assert_eq!(now(&mut straight), beyond);
}

#[test]
fn an_edit_in_the_past_branches_and_the_run_it_left_is_shown_beside() {
    let mut handle = open("chain");
    handle.send(Command::Play(true));
    frames(&mut handle, 60);
    handle.send(Command::Play(false));
    let first_run: Vec<_> = (0..=90).map(|step| at(&mut handle, step)).collect();

    at(&mut handle, 40);
    handle.send(edit("gravity", gravity(9.81)));
    let report = handle.report();
    assert_eq!((report.timeline.newest.0, report.now.step), (40, 40));
    assert!(report.comparison.is_none(), "not asked for");
    assert!(report.samples.last().is_some_and(|last| last.step == 40));
    handle.send(Command::Compare(true));
    let beside = handle.report().comparison.clone().expect("the first run");
    assert_eq!((beside.parted, beside.apart, beside.snapshot.step), (40, 0.0, 40));

    for earlier in &first_run[41..=80] {
        handle.send(Command::Step);
        let report = handle.report();
        check(&report);
        let beside = report.comparison.clone().expect("the first run");
        assert_eq!(beside.snapshot, *earlier);
        assert!(beside.apart > 0.0);
    }
    // Back in time it goes along.
    at(&mut handle, 20);
    let beside = handle.report().comparison.clone().expect("the first run");
    assert_eq!((beside.snapshot, beside.apart), (first_run[20].clone(), 0.0));
    handle.send(Command::Compare(false));
    assert!(handle.report().comparison.is_none());
}

#[test]
fn after_a_reset_the_earlier_run_is_beside_at_the_same_time_even_with_another_step() {
    let mut handle = open("chain");
    handle.send(Command::Play(true));
    frames(&mut handle, 60);
    handle.send(Command::Play(false));
    let half_a_second = at(&mut handle, 50);
    handle.send(Command::Reset);
    handle.send(edit("dt", Change::Dt(0.005)));
    handle.send(Command::Compare(true));
    (0..100).for_each(|_| handle.send(Command::Step));
    let report = handle.report();
    check(&report);
    assert!((report.now.time - 0.5).abs() < 1e-12);
    let beside = report.comparison.clone().expect("the run before the reset");
    assert_eq!((beside.snapshot, beside.parted), (half_a_second, 0));
    assert!(beside.apart > 0.0 && beside.apart < 1.0);
}

#[test]
fn a_reset_keeps_the_parameters_and_own_values_come_back() {
    let mut handle = open("chain");
    handle.send(edit("gravity", gravity(-1.0)));
    handle.send(edit("pin", Change::Pin(14..15, true)));
    handle.send(Command::Play(true));
    frames(&mut handle, 30);
    handle.send(Command::Reset);
    let report = handle.report();
    check(&report);
    assert_eq!(report.now, report.opened.first);
    assert_eq!((report.params.gravity.y, report.params.point_pinned[14]), (-1.0, true));
    assert!(report.playing && report.ledger_is_whole);
    handle.send(Command::OwnValues);
    assert_eq!(handle.report().params, handle.report().opened.params);
    handle.send(Command::Undo);
    assert_eq!(handle.report().params.gravity.y, -1.0);
}

#[test]
fn a_violent_pull_replays_bit_for_bit() {
    for hard in [false, true] {
        for name in ["spring", "chain", "cloth", "jelly"] {
            let mut handle = open(name);
            let points = handle.report().opened.model.point_count();
            handle.send(Command::Play(true));
            frames(&mut handle, 5);
            for i in 0..40u16 {
                let way = Vec3::new(f32::from(i % 7) - 3.0, f32::from(i % 5), f32::from(i % 3)) * 4.0;
                handle.send(Command::Pull(Pull { point: points - 1, target: way, hard }));
                handle.pass(1.0 / 60.0);
                check(&handle.report());
            }
            handle.send(Command::Release);
            frames(&mut handle, 10);
            handle.send(Command::Play(false));
            let report = handle.report();
            assert!(report.trouble.is_none(), "{name}: {:?}", report.trouble);
            assert!(report.params.grabs.is_empty() && report.params.carried.is_empty());
            let newest = report.now.clone();
            at(&mut handle, 3);
            assert_eq!(at(&mut handle, newest.step), newest, "{name}, hard: {hard}");
            at(&mut handle, 3);
            handle.send(Command::Play(true));
            while now(&mut handle).step < newest.step {
                handle.pass(0.01);
            }
            handle.send(Command::Play(false));
            assert_eq!(at(&mut handle, newest.step), newest);
        }
    }
}

#[test]
fn a_branch_in_the_middle_of_a_pull_lets_go() {
    for hard in [false, true] {
        let mut handle = open("chain");
        handle.send(Command::Play(true));
        handle.send(Command::Pull(Pull { point: 14, target: Vec3::splat(30.0), hard }));
        frames(&mut handle, 60);
        at(&mut handle, 40);
        let held = handle.report().params.clone();
        assert_eq!((held.grabs.len(), held.carried.len()), if hard { (0, 1) } else { (1, 0) });
        handle.send(edit("gravity", gravity(-1.0)));
        check(&handle.report());
        handle.send(Command::Play(true));
        frames(&mut handle, 30);
        check(&handle.report());
    }
}

#[test]
fn seeking_comes_in_portions_and_the_newest_place_wins() {
    let mut driver = Driver::new(source("cloth")).expect("it opens");
    driver.obey(Command::Play(true));
    (0..20).for_each(|_| driver.advance(0.25, &mut || true));
    let newest = driver.report().now.step;
    assert_eq!(newest, 500);
    let few = |driver: &mut Driver| {
        let mut left = 3;
        driver.advance(0.01, &mut || {
            left -= 1;
            left >= 0
        });
    };
    driver.obey(Command::Seek(63));
    few(&mut driver);
    let report = driver.report();
    check(&report);
    assert!(report.busy.as_deref().is_some_and(|busy| busy.starts_with("replaying")), "{:?}", report.busy);
    assert!(!driver.is_idle() && !report.playing);
    // Meanwhile something else is wanted, and an edit there.
    driver.obey(Command::Seek(200));
    driver.obey(Command::Seek(30));
    driver.obey(Command::Edit(sprung_driver::Edit::new("gravity", vec![gravity(1.0)])));
    assert_eq!(driver.report().timeline.newest.0, 500, "the edit waits");
    for _ in 0..1000 {
        if driver.is_idle() {
            break;
        }
        few(&mut driver);
    }
    let report = driver.report();
    assert_eq!((report.now.step, report.timeline.newest.0), (30, 30));
    assert_eq!((report.params.gravity.y, report.busy.clone()), (1.0, None));
}

#[test]
fn places_that_are_not_recorded_are_refused() {
    let mut handle = open("spring");
    handle.send(Command::Step);
    handle.send(Command::Seek(2));
    let report = handle.report();
    assert!(report.trouble.is_some() && report.now.step == 1);
    handle.send(Command::Dismiss);
    assert!(handle.report().trouble.is_none());
}

#[test]
fn samples_stay_when_going_back_and_go_when_branching() {
    let mut handle = open("chain");
    handle.send(Command::Watch(vec![
        sprung_driver::Probe::Position(14, 1),
        sprung_driver::Probe::Speed(14),
        sprung_driver::Probe::Strain(3),
        sprung_driver::Probe::Length(99),
    ]));
    handle.send(Command::Play(true));
    frames(&mut handle, 60);
    handle.send(Command::Play(false));
    let report = handle.report();
    let newest = report.now.step;
    assert_eq!(report.samples.len() as u64, newest + 1);
    let last = report.samples.last().expect("samples");
    assert_eq!(last.values.len(), 3, "there is no spring 99");
    assert_eq!(last.values[0].1, f64::from(report.now.positions[14].y));
    assert_eq!(last.energy.total(), report.energy.total());
    assert!(report.ledger_is_whole);
    // The engine's own energies and sums, to the bit; that these balance is tested there.
    let mut alone = source("chain").scene.simulation().expect("it can be built");
    alone.keep_ledger(true);
    (0..newest).for_each(|_| alone.step(0.01).expect("stable"));
    assert_eq!(last.energy, alone.energy());

    at(&mut handle, 20);
    assert_eq!(handle.report().samples.len() as u64, newest + 1);
    handle.send(edit("gravity", gravity(0.0)));
    assert_eq!(handle.report().samples.len(), 21);
    handle.send(Command::Reset);
    assert_eq!(handle.report().samples.len(), 1);
    check(&handle.report());
}

#[test]
fn settling_is_recorded_and_can_be_gone_back_over() {
    let mut handle = open("spring");
    (0..10).for_each(|_| handle.send(Command::Step));
    handle.send(Command::Settle);
    let settled = now(&mut handle);
    assert!((settled.positions[1].y + 5.0 + 9.81).abs() < 0.05, "{}", settled.positions[1]);
    (0..10).for_each(|_| handle.send(Command::Step));
    assert_ne!(at(&mut handle, 9), settled);
    assert_eq!(at(&mut handle, 10), settled);
    assert_eq!(handle.report().timeline.marks.to_vec(), [(10, "settled".to_owned())]);
}

/// As it does when it is broken off.
#[test]
fn settling_that_fails_leaves_everything_as_it_was() {
    let never = sprung::SettleOptions { residual_force: Some(0.0), max_steps: 100 };
    let options = Options { settle: never, ..Options::default() };
    let mut handle = Handle::inline(Driver::with(source("chain"), options).expect("it opens"));
    for hard in [false, true] {
        handle.send(Command::Reset);
        (0..20).for_each(|_| handle.send(Command::Step));
        handle.send(Command::Pull(Pull { point: 14, target: Vec3::splat(20.0), hard }));
        for going_back in [false, true] {
            if going_back {
                (0..20).for_each(|_| handle.send(Command::Step));
                handle.send(Command::Release);
                handle.send(Command::Seek(30));
            }
            let before = handle.report();
            handle.send(Command::Settle);
            let after = handle.report();
            check(&after);
            assert!(after.trouble.is_some());
            assert_eq!((&after.now, &after.params, after.pull), (&before.now, &before.params, before.pull));
            assert_eq!((&after.timeline, after.samples.len()), (&before.timeline, before.samples.len()));
            assert_eq!(
                (before.pull.is_some(), before.timeline.newest.0),
                if going_back { (false, 40) } else { (true, 20) }
            );
        }
    }
}

#[test]
fn what_is_settled_in_the_past_is_a_branch_without_the_hands_of_then() {
    let mut handle = open("spring");
    handle.send(Command::Pull(Pull { point: 1, target: Vec3::new(9.0, 0.0, 0.0), hard: false }));
    (0..20).for_each(|_| handle.send(Command::Step));
    handle.send(Command::Release);
    at(&mut handle, 10);
    assert_eq!(handle.report().params.grabs.len(), 1);
    handle.send(Command::Settle);
    let report = handle.report();
    check(&report);
    assert!(report.trouble.is_none() && report.params.grabs.is_empty());
    assert_eq!((report.now.step, report.timeline.newest.0), (10, 10));
    assert!(report.now.positions[1].x.abs() < 0.05, "nobody pulls it aside: {}", report.now.positions[1]);
    let settled = now(&mut handle);
    at(&mut handle, 3);
    assert_eq!(at(&mut handle, 10), settled);
}
