//! A full disk costs the frame that did not fit, and no other.
//!
//! Each case runs in a child process, this same test program, under a limit that the system sets: a small disk of its
//! own, or a limit on the size of files.

use std::path::{Path, PathBuf};
use std::process::Command;

use sprung::Code;
use sprung_io::RunInfo;
use sprung_io::export::{CSV, GLB, MDD, NPZ, OBJ, PC2, PLY, USDA, USDC, USDZ, VTK};

use crate::common::{begin, give, names_in, run_of, snapshot, to_the_end};
use crate::sequences::{Obj, Ply, Vtp};
use crate::{caches, glb, npz, usd};

const POINTS: usize = 1000;
/// On a very small disk.
const FEW_POINTS: usize = 40;

/// Runs one of the children, such as those below, in a shell that first does `limit`. `$FOLDER` is where it writes.
pub fn in_child(child: &str, limit: &str) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let output = Command::new("sh")
        .args(["-c", &format!("{limit} && exec \"$0\" \"$@\"")])
        .arg(std::env::current_exe().expect("this program has a path"))
        .args(["--exact", child, "--ignored", "--nocapture"])
        .env("FOLDER", folder.path())
        .output()
        .expect("there is a shell");
    let said =
        format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success() && said.contains("1 passed"), "{child} failed:\n{said}");
}

pub fn folder() -> PathBuf {
    std::env::var_os("FOLDER").expect("run by a test of this file").into()
}

/// Gives frames until one does not fit; then completes the file. Gives the frames that were whole.
fn fill(exporter: sprung_io::Exporter, path: &Path, sentence: &str) -> u64 {
    let run = run_for(&exporter);
    let export = begin(exporter, path, &run, 0).expect("the start fits");
    fill_up(export, &run, sentence, 10)
}

/// The same in a run with checkpoints: temporary files have names.
fn fill_marked(exporter: sprung_io::Exporter, path: &Path) -> u64 {
    let run = run_for(&exporter);
    let options = sprung_io::Options { resumable: true, ..sprung_io::Options::default() };
    let mut export = (exporter.open)(path, &run, &options).expect("the start fits");
    export.mark().expect("marked");
    fill_up(export, &run, "cannot be written: the disk is full", 10)
}

/// The same with few points, so that some frames fit a very small disk.
fn fill_with_few(exporter: sprung_io::Exporter, path: &Path, resumable: bool, points: usize) -> u64 {
    let run = RunInfo { frames: 257, ..run_of(points) };
    let options = sprung_io::Options { resumable, ..sprung_io::Options::default() };
    let mut export = (exporter.open)(path, &run, &options).expect("the start fits");
    if resumable {
        export.mark().expect("marked");
    }
    fill_up(export, &run, "cannot be written: the disk is full", 0)
}

fn run_for(exporter: &sprung_io::Exporter) -> RunInfo {
    // Of a clip so few frames are allowed that they have to be larger.
    let (points, planned) = if exporter.ending == "glb" { (4 * POINTS, 257) } else { (POINTS, 1000) };
    RunInfo { frames: planned, ..run_of(points) }
}

fn fill_up(mut export: Box<dyn sprung_io::Export>, run: &RunInfo, sentence: &str, least: u64) -> u64 {
    let mut frames = 0;
    let error = loop {
        match give(&mut *export, run, frames) {
            Ok(()) => frames += 1,
            Err(error) => break error,
        }
    };
    assert_eq!((error.code(), error.sentence()), (Code::Unwritable, sentence));
    // The disk is still full: the next frame does not fit either, and does no harm.
    assert!(give(&mut *export, run, frames).is_err());
    let written = export.finish(&mut to_the_end).expect("whole frames are kept");
    assert_eq!(written.frames, frames);
    assert!(frames > least, "only {frames} frames");
    frames
}

fn check_csv(path: &Path, frames: u64) {
    let text = std::fs::read_to_string(path).expect("text");
    assert_eq!(text.lines().count() as u64, 1 + frames * POINTS as u64);
    let last = format!("{},{},{},", frames - 1, snapshot(1, frames - 1).time, POINTS - 1);
    assert!(text.ends_with('\n') && text.lines().last().is_some_and(|line| line.starts_with(&last)));
}

fn check_npz(path: &Path, frames: usize, points: usize) {
    let (positions, velocities) = (npz::load(path, "positions"), npz::load(path, "velocities"));
    assert_eq!(npz::load(path, "time").shape, [frames]);
    assert_eq!(positions.shape, [frames, points, 3]);
    assert_eq!(velocities.shape, [frames, points, 3]);
    let last = snapshot(points, frames as u64 - 1);
    let start = (frames - 1) * points * 3;
    for (read, expected) in [(positions, last.positions), (velocities, last.velocities)] {
        let expected: Vec<f32> = expected.iter().flat_map(|vector| vector.to_array()).collect();
        assert_eq!(read.f32s()[start..], expected);
    }
}

#[test]
fn a_full_disk_keeps_the_whole_frames() {
    on_a_disk_of("4m", "full_disk::child_on_a_small_disk");
}

/// On which there is hardly room for what is set aside.
#[test]
fn a_very_small_disk_keeps_the_whole_frames() {
    on_a_disk_of("64k", "full_disk::child_on_a_very_small_disk");
}

/// Runs a child that has a disk of its own: root may have one, and on most systems an ordinary user may, too.
#[allow(clippy::print_stderr)]
fn on_a_disk_of(size: &str, child: &str) {
    let is_allowed = |namespace: &&str| {
        let mount = format!("{namespace} mount -t tmpfs tmpfs /mnt");
        Command::new("sh").args(["-c", &mount]).output().is_ok_and(|output| output.status.success())
    };
    let Some(namespace) = ["unshare --mount", "unshare --map-root-user --mount"].into_iter().find(is_allowed)
    else {
        let reason = "not run: this system gives no disk of one's own (unshare, mount)";
        assert!(std::env::var_os("CI").is_none(), "{reason}");
        eprintln!("{reason}");
        return;
    };
    let disk = format!(
        r#"exec {namespace} sh -c 'mount -t tmpfs -o size={size} tmpfs "$FOLDER" && exec "$0" "$@"' "$0" "$@""#
    );
    in_child(child, &disk);
}

#[test]
#[ignore = "run by a_very_small_disk_keeps_the_whole_frames"]
fn child_on_a_very_small_disk() {
    for exporter in [NPZ, GLB, USDC, USDA, USDZ, CSV, PC2, MDD, OBJ, PLY, VTK] {
        let path = folder().join("a").with_extension(exporter.ending);
        for resumable in [false, true] {
            let frames = fill_with_few(exporter, &path, resumable, FEW_POINTS);
            assert!(frames > 3, "only {frames} frames of a .{}", exporter.ending);
            for name in names_in(&folder()) {
                assert!(!name.ends_with(".partial"), "{name} is left");
                let path = folder().join(name);
                let removed =
                    if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
                removed.expect("removed");
            }
        }
    }
    // Where what is moved at the end begins and ends in the disk's blocks, and how many of those are left, is different
    // each time.
    for (points, blocks) in [1, 7, 20, 40, 55, 90].into_iter().flat_map(|p| (0..5).map(move |b| (p, b))) {
        std::fs::write(folder().join("other"), vec![1; blocks << 12]).expect("it fits");
        for resumable in [false, true] {
            let path = folder().join("a.npz");
            let frames = fill_with_few(NPZ, &path, resumable, points) as usize;
            check_npz(&path, frames, points);
            assert_eq!(names_in(&folder()), ["a.npz", "other"]);
            std::fs::remove_file(path).expect("removed");
        }
    }
}

#[test]
#[ignore = "run by a_full_disk_keeps_the_whole_frames"]
fn child_on_a_small_disk() {
    let path = folder().join("a.csv");
    let frames = fill(CSV, &path, "cannot be written: the disk is full");
    check_csv(&path, frames);
    std::fs::remove_file(path).expect("removed");

    let path = folder().join("a.npz");
    let frames = fill(NPZ, &path, "cannot be written: the disk is full") as usize;
    check_npz(&path, frames, POINTS);
    assert_eq!(names_in(&folder()), ["a.npz"]);
    std::fs::remove_file(&path).expect("removed");

    // With checkpoints its temporary files have names and are copied; here there is no room for that, and they are moved.
    let frames = fill_marked(NPZ, &path) as usize;
    check_npz(&path, frames, POINTS);
    assert_eq!(names_in(&folder()), ["a.npz"]);
    std::fs::remove_file(path).expect("removed");

    let full = "cannot be written: the disk is full";
    for exporter in [PC2, MDD] {
        let path = folder().join("a").with_extension(exporter.ending);
        let frames = fill(exporter, &path, full);
        check_cache(&path, frames);
        std::fs::remove_file(path).expect("removed");
    }
    for (exporter, resumable) in
        [(USDC, false), (USDA, false), (USDZ, false), (USDC, true), (USDA, true), (USDZ, true)]
    {
        let path = folder().join("a").with_extension(exporter.ending);
        let frames = if resumable { fill_marked(exporter, &path) } else { fill(exporter, &path, full) };
        let samples = usd::samples(&*usd::read(&path), "/row/body.points");
        assert_eq!(samples.len() as u64, frames);
        for (frame, (time, found)) in samples.iter().enumerate() {
            assert_eq!(*time, frame as f64);
            assert_eq!(*found, usd::bits(&snapshot(POINTS, frame as u64).positions));
        }
        assert_eq!(names_in(&folder()).len(), 1);
        std::fs::remove_file(path).expect("removed");
    }
    for resumable in [false, true] {
        let path = folder().join("a.glb");
        let frames = if resumable { fill_marked(GLB, &path) } else { fill(GLB, &path, full) };
        let (times, drawn) = glb::read(&path);
        assert_eq!(times.len() as u64, frames);
        let first = snapshot(4 * POINTS, 0).positions;
        for (frame, (positions, _)) in drawn[0].frames.iter().enumerate() {
            glb::assert_near(positions, &first, &snapshot(4 * POINTS, frame as u64).positions);
        }
        assert_eq!(names_in(&folder()).len(), 1);
        std::fs::remove_file(path).expect("removed");
    }

    for exporter in [OBJ, PLY, VTK] {
        let path = folder().join("a").with_extension(exporter.ending);
        let frames = fill(exporter, &path, full);
        check_sequence(&path, frames);
        for name in names_in(&folder()) {
            let path = folder().join(name);
            let removed =
                if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
            removed.expect("removed");
        }
    }
}

/// A point cache of whole frames.
fn check_cache(path: &Path, frames: u64) {
    let cache = caches::read(path);
    assert_eq!(cache.frames.len() as u64, frames);
    for (frame, read) in cache.frames.iter().enumerate() {
        assert!(*read == snapshot(POINTS, frame as u64).positions, "frame {frame} of {}", path.display());
    }
}

/// A sequence of whole frames, and nothing else.
fn check_sequence(path: &Path, frames: u64) {
    let ending = path.extension().expect("it has one").to_string_lossy().into_owned();
    let numbered = |frame: u64, ending: &str| format!(".{frame:04}.{ending}");
    let names = names_in(&folder());
    if ending == "pvd" {
        assert_eq!(names, ["a", "a.pvd"]);
        let collection = std::fs::read_to_string(path).expect("text");
        assert_eq!(collection.matches("<DataSet ").count() as u64, frames);
        assert!(collection.ends_with("</Collection>\n</VTKFile>\n"));
        let files: Vec<String> =
            (0..frames).map(|frame| "points".to_owned() + &numbered(frame, "vtp")).collect();
        assert_eq!(names_in(&folder().join("a")), files);
    } else {
        let files: Vec<String> =
            (0..frames).map(|frame| "a".to_owned() + &numbered(frame, &ending)).collect();
        assert_eq!(names, files);
    }
    for frame in 0..frames {
        let read = match ending.as_str() {
            "obj" => Obj::read(&folder().join(format!("a.{frame:04}.obj"))).vertices,
            "ply" => Ply::read(&folder().join(format!("a.{frame:04}.ply"))).vectors(["x", "y", "z"]),
            _ => Vtp::read(&folder().join(format!("a/points.{frame:04}.vtp"))).vectors("Points"),
        };
        assert!(read == snapshot(POINTS, frame).positions, "frame {frame} of {}", path.display());
    }
}

/// What stops the file here is a limit of 2 MB on its size, with the signal that goes with it ignored.
#[test]
fn a_file_that_may_not_grow_keeps_the_whole_frames() {
    in_child("full_disk::child_under_a_size_limit", "trap '' XFSZ && ulimit -f 4096");
}

#[test]
#[ignore = "run by a_file_that_may_not_grow_keeps_the_whole_frames"]
fn child_under_a_size_limit() {
    let sentence = "cannot be written: it would become larger than a file may be here";
    let path = folder().join("a.csv");
    let frames = fill(CSV, &path, sentence);
    check_csv(&path, frames);

    for exporter in [PC2, MDD] {
        let path = folder().join("a").with_extension(exporter.ending);
        let frames = fill(exporter, &path, sentence);
        check_cache(&path, frames);
        std::fs::remove_file(path).expect("removed");
    }

    // An archive needs its arrays in one file, so here nothing can be kept, and nothing is left.
    let run = run_of(POINTS);
    let mut export = begin(NPZ, &folder().join("a.npz"), &run, 100).expect("these fit, each in its file");
    assert!((100..10_000).any(|frame| give(&mut *export, &run, frame).is_err()));
    let error = export.finish(&mut to_the_end).expect_err("too large together");
    assert_eq!(error.sentence(), sentence);
    assert_eq!(names_in(&folder()), ["a.csv"]);
}
