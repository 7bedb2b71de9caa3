//! Ctrl-C: status 130, a sentence that says what is kept, and no half files.
#![cfg(unix)]
#![allow(clippy::unwrap_used)]

use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use tempfile::TempDir;

/// Starts `command`, presses Ctrl-C as soon as `partial` has more than `bytes` bytes, and gives what was said and what
/// files are there at the end. Whatever happens, it must end with status 130, soon.
fn press_ctrl_c(command: &mut Command, folder: &Path, partial: &str, bytes: u64) -> (String, Vec<String>) {
    let mut child = command.current_dir(folder).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    while std::fs::metadata(folder.join(partial)).map_or(0, |file| file.len()) <= bytes {
        assert_eq!(child.try_wait().unwrap(), None, "it ended before there was anything to interrupt");
        std::thread::sleep(Duration::from_millis(5));
    }
    let pressed = Instant::now();
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(killed.success());
    while child.try_wait().unwrap().is_none() {
        if pressed.elapsed() > Duration::from_secs(60) {
            child.kill().unwrap();
            panic!("a minute after Ctrl-C it still runs");
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(130), "{said}");
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    (said, names)
}

fn sprung(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sprung"));
    command.args(arguments);
    command
}

#[test]
fn a_simulation_keeps_its_whole_frames_and_says_where() {
    let folder = TempDir::new().unwrap();
    let run =
        ["run", "jelly", "-o", "a.csv", "-o", "b.png", "--size", "64x48", "--seconds", "1e3", "--quiet"];
    let (said, names) = press_ctrl_c(&mut sprung(&run), folder.path(), "a.csv.partial", 100);
    assert_eq!(names, ["a.csv", "b.png"]);
    let csv = std::fs::read_to_string(folder.path().join("a.csv")).unwrap();
    let rows = csv.lines().count() - 1;
    assert_eq!(rows % 1000, 0, "whole frames only");
    let frames = match rows / 1000 {
        1 => "1 frame is kept".to_owned(),
        frames => format!("{frames} frames are kept"),
    };
    assert_eq!(said, format!("sprung: interrupted; {frames} in a.csv, 1 frame in b.png\n"));
}

#[test]
fn without_outputs_there_is_nothing_to_keep() {
    let run = ["run", "jelly", "--seconds", "1e5", "--fps", "30"];
    let mut child = sprung(&run).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    // What it says of dt comes right before the simulation.
    let mut stderr = BufReader::new(child.stderr.take().unwrap());
    let mut said = String::new();
    stderr.read_line(&mut said).unwrap();
    assert!(said.starts_with("dt is"), "{said}");
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    said.clear();
    stderr.read_to_string(&mut said).unwrap();
    assert_eq!(said, "sprung: interrupted\n");
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

#[test]
fn a_scene_that_never_comes_to_rest_can_be_left_while_it_is_settled() {
    let folder = TempDir::new().unwrap();
    // In free fall, where the kinetic energy has no peak; and of many points, so that it goes on for long.
    let scene = "dt = 0.001\nsubsteps = 20\n[[body]]\nname = \"rain\"\nlattice = { points = [30, 30, 30], spacing = 1 }\npoint_mass = 1\n";
    std::fs::write(folder.path().join("rain.toml"), scene).unwrap();
    let run = ["run", "rain.toml", "--settle", "-o", "a.csv", "-o", "b.gif", "--frames", "20"];
    let (said, names) = press_ctrl_c(&mut sprung(&run), folder.path(), "a.csv.partial", 0);
    assert_eq!(said, "sprung: interrupted\n");
    assert_eq!(names, ["rain.toml"], "nothing is written");
}

#[test]
fn half_an_animation_is_not_kept() {
    let folder = TempDir::new().unwrap();
    let run = ["run", "cloth", "-o", "a.csv", "-o", "b.gif", "-o", "c.gif", "--frames", "2000", "--quiet"];
    // There is something in the animation's file only when the simulation is over.
    let (said, names) = press_ctrl_c(&mut sprung(&run), folder.path(), "b.gif.partial", 0);
    let sentence = |name| format!("interrupted while {name} was being drawn; it is not kept");
    assert!(said.contains(&sentence("b.gif")) && said.contains(&sentence("c.gif")), "{said}");
    assert_eq!(said.lines().count(), 2, "{said}");
    assert_eq!(names, ["a.csv"]);
}

/// The limit on the size of a file is met when the arrays come together in one: not before Ctrl-C, but after it.
#[test]
fn what_goes_wrong_after_ctrl_c_is_told_too() {
    let folder = TempDir::new().unwrap();
    let mut command = Command::new("sh");
    // 16,384 blocks of 512 bytes; a frame of positions has 12,000 bytes.
    command.args([
        "-c",
        "trap '' XFSZ && ulimit -f 16384 && exec \"$0\" \"$@\"",
        env!("CARGO_BIN_EXE_sprung"),
    ]);
    command.args(["run", "jelly", "-o", "a.npz", "--seconds", "1e3", "--quiet"]);
    let (said, names) = press_ctrl_c(&mut command, folder.path(), "a.npz.partial", 9 << 19);
    let full = "sprung: a.npz: cannot be written: it would become larger than a file may be here";
    assert_eq!(said, format!("{full}\nsprung: interrupted\n"));
    assert_eq!(names, [""; 0]);
}
