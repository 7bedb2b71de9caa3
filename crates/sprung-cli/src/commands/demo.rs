//! The demonstration, where there is no window: a scene to an animation and a picture, and what to try next.

use super::run::run as record;
use crate::args::{RunArgs, SceneArgs};
use crate::console::say;

/// Ten simulated seconds at real-time speed, of the jelly unless another scene was asked for.
pub fn run(scene: Option<&SceneArgs>) -> sprung::Result<()> {
    let scene = scene.cloned().unwrap_or_else(|| SceneArgs { scene: "jelly".to_owned(), set: Vec::new() });
    // Of a scene file only the name, so that the files land in the current folder.
    let stem = std::path::Path::new(&scene.scene).file_stem().unwrap_or_default().to_os_string();
    let [film, picture] = ["gif", "png"].map(|ending| std::path::Path::new(&stem).with_extension(ending));
    say(format_args!("Ten seconds of {}, to {} and {}.", scene.scene, film.display(), picture.display()));
    record(&RunArgs {
        scene,
        output: vec![film, picture],
        frames: None,
        seconds: Some(10.0),
        fps: Some(25.0),
        settle: false,
        plot: None,
        at: None,
        size: None,
        threads: 1,
        quiet: false,
    })?;
    say("Try next:");
    say("  sprung scenes                        what else there is");
    say("  sprung show jelly                    how large dt may be, and why");
    say("  sprung run jelly --set dt=0.013      what happens beyond that");
    say("  sprung run cloth -o cloth.gif        a hanging cloth");
    say("  sprung new my.toml                   a scene of your own");
    Ok(())
}
