//! Cards over the scene: help, blow-ups, errors, files.

use sprung_driver::{Command, Trouble};

use crate::action::Action;
use crate::state::AppState;

/// The cards.
#[derive(Default)]
pub struct Cards {}

impl Cards {
    /// Shows those that are up.
    pub fn show(&mut self, context: &egui::Context, state: &mut AppState) {
        let text = match &state.report.trouble {
            None => return,
            Some(Trouble::BlewUp(blow_up)) => blow_up.to_string(),
            Some(Trouble::Refused(error)) => error.to_string(),
        };
        egui::Window::new("Trouble").show(context, |ui| {
            ui.label(text);
            if ui.button("Close").clicked() {
                state.send(Command::Dismiss);
            }
        });
    }

    /// Puts up the card to open or save a file.
    pub fn file(&mut self, _action: Action, _state: &mut AppState) {}
}
