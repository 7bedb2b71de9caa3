//! The npm package: built into `target/npm/sprung`, packed, installed elsewhere and tested there.

use std::fs;
use std::path::Path;

use crate::shell::{Outcome, program, quiet, read_text, root, run, succeeds, target};
use crate::stages::{copy_folder, files_in, fresh_folder};
use crate::wasm::{self, Build};

/// What the package's module is built from.
const ENGINE: Build<'_> =
    Build { package: "sprung-wasm", what: &["--lib"], file: "sprung_wasm", profile: "wasm" };

/// Builds the package and tests it as somebody who has installed it. Without Node.js it is only built; in continuous
/// integration that is a failure.
pub fn npm() -> Outcome {
    let package = fresh_folder("npm/sprung")?;
    build(&package)?;
    if succeeds(&mut program("node", &["--version"])) && succeeds(&mut program("npm", &["--version"])) {
        return check(&package);
    }
    if std::env::var_os("CI").is_some() {
        return Err("the package is not tested: first `apt-get install nodejs npm`".to_owned());
    }
    println!("not tested: for that, install Node.js and npm");
    Ok(())
}

/// The package's folder, ready for `npm pack` or `npm publish`.
fn build(package: &Path) -> Outcome {
    let source = root().join("npm/package");
    copy_folder(&source, package)?;
    for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
        let copied = fs::copy(root().join(licence), package.join(licence));
        copied.map_err(|error| format!("{licence} cannot be copied: {error}"))?;
    }
    let version = env!("CARGO_PKG_VERSION");
    if !read_text(&source.join("package.json"))?.contains(&format!("\"version\": \"{version}\"")) {
        return Err(format!("npm/package/package.json should have the workspace's version, {version}"));
    }
    wasm::bind(&ENGINE.run()?, package, "engine")?;
    for path in files_in(package)? {
        let bytes = fs::metadata(&path).map_or(0, |file| file.len());
        println!("{bytes:>10} bytes  {}", path.file_name().unwrap_or_default().to_string_lossy());
    }
    Ok(())
}

/// Packs it, installs that in a folder of its own, holds examples and tests against its types, and runs the tests.
fn check(package: &Path) -> Outcome {
    let folder = fresh_folder("npm/check")?;
    for part in ["test", "examples"] {
        copy_folder(&root().join("npm").join(part), &folder.join(part))?;
    }
    for file in ["package.json", "package-lock.json", "tsconfig.json", "bench.mjs"] {
        let copied = fs::copy(root().join("npm").join(file), folder.join(file));
        copied.map_err(|error| format!("npm/{file} cannot be copied: {error}"))?;
    }
    let packed =
        quiet(program("npm", &["pack", "--silent", "--pack-destination", ".."]).current_dir(package))?;
    let archive = target().join("npm").join(String::from_utf8_lossy(&packed).trim());
    let at = |name: &str, arguments: &[&str]| {
        let mut command = program(name, arguments);
        command.current_dir(&folder);
        command
    };
    run(&mut at("npm", &["ci", "--no-audit", "--no-fund", "--ignore-scripts"]))?;
    run(at("npm", &["install", "--no-save", "--no-audit", "--no-fund", "--ignore-scripts"]).arg(archive))?;
    run(&mut at("node", &["node_modules/typescript/bin/tsc", "--noEmit"]))?;
    let goldens = root().join("crates/sprung/goldens.json");
    // By its names, as versions of Node.js differ in what they take a folder for.
    let tests: Vec<_> = files_in(&folder.join("test"))?
        .into_iter()
        .filter(|path| path.to_string_lossy().ends_with(".test.mjs"))
        .collect();
    run(at("node", &["--test", "--test-reporter=spec"]).args(tests).env("SPRUNG_GOLDENS", goldens))
}
