//! Files: meshes in, motion out, checkpoints, and the one place that knows paths.
//!
//! Exporters write to anything that is [`std::io::Write`] + [`std::io::Seek`]; [`files`] alone knows paths.

pub mod checkpoint;
pub mod export;
pub mod files;
pub mod import;
pub mod link;
mod pack;

pub use export::{
    Estimate, Export, Exporter, FileMark, Frame, Geometry, Heeds, Mark, Options, Progress, RunInfo, Springs,
    Up, Writes, Written, check_apart,
};
pub use files::PartialFile;
pub use pack::{Pack, Unpack};
