//! A question with several answers, each of which the engine itself has judged.

use egui::Ui;

/// An answer to choose or not.
#[derive(Clone, Debug)]
pub struct Answer {
    /// What it says.
    pub text: String,
    /// Whether it is right: found by computing it, not written down.
    pub is_right: bool,
    /// The numbers that show it.
    pub because: String,
    /// Whether it has been tried.
    pub tried: bool,
}

impl Answer {
    /// An answer that nobody has tried yet.
    pub fn new(text: impl Into<String>, is_right: bool, because: impl Into<String>) -> Self {
        Self { text: text.into(), is_right, because: because.into(), tried: false }
    }
}

/// A question with several answers.
#[derive(Clone, Debug)]
pub struct Quiz {
    /// What is asked.
    pub question: String,
    /// What may be answered.
    pub answers: Vec<Answer>,
}

impl Quiz {
    /// Whether all right answers have been found.
    pub fn is_solved(&self) -> bool {
        self.answers.iter().all(|answer| answer.tried || !answer.is_right)
    }

    /// The question, with what is known of each answer that was tried.
    pub fn show(&mut self, ui: &mut Ui) {
        ui.label(&self.question);
        for answer in &mut self.answers {
            let mark = match (answer.tried, answer.is_right) {
                (false, _) => "",
                (true, true) => "Right: ",
                (true, false) => "No: ",
            };
            let text = format!("{mark}{}", answer.text);
            if ui.add(egui::Button::selectable(answer.tried, text).wrap()).clicked() {
                answer.tried = true;
            }
            if answer.tried {
                ui.indent(&answer.text, |ui| ui.weak(&answer.because));
            }
        }
        let left = self.answers.iter().filter(|answer| answer.is_right && !answer.tried).count();
        ui.label(match left {
            0 => "You found all of them.".to_owned(),
            1 => "One right answer is left.".to_owned(),
            left => format!("{left} right answers are left."),
        });
    }
}
