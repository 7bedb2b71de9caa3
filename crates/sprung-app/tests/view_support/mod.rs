//! A hand, an eye and a window without a screen.
#![allow(dead_code, reason = "each test file uses some of it")]

use egui::{Event, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::kittest::Queryable;
use egui_kittest::{Harness, HarnessBuilder};
use glam::Vec2;
use sprung::scene::Scene;
use sprung_app::{App, AppState};
use sprung_driver::{Command, Driver, Handle, Source};

/// The window with a built-in scene, paused at its start; a step of the window is a sixtieth of a second.
pub fn window(name: &str) -> Harness<'static, App> {
    window_of(Harness::builder().with_size([1000.0, 700.0]), name)
}

/// The same, with a harness that was begun elsewhere.
pub fn window_of(builder: HarnessBuilder<App>, name: &str) -> Harness<'static, App> {
    let scene = Scene::builtin(name).expect("it is built in");
    let driver = Driver::new(Source { name: name.to_owned(), scene }).expect("it can be built");
    let driver = Handle::inline(driver);
    let mut harness = builder.with_step_dt(1.0 / 60.0).build_eframe(move |context| {
        let mut app = App::new(driver, context);
        app.state_mut().send(Command::Play(false));
        app
    });
    harness.run_steps(3);
    // The scene alone, as large as the window.
    state(&mut harness).shown.controls = false;
    state(&mut harness).hint = false;
    harness.run_steps(2);
    harness
}

/// What the parts of the window share.
pub fn state<'h>(harness: &'h mut Harness<'static, App>) -> &'h mut AppState {
    harness.state_mut().state_mut()
}

/// Plays for so many sixtieths of a second.
pub fn play(harness: &mut Harness<'static, App>, steps: usize) {
    state(harness).send(Command::Play(true));
    harness.run_steps(steps);
    state(harness).send(Command::Play(false));
    harness.run_steps(1);
}

/// The rectangle of the scene in the window.
pub fn view(harness: &Harness<'static, App>) -> egui::Rect {
    harness.get_by_label("Scene").rect()
}

/// Where in the window a point of the model is seen.
pub fn place(harness: &Harness<'static, App>, point: usize) -> Option<Pos2> {
    let rect = view(harness);
    let state = harness.state().state();
    let camera = state.camera.camera(Vec2::new(rect.width(), rect.height()));
    let pixel = camera.project(state.report.now.positions[point])?.pixel;
    Some(rect.min + vec2(pixel.x, pixel.y))
}

/// Moves the pointer there, and waits for the answer.
pub fn hover(harness: &mut Harness<'static, App>, place: Pos2) {
    harness.event(Event::PointerMoved(place));
    harness.run_steps(2);
}

/// Presses or lets go of a button there.
pub fn button(harness: &mut Harness<'static, App>, place: Pos2, button: PointerButton, pressed: bool) {
    harness.event(Event::PointerButton { pos: place, button, pressed, modifiers: Modifiers::NONE });
    harness.step();
}

/// Presses the left button there.
pub fn press(harness: &mut Harness<'static, App>, place: Pos2) {
    hover(harness, place);
    button(harness, place, PointerButton::Primary, true);
}

/// Lets go of the left button.
pub fn release(harness: &mut Harness<'static, App>, place: Pos2) {
    button(harness, place, PointerButton::Primary, false);
    harness.run_steps(1);
}

/// Drags with a button, in four moves.
pub fn drag_by(harness: &mut Harness<'static, App>, with: PointerButton, from: Pos2, to: Pos2) {
    hover(harness, from);
    button(harness, from, with, true);
    for part in 1..=4 {
        hover(harness, from.lerp(to, part as f32 / 4.0));
    }
    button(harness, to, with, false);
    harness.run_steps(1);
}

/// Clicks there, and waits until a further click would be another.
pub fn click(harness: &mut Harness<'static, App>, place: Pos2) {
    press(harness, place);
    release(harness, place);
    harness.run_steps(60);
}

/// Clicks there twice.
pub fn double_click(harness: &mut Harness<'static, App>, place: Pos2) {
    press(harness, place);
    release(harness, place);
    press(harness, place);
    release(harness, place);
    harness.run_steps(60);
}

/// Holds keys like Shift, or none.
pub fn hold(harness: &mut Harness<'static, App>, modifiers: Modifiers) {
    harness.event(Event::ModifiersChanged(modifiers));
    harness.step();
}
