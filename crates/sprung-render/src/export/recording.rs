//! Pictures of what was seen, kept until they are written as an animation.
//!
//! A film is recorded before anybody has said where it is to go, and of any length. So the pictures wait, compressed, in
//! a temporary file without a name, and memory holds no more than where each of them begins. Writing goes on in small
//! pieces, between which a window can be drawn.

use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;

use sprung::{Code, Error, Result};
use sprung_io::files::{File, write_error};
use sprung_io::{PartialFile, Written};

use super::gif::{GifWriter, lessons, schedule};
use super::mp4::{FilmWriter, check_ffmpeg};
use super::png::no_frames;
use super::{GIF, MP4};
use crate::image::Image;
use crate::quantise::Palette;

/// Endings of the animations that a recording can become.
const ENDINGS: [&str; 2] = [GIF.ending, MP4.ending];

/// Pictures of what was seen, in order.
#[derive(Debug)]
pub struct Recording {
    file: BufWriter<File>,
    /// Where each picture begins, and the last one ends, bytes.
    starts: Vec<u64>,
    size: [u32; 2],
    rate: f64,
}

impl Recording {
    /// Begins to record pictures of this size (pixels), `rate` of which make a second of the animation.
    ///
    /// # Errors
    /// [`Code::Unwritable`] if there is no room for temporary files.
    pub fn new(size: [u32; 2], rate: f64) -> Result<Self> {
        let file = sprung_io::files::spool().map_err(full)?;
        Ok(Self { file: BufWriter::with_capacity(1 << 18, file), starts: vec![0], size, rate })
    }

    /// How many pictures there are.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Whether there is none yet.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Their width and height, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Takes the next picture.
    ///
    /// # Errors
    /// [`Code::Conflict`] for one of another size, [`Code::Unwritable`] if the disk is full; those before it are kept.
    pub fn push(&mut self, image: &Image) -> Result<()> {
        let [width, height] = self.size;
        if [image.width, image.height] != self.size {
            let sentence = format!(
                "a picture of {}x{} pixels does not fit a film of {width}x{height}",
                image.width, image.height
            );
            return Err(Error::new(Code::Conflict, sentence));
        }
        let start = self.starts.last().copied().unwrap_or(0);
        let write = || -> io::Result<u64> {
            let file = &mut self.file;
            // A picture that only half fitted the disk is written over by the next.
            if file.stream_position()? != start {
                file.seek(SeekFrom::Start(start))?;
            }
            let mut encoder = png::Encoder::new(&mut *file, width, height);
            encoder.set_color(png::ColorType::Rgb);
            encoder.set_depth(png::BitDepth::Eight);
            encoder.set_compression(png::Compression::Fastest);
            let mut writer = encoder.write_header().map_err(io::Error::other)?;
            writer.write_image_data(&image.rgb).map_err(io::Error::other)?;
            writer.finish().map_err(io::Error::other)?;
            file.flush()?;
            file.stream_position()
        }();
        self.starts.push(write.map_err(full)?);
        Ok(())
    }

    /// Begins to write the animation that the ending of `path` asks for.
    ///
    /// # Errors
    /// [`Code::Unsupported`] for another ending than `.gif` and `.mp4`, or without ffmpeg; [`Code::Conflict`] if there is
    /// no picture; [`Code::Unwritable`]. The recording is given back, to be written elsewhere.
    pub fn write_to(self, path: &Path) -> Result<Box<Writing>, (Box<Self>, Error)> {
        match self.try_write_to(path) {
            Ok((format, recording)) => Ok(Box::new(Writing { recording, format, next: 0 })),
            Err((recording, error)) => Err((Box::new(recording), error)),
        }
    }

    fn try_write_to(mut self, path: &Path) -> Result<(Format, Self), (Self, Error)> {
        match self.begin(path) {
            Ok(format) => Ok((format, self)),
            Err(error) => Err((self, error)),
        }
    }

    fn begin(&mut self, path: &Path) -> Result<Format> {
        let Some(last) = self.len().checked_sub(1) else { return Err(no_frames(path)) };
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some(ending) if ending == GIF.ending => {
                let file = PartialFile::create(path)?;
                let times: Vec<f64> = (0..self.len()).map(|frame| frame as f64 / self.rate).collect();
                let schedule = schedule(&times, 1.0 / self.rate);
                let pictures: Result<Vec<Image>> =
                    lessons(0, last).into_iter().map(|frame| self.picture(frame)).collect();
                let writer = GifWriter::begin(file, self.size, Palette::learn(&pictures?))?;
                Ok(Format::Gif { writer: Box::new(writer), schedule })
            }
            Some(ending) if ending == MP4.ending => {
                check_ffmpeg(path)?;
                let size = self.size.map(|side| side & !1); // film stores the colour of two by two pixels together
                Ok(Format::Film(FilmWriter::begin(PartialFile::create(path)?, size, self.rate)?))
            }
            _ => {
                let endings = ENDINGS.map(|ending| format!(".{ending}")).join(" and ");
                let sentence = format!("is no animation, and the endings of animations are {endings}");
                Err(Error::new(Code::Unsupported, sentence).in_file(path.display().to_string()))
            }
        }
    }

    /// Reads a picture back.
    fn picture(&mut self, frame: usize) -> Result<Image> {
        let [width, height] = self.size;
        let mut read = |(begin, end): (u64, u64)| -> io::Result<Vec<u8>> {
            self.file.flush()?;
            let file = self.file.get_mut();
            file.seek(SeekFrom::Start(begin))?;
            let mut bytes = vec![0; (end - begin) as usize];
            file.read_exact(&mut bytes)?;
            let decoder = png::Decoder::new(io::Cursor::new(bytes));
            let mut reader = decoder.read_info().map_err(io::Error::other)?;
            let mut rgb = vec![0; 3 * width as usize * height as usize];
            reader.next_frame(&mut rgb).map_err(io::Error::other)?;
            Ok(rgb)
        };
        let rgb = read((self.starts[frame], self.starts[frame + 1])).map_err(full)?;
        Ok(Image { width, height, rgb })
    }
}

/// A recording that is becoming a file. Dropped before its end, it leaves nothing behind.
pub struct Writing {
    recording: Recording,
    format: Format,
    next: usize,
}

enum Format {
    Gif { writer: Box<GifWriter>, schedule: Vec<(usize, u16)> },
    Film(FilmWriter),
}

impl Writing {
    /// The share that is written, 0 to 1.
    pub fn share_done(&self) -> f64 {
        self.next as f64 / self.count().max(1) as f64
    }

    /// Writes one more picture; what was written once all are.
    ///
    /// # Errors
    /// [`Code::Unwritable`] if the disk is full or ffmpeg stops; nothing is kept of the file then.
    pub fn go_on(mut self: Box<Self>) -> Result<Progressed> {
        if self.next == self.count() {
            return Ok(Progressed::Done(match self.format {
                Format::Gif { writer, .. } => writer.finish()?,
                Format::Film(writer) => writer.finish()?,
            }));
        }
        match &mut self.format {
            Format::Gif { writer, schedule } => {
                let (frame, delay) = schedule[self.next];
                let indices = writer.indices(&self.recording.picture(frame)?);
                writer.write(indices, delay)?;
            }
            Format::Film(writer) => {
                let image = self.recording.picture(self.next)?;
                writer.write(&even(image))?;
            }
        }
        self.next += 1;
        Ok(Progressed::Going(self))
    }

    fn count(&self) -> usize {
        match &self.format {
            Format::Gif { schedule, .. } => schedule.len(),
            Format::Film(_) => self.recording.len(),
        }
    }
}

/// How far a recording has got on its way to a file.
pub enum Progressed {
    /// There is more to write.
    Going(Box<Writing>),
    /// It is whole, and has its name.
    Done(Written),
}

/// The pixels of a picture without its last column and row where their number is odd.
fn even(image: Image) -> Vec<u8> {
    let [columns, rows] = [image.width, image.height].map(|side| (side & !1) as usize);
    if columns == image.width as usize {
        let mut rgb = image.rgb;
        rgb.truncate(3 * columns * rows);
        return rgb;
    }
    let lines = image.rgb.chunks_exact(3 * image.width as usize).take(rows);
    lines.flat_map(|line| &line[..3 * columns]).copied().collect()
}

fn full(error: io::Error) -> Error {
    write_error(Path::new("the recording"), &error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::srgb;

    fn recording(frames: u32, size: [u32; 2]) -> Recording {
        let mut recording = Recording::new(size, 25.0).expect("there is room for temporary files");
        for frame in 0..frames {
            let mut image = Image::new(size, srgb(0xee_f0_f2));
            image.blend(i64::from(frame), 3, srgb(0xc0_20_10), 1.0);
            recording.push(&image).expect("there is room");
        }
        recording
    }

    fn write(recording: Recording, path: &Path) -> Result<Written> {
        let mut writing = recording.write_to(path).map_err(|(_, error)| error)?;
        let mut before = 0.0;
        loop {
            match writing.go_on()? {
                Progressed::Done(written) => return Ok(written),
                Progressed::Going(further) => {
                    assert!(further.share_done() > before);
                    before = further.share_done();
                    writing = further;
                }
            }
        }
    }

    #[test]
    fn a_recording_becomes_an_animation() {
        let folder = tempfile::tempdir().expect("there is room for temporary files");
        let path = folder.path().join("film.gif");
        let written = write(recording(30, [33, 17]), &path).expect("it can be written");
        assert_eq!(written.frames, 30);
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let file = File::open(&path).expect("it is there");
        let mut decoder = options.read_info(io::BufReader::new(file)).expect("it is a GIF");
        let mut delays = Vec::new();
        while let Some(frame) = decoder.read_next_frame().expect("it is whole") {
            delays.push(frame.delay);
        }
        assert_eq!(delays, [4; 30]);
        assert_eq!(std::fs::read_dir(folder.path()).map(Iterator::count).ok(), Some(1));
    }

    #[test]
    fn nothing_is_left_of_one_that_is_given_up() {
        let folder = tempfile::tempdir().expect("there is room for temporary files");
        let writing = recording(5, [20, 20]).write_to(&folder.path().join("film.gif"));
        let writing = writing.map_err(|(_, error)| error).expect("it can be begun");
        drop(writing.go_on().expect("the first picture is written"));
        assert_eq!(std::fs::read_dir(folder.path()).map(Iterator::count).ok(), Some(0));
    }

    #[test]
    fn what_cannot_be_written_is_given_back() {
        let folder = tempfile::tempdir().expect("there is room for temporary files");
        let refused = recording(2, [20, 20]).write_to(&folder.path().join("film.bmp"));
        let Err((again, error)) = refused else { panic!("nobody writes .bmp") };
        assert_eq!(error.code(), Code::Unsupported);
        assert!(error.to_string().contains(".gif and .mp4"), "{error}");
        assert!(write(*again, &folder.path().join("film.gif")).is_ok());
        let Err((_, error)) = recording(0, [20, 20]).write_to(&folder.path().join("film.gif")) else {
            panic!("there is nothing to write")
        };
        assert_eq!(error.code(), Code::Conflict);
    }

    #[test]
    fn pictures_come_back_as_they_were_and_keep_their_size() {
        let mut recording = recording(3, [21, 9]);
        assert_eq!(recording.picture(2).expect("it is there").pixel(2, 3), Some([0xc0, 0x20, 0x10]));
        let other = Image::new([20, 9], srgb(0));
        assert_eq!(recording.push(&other).map_err(|error| error.code()), Err(Code::Conflict));
        assert_eq!(even(recording.picture(0).expect("it is there")).len(), 3 * 20 * 8);
    }
}
