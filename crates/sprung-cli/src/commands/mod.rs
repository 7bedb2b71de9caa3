//! One file per command.

mod bench;
mod demo;
mod new;
mod record;
mod run;
mod scenes;
mod show;

use sprung::{Code, Error, Result};

use crate::args::{Cli, Command};
use crate::console;

/// Does what the arguments say.
pub fn run(cli: Cli) -> Result<()> {
    match cli.command {
        None => demo::run(),
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
        Some(Command::Man) => man(),
    }
}

/// One page for the command and all of its sub-commands.
fn man() -> Result<()> {
    let mut page = Vec::new();
    let mut command = Cli::definition().flatten_help(true);
    command.build();
    clap_mangen::Man::new(command)
        .render(&mut page)
        .map_err(|error| Error::new(Code::Unwritable, format!("cannot make the manual page: {error}")))?;
    console::say(String::from_utf8_lossy(&page).trim_end());
    Ok(())
}
