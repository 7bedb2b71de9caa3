//! Scenes, opened and saved.

use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use sprung::scene::{BUILTIN, Kind, Scene};
use sprung_app::{Action, Pick, SaveRequest, Tool};

use crate::{Window, button, press, report, state, type_number, window};

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

/// A mesh with a vertex twice and one too many, and a face without area: used, and said.
#[test]
fn what_is_odd_about_a_mesh_is_said_once_it_is_open() {
    let folder = tempfile::tempdir().expect("there is a disk");
    let mesh = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 0\nv 9 9 9\nf 1 2 3\nf 5 3 4\nf 1 2 2\n";
    let scene = "[[body]]\nname = \"sail\"\nmesh = \"odd.obj\"\npins = [3]\ncloth = { density = 0.4, stiffness = 150 }\n";
    std::fs::write(folder.path().join("odd.obj"), mesh).expect("it is ours");
    let path = folder.path().join("odd.toml");
    std::fs::write(&path, scene).expect("it is ours");
    let mut window = window("chain");
    open_path(&mut window, &path.display().to_string());
    assert_eq!(report(&window).opened.name, "odd");
    window.get_by_label("It is open, but look at this");
    let said = state(&window).warnings.clone();
    // The sentences of the command.
    assert_eq!(said, report(&window).opened.scene.mesh_warnings());
    assert!(
        said.len() >= 3 && said.iter().all(|sentence| sentence.starts_with("sail (odd.obj): ")),
        "{said:?}"
    );
    for sentence in &said {
        window.get_by_label(&format!("{sentence}."));
    }
    // Enter closes it, and it does not come back.
    window.key_press(Key::Enter);
    window.run_steps(3);
    assert!(window.query_by_label("It is open, but look at this").is_none());
    assert_eq!(report(&window).opened.name, "odd");
    // A scene without any has none.
    button(&mut window, "scene jelly");
    assert!(state(&window).warnings.is_empty());
}
