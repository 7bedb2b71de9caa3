//! The window saves the running simulation and goes on with it: by card, by drop, and not with a file that is damaged.

mod common;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use sprung::{Change, Error, Snapshot, Vec3};
use sprung_app::{Action, App};
use sprung_driver::{Command, Edit, Report, Trouble};
use sprung_io::checkpoint::{Keeper, Stored};

use common::{builtin, click, play, state};

type Window = Harness<'static, App>;

fn window(name: &str) -> Window {
    let mut window = common::window(builtin(name), [1200.0, 900.0]);
    state(&mut window).hint = false;
    window
}

fn report(window: &Window) -> &Report {
    &window.state().state().report
}

fn press(window: &mut Window, action: Action) {
    let key = action.info().keys[0];
    window.key_press_modifiers(key.modifiers, key.logical_key);
    window.run_steps(3);
}

/// Types a path into the card that is up, and presses Enter.
fn enter(window: &mut Window, path: &Path) {
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.event(egui::Event::Text(path.display().to_string()));
    window.run_steps(1);
    window.key_press(Key::Enter);
    window.run_steps(3);
}

fn choose(window: &mut Window, label: &str) {
    window.get_by_role_and_label(Role::RadioButton, label).click();
    window.run_steps(3);
}

/// In the middle of playing, with a parameter changed and a spring cut.
fn under_way(name: &str) -> Window {
    let mut window = window(name);
    play(&mut window, 0.5);
    let changes = vec![Change::Gravity(Vec3::new(0.0, -3.7, 0.5)), Change::Cut(0..1, true)];
    state(&mut window).edit(Edit::new("two", changes));
    state(&mut window).send(Command::Play(true));
    window.run_steps(10);
    window
}

/// The moment that the card keeps, saved there.
fn save(window: &mut Window, path: &Path) -> Arc<Snapshot> {
    press(window, Action::Checkpoint);
    let step = report(window).checkpoint.as_ref().expect("it is kept").state.step;
    enter(window, path);
    assert!(window.query_by_label("Save a checkpoint").is_none() && report(window).checkpoint.is_none());
    // Playing has gone on meanwhile.
    state(window).send(Command::Seek(step));
    window.run_steps(2);
    report(window).now.clone()
}

fn frames(window: &mut Window, count: usize) -> Arc<Snapshot> {
    (0..count).for_each(|_| state(window).send(Command::Frame));
    window.run_steps(2);
    report(window).now.clone()
}

fn file(folder: &tempfile::TempDir, name: &str) -> PathBuf {
    folder.path().join(name)
}

/// A checkpoint with a byte flipped in its middle, and what is said of it.
fn damaged(path: &Path, of: &Path) -> Error {
    let mut bytes = std::fs::read(of).expect("it was saved");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(path, bytes).expect("it is ours");
    Stored::open(path).expect("it is there").read(&|_, _| Ok(())).expect_err("a byte is flipped")
}

fn refused(window: &Window) -> Option<Error> {
    match &report(window).trouble {
        Some(Trouble::Refused(error)) => Some(error.clone()),
        _ => None,
    }
}

#[derive(Debug)]
struct Dropped(PathBuf, Vec<u8>);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        Ok(self.1.clone())
    }
}

fn drop_file(window: &mut Window, path: PathBuf, bytes: Vec<u8>) {
    window.input_mut().dropped_files.push(Arc::new(Dropped(path, bytes)));
    window.run_steps(3);
}

#[test]
fn a_simulation_that_was_saved_goes_on_as_if_it_had_not_been_left() {
    let folder = tempfile::tempdir().expect("there is a disk");
    let path = file(&folder, "mine.sprung");
    let mut here = under_way("jelly");
    let moment = save(&mut here, &path);
    let on = frames(&mut here, 20);
    let mut there = window("chain");
    press(&mut there, Action::Open);
    enter(&mut there, &path);
    state(&mut there).send(Command::Play(false));
    let begun = report(&there).timeline.first;
    assert_eq!((begun, &*report(&there).opened.name), ((moment.step, moment.time), "jelly"));
    state(&mut there).send(Command::Seek(moment.step));
    there.run_steps(2);
    assert_eq!(report(&there).now, moment);
    assert_eq!(frames(&mut there, 20), on);
    assert_eq!(report(&there).params, report(&here).params);
    // The card to save the scene does not suggest to write over the checkpoint.
    press(&mut there, Action::Save);
    assert!(there.get_all_by_value(&file(&folder, "mine.toml").display().to_string()).count() > 0);
}

#[test]
fn a_damaged_checkpoint_is_refused_by_the_sentence_of_the_command() {
    let folder = tempfile::tempdir().expect("there is a disk");
    let (good, bad) = (file(&folder, "good.sprung"), file(&folder, "bad.sprung"));
    save(&mut under_way("chain"), &good);
    let expected = damaged(&bad, &good);
    let mut window = window("jelly");
    press(&mut window, Action::Open);
    enter(&mut window, &bad);
    assert_eq!(refused(&window), Some(expected.clone()));
    window.get_by_label("That did not work");
    window.get_by_label(&format!("bad.sprung {}", expected.sentence()));
    assert_eq!(report(&window).opened.name, "jelly", "what was open stays");
    window.key_press(Key::Escape);
    window.run_steps(3);
    assert_eq!(refused(&window), None);
    press(&mut window, Action::Open);
    enter(&mut window, &file(&folder, "none.sprung"));
    window.get_by_label("There is no such file");
}

#[test]
fn a_checkpoint_that_is_dropped_is_gone_on_with() {
    let folder = tempfile::tempdir().expect("there is a disk");
    let (good, bad) = (file(&folder, "good.sprung"), file(&folder, "bad.sprung"));
    let moment = save(&mut under_way("chain"), &good);
    let bytes = std::fs::read(&good).expect("it was saved");
    // With a path, as on the desktop, and without one.
    for path in [good.clone(), PathBuf::from("good.sprung")] {
        let mut window = window("jelly");
        drop_file(&mut window, path, bytes.clone());
        assert_eq!(report(&window).timeline.first, (moment.step, moment.time));
    }
    let mut window = window("jelly");
    let expected = damaged(&bad, &good);
    drop_file(&mut window, bad, Vec::new());
    assert_eq!(refused(&window), Some(expected));
    drop_file(&mut window, "cut.sprung".into(), bytes[..bytes.len() / 2].to_vec());
    let error = refused(&window).expect("half of it is missing");
    assert_eq!(error.place().file.as_deref(), Some("cut.sprung"));
    assert_eq!(report(&window).opened.name, "jelly");
}

#[test]
fn the_card_chooses_what_is_saved() {
    let mut window = under_way("chain");
    press(&mut window, Action::Save);
    assert!(window.get_all_by_value("my-chain.toml").count() > 0);
    choose(&mut window, "Checkpoint");
    assert!(window.get_all_by_value("my-chain.sprung").count() > 0);
    assert!(report(&window).checkpoint.is_some());
    choose(&mut window, "Scene");
    assert!(window.get_all_by_value("my-chain.toml").count() > 0);
    assert!(report(&window).checkpoint.is_none());
    choose(&mut window, "Checkpoint");
    // Closed without: nothing is kept.
    window.key_press(Key::Escape);
    window.run_steps(3);
    assert!(report(&window).checkpoint.is_none());
}

#[test]
fn a_checkpoint_is_saved_only_where_it_does_no_harm() {
    let folder = tempfile::tempdir().expect("there is a disk");
    let (path, taken) = (file(&folder, "a.sprung"), file(&folder, "taken.sprung"));
    let mut here = under_way("chain");
    save(&mut here, &path);
    let saved = Stored::open(&path).and_then(|stored| stored.read(&|_, _| Ok(()))).expect("it is whole");
    let before = std::fs::read(&path).expect("it is there");
    // It asks first.
    press(&mut here, Action::Checkpoint);
    enter(&mut here, &path);
    click(&mut here, "Keep it");
    assert_eq!(std::fs::read(&path).expect("it is there"), before);
    // A run in the command is still going, and this is its checkpoint.
    let mut keeper = Keeper::begin(&taken).expect("nobody has it");
    keeper.write(&saved).expect("there is room");
    enter(&mut here, &taken);
    click(&mut here, "Replace it");
    let error = state(&mut here).refused.front().map(|refused| refused.error.clone());
    assert!(error.is_some_and(|error| error.sentence().contains("still going")));
    here.key_press(Key::Escape);
    here.run_steps(3);
    // By another name nobody would know it for one.
    enter(&mut here, &file(&folder, "b.toml"));
    assert_eq!(state(&mut here).refused.len(), 1);
    here.key_press(Key::Escape);
    here.run_steps(3);
    // Without an ending it gets its own.
    enter(&mut here, &file(&folder, "c"));
    let stored = Stored::open(&file(&folder, "c.sprung")).and_then(|stored| stored.read(&|_, _| Ok(())));
    assert_eq!(stored.expect("it is whole").scene_name, "chain");
    // Meshes are in it: their files are not needed.
    let towel = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/towel.toml");
    press(&mut here, Action::Open);
    enter(&mut here, &towel);
    press(&mut here, Action::Checkpoint);
    enter(&mut here, &file(&folder, "towel.sprung"));
    let stored = Stored::open(&file(&folder, "towel.sprung")).and_then(|stored| stored.read(&|_, _| Ok(())));
    let scene = stored.and_then(|saved| saved.scene()).expect("it is whole");
    assert!(!scene.waits_for_meshes());
    // And a scene does not go by the name of a checkpoint.
    press(&mut here, Action::Save);
    enter(&mut here, &file(&folder, "scene.sprung"));
    assert_eq!(state(&mut here).refused.len(), 1);
    assert!(!file(&folder, "scene.sprung").exists() && !file(&folder, "b.toml").exists());
}
