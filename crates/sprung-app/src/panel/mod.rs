//! The panels: what to play, and with which parameters.

use crate::action::Action;
use crate::state::AppState;

/// Play, pause, step, reset.
pub fn transport(ui: &mut egui::Ui, state: &mut AppState) {
    ui.horizontal(|ui| {
        for action in [Action::PlayPause, Action::Step, Action::Frame, Action::Reset] {
            if ui.button(action.info().name).on_hover_text(action.info().description).clicked() {
                state.act(action);
            }
        }
    });
}

/// Scenes and parameters.
pub fn controls(ui: &mut egui::Ui, state: &mut AppState) {
    ui.heading(&state.report.opened.scene.title);
    for number in 0..4 {
        let action = Action::Scene(number);
        if ui.button(action.info().name).clicked() {
            state.act(action);
        }
    }
}
