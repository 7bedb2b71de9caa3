//! The engine in WebAssembly: no file, no window, no graphics.

mod worker;

pub use worker::{PageDriver, last_words};
