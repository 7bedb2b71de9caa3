//! 256 colours for an animation: one palette for all its pictures, and a light ordered dither.

use color_quant::NeuQuant;

use crate::image::Image;

/// Colours in a palette; one more index means "as it was".
const COLOURS: usize = 255;
/// Bits of each channel in the table of nearest colours.
const BITS: u32 = 6;
/// The most that dithering moves a channel, in steps of 8-bit colour: hides bands, too little to be seen as a pattern.
const DITHER: f32 = 5.0;

/// The 8x8 Bayer matrix. It stays with the pixel, not with the time, so that nothing crawls where nothing moves.
const BAYER: [[u8; 8]; 8] = [
    [0, 32, 8, 40, 2, 34, 10, 42],
    [48, 16, 56, 24, 50, 18, 58, 26],
    [12, 44, 4, 36, 14, 46, 6, 38],
    [60, 28, 52, 20, 62, 30, 54, 22],
    [3, 35, 11, 43, 1, 33, 9, 41],
    [51, 19, 59, 27, 49, 17, 57, 25],
    [15, 47, 7, 39, 13, 45, 5, 37],
    [63, 31, 55, 23, 61, 29, 53, 21],
];

/// A palette, and the nearest colour of it for every colour.
pub struct Palette {
    rgb: Vec<u8>,
    nearest: Vec<u8>,
}

impl Palette {
    /// Learns a palette from some pictures.
    pub fn learn(pictures: &[Image]) -> Self {
        // Each shade enters as often as the square root of its pixels: the background is most of a picture, and would
        // otherwise take most of the palette from the small things that matter.
        let mut counts = vec![0u32; 1 << (3 * BITS)];
        for pixel in pictures.iter().flat_map(|picture| picture.rgb.chunks_exact(3)) {
            counts[cell([pixel[0], pixel[1], pixel[2]])] += 1;
        }
        let mut sample = Vec::new();
        for (index, &count) in counts.iter().enumerate().filter(|&(_, &count)| count > 0) {
            let [r, g, b] = shade(index);
            for _ in 0..(f64::from(count).sqrt() as usize).clamp(1, 200) {
                sample.extend_from_slice(&[r, g, b, 255]);
            }
        }
        // The quantiser reads at least some hundreds of pixels.
        while sample.len() < 4 * 2048 {
            let again = if sample.is_empty() { vec![255; 4] } else { sample.clone() };
            sample.extend(again);
        }
        let rgb = NeuQuant::new(1, COLOURS, &sample).color_map_rgb();
        let nearest = (0..counts.len()).map(|index| nearest(&rgb, shade(index))).collect();
        Self { rgb, nearest }
    }

    /// The colours, three bytes each.
    pub fn rgb(&self) -> &[u8] {
        &self.rgb
    }

    /// The index that stands for "as it was".
    pub fn transparent(&self) -> u8 {
        COLOURS as u8
    }

    /// The palette's index for each pixel of a picture.
    pub fn indices(&self, image: &Image) -> Vec<u8> {
        let width = image.width as usize;
        let index = |(place, pixel): (usize, &[u8])| {
            let threshold = BAYER[place / width % 8][place % width % 8];
            let push = (f32::from(threshold) - 31.5) / 64.0 * DITHER;
            let move_by = |value: u8| (f32::from(value) + push + 0.5).clamp(0.0, 255.0) as u8;
            self.nearest[cell([move_by(pixel[0]), move_by(pixel[1]), move_by(pixel[2])])]
        };
        image.rgb.chunks_exact(3).enumerate().map(index).collect()
    }
}

/// The place of a colour in the table.
fn cell(rgb: [u8; 3]) -> usize {
    rgb.iter().fold(0, |index, &value| index << BITS | usize::from(value >> (8 - BITS)))
}

/// The middle colour of a place in the table.
fn shade(index: usize) -> [u8; 3] {
    [2, 1, 0].map(|channel| {
        let value = (index >> (channel * BITS) & ((1 << BITS) - 1)) as u8;
        value << (8 - BITS) | 1 << (7 - BITS)
    })
}

/// The index of the colour nearest to one; green counts most, as it does to the eye.
fn nearest(rgb: &[u8], [r, g, b]: [u8; 3]) -> u8 {
    let distance = |colour: &[u8]| {
        let off = |a: u8, b: u8| i32::from(a) - i32::from(b);
        let (r, g, b) = (off(colour[0], r), off(colour[1], g), off(colour[2], b));
        2 * r * r + 4 * g * g + b * b
    };
    let best = rgb.chunks_exact(3).enumerate().min_by_key(|(_, colour)| distance(colour));
    best.map_or(0, |(index, _)| index as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::srgb;

    #[test]
    fn a_palette_holds_the_colours_it_was_shown() {
        let mut image = Image::new([64, 64], srgb(0xe8_ec_f0));
        for (x, colour) in [(3, 0xc8_32_08), (4, 0x0b_47_a8), (5, 0x22_2b_36)] {
            (0..64).for_each(|y| image.blend(x, y, srgb(colour), 1.0));
        }
        let palette = Palette::learn(std::slice::from_ref(&image));
        assert!(palette.rgb().len() <= 3 * COLOURS);
        let indices = palette.indices(&image);
        for (pixel, index) in image.rgb.chunks_exact(3).zip(indices) {
            let found = &palette.rgb()[3 * usize::from(index)..][..3];
            let off = pixel.iter().zip(found).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(off <= Some(9), "{pixel:?} became {found:?}");
        }
    }

    #[test]
    fn the_table_names_every_colour_to_within_its_step() {
        for rgb in [[0, 0, 0], [255, 255, 255], [13, 200, 77]] {
            let found = shade(cell(rgb));
            assert!(rgb.iter().zip(found).all(|(a, b)| a.abs_diff(b) <= 2));
        }
    }
}
