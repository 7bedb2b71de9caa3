//! One file per command.

mod bench;
mod checkpoints;
mod demo;
mod limits;
mod new;
mod outputs;
mod record;
mod resume;
mod run;
mod scenes;
mod show;
mod view;

use sprung::{Code, Error, Result};

use crate::args::{Cli, Command, SceneArgs};
use crate::console;

/// Does what the arguments say.
pub fn run(cli: Cli) -> Result<()> {
    match cli.command {
        None => view::run(None),
        Some(Command::View(args)) => {
            view::run(args.scene.map(|scene| SceneArgs { scene, set: args.set }).as_ref())
        }
        Some(Command::Scenes) => {
            scenes::run();
            Ok(())
        }
        Some(Command::Show(args)) => show::run(&args),
        Some(Command::Run(args)) => run::run(&args),
        Some(Command::Bench(args)) => bench::run(&args),
        Some(Command::New(args)) => new::run(&args),
        Some(Command::Schema) => {
            console::say(sprung::scene::json_schema());
            Ok(())
        }
        Some(Command::Completions { shell }) => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::definition(), "sprung", &mut script);
            console::say(String::from_utf8_lossy(&script).trim_end());
            Ok(())
        }
        Some(Command::Man { command }) => man(command.as_deref()),
    }
}

/// The page of the whole command, or of one of its sub-commands.
fn man(name: Option<&str>) -> Result<()> {
    let mut whole = Cli::definition();
    whole.build();
    let command = match name {
        None => whole,
        Some(name) => whole.find_subcommand(name).cloned().ok_or_else(|| {
            let names: Vec<&str> = whole.get_subcommands().map(clap::Command::get_name).collect();
            let sentence = format!("there is no command \"{name}\"; there are {}", names.join(", "));
            Error::new(Code::NotFound, sentence)
        })?,
    };
    let mut page = Vec::new();
    clap_mangen::Man::new(command)
        .render(&mut page)
        .map_err(|error| Error::new(Code::Unwritable, format!("cannot make the manual page: {error}")))?;
    console::say(String::from_utf8_lossy(&page).trim_end());
    Ok(())
}
