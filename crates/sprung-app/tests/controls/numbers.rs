//! Parameters that are typed and dragged, and the meter.

use egui::accesskit::Role;
use egui::vec2;
use egui_kittest::kittest::Queryable;
use sprung_app::{Action, Pick};

use crate::{button, click, press, report, state, type_number, window};

#[test]
fn a_typed_number_counts_at_once_and_can_be_undone() {
    let mut window = window("chain");
    press(&mut window, Action::Frame);
    let (step, dt) = (report(&window).now.step, report(&window).params.dt);
    type_number(&mut window, "step dt", "0.004");
    assert_eq!(report(&window).params.dt, 0.004);
    assert_eq!(report(&window).now.step, step, "no restart");
    assert_eq!(report(&window).undo.as_deref(), Some("dt"));
    press(&mut window, Action::Undo);
    assert_eq!(report(&window).params.dt, dt);
    press(&mut window, Action::Redo);
    assert_eq!(report(&window).params.dt, 0.004);
    button(&mut window, "own step dt");
    assert_eq!(report(&window).params.dt, dt);
    assert!(window.query_by_label("own step dt").is_none());
}

#[test]
fn a_number_that_is_not_allowed_is_refused_with_a_sentence_and_not_clamped() {
    let names = [
        ("step dt", "-1", "-1 is not allowed: step dt may be from 1e-9 to 1000 s"),
        ("step dt", "soon", "“soon” is not a number, such as 0.5 or 2e-3"),
        ("sub-steps", "2.5", "sub-steps must be a whole number, not 2.5"),
        ("sub-steps", "0", "0 is not allowed: sub-steps may be from 1 to 1000000 /frame"),
        ("mass m", "0", "0 is not allowed: mass m may be from 1e-12 to 1e12 kg"),
        ("stiffness k_s", "-3", "-3 is not allowed: stiffness k_s may be from 0 to 1e12 N/m"),
        ("damping k_d", "1e13", "1e13 is not allowed: damping k_d may be from 0 to 1e12 N·s/m"),
        ("g_y", "inf", "inf is not allowed: g_y may be from -1e9 to 1e9 m/s²"),
        ("contact k_c", "-1", "-1 is not allowed: contact k_c may be from 0 to 1e12 N/m"),
        ("tilt to x", "90", "90 is not allowed: tilt to x may be from -85 to 85 °"),
    ];
    let mut window = window("jelly");
    let before = report(&window).params.clone();
    for (name, text, sentence) in names {
        type_number(&mut window, name, text);
        assert!(window.query_by_label(sentence).is_some(), "{name}: {sentence}");
        assert_eq!(*report(&window).params, *before, "{name}");
    }
    // A number that is allowed takes the sentence away.
    type_number(&mut window, "step dt", "0.005");
    assert!(window.query_by_label("-1 is not allowed: step dt may be from 1e-9 to 1000 s").is_none());
    assert_eq!(report(&window).params.dt, 0.005);
}

#[test]
fn every_parameter_can_be_typed() {
    let mut window = window("jelly");
    for (name, text, value) in [
        ("step dt", "0.002 s", 0.002),
        ("sub-steps", "5", 5.0),
        ("g_x", "1.5", 1.5),
        ("g_y", "-1.5", -1.5),
        ("g_z", "0.25", 0.25),
        ("mass m", "2", 2.0),
        ("stiffness k_s", "500", 500.0),
        ("damping k_d", "5", 5.0),
        ("rest length L", "0.5", 0.5),
        ("height y", "-12", -12.0),
        ("contact k_c", "60", 60.0),
        ("contact k_c,d", "6", 6.0),
    ] {
        type_number(&mut window, name, text);
        let params = &report(&window).params;
        let plane = &params.planes[0];
        let found = match name {
            "step dt" => params.dt,
            "sub-steps" => f64::from(params.substeps),
            "g_x" => f64::from(params.gravity.x),
            "g_y" => f64::from(params.gravity.y),
            "g_z" => f64::from(params.gravity.z),
            "mass m" => f64::from(params.point_mass[999]),
            "stiffness k_s" => f64::from(params.spring_stiffness[7559]),
            "damping k_d" => f64::from(params.spring_damping[0]),
            "rest length L" => {
                let built = report(&window).opened.model.spring_rest_length();
                f64::from(params.spring_rest_length[17] / built[17])
            }
            "height y" => f64::from(plane.point.y),
            "contact k_c" => f64::from(plane.stiffness),
            _ => f64::from(plane.damping),
        };
        assert_eq!(found, value, "{name}");
    }
    type_number(&mut window, "tilt to x", "10");
    let normal = report(&window).params.planes[0].normal;
    assert!((normal.x.atan2(normal.y).to_degrees() - 10.0).abs() < 1e-3, "{normal}");
}

#[test]
fn a_drag_of_a_slider_is_one_edit() {
    let mut window = window("chain");
    let own = report(&window).params.dt;
    let slider = window.get_by_role_and_label(Role::Slider, "step dt").rect();
    window.drag_at(slider.center());
    window.run_steps(2);
    let mut seen = Vec::new();
    for offset in [5.0, 10.0, 20.0, 30.0] {
        window.hover_at(slider.center() + vec2(offset, 0.0));
        window.run_steps(2);
        seen.push(report(&window).params.dt);
    }
    window.drop_at(slider.center() + vec2(30.0, 0.0));
    window.run_steps(2);
    assert!(seen.windows(2).all(|pair| pair[0] < pair[1]), "{seen:?}");
    press(&mut window, Action::Undo);
    assert_eq!(report(&window).params.dt, own, "one undo takes the whole drag back");
    assert!(report(&window).undo.is_none());
}

#[test]
fn each_body_of_a_pile_has_its_own_numbers() {
    let mut window = window("pile");
    let groups = report(&window).opened.model.bodies().to_vec();
    let fields = window.get_all_by_role_and_label(Role::TextInput, "stiffness k_s").count();
    assert_eq!(fields, 5, "three bodies and two joints");
    type_number(&mut window, "stiffness k_s", "650");
    let params = &report(&window).params;
    assert!(params.spring_stiffness[groups[0].springs.clone()].iter().all(|&k| k == 650.0));
    assert_eq!(params.spring_stiffness[groups[1].springs.start], 1000.0);
}

#[test]
fn values_that_vary_take_a_factor() {
    let mut window = window("chain");
    let state = window.state_mut().state_mut();
    state.edit(sprung_driver::Edit::new("one spring", vec![sprung::Change::Stiffness(3..4, 50.0)]));
    window.run_steps(3);
    assert!(window.query_by_label("stiffness k_s from 50 to 200 N/m").is_some());
    type_number(&mut window, "× stiffness k_s", "2");
    let stiffness = report(&window).params.spring_stiffness.clone();
    assert_eq!((stiffness[3], stiffness[4]), (100.0, 400.0));
    type_number(&mut window, "× stiffness k_s", "1e12");
    assert_eq!(report(&window).params.spring_stiffness, stiffness, "out of range for the stiffest");
}

#[test]
fn the_meter_points_out_what_sets_the_limit() {
    let mut window = window("spring");
    let setter = format!("Set by {}", report(&window).opened.model.spring_name(0));
    button(&mut window, &setter);
    assert_eq!(state(&window).pointed_out, [Pick::Spring(0)]);
    assert_eq!(state(&window).selection, Some(Pick::Spring(0)));
    button(&mut window, &setter);
    assert!(state(&window).pointed_out.is_empty());
    click(&mut window, Role::CheckBox, "Auto sub-steps");
    assert!(report(&window).auto_substeps);
}
