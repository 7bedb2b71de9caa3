//! A finished picture: rows of sRGB bytes, and the few things that are painted flat on top of it.

use glam::Vec2;

use crate::colour::{Colour, srgb, to_srgb};

/// A picture: rows from the top, each pixel red, green and blue in sRGB.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Three bytes for each pixel.
    pub rgb: Vec<u8>,
}

impl Image {
    /// A picture of one colour.
    pub fn new([width, height]: [u32; 2], colour: Colour) -> Self {
        let rgb = to_srgb(colour).repeat(width as usize * height as usize);
        Self { width, height, rgb }
    }

    /// The bytes of one pixel, or `None` outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        let start = 3 * self.index(i64::from(x), i64::from(y))?;
        self.rgb.get(start..start + 3)?.try_into().ok()
    }

    /// Lays a colour over a pixel, covering the share `alpha` of it. Outside the picture nothing happens.
    pub fn blend(&mut self, x: i64, y: i64, colour: Colour, alpha: f32) {
        let Some(index) = self.index(x, y) else { return };
        if alpha <= 0.0 {
            return;
        }
        let pixel = &mut self.rgb[3 * index..3 * index + 3];
        let [r, g, b] = [pixel[0], pixel[1], pixel[2]].map(u32::from);
        let mixed = srgb(r << 16 | g << 8 | b).lerp(colour, alpha.min(1.0));
        pixel.copy_from_slice(&to_srgb(mixed));
    }

    /// Fills a rectangle given by two corners in pixels; edges between pixels cover them in part.
    pub fn fill(&mut self, low: Vec2, high: Vec2, colour: Colour, alpha: f32) {
        for y in low.y.floor() as i64..high.y.ceil() as i64 {
            let cover_y = overlap(y as f32, low.y, high.y);
            for x in low.x.floor() as i64..high.x.ceil() as i64 {
                self.blend(x, y, colour, alpha * cover_y * overlap(x as f32, low.x, high.x));
            }
        }
    }

    /// Draws a smooth-edged disc.
    pub fn disc(&mut self, centre: Vec2, radius: f32, colour: Colour) {
        self.polyline(&[centre, centre], 2.0 * radius, &[], colour);
    }

    /// Draws a line of the given width with round joins; `dash` alternates lengths drawn and left out, in pixels.
    ///
    /// The line is painted once as a whole, so that it does not darken where it crosses or folds back on itself.
    pub fn polyline(&mut self, points: &[Vec2], width: f32, dash: &[f32], colour: Colour) {
        let reach = 0.5 * width + 1.0;
        let (mut low, mut high) = (Vec2::MAX, Vec2::MIN);
        for &point in points.iter().filter(|point| point.is_finite()) {
            low = low.min(point - reach);
            high = high.max(point + reach);
        }
        let low = low.max(Vec2::ZERO).floor();
        let high = high.min(Vec2::new(self.width as f32, self.height as f32)).ceil();
        if low.x >= high.x || low.y >= high.y {
            return;
        }
        let (columns, rows) = ((high.x - low.x) as usize, (high.y - low.y) as usize);
        let mut cover = vec![0.0f32; columns * rows];
        for (a, b) in dashes(points, dash) {
            let first = ((a.min(b) - reach).max(low) - low).floor();
            let last = ((a.max(b) + reach).min(high) - low).ceil();
            for row in first.y as usize..last.y.max(0.0) as usize {
                for column in first.x as usize..last.x.max(0.0) as usize {
                    let centre = low + Vec2::new(column as f32 + 0.5, row as f32 + 0.5);
                    let share = (0.5 + 0.5 * width - distance_to_segment(centre, a, b)).clamp(0.0, 1.0);
                    let slot = &mut cover[row * columns + column];
                    *slot = slot.max(share);
                }
            }
        }
        for (index, &share) in cover.iter().enumerate().filter(|&(_, &share)| share > 0.0) {
            let (x, y) = (low.x as i64 + (index % columns) as i64, low.y as i64 + (index / columns) as i64);
            self.blend(x, y, colour, share);
        }
    }

    fn index(&self, x: i64, y: i64) -> Option<usize> {
        let inside = (0..i64::from(self.width)).contains(&x) && (0..i64::from(self.height)).contains(&y);
        inside.then(|| y as usize * self.width as usize + x as usize)
    }
}

/// The share of the unit interval at `start` that lies between `low` and `high`.
fn overlap(start: f32, low: f32, high: f32) -> f32 {
    ((start + 1.0).min(high) - start.max(low)).clamp(0.0, 1.0)
}

fn distance_to_segment(p: Vec2, a: Vec2, b: Vec2) -> f32 {
    let along = b - a;
    let share = ((p - a).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
    (p - a - along * share).length()
}

/// The drawn pieces of a line; all of it if there is no dash pattern.
fn dashes(points: &[Vec2], dash: &[f32]) -> Vec<(Vec2, Vec2)> {
    let pieces =
        points.windows(2).map(|pair| (pair[0], pair[1])).filter(|(a, b)| a.is_finite() && b.is_finite());
    if dash.is_empty() || dash.iter().any(|&length| length < 0.5) {
        return pieces.collect();
    }
    let mut drawn = Vec::new();
    let (mut turn, mut left) = (0, dash[0]);
    for (a, b) in pieces {
        let length = (b - a).length();
        let mut from = 0.0;
        while from < length {
            let to = (from + left).min(length);
            if turn % 2 == 0 {
                drawn.push((a.lerp(b, from / length), a.lerp(b, to / length)));
            }
            left -= to - from;
            from = to;
            if left <= 0.0 {
                turn = (turn + 1) % dash.len();
                left = dash[turn];
            }
        }
    }
    drawn
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_covers_its_own_pixels_and_no_others() {
        let mut image = Image::new([20, 10], srgb(0xff_ff_ff));
        image.polyline(&[Vec2::new(2.0, 5.5), Vec2::new(18.0, 5.5)], 1.0, &[], srgb(0));
        assert_eq!(image.pixel(10, 5), Some([0, 0, 0]));
        assert_eq!(image.pixel(10, 2), Some([255, 255, 255]));
        assert_eq!(image.pixel(20, 5), None);
    }

    #[test]
    fn dashes_leave_their_gaps() {
        let mut image = Image::new([40, 5], srgb(0xff_ff_ff));
        image.polyline(&[Vec2::new(0.0, 2.5), Vec2::new(40.0, 2.5)], 1.0, &[10.0, 10.0], srgb(0));
        assert_eq!(image.pixel(5, 2), Some([0, 0, 0]));
        assert_eq!(image.pixel(15, 2), Some([255, 255, 255]));
        assert_eq!(image.pixel(25, 2), Some([0, 0, 0]));
    }
}
