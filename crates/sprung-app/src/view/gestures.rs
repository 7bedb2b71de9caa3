//! The camera's gestures that need no press: the wheel, two fingers and keys.

use egui::{Key, Modifiers};
use glam::{Vec2, vec2};
use sprung_render::turntable::Turntable;

/// How much nearer one comes for each of the window's points that the wheel turns.
const WHEEL: f32 = 0.0022;
/// How far a key turns the camera, in pixels of a drag across a picture 600 high; how much nearer + comes.
const KEY_TURN: f32 = 24.0;
const KEY_ZOOM: f32 = 1.15;

/// The factor by which wheel or fingers bring things nearer in this frame; 1 for none.
pub fn wheel(input: &egui::InputState) -> f32 {
    input.zoom_delta() * (input.smooth_scroll_delta().y * WHEEL).exp()
}

/// Two fingers move the picture and bring it nearer; true if there are two.
pub fn fingers(input: &egui::InputState, camera: &mut Turntable, corner: egui::Pos2, size: Vec2) -> bool {
    let Some(touch) = input.multi_touch() else { return false };
    camera.pan(vec2(touch.translation_delta.x, touch.translation_delta.y), size);
    let between = touch.center_pos - corner;
    camera.zoom(touch.zoom_delta, vec2(between.x, between.y), size);
    true
}

/// Alt with the arrows turns, plus and minus come nearer and go away; true if one was pressed.
pub fn keys(input: &mut egui::InputState, camera: &mut Turntable, size: Vec2) -> bool {
    let before = *camera;
    let turns = [
        (Key::ArrowLeft, vec2(KEY_TURN, 0.0)),
        (Key::ArrowRight, vec2(-KEY_TURN, 0.0)),
        (Key::ArrowUp, vec2(0.0, KEY_TURN)),
        (Key::ArrowDown, vec2(0.0, -KEY_TURN)),
    ];
    for (key, pixels) in turns {
        if input.consume_key(Modifiers::ALT, key) {
            camera.orbit(pixels * size.y / 600.0, size);
        }
    }
    let zooms = [(Key::Plus, KEY_ZOOM), (Key::Equals, KEY_ZOOM), (Key::Minus, 1.0 / KEY_ZOOM)];
    for (key, factor) in zooms {
        if input.consume_key(Modifiers::NONE, key) {
            camera.zoom(factor, 0.5 * size, size);
        }
    }
    *camera != before
}
