//! A checkpoint of a scene with meshes holds these: a run that was killed is completed to the same bytes without their files.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;

const OUTPUTS: [&str; 3] = ["a.npz", "a.pc2", "a.ply"];

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sprung"));
    command.current_dir(folder).args(arguments);
    command
}

fn sprung(folder: &Path, arguments: &[&str]) -> Output {
    let output = command(folder, arguments).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    output
}

fn copied(name: &str, ending: &str, folder: &Path) -> std::path::PathBuf {
    let file = format!("{name}.{ending}");
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    fs::copy(examples.join(&file), folder.join(&file)).unwrap();
    folder.join(file)
}

fn bytes_in(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let outputs = entries.filter(|path| !["toml", "sprung"].iter().any(|e| path.extension().unwrap() == *e));
    let named = |path: std::path::PathBuf| {
        (path.file_name().unwrap().to_str().unwrap().to_owned(), fs::read(path).unwrap())
    };
    let mut files: Vec<_> = outputs.map(named).collect();
    files.sort();
    files
}

#[test]
fn a_checkpoint_needs_no_mesh_file() {
    let outputs: Vec<&str> = OUTPUTS.iter().flat_map(|name| ["-o", name]).collect();
    for name in ["towel", "pebble", "hammock"] {
        let scene = format!("{name}.toml");
        let whole = TempDir::new().unwrap();
        copied(name, "toml", whole.path());
        let mesh = copied(name, "obj", whole.path());
        let run = [&["run", &scene, "--frames", "60", "--quiet"][..], &outputs].concat();
        sprung(whole.path(), &run);
        fs::remove_file(mesh).unwrap();

        // Killed after its first checkpoint at the earliest, before its last frame.
        let folder = TempDir::new().unwrap();
        let checkpoint = folder.path().join("a.sprung");
        copied(name, "toml", folder.path());
        let mesh = copied(name, "obj", folder.path());
        let endless = [&["run", &scene, "--frames", "1000000", "--quiet"][..], &outputs].concat();
        let mut child = command(folder.path(), &endless);
        let mut child = child.args(["--checkpoint", "a.sprung", "--every", "1000000"]).spawn().unwrap();
        while !checkpoint.exists() {
            assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        fs::remove_file(mesh).unwrap();
        fs::remove_file(folder.path().join(&scene)).unwrap();

        let shown = String::from_utf8(sprung(folder.path(), &["show", "a.sprung"]).stdout).unwrap();
        assert!(shown.starts_with(&format!("{name}: ")), "{shown}");
        sprung(
            folder.path(),
            &["run", "--resume", "a.sprung", "--frames", "60", "--quiet", "--threads", "2"],
        );
        let (found, expected) = (bytes_in(folder.path()), bytes_in(whole.path()));
        for (file, bytes) in &found {
            let other = expected.iter().find(|(name, _)| name == file);
            assert!(other.is_some_and(|(_, other)| other == bytes), "{name}: {file} differs");
        }
        assert_eq!(found.len(), 2 + 61);
        // And its last state is the first of another run.
        sprung(folder.path(), &["run", "a.sprung", "--frames", "2", "--quiet", "-o", "b.csv"]);
    }
}
