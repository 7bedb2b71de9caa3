//! The `sprung` command: arguments in, one sentence out when something is wrong, exit status 0, 2, 3 or 130.

mod args;
mod commands;
mod console;
mod interrupt;
pub mod memory;
mod source;

use clap::FromArgMatches;
use std::ffi::OsString;

pub use args::Cli;
pub use source::{processors, workers};

/// Runs the command with the given arguments, the program's name first, and gives its exit status.
pub fn main_with<A: Into<OsString> + Clone>(args: impl IntoIterator<Item = A>) -> u8 {
    let parsed =
        Cli::definition().try_get_matches_from(args).and_then(|matches| Cli::from_arg_matches(&matches));
    let cli = match parsed {
        Ok(cli) => cli,
        Err(error) => return console::usage(&error),
    };
    match commands::run(cli).and_then(|()| console::lost().map_or(Ok(()), Err)) {
        Ok(()) => 0,
        Err(error) => {
            console::complain(&error);
            error.exit_status()
        }
    }
}
