//! Traces: quantities of points and springs against time, or against another quantity.

use egui::{Color32, Ui};
use egui_plot::{Line, LineStyle, MarkerShape, PlotPoints, Points};
use sprung::Result;
use sprung_driver::{Probe, Report, Sample};

use super::canvas::{self, Canvas, Sheet, swatch};
use super::quantity::{self, Quantity};
use super::{Page, ledger, save, value};
use crate::media::SaveRequest;
use crate::state::{AppState, Pick};
use crate::text::steady;
use crate::theme::rgb;

/// Traces shown at the most: more cannot be told apart.
const MOST: usize = 8;

/// Okabe and Ito's colours on a bright and on a dark background, with dashes that differ where colours are close.
const LOOKS: [([u32; 2], LineStyle); MOST] = [
    ([0x00_72_b2, 0x4a_a8_e0], LineStyle::Solid),
    ([0xd5_5e_00, 0xee_7b_1e], LineStyle::Solid),
    ([0x00_9e_73, 0x2f_c0_96], LineStyle::Dashed { length: 9.0 }),
    ([0xcc_79_a7, 0xdd_8f_bb], LineStyle::Dashed { length: 9.0 }),
    ([0xe6_9f_00, 0xe6_9f_00], LineStyle::Dashed { length: 5.0 }),
    ([0x56_b4_e9, 0x8f_d0_f5], LineStyle::Dashed { length: 5.0 }),
    ([0x22_2b_36, 0xf2_f2_f2], LineStyle::Dotted { spacing: 5.0 }),
    ([0x8c_4a_8f, 0xb9_77_d1], LineStyle::Dotted { spacing: 5.0 }),
];

/// The traces, and the choice of the next one.
pub struct Traces {
    /// What is plotted upwards; each keeps its look while others come and go.
    kept: Vec<(Probe, usize)>,
    /// What runs to the right; time if nothing else.
    across: Option<Probe>,
    /// What the chooser is on.
    pick: Pick,
    quantity: &'static Quantity,
    /// The selection in the scene that the chooser has followed.
    followed: Option<Pick>,
    serial: u64,
    cursor: Option<f64>,
}

impl Default for Traces {
    fn default() -> Self {
        Self {
            kept: Vec::new(),
            across: None,
            pick: Pick::Point(0),
            quantity: &quantity::QUANTITIES[0],
            followed: None,
            serial: 0,
            cursor: None,
        }
    }
}

impl Traces {
    /// What must be recorded for them.
    pub fn probes(&self) -> Vec<Probe> {
        let mut probes: Vec<Probe> = self.kept.iter().map(|(probe, _)| *probe).collect();
        probes.extend(self.across.filter(|across| !probes.contains(across)));
        probes
    }

    /// The chooser, the plot and its legend.
    pub fn show(&mut self, ui: &mut Ui, state: &mut AppState, page: Page<'_>, canvas: &mut Canvas) {
        let Page { report, samples } = page;
        self.follow(state);
        ui.horizontal_wrapped(|ui| self.chooser(ui, report, canvas));
        if self.kept.is_empty() {
            ui.centered_and_justified(|ui| {
                ui.label("Choose a point or a spring, here or in the scene, then a quantity, and add it to the plot.");
            });
            return;
        }
        let dark = ui.visuals().dark_mode;
        let across = self.across;
        let curves: Vec<_> =
            self.kept.iter().map(|&(probe, look)| (look, curve(samples, probe, across))).collect();
        let read = match across {
            None => ledger::nearest(samples, self.cursor.unwrap_or(report.now.time)),
            Some(_) => ledger::nearest(samples, report.now.time),
        };
        // The dot that runs along a phase plot.
        let dots: Vec<_> = self
            .kept
            .iter()
            .filter_map(|&(probe, look)| Some((look, [value(read?, across?)?, value(read?, probe)?])))
            .collect();
        let sheet = |size| Sheet {
            id: if across.is_some() { "phase" } else { "traces" },
            across: across.map_or("time (s)".to_owned(), quantity::axis),
            upwards: self.upwards(),
            now: across.is_none().then_some(report.now.time),
            size,
        };
        let mut cursor = None;
        let mut removed = None;
        super::beside_legend(
            ui,
            |ui, size| {
                cursor = canvas.show(ui, sheet(size), |plot| {
                    for (look, points) in curves {
                        let (colour, style) = look_of(look, dark);
                        plot.line(
                            Line::new("", PlotPoints::new(points)).color(colour).style(style).width(1.8),
                        );
                    }
                    for (look, point) in dots {
                        let dot = Points::new("now", PlotPoints::new(vec![point])).shape(MarkerShape::Circle);
                        plot.points(dot.radius(5.0).color(look_of(look, dark).0));
                    }
                });
            },
            |ui, wide| removed = legend(ui, wide, &self.kept, read),
        );
        self.cursor = cursor;
        if let Some(index) = removed {
            self.kept.remove(index);
        }
    }

    /// The traces as a file.
    ///
    /// # Errors
    /// If the picture cannot be encoded.
    pub fn save(&self, page: Page<'_>, format: save::Format) -> Result<SaveRequest> {
        let curves: Vec<save::Curve> = self
            .kept
            .iter()
            .map(|&(probe, look)| save::Curve {
                name: quantity::name(probe),
                colour: LOOKS[look].0[0],
                style: LOOKS[look].1,
                points: curve(page.samples, probe, self.across).iter().map(|[x, y]| (*x, *y)).collect(),
            })
            .collect();
        match format {
            save::Format::Csv => Ok(save::values(page, &self.probes())),
            _ => save::chart(
                page,
                "traces",
                self.across.map_or("time (s)".to_owned(), quantity::axis),
                self.upwards(),
                curves,
                format,
            ),
        }
    }

    /// Goes where the selection of the scene goes, and drops what another scene does not have.
    fn follow(&mut self, state: &AppState) {
        let model = &state.report.opened.model;
        let exists = |pick| match pick {
            Pick::Point(point) => point < model.point_count(),
            Pick::Spring(spring) => spring < model.spring_count(),
        };
        if self.serial != state.report.opened.serial {
            self.serial = state.report.opened.serial;
            self.kept.retain(|(probe, _)| exists(quantity::place(*probe)));
            self.across = self.across.filter(|probe| exists(quantity::place(*probe)));
            if !exists(self.pick) || self.kept.is_empty() {
                // The last point is free in most scenes; the first is often pinned.
                self.choose(Pick::Point(model.point_count().saturating_sub(1)));
            }
        }
        if self.followed != state.selection {
            self.followed = state.selection;
            if let Some(pick) = state.selection.filter(|pick| exists(*pick)) {
                self.choose(pick);
            }
        }
    }

    fn choose(&mut self, pick: Pick) {
        self.pick = pick;
        if (self.quantity.probe)(pick).is_none() {
            self.quantity = quantity::of(pick).next().unwrap_or(&quantity::QUANTITIES[0]);
        }
    }

    fn chooser(&mut self, ui: &mut Ui, report: &Report, canvas: &mut Canvas) {
        let model = &report.opened.model;
        let is_point = matches!(self.pick, Pick::Point(_));
        if ui.selectable_label(is_point, "Point").on_hover_text("A quantity of a point.").clicked()
            && !is_point
        {
            self.choose(Pick::Point(model.point_count().saturating_sub(1)));
        }
        let springs = ui.add_enabled(model.spring_count() > 0, egui::Button::selectable(!is_point, "Spring"));
        if springs.on_hover_text("A quantity of a spring.").clicked() && is_point {
            self.choose(Pick::Spring(0));
        }
        let (index, count) = match &mut self.pick {
            Pick::Point(index) => (index, model.point_count()),
            Pick::Spring(index) => (index, model.spring_count()),
        };
        let number = ui.add(egui::DragValue::new(index).range(0..=count.saturating_sub(1)));
        number.on_hover_text("Its number. Click in the scene to choose by hand.");
        egui::ComboBox::from_id_salt("quantity").selected_text(self.quantity.name).width(128.0).show_ui(
            ui,
            |ui| {
                for quantity in quantity::of(self.pick) {
                    let chosen = std::ptr::eq(self.quantity, quantity);
                    if ui
                        .selectable_label(chosen, quantity.name)
                        .on_hover_text(quantity.explanation)
                        .clicked()
                    {
                        self.quantity = quantity;
                    }
                }
            },
        );
        let Some(probe) = (self.quantity.probe)(self.pick) else { return };
        let is_new = self.kept.iter().all(|(kept, _)| *kept != probe) && self.kept.len() < MOST;
        let add = ui.add_enabled(is_new, egui::Button::new("+ Add to plot"));
        if add
            .on_hover_text(format!("{}\nIt is recorded from now on.", self.quantity.explanation))
            .on_disabled_hover_text("It is in the plot already, or the plot is full.")
            .clicked()
        {
            let free = (0..MOST).find(|look| self.kept.iter().all(|(_, taken)| taken != look)).unwrap_or(0);
            self.kept.push((probe, free));
            canvas.fit = true;
        }
        ui.separator();
        self.choose_across(ui, probe, canvas);
    }

    /// What runs to the right: time, or the quantity of the chooser for a phase plot.
    fn choose_across(&mut self, ui: &mut Ui, probe: Probe, canvas: &mut Canvas) {
        ui.label("against");
        if ui.selectable_label(self.across.is_none(), "time").clicked() {
            self.across = None;
            canvas.fit = true;
        }
        if let Some(across) = self.across.filter(|across| *across != probe) {
            let _ = ui.selectable_label(true, quantity::name(across));
        }
        let phase = ui.selectable_label(self.across == Some(probe), quantity::name(probe));
        if phase.on_hover_text("A phase plot: one quantity against another, with a dot for now.").clicked() {
            self.across = Some(probe);
            canvas.fit = true;
        }
    }

    /// The label upwards: one quantity by name, several by their units.
    fn upwards(&self) -> String {
        if let [(probe, _)] = self.kept[..] {
            return quantity::axis(probe);
        }
        let mut units: Vec<&str> = Vec::new();
        for (probe, _) in &self.kept {
            let unit = quantity::unit(*probe);
            if !unit.is_empty() && !units.contains(&unit) {
                units.push(unit);
            }
        }
        units.join(", ")
    }
}

fn look_of(look: usize, dark: bool) -> (Color32, LineStyle) {
    let (colours, style) = LOOKS[look % MOST];
    (rgb(colours[usize::from(dark)]), style)
}

/// A trace as points: against time with all its peaks, against another quantity in the order of the run.
fn curve(samples: &[&Sample], probe: Probe, across: Option<Probe>) -> Vec<[f64; 2]> {
    match across {
        None => {
            canvas::thinned(samples.iter().filter_map(|sample| Some([sample.time, value(sample, probe)?])))
        }
        Some(across) => {
            let points: Vec<[f64; 2]> = samples
                .iter()
                .filter_map(|sample| Some([value(sample, across)?, value(sample, probe)?]))
                .filter(|point| point.iter().all(|value| value.is_finite()))
                .collect();
            let every = points.len().div_ceil(6000).max(1);
            points.into_iter().rev().step_by(every).collect()
        }
    }
}

/// The names of the traces with their values; answers which is to be removed.
fn legend(ui: &mut Ui, wide: bool, kept: &[(Probe, usize)], read: Option<&Sample>) -> Option<usize> {
    if wide {
        let text = read.map_or("no samples yet".to_owned(), |sample| format!("at t = {:.3} s", sample.time));
        ui.weak(text);
    }
    let dark = ui.visuals().dark_mode;
    let mut removed = None;
    for (index, &(probe, look)) in kept.iter().enumerate() {
        ui.horizontal(|ui| {
            let (colour, style) = look_of(look, dark);
            swatch(ui, colour, style, true);
            let explanation = quantity::quantity(probe).map_or("", |quantity| quantity.explanation);
            ui.label(quantity::name(probe)).on_hover_text(explanation);
            let remove = ui.small_button("×").on_hover_text(format!("Remove {}", quantity::name(probe)));
            remove.widget_info(|| {
                let name = format!("Remove {}", quantity::name(probe));
                egui::WidgetInfo::labeled(egui::Role::Button, true, name)
            });
            if remove.clicked() {
                removed = Some(index);
            }
        });
        if let Some(value) = read.and_then(|sample| value(sample, probe)).filter(|_| wide) {
            ui.horizontal(|ui| {
                ui.add_space(32.0);
                ui.monospace(format!("{} {}", steady(value), quantity::unit(probe)));
            });
        }
    }
    removed
}
