//! "How it works": the step in formulas with the numbers of the moment, and lessons.

use crate::state::AppState;

/// The side panel that explains.
#[derive(Default)]
pub struct Explain {}

impl Explain {
    /// The panel.
    pub fn show(&mut self, ui: &mut egui::Ui, state: &mut AppState) {
        ui.label(&state.report.opened.scene.description);
    }
}
