//! The tab that holds the run against a formula, where there is one.

use egui::Ui;
use sprung::Result;
use sprung_driver::{Probe, Report};

use super::Page;
use super::canvas::Canvas;
use super::oscillation::Oscillation;
use super::save::Format;
use super::shape::{self, Shape};
use super::stretch::Stretch;
use crate::action::Action;
use crate::media::SaveRequest;
use crate::state::AppState;

/// What fits the scene.
#[derive(Default)]
pub struct Formula {
    oscillation: Oscillation,
    stretch: Stretch,
    shape: Option<Shape>,
    /// Somebody has looked at it: from then on what it needs is recorded.
    is_wanted: bool,
}

impl Formula {
    /// Finds out which formula fits, and since when. This comes before all else in each frame, whatever tab is shown: the
    /// scene may be another one, or its spring may have been cut.
    pub fn follow(&mut self, report: &Report) {
        self.shape = shape::recognise(&report.opened.model, &report.params);
        if let Some(Shape::Oscillator(_)) = &self.shape {
            self.oscillation.notice_disturbance(report);
        }
    }

    /// What must be recorded for it.
    pub fn probes(&self) -> Vec<Probe> {
        match &self.shape {
            Some(Shape::Oscillator(oscillator)) if self.is_wanted => Oscillation::probes(oscillator),
            _ => Vec::new(),
        }
    }

    /// The plot, or the reason why there is none.
    pub fn show(&mut self, ui: &mut Ui, state: &mut AppState, page: Page<'_>, canvas: &mut Canvas) {
        self.is_wanted = true;
        match &self.shape {
            Some(Shape::Oscillator(oscillator)) => {
                self.oscillation.show(ui, state, page, oscillator, canvas);
            }
            Some(Shape::Chain(chain)) => self.stretch.show(ui, state, page, chain, canvas),
            None => no_formula(ui, state),
        }
    }

    /// The curves as a file; `None` where there are none.
    ///
    /// # Errors
    /// If the picture cannot be encoded.
    pub fn save(&self, page: Page<'_>, format: Format) -> Result<Option<SaveRequest>> {
        match &self.shape {
            Some(Shape::Oscillator(oscillator)) => self.oscillation.save(page, oscillator, format),
            Some(Shape::Chain(chain)) => Stretch::save(page, chain, format).map(Some),
            None => Ok(None),
        }
    }
}

fn no_formula(ui: &mut Ui, state: &mut AppState) {
    ui.add_space(8.0);
    ui.label(
        "No formula fits this scene as it is. There is one for a single mass on a spring from a fixed point, and one for a \
         chain that hangs from one end: without a plane, cut springs or other forces.",
    );
    ui.horizontal(|ui| {
        ui.label("Try");
        for action in [Action::Scene(0), Action::Scene(1)] {
            let info = action.info();
            if ui.button(info.name).on_hover_text(info.description).clicked() {
                state.act(action);
            }
        }
    });
}
