//! A mass on a spring beside its formula: up and down for any size of the motion, to the side for small ones.

use egui::Ui;
use egui_plot::{Line, LineStyle, MarkerShape, PlotPoints, Points};
use sprung::{Change, DVec3, Result};
use sprung_driver::{Command, Edit, Probe, Report, Sample};

use super::canvas::{self, Canvas, Sheet, swatch};
use super::exact::{self, Damped};
use super::save::{self, Format};
use super::shape::Oscillator;
use super::{Page, value};
use crate::media::SaveRequest;
use crate::state::AppState;
use crate::text::{steady, with_minus};
use crate::theme::rgb;

/// A motion that leaves the vertical by less than this part of the length counts as vertical.
const UPRIGHT: f64 = 1e-3;
/// Up to this part of the length a motion counts as small: the formula's error is of the order of its square.
const SMALL: f64 = 0.12;

/// Which formula holds from some moment on.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Regime {
    /// Exactly up and down: the formula holds for any size.
    Vertical,
    /// A small motion in any direction: along the spring and to the side do not disturb each other.
    Small,
    /// Too large, by this part of the length.
    TooLarge(f64),
}

/// The motion measured from where the mass would hang at rest.
#[derive(Clone, Copy, Debug)]
struct Moment {
    time: f64,
    /// Below the resting place, m, and its rate, m/s.
    along: (f64, f64),
    /// To the side, m, and its rate, m/s.
    aside: (DVec3, DVec3),
}

/// Motion and formula from one undisturbed moment on.
struct Fit {
    regime: Regime,
    moments: Vec<Moment>,
    /// The direction to the side in which it swings.
    side: DVec3,
    /// Whether it swings to the side more than up and down.
    is_swing: bool,
}

/// The plot of the oscillation.
#[derive(Default)]
pub struct Oscillation {
    /// The step from which on nothing has disturbed the motion, in this scene.
    from: u64,
    serial: u64,
    /// The time the cursor was at in the last frame, s.
    cursor: Option<f64>,
    /// The parameters and the first step for which `from` holds.
    seen: Option<(std::sync::Arc<sprung::Params>, u64)>,
}

impl Oscillation {
    /// What must be recorded: place and velocity of the mass.
    pub fn probes(oscillator: &Oscillator) -> Vec<Probe> {
        let bob = oscillator.bob;
        (0..3)
            .map(|axis| Probe::Position(bob, axis))
            .chain((0..3).map(|axis| Probe::Velocity(bob, axis)))
            .collect()
    }

    /// The plot, and the buttons that start motions for which the formula holds.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        state: &mut AppState,
        page: Page<'_>,
        oscillator: &Oscillator,
        canvas: &mut Canvas,
    ) {
        let report = page.report;
        let Some(down) = oscillator.down() else {
            ui.label("Without gravity there is no place to hang at. Switch gravity on to compare with the formula.");
            return;
        };
        let fit = self.fit(page, oscillator, down);
        ui.horizontal_wrapped(|ui| {
            self.buttons(ui, state, report, oscillator, down);
            ui.label(explanation(&fit, oscillator));
        });
        let dark = ui.visuals().dark_mode;
        let curves = curves(&fit, oscillator, dark);
        let crossings = crossings(&fit);
        let marks: Vec<[f64; 2]> = crossings.iter().map(|time| [*time, 0.0]).collect();
        let at = self.cursor.unwrap_or(report.now.time);
        let mut cursor = None;
        super::beside_legend(
            ui,
            |ui, size| {
                let sheet = Sheet {
                    id: "oscillation",
                    across: "time (s)".to_owned(),
                    upwards: "from where it would hang (m)".to_owned(),
                    now: Some(report.now.time),
                    size,
                };
                cursor = canvas.show(ui, sheet, |plot| {
                    for (curve, colour) in &curves {
                        let points = canvas::thinned(curve.points.iter().map(|(x, y)| [*x, *y]));
                        let line = Line::new(curve.name.clone(), PlotPoints::new(points));
                        plot.line(line.color(*colour).style(curve.style).width(2.0));
                    }
                    let marks =
                        Points::new("crossings", PlotPoints::new(marks)).shape(MarkerShape::Up).radius(4.5);
                    plot.points(marks.color(rgb(0xe6_9f_00)));
                });
            },
            |ui, wide| {
                if wide {
                    ui.weak(format!("at t = {at:.3} s, in m"));
                }
                for (curve, colour) in &curves {
                    ui.horizontal(|ui| {
                        swatch(ui, *colour, curve.style, true);
                        ui.label(&curve.name);
                        if let Some(value) = value_at(&curve.points, at).filter(|_| wide) {
                            let right = egui::Layout::right_to_left(egui::Align::Center);
                            ui.with_layout(right, |ui| ui.monospace(steady(value)));
                        }
                    });
                }
                let motion = if fit.is_swing { oscillator.sideways() } else { oscillator.along() };
                period(ui, &crossings, motion, fit.is_swing, wide);
            },
        );
        self.cursor = cursor;
    }

    /// The curves as a file; `None` without gravity, as there is no place to measure from.
    ///
    /// # Errors
    /// If the picture cannot be encoded.
    pub fn save(
        &self,
        page: Page<'_>,
        oscillator: &Oscillator,
        format: Format,
    ) -> Result<Option<SaveRequest>> {
        let Some(down) = oscillator.down() else { return Ok(None) };
        let fit = self.fit(page, oscillator, down);
        let curves: Vec<save::Curve> =
            curves(&fit, oscillator, false).into_iter().map(|(curve, _)| curve).collect();
        if format == Format::Csv {
            let header: Vec<String> = curves.iter().map(|curve| format!("{} (m)", curve.name)).collect();
            let rows: Vec<(f64, Vec<f64>)> = (0..fit.moments.len())
                .map(|row| (fit.moments[row].time, curves.iter().map(|curve| curve.points[row].1).collect()))
                .collect();
            return Ok(Some(save::rows(page, "oscillation", &header, &rows)));
        }
        let upwards = "from where it would hang (m)".to_owned();
        save::chart(page, "oscillation", "time (s)".to_owned(), upwards, curves, format).map(Some)
    }

    /// Whatever changes parameters or places starts the comparison anew.
    pub fn notice_disturbance(&mut self, report: &Report) {
        let newest_mark = report.timeline.marks.last().map_or(0, |(step, _)| *step);
        let changed = self.seen.as_ref().is_none_or(|(params, mark)| {
            *mark != newest_mark
                || (!std::sync::Arc::ptr_eq(params, &report.params) && **params != *report.params)
        });
        let other_scene = self.serial != report.opened.serial;
        self.serial = report.opened.serial;
        if other_scene || report.now.step < self.from {
            self.from = newest_mark.min(report.now.step);
        } else if changed || report.pull.is_some() {
            self.from = if self.seen.is_none() { newest_mark } else { report.now.step };
        }
        self.seen = Some((report.params.clone(), newest_mark));
    }

    fn fit(&self, Page { report, samples }: Page<'_>, oscillator: &Oscillator, down: DVec3) -> Fit {
        let anchor = report.now.positions[oscillator.anchor].as_dvec3();
        let recorded: Vec<Moment> = samples
            .iter()
            .filter(|sample| sample.step > self.from || (self.from == 0 && sample.step == 0))
            .filter_map(|sample| moment(sample, oscillator, anchor, down))
            .collect();
        // A point that was put elsewhere at once begins a new motion.
        let jumps = recorded.windows(2).rposition(|pair| is_jump(&pair[0], &pair[1], oscillator.length()));
        let moments = recorded[jumps.map_or(0, |jump| jump + 1)..].to_vec();
        let Some(first) = moments.first() else {
            return Fit { regime: Regime::Vertical, moments, side: DVec3::ZERO, is_swing: false };
        };
        let length = oscillator.length();
        let amplitude = |(place, rate): (f64, f64), omega: f64| place.hypot(rate / omega) / length;
        let aside = amplitude((first.aside.0.length(), first.aside.1.length()), oscillator.sideways().omega);
        let along = amplitude(first.along, oscillator.along().omega);
        let regime = match aside.max(along) {
            _ if aside < UPRIGHT && along < 1.0 => Regime::Vertical,
            size if size < SMALL => Regime::Small,
            size => Regime::TooLarge(size),
        };
        let side =
            if first.aside.0.length() > first.aside.1.length() { first.aside.0 } else { first.aside.1 };
        let is_swing = regime == Regime::Small && aside > along;
        Fit { regime, side: side.normalize_or_zero(), is_swing, moments }
    }

    fn buttons(
        &self,
        ui: &mut Ui,
        state: &mut AppState,
        report: &Report,
        oscillator: &Oscillator,
        down: DVec3,
    ) {
        let anchor = report.now.positions[oscillator.anchor].as_dvec3();
        let length = oscillator.length();
        let mut place = |label: &str, place: DVec3| {
            state.edit(Edit::new(label, vec![Change::Place(oscillator.bob, place.as_vec3())]));
            state.send(Command::Play(true));
        };
        let straight = ui.small_button("Pull straight down and let go");
        if straight
            .on_hover_text("Up and down only: the formula holds for any size of this motion.")
            .clicked()
        {
            place("pull straight down", anchor + down * (1.3 * length));
        }
        let aside = ui.small_button("A small swing");
        if aside.on_hover_text("Hangs it 4° to the side and lets go: a pendulum.").clicked() {
            let side = down.any_orthonormal_vector();
            // In the plane of the screen, where gravity is as usual.
            let side = if down.x.abs() < 0.9 { (DVec3::X - down * down.x).normalize_or(side) } else { side };
            place("a small swing", anchor + length * (down * 0.07_f64.cos() + side * 0.07_f64.sin()));
        }
    }
}

/// A sample as seen from where the mass would hang; `None` if place and velocity were not recorded or are not finite.
fn moment(sample: &Sample, oscillator: &Oscillator, anchor: DVec3, down: DVec3) -> Option<Moment> {
    let vector = |probe: fn(usize, usize) -> Probe| {
        let component = |axis| value(sample, probe(oscillator.bob, axis));
        Some(DVec3::new(component(0)?, component(1)?, component(2)?)).filter(|vector| vector.is_finite())
    };
    let (place, rate) = (vector(Probe::Position)? - anchor, vector(Probe::Velocity)?);
    let along = (place.dot(down) - oscillator.length(), rate.dot(down));
    Some(Moment {
        time: sample.time,
        along,
        aside: (place - down * place.dot(down), rate - down * rate.dot(down)),
    })
}

/// Whether the place has changed by much more than the velocity explains.
fn is_jump(before: &Moment, after: &Moment, length: f64) -> bool {
    let half = 0.5 * (after.time - before.time);
    let along = after.along.0 - before.along.0 - half * (before.along.1 + after.along.1);
    let aside = after.aside.0 - before.aside.0 - half * (before.aside.1 + after.aside.1);
    along.hypot(aside.length()) > 0.02 * length
}

fn explanation(fit: &Fit, oscillator: &Oscillator) -> String {
    if fit.moments.is_empty() {
        return "Recording from now on.".to_owned();
    }
    match fit.regime {
        Regime::Vertical => {
            "Straight up and down: the formula is exact for any size of the motion.".to_owned()
        }
        Regime::Small => {
            "A small motion: along the spring it is a damped oscillator, to the side a pendulum of length ℓ."
                .to_owned()
        }
        Regime::TooLarge(size) => format!(
            "The motion is {:.0} % of the length {} m at rest: too large for the formulas, which hold straight up and down, \
             or up to {:.0} %.",
            100.0 * size,
            steady(oscillator.length()),
            100.0 * SMALL
        ),
    }
}

/// Measured and exact curves, those along the spring first. Positive is up, and to the side.
fn curves(fit: &Fit, oscillator: &Oscillator, dark: bool) -> Vec<(save::Curve, egui::Color32)> {
    let (along, aside) = (oscillator.along(), oscillator.sideways());
    let looks: [[u32; 2]; 2] = [[0x00_72_b2, 0x4a_a8_e0], [0xd5_5e_00, 0xee_7b_1e]];
    let mut curves = Vec::new();
    let mut push = |name: &str, look: usize, exact: bool, of: &dyn Fn(&Moment) -> f64| {
        // Formulas are dashed in ink, on top of the measured line.
        let ink = [0x22_2b_36, 0xf2_f2_f2];
        let colours = if exact { ink } else { looks[look] };
        let style = if exact { LineStyle::Dashed { length: 7.0 } } else { LineStyle::Solid };
        let points = fit.moments.iter().map(|moment| (moment.time, of(moment))).collect();
        let curve = save::Curve { name: name.to_owned(), colour: colours[0], style, points };
        curves.push((curve, rgb(colours[usize::from(dark)])));
    };
    let Some(first) = fit.moments.first() else { return curves };
    let side = fit.side;
    push("up and down", 0, false, &|moment| -moment.along.0);
    if fit.regime != Regime::Vertical {
        push("to the side", 1, false, &|moment| moment.aside.0.dot(side));
    }
    if !matches!(fit.regime, Regime::TooLarge(_)) {
        let (x, v) = first.along;
        push("formula", 0, true, &|moment| -along.after(x, v, moment.time - first.time).0);
    }
    if fit.regime == Regime::Small {
        let (x, v) = (first.aside.0.dot(side), first.aside.1.dot(side));
        push("formula, to the side", 1, true, &|moment| aside.after(x, v, moment.time - first.time).0);
    }
    curves
}

/// The value of a curve at a time, or just before it.
fn value_at(points: &[(f64, f64)], time: f64) -> Option<f64> {
    let after = points.partition_point(|point| point.0 <= time);
    points.get(after.saturating_sub(1)).map(|point| point.1)
}

/// When it passed its resting place on the way up, or its lowest place on the way to one side.
fn crossings(fit: &Fit) -> Vec<f64> {
    let place = |moment: &Moment| if fit.is_swing { moment.aside.0.dot(fit.side) } else { -moment.along.0 };
    let curve: Vec<(f64, f64)> = fit.moments.iter().map(|moment| (moment.time, place(moment))).collect();
    exact::rising_crossings(&curve)
}

/// The period: measured between crossings, and by the formula.
fn period(ui: &mut Ui, crossings: &[f64], motion: Damped, is_swing: bool, wide: bool) {
    let formula = motion.period();
    let measured: Vec<f64> = crossings.windows(2).map(|pair| pair[1] - pair[0]).collect();
    ui.add_space(if wide { 6.0 } else { 0.0 });
    ui.label("period T").on_hover_text(if is_swing {
        "Of a pendulum of length ℓ: T = 2π/√(g/ℓ).\nMeasured between the marked crossings."
    } else {
        "T = 2π/√(ω² − (c/2)²) with ω² = k_s/m and c = k_d/m.\nMeasured between the marked crossings on the way up."
    });
    match formula {
        Some(period) => ui.monospace(format!("formula  {period:.4} s")),
        None => ui.label("so much damping that it creeps: none"),
    };
    let latest = if wide { 5 } else { 1 };
    for (number, period) in measured.iter().enumerate().skip(measured.len().saturating_sub(latest)) {
        let off =
            formula.map_or(String::new(), |formula| format!(" {:+.2} %", 100.0 * (period / formula - 1.0)));
        ui.monospace(format!("{:>2}.      {period:.4} s{}", number + 1, with_minus(off)));
    }
    if measured.is_empty() {
        ui.weak("measured after two crossings");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plots::shape::{self, Shape};
    use sprung::Vec3;
    use sprung::scene::Scene;

    fn scene() -> (Oscillator, DVec3) {
        let (model, params, _) = Scene::builtin("spring").expect("it is there").build().expect("it builds");
        let Some(Shape::Oscillator(oscillator)) = shape::recognise(&model, &params) else {
            panic!("the scene is an oscillator")
        };
        let down = oscillator.down().expect("there is gravity");
        (oscillator, down)
    }

    fn sample(step: u64, place: Vec3, rate: Vec3) -> Sample {
        let values = (0..3)
            .flat_map(|axis| {
                [
                    (Probe::Position(1, axis), f64::from(place[axis])),
                    (Probe::Velocity(1, axis), f64::from(rate[axis])),
                ]
            })
            .collect();
        Sample { step, time: 0.01 * step as f64, energy: Default::default(), values }
    }

    #[test]
    fn moments_are_measured_from_the_resting_place() {
        let (oscillator, down) = scene();
        let found = moment(
            &sample(3, Vec3::new(0.5, -15.0, 0.0), Vec3::new(1.0, 2.0, 0.0)),
            &oscillator,
            DVec3::ZERO,
            down,
        )
        .expect("all of it was recorded");
        assert!((found.along.0 - (15.0 - 14.81)).abs() < 1e-6 && (found.along.1 + 2.0).abs() < 1e-12);
        assert!((found.aside.0 - DVec3::new(0.5, 0.0, 0.0)).length() < 1e-12);
        assert!(moment(&sample(3, Vec3::NAN, Vec3::ZERO), &oscillator, DVec3::ZERO, down).is_none());
        let empty = Sample { values: Vec::new(), ..sample(0, Vec3::ZERO, Vec3::ZERO) };
        assert!(moment(&empty, &oscillator, DVec3::ZERO, down).is_none());
    }
}
