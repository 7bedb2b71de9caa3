//! The stages, one function each.

use std::fs;
use std::path::{Path, PathBuf};

use crate::shell::{Outcome, cargo, has_library, program, read, root, run, succeeds, target};
use crate::wasm;

pub fn fmt() -> Outcome {
    run(&mut cargo(&["fmt", "--all", "--check"]))?;
    run(&mut cargo(&["fmt", "--manifest-path", "fuzz/Cargo.toml", "--check"]))
}

/// `fuzz/` has a lock file of its own, which nothing but its stage, late and long, would find behind the times.
pub fn locks() -> Outcome {
    for manifest in ["Cargo.toml", "fuzz/Cargo.toml"] {
        read(&mut cargo(&["tree", "--locked", "--quiet", "--manifest-path", manifest]))
            .map_err(|reason| format!("{reason}; `cargo tree --manifest-path {manifest}` mends it"))?;
    }
    Ok(())
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
    ]))?;
    if !has_library(wasm::TARGET) {
        println!("not looked at as a page's: for that, `rustup target add {}`", wasm::TARGET);
        return Ok(());
    }
    let packages = ["-p", "sprung-wasm", "-p", "sprung-app", "--features", "sprung-wasm/worker"];
    let page = ["clippy", "--locked", "--target", wasm::TARGET];
    run(cargo(&page).args(packages).args(["--", "-D", "warnings"]))
}

pub fn doc() -> Outcome {
    let mut command = cargo(&["doc", "--locked", "--workspace", "--all-features", "--no-deps"]);
    run(command.env("RUSTDOCFLAGS", "-D warnings"))
}

/// Those tests whose results could depend on how the compiler optimises: the kernel's, as only then are its loops vectors,
/// the golden hashes and the stored pictures. All of them would take many minutes to link.
pub fn release_tests() -> Outcome {
    run(&mut cargo(&["test", "--locked", "--release", "-p", "sprung", "--lib", "kernel::"]))?;
    run(&mut cargo(&[
        "test",
        "--locked",
        "--release",
        "-p",
        "sprung",
        "-p",
        "sprung-render",
        "--test",
        "determinism",
        "--test",
        "pictures",
    ]))
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

/// The demonstration and every scene of the assignment to every format, as a user would; then one blow-up.
pub fn demo() -> Outcome {
    let folder = fresh_folder("demo")?;
    // Even where there is a display: this is about the machines without.
    run(sprung(&[])
        .current_dir(&folder)
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET"))?;
    for scene in ["spring", "chain", "jelly", "cloth"] {
        let names: Vec<String> = [
            "csv", "npz", "usdc", "usda", "usdz", "glb", "pc2", "mdd", "obj", "ply", "pvd", "png", "gif",
            "mp4",
        ]
        .iter()
        .map(|ending| format!("{scene}.{ending}"))
        .collect();
        let outputs = names.iter().flat_map(|name| ["-o", name]);
        let plot = format!("{scene}.svg");
        run(sprung(&["run", scene, "--frames", "20", "--quiet", "--plot", &plot])
            .args(outputs)
            .current_dir(&folder))?;
        let count =
            ["-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of", "csv=p=0"];
        let film = folder.join(format!("{scene}.mp4")).display().to_string();
        let counted = read(program("ffprobe", &count).arg(film))?;
        if counted.trim_ascii() != b"21" {
            let found = String::from_utf8_lossy(&counted);
            return Err(format!("{scene}.mp4 should have 21 frames, and has {}", found.trim()));
        }
    }
    let status =
        sprung(&["run", "jelly", "--set", "dt=0.013", "-o", "blow-up.csv"]).current_dir(&folder).status();
    if status.as_ref().ok().and_then(std::process::ExitStatus::code) != Some(3) {
        return Err(format!("a blow-up should end with status 3, and ended with {status:?}"));
    }
    let left_over =
        files_in(&folder)?.into_iter().find(|path| path.extension().is_some_and(|e| e == "partial"));
    left_over.map_or(Ok(()), |path| Err(format!("{} was left behind", path.display())))
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
    // Not optimised: it runs for a second and takes minutes to build.
    let root = own.display().to_string();
    run(&mut cargo(&["install", "cargo-deny", "--locked", "--debug", "--quiet", "--root", &root]))?;
    Ok(own.join("bin").join(program_name))
}

/// The sprung command, optimised.
pub fn sprung(arguments: &[&str]) -> std::process::Command {
    let manifest = root().join("Cargo.toml").display().to_string();
    let mut command = cargo(&["run", "--locked", "--release", "--quiet", "--manifest-path", &manifest, "--"]);
    command.args(arguments);
    command
}

/// An empty folder below the target folder.
pub fn fresh_folder(name: &str) -> Outcome<PathBuf> {
    let folder = target().join(name);
    let made = match fs::remove_dir_all(&folder) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error),
        _ => fs::create_dir_all(&folder),
    };
    made.map_err(|error| format!("{} cannot be made: {error}", folder.display()))?;
    Ok(folder)
}

/// The files in a folder, sorted.
pub fn files_in(folder: &Path) -> Outcome<Vec<PathBuf>> {
    let entries =
        fs::read_dir(folder).map_err(|error| format!("{} cannot be read: {error}", folder.display()))?;
    let mut paths: Vec<PathBuf> =
        entries.flatten().map(|entry| entry.path()).filter(|path| path.is_file()).collect();
    paths.sort();
    Ok(paths)
}

/// Copies a folder with all that is in it.
pub fn copy_folder(from: &Path, to: &Path) -> Outcome {
    let failed = |error: std::io::Error| format!("{} cannot be copied: {error}", from.display());
    fs::create_dir_all(to).map_err(failed)?;
    for entry in fs::read_dir(from).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let copy = to.join(path.file_name().unwrap_or_default());
        if path.is_dir() {
            copy_folder(&path, &copy)?;
        } else {
            fs::copy(&path, &copy)
                .map_err(|error| format!("{} cannot be copied: {error}", path.display()))?;
        }
    }
    Ok(())
}
