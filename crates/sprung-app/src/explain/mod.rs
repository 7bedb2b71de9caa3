//! "How it works": the scene in plain words, the step in formulas with the numbers of the moment, and lessons.

mod explode;
mod formula;
mod ground;
mod joules;
mod lesson;
mod quiz;
pub mod reading;
mod stage;
mod step;
pub mod texts;

use egui::Ui;

use crate::state::AppState;
pub use lesson::{LESSONS, Lesson, LessonStep, Offer};
pub use quiz::{Answer, Quiz};
pub use stage::{STAGES, Stage, StageInfo};

/// The pages of the panel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Page {
    #[default]
    Scene,
    Step,
    Lessons,
}

/// The side panel that explains.
#[derive(Default)]
pub struct Explain {
    page: Page,
    step: step::StepPage,
    lessons: lesson::Lessons,
}

/// The panel it lies in: wide enough for a vector in a line.
pub fn panel(ui: &Ui, is_narrow: bool) -> egui::Panel {
    if is_narrow {
        return egui::Panel::bottom("explain below").exact_size(0.5 * ui.available_height());
    }
    let width = ui.ctx().content_rect().width();
    egui::Panel::right("explain")
        .resizable(true)
        .default_size(348.0_f32.min(0.42 * width))
        .size_range(220.0_f32.min(0.3 * width)..=0.55 * width)
}

impl Explain {
    /// The panel.
    pub fn show(&mut self, ui: &mut Ui, state: &mut AppState) {
        ui.add_space(4.0);
        ui.horizontal_wrapped(|ui| {
            for (page, name, hint) in [
                (Page::Scene, "This scene", "What one sees here, and what to try."),
                (Page::Step, "The step", "One step in four formulas, with the numbers of the moment."),
                (Page::Lessons, "Lessons", "Guided tours that notice what you do."),
            ] {
                ui.selectable_value(&mut self.page, page, name).on_hover_text(hint);
            }
        });
        ui.separator();
        let page = self.page;
        egui::ScrollArea::vertical().id_salt(("explain", page as u8)).auto_shrink(false).show(ui, |ui| {
            match page {
                Page::Scene => scene(ui, state),
                Page::Step => self.step.show(ui, state),
                Page::Lessons => self.lessons.show(ui, state),
            }
        });
    }

    /// In every frame, also while the panel is hidden: ends what playing on ends, and lets a lesson watch.
    pub fn keep_up(&mut self, state: &mut AppState) {
        self.step.keep_up(state);
        self.lessons.keep_up(state);
        if !state.shown.explain || self.page != Page::Step {
            state.explain_stage = None;
        }
    }

    /// Goes to the next stage of the step; shows the page about it first if it is hidden.
    pub fn next_stage(&mut self, state: &mut AppState) {
        state.shown.explain = true;
        self.page = Page::Step;
        self.step.next_stage(state);
    }
}

/// What one sees in this scene, and what to try.
fn scene(ui: &mut Ui, state: &mut AppState) {
    let report = state.report.clone();
    let scene = &report.opened.scene;
    let text = texts::of(&report.opened.name);
    ui.heading(if scene.title.is_empty() { &report.opened.name } else { &scene.title });
    if text.scene.is_empty() && !scene.description.is_empty() {
        ui.label(&scene.description);
        ui.add_space(6.0);
    }
    ui.label(text.see);
    ui.add_space(8.0);
    ui.heading("Try this");
    for hint in text.tries {
        ui.horizontal_top(|ui| {
            ui.label("•");
            ui.add(egui::Label::new(*hint).wrap());
        });
    }
    ground::show(ui, &report);
}
