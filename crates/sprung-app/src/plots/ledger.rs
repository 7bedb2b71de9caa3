//! The energy ledger against time: as lines, or as a stack that shows where every joule is.

use egui::{Stroke, Ui};
use egui_plot::{FilledArea, Line, LineStyle, PlotPoints, PlotUi};
use sprung::Energy;
use sprung_driver::{Command, Sample};

use super::Page;
use super::canvas::{self, Canvas, Sheet, swatch};
use super::entries::ENTRIES;
use crate::state::AppState;
use crate::text::steady;

/// How the ledger is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Drawing {
    /// A line for each entry.
    #[default]
    Lines,
    /// Areas on top of each other.
    Stack,
}

/// The energy plot.
pub struct LedgerPlot {
    /// Lines or a stack.
    pub drawing: Drawing,
    /// Which entries are shown.
    shown: [bool; ENTRIES.len()],
    /// The time the cursor was at in the last frame, s.
    cursor: Option<f64>,
}

impl Default for LedgerPlot {
    fn default() -> Self {
        Self { drawing: Drawing::Lines, shown: [true; ENTRIES.len()], cursor: None }
    }
}

impl LedgerPlot {
    /// The choice between lines and stack.
    pub fn bar(&mut self, ui: &mut Ui) {
        ui.selectable_value(&mut self.drawing, Drawing::Lines, "Lines").on_hover_text(
            "A line for each entry. Solid: where energy is. Dashed: where it went, or came from. Dotted: the integrator's own.",
        );
        ui.selectable_value(&mut self.drawing, Drawing::Stack, "Stack").on_hover_text(
            "Where every joule is: areas on top of each other. They reach up to the dashed line, which is all that was there \
             and was put in; a gap is what the integrator made or lost.",
        );
    }

    /// The plot of some samples, with its legend.
    pub fn show(&mut self, ui: &mut Ui, state: &mut AppState, page: Page<'_>, canvas: &mut Canvas) {
        let Page { report, samples } = page;
        self.say_if_not_whole(ui, state);
        let mut first = samples.first().map(|sample| sample.energy).unwrap_or_default();
        if self.drawing == Drawing::Stack {
            first.gravitational = lowest(samples);
        }
        let at = self.cursor.filter(|_| !samples.is_empty()).unwrap_or(report.now.time);
        let read = nearest(samples, at).map(|sample| (sample.time, sample.energy));
        let dark = ui.visuals().dark_mode;
        let (drawing, shown) = (self.drawing, self.shown);
        super::beside_legend(
            ui,
            |ui, size| {
                let sheet = Sheet {
                    id: "energy",
                    across: "time (s)".to_owned(),
                    upwards: "energy (J)".to_owned(),
                    now: Some(report.now.time),
                    size,
                };
                self.cursor = canvas.show(ui, sheet, |plot| match drawing {
                    Drawing::Lines => lines(plot, samples, &first, &shown, dark),
                    Drawing::Stack => stack(plot, samples, &shown, dark),
                });
            },
            |ui, wide| legend(ui, wide, &mut self.shown, drawing, read, &first),
        );
    }

    /// A ledger that was switched on later, or is off, does not balance: says so, and offers what helps.
    fn say_if_not_whole(&self, ui: &mut Ui, state: &mut AppState) {
        if state.report.ledger_is_whole {
            return;
        }
        ui.horizontal_wrapped(|ui| {
            ui.label("The books are not whole: losses were not counted from the first step on.");
            let again = ui.small_button("Keep them and start again");
            let again = again.on_hover_text(
                "Goes back to the first step, with the ledger on. Each step takes longer with it.",
            );
            if again.clicked() {
                state.send(Command::KeepLedger(true));
                state.send(Command::Reset);
            }
        });
    }
}

fn lines(plot: &mut PlotUi<'_>, samples: &[&Sample], first: &Energy, shown: &[bool], dark: bool) {
    // The total is first in the list, and on top of the others.
    for (entry, _) in ENTRIES.iter().zip(shown).rev().filter(|(_, shown)| **shown) {
        let curve = samples.iter().map(|sample| [sample.time, entry.reading(&sample.energy, first)]);
        let points = PlotPoints::new(canvas::thinned(curve));
        let width = if entry.from_start && !entry.stacks { 2.4 } else { 1.8 };
        plot.line(Line::new(entry.name, points).color(entry.colour(dark)).style(entry.style).width(width));
    }
}

/// Areas from the bottom up, and the line that they should reach: energy at the start plus work put in.
fn stack(plot: &mut PlotUi<'_>, samples: &[&Sample], shown: &[bool], dark: bool) {
    let samples: Vec<&Sample> = canvas::sparse(samples)
        .into_iter()
        .filter(|sample| ENTRIES.iter().all(|entry| (entry.value)(&sample.energy).is_finite()))
        .collect();
    if samples.len() < 2 {
        return;
    }
    // Heights have no zero of their own. The lowest so far makes an area of what can still be fallen.
    let lowest = lowest(&samples);
    let times: Vec<f64> = samples.iter().map(|sample| sample.time).collect();
    let mut below = vec![0.0; samples.len()];
    for (entry, _) in ENTRIES.iter().zip(shown).filter(|(entry, shown)| entry.stacks && **shown) {
        let zero = if entry.from_start { lowest } else { 0.0 };
        let above: Vec<f64> = samples
            .iter()
            .zip(&below)
            .map(|(sample, below)| below + (entry.value)(&sample.energy) - zero)
            .collect();
        let colour = entry.colour(dark);
        plot.add(
            FilledArea::new(entry.name, &times, &below, &above)
                .fill_color(colour.gamma_multiply(0.55))
                .stroke(Stroke::new(1.0, colour)),
        );
        below = above;
    }
    let all = |sample: &&Sample| sample.energy.sums.start + sample.energy.sums.work_in - lowest;
    let due: Vec<[f64; 2]> = samples.iter().map(|sample| [sample.time, all(sample)]).collect();
    plot.line(
        Line::new("start + work put in", PlotPoints::new(due))
            .color(ENTRIES[0].colour(dark))
            .style(LineStyle::Dashed { length: 8.0 })
            .width(2.0),
    );
}

/// The lowest gravitational energy of some samples, J.
fn lowest(samples: &[&Sample]) -> f64 {
    samples.iter().map(|sample| sample.energy.gravitational).fold(f64::INFINITY, f64::min)
}

/// The names of the entries with their values; a click shows or hides one.
fn legend(
    ui: &mut Ui,
    wide: bool,
    shown: &mut [bool; ENTRIES.len()],
    drawing: Drawing,
    read: Option<(f64, Energy)>,
    first: &Energy,
) {
    if wide {
        let text = read.map_or("no samples yet".to_owned(), |(time, _)| format!("at t = {time:.3} s, in J"));
        ui.weak(text);
    }
    let dark = ui.visuals().dark_mode;
    for (entry, shown) in ENTRIES.iter().zip(shown) {
        if drawing == Drawing::Stack && !entry.stacks {
            continue;
        }
        ui.horizontal(|ui| {
            let style = if drawing == Drawing::Stack { LineStyle::Solid } else { entry.style };
            swatch(ui, entry.colour(dark), style, *shown);
            toggle(ui, shown, entry.name).on_hover_text(entry.tooltip());
            if let Some((_, energy)) = read.filter(|_| wide) {
                let value = steady(entry.reading(&energy, first));
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| ui.monospace(value));
            }
        });
    }
    if drawing == Drawing::Stack {
        ui.horizontal(|ui| {
            swatch(ui, ENTRIES[0].colour(dark), LineStyle::Dashed { length: 8.0 }, true);
            ui.label("start + work put in").on_hover_text(
                "All energy there was at the start, and all that was put in since. Where the stack ends below or above it, the \
                 integrator has lost energy or made some: its error.",
            );
        });
    }
}

/// A name that shows or hides a curve. It looks like text, and dims when its curve is hidden.
fn toggle(ui: &mut Ui, shown: &mut bool, name: &str) -> egui::Response {
    let colour = if *shown { ui.visuals().text_color() } else { ui.visuals().weak_text_color() };
    let text = egui::RichText::new(name).color(colour);
    let response = ui.add(egui::Button::new(if *shown { text } else { text.strikethrough() }).frame(false));
    if response.clicked() {
        *shown = !*shown;
    }
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::CheckBox, true, *shown, name));
    response
}

/// The sample nearest to a time.
pub fn nearest<'a>(samples: &[&'a Sample], time: f64) -> Option<&'a Sample> {
    let after = samples.partition_point(|sample| sample.time < time);
    let candidates = samples.get(after.saturating_sub(1)..(after + 1).min(samples.len()))?;
    candidates.iter().copied().min_by(|a, b| (a.time - time).abs().total_cmp(&(b.time - time).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cursor_reads_the_nearest_sample() {
        let samples: Vec<Sample> = (0..10)
            .map(|i| Sample { step: i, time: 0.1 * i as f64, energy: Energy::default(), values: Vec::new() })
            .collect();
        let samples: Vec<&Sample> = samples.iter().collect();
        let step = |time| nearest(&samples, time).map(|sample| sample.step);
        assert_eq!([-3.0, 0.04, 0.06, 0.52, 99.0].map(step), [Some(0), Some(0), Some(1), Some(5), Some(9)]);
        assert!(step(f64::NAN).is_some());
        assert!(nearest(&[], 0.0).is_none());
    }
}
