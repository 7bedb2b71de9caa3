//! Every key and button, and Tab.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use egui_kittest::kittest::Queryable;
use sprung_app::{ACTIONS, Action};

use crate::{Window, button, press, report, state, trace, type_number, walk, window};

#[test]
fn every_action_has_a_name_a_key_and_a_key_of_its_own() {
    let mut keys = Vec::new();
    for info in ACTIONS {
        assert!(!info.name.is_empty() && info.description.ends_with('.'), "{:?}", info.action);
        assert!(!info.keys.is_empty(), "{:?}", info.action);
        for key in info.keys {
            assert!(!keys.contains(key), "{key:?} has two meanings");
            keys.push(*key);
        }
    }
}

#[test]
fn every_key_does_something_and_never_panics() {
    for info in ACTIONS {
        for key in info.keys {
            let mut window = window("chain");
            // In the middle of a recorded run, after an edit that was undone, so that there is something for each to do.
            for _ in 0..3 {
                press(&mut window, Action::Frame);
            }
            type_number(&mut window, "step dt", "0.02");
            press(&mut window, Action::Frame);
            press(&mut window, if info.action == Action::Redo { Action::Undo } else { Action::Back });
            let before = trace(&window);
            window.key_press_modifiers(key.modifiers, key.logical_key);
            window.run_steps(3);
            // Pictures and films belong to the view, files put up a card, and a window that is closed shows nothing.
            let seen_elsewhere = [
                Action::Picture,
                Action::Record,
                Action::Motion,
                Action::Open,
                Action::Save,
                Action::Checkpoint,
                Action::ResetView,
                Action::Quit,
            ];
            if !seen_elsewhere.contains(&info.action) {
                assert_ne!(trace(&window), before, "{:?} by {key:?}", info.action);
            }
        }
    }
}

#[test]
fn the_buttons_of_the_bar_do_what_they_say() {
    let mut window = window("chain");
    button(&mut window, "Step");
    assert_eq!(report(&window).now.step, 1);
    button(&mut window, "Frame");
    assert_eq!(report(&window).now.step, 8);
    button(&mut window, "Play");
    assert!(report(&window).playing);
    button(&mut window, "Pause");
    assert!(!report(&window).playing);
    button(&mut window, "Reset");
    assert_eq!(report(&window).now.step, 0);
    for (name, was) in [("Plots", false), ("How it works", false), ("Panel", true)] {
        let shown = |window: &Window| match name {
            "Plots" => state(window).shown.plots,
            "Panel" => state(window).shown.controls,
            _ => state(window).shown.explain,
        };
        assert_eq!(shown(&window), was);
        button(&mut window, name);
        assert_eq!(shown(&window), !was, "{name}");
    }
}

#[test]
fn each_press_counts_also_of_those_in_one_frame() {
    let mut window = window("jelly");
    let own = report(&window).params.dt;
    for dt in ["0.001", "0.002", "0.003"] {
        type_number(&mut window, "step dt", dt);
    }
    for _ in 0..3 {
        for pressed in [true, false] {
            let (key, modifiers) = (Key::Z, Modifiers::COMMAND);
            window.event(Event::Key { key, physical_key: None, pressed, repeat: false, modifiers });
        }
    }
    window.run_steps(3);
    assert_eq!(report(&window).params.dt, own);
}

#[test]
fn tab_reaches_every_control() {
    let mut window = window("jelly");
    let reached = walk(&mut window);
    for name in [
        "Step",
        "Reset",
        "pace",
        "Scissors",
        "Panel",
        "Plots",
        "How it works",
        "Help",
        "scene cloth",
        "Open…",
        "Save…",
        "Auto sub-steps",
        "step dt",
        "sub-steps",
        "as on",
        "g_y",
        "mass m",
        "stiffness k_s",
        "damping k_d",
        "height y",
        "contact k_c",
        "contact law",
        "Add a plane",
        "To the start",
        "To the end",
        "timeline",
        "Ghost of the earlier run",
    ] {
        assert!(reached.iter().any(|(_, label)| label == name), "{name} is out of reach: {reached:?}");
    }
}

#[test]
fn keys_are_text_while_someone_types_and_work_again_after() {
    let mut window = window("chain");
    let field = window.get_all_by_role_and_label(Role::TextInput, "step dt").next().expect("it is there");
    field.click();
    window.run_steps(2);
    press(&mut window, Action::Step);
    assert_eq!(report(&window).now.step, 0);
    window.key_press(Key::Escape);
    window.run_steps(2);
    press(&mut window, Action::Step);
    assert_eq!(report(&window).now.step, 1);
}
