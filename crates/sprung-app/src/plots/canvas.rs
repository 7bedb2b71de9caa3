//! The area that curves are drawn in: zoom, fit, the line of the current time, and what the cursor points at.

use egui::{Color32, Stroke, Ui};
use egui_plot::{LineStyle, Plot, PlotPoint, PlotUi, VLine};

use crate::text::with_minus;

/// Points of one curve that are drawn at the most: more than there are pixels.
const MOST_POINTS: usize = 1600;

/// What was asked of the plot by its buttons, until it is drawn.
#[derive(Clone, Copy, Debug, Default)]
pub struct Canvas {
    /// Show everything again.
    pub fit: bool,
    /// Zoom by this factor about the middle.
    pub zoom: Option<f32>,
}

/// How a plot is labelled, and where it is.
pub struct Sheet<'a> {
    /// A name for egui, unique among plots.
    pub id: &'a str,
    /// What runs to the right.
    pub across: String,
    /// What runs upwards.
    pub upwards: String,
    /// The current time, if that is what runs to the right, s.
    pub now: Option<f64>,
    /// Width and height.
    pub size: egui::Vec2,
}

impl Canvas {
    /// Draws the plot; answers where across it the cursor is, if it is on the plot.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        sheet: Sheet<'_>,
        build: impl FnOnce(&mut PlotUi<'_>),
    ) -> Option<f64> {
        let asked = std::mem::take(self);
        let ink = ui.visuals().text_color();
        // In a small plot the curve needs the room; the labels come back when it is made larger.
        let has_room = sheet.size.y >= 120.0;
        let [across, upwards] =
            [sheet.across, sheet.upwards].map(|label| if has_room { label } else { String::new() });
        let response = Plot::new(sheet.id)
            .width(sheet.size.x.max(80.0))
            .height(sheet.size.y.max(60.0))
            .x_axis_label(across)
            .y_axis_label(upwards)
            // Wide enough for any number that is written, so that the plot does not move when numbers grow.
            .y_axis_min_width(58.0)
            .y_axis_formatter(|mark, _| short(mark.value))
            .x_axis_formatter(|mark, _| short(mark.value))
            .label_formatter(|_| None)
            .show(ui, |plot| {
                if asked.fit {
                    plot.set_auto_bounds(true);
                }
                if let Some(factor) = asked.zoom {
                    let middle = plot.plot_bounds().center();
                    plot.zoom_bounds(egui::Vec2::splat(factor), middle);
                }
                build(plot);
                if let Some(now) = sheet.now.filter(|now| now.is_finite()) {
                    plot.vline(VLine::new("now", now).stroke(Stroke::new(1.0, ink.gamma_multiply(0.6))));
                }
                plot.response().hovered().then(|| plot.pointer_coordinate()).flatten()
            });
        response.inner.map(|cursor: PlotPoint| cursor.x)
    }
}

/// A number for an axis: at most seven letters, without noise from rounding.
pub fn short(value: f64) -> String {
    let size = value.abs();
    with_minus(if value == 0.0 || size < 1e-12 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&size) {
        let rounded = format!("{value:.4}");
        let trimmed = rounded.trim_end_matches('0').trim_end_matches('.');
        if size >= 1e3 { format!("{value:.0}") } else { trimmed.to_owned() }
    } else {
        format!("{value:.1e}")
    })
}

/// A curve without what is not finite, of at most some 1,600 points: of each stretch the lowest and the highest, so that no
/// peak is lost.
pub fn thinned(curve: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let points: Vec<[f64; 2]> = curve.filter(|point| point.iter().all(|value| value.is_finite())).collect();
    if points.len() <= MOST_POINTS {
        return points;
    }
    let mut kept = Vec::with_capacity(MOST_POINTS + 2);
    for stretch in points.chunks(points.len().div_ceil(MOST_POINTS / 2)) {
        let by_height = |a: &usize, b: &usize| stretch[*a][1].total_cmp(&stretch[*b][1]);
        let lowest = (0..stretch.len()).min_by(by_height).unwrap_or(0);
        let highest = (0..stretch.len()).max_by(by_height).unwrap_or(0);
        kept.push(stretch[lowest.min(highest)]);
        kept.push(stretch[lowest.max(highest)]);
    }
    kept
}

/// Every so-many-th of some samples, and the last: for areas, which must all bend at the same times.
pub fn sparse<T: Copy>(samples: &[T]) -> Vec<T> {
    let every = samples.len().div_ceil(MOST_POINTS / 4).max(1);
    let mut kept: Vec<T> = samples.iter().step_by(every).copied().collect();
    if let Some(last) = samples.last().filter(|_| !(samples.len() - 1).is_multiple_of(every)) {
        kept.push(*last);
    }
    kept
}

/// A short piece of line as the legend shows it.
pub fn swatch(ui: &mut Ui, colour: Color32, style: LineStyle, shown: bool) {
    let (rect, _) = ui.allocate_exact_size(egui::vec2(24.0, 12.0), egui::Sense::hover());
    let colour = if shown { colour } else { ui.visuals().weak_text_color().gamma_multiply(0.5) };
    let ends = [rect.left_center(), rect.right_center()];
    let stroke = Stroke::new(2.0, colour);
    match style {
        LineStyle::Solid => {
            ui.painter().line_segment(ends, stroke);
        }
        LineStyle::Dashed { .. } => {
            ui.painter().extend(egui::Shape::dashed_line(&ends, stroke, 6.0, 3.0));
        }
        LineStyle::Dotted { .. } => {
            ui.painter().extend(egui::Shape::dotted_line(&ends, colour, 5.0, 1.5));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_stay_so() {
        assert_eq!(
            [0.0, 0.1 + 0.2, -2.5, 12_345.6, 4e7, 2e-5].map(short),
            ["0", "0.3", "−2.5", "12346", "4.0e7", "2.0e−5"]
        );
    }

    #[test]
    fn thinning_keeps_peaks_and_drops_what_is_not_a_number() {
        let curve = |count: u32, peak: u32| {
            (0..count).map(move |i| [f64::from(i), if i == peak { 9.0 } else { 0.0 }])
        };
        let kept = thinned(curve(40_000, 31_234));
        assert!(kept.len() <= MOST_POINTS + 2 && kept.contains(&[31_234.0, 9.0]));
        assert!(kept.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
        assert_eq!(thinned([[0.0, f64::NAN], [1.0, 2.0], [f64::INFINITY, 0.0]].into_iter()), [[1.0, 2.0]]);
        assert!(thinned(std::iter::empty()).is_empty());
    }

    #[test]
    fn sparse_keeps_both_ends() {
        for count in [0, 1, 2, 399, 400, 401, 5000] {
            let all: Vec<usize> = (0..count).collect();
            let kept = sparse(&all);
            assert!(kept.len() <= 402);
            assert_eq!((kept.first(), kept.last()), (all.first(), all.last()));
        }
    }
}
