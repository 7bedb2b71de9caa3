//! Faces leave as they are in the artist's file: read back they are the same, by our own readers of meshes where those read
//! what moves.

use std::path::Path;

use sprung::Snapshot;
use sprung::build::Mesh;
use sprung::build::mesh::Faces;
use sprung::scene::Scene;
use sprung_io::export::{GLB, OBJ, PLY, USDA, USDC, USDZ, VTK};
use sprung_io::import::{load_meshes, read_mesh_file};
use sprung_io::{Estimate, Frame, Options, RunInfo, Springs};

use crate::common::to_the_end;
use crate::sequences::Vtp;
use crate::usd;

/// A sheet with a quad, triangles, and a face of five corners of which one is bent inwards.
const SHEET: &str = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1.25 0\nv 2 1 0\nv 0 2 0\nv 1 2.5 0\nv 2 2 0\n\
                     f 1 2 5 4\nf 2 3 6\nf 2 6 5\nf 4 5 6 9 8\nf 4 8 7\n";
/// A box of quads and two triangles, all turned inwards.
const BOX: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                   f 1 2 3 4\nf 8 7 6 5\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5\nf 4 5 1\n";

/// A body made from a mesh, one moment of its run, and the faces of the mesh.
fn made(mesh: &str, how: &str) -> (RunInfo, Snapshot, Faces) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.toml");
    std::fs::write(path.with_extension("obj"), mesh).expect("written");
    let text = format!("[[body]]\nname = \"a\"\nmesh = \"a.obj\"\nposition = [0, 1, 0]\n{how}\n");
    let mut scene = Scene::parse(&text, "a.toml").expect("a scene");
    load_meshes(&mut scene, Some(&path)).expect("a mesh");
    let mut simulation = scene.simulation().expect("it can be built");
    simulation.frame().expect("it is stable");
    let run = RunInfo {
        scene: "a".into(),
        title: "Polygons".into(),
        model: simulation.model().clone(),
        params: simulation.params().clone(),
        frame_time: 0.1,
        frames: 1,
    };
    let faces = read_mesh_file(&path.with_extension("obj")).expect("a mesh").faces;
    (run, simulation.snapshot().clone(), faces)
}

/// The faces turned around, each from its first corner on.
fn turned(faces: &Faces) -> Faces {
    let mut all = Faces::default();
    for face in faces.iter() {
        let mut face = face.to_vec();
        face[1..].reverse();
        all.push(&face);
    }
    all
}

/// With springs as lines or without: a line needs no face, and in a file of its own kind it does not get in a face's way.
fn assert_leaves_as(run: &RunInfo, snapshot: &Snapshot, faces: &Faces, springs: Springs) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| folder.path().join(name);
    let options = Options { springs: Some(springs), ..Options::default() };
    for exporter in [OBJ, PLY, VTK, USDC, USDA, USDZ, GLB] {
        let path = at("a").with_extension(exporter.ending);
        let mut export = (exporter.open)(&path, run, &options).expect("begun");
        export.frame(&Frame { index: 0, snapshot, params: &run.params, energy: None }).expect("taken");
        let bytes = export.finish(&mut to_the_end).expect("completed").bytes;
        if let Ok(Estimate::Exact(estimate)) = (exporter.estimate)(run, &options) {
            assert_eq!(estimate, bytes, "{}", exporter.ending);
        }
    }
    let read = |name: &str| -> Mesh { read_mesh_file(Path::new(&at(name))).expect("a mesh") };
    for name in ["a.0000.obj", "a.0000.ply"] {
        assert_eq!(read(name).faces, *faces, "{name}");
    }
    // Where the vertices are is compared elsewhere; here, that faces stand on the right ones.
    let (obj, ply) = (read("a.0000.obj"), read("a.0000.ply"));
    let narrow = |mesh: &Mesh| mesh.positions.iter().map(|p| p.as_vec3()).collect::<Vec<_>>();
    assert_eq!(narrow(&obj), narrow(&ply));
    // glTF knows triangles alone.
    assert_eq!(read("a.glb").faces.triangles(), faces.triangles());

    let corners: Vec<u32> = faces.iter().flatten().copied().collect();
    for name in ["a.usdc", "a.usda", "a.usdz"] {
        let layer = usd::read(&at(name));
        let of = |attribute: &str| usd::integers(&*layer, &format!("/a/a.{attribute}")).into_iter();
        assert!(of("faceVertexCounts").eq(faces.iter().map(|face| face.len() as i32)), "{name}");
        assert!(of("faceVertexIndices").eq(corners.iter().map(|corner| corner.cast_signed())), "{name}");
    }
    let surface = Vtp::read(&at("a/surface.0000.vtp"));
    assert_eq!(surface.words("Polys connectivity"), corners);
    let ends = faces.iter().scan(0, |end, face| {
        *end += face.len() as u32;
        Some(*end)
    });
    assert!(surface.words("Polys offsets").into_iter().eq(ends));
}

#[test]
fn faces_are_those_of_the_file() {
    let net = "net = { stiffness = 100, damping = 1 }\npoint_mass = 0.1";
    let cloth = "cloth = { density = 0.4, stiffness = 100, damping = 0.02 }";
    // Two corners lie on each other and become one point: vertices are carried then.
    let welded = SHEET.replace("f 2 3 6\n", "v 1 0 0\nf 10 3 6\n");
    for (mesh, how) in [(SHEET, net), (SHEET, cloth), (&welded, net), (&welded, cloth)] {
        let (run, snapshot, faces) = made(mesh, how);
        assert_leaves_as(&run, &snapshot, &faces, Springs::None);
        assert_leaves_as(&run, &snapshot, &faces, Springs::Lines);
    }
}

#[test]
fn faces_of_a_soft_body_look_outwards() {
    let soft = "soft = { spacing = 0.5, density = 1000, stiffness = 2e4, damping = 0.01 }";
    let (run, snapshot, faces) = made(BOX, soft);
    assert_leaves_as(&run, &snapshot, &turned(&faces), Springs::None);
}

#[test]
fn a_face_of_very_many_corners_leaves_as_triangles() {
    let around = |count: u32| -> Faces {
        let mut faces = Faces::default();
        faces.push(&(0..count).collect::<Vec<_>>());
        faces.push(&[0, 1, count]);
        faces
    };
    assert_eq!(around(255).fans(), [253, 1]);
    assert_eq!(around(256).fans(), [1; 255]);
    assert!(around(3).fans().is_empty());
    assert_eq!(around(256).fans().len(), around(256).triangles().len());
}
