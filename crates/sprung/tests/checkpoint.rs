//! A simulation that is taken up from a checkpoint goes on as if it had never stopped.

use std::sync::Arc;

use sprung::scene::{BUILTIN, Kind, Scene};
use sprung::{Change, Checkpoint, Code, Grab, Simulation, Vec3, Workers};

/// Three workers, one after another: how the work is divided is what matters here.
struct Three;

impl Workers for Three {
    fn count(&self) -> usize {
        3
    }

    fn run(&self, job: &(dyn Fn(usize) + Sync)) {
        std::thread::scope(|scope| {
            for worker in 0..3 {
                scope.spawn(move || job(worker));
            }
        });
    }
}

fn simulation(name: &str) -> Simulation {
    Scene::builtin(name).and_then(|scene| scene.simulation()).expect("it is built in")
}

fn again(run: &Simulation, checkpoint: Checkpoint) -> Simulation {
    Simulation::resume_from(run.model().clone(), checkpoint).expect("it fits")
}

/// Everything that can be asked for, compared to the bit.
fn assert_same(a: &mut Simulation, b: &mut Simulation, what: &str) {
    assert_eq!(a.state(), b.state(), "{what}: state, time, clock and sums");
    assert_eq!(a.state_hash(), b.state_hash(), "{what}");
    assert_eq!(a.params(), b.params(), "{what}");
    assert_eq!(a.energy(), b.energy(), "{what}");
}

#[test]
fn every_scene_goes_on_to_the_same_bits_from_any_step() {
    for builtin in BUILTIN.iter().filter(|builtin| builtin.kind != Kind::Benchmark) {
        let mut run = simulation(builtin.name);
        run.keep_ledger(true);
        let mut resumed = simulation(builtin.name);
        resumed.keep_ledger(true);
        // Stopped again and again, at steps that have nothing to do with when the watch looks.
        for steps in [0, 1, 7, 20, 33] {
            run.steps(steps).expect("it is stable");
            resumed.steps(steps).expect("it is stable");
            resumed = again(&run, resumed.checkpoint());
            assert_same(&mut run, &mut resumed, builtin.name);
        }
    }
}

#[test]
fn all_that_was_changed_is_kept() {
    let mut run = simulation("cloth");
    run.keep_ledger(true);
    run.steps(13).expect("it is stable");
    for change in [
        Change::Dt(0.0071),
        Change::Substeps(3),
        Change::Gravity(Vec3::new(0.1, -3.0, 0.2)),
        Change::Mass(5..9, 0.8),
        Change::Pin(30..31, true),
        Change::Stiffness(0..100, 500.0),
        Change::Damping(10..90, 2.5),
        Change::RestScale(40..50, 0.9),
        Change::Cut(200..210, true),
        Change::Force(77, Vec3::new(0.0, 2.0, 1.0)),
        Change::Grab(Grab { point: 200, target: Vec3::new(1.0, 12.0, 3.0), stiffness: 30.0, damping: 1.0 }),
        Change::Carry(399, Some(Vec3::new(0.0, 0.3, -0.1))),
        Change::Planes(vec![sprung::Plane::level(-30.0, 100.0, 1.0)]),
    ] {
        run.change(change).expect("it is allowed");
    }
    run.steps(9).expect("it is stable");
    let mut resumed = again(&run, run.clone().checkpoint());
    for steps in [1, 40] {
        run.steps(steps).expect("it is stable");
        resumed.steps(steps).expect("it is stable");
        assert_same(&mut run, &mut resumed, "with everything changed");
    }
    // A dt that changes later starts the same clock.
    for run in [&mut run, &mut resumed] {
        run.change(Change::Dt(0.005)).expect("it is allowed");
        run.steps(21).expect("it is stable");
    }
    assert_same(&mut run, &mut resumed, "with another dt");
}

#[test]
fn it_goes_on_with_any_number_of_threads() {
    // Large enough for the engine to call on three workers.
    let mut scene = Scene::builtin("cloth").expect("it is built in");
    scene.set("body.cloth.grid.points", "[240, 240]").expect("it is allowed");
    let mut run = scene.simulation().expect("it can be built");
    assert!(run.model().spring_count() > 3 * 65_536);
    run.steps(10).expect("it is stable");
    let checkpoint = run.checkpoint();
    let mut resumed = again(&run, checkpoint);
    resumed.set_workers(Arc::new(Three));
    run.steps(30).expect("it is stable");
    resumed.steps(30).expect("it is stable");
    assert_same(&mut run, &mut resumed, "three threads");
}

#[test]
fn a_blow_up_is_noticed_at_the_same_step() {
    let mut scene = Scene::builtin("jelly").expect("it is built in");
    for dt in ["0.0121", "0.013"] {
        scene.set("dt", dt).expect("it is allowed");
        let mut run = scene.simulation().expect("it can be built");
        let expected = run.steps(5000).expect_err("it blows up");
        let expected = expected.blow_up().expect("that is why");
        // Taken up every 7 steps: in the middle of its being suspect too.
        let mut resumed = scene.simulation().expect("it can be built");
        let found = loop {
            if let Err(error) = resumed.steps(7) {
                break error;
            }
            resumed = again(&run, resumed.checkpoint());
        };
        let found = found.blow_up().expect("that is why");
        assert_eq!((found.step, found.time, found.cause), (expected.step, expected.time, expected.cause));
        assert!(found.good_step >= expected.good_step);
    }
}

#[test]
fn a_fingerprint_tells_models_apart() {
    let of = |name| simulation(name).model().fingerprint();
    assert_eq!(of("jelly"), of("jelly"));
    let mut all: Vec<u64> = BUILTIN
        .iter()
        .filter(|builtin| builtin.kind != Kind::Benchmark)
        .map(|builtin| of(builtin.name))
        .collect();
    let count = all.len();
    all.sort();
    all.dedup();
    assert!(
        all.len() + 2 > count,
        "the report's scenes may be in the gallery once more, but no more than that"
    );
}

#[test]
fn what_is_not_allowed_is_refused() {
    let mut run = simulation("chain");
    run.steps(5).expect("it is stable");
    let good = run.checkpoint();
    let code = |checkpoint: Checkpoint| {
        Simulation::resume_from(run.model().clone(), checkpoint).map(drop).map_err(|error| error.code())
    };
    assert_eq!(code(good.clone()), Ok(()));
    let mut far = good.clone();
    far.state.position[3].x = 3e38;
    assert_eq!(code(far), Ok(()), "a long fall is no reason to lose a run");
    let mut changed = good.clone();
    changed.state.velocity[3].y = f32::NAN;
    assert_eq!(code(changed), Err(Code::OutOfRange));
    let mut changed = good.clone();
    changed.state.position_low[0].z = f32::INFINITY;
    assert_eq!(code(changed), Err(Code::OutOfRange));
    let mut changed = good.clone();
    changed.state.position.pop();
    assert_eq!(code(changed), Err(Code::Conflict));
    let mut changed = good.clone();
    changed.state.step = u64::MAX;
    assert_eq!(code(changed), Err(Code::OutOfRange));
    let mut changed = good.clone();
    changed.state.ledger.work_in = f64::NAN;
    assert_eq!(code(changed), Err(Code::OutOfRange));
    let mut changed = good;
    Arc::make_mut(&mut changed.params).spring_stiffness = Arc::new(vec![1.0]);
    assert_eq!(code(changed), Err(Code::Conflict));
}
