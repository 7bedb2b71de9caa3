//! `cargo bench`: what `sprung bench` prints.

use std::process::ExitCode;

fn main() -> ExitCode {
    // Called again for each scene as `sprung bench SCENE` would be.
    let arguments = std::env::args().skip(1).filter(|argument| argument != "bench");
    sprung_cli::main_with(["sprung".to_owned(), "bench".to_owned()].into_iter().chain(arguments)).into()
}
