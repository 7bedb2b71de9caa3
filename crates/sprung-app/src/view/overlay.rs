//! What is written over the scene: the time, axes and a scale, what arrows and the ghost are, and notes.

use egui::{Align2, Color32, FontId, Pos2, Rect, RichText, Stroke, Ui, UiBuilder, Vec2, pos2, vec2};
use sprung::Vec3;
use sprung_driver::{Report, Trouble};
use sprung_render::palette::{DARK, LIGHT, Palette};
use sprung_render::turntable::Turntable;

use super::drawn::Drawn;
use super::reading::Reading;
use crate::action::Action;
use crate::state::{AppState, Tool};
use crate::text::{rounded, steady, thousands, with_minus};
use crate::theme;

/// Distance of what is written from the view's edges.
const EDGE: f32 = 14.0;
/// A depth below a plane is worth a note from this share of the scene's size on.
const DEEP: f32 = 0.02;
/// A depth is as it should be up to this multiple of what the weight alone presses in: what lands goes deeper for a
/// moment.
const AS_IT_SHOULD: f32 = 2.5;
/// Before this moment nothing has come to lie anywhere: what is in the plane was put there, s.
const BEGINNING: f64 = 0.25;
/// A note needs at least this width, points; wider than the second it is hard to read.
const NOTE_WIDTHS: [f32; 2] = [200.0, 420.0];
/// Room between what lies side by side at the bottom.
const APART: f32 = 12.0;
/// Width that the axes and the scale need at the bottom right, and their height.
const AXES: Vec2 = vec2(104.0, 96.0);
/// Room that legend and axes leave above them for the time, and for the scene.
const FREE_ABOVE: f32 = 90.0;
/// Points looked at for that; of more, an even selection.
const POINTS_SAMPLED: usize = 20_000;
/// Up to this many points are labelled with their numbers.
const MOST_LABELS: usize = 60;

/// What of it the user has put away.
#[derive(Default)]
pub struct Notes {
    /// The scene whose note about its plane was read.
    plane_read: Option<u64>,
    /// Where a note lies in the window, if there is one.
    place: Option<Rect>,
}

impl Notes {
    /// Where a note lies in the window, if there is one.
    pub fn place(&self) -> Option<Rect> {
        self.place
    }
}

/// A panel behind text, so that it can be read over anything.
pub fn plate(ui: &Ui) -> egui::Frame {
    let fill = ui.visuals().panel_fill.gamma_multiply(0.86);
    egui::Frame::new().fill(fill).corner_radius(6.0).inner_margin(egui::Margin::symmetric(8, 5))
}

/// A place in a corner of the view for some widgets.
fn at<R>(ui: &mut Ui, rect: Rect, align: Align2, add: impl FnOnce(&mut Ui) -> R) -> R {
    let layout = match align.x() {
        egui::Align::Max => egui::Layout::top_down(egui::Align::Max),
        egui::Align::Center => egui::Layout::top_down(egui::Align::Center),
        egui::Align::Min => egui::Layout::top_down(egui::Align::Min),
    };
    ui.scope_builder(UiBuilder::new().max_rect(rect).layout(layout), add).inner
}

/// The time and whether it stands still, at the top left.
pub fn status(ui: &mut Ui, view: Rect, state: &AppState, recording: Option<&str>) {
    let report = &state.report;
    let rect = Rect::from_min_size(view.min + vec2(EDGE, EDGE), vec2(360.0, 60.0));
    at(ui, rect, Align2::LEFT_TOP, |ui| {
        ui.horizontal(|ui| {
            let time = with_minus(format!("t = {:.3} s", report.now.time));
            let text = RichText::new(time).monospace().size(14.0);
            plate(ui).show(ui, |ui| ui.add(egui::Label::new(text).selectable(false)));
            if !report.playing {
                badge(ui, "paused", ui.visuals().weak_text_color());
            }
            if state.tool == Tool::Scissors {
                badge(ui, "scissors", ui.visuals().hyperlink_color);
            }
            if let Some(busy) = &report.busy {
                badge(ui, busy, ui.visuals().hyperlink_color);
            }
            if let Some(recording) = recording {
                badge(ui, recording, ui.visuals().error_fg_color);
            }
        });
    });
}

fn badge(ui: &mut Ui, text: &str, colour: Color32) {
    let text = RichText::new(text).color(colour).size(13.0).strong();
    plate(ui).show(ui, |ui| {
        let (dot, _) = ui.allocate_exact_size(vec2(8.0, 14.0), egui::Sense::hover());
        ui.painter().circle_filled(dot.center(), 4.0, colour);
        ui.add(egui::Label::new(text).selectable(false));
    });
}

/// The selection's numbers, at the top right.
pub fn selection(ui: &mut Ui, view: Rect, reading: &Reading) {
    let width = 250.0f32.min(view.width() - 2.0 * EDGE);
    let corner = pos2(view.max.x - EDGE - width, view.min.y + EDGE);
    let rect = Rect::from_min_size(corner, vec2(width, 200.0));
    at(ui, rect, Align2::RIGHT_TOP, |ui| {
        plate(ui).show(ui, |ui| reading_table(ui, reading, "selection"));
    });
}

/// The numbers of a reading as two columns.
pub fn reading_table(ui: &mut Ui, reading: &Reading, id: &str) {
    let label = |ui: &mut Ui, text: RichText| ui.add(egui::Label::new(text).selectable(false).extend());
    ui.with_layout(egui::Layout::top_down(egui::Align::Min), |ui| {
        ui.horizontal(|ui| {
            label(ui, RichText::new(&reading.title).strong());
            if let Some(remark) = reading.remark {
                label(ui, RichText::new(remark).weak());
            }
        });
        egui::Grid::new(id).num_columns(2).spacing([12.0, 2.0]).show(ui, |ui| {
            for (quantity, value) in &reading.lines {
                label(ui, RichText::new(*quantity).weak());
                label(ui, RichText::new(value).monospace().size(12.0));
                ui.end_row();
            }
        });
    });
}

/// Axes and a scale at the bottom right, turned as the scene is.
pub fn axes(ui: &Ui, view: Rect, camera: &Turntable) {
    let painter = ui.painter();
    let ink = ui.visuals().text_color();
    let middle = pos2(view.max.x - EDGE - 34.0, view.max.y - EDGE - 52.0);
    let [right, up, forward] = camera.axes();
    let colours = if ui.visuals().dark_mode {
        [(0xff, 0x8a, 0x7a), (0x8f, 0xd6, 0x7a), (0x8a, 0xb4, 0xff)]
    } else {
        [(0xb8, 0x32, 0x20), (0x2f, 0x7d, 0x21), (0x1f, 0x55, 0xc4)]
    };
    let mut arms: Vec<_> =
        [Vec3::X, Vec3::Y, Vec3::Z].into_iter().zip(["x", "y", "z"]).zip(colours).collect();
    // The one that points away is drawn first.
    arms.sort_by(|a, b| b.0.0.dot(forward).total_cmp(&a.0.0.dot(forward)));
    for ((axis, name), (r, g, b)) in arms {
        let end = vec2(axis.dot(right), -axis.dot(up)) * 24.0;
        let colour = Color32::from_rgb(r, g, b);
        painter.line_segment([middle, middle + end], Stroke::new(2.0, colour));
        let place = middle + end + end.normalized() * 8.0;
        painter.text(place, Align2::CENTER_CENTER, name, FontId::proportional(12.0), colour);
    }

    let metres_per_point = scale_at_target(camera, view.height());
    let length = round_length(80.0 * metres_per_point);
    let width = length / metres_per_point;
    let end = pos2(view.max.x - EDGE, view.max.y - EDGE - 2.0);
    let begin = end - vec2(width, 0.0);
    let stroke = Stroke::new(1.5, ink);
    painter.line_segment([begin, end], stroke);
    for place in [begin, end] {
        painter.line_segment([place - vec2(0.0, 4.0), place], stroke);
    }
    let text = length_text(length);
    painter.text(
        begin.lerp(end, 0.5) - vec2(0.0, 3.0),
        Align2::CENTER_BOTTOM,
        text,
        FontId::monospace(11.0),
        ink,
    );
}

/// How many metres one of the window's points is, at the distance of what is looked at.
fn scale_at_target(camera: &Turntable, height: f32) -> f32 {
    camera.distance / camera.camera(glam::vec2(1.0, height)).focal
}

/// The largest of 1, 2, 5, 10 … that is not above a length.
fn round_length(length: f32) -> f32 {
    let power = 10.0f32.powf(length.max(1e-30).log10().floor());
    [5.0, 2.0, 1.0]
        .map(|step| step * power)
        .into_iter()
        .find(|&step| step <= length * 1.0001)
        .unwrap_or(power)
}

fn length_text(length: f32) -> String {
    let (value, unit) = match length {
        l if l >= 1e3 => (l / 1e3, "km"),
        l if l >= 1.0 => (l, "m"),
        l if l >= 1e-2 => (l * 1e2, "cm"),
        l if l >= 1e-3 => (l * 1e3, "mm"),
        l => (l * 1e6, "\u{b5}m"),
    };
    format!("{} {unit}", sprung::significant(rounded(value.into(), 2)))
}

/// A colour of the renderer's palette, in the theme of the window.
fn ink(ui: &Ui, colour: impl Fn(&Palette) -> u32) -> Color32 {
    theme::rgb(colour(if ui.visuals().dark_mode { &DARK } else { &LIGHT }))
}

/// The colour of forces: that of their arrows.
pub fn force_ink(ui: &Ui) -> Color32 {
    ink(ui, |palette| palette.force)
}

/// The colour of velocities.
pub fn velocity_ink(ui: &Ui) -> Color32 {
    ink(ui, |palette| palette.velocity)
}

/// What the arrows and the ghost are, above the colour legend at the bottom left.
///
/// Gives the upper edge of what it wrote.
pub fn keys(ui: &Ui, view: Rect, below: f32, state: &AppState) -> f32 {
    let mut lines: Vec<(Color32, String)> = Vec::new();
    let appearance = &state.appearance;
    if appearance.velocity_arrows > 0.0 {
        let length = length_text(appearance.velocity_arrows);
        lines.push((velocity_ink(ui), format!("velocity: {length} for 1 m/s")));
    }
    if appearance.force_arrows > 0.0 {
        let length = length_text(appearance.force_arrows);
        lines.push((force_ink(ui), format!("force: {length} for 1 N")));
    }
    if let Some(ghost) = &state.report.comparison {
        let text = format!("the earlier run: at most {} m apart", steady(ghost.apart));
        lines.push((ink(ui, |palette| palette.ghost.0), text));
    }
    let top =
        below - 21.0 * f32::from(u8::from(!lines.is_empty())) - 18.0 * lines.len().saturating_sub(1) as f32;
    for (index, (colour, text)) in lines.into_iter().rev().enumerate() {
        let y = below - 12.0 - 18.0 * index as f32;
        let begin = pos2(view.min.x + EDGE, y);
        let painter = ui.painter();
        painter.arrow(begin, vec2(20.0, 0.0), Stroke::new(2.0, colour));
        let ink = ui.visuals().text_color();
        painter.text(begin + vec2(28.0, 0.0), Align2::LEFT_CENTER, text, FontId::proportional(12.5), ink);
    }
    top
}

/// The lower left corner of the legend.
pub fn legend_corner(view: Rect) -> Pos2 {
    pos2(view.min.x + EDGE, view.max.y - EDGE)
}

/// What there is room for at the bottom of the view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Room {
    /// The legend of the colours.
    pub legend: bool,
    /// Axes and scale.
    pub axes: bool,
}

/// What fits into a view without covering anything else.
pub fn room(view: Rect) -> Room {
    let is_high = view.height() >= AXES.y + FREE_ABOVE;
    let legend = super::legend::SIZE.x + AXES.x + 2.0 * EDGE + APART;
    Room { legend: is_high && view.width() >= legend, axes: is_high && view.width() >= AXES.x + 2.0 * EDGE }
}

/// Where a note may lie: between legend and axes if it is wide enough there, else above both. Its lower edge, middle and
/// width; `None` if there is no room. `left` is the legend with the keys above it.
fn note_place(view: Rect, left: Option<Rect>) -> Option<(Pos2, f32)> {
    let room = room(view);
    let from = left.map_or(view.min.x + EDGE, |left| left.max.x + APART);
    let to = view.max.x - EDGE - if room.axes { AXES.x } else { 0.0 };
    let [least, most] = NOTE_WIDTHS;
    // Between them it stands in the middle of the view, if it can.
    if to - from >= 0.6 * most {
        let width = most.min(to - from);
        let middle = view.center().x.clamp(from + 0.5 * width, to - 0.5 * width);
        return Some((pos2(middle, view.max.y - EDGE), width));
    }
    let width = most.min(view.width() - 2.0 * EDGE);
    let below = left.map_or(view.max.y - EDGE, |left| left.min.y - APART);
    let below = if room.axes { below.min(view.max.y - EDGE - AXES.y - APART) } else { below };
    (width >= least).then(|| (pos2(view.center().x, below), width))
}

/// Notes at the bottom: what one may wonder about.
///
/// `extent` is the size of the scene, m; `left` is the legend with the keys above it, which no note covers.
pub fn notes(
    ui: &mut Ui,
    view: Rect,
    state: &mut AppState,
    (drawn, extent): (&Drawn, f32),
    left: Option<Rect>,
    notes: &mut Notes,
) {
    let report = state.report.clone();
    let serial = report.opened.serial;
    let sunk = (notes.plane_read != Some(serial)).then(|| sunk(&report, extent)).flatten();
    let covered = drawn.covered_springs();
    notes.place = None;
    let text = match sunk {
        Some(Sunk { depth, stiffness }) => format!(
            "Sunk {} m into the plane, as it should: the plane is a spring too. It pushes every point below it with \
             k_c = {} N for each metre.",
            steady(depth.into()),
            sprung::significant(stiffness.into())
        ),
        None if covered > 0 => format!("{} springs lie in the surface and are not drawn", thousands(covered)),
        None => return,
    };
    let Some((bottom, width)) = note_place(view, left) else { return };
    let galley =
        ui.painter().layout(text, FontId::proportional(12.5), ui.visuals().text_color(), width - 18.0);
    let links = if sunk.is_some() { ui.spacing().interact_size.y + ui.spacing().item_spacing.y } else { 0.0 };
    let size = vec2(width, galley.size().y + links + 12.0);
    let rect = Rect::from_min_size(bottom - vec2(0.5 * width, size.y), size);
    // In a view that low the scene is worth more than the note.
    if rect.min.y < view.center().y {
        return;
    }
    let place = at(ui, rect, Align2::CENTER_TOP, |ui| {
        let shown = plate(ui).show(ui, |ui| {
            ui.vertical(|ui| {
                ui.set_max_width(width - 16.0);
                ui.add(egui::Label::new(galley).selectable(false));
                if sunk.is_none() {
                    return;
                }
                ui.horizontal(|ui| {
                    ui.spacing_mut().item_spacing.x = 16.0;
                    if ui.link("How it works").clicked() && !state.shown.explain {
                        state.act(Action::Explain);
                    }
                    if ui.link("Understood").on_hover_text("Puts this note away").clicked() {
                        notes.plane_read = Some(serial);
                    }
                });
            });
        });
        shown.response.rect
    });
    notes.place = Some(place);
}

/// How deep the deepest point is below a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sunk {
    /// m.
    depth: f32,
    /// The plane's, N/m.
    stiffness: f32,
}

/// How deep the deepest free point is below a plane, if it is worth a word and is what the weight presses it in: not at the
/// beginning of a scene that begins in its plane, not while something falls through, not where nothing is as it should be.
fn sunk(report: &Report, extent: f32) -> Option<Sunk> {
    if matches!(report.trouble, Some(Trouble::BlewUp(_))) || report.now.time < BEGINNING {
        return None;
    }
    let params = &report.params;
    let stride = report.now.positions.len().div_ceil(POINTS_SAMPLED).max(1);
    let free = || {
        let moments = report.now.positions.iter().enumerate().step_by(stride);
        moments.filter(|(point, _)| !params.is_fixed(*point))
    };
    let mass: f32 = free().map(|(point, _)| params.point_mass.get(point).copied().unwrap_or(0.0)).sum();
    let found = params.planes.iter().filter_map(|plane| {
        let depths = || free().map(|(_, &position)| plane.depth(position));
        let depth = depths().fold(0.0, f32::max);
        // Those that share the weight: the others are hardly in.
        let carrying = depths().filter(|&each| depth > 0.0 && each >= 0.5 * depth).count();
        let weight = mass * params.gravity.dot(plane.normal).abs();
        let at_rest = weight / (plane.stiffness * carrying as f32);
        let is_as_it_should = at_rest.is_finite() && depth <= AS_IT_SHOULD * at_rest;
        (depth > DEEP * extent && is_as_it_should).then_some(Sunk { depth, stiffness: plane.stiffness })
    });
    found.max_by(|a, b| a.depth.total_cmp(&b.depth))
}

/// The numbers of points, where there are few.
pub fn labels(ui: &Ui, view: Rect, seen: &super::pick::Seen) {
    if seen.pixels.len() > MOST_LABELS {
        return;
    }
    let ink = ui.visuals().weak_text_color();
    for (point, pixel) in seen.pixels.iter().enumerate().filter(|(_, pixel)| pixel.is_finite()) {
        let place = view.min + vec2(pixel.x + 9.0, pixel.y - 9.0);
        ui.painter().text(place, Align2::LEFT_BOTTOM, point.to_string(), FontId::monospace(11.0), ink);
    }
}

/// The line of a cut that is being drawn.
pub fn cut_line(ui: &Ui, view: Rect, cut: &super::scissors::Cut) {
    let points: Vec<Pos2> = cut.line.iter().map(|place| view.min + vec2(place.x, place.y)).collect();
    let colour = ui.visuals().error_fg_color;
    ui.painter().add(egui::Shape::line(points.clone(), Stroke::new(2.0, colour)));
    if let (Some(last), true) = (points.last(), !cut.springs.is_empty()) {
        let text = cut.springs.len().to_string();
        ui.painter().text(
            *last + vec2(14.0, -14.0),
            Align2::LEFT_BOTTOM,
            text,
            FontId::monospace(13.0),
            colour,
        );
    }
}

/// Where the time of a picture goes, at the top left below the time.
pub fn times(ui: &mut Ui, view: Rect, state: &AppState, timings: Option<sprung_render::gpu::Timings>) {
    let millis = |seconds: f64| format!("{:5.2} ms", 1e3 * seconds);
    let mut text = format!("step   {}", millis(state.report.seconds_per_step));
    if let Some(timings) = timings {
        text += &format!("\nupload {}\ndraw   {}", millis(timings.upload), millis(timings.encode));
    }
    let rect = Rect::from_min_size(view.min + vec2(EDGE, EDGE + 38.0), Vec2::new(200.0, 70.0));
    at(ui, rect, Align2::LEFT_TOP, |ui| {
        let text = RichText::new(text).monospace().size(11.0);
        plate(ui).show(ui, |ui| ui.add(egui::Label::new(text).selectable(false)));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_cover_neither_legend_nor_axes() {
        for width in (120..2000).step_by(7) {
            let view = Rect::from_min_size(pos2(50.0, 20.0), vec2(width as f32, 500.0));
            let corner = legend_corner(view);
            let size = super::super::legend::SIZE;
            let legend = Rect::from_min_size(corner - vec2(0.0, size.y), size);
            let room = room(view);
            let legend = room.legend.then_some(legend);
            let Some((bottom, width)) = note_place(view, legend) else { continue };
            let note = Rect::from_min_size(bottom - vec2(0.5 * width, 80.0), vec2(width, 80.0));
            assert!(view.contains_rect(note), "{note:?} in {view:?}");
            assert!(legend.is_none_or(|legend| !legend.intersects(note)), "{note:?} in {view:?}");
            let axes = Rect::from_min_max(view.max - AXES - vec2(EDGE, EDGE), view.max).shrink(1.0);
            assert!(!room.axes || !axes.intersects(note), "{note:?} in {view:?}");
        }
    }

    #[test]
    fn scales_are_round() {
        let texts = [0.07, 0.5, 3.0, 99.0, 4200.0].map(|length| length_text(round_length(length)));
        assert_eq!(texts, ["5 cm", "50 cm", "2 m", "50 m", "2 km"]);
    }
}
