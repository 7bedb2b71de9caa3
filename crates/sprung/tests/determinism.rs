//! The same bits for any number of threads, in debug and in release, today and tomorrow.

mod common;

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use common::{assert_same_bits, simulation};
use sprung::scene::{BUILTIN, Builtin, Kind, Scene};
use sprung::{Change, Vec3, Workers};

/// Threads of the standard library, started anew for each step: slow, and enough for a test.
struct Threads {
    count: usize,
    /// How often they were called on.
    called: AtomicUsize,
}

impl Threads {
    fn new(count: usize) -> Arc<Self> {
        Arc::new(Self { count, called: AtomicUsize::new(0) })
    }

    fn called(&self) -> usize {
        self.called.load(Ordering::Relaxed)
    }
}

impl Workers for Threads {
    fn count(&self) -> usize {
        self.count
    }

    fn run(&self, job: &(dyn Fn(usize) + Sync)) {
        self.called.fetch_add(1, Ordering::Relaxed);
        // WebAssembly has no threads here: the work is divided as it would be among them, and done part by part.
        if cfg!(target_family = "wasm") {
            return (0..self.count).rev().for_each(job);
        }
        std::thread::scope(|scope| {
            // The last worker first, so that finishing in order is nothing to rely on.
            for worker in (0..self.count).rev() {
                scope.spawn(move || job(worker));
            }
        });
    }
}

#[test]
fn small_scenes_leave_other_threads_alone() {
    for builtin in BUILTIN.iter().filter(|builtin| builtin.kind != Kind::Benchmark) {
        let mut run =
            Scene::builtin(builtin.name).and_then(|scene| scene.simulation()).expect("it is built in");
        let threads = Threads::new(64);
        run.set_workers(threads.clone());
        run.steps(20).expect("it is stable");
        assert_eq!(threads.called(), 0, "{}: calling on threads takes longer than its step", builtin.name);
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let start = common::large_cloth(225);
    let mut alone = start.clone();
    alone.steps(25).expect("it is stable");
    for count in [2, 3, 7, 64] {
        let (mut together, threads) = (start.clone(), Threads::new(count));
        together.set_workers(threads.clone());
        together.steps(25).expect("it is stable");
        assert_same_bits(alone.state(), together.state(), &format!("{count} threads"));
        assert!(threads.called() > 0, "{count} threads were not called on");
    }
}

#[test]
fn threads_may_change_while_it_runs_and_parameters_too() {
    let mut alone = common::large_cloth(225);
    let mut changing = alone.clone();
    let (points, springs) = (alone.model().point_count(), alone.model().spring_count());
    let middle = points / 2;
    for (count, change) in [
        (3, Change::Gravity(Vec3::new(3.0, -9.0, 0.0))),
        (1, Change::Cut(springs / 3..springs / 3 + 900, true)),
        (7, Change::Mass(points / 3..2 * points / 3, 2.0)),
        (2, Change::Stiffness(springs / 2..springs, 80.0)),
        (3, Change::Carry(middle, Some(Vec3::Y))),
        (3, Change::Place(points - 1, Vec3::new(225.0, 1.0, 226.0))),
        (2, Change::Pin(middle + 300..points, true)),
    ] {
        alone.change(change.clone()).expect("allowed");
        changing.change(change).expect("allowed");
        let threads = Threads::new(count);
        changing.set_workers(threads.clone());
        alone.steps(9).expect("it is stable");
        changing.steps(9).expect("it is stable");
        assert_same_bits(alone.state(), changing.state(), &format!("{count} threads"));
        assert_eq!(threads.called() > 0, count > 1, "{count} threads");
    }
}

/// Numbers so small that hosts differ in how they treat them, and slow down.
#[test]
fn a_long_rest_leaves_no_denormal_numbers() {
    // A cloth held at three corners, bumped in its own plane, where every motion stretches something and dies away.
    let mut builder = sprung::ModelBuilder::new();
    for at in 0..25 {
        builder.add_point(Vec3::new((at / 5) as f32, (at % 5) as f32, 0.0), 0.1).expect("allowed");
        builder.set_velocity(at, Vec3::new((at % 3) as f32 - 1.0, (at % 4) as f32, 0.0)).expect("allowed");
    }
    [0, 4, 20].into_iter().for_each(|corner| builder.pin(corner).expect("there is such a point"));
    builder.connect_within(0..25, 1.5, sprung::Material { stiffness: 50.0, damping: 1.0 }).expect("allowed");
    let (model, mut params, state) = builder.build().expect("there are points");
    params.dt = 0.005;
    params.gravity = Vec3::ZERO;
    let mut run = simulation((model, params, state));
    run.steps(20_000).expect("it is stable");
    let state = run.state();
    let arrays = [&state.position, &state.position_low, &state.velocity, &state.velocity_low];
    let numbers = arrays.into_iter().flatten().flat_map(|vector| vector.to_array());
    assert!(numbers.into_iter().all(|number| !number.is_subnormal()));
    assert!(run.energy().kinetic < 1e-6, "it has come to rest: {} J", run.energy().kinetic);
}

/// Steps after which a scene's hash is kept.
fn golden_steps(kind: Kind) -> &'static [u64] {
    if kind == Kind::Benchmark { &[0, 1, 10] } else { &[0, 1, 100, 1000] }
}

/// By the name of a scene and the step.
type Hashes = BTreeMap<String, BTreeMap<String, String>>;

/// The hashes of some built-in scenes, with these threads.
fn hashes(threads: &Arc<Threads>, is_wanted: impl Fn(&Builtin) -> bool) -> Hashes {
    let mut found = BTreeMap::new();
    for builtin in BUILTIN.iter().filter(|builtin| is_wanted(builtin)) {
        let mut run =
            Scene::builtin(builtin.name).and_then(|scene| scene.simulation()).expect("it is built in");
        run.keep_history(0);
        run.set_workers(threads.clone());
        let mut hashes = BTreeMap::new();
        for &step in golden_steps(builtin.kind) {
            let left = step - run.state().step;
            run.steps(left).expect("it is stable");
            hashes.insert(step.to_string(), format!("{:016x}", run.state_hash()));
        }
        found.insert(builtin.name.to_owned(), hashes);
    }
    found
}

/// `goldens.json`: for each built-in scene its state hash after some steps. Every build and every door must meet them.
#[test]
fn every_built_in_scene_has_its_golden_hashes() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/goldens.json");
    let found = hashes(&Threads::new(1), |_| true);
    if std::env::var_os("SPRUNG_UPDATE_GOLDENS").is_some() {
        let text = serde_json::to_string_pretty(&found).expect("texts can be written");
        std::fs::write(path, text + "\n").expect("the file can be written");
    }
    let text = std::fs::read_to_string(path).expect("goldens.json lies in crates/sprung");
    let mut golden: Hashes = serde_json::from_str(&text).expect("it is JSON");
    assert_eq!(
        found, golden,
        "other bits: see CONTRIBUTING.md before writing new goldens with SPRUNG_UPDATE_GOLDENS=1"
    );
    // Of those that are large enough to be divided, with threads too.
    let threads = Threads::new(3);
    let found = hashes(&threads, |builtin| builtin.kind == Kind::Benchmark);
    assert!(threads.called() >= found.len(), "each is divided");
    golden.retain(|name, _| found.contains_key(name));
    assert_eq!(found, golden, "other bits with three threads");
}
