//! Checkpoints that are none, are damaged, or do not fit: one sentence, status 2, and what is there stays there.
#![cfg(unix)]
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::Command;

use tempfile::TempDir;

fn sprung(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let output =
        Command::new(env!("CARGO_BIN_EXE_sprung")).current_dir(folder).args(arguments).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

/// Runs, expects status 2 and one line, and gives it.
fn complaint(folder: &Path, arguments: &[&str]) -> String {
    let (status, said) = sprung(folder, arguments);
    assert_eq!(status, Some(2), "{arguments:?}: {said}");
    let line = said.strip_suffix("Try `sprung --help`.\n").unwrap_or(&said).trim_end().to_owned();
    assert!(!line.contains('\n'), "{arguments:?} said more than one line: {said}");
    line.strip_prefix("sprung: ").unwrap().to_owned()
}

/// A run that was killed after its first checkpoint: ten frames, of which one is recorded.
fn killed(folder: &Path) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_sprung"))
        .current_dir(folder)
        .args(["run", "jelly", "--frames", "100000", "-q", "-o", "a.csv", "--checkpoint", "a.sprung"])
        .spawn()
        .unwrap();
    while !folder.join("a.sprung").exists() {
        assert!(child.try_wait().unwrap().is_none());
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn what_is_no_checkpoint_or_damaged() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    killed(folder.path());
    let whole = fs::read(at("a.sprung")).unwrap();
    let all = |name: &str| {
        let lines = [&["run", "--resume", name][..], &["show", name], &["run", name, "-o", "b.csv"]]
            .map(|arguments| complaint(folder.path(), arguments));
        // How much memory is available is another number from moment to moment.
        let said = |line: &str| line.split(", and ").next().unwrap_or_default().to_owned();
        assert!(lines.iter().all(|line| said(line) == said(&lines[0])), "{lines:?}");
        lines[0].clone()
    };
    assert_eq!(all("none.sprung"), "none.sprung: there is no such file");
    fs::write(at("text.sprung"), "[[body]]\nname = \"a\"\n").unwrap();
    assert_eq!(all("text.sprung"), "text.sprung: is no checkpoint: it does not begin like one");
    fs::write(at("cut.sprung"), &whole[..whole.len() / 2]).unwrap();
    let line = all("cut.sprung");
    assert!(
        line.starts_with("cut.sprung: is damaged: the section `") && line.contains("is cut off"),
        "{line}"
    );
    let mut flipped = whole.clone();
    flipped[whole.len() / 3] ^= 4;
    fs::write(at("flipped.sprung"), flipped).unwrap();
    let line = all("flipped.sprung");
    assert!(line.ends_with("does not match its checksum"), "{line}");
    fs::create_dir(at("folder.sprung")).unwrap();
    assert_eq!(all("folder.sprung"), "folder.sprung: is a folder, and must be a file");
    assert!(Command::new("mkfifo").arg(at("pipe.sprung")).status().unwrap().success());
    assert_eq!(all("pipe.sprung"), "pipe.sprung: is a pipe or a device, and must be an ordinary file");
    let large = fs::File::create(at("large.sprung")).unwrap();
    large.set_len(1 << 42).unwrap();
    let line = all("large.sprung");
    assert!(line.starts_with("large.sprung: the checkpoint needs about"), "{line}");
    assert!(line.ends_with("; free some, or go on with it on a machine that has more"), "{line}");
    assert!(!at("b.csv").exists() && !at("b.csv.partial").exists());
    assert_eq!(fs::read(at("a.sprung")).unwrap(), whole);
}

#[test]
fn runs_that_cannot_be_gone_on_with() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    killed(folder.path());
    let run = |arguments: &[&str]| complaint(folder.path(), arguments);
    let resume = ["run", "--resume", "a.sprung"];

    // The partial file is another run's, too short, or gone: nothing is touched.
    let partial = fs::read(at("a.csv.partial")).unwrap();
    let mut changed = partial.clone();
    changed[40] ^= 1;
    fs::write(at("a.csv.partial"), &changed).unwrap();
    let line = run(&resume);
    assert!(
        line.starts_with("a.csv: cannot be gone on with: ") && line.contains("not what this run"),
        "{line}"
    );
    assert_eq!(fs::read(at("a.csv.partial")).unwrap(), changed);
    fs::write(at("a.csv.partial"), &partial[..100]).unwrap();
    assert!(run(&resume).contains("has 100 of the"), "{}", run(&resume));
    fs::rename(at("a.csv.partial"), at("elsewhere")).unwrap();
    let line = run(&resume);
    assert!(line.contains("a.csv.partial is not there; the run was started in "), "{line}");
    fs::write(at("a.csv.partial"), &partial).unwrap();

    // Options that the checkpoint has already.
    for more in [&["--fps", "25"][..], &["-o", "b.csv"], &["--set", "dt=0.01"], &["--checkpoint", "b.sprung"]]
    {
        let line = run(&[&resume[..], more].concat());
        assert!(line.contains("--resume"), "{line}");
    }
    assert!(run(&["run", "a.sprung", "--set", "dt=0.01"]).contains("leave it out"));
    assert!(run(&["bench", "a.sprung"]).contains("is a checkpoint"));
    // The same command again, and one whose checkpoint would take its place.
    let line = run(&["run", "jelly", "-o", "a.csv", "--checkpoint", "a.sprung"]);
    assert!(line.contains("can be completed; `sprung run --resume a.sprung` does that"), "{line}");
    fs::write(at("precious.sprung"), "precious").unwrap();
    let line = run(&["run", "jelly", "--checkpoint", "precious.sprung"]);
    assert!(line.starts_with("precious.sprung: is there already, and is no checkpoint"), "{line}");
    assert_eq!(fs::read(at("precious.sprung")).unwrap(), b"precious");

    // After all that it is completed.
    let (status, said) = sprung(folder.path(), &["run", "--resume", "a.sprung", "--frames", "20"]);
    assert_eq!(status, Some(0), "{said}");
    let line = run(&["run", "--resume", "a.sprung", "--frames", "30"]);
    assert!(line.contains("holds a run that is over"), "{line}");
    // And its last state is the first frame of another.
    let (status, said) = sprung(folder.path(), &["run", "a.sprung", "-o", "b.csv", "--frames", "2"]);
    assert_eq!(status, Some(0), "{said}");
    let [a, b] = ["a.csv", "b.csv"].map(|name| fs::read_to_string(at(name)).unwrap());
    let cells = |line: &str| line.split_once(',').unwrap().1.to_owned();
    assert_eq!(b.lines().nth(1000).map(cells), a.lines().last().map(cells), "the same time, place and speed");
}

#[test]
fn checkpoints_that_cannot_be_written() {
    let folder = TempDir::new().unwrap();
    let run = |name: &str, more: &[&str]| {
        let arguments = [&["run", "spring", "--frames", "3", "--checkpoint", name][..], more].concat();
        complaint(folder.path(), &arguments)
    };
    assert!(run("a.txt", &[]).contains("ends with .sprung"));
    assert_eq!(run("none/a.sprung", &[]), "none/a.sprung: cannot be written: its folder does not exist");
    fs::create_dir(folder.path().join("f.sprung")).unwrap();
    assert!(run("f.sprung", &[]).starts_with("f.sprung: cannot be written: it is a folder"));
    assert!(run("a.sprung", &["-o", "a.mp4"]).contains("a .mp4 cannot be gone on with"));
    assert!(run("a.sprung", &["--every", "never"]).contains("--every"));
    assert!(run("a.sprung", &["--every", "0"]).ends_with("a number of frames must be from 1 to 100,000,000"));
    for time in ["-3s", "0s", "0.9ms", "1e-9s", "1001h", "1e300h"] {
        let line = run("a.sprung", &[&format!("--every={time}")]);
        assert!(line.ends_with("a time must be from 1ms to 1000h, such as 30s"), "{line}");
    }
    let line = complaint(folder.path(), &["run", "spring", "--every", "3s"]);
    assert!(line.starts_with("--every: is of no use without a checkpoint"), "{line}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}
