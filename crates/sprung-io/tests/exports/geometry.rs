//! What is exported of a frame: which bodies, in which order, axes and unit.

use std::sync::Arc;

use sprung::{Code, Material, ModelBuilder, Snapshot, SurfaceKind, Vec3};
use sprung_io::{Frame, Geometry, Options, RunInfo, Springs, Up};

use crate::common::snapshot;

/// A square of two triangles, a lone point and another square, with a spring from each body to the next.
pub fn three_bodies() -> RunInfo {
    let mut builder = ModelBuilder::new();
    for (name, points) in [("left", 4), ("stone", 1), ("right", 4)] {
        builder.begin_body(name).expect("a name of its own");
        let first = builder.point_count() as u32;
        for point in 0..points {
            let (x, y) = ((point % 2) as f32, (point / 2) as f32);
            builder.add_point(Vec3::new(x, y, first as f32), 1.0).expect("an ordinary point");
        }
        if points == 4 {
            let corners = [[0, 1, 2], [2, 1, 3]].map(|triangle| triangle.map(|corner| first + corner));
            builder.add_surface(SurfaceKind::Cloth, corners.to_vec()).expect("an ordinary surface");
        }
    }
    builder.begin_joint("chain");
    for ends in [[0, 3], [3, 4], [4, 5], [5, 8]] {
        builder.add_spring(ends[0], ends[1], Material { stiffness: 10.0, damping: 0.0 }).expect("ordinary");
    }
    let (model, params, _) = builder.build().expect("an ordinary model");
    let (model, frames) = (Arc::new(model), 3);
    RunInfo { scene: "three".into(), title: "Three bodies".into(), model, params, frame_time: 0.04, frames }
}

fn taken(run: &RunInfo, options: &Options, springs: Springs, snapshot: &Snapshot) -> Geometry {
    let mut geometry = Geometry::new(run, options, springs).expect("the options are allowed");
    geometry.take(&Frame { index: 0, snapshot, params: &run.params, energy: None });
    geometry
}

#[test]
fn vertices_are_the_points_in_their_order() {
    let (run, snapshot) = (three_bodies(), snapshot(9, 2));
    let geometry = taken(&run, &Options::default(), Springs::Lines, &snapshot);
    assert_eq!(geometry.positions(), snapshot.positions);
    assert_eq!(geometry.velocities(), snapshot.velocities);
    assert_eq!(geometry.vertex_count(), 9);
    let parts: Vec<_> =
        geometry.parts().iter().map(|part| (part.name.as_str(), part.vertices.clone())).collect();
    assert_eq!(parts, [("left", 0..4), ("stone", 4..5), ("right", 5..9)]);
    assert_eq!(geometry.parts()[2].triangles, [[0, 1, 2], [2, 1, 3]]);
    let triangles: Vec<[u32; 3]> = geometry.triangles().collect();
    assert_eq!(triangles, [[0, 1, 2], [2, 1, 3], [5, 6, 7], [7, 6, 8]]);
    let ends: Vec<[u32; 2]> = geometry.lines().iter().map(|line| line.ends).collect();
    assert_eq!(ends, run.model.springs());
}

#[test]
fn chosen_bodies_keep_the_models_order_and_the_springs_among_them() {
    let (run, snapshot) = (three_bodies(), snapshot(9, 2));
    let bodies = Some(vec!["right".to_owned(), "stone".to_owned(), "right".to_owned()]);
    let options = Options { bodies, points: true, ..Options::default() };
    let geometry = taken(&run, &options, Springs::Lines, &snapshot);
    assert_eq!(geometry.positions(), &snapshot.positions[4..]);
    assert_eq!(geometry.triangle_count(), 0, "points alone");
    let lines: Vec<_> = geometry.lines().iter().map(|line| (line.spring, line.ends)).collect();
    assert_eq!(lines, [(2, [0, 1]), (3, [1, 4])]);

    let unknown = Options { bodies: Some(vec!["middle".to_owned()]), ..Options::default() };
    let error = Geometry::new(&run, &unknown, Springs::None).expect_err("there is none");
    assert_eq!(error.code(), Code::NotFound);
    assert_eq!(error.to_string(), "--body: there is no body \"middle\"; there are left, stone, right");
}

#[test]
fn axes_turn_and_units_scale_positions_and_velocities() {
    let (run, snapshot) = (three_bodies(), snapshot(9, 2));
    let options = Options { up: Up::Z, scale: 100.0, ..Options::default() };
    let geometry = taken(&run, &options, Springs::None, &snapshot);
    let expected = |v: &Vec3| Vec3::new(v.x * 100.0, -v.z * 100.0, v.y * 100.0);
    assert!(geometry.positions().iter().eq(&snapshot.positions.iter().map(expected).collect::<Vec<_>>()));
    assert!(geometry.velocities().iter().eq(&snapshot.velocities.iter().map(expected).collect::<Vec<_>>()));
    assert_eq!(geometry.turned(Vec3::Y), Vec3::Z, "up is up");
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e7] {
        let options = Options { scale, ..Options::default() };
        let error = Geometry::new(&run, &options, Springs::None).expect_err("not a scale");
        assert_eq!(error.code(), Code::OutOfRange);
    }
}

#[test]
fn tubes_are_closed_and_turned_outwards() {
    let run = three_bodies();
    let positions: Vec<Vec3> = (0..9).map(|i| Vec3::new(0.3 * i as f32, (i % 4) as f32, 1.0)).collect();
    let snapshot = Snapshot { step: 0, time: 0.0, velocities: positions.clone(), positions };
    let geometry = taken(&run, &Options::default(), Springs::Tubes, &snapshot);
    assert_eq!(geometry.points().filter(Option::is_none).count(), 4 * 12);
    let tubes = geometry.parts().last().expect("the springs are the last part");
    assert_eq!((tubes.name.as_str(), tubes.body), ("springs", None));
    assert_eq!(geometry.positions()[..9], snapshot.positions, "they come after the bodies");

    // Each edge is passed once in each direction, and the volume inside, by the divergence theorem, is that of the
    // hexagonal prisms: 3√3/2·r²·ℓ each. Twelve corners rounded to 2⁻²⁴ of 3 m move it by less than 10⁻⁵ m²·r.
    let mut edges = std::collections::BTreeMap::new();
    let mut volume = 0.0;
    for triangle in &tubes.triangles {
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            *edges.entry((triangle[a], triangle[b])).or_insert(0) += 1;
        }
        let [a, b, c] =
            triangle.map(|corner| geometry.positions()[tubes.vertices.start + corner as usize].as_dvec3());
        volume += a.dot(b.cross(c)) / 6.0;
    }
    assert!(edges.iter().all(|(&(a, b), &times)| times == 1 && edges.get(&(b, a)) == Some(&1)));
    let radius = f64::from(sprung_io::export::geometry::tube_radius(&run.model));
    let length: f64 = run
        .model
        .springs()
        .iter()
        .map(|ends| {
            let [a, b] = ends.map(|end| snapshot.positions[end as usize].as_dvec3());
            a.distance(b)
        })
        .sum();
    let expected = 1.5 * 3f64.sqrt() * radius * radius * length;
    assert!((volume - expected).abs() < 1e-5 * radius * 4.0, "{volume} m³, and not {expected}");
}

#[test]
fn of_a_skin_only_its_own_points_leave() {
    let simulation =
        sprung::scene::Scene::builtin("jelly").and_then(|scene| scene.simulation()).expect("built in");
    let (model, params) = (Arc::clone(simulation.model()), simulation.params().clone());
    let run =
        RunInfo { scene: "jelly".into(), title: "Jelly".into(), model, params, frame_time: 0.1, frames: 1 };
    let snapshot = snapshot(1000, 0);
    let geometry = taken(&run, &Options::default(), Springs::None, &snapshot);
    // Of 10³ points the 8³ inside are left out, and the others keep their order.
    let points: Vec<usize> = geometry.points().flatten().collect();
    assert_eq!((points.len(), geometry.vertex_count()), (1000 - 512, 488));
    assert!(points.is_sorted() && geometry.parts()[0].is_closed);
    assert!(geometry.positions().iter().eq(points.iter().map(|&point| &snapshot.positions[point])));
    let triangles = &run.model.surfaces()[0].triangles;
    for (found, triangle) in geometry.triangles().zip(triangles) {
        assert_eq!(found.map(|corner| points[corner as usize] as u32), *triangle);
    }
    for (options, springs) in [
        (Options { points: true, ..Options::default() }, Springs::None),
        (Options::default(), Springs::Lines),
    ] {
        assert_eq!(taken(&run, &options, springs, &snapshot).positions(), snapshot.positions);
    }
}

#[test]
fn normals_are_the_mean_over_triangles() {
    let mut positions = vec![Vec3::ZERO; 9];
    for (point, [x, y]) in [[0.0, 0.0], [2.0, 0.0], [0.0, 1.0], [2.0, 1.0]].into_iter().enumerate() {
        positions[point] = Vec3::new(x, y, 0.0);
    }
    let run = three_bodies();
    let snapshot = Snapshot { step: 0, time: 0.0, velocities: positions.clone(), positions };
    let geometry = taken(&run, &Options { up: Up::Z, ..Options::default() }, Springs::None, &snapshot);
    let mut normals = Vec::new();
    geometry.normals(&mut normals);
    assert_eq!(normals[..4], [Vec3::NEG_Y; 4], "+z of the scene is −y where z is up");
    assert_eq!(normals[4..], [Vec3::ZERO; 5], "no triangle, or one without area");
}
