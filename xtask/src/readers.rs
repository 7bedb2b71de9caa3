//! What the command writes, held against other people's readers: NumPy, meshio, trimesh, VTK, OpenUSD, the Khronos validator,
//! loaders of glTF, and Blender.

use std::path::{Path, PathBuf};

use crate::shell::{Outcome, program, run, succeeds, target};
use crate::stages::{fresh_folder, sprung};

/// A scene with bodies of all kinds, and its title and time from frame to frame, s.
const SCENE: (&str, &str, &str) = ("xtask/readers.toml", "Three \"bodies\" \\ of all kinds", "0.04");
/// A soft body whose surface is a mesh that its points carry along: vertices that are no points.
const PEBBLE: &str = "examples/pebble.toml";
/// Cloth of quads, which leave as such.
const TOWEL: &str = "examples/towel.toml";
/// The titles of these two.
const TITLES: [&str; 2] = ["A pebble of jelly", "A towel on a rail"];
/// The Python that the system has.
pub const SYSTEM: &str = if cfg!(windows) { "python" } else { "python3" };
/// The Khronos validator, as npm knows it.
const VALIDATOR: &str = "gltf-validator@2.0.0-dev.3.10";

/// The same run as a table and as a NumPy archive: Python must find the same numbers in both.
pub fn numpy() -> Outcome {
    let python = python_with("venv", SYSTEM, &["numpy"])?;
    let folder = fresh_folder("numpy-check")?;
    let [table, archive] = ["jelly.csv", "jelly.npz"].map(|name| folder.join(name).display().to_string());
    run(&mut sprung(&["run", "jelly", "--frames", "3", "--quiet", "-o", &table, "-o", &archive]))?;
    run(program(python, &["xtask/check_outputs.py", &table, &archive]).env("PYTHONDONTWRITEBYTECODE", "1"))
}

/// Four scenes to every format of geometry, in both axes and with and without springs: other people's readers must find each
/// vertex where the archive of the same run has it.
pub fn exports() -> Outcome {
    let python = python_with("venv-exports", SYSTEM, &["numpy", "scipy", "meshio", "trimesh", "vtk"])?;
    let formats = ["npz", "pc2", "mdd", "obj", "ply", "pvd"];
    for (scene, up, scale, springs) in [
        ("jelly", "y", "1", "lines"),
        ("cloth", "z", "100", "lines"),
        ("jelly", "z", "0.01", "none"),
        (PEBBLE, "y", "1", "lines"),
        (PEBBLE, "z", "100", "none"),
        (TOWEL, "z", "1", "lines"),
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

/// Every vertex of every time sample has the bits of the archive of the same run, and the formats' own validators have
/// nothing to say.
pub fn usd() -> Outcome {
    let python = python_with("venv-usd", SYSTEM, &["numpy", "usd-core", "pygltflib", "trimesh"])?;
    let validator = gltf_validator()?;
    let folder = fresh_folder("usd-check")?;
    let (scene, title, frame_time) = SCENE;
    let file = |ending: &str| folder.join(format!("run.{ending}")).display().to_string();
    let [archive, ply, crate_file, text, package, gltf] =
        ["npz", "ply", "usdc", "usda", "usdz", "glb"].map(file);
    let checked = |script: &str, arguments: &[&str]| {
        let mut command = program(&python, &[script]);
        run(command.args(arguments).env("PYTHONDONTWRITEBYTECODE", "1"))
    };

    let short = ["run", scene, "--frames", "40", "--quiet"];
    let valid = || run(&mut program("node", &["xtask/validate_gltf.mjs", &validator, &gltf]));
    for springs in ["none", "lines"] {
        let files = outputs(&[&archive, &crate_file, &text, &package, &gltf]);
        run(sprung(&short).args(["--springs", springs]).args(files))?;
        checked(
            "xtask/check_usd.py",
            &[&archive, title, "Y", "1", frame_time, &crate_file, &text, &package],
        )?;
        checked("xtask/check_gltf.py", &[&archive, frame_time, "clip", &gltf])?;
        valid()?;
    }
    // In another unit with another axis up; of glTF the still shape of one moment.
    let turned = ["--up", "z", "--scale", "100", "-o", &crate_file, "-o", &text, "-o", &package];
    run(sprung(&short).args(turned))?;
    checked("xtask/check_usd.py", &[&archive, title, "Z", "100", frame_time, &crate_file, &text, &package])?;
    run(sprung(&short).args(["--at", "1.0", "-o", &gltf]))?;
    checked("xtask/check_gltf.py", &[&archive, frame_time, "25", &gltf])?;
    valid()?;
    // A mesh that points carry along is held against the .ply files, which other readers are tried on; so are faces.
    for (scene, title, springs) in
        [(PEBBLE, TITLES[0], "none"), (PEBBLE, TITLES[0], "lines"), (TOWEL, TITLES[1], "none")]
    {
        fresh_folder("usd-check")?;
        let files = outputs(&[&archive, &ply, &crate_file, &text, &package, &gltf]);
        run(sprung(&from_a_mesh(scene, springs)).args(files))?;
        let usd = [&archive, title, "Y", "1", frame_time, &crate_file, &text, &package];
        checked("xtask/check_usd.py", &usd)?;
        checked("xtask/check_gltf.py", &[&archive, frame_time, "clip", &gltf])?;
        valid()?;
    }
    Ok(())
}

/// A body made from a mesh, with as many frames a second as [`SCENE`].
fn from_a_mesh<'a>(scene: &'a str, springs: &'a str) -> [&'a str; 9] {
    ["run", scene, "--fps", "25", "--frames", "20", "--quiet", "--springs", springs]
}

/// Blender itself imports the files and shows every vertex where the archive has it, frame after frame: meshes, caches that move
/// them, USD and glTF. It is a Python module for one version of Python alone; where that is not installed, this says so.
pub fn blender() -> Outcome {
    if !succeeds(&mut program("python3.11", &["--version"])) {
        return Err("Blender's Python module needs Python 3.11, and there is no python3.11".to_owned());
    }
    let python = python_with("venv-blender", "python3.11", &["bpy==4.5.*"])?;
    let checked = |script: &str, arguments: &[&str]| {
        let mut command = program(&python, &[script]);
        run(command.args(arguments).env("PYTHONDONTWRITEBYTECODE", "1"))
    };
    for scene in ["jelly", "cloth", PEBBLE, TOWEL] {
        let folder = fresh_folder("blender-check")?;
        let arguments = ["run", scene, "--fps", "24", "--frames", "24", "--quiet", "--up", "z"];
        run(sprung(&arguments).args(outputs_in(&folder, &["npz", "pc2", "mdd", "obj", "ply"])))?;
        checked("xtask/check_blender.py", &[&folder.display().to_string()])?;
    }
    let bodies = ["run", SCENE.0, "--frames", "40", "--quiet"];
    for (arguments, more) in [(&bodies[..], &[][..]), (&from_a_mesh(PEBBLE, "none"), &["ply"])] {
        let folder = fresh_folder("blender-usd-check")?;
        let endings = ["npz", "usdc", "usda", "usdz", "glb"];
        run(sprung(arguments).args(outputs_in(&folder, &endings)).args(outputs_in(&folder, more)))?;
        let file = |ending: &str| folder.join(format!("run.{ending}")).display().to_string();
        let [archive, picture, crate_file, text, package, gltf] =
            ["npz", "png", "usdc", "usda", "usdz", "glb"].map(file);
        let read = [&archive, SCENE.2, &picture, &crate_file, &text, &package, &gltf];
        checked("xtask/check_blender_usd.py", &read.map(|argument| argument as &str))?;
    }
    Ok(())
}

/// `-o FOLDER/run.ENDING` for each ending.
fn outputs_in(folder: &Path, endings: &[&str]) -> Vec<String> {
    let output =
        |ending: &&str| ["-o".to_owned(), folder.join(format!("run.{ending}")).display().to_string()];
    endings.iter().flat_map(output).collect()
}

fn outputs<'a>(files: &[&'a str]) -> Vec<&'a str> {
    files.iter().flat_map(|file| ["-o", file]).collect()
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

/// The folder of Node.js modules with the validator, below the target folder.
fn gltf_validator() -> Outcome<String> {
    let folder = target().join("gltf-validator");
    let modules = folder.join("node_modules");
    if !Path::new(&modules).join("gltf-validator").is_dir() {
        let prefix = folder.display().to_string();
        run(&mut program("npm", &["install", "--silent", "--no-save", "--prefix", &prefix, VALIDATOR]))?;
    }
    Ok(modules.display().to_string())
}
