//! The help card: every key, from the one list of actions, and what the mouse does.

use egui::{Align, Context, Grid, Layout, RichText, Ui, vec2};

use super::modal;
use crate::action::{ACTIONS, ActionInfo};

/// What the card is called.
pub const TITLE: &str = "Keys and gestures";

/// Width of the column of keys, points.
const KEYS_WIDTH: f32 = 148.0;

/// What mouse, touchpad and fingers do in the scene.
pub static GESTURES: [(&str, &str); 10] = [
    ("Drag a point", "Pulls it by a spring to the cursor; with Shift it is carried along, whatever resists."),
    ("Wheel while dragging", "Brings the hand nearer, or takes it away."),
    ("Double-click a point", "Pins it, or frees it."),
    ("Click a point or a spring", "Chooses it: its numbers stay in sight, its formulas are filled in."),
    ("Drag with the scissors", "Parts the springs that the line crosses; a click parts one."),
    ("Drag anywhere but on a point", "Turns the view."),
    ("Right or middle drag", "Moves the view, and so does a drag with Shift anywhere but on a point."),
    ("Wheel, or pinch", "Comes nearer, or goes away."),
    ("Double-click beside the scene", "Looks at all of it."),
    ("Drop a file", "Opens the scene in it."),
];

/// The card; gives whether it is to be closed.
pub fn show(context: &Context) -> bool {
    modal(context, "help card", TITLE, 860.0, |ui| {
        let half = ACTIONS.len().div_ceil(2);
        if ui.available_width() > 700.0 {
            ui.spacing_mut().item_spacing.x = 24.0;
            ui.columns(2, |columns| {
                keys(&mut columns[0], &ACTIONS[..half]);
                keys(&mut columns[1], &ACTIONS[half..]);
            });
        } else {
            keys(ui, ACTIONS);
        }
        ui.add_space(8.0);
        ui.label(RichText::new("In the scene").strong());
        Grid::new("gestures").num_columns(2).spacing(vec2(16.0, 3.0)).show(ui, |ui| {
            for (gesture, what) in GESTURES {
                ui.label(RichText::new(gesture).strong());
                ui.label(what);
                ui.end_row();
            }
        });
        false
    })
}

fn keys(ui: &mut Ui, actions: &[ActionInfo]) {
    let context = ui.ctx().clone();
    ui.spacing_mut().item_spacing = vec2(8.0, 4.0);
    for info in actions {
        ui.horizontal_top(|ui| {
            let cell = vec2(KEYS_WIDTH, ui.text_style_height(&egui::TextStyle::Body));
            ui.allocate_ui_with_layout(cell, Layout::left_to_right(Align::TOP), |ui| {
                ui.set_min_width(KEYS_WIDTH);
                ui.label(RichText::new(info.keys_text(&context)).strong());
            });
            ui.add(egui::Label::new(info.description).wrap());
        });
    }
}
