//! `.png`: one moment.

use std::io::Write;
use std::path::Path;

use sprung::{Code, Error, Params, Result, Snapshot};
use sprung_io::files::write_error;
use sprung_io::{
    Estimate, Export, Exporter, Frame, Heeds, Mark, Options, Pack, PartialFile, Progress, RunInfo, Unpack,
    Writes, Written,
};

use super::{about, go_on, picture_size};
use crate::image::Image;
use crate::motion::Motion;
use crate::view::{Quality, SceneView};

/// A single picture.
pub const PNG: Exporter = Exporter {
    ending: "png",
    description: "a picture of the last frame, or of the one nearest to --at",
    heeds: &[Heeds::Size, Heeds::At],
    writes: Writes::File,
    estimate,
    open,
    resume: Some(resume),
};

/// Width and height when nothing is said.
const DEFAULT_SIZE: [u32; 2] = [1280, 720];

fn estimate(_: &RunInfo, options: &Options) -> Result<Estimate> {
    Ok(about(options, DEFAULT_SIZE, 0.4))
}

fn open(path: &Path, info: &RunInfo, options: &Options) -> Result<Box<dyn Export>> {
    let size = picture_size(path, options, DEFAULT_SIZE)?;
    let file = PartialFile::create(path)?;
    Ok(Box::new(Picture {
        file,
        info: info.clone(),
        at: options.at,
        motion: Motion::new(info, size),
        chosen: None,
        frames: 0,
    }))
}

fn resume(path: &Path, info: &RunInfo, options: &Options, mark: &Mark) -> Result<Box<dyn Export>> {
    let size = picture_size(path, options, DEFAULT_SIZE)?;
    let [file] = mark.files_of(path)?;
    let mut unpack = Unpack::new(&mark.memory);
    let motion = Motion::unpack(info, size, &mut unpack)?;
    let chosen = match unpack.bool()? {
        true => Some((unpack.snapshot()?, unpack.params()?)),
        false => None,
    };
    unpack.end()?;
    let points = info.model.point_count();
    if let Some((snapshot, params)) = &chosen
        && (snapshot.positions.len() != points || params.validate(&info.model).is_err())
    {
        return Err(Mark::strange(path));
    }
    let file = PartialFile::resume(path, file)?;
    Ok(Box::new(Picture { file, info: info.clone(), at: options.at, motion, chosen, frames: mark.frames }))
}

struct Picture {
    file: PartialFile,
    info: RunInfo,
    at: Option<f64>,
    motion: Motion,
    chosen: Option<(Snapshot, Params)>,
    /// Looked at so far.
    frames: u64,
}

impl Export for Picture {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        let positions = &frame.snapshot.positions;
        self.motion.include(&self.info.model, frame.params, positions);
        // Without a time every frame is better than the one before it.
        let off = |time: f64| self.at.map_or(0.0, |at| (time - at).abs());
        match &mut self.chosen {
            Some((best, _)) if off(best.time) < off(frame.snapshot.time) => {}
            Some((best, params)) => {
                best.clone_from(frame.snapshot);
                *params = frame.params.clone();
            }
            chosen => *chosen = Some((frame.snapshot.clone(), frame.params.clone())),
        }
        self.frames += 1;
        Ok(())
    }

    fn finish(self: Box<Self>, progress: &mut Progress<'_>) -> Result<Written> {
        let Some((snapshot, params)) = &self.chosen else { return Err(no_frames(self.file.path())) };
        let path = self.file.path().to_owned();
        go_on(progress(0.0), &path)?;
        let view = SceneView::new(&self.info, &self.motion, Quality::Still);
        let image = view.picture(params, snapshot.time, &snapshot.positions);
        go_on(progress(0.8), &path)?;
        let mut file = self.file;
        write_png(&mut file, &image).map_err(|error| write_error(&path, &error))?;
        let bytes = file.finish()?;
        Ok(Written { path, bytes, frames: 1 })
    }

    fn mark(&mut self) -> Result<Mark> {
        let file = self.file.mark("", 0).map_err(|error| write_error(self.file.path(), &error))?;
        let mut pack = Pack::new();
        self.motion.pack(&mut pack);
        pack.u8(self.chosen.is_some().into());
        if let Some((snapshot, params)) = &self.chosen {
            pack.snapshot(snapshot).params(params);
        }
        Ok(Mark { frames: self.frames, files: vec![file], memory: pack.into_bytes() })
    }
}

/// Encodes a picture.
///
/// # Errors
/// Those of the writer.
pub fn write_png(writer: impl Write, image: &Image) -> std::io::Result<()> {
    let mut encoder = png::Encoder::new(writer, image.width, image.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header().map_err(io_error)?;
    writer.write_image_data(&image.rgb).map_err(io_error)?;
    writer.finish().map_err(io_error)
}

/// The error of an output that was completed before its first frame.
pub(super) fn no_frames(path: &Path) -> Error {
    Error::new(Code::Conflict, "got no frame, and needs at least one").in_file(path.display().to_string())
}

fn io_error(error: png::EncodingError) -> std::io::Error {
    match error {
        png::EncodingError::IoError(error) => error,
        other => std::io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::srgb;

    #[test]
    fn what_is_written_can_be_read_back() {
        let mut image = Image::new([37, 21], srgb(0xf0_f4_f8));
        image.blend(5, 7, srgb(0x12_34_56), 1.0);
        let mut bytes = Vec::new();
        write_png(&mut bytes, &image).expect("memory takes everything");
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("it is a PNG");
        let mut rgb = vec![0; reader.output_buffer_size().expect("it is small")];
        let frame = reader.next_frame(&mut rgb).expect("it holds a picture");
        assert_eq!((frame.width, frame.height), (37, 21));
        assert_eq!(rgb, image.rgb);
    }
}
