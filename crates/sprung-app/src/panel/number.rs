//! A number with a slider and a text field: it is never clamped behind the user's back, and what is not allowed is
//! refused with a sentence.

use std::ops::RangeInclusive;

use egui::text::{CCursor, CCursorRange};
use egui::{
    Align, Area, Frame, Id, Key, Layout, Order, Rect, RichText, Slider, SliderClamping, TextEdit, TextStyle,
    Ui, vec2,
};
use sprung::significant;

use crate::icon::{self, IconButton};
use crate::text::rounded;
use crate::theme::Meaning;

/// Width of the column of names, points.
const NAME_WIDTH: f32 = 90.0;
/// Width of the text field, points.
const FIELD_WIDTH: f32 = 72.0;
/// Width of the column of units, points.
const UNIT_WIDTH: f32 = 42.0;
/// Width of the button that goes back to the scene's own value, points.
const OWN_WIDTH: f32 = 30.0;

/// Room for why a number is refused, points.
const BUBBLE_WIDTH: f32 = 320.0;

/// How a slider divides its range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By factors.
    Logarithmic,
    /// By factors, and only whole numbers.
    Whole,
}

/// A number as people see it.
#[derive(Clone, Debug)]
pub struct Number<'a> {
    /// What it is called.
    pub name: &'a str,
    /// Its unit, or nothing.
    pub unit: &'a str,
    /// What it means, with the formula it appears in; for the tooltip.
    pub about: &'a str,
    /// What is allowed.
    pub allowed: RangeInclusive<f64>,
    /// The part of it that the slider spans.
    pub slider: RangeInclusive<f64>,
    /// How the slider divides that.
    pub scale: Scale,
}

/// A value that was asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// The value, which is allowed.
    pub value: f64,
    /// Whether it goes on with the value asked for last, as in a drag.
    pub continues: bool,
}

impl Asked {
    fn anew(value: f64) -> Self {
        Self { value, continues: false }
    }
}

/// How long a sentence stays once the field was left, s. Then the field shows the value that holds.
const READING_TIME: f64 = 6.0;

/// What is in the text field while it is edited or refused.
#[derive(Clone, Debug, Default)]
struct Typing {
    text: String,
    refused: Option<String>,
    /// When the field was left with something that was refused, s.
    left: Option<f64>,
}

impl Number<'_> {
    /// A row with name, slider, text field, unit, and the way back to the scene's own value where it differs.
    pub fn show(&self, ui: &mut Ui, value: f64, own: Option<f64>) -> Option<Asked> {
        let id = ui.make_persistent_id(("number", self.name));
        let mut asked = None;
        let row = ui.horizontal(|ui| {
            let name = self.name_label(ui);
            let fixed = FIELD_WIDTH + UNIT_WIDTH + OWN_WIDTH + 3.0 * ui.spacing().item_spacing.x;
            ui.spacing_mut().slider_width = (ui.available_width() - fixed).max(50.0);
            asked = self.slider(ui, id, value, name);
            let typed = self.field(ui, id, value, name);
            asked = asked.or(typed.map(Asked::anew));
            fixed_width(ui, UNIT_WIDTH, |ui| ui.weak(self.unit));
            if let Some(own) = own {
                asked = asked.or(self.own_button(ui, value, own));
            }
        });
        if let Some(asked) = asked {
            // What was refused before is of no interest any more.
            let focused = ui.memory(|memory| memory.has_focus(id));
            if !focused || !asked.continues {
                ui.data_mut(|data| data.remove_temp::<Typing>(id));
            }
        }
        self.refusal(ui, id, row.response.rect);
        asked
    }

    /// Why what was typed is refused, in a bubble: it pushes nothing aside. Beside the row where there is room, else below.
    fn refusal(&self, ui: &Ui, id: Id, row: Rect) {
        let refused = ui.data(|data| data.get_temp::<Typing>(id)).and_then(|typing| typing.refused);
        let Some(sentence) = refused.filter(|_| ui.is_rect_visible(row)) else { return };
        let is_beside = row.right() + BUBBLE_WIDTH < ui.ctx().content_rect().right();
        let corner = if is_beside { row.right_top() + vec2(16.0, -4.0) } else { row.left_bottom() };
        let bubble = Area::new(id.with("refusal")).order(Order::Foreground).interactable(false);
        bubble.fixed_pos(corner).show(ui.ctx(), |ui| {
            Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_max_width(BUBBLE_WIDTH - 40.0);
                ui.label(RichText::new(sentence).color(Meaning::Bad.colour(ui.visuals())));
            });
        });
    }

    /// Reads what was typed.
    ///
    /// # Errors
    /// A sentence that says what is allowed.
    pub fn parse(&self, text: &str) -> Result<f64, String> {
        let text = text.trim();
        let bare = text.strip_suffix(self.unit).unwrap_or(text).trim();
        // Minus signs come in several forms when pasted.
        let bare = bare.replace('−', "-");
        let value: f64 = match bare.parse() {
            Ok(value) => value,
            Err(_) if bare.is_empty() => return Err(format!("{} needs a number", self.name)),
            Err(_) => return Err(format!("“{}” is not a number, such as 0.5 or 2e-3", shortened(&bare))),
        };
        if self.scale == Scale::Whole && value.fract() != 0.0 {
            return Err(format!("{} must be a whole number, not {}", self.name, significant(value)));
        }
        if !self.allowed.contains(&value) {
            let found = if value.is_finite() { significant(value) } else { value.to_string() };
            return Err(format!("{found} is not allowed: {} may be {}", self.name, self.bounds()));
        }
        Ok(value)
    }

    fn bounds(&self) -> String {
        let (low, high) = (significant(*self.allowed.start()), significant(*self.allowed.end()));
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        format!("from {low} to {high}{unit}")
    }

    fn tooltip(&self) -> String {
        format!("{}\n\nAllowed: {}.", self.about, self.bounds())
    }

    fn name_label(&self, ui: &mut Ui) -> Id {
        fixed_width(ui, NAME_WIDTH, |ui| ui.label(self.name).on_hover_text(self.tooltip()).id)
    }

    fn slider(&self, ui: &mut Ui, id: Id, value: f64, name: Id) -> Option<Asked> {
        let mut moved = value;
        let mut slider = Slider::new(&mut moved, self.slider.clone())
            .clamping(SliderClamping::Never)
            .logarithmic(self.scale != Scale::Linear)
            .show_value(false);
        if self.scale == Scale::Whole {
            slider = slider.step_by(1.0);
        } else if self.scale == Scale::Logarithmic {
            slider = slider.smallest_positive(smallest_positive(&self.slider));
        }
        let response = ui.add(slider).labelled_by(name).on_hover_text(self.tooltip());
        // A drag is one edit, and so is a row of arrow keys while the slider keeps the focus.
        let begun = id.with("begun");
        let held = response.dragged() || response.has_focus();
        let continues =
            held && ui.data(|data| data.get_temp(begun).unwrap_or(false)) && !response.drag_started();
        let changed = response.changed() && moved != value;
        ui.data_mut(|data| data.insert_temp(begun, held && (continues || changed)));
        if !changed {
            return None;
        }
        // Positions of a mouse have no six digits.
        let rounded: f64 = if self.scale == Scale::Whole { moved.round() } else { rounded(moved, 3) };
        let value = rounded.clamp(*self.allowed.start(), *self.allowed.end());
        Some(Asked { value, continues })
    }

    fn field(&self, ui: &mut Ui, id: Id, value: f64, name: Id) -> Option<f64> {
        let now = ui.input(|input| input.time);
        let kept: Option<Typing> = ui.data(|data| data.get_temp(id));
        let is_over = |typing: &Typing| typing.left.is_some_and(|left| now - left > READING_TIME);
        if kept.as_ref().is_some_and(is_over) {
            ui.data_mut(|data| data.remove_temp::<Typing>(id));
        }
        let shown = significant(value);
        let Typing { mut text, refused, .. } = kept
            .filter(|typing| !is_over(typing))
            .unwrap_or_else(|| Typing { text: shown.clone(), ..Typing::default() });
        let colour = refused.is_some().then(|| Meaning::Bad.colour(ui.visuals()));
        let output = TextEdit::singleline(&mut text)
            .id(id)
            .desired_width(FIELD_WIDTH - 8.0)
            .font(TextStyle::Monospace)
            .align(egui::Align2::RIGHT_CENTER)
            .text_color_opt(colour)
            .show(ui);
        let response = output.response.response.labelled_by(name).on_hover_text(self.tooltip());
        if response.gained_focus() {
            let mut state = output.state;
            let all = CCursorRange::two(CCursor::new(0), CCursor::new(text.chars().count()));
            state.cursor.set_char_range(Some(all));
            state.store(ui.ctx(), id);
        }
        if response.lost_focus() {
            let given_up = ui.input(|input| input.key_pressed(Key::Escape));
            ui.data_mut(|data| data.remove_temp::<Typing>(id));
            if given_up || text == shown {
                return None;
            }
            match self.parse(&text) {
                Ok(value) => return Some(value),
                Err(sentence) => {
                    // After Enter one goes on typing, or presses Esc for the value that holds.
                    let left = if ui.input(|input| input.key_pressed(Key::Enter)) {
                        ui.memory_mut(|memory| memory.request_focus(id));
                        None
                    } else {
                        ui.ctx().request_repaint_after_secs(READING_TIME as f32 + 0.1);
                        Some(now)
                    };
                    let typing = Typing { text, refused: Some(sentence), left };
                    ui.data_mut(|data| data.insert_temp(id, typing));
                }
            }
        } else if response.has_focus() {
            // The sentence stays until something else is typed.
            let refused = refused.filter(|_| !response.changed());
            ui.data_mut(|data| data.insert_temp(id, Typing { text, refused, left: None }));
        }
        None
    }

    fn own_button(&self, ui: &mut Ui, value: f64, own: f64) -> Option<Asked> {
        own_button(ui, self.name, &format!("{} {}", significant(own), self.unit), value != own)
            .then(|| Asked::anew(own))
    }
}

/// The button that goes back to the scene's own value, where that is another one; its place stays free otherwise.
pub fn own_button(ui: &mut Ui, name: &str, own: &str, differs: bool) -> bool {
    if !differs {
        ui.allocate_space(vec2(OWN_WIDTH, 1.0));
        return false;
    }
    let label = format!("own {name}");
    let small = |button: egui::Button<'static>| button.small().frame_when_inactive(false);
    let button = IconButton::new(icon::RESET, &label).with(small);
    button.show(ui).on_hover_text(format!("The scene's own value: {}", own.trim())).clicked()
}

/// A cell of a fixed width, so that nothing jumps when its text changes.
pub fn fixed_width<R>(ui: &mut Ui, width: f32, add: impl FnOnce(&mut Ui) -> R) -> R {
    let size = vec2(width, ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_width(width);
        ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Truncate);
        add(ui)
    })
    .inner
}

/// A range for a slider around a scene's own value: two powers of ten to both sides; `usual` where that is zero.
pub fn around(own: f64, usual: RangeInclusive<f64>) -> RangeInclusive<f64> {
    if own == 0.0 { usual } else { rounded(own * 0.01, 3)..=rounded(own * 100.0, 3) }
}

/// The smallest step away from zero on a logarithmic slider.
fn smallest_positive(range: &RangeInclusive<f64>) -> f64 {
    if *range.start() > 0.0 { *range.start() } else { 1e-5 * range.end() }
}

fn shortened(text: &str) -> String {
    if text.chars().count() <= 20 { text.to_owned() } else { text.chars().take(19).chain(['…']).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: Number<'static> = Number {
        name: "dt",
        unit: "s",
        about: "",
        allowed: 1e-9..=1e3,
        slider: 1e-5..=1.0,
        scale: Scale::Logarithmic,
    };

    #[test]
    fn numbers_are_read_with_or_without_their_unit() {
        for (text, value) in [("0.01", 0.01), (" 2e-3 s ", 0.002), ("5s", 5.0), (".5", 0.5)] {
            assert_eq!(DT.parse(text), Ok(value), "{text}");
        }
        let level = Number { allowed: -10.0..=10.0, ..DT };
        assert_eq!(level.parse("−2.5"), Ok(-2.5));
    }

    #[test]
    fn what_is_refused_is_said() {
        for (text, sentence) in [
            ("", "dt needs a number"),
            ("fast", "“fast” is not a number, such as 0.5 or 2e-3"),
            ("0,01", "“0,01” is not a number, such as 0.5 or 2e-3"),
            ("2000", "2000 is not allowed: dt may be from 1e-9 to 1000 s"),
            ("-1", "-1 is not allowed: dt may be from 1e-9 to 1000 s"),
            ("NaN", "NaN is not allowed: dt may be from 1e-9 to 1000 s"),
            ("inf", "inf is not allowed: dt may be from 1e-9 to 1000 s"),
        ] {
            assert_eq!(DT.parse(text), Err(sentence.to_owned()), "{text}");
        }
        let whole = Number { name: "substeps", unit: "", scale: Scale::Whole, allowed: 1.0..=100.0, ..DT };
        assert_eq!(whole.parse("2.5"), Err("substeps must be a whole number, not 2.5".to_owned()));
    }
}
