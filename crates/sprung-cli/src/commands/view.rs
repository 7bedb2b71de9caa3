//! `sprung view`, and `sprung` alone: the window, or the demonstration where there can be none.

use std::path::PathBuf;

#[cfg(not(feature = "window"))]
use sprung::Error;
use sprung::scene::Scene;
use sprung::{Code, Params, Result, Simulation};
#[cfg(feature = "window")]
use sprung_app::{Beginning, Running, Source};
use sprung_io::checkpoint::Resumed;

use super::demo;
use crate::args::SceneArgs;
use crate::console::note;
#[cfg(feature = "window")]
use crate::memory;
use crate::source;

/// Opens the window on a scene or a checkpoint, or on that of last time.
pub fn run(scene: Option<&SceneArgs>) -> Result<()> {
    // What is wrong with the scene is said before a window is tried.
    let opened = scene.map(open).transpose()?;
    match window(opened) {
        Err(error) if error.code() == Code::NoWindow => {
            note(format_args!("sprung: {error}. Here is the demonstration instead."));
            demo::run(scene)
        }
        outcome => outcome,
    }
}

/// The name of a scene, the scene, what is under way of it if that is a checkpoint, and its file.
type Opened = (String, Scene, Option<(Params, Simulation)>, Option<PathBuf>);

fn open(args: &SceneArgs) -> Result<Opened> {
    if !source::is_checkpoint(&args.scene) {
        let (name, scene, path) = source::scene_and_file(args)?;
        return Ok((name, scene, None, path));
    }
    let (path, saved) = source::saved(args)?;
    let Resumed { scene, params, simulation } = source::resumed(path, &saved)?;
    Ok((saved.scene_name, scene, Some((params, simulation)), Some(path.to_owned())))
}

#[cfg(feature = "window")]
fn window(opened: Option<Opened>) -> Result<()> {
    let (beginning, path) = opened.map_or((None, None), |(name, scene, under_way, path)| {
        let beginning: Beginning = match under_way {
            None => Source { name, scene }.into(),
            Some((params, simulation)) => Running { name, scene, params: params.into(), simulation }.into(),
        };
        (Some(beginning), path)
    });
    let (memory_limit, workers) = (memory::available(), source::workers(None)?);
    sprung_app::run(sprung_app::Options { beginning, path, memory_limit, workers })
}

#[cfg(not(feature = "window"))]
fn window(_: Option<Opened>) -> Result<()> {
    let error = Error::new(Code::NoWindow, "this build of sprung has no window");
    Err(error.with_fix("build it with its default features"))
}
