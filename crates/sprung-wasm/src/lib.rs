//! The engine in WebAssembly: no file, no window, no graphics. It has two doors.
//!
//! For the npm package: what takes plain numbers and texts. The package's own JavaScript, in `npm/package`, stands between it
//! and a user: it checks what has types only there, and keeps typed arrays that do not die when memory grows.
//!
//! For the page's worker, with the feature `worker`: `PageDriver`, which takes and gives messages of the driver.

mod builder;
mod javascript;
mod pick;
mod scenes;
mod simulation;
mod tell;
#[cfg(feature = "worker")]
mod worker;

pub use builder::EngineBuilder;
pub use scenes::{scenes, version};
pub use simulation::EngineSimulation;
#[cfg(feature = "worker")]
pub use worker::{PageDriver, last_words};
