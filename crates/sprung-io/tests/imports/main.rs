//! Meshes in: every format as programs write it, every kind of file that is broken, and files that nobody wrote.
#![allow(clippy::unwrap_used)]

mod broken;
mod folders;
mod formats;
mod random;
mod samples;
