//! Looks, sizes of the window, help and hint.

use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use sprung::Vec3;
use sprung_app::{ACTIONS, Action, FilmClock, PictureSize};
use sprung_driver::Command;

use crate::{button, click, press, report, state, type_number, walk, window, window_of};

#[test]
fn a_small_window_keeps_the_timeline_low() {
    for (width, most) in [(500.0, 100.0), (700.0, 100.0), (900.0, 100.0)] {
        let window = window_of("chain", [width, 420.0]);
        let top = window.get_by_label("To the start").rect().top();
        assert!(420.0 - top < most, "{} at {width}", 420.0 - top);
    }
}

#[test]
fn the_help_card_names_every_key_and_gesture() {
    let mut window = window("chain");
    press(&mut window, Action::Help);
    for info in ACTIONS {
        assert!(window.query_all_by_label(info.description).next().is_some(), "{:?}", info.action);
    }
    for (gesture, what) in sprung_app::GESTURES {
        assert!(window.query_by_label(gesture).is_some() && window.query_by_label(what).is_some());
    }
    // Over a card, keys do not reach what is below it.
    press(&mut window, Action::Step);
    assert_eq!(report(&window).now.step, 0);
    press(&mut window, Action::Help);
    assert!(!state(&window).shown.help);
    press(&mut window, Action::Help);
    window.key_press(Key::Escape);
    window.run_steps(3);
    assert!(!state(&window).shown.help);
}

#[test]
fn looks_are_chosen() {
    let mut window = window("cloth");
    click(&mut window, Role::DisclosureTriangle, "Looks");
    for name in ["points", "springs", "surfaces"] {
        click(&mut window, Role::ComboBox, name);
        button(&mut window, "hidden");
    }
    click(&mut window, Role::ComboBox, "colour by");
    button(&mut window, "strain");
    for name in ["Ground", "Shadows"] {
        click(&mut window, Role::CheckBox, name);
    }
    type_number(&mut window, "v arrows", "0.5");
    type_number(&mut window, "full scale", "0.2");
    use sprung_render::appearance::{ColourBy, Points, Springs, Surfaces};
    let look = state(&window).appearance;
    assert_eq!(
        (look.points, look.springs, look.surfaces),
        (Points::Hidden, Springs::Hidden, Surfaces::Hidden)
    );
    assert_eq!((look.colour_by, look.ground, look.shadows), (ColourBy::Strain, false, false));
    assert_eq!((look.velocity_arrows, look.full_scale), (0.5, 0.2));
}

#[test]
fn a_small_window_and_large_text_lose_nothing() {
    // The second: 1400 × 900 with everything twice as large.
    for size in [[800.0, 600.0], [700.0, 450.0]] {
        let mut window = window_of("jelly", size);
        let reached = walk(&mut window);
        for name in ["Help", "step dt", "stiffness k_s", "contact law", "timeline"] {
            assert!(reached.iter().any(|(_, label)| label == name), "{name} at {size:?}");
        }
        // What has the focus has been scrolled into sight.
        let field =
            window.get_all_by_role_and_label(Role::TextInput, "contact k_c").next().expect("it is there");
        field.focus();
        window.run_steps(4);
        let field =
            window.get_all_by_role_and_label(Role::TextInput, "contact k_c").next().expect("it is there");
        let screen = egui::Rect::from_min_size(egui::Pos2::ZERO, size.into());
        assert!(screen.contains_rect(field.rect()), "{:?} in {screen:?}", field.rect());
    }
}

#[test]
fn how_pictures_and_films_are_made_can_be_chosen_in_the_panel() {
    let mut window = window("spring");
    click(&mut window, Role::DisclosureTriangle, "Pictures and films");
    for name in ["1920 × 1080", "50 pictures a second", "as it was seen"] {
        click(&mut window, Role::RadioButton, name);
    }
    let filming = &state(&window).filming;
    assert_eq!((filming.size, filming.rate, filming.clock), (PictureSize::FullHd, 50, FilmClock::Real));
    click(&mut window, Role::DisclosureTriangle, "Looks");
    click(&mut window, Role::CheckBox, "Frame times");
    assert!(state(&window).overlays.times);
}

#[test]
fn the_hint_goes_away_with_the_first_pull() {
    let mut window = window("jelly");
    window.state_mut().state_mut().hint = true;
    window.run_steps(2);
    assert!(window.query_by_label("Pull it!").is_some());
    let pull = sprung_driver::Pull { point: 5, target: Vec3::new(0.0, 5.0, 0.0), hard: false };
    window.state_mut().state_mut().send(Command::Pull(pull));
    window.run_steps(3);
    assert!(!state(&window).hint);
    assert!(window.query_by_label("Pull it!").is_none());
}
