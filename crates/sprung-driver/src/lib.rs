//! The driver: it owns a simulation for a front end, takes [`Command`]s and gives [`Report`]s.
//!
//! A front end never touches the simulation. It sends commands through a [`Handle`] and reads the newest report. Behind the
//! handle the [`Driver`] works inline (in tests), on a thread of its own, or in a page's worker, which is reached by bytes alone:
//! there a [`Host`] has it.
//!
//! ```
//! use sprung::scene::Scene;
//! use sprung_driver::{Command, Driver, Handle, Source};
//!
//! let source = Source { name: "jelly".into(), scene: Scene::builtin("jelly")? };
//! let mut handle = Handle::inline(Driver::new(source)?);
//! handle.send(Command::Play(true));
//! handle.pass(0.1); // a tenth of a second: ten steps of 0.01 s
//! assert_eq!(handle.report().now.step, 10);
//! handle.send(Command::Seek(3));
//! assert_eq!(handle.report().now.step, 3);
//! # Ok::<(), sprung::Error>(())
//! ```

// So that the tests in here can share what those beside use.
#[cfg(test)]
extern crate self as sprung_driver;

mod command;
mod driver;
mod editing;
mod fixes;
mod ghost;
mod hand;
mod handle;
mod host;
mod job;
mod kept;
mod limits;
mod options;
mod pictures;
mod playing;
mod pulling;
mod remote;
mod report;
mod run;
mod samples;
mod settings;
mod substeps;
#[cfg(not(target_arch = "wasm32"))]
mod thread;
mod timeline;
mod turns;
mod undo;
mod wire;

pub use command::{Beginning, Command, Edit, Fix, Pace, Probe, Pull, Source};
pub use driver::Driver;
pub use hand::grab;
pub use handle::Handle;
pub use host::Host;
pub use kept::{Kept, Running};
pub use options::{DEFAULT_HISTORY_BYTES, Options};
pub use remote::{Post, Word};
pub use report::{Comparison, Opened, Report, Sample, Stability, Timeline, Trouble};
pub use samples::Samples;
