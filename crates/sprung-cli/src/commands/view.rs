//! `sprung view`, and `sprung` alone: the window, or the demonstration where there can be none.

use std::path::PathBuf;

#[cfg(not(feature = "window"))]
use sprung::Error;
use sprung::scene::Scene;
use sprung::{Code, Result};

use super::demo;
use crate::args::SceneArgs;
use crate::console::note;
#[cfg(feature = "window")]
use crate::memory;
use crate::source;

/// Opens the window on a scene, or on that of last time.
pub fn run(scene: Option<&SceneArgs>) -> Result<()> {
    // What is wrong with the scene is said before a window is tried.
    let opened = scene.map(source::scene_and_file).transpose()?;
    match window(opened) {
        Err(error) if error.code() == Code::NoWindow => {
            note(format_args!("sprung: {error}. Here is the demonstration instead."));
            demo::run(scene)
        }
        outcome => outcome,
    }
}

/// A scene, the name to call it by, and its file.
type Opened = (String, Scene, Option<PathBuf>);

#[cfg(feature = "window")]
fn window(opened: Option<Opened>) -> Result<()> {
    let (source, path) =
        opened.map_or((None, None), |(name, scene, path)| (Some(sprung_app::Source { name, scene }), path));
    let (memory_limit, workers) = (memory::available(), source::workers(None)?);
    sprung_app::run(sprung_app::Options { source, path, memory_limit, workers })
}

#[cfg(not(feature = "window"))]
fn window(_: Option<Opened>) -> Result<()> {
    let error = Error::new(Code::NoWindow, "this build of sprung has no window");
    Err(error.with_fix("build it with its default features"))
}
