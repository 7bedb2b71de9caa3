//! The stages, one function each.

use std::fs;
use std::path::{Path, PathBuf};

use crate::shell::{Outcome, cargo, program, read, root, run, succeeds, target};

/// How long the fuzzer runs on scenes, and on checkpoints.
const FUZZ_SECONDS: [u32; 2] = [60, 30];

/// The same for each reader of meshes.
const FUZZ_SECONDS_PER_READER: u32 = 15;

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

/// The same run as a table and as a NumPy archive: Python must find the same numbers in both.
pub fn python() -> Outcome {
    let python = python_with_numpy()?;
    let folder = fresh_folder("python-check")?;
    let [table, archive] = ["jelly.csv", "jelly.npz"].map(|name| folder.join(name).display().to_string());
    run(&mut sprung(&["run", "jelly", "--frames", "3", "--quiet", "-o", &table, "-o", &archive]))?;
    run(program(python, &["xtask/check_outputs.py", &table, &archive]).env("PYTHONDONTWRITEBYTECODE", "1"))
}

/// A soft body whose surface is a mesh that its points carry along: vertices that are no points.
pub const PEBBLE: &str = "examples/pebble.toml";

/// Three scenes to every format of geometry, in both axes and with and without springs: other people's readers must find each
/// vertex where the archive of the same run has it.
pub fn exports() -> Outcome {
    let python = python_with("venv-exports", "python3", &["numpy", "scipy", "meshio", "trimesh", "vtk"])?;
    let formats = ["npz", "pc2", "mdd", "obj", "ply", "pvd"];
    for (scene, up, scale, springs) in [
        ("jelly", "y", "1", "lines"),
        ("cloth", "z", "100", "lines"),
        ("jelly", "z", "0.01", "none"),
        (PEBBLE, "y", "1", "lines"),
        (PEBBLE, "z", "100", "none"),
    ] {
        let folder = fresh_folder("exports-check")?;
        let mut command = sprung(&["run", scene, "--frames", "12", "--quiet", "--up", up, "--scale", scale]);
        run(command.args(["--springs", springs]).args(outputs_in(&folder, &formats)))?;
        let folder = folder.display().to_string();
        let check = ["xtask/check_exports.py", &folder, up, scale];
        run(program(&python, &check).env("PYTHONDONTWRITEBYTECODE", "1"))?;
    }
    Ok(())
}

/// Three scenes into Blender itself: as meshes, and as caches that move a mesh. It is a Python module for one version of
/// Python alone; where that is not installed, this says so.
pub fn blender() -> Outcome {
    if !succeeds(&mut program("python3.11", &["--version"])) {
        return Err("Blender's Python module needs Python 3.11, and there is no python3.11".to_owned());
    }
    let python = python_with("venv-blender", "python3.11", &["bpy==4.5.*"])?;
    for scene in ["jelly", "cloth", PEBBLE] {
        let folder = fresh_folder("blender-check")?;
        let mut command = sprung(&["run", scene, "--fps", "24", "--frames", "24", "--quiet", "--up", "z"]);
        run(command.args(outputs_in(&folder, &["npz", "pc2", "mdd", "obj", "ply"])))?;
        let check = ["xtask/check_blender.py", &folder.display().to_string()];
        run(program(&python, &check).env("PYTHONDONTWRITEBYTECODE", "1"))?;
    }
    Ok(())
}

/// `-o FOLDER/run.ENDING` for each ending.
fn outputs_in(folder: &Path, endings: &[&str]) -> Vec<String> {
    let output =
        |ending: &&str| ["-o".to_owned(), folder.join(format!("run.{ending}")).display().to_string()];
    endings.iter().flat_map(output).collect()
}

/// A Python of our own, below the target folder, with NumPy.
fn python_with_numpy() -> Outcome<PathBuf> {
    python_with("venv", if cfg!(windows) { "python" } else { "python3" }, &["numpy"])
}

/// A Python of our own, below the target folder, with packages; they are installed when one of them is missing.
pub fn python_with(venv: &str, system: &str, packages: &[&'static str]) -> Outcome<PathBuf> {
    let venv = target().join(venv);
    let python = venv.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let module = |name: &&'static str| match name.split("==").next() {
        Some("usd-core") => "pxr",
        Some(module) => module,
        None => name,
    };
    let modules: Vec<&str> = packages.iter().map(module).collect();
    if !succeeds(&mut program(&python, &["-c", &format!("import {}", modules.join(", "))])) {
        run(&mut program(system, &["-m", "venv", "--clear", &venv.display().to_string()]))?;
        let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
        run(program(&python, &install).args(packages))?;
    }
    Ok(python)
}

/// Random mesh files for every reader, grown from a small one of each form. See fuzz/README.md.
pub fn fuzz_meshes() -> Outcome {
    let seeds = fresh_folder("fuzz-mesh-seeds")?;
    // A test writes the samples that it reads: they are made there, and are of use here.
    let mut samples =
        cargo(&["test", "--locked", "--quiet", "-p", "sprung-io", "--test", "imports", "formats"]);
    run(samples.env("SPRUNG_WRITE_SAMPLES", &seeds))?;
    let crashes = target().join("fuzz-crashes");
    fs::create_dir_all(&crashes).map_err(|error| format!("{} cannot be made: {error}", crashes.display()))?;
    for entry in
        fs::read_dir(&seeds).map_err(|error| format!("the samples cannot be read: {error}"))?.flatten()
    {
        let ending = entry.file_name().to_string_lossy().into_owned();
        let found = target().join(format!("fuzz-corpus-{ending}"));
        fs::create_dir_all(&found).map_err(|error| format!("{} cannot be made: {error}", found.display()))?;
        let mut command = cargo(&["run", "--locked", "--release", "--bin", "mesh", "--"]);
        command
            .current_dir(root().join("fuzz"))
            .env_remove("RUSTFLAGS")
            .env_remove("CARGO_ENCODED_RUSTFLAGS")
            .env("SPRUNG_READER", &ending)
            .args([&found, &entry.path()])
            .arg(format!("-artifact_prefix={}/{ending}-", crashes.display()))
            .arg(format!("-max_total_time={FUZZ_SECONDS_PER_READER}"))
            .args([
                "-max_len=4096",
                "-timeout=10",
                "-rss_limit_mb=1024",
                "-print_final_stats=1",
                "-verbosity=0",
            ]);
        run(&mut command).map_err(|reason| {
            format!("{reason}; the input that did it is in target/fuzz-crashes, see fuzz/README.md for how to go on")
        })?;
    }
    Ok(())
}

/// Random scene files, grown from those in `scenes/` by what code they reach, and random checkpoints. See fuzz/README.md.
pub fn fuzz() -> Outcome {
    let [scenes, checkpoints] = FUZZ_SECONDS;
    let seeds = fresh_folder("fuzz-seeds")?;
    for path in files_in(&root().join("scenes"))? {
        let name = path.file_name().unwrap_or_default();
        fs::copy(&path, seeds.join(name))
            .map_err(|error| format!("{} cannot be copied: {error}", path.display()))?;
    }
    fuzz_one("scene", &seeds, &["-dict=scene.dict", "-max_len=4096"], scenes)?;

    let seeds = fresh_folder("fuzz-seeds-checkpoint")?;
    for version in ["version-1", "version-2"] {
        let path = root().join("crates/sprung-io/tests/checkpoints").join(version).with_extension("hex");
        let digits =
            fs::read_to_string(&path).map_err(|error| format!("{version}.hex cannot be read: {error}"))?;
        let digits: Vec<char> = digits.chars().filter(char::is_ascii_hexdigit).collect();
        let byte = |pair: &[char]| u8::from_str_radix(&pair.iter().collect::<String>(), 16).unwrap_or(0);
        let bytes: Vec<u8> = digits.chunks(2).map(byte).collect();
        fs::write(seeds.join(version), bytes)
            .map_err(|error| format!("a seed cannot be written: {error}"))?;
    }
    fuzz_one("checkpoint", &seeds, &["-max_len=8192"], checkpoints)
}

fn fuzz_one(target_name: &str, seeds: &Path, options: &[&str], seconds: u32) -> Outcome {
    // What was found earlier is kept: it makes the next run start from where this one ended.
    let suffix = if target_name == "scene" { String::new() } else { format!("-{target_name}") };
    let found = target().join(format!("fuzz-corpus{suffix}"));
    let crashes = target().join("fuzz-crashes");
    for folder in [&found, &crashes] {
        fs::create_dir_all(folder)
            .map_err(|error| format!("{} cannot be made: {error}", folder.display()))?;
    }
    let mut command = cargo(&["run", "--locked", "--release", "--bin", target_name, "--"]);
    command
        // Cargo reads the compiler flags for coverage from fuzz/.cargo/config.toml when it runs there.
        .current_dir(root().join("fuzz"))
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .args([found.as_path(), seeds])
        .arg(format!("-artifact_prefix={}/", crashes.display()))
        .arg(format!("-max_total_time={seconds}"))
        .args(options)
        .arg("-mutate_depth=2")
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
fn files_in(folder: &Path) -> Outcome<Vec<PathBuf>> {
    let entries =
        fs::read_dir(folder).map_err(|error| format!("{} cannot be read: {error}", folder.display()))?;
    let mut paths: Vec<PathBuf> =
        entries.flatten().map(|entry| entry.path()).filter(|path| path.is_file()).collect();
    paths.sort();
    Ok(paths)
}
