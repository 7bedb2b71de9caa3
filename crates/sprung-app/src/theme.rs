//! Colours and sizes of the window's parts.

use sprung_render::appearance::Theme;

/// Sets the theme.
pub fn apply(context: &egui::Context, theme: Theme) {
    context.set_theme(match theme {
        Theme::Light => egui::Theme::Light,
        Theme::Dark => egui::Theme::Dark,
    });
}
