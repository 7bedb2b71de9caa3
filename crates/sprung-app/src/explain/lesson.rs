//! Guided lessons: what to do, a way to see that it was done, and on to the next. Each lesson is a list in a file of its own.

use egui::{RichText, Ui};
use sprung::{BlowUp, Result, stability};
use sprung_driver::Trouble;

use super::quiz::Quiz;
use super::{explode, formula, joules};
use crate::state::AppState;

/// All lessons.
pub static LESSONS: &[Lesson] = &[explode::LESSON, joules::LESSON];

/// A lesson.
pub struct Lesson {
    /// What it is called.
    pub title: &'static str,
    /// What one learns, in a sentence.
    pub about: &'static str,
    /// Its steps.
    pub steps: &'static [LessonStep],
}

/// A step of a lesson.
pub struct LessonStep {
    /// A few words.
    pub title: &'static str,
    /// What to do or to see, with the numbers of the moment.
    pub text: fn(&AppState, &Memory) -> String,
    /// Buttons that do it.
    pub offers: &'static [Offer],
    /// Whether it has been done. Once true, the step stays done.
    pub done: fn(&AppState, &Memory) -> bool,
    /// Questions to answer, made when the step begins, about a built-in scene: whatever is open, they take as long.
    pub quiz: Option<fn() -> Result<Quiz>>,
}

/// A button that does what a step asks for.
pub struct Offer {
    /// What it says.
    pub label: &'static str,
    /// What it does.
    pub act: fn(&mut AppState),
}

/// What a lesson remembers.
#[derive(Default)]
pub struct Memory {
    /// Simulated time when the step began, s.
    pub began: f64,
    /// The scene in which it began.
    pub serial: u64,
    /// The last blow-up seen in this lesson.
    pub blow_up: Option<BlowUp>,
    /// The fastest vibration of the scene's first shape under its own parameters, as far as it could be found quickly.
    pub own_limit: Option<stability::Sharp>,
    /// The questions of this step.
    pub quiz: Option<Quiz>,
}

impl Memory {
    /// Simulated time that has passed since the step began, or since a scene was opened in it, s.
    pub fn elapsed(&self, state: &AppState) -> f64 {
        let report = &state.report;
        if report.opened.serial == self.serial { report.now.time - self.began } else { report.now.time }
    }
}

/// A lesson that goes on.
struct Running {
    lesson: &'static Lesson,
    step: usize,
    done: bool,
    memory: Memory,
}

/// The lessons' page.
#[derive(Default)]
pub struct Lessons {
    running: Option<Running>,
}

/// Larger models take too long for the true limit to be found between two frames.
const MOST_SPRINGS: usize = 50_000;

impl Running {
    fn begin(&mut self, step: usize, state: &AppState) {
        let report = &state.report;
        (self.step, self.done) = (step, false);
        self.memory.began = report.now.time;
        self.memory.serial = report.opened.serial;
        self.memory.own_limit = own_limit(state);
        let quiz = self.lesson.steps.get(step).and_then(|step| step.quiz);
        // The scene that it is about comes with the program, and can be built.
        self.memory.quiz = quiz.and_then(|quiz| quiz().ok());
    }
}

fn own_limit(state: &AppState) -> Option<stability::Sharp> {
    let opened = &state.report.opened;
    (opened.model.spring_count() <= MOST_SPRINGS)
        .then(|| stability::sharp(&opened.model, &opened.params, &opened.first.positions))
}

impl Lessons {
    /// Watches whether the step at hand has been done.
    pub fn keep_up(&mut self, state: &AppState) {
        let Some(running) = &mut self.running else { return };
        if let Some(Trouble::BlewUp(blow_up)) = &state.report.trouble {
            running.memory.blow_up = Some((**blow_up).clone());
        }
        if let Some(step) = running.lesson.steps.get(running.step).filter(|_| !running.done) {
            let answered = running.memory.quiz.as_ref().is_none_or(Quiz::is_solved);
            running.done = answered && (step.done)(state, &running.memory);
        }
    }

    /// The list of lessons, or the step at hand.
    pub fn show(&mut self, ui: &mut Ui, state: &mut AppState) {
        let Some(running) = &mut self.running else {
            self.list(ui, state);
            return;
        };
        let Some(step) = running.lesson.steps.get(running.step) else {
            self.running = None;
            return;
        };
        let count = running.lesson.steps.len();
        ui.heading(running.lesson.title);
        ui.add(
            egui::ProgressBar::new((running.step + usize::from(running.done)) as f32 / count as f32)
                .desired_height(6.0),
        );
        ui.add_space(6.0);
        ui.label(RichText::new(format!("{} of {count}: {}", running.step + 1, step.title)).strong());
        for paragraph in (step.text)(state, &running.memory).split('\n') {
            formula::prose(ui, paragraph);
            ui.add_space(3.0);
        }
        for offer in step.offers {
            if ui.button(offer.label).clicked() {
                (offer.act)(state);
            }
        }
        if let Some(quiz) = &mut running.memory.quiz {
            quiz.show(ui);
        }
        ui.add_space(8.0);
        ui.label(if running.done { "Done." } else { "It goes on when this is done; or skip it." });
        let (mut go, mut leave) = (None, false);
        ui.horizontal_wrapped(|ui| {
            if ui.add_enabled(running.step > 0, egui::Button::new("Previous")).clicked() {
                go = Some(running.step.saturating_sub(1));
            }
            let next = match (running.step + 1 == count, running.done) {
                (true, _) => "Finish",
                (_, true) => "Next",
                (_, false) => "Skip",
            };
            if ui.button(RichText::new(next).strong()).clicked() {
                go = Some(running.step + 1);
            }
            leave = ui.button("Leave").on_hover_text("Ends the lesson. The scene stays as it is.").clicked();
        });
        match go {
            Some(step) if step < count => running.begin(step, state),
            Some(_) => leave = true,
            None => {}
        }
        if leave {
            self.running = None;
            state.pointed_out.clear();
        }
    }

    fn list(&mut self, ui: &mut Ui, state: &AppState) {
        ui.label("A lesson tells you what to do, notices when you have done it, and explains what happened.");
        for lesson in LESSONS {
            ui.add_space(8.0);
            ui.label(RichText::new(lesson.title).strong());
            ui.label(lesson.about);
            let begin = ui.button(format!("Begin: {}", lesson.title));
            if begin.on_hover_text(format!("{} steps", lesson.steps.len())).clicked() {
                let mut running = Running { lesson, step: 0, done: false, memory: Memory::default() };
                running.begin(0, state);
                self.running = Some(running);
            }
        }
    }
}
