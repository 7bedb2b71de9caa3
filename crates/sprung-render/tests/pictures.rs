//! Pictures of hand-built scenes, at rest and deformed, compared to stored ones.
//!
//! `SPRUNG_UPDATE_PICTURES=1 cargo test -p sprung-render` draws the stored ones anew; look at them before committing.

mod scenes;
mod squares;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use sprung::Snapshot;
use sprung_io::{Frame, Heeds, Options, Written};
use sprung_render::export::{EXPORTERS, exporter_for};

use scenes::Motion;

/// The most that a channel of a pixel may differ, and the share of pixels that may differ more. The same arithmetic
/// runs everywhere, so this is slack for a compiler that orders a sum differently, not for a change of the drawing.
const TOLERANCE: u8 = 3;
const STRAY_SHARE: f64 = 0.001;

fn write(path: &Path, motion: &Motion, moments: &[Snapshot], options: &Options) -> sprung::Result<Written> {
    let mut output = (exporter_for(path)?.open)(path, &motion.info, options)?;
    for (index, snapshot) in moments.iter().enumerate() {
        let params = &motion.info.params;
        output.frame(&Frame { index: index as u64, snapshot, params, energy: None })?;
    }
    output.finish(&mut |_| ControlFlow::Continue(()))
}

fn compare(name: &str, motion: &Motion, at: f64) {
    let stored = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pictures").join(format!("{name}.png"));
    let drawn = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.png"));
    let options = Options { size: Some([320, 180]), at: Some(at), ..Options::default() };
    write(&drawn, motion, &motion.moments, &options).expect("the picture can be drawn");
    if squares::updates() {
        std::fs::create_dir_all(stored.parent().expect("it has a folder")).expect("the folder can be made");
        std::fs::copy(&drawn, &stored).expect("the picture can be stored");
    }
    let fix = "draw it anew with SPRUNG_UPDATE_PICTURES=1 and look at it";
    let Some(expected) = squares::read(&stored) else {
        panic!("there is no stored picture {}; {fix}", stored.display())
    };
    let found = squares::read(&drawn).expect("the drawn picture can be read");
    assert_eq!((found.width, found.height), (expected.width, expected.height), "size of {name}");
    let pixels = found.rgb.chunks_exact(3).zip(expected.rgb.chunks_exact(3));
    let stray = pixels.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > TOLERANCE)).count();
    let share = 3.0 * stray as f64 / expected.rgb.len() as f64;
    let (drawn, stored) = (drawn.display(), stored.display());
    assert!(share <= STRAY_SHARE, "{stray} pixels of {drawn} differ from {stored}; if that was meant, {fix}");
}

#[test]
fn spring() {
    let motion = scenes::spring(5);
    compare("spring-rest", &motion, 0.0);
    compare("spring-stretched", &motion, 9.0);
}

#[test]
fn chain() {
    compare("chain-bent", &scenes::chain(5), 0.14);
}

#[test]
fn jelly() {
    let motion = scenes::jelly(10, 5);
    compare("jelly-rest", &motion, 0.0);
    compare("jelly-sunken", &motion, 9.0);
}

#[test]
fn cloth() {
    let motion = scenes::cloth(20, 5);
    compare("cloth-rest", &motion, 0.0);
    compare("cloth-hanging", &motion, 9.0);
}

#[test]
fn large_models_show_their_surfaces() {
    compare("jelly-large", &scenes::jelly(32, 3), 9.0);
    compare("cloth-large", &scenes::cloth(150, 3), 9.0);
}

/// The size of all files in a folder and those in it.
fn bytes_below(folder: &Path) -> u64 {
    let entries = std::fs::read_dir(folder).expect("the folder is there");
    let bytes = |path: std::path::PathBuf| {
        if path.is_dir() { bytes_below(&path) } else { path.metadata().expect("it is there").len() }
    };
    entries.map(|entry| bytes(entry.expect("an entry").path())).sum()
}

#[test]
#[allow(clippy::print_stderr)]
fn every_exporter_keeps_its_promises() {
    let motion = scenes::cloth(8, 6);
    let options = Options { size: Some([64, 48]), ..Options::default() };
    for exporter in EXPORTERS {
        let folder = tempfile::tempdir().expect("a folder");
        let names = || {
            let entries = std::fs::read_dir(folder.path()).expect("the folder is there");
            let mut names: Vec<String> = entries
                .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
                .collect();
            names.sort();
            names
        };
        let path = folder.path().join(format!("out.{}", exporter.ending));
        let open = || (exporter.open)(&path, &motion.info, &options);
        if exporter.ending == "mp4" && open().is_err_and(|error| error.code() == sprung::Code::Unsupported) {
            assert_eq!(names(), Vec::<String>::new(), "refused before anything was written");
            assert!(std::env::var_os("CI").is_none(), "there is no ffmpeg to try .mp4 with");
            eprintln!("not tried: .mp4, as there is no ffmpeg");
            continue;
        }
        // Dropped unfinished it leaves nothing; completed it leaves its file alone.
        let mut output = open().expect("it can be begun");
        let frame =
            Frame { index: 0, snapshot: &motion.moments[0], params: &motion.info.params, energy: None };
        output.frame(&frame).expect("it takes a frame");
        assert!(names().contains(&format!("out.{}.partial", exporter.ending)), "{:?}", names());
        drop(output);
        assert_eq!(names(), Vec::<String>::new());
        let written = write(&path, &motion, &motion.moments, &options).expect("it can be written");
        let bytes = bytes_below(folder.path());
        assert_eq!(written.bytes, bytes, "{:?}", names());
        assert!(!names().iter().any(|name| name.ends_with(".partial")), "{:?}", names());
        // A folder that is not there is found before the run.
        let nowhere = folder.path().join("none").join(format!("out.{}", exporter.ending));
        assert!((exporter.open)(&nowhere, &motion.info, &options).is_err());
        if !exporter.heeds.contains(&Heeds::Size) {
            continue;
        }
        assert_eq!((names(), written.path), (vec![format!("out.{}", exporter.ending)], path.clone()));
        // Broken off while it is drawn it leaves nothing, and what was there before stays.
        let mut output = open().expect("it can be begun");
        output.frame(&frame).expect("it takes a frame");
        let error = output.finish(&mut |_| ControlFlow::Break(())).expect_err("broken off");
        let sentence = format!("interrupted while {} was being drawn; it is not kept", path.display());
        assert_eq!((error.code(), error.to_string()), (sprung::Code::Interrupted, sentence));
        assert_eq!(names(), [format!("out.{}", exporter.ending)]);
        assert_eq!(std::fs::metadata(&path).expect("it is there").len(), bytes);
        // A picture of no frame at all cannot be made.
        assert!(write(&path, &motion, &[], &options).is_err());
        let tiny = Options { size: Some([3, 3]), ..Options::default() };
        assert!((exporter.open)(&path, &motion.info, &tiny).is_err());
    }
}

#[test]
fn a_gif_plays_back_what_was_drawn() {
    let motion = scenes::jelly(5, 15);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("out.gif");
    let options = Options { size: Some([160, 90]), ..Options::default() };
    write(&path, &motion, &motion.moments, &options).expect("it can be written");
    let file = std::fs::File::open(&path).expect("it was written");
    let mut reader = gif::DecodeOptions::new().read_info(file).expect("it is a GIF");
    assert_eq!((reader.width(), reader.height(), reader.repeat()), (160, 90, gif::Repeat::Infinite));
    let mut delays = Vec::new();
    while let Some(frame) = reader.read_next_frame().expect("whole frames") {
        delays.push(frame.delay);
    }
    assert_eq!(delays, vec![11; 15]);
}

#[test]
fn a_picture_is_the_same_twice_and_on_one_thread() {
    let motion = scenes::jelly(6, 3);
    let size = [200, 120];
    let mut extent = sprung_render::Motion::new(&motion.info, size);
    for moment in &motion.moments {
        extent.include(&motion.info.model, &motion.info.params, &moment.positions);
    }
    let view = sprung_render::SceneView::new(&motion.info, &extent, sprung_render::Quality::Motion);
    let draw = || view.picture(&motion.info.params, 1.0, &motion.moments[1].positions);
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    assert_eq!(draw(), one.install(draw));
}
