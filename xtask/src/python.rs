//! The Python package: built as users build it, installed in an environment of its own, and tested there.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::readers::SYSTEM;
use crate::shell::{Outcome, program, run, succeeds, target};
use crate::stages::{files_in, fresh_folder};

/// What its tests and types want beside the package and what it brings.
const TOOLS: &[&str] = &[
    "pytest",
    "mypy",
    "pandas-stubs",
    "types-tqdm",
    "typing_extensions",
    "nbclient",
    "nbformat",
    "ipykernel",
    "scipy",
    "jax",
];

/// Versions of Python that it is for, beside the one at hand; tested where they are installed.
const VERSIONS: [&str; 5] = ["3.10", "3.11", "3.12", "3.13", "3.14"];

/// Builds a wheel, installs it in a fresh environment and runs everything that is told of the package.
pub fn python() -> Outcome {
    let wheel = wheel()?;
    let python = environment("venv-package", SYSTEM)?;
    let with_all = format!("{}[all]", wheel.display());
    pip(&python, &[&with_all])?;
    pip(&python, TOOLS)?;
    let checked = |arguments: &[&str]| run(&mut tidy(program(&python, arguments)));
    checked(&["-m", "mypy", "python/sprung", "python/tests"])?;
    checked(&["-m", "mypy.stubtest", "sprung._engine", "--ignore-disjoint-bases"])?;
    checked(&["-m", "pytest", "--quiet", "-p", "no:cacheprovider", "--durations=5", "python/tests"])?;
    for version in VERSIONS {
        let system = format!("python{version}");
        if !succeeds(&mut program(&system, &["-c", "import venv, ensurepip"])) {
            println!("{system} is not here, or has no venv: not tried.");
            continue;
        }
        other(&wheel, &system)?;
    }
    Ok(())
}

/// The same wheel in another version of Python, without what is optional.
fn other(wheel: &Path, system: &str) -> Outcome {
    let python = environment(&format!("venv-{system}"), system)?;
    pip(&python, &[&wheel.display().to_string(), "pytest"])?;
    let tests = ["arrays", "bits", "errors", "examples", "package", "physics", "threads", "trajectory"];
    let files = tests.map(|name| format!("python/tests/test_{name}.py"));
    let pytest = program(&python, &["-m", "pytest", "--quiet", "-p", "no:cacheprovider"]);
    run(tidy(pytest).args(files))
}

/// One wheel for every version, by pip and what pyproject.toml names.
fn wheel() -> Outcome<PathBuf> {
    let folder = fresh_folder("wheels")?;
    let builder = environment("venv-build", SYSTEM)?;
    let arguments =
        ["-m", "pip", "wheel", "--quiet", "--disable-pip-version-check", "--no-deps", "--wheel-dir"];
    let mut build = program(builder, &arguments);
    run(build.arg(&folder).arg(".").env("CARGO_TARGET_DIR", target()))?;
    let made = files_in(&folder)?;
    made.into_iter().next().ok_or_else(|| "pip made no wheel".to_owned())
}

/// An environment of this name, made anew, and its Python.
fn environment(name: &str, system: &str) -> Outcome<PathBuf> {
    let venv = target().join(name);
    run(&mut program(system, &["-m", "venv", "--clear", &venv.display().to_string()]))?;
    Ok(venv.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" }))
}

fn pip(python: &Path, packages: &[&str]) -> Outcome {
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
    run(program(python, &install).args(packages))
}

/// Without compiled files in the source tree.
fn tidy(mut command: Command) -> Command {
    command.env("PYTHONDONTWRITEBYTECODE", "1");
    command
}
