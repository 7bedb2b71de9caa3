//! glTF files, read back by an independent reader.

use std::path::Path;

use gltf::animation::util::ReadOutputs;
use gltf::mesh::Mode;
use sprung::{Code, Vec3};
use sprung_io::export::GLB;
use sprung_io::{Options, RunInfo, Springs, Up};

use crate::common::{begin, give, names_in, run_of, snapshot, to_the_end};
use crate::geometry::three_bodies;

/// What is drawn of a thing, frame by frame.
pub struct Drawn {
    pub name: String,
    pub mode: Mode,
    pub indices: Vec<u32>,
    /// Positions and normals as the animation blends them.
    pub frames: Vec<(Vec<Vec3>, Vec<Vec3>)>,
}

/// Reads and plays a file.
pub fn read(path: &Path) -> (Vec<f32>, Vec<Drawn>) {
    let bytes = std::fs::read(path).expect("it is there");
    // The reader checks what the standard demands of the description.
    let file = gltf::Gltf::from_slice(&bytes).expect("a glTF file");
    let data = file.blob.clone().expect("it has data");
    let mut times = vec![0.0];
    let mut weights = vec![Vec::new()];
    if let Some(animation) = file.animations().next() {
        let channel = animation.channels().next().expect("a channel");
        assert_eq!(animation.channels().count(), file.nodes().count());
        let reader = channel.reader(|_| Some(&data));
        times = reader.read_inputs().expect("times").collect();
        let Some(ReadOutputs::MorphTargetWeights(all)) = reader.read_outputs() else { panic!("no weights") };
        let all: Vec<f32> = all.into_f32().collect();
        weights = all.chunks(times.len() - 1).map(<[f32]>::to_vec).collect();
        assert_eq!(weights.len(), times.len());
    }
    let drawn = file.nodes().map(|node| {
        let mesh = node.mesh().expect("a mesh");
        let primitive = mesh.primitives().next().expect("a primitive");
        let reader = primitive.reader(|_| Some(&data));
        let vectors = |read: Option<Vec<[f32; 3]>>| -> Vec<Vec3> {
            read.unwrap_or_default().into_iter().map(Vec3::from).collect()
        };
        let positions = vectors(reader.read_positions().map(Iterator::collect));
        let normals = vectors(reader.read_normals().map(Iterator::collect));
        let shapes: Vec<[Vec<Vec3>; 2]> = reader
            .read_morph_targets()
            .map(|(p, n, _)| [vectors(p.map(Iterator::collect)), vectors(n.map(Iterator::collect))])
            .collect();
        let blend = |base: &[Vec3], part: usize, weights: &[f32]| {
            let mut sum = base.to_vec();
            for (weight, shape) in weights.iter().zip(&shapes) {
                sum.iter_mut().zip(&shape[part]).for_each(|(sum, delta)| *sum += *weight * *delta);
            }
            sum
        };
        let frames =
            weights.iter().map(|weights| (blend(&positions, 0, weights), blend(&normals, 1, weights)));
        Drawn {
            name: node.name().unwrap_or_default().to_owned(),
            mode: primitive.mode(),
            indices: reader.read_indices().map(|i| i.into_u32().collect()).unwrap_or_default(),
            frames: frames.collect(),
        }
    });
    (times, drawn.collect())
}

/// That a sum of the first frame and a difference is the second up to the rounding of both.
pub fn assert_near(found: &[Vec3], first: &[Vec3], expected: &[Vec3]) {
    assert_eq!(found.len(), expected.len());
    for ((found, first), expected) in found.iter().zip(first).zip(expected) {
        let allowed = f32::EPSILON / 2.0 * ((*expected - *first).abs() + expected.abs()) * 1.0001;
        let off = (*found - *expected).abs();
        // The smallest numbers have an absolute error.
        assert!(off.cmple(allowed + Vec3::splat(f32::MIN_POSITIVE)).all(), "{found} for {expected}");
    }
}

#[test]
fn a_clip_plays_the_frames() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.glb");
    let run = RunInfo { frames: 9, ..three_bodies() };
    let options = Options { springs: Some(Springs::Lines), ..Options::default() };
    let mut export = (GLB.open)(&path, &run, &options).expect("begun");
    (0..9).for_each(|index| give(&mut *export, &run, index).expect("taken"));
    let written = export.finish(&mut to_the_end).expect("completed");
    assert_eq!((written.frames, written.bytes), (9, std::fs::metadata(&path).expect("there").len()));

    let (times, drawn) = read(&path);
    assert!(times.iter().enumerate().all(|(frame, time)| *time == (frame as f64 * run.frame_time) as f32));
    let spans = [0..4, 4..5, 5..9, 0..9];
    let kinds = [
        ("left", Mode::Triangles, vec![0, 1, 2, 2, 1, 3]),
        ("stone", Mode::Points, vec![]),
        ("right", Mode::Triangles, vec![0, 1, 2, 2, 1, 3]),
        ("springs", Mode::Lines, vec![0, 3, 3, 4, 4, 5, 5, 8]),
    ];
    assert_eq!(drawn.len(), 4);
    let first = snapshot(9, 0).positions;
    for ((thing, (name, mode, indices)), span) in drawn.iter().zip(kinds).zip(spans) {
        assert_eq!((thing.name.as_str(), thing.mode, &thing.indices), (name, mode, &indices));
        assert_eq!(thing.frames[0].0, first[span.clone()], "the first frame has its bits");
        for (frame, (positions, normals)) in thing.frames.iter().enumerate() {
            let expected = snapshot(9, frame as u64).positions;
            assert_near(positions, &first[span.clone()], &expected[span.clone()]);
            assert!(normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-5));
            assert_eq!(normals.is_empty(), mode != Mode::Triangles);
        }
    }
}

#[test]
fn a_still_is_the_frame_nearest_to_the_time() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.glb");
    // Frames are 0.07 s apart. There may be any number of them.
    for (at, frame) in [(0.0, 0), (0.2, 3), (0.1, 1), (100.0, 300)] {
        let run = RunInfo { frames: 301, ..run_of(5) };
        let options = Options { at: Some(at), ..Options::default() };
        let mut export = (GLB.open)(&path, &run, &options).expect("begun");
        (0..301).for_each(|index| give(&mut *export, &run, index).expect("taken"));
        assert_eq!(export.finish(&mut to_the_end).expect("completed").frames, 1);
        let (times, drawn) = read(&path);
        assert_eq!((times.len(), drawn[0].frames.len()), (1, 1));
        assert_eq!(drawn[0].frames[0].0, snapshot(5, frame).positions);
    }
}

#[test]
fn what_cannot_be_is_refused_before_the_run() {
    let refused = |run: &RunInfo, options: &Options| {
        let error = (GLB.estimate)(run, options).expect_err("refused");
        (error.code(), error.sentence().to_owned())
    };
    let run = RunInfo { frames: 258, ..run_of(5) };
    let sentence = "would have 258 frames, and a .glb that moves holds at most 257";
    assert_eq!(refused(&run, &Options::default()), (Code::TooLarge, sentence.to_owned()));
    let still = Options { at: Some(0.0), ..Options::default() };
    assert!((GLB.estimate)(&run, &still).is_ok());

    let run = RunInfo { frames: 257, ..run_of(400_000) };
    let (code, sentence) = refused(&run, &Options::default());
    assert_eq!(code, Code::TooLarge);
    assert!(sentence.ends_with(" MiB, and a .glb holds at most 1024 MiB"), "{sentence}");

    let run = run_of(5);
    let z_up = Options { up: Up::Z, at: Some(0.0), ..Options::default() };
    let sentence = "cannot be said for a .glb, which is Y up by its standard";
    assert_eq!(refused(&run, &z_up), (Code::Conflict, sentence.to_owned()));
    let centimetres = Options { scale: 100.0, at: Some(0.0), ..Options::default() };
    let sentence = "cannot be said for a .glb, which is in metres by its standard";
    assert_eq!(refused(&run, &centimetres), (Code::Conflict, sentence.to_owned()));
}

/// Where nobody knew how many frames would come, those that have room are kept.
#[test]
fn a_clip_that_is_full_keeps_its_frames() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let run = RunInfo { frames: 1, ..run_of(2) };
    let mut export = begin(GLB, &folder.path().join("a.glb"), &run, 257).expect("these have room");
    let error = give(&mut *export, &run, 257).expect_err("one too many");
    assert_eq!(error.sentence(), "is full after 257 frames, the most that a .glb holds");
    assert_eq!(export.finish(&mut to_the_end).expect("completed").frames, 257);
    let (times, drawn) = read(&folder.path().join("a.glb"));
    assert_eq!((times.len(), drawn[0].frames.len()), (257, 257));
    assert_eq!(names_in(folder.path()), ["a.glb"]);
}
