//! The window alone; `sprung` and `sprung view` open the same one.

use std::process::ExitCode;

#[expect(clippy::print_stderr, reason = "the program says why it ends")]
fn main() -> ExitCode {
    sprung_app::run(sprung_app::Options::default()).map_or_else(
        |error| {
            eprintln!("sprung: {error}");
            ExitCode::from(error.exit_status())
        },
        |()| ExitCode::SUCCESS,
    )
}
