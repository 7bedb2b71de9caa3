//! What is seen, saved: needs a graphics driver. Without one this says what it leaves out, unless `SPRUNG_REQUIRE_GPU`
//! is set: then that is a failure.

mod view_support;

use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use sprung_app::{App, Film, FilmClock, Pick, PictureSize};
use sprung_render::appearance::Theme;
use view_support::*;

/// A window that is drawn; `None` where there is no driver.
#[allow(clippy::print_stderr, reason = "it says what is skipped")]
fn drawn(scene: &str) -> Option<Harness<'static, App>> {
    if let Err(error) = sprung_render::gpu::headless() {
        let must = std::env::var_os("SPRUNG_REQUIRE_GPU").is_some();
        assert!(!must, "{error}");
        #[expect(clippy::print_stderr, reason = "a test that is left out says so")]
        {
            eprintln!("not tried: {error}");
        }
        return None;
    }
    Some(window_of(Harness::builder().with_size([640.0, 480.0]).wgpu(), scene))
}

#[test]
fn the_scene_is_drawn_in_both_themes_and_only_where_it_is() {
    for scene in ["spring", "chain", "jelly", "cloth"] {
        let Some(mut harness) = drawn(scene) else { return };
        for theme in [Theme::Light, Theme::Dark] {
            state(&mut harness).appearance.theme = theme;
            harness.run_steps(3);
            let image = harness.render().expect("there is a driver");
            let rect = view(&harness);
            let at = |x: f32, y: f32| image.get_pixel(x as u32, y as u32).0;
            let empty = at(rect.min.x + 3.0, rect.center().y);
            let is_dark = empty[..3].iter().all(|value| *value < 90);
            assert_eq!(is_dark, theme == Theme::Dark, "{scene}, {theme:?}: {empty:?}");
            let place = place(&harness, 0).expect("it is seen");
            let around = (-4..=4).flat_map(|x| (-4..=4).map(move |y| (x as f32, y as f32)));
            let differs = around.filter(|(x, y)| {
                let found = at(place.x + x, place.y + y);
                (0..3).any(|channel| found[channel].abs_diff(empty[channel]) > 40)
            });
            assert!(differs.count() > 10, "{scene}, {theme:?}: nothing at point 0");
        }
    }
}

#[test]
fn a_picture_has_the_size_that_was_chosen() {
    let Some(mut harness) = drawn("jelly") else { return };
    let rect = view(&harness);
    let sizes = [
        (PictureSize::Window, [rect.width() as u32, rect.height() as u32]),
        (PictureSize::Twice, [2 * rect.width() as u32, 2 * rect.height() as u32]),
        (PictureSize::FullHd, [1920, 1080]),
    ];
    for (size, [width, height]) in sizes {
        state(&mut harness).filming.size = size;
        harness.key_press_modifiers(Modifiers::COMMAND, Key::P);
        harness.run_steps(2);
        let request = state(&mut harness).save_requests.pop().expect("it asks where to save");
        assert_eq!(request.name, "jelly.png");
        // Away with the card that asks.
        harness.key_press(Key::Escape);
        harness.run_steps(2);
        // A PNG says its size in bytes 16 to 23.
        let side = |at: usize| u32::from_be_bytes(request.bytes[at..at + 4].try_into().expect("four bytes"));
        assert!(side(16).abs_diff(width) <= 2 && side(20).abs_diff(height) <= 2, "{}x{}", side(16), side(20));
    }
    assert!(state(&mut harness).refused.is_empty());
}

#[test]
fn a_film_follows_the_simulations_time_and_becomes_a_file() {
    let Some(mut harness) = drawn("spring") else { return };
    let folder = std::env::temp_dir().join(format!("sprung-film-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("there is room for temporary files");
    let path = folder.join("spring.gif");
    state(&mut harness).filming.rate = 25;
    let ctrl_r = |harness: &mut Harness<'static, App>| {
        harness.key_press_modifiers(Modifiers::COMMAND, Key::R);
        harness.run_steps(2);
    };
    ctrl_r(&mut harness);
    play(&mut harness, 60);
    ctrl_r(&mut harness);
    assert_eq!(state(&mut harness).filming.film, Film::Waits("spring.gif".to_owned()));
    state(&mut harness).filming.film = Film::To(path.clone());
    for _ in 0..600 {
        harness.run_steps(1);
        if path.exists() {
            break;
        }
    }
    assert!(state(&mut harness).refused.is_empty(), "{:?}", state(&mut harness).refused);
    let film = std::fs::read(&path).expect("it was written");
    assert!(film.starts_with(b"GIF89a"));
    // Each picture has a graphic control extension; a second of 25 pictures, with the first and the last.
    let pictures = film
        .windows(4)
        .filter(|bytes| *bytes == [0x21, 0xf9, 0x04, 0x04] || *bytes == [0x21, 0xf9, 0x04, 0x05]);
    let count = pictures.count();
    assert!((22..=28).contains(&count), "{count} pictures");
    std::fs::remove_dir_all(&folder).expect("it is ours");
}

#[test]
fn a_clock_that_is_chosen_during_a_film_is_for_the_next_one() {
    let Some(mut harness) = drawn("spring") else { return };
    harness.key_press_modifiers(Modifiers::COMMAND, Key::R);
    harness.run_steps(3);
    let badge = "recording: 1 picture";
    assert!(harness.query_by_label(badge).is_some(), "time stands still");
    state(&mut harness).filming.clock = FilmClock::Real;
    harness.run_steps(60);
    assert!(harness.query_by_label(badge).is_some(), "a second of the other clock has passed");
}

#[test]
fn a_film_that_is_still_written_leaves_no_file_when_the_window_closes() {
    let Some(mut harness) = drawn("jelly") else { return };
    let folder = tempfile::tempdir().expect("there is room for temporary files");
    let film = |harness: &mut Harness<'static, App>| {
        harness.key_press_modifiers(Modifiers::COMMAND, Key::R);
        harness.run_steps(2);
    };
    film(&mut harness);
    play(&mut harness, 60);
    film(&mut harness);
    state(&mut harness).filming.film = Film::To(folder.path().join("jelly.gif"));
    harness.run_steps(2);
    let is_writing = harness.query_by_label_contains("writing").is_some();
    eframe::App::on_exit(harness.state_mut());
    let files = std::fs::read_dir(folder.path()).expect("it is ours").count();
    assert!(is_writing && files == 0, "{files} files, writing: {is_writing}");
}

#[test]
fn a_film_is_lost_only_if_that_is_wanted() {
    let Some(mut harness) = drawn("spring") else { return };
    harness.key_press_modifiers(Modifiers::COMMAND, Key::R);
    harness.run_steps(3);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::R);
    harness.run_steps(3);
    harness.get_by_label("Save the film");
    // Esc asks, and Esc again goes back.
    for question in [true, false] {
        harness.key_press(Key::Escape);
        harness.run_steps(3);
        assert_eq!(harness.query_by_label("Discard the film?").is_some(), question);
        assert!(matches!(state(&mut harness).filming.film, Film::Waits(_)));
    }
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    harness.get_by_label("Discard it").click();
    harness.run_steps(3);
    assert_eq!(state(&mut harness).filming.film, Film::None);
    assert!(harness.query_by_label("Save the film").is_none());
    assert!(harness.query_by_label_contains("to be saved").is_none());
}

#[test]
fn what_is_pointed_out_is_marked_even_where_it_is_selected() {
    let Some(mut harness) = drawn("cloth") else { return };
    let (point, spring) = (Pick::Point(210), Pick::Spring(30));
    state(&mut harness).selection = Some(spring);
    harness.run_steps(2);
    let before = harness.render().expect("there is a driver");
    state(&mut harness).pointed_out = vec![point, spring];
    harness.run_steps(2);
    let after = harness.render().expect("there is a driver");
    let ends = state(&mut harness).report.opened.model.springs()[30].map(|end| end as usize);
    let ends = ends.map(|end| place(&harness, end).expect("it is seen"));
    for place in [place(&harness, 210).expect("it is seen"), ends[0].lerp(ends[1], 0.5)] {
        let changed = before.enumerate_pixels().filter(|(x, y, pixel)| {
            let near = (*x as f32 - place.x).hypot(*y as f32 - place.y) < 12.0;
            near && after.get_pixel(*x, *y) != *pixel
        });
        assert!(changed.count() > 5, "nothing new around {place}");
    }
}

#[test]
fn what_is_selected_is_marked() {
    let Some(mut harness) = drawn("cloth") else { return };
    harness.run_steps(2);
    let before = harness.render().expect("there is a driver");
    state(&mut harness).selection = Some(Pick::Point(210));
    harness.run_steps(2);
    let after = harness.render().expect("there is a driver");
    let place = place(&harness, 210).expect("it is seen");
    let changed = before.enumerate_pixels().filter(|(x, y, pixel)| {
        let near = (*x as f32 - place.x).hypot(*y as f32 - place.y) < 30.0;
        near && after.get_pixel(*x, *y) != *pixel
    });
    assert!(changed.count() > 20, "a ring around the point");
}
