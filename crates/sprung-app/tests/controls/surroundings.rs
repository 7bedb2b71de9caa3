//! Gravity, pins and planes.

use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use sprung::{Change, Plane, Vec3};
use sprung_app::PLANETS;
use sprung_driver::Edit;

use crate::{button, click, report, type_number, window};

#[test]
fn planets_change_gravity() {
    for (name, g) in PLANETS {
        let mut window = window("chain");
        click(&mut window, Role::ComboBox, "as on");
        button(&mut window, &format!("{name}   {g} m/s²"));
        assert_eq!(report(&window).params.gravity, Vec3::new(0.0, -g, 0.0), "{name}");
    }
}

#[test]
fn pins_are_counted_freed_and_put_back() {
    let mut window = window("cloth");
    click(&mut window, Role::DisclosureTriangle, "Pins");
    assert!(window.query_by_label("2 points are pinned.").is_some());
    button(&mut window, "Free all");
    assert!(window.query_by_label("No point is pinned.").is_some());
    assert!(report(&window).params.point_pinned.iter().all(|pinned| !pinned));
    button(&mut window, "Own pins");
    assert_eq!(report(&window).params.point_pinned, report(&window).opened.params.point_pinned);
}

#[test]
fn planes_are_added_removed_and_put_back() {
    let mut window = window("jelly");
    button(&mut window, "Add a plane");
    assert_eq!(report(&window).params.planes.len(), 2);
    button(&mut window, "Remove this plane");
    assert_eq!(report(&window).params.planes.len(), 1);
    button(&mut window, "Own ground");
    assert_eq!(report(&window).params.planes, report(&window).opened.params.planes);
}

#[test]
fn a_tilted_plane_goes_back_to_the_very_normal_it_had() {
    let mut window = window("valley");
    let own = report(&window).params.planes.clone();
    type_number(&mut window, "tilt to x", "12.3");
    type_number(&mut window, "tilt to z", "-7");
    assert_ne!(report(&window).params.planes, own);
    button(&mut window, "own normal");
    assert_eq!(report(&window).params.planes, own);
    assert!(window.query_by_role_and_label(Role::Button, "own normal").is_none());
}

#[test]
fn walls_and_ceilings_are_not_turned_by_stealth() {
    for normal in [Vec3::X, Vec3::NEG_Y, Vec3::new(0.6, -0.8, 0.0)] {
        let mut window = window("jelly");
        let plane = Plane { normal, ..report(&window).params.planes[0] };
        let edit = Edit::new("a wall", vec![Change::Planes(vec![plane])]);
        window.state_mut().state_mut().edit(edit);
        window.run_steps(3);
        window.get_by_label_contains("A wall or a ceiling");
        assert!(window.query_by_role_and_label(Role::TextInput, "tilt to x").is_none(), "{normal}");
        type_number(&mut window, "height y", "-11");
        assert_eq!(report(&window).params.planes[0].normal, normal);
        button(&mut window, "Level it");
        assert_eq!(report(&window).params.planes[0].normal, Vec3::Y);
        type_number(&mut window, "tilt to x", "10");
        assert!(report(&window).params.planes[0].normal.x > 0.17);
    }
}
