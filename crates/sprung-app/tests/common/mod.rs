//! A window without a screen, on a driver that works when it is told to.
#![allow(dead_code, reason = "each test file uses some of it")]

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use sprung::scene::Scene;
use sprung_app::{App, AppState};
use sprung_driver::{Command, Driver, Handle, Source};

/// Points without a spring.
pub const DUST: &str = "[[body]]\nname = \"dust\"\npoints = [[0, 0, 0], [1, 2, 0]]\npoint_mass = 1.0\n";

/// A window of this size on a scene, paused at its start; each step of the window is a twentieth of a second.
pub fn window(source: Source, size: [f32; 2]) -> Harness<'static, App> {
    let driver = Driver::new(source).expect("the scene can be built");
    let mut harness = Harness::builder()
        .with_size(size)
        .with_step_dt(0.05)
        .build_eframe(move |context| App::new(Handle::inline(driver), context));
    // A first start plays at once.
    harness.state_mut().state_mut().send(Command::Play(false));
    harness.state_mut().state_mut().send(Command::Reset);
    harness.run_steps(2);
    harness
}

/// A built-in scene.
pub fn builtin(name: &str) -> Source {
    Source { name: name.to_owned(), scene: Scene::builtin(name).expect("it is built in") }
}

/// A scene from its text.
pub fn scene(name: &str, text: &str) -> Source {
    Source { name: name.to_owned(), scene: Scene::parse(text, "test.toml").expect("it can be read") }
}

/// What the parts of the window share.
pub fn state<'h>(harness: &'h mut Harness<'static, App>) -> &'h mut AppState {
    harness.state_mut().state_mut()
}

/// Clicks on what is called so, and lets the window answer.
pub fn click(harness: &mut Harness<'static, App>, label: &str) {
    harness.step();
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

/// Plays for so many seconds, and pauses.
pub fn play(harness: &mut Harness<'static, App>, seconds: f64) {
    state(harness).send(Command::Play(true));
    harness.run_steps((seconds / 0.05).ceil() as usize);
    state(harness).send(Command::Play(false));
    harness.run_steps(2);
}
