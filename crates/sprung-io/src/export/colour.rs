//! Colours as formats for rendering want them.

/// The linear value of an sRGB one, to four decimals: the same on every system.
pub fn linear(srgb: u8) -> f64 {
    let s = f64::from(srgb) / 255.0;
    let linear = if s <= 0.040_45 { s / 12.92 } else { ((s + 0.055) / 1.055).powf(2.4) };
    (linear * 1e4).round() / 1e4
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_linear() {
        assert_eq!([0, 255].map(linear), [0.0, 1.0]);
        assert_eq!(linear(128), 0.2159); // ((128/255 + 0.055)/1.055)^2.4 = 0.21586
        assert_eq!(linear(10), 0.003); // 10/255/12.92 = 0.003035
    }
}
