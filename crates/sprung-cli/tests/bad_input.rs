//! Bad input of every kind: one sentence with the place, exit status 2, and nothing written.
#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::process::Command;

use tempfile::TempDir;

/// Runs, expects status 2 and one line (and a pointer to the help where the arguments were at fault), and gives it.
fn complaint(folder: &Path, arguments: &[&str]) -> String {
    let output =
        Command::new(env!("CARGO_BIN_EXE_sprung")).current_dir(folder).args(arguments).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
    assert!(output.stdout.is_empty(), "{arguments:?} printed to standard output");
    let line = said.strip_suffix("Try `sprung --help`.\n").unwrap_or(&said).trim_end().to_owned();
    assert!(!line.contains('\n'), "{arguments:?} said more than one line: {said}");
    assert!(line.starts_with("sprung: "), "{line}");
    line["sprung: ".len()..].to_owned()
}

const BODY: &str = "[[body]]\nname = \"a\"\npoints = [[0, 0, 0], [1, 0, 0]]\npoint_mass = 1\n";

#[test]
fn bad_scene_files() {
    let folder = TempDir::new().unwrap();
    let scene = |text: &str| {
        std::fs::write(folder.path().join("bad.toml"), text).unwrap();
        complaint(folder.path(), &["run", "bad.toml", "-o", "out.csv"])
    };
    let cases: &[(&str, &[&str])] = &[
        ("", &["bad.toml", "empty"]),
        ("dt = \n", &["bad.toml:1:"]),
        (&format!("dt = nan\n{BODY}"), &["bad.toml:1:6: dt:", "nan", "finite"]),
        (&format!("dt = inf\n{BODY}"), &["bad.toml:1:6: dt:"]),
        (&format!("dt = -1\n{BODY}"), &["bad.toml:1:6: dt:", "-1"]),
        (&format!("dt = \"soon\"\n{BODY}"), &["bad.toml:1:6: dt:", "auto"]),
        (&format!("substep = 3\n{BODY}"), &["bad.toml:1:1:", "substep", "did you mean \"substeps\"?"]),
        (&format!("{BODY}pins = [0, 0]\n"), &["bad.toml:5:", "pins"]),
        (&format!("{BODY}pins = [7]\n"), &["bad.toml:5:", "pins", "7"]),
        (
            "[[body]]\nname = \"a\"\npoints = [[0, 0, 0]]\npoint_mass = -1\n",
            &["bad.toml:4:14:", "point_mass", "-1"],
        ),
        (
            &format!("{BODY}[[body.springs]]\nradius = 1\nstiffness = -5\ndamping = 0\n"),
            &["bad.toml:7:", "stiffness", "-5"],
        ),
        (&format!("{BODY}[[body.springs]]\nradius = 1\n"), &["bad.toml:5:", "stiffness"]),
        (
            &format!("{BODY}[[body.springs]]\nradius = 0.5\nstiffness = 5\n"),
            &[
                "bad.toml:6:10: body[0].springs[0].radius: is 0.5 m, and no two points of the body are that near",
            ],
        ),
    ];
    for (text, parts) in cases {
        let line = scene(text);
        for part in *parts {
            assert!(line.contains(part), "{part:?} is not in: {line}");
        }
    }
    assert!(!folder.path().join("out.csv").exists() && !folder.path().join("out.csv.partial").exists());
}

#[test]
fn scenes_that_would_be_too_large() {
    let folder = TempDir::new().unwrap();
    // 50,000 points within reach of each other: 1.25 thousand million springs.
    let text = "[[body]]\nname = \"a\"\nlattice = { points = [50, 50, 20], spacing = 0.001 }\npoint_mass = 1\n\
                [[body.springs]]\nradius = 9\nstiffness = 1\n";
    std::fs::write(folder.path().join("dense.toml"), text).unwrap();
    let line = complaint(folder.path(), &["show", "dense.toml"]);
    assert!(
        line.starts_with("dense.toml:6:") && line.contains("20000000") && line.contains("max_springs"),
        "{line}"
    );
    let text = "[[body]]\nname = \"a\"\nlattice = { points = [4000000000, 4000000000, 4000000000], spacing = 1 }\npoint_mass = 1\n";
    std::fs::write(folder.path().join("huge.toml"), text).unwrap();
    let line = complaint(folder.path(), &["show", "huge.toml"]);
    assert!(line.starts_with("huge.toml:3:"), "{line}");
}

#[test]
fn a_scene_that_falls_does_not_come_to_rest() {
    let folder = TempDir::new().unwrap();
    let point = "[[body]]\nname = \"a\"\npoints = [[0, 0, 0]]\n";
    std::fs::write(folder.path().join("falls.toml"), point).unwrap();
    let line = complaint(folder.path(), &["run", "falls.toml", "--settle", "-o", "a.csv"]);
    assert!(line.starts_with("the scene did not come to rest: after 1000000 steps"), "{line}");
    // What is advised can be done.
    assert!(line.ends_with(
        "; hold every body by a pin or a plane, or leave out --settle and let it rest in a longer run"
    ));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn files_that_cannot_be_read() {
    let folder = TempDir::new().unwrap();
    assert_eq!(complaint(folder.path(), &["run", "none.toml"]), "none.toml: there is no such file");
    std::fs::create_dir(folder.path().join("folder.toml")).unwrap();
    assert_eq!(
        complaint(folder.path(), &["run", "folder.toml"]),
        "folder.toml: is a folder, and must be a file"
    );
    std::fs::write(folder.path().join("binary.toml"), b"dt = 1\nname = \"\xff\"\n").unwrap();
    let line = complaint(folder.path(), &["run", "binary.toml"]);
    assert!(line.starts_with("binary.toml:2:9:") && line.contains("UTF-8"), "{line}");
    // Two thousand million bytes without taking them from the disk.
    let large = std::fs::File::create(folder.path().join("large.toml")).unwrap();
    large.set_len(2_000_000_000).unwrap();
    assert_eq!(
        complaint(folder.path(), &["run", "large.toml"]),
        "large.toml: is larger than the 64 MiB allowed"
    );
}

#[test]
fn outputs_that_cannot_be_written() {
    let folder = TempDir::new().unwrap();
    let run = |output: &str| complaint(folder.path(), &["run", "spring", "-o", output, "--frames", "2"]);
    assert_eq!(run("none/out.csv"), "none/out.csv: cannot be written: its folder does not exist");
    std::fs::create_dir(folder.path().join("folder.csv")).unwrap();
    assert!(run("folder.csv").starts_with("folder.csv: cannot be written: it is a folder"));
    let line = run("out.xyz");
    assert!(line.starts_with("out.xyz:") && line.contains("csv") && line.contains("gif"), "{line}");
    assert!(run("out").starts_with("out:"));
    let line = complaint(folder.path(), &["run", "spring", "-o", "a.csv", "-o", "a.csv"]);
    assert!(line.starts_with("a.csv: is given twice"), "the same output twice: {line}");
    let line = complaint(folder.path(), &["run", "spring", "-o", "a.csv", "--plot", "b.txt"]);
    assert!(line.starts_with("b.txt:") && line.contains("svg"), "{line}");
    let line = complaint(folder.path(), &["run", "spring", "-o", "same.png", "--plot", "same.png"]);
    assert!(line.starts_with("same.png: is given twice"), "{line}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is left but the folder");
}

/// Each case: the outputs, and what is said of them. Where a folder is missing or a link leads is looked at, too.
#[test]
fn outputs_that_get_into_each_others_way() {
    let folder = TempDir::new().unwrap();
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    let cases: &[(&[&str], &str)] = &[
        (&["-o", "a.pc2", "-o", "./a.pc2"], "a.pc2 and ./a.pc2 are the same file"),
        (&["-o", "sub/../a.png", "--plot", "a.png"], "sub/../a.png and a.png are the same file"),
        (&["-o", "none/a.csv", "-o", "./none/a.csv"], "none/a.csv and ./none/a.csv are the same file"),
        (&["-o", "a.obj", "-o", "a.0001.obj"], "a.obj writes into a.0001.obj, the file of a frame"),
        (&["-o", "./a.10000.ply", "-o", "a.ply"], "a.ply writes into ./a.10000.ply, the file of a frame"),
        (&["-o", "a.0001.obj.pvd", "-o", "a.obj"], "a.obj writes into a.0001.obj, the file of a frame"),
        (
            &["-o", "a.csv", "-o", "a.csv.pvd"],
            "a.csv.pvd writes into the folder a.csv, where a.csv is to be written",
        ),
        (&["-o", "x.pvd", "-o", "x/y.csv"], "x.pvd writes into the folder x, where x/y.csv is to be written"),
        (&["-o", "x.pvd", "-o", "x.PVD"], "x.pvd writes into the folder x, where x.PVD is to be written"),
        (
            &["-o", "a.sprung.pvd", "--checkpoint", "a.sprung"],
            "a.sprung.pvd writes into the folder a.sprung, where a.sprung is to be written",
        ),
    ];
    for (outputs, sentence) in cases {
        for more in [&[][..], &["--dry-run"]] {
            let line =
                complaint(folder.path(), &[&["run", "spring", "--frames", "2"], *outputs, more].concat());
            assert_eq!(line, format!("-o: {sentence}; give each output a name of its own"));
        }
    }
    #[cfg(unix)]
    {
        std::fs::write(folder.path().join("sub/b.csv"), "mine").unwrap();
        std::os::unix::fs::symlink("sub/b.csv", folder.path().join("a.csv")).unwrap();
        let line = complaint(folder.path(), &["run", "spring", "-o", "a.csv", "-o", "sub/b.csv"]);
        assert!(line.starts_with("-o: a.csv and sub/b.csv are the same file"), "{line}");
        std::fs::remove_file(folder.path().join("a.csv")).unwrap();
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is left but the folder");

    // These look alike, and are apart.
    let fine =
        ["a.obj", "a.001.obj", "sub/a.0001.obj", "a.ply", "a.0001.ply.csv", "x.pvd", "sub/x.pvd", "x.csv"];
    let outputs: Vec<&str> = fine.iter().flat_map(|name| ["-o", name]).collect();
    let run = [&["run", "spring", "--frames", "2", "--quiet"], &outputs[..]].concat();
    let output =
        Command::new(env!("CARGO_BIN_EXE_sprung")).current_dir(folder.path()).args(run).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn bad_arguments() {
    let folder = TempDir::new().unwrap();
    let cases: &[(&[&str], &[&str])] = &[
        (&["run", "jely"], &["jely", "did you mean \"jelly\"?"]),
        (&["run", "jelly", "--set", "dt"], &["--set dt", "dt=0.005"]),
        (&["run", "jelly", "--set", "dtt=1"], &["--set dtt=1", "did you mean \"dt\"?"]),
        (&["run", "jelly", "--set", "dt=fast"], &["--set dt=fast"]),
        (&["run", "jelly", "--set", "dt=nan"], &["--set dt=nan", "NaN"]),
        (&["run", "jelly", "--set", "gravity=[0, 1]"], &["--set gravity=[0, 1]"]),
        (&["run", "jelly", "--frames", "-1"], &["--frames"]),
        (&["run", "jelly", "--frames", "many"], &["--frames"]),
        (&["run", "jelly", "--seconds", "0"], &["--seconds", "1e-6"]),
        (&["run", "jelly", "--seconds", "NaN"], &["--seconds", "finite"]),
        (&["run", "jelly", "--seconds", "1e9", "--fps", "1e6"], &["--seconds", "frames"]),
        (
            &["run", "spring", "--set", "dt=1e-9", "--fps", "1e-6", "--frames", "100000000", "--dry-run"],
            &["would take 1e23 steps", "9007199254740992"],
        ),
        (&["run", "jelly", "--frames", "3", "--seconds", "1"], &["--frames", "--seconds"]),
        (&["run", "jelly", "--threads", "0"], &["--threads"]),
        (&["run", "jelly", "--size", "10"], &["--size", "1280x720"]),
        (&["run", "jelly", "--at", "1"], &["--at", ".png"]),
        (&["run", "jelly", "-o", "a.png", "--seconds", "1", "--at", "9"], &["--at: is 9 s", "ends at 1.1 s"]),
        (&["run", "jelly", "-o", "a.csv", "--size", "640x360"], &["--size", "picture"]),
        (&["run", "jelly", "-o", "a.csv", "--up", "z"], &["--up: is of no use", ".obj"]),
        (&["run", "jelly", "-o", "a.npz", "--springs", "lines"], &["--springs: is of no use", ".pvd"]),
        (&["run", "jelly", "--points"], &["--points: is of no use", ".ply"]),
        (&["run", "jelly", "-o", "a.obj", "--up", "x"], &["--up", "y, z"]),
        (&["run", "jelly", "-o", "a.obj", "--scale", "0"], &["--scale", "0.000001"]),
        (&["run", "jelly", "-o", "a.obj", "--body", "jam"], &["there is no body \"jam\"; there are jelly"]),
        (
            &["run", "jelly", "-o", "a.obj", "--frames", "3", "--from", "4"],
            &["--from: is frame 4", "last one is 3"],
        ),
        (&["run", "jelly", "--from", "4"], &["--from: is of no use", "-o"]),
        (
            &["run", "jelly", "-o", "a.png", "--frames", "30", "--from", "20", "--at", "1"],
            &["--at: is 1 s", "the first frame is at 2.2 s"],
        ),
        (&["man", "ran"], &["there is no command \"ran\"", "run"]),
        (&["run", "jelly", "--frobnicate"], &["--frobnicate"]),
        (&["runn", "jelly"], &["runn", "'run'"]),
        (&["run"], &["SCENE"]),
    ];
    for (arguments, parts) in cases {
        let line = complaint(folder.path(), arguments);
        for part in *parts {
            assert!(
                line.to_lowercase().contains(&part.to_lowercase()),
                "{arguments:?}: {part:?} is not in: {line}"
            );
        }
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
