//! What `sprung run` says of outputs before it writes them, and the options that choose what is written.
#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;

fn sprung(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_sprung")).current_dir(folder).args(arguments).output().unwrap()
}

fn said(output: &Output) -> [String; 2] {
    [&output.stdout, &output.stderr].map(|bytes| String::from_utf8(bytes.clone()).unwrap())
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// An output for each ending.
fn outputs(endings: &[&str]) -> Vec<String> {
    endings.iter().flat_map(|ending| ["-o".to_owned(), format!("a.{ending}")]).collect()
}

fn run(folder: &Path, arguments: &[&str], endings: &[&str]) -> Output {
    let outputs = outputs(endings);
    let all: Vec<&str> = arguments.iter().copied().chain(outputs.iter().map(String::as_str)).collect();
    sprung(folder, &all)
}

#[test]
fn a_dry_run_tells_the_very_sizes_and_writes_nothing() {
    let folder = TempDir::new().unwrap();
    let exact = ["npz", "pc2", "mdd"];
    let arguments = ["run", "cloth", "--frames", "9", "--dry-run"];
    let output = run(folder.path(), &arguments, &["npz", "pc2", "mdd", "ply", "csv", "pvd", "png"]);
    let [told, warned] = said(&output);
    assert!(output.status.success() && warned.is_empty(), "{warned}");
    assert!(names(folder.path()).is_empty());
    assert!(told.starts_with("cloth: 10 frames, 63 steps of 0.01 s, 0.63 s simulated\n"), "{told}");
    assert!(told.contains("a.csv: 10 frames, about "), "{told}");
    assert!(told.contains("a.png: 1 frame, about "), "{told}");
    for (more, line) in [(&[][..], "a.glb: 10 frames, about "), (&["--at", "0.2"], "a.glb: 1 frame, about ")]
    {
        let output = run(folder.path(), &[&arguments[..], more].concat(), &["glb"]);
        assert!(said(&output)[0].contains(line), "{}", said(&output)[0]);
    }

    run(folder.path(), &["run", "cloth", "--frames", "9", "--quiet"], &exact);
    for ending in exact {
        let bytes = std::fs::metadata(folder.path().join(format!("a.{ending}"))).unwrap().len();
        let line = format!("a.{ending}: 10 frames, {:.1} kB\n", bytes as f64 / 1e3);
        assert!(told.contains(&line), "{line} in {told}");
    }
}

#[test]
fn a_dry_run_refuses_what_a_run_refuses() {
    let folder = TempDir::new().unwrap();
    std::fs::create_dir(folder.path().join("folder.obj")).unwrap();
    for (output, sentence) in [
        ("none/a.obj", "its folder does not exist"),
        ("folder.obj", "it is a folder"),
        ("a.xyz", "the endings that can be written are"),
    ] {
        let output = sprung(folder.path(), &["run", "cloth", "--dry-run", "-o", output]);
        assert_eq!(output.status.code(), Some(2));
        assert!(said(&output)[1].contains(sentence), "{}", said(&output)[1]);
    }
}

/// Frames that lie far apart or close together, and no rate was asked for.
#[test]
fn a_better_pace_is_suggested() {
    let folder = TempDir::new().unwrap();
    let smoother = "Frames are 0.07 s apart; --fps 25 makes a smoother film.\n";
    let fewer = "Frames are 0.005 s apart; --fps 24 makes fewer of them.\n";
    let fine: &[&str] = &["--set", "dt=0.005", "--set", "substeps=1"];
    for (arguments, ending, note) in [
        (&[][..], "gif", smoother),
        (&[], "GIF", smoother),
        (&[], "csv", ""),
        (&[], "png", ""),
        (fine, "gif", fewer),
        (fine, "csv", fewer),
        (fine, "obj", fewer),
        (fine, "png", ""),
        (
            &["--fps", "200"],
            "csv",
            "dt is 0.005 s instead of 0.01 s, so that 1 step makes a frame of 1/200 s.\n",
        ),
        (&["--set", "dt=0.0084", "--set", "substeps=1"], "csv", ""),
    ] {
        let arguments = [&["run", "cloth", "--frames", "9", "--dry-run"], arguments].concat();
        let output = run(folder.path(), &arguments, &[ending]);
        assert!(output.status.success());
        assert_eq!(said(&output)[1], note, "{arguments:?} {ending}");
        let output = run(folder.path(), &[&arguments[..], &["--quiet"]].concat(), &[ending]);
        assert_eq!(said(&output)[1], "", "{arguments:?} {ending}");
    }
    let output = run(folder.path(), &[&["run", "cloth", "--frames", "9"], fine].concat(), &["pc2"]);
    assert!(said(&output)[1].starts_with(fewer), "{}", said(&output)[1]);
}

/// 10⁸ frames of 1000 points: tens of terabytes.
#[test]
fn what_does_not_fit_the_disk_is_refused_before_it_is_begun() {
    let folder = TempDir::new().unwrap();
    let arguments = ["run", "jelly", "--frames", "100000000"];
    let output = run(folder.path(), &arguments, &["npz", "pc2", "mdd", "ply"]);
    let [told, refused] = said(&output);
    assert_eq!((output.status.code(), told.as_str()), (Some(2), ""));
    assert!(
        refused.contains("will not fit: the outputs there need ") && refused.contains(" left; "),
        "{refused}"
    );
    assert_eq!(refused.lines().count(), 1, "{refused}");
    assert!(names(folder.path()).is_empty());

    // What is only about so much is warned of.
    let output = run(folder.path(), &[&arguments[..], &["--dry-run"]].concat(), &["csv"]);
    let [_, warned] = said(&output);
    assert!(
        output.status.success() && warned.starts_with("Warning: a.csv may not fit: it needs "),
        "{warned}"
    );
}

#[test]
fn frames_before_from_are_not_written() {
    let folder = TempDir::new().unwrap();
    let output =
        run(folder.path(), &["run", "chain", "--frames", "5", "--from", "3"], &["obj", "csv", "pc2"]);
    assert!(output.status.success(), "{}", said(&output)[1]);
    assert_eq!(names(folder.path()), ["a.0003.obj", "a.0004.obj", "a.0005.obj", "a.csv", "a.pc2"]);
    let csv = std::fs::read_to_string(folder.path().join("a.csv")).unwrap();
    assert!(csv.lines().nth(1).unwrap().starts_with("3,0.21,0,"), "{csv}");
    let pc2 = std::fs::read(folder.path().join("a.pc2")).unwrap();
    assert_eq!((&pc2[20..24], &pc2[28..32]), (&3f32.to_le_bytes()[..], &3i32.to_le_bytes()[..]));
}

#[test]
fn options_choose_bodies_axes_units_and_springs() {
    let folder = TempDir::new().unwrap();
    let scene = "dt = 0.01\n[[body]]\nname = \"left post\"\npoints = [[1, 2, 3]]\npoint_mass = 1\n\
                 [[body]]\nname = \"rope\"\npoints = [[0, 0, 0], [0, 2, 0]]\npoint_mass = 1\n\
                 [[body.springs]]\nradius = 2\nstiffness = 1\n";
    std::fs::write(folder.path().join("two.toml"), scene).unwrap();
    let obj = |arguments: &[&str]| {
        let output =
            run(folder.path(), &[&["run", "two.toml", "--frames", "0"], arguments].concat(), &["obj"]);
        assert!(output.status.success(), "{}", said(&output)[1]);
        let text = std::fs::read_to_string(folder.path().join("a.0000.obj")).unwrap();
        text.lines().filter(|line| !line.starts_with('#')).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(obj(&[]), "o left_post\nv 1.0 2.0 3.0\no rope\nv 0.0 0.0 0.0\nv 0.0 2.0 0.0");
    assert_eq!(
        obj(&["--body", "left post", "--up", "Z", "--scale", "100"]),
        "o left_post\nv 100.0 -300.0 200.0"
    );
    let with_lines = obj(&["--body", "rope", "--springs", "lines"]);
    assert_eq!(with_lines, "o rope\nv 0.0 0.0 0.0\nv 0.0 2.0 0.0\no springs\nl 1 2");
    assert_eq!(obj(&["--springs", "tubes"]).matches("\nf ").count(), 12 + 8);
}
