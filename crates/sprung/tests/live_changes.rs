//! Whatever is changed while a scene runs, the solver is where a new one would be.

mod common;

use common::{Random, assert_same_bits, scenes};
use sprung::{Change, ContactLaw, Grab, Plane, Simulation, Vec3};

/// A change of any kind, of a size that leaves a scene of the report stable.
fn any_change(random: &mut Random, run: &Simulation) -> Change {
    let (points, springs) = (run.model().point_count(), run.model().spring_count());
    let point = random.below(points);
    match random.below(20) {
        0 | 1 => Change::Stiffness(random.range(springs), 300.0 * random.share()),
        2 => Change::Stiffness(0..springs, 200.0),
        3 | 4 => Change::Damping(random.range(springs), 3.0 * random.share()),
        5 | 6 => Change::RestScale(random.range(springs), 0.9 + 0.2 * random.share()),
        7 => Change::Cut(random.range(springs), true),
        8 => Change::Cut(0..springs, false),
        9 => Change::Cut(random.range(springs), false),
        10 => Change::Mass(random.range(points), 1.0 + random.share()),
        11 => Change::Mass(point..point + 1, 0.0),
        12 => Change::Pin(random.range(points), random.below(2) == 0),
        13 => Change::Carry(point, Some(random.vector())),
        14 => Change::Carry(run.params().carried.keys().next().copied().unwrap_or(point), None),
        15 => {
            let target = run.state().position[point] + random.vector();
            Change::Grab(Grab { point, target, stiffness: 90.0 * random.share(), damping: 2.0 })
        }
        16 => Change::Release(run.params().grabs.first().map_or(point, |grab| grab.point)),
        17 => Change::Force(point, random.vector() * 5.0),
        18 => {
            let tilted = common::tilted_plane([ContactLaw::Push, ContactLaw::Report][random.below(2)]);
            let planes = vec![Plane::level(-12.0, 60.0, 4.0), tilted];
            Change::Planes(if random.below(3) == 0 { Vec::new() } else { planes })
        }
        _ => match random.below(4) {
            0 => Change::Gravity(random.vector() * 10.0),
            1 => Change::Dt(0.002 + 0.003 * f64::from(random.share())),
            2 => Change::Place(point, run.state().position[point] + 0.1 * random.vector()),
            _ => {
                let mut params = run.params().clone();
                params.gravity.x += 1.0;
                std::sync::Arc::make_mut(&mut params.point_mass)[point] = 1.5;
                std::sync::Arc::make_mut(&mut params.spring_cut)[random.below(springs)] ^= true;
                params.carried.clear();
                Change::Params(params.into())
            }
        },
    }
}

/// Between two looks one to four changes are made, some asking for state or forces in between and some not.
#[test]
fn after_any_changes_a_run_is_where_a_new_one_would_be() {
    let scenes = [scenes::chain(), scenes::cloth(), scenes::jelly()];
    for (scene, seed) in scenes.iter().flat_map(|scene| (0..4).map(move |seed| (scene, seed))) {
        let random = &mut Random(seed);
        let mut run = scenes::engine(scene);
        run.change(Change::Dt(0.004)).expect("allowed");
        let mut made = Vec::new();
        for _ in 0..60 {
            made.clear();
            for _ in 0..=random.below(4) {
                let change = any_change(random, &run);
                made.push(format!("{change:?}").chars().take(60).collect::<String>());
                run.change(change).expect("allowed");
                if random.below(3) == 0 {
                    run.forces();
                }
            }
            let (params, state) = (run.params().clone(), run.state().clone());
            let mut fresh =
                Simulation::resume(run.model().clone(), params, state).expect("it was valid here");
            let what = format!("{} after {made:?}", scene.name);
            assert_same_bits(run.state(), fresh.state(), &what);
            let bits =
                |forces: &[Vec3]| forces.iter().map(|f| f.to_array().map(f32::to_bits)).collect::<Vec<_>>();
            if random.below(2) == 0 {
                assert!(bits(run.forces()) == bits(fresh.forces()), "{what}: other forces");
            }
            let steps = 1 + random.below(5) as u64;
            run.steps(steps).expect("it is stable");
            fresh.steps(steps).expect("it is stable");
            assert_same_bits(run.state(), fresh.state(), &what);
        }
    }
}

/// A hand takes a point while other changes wait to be packed, and then time goes back to before it came.
#[test]
fn a_hand_is_forgotten_when_time_goes_back() {
    let mut fresh = scenes::engine(&scenes::cloth());
    common::steps(&mut fresh, 80);

    let mut run = scenes::engine(&scenes::cloth());
    run.change(Change::Gravity(Vec3::X)).expect("allowed");
    run.change(Change::Carry(5, Some(Vec3::Y))).expect("allowed");
    run.reset();
    common::steps(&mut run, 80);
    assert_same_bits(run.state(), fresh.state(), "after a reset");

    let mut run = scenes::engine(&scenes::cloth());
    common::steps(&mut run, 80);
    run.rewind_to(10).expect("it is recorded");
    run.change(Change::Carry(5, Some(Vec3::Y))).expect("allowed");
    common::steps(&mut run, 20);
    run.change(Change::Carry(5, None)).expect("allowed");
    common::steps(&mut run, 100);
    let mut again = run.clone();
    for step in [0, 130, 20, 75, 130] {
        again.rewind_to(step).expect("it is recorded");
    }
    assert_same_bits(again.state(), run.state(), "after going to and fro");
}
