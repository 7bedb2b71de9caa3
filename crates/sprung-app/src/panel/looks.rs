//! How the scene looks: what is drawn, what colours mean, and on which background.

use egui::{ComboBox, Ui};
use sprung_render::appearance::{Appearance, ColourBy, Points, Springs, Surfaces, Theme};

use super::number::{Number, Scale};
use super::{action_button, number, pictures};
use crate::action::Action;
use crate::state::AppState;

/// How points can be shown, and what that is called.
pub static POINTS: [(Points, &str); 3] =
    [(Points::Auto, "automatic"), (Points::Spheres, "spheres"), (Points::Hidden, "hidden")];

/// How springs can be shown.
pub static SPRINGS: [(Springs, &str); 4] = [
    (Springs::Auto, "automatic"),
    (Springs::Lines, "lines"),
    (Springs::Coils, "coils"),
    (Springs::Hidden, "hidden"),
];

/// How cloths and skins can be shown.
pub static SURFACES: [(Surfaces, &str); 4] = [
    (Surfaces::Auto, "automatic"),
    (Surfaces::Filled, "filled"),
    (Surfaces::Wireframe, "wireframe"),
    (Surfaces::Hidden, "hidden"),
];

/// What colours can mean.
pub static COLOUR_BY: [(ColourBy, &str); 4] = [
    (ColourBy::Plain, "plain"),
    (ColourBy::Strain, "strain"),
    (ColourBy::Tension, "tension"),
    (ColourBy::Energy, "energy"),
];

/// The section.
pub fn show(ui: &mut Ui, state: &mut AppState) {
    let look = &mut state.appearance;
    choice(ui, "points", "How points are drawn.", &mut look.points, &POINTS);
    choice(ui, "springs", "How springs are drawn.", &mut look.springs, &SPRINGS);
    choice(ui, "surfaces", "How cloths and skins are drawn.", &mut look.surfaces, &SURFACES);
    let about = "What the colour of a spring means: its strain (ℓ − L)/L, its tension k_s(ℓ − L), or its energy \
                 ½k_s(ℓ − L)². On a surface, the mean over each point's springs.";
    choice(ui, "colour by", about, &mut look.colour_by, &COLOUR_BY);
    scales(ui, look);
    ui.checkbox(&mut look.ground, "Ground").on_hover_text("Ground planes with their grid.");
    ui.checkbox(&mut look.shadows, "Shadows").on_hover_text("Shadows on the ground.");
    background(ui, look);
    pictures::overlays(ui, &mut state.overlays);
    ui.horizontal_wrapped(|ui| {
        action_button(ui, state, Action::ResetView);
        action_button(ui, state, Action::Presentation);
    });
}

fn choice<T: PartialEq + Copy>(ui: &mut Ui, name: &str, about: &str, value: &mut T, all: &[(T, &str)]) {
    ui.horizontal(|ui| {
        let label = number::fixed_width(ui, 92.0, |ui| ui.label(name).on_hover_text(about).id);
        let chosen = all.iter().find(|(choice, _)| choice == value).map_or("", |(_, name)| name);
        let combo = ComboBox::from_id_salt(name).selected_text(chosen).show_ui(ui, |ui| {
            for (choice, name) in all {
                ui.selectable_value(value, *choice, *name);
            }
        });
        combo.response.labelled_by(label).on_hover_text(about);
    });
}

fn scales(ui: &mut Ui, look: &mut Appearance) {
    let unit = match look.colour_by {
        ColourBy::Plain => None,
        ColourBy::Strain => Some(""),
        ColourBy::Tension => Some("N"),
        ColourBy::Energy => Some("J"),
    };
    let scale = |name, unit, about| Number {
        name,
        unit,
        about,
        allowed: 0.0..=1e9,
        slider: 0.0..=10.0,
        scale: Scale::Logarithmic,
    };
    if let Some(unit) = unit {
        let about = "The value at which the colour scale ends; more than that looks the same.";
        let full = Number { allowed: 1e-9..=1e9, slider: 1e-3..=1e4, ..scale("full scale", unit, about) };
        set(ui, &full, &mut look.full_scale);
    }
    let velocity = scale(
        "v arrows",
        "m·s/m",
        "An arrow at each point along its velocity: its length in m for 1 m/s. 0: none.",
    );
    set(ui, &velocity, &mut look.velocity_arrows);
    let force = scale(
        "F arrows",
        "m/N",
        "An arrow at each point along the force on it: its length in m for 1 N. 0: none.",
    );
    set(ui, &force, &mut look.force_arrows);
}

fn set(ui: &mut Ui, number: &Number<'_>, value: &mut f32) {
    if let Some(asked) = number.show(ui, f64::from(*value), None) {
        *value = asked.value as f32;
    }
}

fn background(ui: &mut Ui, look: &mut Appearance) {
    ui.horizontal(|ui| {
        let label = number::fixed_width(ui, 92.0, |ui| ui.label("background").id);
        let mut colour = look.background.unwrap_or(match look.theme {
            Theme::Light => [245, 246, 248],
            Theme::Dark => [24, 26, 30],
        });
        let button = ui.color_edit_button_srgb(&mut colour).labelled_by(label);
        if button.on_hover_text("The colour behind the scene.").changed() {
            look.background = Some(colour);
        }
        let own = ui.add_enabled(look.background.is_some(), egui::Button::new("The theme's own"));
        if own.clicked() {
            look.background = None;
        }
    });
    ui.horizontal(|ui| {
        ui.label("theme");
        for (theme, name) in [(Theme::Light, "light"), (Theme::Dark, "dark")] {
            ui.selectable_value(&mut look.theme, theme, name);
        }
    });
}
