//! The command as a user meets it: the program itself, its files, its sentences and its exit status.
#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

fn sprung(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_sprung")).current_dir(folder).args(arguments).output().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Frame numbers in a CSV and how many rows each has.
fn frames(csv: &str) -> Vec<(u64, usize)> {
    let mut frames: Vec<(u64, usize)> = Vec::new();
    for row in csv.lines().skip(1) {
        assert_eq!(row.split(',').count(), 9, "{row}");
        let frame = row.split(',').next().unwrap().parse().unwrap();
        match frames.last_mut() {
            Some((last, rows)) if *last == frame => *rows += 1,
            _ => frames.push((frame, 1)),
        }
    }
    frames
}

#[test]
fn every_scene_of_the_assignment_runs_to_a_table() {
    let folder = TempDir::new().unwrap();
    for (scene, points, frame_time) in
        [("spring", 2, 0.07), ("chain", 15, 0.07), ("jelly", 1000, 0.11), ("cloth", 400, 0.07)]
    {
        let file = format!("{scene}.csv");
        let output = sprung(folder.path(), &["run", scene, "-o", &file, "--frames", "3", "--quiet"]);
        assert!(output.status.success(), "{}", stderr(&output));
        assert_eq!(stdout(&output) + &stderr(&output), "", "quiet says nothing");
        let csv = std::fs::read_to_string(folder.path().join(file)).unwrap();
        assert_eq!(csv.lines().next().unwrap(), "frame,time,point,x,y,z,vx,vy,vz");
        assert_eq!(frames(&csv), (0..=3).map(|frame| (frame, points)).collect::<Vec<_>>());
        let last_time: f64 = csv.lines().last().unwrap().split(',').nth(1).unwrap().parse().unwrap();
        assert!((last_time - 3.0 * frame_time).abs() < 1e-12, "{scene}: {last_time}");
    }
}

#[test]
fn several_outputs_cost_one_simulation_and_agree() {
    let folder = TempDir::new().unwrap();
    let arguments =
        ["run", "chain", "-o", "a.csv", "-o", "b.csv", "-o", "c.npz", "-o", "d.png", "--size", "320x180"];
    let output = sprung(folder.path(), &[&arguments[..], &["--frames", "5", "--plot", "e.svg"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(names(folder.path()), ["a.csv", "b.csv", "c.npz", "d.png", "e.svg"]);
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert_eq!(read("a.csv"), read("b.csv"));
    assert!(stdout(&output).contains("6 frames, 35 steps, 0.35 s simulated"), "{}", stdout(&output));
}

#[test]
fn a_frame_rate_takes_the_largest_step_that_divides_a_frame_and_says_so() {
    let folder = TempDir::new().unwrap();
    // 1/24 s takes five steps of 1/120 s: four of dt = 0.01 s would be too short.
    let output = sprung(folder.path(), &["run", "spring", "-o", "a.csv", "--seconds", "1", "--fps", "24"]);
    assert!(
        stderr(&output)
            .contains("dt is 0.00833333 s instead of 0.01 s, so that 5 steps make a frame of 1/24 s.")
    );
    let csv = std::fs::read_to_string(folder.path().join("a.csv")).unwrap();
    assert_eq!(frames(&csv).len(), 25);
    let time: f64 = csv.lines().last().unwrap().split(',').nth(1).unwrap().parse().unwrap();
    assert!((time - 1.0).abs() < 1e-12);
    // 1/25 s takes exactly four steps of 0.01 s, whatever the rounding of 1/(25 · 0.01).
    let output = sprung(folder.path(), &["run", "spring", "--seconds", "1", "--fps", "25"]);
    assert_eq!(stderr(&output), "");
}

#[test]
fn show_answers_with_the_table_of_stability_limits() {
    // From a dense eigenvalue solve, to 0.1 %: ω²_max, c_max, limit of dt.
    let table = [
        ("spring", 1.000, 0.200, 1.80998, 1.0),
        ("chain", 790.648, 11.8597, 0.0576921, 14.0),
        ("jelly", 8643.98, 115.253, 0.0119753, 1000.0),
        ("cloth", 9512.24, 47.5612, 0.0161071, 199.0),
    ];
    let folder = TempDir::new().unwrap();
    for (scene, omega2, c, limit, mass) in table {
        let output = sprung(folder.path(), &["show", scene, "--json"]);
        let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
        for (key, expected) in
            [("omega2_max", omega2), ("c_max", c), ("dt_limit", limit), ("total_mass", mass)]
        {
            let found = answer[key].as_f64().unwrap();
            assert!((found / expected - 1.0).abs() < 1e-3, "{scene} {key}: {found}, and not {expected}");
        }
        assert!(answer["dt_limit_certified"].as_f64().unwrap() <= limit * 1.0001);
        for key in ["points", "springs", "pinned", "dt", "substeps", "energy"] {
            assert!(answer[key].is_number(), "{scene} {key}");
        }
        assert_eq!(answer["state_hash"].as_str().unwrap().len(), 16);
        assert!(stdout(&sprung(folder.path(), &["show", scene])).contains("dt limit"));
    }
}

#[test]
fn a_scene_without_a_limit_says_null() {
    let folder = TempDir::new().unwrap();
    let scene = "dt = 0.01\n[[body]]\nname = \"stone\"\npoints = [[0, 0, 0]]\npoint_mass = 1\n";
    std::fs::write(folder.path().join("stone.toml"), scene).unwrap();
    let output = sprung(folder.path(), &["show", "stone.toml", "--json"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(answer["dt_limit"].is_null() && answer["dt_limit_certified"].is_null());
}

#[test]
fn a_blow_up_is_caught_before_it_is_written() {
    for dt in ["0.013", "0.0121"] {
        let folder = TempDir::new().unwrap();
        let set = format!("dt={dt}");
        let output =
            sprung(folder.path(), &["run", "jelly", "--set", &set, "-o", "a.csv", "--seconds", "20"]);
        assert_eq!(output.status.code(), Some(3));
        let said = stderr(&output);
        assert!(said.contains("Warning: dt ="), "a warning comes before the run: {said}");
        for part in ["blew up at t =", "step", "spring", "points", "limit", "Use dt ="] {
            assert!(said.contains(part), "{part} is missing: {said}");
        }
        assert_eq!(names(folder.path()), ["a.csv"]);
        let csv = std::fs::read_to_string(folder.path().join("a.csv")).unwrap();
        assert!(frames(&csv).iter().all(|&(_, rows)| rows == 1000), "whole frames only");
        // The cube falls 20 m at first: nothing sound is faster than a few times √(2·9.81·20) = 20 m/s.
        for row in csv.lines().skip(1) {
            for speed in row.split(',').skip(6) {
                let speed: f32 = speed.parse().unwrap();
                assert!(speed.abs() < 100.0, "{row}");
            }
        }
    }
}

#[test]
fn settled_scenes_hardly_move() {
    let folder = TempDir::new().unwrap();
    let output = sprung(folder.path(), &["run", "chain", "--settle", "-o", "a.csv", "--frames", "10"]);
    assert!(stderr(&output).contains("Settled in"), "{}", stderr(&output));
    let csv = std::fs::read_to_string(folder.path().join("a.csv")).unwrap();
    // A residual force of 10⁻³ m·g leaves speeds of the order of 10⁻³·g·0.7 s.
    for row in csv.lines().skip(1) {
        assert!(row.split(',').skip(6).all(|speed| speed.parse::<f32>().unwrap().abs() < 0.01), "{row}");
    }
}

#[test]
fn threads_change_nothing() {
    let folder = TempDir::new().unwrap();
    for threads in ["1", "2", "5"] {
        let file = format!("{threads}.csv");
        let output =
            sprung(folder.path(), &["run", "jelly", "--threads", threads, "-o", &file, "--frames", "2"]);
        assert!(output.status.success(), "{}", stderr(&output));
    }
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert_eq!(read("1.csv"), read("2.csv"));
    assert_eq!(read("1.csv"), read("5.csv"));
}

#[test]
fn a_starter_scene_runs_and_is_never_written_over() {
    let folder = TempDir::new().unwrap();
    assert!(sprung(folder.path(), &["new", "mine.toml"]).status.success());
    let output = sprung(folder.path(), &["run", "mine.toml", "--frames", "2"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let again = sprung(folder.path(), &["new", "mine.toml"]);
    assert_eq!(again.status.code(), Some(2));
    assert_eq!(stderr(&again), "sprung: mine.toml: exists already and is left as it is; give another name\n");
}

#[test]
fn help_completions_manual_and_schema_come_from_the_same_definitions() {
    let folder = TempDir::new().unwrap();
    for command in ["scenes", "show", "run", "bench", "new", "schema", "completions", "man"] {
        assert!(stdout(&sprung(folder.path(), &["--help"])).contains(command));
        assert!(stdout(&sprung(folder.path(), &["man"])).contains(command));
        assert!(stdout(&sprung(folder.path(), &["completions", "bash"])).contains(command));
    }
    assert!(stdout(&sprung(folder.path(), &["man", "run"])).contains("frames"));
    let schema: Value = serde_json::from_slice(&sprung(folder.path(), &["schema"]).stdout).unwrap();
    assert!(schema["properties"]["substeps"].is_object());
}

#[test]
fn bench_says_what_is_wrong_before_it_measures() {
    let folder = tempfile::tempdir().expect("there is a disk");
    let output = sprung(folder.path(), &["bench", "spring", "nosuch"]);
    assert_eq!((output.status.code(), &output.stdout[..]), (Some(2), &b""[..]));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("there is no built-in scene \"nosuch\"") && said.lines().count() == 1, "{said}");
}

#[test]
fn bench_gives_one_object_per_scene() {
    let folder = TempDir::new().unwrap();
    let output = sprung(folder.path(), &["bench", "spring", "chain", "--json"]);
    let text = stdout(&output);
    let figures: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(figures.iter().map(|f| f["scene"].as_str().unwrap()).collect::<Vec<_>>(), ["spring", "chain"]);
    for key in ["points", "springs", "steps", "threads", "ns_per_spring_step", "setup_s", "peak_mb"] {
        assert!(figures.iter().all(|figures| !figures[key].is_null()), "{key}: {text}");
    }
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_sprung"))
        .arg("schema")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{}", stderr(&output));
}
