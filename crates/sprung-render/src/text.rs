//! Text: the fonts of a crate, outlines turned into coverage, subscripts, numbers as people write them.

use std::sync::OnceLock;

use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};
use glam::Vec2;

use crate::colour::Colour;
use crate::image::Image;

/// Size of a subscript, and how far it sinks, as shares of the text's size.
const SUBSCRIPT: (f32, f32) = (0.72, 0.16);

/// How text is set.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// Height of the line, pixels.
    pub size: f32,
    /// Ink.
    pub colour: Colour,
    /// Whether strokes are thickened a little.
    pub strong: bool,
}

/// Where a text's given place lies along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// At its beginning.
    Start,
    /// In its middle.
    Middle,
    /// At its end.
    End,
}

/// A piece of text of one size.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Piece {
    /// The letters.
    pub text: String,
    /// Whether they hang lower and are smaller.
    pub subscript: bool,
}

/// Splits `k_s` and `k_{c,d}` into letters and subscripts.
pub fn pieces(text: &str) -> Vec<Piece> {
    let mut pieces: Vec<Piece> = Vec::new();
    let mut push = |letter: char, subscript: bool| match pieces.last_mut() {
        Some(piece) if piece.subscript == subscript => piece.text.push(letter),
        _ => pieces.push(Piece { text: letter.to_string(), subscript }),
    };
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        if letter != '_' {
            push(letter, false);
        } else if letters.next_if_eq(&'{').is_some() {
            letters.by_ref().take_while(|&letter| letter != '}').for_each(|letter| push(letter, true));
        } else if let Some(letter) = letters.next() {
            push(letter, true);
        }
    }
    pieces
}

/// The length of a line of text, pixels.
pub fn width(text: &str, size: f32) -> f32 {
    let mut pen = 0.0;
    layout(text, size, |_, _, advance| pen += advance);
    pen
}

/// Writes a line of text; `place` is on its baseline.
pub fn draw(image: &mut Image, text: &str, place: Vec2, anchor: Anchor, style: Style) {
    let shift = match anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => 0.5 * width(text, style.size),
        Anchor::End => width(text, style.size),
    };
    let mut pen = place - Vec2::new(shift, 0.0);
    let thicken: &[f32] = if style.strong { &[0.0, 0.025] } else { &[0.0] };
    layout(text, style.size, |glyph, sink, advance| {
        for offset in thicken {
            let mut glyph = glyph.clone();
            glyph.position = point(pen.x + offset * style.size, pen.y + sink);
            if let Some(outline) = font().outline_glyph(glyph) {
                let corner = outline.px_bounds().min;
                outline.draw(|x, y, cover| {
                    let (x, y) = (corner.x as i64 + i64::from(x), corner.y as i64 + i64::from(y));
                    image.blend(x, y, style.colour, cover);
                });
            }
        }
        pen.x += advance;
    });
}

/// Visits each glyph with how far it hangs below the baseline and how far the pen moves on.
fn layout(text: &str, size: f32, mut visit: impl FnMut(&ab_glyph::Glyph, f32, f32)) {
    for piece in pieces(text) {
        let (scale, sink) =
            if piece.subscript { (size * SUBSCRIPT.0, size * SUBSCRIPT.1) } else { (size, 0.0) };
        let scaled = font().as_scaled(PxScale::from(scale));
        let mut letters = piece.text.chars().peekable();
        while let Some(letter) = letters.next() {
            let id = scaled.glyph_id(letter);
            let kern = letters.peek().map_or(0.0, |&next| scaled.kern(id, scaled.glyph_id(next)));
            visit(&id.with_scale(scale), sink, scaled.h_advance(id) + kern);
        }
    }
}

fn font() -> &'static FontRef<'static> {
    static FONT: OnceLock<FontRef<'static>> = OnceLock::new();
    FONT.get_or_init(|| {
        FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).expect("the crate's font file is whole")
    })
}

/// A count with its thousands set apart: `7,560`.
pub fn count(value: usize) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A number with up to four significant digits and a proper minus sign: `750`, `0.0125`, `−1.2e−7`.
pub fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".to_owned() } else { value.to_string() };
    }
    let size = value.abs();
    let text = if (1e-3..1e6).contains(&size) {
        let decimals = (0..=6).find(|&d| size >= [1e3, 1e2, 1e1, 1.0, 0.1, 0.01, 0.0][d]).unwrap_or(6);
        let text = format!("{value:.decimals$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    } else {
        let text = format!("{value:.3e}");
        let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
        format!("{}e{power}", digits.trim_end_matches('0').trim_end_matches('.'))
    };
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::srgb;

    #[test]
    fn numbers_read_as_people_write_them() {
        let found = [750.0, 0.01, 1.0 / 600.0, -0.2, 12345.6, 2.5e-7, 0.0, 1e9].map(number);
        assert_eq!(found, ["750", "0.01", "0.001667", "−0.2", "12346", "2.5e−7", "0", "1e9"]);
        assert_eq!([0, 999, 1000, 1234567].map(count), ["0", "999", "1,000", "1,234,567"]);
    }

    #[test]
    fn subscripts_are_set_apart() {
        let found: Vec<_> =
            pieces("k_s, k_{c,d}").into_iter().map(|piece| (piece.text, piece.subscript)).collect();
        let expected = [("k", false), ("s", true), (", k", false), ("c,d", true)];
        assert_eq!(found, expected.map(|(text, subscript)| (text.to_owned(), subscript)));
        assert!(width("k_s", 20.0) < width("ks", 20.0));
    }

    #[test]
    fn text_leaves_ink_where_it_stands() {
        let mut image = Image::new([60, 30], srgb(0xff_ff_ff));
        let style = Style { size: 24.0, colour: srgb(0), strong: false };
        draw(&mut image, "H", Vec2::new(30.0, 24.0), Anchor::Middle, style);
        let dark = (0..60)
            .flat_map(|x| (0..30).map(move |y| (x, y)))
            .filter(|&(x, y)| image.pixel(x, y).is_some_and(|rgb| rgb[0] < 128));
        assert!(dark.count() > 15);
    }
}
