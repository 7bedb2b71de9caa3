//! Motion out: one file per format, chosen by the ending of the file's name.

mod apart;
mod colour;
mod csv;
mod faces;
pub mod geometry;
mod gltf;
mod mark;
mod mdd;
mod mesh_files;
mod npz;
mod numbers;
mod obj;
mod pc2;
mod ply;
mod sequence;
mod spool;
mod stored_zip;
mod usd;
mod vtk;
mod vtp;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use serde::{Deserialize, Serialize};
use sprung::energy::Energy;
use sprung::{Code, Error, Model, Params, Result, Snapshot};

pub use apart::{Writes, check_apart};
pub use csv::CSV;
pub use geometry::Geometry;
pub use gltf::GLB;
pub use mark::{FileMark, Mark};
pub use mdd::MDD;
pub use npz::NPZ;
pub use obj::OBJ;
pub use pc2::PC2;
pub use ply::PLY;
pub use usd::{USDA, USDC, USDZ};
pub use vtk::VTK;

use crate::files;

/// What an exporter may want to know about a run before its first frame.
#[derive(Clone, Debug)]
pub struct RunInfo {
    /// The scene's name, such as `jelly`.
    pub scene: String,
    /// The scene's title, such as "A cube of jelly falling on a plane".
    pub title: String,
    /// What is joined to what.
    pub model: Arc<Model>,
    /// Parameters at the start.
    pub params: Params,
    /// Simulated time from one frame to the next, s.
    pub frame_time: f64,
    /// How many frames are planned, from the first that is written: a run that ends early gives fewer, none gives more.
    pub frames: u64,
}

/// What a user may say about outputs. A checkpoint keeps it as JSON: a field that it does not know yet has its default.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Options {
    /// Width and height of pictures, in pixels; each format has its own default.
    pub size: Option<[u32; 2]>,
    /// Simulated time of the picture in a `.png`, s; the last frame by default.
    pub at: Option<f64>,
    /// The axis that points up in exported geometry.
    pub up: Up,
    /// Units of exported geometry per metre: 100 for centimetres.
    pub scale: f64,
    /// What becomes of springs; each format has its own default.
    pub springs: Option<Springs>,
    /// The bodies that are exported, by name; all by default.
    pub bodies: Option<Vec<String>>,
    /// Whether points alone are exported, and no surfaces.
    pub points: bool,
    /// The run takes checkpoints: what waits beside the output has a name, so that it is there after the run was killed.
    pub resumable: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            size: None,
            at: None,
            up: Up::Y,
            scale: 1.0,
            springs: None,
            bodies: None,
            points: false,
            resumable: false,
        }
    }
}

/// The axis that points up in a file. Scenes have +Y up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Up {
    /// As in scenes, Maya, Houdini and glTF.
    #[default]
    Y,
    /// As in Blender, Unreal and most of CAD: (x, y, z) is written as (x, −z, y).
    Z,
}

/// What becomes of springs in exported geometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Springs {
    /// They are left out.
    None,
    /// Lines between points, or curves.
    Lines,
    /// Tubes that can be rendered.
    Tubes,
}

/// Options that formats may take account of, by the names of their fields in [`Options`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heeds {
    /// [`Options::size`].
    Size,
    /// [`Options::at`].
    At,
    /// [`Options::up`], [`Options::scale`], [`Options::bodies`] and [`Options::points`].
    Geometry,
    /// [`Options::springs`].
    Springs,
}

/// How many bytes an output will take, if the run gets to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Estimate {
    /// So many, to the byte.
    Exact(u64),
    /// About so many.
    About(u64),
}

impl Estimate {
    /// The number of bytes.
    pub fn bytes(self) -> u64 {
        match self {
            Self::Exact(bytes) | Self::About(bytes) => bytes,
        }
    }
}

/// One recorded frame.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Counts from 0, the initial state.
    pub index: u64,
    /// Positions, velocities, step and time, in the user's order.
    pub snapshot: &'a Snapshot,
    /// Parameters at that moment.
    pub params: &'a Params,
    /// The energy ledger, where the run keeps one.
    pub energy: Option<&'a Energy>,
}

/// What was written.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// The finished file.
    pub path: PathBuf,
    /// Its size.
    pub bytes: u64,
    /// Frames in it.
    pub frames: u64,
}

/// An output being written. Dropped before [`finish`](Export::finish) it leaves nothing behind.
///
/// A frame that could not be taken does not spoil those before it: after an error from [`frame`](Export::frame),
/// `finish` still completes the file with the whole frames. So does a run that ends early for another reason.
pub trait Export {
    /// Takes one frame.
    ///
    /// # Errors
    /// [`sprung::Code::Unwritable`] if the disk is full or the file cannot be written.
    fn frame(&mut self, frame: &Frame<'_>) -> Result<()>;

    /// Completes the file with the whole frames taken so far and gives it its name.
    ///
    /// `progress` hears the share done, 0 to 1, where there is still work to do. When it breaks off, a format that still
    /// has pictures to draw gives up and leaves nothing behind; one that only has to close its file goes on.
    ///
    /// # Errors
    /// As [`frame`](Export::frame), and [`sprung::Code::Interrupted`] if `progress` broke off.
    fn finish(self: Box<Self>, progress: &mut Progress<'_>) -> Result<Written>;

    /// Puts everything taken so far safely on the disk and says what it takes to go on from here with
    /// [`Exporter::resume`]. From now on a file that is dropped unfinished stays: a checkpoint relies on it.
    ///
    /// # Errors
    /// As [`frame`](Export::frame), and [`Code::Unsupported`] for a format that cannot go on where it was stopped.
    fn mark(&mut self) -> Result<Mark> {
        Err(Error::new(Code::Unsupported, "cannot be taken up again after the run was killed"))
    }
}

/// Hears the share done, 0 to 1, and says whether to go on.
pub type Progress<'a> = dyn FnMut(f64) -> ControlFlow<()> + 'a;

/// A format: its ending, what it is, and how to begin a file of it.
#[derive(Clone, Copy)]
pub struct Exporter {
    /// The ending of file names, without the dot.
    pub ending: &'static str,
    /// What the file holds, in a phrase.
    pub description: &'static str,
    /// The options it takes account of.
    pub heeds: &'static [Heeds],
    /// Where it writes.
    pub writes: Writes,
    /// How many bytes it will take for [`RunInfo::frames`] frames. It writes nothing, and refuses what `open` refuses of
    /// run and options.
    pub estimate: fn(&RunInfo, &Options) -> Result<Estimate>,
    /// Begins a file.
    pub open: fn(&Path, &RunInfo, &Options) -> Result<Box<dyn Export>>,
    /// Goes on with a file of a run that was killed: what came after the mark is cut off, and the rest is checked to be
    /// what was marked. `None` for a format that cannot; a run with checkpoints then refuses it before it begins.
    ///
    /// What is written after that is, byte for byte, what would have been written without the interruption, even if that
    /// came in the middle of [`Export::finish`].
    pub resume: Option<Resume>,
}

impl Exporter {
    /// Whether an output that was being completed when the run was killed had been completed before that. `begun` is when
    /// the run began.
    pub fn is_complete(&self, path: &Path, mark: &Mark, begun: SystemTime) -> bool {
        match self.writes {
            Writes::Sequence => sequence::is_complete(path, mark, begun),
            // The list of a folder's files gets its name when they are all there.
            Writes::File | Writes::FileAndFolder => files::is_complete(path, begun),
        }
    }
}

/// See [`Exporter::resume`].
pub type Resume = fn(&Path, &RunInfo, &Options, &Mark) -> Result<Box<dyn Export>>;
