//! The timeline and the ghost.

use egui::accesskit::Role;
use egui::{Key, vec2};
use egui_kittest::kittest::Queryable;
use sprung_app::Action;

use crate::{click, press, report, type_number, window};

#[test]
fn the_timeline_goes_back_and_forth() {
    let mut window = window("chain");
    for _ in 0..10 {
        press(&mut window, Action::Frame);
    }
    assert_eq!(report(&window).now.step, 70);
    press(&mut window, Action::Back);
    assert_eq!(report(&window).now.step, 63);
    press(&mut window, Action::Start);
    assert_eq!(report(&window).now.step, 0);
    press(&mut window, Action::Forward);
    assert_eq!(report(&window).now.step, 7);
    press(&mut window, Action::End);
    assert_eq!(report(&window).now.step, 70);
    let strip = window.get_by_role_and_label(Role::Slider, "timeline").rect();
    window.drag_at(strip.center());
    window.run_steps(2);
    assert_eq!(report(&window).now.step, 35);
    window.hover_at(strip.left_center() - vec2(50.0, 0.0));
    window.run_steps(2);
    assert_eq!(report(&window).now.step, 0);
    window.drop_at(strip.left_center());
    window.run_steps(2);
    window.get_by_role_and_label(Role::Slider, "timeline").focus();
    window.run_steps(2);
    window.key_press(Key::End);
    window.run_steps(3);
    assert_eq!(report(&window).now.step, 70);
}

#[test]
fn the_ghost_of_an_earlier_run_is_compared_with() {
    let mut window = window("chain");
    for _ in 0..5 {
        press(&mut window, Action::Frame);
    }
    press(&mut window, Action::Start);
    click(&mut window, Role::CheckBox, "Ghost of the earlier run");
    type_number(&mut window, "g_y", "-20");
    for _ in 0..3 {
        press(&mut window, Action::Frame);
    }
    let comparison = report(&window).comparison.clone().expect("there is an earlier run");
    assert!(comparison.apart > 0.0);
    click(&mut window, Role::CheckBox, "Ghost of the earlier run");
    assert!(report(&window).comparison.is_none());
}
