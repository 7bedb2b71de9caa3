//! The window, brought to a moment without a clock: the same steps on every machine, however slow it draws.

pub mod compare;
pub mod png_file;
#[path = "../../../sprung-render/tests/squares/mod.rs"]
pub mod squares;

use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;

use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT, Queryable};
use egui_kittest::{Harness, Node};
use sprung_app::{Action, App};
use sprung_driver::Command;
use sprung_render::Image;
use sprung_render::appearance::Theme;

use crate::view_support::{state, window_of};

pub type Window = Harness<'static, App>;

/// A picture of the window: what is opened, how large it is, and what is done before it is taken.
pub struct Shot {
    pub name: &'static str,
    pub scene: &'static str,
    pub theme: Theme,
    /// Width and height, points.
    pub size: [f32; 2],
    /// Pixels for each point: 2 draws text and all else twice as large.
    pub scale: f32,
    pub act: fn(&mut Window),
}

impl Shot {
    pub const fn light(name: &'static str, scene: &'static str, act: fn(&mut Window)) -> Self {
        Self { name, scene, theme: Theme::Light, size: [900.0, 600.0], scale: 1.0, act }
    }

    pub const fn dark(name: &'static str, scene: &'static str, act: fn(&mut Window)) -> Self {
        Self { theme: Theme::Dark, ..Self::light(name, scene, act) }
    }

    pub const fn sized(mut self, size: [f32; 2], scale: f32) -> Self {
        (self.size, self.scale) = (size, scale);
        self
    }

    /// Takes the picture.
    pub fn take(&self) -> Image {
        let builder = Harness::builder()
            .with_size(self.size)
            .with_pixels_per_point(self.scale)
            .with_render_cursor(false)
            .wgpu();
        let mut window = window_of(builder, self.scene);
        state(&mut window).appearance.theme = self.theme;
        state(&mut window).shown.controls = true;
        (self.act)(&mut window);
        // What slides or fades in has come to rest, and what was hovered no longer is.
        window.remove_cursor();
        window.run_steps(20);
        let drawn = window.render().expect("there is a driver");
        let rgb = drawn.pixels().flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        Image { width: drawn.width(), height: drawn.height(), rgb }
    }
}

/// Whether there is a driver to draw with. Where there is none, it says which pictures are left out, past the test
/// harness, which would swallow it; unless `SPRUNG_REQUIRE_GPU` is set: then that is a failure.
pub fn can_draw(what: &str) -> bool {
    let Err(error) = sprung_render::gpu::headless() else { return true };
    let must = std::env::var_os("SPRUNG_REQUIRE_GPU").is_some();
    assert!(!must, "{what} cannot be compared: {error}");
    writeln!(std::io::stderr(), "not compared: {what}, as {error}").expect("there is a terminal");
    false
}

/// Plays frame by frame until so much time is simulated, s, or it blows up. No clock decides how many steps that is.
pub fn play_to(window: &mut Window, time: f64) {
    let state = state(window);
    loop {
        let report = state.driver.report();
        if report.now.time >= time || report.trouble.is_some() {
            break;
        }
        state.send(Command::Frame);
    }
    window.run_steps(1);
}

/// Does what a key or a button does.
pub fn act(window: &mut Window, action: Action) {
    state(window).act(action);
    window.run_steps(3);
}

/// Clicks on the first thing of this name.
pub fn click(window: &mut Window, label: &str) {
    window.step();
    window.get_all_by_label(label).next().expect("it is there").click();
    window.run_steps(3);
}

/// Opens the list of choices that shows one of them, and takes another.
pub fn choose(window: &mut Window, shown: &str, wanted: &str) {
    let of_value = |node: &Node<'_>| node.accesskit_node().value().as_deref() == Some(shown);
    window.get_all_by_role(Role::ComboBox).find(of_value).expect("it is there").click();
    window.run_steps(3);
    click(window, wanted);
}

/// Types into what has the focus, in place of what it holds, and presses Enter.
pub fn enter(window: &mut Window, text: &str) {
    window.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    window.event(egui::Event::Text(text.to_owned()));
    window.step();
    window.key_press(Key::Enter);
    window.run_steps(3);
}

/// Drops a file onto the window.
pub fn drop_file(window: &mut Window, name: &str, text: &str) {
    let file = Dropped(name.into(), text.as_bytes().to_vec());
    window.input_mut().dropped_files.push(Arc::new(file));
    window.run_steps(3);
}

#[derive(Debug)]
struct Dropped(PathBuf, Vec<u8>);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &std::path::Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        Ok(self.1.clone())
    }
}
