//! Hands at points: soft and hard, playing and paused, in every scene.

mod common;

use common::{check, edit, frames, now, open};
use sprung::scene::{BUILTIN, Kind};
use sprung::{Change, Vec3};
use sprung_driver::{Command, Pull, Trouble};

#[test]
fn a_soft_pull_is_felt_in_every_scene_and_hurts_none() {
    for builtin in BUILTIN.iter().filter(|builtin| builtin.kind != Kind::Benchmark) {
        let (mut free, mut pulled) = (open(builtin.name), open(builtin.name));
        let report = pulled.report();
        let points = report.opened.model.point_count();
        let point = (0..points).rev().find(|&point| !report.params.is_fixed(point)).expect("a free point");
        let size = report.opened.model.spring_rest_length().iter().copied().fold(0.0, f32::max);
        for handle in [&mut free, &mut pulled] {
            handle.send(Command::Play(true));
        }
        // The hand goes up by two springs' lengths within half a second, and stays there.
        let start = report.now.positions[point];
        let mut target = start;
        for frame in 1..=45 {
            target = start + Vec3::Y * (2.0 * size * (frame as f32 / 30.0).min(1.0));
            pulled.send(Command::Pull(Pull { point, target, hard: false }));
            frames(&mut free, 1);
            frames(&mut pulled, 1);
            check(&pulled.report());
        }
        let report = pulled.report();
        assert!(report.trouble.is_none(), "{}: {:?}", builtin.name, report.trouble);
        assert_eq!(report.pull, Some((point, target)));
        let way = |state: &sprung::Snapshot| (state.positions[point] - target).length();
        let (with, without) = (way(&report.now), way(&now(&mut free)));
        assert!(with < 0.5 * without, "{}: {with} m from the hand, {without} m without it", builtin.name);
        pulled.send(Command::Release);
        frames(&mut pulled, 15);
        let report = pulled.report();
        assert!(report.trouble.is_none() && report.pull.is_none() && report.params.grabs.is_empty());
    }
}

#[test]
fn a_hard_pull_arrives_rests_and_lets_go_with_its_velocity() {
    let mut handle = open("jelly");
    handle.send(Command::Play(true));
    frames(&mut handle, 10);
    let start = now(&mut handle).positions[999];
    for frame in 1..=30u8 {
        let target = start + Vec3::X * (0.2 * f32::from(frame));
        handle.send(Command::Pull(Pull { point: 999, target, hard: true }));
        frames(&mut handle, 1);
        let report = handle.report();
        check(&report);
        assert!((report.now.positions[999] - target).length() < 0.5, "frame {frame}");
    }
    frames(&mut handle, 30);
    let at_rest = now(&mut handle);
    assert!((at_rest.positions[999] - (start + Vec3::X * 6.0)).length() < 1e-3);
    assert_eq!(at_rest.velocities[999], Vec3::ZERO);
    handle.send(Command::Pull(Pull { point: 999, target: start + Vec3::X * 7.0, hard: true }));
    handle.pass(0.01);
    let velocity = now(&mut handle).velocities[999];
    assert!(velocity.x > 10.0);
    handle.send(Command::Release);
    assert_eq!(now(&mut handle).velocities[999], velocity);
    assert!(handle.report().params.carried.is_empty() && handle.report().pull.is_none());
    frames(&mut handle, 60);
    assert!(handle.report().trouble.is_none(), "{:?}", handle.report().trouble);
}

#[test]
fn a_paused_scene_is_shaped_by_hand() {
    let mut handle = open("cloth");
    let target = Vec3::new(1.0, 20.0, 3.0);
    for part in 1..=5u8 {
        let target = target * (f32::from(part) / 5.0);
        handle.send(Command::Pull(Pull { point: 210, target, hard: true }));
        let report = handle.report();
        check(&report);
        assert_eq!((report.now.positions[210], report.now.step), (target, 0));
    }
    handle.send(Command::Release);
    assert_eq!(now(&mut handle).positions[210], target);
    handle.send(Command::Step);
    // Reset undoes it.
    handle.send(Command::Reset);
    assert_eq!(now(&mut handle), handle.report().opened.first);
}

#[test]
fn a_fixed_point_does_not_follow_a_soft_pull_but_can_be_carried() {
    let mut handle = open("chain");
    let pull = Pull { point: 0, target: Vec3::new(0.0, 30.0, 0.0), hard: false };
    handle.send(Command::Pull(pull));
    let report = handle.report();
    assert!(matches!(report.trouble, Some(Trouble::Refused(_))) && report.pull.is_none());
    handle.send(Command::Play(true));
    handle.send(Command::Pull(Pull { hard: true, ..pull }));
    frames(&mut handle, 30);
    let report = handle.report();
    assert!((report.now.positions[0] - pull.target).length() < 1e-3 && report.trouble.is_none());
    handle.send(Command::Release);
    frames(&mut handle, 30);
    assert!((now(&mut handle).positions[0] - pull.target).length() < 1e-3, "it is fixed there");
}

#[test]
fn nonsense_is_refused() {
    let mut handle = open("spring");
    for (point, target) in [(2, Vec3::ZERO), (usize::MAX, Vec3::ZERO), (1, Vec3::NAN), (1, Vec3::splat(1e30))]
    {
        for hard in [false, true] {
            handle.send(Command::Pull(Pull { point, target, hard }));
            let report = handle.report();
            assert!(matches!(report.trouble, Some(Trouble::Refused(_))) && report.pull.is_none());
            handle.send(Command::Dismiss);
        }
    }
}

/// Sub-steps follow the hand, and come back when it is gone.
#[test]
fn automatic_substeps_count_the_hand() {
    let mut handle = open("jelly");
    handle.send(Command::AutoSubsteps(true));
    handle.send(edit("stiffness", Change::Stiffness(0..7560, 7500.0)));
    let before = handle.report().params.clone();
    handle.send(Command::Play(true));
    handle.send(Command::Pull(Pull { point: 555, target: Vec3::splat(20.0), hard: false }));
    frames(&mut handle, 30);
    let report = handle.report();
    assert!(report.params.dt <= 0.95 * report.stability.every_configuration.expect("a limit"));
    assert!(report.trouble.is_none());
    handle.send(Command::Release);
    let after = handle.report().params.clone();
    assert_eq!((after.dt, after.substeps), (before.dt, before.substeps));
}
