//! The limits on dt that a running simulation is asked for: those of [`stability`], found cheaply.

mod common;

use common::scenes;
use sprung::stability::{self, Limit};
use sprung::{Change, Grab, Plane, Simulation, Vec3};

/// How far the quick limit may be below the exact one, in proportion: points here have fewer than fifty springs.
const BELOW: f64 = 2e-5;

fn exact(run: &Simulation) -> [Option<Limit>; 2] {
    let (model, params, state) = (run.model(), run.params(), run.state());
    [stability::certified(model, params, &state.position), stability::every_configuration(model, params)]
}

fn assert_agrees(run: &mut Simulation, what: &str) {
    let [certified, every] = exact(run);
    assert_eq!(run.limit_of_every_configuration(), every, "{what}");
    let quick = run.certified_limit();
    let (Some(quick), Some(certified)) = (quick, certified) else {
        // Nothing moves while a hand has the only point that can.
        return assert_eq!(quick, certified, "{what}");
    };
    let allowed = certified.dt * (1.0 - BELOW)..=certified.dt;
    assert!(allowed.contains(&quick.dt), "{what}: {quick:?} and {certified:?}");
    assert!(every.is_some_and(|every| every.dt <= quick.dt), "{what}: {quick:?} and {every:?}");
}

/// After whatever may change a limit, and whatever may not.
#[test]
fn they_follow_every_change() {
    for scene in scenes::four() {
        let mut run = scenes::engine(&scene);
        let (points, springs) = (run.model().point_count(), run.model().spring_count());
        assert_agrees(&mut run, scene.name);
        let last = points - 1;
        let grab = Grab { point: last, target: Vec3::ONE, stiffness: 900.0, damping: 1.0 };
        let mut ground = Plane::level(100.0, 4e3, 2.0);
        ground.point.y = 100.0;
        let changes = [
            // So short that all that follows is stable.
            Change::Dt(1e-5),
            Change::Stiffness(0..springs, 44.0),
            Change::Damping(0..springs / 2, 0.25),
            Change::Mass(last..points, 0.02),
            Change::RestScale(0..springs, 0.5),
            Change::Grab(grab),
            Change::Grab(Grab { target: Vec3::ZERO, ..grab }),
            Change::Carry(last, Some(Vec3::X)),
            Change::Carry(last, None),
            Change::Release(last),
            Change::Planes(vec![ground]),
            Change::Gravity(Vec3::X),
        ];
        for change in changes {
            let what = format!("{} after {change:?}", scene.name);
            run.change(change).expect("allowed");
            assert_agrees(&mut run, &what);
            run.steps(3).expect("it is stable");
            assert_agrees(&mut run, &what);
        }
        run.reset();
        assert_agrees(&mut run, "after a reset");
    }
}

#[test]
fn asking_changes_nothing_of_the_motion() {
    for scene in scenes::four() {
        let (mut run, mut asked) = (scenes::engine(&scene), scenes::engine(&scene));
        for _ in 0..20 {
            run.steps(7).expect("it is stable");
            asked.steps(7).expect("it is stable");
            asked.certified_limit();
            assert_eq!(run.state_hash(), asked.state_hash(), "{}", scene.name);
        }
    }
}

/// Where nothing limits dt, or only what float32 cannot tell, the exact ones answer.
#[test]
fn without_springs_there_is_no_limit() {
    let mut run = scenes::engine(&scenes::four()[0]);
    let springs = run.model().spring_count();
    run.change(Change::Stiffness(0..springs, 1e-30)).expect("allowed");
    run.change(Change::Damping(0..springs, 0.0)).expect("allowed");
    assert_eq!(run.certified_limit(), exact(&run)[0]);
    assert!(run.certified_limit().is_some());
    run.change(Change::Cut(0..springs, true)).expect("allowed");
    run.change(Change::Planes(Vec::new())).expect("allowed");
    assert_eq!((run.certified_limit(), run.limit_of_every_configuration()), (None, None));
}
