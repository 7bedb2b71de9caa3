//! Formulas in a line of text: letters lean, digits stand, subscripts hang.

use egui::text::{LayoutJob, TextFormat};
use egui::{Align, Color32, FontId, Ui};

/// A piece of a formula.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Piece {
    text: String,
    leans: bool,
    hangs: bool,
}

/// Splits `k_s`, `k_{c,d}` and `2x` into pieces. Single letters are quantities and lean; words, digits and signs stand.
fn pieces(markup: &str) -> Vec<Piece> {
    let mut pieces: Vec<Piece> = Vec::new();
    let mut push = |text: &str, leans: bool, hangs: bool| match pieces.last_mut() {
        Some(last) if last.leans == leans && last.hangs == hangs => last.text.push_str(text),
        _ => pieces.push(Piece { text: text.to_owned(), leans, hangs }),
    };
    let mut rest = markup;
    while let Some(first) = rest.chars().next() {
        if let Some(after) = rest.strip_prefix('_') {
            let (low, remaining) = match after.strip_prefix('{').and_then(|inner| inner.split_once('}')) {
                Some(parts) => parts,
                None => after.split_at(after.chars().next().map_or(0, char::len_utf8)),
            };
            push(low, false, true);
            rest = remaining;
        } else if first.is_alphabetic() {
            let end = rest.find(|letter: char| !letter.is_alphabetic()).unwrap_or(rest.len());
            let (word, remaining) = rest.split_at(end);
            push(word, is_quantity(word), false);
            rest = remaining;
        } else {
            let (sign, remaining) = rest.split_at(first.len_utf8());
            push(sign, false, false);
            rest = remaining;
        }
    }
    pieces
}

/// One letter, or dt.
fn is_quantity(word: &str) -> bool {
    word == "dt" || word.chars().count() == 1
}

/// A formula as text to lay out.
pub fn job(markup: &str, size: f32, colour: Color32) -> LayoutJob {
    lay_out(pieces(markup), size, colour)
}

/// A sentence with subscripts, in which letters stand.
pub fn prose(ui: &mut Ui, markup: &str) -> egui::Response {
    let size = egui::TextStyle::Body.resolve(ui.style()).size;
    let standing = pieces(markup).into_iter().map(|piece| Piece { leans: false, ..piece });
    ui.label(lay_out(standing.collect(), size, ui.visuals().text_color()))
}

fn lay_out(pieces: Vec<Piece>, size: f32, colour: Color32) -> LayoutJob {
    let mut job = LayoutJob::default();
    for piece in pieces {
        let font = if piece.hangs { 0.72 * size } else { size };
        let format = TextFormat {
            font_id: FontId::proportional(font),
            color: colour,
            italics: piece.leans,
            valign: if piece.hangs { Align::BOTTOM } else { Align::Center },
            ..TextFormat::default()
        };
        job.append(&piece.text, 0.0, format);
    }
    job
}

/// A formula as a label, a little larger than text.
pub fn show(ui: &mut Ui, markup: &str) -> egui::Response {
    let size = 1.18 * egui::TextStyle::Body.resolve(ui.style()).size;
    ui.label(job(markup, size, ui.visuals().strong_text_color()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_lean_and_subscripts_hang() {
        let found: Vec<(String, bool, bool)> = pieces("v_i = 2 k_{c,d} dt, cos x_")
            .into_iter()
            .map(|piece| (piece.text, piece.leans, piece.hangs))
            .collect();
        let expected = [
            ("v", true, false),
            ("i", false, true),
            (" = 2 ", false, false),
            ("k", true, false),
            ("c,d", false, true),
            (" ", false, false),
            ("dt", true, false),
            (", cos ", false, false),
            ("x", true, false),
        ];
        let text: String = found.iter().map(|(text, ..)| text.as_str()).collect();
        assert_eq!(text, "vi = 2 kc,d dt, cos x");
        for (found, (text, leans, hangs)) in found.iter().zip(expected) {
            assert_eq!((found.0.as_str(), found.1, found.2), (text, leans, hangs));
        }
        assert!(pieces("").is_empty());
    }
}
