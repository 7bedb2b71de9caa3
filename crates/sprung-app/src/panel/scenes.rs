//! The scenes to choose from: the four of the report, the gallery, and files.

use std::sync::OnceLock;

use egui::{Button, RichText, Ui, vec2};
use sprung::scene::{BUILTIN, Kind, Scene};

use super::action_button;
use crate::action::Action;
use crate::files::Origin;
use crate::state::AppState;
use crate::text::thousands;

/// A built-in scene as the panel shows it.
pub struct Entry {
    /// The name it is opened by.
    pub name: &'static str,
    /// What it is for.
    pub kind: Kind,
    /// Its title.
    pub title: String,
    /// What to look at.
    pub description: String,
}

/// All built-in scenes with their titles; their texts are read once.
pub fn entries() -> &'static [Entry] {
    static ENTRIES: OnceLock<Vec<Entry>> = OnceLock::new();
    ENTRIES.get_or_init(|| {
        let entry = |builtin: &sprung::scene::Builtin| {
            let scene = Scene::builtin(builtin.name).ok();
            let (title, description) =
                scene.map_or_else(Default::default, |scene| (scene.title, scene.description));
            Entry { name: builtin.name, kind: builtin.kind, title, description }
        };
        BUILTIN.iter().map(entry).collect()
    })
}

/// The open scene and the choice of others.
pub fn show(ui: &mut Ui, state: &mut AppState) {
    let opened = state.report.opened.clone();
    let title = if opened.scene.title.is_empty() { &opened.name } else { &opened.scene.title };
    ui.add(egui::Label::new(RichText::new(title).heading()).wrap()).on_hover_text(&opened.scene.description);
    let (points, springs) = (opened.model.point_count(), opened.model.spring_count());
    let count = |count: usize, one: &str| {
        if count == 1 { format!("1 {one}") } else { format!("{} {one}s", thousands(count)) }
    };
    ui.weak(format!("{}, {}", count(points, "point"), count(springs, "spring")));
    ui.add_space(4.0);
    let gap = ui.spacing().item_spacing.x;
    let width = ((ui.available_width() - 3.0 * gap) / 4.0).max(60.0);
    ui.horizontal(|ui| {
        for (index, entry) in of_kind(Kind::Report).enumerate() {
            let text = format!("{}  {}", index + 1, entry.name);
            scene_button(ui, state, entry, &text, vec2(width, 28.0));
        }
    });
    ui.horizontal_wrapped(|ui| {
        for entry in of_kind(Kind::Gallery) {
            scene_button(ui, state, entry, entry.name, vec2(0.0, 0.0));
        }
    });
    ui.horizontal_wrapped(|ui| {
        ui.weak("large:").on_hover_text("Scenes for measuring speed.");
        for entry in of_kind(Kind::Benchmark) {
            scene_button(ui, state, entry, entry.name, vec2(0.0, 0.0));
        }
    });
    ui.horizontal(|ui| {
        action_button(ui, state, Action::Open);
        action_button(ui, state, Action::Save);
    });
}

/// The built-in scenes of a kind, in order.
pub fn of_kind(kind: Kind) -> impl Iterator<Item = &'static Entry> {
    entries().iter().filter(move |entry| entry.kind == kind)
}

/// A button that opens a built-in scene.
pub fn scene_button(ui: &mut Ui, state: &mut AppState, entry: &Entry, text: &str, size: egui::Vec2) -> bool {
    let is_open = state.files.origin == Origin::Builtin(entry.name.to_owned());
    let response = ui.add(Button::new(text).selected(is_open).min_size(size));
    response.widget_info(|| {
        egui::WidgetInfo::selected(egui::Role::Button, true, is_open, format!("scene {}", entry.name))
    });
    let response = response.on_hover_ui(|ui| {
        ui.set_max_width(340.0);
        ui.strong(&entry.title);
        ui.label(&entry.description);
    });
    let clicked = response.clicked();
    if clicked {
        state.open_builtin(entry.name);
    }
    clicked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_has_a_title_and_a_description() {
        assert_eq!(entries().len(), BUILTIN.len());
        for entry in entries() {
            assert!(!entry.title.is_empty() && !entry.description.is_empty(), "{}", entry.name);
        }
    }
}
