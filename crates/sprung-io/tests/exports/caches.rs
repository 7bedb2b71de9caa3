//! Point caches, read back by the layout that their formats' users agree on.

use std::path::Path;

use sprung::{Code, Vec3};
use sprung_io::export::{CSV, MDD, NPZ, PC2};
use sprung_io::{Estimate, Exporter, Frame, Options, Springs};

use crate::common::{begin, give, run_of, snapshot, to_the_end};

/// What a point cache holds.
pub struct Cache {
    /// Of each frame, s; of a `.pc2` the frame at which it begins, and the frames between samples.
    pub times: Vec<f32>,
    pub frames: Vec<Vec<Vec3>>,
}

/// Reads a `.pc2` or `.mdd` and finds every byte used.
pub fn read(path: &Path) -> Cache {
    let bytes = std::fs::read(path).expect("the file is there");
    let is_pc2 = path.extension().is_some_and(|ending| ending == "pc2");
    let word = |at: usize| {
        let word: [u8; 4] = bytes[at..at + 4].try_into().expect("four bytes");
        if is_pc2 { u32::from_le_bytes(word) } else { u32::from_be_bytes(word) }
    };
    let number = |at: usize| f32::from_bits(word(at));
    let (vertices, frames, times, start) = if is_pc2 {
        assert_eq!((&bytes[..12], word(12)), (&b"POINTCACHE2\0"[..], 1));
        (word(16) as usize, word(28) as usize, vec![number(20), number(24)], 32)
    } else {
        let frames = word(0) as usize;
        let times = (0..frames).map(|frame| number(8 + 4 * frame)).collect();
        (word(4) as usize, frames, times, 8 + 4 * frames)
    };
    assert_eq!(bytes.len(), start + frames * vertices * 12, "{}", path.display());
    let vertex = |index: usize| {
        let at = start + 12 * index;
        Vec3::new(number(at), number(at + 4), number(at + 8))
    };
    let frame = |frame: usize| (frame * vertices..(frame + 1) * vertices).map(vertex).collect();
    Cache { times, frames: (0..frames).map(frame).collect() }
}

#[test]
fn caches_read_back_to_the_same_bits() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for exporter in [PC2, MDD] {
        let path = folder.path().join("a").with_extension(exporter.ending);
        let mut run = run_of(700);
        run.frames = 5;
        // From frame 3 on, as after --from.
        let mut export = begin(exporter, &path, &run, 0).expect("written");
        (3..8).for_each(|frame| give(&mut *export, &run, frame).expect("written"));
        let written = export.finish(&mut to_the_end).expect("written");
        let estimate = (exporter.estimate)(&run, &Options::default());
        assert_eq!((estimate, written.frames), (Ok(Estimate::Exact(written.bytes)), 5));
        let cache = read(&path);
        let times = if exporter.ending == "pc2" {
            vec![3.0, 1.0]
        } else {
            (3..8).map(|frame| snapshot(1, frame).time as f32).collect()
        };
        assert_eq!(cache.times, times);
        for (read, frame) in cache.frames.iter().zip(3..) {
            let expected = snapshot(700, frame).positions;
            assert!(
                read.iter()
                    .zip(&expected)
                    .all(|(a, b)| a.to_array().map(f32::to_bits) == b.to_array().map(f32::to_bits))
            );
        }
    }
}

/// The times of an `.mdd` come before its vertices, and how many there are turns out at the end.
#[test]
fn a_cache_of_fewer_frames_than_planned_is_whole() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for frames in [0, 1, 2, 99, 100] {
        for exporter in [PC2, MDD] {
            let path = folder.path().join(format!("{frames}")).with_extension(exporter.ending);
            let mut run = run_of(50);
            run.frames = 100;
            let written = begin(exporter, &path, &run, frames).expect("written").finish(&mut to_the_end);
            assert_eq!(written.expect("written").frames, frames);
            let read = read(&path).frames;
            assert_eq!(read.len() as u64, frames);
            for (read, frame) in read.iter().zip(0..) {
                assert!(*read == snapshot(50, frame).positions);
            }
        }
    }
    let mut run = run_of(5);
    run.frames = 2;
    let path = folder.path().join("more.mdd");
    let error = begin(MDD, &path, &run, 3).err().expect("there is no room for a third time");
    assert_eq!(
        (error.code(), error.sentence()),
        (Code::Conflict, "got a frame more than the 2 that were planned")
    );
}

#[test]
fn what_cannot_be_counted_is_refused() {
    let mut run = run_of(5);
    run.frames = 1 << 31;
    for exporter in [PC2, MDD] {
        let error = (exporter.estimate)(&run, &Options::default()).expect_err("too many frames");
        assert_eq!(error.code(), Code::TooLarge);
        let folder = tempfile::tempdir().expect("a temporary folder");
        assert!((exporter.open)(&folder.path().join("a"), &run, &Options::default()).is_err());
    }
}

/// With tubes a cache fits the mesh that was written with the same options.
#[test]
fn tubes_are_in_the_cache_too() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let run = run_of(4);
    let options = Options { springs: Some(Springs::Tubes), ..Options::default() };
    for exporter in [PC2, MDD] {
        let path = folder.path().join("a").with_extension(exporter.ending);
        let mut export = (exporter.open)(&path, &run, &options).expect("written");
        let snapshot = snapshot(4, 0);
        export
            .frame(&Frame { index: 0, snapshot: &snapshot, params: &run.params, energy: None })
            .expect("written");
        export.finish(&mut to_the_end).expect("written");
        assert_eq!(read(&path).frames[0].len(), 4 + 3 * 12);
    }
}

#[test]
fn estimates_of_tables_hold() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for frames in [1, 7, 40] {
        for exporter in [CSV, NPZ] as [Exporter; 2] {
            let path = folder.path().join("a").with_extension(exporter.ending);
            let mut run = run_of(200);
            run.frames = frames;
            let written = begin(exporter, &path, &run, frames).expect("written").finish(&mut to_the_end);
            let bytes = written.expect("written").bytes;
            match (exporter.estimate)(&run, &Options::default()).expect("an estimate") {
                Estimate::Exact(estimate) => assert_eq!(estimate, bytes, "{}", exporter.ending),
                Estimate::About(estimate) => {
                    let ratio = estimate as f64 / bytes as f64;
                    assert!((0.5..2.0).contains(&ratio), "{}: {estimate} for {bytes}", exporter.ending);
                }
            }
        }
    }
}
