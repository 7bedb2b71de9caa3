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
        let endless = [&["run", &scene, "--frames", "200000", "--quiet"][..], &outputs].concat();
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

#[test]
fn show_says_how_large_a_scene_is_and_what_became_of_its_meshes() {
    let folder = TempDir::new().unwrap();
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    fs::write(folder.path().join("cube.obj"), cube).unwrap();
    let scene = "[[plane]]\ny = 0\nstiffness = 1e5\n[[body]]\nname = \"jelly\"\nmesh = \"cube.obj\"\nscale = 0.5\n\
                 soft = { spacing = 0.25, density = 100, stiffness = 1000 }\n";
    fs::write(folder.path().join("jelly.toml"), scene).unwrap();
    let output = sprung(folder.path(), &["show", "jelly.toml"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    for line in [
        "  size                 0.5 × 0.5 × 0.5 m\n",
        "  mesh                 cube.obj as soft body jelly: 27 points, 126 springs\n",
        // A corner has the eighth part of a cell: 100 kg/m³ · (0.25 m)³/8.
        "set by the contact of point 0 of jelly (0.195312 kg) with a plane of stiffness 100000 N/m\n",
        "  for longer steps     a lower plane.stiffness, or a heavier point 0 of jelly: points of jelly have 0.462963 kg in the \
         mean; a larger body.jelly.soft.spacing makes all its points heavier\n",
    ] {
        assert!(said.contains(line), "{line}{said}");
    }
    let output = sprung(folder.path(), &["show", "jelly.toml", "--json"]);
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(answer["size"], serde_json::json!([0.5, 0.5, 0.5]));
    let mesh = &answer["meshes"][0];
    assert_eq!((mesh["becomes"].as_str(), mesh["points"].as_u64()), (Some("soft"), Some(27)));
    let setter = answer["dt_limit_every_configuration_set_by"].as_str().unwrap();
    assert!(setter.starts_with("the contact of point 0 of jelly (0.195312 kg)"), "{setter}");
}
