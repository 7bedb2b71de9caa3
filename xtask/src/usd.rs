//! USD and glTF held against their real readers: OpenUSD, the Khronos validator, two loaders, and Blender.

use std::path::Path;

use crate::shell::{Outcome, program, run, succeeds, target};
use crate::stages::{fresh_folder, python_with, sprung};

/// A scene with bodies of all kinds, and its title and time from frame to frame, s.
const SCENE: (&str, &str, &str) = ("xtask/readers.toml", "Three \"bodies\" \\ of all kinds", "0.04");
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
    let [archive, crate_file, text, package, gltf] = ["npz", "usdc", "usda", "usdz", "glb"].map(file);
    let checked = |script: &str, arguments: &[&str]| {
        let mut command = program(&python, &[script]);
        run(command.args(arguments).env("PYTHONDONTWRITEBYTECODE", "1"))
    };

    let short = ["run", scene, "--frames", "40", "--quiet"];
    let valid = || run(&mut program("node", &["xtask/validate_gltf.mjs", &validator, &gltf]));
    for springs in ["none", "lines"] {
        let outputs =
            [&archive, &crate_file, &text, &package, &gltf].into_iter().flat_map(|path| ["-o", path]);
        run(sprung(&short).args(["--springs", springs]).args(outputs))?;
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
    valid()
}

/// Blender imports the files, and shows every vertex where the archive has it, frame after frame.
pub fn blender() -> Outcome {
    if !succeeds(&mut program("python3.11", &["--version"])) {
        return Err("Blender's Python module needs Python 3.11, and there is no python3.11".to_owned());
    }
    let python = python_with("venv-blender", "python3.11", &["bpy==4.5.*"])?;
    let folder = fresh_folder("usd-blender-check")?;
    let (scene, _, frame_time) = SCENE;
    let files = ["npz", "usdc", "usda", "usdz", "glb"]
        .map(|ending| folder.join(format!("run.{ending}")).display().to_string());
    let outputs = files.iter().flat_map(|path| ["-o", path]);
    run(sprung(&["run", scene, "--frames", "40", "--quiet"]).args(outputs))?;
    let picture = folder.join("run.png").display().to_string();
    let mut command = program(&python, &["xtask/check_blender_usd.py", &files[0], frame_time, &picture]);
    run(command.args(&files[1..]).env("PYTHONDONTWRITEBYTECODE", "1"))
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
