//! Outputs of many files, in a run that is gone on with: what is complete is left alone, and the rest is completed.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, SystemTime};

use tempfile::TempDir;

const OUTPUTS: &[&str] = &["-o", "a.obj", "-o", "a.ply", "-o", "a.pvd", "-o", "a.csv"];
const RESUME: &[&str] = &["run", "--resume", "a.sprung"];

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sprung"));
    command.current_dir(folder).args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn sprung(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().unwrap()
}

fn said(output: &Output) -> [String; 2] {
    [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned())
}

/// Every file below a folder but for the checkpoint: its name, when it was written, and what is in it.
fn files_in(folder: &Path) -> Vec<(String, SystemTime, Vec<u8>)> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap()) {
        let (path, name) = (entry.path(), entry.file_name().into_string().unwrap());
        if path.is_dir() {
            files.extend(
                files_in(&path)
                    .into_iter()
                    .map(|(below, when, all)| (name.clone() + "/" + &below, when, all)),
            );
        } else if !name.starts_with("a.sprung") {
            files.push((name, entry.metadata().unwrap().modified().unwrap(), fs::read(path).unwrap()));
        }
    }
    files.sort();
    files
}

fn finished(folder: &Path) {
    let run = ["run", "cloth", "--frames", "4", "--quiet", "--checkpoint", "a.sprung"];
    let output = sprung(folder, &[&run, OUTPUTS].concat());
    assert!(output.status.success(), "{:?}", said(&output));
}

#[test]
fn what_is_complete_is_left_alone() {
    let folder = TempDir::new().unwrap();
    finished(folder.path());
    let before = files_in(folder.path());
    assert_eq!(before.len(), 5 + 5 + (1 + 2 * 5) + 1);
    let output = sprung(folder.path(), RESUME);
    assert!(output.status.success());
    let over = "cloth: the run is over and its files are complete; there is nothing left to do\n";
    assert_eq!(said(&output)[0], over);
    assert!(files_in(folder.path()) == before);

    // Killed when the first sequence was being completed: its name is still held, and an earlier and longer run has left
    // a file behind its end.
    let at = |name: &str| folder.path().join(name);
    fs::write(at("a.obj.partial"), "").unwrap();
    fs::write(at("a.0005.obj"), "old").unwrap();
    let output = sprung(folder.path(), RESUME);
    assert!(output.status.success());
    let [_, notes] = said(&output);
    assert_eq!(notes.matches("is complete already").count(), 3, "{notes}");
    assert!(
        notes.contains("a.pvd is complete already.\n") && notes.contains("Wrote a.####.obj: 5 frames"),
        "{notes}"
    );
    assert!(files_in(folder.path()) == before);
}

#[test]
fn a_sequence_that_lacks_a_file_is_not_gone_on_with() {
    let folder = TempDir::new().unwrap();
    finished(folder.path());
    let at = |name: &str| folder.path().join(name);
    fs::rename(at("a.0002.obj"), at("b.obj")).unwrap();
    let before = files_in(folder.path());
    for _ in 0..2 {
        let output = sprung(folder.path(), RESUME);
        assert_eq!(output.status.code(), Some(2));
        let [_, line] = said(&output);
        assert!(line.starts_with("sprung: a.obj: cannot be gone on with: a.0002.obj is not there"), "{line}");
        assert!(files_in(folder.path()) == before);
    }
    fs::write(at("a.0002.obj"), "v 0 0 0\n").unwrap();
    let [_, line] = said(&sprung(folder.path(), RESUME));
    assert!(line.contains("a.obj: cannot be gone on with: its files have"), "{line}");
    fs::rename(at("b.obj"), at("a.0002.obj")).unwrap();
    assert!(said(&sprung(folder.path(), RESUME))[0].contains("nothing left to do"));
}

#[test]
fn a_run_that_is_killed_is_completed_to_the_same_bytes() {
    let run = ["run", "cloth", "--frames", "40", "--quiet"];
    let whole = TempDir::new().unwrap();
    assert!(sprung(whole.path(), &[&run, OUTPUTS].concat()).status.success());
    let content = |folder: &Path| -> Vec<(String, Vec<u8>)> {
        files_in(folder).into_iter().map(|(name, _, all)| (name, all)).collect()
    };
    let expected = content(whole.path());
    for kill in 0..5 {
        let folder = TempDir::new().unwrap();
        let more = ["--checkpoint", "a.sprung", "--every", "3"];
        let mut child = command(folder.path(), &[&run, OUTPUTS, &more].concat()).spawn().unwrap();
        // When so many frames are there, and then some; or when it has ended by itself.
        let frame = folder.path().join(format!("a.{:04}.obj", 8 * kill + 3));
        while !frame.exists() && child.try_wait().unwrap().is_none() {
            std::thread::yield_now();
        }
        std::thread::sleep(Duration::from_millis(7 * kill));
        child.kill().unwrap();
        child.wait().unwrap();
        let output = sprung(folder.path(), RESUME);
        assert!(output.status.success(), "{:?}", said(&output));
        let found = content(folder.path());
        let names =
            |files: &[(String, Vec<u8>)]| files.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
        assert_eq!(names(&found), names(&expected));
        assert!(found == expected, "kill {kill}");
    }
}
