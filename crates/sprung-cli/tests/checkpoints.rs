//! Runs with checkpoints and from them: what is said, and what is left to do.
#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::process::Command;

use tempfile::TempDir;

/// Runs, expects that all is well, and gives what was said on standard output and on standard error.
fn sprung(folder: &Path, arguments: &[&str]) -> [String; 2] {
    let output =
        Command::new(env!("CARGO_BIN_EXE_sprung")).current_dir(folder).args(arguments).output().unwrap();
    let said = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    assert!(output.status.success(), "{arguments:?}: {said:?}");
    said
}

#[test]
fn another_run_from_a_checkpoint_has_its_frames_and_counts_its_own_steps() {
    let folder = TempDir::new().unwrap();
    // A frame of 1/24 s takes five steps of 1/120 s; the scene's own would be of other length.
    let first = ["run", "spring", "--fps", "24", "--seconds", "2", "-o", "a.csv", "--checkpoint", "a.sprung"];
    let [said, _] = sprung(folder.path(), &first);
    assert!(said.contains("spring: 49 frames, 240 steps, 2 s simulated in "), "{said}");
    let [said, _] = sprung(folder.path(), &["run", "a.sprung", "--seconds", "1", "-o", "b.csv"]);
    assert!(said.contains("spring: 25 frames, 120 steps, 1 s simulated in "), "{said}");
    let [said, _] = sprung(folder.path(), &["show", "a.sprung"]);
    assert!(said.contains("recorded             all 49 frames; the run is over\n"), "{said}");
    assert!(said.contains("× 5 substeps = 0.0416667 s per frame"), "{said}");
    let [said, _] = sprung(folder.path(), &["show", "a.sprung", "--json"]);
    assert!(said.contains("\"substeps\": 5,\n  \"frame_time\": 0.04166"), "{said}");
}

/// A run that was killed after its second checkpoint, one of which it takes every so many frames.
fn killed_after(folder: &Path, frames: u64) {
    let begun = ["run", "chain", "--frames", "1000000", "-q", "-o", "a.csv", "--checkpoint", "a.sprung"];
    let every = format!("--every={frames}");
    let mut child = Command::new(env!("CARGO_BIN_EXE_sprung"))
        .current_dir(folder)
        .args(begun)
        .arg(every)
        .spawn()
        .unwrap();
    let recorded = || {
        let shown = Command::new(env!("CARGO_BIN_EXE_sprung"))
            .current_dir(folder)
            .args(["show", "a.sprung", "--json"])
            .output()
            .unwrap();
        String::from_utf8(shown.stdout).unwrap().contains("\"recorded_frames\": 1,")
    };
    while !folder.join("a.sprung").exists() || recorded() {
        assert!(child.try_wait().unwrap().is_none());
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn what_is_there_and_what_was_asked_for_is_said() {
    let folder = TempDir::new().unwrap();
    killed_after(folder.path(), 1000);
    let [said, _] = sprung(folder.path(), &["show", "a.sprung"]);
    let recorded = said.lines().find_map(|line| line.trim().strip_prefix("recorded ")).unwrap().trim();
    let there = recorded.strip_suffix(" of the 1,000,001 frames asked for").unwrap();
    let count: u64 = there.replace(',', "").parse().unwrap();
    let refused = ["run", "--resume", "a.sprung", "--frames", "3"];
    let output =
        Command::new(env!("CARGO_BIN_EXE_sprung")).current_dir(folder.path()).args(refused).output().unwrap();
    assert_eq!(
        String::from_utf8(output.stderr).unwrap(),
        format!(
            "sprung: a.sprung: holds a run up to frame {}, so that it cannot end with frame 3; choose a later end\n",
            count - 1
        )
    );
    let end = (count + 9).to_string();
    let [said, noted] = sprung(folder.path(), &["run", "--resume", "a.sprung", "--frames", &end]);
    let all = said.split_once(" in all)").unwrap().0;
    assert!(noted.starts_with(&format!("Going on with a.sprung, which has {there} of the ")), "{noted}");
    assert!(all.starts_with("chain: 10 more frames ("), "{said}");
    let [said, _] = sprung(folder.path(), &["run", "--resume", "a.sprung"]);
    assert!(said.ends_with("there is nothing left to do\n"), "{said}");
}
