//! The stages, one function each.

use std::fs;
use std::path::{Path, PathBuf};

use crate::shell::{Outcome, cargo, program, read, root, run, succeeds, target};

/// How long the fuzzer runs.
const FUZZ_SECONDS: u32 = 60;

pub fn fmt() -> Outcome {
    run(&mut cargo(&["fmt", "--all", "--check"]))?;
    run(&mut cargo(&["fmt", "--manifest-path", "fuzz/Cargo.toml", "--check"]))
}

pub fn clippy() -> Outcome {
    run(&mut cargo(&[
        "clippy",
        "--locked",
        "--workspace",
        "--all-targets",
        "--all-features",
        "--",
        "-D",
        "warnings",
    ]))
}

pub fn doc() -> Outcome {
    let mut command = cargo(&["doc", "--locked", "--workspace", "--all-features", "--no-deps"]);
    run(command.env("RUSTDOCFLAGS", "-D warnings"))
}

pub fn release_tests() -> Outcome {
    run(&mut cargo(&["test", "--locked", "--release"]))
}

pub fn schema() -> Outcome {
    let path = root().join("docs/scene.schema.json");
    let printed = read(&mut sprung(&["schema"]))?;
    let committed =
        fs::read(&path).map_err(|error| format!("docs/scene.schema.json cannot be read: {error}"))?;
    if printed == committed {
        return Ok(());
    }
    let reason = "docs/scene.schema.json is not what the command prints";
    Err(format!("{reason}; run `cargo run --release -- schema > docs/scene.schema.json`"))
}

/// The same run as a table and as a NumPy archive: Python must find the same numbers in both.
pub fn python() -> Outcome {
    let python = python_with_numpy()?;
    let folder = fresh_folder("python-check")?;
    let [table, archive] = ["jelly.csv", "jelly.npz"].map(|name| folder.join(name).display().to_string());
    run(&mut sprung(&["run", "jelly", "--frames", "3", "--quiet", "-o", &table, "-o", &archive]))?;
    run(program(python, &["xtask/check_outputs.py", &table, &archive]).env("PYTHONDONTWRITEBYTECODE", "1"))
}

/// A Python of our own, below the target folder, with NumPy.
fn python_with_numpy() -> Outcome<PathBuf> {
    let venv = target().join("venv");
    let python = venv.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    if !succeeds(&mut program(&python, &["-c", "import numpy"])) {
        let system = if cfg!(windows) { "python" } else { "python3" };
        run(&mut program(system, &["-m", "venv", "--clear", &venv.display().to_string()]))?;
        run(&mut program(
            &python,
            &["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "numpy"],
        ))?;
    }
    Ok(python)
}

/// Random scene files, grown from those in `scenes/` by what code they reach. See fuzz/README.md.
pub fn fuzz() -> Outcome {
    let seeds = fresh_folder("fuzz-seeds")?;
    for path in files_in(&root().join("scenes"))? {
        let name = path.file_name().unwrap_or_default();
        fs::copy(&path, seeds.join(name))
            .map_err(|error| format!("{} cannot be copied: {error}", path.display()))?;
    }
    // What was found earlier is kept: it makes the next run start from where this one ended.
    let found = target().join("fuzz-corpus");
    let crashes = target().join("fuzz-crashes");
    for folder in [&found, &crashes] {
        fs::create_dir_all(folder)
            .map_err(|error| format!("{} cannot be made: {error}", folder.display()))?;
    }
    let mut command = cargo(&["run", "--locked", "--release", "--bin", "scene", "--"]);
    command
        // Cargo reads the compiler flags for coverage from fuzz/.cargo/config.toml when it runs there.
        .current_dir(root().join("fuzz"))
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .args([&found, &seeds])
        .arg(format!("-artifact_prefix={}/", crashes.display()))
        .arg(format!("-max_total_time={FUZZ_SECONDS}"))
        .args(["-dict=scene.dict", "-max_len=4096", "-mutate_depth=2"])
        .args(["-timeout=10", "-rss_limit_mb=2048", "-print_final_stats=1", "-verbosity=0"]);
    run(&mut command).map_err(|reason| {
        format!(
            "{reason}; the input that did it is in target/fuzz-crashes, see fuzz/README.md for how to go on"
        )
    })
}

pub fn licences() -> Outcome {
    let arguments = ["--locked", "--workspace", "--all-features", "check", "licenses", "bans", "sources"];
    run(&mut program(cargo_deny()?, &arguments))
}

/// cargo-deny from the path, or our own below the target folder.
fn cargo_deny() -> Outcome<PathBuf> {
    let own = target().join("tools");
    let program_name = format!("cargo-deny{}", std::env::consts::EXE_SUFFIX);
    for candidate in [PathBuf::from(&program_name), own.join("bin").join(&program_name)] {
        if succeeds(&mut program(&candidate, &["--version"])) {
            return Ok(candidate);
        }
    }
    run(&mut cargo(&["install", "cargo-deny", "--locked", "--quiet", "--root", &own.display().to_string()]))?;
    Ok(own.join("bin").join(program_name))
}

/// The sprung command, optimised.
fn sprung(arguments: &[&str]) -> std::process::Command {
    let mut command = cargo(&["run", "--locked", "--release", "--quiet", "--package", "sprung-cli", "--"]);
    command.args(arguments);
    command
}

/// An empty folder below the target folder.
fn fresh_folder(name: &str) -> Outcome<PathBuf> {
    let folder = target().join(name);
    let made = match fs::remove_dir_all(&folder) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error),
        _ => fs::create_dir_all(&folder),
    };
    made.map_err(|error| format!("{} cannot be made: {error}", folder.display()))?;
    Ok(folder)
}

/// The files in a folder, sorted.
fn files_in(folder: &Path) -> Outcome<Vec<PathBuf>> {
    let entries =
        fs::read_dir(folder).map_err(|error| format!("{} cannot be read: {error}", folder.display()))?;
    let mut paths: Vec<PathBuf> =
        entries.flatten().map(|entry| entry.path()).filter(|path| path.is_file()).collect();
    paths.sort();
    Ok(paths)
}
