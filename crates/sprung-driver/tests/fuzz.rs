//! Anything in any order: no panic, nothing that is not finite, reports that agree with themselves, and a record that
//! replays bit for bit.

mod common;

use common::{at, check, kept, source};
use proptest::prelude::*;
use sprung::{Change, Vec3};
use sprung_driver::{Command, Driver, Edit, Fix, Handle, Pace, Probe, Pull, Trouble};

/// A command, or time that passes.
#[derive(Clone, Debug)]
enum Act {
    Send(Command),
    Pass(f64, u32),
    /// Goes to this share of what is recorded.
    Seek(f64),
    /// Goes on with the moment that was kept, if one was.
    GoOn,
}

fn change() -> impl Strategy<Value = Change> {
    let few = || (0usize..16, 0usize..4).prop_map(|(first, count)| first..first + count);
    prop_oneof![
        prop::sample::select(vec![1e-4, 1e-3, 0.01, 0.02, 0.05, 0.2, -1.0, f64::NAN]).prop_map(Change::Dt),
        (0u32..20).prop_map(Change::Substeps),
        (-30.0f32..30.0).prop_map(|g| Change::Gravity(Vec3::new(0.1, g, 0.0))),
        (few(), -0.1f32..4.0).prop_map(|(points, mass)| Change::Mass(points, mass)),
        (few(), any::<bool>()).prop_map(|(points, on)| Change::Pin(points, on)),
        (few(), 0.0f32..5000.0).prop_map(|(springs, k)| Change::Stiffness(springs, k)),
        (few(), 0.0f32..50.0).prop_map(|(springs, d)| Change::Damping(springs, d)),
        (few(), 0.0f32..3.0).prop_map(|(springs, scale)| Change::RestScale(springs, scale)),
        (few(), any::<bool>()).prop_map(|(springs, on)| Change::Cut(springs, on)),
        (0usize..16, -9.0f32..9.0).prop_map(|(point, force)| Change::Force(point, Vec3::splat(force))),
        (0usize..16, -9.0f32..9.0).prop_map(|(point, x)| Change::Place(point, Vec3::splat(x))),
    ]
}

fn act() -> impl Strategy<Value = Act> {
    let label = prop::sample::select(vec!["one", "two"]);
    let edit = (label, prop::collection::vec(change(), 1..3), any::<bool>()).prop_map(
        |(label, changes, continues)| Command::Edit(Edit { continues, ..Edit::new(label, changes) }),
    );
    let pull = (0usize..16, prop::array::uniform3(-40.0f32..40.0), any::<bool>())
        .prop_map(|(point, target, hard)| Command::Pull(Pull { point, target: target.into(), hard }));
    let fix =
        prop_oneof![(0.0001..0.1).prop_map(Fix::Dt), Just(Fix::Substeps), (-0.5..3.0).prop_map(Fix::Damping)];
    let command = prop_oneof![
        8 => edit,
        8 => pull,
        8 => any::<bool>().prop_map(Command::Play),
        4 => Just(Command::Step),
        2 => Just(Command::Frame),
        1 => Just(Command::Reset),
        1 => Just(Command::OwnValues),
        4 => Just(Command::Undo),
        3 => Just(Command::Redo),
        2 => (0u64..100).prop_map(Command::Seek),
        2 => prop::sample::select(Pace::ALL.to_vec()).prop_map(Command::Pace),
        2 => any::<bool>().prop_map(Command::AutoSubsteps),
        4 => Just(Command::Release),
        1 => Just(Command::Settle),
        1 => any::<bool>().prop_map(Command::KeepLedger),
        1 => any::<bool>().prop_map(Command::WantForces),
        1 => Just(Command::Watch(vec![Probe::Speed(3), Probe::Strain(2), Probe::Position(99, 9)])),
        2 => any::<bool>().prop_map(Command::Compare),
        3 => any::<bool>().prop_map(Command::Checkpoint),
        2 => fix.prop_map(Command::Fix),
        3 => (-1.0..3.0).prop_map(Command::RewindAndGoOn),
        1 => Just(Command::FindSharpLimit),
        1 => Just(Command::Dismiss),
        1 => prop::sample::select(vec!["spring", "chain"])
            .prop_map(|name| Command::Open(Box::new(source(name)))),
    ];
    prop_oneof![
        10 => command.prop_map(Act::Send),
        10 => (0.0..0.1, 0u32..12).prop_map(|(seconds, steps)| Act::Pass(seconds, steps)),
        2 => (0.0..1.0).prop_map(Act::Seek),
        1 => Just(Act::GoOn),
    ]
}

/// Settling soon gives up, so that a test ends.
fn options() -> sprung_driver::Options {
    let settle = sprung::SettleOptions { residual_force: None, max_steps: 2000 };
    sprung_driver::Options { settle, history_bytes: 40_000, ..Default::default() }
}

proptest! {
    #![proptest_config(common::cases(300))]

    #[test]
    fn anything_in_any_order(acts in prop::collection::vec(act(), 1..150)) {
        let mut driver = Driver::with(source("chain"), options()).expect("it opens");
        for act in acts {
            match act {
                Act::Send(command) => driver.obey(command),
                Act::Seek(share) => {
                    let newest = driver.report().timeline.newest.0;
                    driver.obey(Command::Seek((share * newest as f64) as u64));
                }
                Act::GoOn => {
                    let report = driver.report();
                    if report.checkpoint.is_some() {
                        driver.obey(Command::GoOn(kept(&report)));
                    }
                }
                Act::Pass(seconds, steps) => {
                    let mut left = steps;
                    driver.advance(seconds, &mut || {
                        left = left.saturating_sub(1);
                        left > 0
                    });
                }
            }
            check(&driver.report());
        }
        // Whatever happened: it replays.
        while !driver.is_idle() {
            driver.obey(Command::Play(false));
            driver.advance(0.0, &mut || true);
        }
        driver.obey(Command::Release);
        driver.advance(0.0, &mut || true);
        let mut handle = Handle::inline(driver);
        let timeline = handle.report().timeline.clone();
        let (first, newest) = (timeline.first.0, timeline.newest.0);
        let half_way = first.midpoint(newest);
        let end = at(&mut handle, newest);
        let middle = at(&mut handle, half_way);
        at(&mut handle, first);
        prop_assert_eq!(at(&mut handle, half_way), middle);
        at(&mut handle, first);
        handle.send(Command::Pace(Pace::RealTime));
        handle.send(Command::Play(true));
        let mut turns = 0;
        while handle.report().now.step < newest {
            handle.send(Command::Step);
            turns += 1;
            prop_assert!(turns < 1_000_000);
        }
        prop_assert_eq!(&handle.report().now, &end);
        prop_assert!(!matches!(handle.report().trouble, Some(Trouble::BlewUp(_))));
    }
}
