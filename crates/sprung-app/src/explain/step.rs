//! The step as four formulas with the numbers of one spring, and a highlight that goes through them stage by stage.

use egui::{RichText, Ui};
use sprung::DVec3;
use sprung::stability::Setter;
use sprung_driver::{Command, Report};

use super::reading::{self, PointReading, SpringReading};
use super::{STAGES, Stage, StageInfo, formula};
use crate::action::Action;
use crate::state::{AppState, Pick};
use crate::text::with_minus;

/// The step's page.
#[derive(Default)]
pub struct StepPage {
    /// The spring to look at while nothing is chosen, in the scene of this number.
    suggested: Option<(u64, Option<usize>)>,
    /// Whether point j is followed through the step, not i.
    far_end: bool,
    /// The simulation was seen paused since the stages were begun.
    has_paused: bool,
}

impl StepPage {
    /// Goes to the next stage; after the last the step is taken, and the first stage of the next step follows.
    pub fn next_stage(&mut self, state: &mut AppState) {
        if state.report.playing {
            state.send(Command::Play(false));
            self.has_paused = false;
        }
        if state.selection.is_none() {
            state.selection = self.suggestion(&state.report).map(Pick::Spring);
        }
        state.explain_stage = match state.explain_stage {
            None => Some(Stage::Springs),
            Some(stage) => stage.next().or_else(|| {
                state.send(Command::Step);
                Some(Stage::Springs)
            }),
        };
    }

    /// Playing on ends the walk through the stages.
    pub fn keep_up(&mut self, state: &mut AppState) {
        if !state.report.playing {
            self.has_paused = true;
        } else if self.has_paused {
            state.explain_stage = None;
        }
        state.explain_at = match state.selection {
            Some(Pick::Point(point)) => Some(Pick::Point(point)),
            _ => self.chosen(state).map(Pick::Spring),
        };
    }

    /// The page.
    pub fn show(&mut self, ui: &mut Ui, state: &mut AppState) {
        let report = state.report.clone();
        let spring = self.chosen(state).and_then(|spring| reading::spring(&report, spring));
        self.controls(ui, state);
        ui.add_space(4.0);
        self.choose(ui, state, &report, spring.as_ref());
        let point = match (&spring, state.selection) {
            (_, Some(Pick::Point(point))) => Some(point),
            (Some(spring), _) => Some(spring.now.points[usize::from(self.far_end)]),
            (None, _) => report.opened.model.point_count().checked_sub(1),
        };
        let Some(point) = point.and_then(|point| reading::point(&report, point)) else {
            ui.label("There are no points in this scene.");
            return;
        };
        for (number, info) in STAGES.iter().enumerate() {
            let active = state.explain_stage == Some(info.stage);
            stage(ui, number + 1, info, active, |ui| match info.stage {
                Stage::Springs => springs(ui, spring.as_ref(), &point),
                Stage::Forces => forces(ui, &report, &point),
                Stage::Velocity => velocity(ui, &point),
                Stage::Position => position(ui, &point),
            });
        }
        ui.weak("i and j are the spring's two points, u the direction from j to i. All numbers are those before the step.");
    }

    fn controls(&mut self, ui: &mut Ui, state: &mut AppState) {
        ui.horizontal_wrapped(|ui| {
            let (text, hint) = match state.explain_stage {
                None => ("Go through the step", "Pauses, and goes through one step stage by stage. Key N."),
                Some(Stage::Position) => {
                    ("Take the step", "Does what the four lines say, and begins again. Key N.")
                }
                Some(_) => ("Next stage", "Goes on to the next of the four stages. Key N."),
            };
            if ui.button(text).on_hover_text(hint).clicked() {
                state.act(Action::NextStage);
            }
            if state.explain_stage.is_some()
                && ui.button("Done").on_hover_text("No highlight any more.").clicked()
            {
                state.explain_stage = None;
            }
            ui.weak(format!("step {}", state.report.now.step));
        });
    }

    /// Which spring, and which of its ends is followed.
    fn choose(&mut self, ui: &mut Ui, state: &mut AppState, report: &Report, spring: Option<&SpringReading>) {
        let Some(spring) = spring else {
            ui.label("There are no springs in this scene: only gravity, the ground and your hand.");
            return;
        };
        let count = report.opened.model.spring_count();
        ui.horizontal_wrapped(|ui| {
            let mut index = spring.spring;
            let label = ui.label("Spring");
            let number = ui
                .add(egui::DragValue::new(&mut index).range(0..=count.saturating_sub(1)))
                .labelled_by(label.id);
            if number.on_hover_text("Its number. Click on a spring in the scene to choose it.").changed() {
                state.selection = Some(Pick::Spring(index));
            }
            let owner = report.opened.model.spring_owner(spring.spring);
            ui.label(if owner.is_empty() { String::new() } else { format!("of {owner}") });
        });
        ui.horizontal_wrapped(|ui| {
            ui.label("Follow");
            for (far, name) in [(false, "i"), (true, "j")] {
                let point = spring.now.points[usize::from(far)];
                let fixed = if report.params.is_fixed(point) { ", fixed" } else { "" };
                let chosen = match state.selection {
                    Some(Pick::Point(selected)) => selected == point,
                    _ => self.far_end == far,
                };
                let end = ui.selectable_label(chosen, format!("{name} = point {point}{fixed}"));
                if end.on_hover_text("The point whose velocity and place are reckoned below.").clicked() {
                    self.far_end = far;
                    state.selection = Some(Pick::Spring(spring.spring));
                }
            }
        });
    }

    /// The chosen spring, the first at the chosen point, or the suggested one.
    fn chosen(&mut self, state: &AppState) -> Option<usize> {
        let model = &state.report.opened.model;
        match state.selection {
            Some(Pick::Spring(spring)) if spring < model.spring_count() => Some(spring),
            Some(Pick::Point(point)) if point < model.point_count() => {
                model.springs_at(point).first().map(|spring| *spring as usize)
            }
            _ => self.suggestion(&state.report),
        }
    }

    /// The spring that limits dt when the scene is first looked at, so that the choice does not jump; with its free end.
    fn suggestion(&mut self, report: &Report) -> Option<usize> {
        if let Some((serial, spring)) = self.suggested.filter(|(serial, _)| *serial == report.opened.serial) {
            debug_assert_eq!(serial, report.opened.serial);
            return spring;
        }
        let limiting = report.stability.certified.and_then(|limit| match limit.setter {
            Setter::Spring(spring) => Some(spring),
            Setter::Point(_) => None,
        });
        let springs = report.opened.model.springs();
        let spring = limiting.or(springs.len().checked_sub(1));
        self.far_end = spring
            .and_then(|spring| springs.get(spring))
            .is_some_and(|[i, _]| report.params.is_fixed(*i as usize));
        self.suggested = Some((report.opened.serial, spring));
        spring
    }
}

/// A stage: its number and name, its formula, its numbers, its meaning.
fn stage(ui: &mut Ui, number: usize, info: &StageInfo, active: bool, numbers: impl FnOnce(&mut Ui)) {
    let visuals = ui.visuals();
    let (fill, line) = if active {
        (visuals.selection.bg_fill.gamma_multiply(0.22), visuals.selection.bg_fill)
    } else {
        (visuals.faint_bg_color, visuals.widgets.noninteractive.bg_stroke.color)
    };
    let frame =
        egui::Frame::group(ui.style()).fill(fill).stroke(egui::Stroke::new(1.0, line)).inner_margin(8);
    let response = frame.show(ui, |ui| {
        ui.set_width(ui.available_width());
        let title = format!("{number}  {}{}", info.name, if active { "  ·  now" } else { "" });
        ui.label(RichText::new(title).strong()).on_hover_text(info.meaning);
        formula::show(ui, info.formula);
        egui::Grid::new(info.name).num_columns(2).spacing([8.0, 3.0]).min_col_width(70.0).show(ui, numbers);
        if active {
            ui.add_space(2.0);
            ui.label(info.meaning);
        }
    });
    if active {
        response.response.scroll_to_me(None);
    }
}

fn springs(ui: &mut Ui, spring: Option<&SpringReading>, point: &PointReading) {
    if let Some(spring) = spring {
        let SpringReading { stiffness, damping, now, .. } = *spring;
        let sprung::SpringReading { length, rest_length, stretch_rate: parting, .. } = now;
        let stretch = length - rest_length;
        line(ui, "ℓ − L", &format!("{} − {} = {} m", number(length), number(rest_length), number(stretch)));
        row(ui, "u", spring.axis, "");
        if now.is_cut {
            line(ui, "cut", "it pulls no more");
        }
        line(ui, "k_s, k_d", &format!("{} N/m, {} N·s/m", number(stiffness), number(damping)));
        line(ui, "(v_i − v_j)·u", &format!("{} m/s", number(parting)));
        row(ui, "spring on i", spring.spring_force(), "N");
        row(ui, "damper on i", spring.damper_force(), "N");
    }
    let (count, plural) = (point.spring_count, if point.spring_count == 1 { "" } else { "s" });
    row(ui, &format!("{count} spring{plural}"), point.force("spring"), "N");
}

fn forces(ui: &mut Ui, report: &Report, point: &PointReading) {
    row(ui, "m g", point.force("gravity"), "N");
    if !report.params.planes.is_empty() {
        row(ui, "ground", point.force("contact"), "N");
    }
    for name in ["external", "grab"] {
        let force = point.force(name);
        if force != DVec3::ZERO {
            row(ui, if name == "grab" { "hand" } else { "outer" }, force, "N");
        }
    }
    row(ui, "f, all", point.now.total_force, "N");
}

fn velocity(ui: &mut Ui, point: &PointReading) {
    if point.now.is_fixed {
        line(ui, "fixed", "forces do not move it");
    } else {
        let text = format!("{} kg, dt = {} s", number(point.now.mass), sprung::significant(point.dt));
        line(ui, "m", &text);
        row(ui, "(f/m) dt", point.gain(), "m/s");
    }
    row(ui, "v before", point.now.velocity, "m/s");
    row(ui, "v after", point.new_velocity(), "m/s");
}

fn position(ui: &mut Ui, point: &PointReading) {
    row(ui, "v dt", point.new_velocity() * point.dt, "m");
    row(ui, "x before", point.now.position, "m");
    row(ui, "x after", point.new_position(), "m");
}

/// A vector with its name and unit.
fn row(ui: &mut Ui, name: &str, vector: DVec3, unit: &str) {
    let [x, y, z] = vector.to_array().map(component);
    line(ui, name, format!("({x}, {y}, {z}) {unit}").trim_end());
}

fn line(ui: &mut Ui, name: &str, value: &str) {
    let colour = ui.visuals().weak_text_color();
    let size = egui::TextStyle::Body.resolve(ui.style()).size;
    ui.label(formula::job(name, size, colour));
    ui.label(RichText::new(value).monospace().size(0.9 * size));
    ui.end_row();
}

/// A component of a vector: always seven letters, unless it is huge, so that nothing jumps.
fn component(value: f64) -> String {
    let size = value.abs();
    with_minus(if !value.is_finite() {
        format!("{:>7}", "—")
    } else if size < 5e-5 {
        format!("{:>7}", "0")
    } else if size < 0.9999 {
        format!("{value:7.4}")
    } else if size < 99.99 {
        format!("{value:7.3}")
    } else if size < 9999.0 {
        format!("{value:7.1}")
    } else if size < 999_999.0 {
        format!("{value:7.0}")
    } else {
        format!("{value:7.1e}")
    })
}

/// A single number with its sign.
fn number(value: f64) -> String {
    if !value.is_finite() {
        return "—".to_owned();
    }
    with_minus(if value.abs() < 5e-6 {
        "0".to_owned()
    } else {
        sprung::significant((value * 1e5).round() / 1e5)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_keep_their_width() {
        for value in [0.0, 1.0, -0.5, 0.001, -12.25, 999.0, -9810.0, f64::NAN, 1e-9] {
            assert_eq!(component(value).chars().count(), 7, "{value}");
        }
        assert_eq!([component(-12.25), component(1e20)], ["−12.250".to_owned(), " 1.0e20".to_owned()]);
        assert_eq!([number(-0.2), number(1e-9), number(f64::INFINITY)], ["−0.2", "0", "—"]);
    }
}
