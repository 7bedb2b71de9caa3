//! Files: meshes in, motion out, and the one place that knows paths.
//!
//! Exporters write to anything that is [`std::io::Write`] + [`std::io::Seek`]; [`files`] alone knows paths.

pub mod export;
pub mod files;
pub mod import;

pub use export::{Export, Exporter, Frame, Options, Progress, RunInfo, Written};
pub use files::PartialFile;
