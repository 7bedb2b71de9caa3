//! The bar at the top: play, pause, step, pace, undo, and what of the window is shown.

use egui::{ComboBox, Role, ScrollArea, Ui, WidgetInfo};
use sprung_driver::{Command, Pace};

use super::{action_button, action_icon, action_toggle, play_button, undo_and_redo};
use crate::action::Action;
use crate::state::{AppState, Tool};

/// The bar; what does not fit goes on in another row, or, in a narrow window, is scrolled to.
pub fn bar(ui: &mut Ui, state: &mut AppState) {
    ui.add_space(2.0);
    if state.is_narrow {
        ScrollArea::horizontal().show(ui, |ui| ui.horizontal(|ui| narrow_bar(ui, state)));
        ui.add_space(1.0);
        return;
    }
    ui.horizontal_wrapped(|ui| {
        play_button(ui, state, true);
        for action in [Action::Step, Action::Frame, Action::Reset] {
            action_button(ui, state, action);
        }
        pace(ui, state);
        ui.separator();
        undo_and_redo(ui, state);
        ui.separator();
        let (scissors, shown) = (state.tool == Tool::Scissors, state.shown);
        action_toggle(ui, state, Action::Scissors, scissors);
        for action in [Action::ResetView, Action::Picture, Action::Record] {
            action_icon(ui, state, action);
        }
        #[cfg(target_arch = "wasm32")]
        action_icon(ui, state, Action::Link);
        ui.separator();
        action_toggle(ui, state, Action::Panel, shown.controls);
        action_toggle(ui, state, Action::Plots, shown.plots);
        action_toggle(ui, state, Action::Explain, shown.explain);
        for action in [Action::Presentation, Action::Theme, Action::Help] {
            action_icon(ui, state, action);
        }
    });
    ui.add_space(1.0);
}

/// Signs alone, those that are wanted first on the left.
fn narrow_bar(ui: &mut Ui, state: &mut AppState) {
    play_button(ui, state, false);
    action_icon(ui, state, Action::Reset);
    let (scissors, shown) = (state.tool == Tool::Scissors, state.shown);
    action_toggle(ui, state, Action::Panel, shown.controls);
    action_toggle(ui, state, Action::Scissors, scissors);
    action_icon(ui, state, Action::ResetView);
    action_toggle(ui, state, Action::Explain, shown.explain);
    action_toggle(ui, state, Action::Plots, shown.plots);
    #[cfg(target_arch = "wasm32")]
    action_icon(ui, state, Action::Link);
    undo_and_redo(ui, state);
    for action in [Action::Step, Action::Frame, Action::Picture, Action::Record] {
        action_icon(ui, state, action);
    }
    for action in [Action::Presentation, Action::Theme, Action::Help] {
        action_icon(ui, state, action);
    }
    pace(ui, state);
}

fn pace(ui: &mut Ui, state: &mut AppState) {
    let now = state.report.pace;
    let combo =
        ComboBox::from_id_salt("pace").width(126.0).selected_text(now.to_string()).show_ui(ui, |ui| {
            for pace in Pace::ALL {
                if ui.selectable_label(now == pace, pace.to_string()).clicked() {
                    state.send(Command::Pace(pace));
                }
            }
        });
    let response = combo.response;
    response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, "pace"));
    response.on_hover_text(
        "How fast simulated time goes. The report's own pace is one frame of sub-steps for each sixtieth of a second: \
         four to seven times faster than real time in its scenes.",
    );
}
