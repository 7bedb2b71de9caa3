//! No command: the demonstration.

use sprung::Result;

use super::run::run as record;
use crate::args::{RunArgs, SceneArgs};
use crate::console::say;

/// Ten simulated seconds of jelly at real-time speed.
pub fn run() -> Result<()> {
    say("A cube of jelly falls on a plane: ten seconds, to jelly.gif and jelly.png.");
    record(&RunArgs {
        scene: SceneArgs { scene: "jelly".to_owned(), set: Vec::new() },
        output: vec!["jelly.gif".into(), "jelly.png".into()],
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
