//! Pictures in files: small ones to compare with, and large ones with a palette for people.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use color_quant::NeuQuant;
use sprung_render::Image;

/// Stores a picture exactly.
pub fn write(path: &Path, image: &Image) {
    encode(path, image, &image.rgb, png::ColorType::Rgb, |_| {});
}

/// Half as wide and high, and each channel in steps of 4: a fifth of the bytes, and all that a comparison needs.
pub fn reduced(image: &Image) -> Image {
    let (width, height) = (image.width / 2, image.height / 2);
    let mut rgb = Vec::with_capacity(3 * (width * height) as usize);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (2 * x, 2 * y))) {
        let four = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)].map(|(x, y)| image.pixel(x, y));
        for channel in 0..3 {
            let sum: u32 = four.iter().flatten().map(|pixel| u32::from(pixel[channel])).sum();
            rgb.push(((sum / 4 + 2) / 4 * 4).min(255) as u8);
        }
    }
    Image { width, height, rgb }
}

/// Stores a picture with the 256 colours that suit it best: a third of the bytes, and as good to look at.
pub fn write_with_palette(path: &Path, image: &Image) {
    let mut count = BTreeMap::new();
    for colour in image.rgb.chunks_exact(3) {
        *count.entry([colour[0], colour[1], colour[2]]).or_insert(0_u32) += 1;
    }
    // Few pixels of their own colour, as in a legend, count for more than their share, or backgrounds would take all.
    let sample: Vec<u8> = count
        .iter()
        .flat_map(|([r, g, b], count)| [*r, *g, *b, 255].repeat(1 + count.ilog2() as usize))
        .collect();
    let palette = NeuQuant::new(1, 256, &sample);
    let index: BTreeMap<_, _> =
        count.keys().map(|&[r, g, b]| ([r, g, b], palette.index_of(&[r, g, b, 255]) as u8)).collect();
    let indices: Vec<u8> = image.rgb.chunks_exact(3).map(|c| index[&[c[0], c[1], c[2]]]).collect();
    encode(path, image, &indices, png::ColorType::Indexed, |encoder| {
        encoder.set_palette(palette.color_map_rgb());
    });
}

fn encode(
    path: &Path,
    image: &Image,
    data: &[u8],
    colours: png::ColorType,
    set: impl FnOnce(&mut png::Encoder<'_, BufWriter<File>>),
) {
    let file = BufWriter::new(File::create(path).expect("the picture can be stored"));
    let mut encoder = png::Encoder::new(file, image.width, image.height);
    encoder.set_color(colours);
    encoder.set_compression(png::Compression::High);
    set(&mut encoder);
    let mut writer = encoder.write_header().expect("it can be written");
    writer.write_image_data(data).expect("it can be written");
    writer.finish().expect("it can be written");
}
