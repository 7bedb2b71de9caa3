//! Sequences of files, read back by small readers of their own.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use sprung::scene::Scene;
use sprung::{Code, PointReading, SpringReading, Vec3};
use sprung_io::export::{OBJ, PLY, VTK};
use sprung_io::{Estimate, Exporter, Frame, Options, RunInfo, Springs, Up};

use crate::common::{begin, give, names_in, run_of, to_the_end};

/// An `.obj` file.
#[derive(Default)]
pub struct Obj {
    pub names: Vec<String>,
    pub vertices: Vec<Vec3>,
    pub faces: Vec<[u32; 3]>,
    pub lines: Vec<[u32; 2]>,
}

impl Obj {
    pub fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).expect("text");
        let mut obj = Self::default();
        for line in text.lines() {
            let words: Vec<&str> = line.split(' ').collect();
            let numbers = || words[1..].iter().map(|word| word.parse::<f32>().expect("a number"));
            let indices = || words[1..].iter().map(|word| word.parse::<u32>().expect("an index") - 1);
            match words[0] {
                "v" => obj.vertices.push(Vec3::from_slice(&numbers().collect::<Vec<_>>())),
                "f" => obj.faces.push(indices().collect::<Vec<_>>().try_into().expect("a triangle")),
                "l" => obj.lines.push(indices().collect::<Vec<_>>().try_into().expect("two ends")),
                "o" => {
                    assert_eq!(words.len(), 2, "a name is one word");
                    obj.names.push(words[1].to_owned());
                }
                other => assert!(["#", "s"].contains(&other), "{line}"),
            }
        }
        obj
    }
}

/// A `.ply` file: columns of its vertices, and its indices.
pub struct Ply {
    columns: BTreeMap<String, Vec<f32>>,
    pub faces: Vec<[u32; 3]>,
    pub edges: Vec<[u32; 2]>,
}

impl Ply {
    pub fn read(path: &Path) -> Self {
        let bytes = fs::read(path).expect("the file is there");
        let end = bytes.windows(11).position(|window| window == b"end_header\n").expect("a header") + 11;
        let header = String::from_utf8(bytes[..end].to_vec()).expect("text");
        assert!(header.starts_with("ply\nformat binary_little_endian 1.0\n"));
        let mut rest = &bytes[end..];
        let mut take = |count: usize| {
            let (taken, left) = rest.split_at(count);
            rest = left;
            taken.to_vec()
        };
        let word = |bytes: Vec<u8>| u32::from_le_bytes(bytes.try_into().expect("four bytes"));
        let mut ply = Self { columns: BTreeMap::new(), faces: Vec::new(), edges: Vec::new() };
        let elements: Vec<&str> = header.split("element ").skip(1).collect();
        for element in elements {
            let mut lines = element.lines();
            let (name, count) = lines.next().and_then(|line| line.split_once(' ')).expect("name and count");
            let properties: Vec<&str> = lines.filter_map(|line| line.strip_prefix("property ")).collect();
            for _ in 0..count.parse().expect("a count") {
                match name {
                    "vertex" => {
                        for property in &properties {
                            let (kind, name) = property.split_once(' ').expect("type and name");
                            let value = match kind {
                                "float" => f32::from_bits(word(take(4))),
                                "uchar" => f32::from(take(1)[0]),
                                "int" => word(take(4)) as i32 as f32,
                                other => panic!("{other}"),
                            };
                            ply.columns.entry(name.to_owned()).or_default().push(value);
                        }
                    }
                    "face" => {
                        assert_eq!(take(1), [3]);
                        ply.faces.push([(); 3].map(|()| word(take(4))));
                    }
                    "edge" => ply.edges.push([(); 2].map(|()| word(take(4)))),
                    other => panic!("{other}"),
                }
            }
        }
        assert!(rest.is_empty(), "{} bytes are left", rest.len());
        ply
    }

    pub fn vectors(&self, names: [&str; 3]) -> Vec<Vec3> {
        let [x, y, z] = names.map(|name| &self.columns[name]);
        (0..x.len()).map(|i| Vec3::new(x[i], y[i], z[i])).collect()
    }
}

/// A `.vtp` file: its arrays by name, those of cells with the element's name before theirs.
pub struct Vtp(BTreeMap<String, Vec<u8>>);

impl Vtp {
    pub fn read(path: &Path) -> Self {
        let bytes = fs::read(path).expect("the file is there");
        let marker = b"<AppendedData encoding=\"raw\">\n_";
        let start =
            bytes.windows(marker.len()).position(|window| window == marker).expect("data") + marker.len();
        let header = String::from_utf8(bytes[..start].to_vec()).expect("text");
        let mut arrays = BTreeMap::new();
        let (mut element, mut end) = (String::new(), start);
        for line in header.lines() {
            let attribute = |name: &str| {
                let from = line.split_once(&format!(" {name}=\""))?.1;
                Some(from.split_once('"')?.0.to_owned())
            };
            let Some(offset) = attribute("offset") else {
                element = line.trim_matches(['<', '>']).to_owned();
                continue;
            };
            let at = start + offset.parse::<usize>().expect("a number");
            assert_eq!(at, end, "arrays lie one behind the other");
            let length = u64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight bytes")) as usize;
            end = at + 8 + length;
            let name = attribute("Name").expect("a name");
            let is_of_cells = ["Verts", "Lines", "Polys"].contains(&element.as_str());
            let key = if is_of_cells { format!("{element} {name}") } else { name };
            arrays.insert(key, bytes[at + 8..end].to_vec());
        }
        assert_eq!(&bytes[end..], b"\n</AppendedData>\n</VTKFile>\n");
        Self(arrays)
    }

    pub fn numbers(&self, name: &str) -> Vec<f32> {
        self.words(name).into_iter().map(f32::from_bits).collect()
    }

    pub fn words(&self, name: &str) -> Vec<u32> {
        let words = self.0[name].chunks_exact(4);
        words.map(|word| u32::from_le_bytes(word.try_into().expect("four bytes"))).collect()
    }

    pub fn vectors(&self, name: &str) -> Vec<Vec3> {
        self.numbers(name).chunks_exact(3).map(Vec3::from_slice).collect()
    }
}

/// Some frames of the cloth of the assignment, and what is said of them.
fn cloth(frames: u64) -> (RunInfo, Vec<sprung::Snapshot>) {
    let mut simulation =
        Scene::builtin("cloth").and_then(|scene| scene.simulation()).expect("it is built in");
    let mut snapshots = vec![simulation.snapshot().clone()];
    for _ in 1..frames {
        simulation.frame().expect("it is stable");
        snapshots.push(simulation.snapshot().clone());
    }
    let (model, params) = (Arc::clone(simulation.model()), simulation.params().clone());
    let frame_time = 0.07;
    (
        RunInfo {
            scene: "cloth".into(),
            title: "Cloth\nin two lines".into(),
            model,
            params,
            frame_time,
            frames,
        },
        snapshots,
    )
}

fn write(
    exporter: Exporter,
    path: &Path,
    options: &Options,
    run: &RunInfo,
    snapshots: &[sprung::Snapshot],
) -> u64 {
    let mut export = (exporter.open)(path, run, options).expect("written");
    for (snapshot, index) in snapshots.iter().zip(0..) {
        export.frame(&Frame { index, snapshot, params: &run.params, energy: None }).expect("written");
    }
    let written = export.finish(&mut to_the_end).expect("written");
    assert_eq!(written.frames, snapshots.len() as u64);
    written.bytes
}

fn close_to(estimate: Estimate, bytes: u64) -> bool {
    match estimate {
        Estimate::Exact(estimate) => estimate == bytes,
        Estimate::About(estimate) => (0.7..1.4).contains(&(estimate as f64 / bytes as f64)),
    }
}

#[test]
fn meshes_read_back_to_the_same_bits() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (run, snapshots) = cloth(4);
    let options = Options { springs: Some(Springs::Lines), up: Up::Z, ..Options::default() };
    let triangles: Vec<[u32; 3]> = run.model.surfaces()[0].triangles.clone();
    for exporter in [OBJ, PLY] {
        let path = folder.path().join("cloth").with_extension(exporter.ending);
        let bytes = write(exporter, &path, &options, &run, &snapshots);
        assert!(close_to((exporter.estimate)(&run, &options).expect("an estimate"), bytes), "{bytes}");
    }
    for (frame, snapshot) in snapshots.iter().enumerate() {
        let turned = |v: &Vec3| Vec3::new(v.x, -v.z, v.y);
        let positions: Vec<Vec3> = snapshot.positions.iter().map(turned).collect();
        let velocities: Vec<Vec3> = snapshot.velocities.iter().map(turned).collect();

        let obj = Obj::read(&folder.path().join(format!("cloth.{frame:04}.obj")));
        assert!(obj.vertices == positions && obj.faces == triangles && obj.lines == run.model.springs());
        assert_eq!(obj.names, ["cloth", "springs"]);

        let ply = Ply::read(&folder.path().join(format!("cloth.{frame:04}.ply")));
        assert!(ply.vectors(["x", "y", "z"]) == positions && ply.vectors(["vx", "vy", "vz"]) == velocities);
        assert!(ply.faces == triangles && ply.edges == run.model.springs());
        assert_eq!(ply.vectors(["red", "green", "blue"])[0], Vec3::new(18.0, 122.0, 138.0));
        // Lengths of normals round in float32.
        assert!(ply.vectors(["nx", "ny", "nz"]).iter().all(|n| (n.length() - 1.0).abs() < 1e-6));
    }
    assert_eq!(names_in(folder.path()).len(), 8);
}

#[test]
fn vtk_files_hold_points_springs_and_surfaces_with_their_fields() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (run, snapshots) = cloth(3);
    let path = folder.path().join("cloth.pvd");
    let bytes = write(VTK, &path, &Options::default(), &run, &snapshots);
    assert!(close_to((VTK.estimate)(&run, &Options::default()).expect("an estimate"), bytes), "{bytes}");

    let collection = fs::read_to_string(&path).expect("text");
    let vtp =
        |layer: &str, frame: usize| Vtp::read(&folder.path().join(format!("cloth/{layer}.{frame:04}.vtp")));
    for (frame, snapshot) in snapshots.iter().enumerate() {
        for layer in ["points", "surface"] {
            let listed = format!("timestep=\"{:?}\" file=\"cloth/{layer}.{frame:04}.vtp\"", snapshot.time);
            assert!(collection.contains(&listed), "{listed}");
        }
        let points = vtp("points", frame);
        assert!(
            points.vectors("Points") == snapshot.positions
                && points.vectors("velocity") == snapshot.velocities
        );
        assert_eq!(points.words("Lines connectivity"), run.model.springs().as_flattened());
        assert_eq!(points.words("Lines offsets").last(), Some(&(2 * run.model.spring_count() as u32)));
        assert_eq!(points.numbers("mass"), **run.params.point_mass);
        let (strain, tension) = (points.numbers("strain"), points.numbers("tension"));
        for spring in 0..run.model.spring_count() {
            let reading = SpringReading::of(&run.model, &run.params, snapshot, spring).expect("it is there");
            assert_eq!(tension[spring], reading.tension as f32);
            assert_eq!(Some(strain[spring]), reading.strain.map(|strain| strain as f32));
        }
        for (point, force) in points.vectors("force").into_iter().enumerate() {
            let reading = PointReading::of(&run.model, &run.params, snapshot, point).expect("it is there");
            assert_eq!(force, reading.total_force.as_vec3());
        }
        let surface = vtp("surface", frame);
        assert_eq!(surface.words("Polys connectivity"), run.model.surfaces()[0].triangles.as_flattened());
        assert!(surface.vectors("Points") == snapshot.positions);
    }
    assert_eq!(names_in(folder.path()), ["cloth", "cloth.pvd"]);
    assert_eq!(names_in(&folder.path().join("cloth")).len(), 6);
}

#[test]
fn a_sequence_ends_with_its_last_frame() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| folder.path().join(name);
    // Of an earlier and longer run, and of the user.
    let kept =
        ["a.0007.ply", "a.007.obj", "a.00007.obj", "a.obj", "a.0007.obj.bak", "aa.0007.obj", "a.-001.obj"];
    kept.iter().chain(&["a.0007.obj", "a.10000.obj", "a.0001.obj"]).for_each(|name| {
        fs::write(at(name), "mine").expect("written");
    });
    let written =
        begin(OBJ, &at("a.obj"), &run_of(3), 3).expect("written").finish(&mut to_the_end).expect("written");
    assert_eq!((written.path, written.frames), (at("a.####.obj"), 3));
    let mut names: Vec<&str> = kept.to_vec();
    names.extend(["a.0000.obj", "a.0001.obj", "a.0002.obj"]);
    names.sort_unstable();
    assert_eq!(names_in(folder.path()), names);
    assert!(kept.iter().all(|name| fs::read(at(name)).expect("it is there") == b"mine"));
}

#[test]
fn a_sequence_that_is_dropped_leaves_nothing_behind() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for exporter in [OBJ, PLY, VTK] {
        let path = folder.path().join("a").with_extension(exporter.ending);
        for frames in [0, 3] {
            drop(begin(exporter, &path, &run_of(3), frames).expect("written"));
            assert!(names_in(folder.path()).is_empty(), "{:?}", names_in(folder.path()));
        }
        let export = begin(exporter, &path, &run_of(3), 0).expect("written");
        assert_eq!(export.finish(&mut to_the_end).expect("written").frames, 0);
    }
    assert_eq!(names_in(folder.path()), ["a.pvd"], "a run without frames");
}

#[test]
fn two_runs_do_not_mix_their_frames() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for exporter in [OBJ, PLY, VTK] {
        let path = folder.path().join("a").with_extension(exporter.ending);
        let mut first = begin(exporter, &path, &run_of(3), 1).expect("written");
        let error = begin(exporter, &path, &run_of(3), 0).err().expect("refused");
        assert_eq!(error.sentence(), "cannot be written: another output is being written there");
        give(&mut *first, &run_of(3), 1).expect("the first run goes on unharmed");
        assert_eq!(first.finish(&mut to_the_end).expect("written").frames, 2);
    }
}

#[test]
fn names_of_every_kind_stand_in_the_files_as_the_formats_ask() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let name = "a b&<c>\"d' é";
    begin(VTK, &folder.path().join(format!("{name}.pvd")), &run_of(3), 1)
        .and_then(|export| export.finish(&mut to_the_end))
        .expect("written");
    let collection = fs::read_to_string(folder.path().join(format!("{name}.pvd"))).expect("text");
    assert!(collection.contains("file=\"a b&amp;&lt;c&gt;&quot;d' é/points.0000.vtp\""), "{collection}");
    assert_eq!(names_in(&folder.path().join(name)), ["points.0000.vtp"]);

    let error =
        begin(VTK, &folder.path().join("a\nb.pvd"), &run_of(3), 0).err().expect("XML has no place for it");
    assert_eq!(error.code(), Code::Unwritable);
    // The folder's name is taken.
    fs::write(folder.path().join("taken"), "mine").expect("written");
    let error = begin(VTK, &folder.path().join("taken.pvd"), &run_of(3), 0).err().expect("refused");
    assert_eq!(
        (error.code(), error.sentence()),
        (Code::Unwritable, "is to be a folder for the frames, and there is something else of this name")
    );
    assert_eq!(names_in(folder.path()).len(), 3);
}

#[test]
fn frames_that_cannot_be_written_cost_no_other() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (run, snapshots) = cloth(3);
    // The second layer of frame 1 is in the way: the first layer's file of it goes, too.
    fs::create_dir_all(folder.path().join("a/surface.0001.vtp")).expect("made");
    let path = folder.path().join("a.pvd");
    let mut export = (VTK.open)(&path, &run, &Options::default()).expect("written");
    let mut give = |index: u64| {
        let snapshot = &snapshots[index as usize];
        export.frame(&Frame { index, snapshot, params: &run.params, energy: None })
    };
    assert!(give(0).is_ok());
    assert_eq!(give(1).expect_err("a folder").sentence(), "cannot be written: it is a folder");
    assert_eq!(export.finish(&mut to_the_end).expect("written").frames, 1);
    assert_eq!(
        names_in(&folder.path().join("a")),
        ["points.0000.vtp", "surface.0000.vtp", "surface.0001.vtp"]
    );
    assert_eq!(fs::read_to_string(path).expect("text").matches("DataSet").count(), 2);
}
