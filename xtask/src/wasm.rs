//! Building for WebAssembly: compiler, library and wasm-bindgen, for the npm package and for the page.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::shell::{Outcome, cargo, has_library, program, quiet, read_text, root, run, succeeds, target};

/// The target: no operating system at all.
pub const TARGET: &str = "wasm32-unknown-unknown";

/// What has to be installed where nothing else is said.
const MISSING: &str = "the standard library for WebAssembly is missing; `rustup target add wasm32-unknown-unknown` brings it, \
                       and on Debian `apt-get install rustc-web rust-web-src lld-19`";

/// Something to build.
pub struct Build<'a> {
    pub package: &'a str,
    /// What cargo is to build of it: `["--lib"]`, or `["--bin", "sprung-app"]`.
    pub what: &'a [&'a str],
    /// The file that comes out, without its ending.
    pub file: &'a str,
    pub profile: &'a str,
}

impl Build<'_> {
    /// Builds it with vector instructions. Gives where the file lies.
    pub fn run(&self) -> Outcome<PathBuf> {
        let mut command = Compiler::here()?.cargo_build();
        command.args(["--package", self.package, "--profile", self.profile]).args(self.what);
        run(&mut command)?;
        // The folder of the development profile alone has another name than the profile.
        let folder = if self.profile == "dev" { "debug" } else { self.profile };
        Ok(target().join(TARGET).join(folder).join(format!("{}.wasm", self.file)))
    }
}

/// Makes of what the compiler built a module that JavaScript can load: `NAME_bg.wasm` and `NAME.js` in the folder.
///
/// wasm-opt is left out: compressed, it makes modules 4 % smaller at the most, and version 108, which Debian 12 has, breaks those
/// with references without a word.
pub fn bind(built: &Path, folder: &Path, name: &str) -> Outcome {
    let arguments =
        ["--target", "web", "--no-typescript", "--omit-default-module-path", "--remove-name-section"];
    let mut command = program(wasm_bindgen()?, &arguments);
    run(command.args(["--remove-producers-section", "--out-name", name, "--out-dir"]).arg(folder).arg(built))
}

/// Where the compiler and the library for WebAssembly come from.
enum Compiler {
    /// The one that rust-toolchain.toml names.
    Own,
    /// Debian's, which has the library as source.
    Debian { linker: String },
}

impl Compiler {
    /// The one that is here. If rustup offers the library, it is installed.
    fn here() -> Outcome<Self> {
        if has_library(TARGET) {
            return Ok(Self::Own);
        }
        if succeeds(&mut program("rustup", &["--version"]))
            && run(&mut program("rustup", &["target", "add", TARGET])).is_ok()
        {
            return Ok(Self::Own);
        }
        let sysroot =
            quiet(&mut program(DEBIANS_RUSTC, &["--print", "sysroot"])).map_err(|_| MISSING.to_owned())?;
        let source =
            Path::new(String::from_utf8_lossy(&sysroot).trim()).join("lib/rustlib/src/rust/library/std");
        // Any version will do; the newest first.
        let linkers = (14..30).rev().map(|version| format!("wasm-ld-{version}"));
        let linker = linkers
            .chain(["wasm-ld".to_owned()])
            .find(|linker| succeeds(&mut program(linker, &["--version"])));
        match linker {
            Some(linker) if source.is_dir() => Ok(Self::Debian { linker }),
            _ => Err(MISSING.to_owned()),
        }
    }

    fn cargo_build(&self) -> Command {
        let mut command = cargo(&["build", "--locked", "--target", TARGET]);
        // Lists of texts are written in TOML as in Rust.
        let flags = ["-Ctarget-feature=+simd128", "-Dwarnings"];
        command.arg("--config").arg(format!("target.{TARGET}.rustflags={flags:?}"));
        // Cargo would take flags from there instead of ours.
        command.env_remove("RUSTFLAGS").env_remove("CARGO_ENCODED_RUSTFLAGS");
        if let Self::Debian { linker } = self {
            command.arg("-Zbuild-std=std,panic_abort");
            command.env("RUSTC", DEBIANS_RUSTC).env("RUSTC_BOOTSTRAP", "1");
            command.env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", linker);
        }
        command
    }
}

const DEBIANS_RUSTC: &str = "/usr/bin/rustc";

/// wasm-bindgen from the path, or our own below the target folder: of the very version that the crate has.
fn wasm_bindgen() -> Outcome<PathBuf> {
    let version = locked_version("wasm-bindgen")?;
    let own = target().join("tools");
    let name = format!("wasm-bindgen{}", std::env::consts::EXE_SUFFIX);
    for candidate in [PathBuf::from(&name), own.join("bin").join(&name)] {
        let said = quiet(&mut program(&candidate, &["--version"])).unwrap_or_default();
        if String::from_utf8_lossy(&said).split_whitespace().nth(1) == Some(version.as_str()) {
            return Ok(candidate);
        }
    }
    // Not optimised: it runs for seconds and takes minutes to build. Its lock file asks for crates that do not build here.
    let folder = own.display().to_string();
    run(&mut cargo(&[
        "install",
        "wasm-bindgen-cli",
        "--version",
        &version,
        "--no-default-features",
        "--debug",
        "--quiet",
        "--root",
        &folder,
    ]))?;
    Ok(own.join("bin").join(name))
}

/// The version of a crate in Cargo.lock.
fn locked_version(name: &str) -> Outcome<String> {
    let lock = read_text(&root().join("Cargo.lock"))?;
    let entry = lock.split("[[package]]").find(|entry| entry.contains(&format!("name = \"{name}\"\n")));
    let version = entry.and_then(|entry| entry.lines().find_map(|line| line.strip_prefix("version = \"")));
    let version = version.and_then(|rest| rest.strip_suffix('"'));
    version.map(str::to_owned).ok_or_else(|| format!("Cargo.lock has no version of {name}"))
}
