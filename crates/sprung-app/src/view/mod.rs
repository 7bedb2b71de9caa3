//! The scene itself: drawn, turned, grabbed and cut.

mod canvas;
mod drawn;
mod framing;
mod gestures;
mod hand;
mod legend;
mod overlay;
mod pick;
mod pointer;
mod reading;
mod save;
mod scissors;
mod stage_arrows;

use std::sync::Arc;

use glam::{Vec2, Vec3, vec2};
use sprung_driver::Report;
use sprung_render::appearance::{Points, Springs, Surfaces};
use sprung_render::camera::Bounds;
use sprung_render::gpu::Marks;
use sprung_render::turntable::Turntable;

use crate::action::Action;
use crate::panel::pictures;
use crate::state::{AppState, Pick};

use canvas::Canvas;
use drawn::Drawn;
use legend::Legend;
use overlay::Notes;
use pick::Seen;
use pointer::{Eye, Pointer};
use save::Saver;

/// How long a new view is turned to, s.
const GLIDE: f32 = 0.3;
/// Crossed springs that are pointed out while a cut is drawn.
const MOST_MARKED: usize = 2000;

/// The view of the scene.
pub struct View {
    /// Its size in the window's points, once it was shown.
    size: Option<Vec2>,
    canvas: Canvas,
    pointer: Pointer,
    legend: Legend,
    notes: Notes,
    saver: Saver,
    /// What is drawn, and for which scene and choices.
    drawn: (Option<DrawnFor>, Drawn),
    /// Where every point appears, and in which picture.
    seen: (Option<SeenIn>, Seen),
    /// The box that a scene is expected to need.
    motion: Option<(u64, Bounds)>,
    /// A new view is wanted, at once or by gliding there.
    framing: Option<bool>,
    glide: Option<Glide>,
}

type DrawnFor = (u64, Points, Springs, Surfaces);
type SeenIn = (Arc<Report>, Turntable, Vec2);

/// On the way from one view to another.
struct Glide {
    from: Turntable,
    to: Turntable,
    /// What the camera was set to last: if it has changed since, somebody else has taken it.
    last: Turntable,
    share: f32,
}

impl View {
    /// A view that draws with egui's own graphics device, if there is one.
    pub fn new(gpu: Option<&eframe::egui_wgpu::RenderState>) -> Self {
        Self {
            size: None,
            canvas: Canvas::new(gpu),
            pointer: Pointer::default(),
            legend: Legend::default(),
            notes: Notes::default(),
            saver: Saver::default(),
            drawn: (None, Drawn::default()),
            seen: (None, Seen::default()),
            motion: None,
            framing: None,
            glide: None,
        }
    }

    /// Looks at the whole scene, as soon as it is shown: at a new one at once, else by turning there.
    pub fn frame_scene(&mut self, state: &mut AppState) {
        let serial = state.report.opened.serial;
        let is_new = self.motion.is_none_or(|(of, _)| of != serial);
        if is_new {
            self.motion = Some((serial, framing::bounds_of_motion(&state.report.opened)));
        }
        self.framing = Some(is_new || self.framing == Some(true));
    }

    /// Draws the scene and takes what the pointer does there.
    pub fn show(&mut self, ui: &mut egui::Ui, state: &mut AppState) {
        let sense = egui::Sense::click_and_drag();
        let (rect, response) = ui.allocate_exact_size(ui.available_size().max(egui::Vec2::splat(1.0)), sense);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Scene"));
        let size = vec2(rect.width(), rect.height());
        self.size = Some(size);
        let before = state.camera;
        self.turn(ui, state, size);
        let real = ui.input(|input| input.time);
        self.legend.follow(real, state);

        self.look(state, size);
        let eye = Eye {
            corner: rect.min,
            size,
            drawn: &self.drawn.1,
            seen: &self.seen.1,
            covered: self.notes.place(),
        };
        if self.pointer.act(ui, &response, state, &eye) {
            self.frame_scene(state);
            ui.ctx().request_repaint();
        }

        let marks = self.marks(state);
        let painter = ui.painter_at(rect);
        self.canvas.show(&painter, rect, state, &marks, (&self.drawn.1, &self.seen.1));
        if self.saver.go_on(&mut self.canvas, state, &marks, real) {
            ui.ctx().request_repaint();
        }
        self.overlay(ui, rect, state);
        // While the scene is turned, by whatever means, one looks at the scene.
        if state.camera == before {
            self.pointer.tooltip(ui, &response, state);
        }
        response.context_menu(|ui| menu(ui, state));
    }

    /// Saves a picture, or begins or ends a film.
    pub fn save(&mut self, action: Action, state: &mut AppState) {
        let size = self.size.unwrap_or(Vec2::splat(512.0)) * state.pixels_per_point;
        let pixels = size.to_array().map(|side| side.round().max(1.0) as u32);
        let marks = self.marks(state);
        match action {
            Action::Picture => self.saver.picture(&mut self.canvas, state, &marks, pixels),
            _ => self.saver.toggle_film(&mut self.canvas, state, pixels),
        }
    }

    /// Ends whatever goes on with a film, and leaves no half-written file.
    pub fn drop_film(&mut self) {
        self.saver.drop_film();
    }

    /// Sets the camera for a scene that is to be framed, or turns it on its way there.
    fn turn(&mut self, ui: &egui::Ui, state: &mut AppState, size: Vec2) {
        if let Some(at_once) = self.framing.take() {
            let to = self.whole_scene(state, size);
            if at_once {
                (state.camera, self.glide) = (to, None);
            } else {
                self.glide = Some(Glide { from: state.camera, to, last: state.camera, share: 0.0 });
            }
        }
        let Some(mut glide) = self.glide.take().filter(|glide| glide.last == state.camera) else { return };
        glide.share += ui.input(|input| input.stable_dt.min(0.1)) / GLIDE;
        if glide.share >= 1.0 {
            state.camera = glide.to;
            return;
        }
        let eased = glide.share * glide.share * (3.0 - 2.0 * glide.share);
        state.camera = glide.from.between(&glide.to, eased);
        glide.last = state.camera;
        self.glide = Some(glide);
        ui.ctx().request_repaint();
    }

    /// The view of all that is there and is expected to come; of what has run away, the view of where it is now.
    fn whole_scene(&self, state: &AppState, size: Vec2) -> Turntable {
        let now = framing::bounds(&state.report.now.positions);
        let mut bounds = self.motion.map_or(now, |(_, motion)| motion);
        if now.low.is_finite() && now.low.x <= now.high.x {
            bounds.include(now.low);
            bounds.include(now.high);
            let expected = self.motion.map_or(0.0, |(_, motion)| motion.size().length());
            if bounds.size().length() > 20.0 * expected.max(1e-3) {
                bounds = now;
            }
        }
        Turntable::framing_with(&bounds, &state.report.params.planes, size.x / size.y)
    }

    /// Works out what is drawn and where every point appears, unless that is known.
    fn look(&mut self, state: &AppState, size: Vec2) {
        let report = &state.report;
        let look = &state.appearance;
        let drawn_for = (report.opened.serial, look.points, look.springs, look.surfaces);
        if self.drawn.0 != Some(drawn_for) {
            self.drawn = (Some(drawn_for), Drawn::new(&report.opened.model, look));
        }
        let is_known = self.seen.0.as_ref().is_some_and(|(of, camera, of_size)| {
            let same = Arc::ptr_eq(&of.now, &report.now) && Arc::ptr_eq(&of.before, &report.before);
            same && of.blend == report.blend && *camera == state.camera && *of_size == size
        });
        if !is_known {
            let blend = report.blend as f32;
            let (before, now) = (&report.before.positions, &report.now.positions);
            let camera = state.camera.camera(size);
            let is_between = before.len() == now.len();
            let shown =
                |point: usize| if is_between { before[point].lerp(now[point], blend) } else { now[point] };
            let mut seen = Seen::new(&camera, (0..now.len()).map(shown));
            let model = &report.opened.model;
            if model.weighted_count() > 0 && now.len() == model.point_count() {
                let positions: Vec<Vec3> = (0..now.len()).map(shown).collect();
                seen = seen.carrying(&camera, model, &positions);
            }
            self.seen = (Some((report.clone(), state.camera, size)), seen);
        }
    }

    /// What is pointed out in the picture.
    fn marks(&self, state: &AppState) -> Marks {
        let mut marks = Marks::default();
        match state.selection {
            Some(Pick::Point(point)) => marks.selected_points.push(point),
            Some(Pick::Spring(spring)) => marks.selected_springs.push(spring),
            None => {}
        }
        match state.hovered {
            Some(Pick::Point(point)) => marks.hovered_point = Some(point),
            Some(Pick::Spring(spring)) => marks.hovered_spring = Some(spring),
            None => {}
        }
        for pick in &state.pointed_out {
            match *pick {
                Pick::Point(point) => marks.alarming_points.push(point),
                Pick::Spring(spring) => marks.alarming_springs.push(spring),
            }
        }
        if let Some(cut) = self.pointer.cut() {
            marks.alarming_springs.extend(cut.springs.iter().take(MOST_MARKED));
        }
        if let Some((point, hand)) = state.report.pull {
            let (before, now) = (&state.report.before.positions, &state.report.now.positions);
            if let (Some(before), Some(now)) = (before.get(point), now.get(point)) {
                marks.pulls.push((before.lerp(*now, state.report.blend as f32), hand));
            }
        }
        marks
    }

    fn overlay(&mut self, ui: &mut egui::Ui, rect: egui::Rect, state: &mut AppState) {
        let badge = self.saver.badge().or_else(|| state.motion.badge());
        if let Some(cut) = self.pointer.cut() {
            overlay::cut_line(ui, rect, cut);
        }
        if state.shown.presentation {
            return;
        }
        if state.overlays.labels {
            overlay::labels(ui, rect, &self.seen.1);
        }
        let camera = state.camera.camera(vec2(rect.width(), rect.height()));
        stage_arrows::show(ui, rect, state, &camera);
        overlay::status(ui, rect, state, badge.as_deref());
        if state.overlays.times {
            overlay::times(ui, rect, state, self.canvas.timings());
        }
        if let Some(reading) = state.selection.and_then(|pick| reading::Reading::of(&state.report, pick)) {
            overlay::selection(ui, rect, &reading);
        }
        let room = overlay::room(rect);
        if room.axes {
            overlay::axes(ui, rect, &state.camera);
        }
        let corner = overlay::legend_corner(rect);
        let mut left = room.legend.then(|| self.legend.show(ui, corner, state)).flatten();
        let below = left.map_or(corner.y, |legend| legend.min.y);
        let top = overlay::keys(ui, rect, below, state);
        if top < below {
            let written = egui::Rect::from_min_max(egui::pos2(corner.x, top), corner);
            let written =
                egui::Rect::from_min_size(written.min, egui::vec2(legend::SIZE.x, written.height()));
            left = Some(left.map_or(written, |legend| legend.union(written)));
        }
        let extent = self.motion.map_or(1.0, |(_, motion)| motion.grown(0.0).size().max_element());
        overlay::notes(ui, rect, state, (&self.drawn.1, extent), left, &mut self.notes);
    }
}

/// The menu of a click with the right button: what the view alone needs.
fn menu(ui: &mut egui::Ui, state: &mut AppState) {
    for action in [Action::ResetView, Action::Picture, Action::Record, Action::Presentation] {
        let info = action.info();
        if ui.button(info.name).on_hover_text(info.description).clicked() {
            state.act(action);
            ui.close();
        }
    }
    ui.separator();
    ui.menu_button("Pictures and films", |ui| pictures::show(ui, state));
    pictures::overlays(ui, &mut state.overlays);
}
