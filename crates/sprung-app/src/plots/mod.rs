//! Plots of energies and of chosen quantities.

use crate::state::AppState;

/// The plots.
#[derive(Default)]
pub struct Plots {}

impl Plots {
    /// The plots' panel.
    pub fn show(&mut self, ui: &mut egui::Ui, state: &mut AppState) {
        ui.label(format!("{:.3} J", state.report.energy.total()));
    }
}
