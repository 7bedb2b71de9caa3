//! A hanging chain: the stretch of each spring as a bar, with what the formula says for a chain at rest.

use egui::{Stroke, Ui};
use egui_plot::{Bar, BarChart, Line, LineStyle, PlotPoints};
use sprung::Result;
use sprung_driver::{Command, Report};

use super::Page;
use super::canvas::{Canvas, Sheet, swatch};
use super::exact;
use super::save::{self, Format};
use super::shape::Chain;
use crate::media::SaveRequest;
use crate::state::AppState;
use crate::text::steady;
use crate::theme::rgb;

/// Slower than this, m/s, a chain counts as hanging still.
const STILL: f64 = 1e-3;

/// The bars.
#[derive(Default)]
pub struct Stretch {
    /// The spring that the cursor is on, as its place in the chain.
    cursor: Option<usize>,
}

impl Stretch {
    /// The bars of the chain as it is now.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        state: &mut AppState,
        Page { report, .. }: Page<'_>,
        chain: &Chain,
        canvas: &mut Canvas,
    ) {
        let (measured, exact) = (measured(report, chain), formula(chain));
        let fastest = report.now.velocities.iter().map(|v| f64::from(v.length())).fold(0.0, f64::max);
        let off = measured.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        ui.horizontal_wrapped(|ui| {
            ui.label(if fastest < STILL {
                format!("At rest: the largest difference is {} mm.", steady(1000.0 * off))
            } else {
                "It moves. The formula is that of the chain at rest.".to_owned()
            });
            let settle = ui.small_button("Bring to rest");
            if settle.on_hover_text("Takes the motion out until all forces balance.").clicked() {
                state.send(Command::Settle);
            }
        });
        let dark = ui.visuals().dark_mode;
        let (blue, orange) = (rgb(if dark { 0x4a_a8_e0 } else { 0x00_72_b2 }), rgb(0xe6_7a_00));
        let read = self.cursor.filter(|index| *index < exact.len());
        let spring_under_cursor = read.map(|index| (chain.springs[index], measured[index], exact[index]));
        super::beside_legend(
            ui,
            |ui, size| {
                let sheet = Sheet {
                    id: "stretch",
                    across: "spring, from the fixed end on".to_owned(),
                    upwards: "stretch (m)".to_owned(),
                    now: None,
                    size,
                };
                let bars = measured.iter().enumerate().filter(|(_, stretch)| stretch.is_finite());
                let bars =
                    bars.map(|(index, &stretch)| Bar::new(index as f64 + 1.0, stretch).width(0.6)).collect();
                let at = canvas.show(ui, sheet, |plot| {
                    plot.bar_chart(
                        BarChart::new("measured", bars)
                            .color(blue.gamma_multiply(0.75))
                            .element_formatter(Box::new(|_, _| String::new())),
                    );
                    for (index, &stretch) in exact.iter().enumerate() {
                        let ends = [index as f64 + 0.6, index as f64 + 1.4].map(|x| [x, stretch]).to_vec();
                        plot.line(
                            Line::new("formula", PlotPoints::new(ends)).stroke(Stroke::new(3.0, orange)),
                        );
                    }
                });
                self.cursor = at.map(|x| x.round()).filter(|x| *x >= 1.0).map(|x| x as usize - 1);
            },
            |ui, wide| {
                ui.horizontal(|ui| {
                    swatch(ui, blue, LineStyle::Solid, true);
                    ui.label("measured").on_hover_text("ℓ − L of each spring, now.");
                });
                ui.horizontal(|ui| {
                    swatch(ui, orange, LineStyle::Solid, true);
                    ui.label("formula").on_hover_text(
                        "Each spring carries everything below it:\nk_s (ℓ − L) = g · Σ m below",
                    );
                });
                if wide {
                    ui.label("ℓ − L = g · (Σ m below)/k_s");
                    if let Some((spring, measured, exact)) = spring_under_cursor {
                        ui.label(format!("spring {spring}:"));
                        ui.monospace(format!("measured {} m", steady(measured)));
                        ui.monospace(format!("formula  {} m", steady(exact)));
                    }
                }
            },
        );
    }

    /// The bars as a file.
    ///
    /// # Errors
    /// If the picture cannot be encoded.
    pub fn save(page: Page<'_>, chain: &Chain, format: Format) -> Result<SaveRequest> {
        let (measured, exact) = (measured(page.report, chain), formula(chain));
        if format == Format::Csv {
            let mut text = "spring,measured (m),formula (m)\n".to_owned();
            for ((spring, measured), exact) in chain.springs.iter().zip(&measured).zip(&exact) {
                text.push_str(&format!("{spring},{measured},{exact}\n"));
            }
            return Ok(save::csv(page, "stretch", text));
        }
        let curve = |name: &str, colour, style, values: &[f64]| save::Curve {
            name: name.to_owned(),
            colour,
            style,
            points: values.iter().enumerate().map(|(index, &value)| (index as f64 + 1.0, value)).collect(),
        };
        let curves = vec![
            curve("measured", 0x00_72_b2, LineStyle::Solid, &measured),
            curve("formula", 0xe6_7a_00, LineStyle::Dashed { length: 8.0 }, &exact),
        ];
        let across = "spring, from the fixed end on".to_owned();
        save::chart(page, "stretch", across, "stretch (m)".to_owned(), curves, format)
    }
}

/// ℓ − L of each spring, m, from the fixed end on.
fn measured(report: &Report, chain: &Chain) -> Vec<f64> {
    let stretch = |&spring: &usize| {
        let [i, j] =
            report.opened.model.springs()[spring].map(|end| report.now.positions[end as usize].as_dvec3());
        (i - j).length() - f64::from(report.params.spring_rest_length[spring])
    };
    chain.springs.iter().map(stretch).collect()
}

fn formula(chain: &Chain) -> Vec<f64> {
    exact::hanging_stretch(&chain.masses, &chain.stiffness, chain.g)
}
