//! Keeping a moment of a run, and going on with it: in another driver, as if it had never been left.

mod common;

use std::sync::Arc;

use sprung::scene::Scene;
use sprung::{Change, Code, Error, Vec3};
use sprung_driver::{Command, Driver, Kept, Pull, Report, Source, Trouble};

use common::{check, edit, kept, running, source};

fn driver(source: Source) -> Driver {
    Driver::new(source).expect("a scene that can be built")
}

fn obey(driver: &mut Driver, commands: impl IntoIterator<Item = Command>) -> Arc<Report> {
    for command in commands {
        driver.obey(command);
        driver.advance(0.0, &mut || true);
    }
    let report = driver.report();
    check(&report);
    report
}

fn play(driver: &mut Driver, frames: usize) {
    driver.obey(Command::Play(true));
    (0..frames).for_each(|_| driver.advance(1.0 / 60.0, &mut || true));
}

/// Another driver, of another scene, that goes on with the moment that this one keeps.
fn taken_up(driver: &mut Driver) -> Driver {
    let kept = kept(&driver.report());
    let mut other = self::driver(source("chain"));
    obey(&mut other, [Command::GoOn(kept)]);
    other
}

#[test]
fn a_moment_of_a_run_goes_on_elsewhere_with_the_same_bits() {
    for name in ["spring", "chain", "jelly", "cloth"] {
        let mut here = driver(source(name));
        play(&mut here, 20);
        obey(
            &mut here,
            [edit("gravity", Change::Gravity(Vec3::new(0.5, -3.7, 0.0))), edit("dt", Change::Dt(0.004))],
        );
        play(&mut here, 20);
        obey(&mut here, [edit("cut", Change::Cut(0..1, true))]);
        play(&mut here, 7);
        // While it plays: a moment that is kept disturbs nothing.
        let moment = obey(&mut here, [Command::Checkpoint(true)]);
        assert!(moment.playing);
        let mut there = taken_up(&mut here);
        let begun = there.report();
        assert_eq!((&begun.opened.name, begun.now.step), (&moment.opened.name, moment.now.step), "{name}");
        assert_eq!((begun.now.time, &begun.params), (moment.now.time, &moment.params), "{name}");
        assert_eq!((&begun.now, begun.energy), (&moment.now, moment.energy), "{name}");
        assert_eq!(there.state_hash(), here.state_hash(), "{name}");
        // The scene's own parameters are still those that one can go back to.
        assert_eq!(begun.opened.params, moment.opened.params, "{name}");
        assert_eq!((begun.undo.clone(), begun.timeline.marks.len()), (None, 0), "what was done is not in it");
        let [left, right] = [&mut here, &mut there].map(|driver| {
            let frames = (0..30).map(|_| Command::Frame);
            let on = obey(driver, frames);
            (on.now.clone(), on.energy, driver.state_hash())
        });
        assert_eq!(left, right, "{name}");
    }
}

/// One that never kept anything goes the same way.
#[test]
fn keeping_a_moment_changes_nothing() {
    let mut drivers = [driver(source("jelly")), driver(source("jelly"))];
    drivers.iter_mut().for_each(|driver| play(driver, 30));
    obey(&mut drivers[0], [Command::Checkpoint(true), Command::Checkpoint(false)]);
    drivers.iter_mut().for_each(|driver| play(driver, 90));
    assert_eq!(drivers[0].state_hash(), drivers[1].state_hash());
}

#[test]
fn a_moment_of_the_past_is_kept_as_it_was() {
    let mut here = driver(source("chain"));
    obey(&mut here, (0..10).map(|_| Command::Frame));
    obey(&mut here, [edit("gravity", Change::Gravity(Vec3::ZERO))]);
    obey(&mut here, (0..10).map(|_| Command::Frame));
    obey(&mut here, [Command::Seek(35), Command::Checkpoint(true)]);
    let mut there = taken_up(&mut here);
    assert_eq!(there.state_hash(), here.state_hash());
    assert_eq!(here.report().timeline.newest.0, 140, "the rest is not forgotten");
    // It knows nothing of what was recorded later, such as that gravity ended.
    let on = obey(&mut there, (0..10).map(|_| Command::Frame));
    let mut never = driver(source("chain"));
    assert_eq!(on.now.positions, obey(&mut never, (0..15).map(|_| Command::Frame)).now.positions);
}

#[test]
fn the_run_begins_where_it_is_gone_on_with() {
    let mut here = driver(source("spring"));
    play(&mut here, 33);
    let moment = obey(&mut here, [Command::Play(false), Command::Checkpoint(true)]);
    let mut there = taken_up(&mut here);
    let (step, time) = (moment.now.step, moment.now.time);
    assert_eq!(there.report().timeline.first, (step, time));
    obey(&mut there, (0..5).map(|_| Command::Frame));
    let back = obey(&mut there, [Command::Seek(step)]);
    assert_eq!(back.now, moment.now);
    obey(&mut there, [Command::Seek(step - 1)]);
    assert!(matches!(there.report().trouble, Some(Trouble::Refused(_))), "there is nothing before it");
    obey(&mut there, (0..5).map(|_| Command::Frame));
    let reset = obey(&mut there, [Command::Reset]);
    assert_eq!((&reset.now, &reset.opened.first), (&moment.now, &moment.now));
}

#[test]
fn a_hand_lets_go_of_what_is_kept_and_holds_on_here() {
    for hard in [false, true] {
        let mut here = driver(source("jelly"));
        obey(
            &mut here,
            [Command::Play(true), Command::Pull(Pull { point: 0, target: Vec3::splat(2.0), hard })],
        );
        play(&mut here, 20);
        let held = obey(&mut here, [Command::Checkpoint(true)]);
        assert!(held.pull.is_some());
        let mut there = taken_up(&mut here);
        let released = there.report();
        assert!(released.params.grabs.is_empty() && released.params.carried.is_empty());
        obey(&mut here, [Command::Release]);
        let [left, right] = [&mut here, &mut there].map(|driver| {
            obey(driver, (0..10).map(|_| Command::Frame));
            driver.state_hash()
        });
        assert_eq!(left, right);
    }
}

/// Whatever the file says: a hand that nobody has would hold a point for ever.
#[test]
fn a_hand_in_a_checkpoint_lets_go_for_good() {
    let scene = Scene::builtin("jelly").expect("a built-in scene");
    let mut simulation = scene.simulation().expect("it can be built");
    simulation.change(Change::Carry(0, Some(Vec3::X))).expect("allowed");
    simulation.steps(10).expect("it is stable");
    let running = running("jelly", &scene, &simulation.checkpoint()).expect("it can be gone on with");
    let mut driver = Driver::new(running).expect("it is built");
    obey(&mut driver, [Command::Frame]);
    let reset = obey(&mut driver, [Command::Reset]);
    assert!(reset.params.carried.is_empty());
}

#[test]
fn books_that_were_opened_late_stay_so() {
    let mut here = driver(source("chain"));
    obey(&mut here, [Command::Frame, Command::Checkpoint(true)]);
    assert!(taken_up(&mut here).report().ledger_is_whole);
    obey(&mut here, [Command::KeepLedger(false), Command::Frame, Command::KeepLedger(true), Command::Frame]);
    obey(&mut here, [Command::Checkpoint(true)]);
    let mut there = taken_up(&mut here);
    assert!(!there.report().ledger_is_whole);
    assert!(!obey(&mut there, [Command::Frame, Command::Reset]).ledger_is_whole);
}

#[test]
fn a_moment_is_kept_until_it_is_let_go_or_another_scene_is_opened() {
    let mut here = driver(source("chain"));
    let moment = obey(&mut here, [Command::Checkpoint(true)]).checkpoint.clone();
    let later = obey(&mut here, [Command::Frame]);
    assert_eq!(later.checkpoint, moment);
    assert!(obey(&mut here, [Command::Checkpoint(false)]).checkpoint.is_none());
    obey(&mut here, [Command::Checkpoint(true), Command::Open(Box::new(source("spring")))]);
    assert!(here.report().checkpoint.is_none());
}

#[test]
fn what_cannot_be_gone_on_with_changes_nothing() {
    let refused = || Error::new(Code::Unreadable, "is damaged").in_file("x.sprung");
    let mut here = driver(source("chain"));
    play(&mut here, 20);
    let before = here.report();
    let after = obey(&mut here, [Command::GoOn(Kept::elsewhere("x.sprung", move |_| Err(refused())))]);
    assert!(matches!(&after.trouble, Some(Trouble::Refused(error)) if *error == refused()));
    assert_eq!((after.opened.serial, after.playing, &after.now), (1, true, &before.now));
}
