//! The same bits with other vector instructions than this machine's: the tests of the step, built for 64-bit ARM (NEON) and
//! for WebAssembly with and without simd128, and run by an emulator and by Node.js.

use std::env::consts::{ARCH, OS};
use std::process::Command;

use crate::shell::{Outcome, cargo, has_library, program, run, succeeds};

/// A processor that this machine is not, and how its programs run here.
struct Elsewhere {
    name: &'static str,
    target: &'static str,
    /// Flags of the compiler.
    flags: &'static [&'static str],
    linker: Option<&'static str>,
    /// The command before a program's own, run in `crates/sprung`.
    runner: &'static [&'static str],
    /// What ends well where the tools are there, and the packages of Debian that bring them.
    tools: &'static [&'static [&'static str]],
    packages: &'static str,
    /// What is asked of `cargo test -p sprung`, one call after another.
    tests: &'static [&'static [&'static str]],
}

const ELSEWHERE: &[Elsewhere] = &[
    Elsewhere {
        name: "64-bit ARM, NEON",
        target: "aarch64-unknown-linux-gnu",
        flags: &[],
        linker: Some("aarch64-linux-gnu-gcc"),
        runner: &["qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"],
        tools: &[
            &["qemu-aarch64", "--version"],
            &["aarch64-linux-gnu-gcc", "--version"],
            &["ls", "/usr/aarch64-linux-gnu/lib/libc.so.6"],
        ],
        packages: "qemu-user gcc-aarch64-linux-gnu libc6-dev-arm64-cross",
        // The kernel against its plain twin and itself, the golden hashes, and that it matters neither how many steps are
        // taken at once nor how points are numbered. An emulator takes ten times as long as a machine: left out are tests that
        // divide large models among threads, as others do with smaller ones, and those of built-in scenes, which have
        // their golden hashes.
        tests: &[
            &[
                "--lib",
                "--",
                "kernel::",
                "--skip",
                "regions_give_the_same_bits_on_built_in_scenes",
                "--skip",
                "built_in_scenes_move_as_their_plain_twins",
                "--skip",
                "hardly_below_in_built_in_scenes",
            ],
            &[
                "--test",
                "determinism",
                "--test",
                "many_steps",
                "--test",
                "renumbered",
                "--",
                "--skip",
                "threads_may_change_while_it_runs",
            ],
        ],
    },
    Elsewhere {
        name: "WebAssembly, simd128",
        flags: &["-Ctarget-feature=+simd128"],
        tests: &[&["--lib", "--", "kernel::"], GOLDENS],
        ..WEBASSEMBLY
    },
    WEBASSEMBLY,
];

const WEBASSEMBLY: Elsewhere = Elsewhere {
    name: "WebAssembly, one number at a time",
    target: "wasm32-wasip1",
    flags: &[],
    linker: None,
    runner: &["node", "--no-warnings", "../../xtask/wasi.mjs"],
    tools: &[&["node", "--input-type=module", "--eval", "import 'node:wasi'"]],
    packages: "nodejs",
    tests: &[GOLDENS],
};

const GOLDENS: &[&str] = &["--test", "determinism"];

/// Runs the tests everywhere that this machine has the tools for; in continuous integration it has to have all.
pub fn levels() -> Outcome {
    for elsewhere in ELSEWHERE {
        println!("- {}", elsewhere.name);
        let missing = elsewhere.missing();
        if missing.is_empty() {
            elsewhere.tests.iter().try_for_each(|tests| run(&mut elsewhere.cargo_test(tests)))?;
        } else if std::env::var_os("CI").is_some() {
            return Err(format!("{} is not tested: {missing}", elsewhere.name));
        } else {
            println!("not tested: {missing}");
        }
    }
    Ok(())
}

impl Elsewhere {
    /// What to install; nothing where all is there.
    fn missing(&self) -> String {
        let mut orders = Vec::new();
        let mut tools = self.tools.iter();
        if !self.is_here() && !tools.all(|tool| succeeds(&mut program(tool[0], &tool[1..]))) {
            orders.push(format!("`apt-get install {}`", self.packages));
        }
        if !has_library(self.target) {
            orders.push(format!("`rustup target add {}`", self.target));
        }
        if orders.is_empty() { String::new() } else { format!("first {}", orders.join(" and ")) }
    }

    /// Whether this machine is one itself.
    fn is_here(&self) -> bool {
        self.target == format!("{ARCH}-unknown-{OS}-gnu")
    }

    fn cargo_test(&self, tests: &[&str]) -> Command {
        let mut command =
            cargo(&["test", "--locked", "--profile", "levels", "-p", "sprung", "--target", self.target]);
        let mut configure = |key: &str, value: String| {
            command.arg("--config").arg(format!("target.{}.{key}={value}", self.target));
        };
        // Texts and lists of them are written in TOML as in Rust.
        let flags: Vec<&str> = self.flags.iter().copied().chain(["-Dwarnings"]).collect();
        configure("rustflags", format!("{flags:?}"));
        if !self.is_here() {
            configure("runner", format!("{:?}", self.runner));
            if let Some(linker) = self.linker {
                configure("linker", format!("{linker:?}"));
            }
        }
        // Cargo would take flags from there instead of ours.
        command.args(tests).env_remove("RUSTFLAGS").env_remove("CARGO_ENCODED_RUSTFLAGS");
        command
    }
}
