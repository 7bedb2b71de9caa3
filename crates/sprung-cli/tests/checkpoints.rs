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
    assert!(said.contains("× 5 substeps = 0.0416667 s per frame"), "{said}");
    let [said, _] = sprung(folder.path(), &["show", "a.sprung", "--json"]);
    assert!(said.contains("\"substeps\": 5,\n  \"frame_time\": 0.04166"), "{said}");
}
