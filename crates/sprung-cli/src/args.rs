//! The arguments: one definition for parsing, help, completions and the man page.

use std::path::PathBuf;
use std::time::Duration;

use clap::builder::RangedU64ValueParser;
use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use sprung_io::checkpoint::MOST_FRAMES;
use sprung_io::export::geometry::SCALE_RANGE;
use sprung_render::export::{EXPORTERS, SIZE_RANGE};

use crate::console::grouped;

/// Mass-spring animation: fast, exactly repeatable, and honest about how large a time step may be.
///
/// Without a command it opens the window. Where there is no display, it runs the demonstration: ten simulated seconds of a
/// cube of jelly, to jelly.gif and jelly.png in the current folder.
#[derive(Debug, Parser)]
#[command(name = "sprung", version, max_term_width = 100)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Option<Command>,
}

impl Cli {
    /// The whole definition, with the formats of the one list of exporters in the help.
    pub fn definition() -> clap::Command {
        let formats: Vec<String> = EXPORTERS
            .iter()
            .map(|exporter| format!(".{} ({})", exporter.ending, exporter.description))
            .collect();
        let help = format!(
            "A file to write, in the format of its ending: {}. May be given several times",
            formats.join(", ")
        );
        Self::command().mut_subcommand("run", |run| run.mut_arg("output", |output| output.help(help)))
    }
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Open the window, to watch, grab and change a scene
    View(ViewArgs),
    /// List the built-in scenes
    Scenes,
    /// Describe a scene or a checkpoint: points, springs, energy, and how large dt may be
    Show(ShowArgs),
    /// Simulate a scene and write its motion
    Run(Box<RunArgs>),
    /// Measure nanoseconds per spring and step
    Bench(BenchArgs),
    /// Write a commented scene file to start from
    New(NewArgs),
    /// Print the JSON Schema of scene files
    Schema,
    /// Print a completion script for a shell
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Print the manual page, or that of one command; `sprung man run | man -l -` shows it
    Man {
        /// The command
        command: Option<String>,
    },
}

/// A scene and what is changed of it.
#[derive(Clone, Debug, Args)]
pub struct SceneArgs {
    /// A built-in scene's name, or a scene file
    pub scene: String,
    /// Change a value of the scene, such as dt=0.005, gravity=[0,-1.62,0] or body.jelly.springs.stiffness=500
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

/// Arguments of `view`.
#[derive(Debug, Args)]
pub struct ViewArgs {
    /// A built-in scene's name, a scene file, or a checkpoint to go on with [default: the scene of last time]
    pub scene: Option<String>,
    /// Change a value of the scene, such as dt=0.005, gravity=[0,-1.62,0] or body.jelly.springs.stiffness=500
    #[arg(long, value_name = "KEY=VALUE", requires = "scene")]
    pub set: Vec<String>,
}

/// Arguments of `show`.
#[derive(Debug, Args)]
pub struct ShowArgs {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `run`.
#[derive(Debug, Default, Args)]
pub struct RunArgs {
    /// A built-in scene's name, a scene file, or a checkpoint whose state is to be the first frame
    #[arg(required_unless_present = "resume")]
    pub scene: Option<String>,
    /// Change a value of the scene, such as dt=0.005, gravity=[0,-1.62,0] or body.jelly.springs.stiffness=500
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// A file to write; its ending chooses the format
    #[arg(short, long, value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// Record frames 0 to N
    #[arg(long, value_name = "N", allow_negative_numbers = true, conflicts_with = "seconds", value_parser = RangedU64ValueParser::<u64>::new().range(0..=MOST_FRAMES))]
    pub frames: Option<u64>,
    /// Record this many simulated seconds, rounded up to whole frames [default: 10]
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = positive)]
    pub seconds: Option<f64>,
    /// Record F frames per simulated second; dt becomes the largest step not above it that divides such a frame.
    /// Otherwise a frame is `substeps` steps of `dt`
    #[arg(long, value_name = "F", allow_negative_numbers = true, value_parser = positive)]
    pub fps: Option<f64>,
    /// Bring the scene to rest first
    #[arg(long)]
    pub settle: bool,
    /// Draw the energy against time into a .svg or .png
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Simulated time of the picture in a .png, in seconds [default: the last frame]
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = not_negative)]
    pub at: Option<f64>,
    /// Width and height of pictures in pixels, such as 1920x1080
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size: Option<[u32; 2]>,
    /// Write no frame before this one; the run starts at 0 all the same
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = RangedU64ValueParser::<u64>::new().range(0..=MOST_FRAMES))]
    pub from: Option<u64>,
    /// What leaves of the geometry.
    #[command(flatten)]
    pub geometry: GeometryArgs,
    /// Say what would be simulated and written, and do neither
    #[arg(long)]
    pub dry_run: bool,
    /// Save the run into FILE.sprung every now and then, so that --resume can complete it if it is killed
    #[arg(long, value_name = "FILE.sprung")]
    pub checkpoint: Option<PathBuf>,
    /// How often to save a checkpoint: each time so much time has passed, such as 30s, 5m or 1h, or so many frames were
    /// recorded, such as 100 [default: 1m]
    #[arg(long, value_name = "TIME|N", allow_negative_numbers = true, value_parser = every)]
    pub every: Option<Every>,
    /// Complete a run that was killed, from its checkpoint: scene, outputs and options are in it, and the files become those
    /// of a run that was never stopped. --seconds or --frames make it longer or shorter
    #[arg(long, value_name = "FILE.sprung", conflicts_with_all = ["scene", "set", "output", "fps", "settle", "plot", "at", "size", "from", "up", "scale", "springs", "body", "points", "dry_run", "checkpoint"])]
    pub resume: Option<PathBuf>,
    /// Worker threads, the most that are used; the result is the same for any number [default: one for each processor]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = RangedU64ValueParser::<usize>::new().range(1..=1024))]
    pub threads: Option<usize>,
    /// No progress bar and no summary
    #[arg(short, long)]
    pub quiet: bool,
}

impl RunArgs {
    /// The scene and what is changed of it.
    pub fn scene(&self) -> SceneArgs {
        SceneArgs { scene: self.scene.clone().unwrap_or_default(), set: self.set.clone() }
    }
}

/// How often a checkpoint is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Every {
    /// After so many frames.
    Frames(u64),
    /// After so much time, as soon as a frame is whole.
    Time(Duration),
}

/// What of the geometry is exported, and how.
#[derive(Clone, Debug, Default, Args)]
pub struct GeometryArgs {
    /// The axis that points up in exported geometry: z turns (x, y, z) into (x, -z, y) [default: y, as in scenes]
    #[arg(long, value_name = "AXIS", ignore_case = true)]
    pub up: Option<Axis>,
    /// Units of exported geometry per metre, such as 100 for centimetres [default: 1]
    #[arg(long, value_name = "UNITS", allow_negative_numbers = true, value_parser = scale)]
    pub scale: Option<f64>,
    /// What becomes of springs in exported geometry [default: lines in a .pvd, none elsewhere]
    #[arg(long, value_name = "STYLE")]
    pub springs: Option<SpringStyle>,
    /// Export this body alone; may be given several times [default: all]
    #[arg(long, value_name = "NAME")]
    pub body: Vec<String>,
    /// Export points alone, without surfaces
    #[arg(long)]
    pub points: bool,
}

/// The axis that points up.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Axis {
    /// As in scenes, Houdini, Maya and three.js
    Y,
    /// As in Blender and Unreal
    Z,
}

/// What becomes of springs.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum SpringStyle {
    /// Left out
    None,
    /// Lines between points
    Lines,
    /// Six-sided tubes, to be rendered; lines in a .pvd
    Tubes,
}

/// Arguments of `bench`.
#[derive(Debug, Args)]
pub struct BenchArgs {
    /// Built-in scenes or scene files [default: the four scenes of the assignment and those for measuring speed]
    pub scenes: Vec<String>,
    /// Worker threads, the most that are used [default: one for each processor]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = RangedU64ValueParser::<usize>::new().range(1..=1024))]
    pub threads: Option<usize>,
    /// Print one JSON object per scene, each on a line of its own
    #[arg(long)]
    pub json: bool,
    /// Given by `cargo bench`; means nothing
    #[arg(long, hide = true)]
    pub bench: bool,
}

/// Arguments of `new`.
#[derive(Debug, Args)]
pub struct NewArgs {
    /// The scene file to write
    pub file: PathBuf,
}

fn finite(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "it must be a number".to_owned())?;
    if value.is_finite() { Ok(value) } else { Err("it must be finite".to_owned()) }
}

fn positive(text: &str) -> Result<f64, String> {
    let allowed = 1e-6..=1e9;
    let value = finite(text)?;
    if allowed.contains(&value) { Ok(value) } else { Err("it must be from 1e-6 to 1e9".to_owned()) }
}

fn scale(text: &str) -> Result<f64, String> {
    let value = finite(text)?;
    let (low, high) = (SCALE_RANGE.start(), SCALE_RANGE.end());
    if SCALE_RANGE.contains(&value) { Ok(value) } else { Err(format!("it must be from {low} to {high}")) }
}

/// `30s`, `5m`, `1h`, or a number of frames.
pub fn every(text: &str) -> Result<Every, String> {
    let units = [("ms", 0.001), ("s", 1.0), ("m", 60.0), ("h", 3600.0)];
    let told = "it must be a time such as 30s, 5m or 1h, or a number of frames such as 100";
    for (unit, seconds) in units {
        let Some(number) = text.strip_suffix(unit) else { continue };
        let time = finite(number).map_err(|_| told.to_owned())? * seconds;
        // Kept in a checkpoint as whole milliseconds.
        if !(0.001..=3.6e6).contains(&time) {
            return Err("a time must be from 1ms to 1000h, such as 30s".to_owned());
        }
        return Ok(Every::Time(Duration::from_secs_f64(time)));
    }
    match text.parse() {
        Ok(frames @ 1..=MOST_FRAMES) => Ok(Every::Frames(frames)),
        Ok(_) => Err(format!("a number of frames must be from 1 to {}", grouped(MOST_FRAMES))),
        Err(_) => Err(told.to_owned()),
    }
}

fn not_negative(text: &str) -> Result<f64, String> {
    let value = finite(text)?;
    if value >= 0.0 { Ok(value) } else { Err("it must be at least 0".to_owned()) }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let parse = |side: &str| side.parse().ok().filter(|side| SIZE_RANGE.contains(side));
    let sides = text.split_once(['x', 'X']).and_then(|(width, height)| Some([parse(width)?, parse(height)?]));
    let (low, high) = (SIZE_RANGE.start(), SIZE_RANGE.end());
    sides.ok_or_else(|| format!("it must be WIDTHxHEIGHT, each from {low} to {high}, such as 1280x720"))
}
