//! The timeline: what can be gone back to, what was changed where, and the earlier run beside this one.

use egui::{EventFilter, Key, Rect, RichText, Role, Sense, Ui, WidgetInfo, pos2, vec2};
use sprung_driver::{Command, Report, Timeline};

use crate::action::Action;
use crate::panel::{Speedometer, action_icon, fixed_width, play_button};
use crate::state::AppState;
use crate::text::three_digits;
use crate::theme::Meaning;

/// Height of the strip, points.
const HEIGHT: f32 = 26.0;

/// Room for the time and for the step, points.
const MOMENT_WIDTHS: [f32; 2] = [104.0, 94.0];

/// Room for the memory of the recording, points.
const MEMORY_WIDTH: f32 = 152.0;

/// From these widths on, the row has room for the time of a frame and the memory, and for how far the ghost is apart:
/// it never takes more than two lines.
const WIDE: f32 = 860.0;
const MEDIUM: f32 = 640.0;

/// How near the cursor must be to a mark to name it, points.
const NEAR: f32 = 5.0;

/// The bar below the scene.
#[derive(Default)]
pub struct TimelineBar {
    speedometer: Speedometer,
}

impl TimelineBar {
    /// Buttons, the moment, and the strip below them.
    pub fn show(&mut self, ui: &mut Ui, state: &mut AppState) {
        ui.add_space(3.0);
        let width = ui.available_width();
        if state.is_narrow {
            // The strip goes back and forth, and the clock is in the scene: steps one by one are for larger windows.
            self.speedometer.show(ui, &state.report, false);
            strip(ui, state);
            ui.add_space(4.0);
            return;
        }
        ui.horizontal_wrapped(|ui| {
            buttons(ui, state);
            moment(ui, &state.report);
            self.speedometer.show(ui, &state.report, width >= WIDE);
            if width >= WIDE {
                memory(ui, &state.report.timeline);
            }
            compare(ui, state, width >= MEDIUM);
        });
        strip(ui, state);
        ui.add_space(4.0);
    }
}

fn buttons(ui: &mut Ui, state: &mut AppState) {
    for action in [Action::Start, Action::Back] {
        action_icon(ui, state, action);
    }
    play_button(ui, state, false);
    for action in [Action::Forward, Action::End] {
        action_icon(ui, state, action);
    }
}

/// Time and step. All texts of the row have the same height, so that they stand on one line, and room for their longest
/// content, so that none pushes the next.
fn moment(ui: &mut Ui, report: &Report) {
    let texts = [format!("t = {:>7.3} s", report.now.time), format!("step {:<7}", report.now.step)];
    for (text, width) in texts.into_iter().zip(MOMENT_WIDTHS) {
        fixed_width(ui, width, |ui| ui.label(RichText::new(text).monospace()));
    }
}

/// Goes on (or back) by so many frames of what is recorded.
pub fn go(state: &mut AppState, frames: i64) {
    let steps = frames * i64::from(state.report.params.substeps);
    let timeline = &state.report.timeline;
    let step = state.report.now.step.saturating_add_signed(steps);
    seek(state, step.clamp(timeline.first.0, timeline.newest.0.max(timeline.first.0)));
}

/// Goes to the first recorded moment.
pub fn go_to_start(state: &mut AppState) {
    seek(state, state.report.timeline.first.0);
}

/// Goes to the newest.
pub fn go_to_end(state: &mut AppState) {
    seek(state, state.report.timeline.newest.0);
}

fn seek(state: &mut AppState, step: u64) {
    if step != state.report.now.step || state.report.playing {
        state.send(Command::Seek(step));
    }
}

fn compare(ui: &mut Ui, state: &mut AppState, has_room: bool) {
    let mut on = state.report.comparison.is_some() || state.compares;
    let about = "After a change in the past, shows the run that was left as a ghost beside this one, and how far the two \
                 are apart.";
    if ui.checkbox(&mut on, "Ghost of the earlier run").on_hover_text(about).changed() {
        state.compares = on;
        state.send(Command::Compare(on));
    }
    if !has_room {
        return;
    }
    if let Some(comparison) = &state.report.comparison {
        let apart = three_digits(comparison.apart);
        let text = format!("apart by {apart} m, parted at step {}", comparison.parted);
        ui.label(RichText::new(text).color(Meaning::Warn.colour(ui.visuals())))
            .on_hover_text("The largest distance between the same point in both runs.");
    } else if state.compares {
        ui.weak("no earlier run yet");
    }
}

fn memory(ui: &mut Ui, timeline: &Timeline) {
    let mega = |bytes: usize| bytes.div_ceil(1 << 20);
    let (used, most) = timeline.bytes;
    // The first state is always kept, even beyond what may be used up.
    let text = match used < most {
        true => format!("recording: {} of {} MB", mega(used), mega(most)),
        false => format!("recording: {} MB, full", mega(used)),
    };
    fixed_width(ui, MEMORY_WIDTH, |ui| ui.weak(text)).on_hover_text(
        "States are kept now and then, and the steps between them are taken again when they are gone to: bit for bit the \
         same. When the memory is used up, the states kept lie further apart.",
    );
}

/// The strip to scrub in: time goes from left to right.
fn strip(ui: &mut Ui, state: &mut AppState) {
    let size = vec2(ui.available_width().max(60.0), HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let timeline = state.report.timeline.clone();
    let (first, newest) = (timeline.first.0, timeline.newest.0);
    let span = newest.saturating_sub(first).max(1) as f64;
    let track = rect.shrink2(vec2(8.0, 9.0));
    let x_of =
        |step: u64| track.left() + track.width() * (step.saturating_sub(first) as f64 / span).min(1.0) as f32;
    let step_at = |x: f32| {
        let share = f64::from((x - track.left()) / track.width().max(1.0)).clamp(0.0, 1.0);
        first + (share * (newest.saturating_sub(first)) as f64).round() as u64
    };
    // From the press on, not only once it has moved.
    let held = response.is_pointer_button_down_on();
    if let Some(pointer) = response.interact_pointer_pos().filter(|_| held) {
        // The driver keeps only the newest place it is asked to go to.
        seek(state, step_at(pointer.x));
    }
    keys(ui, &response, state);
    paint(ui, &response, track, &x_of, state);
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(Role::Slider, true, "timeline");
        info.value = Some(state.report.now.step as f64);
        info
    });
    let hovered = response.hover_pos();
    response.on_hover_ui_at_pointer(|ui| {
        // Beside the window's edge it moves aside instead of breaking its words.
        ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
        let Some(pointer) = hovered else { return };
        let near: Vec<_> =
            timeline.marks.iter().filter(|(step, _)| (x_of(*step) - pointer.x).abs() <= NEAR).collect();
        for (step, what) in near.iter().take(8) {
            ui.strong(format!("{what} at step {step}"));
        }
        let step = step_at(pointer.x);
        ui.label(format!("Step {step}. Drag to go back and forth; playing goes on from there."));
    });
}

/// While the strip has the focus, its keys move through time.
fn keys(ui: &Ui, response: &egui::Response, state: &mut AppState) {
    if !response.has_focus() {
        return;
    }
    let arrows = EventFilter { horizontal_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, arrows));
    let keys = [
        (Key::ArrowLeft, Action::Back),
        (Key::ArrowRight, Action::Forward),
        (Key::Home, Action::Start),
        (Key::End, Action::End),
    ];
    for (key, action) in keys {
        if ui.input(|input| input.key_pressed(key)) {
            state.act(action);
        }
    }
}

fn paint(ui: &Ui, response: &egui::Response, track: Rect, x_of: &dyn Fn(u64) -> f32, state: &AppState) {
    let (painter, visuals) = (ui.painter(), ui.visuals());
    let now = x_of(state.report.now.step);
    painter.rect_filled(track, 4.0, visuals.widgets.inactive.bg_fill);
    let past = Rect::from_min_max(track.min, pos2(now, track.bottom()));
    painter.rect_filled(past, 4.0, visuals.selection.bg_fill);
    if let Some(comparison) = &state.report.comparison {
        let parted =
            Rect::from_min_max(pos2(x_of(comparison.parted), track.top()), pos2(now, track.bottom()));
        painter.rect_filled(parted, 4.0, Meaning::Warn.colour(visuals).gamma_multiply(0.35));
    }
    for (step, _) in state.report.timeline.marks.iter() {
        painter.vline(x_of(*step), track.y_range().expand(4.0), (2.0, Meaning::Warn.colour(visuals)));
    }
    let style = ui.style().interact(response);
    painter.circle(pos2(now, track.center().y), 7.0, visuals.extreme_bg_color, (2.0, style.fg_stroke.color));
    if response.has_focus() {
        painter.rect_stroke(response.rect, 4.0, visuals.selection.stroke, egui::StrokeKind::Inside);
    }
}
