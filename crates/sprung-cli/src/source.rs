//! From what the user typed to a simulation: a built-in scene or a file, changed by `--set`.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sprung::scene::{self, Scene};
use sprung::{Code, Error, Inline, Result, Simulation, Workers};
use sprung_io::checkpoint::{self, Recording, Resumed, Saved, Stored};
use sprung_io::{files, import};

use crate::args::SceneArgs;
use crate::console::note;
use crate::memory;

/// What a scene is called that came through a pipe.
const HANDED_OVER: &str = "scene";

/// The scene with its changes, and the name to call it by.
pub fn scene(args: &SceneArgs) -> Result<(String, Scene)> {
    scene_and_file(args).map(|(name, scene, _)| (name, scene))
}

/// The same, and the file that it was read from, if it is in one: not built in, and not handed over by the shell.
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
    checkpoint::is_name(Path::new(text))
}

/// A simulation, its scene, and the name to call it by.
pub struct Begun {
    pub name: String,
    pub scene: Scene,
    pub simulation: Simulation,
    /// The scene's `substeps`; of a checkpoint those of the run that it is of, which may have had a frame rate of its own.
    pub steps_per_frame: u64,
}

impl Begun {
    fn new(name: String, scene: Scene, simulation: Simulation) -> Self {
        let steps_per_frame = simulation.params().substeps.into();
        Self { name, scene, simulation, steps_per_frame }
    }
}

/// The simulation of a scene at its start, or of a checkpoint.
pub fn begun(args: &SceneArgs, threads: Option<usize>) -> Result<Begun> {
    if !is_checkpoint(&args.scene) {
        let (name, scene) = scene(args)?;
        let simulation = simulation(&scene, threads)?;
        return Ok(Begun::new(name, scene, simulation));
    }
    let (path, saved) = saved(args)?;
    begun_from(path, &saved, threads)
}

/// The checkpoint that is named instead of a scene.
pub fn saved(args: &SceneArgs) -> Result<(&Path, Saved)> {
    if let Some(assignment) = args.set.first() {
        let error =
            Error::new(Code::Conflict, "changes a scene, and a checkpoint holds one that is under way");
        return Err(error.in_file(format!("--set {assignment}")).with_fix("leave it out"));
    }
    let path = Path::new(&args.scene);
    Ok((path, Stored::open(path)?.read(&memory::check)?))
}

/// The simulation that a checkpoint holds, with its scene.
pub fn resumed(path: &Path, saved: &Saved) -> Result<Resumed> {
    saved.resume(&memory::check).map_err(|error| error.in_file(path.display().to_string()))
}

/// The same, without a history, on so many threads.
pub fn begun_from(path: &Path, saved: &Saved, threads: Option<usize>) -> Result<Begun> {
    let Resumed { scene, mut simulation, .. } = resumed(path, saved)?;
    simulation.keep_history(0);
    simulation.set_workers(workers(threads)?);
    let mut begun = Begun::new(saved.scene_name.clone(), scene, simulation);
    if let Some(Recording { plan, .. }) = &saved.recording {
        begun.steps_per_frame = plan.steps_per_frame;
    }
    Ok(begun)
}

fn named(text: &str) -> Result<(String, Scene, Option<PathBuf>)> {
    let path = Path::new(text);
    if is_checkpoint(text) {
        let error = Error::new(Code::Unsupported, "is a checkpoint, and a scene is wanted here");
        return Err(error
            .in_file(text)
            .with_fix("`sprung run`, `sprung show` and `sprung view` take checkpoints"));
    }
    let looks_like_a_file = path.extension().is_some() || text.contains(['/', '\\']) || path.exists();
    match Scene::builtin(text) {
        Ok(scene) => Ok((text.to_owned(), scene, None)),
        Err(_) if looks_like_a_file => {
            let bytes = files::read_or_take(path, scene::MAX_BYTES)?;
            let scene = Scene::from_bytes(&bytes, text)?;
            if files::is_handed_over(path) {
                // It has no name, and lies in no folder.
                return Ok((HANDED_OVER.to_owned(), scene, None));
            }
            let name = path.file_stem().map_or(text.to_owned(), |stem| stem.to_string_lossy().into_owned());
            Ok((name, scene, Some(path.to_owned())))
        }
        Err(error) if text == "-" && cfg!(unix) => {
            Err(error.with_fix("/dev/stdin is a scene from the standard input"))
        }
        Err(error) if path.with_extension("toml").is_file() => {
            Err(error.with_fix(format!("did you mean {text}.toml?")))
        }
        Err(error) => Err(error),
    }
}

/// The simulation of a scene, without a history, after asking whether there is memory for it.
pub fn simulation(scene: &Scene, threads: Option<usize>) -> Result<Simulation> {
    check_memory(scene)?;
    let mut simulation = scene.simulation()?;
    simulation.keep_history(0);
    simulation.set_workers(workers(threads)?);
    Ok(simulation)
}

/// Asks whether there is memory for a scene.
pub fn check_memory(scene: &Scene) -> Result<()> {
    let checked = memory::check(scene.estimated_bytes(), "the scene");
    checked.map_err(|error| error.with_fix("use fewer points or a smaller radius"))
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
