//! An output of a run that was killed goes on from its mark to the same bytes: every format that says it can.

use std::fs;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::Path;

use sprung::scene::Scene;
use sprung::{Code, Energy, Result, Simulation};
use sprung_io::{Export, Exporter, Frame, Heeds, Mark, Options, RunInfo};
use sprung_render::export::EXPORTERS;
use sprung_render::plot::EnergyPlot;

const FRAMES: u64 = 14;

fn resumable() -> impl Iterator<Item = &'static Exporter> {
    EXPORTERS.iter().filter(|exporter| exporter.resume.is_some())
}

fn simulation() -> Simulation {
    Scene::builtin("cloth").and_then(|scene| scene.simulation()).expect("it is built in")
}

fn info() -> RunInfo {
    let simulation = simulation();
    RunInfo {
        scene: "cloth".into(),
        title: "A cloth".into(),
        model: simulation.model().clone(),
        params: simulation.params().clone(),
        frame_time: 0.07,
        frames: FRAMES,
    }
}

fn options() -> Options {
    Options { size: Some([64, 48]), resumable: true, ..Options::default() }
}

/// Gives the frames of this range, as a run that begins with the first of them would.
fn give(export: &mut dyn Export, frames: std::ops::Range<u64>) -> Result<()> {
    let mut simulation = simulation();
    for index in 0..frames.end {
        if index >= frames.start {
            let params = simulation.params().clone();
            let snapshot = simulation.snapshot();
            export.frame(&Frame { index, snapshot, params: &params, energy: None })?;
        }
        simulation.frame()?;
    }
    Ok(())
}

fn finish(export: Box<dyn Export>) -> u64 {
    export.finish(&mut |_| ControlFlow::Continue(())).expect("it is completed").frames
}

/// The run without an interruption, in a folder of its own: what it leaves.
fn undisturbed(exporter: &Exporter, options: &Options) -> Vec<(String, Vec<u8>)> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(format!("a.{}", exporter.ending));
    let options = Options { resumable: false, ..options.clone() };
    let mut export = (exporter.open)(&path, &info(), &options).expect("begun");
    give(&mut *export, 0..FRAMES).expect("written");
    finish(export);
    tree(folder.path())
}

/// All files in a folder and those below it, by name, with what they hold.
fn tree(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder is there") {
        let path = entry.expect("readable").path();
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        if path.is_dir() {
            files.extend(tree(&path).into_iter().map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
        } else {
            files.push((name, fs::read(&path).expect("readable")));
        }
    }
    files.sort();
    files
}

fn names(files: &[(String, Vec<u8>)]) -> Vec<&str> {
    files.iter().map(|(name, _)| name.as_str()).collect()
}

fn resume(exporter: &Exporter, path: &Path, mark: &Mark) -> Result<Box<dyn Export>> {
    exporter.resume.expect("it can be resumed")(path, &info(), &options(), mark)
}

/// The error of what must not go on.
fn refused(exporter: &Exporter, path: &Path, mark: &Mark) -> sprung::Error {
    match resume(exporter, path, mark) {
        Ok(_) => panic!(".{} goes on", exporter.ending),
        Err(error) => error,
    }
}

#[test]
fn what_follows_the_mark_is_forgotten_and_the_rest_goes_on_to_the_same_bytes() {
    for exporter in resumable() {
        let expected = undisturbed(exporter, &options());
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join(format!("a.{}", exporter.ending));
        for cut in [0, 1, 5, FRAMES] {
            let mut export = (exporter.open)(&path, &info(), &options()).expect("begun");
            give(&mut *export, 0..cut).expect("written");
            let mark = export.mark().expect("marked");
            assert_eq!(mark.frames, cut);
            give(&mut *export, cut..FRAMES.min(cut + 3)).expect("written");
            // As after a kill: what a checkpoint relies on stays.
            drop(export);

            let mut export = resume(exporter, &path, &mark).expect("it goes on");
            assert_eq!(export.mark().expect("marked again"), mark, ".{}", exporter.ending);
            give(&mut *export, cut..FRAMES - FRAMES.min(2)).expect("written");
            // Twice.
            let later = export.mark().expect("marked");
            drop(export);
            let mut export = resume(exporter, &path, &later).expect("it goes on");
            give(&mut *export, later.frames..FRAMES).expect("written");
            let frames = finish(export);
            assert!(frames == FRAMES || exporter.ending == "png", "{frames} frames");
            let found = tree(folder.path());
            assert_eq!(names(&found), names(&expected));
            assert!(found == expected, ".{} differs", exporter.ending);
        }
    }
}

/// What is kept of a format that shows one moment is the best until the mark, or comes after it.
#[test]
fn a_moment_before_or_after_the_mark_is_found() {
    for exporter in resumable().filter(|exporter| exporter.heeds.contains(&Heeds::At)) {
        for at in [0.0, 0.3, 0.9] {
            let options = Options { at: Some(at), ..options() };
            let expected = undisturbed(exporter, &options);
            let folder = tempfile::tempdir().expect("a temporary folder");
            let path = folder.path().join(format!("a.{}", exporter.ending));
            let mut export = (exporter.open)(&path, &info(), &options).expect("begun");
            give(&mut *export, 0..6).expect("written");
            let mark = export.mark().expect("marked");
            assert_eq!(mark.frames, 6);
            give(&mut *export, 6..8).expect("written");
            drop(export);
            let resume = exporter.resume.expect("it can be resumed");
            let mut export = resume(&path, &info(), &options, &mark).expect("it goes on");
            assert_eq!(export.mark().expect("marked again"), mark, ".{}", exporter.ending);
            give(&mut *export, 6..FRAMES).expect("written");
            assert_eq!(finish(export), 1);
            assert!(tree(folder.path()) == expected, ".{} differs at {at} s", exporter.ending);
        }
    }
}

#[test]
fn what_is_not_the_runs_own_is_refused_and_stays() {
    for exporter in resumable() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join(format!("a.{}", exporter.ending));
        let mut export = (exporter.open)(&path, &info(), &options()).expect("begun");
        give(&mut *export, 0..3).expect("written");
        let mark = export.mark().expect("marked");

        let error = refused(exporter, &path, &mark);
        assert!(error.to_string().contains("being written"), "{error}");
        drop(export);

        // Each of its files, cut and changed.
        for file in mark.files.iter().filter(|file| file.bytes > file.head) {
            let dot = if file.part.is_empty() { "" } else { "." };
            let partial = folder.path().join(format!("a.{}{dot}{}.partial", exporter.ending, file.part));
            let whole = fs::read(&partial).expect("it stayed");
            let mut changed = whole.clone();
            *changed.last_mut().expect("it is not empty") ^= 1;
            fs::write(&partial, &changed).expect("written");
            let error = refused(exporter, &path, &mark);
            assert_eq!(error.code(), Code::Unreadable);
            assert!(error.to_string().ends_with("is not what this run had written"), "{error}");
            assert_eq!(fs::read(&partial).expect("it stays"), changed);
            fs::write(&partial, &whole[..whole.len() - 1]).expect("written");
            let error = refused(exporter, &path, &mark);
            assert!(error.to_string().contains("bytes that the run had written"), "{error}");
            fs::remove_file(&partial).expect("removed");
            let error = refused(exporter, &path, &mark);
            assert!(error.to_string().ends_with("is not there"), "{error}");
            fs::write(&partial, &whole).expect("written");
        }
        // Marks that no such format makes.
        for strange in [
            Mark::default(),
            Mark { frames: mark.frames + 1, ..mark.clone() },
            Mark { memory: vec![255; 9], ..mark.clone() },
        ] {
            // Of a table of text the number of frames is not seen.
            let goes_on = resume(exporter, &path, &strange).is_ok();
            assert!(
                !goes_on
                    || strange.files.len() == 1 && strange.memory == mark.memory
                    || strange.memory.len() == 9,
                ".{}",
                exporter.ending
            );
        }
        finish(resume(exporter, &path, &mark).expect("it goes on all the same"));
    }
}

#[test]
fn the_energy_plot_goes_on_too() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let samples: Vec<(f64, Energy)> = {
        let mut simulation = simulation();
        let mut sample = |_| {
            simulation.frame().expect("it is stable");
            (simulation.now().1, simulation.energy())
        };
        (0..10).map(&mut sample).collect()
    };
    for name in ["a.svg", "a.png"] {
        let path = folder.path().join(name);
        EnergyPlot::begin(&path).and_then(|plot| plot.finish("a", &samples)).expect("written");
        let expected = fs::read(&path).expect("it is there");
        let mut plot = EnergyPlot::begin(&path).expect("begun");
        let mark = plot.mark(&samples[..4]).expect("marked");
        drop(plot);
        let (plot, mut read) = EnergyPlot::resume(&path, &mark).expect("it goes on");
        assert_eq!(read, samples[..4]);
        read.extend_from_slice(&samples[4..]);
        plot.finish("a", &read).expect("written");
        assert_eq!(fs::read(&path).expect("it is there"), expected);
    }
    assert_eq!(fs::read_dir(folder.path()).map(Iterator::count).ok(), Some(2));
}

#[test]
fn a_file_that_was_begun_again_is_not_taken_for_the_old_one() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.csv");
    let csv = &sprung_io::export::CSV;
    let mut export = (csv.open)(&path, &info(), &options()).expect("begun");
    give(&mut *export, 0..5).expect("written");
    let mark = export.mark().expect("marked");
    drop(export);
    // Another run to the same name, killed as well; it has the same length.
    let partial = folder.path().join("a.csv.partial");
    let mut bytes = fs::read(&partial).expect("it stayed");
    bytes[100] ^= 2;
    fs::File::create(&partial).and_then(|mut file| file.write_all(&bytes)).expect("written");
    assert!(refused(csv, &path, &mark).to_string().contains("not what this run had written"));
}
