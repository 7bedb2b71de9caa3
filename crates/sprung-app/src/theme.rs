//! Colours and sizes of the window's parts: calm greys, one accent, and three colours with a meaning.

use egui::{
    Color32, CornerRadius, FontFamily, FontId, Margin, Shadow, Stroke, Style, TextStyle, Visuals, vec2,
};
use sprung_render::appearance::Theme;

/// Sets fonts, distances and colours of both themes; once, when the window opens.
pub fn install(context: &egui::Context) {
    for theme in [egui::Theme::Light, egui::Theme::Dark] {
        context.style_mut_of(theme, |style| {
            sizes(style);
            colours(&mut style.visuals, theme);
        });
    }
}

/// Sets the theme.
pub fn apply(context: &egui::Context, theme: Theme) {
    context.set_theme(match theme {
        Theme::Light => egui::Theme::Light,
        Theme::Dark => egui::Theme::Dark,
    });
}

fn sizes(style: &mut Style) {
    let text = [
        (TextStyle::Small, 11.0, FontFamily::Proportional),
        (TextStyle::Body, 13.5, FontFamily::Proportional),
        (TextStyle::Button, 13.5, FontFamily::Proportional),
        (TextStyle::Heading, 17.0, FontFamily::Proportional),
        (TextStyle::Monospace, 12.5, FontFamily::Monospace),
    ];
    style.text_styles = text.map(|(style, size, family)| (style, FontId::new(size, family))).into();
    let spacing = &mut style.spacing;
    spacing.item_spacing = vec2(6.0, 6.0);
    spacing.button_padding = vec2(8.0, 3.0);
    spacing.interact_size = vec2(28.0, 22.0);
    spacing.window_margin = Margin::same(16);
    spacing.menu_margin = Margin::same(8);
    spacing.slider_rail_height = 4.0;
    spacing.tooltip_width = 340.0;
}

fn colours(visuals: &mut Visuals, theme: egui::Theme) {
    let is_dark = theme == egui::Theme::Dark;
    let pick = |light: u32, dark: u32| rgb(if is_dark { dark } else { light });
    visuals.panel_fill = pick(0xf7f7f8, 0x1d1f23);
    visuals.window_fill = pick(0xffffff, 0x25282d);
    visuals.extreme_bg_color = pick(0xffffff, 0x15171a);
    visuals.text_edit_bg_color = Some(pick(0xffffff, 0x15171a));
    visuals.faint_bg_color = pick(0xeeeff1, 0x26292e);
    visuals.window_stroke = Stroke::new(1.0, pick(0xd4d6da, 0x3b3f46));
    visuals.window_corner_radius = CornerRadius::same(10);
    visuals.menu_corner_radius = CornerRadius::same(8);
    visuals.window_shadow =
        Shadow { offset: [0, 8], blur: 28, spread: 0, color: Color32::from_black_alpha(60) };
    visuals.popup_shadow =
        Shadow { offset: [0, 4], blur: 12, spread: 0, color: Color32::from_black_alpha(50) };
    visuals.selection.bg_fill = pick(0xc4dcf5, 0x1f4f7d);
    visuals.selection.stroke = Stroke::new(1.0, pick(0x0b4a85, 0xdcecff));
    visuals.hyperlink_color = accent(is_dark);
    visuals.warn_fg_color = pick(0x8a5300, 0xf0b656);
    visuals.error_fg_color = pick(0xb3261e, 0xff8a80);
    visuals.slider_trailing_fill = true;
    visuals.indent_has_left_vline = false;
    let widgets = &mut visuals.widgets;
    // The rest state: text a shade softer than black and white, outlines hardly seen.
    widgets.noninteractive.fg_stroke.color = pick(0x2b2e33, 0xd5d8dc);
    widgets.noninteractive.bg_stroke.color = pick(0xdedfe3, 0x33373d);
    widgets.inactive.fg_stroke.color = pick(0x24272b, 0xdfe2e6);
    widgets.inactive.bg_fill = pick(0xdddfe4, 0x3a3f46);
    widgets.inactive.weak_bg_fill = pick(0xe9eaee, 0x2d3137);
    widgets.hovered.weak_bg_fill = pick(0xdcdfe5, 0x3a4048);
    widgets.active.weak_bg_fill = pick(0xcbd0d9, 0x47505b);
    for state in [
        &mut widgets.noninteractive,
        &mut widgets.inactive,
        &mut widgets.hovered,
        &mut widgets.active,
        &mut widgets.open,
    ] {
        state.corner_radius = CornerRadius::same(5);
    }
}

/// A colour from 0xrrggbb.
pub fn rgb(rgb: u32) -> Color32 {
    let [_, red, green, blue] = rgb.to_be_bytes();
    Color32::from_rgb(red, green, blue)
}

/// What can be clicked and what is on.
fn accent(is_dark: bool) -> Color32 {
    rgb(if is_dark { 0x6db3f2 } else { 0x0b63b5 })
}

/// The three colours with a meaning. Blue-green, amber and vermilion also differ for those who confuse red and green.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// All is well.
    Good,
    /// Take care.
    Warn,
    /// It will go wrong, or has.
    Bad,
}

impl Meaning {
    /// Its colour on the surroundings of the moment.
    pub fn colour(self, visuals: &Visuals) -> Color32 {
        rgb(match (self, visuals.dark_mode) {
            (Self::Good, false) => 0x00876a,
            (Self::Good, true) => 0x35c29b,
            (Self::Warn, false) => 0xc98500,
            (Self::Warn, true) => 0xf0b656,
            (Self::Bad, false) => 0xc8402a,
            (Self::Bad, true) => 0xff7a5c,
        })
    }
}
