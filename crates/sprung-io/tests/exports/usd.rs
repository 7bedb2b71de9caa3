//! USD files, read back by an independent reader.

use std::fs::File;
use std::path::Path;

use openusd::sdf::{self, AbstractData, Value};
use openusd::{usda, usdc, usdz};
use sprung::{Code, Vec3};
use sprung_io::export::{USDA, USDC, USDZ};
use sprung_io::{Estimate, Exporter, Options, RunInfo, Springs, Up};

use crate::common::{begin, give, run_of, snapshot, to_the_end};
use crate::geometry::three_bodies;

const ALL: [Exporter; 3] = [USDC, USDA, USDZ];

/// A layer, whatever its form.
pub fn read(path: &Path) -> Box<dyn AbstractData> {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("usda") => Box::new(usda::read_file(path).expect("a text layer")),
        Some("usdz") => {
            usdz::Archive::open(path).expect("an archive").read_first_layer().expect("a layer in it")
        }
        _ => Box::new(usdc::CrateData::open(File::open(path).expect("it is there"), true).expect("a crate")),
    }
}

fn field(layer: &dyn AbstractData, path: &str, name: &str) -> Value {
    let path = sdf::Path::new(path).expect("a path");
    let found = layer.get_field(&path, name);
    found.unwrap_or_else(|_| panic!("no {name} of {path} among {:?}", layer.spec_paths())).into_owned()
}

fn vectors(value: &Value) -> Vec<[u32; 3]> {
    let Value::Vec3fVec(vectors) = value else { panic!("not vectors: {value:?}") };
    vectors.iter().map(|v| [v.x, v.y, v.z].map(f32::to_bits)).collect()
}

pub fn bits(vectors: &[Vec3]) -> Vec<[u32; 3]> {
    vectors.iter().map(|v| v.to_array().map(f32::to_bits)).collect()
}

/// The samples of an attribute: times and vectors.
pub fn samples(layer: &dyn AbstractData, path: &str) -> Vec<(f64, Vec<[u32; 3]>)> {
    let Value::TimeSamples(samples) = field(layer, path, "timeSamples") else { panic!("{path} has none") };
    samples.iter().map(|(time, value)| (*time, vectors(value))).collect()
}

fn text(value: &Value) -> String {
    match value {
        Value::Token(token) => token.to_string(),
        Value::String(text) => text.clone(),
        _ => panic!("no text: {value:?}"),
    }
}

fn number(value: &Value) -> f64 {
    match value {
        Value::Double(number) => *number,
        Value::Float(number) => f64::from(*number),
        Value::Int(number) => f64::from(*number),
        _ => panic!("no number: {value:?}"),
    }
}

/// An attribute that is the same at all times.
pub fn integers(layer: &dyn AbstractData, path: &str) -> Vec<i32> {
    ints(&field(layer, path, "default"))
}

fn ints(value: &Value) -> Vec<i32> {
    let Value::IntVec(ints) = value else { panic!("no integers: {value:?}") };
    ints.clone()
}

/// Writes frames from `first` on.
fn write(exporter: Exporter, path: &Path, run: &RunInfo, options: &Options, first: u64, frames: u64) -> u64 {
    let mut export = (exporter.open)(path, run, options).expect("begun");
    (first..first + frames).for_each(|index| give(&mut *export, run, index).expect("taken"));
    let written = export.finish(&mut to_the_end).expect("completed");
    assert_eq!((written.frames, written.path.as_path()), (frames, path));
    assert_eq!(std::fs::metadata(path).expect("it is there").len(), written.bytes);
    written.bytes
}

#[test]
fn every_sample_has_its_bits() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let run = three_bodies();
    let options = Options { springs: Some(Springs::Lines), ..Options::default() };
    for exporter in ALL {
        let path = folder.path().join("a").with_extension(exporter.ending);
        write(exporter, &path, &run, &options, 3, 20);
        let layer = read(&path);
        let layer = &*layer;
        let ends = [0, 3, 3, 4, 4, 5, 5, 8];
        for (prim, chosen) in [
            ("left", vec![0, 1, 2, 3]),
            ("stone", vec![4]),
            ("right", vec![5, 6, 7, 8]),
            ("springs", ends.to_vec()),
        ] {
            let of = |vectors: &[Vec3]| chosen.iter().map(|&point| vectors[point]).collect::<Vec<_>>();
            let points = samples(layer, &format!("/three/{prim}.points"));
            let velocities = samples(layer, &format!("/three/{prim}.velocities"));
            let extents = samples(layer, &format!("/three/{prim}.extent"));
            assert_eq!([points.len(), velocities.len(), extents.len()], [20; 3]);
            for (index, (time, found)) in points.iter().enumerate() {
                let frame = 3 + index as u64;
                let expected = snapshot(9, frame);
                assert_eq!(*time, frame as f64);
                assert_eq!(*found, bits(&of(&expected.positions)), "{prim} at {frame} in {}", path.display());
                assert_eq!(velocities[index], (*time, bits(&of(&expected.velocities))));
                let (low, high) = of(&expected.positions)
                    .iter()
                    .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
                if prim == "left" || prim == "right" {
                    // Zero has two signs, and a box does not care for them.
                    let box_found = extents[index].1.iter().map(|corner| corner.map(f32::from_bits));
                    assert!(box_found.eq([low.to_array(), high.to_array()]));
                }
            }
        }
    }
}

#[test]
fn a_layer_says_what_it_is() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut run = three_bodies();
    run.title = "He said \"three\"\nbodies \\ and a tab\t".into();
    let options = Options { up: Up::Z, scale: 100.0, ..Options::default() };
    for exporter in ALL {
        let path = folder.path().join("a").with_extension(exporter.ending);
        write(exporter, &path, &run, &options, 0, 5);
        let layer = read(&path);
        let of = |path: &str, name: &str| field(&*layer, path, name);
        assert_eq!(text(&of("/", "defaultPrim")), "three");
        assert_eq!(text(&of("/", "upAxis")), "Z");
        assert_eq!(number(&of("/", "metersPerUnit")), 0.01);
        assert_eq!(number(&of("/", "timeCodesPerSecond")), 25.0);
        assert_eq!(number(&of("/", "framesPerSecond")), 25.0);
        assert_eq!(number(&of("/", "startTimeCode")), 0.0);
        assert_eq!(number(&of("/", "endTimeCode")), 4.0);
        // This reader leaves the escapes of a text as they are; OpenUSD does not (xtask/check_usd.py).
        if exporter.ending != "usda" {
            assert!(text(&of("/", "documentation")).starts_with(&run.title));
        }

        for (prim, kind) in
            [("left", "Mesh"), ("stone", "Points"), ("right", "Mesh"), ("springs", "BasisCurves")]
        {
            let path = format!("/three/{prim}");
            assert_eq!(text(&of(&path, "typeName")), kind);
            assert_eq!(text(&of(&path, "displayName")), prim);
            let colour = of(&format!("{path}.primvars:displayColor"), "default");
            assert_eq!(vectors(&colour).len(), 1);
        }
        let mesh = "/three/right";
        let value = |name: &str| of(&format!("{mesh}.{name}"), "default");
        assert_eq!(ints(&value("faceVertexCounts")), [3, 3]);
        assert_eq!(ints(&value("faceVertexIndices")), [0, 1, 2, 2, 1, 3]);
        assert_eq!(text(&value("subdivisionScheme")), "none");
        assert_eq!(text(&value("orientation")), "rightHanded");
        assert_eq!(value("doubleSided"), Value::Bool(true));
        assert_eq!(text(&of("/three/right.normals", "interpolation")), "vertex");
        assert_eq!(ints(&of("/three/springs.curveVertexCounts", "default")), [2; 4]);
        assert_eq!(text(&of("/three/springs.type", "default")), "linear");
        for (_, normals) in samples(&*layer, "/three/right.normals") {
            assert_eq!(normals.len(), 4);
        }
    }
}

#[test]
fn what_is_planned_is_what_is_written() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (run, springs) in [(run_of(17), None), (three_bodies(), Some(Springs::Tubes))] {
        let options = Options { springs, ..Options::default() };
        for frames in [1, 2, 100] {
            let run = RunInfo { frames, ..run.clone() };
            for exporter in ALL {
                let path = folder.path().join("a").with_extension(exporter.ending);
                let bytes = write(exporter, &path, &run, &options, 0, frames);
                match (exporter.estimate)(&run, &options).expect("it can be written") {
                    Estimate::Exact(planned) => assert_eq!(planned, bytes, "{}", exporter.ending),
                    Estimate::About(planned) => {
                        assert!((bytes / 2..2 * bytes).contains(&planned), "{planned} for {bytes}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_package_over_4_gib_is_refused_before_the_run() {
    let run = RunInfo { frames: 3_000_000, ..run_of(100) };
    let error = (USDZ.estimate)(&run, &Options::default()).expect_err("too large");
    assert_eq!(error.code(), Code::TooLarge);
    assert_eq!(error.sentence(), "would take 20.4 GiB, and a .usdz holds at most 4 GiB");
    let folder = tempfile::tempdir().expect("a temporary folder");
    assert!((USDZ.open)(&folder.path().join("a.usdz"), &run, &Options::default()).is_err());
    assert!((USDC.estimate)(&run, &Options::default()).is_ok());
}

/// As a zip archive it is an ordinary one, whose entry lies where phones want it.
#[test]
fn a_package_is_a_zip_archive_with_its_entry_aligned() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for scene in ["a", "a_name_that_reaches_beyond_the_first_64_bytes_of_the_file"] {
        let run = RunInfo { scene: scene.into(), ..run_of(3) };
        let path = folder.path().join("a.usdz");
        write(USDZ, &path, &run, &Options::default(), 0, 2);
        let mut archive = zip::ZipArchive::new(File::open(&path).expect("it is there")).expect("an archive");
        let mut entry = archive.by_index(0).expect("an entry");
        assert_eq!(entry.name().expect("text"), format!("{scene}.usdc"));
        assert_eq!(entry.data_start().expect("known") % 64, 0);
        let mut content = Vec::new();
        std::io::Read::read_to_end(&mut entry, &mut content).expect("the checksum fits");
        let alone = folder.path().join("a.usdc");
        write(USDC, &alone, &run, &Options::default(), 0, 2);
        assert!(content == std::fs::read(alone).expect("it is there"));
    }
}

#[test]
fn frames_follow_each_other() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let run = run_of(2);
    let mut export = begin(USDC, &folder.path().join("a.usdc"), &run, 3).expect("begun");
    let error = give(&mut *export, &run, 4).expect_err("one is missing");
    assert_eq!(error.sentence(), "frame 3 was to follow, and frame 4 came");
    assert!(give(&mut *export, &run, 3).is_ok());
}

/// Neither a frame nor the end takes memory that depends on how many frames there are.
#[test]
fn memory_does_not_grow_with_the_frames() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let run = run_of(50);
    for exporter in ALL {
        let at_the_end = [10, 2000].map(|frames| {
            let path = folder.path().join("a").with_extension(exporter.ending);
            let mut export = begin(exporter, &path, &run, 2).expect("begun");
            let growing = allocation_counter::measure(|| {
                (2..frames).for_each(|index| give(&mut *export, &run, index).expect("taken"));
            });
            assert_eq!(growing.bytes_current, 0, "{} with {frames} frames", exporter.ending);
            allocation_counter::measure(|| {
                export.finish(&mut to_the_end).expect("completed");
            })
            .bytes_max
        });
        assert_eq!(at_the_end[0], at_the_end[1], "{}", exporter.ending);
    }
}

/// Several hundred bodies, each with several attributes that move: a file is open for each output and what waits beside it,
/// not for each of them.
#[cfg(target_os = "linux")]
#[test]
fn many_bodies_take_few_files() {
    crate::full_disk::in_child("usd::child_with_few_files", "ulimit -n 24");
}

#[cfg(target_os = "linux")]
#[test]
#[ignore = "run by many_bodies_take_few_files"]
fn child_with_few_files() {
    use std::sync::Arc;

    let mut builder = sprung::ModelBuilder::new();
    for body in 0..300 {
        builder.begin_body(format!("body {body}")).expect("a name of its own");
        builder.add_point(Vec3::X * body as f32, 1.0).expect("an ordinary point");
    }
    let (model, params, _) = builder.build().expect("an ordinary model");
    let run = RunInfo { model: Arc::new(model), params, frames: 3, ..run_of(1) };
    for exporter in ALL {
        let path = crate::full_disk::folder().join("a").with_extension(exporter.ending);
        write(exporter, &path, &run, &Options::default(), 0, 3);
        let layer = read(&path);
        for body in [0, 7, 299] {
            let samples = samples(&*layer, &format!("/row/body_{body}.points"));
            let expected =
                (0..3).map(|frame| (frame as f64, bits(&snapshot(300, frame).positions[body..=body])));
            assert!(samples.into_iter().eq(expected), "{}", exporter.ending);
        }
    }
}
