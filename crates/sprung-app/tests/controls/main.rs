//! The window as a person works it: every key and button, numbers that are typed and dragged, cards, scenes.
//!
//! These tests need no graphics driver. The driver of the simulation works inline, so that the same clicks give the same
//! reports.

mod blow_up;
mod keys;
mod looks;
mod numbers;
mod scene_files;
mod surroundings;
mod time;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use sprung::scene::Scene;
use sprung_app::{Action, App, AppState};
use sprung_driver::{Command, Driver, Handle, Report, Source};

type Window = Harness<'static, App>;

fn window_of(name: &str, size: [f32; 2]) -> Window {
    let scene = Scene::builtin(name).expect("it is built in");
    let driver = Driver::new(Source { name: name.to_owned(), scene }).expect("it can be built");
    let mut window = Harness::builder()
        .with_size(size)
        .with_max_steps(8)
        .build_eframe(move |context| App::new(Handle::inline(driver), context));
    window.state_mut().state_mut().hint = false;
    // It begins to play at once; tests begin at the first step.
    window.state_mut().state_mut().send(Command::Play(false));
    window.state_mut().state_mut().send(Command::Reset);
    window.run_steps(3);
    window
}

/// Tall enough that nothing of the panel has to be scrolled to.
fn window(name: &str) -> Window {
    window_of(name, [1400.0, 2200.0])
}

fn state(window: &Window) -> &AppState {
    window.state().state()
}

fn report(window: &Window) -> &Report {
    &state(window).report
}

fn click(window: &mut Window, role: Role, label: &str) {
    window.get_all_by_role_and_label(role, label).next().expect("it is there").click();
    window.run_steps(3);
}

fn button(window: &mut Window, label: &str) {
    click(window, Role::Button, label);
}

fn press(window: &mut Window, action: Action) {
    let key = action.info().keys[0];
    window.key_press_modifiers(key.modifiers, key.logical_key);
    window.run_steps(3);
}

/// Types into a number's field, as the `index`th of that name, and presses Enter.
fn type_number(window: &mut Window, label: &str, text: &str) {
    let field =
        window.get_all_by_role_and_label(Role::TextInput, label).next().expect("there is such a number");
    field.click();
    window.run_steps(3);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.run_steps(1);
    window.event(egui::Event::Text(text.to_owned()));
    window.run_steps(1);
    window.key_press(Key::Enter);
    window.run_steps(3);
}

/// What an action changes, as far as this window shows it.
fn trace(window: &Window) -> String {
    let (state, report) = (state(window), report(window));
    format!(
        "{:?} {} {} {:?} {:?} {:?} {:?} {:?}",
        report.playing,
        report.now.step,
        report.opened.serial,
        state.shown,
        state.tool,
        state.appearance.theme,
        state.camera,
        report.params.dt,
    )
}

/// Every control that Tab reaches, by role and name.
fn walk(window: &mut Window) -> Vec<(Role, String)> {
    let mut reached = Vec::new();
    for _ in 0..200 {
        window.key_press(Key::Tab);
        window.run_steps(2);
        let focused = window.root().children_recursive().find(|node| node.is_focused());
        let Some(node) = focused else { continue };
        let node = node.accesskit_node();
        let found = (node.role(), node.label().unwrap_or_default());
        // The scene itself.
        if found.0 == Role::Unknown {
            continue;
        }
        assert!(!found.1.is_empty(), "a {:?} has no name", found.0);
        if reached.first() == Some(&found) && reached.len() > 20 {
            return reached;
        }
        reached.push(found);
    }
    panic!("Tab never comes round: {reached:?}");
}
