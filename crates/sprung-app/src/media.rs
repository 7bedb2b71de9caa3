//! Pictures and films of what is seen: how they are made, and what becomes of them.

use std::path::PathBuf;

/// Bytes that wait to be saved; the files' door asks where.
#[derive(Clone, Debug, PartialEq)]
pub struct SaveRequest {
    /// The file name to suggest, with its ending.
    pub name: String,
    /// What the file is to hold.
    pub bytes: Vec<u8>,
}

/// How large pictures and films of what is seen are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PictureSize {
    /// As large as the view.
    #[default]
    Window,
    /// Twice as wide and as high.
    Twice,
    /// 1920 by 1080 pixels.
    FullHd,
}

impl PictureSize {
    /// All of them, for menus.
    pub const ALL: [Self; 3] = [Self::Window, Self::Twice, Self::FullHd];

    /// Its name in a menu.
    pub fn name(self) -> &'static str {
        match self {
            Self::Window => "as in the window",
            Self::Twice => "twice as wide and high",
            Self::FullHd => "1920 \u{d7} 1080",
        }
    }
}

/// Which time a film follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FilmClock {
    /// The simulation's: smooth at its own speed, however slowly it ran. Pauses are left out.
    #[default]
    Simulated,
    /// The clock on the wall: what was seen, pauses and all.
    Real,
}

impl FilmClock {
    /// All of them, for menus.
    pub const ALL: [Self; 2] = [Self::Simulated, Self::Real];

    /// Its name in a menu.
    pub fn name(self) -> &'static str {
        match self {
            Self::Simulated => "at the simulation's own time",
            Self::Real => "as it was seen",
        }
    }
}

/// A film that was recorded.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Film {
    /// There is none.
    #[default]
    None,
    /// It waits to be saved, under this name if nobody has a better one.
    Waits(String),
    /// It is to go there; the ending, `.gif` or `.mp4`, says as what.
    To(PathBuf),
    /// Nobody wants it.
    Unwanted,
}

/// How pictures and films are made, and what becomes of a film.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Filming {
    /// How large pictures and films are.
    pub size: PictureSize,
    /// Pictures in a second of a film.
    pub rate: u32,
    /// Which time a film follows.
    pub clock: FilmClock,
    /// The film that was recorded.
    pub film: Film,
}

impl Filming {
    /// How many pictures in a second are offered.
    pub const RATES: [u32; 3] = [25, 30, 50];
}

impl Default for Filming {
    fn default() -> Self {
        Self { size: PictureSize::default(), rate: 30, clock: FilmClock::default(), film: Film::None }
    }
}

/// A scene's name as part of a file's: letters, digits, dashes, dots; no folders.
pub fn file_stem(name: &str) -> String {
    let keep = |c: char| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '-' };
    let stem: String = name.chars().take(60).map(keep).collect();
    if stem.trim_matches(['-', '.']).is_empty() { "scene".to_owned() } else { stem }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_allowed_ones() {
        assert_eq!(file_stem("a/b\\c: d"), "a-b-c--d");
        assert_eq!(file_stem("two.words"), "two.words");
        assert_eq!(file_stem("../"), "scene");
        assert_eq!(file_stem(""), "scene");
    }
}
