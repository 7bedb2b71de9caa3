//! The driver: it owns a simulation for a front end, takes [`Command`]s and gives [`Report`]s.
//!
//! A front end never touches the simulation. It sends commands through a [`Handle`] and reads the newest report. Behind the
//! handle the [`Driver`] works inline (in tests and pages without a worker) or on a thread of its own.

mod command;
mod driver;
mod handle;
mod report;

pub use command::{Command, Edit, Pace, Probe, Pull, Source};
pub use driver::Driver;
pub use handle::Handle;
pub use report::{Comparison, Opened, Report, Sample, Stability, Timeline, Trouble};
