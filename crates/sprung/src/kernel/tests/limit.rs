//! The certified limit in the layout of the step against the one in float64, and against itself.

use std::sync::Arc;

use glam::Vec3;

use super::networks::{Random, mixed, with_hidden_order};
use super::{Parts, Threads, affordable};
use crate::kernel::laws::Laws;
use crate::kernel::level::Level;
use crate::kernel::limit::{longest_sum, margin};
use crate::kernel::plan::Plan;
use crate::kernel::team::Team;
use crate::params::{Grab, Params};
use crate::scene::BUILTIN;
use crate::stability::{Limit, Setter, certified, limit_of_springs_at};
use crate::workers::Inline;

/// The limit at the state of some parts, and how far it may be below the one in float64, in proportion.
fn found(parts: &Parts) -> (Option<Limit>, f64) {
    let Parts { model, params, .. } = parts;
    let plan = Plan::new(model);
    let longest = longest_sum(&plan, &Laws::new(&plan, model, params));
    let limit = parts.team(Level::best()).certified(model, params, &Inline);
    // What is computed is off by one margin at the most, in either direction, and is then made smaller by one.
    (limit, 2.0 * margin(longest.max(params.planes.len() + 1)))
}

/// Compares the limit with the one in float64, and what sets it.
fn assert_agrees(name: &str, parts: &Parts) {
    let Parts { model, params, state } = parts;
    let exact = certified(model, params, &state.position);
    let (limit, below) = found(parts);
    let (Some(limit), Some(exact)) = (limit, exact) else { panic!("{name}: {limit:?} and {exact:?}") };
    let least = exact.dt * (1.0 - below);
    assert!(
        (least..=exact.dt).contains(&limit.dt),
        "{name}: {limit:?}, and {exact:?} in float64: {:e} below",
        1.0 - limit.dt / exact.dt
    );
    // Of two that are as near as rounding, either may set it.
    let of_setter = match limit.setter {
        Setter::Spring(spring) => limit_of_springs_at(model, params, &state.position, &[spring], None),
        Setter::Point(point) => {
            let springs: Vec<usize> = model.springs_at(point).iter().map(|&spring| spring as usize).collect();
            limit_of_springs_at(model, params, &state.position, &springs, Some(point))
        }
    };
    assert!(of_setter <= exact.dt / (1.0 - below), "{name}: {limit:?} is set elsewhere: {of_setter} s there");
}

#[test]
fn it_is_never_above_the_exact_one_and_hardly_below_in_built_in_scenes() {
    for scene in BUILTIN {
        let mut parts = Parts::built_in(scene);
        assert_agrees(scene.name, &parts);
        let (_, below) = found(&parts);
        assert!(below < 2e-5, "{}: {below}", scene.name);
        let mut team = parts.team(Level::best());
        parts.advance(&mut team, affordable(scene, 3, 300), 1);
        parts.state = parts.state_of(&team);
        assert_agrees(&format!("{} in motion", scene.name), &parts);
    }
}

/// Where a point goes when a network changes its shape.
type Shape = fn(Vec3) -> Vec3;

/// Springs of every kind, stretched, pressed, flat, in one line and all in one place, with everything that holds points.
#[test]
fn it_agrees_in_mixed_networks_whatever_shape_they_have() {
    for seed in 0..4 {
        let parts = mixed(seed, 3_000, false);
        let shapes: [(&str, Shape); 6] = [
            ("as it is", |x| x),
            ("stretched", |x| x * 3.0),
            ("pressed", |x| x * 0.2),
            ("flat", |x| Vec3::new(x.x, 1.5 * x.y, 0.0)),
            ("in a line", |x| Vec3::new(x.x, x.x, -0.5 * x.x)),
            ("in one place", |_| Vec3::new(0.5, -0.25, 3.0)),
        ];
        for (name, shape) in shapes {
            let mut parts = parts.clone();
            parts.state.position.iter_mut().for_each(|x| *x = shape(*x));
            assert_agrees(&format!("network {seed} {name}"), &parts);
        }
    }
}

/// A change of the parameters, and what it is called.
type Variant = (&'static str, fn(&mut Params));

#[test]
fn it_agrees_whatever_springs_and_masses_are_like() {
    fn scale(values: &mut Arc<Vec<f32>>, factor: f32) {
        Arc::make_mut(values).iter_mut().for_each(|value| *value *= factor);
    }
    let variants: [Variant; 10] = [
        ("very stiff", |params| scale(&mut params.spring_stiffness, 1e9)),
        ("very soft", |params| scale(&mut params.spring_stiffness, 1e-4)),
        ("without damping", |params| scale(&mut params.spring_damping, 0.0)),
        ("damped much", |params| scale(&mut params.spring_damping, 1e6)),
        ("light", |params| scale(&mut params.point_mass, 1e-6)),
        ("heavy", |params| scale(&mut params.point_mass, 1e8)),
        ("stiff and light", |params| {
            scale(&mut params.spring_stiffness, 1e4);
            scale(&mut params.point_mass, 1e-5);
        }),
        ("with soft ground", |params| params.planes[0].stiffness = 1e-3),
        ("with hard ground", |params| params.planes[1].stiffness = 1e9),
        ("held fast", |params| {
            for stiffness in [1e7, 1e3] {
                let grab = Grab { point: 700, target: Vec3::ZERO, stiffness, damping: 2.0 };
                params.grabs.push(grab);
            }
            params.planes.clear();
        }),
    ];
    for (name, change) in variants {
        let mut parts = mixed(7, 2_000, false);
        change(&mut parts.params);
        assert_agrees(name, &parts);
    }
}

/// Half of the springs as soft as nothing, in sizes that differ more than float32 can add.
#[test]
fn it_agrees_where_stiffness_has_all_sizes() {
    for seed in 0..4 {
        let mut parts = mixed(seed, 2_000, false);
        let random = &mut Random(seed);
        let params = &mut parts.params;
        Arc::make_mut(&mut params.spring_stiffness).iter_mut().for_each(|k| *k = random.size(-120, 20));
        Arc::make_mut(&mut params.spring_damping).iter_mut().for_each(|d| *d = random.size(-120, 0));
        Arc::make_mut(&mut params.point_mass).iter_mut().for_each(|mass| *mass *= random.size(-10, 30));
        assert_agrees(&format!("network {seed}"), &parts);
    }
}

#[test]
fn it_agrees_where_springs_join_points_anywhere() {
    let parts = mixed(3, 1_500, false);
    let model = with_hidden_order(&parts.model, &mut Random(3));
    assert_agrees("a network in any order", &Parts { model, ..parts });
    let mut parts = mixed(4, 70_000, true);
    assert!(!Plan::new(&parts.model).loose.is_empty());
    assert_agrees("a wide network", &parts);
    // The loose ones set it, and one that is cut does not.
    let loose: Vec<usize> = Plan::new(&parts.model).loose.iter().map(|loose| loose.spring as usize).collect();
    for &spring in &loose {
        Arc::make_mut(&mut parts.params.spring_stiffness)[spring] *= 5_000.0;
    }
    assert_agrees("a wide network with stiff far springs", &parts);
    let (Some(Limit { setter: Setter::Spring(stiffest), .. }), _) = found(&parts) else {
        panic!("no spring")
    };
    assert!(loose.contains(&stiffest));
    Arc::make_mut(&mut parts.params.spring_cut)[stiffest] = true;
    assert_agrees("a wide network with a far spring cut", &parts);
}

#[test]
fn it_is_the_same_to_the_bit_at_every_level_in_any_number_of_regions() {
    for (seed, points) in [(5, 24_000), (6, 36_000)] {
        let parts = mixed(seed, points, false);
        let mut plain = parts.team(Level::Baseline);
        parts.advance(&mut plain, 3, 1);
        let expected = plain.certified(&parts.model, &parts.params, &Threads(1));
        assert!(expected.is_some());
        for level in Level::available() {
            for threads in [1, 2, 3, 7] {
                let mut team = parts.divided_team(level);
                parts.advance(&mut team, 3, threads);
                let found = team.certified(&parts.model, &parts.params, &Threads(threads));
                assert_eq!(found, expected, "{} in {} regions", level.name(), team.region_count());
                // Asking moves nothing, and what was kept for it holds no longer than it should.
                parts.advance(&mut team, 2, threads);
                let mut alone = parts.team(level);
                parts.advance(&mut alone, 5, 1);
                assert_eq!(super::first_difference(&parts.state_of(&alone), &parts.state_of(&team)), None);
                let again = |team: &mut Team| team.certified(&parts.model, &parts.params, &Threads(threads));
                assert_eq!(again(&mut team), again(&mut alone));
            }
        }
    }
}

#[test]
fn of_springs_that_are_alike_the_first_of_the_first_block_sets_it() {
    // In a straight row of springs at rest all are alike, but for the two at the ends.
    let mut builder = crate::build::ModelBuilder::new();
    for x in 0..600u16 {
        builder.add_point(Vec3::X * f32::from(x), 1.0).expect("allowed");
    }
    for x in 0..599 {
        let material = crate::build::Material { stiffness: 4.0, damping: 0.5 };
        builder.add_spring(x, x + 1, material).expect("allowed");
    }
    let parts = Parts::new(builder.build().expect("there are points"));
    let first = parts.team(Level::best()).certified(&parts.model, &parts.params, &Inline);
    let exact = certified(&parts.model, &parts.params, &parts.state.position);
    assert_eq!(first.map(|limit| limit.setter), exact.map(|limit| limit.setter));
    assert_agrees("a row", &parts);
}

#[test]
fn where_float32_does_not_suffice_it_does_not_answer() {
    let refuses = |name: &str, change: &dyn Fn(&mut Parts)| {
        let mut parts = mixed(1, 2_000, false);
        change(&mut parts);
        assert_eq!(found(&parts).0, None, "{name}");
    };
    refuses("no springs", &|parts| {
        Arc::make_mut(&mut parts.params.spring_cut).fill(true);
        parts.params.grabs.clear();
        parts.params.planes.clear();
    });
    refuses("springs next to nothing", &|parts| {
        Arc::make_mut(&mut parts.params.spring_stiffness).iter_mut().for_each(|k| *k *= 1e-20);
        Arc::make_mut(&mut parts.params.spring_damping).fill(0.0);
        parts.params.grabs.clear();
        parts.params.planes.clear();
    });
    refuses("springs beyond everything", &|parts| {
        Arc::make_mut(&mut parts.params.spring_stiffness).fill(1e12);
        Arc::make_mut(&mut parts.params.point_mass).fill(1e-12);
    });
    for nowhere in [f32::INFINITY, f32::NAN] {
        refuses("nowhere", &|parts| {
            let point = somewhere(parts);
            parts.state.position[point] = Vec3::splat(nowhere);
        });
    }
}

#[test]
fn beyond_the_range_of_squares_it_is_safe() {
    let mut parts = mixed(1, 2_000, false);
    let point = somewhere(&parts);
    parts.state.position[point] = Vec3::new(1e25, -1e25, 3.0);
    let exact = certified(&parts.model, &parts.params, &parts.state.position).expect("it has springs");
    assert!(found(&parts).0.expect("it has springs").dt <= exact.dt);
}

/// A point that has springs, and can move: others may be alone.
fn somewhere(parts: &Parts) -> usize {
    let live = |&spring: &usize| parts.params.is_live(&parts.model, spring);
    let spring = (0..parts.model.spring_count()).find(live).expect("some are");
    parts.model.springs[spring][0] as usize
}
