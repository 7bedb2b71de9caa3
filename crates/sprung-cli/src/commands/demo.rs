//! The demonstration, where there is no window: a scene to an animation and a picture, and what to try next.

use std::path::{Path, PathBuf};

use super::run::run as record;
use crate::args::{GeometryArgs, RunArgs, SceneArgs};
use crate::console::say;

/// Ten simulated seconds at real-time speed, of the jelly unless another scene was asked for.
pub fn run(scene: Option<&SceneArgs>) -> sprung::Result<()> {
    let scene = scene.cloned().unwrap_or_else(|| SceneArgs { scene: "jelly".to_owned(), set: Vec::new() });
    let [film, picture] = outputs(&scene.scene);
    say(format_args!("Ten seconds of {}, to {} and {}.", scene.scene, film.display(), picture.display()));
    record(&RunArgs {
        scene,
        output: vec![film, picture],
        frames: None,
        seconds: Some(10.0),
        fps: Some(25.0),
        settle: false,
        from: None,
        geometry: GeometryArgs::default(),
        dry_run: false,
        plot: None,
        at: None,
        size: None,
        threads: None,
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

/// The film and the picture of a scene, in the current folder: of a scene file only the name counts, without `.toml`.
fn outputs(scene: &str) -> [PathBuf; 2] {
    let stem = Path::new(scene).file_stem().unwrap_or_default();
    [".gif", ".png"].map(|ending| {
        let mut name = stem.to_os_string();
        name.push(ending);
        name.into()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outputs_are_named_after_the_scene_with_all_its_dots() {
        for (scene, film) in [
            ("jelly", "jelly.gif"),
            ("my.toml", "my.gif"),
            ("my.v2.toml", "my.v2.gif"),
            ("../scenes/a b.v1.5.toml", "a b.v1.5.gif"),
        ] {
            assert_eq!(outputs(scene)[0], Path::new(film));
        }
        assert_eq!(outputs("my.v2.toml")[1], Path::new("my.v2.png"));
    }
}
