//! Plots: every kind with every scene, traces, the comparison with formulas, and what is saved.

mod common;

use common::{DUST, builtin, click, play, scene, state, window};
use egui::Key;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use sprung::Change;
use sprung::scene::{BUILTIN, Kind};
use sprung_app::plots::PlotKind;
use sprung_app::{App, SaveRequest};
use sprung_driver::{Command, Edit, Probe};

const SIZE: [f32; 2] = [1400.0, 900.0];

#[test]
fn every_plot_shows_with_every_scene_in_every_size_and_theme() {
    let scenes =
        BUILTIN.iter().filter(|scene| scene.kind != Kind::Benchmark).map(|scene| builtin(scene.name));
    for source in scenes.chain([scene("dust", DUST)]) {
        for size in [SIZE, [800.0, 600.0]] {
            let name = source.name.clone();
            let mut window = window(source.clone(), size);
            state(&mut window).shown.plots = true;
            for (kind, label, _) in PlotKind::ALL {
                state(&mut window).plot = kind;
                state(&mut window).act(sprung_app::Action::Theme);
                window.run_steps(2);
                assert!(window.query_by_label(label).is_some(), "{name}: {label} before any sample");
            }
            state(&mut window).send(Command::Frame);
            for (kind, label, _) in PlotKind::ALL {
                state(&mut window).plot = kind;
                window.run_steps(3);
                assert!(window.query_by_label(label).is_some(), "{name}: {label}");
                let has_formula = window.query_by_label_contains("No formula fits").is_none();
                assert_eq!(
                    has_formula || kind != PlotKind::Formula,
                    kind != PlotKind::Formula || ["spring", "chain"].contains(&&*name)
                );
            }
        }
    }
}

#[test]
fn stack_hold_zoom_and_fit_can_be_clicked() {
    let mut window = window(builtin("jelly"), SIZE);
    state(&mut window).shown.plots = true;
    play(&mut window, 0.3);
    for button in ["Stack", "Zoom in", "Zoom out", "Last 10 s", "Fit", "Lines", "kinetic", "Hold"] {
        click(&mut window, button);
    }
    // Held, the plot stays while the simulation goes on.
    let reading =
        |window: &egui_kittest::Harness<'_, sprung_app::App>| window.get_by_label_contains("at t = ").value();
    let before = reading(&window);
    play(&mut window, 0.3);
    assert_eq!(reading(&window), before);
    click(&mut window, "Hold");
    assert_ne!(reading(&window), before);
}

#[test]
fn books_that_are_not_whole_are_said_to_be_so_and_mended() {
    let mut window = window(builtin("chain"), SIZE);
    state(&mut window).shown.plots = true;
    play(&mut window, 0.2);
    assert!(window.query_by_label_contains("books are not whole").is_none());
    state(&mut window).send(Command::KeepLedger(false));
    window.run_steps(2);
    assert!(window.query_by_label_contains("books are not whole").is_some());
    click(&mut window, "Keep them and start again");
    play(&mut window, 0.2);
    assert!(window.query_by_label_contains("books are not whole").is_none());
}

#[test]
fn traces_are_added_recorded_and_removed() {
    let mut window = window(builtin("spring"), SIZE);
    state(&mut window).shown.plots = true;
    click(&mut window, "Traces");
    assert!(window.query_by_label_contains("Choose a point or a spring").is_some());
    click(&mut window, "+ Add to plot");
    assert_eq!(*state(&mut window).report.watched, [Probe::Position(1, 1)]);
    click(&mut window, "Spring");
    click(&mut window, "+ Add to plot");
    assert_eq!(*state(&mut window).report.watched, [Probe::Position(1, 1), Probe::Length(0)]);
    play(&mut window, 0.5);
    let newest = state(&mut window).report.samples.last().expect("it has played").clone();
    assert_eq!(newest.values.len(), 2);

    // A phase plot: against the quantity of the chooser.
    window.get_all_by_label("ℓ of spring 0").next().expect("a choice for the x axis").click();
    window.run_steps(3);
    click(&mut window, "time");
    click(&mut window, "Remove y of point 1");
    click(&mut window, "Remove ℓ of spring 0");
    assert!(state(&mut window).report.watched.is_empty());

    // What another scene does not have goes with the old one.
    click(&mut window, "+ Add to plot");
    state(&mut window).send(Command::Open(Box::new(scene("dust", DUST))));
    window.run_steps(4);
    assert!(state(&mut window).report.watched.is_empty());
}

#[test]
fn the_table_that_is_saved_holds_the_samples() {
    let mut window = window(builtin("spring"), SIZE);
    state(&mut window).shown.plots = true;
    click(&mut window, "Traces");
    click(&mut window, "+ Add to plot");
    play(&mut window, 0.5);
    for (tab, columns) in [("Energy", 11), ("Traces", 3)] {
        click(&mut window, tab);
        let request = saved(&mut window, "Numbers (.csv)");
        assert_eq!(request.name, format!("spring-{}.csv", tab.to_lowercase()));
        let text = String::from_utf8(request.bytes).expect("it is text");
        let report = state(&mut window).report.clone();
        assert_eq!(text.lines().count(), 1 + report.samples.len());
        for (line, sample) in text.lines().skip(1).zip(report.samples.iter()) {
            let cells: Vec<&str> = line.split(',').collect();
            assert_eq!(cells.len(), columns);
            assert_eq!((cells[0].parse(), cells[1].parse()), (Ok(sample.step), Ok(sample.time)));
            let value = if tab == "Energy" {
                Some(sample.energy.total())
            } else {
                sample.values.first().map(|(_, value)| *value)
            };
            assert_eq!(cells[2].parse().ok(), value);
        }
    }
    for (format, begin) in
        [("Picture of lines (.svg)", &b"<svg"[..]), ("Picture of pixels (.png)", b"\x89PNG")]
    {
        for tab in ["Energy", "Traces", "Formula"] {
            click(&mut window, tab);
            let request = saved(&mut window, format);
            assert!(request.bytes.starts_with(begin), "{tab} {format}");
        }
    }
}

/// What a scene is called may hold what no file may be called.
#[test]
fn files_of_plots_have_names_that_every_system_takes() {
    for (name, text) in [("spring", "spring"), ("chain", "chain")] {
        let mut source = builtin(text);
        source.name = format!("a/b: {name}");
        let mut window = window(source, SIZE);
        state(&mut window).shown.plots = true;
        for tab in ["Energy", "Traces", "Formula"] {
            click(&mut window, tab);
            let request = saved(&mut window, "Numbers (.csv)");
            assert!(request.name.starts_with(&format!("a-b--{name}-")), "{tab}: {}", request.name);
        }
    }
}

/// The overlay of the formula lies on the measured motion, and the period is that of the formula.
#[test]
fn pulled_straight_down_the_spring_follows_its_formula() {
    let mut window = window(builtin("spring"), SIZE);
    state(&mut window).shown.plots = true;
    click(&mut window, "Formula");
    play(&mut window, 0.2);
    assert!(window.query_by_label_contains("too large for the formulas").is_some());
    for (button, says, columns) in
        [("Pull straight down and let go", "exact for any size", 2), ("A small swing", "A small motion", 4)]
    {
        click(&mut window, button);
        play(&mut window, 15.0);
        assert!(window.query_by_label_contains(says).is_some(), "{button}");
        // 2π/√(1 − 0.1²) s along the spring, 2π/√(9.81/14.81) s to the side.
        let period = if columns == 2 { "6.31" } else { "7.7" };
        assert!(window.query_by_label_contains(&format!("formula  {period}")).is_some(), "{button}");
        assert!(window.query_by_label_contains(&format!(" 1.      {period}")).is_some(), "{button}");
        let request = saved(&mut window, "Numbers (.csv)");
        let text = String::from_utf8(request.bytes).expect("it is text");
        let (mut off, mut swing) = (0.0_f64, 0.0_f64);
        for line in text.lines().skip(1) {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
            assert_eq!(cells.len(), 1 + columns);
            let (measured, formula) = if columns == 2 { (cells[1], cells[2]) } else { (cells[2], cells[4]) };
            (off, swing) = (off.max((measured - formula).abs()), swing.max(measured.abs()));
        }
        assert!(swing > 0.9 && off < 0.03 * swing, "{button}: {off} of {swing}");
    }
}

#[test]
fn a_chain_at_rest_is_stretched_as_its_formula_says() {
    let mut window = window(builtin("chain"), SIZE);
    state(&mut window).shown.plots = true;
    click(&mut window, "Formula");
    play(&mut window, 0.5);
    assert!(window.query_by_label_contains("It moves").is_some());
    click(&mut window, "Bring to rest");
    window.run_steps(3);
    assert!(window.query_by_label_contains("At rest: the largest difference is").is_some());
}

/// A larger scene gives way to a smaller one in the very frame in which its plot is saved.
#[test]
fn what_is_saved_right_after_a_change_of_scene_is_that_of_the_new_one() {
    for (first, then) in [("chain", "dust"), ("spring", "chain"), ("chain", "spring")] {
        let mut window = window(builtin(first), SIZE);
        state(&mut window).shown.plots = true;
        click(&mut window, "Formula");
        click(&mut window, "Save plot…");
        let next = if then == "dust" { scene("dust", DUST) } else { builtin(then) };
        state(&mut window).send(Command::Open(Box::new(next)));
        window.get_by_label("Numbers (.csv)").click_accesskit();
        window.run_steps(3);
        let requests: Vec<_> =
            state(&mut window).save_requests.drain(..).map(|request| request.name).collect();
        let expected = match then {
            "chain" => vec!["chain-stretch.csv"],
            "spring" => vec!["spring-oscillation.csv"],
            _ => Vec::new(),
        };
        assert_eq!(requests, expected, "{first}, then {then}");
        let is_said = window.query_by_label("There is no curve to save").is_some();
        assert_eq!(is_said, expected.is_empty(), "{first}, then {then}");
    }
}

#[test]
fn what_is_recorded_for_a_formula_is_that_of_the_scene_on_every_tab() {
    let mut window = window(builtin("spring"), SIZE);
    state(&mut window).shown.plots = true;
    click(&mut window, "Formula");
    assert_eq!(state(&mut window).report.watched.len(), 6, "place and velocity of the mass");
    click(&mut window, "Energy");
    assert_eq!(state(&mut window).report.watched.len(), 6);
    state(&mut window).send(Command::Open(Box::new(builtin("cloth"))));
    window.run_steps(4);
    assert!(state(&mut window).report.watched.is_empty(), "{:?}", state(&mut window).report.watched);
    state(&mut window).send(Command::Open(Box::new(builtin("spring"))));
    window.run_steps(4);
    assert_eq!(state(&mut window).report.watched.len(), 6);
}

#[test]
fn a_run_that_explodes_is_plotted_too() {
    let mut window = window(builtin("jelly"), [800.0, 600.0]);
    state(&mut window).shown.plots = true;
    state(&mut window).edit(Edit::new("dt", vec![Change::Dt(0.02)]));
    state(&mut window).send(Command::Watch(vec![Probe::Speed(0)]));
    play(&mut window, 2.0);
    assert!(state(&mut window).report.trouble.is_some());
    for (kind, ..) in PlotKind::ALL {
        state(&mut window).plot = kind;
        window.run_steps(3);
    }
}

/// What is saved in a format; the card that asks for a name is closed again.
fn saved(window: &mut Harness<'static, App>, format: &str) -> SaveRequest {
    click(window, "Save plot…");
    click(window, format);
    let request = state(window).save_requests.pop().expect("something to save");
    window.key_press(Key::Escape);
    window.run_steps(3);
    request
}
