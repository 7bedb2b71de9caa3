//! What the tests share: small scenes, and a driver that does as it is told at once.

#![allow(dead_code, reason = "each test uses some of it")]

pub mod acts;

use std::sync::Arc;

use proptest::test_runner::{Config as ProptestConfig, RngSeed};
use sprung::scene::Scene;
use sprung::{Change, Checkpoint, Result, Simulation, Snapshot};
use sprung_driver::{Command, Driver, Edit, Handle, Kept, Report, Running, Source, Trouble};

/// So many random cases, the same ones on every machine.
pub fn cases(count: u32) -> ProptestConfig {
    let rng_seed = RngSeed::Fixed(3);
    ProptestConfig { rng_seed, failure_persistence: None, ..ProptestConfig::with_cases(count) }
}

/// A built-in scene.
pub fn source(name: &str) -> Source {
    Source { name: name.to_owned(), scene: Scene::builtin(name).expect("a built-in scene") }
}

/// A built-in scene with some settings.
pub fn source_with(name: &str, settings: &[(&str, &str)]) -> Source {
    let mut source = source(name);
    for (key, value) in settings {
        source.scene.set(key, value).expect("a setting that is allowed");
    }
    source
}

/// An inline driver of a built-in scene.
pub fn open(name: &str) -> Handle {
    open_source(source(name))
}

/// An inline driver.
pub fn open_source(source: Source) -> Handle {
    Handle::inline(Driver::new(source).expect("a scene that can be built"))
}

/// An edit of one change.
pub fn edit(label: &str, change: Change) -> Command {
    Command::Edit(Edit::new(label, vec![change]))
}

/// What goes on with a checkpoint, as a front end makes it from a file.
pub fn kept(report: &Report) -> Kept {
    let (name, scene) = (report.opened.name.clone(), report.opened.scene.clone());
    let checkpoint = report.checkpoint.clone().expect("a moment is kept");
    Kept::elsewhere(name.clone(), move |_| running(&name, &scene, &checkpoint))
}

/// A checkpoint of a scene, taken up again.
pub fn running(name: &str, scene: &Scene, checkpoint: &Checkpoint) -> Result<Running> {
    let (model, params, _) = scene.build()?;
    let simulation = Simulation::resume_from(model, checkpoint.clone())?;
    Ok(Running { name: name.to_owned(), scene: scene.clone(), params: Arc::new(params), simulation })
}

/// Plays for so many sixtieths of a second.
pub fn frames(handle: &mut Handle, count: usize) {
    (0..count).for_each(|_| handle.pass(1.0 / 60.0));
}

/// The state now.
pub fn now(handle: &mut Handle) -> Arc<Snapshot> {
    handle.report().now.clone()
}

/// Goes to a step and gives the state there.
pub fn at(handle: &mut Handle, step: u64) -> Arc<Snapshot> {
    handle.send(Command::Seek(step));
    let now = now(handle);
    assert_eq!(now.step, step);
    now
}

/// Whether a report agrees with itself.
pub fn check(report: &Report) {
    let points = report.opened.model.point_count();
    for snapshot in [&report.before, &report.now] {
        assert_eq!(snapshot.positions.len(), points);
        assert!(snapshot.positions.iter().chain(&snapshot.velocities).all(|vector| vector.is_finite()));
    }
    let timeline = &report.timeline;
    assert!((timeline.first.0..=timeline.newest.0).contains(&report.now.step));
    assert!(report.before.step == report.now.step || report.before.step + 1 == report.now.step);
    assert!((0.0..=1.0).contains(&report.blend));
    let scale = report.now.time.abs().max(1.0);
    assert!((timeline.time_of(report.now.step) - report.now.time).abs() < 1e-9 * scale, "the clock is off");
    assert!(report.energy.total().is_finite() && report.speed.is_finite());
    report.params.validate(&report.opened.model).expect("valid parameters");
    assert!(timeline.marks.is_sorted_by_key(|mark| mark.0));
    assert!(timeline.marks.iter().all(|mark| mark.0 <= timeline.newest.0));
    assert!(report.samples.iter().is_sorted_by(|a, b| a.step < b.step));
    assert!(report.samples.last().is_none_or(|last| last.step <= timeline.newest.0));
    assert!(report.samples.iter().all(|sample| sample.energy.total().is_finite()));
    if report.pull.is_none() && report.now.step == timeline.newest.0 && report.busy.is_none() {
        let held = report.params.grabs.len() + report.params.carried.len();
        assert_eq!(held, 0, "nobody pulls, and points are held");
    }
    if let Some((point, _)) = report.pull {
        let grabbed = report.params.grabs.iter().any(|grab| grab.point == point);
        assert!(grabbed || report.params.carried.contains_key(&point));
    }
    if report.playing {
        assert!(!matches!(report.trouble, Some(Trouble::BlewUp(_))));
    }
}
