//! The window as a person works it: every key and button, numbers that are typed and dragged, cards, scenes.
//!
//! These tests need no graphics driver. The driver of the simulation works inline, so that the same clicks give the same
//! reports.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use sprung::scene::{BUILTIN, Kind, Scene};
use sprung::{Change, Plane, Vec3};
use sprung_app::{ACTIONS, Action, App, AppState, FilmClock, PLANETS, Pick, PictureSize, SaveRequest, Tool};
use sprung_driver::{Command, Driver, Edit, Handle, Report, Source, Trouble};

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
fn every_scene_opens_by_its_button() {
    for builtin in BUILTIN.iter().filter(|builtin| builtin.kind != Kind::Benchmark) {
        let mut window = window("chain");
        button(&mut window, &format!("scene {}", builtin.name));
        assert_eq!(report(&window).opened.name, builtin.name);
        assert!(report(&window).trouble.is_none() && state(&window).refused.is_empty());
        assert!(report(&window).playing);
    }
}

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
fn planets_change_gravity() {
    for (name, g) in PLANETS {
        let mut window = window("chain");
        click(&mut window, Role::ComboBox, "as on");
        button(&mut window, &format!("{name}   {g} m/s²"));
        assert_eq!(report(&window).params.gravity, Vec3::new(0.0, -g, 0.0), "{name}");
    }
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
fn another_scene_begins_with_the_hand_and_nothing_chosen() {
    let mut window = window("jelly");
    press(&mut window, Action::Scissors);
    press(&mut window, Action::NextStage);
    window.state_mut().state_mut().selection = Some(Pick::Point(3));
    window.run_steps(2);
    assert!(state(&window).explain_stage.is_some());
    press(&mut window, Action::Scene(1));
    window.run_steps(4);
    assert_eq!(state(&window).tool, Tool::Hand);
    assert_eq!((state(&window).selection, state(&window).explain_stage), (None, None));
}

#[test]
fn a_small_window_keeps_the_timeline_low() {
    for (width, most) in [(500.0, 100.0), (700.0, 100.0), (900.0, 100.0)] {
        let window = window_of("chain", [width, 420.0]);
        let top = window.get_by_label("To the start").rect().top();
        assert!(420.0 - top < most, "{} at {width}", 420.0 - top);
    }
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

fn open_path(window: &mut Window, path: &str) {
    press(window, Action::Open);
    window.event(egui::Event::Text(path.to_owned()));
    window.run_steps(1);
    window.key_press(Key::Enter);
    window.run_steps(3);
}

#[test]
fn a_bad_file_is_shown_with_its_line() {
    let folder = tempfile::tempdir().expect("there is a disk");
    let path = folder.path().join("bad.toml");
    std::fs::write(&path, "dt = 0.01\n\n[[body]]\nname = \"a\"\npoints = [[0, 0]]\n")
        .expect("it can be written");
    let mut window = window("chain");
    open_path(&mut window, &path.display().to_string());
    let error = state(&window)
        .refused
        .front()
        .map(|refused| refused.error.clone())
        .expect("the point has two coordinates");
    assert_eq!(error.place().line_column.map(|(line, _)| line), Some(5));
    assert!(window.query_by_label("That did not work").is_some());
    assert!(window.query_by_label("   5 points = [[0, 0]]").is_some());
    assert_eq!(report(&window).opened.name, "chain", "what was open stays");
    window.key_press(Key::Escape);
    window.run_steps(3);
    assert!(state(&window).refused.is_empty());
    open_path(&mut window, "/nowhere/at/all.toml");
    assert!(window.query_by_label("There is no such file").is_some());
}

#[test]
fn what_is_saved_opens_with_the_same_parameters() {
    let folder = tempfile::tempdir().expect("there is a disk");
    let path = folder.path().join("mine.toml");
    let mut window = window("jelly");
    type_number(&mut window, "stiffness k_s", "500");
    type_number(&mut window, "g_y", "-1.62");
    type_number(&mut window, "height y", "-11");
    let params = report(&window).params.clone();
    let save = |window: &mut Window| {
        press(window, Action::Save);
        window.key_press_modifiers(Modifiers::COMMAND, Key::A);
        window.event(egui::Event::Text(path.display().to_string()));
        window.run_steps(1);
        window.key_press(Key::Enter);
        window.run_steps(3);
    };
    save(&mut window);
    let text = std::fs::read_to_string(&path).expect("it was written");
    let saved = Scene::parse(&text, "mine.toml").expect("it is a scene");
    assert_eq!(saved.build().expect("it can be built").1, *params);
    // A second time, it asks first.
    type_number(&mut window, "g_y", "-3.7");
    save(&mut window);
    assert_eq!(std::fs::read_to_string(&path).expect("it is there"), text);
    button(&mut window, "Keep it");
    window.key_press(Key::Escape);
    window.run_steps(3);
    save(&mut window);
    button(&mut window, "Replace it");
    assert_ne!(std::fs::read_to_string(&path).expect("it is there"), text);
    open_path(&mut window, &path.display().to_string());
    assert_eq!(report(&window).opened.name, "mine");
    assert_eq!(report(&window).params.gravity.y, -3.7);
}

/// A path that cannot be written costs nothing: neither what was to be saved nor the card.
#[test]
fn what_cannot_be_saved_there_can_be_saved_elsewhere() {
    let folder = tempfile::tempdir().expect("there is a disk");
    let enter = |window: &mut Window, path: &std::path::Path| {
        window.key_press_modifiers(Modifiers::COMMAND, Key::A);
        window.event(egui::Event::Text(path.display().to_string()));
        window.run_steps(1);
        window.key_press(Key::Enter);
        window.run_steps(3);
    };
    let mut window = window("chain");
    let (nowhere, here) = (folder.path().join("none/a.csv"), folder.path().join("a.csv"));
    let request = SaveRequest { name: "a.csv".to_owned(), bytes: b"1,2\n".to_vec() };
    window.state_mut().state_mut().save_requests.push(request);
    window.run_steps(3);
    enter(&mut window, &nowhere);
    assert_eq!(state(&window).refused.len(), 1, "it is said why");
    window.key_press(Key::Escape);
    window.run_steps(3);
    assert_eq!(state(&window).save_requests.len(), 1);
    window.get_by_label("Save the numbers");
    enter(&mut window, &here);
    assert_eq!(std::fs::read(&here).expect("it was written"), b"1,2\n");
    assert!(state(&window).save_requests.is_empty() && window.query_by_label("Save the numbers").is_none());
    // The same with a file that may be replaced, but cannot be: a folder is in its place.
    press(&mut window, Action::Save);
    let in_the_way = folder.path().join("scene.toml");
    std::fs::create_dir(&in_the_way).expect("it is ours");
    enter(&mut window, &in_the_way);
    button(&mut window, "Replace it");
    assert_eq!(state(&window).refused.len(), 1);
    window.key_press(Key::Escape);
    window.run_steps(3);
    window.get_by_label("Save the scene");
    enter(&mut window, &folder.path().join("other.toml"));
    assert!(window.query_by_label("Save the scene").is_none());
    assert!(folder.path().join("other.toml").is_file());
}

#[derive(Debug)]
struct Dropped(std::path::PathBuf, Vec<u8>);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &std::path::Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        Ok(self.1.clone())
    }
}

#[test]
fn a_dropped_file_opens() {
    let mut window = window("chain");
    let text = "[[body]]\nname = \"lone\"\npoints = [[0, 1, 0]]\n";
    let file = Dropped("lone.toml".into(), text.as_bytes().to_vec());
    window.input_mut().dropped_files.push(std::sync::Arc::new(file));
    window.run_steps(3);
    assert_eq!(report(&window).opened.name, "lone");
    window.input_mut().dropped_files.push(std::sync::Arc::new(Dropped("x.toml".into(), vec![0xff])));
    window.run_steps(3);
    assert!(!state(&window).refused.is_empty());
    assert_eq!(report(&window).opened.name, "lone");
}

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
