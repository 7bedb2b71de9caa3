//! The window saves the recorded motion for other programs: what happened, frame by frame, hands and changes and all.

mod common;

use std::path::Path;

use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use sprung::{Change, Vec3};
use sprung_app::{Action, App};
use sprung_driver::{Command, Edit, Report};

use common::{builtin, play, state};

type Window = Harness<'static, App>;

fn window(name: &str) -> Window {
    let mut window = common::window(builtin(name), [1200.0, 900.0]);
    state(&mut window).hint = false;
    window
}

fn report(window: &Window) -> &Report {
    &window.state().state().report
}

/// Asks for the motion and enters a path.
fn save(window: &mut Window, path: &Path) {
    let key = Action::Motion.info().keys[0];
    window.key_press_modifiers(key.modifiers, key.logical_key);
    window.run_steps(3);
    assert!(window.query_by_label("Save the motion").is_some());
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.event(egui::Event::Text(path.display().to_string()));
    window.run_steps(1);
    window.key_press(Key::Enter);
    window.run_steps(3);
}

#[test]
fn the_motion_is_what_happened() {
    let folder = tempfile::tempdir().expect("there is a disk");
    let path = folder.path().join("chain.csv");
    let mut window = window("chain");
    play(&mut window, 0.5);
    let changes = vec![Change::Gravity(Vec3::new(0.0, -3.7, 0.5)), Change::Cut(0..1, true)];
    state(&mut window).edit(Edit::new("two", changes));
    play(&mut window, 0.5);
    let (newest, dt) = (report(&window).timeline.newest, report(&window).params.dt);
    // Somewhere in the middle, where it is to stand again afterwards.
    state(&mut window).send(Command::Seek(newest.0 / 3));
    window.run_steps(2);

    save(&mut window, &path);
    let text = (0..200).find_map(|_| {
        window.run_steps(1);
        std::fs::read_to_string(&path).ok()
    });
    let text = text.expect("it is written");
    window.run_steps(2);
    assert_eq!(report(&window).now.step, newest.0 / 3);

    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let columns: Vec<&str> = lines.next().expect("it has a header").split(',').collect();
    let column = |name: &str| columns.iter().position(|column| *column == name).expect(name);
    let [time_at, point_at] = ["time", "point"].map(column);
    let at = ["x", "y", "z"].map(column);
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let points = report(&window).now.positions.len();
    let frames = (24.0 * newest.1 + 1e-6) as usize + 1;
    assert_eq!(rows.len(), frames * points, "24 frames a second");
    for frame in 0..frames {
        let time: f64 = rows[frame * points][time_at].parse().expect("it is a number");
        assert!((time - frame as f64 / 24.0).abs() <= 0.5 * dt + 1e-9, "frame {frame} is at {time} s");
        let step = (time / dt).round() as u64;
        // As the run is at that step when one goes there.
        state(&mut window).send(Command::Seek(step));
        window.run_steps(1);
        let now = report(&window).now.clone();
        assert_eq!(now.time, time);
        for row in &rows[frame * points..(frame + 1) * points] {
            let point: usize = row[point_at].parse().expect("it is a number");
            let written = at.map(|column| row[column].parse::<f32>().expect("it is a number"));
            assert_eq!(written, now.positions[point].to_array(), "point {point} at step {step}");
        }
    }
}

#[test]
fn no_half_of_a_motion_is_left() {
    let folder = tempfile::tempdir().expect("there is a disk");
    let mut window = window("cloth");
    play(&mut window, 2.0);
    // A name that holds pictures.
    save(&mut window, &folder.path().join("cloth.png"));
    let said = window.state().state().refused.front().map(|refused| refused.error.to_string());
    assert!(said.is_some_and(|said| said.contains("is no name for a motion: its ending can be .csv, ")));
    state(&mut window).refused.clear();
    window.run_steps(2);
    window.key_press(Key::Escape);
    window.run_steps(3);
    // Another scene is opened before the last frame is there.
    save(&mut window, &folder.path().join("cloth.usdc"));
    state(&mut window).open_builtin("spring");
    window.run_steps(10);
    let left = std::fs::read_dir(folder.path()).expect("it is there").count();
    let done = window.state().state().refused.is_empty();
    assert_eq!(left, usize::from(done), "the whole motion, or nothing");
}
