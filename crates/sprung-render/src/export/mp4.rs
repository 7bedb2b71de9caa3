//! `.mp4`: a film, encoded by ffmpeg where that is installed.

use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use sprung::{Code, Error, Result};
use sprung_io::files::write_error;
use sprung_io::{
    Estimate, Export, Exporter, Frame, Heeds, Options, PartialFile, Progress, RunInfo, Writes, Written,
};

use super::png::no_frames;
use super::spool::Spool;
use super::{about, go_on, picture_size};

/// A film.
/// What ffmpeg has been given cannot be taken back, so a film is not resumed.
pub const MP4: Exporter = Exporter {
    ending: "mp4",
    description: "a film (needs ffmpeg)",
    heeds: &[Heeds::Size],
    writes: Writes::File,
    estimate,
    open,
    resume: None,
};

/// Width and height when nothing is said.
const DEFAULT_SIZE: [u32; 2] = [1280, 720];

/// How long ffmpeg may take to tell its version.
const PATIENCE: Duration = Duration::from_secs(10);

/// Frames per second that players cope with.
const RATE_RANGE: (f64, f64) = (0.05, 1000.0);

fn estimate(run: &RunInfo, options: &Options) -> Result<Estimate> {
    let pictures = (run.frames as f64).min(RATE_RANGE.1 * run.frame_time * run.frames as f64);
    Ok(about(options, DEFAULT_SIZE, 0.04 * pictures))
}

fn open(path: &Path, info: &RunInfo, options: &Options) -> Result<Box<dyn Export>> {
    // Asked before the simulation, which may take long, and not after it.
    check_ffmpeg(path)?;
    // The colour of two by two pixels is stored together, so both sides must be even.
    let size = picture_size(path, options, DEFAULT_SIZE)?.map(|side| side & !1);
    Ok(Box::new(Film { file: PartialFile::create(path)?, spool: Spool::new(path, info, size, false)?, size }))
}

/// Whether there is an ffmpeg that can make a film of `path`.
pub(super) fn check_ffmpeg(path: &Path) -> Result<()> {
    probe(PATIENCE).map_err(|why| {
        let error = Error::new(Code::Unsupported, format!("a film is encoded by ffmpeg, and {why}"));
        error.with_fix("install ffmpeg, or write a .gif").in_file(path.display().to_string())
    })
}

/// Asks ffmpeg for its version; otherwise says why there is none to be had.
fn probe(patience: Duration) -> Result<(), String> {
    let none = |_| "there is none on this machine".to_owned();
    let mut command = Command::new("ffmpeg");
    command.arg("-version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = command.spawn().map_err(none)?;
    let deadline = Instant::now() + patience;
    loop {
        match child.try_wait().map_err(none)? {
            Some(status) if status.success() => return Ok(()),
            Some(status) => return Err(format!("the one on this machine does not work ({status})")),
            None if Instant::now() < deadline => std::thread::sleep(Duration::from_millis(5)),
            None => {
                let _ = child.kill();
                let _ = child.wait();
                return Err(format!("the one on this machine did not answer in {} s", patience.as_secs()));
            }
        }
    }
}

struct Film {
    file: PartialFile,
    spool: Spool,
    size: [u32; 2],
}

impl Export for Film {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        self.spool.push(frame)
    }

    fn finish(self: Box<Self>, progress: &mut Progress<'_>) -> Result<Written> {
        let Self { file, mut spool, size } = *self;
        let path = file.path().to_owned();
        if spool.times().is_empty() {
            return Err(no_frames(&path));
        }
        let (frames, rate) = shown(spool.times().len(), spool.info().frame_time);
        let mut writer = FilmWriter::begin(file, size, rate)?;
        let view = spool.view();
        spool.draw(
            &view,
            &frames,
            |image| image.rgb,
            |index, rgb| {
                writer.write(&rgb)?;
                go_on(progress((index + 1) as f64 / frames.len() as f64), &path)
            },
        )?;
        writer.finish()
    }
}

/// Which frames are shown, and how many of them in a second: no more than players cope with, and in real time.
fn shown(frames: usize, frame_time: f64) -> (Vec<usize>, f64) {
    let rate = 1.0 / frame_time;
    let every = (rate / RATE_RANGE.1).ceil().max(1.0);
    ((0..frames).step_by(every as usize).collect(), rate / every)
}

/// A film that takes one picture after the other. Dropped unfinished, ffmpeg is ended and the file is removed.
pub(super) struct FilmWriter {
    // Dropped in this order: ffmpeg must not write any more when its file is removed.
    encoder: Encoder,
    file: PartialFile,
    frames: u64,
}

impl FilmWriter {
    /// Begins a film of pictures of this size (both sides even) and so many of them in a second.
    pub fn begin(file: PartialFile, size: [u32; 2], rate: f64) -> Result<Self> {
        let rate = rate.clamp(RATE_RANGE.0, RATE_RANGE.1);
        let encoder = Encoder::start(file.partial_path(), size, rate);
        let encoder = encoder.map_err(|error| write_error(file.path(), &error))?;
        Ok(Self { encoder, file, frames: 0 })
    }

    /// Takes the next picture: three bytes for each pixel.
    pub fn write(&mut self, rgb: &[u8]) -> Result<()> {
        self.frames += 1;
        if self.encoder.write(rgb).is_ok() {
            return Ok(());
        }
        // ffmpeg closed its end, and its own words say why.
        let reason = self.encoder.finish().err().unwrap_or_else(|| "no more pictures".to_owned());
        Err(self.stopped(&reason))
    }

    /// Completes the film and gives it its name.
    pub fn finish(mut self) -> Result<Written> {
        if let Err(reason) = self.encoder.finish() {
            return Err(self.stopped(&reason));
        }
        let Self { file, frames, .. } = self;
        let path = file.path().to_owned();
        if std::fs::metadata(file.partial_path()).is_ok_and(|film| film.len() == 0) {
            let error = Error::new(Code::Unwritable, "cannot be written: ffmpeg wrote an empty file");
            return Err(error.in_file(path.display().to_string()));
        }
        let bytes = file.finish()?;
        Ok(Written { path, bytes, frames })
    }

    fn stopped(&self, reason: &str) -> Error {
        let sentence = format!("cannot be written: ffmpeg stopped with \"{reason}\"");
        Error::new(Code::Unwritable, sentence).in_file(self.file.path().display().to_string())
    }
}

/// A running ffmpeg. Dropped unfinished it is ended.
struct Encoder {
    child: Child,
    /// Reads what ffmpeg complains about, so that it never waits for us to.
    complaints: Option<std::thread::JoinHandle<String>>,
}

impl Encoder {
    fn start(output: &Path, [width, height]: [u32; 2], rate: f64) -> std::io::Result<Self> {
        let mut command = Command::new("ffmpeg");
        command.args([
            "-hide_banner",
            "-nostdin",
            "-loglevel",
            "error",
            "-y",
            "-f",
            "rawvideo",
            "-pix_fmt",
            "rgb24",
        ]);
        command.args([
            "-video_size",
            &format!("{width}x{height}"),
            "-framerate",
            &format!("{rate:.6}"),
            "-i",
            "pipe:0",
        ]);
        command.args(["-an", "-c:v", "libx264", "-crf", "18", "-preset", "medium"]);
        // Say which matrix turns RGB into what films hold, or players guess and the colours drift.
        command.args(["-vf", "scale=out_color_matrix=bt709:out_range=tv", "-pix_fmt", "yuv420p"]);
        command.args([
            "-colorspace",
            "bt709",
            "-color_primaries",
            "bt709",
            "-color_trc",
            "bt709",
            "-color_range",
            "tv",
        ]);
        command.args(["-movflags", "+faststart", "-f", "mp4"]).arg(output);
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        // Ctrl-C in a terminal reaches every process of the group; the film so far should still be completed.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn()?;
        let complaints = child.stderr.take().map(|mut pipe| {
            std::thread::spawn(move || {
                let mut bytes = Vec::new();
                let _ = pipe.read_to_end(&mut bytes);
                String::from_utf8_lossy(&bytes).into_owned()
            })
        });
        Ok(Self { child, complaints })
    }

    fn write(&mut self, rgb: &[u8]) -> std::io::Result<()> {
        self.child.stdin.as_mut().map_or(Ok(()), |pipe| pipe.write_all(rgb))
    }

    /// Waits for the end; if it is not a good one, gives the last line ffmpeg said.
    fn finish(&mut self) -> Result<(), String> {
        // The pipe is closed: no more pictures will come.
        self.child.stdin = None;
        let status = self.child.wait();
        let said = self.complaints.take().and_then(|thread| thread.join().ok()).unwrap_or_default();
        match status {
            Ok(status) if status.success() => Ok(()),
            Ok(status) => {
                let last = said.lines().map(str::trim).rfind(|line| !line.is_empty());
                Err(last.map_or_else(|| status.to_string(), str::to_owned))
            }
            Err(error) => Err(error.to_string()),
        }
    }
}

impl Drop for Encoder {
    fn drop(&mut self) {
        if self.complaints.is_some() {
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn films_keep_real_time() {
        for (frames, frame_time) in [(100, 0.04), (1000, 0.001), (715, 0.000_279_551), (3, 1e-6)] {
            let (shown, rate) = shown(frames, frame_time);
            assert!(rate <= RATE_RANGE.1);
            let (lasts, real) = (shown.len() as f64 / rate, frames as f64 * frame_time);
            assert!((lasts - real).abs() < 1.0 / rate, "{lasts} s instead of {real} s");
        }
        assert_eq!(shown(3, 0.04), (vec![0, 1, 2], 25.0));
    }
}
