//! From what the user typed to a simulation: a built-in scene or a file, changed by `--set`.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sprung::scene::{self, Scene};
use sprung::{Code, Error, Inline, Result, Simulation, Workers};
use sprung_io::checkpoint::{self, Saved, Stored};
use sprung_io::{files, import};

use crate::args::SceneArgs;
use crate::console::note;
use crate::memory;

/// The scene with its changes, and the name to call it by.
pub fn scene(args: &SceneArgs) -> Result<(String, Scene)> {
    scene_and_file(args).map(|(name, scene, _)| (name, scene))
}

/// The same, and the file that it was read from, if it is not built in.
pub fn scene_and_file(args: &SceneArgs) -> Result<(String, Scene, Option<PathBuf>)> {
    let (name, mut scene, file) = named(&args.scene)?;
    for assignment in &args.set {
        let Some((key, value)) = assignment.split_once('=') else {
            let error = Error::new(Code::Syntax, "needs a key and a value, such as dt=0.005");
            return Err(error.in_file(format!("--set {assignment}")));
        };
        scene.set(key.trim(), value.trim())?;
    }
    for sentence in import::load_meshes(&mut scene, file.as_deref())? {
        note(format_args!("Note: {sentence}."));
    }
    Ok((name, scene, file))
}

/// Whether this names a checkpoint.
pub fn is_checkpoint(text: &str) -> bool {
    Path::new(text).extension().is_some_and(|ending| ending.eq_ignore_ascii_case(checkpoint::ENDING))
}

/// A simulation, its scene, and the name to call it by.
pub struct Begun {
    pub name: String,
    pub scene: Scene,
    pub simulation: Simulation,
}

/// The simulation of a scene at its start, or of a checkpoint.
pub fn begun(args: &SceneArgs, threads: Option<usize>) -> Result<Begun> {
    if !is_checkpoint(&args.scene) {
        let (name, scene) = scene(args)?;
        let simulation = simulation(&scene, threads)?;
        return Ok(Begun { name, scene, simulation });
    }
    if let Some(assignment) = args.set.first() {
        let error =
            Error::new(Code::Conflict, "changes a scene, and a checkpoint holds one that is under way");
        return Err(error.in_file(format!("--set {assignment}")).with_fix("leave it out"));
    }
    let path = Path::new(&args.scene);
    begun_from(path, &read(path, &Stored::open(path)?)?, threads)
}

/// Reads a checkpoint, after asking whether there is memory for it.
pub fn read(path: &Path, stored: &Stored) -> Result<Saved> {
    let named = |error: Error| error.in_file(path.display().to_string());
    memory::check(stored.memory(), "the checkpoint").map_err(named)?;
    stored.read()
}

/// The simulation that a checkpoint holds.
pub fn begun_from(path: &Path, saved: &Saved, threads: Option<usize>) -> Result<Begun> {
    let begun = || -> Result<Begun> {
        let scene = saved.scene()?;
        memory::check(scene.estimated_bytes(), "the scene in it")?;
        let (model, ..) = scene.build()?;
        let mut simulation = saved.simulation(model)?;
        simulation.keep_history(0);
        simulation.set_workers(workers(threads)?);
        Ok(Begun { name: saved.scene_name.clone(), scene, simulation })
    };
    begun().map_err(|error| {
        let place = error.place();
        let inner = place.field.as_ref().map(|field| format!("{field}: ")).unwrap_or_default();
        let sentence = format!("cannot be gone on with: {inner}{}", error.sentence());
        let outer = Error::new(error.code(), sentence).in_file(path.display().to_string());
        error.fix().map(str::to_owned).into_iter().fold(outer, Error::with_fix)
    })
}

fn named(text: &str) -> Result<(String, Scene, Option<PathBuf>)> {
    let path = Path::new(text);
    if is_checkpoint(text) {
        let error = Error::new(Code::Unsupported, "is a checkpoint, and a scene is wanted here");
        return Err(error.in_file(text).with_fix("`sprung run` and `sprung show` take checkpoints"));
    }
    let looks_like_a_file = path.extension().is_some() || text.contains(['/', '\\']) || path.exists();
    match Scene::builtin(text) {
        Ok(scene) => Ok((text.to_owned(), scene, None)),
        Err(_) if looks_like_a_file => {
            let bytes = files::read(path, scene::MAX_BYTES)?;
            let name = path.file_stem().map_or(text.to_owned(), |stem| stem.to_string_lossy().into_owned());
            Ok((name, Scene::from_bytes(&bytes, text)?, Some(path.to_owned())))
        }
        Err(error) if path.with_extension("toml").is_file() => {
            Err(error.with_fix(format!("did you mean {text}.toml?")))
        }
        Err(error) => Err(error),
    }
}

/// The simulation of a scene, without a history, after asking whether there is memory for it.
pub fn simulation(scene: &Scene, threads: Option<usize>) -> Result<Simulation> {
    memory::check(scene.estimated_bytes(), "the scene")?;
    let mut simulation = scene.simulation()?;
    simulation.keep_history(0);
    simulation.set_workers(workers(threads)?);
    Ok(simulation)
}

/// Worker threads to lend to the engine: so many, or one for each processor.
pub fn workers(threads: Option<usize>) -> Result<Arc<dyn Workers>> {
    let threads = threads.unwrap_or_else(processors);
    if threads == 1 {
        return Ok(Arc::new(Inline));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool
        .map_err(|error| Error::new(Code::Unsupported, format!("cannot start {threads} threads: {error}")))?;
    Ok(Arc::new(pool))
}

/// Processors that this program may use.
pub fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_knows_the_file_it_was_read_from() {
        let folder = tempfile::tempdir().expect("there is a disk");
        let path = folder.path().join("mine.toml");
        std::fs::write(&path, "[[body]]\nname = \"a\"\npoints = [[0, 0, 0]]\n").expect("it is ours");
        let args = |scene: &str| SceneArgs { scene: scene.to_owned(), set: Vec::new() };
        let (name, _, file) = scene_and_file(&args(&path.display().to_string())).expect("it is a scene");
        assert_eq!((name.as_str(), file), ("mine", Some(path)));
        assert_eq!(scene_and_file(&args("jelly")).expect("it is built in").2, None);
    }
}
