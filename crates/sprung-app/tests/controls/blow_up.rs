//! Blow-ups and refusals.

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use sprung_app::Pick;
use sprung_driver::{Command, Trouble};

use crate::{Window, button, report, state, type_number, window};

/// A jelly whose step is too long, played until it blows up.
fn blown_up() -> Window {
    let mut window = window("jelly");
    type_number(&mut window, "step dt", "0.0135");
    let app = window.state_mut().state_mut();
    app.send(Command::Play(true));
    for _ in 0..100 {
        app.driver.pass(0.1);
        if app.driver.report().trouble.is_some() {
            break;
        }
    }
    window.run_steps(3);
    assert!(matches!(report(&window).trouble, Some(Trouble::BlewUp(_))));
    window
}

#[test]
fn a_blow_up_is_explained_and_mended() {
    let mut window = blown_up();
    let blow_up = match &report(&window).trouble {
        Some(Trouble::BlewUp(blow_up)) => blow_up.clone(),
        _ => panic!("it blew up"),
    };
    let spring = blow_up.spring.expect("a spring sets the limit");
    assert!(state(&window).pointed_out.contains(&Pick::Spring(spring)));
    assert!(window.query_by_label("It blew up").is_some());
    assert!(window.query_by_label("More sub-steps for the same frame").is_some());
    button(&mut window, "Rewind two seconds and go on");
    assert!(report(&window).trouble.is_none() && report(&window).playing);
    assert!(report(&window).params.dt < 0.0119, "the first fix was chosen");
    assert!(report(&window).now.time < blow_up.good_time);
    assert!(state(&window).pointed_out.is_empty());
}

#[test]
fn enter_presses_the_button_of_the_blow_up_card_that_is_most_likely_wanted() {
    let mut window = blown_up();
    // A field that is being left takes its Enter for itself.
    type_number(&mut window, "g_x", "0");
    assert!(matches!(report(&window).trouble, Some(Trouble::BlewUp(_))));
    window.run_steps(2);
    window.key_press(Key::Enter);
    window.run_steps(3);
    assert!(report(&window).trouble.is_none() && report(&window).playing);
    assert!(report(&window).params.dt < 0.0119, "the first fix was chosen");
}

#[test]
fn the_card_of_a_blow_up_goes_away_once_parameters_are_changed() {
    let mut window = blown_up();
    type_number(&mut window, "step dt", "0.001");
    window.run_steps(2);
    assert!(report(&window).trouble.is_none());
    let mut window = blown_up();
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.run_steps(4);
    assert!(report(&window).params.dt < 0.0135, "it was taken back");
    assert!(window.query_by_label("It blew up").is_none());
    assert!(state(&window).pointed_out.is_empty());
}

#[test]
fn a_refusal_pushes_nothing_aside() {
    let mut window = window("jelly");
    let place = |window: &Window| {
        let mut fields = window.get_all_by_role_and_label(Role::TextInput, "sub-steps");
        fields.next().expect("it is there").rect()
    };
    let before = place(&window);
    type_number(&mut window, "step dt", "-1");
    let sentence = "-1 is not allowed: step dt may be from 1e-9 to 1000 s";
    let bubble = window.get_by_label(sentence).rect();
    assert_eq!(place(&window), before);
    assert!(!bubble.intersects(before), "{bubble:?} covers {before:?}");
}

#[test]
fn the_card_of_a_blow_up_goes_away_with_escape_and_changes_nothing() {
    let mut window = blown_up();
    window.key_press(Key::Escape);
    window.run_steps(3);
    assert!(report(&window).trouble.is_none());
    assert_eq!(report(&window).params.dt, 0.0135);
    assert!(window.query_by_label("It blew up").is_none());
}
