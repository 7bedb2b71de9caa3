//! USD and glTF held against their real readers: OpenUSD, the Khronos validator, two loaders, and Blender.

use std::path::Path;

use crate::shell::{Outcome, program, run, succeeds, target};
use crate::stages::{PEBBLE, fresh_folder, python_with, sprung};

/// A scene with bodies of all kinds, and its title and time from frame to frame, s.
const SCENE: (&str, &str, &str) = ("xtask/readers.toml", "Three \"bodies\" \\ of all kinds", "0.04");
/// The title of [`PEBBLE`].
const PEBBLE_TITLE: &str = "A pebble of jelly";
/// The Khronos validator, as npm knows it.
const VALIDATOR: &str = "gltf-validator@2.0.0-dev.3.10";

/// Every vertex of every time sample has the bits of the archive of the same run, and the formats' own validators have
/// nothing to say.
pub fn usd() -> Outcome {
    let python = python_with("venv-usd", "python3", &["numpy", "usd-core", "pygltflib", "trimesh"])?;
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
    // A mesh that points carry along is held against the .ply files, which other readers are tried on.
    for springs in ["none", "lines"] {
        fresh_folder("usd-check")?;
        let files = outputs(&[&archive, &ply, &crate_file, &text, &package, &gltf]);
        run(sprung(&pebble(springs)).args(files))?;
        let usd = [&archive, PEBBLE_TITLE, "Y", "1", frame_time, &crate_file, &text, &package];
        checked("xtask/check_usd.py", &usd)?;
        checked("xtask/check_gltf.py", &[&archive, frame_time, "clip", &gltf])?;
        valid()?;
    }
    Ok(())
}

/// The soft body with as many frames a second as [`SCENE`].
fn pebble(springs: &str) -> [&str; 9] {
    ["run", PEBBLE, "--fps", "25", "--frames", "20", "--quiet", "--springs", springs]
}

fn outputs<'a>(files: &[&'a str]) -> Vec<&'a str> {
    files.iter().flat_map(|file| ["-o", file]).collect()
}

/// Blender imports the files, and shows every vertex where the archive has it, frame after frame.
pub fn blender() -> Outcome {
    if !succeeds(&mut program("python3.11", &["--version"])) {
        return Err("Blender's Python module needs Python 3.11, and there is no python3.11".to_owned());
    }
    let python = python_with("venv-blender", "python3.11", &["bpy==4.5.*"])?;
    let (scene, _, frame_time) = SCENE;
    let bodies = ["run", scene, "--frames", "40", "--quiet"];
    for (arguments, endings) in [
        (&bodies[..], &["npz", "usdc", "usda", "usdz", "glb"][..]),
        (&pebble("none"), &["npz", "usdc", "usda", "usdz", "glb", "ply"]),
    ] {
        let folder = fresh_folder("usd-blender-check")?;
        let file = |ending: &&str| folder.join(format!("run.{ending}")).display().to_string();
        let files: Vec<String> = endings.iter().map(file).collect();
        run(sprung(arguments).args(files.iter().flat_map(|path| ["-o", path])))?;
        let picture = folder.join("run.png").display().to_string();
        let mut command = program(&python, &["xtask/check_blender_usd.py", &files[0], frame_time, &picture]);
        run(command.args(&files[1..5]).env("PYTHONDONTWRITEBYTECODE", "1"))?;
    }
    Ok(())
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
