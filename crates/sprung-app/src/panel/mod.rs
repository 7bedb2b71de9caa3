//! The panels: what to play, and with which parameters.

mod bar;
pub mod ground;
mod groups;
mod looks;
mod number;
mod params;
pub mod pictures;
pub mod scenes;
mod speed;
mod stability;

pub use bar::bar;
pub use looks::{COLOUR_BY, POINTS, SPRINGS, SURFACES};
pub use number::fixed_width;
pub use params::PLANETS;
pub use speed::Speedometer;

use egui::{CollapsingHeader, Id, Margin, Response, RichText, ScrollArea, Ui, vec2};

use crate::action::Action;
use crate::icon::{self, IconButton};
use crate::state::AppState;

/// Room for the scroll bar, so that it covers nothing.
const BESIDE_SCROLL_BAR: Margin = Margin { left: 0, right: 10, top: 0, bottom: 0 };

/// Scenes, stability, parameters and looks, one below the other.
#[derive(Default)]
pub struct Controls {
    params: params::ParamsPanel,
    /// What had the keyboard's focus last, to notice where it goes.
    focused: Option<Id>,
}

impl Controls {
    /// The panel. What does not fit is scrolled to.
    pub fn show(&mut self, ui: &mut Ui, state: &mut AppState) {
        ScrollArea::both().auto_shrink(false).content_margin(BESIDE_SCROLL_BAR).show(ui, |ui| {
            ui.add_space(4.0);
            scenes::show(ui, state);
            section(ui, "Stability", true, |ui| stability::show(ui, state));
            self.params.show(ui, state);
            section(ui, "Looks", false, |ui| looks::show(ui, state));
            section(ui, "Pictures and films", false, |ui| {
                pictures::show(ui, state);
                ui.horizontal_wrapped(|ui| {
                    action_button(ui, state, Action::Picture);
                    action_button(ui, state, Action::Record);
                    action_button(ui, state, Action::Motion);
                });
            });
            ui.add_space(8.0);
            self.follow_focus(ui);
        });
    }

    /// What the Tab key has gone to is scrolled into sight.
    fn follow_focus(&mut self, ui: &Ui) {
        let focused = ui.memory(|memory| memory.focused());
        if focused == self.focused {
            return;
        }
        self.focused = focused;
        let Some(response) = focused.and_then(|id| ui.ctx().read_response(id)) else { return };
        // Only what lies in this panel is cut off by its edges.
        let is_cut_off = !response.interact_rect.contains_rect(response.rect);
        if is_cut_off && response.layer_id == ui.layer_id() {
            ui.scroll_to_rect(response.rect.expand(8.0), None);
        }
    }
}

/// A part of the panel that folds away.
fn section(ui: &mut Ui, title: &str, is_open: bool, add: impl FnOnce(&mut Ui)) {
    ui.separator();
    let title = RichText::new(title).strong().size(14.5);
    CollapsingHeader::new(title).default_open(is_open).show_unindented(ui, |ui| {
        ui.add_space(2.0);
        add(ui);
        ui.add_space(2.0);
    });
}

/// The button of an action, with its sign and its name.
pub fn action_button(ui: &mut Ui, state: &mut AppState, action: Action) -> Response {
    let info = action.info();
    finish(ui, state, action, IconButton::new(info.icon, info.name).text(info.name))
}

/// The button of an action, with its sign only.
pub fn action_icon(ui: &mut Ui, state: &mut AppState, action: Action) -> Response {
    finish(ui, state, action, IconButton::new(action.info().icon, action.info().name))
}

/// As [`action_icon`], for what is either on or off.
pub fn action_toggle(ui: &mut Ui, state: &mut AppState, action: Action, on: bool) -> Response {
    finish(ui, state, action, IconButton::new(action.info().icon, action.info().name).selected(on))
}

/// The button that plays or pauses, with the sign of what it would do; with its word, too, where that is wanted.
pub fn play_button(ui: &mut Ui, state: &mut AppState, has_text: bool) -> Response {
    let (icon, name) = if state.report.playing { (icon::PAUSE, "Pause") } else { (icon::PLAY, "Play") };
    let mut button = IconButton::new(icon, name);
    if has_text {
        // As wide for both words, so that the row does not jump.
        button = button.text(name).with(|button| button.min_size(vec2(76.0, 0.0)));
    }
    finish(ui, state, Action::PlayPause, button)
}

/// The buttons to undo and redo, which say what they would do.
pub fn undo_and_redo(ui: &mut Ui, state: &mut AppState) {
    for action in [Action::Undo, Action::Redo] {
        let what = if action == Action::Undo { &state.report.undo } else { &state.report.redo };
        let what = what.clone();
        let button = IconButton::new(action.info().icon, action.info().name).enabled(what.is_some());
        let response = finish(ui, state, action, button);
        if let Some(what) = what {
            response.on_hover_text(format!("{}: {what}", action.info().name));
        }
    }
}

fn finish(ui: &mut Ui, state: &mut AppState, action: Action, button: IconButton<'_>) -> Response {
    let response = button.show(ui).on_hover_text(action.info().tooltip(ui.ctx()));
    if response.clicked() {
        state.act(action);
    }
    response
}
