//! The sprung command.
fn main() {}
