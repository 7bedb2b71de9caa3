//! The built-in scenes, the round trip, `set`, and what the schema says.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use glam::Vec3;

use super::*;
use crate::contact::ContactLaw;
use crate::model::{Model, SurfaceKind};
use crate::params::Params;
use crate::state::State;

fn build(name: &str) -> (Model, Params, State) {
    Scene::builtin(name).unwrap().build().unwrap()
}

fn pinned(params: &Params) -> Vec<usize> {
    (0..params.point_pinned.len()).filter(|&point| params.is_fixed(point)).collect()
}

fn material(params: &Params, stiffness: f32, damping: f32) {
    assert!(params.spring_stiffness.iter().all(|&value| value == stiffness));
    assert!(params.spring_damping.iter().all(|&value| value == damping));
}

#[test]
fn rest_lengths_are_kept_once_until_something_is_said_of_them() {
    let build = |extra: &str| {
        let text = format!(
            "[[body]]\nname = \"pair\"\npoints = [[0, 0, 0], [2, 0, 0]]\n\
             [[body.springs]]\npairs = [[0, 1]]\nstiffness = 1\ndamping = 0\n{extra}"
        );
        let (model, params, _) =
            Scene::parse(&text, "test").expect("valid").build().expect("it can be built");
        (model.spring_rest_length, params.spring_rest_length)
    };
    let (own, current) = build("");
    assert!(Arc::ptr_eq(&own, &current));
    let (own, current) = build("rest_scale = 0.5");
    assert_eq!((own[0], current[0]), (2.0, 1.0));
}

#[test]
fn scene_1_is_that_of_the_report() {
    let (model, params, state) = build("spring");
    assert_eq!(model.springs(), [[0, 1]]);
    assert_eq!(state.position, [Vec3::ZERO, Vec3::new(0.0, -5.0, 0.0)]);
    assert_eq!(state.velocity, [Vec3::ZERO, Vec3::new(5.0, 0.0, 0.0)]);
    assert_eq!((params.point_mass[1], pinned(&params)), (1.0, vec![0]));
    assert_eq!((params.dt, params.substeps, params.gravity), (0.01, 7, Vec3::new(0.0, -9.81, 0.0)));
    assert!(params.planes.is_empty());
    material(&params, 1.0, 0.2);
}

#[test]
fn scene_2_is_that_of_the_report() {
    let (model, params, state) = build("chain");
    let springs: Vec<[u32; 2]> = (0..14).map(|i| [i, i + 1]).collect();
    assert_eq!(model.springs(), springs);
    let positions: Vec<Vec3> = (0..15).map(|i| Vec3::new(2.0 * i as f32, 25.0, 0.0)).collect();
    assert_eq!(state.position, positions);
    assert!(state.velocity.iter().all(|&v| v == Vec3::ZERO));
    assert!(params.point_mass.iter().all(|&mass| mass == 1.0));
    assert_eq!((pinned(&params), params.dt, params.substeps), (vec![0], 0.01, 7));
    material(&params, 200.0, 3.0);
}

#[test]
fn scene_3_is_that_of_the_report() {
    let (model, params, state) = build("jelly");
    assert_eq!((model.point_count(), model.spring_count()), (1000, 7560));
    let turn = crate::math::rotation(glam::DVec3::ONE, 12.5);
    for (i, j, k) in [(0, 0, 0), (0, 0, 9), (3, 1, 4), (9, 9, 9)] {
        let point = glam::DVec3::new(f64::from(2 * i - 10), f64::from(2 * j), f64::from(2 * k));
        assert_eq!(state.position[(i * 100 + j * 10 + k) as usize], (turn * point).as_vec3());
    }
    assert!(params.point_mass.iter().all(|&mass| mass == 1.0));
    assert_eq!((pinned(&params), params.dt, params.substeps), (vec![], 0.01, 11));
    let [plane] = params.planes[..] else { panic!("one plane") };
    assert_eq!((plane.point, plane.normal), (Vec3::new(0.0, -10.0, 0.0), Vec3::Y));
    assert_eq!((plane.stiffness, plane.damping, plane.law), (50.0, 10.0, ContactLaw::Report));
    assert_eq!(model.surfaces()[0].kind, SurfaceKind::Skin);
    assert_eq!(model.surfaces()[0].triangles.len(), 6 * 81 * 2);
    material(&params, 750.0, 10.0);
}

#[test]
fn scene_4_is_that_of_the_report() {
    let (model, params, state) = build("cloth");
    assert_eq!((model.point_count(), model.spring_count()), (400, 1482));
    for (point, &position) in state.position.iter().enumerate() {
        let (column, row) = ((point / 20) as f32, (point % 20) as f32);
        assert_eq!(position, Vec3::new(2.0 * column - 20.0, 10.0, 2.0 * row));
    }
    assert!(params.point_mass.iter().all(|&mass| mass == 0.5));
    assert_eq!((pinned(&params), params.dt, params.substeps), (vec![0, 19 * 20], 0.01, 7));
    assert_eq!(model.surfaces()[0].kind, SurfaceKind::Cloth);
    assert_eq!(model.surfaces()[0].triangles.len(), 19 * 19 * 2);
    material(&params, 600.0, 3.0);
}

#[test]
fn every_built_in_scene_builds_and_survives_being_written_out() {
    for builtin in BUILTIN {
        let scene = Scene::builtin(builtin.name).unwrap_or_else(|error| panic!("{error}"));
        assert!(!scene.title.is_empty() && !scene.description.is_empty(), "{}", builtin.name);
        let written = scene.to_toml();
        let again = Scene::parse(&written, "written").unwrap_or_else(|error| panic!("{error}\n{written}"));
        assert_eq!(scene, again, "{}", builtin.name);
        let (model, params, state) = scene.build().unwrap_or_else(|error| panic!("{error}"));
        params.validate(&model).unwrap();
        assert_eq!(state.position.len() as u64, scene.point_count());
    }
}

#[test]
fn the_starter_is_a_scene() {
    let scene = Scene::parse(STARTER, "starter.toml").unwrap_or_else(|error| panic!("{error}"));
    let (model, params, _) = scene.build().unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(params.dt, crate::stability::auto_dt(&model, &params).expect("there is one"));
}

#[test]
fn gallery_scenes_keep_clear_of_the_largest_stable_step() {
    for builtin in BUILTIN.iter().filter(|builtin| builtin.kind == Kind::Gallery) {
        let (model, params, _) = build(builtin.name);
        let auto = crate::stability::auto_dt(&model, &params).expect("there is one");
        assert!(params.dt < 0.85 * auto, "{}: dt = {}, \"auto\" would be {auto}", builtin.name, params.dt);
    }
}

#[test]
fn benchmarks_have_the_springs_they_say() {
    for (name, springs) in [("cloth512", 1_045_506), ("jelly64", 2_298_240)] {
        let scene = Scene::builtin(name).unwrap();
        assert_eq!(scene.point_count(), 262_144);
        assert_eq!(scene.bodies[0].most_springs(&scene.bodies[0].springs[0], u64::MAX), springs);
    }
}

#[test]
fn an_unknown_built_in_scene_gets_a_suggestion() {
    let error = Scene::builtin("jely").unwrap_err();
    assert_eq!((error.code(), error.fix()), (Code::NotFound, Some("did you mean \"jelly\"?")));
    assert!(
        error
            .sentence()
            .starts_with("there is no built-in scene \"jely\"; there are spring, chain, jelly, cloth, ")
    );
}

#[test]
fn values_are_set_one_by_one_or_all_at_once() {
    let mut scene = Scene::builtin("bridge").unwrap();
    for (key, value) in [
        ("dt", "auto"),
        ("gravity", "[0, -1.62, 0]"),
        ("title", "Bridge on the moon"),
        ("stiffness", "1234"),
        ("body.deck.springs.1.damping", "7"),
        ("body.near rail.rest_scale", "1.5"),
        ("joint.0.stiffness", "5"),
        ("body.deck.pins", "[\"left\"]"),
        ("body.deck.rotation.axis", "[0, 1, 0]"),
    ] {
        if key == "body.deck.rotation.axis" {
            assert_eq!(scene.set(key, value).unwrap_err().code(), Code::MissingField); // degrees, too
        } else if key == "title" {
            assert!(scene.set(key, value).is_err()); // several words need quotes
            scene.set(key, &format!("\"{value}\"")).unwrap();
        } else {
            scene.set(key, value).unwrap_or_else(|error| panic!("{error}"));
        }
    }
    assert_eq!((scene.dt, scene.gravity[1], scene.title.as_str()), (Dt::Auto, -1.62, "Bridge on the moon"));
    assert!(scene.bodies.iter().flat_map(|body| &body.springs).all(|springs| springs.stiffness == 1234.0));
    assert_eq!((scene.joints[0].stiffness, scene.joints[1].stiffness), (5.0, 1234.0));
    let deck = &scene.bodies[2];
    assert_eq!((deck.springs[0].damping, deck.springs[1].damping), (12.0, 7.0));
    assert_eq!(deck.pins, [Pin::Side("left".to_owned())]);
    assert_eq!(scene.bodies[3].springs[0].rest_scale, 1.5);
    assert_eq!(scene.bodies[4].springs[0].rest_scale, 1.01);
}

#[test]
fn everything_a_body_can_say_is_done() {
    let text = r#"
        gravity = [0, 0, 0]
        [[plane]]
        point = [0, -5, 0]
        normal = [0, 3, 4]
        stiffness = 1
        [[body]]
        name = "box"
        lattice = { points = [2, 2, 2], spacing = 1, origin = [1, 0, 0] }
        scale = 2
        rotation = { axis = [0, 0, 1], degrees = 90 }
        position = [0, 0, 10]
        body_mass = 4
        pins = [{ box = { min = [-9, -9, 11.5], max = [9, 9, 12.5] } }]
        [[body.springs]]
        kinds = ["structural"]
        stiffness = 1
        rest_scale = 0.5
        [[body]]
        name = "pair"
        points = [[0, 0, 0], [3, 0, 0]]
        point_mass = [0, 2]
        velocity = [[1, 1, 1], [1, 2, 3]]
        [[body.springs]]
        pairs = [[1, 0]]
        rest_length = 1
        rest_scale = 3
        stiffness = 1
        [[joint]]
        between = ["pair", "box"]
        pairs = [[1, 7]]
        stiffness = 9
        damping = 1
    "#;
    let (model, params, state) = Scene::parse(text, "text").unwrap().build().unwrap();
    // (1,0,0)·2 turned by 90° about z is (0,2,0); the rotation is rounded to float32 once.
    assert!(state.position[0].distance(Vec3::new(0.0, 2.0, 10.0)) < 1e-6);
    assert!(state.position[7].distance(Vec3::new(-2.0, 4.0, 12.0)) < 1e-6);
    assert!(params.point_mass[..8].iter().all(|&mass| mass == 0.5));
    assert_eq!(pinned(&params), [1, 3, 5, 7, 8]);
    assert_eq!((state.velocity[8], state.velocity[9]), (Vec3::ZERO, Vec3::new(1.0, 2.0, 3.0)));
    assert_eq!(model.springs()[12..], [[8, 9], [7, 9]]);
    assert!((model.spring_rest_length()[0], params.spring_rest_length[0]) == (2.0, 1.0));
    assert_eq!((model.spring_rest_length()[12], params.spring_rest_length[12]), (1.0, 3.0));
    assert_eq!(model.joints()[0].name, "pair - box");
    assert_eq!(params.spring_stiffness[13], 9.0);
    assert!((params.planes[0].normal - Vec3::new(0.0, 0.6, 0.8)).length() < 1e-7);
}

#[test]
fn the_schema_describes_every_key() {
    let schema: serde_json::Value = serde_json::from_str(&json_schema()).unwrap();
    let tables = schema["$defs"].as_object().unwrap().values().chain([&schema]);
    let mut keys = 0;
    for (key, property) in tables.filter_map(|table| table["properties"].as_object()).flatten() {
        assert!(property["description"].is_string(), "{key}");
        keys += 1;
    }
    assert!(keys > 50);
    // The page on the format names every key, too.
    let page = include_str!("../../../../docs/scene-format.md");
    for table in schema["$defs"].as_object().unwrap().values().chain([&schema]) {
        for key in table["properties"].as_object().into_iter().flatten().map(|(key, _)| key) {
            assert!(page.contains(&format!("`{key}`")) || page.contains(&format!("`[[{key}]]`")), "{key}");
        }
    }
}
