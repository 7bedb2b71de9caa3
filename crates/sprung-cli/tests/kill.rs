//! Nothing is lost: a run that is killed at any moment, again and again, is completed to the same bytes as one that was not.
//!
//! `SPRUNG_KILLS=500 cargo test --test kill` kills it more often than the usual 25 times; `SPRUNG_SEED` chooses other moments.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use tempfile::TempDir;

/// Formats that keep files beside them, fill in what comes first, or draw; and the energy plot, which has the ledger kept.
const OUTPUTS: &[&str] = &["a.csv", "a.npz", "a.pc2", "a.mdd", "a.usdc", "a.usda", "a.glb", "a.gif", "a.png"];
const PLOT: &str = "a.svg";

/// A run of a second or so in a debug build.
fn run(folder: &Path, checkpoint: bool) -> Command {
    let mut command = sprung(folder);
    command.args(["run", "cloth", "--frames", "150", "--size", "96x64", "--quiet", "--plot", PLOT]);
    command.args(OUTPUTS.iter().flat_map(|name| ["-o", name]));
    if checkpoint {
        command.args(["--checkpoint", "a.sprung", "--every", "3"]);
    }
    command
}

fn resume(folder: &Path, threads: &str) -> Command {
    let mut command = sprung(folder);
    command.args(["run", "--resume", "a.sprung", "--quiet", "--threads", threads]);
    command
}

fn sprung(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sprung"));
    command.current_dir(folder).stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

fn bytes_in(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files: Vec<(String, Vec<u8>)> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap())
        .map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap()))
        .filter(|(name, _)| name != "a.sprung")
        .collect();
    files.sort();
    files
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }
}

/// When it is killed.
#[derive(Clone, Copy, Debug)]
enum Moment {
    /// After so much time.
    After(Duration),
    /// While a checkpoint is being written.
    InCheckpoint,
    /// While the outputs are being completed: the first of them has its name.
    InFinish,
}

/// Lets it run until then and kills it; false if it ended by itself before, and well.
fn killed(mut child: Child, folder: &Path, moment: Moment, old: bool) -> bool {
    let begun = Instant::now();
    let is_now = || match moment {
        Moment::After(time) => begun.elapsed() >= time,
        Moment::InCheckpoint => folder.join("a.sprung.partial").exists(),
        Moment::InFinish => !old && folder.join(OUTPUTS[0]).exists(),
    };
    while !is_now() {
        if let Some(status) = child.try_wait().unwrap() {
            let output = child.wait_with_output().unwrap();
            assert!(status.success(), "{moment:?}: {}", String::from_utf8_lossy(&output.stderr));
            return false;
        }
        std::thread::yield_now();
    }
    child.kill().unwrap();
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    // It may just have ended by itself.
    assert!(output.status.success() || output.status.code().is_none() || cfg!(windows), "{moment:?}: {said}");
    !output.status.success()
}

#[test]
#[allow(clippy::print_stderr)]
fn a_run_that_is_killed_at_any_moment_is_completed_to_the_same_bytes() {
    let number = |name: &str, default: u64| {
        std::env::var(name).ok().map_or(default, |text| text.parse().expect("a number"))
    };
    let (wanted, mut random) = (number("SPRUNG_KILLS", 25), Random(number("SPRUNG_SEED", 1)));

    let whole = TempDir::new().unwrap();
    let begun = Instant::now();
    assert!(run(whole.path(), false).status().unwrap().success());
    // Only to choose moments: checkpoints make it longer.
    let length = begun.elapsed();
    let expected = bytes_in(whole.path());
    assert_eq!(expected.len(), OUTPUTS.len() + 1);

    let (mut kills, mut before_any, mut in_checkpoint, mut in_finish, mut completed) = (0, 0, 0, 0, 0);
    while kills < wanted {
        let folder = TempDir::new().unwrap();
        // Each run is killed up to five times on its way.
        for round in 0.. {
            let is_begun = folder.path().join("a.sprung").exists();
            let threads = ["1", "2", "3"][round % 3];
            let command = if is_begun { resume(folder.path(), threads) } else { run(folder.path(), true) };
            let mut command = command;
            let child = command.spawn().unwrap();
            let moment = match random.next() % 6 {
                _ if round >= 5 => Moment::After(Duration::MAX),
                0 => Moment::InCheckpoint,
                1 => Moment::InFinish,
                _ => Moment::After(length.mul_f64((random.next() % 1000) as f64 / 600.0)),
            };
            let old = folder.path().join(OUTPUTS[0]).exists();
            if !killed(child, folder.path(), moment, old) {
                break;
            }
            kills += 1;
            let is_there = |name: &str| folder.path().join(name).exists();
            before_any += u64::from(!is_there("a.sprung"));
            in_checkpoint += u64::from(is_there("a.sprung.partial"));
            in_finish += u64::from(is_there(OUTPUTS[0]));
        }
        let found = bytes_in(folder.path());
        let names = |files: &[(String, Vec<u8>)]| -> Vec<String> {
            files.iter().map(|(name, _)| name.clone()).collect()
        };
        // What is left of a checkpoint that was cut short is in nobody's way.
        let found: Vec<_> = found.into_iter().filter(|(name, _)| name != "a.sprung.partial").collect();
        assert_eq!(names(&found), names(&expected));
        for ((name, bytes), (_, expected)) in found.iter().zip(&expected) {
            assert!(bytes == expected, "{name} differs after {kills} kills");
        }
        completed += 1;
    }
    eprintln!(
        "{kills} kills of {completed} runs: {before_any} before the first checkpoint, {in_checkpoint} while one was being \
         written, {in_finish} while the outputs were being completed"
    );
}

#[test]
fn a_run_that_is_still_going_is_left_alone_and_one_that_is_over_too() {
    let folder = TempDir::new().unwrap();
    let mut long = sprung(folder.path());
    long.args(["run", "cloth", "--frames", "100000", "--quiet", "-o", "a.csv", "--checkpoint", "a.sprung"]);
    let mut child = long.spawn().unwrap();
    while !folder.path().join("a.sprung").exists() {
        assert!(child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(5));
    }
    let refused = |command: &mut Command| {
        let output = command.output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        said
    };
    let said = refused(&mut resume(folder.path(), "1"));
    assert!(said.contains("a.sprung: is the checkpoint of a run that is still going"), "{said}");
    let mut again = sprung(folder.path());
    again.args(["run", "spring", "--quiet", "-o", "b.csv", "--checkpoint", "a.sprung"]);
    let said = refused(&mut again);
    assert!(said.contains("is the checkpoint of a run that is still going"), "{said}");
    child.kill().unwrap();
    child.wait().unwrap();

    // The same command again would lose what there is.
    let said = refused(&mut again);
    assert!(said.contains("can be completed; `sprung run --resume a.sprung` does that"), "{said}");
    // Made shorter than it is, no; but as short as that, and it is complete.
    let mut shorter = resume(folder.path(), "1");
    shorter.args(["--frames", "300"]);
    let output = shorter.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let csv = fs::read_to_string(folder.path().join("a.csv")).unwrap();
    assert!(csv.lines().last().unwrap().starts_with("300,"));
    // Twice does no harm.
    let before = fs::read(folder.path().join("a.csv")).unwrap();
    let output = resume(folder.path(), "1").output().unwrap();
    assert!(output.status.success());
    assert_eq!(fs::read(folder.path().join("a.csv")).unwrap(), before);
    let mut names: Vec<String> =
        fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert_eq!(names, ["a.csv", "a.sprung"]);
}
