//! The driver: it owns a simulation for a front end, takes [`Command`]s and gives [`Report`]s.
//!
//! A front end never touches the simulation. It sends commands through a [`Handle`] and reads the newest report. Behind the
//! handle the [`Driver`] works inline (in tests and pages without a worker) or on a thread of its own.
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

mod command;
mod driver;
mod editing;
mod fixes;
mod ghost;
mod hand;
mod handle;
mod job;
mod limits;
mod options;
mod pictures;
mod playing;
mod pulling;
mod report;
mod run;
mod samples;
mod settings;
mod substeps;
mod supervisor;
#[cfg(not(target_arch = "wasm32"))]
mod thread;
mod timeline;
mod undo;

pub use command::{Beginning, Bring, Command, Edit, Fix, Kept, Pace, Probe, Pull, Running, Source};
pub use driver::Driver;
pub use hand::soft_spring;
pub use handle::Handle;
pub use options::{DEFAULT_HISTORY_BYTES, Options};
pub use report::{Comparison, Opened, Report, Sample, Stability, Timeline, Trouble};
pub use samples::Samples;
