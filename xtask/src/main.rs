//! What continuous integration runs, in Rust: `cargo xtask ci`, or one stage of it by its name.
//!
//! A stage is one function in [`stages`] and one line in [`STAGES`]; the list feeds the help, the dispatch and `ci`.

// Printing is what this program is for.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod fuzz;
mod instructions;
mod levels;
mod npm;
mod python;
mod readers;
mod serve;
mod shell;
mod stages;
mod wasm;
mod web;
mod window;
mod window_story;

use std::process::ExitCode;
use std::time::{Duration, Instant};

use shell::Outcome;

/// One thing that can be right or wrong about the repository.
struct Stage {
    name: &'static str,
    about: &'static str,
    run: fn() -> Outcome,
}

/// All stages, in the order `ci` runs them: what fails quickly comes first.
const STAGES: &[Stage] = &[
    Stage { name: "fmt", about: "the code is formatted", run: stages::fmt },
    Stage { name: "locks", about: "every Cargo.lock is what its manifests need", run: stages::locks },
    Stage {
        name: "clippy",
        about: "no compiler or clippy warning, in any target or feature",
        run: stages::clippy,
    },
    Stage { name: "doc", about: "the API documentation builds without warnings", run: stages::doc },
    Stage {
        name: "release-tests",
        about: "golden hashes and stored pictures, optimised: the same as in debug",
        run: stages::release_tests,
    },
    Stage {
        name: "instructions",
        about: "the engine takes as many instructions as docs/benchmarks.md says",
        run: instructions::instructions,
    },
    Stage { name: "levels", about: "the same bits with NEON and in WebAssembly", run: levels::levels },
    Stage {
        name: "npm",
        about: "the npm package in target/npm/sprung: its tests in Node.js, with the same bits",
        run: npm::npm,
    },
    Stage { name: "web", about: "the page, built into web/dist: its tests in a browser", run: web::web },
    Stage { name: "schema", about: "docs/scene.schema.json is what the command prints", run: stages::schema },
    Stage { name: "demo", about: "the demonstration, and every scene to every format", run: stages::demo },
    Stage {
        name: "window",
        about: "a real window on a virtual display does what a person asks of it",
        run: window_story::run_all,
    },
    Stage { name: "numpy", about: "NumPy reads what the command writes", run: readers::numpy },
    Stage {
        name: "python",
        about: "the Python package is built, installed, typed and tested, and its notebooks run",
        run: python::python,
    },
    Stage {
        name: "exports",
        about: "meshio, trimesh and VTK find every vertex where the command says it is",
        run: readers::exports,
    },
    Stage {
        name: "usd",
        about: "OpenUSD, the Khronos validator and loaders of glTF find what the archive has",
        run: readers::usd,
    },
    Stage {
        name: "blender",
        about: "so does Blender, with meshes, caches, USD and glTF",
        run: readers::blender,
    },
    Stage {
        name: "fuzz",
        about: "a minute of random scenes, half of one of checkpoints and a quarter for each format of meshes crash nothing",
        run: fuzz::fuzz,
    },
    Stage {
        name: "licences",
        about: "licences, duplicates and sources of dependencies",
        run: stages::licences,
    },
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let chosen: Vec<&Stage> = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] | ["help" | "--help" | "-h"] => {
            print!("{}", help());
            return ExitCode::SUCCESS;
        }
        ["ci"] => STAGES.iter().collect(),
        ["web", "--serve"] => return end(web::serve()),
        [name] => match STAGES.iter().find(|stage| stage.name == name) {
            Some(stage) => vec![stage],
            None => {
                eprintln!("xtask: there is no stage \"{name}\"\n\n{}", help());
                return ExitCode::from(2);
            }
        },
        _ => {
            eprintln!("xtask: one stage at a time\n\n{}", help());
            return ExitCode::from(2);
        }
    };
    run(&chosen)
}

/// The exit status of what is no stage.
fn end(outcome: Outcome) -> ExitCode {
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("xtask: {reason}");
            ExitCode::FAILURE
        }
    }
}

/// Runs stages until one fails, then sums up.
fn run(chosen: &[&Stage]) -> ExitCode {
    let mut lines = Vec::new();
    let mut failure = None;
    for stage in chosen {
        if failure.is_some() {
            lines.push(format!("  {:<15} not run", stage.name));
            continue;
        }
        println!("\n=== {}: {}", stage.name, stage.about);
        let start = Instant::now();
        let outcome = (stage.run)();
        let seconds = seconds(start.elapsed());
        match outcome {
            Ok(()) => {
                println!("=== {}: passed in {seconds}", stage.name);
                lines.push(format!("  {:<15} passed  {seconds:>9}", stage.name));
            }
            Err(reason) => {
                lines.push(format!("  {:<15} FAILED  {seconds:>9}", stage.name));
                failure = Some(format!("{} failed: {reason}", stage.name));
            }
        }
    }
    println!("\n{}", lines.join("\n"));
    match failure {
        None => ExitCode::SUCCESS,
        Some(failure) => {
            println!("\nxtask: {failure}");
            ExitCode::FAILURE
        }
    }
}

fn seconds(time: Duration) -> String {
    format!("{:.1} s", time.as_secs_f64())
}

fn help() -> String {
    let mut text =
        "What continuous integration runs.\n\n  cargo xtask ci       all stages below, in this order\n"
            .to_owned();
    text += "  cargo xtask STAGE    one of them\n";
    text += "  cargo xtask web --serve\n                       builds the page and serves it on this machine\n\nStages:\n";
    for stage in STAGES {
        text += &format!("  {:<15} {}\n", stage.name, stage.about);
    }
    text
}
