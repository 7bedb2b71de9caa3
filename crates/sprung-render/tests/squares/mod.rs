//! Whether two pictures show the same, though another driver drew them. The window's picture tests use it too.
//!
//! Drivers may place the samples of a pixel differently and round differently, which moves edges by a fraction of a pixel
//! and colours by a step or two. So not pixels are compared but means over squares of 6 pixels: a moved edge shifts a mean
//! by some steps, and a missing or wrong thing shifts many means by dozens.
#![allow(dead_code, reason = "each user takes what it needs")]

use std::path::Path;

use sprung_render::Image;

/// The most that a mean may differ, in steps of 255: an edge between black and white, moved by a quarter of a pixel
/// (half the distance of samples) along a whole square, shifts it by 255/4/6 = 11.
const TOLERANCE: f64 = 11.0;
/// The share of squares that may differ more: where several thin lines cross a square, their shifts add up.
const STRAY_SHARE: f64 = 0.004;

/// Which squares of two pictures of the same size differ, row by row. `side` is theirs, in pixels of these pictures.
pub fn strays(a: &Image, b: &Image, side: u32) -> Vec<bool> {
    let far = |(a, b): (&[f64; 3], &[f64; 3])| a.iter().zip(b).any(|(a, b)| (a - b).abs() > TOLERANCE);
    means(a, side).iter().zip(&means(b, side)).map(far).collect()
}

/// Says so if more squares differ than may by chance, wherever they lie.
pub fn too_many(strays: &[bool]) -> Option<String> {
    let share = strays.iter().filter(|stray| **stray).count() as f64 / strays.len() as f64;
    (share > STRAY_SHARE).then(|| format!("{:.1} % of its squares", 100.0 * share))
}

/// The mean colour of each square, row by row.
fn means(image: &Image, side: u32) -> Vec<[f64; 3]> {
    let mut means = Vec::new();
    for top in (0..image.height).step_by(side as usize) {
        for left in (0..image.width).step_by(side as usize) {
            let inside = (0..side).flat_map(|y| (0..side).map(move |x| (left + x, top + y)));
            let (mut sum, mut count) = ([0.0; 3], 0.0);
            for pixel in inside.filter_map(|(x, y)| image.pixel(x, y)) {
                sum.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += f64::from(value));
                count += 1.0;
            }
            means.push(sum.map(|sum| sum / count));
        }
    }
    means
}

/// A stored picture; `None` if there is none.
pub fn read(path: &Path) -> Option<Image> {
    let file = std::io::BufReader::new(std::fs::File::open(path).ok()?);
    let mut reader = png::Decoder::new(file).read_info().ok()?;
    let mut rgb = vec![0; reader.output_buffer_size()?];
    let frame = reader.next_frame(&mut rgb).ok()?;
    Some(Image { width: frame.width, height: frame.height, rgb })
}

/// Whether stored pictures are to be drawn anew.
pub fn updates() -> bool {
    std::env::var_os("SPRUNG_UPDATE_PICTURES").is_some()
}
