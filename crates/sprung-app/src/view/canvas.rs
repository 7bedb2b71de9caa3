//! The picture of the scene: drawn by the graphics card into a texture, or plainly by egui where there is none.

use std::sync::Arc;

use eframe::egui_wgpu::{RenderState, wgpu};
use egui::{Color32, Painter, Pos2, Rect, Stroke, TextureId};
use glam::Vec2;
use sprung_driver::Report;
use sprung_render::appearance::{Appearance, Theme};
use sprung_render::camera::Camera;
use sprung_render::gpu::{Marks, Moment, Quality, Reading, Stage, Timings};

use super::drawn::Drawn;
use super::pick::Seen;
use crate::state::AppState;

/// The largest number of springs that the plain picture draws.
const MOST_PLAIN: usize = 20_000;

/// Everything that a picture shows; two that are equal look the same.
#[derive(Clone)]
struct Shown {
    report: Arc<Report>,
    camera: Camera,
    appearance: Appearance,
    marks: Marks,
    size: [u32; 2],
}

impl Shown {
    fn looks_like(&self, other: &Self) -> bool {
        let (a, b) = (&*self.report, &*other.report);
        let same_moment = Arc::ptr_eq(&a.now, &b.now)
            && Arc::ptr_eq(&a.before, &b.before)
            && (a.blend == b.blend || Arc::ptr_eq(&a.now, &a.before));
        let same_forces = match (&a.forces, &b.forces) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        let ghost = |report: &Report| report.comparison.as_ref().map(|ghost| Arc::as_ptr(&ghost.snapshot));
        a.opened.serial == b.opened.serial
            && Arc::ptr_eq(&a.params, &b.params)
            && same_moment
            && same_forces
            && ghost(a) == ghost(b)
            && self.camera == other.camera
            && self.appearance == other.appearance
            && self.marks == other.marks
            && self.size == other.size
    }
}

/// A stage with the model that is on it.
struct Set {
    stage: Stage,
    serial: Option<u64>,
}

impl Set {
    fn new(gpu: &RenderState) -> Self {
        let quality = Quality::for_adapter(&gpu.adapter.get_info());
        Self { stage: Stage::new(&gpu.device, &gpu.queue, quality), serial: None }
    }

    fn draw(&mut self, shown: &Shown) {
        let report = &*shown.report;
        if self.serial != Some(report.opened.serial) {
            self.serial = Some(report.opened.serial);
            self.stage.set_model(&report.opened.model);
        }
        self.stage.set_params(&report.params);
        let moment = Moment {
            before: &report.before.positions,
            now: &report.now.positions,
            blend: report.blend as f32,
            velocities: &report.now.velocities,
            forces: report.forces.as_deref().map_or(&[], |forces| forces),
            ghost: report.comparison.as_ref().map_or(&[], |ghost| &ghost.snapshot.positions),
        };
        self.stage.draw(&moment, &shown.marks, &shown.camera, &shown.appearance, shown.size);
    }
}

/// Draws the scene into the window, and into pictures of other sizes.
pub struct Canvas {
    gpu: Option<RenderState>,
    screen: Option<Set>,
    /// For pictures to save, whose size is not the window's.
    album: Option<Set>,
    texture: Option<(wgpu::Texture, TextureId)>,
    last: Option<Shown>,
}

impl Canvas {
    /// A canvas on egui's own graphics device, if there is one.
    pub fn new(gpu: Option<&RenderState>) -> Self {
        Self { gpu: gpu.cloned(), screen: None, album: None, texture: None, last: None }
    }

    /// Draws the scene into a rectangle of the window, unless it is drawn there already.
    pub fn show(
        &mut self,
        painter: &Painter,
        rect: Rect,
        state: &AppState,
        marks: &Marks,
        plain: (&Drawn, &Seen),
    ) {
        let scale = painter.ctx().pixels_per_point();
        let size = [rect.width(), rect.height()].map(|side| (side * scale).round().max(1.0) as u32);
        let shown = shown(state, marks, size);
        let Some(gpu) = &self.gpu else {
            return draw_plainly(painter, rect, state, plain);
        };
        if self.last.as_ref().is_none_or(|last| !last.looks_like(&shown)) {
            let screen = self.screen.get_or_insert_with(|| Set::new(gpu));
            screen.draw(&shown);
            self.register();
            self.last = Some(shown);
        }
        if let Some((_, texture)) = self.texture {
            let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
            painter.image(texture, rect, whole, Color32::WHITE);
        }
    }

    /// Makes the stage's texture known to egui, and forgets the one before.
    fn register(&mut self) {
        let (Some(gpu), Some(screen)) = (&self.gpu, &self.screen) else { return };
        let Some(texture) = screen.stage.texture() else { return };
        if self.texture.as_ref().is_some_and(|(old, _)| old == texture) {
            return;
        }
        let mut renderer = gpu.renderer.write();
        let view = texture.create_view(&Default::default());
        if let Some((_, id)) = &self.texture {
            renderer.update_egui_texture_from_wgpu_texture(&gpu.device, &view, wgpu::FilterMode::Linear, *id);
            let id = *id;
            self.texture = Some((texture.clone(), id));
        } else {
            let id = renderer.register_native_texture(&gpu.device, &view, wgpu::FilterMode::Linear);
            self.texture = Some((texture.clone(), id));
        }
    }

    /// Whether there is a graphics card to make pictures with.
    pub fn can_make_pictures(&self) -> bool {
        self.gpu.is_some()
    }

    /// A picture of what is seen, in another size, on its way back from the graphics card; `None` without one.
    pub fn picture(&mut self, state: &AppState, marks: &Marks, size: [u32; 2]) -> Option<Reading> {
        let gpu = self.gpu.as_ref()?;
        let album = self.album.get_or_insert_with(|| Set::new(gpu));
        album.draw(&shown(state, marks, size));
        album.stage.begin_to_read()
    }

    /// Gives back what pictures of other sizes took.
    pub fn close_album(&mut self) {
        self.album = None;
    }

    /// How long the last picture took on this side of the card; `None` if it was drawn without one.
    pub fn timings(&self) -> Option<Timings> {
        self.screen.as_ref().map(|screen| screen.stage.timings())
    }
}

fn shown(state: &AppState, marks: &Marks, size: [u32; 2]) -> Shown {
    let camera = state.camera.camera(Vec2::new(size[0] as f32, size[1] as f32));
    let (report, appearance) = (state.report.clone(), state.appearance);
    Shown { report, camera, appearance, marks: marks.clone(), size }
}

/// Points and lines by egui alone, so that the window can be used without a driver.
fn draw_plainly(painter: &Painter, rect: Rect, state: &AppState, (drawn, seen): (&Drawn, &Seen)) {
    let (back, ink) = match state.appearance.theme {
        Theme::Light => (Color32::from_rgb(0xec, 0xf0, 0xf4), Color32::from_rgb(0x4a, 0x58, 0x68)),
        Theme::Dark => (Color32::from_rgb(0x1a, 0x20, 0x28), Color32::from_rgb(0x93, 0x9e, 0xab)),
    };
    painter.rect_filled(rect, 0.0, back);
    let place = |pixel: Vec2| rect.min + egui::vec2(pixel.x, pixel.y);
    let (model, params) = (&state.report.opened.model, &state.report.params);
    for spring in drawn.springs_in_reach().take(MOST_PLAIN) {
        if let Some((a, b)) = seen.ends(model.springs()[spring])
            && !params.spring_cut[spring]
        {
            painter.line_segment([place(a), place(b)], Stroke::new(1.0, ink));
        }
    }
    for (point, pixel) in seen.pixels.iter().enumerate().take(MOST_PLAIN) {
        if pixel.is_finite() {
            let radius = if params.is_fixed(point) { 4.0 } else { 2.5 };
            painter.circle_filled(place(*pixel), radius, ink);
        }
    }
}
