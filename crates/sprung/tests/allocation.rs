//! Solvers own their scratch memory: a step takes none, on any thread.

mod common;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use allocation_counter::{measure, opt_out};
use common::scenes;
use sprung::{Change, Grab, Material, ModelBuilder, Simulation, Vec3, Workers};

/// A hundred steps: the watch looks at five of them and keeps each as the last good state.
const STEPS: u64 = 100;

#[test]
fn a_step_allocates_nothing() {
    for scene in scenes::four() {
        let mut run = scenes::engine(&scene);
        run.keep_history(0);
        let dt = run.params().dt;
        let last = run.model().point_count() - 1;
        run.change(Change::Carry(last, Some(Vec3::Y))).expect("allowed");
        run.step(dt).expect("it is stable");
        let taken = measure(|| {
            for _ in 0..STEPS {
                run.step(dt).expect("it is stable");
            }
        });
        assert_eq!(taken.count_total, 0, "{}", scene.name);
    }
}

/// Whether anything drives it or not, many steps at once allocate nothing.
#[test]
fn many_steps_at_once_allocate_nothing() {
    for scene in scenes::four() {
        let mut run = scenes::engine(&scene);
        run.keep_history(0);
        let last = run.model().point_count() - 1;
        assert_steps_allocate_nothing(&mut run, STEPS, scene.name);
        run.change(Change::Force(last, Vec3::Y)).expect("allowed");
        assert_steps_allocate_nothing(&mut run, STEPS, scene.name);
        let grab = Grab { point: last, target: Vec3::ZERO, stiffness: 5.0, damping: 1.0 };
        run.change(Change::Grab(grab)).expect("allowed");
        assert_steps_allocate_nothing(&mut run, STEPS, scene.name);
    }
}

#[test]
fn threads_allocate_nothing() {
    let mut run = common::large_cloth(225);
    let workers = Arc::new(Counting::default());
    run.set_workers(workers.clone());
    assert_steps_allocate_nothing(&mut run, 25, "a large cloth");
    let grab = Grab { point: 7, target: Vec3::ZERO, stiffness: 5.0, damping: 1.0 };
    run.change(Change::Grab(grab)).expect("allowed");
    run.change(Change::Force(20_000, Vec3::Y)).expect("allowed");
    workers.taken.store(0, Ordering::Relaxed);
    assert_steps_allocate_nothing(&mut run, 25, "a large cloth, driven");
    // The last 25 steps one by one, as something drives them.
    assert!(workers.called.load(Ordering::Relaxed) > 27, "it is large enough for several threads");
    assert_eq!(workers.taken.load(Ordering::Relaxed), 0, "allocations on worker threads");
}

/// A chain of two large halves whose ends are joined, further apart than a sweep sees.
#[test]
fn springs_across_a_whole_model_allocate_nothing_and_cost_no_threads() {
    let points = 140_000;
    let mut builder = ModelBuilder::new();
    for point in 0..points {
        builder.add_point(Vec3::X * point as f32, 1.0).expect("allowed");
    }
    let chain = (1..points).map(|point| [point - 1, point]);
    let across = (0..100).map(|point| [3 * point, points - 1 - 5 * point]);
    for [a, b] in chain.chain(across) {
        builder.add_spring(a, b, Material { stiffness: 100.0, damping: 1.0 }).expect("allowed");
    }
    let mut run = builder.simulation().expect("there are points");
    run.keep_history(0);
    let workers = Arc::new(Counting::default());
    run.set_workers(workers.clone());
    assert_steps_allocate_nothing(&mut run, 25, "a joined chain");
    assert!(workers.called.load(Ordering::Relaxed) >= 26, "it is large enough for several threads");
}

/// Packed springs are gathered through windows of 65,536 points. A small model has room for one beyond its positions, those of
/// the last good state, those in float64 and its forces, and no more.
#[test]
fn a_copy_of_a_small_network_is_small() {
    let mut builder = ModelBuilder::new();
    for point in 0..50 {
        let at = [7, 11, 13].map(|way| (point * way % 50) as f32);
        builder.add_point(Vec3::from_array(at), 1.0).expect("allowed");
    }
    builder.connect_within(0..50, 15.0, Material { stiffness: 100.0, damping: 1.0 }).expect("allowed");
    let mut run = builder.simulation().expect("there are points");
    run.keep_history(0);
    run.steps(100).expect("it is stable");
    let taken = measure(|| drop(run.clone()));
    let (coordinate, wide, force) = (4, 8, 16);
    let windows = 65_536 * (2 * coordinate + wide + force);
    assert!(taken.bytes_total < windows + 200_000, "{} bytes", taken.bytes_total);
    assert!(taken.bytes_total > windows, "it has packed springs");
}

/// After the first step, which may make room for what was changed.
fn assert_steps_allocate_nothing(run: &mut Simulation, count: u64, what: &str) {
    run.steps(1).expect("it is stable");
    let taken = measure(|| run.steps(count).expect("it is stable"));
    assert_eq!(taken.count_total, 0, "{what}");
}

/// Three threads, whose own making is not counted but all they do is.
#[derive(Default)]
struct Counting {
    called: AtomicU64,
    taken: AtomicU64,
}

impl Workers for Counting {
    fn count(&self) -> usize {
        3
    }

    fn run(&self, job: &(dyn Fn(usize) + Sync)) {
        self.called.fetch_add(1, Ordering::Relaxed);
        let count_job = |worker| {
            let taken = measure(|| job(worker)).count_total;
            self.taken.fetch_add(taken, Ordering::Relaxed);
        };
        opt_out(|| {
            std::thread::scope(|scope| {
                for worker in 0..self.count() {
                    scope.spawn(move || count_job(worker));
                }
            });
        });
    }
}
