//! The card for what is odd about the meshes of a scene: it is open, and this was mended or left out.

use egui::{Context, RichText};

use super::{modal, primary};
use crate::icon;
use crate::theme::Meaning;

/// What the card is called.
pub const TITLE: &str = "It is open, but look at this";

/// The card; gives whether it is to be closed.
pub fn show(context: &Context, warnings: &[String]) -> bool {
    modal(context, "warnings card", TITLE, 560.0, |ui| {
        for sentence in warnings {
            ui.horizontal_top(|ui| {
                icon::label(ui, icon::WARNING, Meaning::Warn.colour(ui.visuals()));
                ui.add(egui::Label::new(RichText::new(format!("{sentence}."))).wrap());
            });
            ui.add_space(4.0);
        }
        ui.add_space(6.0);
        let button = ui.add(primary(ui, "Close"));
        if ui.memory(|memory| memory.focused().is_none()) {
            button.request_focus();
        }
        button.clicked()
    })
}
