//! The card for what could not be done: what was found, where, and what would mend it; for files with the very line.

use std::path::Path;

use egui::{Context, RichText, Ui};
use sprung::Error;

use super::{modal, primary};
use crate::icon;
use crate::panel::fixed_width;
use crate::theme::Meaning;

/// What the card is called.
pub const TITLE: &str = "That did not work";

/// Most characters of a line that are shown around the fault.
const WIDTH: usize = 72;

/// Words that sentences begin with which say something of a file.
const VERBS: [&str; 7] = ["is", "are", "has", "does", "cannot", "must", "needs"];

/// The card; gives whether it is to be closed. `text` is that of the file, where it is known.
pub fn show(context: &Context, error: &Error, text: Option<&str>) -> bool {
    modal(context, "error card", TITLE, 560.0, |ui| {
        let colour = Meaning::Bad.colour(ui.visuals());
        let place = error.place();
        let sentence = sentence(error);
        ui.horizontal_top(|ui| {
            icon::label(ui, icon::WARNING, colour);
            ui.add(egui::Label::new(RichText::new(capital(&sentence)).color(colour)).wrap());
        });
        ui.add_space(4.0);
        let line = place.line_column.map(|(line, column)| format!("{line}, column {column}"));
        for (name, value) in [("File", &place.file), ("Line", &line), ("Field", &place.field)] {
            let Some(value) = value else { continue };
            ui.horizontal_top(|ui| {
                fixed_width(ui, 44.0, |ui| ui.weak(name));
                ui.add(egui::Label::new(RichText::new(value).monospace()).wrap());
            });
        }
        if let (Some((line, column)), Some(text)) = (place.line_column, text) {
            quote(ui, text, line, column);
        }
        if let Some(fix) = error.fix() {
            ui.add_space(4.0);
            ui.horizontal_top(|ui| {
                icon::label(ui, icon::BULB, ui.visuals().hyperlink_color);
                ui.add(egui::Label::new(capital(fix)).wrap());
            });
        }
        ui.add_space(10.0);
        let button = ui.add(primary(ui, "Close"));
        if ui.memory(|memory| memory.focused().is_none()) {
            button.request_focus();
        }
        button.clicked()
    })
}

/// What was found, with its subject: the field it is about, or the file where it says something of that.
fn sentence(error: &Error) -> String {
    let (place, sentence) = (error.place(), error.sentence());
    let is_without_subject = sentence.split(' ').next().is_some_and(|word| VERBS.contains(&word));
    match (&place.field, &place.file) {
        (Some(field), _) => format!("{field} {sentence}"),
        (None, Some(file)) if is_without_subject => {
            let name = Path::new(file).file_name().map_or_else(|| file.into(), |name| name.to_string_lossy());
            format!("{name} {sentence}")
        }
        _ => sentence.to_owned(),
    }
}

/// The line at fault, with the ones around it and a caret under the column.
fn quote(ui: &mut Ui, text: &str, line: usize, column: usize) {
    ui.add_space(6.0);
    egui::Frame::new().fill(ui.visuals().faint_bg_color).corner_radius(6).inner_margin(10).show(ui, |ui| {
        ui.set_width(ui.available_width());
        for (number, shown) in excerpt(text, line, column) {
            let is_fault = number == Some(line) || number.is_none();
            let margin = number.map_or_else(|| "     ".to_owned(), |number| format!("{number:>4} "));
            let mut row = RichText::new(format!("{margin}{shown}")).monospace();
            row = if is_fault { row.color(Meaning::Bad.colour(ui.visuals())) } else { row.weak() };
            ui.add(egui::Label::new(row).extend());
        }
    });
}

/// Numbered lines around a fault; the one without a number holds the caret.
fn excerpt(text: &str, line: usize, column: usize) -> Vec<(Option<usize>, String)> {
    // Of a long line, the part around the column.
    let left = column.saturating_sub(WIDTH / 2 + 1);
    let cut = |text: &str| -> String {
        let visible = |c: char| if c.is_control() { ' ' } else { c };
        text.chars().skip(left).take(WIDTH).map(visible).collect()
    };
    let mut rows = Vec::new();
    let first = line.saturating_sub(2).max(1);
    for (index, content) in text.lines().enumerate().skip(first - 1).take(line + 2 - first) {
        rows.push((Some(index + 1), cut(content)));
        if index + 1 == line {
            rows.push((None, format!("{}^", " ".repeat(column.saturating_sub(1 + left)))));
        }
    }
    rows
}

/// With a capital, unless it begins with a name or a number, which stay as they are: `dt`, `body[0].mass`.
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    match letters.next() {
        Some(first)
            if text
                .split_whitespace()
                .next()
                .is_some_and(|word| word.chars().all(char::is_alphabetic) && word.len() > 2) =>
        {
            first.to_uppercase().chain(letters).collect()
        }
        _ => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_caret_is_under_the_fault() {
        let rows = excerpt("a\nb\ndt = -1\nc\nd", 3, 6);
        let expected =
            [(Some(1), "a"), (Some(2), "b"), (Some(3), "dt = -1"), (None, "     ^"), (Some(4), "c")];
        assert_eq!(rows, expected.map(|(number, text)| (number, text.to_owned())));
    }

    #[test]
    fn every_sentence_has_a_subject() {
        let large = Error::new(sprung::Code::TooLarge, "is larger than the 64 MiB allowed");
        assert_eq!(
            sentence(&large.in_file("some/where/big.toml")),
            "big.toml is larger than the 64 MiB allowed"
        );
        let display = Error::new(sprung::Code::Unsupported, "there is no display").in_file("x.toml");
        assert_eq!(sentence(&display), "there is no display");
    }

    #[test]
    fn long_lines_are_cut_around_the_fault() {
        let text = "x".repeat(500);
        let rows = excerpt(&text, 1, 400);
        assert_eq!(rows[0].1.chars().count(), WIDTH);
        assert_eq!(rows[1].1.chars().count(), WIDTH / 2 + 1);
    }

    #[test]
    fn a_place_beyond_the_text_is_no_reason_to_panic() {
        for (line, column) in [(0, 0), (9, 9), (usize::MAX - 5, usize::MAX)] {
            excerpt("one\ntwo", line, column);
        }
    }
}
