//! The stability meter: how near dt is to where the simulation explodes, and what sets the limit.

use egui::{Color32, Rect, Sense, Ui, pos2, vec2};
use sprung::stability::Limit;
use sprung_driver::{Command, Stability};

use crate::icon::{self, IconButton};
use crate::state::{AppState, Pick};
use crate::text::three_digits;
use crate::theme::Meaning;

/// Height of the bar, points.
const HEIGHT: f32 = 14.0;

const ABOUT: &str = "A mode of squared frequency ω² and damping c per mass stays stable while\n\
    dt²ω² + 2c·dt < 4, that is dt < 4/(c + √(c² + 4ω²)).\n\n\
    The certified limit is that of the worst spring with all that pulls at its two ends: quickly found, and safe.\n\
    The true limit is that of the whole network's worst mode: found by iteration, now and then.\n\
    Between the two the motion is still stable; beyond the true limit it explodes.";

/// The section.
pub fn show(ui: &mut Ui, state: &mut AppState) {
    let (dt, stability) = (state.report.params.dt, state.report.stability);
    let verdict = verdict(dt, &stability);
    let response = ui.horizontal(|ui| {
        icon::label(ui, icon::LAMP, verdict.meaning.colour(ui.visuals()));
        ui.label(verdict.text);
    });
    response.response.on_hover_text(ABOUT);
    bar(ui, dt, &stability);
    numbers(ui, dt, &stability);
    if let Some(limit) = stability.certified {
        setter(ui, state, limit);
    }
    let mut auto = state.report.auto_substeps;
    let text = "Auto sub-steps";
    let about = "Takes more and shorter steps where dt would be too long, at the same simulated time for a frame, and \
                 fewer again where it may.";
    if ui.checkbox(&mut auto, text).on_hover_text(about).changed() {
        state.send(Command::AutoSubsteps(auto));
    }
}

/// What the meter says, in words.
struct Verdict {
    meaning: Meaning,
    text: String,
}

fn verdict(dt: f64, stability: &Stability) -> Verdict {
    let certified = stability.certified.map(|limit| limit.dt);
    let (meaning, text) = match (certified, stability.sharp) {
        (None, None) => (Meaning::Good, "Nothing here limits dt.".to_owned()),
        (Some(certified), _) if dt < certified => {
            let share = dt / certified;
            let meaning = if share > 0.9 { Meaning::Warn } else { Meaning::Good };
            (meaning, format!("Stable: dt is {} of the certified limit.", percent(share)))
        }
        (_, Some(sharp)) if dt < sharp => {
            (Meaning::Warn, format!("Just stable: dt is {} of the true limit.", percent(dt / sharp)))
        }
        (_, Some(sharp)) => {
            (Meaning::Bad, format!("Unstable: dt is {} of the true limit.", percent(dt / sharp)))
        }
        (Some(certified), None) => (
            Meaning::Warn,
            format!("No longer certain: dt is {} of the certified limit.", percent(dt / certified)),
        ),
    };
    Verdict { meaning, text }
}

/// A share in per cent, with a digit more where it is small.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent < 10.0 { format!("{percent:.1} %") } else { format!("{percent:.0} %") }
}

/// A bar from green over amber to red, filled up to dt, with a mark for each limit.
fn bar(ui: &mut Ui, dt: f64, stability: &Stability) {
    let certified = stability.certified.map(|limit| limit.dt);
    let Some(limit) = stability.sharp.or(certified) else { return };
    // A little more than the largest of the three is seen.
    let end = 1.15 * limit.max(dt).max(certified.unwrap_or(0.0));
    let (response, painter) = ui.allocate_painter(vec2(ui.available_width(), HEIGHT + 8.0), Sense::hover());
    let track = Rect::from_min_size(response.rect.min + vec2(0.0, 4.0), vec2(response.rect.width(), HEIGHT));
    let x = |dt: f64| track.left() + track.width() * (dt / end) as f32;
    let colour_at = |dt: f64| blend(ui, dt, certified.unwrap_or(limit).min(limit), limit);
    painter.rect_filled(track, 4.0, ui.visuals().extreme_bg_color);
    // Columns a point wide: bright up to dt, a hint of colour beyond.
    let columns = track.width().ceil() as i32;
    for column in 0..columns {
        let left = track.left() + column as f32;
        let middle = end * f64::from(left + 0.5 - track.left()) / f64::from(track.width());
        let strength = if middle <= dt { 1.0 } else { 0.22 };
        let strip = Rect::from_min_max(
            pos2(left, track.top()),
            pos2((left + 1.0).min(track.right()), track.bottom()),
        );
        painter.rect_filled(strip, 0.0, colour_at(middle).gamma_multiply(strength));
    }
    painter.rect_stroke(track, 4.0, ui.visuals().window_stroke, egui::StrokeKind::Outside);
    let ink = ui.visuals().strong_text_color();
    for limit in [certified, stability.sharp].into_iter().flatten() {
        painter.vline(x(limit), track.y_range().expand(3.0), (1.5, ink));
    }
    let at = x(dt);
    let hand = vec![
        pos2(at - 5.0, track.top() - 4.0),
        pos2(at + 5.0, track.top() - 4.0),
        pos2(at, track.top() + 3.0),
    ];
    painter.add(egui::Shape::convex_polygon(hand, ink, egui::Stroke::NONE));
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::Role::ProgressIndicator, true, verdict(dt, stability).text)
    });
    response.on_hover_text(ABOUT);
}

/// Green well below the certified limit, amber at it, red from the true limit on.
fn blend(ui: &Ui, dt: f64, certified: f64, sharp: f64) -> Color32 {
    let [good, warn, bad] = [Meaning::Good, Meaning::Warn, Meaning::Bad].map(|it| it.colour(ui.visuals()));
    let start = 0.6 * certified;
    if dt < certified {
        good.lerp_to_gamma(warn, ((dt - start) / (certified - start)).clamp(0.0, 1.0) as f32)
    } else if dt < sharp {
        warn.lerp_to_gamma(bad, ((dt - certified) / (sharp - certified)).clamp(0.0, 1.0) as f32)
    } else {
        bad
    }
}

/// dt and the limits, one below the other.
fn numbers(ui: &mut Ui, dt: f64, stability: &Stability) {
    let rows = [
        ("dt", Some(dt)),
        ("certified limit", stability.certified.map(|limit| limit.dt)),
        ("true limit", stability.sharp),
        ("limit in every shape", stability.every_configuration),
    ];
    egui::Grid::new("limits").num_columns(3).spacing(vec2(12.0, 2.0)).show(ui, |ui| {
        for (name, seconds) in rows {
            let Some(seconds) = seconds else { continue };
            ui.weak(name);
            ui.monospace(format!("{:<10}", format!("{} s", three_digits(seconds))));
            let share = if name == "dt" { String::new() } else { percent(dt / seconds) };
            ui.monospace(format!("{share:>7}"));
            ui.end_row();
        }
    });
}

/// What sets the certified limit; a click points it out in the scene.
fn setter(ui: &mut Ui, state: &mut AppState, limit: Limit) {
    let model = &state.report.opened.model;
    let pick = Pick::from(limit.setter);
    let text = match pick {
        Pick::Spring(spring) => format!("Set by {}", model.spring_name(spring)),
        Pick::Point(point) => format!("Set by the contact or grab at {}", model.point_name(point)),
    };
    let is_out = state.pointed_out.contains(&pick);
    let about = "Points it out in the scene and chooses it; once more, and it does not.";
    let button = IconButton::new(icon::TARGET, &text).text(&text).selected(is_out);
    if button.show(ui).on_hover_text(about).clicked() {
        state.pointed_out.clear();
        if !is_out {
            state.pointed_out.push(pick);
            state.selection = Some(pick);
        }
    }
}

#[cfg(test)]
mod tests {
    use sprung::stability::Setter;

    use super::*;

    #[test]
    fn the_verdict_says_which_limit_was_crossed() {
        let limit = |dt| Some(Limit { dt, setter: Setter::Spring(0) });
        let stability = Stability { certified: limit(0.01), sharp: Some(0.012), ..Stability::default() };
        for (dt, meaning, text) in [
            (0.0001, Meaning::Good, "Stable: dt is 1.0 % of the certified limit."),
            (0.0095, Meaning::Warn, "Stable: dt is 95 % of the certified limit."),
            (0.011, Meaning::Warn, "Just stable: dt is 92 % of the true limit."),
            (0.0121, Meaning::Bad, "Unstable: dt is 101 % of the true limit."),
        ] {
            let found = verdict(dt, &stability);
            assert_eq!((found.meaning, found.text.as_str()), (meaning, text));
        }
        assert_eq!(verdict(1.0, &Stability::default()).text, "Nothing here limits dt.");
        let unknown = Stability { sharp: None, ..stability };
        assert_eq!(verdict(0.02, &unknown).text, "No longer certain: dt is 200 % of the certified limit.");
    }
}
