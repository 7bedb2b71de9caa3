//! Colours: linear light inside, sRGB bytes outside, and the palettes.

use std::sync::OnceLock;

use glam::Vec3;

/// A colour in linear light, red, green and blue from 0 to 1.
pub type Colour = Vec3;

/// Colour of springs that push (negative force).
pub const COMPRESSION: u32 = 0x0b_47_a8;
/// Halfway there.
const COMPRESSION_HALF: u32 = 0x5b_9d_e8;
/// Colour of springs without force.
pub const NEUTRAL: u32 = 0xb4_b7_ba;
/// Halfway to tension.
const TENSION_HALF: u32 = 0xf0_96_3c;
/// Colour of springs that pull (positive force).
pub const TENSION: u32 = 0xc8_32_08;

/// Ink of titles.
pub const INK: u32 = 0x22_2b_36;
/// Ink of everything less important.
pub const INK_SOFT: u32 = 0x5a_66_74;

/// The linear colour of an sRGB colour written as `0xRRGGBB`.
pub fn srgb(hex: u32) -> Colour {
    static TABLE: OnceLock<Vec<f32>> = OnceLock::new();
    let table = TABLE.get_or_init(|| (0..256).map(|byte| decode(byte as f32 / 255.0)).collect());
    let channel = |shift: u32| table[(hex >> shift & 0xff) as usize];
    Vec3::new(channel(16), channel(8), channel(0))
}

/// The sRGB bytes of a linear colour; values outside 0 to 1 are clamped.
pub fn to_srgb(colour: Colour) -> [u8; 3] {
    // Spaced by square roots, as fine in the dark as in the light; a table is the same on every machine and fast.
    static TABLE: OnceLock<Vec<u8>> = OnceLock::new();
    const LAST: f32 = 4095.0;
    let table = TABLE.get_or_init(|| {
        let byte = |root: f32| (encode(root * root) * 255.0 + 0.5) as u8;
        (0..4096).map(|index| byte(index as f32 / LAST)).collect()
    });
    colour.to_array().map(|value| table[(value.clamp(0.0, 1.0).sqrt() * LAST + 0.5) as usize])
}

/// Blue for compression (-1), grey for no force (0), vermilion for tension (+1): told apart by every kind of colour sight.
pub fn diverging(value: f32) -> Colour {
    let strength = value.abs().min(1.0);
    let end = srgb(if value < 0.0 { COMPRESSION } else { TENSION });
    // Through a lighter shade of the same hue; faster than linear near zero, so that small forces are seen at all.
    let half = srgb(if value < 0.0 { COMPRESSION_HALF } else { TENSION_HALF });
    let eased = strength * (1.5 - 0.5 * strength);
    if eased < 0.5 { srgb(NEUTRAL).lerp(half, 2.0 * eased) } else { half.lerp(end, 2.0 * eased - 1.0) }
}

fn decode(value: f32) -> f32 {
    if value <= 0.040_45 { value / 12.92 } else { libm::powf((value + 0.055) / 1.055, 2.4) }
}

fn encode(value: f32) -> f32 {
    if value <= 0.003_130_8 { value * 12.92 } else { 1.055 * libm::powf(value, 1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_the_way_there_and_back() {
        for byte in 0..256u32 {
            assert_eq!(to_srgb(srgb(byte << 16 | byte << 8 | byte)), [byte as u8; 3]);
        }
    }

    #[test]
    fn the_diverging_map_is_neutral_at_zero_and_ends_where_it_should() {
        assert_eq!(diverging(0.0), srgb(NEUTRAL));
        assert!((diverging(5.0) - srgb(TENSION)).length() < 1e-6);
        assert!((diverging(-1.0) - srgb(COMPRESSION)).length() < 1e-6);
    }
}
