//! The built-in scenes, the round trip, `set`, and what the schema says.
#![allow(clippy::unwrap_used)]

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
