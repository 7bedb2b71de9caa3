//! The legend of the colour scale: what colours mean, up to which value, and handles to change that.

use egui::{Align2, Color32, FontId, Rect, Response, Sense, Ui, pos2, vec2};
use sprung_render::appearance::{Appearance, ColourBy};
use sprung_render::colour::to_srgb;

use crate::state::AppState;
use crate::text::{steady, three_digits};

/// Size of the bar with the colours.
const BAR: egui::Vec2 = egui::vec2(200.0, 12.0);
/// Size of the whole legend.
pub const SIZE: egui::Vec2 = vec2(BAR.x + 24.0, 46.0);
/// Pieces of one colour in it.
const PIECES: usize = 64;

/// How often the scale is held against the scene, s of real time.
const LOOK_EVERY: f64 = 0.2;

/// The legend, and whether the scale follows the scene by itself.
#[derive(Default)]
pub struct Legend {
    /// The scene and quantity that the scale was set for by itself, and the value it was given.
    by_itself: Option<(u64, ColourBy, f32)>,
    /// Whether the user has set the scale for this quantity.
    by_hand: Option<(u64, ColourBy)>,
    /// When the scale was held against the scene last, s.
    looked: f64,
}

impl Legend {
    /// Lets the scale grow with the scene, in round values, unless the user has set it; it never shrinks by itself, so that
    /// colours mean the same from moment to moment.
    pub fn follow(&mut self, now: f64, state: &mut AppState) {
        let (serial, colour_by) = (state.report.opened.serial, state.appearance.colour_by);
        // A pull or a blow-up tears at a few springs, and would leave the others without colour.
        let is_torn = state.report.trouble.is_some() || state.report.pull.is_some();
        if colour_by == ColourBy::Plain || is_torn {
            return;
        }
        let is_mine = self.by_itself.is_some_and(|(s, by, value)| {
            (s, by) == (serial, colour_by) && value == state.appearance.full_scale
        });
        let is_new = self.by_itself.is_none_or(|(s, by, _)| (s, by) != (serial, colour_by));
        if !is_new && !is_mine {
            self.by_hand = Some((serial, colour_by)); // somebody else has set it
        }
        let is_early = !is_new && now - self.looked < LOOK_EVERY;
        if is_early || self.by_hand == Some((serial, colour_by)) {
            return;
        }
        self.looked = now;
        let fitting = fitting(state);
        let value = if is_new { fitting } else { fitting.max(state.appearance.full_scale) };
        state.appearance.full_scale = value;
        self.by_itself = Some((serial, colour_by, value));
    }

    /// Draws the legend with its lower left corner at a place.
    pub fn show(&mut self, ui: &mut Ui, corner: egui::Pos2, state: &mut AppState) -> Option<Rect> {
        let appearance = state.appearance;
        if appearance.colour_by == ColourBy::Plain {
            return None;
        }
        let ink = ui.visuals().text_color();
        let whole = Rect::from_min_size(corner - vec2(0.0, SIZE.y), SIZE);
        let bar = Rect::from_min_size(whole.min + vec2(0.0, 18.0), BAR);
        let response =
            ui.interact(bar.expand(4.0), ui.scope_id().with("colour scale"), Sense::click_and_drag());
        let value = appearance.full_scale;
        let name = format!("Colour scale, up to {} {}", steady(value.into()), appearance.colour_by.unit());
        response.widget_info(|| egui::WidgetInfo::slider(true, value.into(), name.clone()));
        let response = response.on_hover_cursor(egui::CursorIcon::ResizeHorizontal).on_hover_text(
            "What the colours mean. Drag to change where the scale ends; double-click lets it fit the scene.",
        );
        self.take(&response, state);

        let painter = ui.painter();
        let title = title(appearance.colour_by);
        painter.text(
            whole.min + vec2(0.0, 14.0),
            Align2::LEFT_BOTTOM,
            title,
            FontId::proportional(12.5),
            ink,
        );
        draw_bar(painter, bar, &appearance);
        let (low, middle) = if appearance.colour_by.is_signed() { (-value, Some(0.0)) } else { (0.0, None) };
        let label = |x: f32, align: Align2, value: f32| {
            let text = short(value, appearance.colour_by);
            painter.text(pos2(x, bar.max.y + 2.0), align, text, FontId::monospace(11.0), ink);
        };
        label(bar.min.x, Align2::LEFT_TOP, low);
        label(bar.max.x, Align2::RIGHT_TOP, value);
        if let Some(middle) = middle {
            label(bar.center().x, Align2::CENTER_TOP, middle);
        }
        Some(whole)
    }

    fn take(&mut self, response: &Response, state: &mut AppState) {
        let by_hand = Some((state.report.opened.serial, state.appearance.colour_by));
        if response.double_clicked() {
            self.by_hand = None;
            self.by_itself = None;
        } else if response.dragged() {
            let factor = (-response.drag_delta().x / BAR.x * 3.0).exp();
            state.appearance.full_scale = (state.appearance.full_scale * factor).clamp(1e-6, 1e12);
            self.by_hand = by_hand;
        }
    }
}

/// What fits the scene now; before anything is stretched, what its own weight would be felt as.
fn fitting(state: &AppState) -> f32 {
    let (opened, params) = (&state.report.opened, &state.report.params);
    let colour_by = state.appearance.colour_by;
    let now = &state.report.now.positions;
    let is_strained =
        opened.model.springs().iter().zip(&*params.spring_rest_length).any(|(&[i, j], &rest)| {
            let (Some(a), Some(b)) = (now.get(i as usize), now.get(j as usize)) else { return false };
            ((*a - *b).length() - rest).abs() > 1e-4 * rest
        });
    if is_strained {
        return Appearance::full_scale_for(&opened.model, params, now, colour_by);
    }
    if colour_by == ColourBy::Strain { 0.05 } else { 1.0 }
}

/// A scale in the colours of the scene.
fn draw_bar(painter: &egui::Painter, bar: Rect, appearance: &Appearance) {
    let width = bar.width() / PIECES as f32;
    for piece in 0..PIECES {
        let share = (piece as f32 + 0.5) / PIECES as f32;
        let share = if appearance.colour_by.is_signed() { 2.0 * share - 1.0 } else { share };
        let [r, g, b] = to_srgb(appearance.scale_colour(share));
        let left = bar.min.x + piece as f32 * width;
        let rect = Rect::from_min_max(pos2(left, bar.min.y), pos2(left + width + 0.5, bar.max.y));
        painter.rect_filled(rect, 0.0, Color32::from_rgb(r, g, b));
    }
}

fn title(colour_by: ColourBy) -> &'static str {
    match colour_by {
        ColourBy::Plain => "",
        ColourBy::Strain => "strain: how much longer than at rest",
        ColourBy::Tension => "tension in N: \u{2212} pushes, + pulls",
        ColourBy::Energy => "energy stored in each spring, J",
    }
}

/// A value at the end of the scale.
fn short(value: f32, colour_by: ColourBy) -> String {
    let (value, unit) = if colour_by == ColourBy::Strain { (100.0 * value, " %") } else { (value, "") };
    format!("{}{unit}", three_digits(value.into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quantity_says_what_it_is() {
        for colour_by in ColourBy::ALL {
            assert_eq!(title(colour_by).is_empty(), colour_by == ColourBy::Plain);
            assert!(title(colour_by).contains(colour_by.unit()));
        }
        assert_eq!(short(-0.05, ColourBy::Strain), "\u{2212}5 %");
        assert_eq!(short(200.0, ColourBy::Tension), "200");
    }
}
