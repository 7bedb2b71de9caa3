//! Blow-ups and what mends them, automatic sub-steps, refusals.

mod common;

use common::{check, edit, frames, now, open, open_source, source_with};
use sprung::{Change, Code, Vec3};
use sprung_driver::{Command, Driver, Edit, Fix, Handle, Options, Trouble};

/// Plays until something goes wrong, at the most so many frames.
fn play_until_trouble(handle: &mut Handle, most: usize) -> bool {
    handle.send(Command::Play(true));
    for _ in 0..most {
        handle.pass(1.0 / 60.0);
        let report = handle.report();
        check(&report);
        if report.trouble.is_some() {
            return true;
        }
    }
    false
}

/// The jelly with dt = 0.013 s, as it stands when it has blown up.
fn blown_up() -> Handle {
    let mut handle = open("jelly");
    frames(&mut handle, 1);
    handle.send(edit("dt", Change::Dt(0.013)));
    assert!(play_until_trouble(&mut handle, 1000), "it has to blow up");
    handle
}

#[test]
fn a_blow_up_pauses_at_the_last_good_state_and_is_mended() {
    let mut handle = blown_up();
    let report = handle.report();
    let Some(Trouble::BlewUp(blow_up)) = &report.trouble else { panic!("{:?}", report.trouble) };
    assert!(!report.playing && report.busy.is_none());
    assert_eq!((report.now.step, report.now.time), (blow_up.good_step, blow_up.good_time));
    assert_eq!(report.timeline.newest.0, blow_up.good_step);
    assert!(blow_up.spring.is_some() && blow_up.points.len() == 2);
    assert_eq!(report.params.dt, 0.013);
    assert!(matches!(report.fixes[..], [Fix::Dt(dt), Fix::Substeps, ..] if dt < 0.012), "{:?}", report.fixes);

    let good_time = report.now.time;
    for fix in report.fixes.clone() {
        handle.send(Command::Fix(fix));
        handle.send(Command::RewindAndGoOn(2.0));
        let report = handle.report();
        assert!(report.playing && report.trouble.is_none() && report.fixes.is_empty());
        assert!((report.now.time - (good_time - 2.0).max(0.0)).abs() < 0.014, "{}", report.now.time);
        assert!(!play_until_trouble(&mut handle, 150), "{fix}: {:?}", handle.report().trouble);
        // Taken back, it blows up once more.
        handle.send(Command::Undo);
        assert_eq!(handle.report().params.dt, 0.013, "{fix}");
        handle.send(Command::Reset);
        assert!(play_until_trouble(&mut handle, 1000));
    }
}

#[test]
fn going_on_without_a_fix_is_allowed_and_blows_up_again() {
    let mut handle = blown_up();
    handle.send(Command::RewindAndGoOn(1e9));
    let report = handle.report();
    assert_eq!((report.now.step, report.params.dt, report.playing), (0, 0.013, true));
    assert!(play_until_trouble(&mut handle, 1000));
    for seconds in [0.0, -1.0, f64::NAN] {
        let step = now(&mut handle).step;
        handle.send(Command::RewindAndGoOn(seconds));
        assert_eq!(now(&mut handle).step, step);
        handle.send(Command::Play(false));
    }
}

/// The good state may lie before the edit that was too much: the edit stays, and can be undone.
#[test]
fn what_the_user_set_stays_set_when_it_blows_up_at_once() {
    let mut handle = open("jelly");
    handle.send(Command::Play(true));
    frames(&mut handle, 59);
    handle.send(edit("stiffness", Change::Stiffness(0..7560, 1e9)));
    assert!(play_until_trouble(&mut handle, 100));
    let report = handle.report();
    assert!(matches!(report.trouble, Some(Trouble::BlewUp(_))));
    assert_eq!((report.params.spring_stiffness[0], report.undo.as_deref()), (1e9, Some("stiffness")));
    handle.send(Command::Undo);
    assert!(!play_until_trouble(&mut handle, 100));
}

#[test]
fn automatic_substeps_keep_every_stiffness_stable() {
    let mut handle = open("cloth");
    handle.send(Command::AutoSubsteps(true));
    handle.send(Command::Play(true));
    for stiffness in [600.0, 6e3, 6e4, 6e5, 10.0, 1e5] {
        handle.send(edit("stiffness", Change::Stiffness(0..1482, stiffness)));
        handle.send(edit("damping", Change::Damping(0..1482, stiffness / 200.0)));
        assert!(!play_until_trouble(&mut handle, 20), "{:?}", handle.report().trouble);
        let report = handle.report();
        let limit = report.stability.every_configuration.expect("a limit");
        assert!(report.params.dt <= 0.95 * limit && report.auto_substeps);
        assert!((report.params.dt * f64::from(report.params.substeps) - 0.07).abs() < 1e-12);
    }
    assert!(handle.report().params.substeps > 50);
    // What cannot be split is refused, and nothing has changed.
    let before = handle.report().params.clone();
    handle.send(edit("damping", Change::Damping(0..1482, 1e9)));
    let report = handle.report();
    assert!(matches!(&report.trouble, Some(Trouble::Refused(error)) if error.code() == Code::OutOfRange));
    assert!(report.params == before && report.playing);
    handle.send(Command::AutoSubsteps(false));
    let report = handle.report();
    assert_eq!((report.params.dt, report.params.substeps, report.auto_substeps), (0.01, 7, false));
    handle.send(Command::Undo);
    assert!(handle.report().auto_substeps && handle.report().params.dt < 0.01);
    // A step that is set by hand takes over.
    handle.send(edit("dt", Change::Dt(1e-5)));
    assert!(!handle.report().auto_substeps && handle.report().params.dt == 1e-5);
}

#[test]
fn a_scene_that_cannot_be_opened_leaves_the_one_before() {
    let options = Options { memory_limit: Some(10 << 20), ..Options::default() };
    let mut handle = Handle::inline(Driver::with(common::source("chain"), options).expect("it is small"));
    handle.send(Command::Play(true));
    frames(&mut handle, 6);
    handle.send(Command::Open(Box::new(common::source("cloth512"))));
    let report = handle.report();
    let Some(Trouble::Refused(error)) = &report.trouble else { panic!("{:?}", report.trouble) };
    assert_eq!(error.code(), Code::TooLarge);
    assert_eq!((&*report.opened.name, report.opened.serial, report.playing), ("chain", 1, true));
    handle.send(Command::Open(Box::new(common::source("jelly"))));
    let report = handle.report();
    check(&report);
    assert_eq!((&*report.opened.name, report.opened.serial, report.now.step), ("jelly", 2, 0));
    assert!(report.undo.is_none() && report.trouble.is_none());
    assert!(
        Driver::with(
            common::source("cloth512"),
            Options { memory_limit: Some(1 << 20), ..Options::default() }
        )
        .is_err()
    );
}

#[test]
fn an_edit_is_made_whole_or_not_at_all() {
    let mut handle = open("chain");
    handle.send(Command::Play(true));
    frames(&mut handle, 30);
    let newest = now(&mut handle).step;
    common::at(&mut handle, 5);
    for wrong in [
        Change::Dt(-1.0),
        Change::Pin(0..99, true),
        Change::Grab(sprung::Grab { point: 1, target: Vec3::ZERO, stiffness: 1.0, damping: 0.0 }),
        Change::Place(99, Vec3::ZERO),
    ] {
        let before = handle.report();
        handle.send(Command::Edit(Edit::new("wrong", vec![Change::Gravity(Vec3::ZERO), wrong])));
        let report = handle.report();
        assert!(matches!(report.trouble, Some(Trouble::Refused(_))));
        assert!(report.params == before.params && report.undo.is_none());
        assert_eq!(report.timeline.newest.0, newest, "what was recorded is not lost to a mistake");
    }
}

/// The limits agree with each other, and the sharp one is known of every state that stands still.
#[test]
fn the_limits_are_in_order_and_fresh() {
    let mut handle = open_source(source_with("jelly", &[("dt", "0.005")]));
    let report = handle.report();
    let first = report.stability;
    assert_eq!(first.sharp_step, Some(0));
    assert!((first.sharp.expect("a limit") - 0.0119753).abs() < 1e-5);
    handle.send(Command::Play(true));
    let mut steps = Vec::new();
    for _ in 0..90 {
        handle.pass(1.0 / 60.0);
        let report = handle.report();
        let limits = report.stability;
        let certified = limits.certified.expect("a limit").dt;
        assert!(limits.every_configuration.expect("a limit") <= certified);
        if limits.sharp_step == Some(report.now.step) {
            assert!(certified <= limits.sharp.expect("a limit") * (1.0 + 1e-6));
        }
        steps.extend(limits.sharp_step);
    }
    steps.dedup();
    assert!((2..=5).contains(&steps.len()), "sharp limits of steps {steps:?}");
    handle.send(Command::Play(false));
    let report = handle.report();
    assert_eq!(report.stability.sharp_step, Some(report.now.step));
    handle.send(edit("stiffness", Change::Stiffness(0..7560, 75.0)));
    let softer = handle.report().stability;
    assert!(softer.every_configuration > first.every_configuration && softer.sharp > first.sharp);
}
