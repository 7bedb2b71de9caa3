//! Files: motion out, checkpoints, and the one place that knows paths.
//!
//! Exporters write to anything that is [`std::io::Write`] + [`std::io::Seek`]; [`files`] alone knows paths.

pub mod checkpoint;
pub mod export;
pub mod files;
mod pack;

pub use export::{Export, Exporter, FileMark, Frame, Mark, Options, Progress, RunInfo, Written};
pub use files::PartialFile;
pub use pack::{Pack, Unpack};
