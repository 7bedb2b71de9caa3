//! The scene in the window, as a hand finds it: turning, pulling, pinning, cutting, choosing. No graphics driver is needed.

mod view_support;

use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton, TouchDeviceId, TouchId, TouchPhase, vec2};
use egui_kittest::kittest::Queryable;
use glam::Vec2;
use sprung::scene::BUILTIN;
use sprung_app::{Pick, Tool};
use sprung_driver::Command;
use view_support::*;

#[test]
fn a_point_that_is_pulled_follows_the_hand() {
    let mut harness = window("chain");
    let start = place(&harness, 14).expect("it is seen");
    press(&mut harness, start);
    let to = start + vec2(-60.0, 40.0);
    hover(&mut harness, to);
    let (point, hand) = state(&mut harness).report.pull.expect("the hand holds something");
    assert_eq!(point, 14);
    let away = |harness: &mut egui_kittest::Harness<'static, sprung_app::App>| {
        (state(harness).report.now.positions[14] - hand).length()
    };
    let before = away(&mut harness);
    play(&mut harness, 90);
    let after = away(&mut harness);
    assert!(after < 0.35 * before, "{before} m became {after} m");
    release(&mut harness, to);
    assert_eq!(state(&mut harness).report.pull, None);
}

#[test]
fn a_press_that_has_moved_on_within_its_frame_pulls_where_it_was_pressed() {
    let mut harness = window("chain");
    let start = place(&harness, 14).expect("it is seen");
    let camera = state(&mut harness).camera;
    hover(&mut harness, start + vec2(-200.0, 60.0));
    let to = start + vec2(90.0, 70.0);
    let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
    harness.event(Event::PointerMoved(start));
    harness.event(Event::PointerButton { pos: start, button, pressed: true, modifiers });
    harness.event(Event::PointerMoved(to));
    harness.run_steps(2);
    assert_eq!(state(&mut harness).report.pull.map(|(point, _)| point), Some(14));
    assert_eq!(state(&mut harness).camera, camera, "the scene stays");
    release(&mut harness, to);
}

#[test]
fn in_a_presentation_a_cursor_at_rest_points_at_nothing() {
    let mut harness = window("spring");
    let point = place(&harness, 1).expect("it is seen");
    harness.key_press(Key::F11);
    harness.run_steps(2);
    let point = place(&harness, 1).unwrap_or(point);
    hover(&mut harness, point);
    assert_eq!(state(&mut harness).hovered, Some(Pick::Point(1)));
    harness.run_steps(130);
    assert_eq!(state(&mut harness).hovered, None);
    hover(&mut harness, point + vec2(1.0, 0.0));
    assert_eq!(state(&mut harness).hovered, Some(Pick::Point(1)));
}

#[test]
fn with_shift_a_point_goes_where_the_hand_is_even_while_time_stands_still() {
    let mut harness = window("jelly");
    let start = place(&harness, 999).expect("it is seen");
    hold(&mut harness, Modifiers::SHIFT);
    press(&mut harness, start);
    let to = start + vec2(70.0, -50.0);
    hover(&mut harness, to);
    harness.run_steps(2);
    let (held, _) = state(&mut harness).report.pull.expect("the hand holds something");
    let found = place(&harness, held).expect("it is seen");
    // As far from the cursor as it was when it was taken.
    assert!((found - to).length() < 13.0, "{found} instead of {to}");
    assert_eq!(state(&mut harness).report.now.step, 0);
    release(&mut harness, to);
    hold(&mut harness, Modifiers::NONE);
}

#[test]
fn what_is_fixed_is_carried() {
    let mut harness = window("spring");
    let start = place(&harness, 0).expect("it is seen");
    press(&mut harness, start);
    let to = start + vec2(50.0, 10.0);
    hover(&mut harness, to);
    harness.run_steps(2);
    release(&mut harness, to);
    let found = place(&harness, 0).expect("it is seen");
    assert!((found - to).length() < 2.0, "{found} instead of {to}");
    assert!(state(&mut harness).report.trouble.is_none());
}

#[test]
fn escape_and_a_lost_focus_let_go() {
    for lose in ["escape", "focus"] {
        let mut harness = window("chain");
        let start = place(&harness, 7).expect("it is seen");
        press(&mut harness, start);
        hover(&mut harness, start + vec2(30.0, 30.0));
        assert!(state(&mut harness).report.pull.is_some());
        if lose == "escape" {
            harness.key_press(Key::Escape);
        } else {
            harness.input_mut().focused = false;
        }
        harness.run_steps(2);
        assert_eq!(state(&mut harness).report.pull, None, "{lose}");
        // Moving on with the button still down takes nothing up again.
        hover(&mut harness, start + vec2(60.0, 60.0));
        assert_eq!(state(&mut harness).report.pull, None, "{lose}");
    }
}

#[test]
fn the_wheel_brings_the_hand_nearer() {
    let mut harness = window("chain");
    let start = place(&harness, 10).expect("it is seen");
    press(&mut harness, start);
    let to = start + vec2(0.0, 20.0);
    hover(&mut harness, to);
    let (camera, (_, first)) =
        (state(&mut harness).camera, state(&mut harness).report.pull.expect("it is held"));
    harness.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        source: egui::MouseWheelSource::Wheel,
        delta: vec2(0.0, 80.0),
        phase: TouchPhase::Move,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(30);
    let (_, nearer) = state(&mut harness).report.pull.expect("it is held");
    assert_eq!(state(&mut harness).camera, camera);
    assert!((nearer - first).dot(camera.axes()[2]) < -0.5, "{first} to {nearer}");
    release(&mut harness, to);
}

#[test]
fn a_double_click_pins_a_point_and_frees_it_again() {
    let mut harness = window("cloth");
    let place = place(&harness, 399).expect("it is seen");
    double_click(&mut harness, place);
    assert!(state(&mut harness).report.params.point_pinned[399]);
    assert_eq!(state(&mut harness).report.undo.as_deref(), Some("pin a point"));
    double_click(&mut harness, place);
    assert!(!state(&mut harness).report.params.point_pinned[399]);
}

#[test]
fn scissors_cut_what_their_line_crosses_and_nothing_else() {
    let mut harness = window("cloth");
    harness.key_press(Key::C);
    harness.run_steps(1);
    assert_eq!(state(&mut harness).tool, Tool::Scissors);
    let rect = view(&harness);
    let [from, to] = [10, 390].map(|point| place(&harness, point).expect("it is seen"));
    let (from, to) = (from + vec2(-31.0, -7.0), to + vec2(23.0, 9.0));

    // Every spring against the whole line, in float64.
    let report = state(&mut harness).report.clone();
    let camera = state(&mut harness).camera.camera(Vec2::new(rect.width(), rect.height()));
    let side = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).signum()
    };
    let (a, b) = ([from.x, from.y].map(f64::from), [to.x, to.y].map(f64::from));
    let expected: Vec<bool> = report
        .opened
        .model
        .springs()
        .iter()
        .map(|ends| {
            let [c, d] = ends.map(|end| {
                let pixel = camera.project(report.now.positions[end as usize]).expect("it is seen").pixel;
                [f64::from(pixel.x + rect.min.x), f64::from(pixel.y + rect.min.y)]
            });
            side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)
        })
        .collect();
    let count = expected.iter().filter(|crossed| **crossed).count();
    assert!(count > 20, "the line should cross the cloth, and crosses {count} springs");

    drag_by(&mut harness, PointerButton::Primary, from, to);
    let report = state(&mut harness).report.clone();
    assert_eq!(*report.params.spring_cut, expected);
    assert_eq!(report.undo, Some(format!("cut {count} springs")));
    state(&mut harness).send(Command::Undo);
    harness.run_steps(1);
    assert!(state(&mut harness).report.params.spring_cut.iter().all(|cut| !cut));
}

#[test]
fn scissors_cut_a_spring_that_is_clicked() {
    let mut harness = window("chain");
    state(&mut harness).tool = Tool::Scissors;
    let ends = [5, 6].map(|point| place(&harness, point).expect("it is seen"));
    click(&mut harness, ends[0].lerp(ends[1], 0.5));
    let cut = &state(&mut harness).report.params.spring_cut;
    assert_eq!(cut.iter().filter(|cut| **cut).count(), 1);
    assert!(cut[5]);
}

#[test]
fn scissors_pass_by_points_and_what_is_chosen() {
    let mut harness = window("jelly");
    state(&mut harness).selection = Some(Pick::Point(3));
    state(&mut harness).tool = Tool::Scissors;
    let corner = place(&harness, 999).expect("it is seen");
    hover(&mut harness, corner);
    assert!(!matches!(state(&mut harness).hovered, Some(Pick::Point(_))));
    click(&mut harness, corner);
    assert_eq!(state(&mut harness).selection, Some(Pick::Point(3)));
    assert_eq!(state(&mut harness).report.params.spring_cut.iter().filter(|cut| **cut).count(), 1);
}

#[test]
fn empty_space_turns_the_scene_other_buttons_move_it_and_the_wheel_comes_nearer() {
    let mut harness = window("spring");
    let rect = view(&harness);
    let empty = rect.left_center() + vec2(120.0, 30.0);
    let start = state(&mut harness).camera;

    drag_by(&mut harness, PointerButton::Primary, empty, empty + vec2(80.0, 40.0));
    let turned = state(&mut harness).camera;
    assert!(turned.azimuth != start.azimuth && turned.elevation > start.elevation);
    assert_eq!((turned.target, turned.distance), (start.target, start.distance));

    for with in [PointerButton::Secondary, PointerButton::Middle] {
        let before = state(&mut harness).camera;
        drag_by(&mut harness, with, empty, empty + vec2(50.0, 0.0));
        let moved = state(&mut harness).camera;
        assert!((moved.target - before.target).length() > 0.1, "{with:?}");
        assert_eq!((moved.azimuth, moved.elevation), (before.azimuth, before.elevation), "{with:?}");
    }

    hover(&mut harness, empty);
    harness.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        source: egui::MouseWheelSource::Wheel,
        delta: vec2(0.0, 100.0),
        phase: TouchPhase::Move,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(30);
    let near = state(&mut harness).camera;
    assert!(near.distance < 0.95 * turned.distance);

    // Both V and a double click on nothing go back.
    harness.key_press(Key::V);
    harness.run_steps(40);
    let whole = state(&mut harness).camera;
    assert!((whole.distance - start.distance).abs() < 1e-3 * start.distance, "{whole:?} {start:?}");
    assert!((whole.azimuth - start.azimuth).abs() < 1e-4);
    drag_by(&mut harness, PointerButton::Primary, empty, empty + vec2(-90.0, 10.0));
    double_click(&mut harness, empty);
    assert!((state(&mut harness).camera.azimuth - start.azimuth).abs() < 1e-4);
}

#[test]
fn keys_turn_the_scene_and_come_nearer() {
    let mut harness = window("spring");
    let start = state(&mut harness).camera;
    harness.key_press_modifiers(Modifiers::ALT, Key::ArrowLeft);
    harness.key_press_modifiers(Modifiers::ALT, Key::ArrowUp);
    harness.run_steps(2);
    let turned = state(&mut harness).camera;
    assert!(turned.azimuth != start.azimuth && turned.elevation != start.elevation);
    harness.key_press(Key::Plus);
    harness.run_steps(2);
    assert!(state(&mut harness).camera.distance < turned.distance);
    harness.key_press(Key::Minus);
    harness.run_steps(2);
    assert!((state(&mut harness).camera.distance - turned.distance).abs() < 1e-3 * turned.distance);
}

#[test]
fn two_fingers_move_the_scene_and_spread_to_come_nearer() {
    let mut harness = window("spring");
    let middle = view(&harness).left_center() + vec2(150.0, 0.0);
    hover(&mut harness, middle);
    let start = state(&mut harness).camera;
    for (finger, phase, at) in [
        (0, TouchPhase::Start, vec2(-30.0, 0.0)),
        (1, TouchPhase::Start, vec2(30.0, 0.0)),
        (0, TouchPhase::Move, vec2(-50.0, 0.0)),
        (1, TouchPhase::Move, vec2(50.0, 0.0)),
        (0, TouchPhase::Move, vec2(-60.0, 0.0)),
        (1, TouchPhase::Move, vec2(60.0, 0.0)),
    ] {
        harness.event(Event::Touch {
            device_id: TouchDeviceId(0),
            id: TouchId(finger),
            phase,
            pos: middle + at,
            force: None,
        });
        harness.step();
    }
    let near = state(&mut harness).camera;
    assert!(near.distance < 0.8 * start.distance, "{} to {}", start.distance, near.distance);
    assert_eq!(near.azimuth, start.azimuth);
}

#[test]
fn what_the_cursor_is_on_tells_its_numbers() {
    let mut harness = window("spring");
    let ends = [0, 1].map(|point| place(&harness, point).expect("it is seen"));
    hover(&mut harness, ends[1]);
    harness.run_steps(3);
    assert_eq!(state(&mut harness).hovered, Some(Pick::Point(1)));
    for text in ["point 1 of", "mass", "1.000 kg", "speed", "5.000 m/s", "force", "9.810 N"] {
        assert!(harness.query_all_by_label_contains(text).next().is_some(), "{text}");
    }
    hover(&mut harness, ends[0].lerp(ends[1], 0.5));
    harness.run_steps(3);
    assert_eq!(state(&mut harness).hovered, Some(Pick::Spring(0)));
    for text in ["spring 0 of", "rest length", "strain", "0.000 %", "tension", "energy", "0.000 J"] {
        assert!(harness.query_all_by_label_contains(text).next().is_some(), "{text}");
    }
}

#[test]
fn a_click_selects_and_escape_does_not_any_more() {
    let mut harness = window("spring");
    let end = place(&harness, 1).expect("it is seen");
    click(&mut harness, end);
    assert_eq!(state(&mut harness).selection, Some(Pick::Point(1)));
    let corner = view(&harness).left_center() + vec2(100.0, 0.0);
    hover(&mut harness, corner);
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("point 1 of").is_some(), "the box of the selection stays");
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert_eq!(state(&mut harness).selection, None);
    assert!(harness.query_by_label_contains("point 1 of").is_none());
    click(&mut harness, end);
    click(&mut harness, corner);
    assert_eq!(state(&mut harness).selection, None);
}

#[test]
fn in_every_scene_what_is_seen_can_be_grabbed() {
    for builtin in BUILTIN {
        let mut harness = window(builtin.name);
        let rect = view(&harness);
        let report = state(&mut harness).report.clone();
        let camera = state(&mut harness).camera.camera(Vec2::new(rect.width(), rect.height()));
        // Of some thousand points the one nearest to the eye, which nothing can hide.
        let positions = &report.now.positions;
        let nearest = (0..positions.len())
            .filter(|&point| !report.params.is_fixed(point))
            .filter_map(|point| Some((point, camera.project(positions[point])?.depth)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(point, _)| point)
            .expect("something is seen");
        let start = place(&harness, nearest).expect("it is seen");
        press(&mut harness, start);
        let to = start + vec2(25.0, 15.0);
        hover(&mut harness, to);
        let (held, hand) = state(&mut harness).report.pull.unwrap_or_else(|| panic!("{}", builtin.name));
        let found = place(&harness, held).expect("it is seen");
        assert!((found - start).length() < 12.5, "{}: {found} instead of {start}", builtin.name);
        assert!(hand.is_finite() && (hand - positions[held]).length() > 0.0, "{}", builtin.name);
        release(&mut harness, to);
    }
}

#[test]
fn every_scene_is_seen_whole_at_its_start() {
    for builtin in BUILTIN {
        let harness = window(builtin.name);
        let rect = view(&harness);
        let count = harness.state().state().report.now.positions.len();
        for point in (0..count).step_by(count.div_ceil(500)) {
            let at = place(&harness, point).expect("it is before the eye");
            assert!(rect.contains(at), "{}: point {point} at {at} of {rect}", builtin.name);
        }
    }
}

#[test]
fn the_colour_scale_can_be_dragged_and_left_to_itself_again() {
    let mut harness = window("jelly");
    play(&mut harness, 120);
    let by_itself = state(&mut harness).appearance.full_scale;
    let bar = harness.get_by_label_contains("Colour scale").rect().center();
    drag_by(&mut harness, PointerButton::Primary, bar, bar + vec2(-60.0, 0.0));
    let by_hand = state(&mut harness).appearance.full_scale;
    assert!(by_hand > 1.5 * by_itself, "{by_itself} to {by_hand}");
    harness.run_steps(3);
    assert_eq!(state(&mut harness).appearance.full_scale, by_hand, "what a hand has set stays");
    let bar = harness.get_by_label_contains("Colour scale").rect().center();
    double_click(&mut harness, bar);
    assert!(state(&mut harness).appearance.full_scale < by_hand);
}

#[test]
fn without_a_driver_a_picture_is_refused_in_one_sentence() {
    let mut harness = window("spring");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::P);
    harness.run_steps(2);
    let refused = state(&mut harness).refused.pop_front().expect("it says so");
    assert_eq!(refused.error.code(), sprung::Code::Unsupported);
    assert!(state(&mut harness).save_requests.is_empty());
}

#[test]
fn what_was_refused_is_read_one_after_the_other() {
    let mut harness = window("spring");
    for sentence in ["is too large", "is too small", "is too small"] {
        state(&mut harness).refuse(sprung::Error::new(sprung::Code::TooLarge, sentence));
    }
    for sentence in ["too large", "too small"] {
        harness.run_steps(2);
        assert!(harness.query_by_label_contains(sentence).is_some(), "{sentence}");
        harness.key_press(Key::Escape);
        harness.run_steps(2);
    }
    assert!(state(&mut harness).refused.is_empty(), "what was said twice is read once");
}

#[test]
fn a_presentation_shows_nothing_but_the_scene_which_can_still_be_grabbed() {
    let mut harness = window("chain");
    assert!(harness.query_by_label("paused").is_some());
    harness.key_press(Key::F11);
    harness.run_steps(2);
    assert!(harness.query_by_label("paused").is_none());
    assert!(harness.query_by_label_contains("Colour scale").is_none());
    let start = place(&harness, 9).expect("it is seen");
    press(&mut harness, start);
    hover(&mut harness, start + vec2(20.0, 20.0));
    assert_eq!(state(&mut harness).report.pull.map(|(point, _)| point), Some(9));
}

#[test]
fn a_blow_up_points_out_what_set_the_limit_and_stops() {
    let mut harness = window("jelly");
    let change = vec![sprung::Change::Dt(0.02)];
    state(&mut harness).edit(sprung_driver::Edit::new("dt", change));
    play(&mut harness, 300);
    let report = state(&mut harness).report.clone();
    let Some(sprung_driver::Trouble::BlewUp(blow_up)) = &report.trouble else { panic!("0.02 s is too long") };
    assert!(!blow_up.points.is_empty() && !report.playing);
    // The last good state is shown, and can be looked at from all sides.
    assert!(report.now.positions.iter().all(|position| position.is_finite()));
    harness.key_press(Key::V);
    harness.run_steps(40);
    assert!(state(&mut harness).camera.distance.is_finite());
}

#[test]
fn a_jelly_in_its_plane_explains_itself_until_it_is_understood() {
    let mut harness = window("jelly");
    play(&mut harness, 240);
    assert!(harness.query_by_label_contains("the plane is a spring too").is_some());
    // Nothing that lies under it is pointed at through it.
    let note = harness.get_by_label_contains("the plane is a spring too").rect();
    for x in 0..20 {
        hover(&mut harness, note.lerp_inside(vec2(x as f32 / 20.0, 0.5)));
        assert_eq!(state(&mut harness).hovered, None);
    }
    harness.get_by_label("Understood").click();
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("the plane is a spring too").is_none());
}

#[test]
fn what_begins_in_its_plane_or_falls_through_is_not_as_it_should() {
    let mut harness = window("jelly");
    // Far below a plane that was just put there.
    let mut planes = state(&mut harness).report.params.planes.clone();
    planes[0].point.y += 40.0;
    let change = vec![sprung::Change::Planes(planes)];
    state(&mut harness).edit(sprung_driver::Edit::new("plane", change));
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("as it should").is_none());
    play(&mut harness, 20);
    assert!(harness.query_by_label_contains("as it should").is_none());
}
