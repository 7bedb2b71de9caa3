//! Anything that a front end may do, at random.

#![allow(dead_code, reason = "each test uses some of it")]

use proptest::prelude::*;
use sprung::scene::Scene;
use sprung::{Change, Vec3};
use sprung_driver::{Command, Driver, Edit, Fix, Kept, Options, Pace, Probe, Pull, Source};

/// A command, or time that passes.
#[derive(Clone, Debug)]
pub enum Act {
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

pub fn act() -> impl Strategy<Value = Act> {
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
            .prop_map(|name| Command::Open(Box::new(Source { name: name.to_owned(), scene: builtin(name) }))),
    ];
    prop_oneof![
        10 => command.prop_map(Act::Send),
        10 => (0.0..0.1, 0u32..12).prop_map(|(seconds, steps)| Act::Pass(seconds, steps)),
        2 => (0.0..1.0).prop_map(Act::Seek),
        1 => Just(Act::GoOn),
    ]
}

fn builtin(name: &str) -> Scene {
    Scene::builtin(name).expect("a built-in scene")
}

/// Settling soon gives up, so that a test ends.
pub fn options() -> Options {
    let settle = sprung::SettleOptions { residual_force: None, max_steps: 2000 };
    Options { settle, history_bytes: 40_000, ..Default::default() }
}

impl Act {
    /// Does it; `obey` is how a command gets to the driver, and `kept` goes on with the moment that it keeps.
    pub fn act(
        self,
        driver: &mut Driver,
        obey: &mut dyn FnMut(&mut Driver, Command),
        kept: &dyn Fn(&mut Driver) -> Option<Kept>,
    ) {
        match self {
            Self::Send(command) => obey(driver, command),
            Self::Seek(share) => {
                let newest = driver.report().timeline.newest.0;
                obey(driver, Command::Seek((share * newest as f64) as u64));
            }
            Self::GoOn => {
                if let Some(kept) = kept(driver) {
                    obey(driver, Command::GoOn(kept));
                }
            }
            Self::Pass(seconds, steps) => {
                let mut left = steps;
                driver.advance(seconds, &mut || {
                    left = left.saturating_sub(1);
                    left > 0
                });
            }
        }
    }
}
