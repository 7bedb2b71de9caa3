//! Plots: the energy ledger, traces of chosen quantities, and measured motion beside its formula.
//!
//! All of them read the report's samples. To hold a plot still is to look at an older report: the simulation goes on.

mod canvas;
mod entries;
pub mod exact;
mod formula;
mod ledger;
mod oscillation;
mod quantity;
mod save;
pub mod shape;
mod stretch;
mod traces;

use std::sync::Arc;

use egui::Ui;
use sprung_driver::{Command, Probe, Report, Sample};

use crate::state::AppState;
use canvas::Canvas;

/// Which plot is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PlotKind {
    /// Where the energy is, and where it went.
    #[default]
    Energy,
    /// Chosen quantities against time or each other.
    Traces,
    /// Measured motion beside its formula.
    Formula,
}

impl PlotKind {
    /// All of them with their names and what they show.
    pub const ALL: [(Self, &'static str, &'static str); 3] = [
        (Self::Energy, "Energy", "Where the energy is, and where it went."),
        (Self::Traces, "Traces", "Any quantity of a point or a spring, against time or against another."),
        (Self::Formula, "Formula", "The motion beside its exact solution, where there is one."),
    ];
}

/// What a plot shows, the same for all that lies on it.
#[derive(Clone, Copy)]
struct Page<'a> {
    /// How the simulation is, or was when the plot was held.
    report: &'a Report,
    /// The samples to show, in order of time.
    samples: &'a [&'a Sample],
}

/// How much of the run is shown when only its end is, s.
const RECENT: f64 = 10.0;

/// The plots' panel.
#[derive(Default)]
pub struct Plots {
    ledger: ledger::LedgerPlot,
    traces: traces::Traces,
    formula: formula::Formula,
    canvas: Canvas,
    /// The report that is shown while the plots are held.
    held: Option<Arc<Report>>,
    /// Only the last ten seconds.
    recent: bool,
    /// What the driver was asked to record, in the scene of this number.
    watching: (u64, Vec<Probe>),
}

/// The panel that the plots lie in: as high as wanted, but never more than most of the window.
pub fn panel(ui: &Ui) -> egui::Panel {
    let height = ui.ctx().content_rect().height();
    egui::Panel::bottom("plots")
        .resizable(true)
        .default_size((0.34 * height).max(250.0).min(0.5 * height))
        .size_range(150.0_f32.min(0.4 * height)..=0.65 * height)
}

impl Plots {
    /// The plots.
    pub fn show(&mut self, ui: &mut Ui, state: &mut AppState) {
        let serial = state.report.opened.serial;
        self.held = self.held.take().filter(|held| held.opened.serial == serial);
        let report = self.held.clone().unwrap_or_else(|| state.report.clone());
        let samples = self.visible(&report);
        self.formula.follow(&report);
        ui.add_space(4.0);
        let page = Page { report: &report, samples: &samples };
        ui.horizontal_wrapped(|ui| self.bar(ui, state, page));
        match state.plot {
            PlotKind::Energy => self.ledger.show(ui, state, page, &mut self.canvas),
            PlotKind::Traces => self.traces.show(ui, state, page, &mut self.canvas),
            PlotKind::Formula => self.formula.show(ui, state, page, &mut self.canvas),
        }
        self.watch(state);
    }

    /// The samples to show, in order of time.
    fn visible<'a>(&self, report: &'a Report) -> Vec<&'a Sample> {
        let all = report.samples.iter();
        if !self.recent {
            return all.collect();
        }
        all.filter(|sample| sample.time >= report.now.time - RECENT).collect()
    }

    fn bar(&mut self, ui: &mut Ui, state: &mut AppState, page: Page<'_>) {
        for (kind, name, description) in PlotKind::ALL {
            ui.selectable_value(&mut state.plot, kind, name).on_hover_text(description);
        }
        ui.separator();
        if state.plot == PlotKind::Energy {
            self.ledger.bar(ui);
            ui.separator();
        }
        let mut hold = self.held.is_some();
        let held = ui.toggle_value(&mut hold, "Hold").on_hover_text(
            "Holds the plot still, to read it. The simulation goes on, and so does its recording.",
        );
        if held.changed() {
            self.held = hold.then(|| state.report.clone());
        }
        if ui
            .button("Fit")
            .on_hover_text("Shows all of it again; so does a double click on the plot.")
            .clicked()
        {
            self.canvas.fit = true;
        }
        for (text, name, factor) in [("+", "Zoom in", 1.25), ("−", "Zoom out", 0.8)] {
            let button = ui.button(text).on_hover_text(format!(
                "{name}. On the plot: Ctrl and the wheel zoom, dragging moves, dragging with the right button cuts out a piece."
            ));
            button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, name));
            if button.clicked() {
                self.canvas.zoom = Some(factor);
            }
        }
        if ui
            .toggle_value(&mut self.recent, "Last 10 s")
            .on_hover_text("Only the last ten simulated seconds, or the whole run.")
            .changed()
        {
            self.canvas.fit = true;
        }
        ui.menu_button("Save plot…", |ui| {
            for format in save::FORMATS {
                if ui.button(format.name).on_hover_text(format.description).clicked() {
                    let request = match state.plot {
                        PlotKind::Energy => save::ledger(page, format.format).map(Some),
                        PlotKind::Traces => self.traces.save(page, format.format).map(Some),
                        PlotKind::Formula => self.formula.save(page, format.format),
                    };
                    match request {
                        Ok(Some(request)) => state.save_requests.push(request),
                        Ok(None) => state.say("There is no curve to save"),
                        Err(error) => state.refuse(error),
                    }
                    ui.close();
                }
            }
        })
        .response
        .on_hover_text("Saves the curves that are shown, as numbers or as a picture.");
    }

    /// Asks the driver to record what the plots need, once for each change.
    fn watch(&mut self, state: &mut AppState) {
        let mut wanted: Vec<Probe> = self.traces.probes();
        for probe in self.formula.probes() {
            if !wanted.contains(&probe) {
                wanted.push(probe);
            }
        }
        let wanted = (state.report.opened.serial, wanted);
        if self.watching != wanted && (!wanted.1.is_empty() || !self.watching.1.is_empty()) {
            state.send(Command::Watch(wanted.1.clone()));
            self.watching = wanted;
        }
    }
}

/// A plot with its legend: beside it where there is room, else below it in short.
fn beside_legend(ui: &mut Ui, plot: impl FnOnce(&mut Ui, egui::Vec2), legend: impl FnOnce(&mut Ui, bool)) {
    const LEGEND: f32 = 214.0;
    // The topmost number of the axis stands a little above the plot.
    ui.add_space(5.0);
    let all = ui.available_size();
    if all.x >= 2.4 * LEGEND {
        ui.horizontal_top(|ui| {
            let spacing = ui.spacing().item_spacing.x;
            plot(ui, egui::vec2(all.x - LEGEND - spacing, all.y));
            let column = egui::vec2(LEGEND, all.y);
            ui.allocate_ui_with_layout(column, egui::Layout::top_down(egui::Align::Min), |ui| {
                egui::ScrollArea::vertical()
                    .id_salt("legend")
                    .auto_shrink(false)
                    .show(ui, |ui| legend(ui, true));
            });
        });
    } else {
        let row = 46.0;
        plot(ui, egui::vec2(all.x, (all.y - row).max(70.0)));
        egui::ScrollArea::vertical().id_salt("legend").max_height(row).show(ui, |ui| {
            ui.horizontal_wrapped(|ui| legend(ui, false));
        });
    }
}

/// The value of a probe in a sample, if it was recorded.
fn value(sample: &Sample, probe: Probe) -> Option<f64> {
    sample.values.iter().find(|(recorded, _)| *recorded == probe).map(|(_, value)| *value)
}
