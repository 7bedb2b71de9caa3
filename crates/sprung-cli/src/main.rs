//! The `sprung` command; all of it is in the library beside this file.

use std::process::ExitCode;

fn main() -> ExitCode {
    sprung_cli::main_with(std::env::args_os()).into()
}
