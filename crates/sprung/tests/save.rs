//! A scene that is given the parameters as they are now: written, read and built, it has them to the bit.

mod common;

use std::collections::BTreeMap;
use std::sync::Arc;

use proptest::prelude::*;
use proptest::sample::Index;
use sprung::scene::{BUILTIN, Dt, Exception, Kind, Numbers, OneOrEach, Pin, Scene};
use sprung::{Change, Code, ContactLaw, Grab, Model, Params, Plane, State, Vec3};

/// Every way to say what a body and its springs are.
const VARIED: &str = r#"
[[plane]]
y = -3
stiffness = 100
[[plane]]
point = [0, -4, 0]
normal = [1, 5, 2]
stiffness = 60
damping = 2
[[body]]
name = "sheet"
grid = { points = [5, 4], spacing = 0.3 }
rotation = { axis = [1, 2, 3], degrees = 33 }
pins = ["left", 19, { box = { min = [0.5, -9, -9], max = [9, 9, 9] } }]
velocity = [1, 2, 3]
body_mass = 3
[[body.springs]]
kinds = ["structural", "shear"]
stiffness = 80
damping = 0.1
rest_scale = 0.9
cut = [3, [7, 9]]
[[body.springs.except]]
springs = [1, [4, 6]]
stiffness = 44
rest_length = 0.25
[[body.springs]]
kinds = ["bend"]
stiffness = 5
[[body]]
name = "few"
points = [[0, 1, 0], [0.5, 1, 0], [0.5, 1, 0], [1, 1.5, 0.1]]
point_mass = [1, 0, 2, 3]
forces = [{ point = 3, force = [0, 1.5, 0] }]
[[body.springs]]
pairs = [[0, 1], [1, 2], [2, 3]]
rest_length = 0.4
stiffness = 30
[[joint]]
between = ["sheet", "few"]
pairs = [[4, 0], [8, 3]]
stiffness = 12
damping = 0.5
"#;

fn scenes() -> Vec<Scene> {
    let small = BUILTIN.iter().filter(|builtin| builtin.kind != Kind::Benchmark);
    let mut scenes: Vec<Scene> =
        small.map(|builtin| Scene::builtin(builtin.name).expect("it is built in")).collect();
    scenes.push(Scene::parse(VARIED, "varied.toml").expect("it is right"));
    scenes
}

/// What a file cannot say: the hands.
fn without_hands(params: &Params) -> Params {
    Params { grabs: Vec::new(), carried: BTreeMap::new(), ..params.clone() }
}

/// Saves, writes, reads and builds again.
fn through_a_file(scene: &Scene, model: &Model, params: &Params) -> (Scene, (Model, Params, State)) {
    let saved = scene.with_params(model, params).unwrap_or_else(|error| panic!("{}: {error}", scene.title));
    let read = Scene::parse(&saved.to_toml(), "saved.toml").unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(read, saved);
    let built = read.build().unwrap_or_else(|error| panic!("{error}"));
    (saved, built)
}

#[test]
fn a_scene_that_has_not_changed_stays_as_it_is_written() {
    for scene in scenes() {
        let (model, params, state) = scene.build().expect("it is right");
        let (saved, built) = through_a_file(&scene, &model, &params);
        assert_eq!(saved, scene);
        assert!(built == (model, params, state), "{}", scene.title);
    }
}

#[test]
fn what_changed_is_written_as_shortly_as_it_can_be() {
    let scene = Scene::builtin("jelly").expect("it is built in");
    let (model, mut params, _) = scene.build().expect("it is right");
    let mut change = |change| params.apply(&model, &change).expect("allowed");
    for value in [
        Change::Stiffness(0..7560, 500.1),
        Change::Damping(0..7560, 0.3),
        Change::Damping(10..12, 7.0),
        Change::RestScale(0..7560, 1.1),
        Change::RestScale(100..200, 0.7),
        Change::Mass(0..1000, 0.1),
        Change::Pin(5..6, true),
        Change::Cut(3..4, true),
        Change::Cut(17..40, true),
        Change::Force(999, Vec3::new(0.0, 0.1, 0.0)),
        Change::Dt(0.005),
        Change::Substeps(4),
        Change::Gravity(Vec3::new(0.0, -1.62, 0.0)),
        Change::Planes(vec![Plane { law: ContactLaw::Report, ..Plane::level(-7.7, 40.0, 9.0) }]),
    ] {
        change(value);
    }
    let (saved, (_, again, _)) = through_a_file(&scene, &model, &params);
    assert_eq!(again, params);
    let (body, springs) = (&saved.bodies[0], &saved.bodies[0].springs[0]);
    assert_eq!((springs.stiffness, springs.damping, springs.rest_scale), (500.1, 0.3, 1.1));
    let expected = [
        Exception { springs: vec![Numbers::Span([10, 11])], damping: Some(7.0), ..Exception::default() },
        Exception { springs: vec![Numbers::Span([100, 199])], rest_scale: Some(0.7), ..Exception::default() },
    ];
    assert_eq!(springs.except, expected);
    assert_eq!(springs.cut, [Numbers::One(3), Numbers::Span([17, 39])]);
    assert_eq!((&body.point_mass, &body.pins[..]), (&Some(OneOrEach::One(0.1)), &[Pin::Index(5)][..]));
    assert_eq!((body.forces[0].point, body.forces[0].force), (999, [0.0, 0.1, 0.0]));
    assert_eq!((saved.dt, saved.substeps, saved.gravity), (Dt::Seconds(0.005), 4, [0.0, -1.62, 0.0]));
    assert_eq!((saved.planes[0].y, saved.planes[0].normal), (Some(-7.7), None));
    assert_eq!(
        (&saved.title, &body.lattice),
        (&scene.title, &scene.bodies[0].lattice),
        "all else is as it was"
    );
}

#[test]
fn auto_stays_auto_while_it_means_the_same_step() {
    let scene = Scene::parse(&VARIED.replace("stiffness = 80", "stiffness = 800000"), "varied.toml");
    let scene = scene.expect("it is right");
    let (model, mut params, _) = scene.build().expect("it is right");
    params.apply(&model, &Change::Gravity(Vec3::X)).expect("allowed");
    assert_eq!(through_a_file(&scene, &model, &params).0.dt, Dt::Auto);
    params.apply(&model, &Change::Mass(0..10, 0.01)).expect("allowed");
    assert_eq!(through_a_file(&scene, &model, &params).0.dt, Dt::Seconds(params.dt));
}

#[test]
fn pins_that_still_hold_stay_as_they_are_written() {
    let scene = Scene::parse(VARIED, "varied.toml").expect("it is right");
    let (model, mut params, state) = scene.build().expect("it is right");
    params.apply(&model, &Change::Pin(1..2, false)).expect("allowed");
    params.apply(&model, &Change::Pin(6..7, true)).expect("allowed");
    let (saved, (_, again, first)) = through_a_file(&scene, &model, &params);
    assert_eq!(again, params);
    // "left" is points 0 to 3 and no longer holds 1; the corner and the box still hold.
    let pins = &saved.bodies[0].pins;
    assert_eq!(pins[..2], scene.bodies[0].pins[1..]);
    assert_eq!(pins[2..], [0, 2, 3, 6].map(Pin::Index));
    // The point that was freed still starts at rest.
    assert_eq!(first.velocity[1], state.velocity[1]);
    assert_eq!(first.velocity[5], Vec3::new(1.0, 2.0, 3.0));
}

#[test]
fn hands_are_not_saved() {
    let scene = Scene::builtin("chain").expect("it is built in");
    let (model, mut params, _) = scene.build().expect("it is right");
    let grab = Grab { point: 3, target: Vec3::X, stiffness: 5.0, damping: 0.0 };
    params.apply(&model, &Change::Grab(grab)).expect("allowed");
    params.apply(&model, &Change::Carry(4, Some(Vec3::X))).expect("allowed");
    assert_eq!(scene.with_params(&model, &params).expect("it can be saved"), scene);
}

#[test]
fn what_cannot_be_saved_is_refused_with_a_sentence() {
    let (chain, cloth) =
        (Scene::builtin("chain").expect("built in"), Scene::builtin("cloth").expect("built in"));
    let (model, params, _) = chain.build().expect("it is right");
    let error = cloth.with_params(&model, &params).expect_err("another scene's");
    assert_eq!((error.code(), error.sentence()), (Code::Conflict, "the model was not built from this scene"));
    let bad = Params { dt: -1.0, ..params };
    assert_eq!(chain.with_params(&model, &bad).expect_err("no such step").code(), Code::OutOfRange);
}

#[test]
fn a_file_that_would_be_too_large_is_refused() {
    // 2,298,240 springs, each unlike its neighbours.
    let scene = Scene::builtin("jelly64").expect("built in");
    let (model, mut params, _) = scene.build().expect("it is right");
    let values = Arc::make_mut(&mut params.spring_stiffness);
    values.iter_mut().enumerate().for_each(|(spring, value)| *value = 1000.0 + spring as f32 / 16.0);
    let error = scene.with_params(&model, &params).expect_err("too large");
    assert_eq!(error.code(), Code::TooLarge, "{error}");
}

/// A random change, from a kind and some numbers.
fn change(model: &Model, what: usize, range: (Index, Index), value: f32, vector: [f32; 3]) -> Change {
    let within = |count: usize| {
        let (a, b) = (range.0.index(count + 1), range.1.index(count + 1));
        a.min(b)..a.max(b)
    };
    let (points, springs) = (within(model.point_count()), within(model.spring_count()));
    let one = range.0.index(model.point_count());
    let vector = Vec3::from_array(vector);
    match what {
        0 => Change::Dt(f64::from(value) * 1e-4),
        1 => Change::Substeps(1 + value as u32),
        2 => Change::Gravity(vector),
        3 => {
            let normal = (vector + Vec3::splat(0.01)).normalize();
            let sloping = Plane { normal, point: vector * 3.0, ..Plane::level(0.0, value, 1.0) };
            Change::Planes(vec![Plane::level(-value, 30.0, 0.1), sloping])
        }
        4 => Change::Mass(points, if value < 5.0 { 0.0 } else { value }),
        5 => Change::Pin(points, value < 50.0),
        6 => Change::Stiffness(springs, value * 9.7),
        7 => Change::Damping(springs, value * 0.013),
        8 => Change::RestScale(springs, value * 0.02),
        9 => Change::Cut(springs, value < 70.0),
        10 => Change::Force(one, vector),
        _ => Change::RestScale(0..model.spring_count(), value * 0.02),
    }
}

proptest! {
    #![proptest_config(common::cases(150))]

    #[test]
    fn any_parameters_come_back_to_the_bit(
        which in any::<Index>(),
        changes in prop::collection::vec(
            (0usize..12, (any::<Index>(), any::<Index>()), 0.0f32..100.0, prop::array::uniform3(-20.0f32..20.0)),
            0..12,
        ),
        lengths in prop::collection::vec((any::<Index>(), 0.0f32..5.0), 0..3),
    ) {
        let scenes = scenes();
        let scene = &scenes[which.index(scenes.len())];
        let (model, mut params, own) = scene.build().expect("it is right");
        for (what, range, value, vector) in changes {
            params.apply(&model, &change(&model, what, range, value, vector)).expect("allowed");
        }
        // Rest lengths that no scale gives.
        for (spring, length) in lengths {
            Arc::make_mut(&mut params.spring_rest_length)[spring.index(model.spring_count())] = length;
        }
        let (saved, (model_again, again, state)) = through_a_file(scene, &model, &params);
        prop_assert_eq!(&again, &without_hands(&params));
        prop_assert_eq!(&model_again, &model);
        prop_assert_eq!(&state.position, &own.position);
        for point in 0..model.point_count() {
            let expected = if params.is_fixed(point) { Vec3::ZERO } else { own.velocity[point] };
            prop_assert_eq!(state.velocity[point], expected);
        }
        // What was saved can be changed back and saved again.
        let (_, original, _) = scene.build().expect("it is right");
        let (_, (_, back, first)) = through_a_file(&saved, &model, &original);
        prop_assert_eq!(&back, &original);
        prop_assert_eq!(&first.position, &own.position);
    }
}
