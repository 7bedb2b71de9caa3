//! The same bits for any number of threads, in debug and in release, today and tomorrow.

mod common;

use std::collections::BTreeMap;
use std::sync::Arc;

use common::{network, scenes, simulation, steps};
use proptest::prelude::*;
use sprung::scene::{BUILTIN, Kind, Scene};
use sprung::{Change, Simulation, Vec3, Workers};

/// Threads of the standard library, started anew for each step: slow, and enough for a test.
struct Threads(usize);

impl Workers for Threads {
    fn count(&self) -> usize {
        self.0
    }

    fn run(&self, job: &(dyn Fn(usize) + Sync)) {
        std::thread::scope(|scope| {
            // The last worker first, so that finishing in order is nothing to rely on.
            for worker in (0..self.0).rev() {
                scope.spawn(move || job(worker));
            }
        });
    }
}

fn with_threads(mut run: Simulation, threads: usize) -> Simulation {
    run.set_workers(Arc::new(Threads(threads)));
    run
}

#[test]
fn any_number_of_threads_gives_the_same_bits_on_the_four_scenes() {
    for scene in scenes::four() {
        let mut alone = scenes::engine(&scene);
        steps(&mut alone, 60);
        for threads in [2, 3, 7, 64] {
            let mut together = with_threads(scenes::engine(&scene), threads);
            steps(&mut together, 60);
            assert_eq!(alone.state(), together.state(), "{} with {threads} threads", scene.name);
        }
    }
}

#[test]
fn threads_may_change_while_it_runs_and_parameters_too() {
    let mut alone = scenes::engine(&scenes::cloth());
    let mut changing = alone.clone();
    for (threads, change) in [
        (3, Change::Gravity(Vec3::new(3.0, -9.0, 0.0))),
        (1, Change::Cut(100..140, true)),
        (7, Change::Mass(50..60, 2.0)),
        (2, Change::Stiffness(0..700, 300.0)),
    ] {
        alone.change(change.clone()).expect("allowed");
        changing.change(change).expect("allowed");
        changing.set_workers(Arc::new(Threads(threads)));
        steps(&mut alone, 25);
        steps(&mut changing, 25);
        assert_eq!(alone.state(), changing.state(), "with {threads} threads");
    }
}

/// More points than one thread sums at a time, so that blocks begin and end among them.
#[test]
fn several_blocks_of_points_give_the_same_bits() {
    let run = |threads: usize| {
        let mut run = Scene::builtin("flag").and_then(|scene| scene.simulation()).expect("it is built in");
        run.keep_history(0);
        run.set_workers(Arc::new(Threads(threads)));
        steps(&mut run, 10);
        run.state_hash()
    };
    let alone = run(1);
    assert!([2, 5].into_iter().all(|threads| run(threads) == alone));
}

proptest! {
    #![proptest_config(common::cases(60))]

    #[test]
    fn any_number_of_threads_gives_the_same_bits_on_random_networks(network in network(), threads in 2usize..5) {
        let parts = common::driven(&network);
        let (mut alone, mut together) = (simulation(parts.clone()), with_threads(simulation(parts), threads));
        steps(&mut alone, 10);
        steps(&mut together, 10);
        prop_assert_eq!(alone.state(), together.state());
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
    steps(&mut run, 20_000);
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

/// For each built-in scene its hashes, with so many threads.
fn hashes(threads: usize) -> BTreeMap<String, BTreeMap<String, String>> {
    let mut found = BTreeMap::new();
    for builtin in BUILTIN {
        let mut run =
            Scene::builtin(builtin.name).and_then(|scene| scene.simulation()).expect("it is built in");
        run.keep_history(0);
        if threads > 1 {
            run.set_workers(Arc::new(Threads(threads)));
        }
        let mut hashes = BTreeMap::new();
        for &step in golden_steps(builtin.kind) {
            let left = step - run.state().step;
            steps(&mut run, left);
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
    let found = hashes(1);
    if std::env::var_os("SPRUNG_UPDATE_GOLDENS").is_some() {
        let text = serde_json::to_string_pretty(&found).expect("texts can be written");
        std::fs::write(path, text + "\n").expect("the file can be written");
    }
    let text = std::fs::read_to_string(path).expect("goldens.json lies in crates/sprung");
    let golden: BTreeMap<String, BTreeMap<String, String>> = serde_json::from_str(&text).expect("it is JSON");
    assert_eq!(
        found, golden,
        "other bits: see CONTRIBUTING.md before writing new goldens with SPRUNG_UPDATE_GOLDENS=1"
    );
    assert_eq!(hashes(3), golden, "other bits with three threads");
}
