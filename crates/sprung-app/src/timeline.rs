//! The timeline: what can be gone back to.

use sprung_driver::Command;

use crate::state::AppState;

/// The timeline's strip.
pub fn show(ui: &mut egui::Ui, state: &mut AppState) {
    ui.label(format!("t = {:.2} s, step {}", state.report.now.time, state.report.now.step));
}

/// Goes on (or back) by so many frames of what is recorded.
pub fn go(state: &mut AppState, frames: i64) {
    let steps = frames * i64::from(state.report.params.substeps);
    let timeline = &state.report.timeline;
    let step = state.report.now.step.saturating_add_signed(steps).clamp(timeline.first.0, timeline.newest.0);
    state.send(Command::Seek(step));
}
