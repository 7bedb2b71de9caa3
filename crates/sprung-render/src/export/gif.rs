//! `.gif`: an animation that plays in real time and loops, at most 50 frames a second for ever.

use std::borrow::Cow;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sprung::Result;
use sprung_io::files::write_error;
use sprung_io::{
    Estimate, Export, Exporter, Frame, Heeds, Mark, Options, PartialFile, Progress, RunInfo, Writes, Written,
};

use super::png::no_frames;
use super::spool::Spool;
use super::{about, go_on, picture_size};
use crate::image::Image;
use crate::quantise::Palette;

/// An animation for everywhere.
pub const GIF: Exporter = Exporter {
    ending: "gif",
    description: "an animation that plays in real time and loops",
    heeds: &[Heeds::Size],
    writes: Writes::File,
    estimate,
    open,
    resume: Some(resume),
};

/// Width and height unless said otherwise, pixels.
const DEFAULT_SIZE: [u32; 2] = [800, 450];
/// The shortest delay that browsers respect, hundredths of a second.
const SHORTEST: u64 = 2;

fn estimate(run: &RunInfo, options: &Options) -> Result<Estimate> {
    let pictures = (run.frames as f64).min(100.0 / SHORTEST as f64 * run.frame_time * run.frames as f64);
    Ok(about(options, DEFAULT_SIZE, 0.2 * pictures))
}

fn open(path: &Path, info: &RunInfo, options: &Options) -> Result<Box<dyn Export>> {
    let size = picture_size(path, options, DEFAULT_SIZE)?;
    let file = PartialFile::create(path)?;
    Ok(Box::new(Animation { file, spool: Spool::new(path, info, size, options.resumable)?, size }))
}

/// Of the animation itself nothing is written before all frames are there, so there is nothing to go on with but them.
fn resume(path: &Path, info: &RunInfo, options: &Options, mark: &Mark) -> Result<Box<dyn Export>> {
    let size = picture_size(path, options, DEFAULT_SIZE)?;
    let [file, frames] = mark.files_of(path)?;
    let file = PartialFile::resume(path, file)?;
    let spool = Spool::resume(path, info, size, frames, &mark.memory)?;
    if spool.times().len() as u64 != mark.frames {
        return Err(Mark::strange(path));
    }
    Ok(Box::new(Animation { file, spool, size }))
}

struct Animation {
    file: PartialFile,
    spool: Spool,
    size: [u32; 2],
}

impl Export for Animation {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        self.spool.push(frame)
    }

    fn finish(self: Box<Self>, progress: &mut Progress<'_>) -> Result<Written> {
        let Self { file, mut spool, size } = *self;
        let path = file.path().to_owned();
        let schedule = schedule(spool.times(), spool.info().frame_time);
        let (Some(&(first, _)), Some(&(last, _))) = (schedule.first(), schedule.last()) else {
            return Err(no_frames(&path));
        };
        let view = spool.view();

        let lessons = lessons(first, last);
        let mut pictures = Vec::new();
        spool.draw(
            &view,
            &lessons,
            |image| image,
            |_, image| {
                pictures.push(image);
                go_on(progress(0.0), &path)
            },
        )?;
        let mut writer = GifWriter::begin(file, size, Palette::learn(&pictures))?;
        drop(pictures);
        let frames: Vec<usize> = schedule.iter().map(|&(frame, _)| frame).collect();
        let palette = writer.palette.clone();
        spool.draw(
            &view,
            &frames,
            |image: Image| palette.indices(&image),
            |index, indices| {
                writer.write(indices, schedule[index].1)?;
                go_on(progress((index + 1) as f64 / frames.len() as f64), &path)
            },
        )?;
        let written = writer.finish()?;
        spool.discard();
        Ok(written)
    }

    fn mark(&mut self) -> Result<Mark> {
        let file = self.file.mark("", 0).map_err(|error| write_error(self.file.path(), &error))?;
        let (frames, memory) = self.spool.mark()?;
        Ok(Mark { frames: self.spool.times().len() as u64, files: vec![file, frames], memory })
    }
}

/// A file that takes one picture after the other. Dropped unfinished, it is removed.
pub(super) struct GifWriter {
    path: PathBuf,
    encoder: gif::Encoder<PartialFile>,
    palette: Arc<Palette>,
    width: u16,
    before: Vec<u8>,
    frames: u64,
}

impl GifWriter {
    /// Begins an animation of pictures of this size, in the colours of a palette.
    pub fn begin(file: PartialFile, size: [u32; 2], palette: Palette) -> Result<Self> {
        let path = file.path().to_owned();
        let [width, height] = size.map(|side| side as u16); // at most 8192
        let encoder = gif::Encoder::new(file, width, height, palette.rgb());
        let mut encoder = encoder.map_err(|error| write_error(&path, &encoding(error)))?;
        encoder.set_repeat(gif::Repeat::Infinite).map_err(|error| write_error(&path, &encoding(error)))?;
        Ok(Self { path, encoder, palette: Arc::new(palette), width, before: Vec::new(), frames: 0 })
    }

    /// The palette's index for each pixel of a picture.
    pub fn indices(&self, image: &Image) -> Vec<u8> {
        self.palette.indices(image)
    }

    /// Takes the next picture, as indices, to be shown for `delay` hundredths of a second.
    pub fn write(&mut self, indices: Vec<u8>, delay: u16) -> Result<()> {
        let mut frame = changed_part(&self.before, &indices, self.width, self.palette.transparent());
        frame.delay = delay;
        self.encoder.write_frame(&frame).map_err(|error| write_error(&self.path, &encoding(error)))?;
        drop(frame);
        self.before = indices;
        self.frames += 1;
        Ok(())
    }

    /// Completes the file and gives it its name.
    pub fn finish(self) -> Result<Written> {
        let Self { path, encoder, frames, .. } = self;
        let file = encoder.into_inner().map_err(|error| write_error(&path, &encoding(error)))?;
        let bytes = file.finish()?;
        Ok(Written { path, bytes, frames })
    }
}

/// The palette is learnt from five pictures spread over the motion.
pub(super) fn lessons(first: usize, last: usize) -> Vec<usize> {
    let mut lessons: Vec<usize> = (0..5).map(|part| first + (last - first) * part / 4).collect();
    lessons.dedup();
    lessons
}

/// Which frames are shown, and for how long (hundredths of a second).
///
/// Delays are whole hundredths, so each picture is shown until the rounded time of the next: what rounding takes from one
/// the next gets back, and the animation keeps real time on average. Frames closer than two hundredths, which browsers
/// would slow down fivefold, are left out.
pub(super) fn schedule(times: &[f64], frame_time: f64) -> Vec<(usize, u16)> {
    let Some(&start) = times.first() else { return Vec::new() };
    let end = times.last().map_or(start, |last| last + frame_time.max(0.0));
    let at = |time: f64| ((time - start) * 100.0).round().max(0.0) as u64;
    let mut shown: Vec<(usize, u64)> = Vec::new();
    for (frame, &time) in times.iter().enumerate() {
        if shown.last().is_none_or(|&(_, last)| at(time) >= last + SHORTEST) {
            shown.push((frame, at(time)));
        }
    }
    let ends: Vec<u64> = shown.iter().skip(1).map(|&(_, begin)| begin).chain([at(end)]).collect();
    let delay = |(&(frame, begin), end): (&(usize, u64), u64)| {
        let delay = end.saturating_sub(begin).max(SHORTEST);
        (frame, u16::try_from(delay).unwrap_or(u16::MAX))
    };
    shown.iter().zip(ends).map(delay).collect()
}

/// The smallest rectangle that holds every pixel that changed; those within it that did not are transparent.
fn changed_part<'a>(before: &[u8], now: &'a [u8], width: u16, transparent: u8) -> gif::Frame<'a> {
    let columns = usize::from(width);
    let height = (now.len() / columns) as u16;
    let mut frame = gif::Frame { width, height, dispose: gif::DisposalMethod::Keep, ..gif::Frame::default() };
    if before.len() != now.len() {
        frame.buffer = Cow::Borrowed(now);
        return frame;
    }
    let rows = || before.chunks_exact(columns).zip(now.chunks_exact(columns));
    let differs = |(a, b): (&[u8], &[u8])| a != b;
    // A picture that did not change at all still needs one pixel to carry its delay.
    let top = rows().position(differs).unwrap_or(0);
    let bottom = rows().rposition(differs).unwrap_or(0);
    let (mut left, mut right) = (columns - 1, 0);
    for (a, b) in rows() {
        let differ = |column: &usize| a[*column] != b[*column];
        left = (0..left).find(differ).unwrap_or(left);
        right = (right + 1..columns).rev().find(differ).unwrap_or(right);
    }
    let right = right.max(left);
    let mut buffer = Vec::with_capacity((bottom - top + 1) * (right - left + 1));
    for (a, b) in rows().take(bottom + 1).skip(top) {
        let pixels = a[left..=right].iter().zip(&b[left..=right]);
        buffer.extend(pixels.map(|(old, new)| if old == new { transparent } else { *new }));
    }
    frame.left = left as u16;
    frame.top = top as u16;
    frame.width = (right - left + 1) as u16;
    frame.height = (bottom - top + 1) as u16;
    frame.transparent = Some(transparent);
    frame.buffer = Cow::Owned(buffer);
    frame
}

fn encoding(error: gif::EncodingError) -> io::Error {
    match error {
        gif::EncodingError::Io(error) => error,
        other => io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(count: usize, step: f64) -> Vec<f64> {
        (0..count).map(|frame| frame as f64 * step).collect()
    }

    #[test]
    fn animations_keep_real_time() {
        for (step, count) in [
            (0.07, 240),
            (0.11, 240),
            (1.0 / 30.0, 240),
            (1.0 / 60.0, 240),
            (1.0 / 24.0, 240),
            (0.005, 240),
            // Short ones, of which few pictures are left.
            (0.002_236, 91),
            (1.0 / 60.0, 11),
            (1e-6, 50),
        ] {
            let schedule = schedule(&times(count, step), step);
            let total: u64 = schedule.iter().map(|&(_, delay)| u64::from(delay)).sum();
            let real = count as f64 * step * 100.0;
            assert!((total as f64 - real).abs() <= 2.0, "step {step}: {total} instead of {real}");
            assert!(schedule.iter().all(|&(_, delay)| u64::from(delay) >= SHORTEST));
        }
    }

    #[test]
    fn rounding_is_carried_on() {
        let delays: Vec<u16> =
            schedule(&times(60, 1.0 / 30.0), 1.0 / 30.0).iter().map(|&(_, delay)| delay).collect();
        assert_eq!(delays[..6], [3, 4, 3, 3, 4, 3]);
    }

    #[test]
    fn odd_motions_have_a_schedule_too() {
        assert_eq!(schedule(&[], 0.1), []);
        assert_eq!(schedule(&[3.0], 0.1), [(0, 10)]);
        assert_eq!(schedule(&times(50, 1e-6), 1e-6), [(0, 2)]);
        assert_eq!(schedule(&times(2, 1e6), 1e6), [(0, u16::MAX), (1, u16::MAX)]);
    }

    #[test]
    fn only_what_changed_is_written() {
        let before = [1u8; 20]; // 5 x 4
        let mut now = before;
        now[6] = 9; // column 1, row 1
        now[13] = 8; // column 3, row 2
        let frame = changed_part(&before, &now, 5, 255);
        assert_eq!((frame.left, frame.top, frame.width, frame.height), (1, 1, 3, 2));
        assert_eq!(*frame.buffer, [9, 255, 255, 255, 255, 8]);
        let still = changed_part(&before, &before, 5, 255);
        assert_eq!((still.width, still.height, still.buffer.len()), (1, 1, 1));
    }
}
