//! A soft body leaves as the artist's mesh: its vertices in its order, each carried along by points with weights.

use std::path::Path;
use std::sync::Arc;

use sprung::scene::Scene;
use sprung::{DVec3, Model, Simulation, Snapshot, Vec3, WeightedVertex};
use sprung_io::export::{GLB, MDD, OBJ, PC2, PLY, USDA, USDC, USDZ, VTK};
use sprung_io::import::load_meshes;
use sprung_io::{Estimate, Exporter, Frame, Geometry, Options, RunInfo, Springs, Up};

use crate::common::to_the_end;
use crate::sequences::{Obj, Ply, Vtp};
use crate::{caches, glb, usd};

/// The example of a soft body: its run, and the mesh's vertices where the scene puts them.
fn pebble() -> (RunInfo, Simulation, Vec<DVec3>) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/pebble.toml");
    let text = std::fs::read_to_string(&path).expect("it is there");
    let mut scene = Scene::parse(&text, "pebble.toml").expect("a scene");
    load_meshes(&mut scene, Some(&path)).expect("its mesh is there");
    let simulation = scene.simulation().expect("it can be built");
    let (model, params) = (Arc::clone(simulation.model()), simulation.params().clone());
    let run = RunInfo {
        scene: "pebble".into(),
        title: "A pebble".into(),
        model,
        params,
        frame_time: 0.1,
        frames: 3,
    };
    // The file again, by a reader of three lines: millimetres, 0.4 m above the ground.
    let mesh = std::fs::read_to_string(path.with_extension("obj")).expect("it is there");
    let vertices = mesh.lines().filter_map(|line| line.strip_prefix("v ")).map(|line| {
        let place: Vec<f64> = line.split(' ').map(|word| word.parse().expect("a number")).collect();
        DVec3::new(place[0], place[1], place[2]) * 0.001 + DVec3::new(0.0, 0.4, 0.0)
    });
    (run, simulation, vertices.collect())
}

/// Frames on the way: it falls, meets the ground and is pressed.
fn frames(simulation: &mut Simulation, count: usize) -> Vec<Snapshot> {
    let one = |_| {
        let snapshot = simulation.snapshot().clone();
        while simulation.state().time < snapshot.time + 0.15 {
            simulation.frame().expect("it is stable");
        }
        snapshot
    };
    (0..count).map(one).collect()
}

/// The weights applied by hand, in float64, and by how much float32 may be off: a few roundings of the largest number there
/// is, times the largest sum of weights without their signs. (The weights themselves are rounded, and add up to 1 as nearly.)
fn by_hand(model: &Model, values: &[Vec3]) -> (Vec<DVec3>, f64) {
    let vertices = model.surfaces()[0].weighted();
    let term =
        |v: &WeightedVertex, k: usize| f64::from(v.weights[k]) * values[v.points[k] as usize].as_dvec3();
    let sums = vertices.iter().map(|v| (0..4).map(|k| term(v, k)).sum()).collect();
    let largest = values.iter().map(|v| f64::from(v.abs().max_element())).fold(0.0, f64::max);
    let weight = |v: &WeightedVertex| v.weights.iter().map(|w| f64::from(w.abs())).sum::<f64>();
    let heaviest = vertices.iter().map(weight).fold(1.0, f64::max);
    (sums, 16.0 * 2f64.powi(-24) * largest * heaviest)
}

fn assert_close(found: &[Vec3], expected: &[DVec3], allowed: f64) {
    assert_eq!(found.len(), expected.len());
    for (vertex, (found, expected)) in found.iter().zip(expected).enumerate() {
        let off = (found.as_dvec3() - *expected).abs().max_element();
        assert!(off <= allowed, "vertex {vertex} is off by {off} m, and may be by {allowed}");
    }
}

fn taken(run: &RunInfo, options: &Options, springs: Springs, snapshot: &Snapshot) -> Geometry {
    let mut geometry = Geometry::new(run, options, springs).expect("the options are allowed");
    geometry.take(&Frame { index: 0, snapshot, params: &run.params, energy: None });
    geometry
}

#[test]
fn vertices_are_the_meshs_own_in_its_order() {
    let (run, mut simulation, mesh) = pebble();
    let frames = frames(&mut simulation, 3);
    assert!(frames[2].positions.iter().any(|p| p.y < 0.0), "it has met the ground");
    for (frame, snapshot) in frames.iter().enumerate() {
        let geometry = taken(&run, &Options::default(), Springs::None, snapshot);
        let (positions, allowed) = by_hand(&run.model, &snapshot.positions);
        assert_close(geometry.positions(), &positions, allowed);
        if frame == 0 {
            assert_close(geometry.positions(), &mesh, allowed);
        }
        let (velocities, allowed) = by_hand(&run.model, &snapshot.velocities);
        assert_close(geometry.velocities(), &velocities, allowed);
        assert!(geometry.points().all(|point| point.is_none()) && geometry.points().count() == mesh.len());
        assert_eq!(geometry.parts()[0].triangles, run.model.surfaces()[0].triangles);
        assert!(geometry.parts()[0].is_closed && geometry.parts().len() == 1);
        let mut normals = Vec::new();
        geometry.normals(&mut normals);
        // Of a pebble they point outwards.
        let middle = positions.iter().sum::<DVec3>() / positions.len() as f64;
        let outwards = |(normal, place): (&Vec3, &DVec3)| normal.as_dvec3().dot(*place - middle) > 0.0;
        assert!(normals.iter().zip(&positions).all(outwards));
    }
}

#[test]
fn lines_end_at_points_behind_the_mesh() {
    let (run, mut simulation, mesh) = pebble();
    let snapshot = &frames(&mut simulation, 2)[1];
    let plain = taken(&run, &Options::default(), Springs::None, snapshot);
    let geometry = taken(&run, &Options::default(), Springs::Lines, snapshot);
    assert_eq!(&geometry.positions()[..mesh.len()], plain.positions());
    assert_eq!(&geometry.positions()[mesh.len()..], snapshot.positions);
    assert_eq!(&geometry.velocities()[mesh.len()..], snapshot.velocities);
    let points: Vec<usize> = geometry.points().skip(mesh.len()).flatten().collect();
    assert!(points.iter().copied().eq(0..run.model.point_count()));
    let [body, ends] = geometry.parts() else { panic!("a body, and what lines end at") };
    assert!(!body.is_line_ends() && ends.is_line_ends());
    for (line, ends) in geometry.lines().iter().zip(run.model.springs()) {
        assert_eq!(line.ends.map(|end| end - mesh.len() as u32), *ends);
    }
    // Tubes need no such points, and points alone are the simulated ones.
    let tubes = taken(&run, &Options::default(), Springs::Tubes, snapshot);
    assert!(tubes.parts().iter().all(|part| !part.is_line_ends()));
    assert_eq!(&tubes.positions()[..mesh.len()], plain.positions());
    let points = Options { points: true, ..Options::default() };
    for springs in [Springs::None, Springs::Lines] {
        let geometry = taken(&run, &points, springs, snapshot);
        assert_eq!(geometry.positions(), snapshot.positions);
        assert_eq!(geometry.parts().len(), 1);
    }
}

/// The same numbers in every format, with and without lines.
#[test]
fn all_formats_hold_the_mesh() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (run, mut simulation, mesh) = pebble();
    let snapshots = frames(&mut simulation, 3);
    let faces = &run.model.surfaces()[0].triangles;
    for (springs, up) in [(Springs::None, Up::Z), (Springs::Lines, Up::Y)] {
        let options = Options { springs: Some(springs), up, ..Options::default() };
        let frames: Vec<Geometry> =
            snapshots.iter().map(|snapshot| taken(&run, &options, springs, snapshot)).collect();
        let lines: Vec<[u32; 2]> = frames[0].lines().iter().map(|line| line.ends).collect();
        let at = |name: &str| folder.path().join(name);
        let exporters: &[Exporter] = match up {
            Up::Y => &[PC2, MDD, OBJ, PLY, VTK, USDC, USDA, USDZ, GLB],
            Up::Z => &[PC2, MDD, OBJ, PLY, VTK, USDC, USDA, USDZ],
        };
        for exporter in exporters {
            let path = at("a").with_extension(exporter.ending);
            let mut export = (exporter.open)(&path, &run, &options).expect("begun");
            for (snapshot, index) in snapshots.iter().zip(0..) {
                let frame = Frame { index, snapshot, params: &run.params, energy: None };
                export.frame(&frame).expect("taken");
            }
            let bytes = export.finish(&mut to_the_end).expect("completed").bytes;
            if let Ok(Estimate::Exact(estimate)) = (exporter.estimate)(&run, &options) {
                assert_eq!(estimate, bytes, "{}", exporter.ending);
            }
        }

        for cache in ["a.pc2", "a.mdd"].map(|name| caches::read(&at(name))) {
            assert!(cache.frames.iter().map(Vec::as_slice).eq(frames.iter().map(Geometry::positions)));
        }
        let usd = ["a.usdc", "a.usda", "a.usdz"].map(|name| usd::read(&at(name)));
        for (number, geometry) in frames.iter().enumerate() {
            let obj = Obj::read(&at(&format!("a.{number:04}.obj")));
            assert!(obj.vertices == geometry.positions() && obj.faces == *faces && obj.lines == lines);
            assert_eq!(obj.names, ["pebble", "springs"][..if lines.is_empty() { 1 } else { 2 }]);
            let ply = Ply::read(&at(&format!("a.{number:04}.ply")));
            assert!(ply.vectors(["x", "y", "z"]) == geometry.positions() && ply.faces == *faces);
            assert!(ply.vectors(["vx", "vy", "vz"]) == geometry.velocities() && ply.edges == lines);
            let surface = Vtp::read(&at(&format!("a/surface.{number:04}.vtp")));
            assert!(surface.vectors("Points") == geometry.positions()[..mesh.len()]);
            assert!(surface.vectors("velocity") == geometry.velocities()[..mesh.len()]);
            assert!(surface.words("point").iter().all(|&point| point.cast_signed() == -1));
            assert_eq!(surface.words("Polys connectivity"), faces.as_flattened());
            let points = Vtp::read(&at(&format!("a/points.{number:04}.vtp")));
            assert_eq!(points.vectors("Points").len(), run.model.point_count());
            for layer in &usd {
                let of = |attribute: &str| usd::samples(&**layer, &format!("/pebble/{attribute}"));
                let frame = number as f64;
                let (positions, speeds) = (geometry.positions(), geometry.velocities());
                assert_eq!(of("pebble.points")[number], (frame, usd::bits(&positions[..mesh.len()])));
                assert_eq!(of("pebble.velocities")[number], (frame, usd::bits(&speeds[..mesh.len()])));
                if springs == Springs::Lines {
                    let ends: Vec<Vec3> =
                        lines.iter().flatten().map(|&end| positions[end as usize]).collect();
                    assert_eq!(of("springs.points")[number], (frame, usd::bits(&ends)));
                }
            }
        }
    }
    let first = taken(&run, &Options::default(), Springs::Lines, &snapshots[0]);
    let (_, drawn) = glb::read(&folder.path().join("a.glb"));
    let names: Vec<&str> = drawn.iter().map(|drawn| drawn.name.as_str()).collect();
    assert_eq!(names, ["pebble", "springs"]);
    assert_eq!(drawn[0].indices, faces.as_flattened());
    for (number, snapshot) in snapshots.iter().enumerate() {
        let geometry = taken(&run, &Options::default(), Springs::Lines, snapshot);
        for (drawn, count) in drawn.iter().zip([mesh.len(), geometry.vertex_count()]) {
            let (found, expected) = (&drawn.frames[number].0, &geometry.positions()[..count]);
            glb::assert_near(found, &first.positions()[..count], expected);
        }
    }
}
