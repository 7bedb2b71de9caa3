//! The window alone; `sprung` and `sprung view` open the same one.

#[cfg(not(target_arch = "wasm32"))]
use std::process::ExitCode;

#[cfg(not(target_arch = "wasm32"))]
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

#[cfg(target_arch = "wasm32")]
fn main() {
    sprung_app::web::start();
}
