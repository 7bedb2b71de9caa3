//! What the pointer does in the scene: turn, move, pull, cut, choose.

use egui::{CursorIcon, Key, Modifiers, PointerButton, RectAlign, Response, Ui};
use glam::Vec2;
use sprung::Change;
use sprung_driver::{Command, Edit};

use super::drawn::Drawn;
use super::hand::{Hand, Press};
use super::pick::{self, Seen};
use super::scissors::Cut;
use super::{gestures, reading};
use crate::state::{AppState, Pick, Tool};

/// From so far below the view's upper edge on, tooltips find room above the cursor, points.
const ROOM_FOR_TOOLTIP: f32 = 200.0;

/// In a presentation, a cursor that has rested so long points at nothing, s.
const RESTS: f64 = 2.0;

/// The scene as it is seen in this frame.
pub struct Eye<'a> {
    /// The view's upper left corner in the window.
    pub corner: egui::Pos2,
    /// Its size, in the window's points.
    pub size: Vec2,
    /// What is drawn.
    pub drawn: &'a Drawn,
    /// Where every point appears.
    pub seen: &'a Seen,
    /// Where a note lies over the scene, in the window.
    pub covered: Option<egui::Rect>,
}

impl Eye<'_> {
    fn place(&self, position: egui::Pos2) -> Vec2 {
        Vec2::new(position.x - self.corner.x, position.y - self.corner.y)
    }

    /// What the cursor is on, for the tool in hand.
    fn pick(&self, state: &AppState, cursor: Vec2, reach: f32) -> Option<Pick> {
        let (model, cut) = (&state.report.opened.model, &state.report.params.spring_cut);
        match state.tool {
            Tool::Hand => pick::pick(model, cut, self.drawn, self.seen, cursor, reach),
            Tool::Scissors => {
                pick::pick_to_cut(model, cut, self.drawn, self.seen, cursor, reach).map(Pick::Spring)
            }
        }
    }
}

/// What a press began.
#[derive(Default)]
enum Doing {
    #[default]
    Nothing,
    Orbit,
    Pan,
    /// On a point; it may become a pull.
    Press(Press),
    Pull(Hand),
    Cut(Cut),
}

/// What the pointer is doing.
#[derive(Default)]
pub struct Pointer {
    doing: Doing,
    /// The scene that it is done in.
    serial: u64,
    /// Where the pointer was last, from the view's corner.
    cursor: Vec2,
    /// When it moved last, s; `None` before it has.
    moved: Option<f64>,
}

impl Pointer {
    /// Whether a press goes on.
    pub fn is_busy(&self) -> bool {
        !matches!(self.doing, Doing::Nothing)
    }

    /// The cut that is being drawn.
    pub fn cut(&self) -> Option<&Cut> {
        if let Doing::Cut(cut) = &self.doing { Some(cut) } else { None }
    }

    /// Takes what pointer, wheel, fingers and keys did in this frame. True if the whole scene is to be framed.
    pub fn act(&mut self, ui: &mut Ui, response: &Response, state: &mut AppState, eye: &Eye<'_>) -> bool {
        if self.serial != state.report.opened.serial {
            self.serial = state.report.opened.serial;
            self.doing = Doing::Nothing;
        }
        let position = ui.input(|input| input.pointer.interact_pos());
        let mut moved = position.map_or(Vec2::ZERO, |position| {
            let before = std::mem::replace(&mut self.cursor, eye.place(position));
            self.cursor - before
        });
        if moved != Vec2::ZERO {
            self.moved = Some(ui.input(|input| input.time));
        }
        if let Some(pressed) = self.press(ui, response, state, eye) {
            // On the way to the press, nothing was held yet.
            moved = self.cursor - pressed;
        }
        let frame_all = self.click(ui, response, state, eye);
        self.go_on(ui, state, eye, moved);
        self.wheel(ui, response, state, eye);
        self.hover(ui, response, state, eye);
        frame_all
    }

    /// Lets go of whatever a press began, and does not finish it.
    pub fn let_go(&mut self, state: &mut AppState) {
        if let Doing::Pull(_) = std::mem::take(&mut self.doing) {
            state.send(Command::Release);
        }
    }

    /// Takes hold of what a press is on; gives where that was. In a slow window the pointer may have moved on since, in the
    /// same frame.
    fn press(&mut self, ui: &Ui, response: &Response, state: &mut AppState, eye: &Eye<'_>) -> Option<Vec2> {
        if !response.is_pointer_button_down_on() {
            return None;
        }
        let origin = ui.input(|input| input.pointer.press_origin());
        let pressed = origin.map_or(self.cursor, |origin| eye.place(origin));
        let (primary, aside, modifiers, now) = ui.input(|input| {
            let pointer = &input.pointer;
            let aside = pointer.secondary_pressed() || pointer.button_pressed(PointerButton::Middle);
            (pointer.primary_pressed(), aside, input.modifiers, input.time)
        });
        if aside {
            self.let_go(state);
            self.doing = Doing::Pan;
        } else if primary {
            let picked = eye.pick(state, pressed, reach(ui));
            self.doing = match (state.tool, picked) {
                _ if modifiers.alt => Doing::Orbit,
                (Tool::Scissors, _) => Doing::Cut(Cut::begin(pressed)),
                (Tool::Hand, Some(Pick::Point(point))) => {
                    Doing::Press(Press { point, cursor: pressed, since: now })
                }
                _ if modifiers.shift => Doing::Pan,
                _ => Doing::Orbit,
            };
        }
        (primary || aside).then_some(pressed)
    }

    fn go_on(&mut self, ui: &Ui, state: &mut AppState, eye: &Eye<'_>, moved: Vec2) {
        let (two_fingers, is_down, is_focused, escape, hard, now) = ui.input(|input| {
            let fingers = input.multi_touch().is_some();
            let escape = input.key_pressed(Key::Escape);
            (fingers, input.pointer.any_down(), input.focused, escape, input.modifiers.shift, input.time)
        });
        if two_fingers || escape || !is_focused {
            let was_busy = self.is_busy();
            self.let_go(state);
            if escape && !was_busy {
                state.selection = None;
            }
            return;
        }
        if let Doing::Press(press) = self.doing
            && is_down
            && press.is_pull(self.cursor, now)
        {
            let hand = Hand::take(press.point, eye.seen, press.cursor);
            self.doing = hand.map_or(Doing::Nothing, Doing::Pull);
        }
        match &mut self.doing {
            Doing::Nothing | Doing::Press(_) => {}
            Doing::Orbit => state.camera.orbit(moved, eye.size),
            Doing::Pan => state.camera.pan(moved, eye.size),
            Doing::Pull(hand) => {
                // What is fixed gives way to no spring: it is carried.
                let hard = hard || state.report.params.is_anchored(hand.point);
                if let Some(pull) = hand.pull(self.cursor, &state.camera, eye.size, hard) {
                    state.send(Command::Pull(pull));
                }
            }
            Doing::Cut(cut) => {
                let (model, params) = (&state.report.opened.model, &state.report.params);
                cut.go_on(self.cursor, model, &params.spring_cut, eye.drawn, eye.seen);
            }
        }
        if !is_down {
            match std::mem::take(&mut self.doing) {
                Doing::Pull(_) => state.send(Command::Release),
                Doing::Cut(cut) => {
                    if let Some(edit) = cut.edit() {
                        state.edit(edit);
                    }
                }
                _ => {}
            }
        } else if matches!(self.doing, Doing::Press(_)) {
            // A press that lies still becomes a pull after a while.
            ui.ctx().request_repaint_after(web_time::Duration::from_millis(40));
        }
    }

    fn wheel(&mut self, ui: &mut Ui, response: &Response, state: &mut AppState, eye: &Eye<'_>) {
        if ui.input(|input| gestures::fingers(input, &mut state.camera, eye.corner, eye.size)) {
            return;
        }
        let factor = ui.input(gestures::wheel);
        if factor != 1.0 && response.contains_pointer() {
            match &mut self.doing {
                Doing::Pull(hand) => hand.come_nearer(factor),
                _ => state.camera.zoom(factor, self.cursor, eye.size),
            }
        }
        if !ui.ctx().text_edit_focused() {
            ui.input_mut(|input| gestures::keys(input, &mut state.camera, eye.size));
        }
    }

    fn click(&mut self, ui: &Ui, response: &Response, state: &mut AppState, eye: &Eye<'_>) -> bool {
        if !response.clicked() {
            return false;
        }
        let picked = eye.pick(state, self.cursor, reach(ui));
        if state.tool == Tool::Scissors {
            // What a click is on is cut like what a line crosses: when the button is let go of, as one edit.
            if let (Doing::Cut(cut), Some(Pick::Spring(spring))) = (&mut self.doing, picked) {
                cut.click(spring);
            }
            return false;
        }
        if response.double_clicked() {
            return match picked {
                Some(Pick::Point(point)) => {
                    toggle_pin(state, point);
                    false
                }
                Some(Pick::Spring(_)) => false,
                None => true,
            };
        }
        state.selection = picked;
        false
    }

    fn hover(&mut self, ui: &Ui, response: &Response, state: &mut AppState, eye: &Eye<'_>) {
        let place = ui.input(|input| input.pointer.latest_pos());
        let on_note = eye.covered.zip(place).is_some_and(|(note, place)| note.contains(place));
        let rests = state.shown.presentation && self.rests(ui);
        let is_here = response.contains_pointer() && !on_note && !self.is_busy() && !rests;
        let picked = if is_here { eye.pick(state, self.cursor, reach(ui)) } else { None };
        state.hovered = match &self.doing {
            Doing::Press(Press { point, .. }) | Doing::Pull(Hand { point, .. }) => Some(Pick::Point(*point)),
            _ => picked,
        };
        let icon = match (&self.doing, state.tool, state.hovered) {
            (Doing::Press(_) | Doing::Pull(_), ..) => CursorIcon::Grabbing,
            (Doing::Orbit, ..) => CursorIcon::AllScroll,
            (Doing::Pan, ..) => CursorIcon::Move,
            (Doing::Cut(_), ..) | (_, Tool::Scissors, _) => CursorIcon::Crosshair,
            (_, Tool::Hand, Some(Pick::Point(_))) => CursorIcon::Grab,
            (_, Tool::Hand, Some(Pick::Spring(_))) => CursorIcon::PointingHand,
            (_, Tool::Hand, None) => CursorIcon::Default,
        };
        if is_here || self.is_busy() {
            ui.ctx().set_cursor_icon(icon);
        }
    }

    /// Whether the cursor has lain still for a while. If not, the window looks again when it will have.
    fn rests(&self, ui: &Ui) -> bool {
        let Some(moved) = self.moved else { return true };
        let left = RESTS - (ui.input(|input| input.time) - moved);
        if left > 0.0 {
            ui.ctx().request_repaint_after(web_time::Duration::from_secs_f64(left));
        }
        left <= 0.0
    }

    /// The tooltip of what the cursor is on, unless something is being done.
    pub fn tooltip(&self, ui: &Ui, response: &Response, state: &AppState) {
        let is_menu_open = egui::Popup::is_any_open(ui.ctx());
        let Some(hovered) = state.hovered.filter(|_| !self.is_busy() && !is_menu_open) else { return };
        let Some(reading) = reading::Reading::of(&state.report, hovered) else { return };
        let hint = match (state.tool, hovered) {
            (Tool::Hand, Pick::Point(point)) if is_pinned(state, point) => {
                "drag: carry \u{b7} double-click: free"
            }
            (Tool::Hand, Pick::Point(_)) => "drag: pull \u{b7} Shift: carry \u{b7} double-click: pin",
            (Tool::Hand, Pick::Spring(_)) => "click: keep this in view",
            (Tool::Scissors, _) => "click, or drag across springs: cut",
        };
        let tooltip = egui::Tooltip::always_open(
            ui.ctx().clone(),
            response.layer_id,
            response.id.with("reading"),
            egui::PopupAnchor::Pointer,
        );
        // Above the cursor where there is room, so that it covers no note at the bottom.
        let is_low = self.cursor.y > ROOM_FOR_TOOLTIP;
        let mut tooltip = tooltip.gap(16.0);
        tooltip.popup =
            tooltip.popup.align(if is_low { RectAlign::TOP_START } else { RectAlign::BOTTOM_START });
        tooltip.show(|ui| {
            super::overlay::reading_table(ui, &reading, "hovered");
            ui.weak(hint);
        });
    }
}

fn is_pinned(state: &AppState, point: usize) -> bool {
    state.report.params.point_pinned.get(point).copied().unwrap_or(false)
}

/// Pins a point that is free, and frees one that is pinned.
fn toggle_pin(state: &mut AppState, point: usize) {
    let pinned = is_pinned(state, point);
    let label = if pinned { "unpin a point" } else { "pin a point" };
    state.edit(Edit::new(label, vec![Change::Pin(point..point + 1, !pinned)]));
}

/// How far things may be from what points at them: a finger covers more than a cursor.
fn reach(ui: &Ui) -> f32 {
    let touched = ui.input(|input| input.any_touches() && input.modifiers == Modifiers::NONE);
    if touched { pick::TOUCH } else { 1.0 }
}
