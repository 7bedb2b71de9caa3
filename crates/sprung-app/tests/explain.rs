//! "How it works": its pages with every scene, the stages of the step, and lessons that are done by doing what they say.

mod common;

use common::{DUST, builtin, click, scene, state, window};
use egui::Key;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use sprung::scene::{BUILTIN, Kind};
use sprung_app::explain::{LESSONS, Quiz, STAGES, Stage, reading};
use sprung_app::{App, Pick};
use sprung_driver::Command;

const SIZE: [f32; 2] = [1400.0, 900.0];

#[test]
fn every_page_shows_with_every_scene() {
    let scenes =
        BUILTIN.iter().filter(|scene| scene.kind != Kind::Benchmark).map(|scene| builtin(scene.name));
    for source in scenes.chain([scene("dust", DUST)]) {
        let name = source.name.clone();
        let mut window = window(source, [800.0, 600.0]);
        state(&mut window).shown.explain = true;
        window.run_steps(2);
        assert!(window.query_by_label("Try this").is_some(), "{name}");
        let has_plane = !state(&mut window).report.params.planes.is_empty();
        assert_eq!(window.query_by_label("The ground").is_some(), has_plane, "{name}");
        click(&mut window, "The step");
        for info in &STAGES {
            assert!(window.query_by_label_contains(info.name).is_some(), "{name}: {}", info.name);
        }
        click(&mut window, "Lessons");
        assert!(window.query_by_label_contains("notices when you have done it").is_some(), "{name}");
    }
}

#[test]
fn the_jelly_in_its_plane_is_explained_with_the_numbers_of_the_moment() {
    let mut window = window(builtin("jelly"), SIZE);
    state(&mut window).shown.explain = true;
    state(&mut window).send(Command::Settle);
    window.run_steps(3);
    assert!(window.query_by_label_contains("the weight is 9810 N").is_some());
    assert!(window.query_by_label_contains("pushed up by 98").is_some());
    let shared = "9810/50 = 196.2 m. Shared by the 100 points that are deep, that is 1.96 m each";
    assert!(window.query_by_label_contains(shared).is_some());
}

#[test]
fn the_key_goes_through_the_stages_and_takes_the_step() {
    let mut window = window(builtin("chain"), SIZE);
    state(&mut window).send(Command::Play(true));
    window.run_steps(3);
    let press = |window: &mut Harness<'static, App>| {
        window.key_press(Key::N);
        window.run_steps(3);
    };
    press(&mut window);
    assert!(!state(&mut window).report.playing, "it pauses first");
    assert!(state(&mut window).shown.explain);
    let Some(Pick::Spring(spring)) = state(&mut window).selection else { panic!("a spring is suggested") };
    let step = state(&mut window).report.now.step;
    for info in &STAGES {
        assert_eq!(state(&mut window).explain_stage, Some(info.stage));
        assert!(window.query_by_label_contains(&format!("{}  ·  now", info.name)).is_some());
        assert_eq!(state(&mut window).report.now.step, step);
        // Its arrow is in the scene, at both ends of the spring.
        let called = match info.stage {
            Stage::Springs => "spring and damper on",
            Stage::Forces => "all forces on",
            Stage::Velocity => "new velocity of",
            Stage::Position => "way in this step of",
        };
        for end in ["i", "j"] {
            let label = format!("{called} {end}: ");
            assert!(window.query_by_label_contains(&label).is_some(), "{label}");
        }
        press(&mut window);
    }
    assert_eq!(state(&mut window).report.now.step, step + 1, "after the last stage the step is taken");
    assert_eq!(state(&mut window).explain_stage, Some(Stage::Springs));
    assert!(reading::spring(&state(&mut window).report, spring).is_some());
    // Playing on ends it, and so does hiding the panel.
    state(&mut window).send(Command::Play(true));
    window.run_steps(2);
    assert_eq!(state(&mut window).explain_stage, None);
    assert!(window.query_by_label_contains("spring and damper on i").is_none());
    press(&mut window);
    window.key_press(Key::E);
    window.run_steps(3);
    assert_eq!(state(&mut window).explain_stage, None);
}

#[test]
fn stages_also_go_through_a_scene_without_springs() {
    let mut window = window(scene("dust", DUST), SIZE);
    for _ in 0..9 {
        window.key_press(Key::N);
        window.run_steps(2);
    }
    assert_eq!(state(&mut window).report.now.step, 2);
}

/// Plays until the step of the lesson is done, or for `patience` frames of the window.
fn wait_until_done(window: &mut Harness<'static, App>, patience: usize) -> bool {
    (0..patience).any(|_| {
        window.step();
        window.query_by_label("Done.").is_some()
    })
}

/// Gives every answer, and reads what is said of it.
fn try_all(window: &mut Harness<'static, App>, quiz: &Quiz) {
    for answer in &quiz.answers {
        window.get_by_label(&answer.text).click();
        window.run_steps(2);
        let mark = if answer.is_right { "Right:" } else { "No:" };
        assert!(window.query_by_label(&format!("{mark} {}", answer.text)).is_some(), "{}", answer.text);
    }
}

#[test]
fn lessons_ask_about_their_own_scene_whatever_is_open() {
    for lesson in LESSONS {
        let mut window = window(scene("dust", DUST), SIZE);
        state(&mut window).shown.explain = true;
        window.run_steps(2);
        click(&mut window, "Lessons");
        click(&mut window, &format!("Begin: {}", lesson.title));
        for step in lesson.steps {
            if let Some(quiz) = step.quiz {
                try_all(&mut window, &quiz().expect("its scene is built in"));
            }
            let onward = ["Skip", "Next", "Finish"];
            let onward = onward.into_iter().find(|label| window.query_by_label(label).is_some());
            click(&mut window, onward.expect("there is a way on"));
        }
    }
}

/// Does what each step of a lesson says, by its first button, and answers its questions by trying all.
fn take_lesson(number: usize, scene: &str) {
    let lesson = &LESSONS[number];
    let mut window = window(builtin(scene), SIZE);
    state(&mut window).shown.explain = true;
    window.run_steps(2);
    click(&mut window, "Lessons");
    click(&mut window, &format!("Begin: {}", lesson.title));
    for (index, step) in lesson.steps.iter().enumerate() {
        let title = format!("{} of {}: {}", index + 1, lesson.steps.len(), step.title);
        assert!(window.query_by_label(&title).is_some(), "{title}");
        if let Some(offer) = step.offers.first() {
            click(&mut window, offer.label);
        }
        if let Some(quiz) = step.quiz {
            let quiz = quiz().expect("its scene is built in");
            let right = quiz.answers.iter().filter(|answer| answer.is_right).count();
            assert!(right > 0 && right < quiz.answers.len(), "{title}: some are right, some are not");
            try_all(&mut window, &quiz);
        }
        assert!(wait_until_done(&mut window, 2000), "{title}");
        click(&mut window, if index + 1 == lesson.steps.len() { "Finish" } else { "Next" });
    }
    assert!(window.query_by_label_contains("notices when you have done it").is_some(), "back at the list");
}

#[test]
fn the_lesson_about_explosions_runs_through() {
    take_lesson(0, "cloth");
}

#[test]
fn the_lesson_about_energy_runs_through() {
    take_lesson(1, "chain");
}

#[test]
fn every_lesson_is_taken_by_a_test() {
    assert_eq!(LESSONS.len(), 2, "add a test that takes the new lesson");
}
