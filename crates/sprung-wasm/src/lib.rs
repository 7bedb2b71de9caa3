//! The engine in WebAssembly, for the npm package: no file, no window, no graphics.
//!
//! What is exported here takes plain numbers and texts. The package's own JavaScript, in `npm/package`, stands between it
//! and a user: it checks what has types only there, and keeps typed arrays that do not die when memory grows.

mod builder;
mod javascript;
mod pick;
mod scenes;
mod simulation;
mod tell;

pub use builder::EngineBuilder;
pub use scenes::{scenes, version};
pub use simulation::EngineSimulation;
