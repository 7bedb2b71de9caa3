//! `sprung scenes`: the built-in scenes.

use sprung::scene::{BUILTIN, Kind, Scene};

use crate::console::say;

/// Prints the list.
pub fn run() {
    let groups = [
        (Kind::Report, "The four scenes of the assignment"),
        (Kind::Gallery, "Gallery"),
        (Kind::Benchmark, "For measuring speed"),
    ];
    for (number, (kind, heading)) in groups.into_iter().enumerate() {
        say(format_args!("{}{heading}", if number == 0 { "" } else { "\n" }));
        for builtin in BUILTIN.iter().filter(|builtin| builtin.kind == kind) {
            let title = Scene::builtin(builtin.name).map(|scene| scene.title).unwrap_or_default();
            say(format_args!("  {:<12} {title}", builtin.name));
        }
    }
    say("\nTry `sprung show jelly` or `sprung run cloth -o cloth.gif`.");
}
