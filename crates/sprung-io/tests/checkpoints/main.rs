//! Checkpoint files: every version for ever, whatever is cut or changed is noticed and named, and hostile ones get a sentence.

mod damage;
mod golden;
mod keeping;

use std::path::Path;
use std::sync::Arc;

use sprung::build::Mesh;
use sprung::build::mesh::{Faces, MeshGroup};
use sprung::energy::LedgerSums;
use sprung::scene::Scene;
use sprung::{Change, DVec3, Grab, Plane, Result, Simulation, Vec3};
use sprung_io::checkpoint::{Plan, Recording, Saved};
use sprung_io::import::load_meshes;
use sprung_io::{FileMark, Mark, Options};

/// Three points and two springs.
const ROW: &str = "title = \"Three in a row\"\ndt = 0.01\nsubsteps = 2\n\n[[body]]\nname = \"row\"\n\
                   points = [[0, 0, 0], [1, 0, 0], [2, 0.5, 0]]\npoint_mass = 0.5\npins = [0]\n\n[[body.springs]]\n\
                   pairs = [[0, 1], [1, 2]]\nstiffness = 50.0\ndamping = 0.5\n";

/// They, of which everything that a checkpoint can hold has been changed, meshes apart.
fn small() -> Saved {
    on_its_way("row", &Scene::parse(ROW, "row.toml").expect("a scene"))
}

/// A scene that begins with the row, under way and changed, in the midst of a recording.
fn on_its_way(name: &str, scene: &Scene) -> Saved {
    let mut simulation = scene.simulation().expect("it can be built");
    simulation.keep_ledger(true);
    simulation.steps(3).expect("it is stable");
    for change in [
        Change::Gravity(Vec3::new(0.5, -3.0, 0.25)),
        Change::Planes(vec![
            Plane::level(-2.0, 100.0, 1.0),
            Plane {
                point: Vec3::new(-3.0, 0.0, 0.0),
                normal: Vec3::X,
                law: sprung::ContactLaw::Report,
                ..Plane::level(0.0, 50.0, 0.5)
            },
        ]),
        Change::Force(2, Vec3::new(0.0, 0.125, 0.0)),
        Change::Grab(Grab { point: 1, target: Vec3::ONE, stiffness: 4.0, damping: 0.25 }),
        Change::Carry(2, Some(Vec3::new(0.5, 0.0, 0.0))),
        Change::Cut(1..2, true),
        Change::RestScale(0..1, 0.75),
        Change::Dt(0.0078125),
    ] {
        simulation.change(change).expect("it is allowed");
    }
    simulation.steps(4).expect("it is stable");
    let mut saved = Saved::new(name, scene, &mut simulation);
    // Not of the day on which the test runs.
    saved.program = "0.1.0".to_owned();
    // Nor of how the ledger is summed up, which may become faster: its last digits are no part of the promise.
    saved.checkpoint.state.ledger = LedgerSums {
        start: 2.4525001049041815,
        work_in: -1.1250075422277042,
        lost_in_dampers: 0.0023200850251552394,
        lost_in_contact: 0.0,
        integrator_error: -0.04683206211586318,
        suspect_steps: 0,
    };
    saved.recording = Some(Recording {
        plan: Plan {
            title: "Three in a row".into(),
            outputs: vec!["out/row.csv".into(), "row.npz".into()],
            plot: Some("row.svg".into()),
            folder: "/somewhere".into(),
            options: Options { size: Some([320, 180]), at: Some(0.1), resumable: true, ..Options::default() },
            steps_per_frame: 2,
            last_frame: 100,
            recorded: 4,
            from: 1,
            every: "10s".into(),
            begun: 1_700_000_000,
            ended: None,
        },
        marks: vec![
            Mark {
                frames: 4,
                files: vec![FileMark { part: String::new(), bytes: 345, head: 0, crc32: 0xdead_beef }],
                memory: Vec::new(),
            },
            Mark {
                frames: 4,
                files: vec![
                    FileMark { part: String::new(), bytes: 900, head: 700, crc32: 1 },
                    FileMark { part: "velocities".into(), bytes: 144, head: 0, crc32: 2 },
                ],
                memory: vec![1, 2, 3],
            },
            Mark::default(),
        ],
    });
    saved
}

/// The same with a triangle of net made from a mesh, whose file nobody will find.
fn netted() -> Saved {
    let text = format!(
        "{ROW}\n[[body]]\nname = \"net\"\nmesh = \"gone/net.ply\"\nbody_mass = 0.25\npins = [{{ group = \"rail\" }}]\n\
         net = {{ stiffness = 10.0 }}\n"
    );
    let mut scene = Scene::parse(&text, "netted.toml").expect("a scene");
    let mut faces = Faces::default();
    faces.push(&[0, 1, 2]);
    let mesh = Mesh {
        positions: vec![DVec3::new(0.0, 3.0, 0.1), DVec3::new(1.0, 3.0, 0.0), DVec3::new(0.5, 2.0, 0.0)],
        faces,
        groups: vec![MeshGroup { name: "rail".into(), vertices: vec![0] }],
        colours: vec![[1.0, 0.5, 0.25]; 3],
        warnings: vec!["has a texture, which was left out".into()],
        ..Mesh::default()
    };
    scene.load_meshes(&mut |_| Ok(mesh.clone())).expect("a mesh");
    on_its_way("netted", &scene)
}

fn bytes_of(saved: &Saved) -> Vec<u8> {
    let mut bytes = Vec::new();
    saved.write_to(&mut bytes).expect("memory takes everything");
    bytes
}

fn read(bytes: &[u8]) -> Result<Saved> {
    Saved::read_from(&mut &bytes[..], bytes.len() as u64)
}

fn resumed(saved: &Saved) -> Result<Simulation> {
    let (model, ..) = saved.scene()?.build()?;
    saved.simulation(model)
}

#[test]
fn what_is_written_is_read_and_goes_on_to_the_same_bits() {
    let saved = small();
    let read = read(&bytes_of(&saved)).expect("it is whole");
    assert_eq!(read, saved);
    assert_eq!(read.checkpoint.state.clock(), saved.checkpoint.state.clock());
    let [mut a, mut b] = [saved, read].map(|saved| resumed(&saved).expect("it goes on"));
    for run in [&mut a, &mut b] {
        run.steps(25).expect("it is stable");
    }
    assert_eq!(a.state(), b.state());
    assert_eq!(a.energy(), b.energy());
    assert!(a.energy().sums.integrator_error != 0.0, "the ledger is kept");
}

#[test]
fn meshes_are_in_it() {
    let saved = netted();
    assert_eq!(saved.meshes[0].0, "gone/net.ply");
    let again = read(&bytes_of(&saved)).expect("it is whole");
    assert_eq!(again, saved);
    let [mut a, mut b] = [&saved, &again].map(|saved| resumed(saved).expect("it goes on"));
    for run in [&mut a, &mut b] {
        run.steps(25).expect("it is stable");
    }
    assert_eq!(a.state(), b.state());
    let without = Saved { meshes: Vec::new(), ..saved };
    let error = resumed(&without).expect_err("there is no mesh");
    assert_eq!(error.to_string(), "the mesh \"gone/net.ply\" is not there");
}

/// The examples' scenes, saved on their way and gone on with where no mesh file is.
#[test]
fn examples_with_meshes_go_on_without_their_files() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    for name in ["towel", "pebble", "hammock"] {
        let path = folder.join(name).with_extension("toml");
        let text = std::fs::read_to_string(&path).expect("it is there");
        let mut scene = Scene::parse(&text, name).expect("a scene");
        load_meshes(&mut scene, Some(&path)).expect("its mesh is there");
        let mut run = scene.simulation().expect("it can be built");
        run.steps(9).expect("it is stable");
        let saved = Saved::new(name, &scene, &mut run);
        let mut again = resumed(&read(&bytes_of(&saved)).expect("it is whole")).expect("it goes on");
        assert_eq!(again.model().surfaces(), run.model().surfaces());
        run.steps(31).expect("it is stable");
        again.steps(31).expect("it is stable");
        assert_eq!(again.state(), run.state(), "{name}");
    }
}

#[test]
fn every_built_in_scene_can_be_saved() {
    use sprung::scene::{BUILTIN, Kind};
    for builtin in BUILTIN.iter().filter(|builtin| builtin.kind != Kind::Benchmark) {
        let scene = Scene::builtin(builtin.name).expect("it is built in");
        let mut run = scene.simulation().expect("it can be built");
        run.steps(9).expect("it is stable");
        let saved = Saved::new(builtin.name, &scene, &mut run);
        let mut again = resumed(&read(&bytes_of(&saved)).expect("it is whole")).expect("it goes on");
        run.steps(31).expect("it is stable");
        again.steps(31).expect("it is stable");
        assert_eq!(again.state(), run.state(), "{}", builtin.name);
    }
}

#[test]
fn a_scene_that_is_not_the_one_of_the_points_is_refused() {
    let mut saved = small();
    saved.scene = saved.scene.replace("1, 0, 0", "1.5, 0, 0").replace("1.0, 0.0, 0.0", "1.5, 0.0, 0.0");
    let error = resumed(&saved).expect_err("another model");
    assert!(error.to_string().contains("not the one that its points and springs are of"), "{error}");
    let mut saved = small();
    let params = Arc::make_mut(&mut saved.checkpoint.params);
    params.point_mass = Arc::new(vec![1.0; 2]);
    assert!(resumed(&saved).expect_err("too few").to_string().starts_with("point_mass"));
    let mut saved = small();
    saved.scene = "[[body]]\n".into();
    assert!(resumed(&saved).expect_err("no scene").to_string().starts_with("the scene in the checkpoint:"));
}
