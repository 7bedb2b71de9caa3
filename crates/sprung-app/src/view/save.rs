//! Pictures and films of what is seen.

use std::collections::VecDeque;
use std::path::PathBuf;

use sprung::{Code, Error, Result};
use sprung_render::Image;
use sprung_render::export::{Progressed, Recording, Writing, write_png};
use sprung_render::gpu::{Marks, Reading};
use web_time::{Duration, Instant};

use super::canvas::Canvas;
use crate::media::{self, FilmClock, PictureSize, SaveRequest, file_stem};
use crate::state::AppState;

/// How long a film may be written before the window is drawn again, s.
const PIECE: f64 = 0.012;
/// The same where drawing takes long: about as long as that, but the window must still answer.
const LONGEST_PIECE: f64 = 0.25;
/// The largest side of a picture, pixels.
const LARGEST: u32 = 8192;
/// The same picture fills at most so many of a film's at once: a window that stood still leaves no minutes of it.
const MOST_AT_ONCE: usize = 60;

/// What is being recorded or written.
#[derive(Default)]
enum Film {
    #[default]
    None,
    Recording {
        recording: Recording,
        clock: Clock,
    },
    /// Waits until somebody has said where it is to go.
    Waiting(Recording),
    Writing(Box<Writing>),
}

/// When the next picture of a film is due.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Clock {
    /// The time that it follows; another choice is for the next film.
    follows: FilmClock,
    /// Time of the film's first picture, s; later where a pause was left out, earlier where time was turned back.
    begin: f64,
    /// Pictures in a second.
    rate: f64,
}

impl Clock {
    /// How many pictures a film of so many lacks now: all that it shows until then, if time went on as it should.
    fn missing(&mut self, taken: usize, now: f64) -> usize {
        let picture = 1.0 / self.rate;
        let newest = self.begin + (taken as f64 - 1.0) * picture;
        if taken > 0 && now < newest - picture {
            // Time was turned back, and the film goes on from there.
            self.begin = now - taken as f64 * picture;
        }
        let missing = self.due(now).saturating_sub(taken);
        let left_out = missing.saturating_sub(MOST_AT_ONCE);
        self.begin += left_out as f64 * picture;
        missing - left_out
    }

    /// How many pictures there should be at a time: all those that the film shows until then.
    fn due(&self, now: f64) -> usize {
        // A hair earlier, so that a picture due at the very moment of a step is not missed by rounding.
        let last = ((now - self.begin) * self.rate + 1e-6).floor();
        if last >= 0.0 { last as usize + 1 } else { 0 }
    }
}

/// What a picture that is on its way back from the graphics card is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum For {
    /// To be saved by itself.
    Itself,
    /// So many pictures of the film.
    Film(usize),
}

/// Makes pictures and films.
#[derive(Default)]
pub struct Saver {
    film: Film,
    /// Pictures on their way back. Natively each is waited for; a page must go on meanwhile.
    coming: VecDeque<(Reading, For)>,
    /// Real time of this frame, s.
    real: f64,
}

impl Saver {
    /// Makes a picture and asks where to save it.
    pub fn picture(&mut self, canvas: &mut Canvas, state: &mut AppState, marks: &Marks, pixels: [u32; 2]) {
        let size = size_of(state.filming.size, pixels);
        let reading = canvas.picture(state, marks, size);
        if !self.is_recording() {
            canvas.close_album();
        }
        match reading {
            Some(reading) => {
                self.coming.push_back((reading, For::Itself));
                self.take_what_came(state);
            }
            None => state.refuse(no_card()),
        }
    }

    /// Takes the pictures that have come back, in order.
    fn take_what_came(&mut self, state: &mut AppState) {
        while let Some((reading, purpose)) = self.coming.pop_front() {
            let image = if cfg!(target_arch = "wasm32") { reading.look() } else { Ok(reading.wait()) };
            let taken = match image {
                Err(reading) => return self.coming.push_front((reading, purpose)),
                Ok(None) => Err(no_card()),
                Ok(Some(image)) => self.take_picture(&image, purpose, state),
            };
            if let Err(error) = taken {
                state.refuse(error);
            }
        }
    }

    fn take_picture(&mut self, image: &Image, purpose: For, state: &mut AppState) -> Result<()> {
        match (purpose, &mut self.film) {
            (For::Itself, _) => {
                let name = format!("{}.png", file_stem(&state.report.opened.name));
                state.save_requests.push(SaveRequest { name, bytes: encoded(image)? });
                Ok(())
            }
            (For::Film(count), Film::Recording { recording, .. }) => {
                (0..count).try_for_each(|_| recording.push(image))
            }
            // It came after the film's end.
            (For::Film(_), _) => Ok(()),
        }
    }

    /// Pictures of the film that are on their way.
    fn pictures_coming(&self) -> usize {
        let of_film = |purpose: &For| if let For::Film(count) = purpose { *count } else { 0 };
        self.coming.iter().map(|(_, purpose)| of_film(purpose)).sum()
    }

    /// Begins a film, or ends it and asks where to save it.
    pub fn toggle_film(&mut self, canvas: &mut Canvas, state: &mut AppState, pixels: [u32; 2]) {
        match std::mem::take(&mut self.film) {
            Film::None => {
                if !canvas.can_make_pictures() {
                    return state.refuse(no_card());
                }
                let size = size_of(state.filming.size, pixels).map(|side| (side & !1).max(16));
                let rate = f64::from(state.filming.rate.clamp(1, 60));
                match Recording::new(size, rate) {
                    Ok(recording) => {
                        let follows = state.filming.clock;
                        let clock = Clock { follows, begin: self.time(follows, state), rate };
                        self.film = Film::Recording { recording, clock };
                    }
                    Err(error) => state.refuse(error),
                }
            }
            Film::Recording { recording, .. } => {
                canvas.close_album();
                let name = format!("{}.gif", file_stem(&state.report.opened.name));
                state.filming.film = media::Film::Waits(name);
                self.film = Film::Waiting(recording);
            }
            // One after the other.
            other @ (Film::Waiting(_) | Film::Writing(_)) => self.film = other,
        }
    }

    /// Ends whatever goes on with a film, and leaves no half-written file.
    pub fn drop_film(&mut self) {
        self.film = Film::None;
    }

    /// Whether a film is being recorded.
    pub fn is_recording(&self) -> bool {
        matches!(self.film, Film::Recording { .. })
    }

    /// Takes the pictures that are due, or writes for some milliseconds; true if it wants to go on soon.
    pub fn go_on(&mut self, canvas: &mut Canvas, state: &mut AppState, marks: &Marks, real: f64) -> bool {
        // Half of the time between two pictures of the window, which writing is part of: as long as drawing takes.
        let piece = (0.5 * (real - self.real)).clamp(PIECE, LONGEST_PIECE);
        self.real = real;
        self.take_what_came(state);
        match std::mem::take(&mut self.film) {
            Film::None => return !self.coming.is_empty(),
            Film::Recording { recording, mut clock } => {
                let taken = recording.len() + self.pictures_coming();
                let missing = clock.missing(taken, self.time(clock.follows, state));
                let size = recording.size();
                self.film = Film::Recording { recording, clock };
                if missing > 0 {
                    // Where the window was slow, the same one again.
                    let reading = canvas.picture(state, marks, size);
                    self.coming.extend(reading.map(|reading| (reading, For::Film(missing))));
                }
                let troubles = state.refused.len();
                self.take_what_came(state);
                if state.refused.len() > troubles {
                    // What was recorded so far is kept.
                    self.toggle_film(canvas, state, [0, 0]);
                }
            }
            Film::Waiting(recording) => match std::mem::take(&mut state.filming.film) {
                media::Film::To(path) => self.begin_to_write(recording, path, state),
                waits @ media::Film::Waits(_) => {
                    state.filming.film = waits;
                    self.film = Film::Waiting(recording);
                }
                media::Film::None | media::Film::Unwanted => state.say("The film was not kept"),
            },
            Film::Writing(writing) => match write(writing, Duration::from_secs_f64(piece)) {
                Ok(Progressed::Going(writing)) => self.film = Film::Writing(writing),
                Ok(Progressed::Done(_)) => state.say("The film is saved"),
                Err(error) => state.refuse(error),
            },
        }
        matches!(self.film, Film::Recording { .. } | Film::Writing(_))
    }

    fn begin_to_write(&mut self, recording: Recording, path: PathBuf, state: &mut AppState) {
        match recording.write_to(&path) {
            Ok(writing) => self.film = Film::Writing(writing),
            Err((recording, error)) => {
                // Nothing is lost: another name may do.
                let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                state.filming.film = media::Film::Waits(name);
                state.refuse(error);
                self.film = Film::Waiting(*recording);
            }
        }
    }

    /// The time that a film follows, s.
    fn time(&self, follows: FilmClock, state: &AppState) -> f64 {
        match follows {
            FilmClock::Simulated => {
                let (before, now) = (state.report.before.time, state.report.now.time);
                before + (now - before) * state.report.blend
            }
            FilmClock::Real => self.real,
        }
    }

    /// What the badge says while something goes on.
    pub fn badge(&self) -> Option<String> {
        match &self.film {
            Film::None => None,
            Film::Recording { recording, .. } => Some(format!("recording: {}", pictures(recording.len()))),
            Film::Waiting(recording) => Some(format!("{} to be saved", pictures(recording.len()))),
            Film::Writing(writing) => Some(format!("writing {:.0} %", 100.0 * writing.share_done())),
        }
    }
}

fn pictures(count: usize) -> String {
    if count == 1 { "1 picture".to_owned() } else { format!("{count} pictures") }
}

fn write(mut writing: Box<Writing>, piece: Duration) -> Result<Progressed> {
    let begin = Instant::now();
    loop {
        match writing.go_on()? {
            Progressed::Going(further) if begin.elapsed() < piece => writing = further,
            other => return Ok(other),
        }
    }
}

/// The pixels of a picture of what fills so many of the window's.
fn size_of(size: PictureSize, pixels: [u32; 2]) -> [u32; 2] {
    let [width, height] = match size {
        PictureSize::Window => pixels,
        PictureSize::Twice => pixels.map(|side| 2 * side),
        PictureSize::FullHd => [1920, 1080],
    };
    [width, height].map(|side| side.clamp(16, LARGEST))
}

fn encoded(image: &Image) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    write_png(&mut bytes, image)
        .map_err(|error| Error::new(Code::Unwritable, format!("the picture cannot be encoded: {error}")))?;
    Ok(bytes)
}

fn no_card() -> Error {
    let sentence = "a picture of what is seen is drawn by a graphics driver, and this window has none";
    Error::new(Code::Unsupported, sentence).with_fix("use `sprung run SCENE -o NAME.png`")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_film_has_as_many_pictures_as_its_time_asks_for() {
        let clock = Clock { follows: FilmClock::Real, begin: 2.0, rate: 25.0 };
        assert_eq!([2.0, 2.039, 2.04, 3.0].map(|now| clock.due(now)), [1, 1, 2, 26]);
        assert_eq!(clock.due(0.0), 0);
    }

    /// Films so many pictures as are missing at each time, and gives how many those were.
    fn filmed<const N: usize>(times: [f64; N]) -> [usize; N] {
        let mut clock = Clock { follows: FilmClock::Real, begin: times[0], rate: 25.0 };
        let mut taken = 0;
        times.map(|now| {
            let missing = clock.missing(taken, now);
            taken += missing;
            missing
        })
    }

    #[test]
    fn a_long_pause_of_the_window_is_left_out_of_a_film() {
        // Not caught up with later, either.
        assert_eq!(filmed([0.0, 0.04, 100.04, 100.06, 100.08, 100.12]), [1, 1, MOST_AT_ONCE, 0, 1, 1]);
        // A short one is not.
        assert_eq!(filmed([0.0, 2.0, 2.04]), [1, 50, 1]);
    }

    #[test]
    fn a_film_goes_on_where_time_was_turned_back_to() {
        assert_eq!(filmed([0.0, 1.0, 0.0, 0.04, 0.08]), [1, 25, 1, 1, 1]);
        assert_eq!(filmed([1.0, 2.0, 1.5, 1.54, 0.0, 0.04]), [1, 25, 1, 1, 1, 1]);
        assert_eq!(filmed([5.0, 0.0, 0.04]), [1, 1, 1]);
        // The time shown lies between two steps, and may go back by less than a picture.
        assert_eq!(filmed([0.0, 1.0, 0.99, 1.0, 1.04]), [1, 25, 0, 0, 1]);
    }

    #[test]
    fn sizes_are_allowed_ones() {
        assert_eq!(size_of(PictureSize::Window, [3, 700]), [16, 700]);
        assert_eq!(size_of(PictureSize::Twice, [6000, 700]), [8192, 1400]);
        assert_eq!(size_of(PictureSize::FullHd, [1, 1]), [1920, 1080]);
    }
}
