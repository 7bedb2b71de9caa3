//! Whether two pictures show the same, though another driver drew them.
//!
//! Means over squares are compared, as those of the renderer's pictures are. Two things make pictures differ:
//!
//! - too many squares that differ, wherever they lie: the scene has moved, turned, or changed its colour;
//! - several that differ side by side: a word, a sign or a curve is missing. Where edges have moved, squares that
//!   differ by chance lie apart.

use std::path::{Path, PathBuf};

use sprung_render::Image;

use super::{png_file, squares};

/// Side of a square in a stored picture, which is half as wide and high as the window: 6 of the window's pixels, about
/// half the height of a line of text.
const SQUARE: u32 = 3;
/// A neighbourhood, in squares: as wide as a short word and a little higher.
const NEIGHBOURHOOD: [usize; 2] = [6, 3];
/// How many squares of one neighbourhood may differ.
const MOST_TOGETHER: usize = 6;

/// Compares a picture with the stored one, or stores it if `SPRUNG_UPDATE_PICTURES` is set. Gives what is wrong.
pub fn compare(stored: &Path, found: &Image) -> Option<String> {
    let fix = "look at it; if it is right, store it with SPRUNG_UPDATE_PICTURES=1";
    let drawn = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(stored.file_name().expect("it has a name"));
    png_file::write(&drawn, found);
    let found = png_file::reduced(found);
    if squares::updates() {
        png_file::write(stored, &found);
    }
    let Some(expected) = squares::read(stored) else {
        return Some(format!(
            "there is no stored picture {} of {}; {fix}",
            stored.display(),
            drawn.display()
        ));
    };
    let what = difference(&found, &expected)?;
    Some(format!("{} differs from {}: {what}; {fix}", drawn.display(), stored.display()))
}

/// In what two pictures differ, if they do.
fn difference(a: &Image, b: &Image) -> Option<String> {
    if (a.width, a.height) != (b.width, b.height) {
        return Some(format!("it has {} × {} pixels, not {} × {}", a.width, a.height, b.width, b.height));
    }
    let strays = squares::strays(a, b, SQUARE);
    let columns = a.width.div_ceil(SQUARE) as usize;
    if let Some((count, [x, y])) = thickest(&strays, columns).filter(|(count, _)| *count > MOST_TOGETHER) {
        return Some(format!(
            "{count} of {} squares around pixel ({x}, {y})",
            NEIGHBOURHOOD[0] * NEIGHBOURHOOD[1]
        ));
    }
    squares::too_many(&strays)
}

/// The largest number of strays in one neighbourhood, and the pixel in its middle.
fn thickest(strays: &[bool], columns: usize) -> Option<(usize, [usize; 2])> {
    let [width, height] = NEIGHBOURHOOD;
    let rows: Vec<&[bool]> = strays.chunks(columns).collect();
    let places = (0..=rows.len().checked_sub(height)?)
        .flat_map(|top| (0..=columns.saturating_sub(width)).map(move |left| [left, top]));
    let count = |[left, top]: [usize; 2]| {
        let inside = rows[top..top + height].iter().flat_map(|row| &row[left..(left + width).min(columns)]);
        inside.filter(|stray| **stray).count()
    };
    // In pixels of the window, of which a stored one has two.
    let middle = |[left, top]: [usize; 2]| {
        [(2 * left + width) * SQUARE as usize, (2 * top + height) * SQUARE as usize]
    };
    places.map(|place| (count(place), middle(place))).max_by_key(|(count, _)| *count)
}
