//! What a run will write: the options that its outputs heed, how large they will be, and whether there is room.

use std::path::{Path, PathBuf};

use sprung::{Code, Error, Result, significant as rounded};
use sprung_io::{Estimate, Exporter, Heeds, Options, RunInfo, Springs, Up, Writes, check_apart, files};
use sprung_render::export::{EXPORTERS, exporter_for};

use crate::args::{Axis, RunArgs, SpringStyle};
use crate::console::{bytes, counted, note, say};

/// Frames further apart than this make a film that visibly jumps, s.
const SMOOTH: f64 = 1.0 / 15.0;

/// Frames closer than this are more than any screen shows, s.
const FINE: f64 = 1.0 / 120.0;

/// Runs that write less than this do not say so beforehand, bytes.
const WORTH_TELLING: u64 = 100_000_000;

/// The outputs of a run, in the order in which they were given.
pub struct Outputs<'a> {
    planned: Vec<Planned<'a>>,
    /// From one frame to the next, s, where no rate was asked for.
    frame_time: Option<f64>,
}

/// What is known of an output beforehand.
struct Planned<'a> {
    path: &'a Path,
    estimate: Estimate,
    /// It holds one moment, however many frames the run has.
    is_still: bool,
    /// It is pictures that move.
    is_film: bool,
}

impl<'a> Outputs<'a> {
    /// Plans them.
    ///
    /// # Errors
    /// Those of an ending that nobody writes, of outputs that get into each other's way, of options that are of no use for
    /// these outputs, and of whatever the formats refuse of run and options.
    pub fn plan(args: &'a RunArgs, info: &RunInfo, options: &Options) -> Result<Self> {
        let exporters = args.output.iter().map(|path| exporter_for(path)).collect::<Result<Vec<_>>>()?;
        let mut places: Vec<(&Path, Writes)> =
            args.output.iter().zip(&exporters).map(|(path, exporter)| (&**path, exporter.writes)).collect();
        places.extend(args.plot.iter().chain(&args.checkpoint).map(|path| (&**path, Writes::File)));
        check_apart(&places)?;
        check_heeded(args, &exporters)?;
        check_resumable(args, &exporters)?;
        let estimate = |(path, exporter): (&'a PathBuf, &&Exporter)| {
            let named = |error: Error| error.in_file(path.display().to_string());
            let estimate = (exporter.estimate)(info, options).map_err(named)?;
            // What heeds a size is pictures, and with a moment it is a single one, whatever was said.
            let [at, size] = [Heeds::At, Heeds::Size].map(|heeds| exporter.heeds.contains(&heeds));
            let is_still = at && (size || options.at.is_some());
            Ok(Planned { path, estimate, is_still, is_film: size && !at })
        };
        let planned = args.output.iter().zip(&exporters).map(estimate).collect::<Result<_>>()?;
        Ok(Self { planned, frame_time: args.fps.is_none().then_some(info.frame_time) })
    }

    /// Whether there is room for all of them. What is known to the byte and does not fit is refused; of what is not, it
    /// warns.
    ///
    /// # Errors
    /// [`Code::TooLarge`].
    pub fn check_room(&self) -> Result<()> {
        let mut disks: Vec<(String, &Path)> =
            self.planned.iter().filter_map(|p| Some((files::disk_of(p.path)?, p.path))).collect();
        disks.sort();
        disks.dedup_by(|a, b| a.0 == b.0);
        for (disk, path) in disks {
            let Some(room) = files::room_beside(path) else { continue };
            let here = || self.planned.iter().filter(|p| files::disk_of(p.path).as_ref() == Some(&disk));
            let sum = |estimates: &mut dyn Iterator<Item = Estimate>| {
                estimates.fold(0u64, |sum, estimate| sum.saturating_add(estimate.bytes()))
            };
            let exact = sum(&mut here().map(|p| p.estimate).filter(|e| matches!(e, Estimate::Exact(_))));
            let all = sum(&mut here().map(|p| p.estimate));
            let place = |need: u64| {
                let what = if here().count() == 1 { "it needs" } else { "the outputs there need" };
                format!("{what} {}, and the disk has {} left", bytes(need), bytes(room))
            };
            if exact > room {
                let error = Error::new(Code::TooLarge, format!("will not fit: {}", place(exact)));
                let error = error.in_file(path.display().to_string());
                return Err(error.with_fix("write fewer frames, or to another disk"));
            }
            if all > room {
                note(format_args!("Warning: {} may not fit: {}.", path.display(), place(all)));
            }
        }
        Ok(())
    }

    /// Suggests a rate where frames are too far apart for a film, or closer than anybody looks.
    pub fn suggest_pace(&self) {
        let Some(frame_time) = self.frame_time else { return };
        let suggestion = if frame_time > SMOOTH && self.planned.iter().any(|p| p.is_film) {
            "--fps 25 makes a smoother film"
        } else if frame_time < FINE && self.planned.iter().any(|p| !p.is_still) {
            "--fps 24 makes fewer of them"
        } else {
            return;
        };
        note(format_args!("Frames are {} s apart; {suggestion}.", rounded(frame_time)));
    }

    /// Says how much will be written, if it is much.
    pub fn announce(&self) {
        let total = self.planned.iter().fold(0u64, |sum, p| sum.saturating_add(p.estimate.bytes()));
        if total >= WORTH_TELLING {
            let each: Vec<String> =
                self.planned.iter().map(|p| format!("{} {}", size(p.estimate), p.path.display())).collect();
            note(format_args!("Will write {}.", each.join(", ")));
        }
    }

    /// Says what would be written of so many frames, a line for each output.
    pub fn tell(&self, frames: u64) {
        for Planned { path, estimate, is_still, .. } in &self.planned {
            let frames = if *is_still { 1 } else { frames };
            say(format_args!("{}: {}, {}", path.display(), counted(frames, "frame"), size(*estimate)));
        }
    }
}

fn size(estimate: Estimate) -> String {
    match estimate {
        Estimate::Exact(count) => bytes(count),
        Estimate::About(count) => format!("about {}", bytes(count)),
    }
}

/// What was said about outputs.
pub fn options(args: &RunArgs) -> Options {
    let defaults = Options::default();
    Options {
        size: args.size,
        at: args.at,
        up: args.geometry.up.map_or(defaults.up, |up| match up {
            Axis::Y => Up::Y,
            Axis::Z => Up::Z,
        }),
        scale: args.geometry.scale.unwrap_or(defaults.scale),
        springs: args.geometry.springs.map(|style| match style {
            SpringStyle::None => Springs::None,
            SpringStyle::Lines => Springs::Lines,
            SpringStyle::Tubes => Springs::Tubes,
        }),
        bodies: (!args.geometry.body.is_empty()).then(|| args.geometry.body.clone()),
        points: args.geometry.points,
        resumable: args.checkpoint.is_some(),
    }
}

/// An option that none of the outputs heeds is refused: it was meant for something.
fn check_heeded(args: &RunArgs, exporters: &[&Exporter]) -> Result<()> {
    let given = [
        ("--size", Heeds::Size, args.size.is_some()),
        ("--at", Heeds::At, args.at.is_some()),
        ("--up", Heeds::Geometry, args.geometry.up.is_some()),
        ("--scale", Heeds::Geometry, args.geometry.scale.is_some()),
        ("--body", Heeds::Geometry, !args.geometry.body.is_empty()),
        ("--points", Heeds::Geometry, args.geometry.points),
        ("--springs", Heeds::Springs, args.geometry.springs.is_some()),
    ];
    for (name, heeds, _) in given.into_iter().filter(|&(.., is_given)| is_given) {
        if exporters.iter().any(|exporter| exporter.heeds.contains(&heeds)) {
            continue;
        }
        let endings: Vec<String> = EXPORTERS
            .iter()
            .filter(|exporter| exporter.heeds.contains(&heeds))
            .map(|exporter| format!(".{}", exporter.ending))
            .collect();
        let without = match (heeds, &endings[..]) {
            (Heeds::Size, _) => "without a picture".to_owned(),
            (_, [ending]) => format!("without a {ending}"),
            _ => "for these outputs".to_owned(),
        };
        return Err(of_no_use(name, &without, format!("add -o with a {}", one_of(&endings))));
    }
    if args.from.is_some() && args.output.is_empty() {
        return Err(of_no_use("--from", "without an output", "add -o FILE".into()));
    }
    Ok(())
}

/// In a run with checkpoints every output must be one that can be gone on with.
fn check_resumable(args: &RunArgs, exporters: &[&Exporter]) -> Result<()> {
    if args.checkpoint.is_none() {
        return match args.every {
            None => Ok(()),
            Some(_) => {
                Err(of_no_use("--every", "without a checkpoint", "add --checkpoint FILE.sprung".into()))
            }
        };
    }
    let Some(index) = exporters.iter().position(|exporter| exporter.resume.is_none()) else { return Ok(()) };
    let sentence = format!("a .{} cannot be gone on with after the run was killed", exporters[index].ending);
    let error = Error::new(Code::Unsupported, sentence).in_file(args.output[index].display().to_string());
    Err(error.with_fix("leave out --checkpoint, or this output"))
}

fn of_no_use(option: &str, without: &str, fix: String) -> Error {
    Error::new(Code::Conflict, format!("is of no use {without}")).in_file(option).with_fix(fix)
}

/// `.png, .gif or .mp4`.
fn one_of(endings: &[String]) -> String {
    match endings {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}
