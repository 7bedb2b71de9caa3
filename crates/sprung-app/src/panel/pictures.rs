//! How pictures and films are made, and what is written over the scene: for the panel, and for the scene's own menu.

use egui::Ui;

use crate::media::{FilmClock, Filming, PictureSize};
use crate::state::{AppState, Overlays};

/// Sizes, rates and clocks.
pub fn show(ui: &mut Ui, state: &mut AppState) {
    let filming = &mut state.filming;
    let sizes = PictureSize::ALL.map(|size| (size, size.name().to_owned()));
    radios(ui, "Size of pictures and films", &mut filming.size, sizes);
    let rates = Filming::RATES.map(|rate| (rate, format!("{rate} pictures a second")));
    radios(ui, "Films have", &mut filming.rate, rates);
    let clocks = FilmClock::ALL.map(|clock| (clock, clock.name().to_owned()));
    radios(ui, "and go", &mut filming.clock, clocks);
}

/// What is written over the scene beyond the usual.
pub fn overlays(ui: &mut Ui, overlays: &mut Overlays) {
    ui.checkbox(&mut overlays.labels, "Numbers of points")
        .on_hover_text("The index of each point, in scenes of few points.");
    ui.checkbox(&mut overlays.times, "Frame times")
        .on_hover_text("How long a step, the upload and the drawing of a picture take.");
}

fn radios<T: PartialEq + Copy>(
    ui: &mut Ui,
    title: &str,
    value: &mut T,
    all: impl IntoIterator<Item = (T, String)>,
) {
    ui.weak(title);
    for (choice, name) in all {
        ui.radio_value(value, choice, name);
    }
}
