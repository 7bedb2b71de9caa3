//! Random bytes for every parser, steered by the code that they reach: see fuzz/README.md.

use std::fs;
use std::path::{Path, PathBuf};

use crate::shell::{Outcome, cargo, root, run, target};
use crate::stages::{files_in, fresh_folder};

/// How long scenes are tried, checkpoints, and the meshes of each reader.
const SECONDS: [u32; 3] = [60, 30, 15];

/// What is tried, beginning with what, and how.
struct Campaign<'a> {
    /// The program in `fuzz/`.
    program: &'a str,
    /// Which of the readers that it has, if there are several.
    reader: Option<&'a str>,
    /// Files to begin with.
    seeds: PathBuf,
    seconds: u32,
    /// Of libFuzzer.
    options: &'a [&'a str],
}

/// Scene files, grown from those in `scenes/`; checkpoints, from those that the tests keep; and meshes for every reader, from a
/// small one of each form.
pub fn fuzz() -> Outcome {
    let [scenes, checkpoints, meshes] = SECONDS;
    Campaign {
        program: "scene",
        reader: None,
        seeds: scene_seeds()?,
        seconds: scenes,
        options: &["-dict=scene.dict", "-max_len=4096", "-mutate_depth=2", "-rss_limit_mb=2048"],
    }
    .run()?;
    Campaign {
        program: "checkpoint",
        reader: None,
        seeds: checkpoint_seeds()?,
        seconds: checkpoints,
        options: &["-max_len=8192", "-mutate_depth=2", "-rss_limit_mb=2048"],
    }
    .run()?;
    for seeds in mesh_seeds()? {
        let reader = seeds.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let options = ["-max_len=4096", "-rss_limit_mb=1024"];
        Campaign { program: "mesh", reader: Some(&reader), seeds, seconds: meshes, options: &options }
            .run()?;
    }
    Ok(())
}

impl Campaign<'_> {
    fn run(self) -> Outcome {
        let Self { program, reader, seeds, seconds, options } = self;
        let what = reader.map_or_else(|| program.to_owned(), |reader| format!("{program}-{reader}"));
        // What was found earlier is kept: it makes the next run start from where this one ended.
        let found = target().join(format!("fuzz-corpus-{what}"));
        let crashes = target().join("fuzz-crashes");
        for folder in [&found, &crashes] {
            fs::create_dir_all(folder)
                .map_err(|error| format!("{} cannot be made: {error}", folder.display()))?;
        }
        let mut command = cargo(&["run", "--locked", "--release", "--bin", program, "--"]);
        command
            // Cargo reads the compiler flags for coverage from fuzz/.cargo/config.toml when it runs there.
            .current_dir(root().join("fuzz"))
            .env_remove("RUSTFLAGS")
            .env_remove("CARGO_ENCODED_RUSTFLAGS")
            .env("SPRUNG_READER", reader.unwrap_or_default())
            .args([&found, &seeds])
            .arg(format!("-artifact_prefix={}/{what}-", crashes.display()))
            .arg(format!("-max_total_time={seconds}"))
            .args(options)
            .args(["-timeout=10", "-print_final_stats=1", "-verbosity=0"]);
        run(&mut command).map_err(|reason| {
            format!("{reason}; the input that did it is in target/fuzz-crashes, see fuzz/README.md for how to go on")
        })
    }
}

fn scene_seeds() -> Outcome<PathBuf> {
    let seeds = fresh_folder("fuzz-seeds-scene")?;
    for path in files_in(&root().join("scenes"))? {
        let name = path.file_name().unwrap_or_default();
        fs::copy(&path, seeds.join(name))
            .map_err(|error| format!("{} cannot be copied: {error}", path.display()))?;
    }
    Ok(seeds)
}

/// The checkpoints that the tests keep, as digits.
fn checkpoint_seeds() -> Outcome<PathBuf> {
    let seeds = fresh_folder("fuzz-seeds-checkpoint")?;
    for path in files_in(&root().join("crates/sprung-io/tests/checkpoints"))? {
        if path.extension().is_none_or(|ending| ending != "hex") {
            continue;
        }
        let failed = |error| format!("{} cannot be made a seed: {error}", path.display());
        let digits = fs::read_to_string(&path).map_err(failed)?;
        let digits: Vec<char> = digits.chars().filter(char::is_ascii_hexdigit).collect();
        let byte = |pair: &[char]| u8::from_str_radix(&pair.iter().collect::<String>(), 16).unwrap_or(0);
        let bytes: Vec<u8> = digits.chunks(2).map(byte).collect();
        fs::write(seeds.join(path.file_stem().unwrap_or_default()), bytes).map_err(failed)?;
    }
    Ok(seeds)
}

/// A folder for each reader of meshes, named by its ending. A test writes the samples that it reads: they are made there, and
/// are of use here.
fn mesh_seeds() -> Outcome<Vec<PathBuf>> {
    let seeds = fresh_folder("fuzz-seeds-mesh")?;
    let mut samples =
        cargo(&["test", "--locked", "--quiet", "-p", "sprung-io", "--test", "imports", "formats"]);
    run(samples.env("SPRUNG_WRITE_SAMPLES", &seeds))?;
    folders_in(&seeds)
}

/// The folders in a folder, sorted.
fn folders_in(folder: &Path) -> Outcome<Vec<PathBuf>> {
    let failed = |error| format!("{} cannot be read: {error}", folder.display());
    let paths = fs::read_dir(folder).map_err(failed)?.flatten().map(|entry| entry.path());
    let mut folders: Vec<PathBuf> = paths.filter(|path| path.is_dir()).collect();
    folders.sort();
    Ok(folders)
}
