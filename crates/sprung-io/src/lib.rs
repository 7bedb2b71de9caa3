//! Files: motion out, and the one place that knows paths.
//!
//! Exporters write to anything that is [`std::io::Write`] + [`std::io::Seek`]; [`files`] alone knows paths.

pub mod export;
pub mod files;

pub use export::{
    Estimate, Export, Exporter, Frame, Geometry, Heeds, Options, Progress, RunInfo, Springs, Up, Written,
};
pub use files::PartialFile;
