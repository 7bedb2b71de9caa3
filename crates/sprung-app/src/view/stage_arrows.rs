//! The stage of the step that is being explained, at the points it is explained at: forces, then all forces together,
//! then the new velocity, then the way that the point goes.

use egui::{Color32, Label, Pos2, Rect, RichText, Stroke, Ui, UiBuilder, Vec2, vec2};
use sprung::{DVec3, Vec3};
use sprung_driver::Report;
use sprung_render::camera::Camera;

use super::overlay::{force_ink, plate, velocity_ink};
use crate::explain::{Stage, reading};
use crate::state::{AppState, Pick};
use crate::text::steady;

/// Length of the longest arrow, points of the window.
const LENGTH: f64 = 80.0;
/// How far beside the spring its two forces are drawn: they point at each other, or away from each other.
const ASIDE: f32 = 7.0;
/// From an arrow's end to its label.
const GAP: f32 = 14.0;
/// Size of a label, at most.
const LABEL: Vec2 = vec2(360.0, 24.0);

/// An arrow in the scene.
#[derive(Clone, Debug, PartialEq)]
struct Arrow {
    /// Where it begins, m.
    from: Vec3,
    /// What it shows, in `unit`.
    vector: DVec3,
    /// What that is called: "all forces on i".
    name: String,
    /// The unit that `vector` has.
    unit: &'static str,
    /// The point is fixed, so that velocity and way are none.
    is_fixed: bool,
}

impl Arrow {
    fn text(&self) -> String {
        let about = if self.is_fixed { ", fixed" } else { "" };
        format!("{}: {} {}{about}", self.name, steady(self.vector.length()), self.unit)
    }
}

/// Draws the stage's arrows with their labels.
pub fn show(ui: &mut Ui, view: Rect, state: &AppState, camera: &Camera) {
    let (Some(stage), Some(at)) = (state.explain_stage, state.explain_at) else { return };
    let arrows = arrows(&state.report, stage, at);
    let longest = arrows.iter().map(|arrow| arrow.vector.length()).fold(0.0, f64::max);
    let ink = match stage {
        Stage::Springs | Stage::Forces => force_ink(ui),
        Stage::Velocity | Stage::Position => velocity_ink(ui),
    };
    let mut taken: Vec<Rect> = Vec::new();
    for arrow in &arrows {
        let Some(begin) = camera.project(arrow.from) else { continue };
        // As long as seen at the point's own distance; one that points to the eye is short, as it should be.
        let metres_per_point = f64::from(begin.depth / camera.focal);
        let factor = LENGTH * metres_per_point / longest.max(1e-30);
        let way = arrow.vector * factor;
        let end = camera.project(arrow.from + way.as_vec3()).map_or(begin.pixel, |end| end.pixel);
        let on_screen = |pixel: glam::Vec2| view.min + vec2(pixel.x, pixel.y);
        let (mut begin, mut end) = (on_screen(begin.pixel), on_screen(end));
        if stage == Stage::Springs {
            let aside = (end - begin).normalized().rot90() * ASIDE;
            (begin, end) = (begin + aside, end + aside);
        }
        if (end - begin).length() > 1.0 {
            // A rim in the background's colour, so that it is seen over anything.
            let rim = ui.visuals().panel_fill.gamma_multiply(0.7);
            ui.painter().with_clip_rect(view).arrow(begin, end - begin, Stroke::new(6.0, rim));
            ui.painter().with_clip_rect(view).arrow(begin, end - begin, Stroke::new(3.0, ink));
        }
        let mut text = arrow.text();
        if stage == Stage::Position && longest > 0.0 {
            text += &format!(", drawn {} times as long", sprung::significant(factor.round()));
        }
        label(ui, view, (begin, end), (&text, ink), &mut taken);
    }
}

/// The arrows of a stage: with the numbers that the page about the step shows.
fn arrows(report: &Report, stage: Stage, at: Pick) -> Vec<Arrow> {
    let spring = match at {
        Pick::Spring(spring) => reading::spring(report, spring),
        Pick::Point(_) => None,
    };
    let points: Vec<(usize, &str)> = match (&spring, at) {
        (Some(spring), _) => spring.now.points.into_iter().zip(["i", "j"]).collect(),
        (None, Pick::Point(point)) => vec![(point, "it")],
        (None, Pick::Spring(_)) => Vec::new(),
    };
    let blend = report.blend as f32;
    let arrow = |(point, called): (usize, &str)| {
        let read = reading::point(report, point)?;
        let (before, now) = (report.before.positions.get(point)?, report.now.positions.get(point)?);
        let of_spring = spring.as_ref().map(|spring| spring.spring_force() + spring.damper_force());
        let (vector, name, unit) = match (stage, of_spring) {
            // Point j gets exactly the opposite.
            (Stage::Springs, Some(force)) => {
                (if called == "j" { -force } else { force }, "spring and damper on", "N")
            }
            (Stage::Springs, None) => (read.force("spring"), "all springs on", "N"),
            (Stage::Forces, _) => (read.now.total_force, "all forces on", "N"),
            (Stage::Velocity, _) => (read.new_velocity(), "new velocity of", "m/s"),
            (Stage::Position, _) => (read.new_velocity() * read.dt, "way in this step of", "m"),
        };
        let moves = matches!(stage, Stage::Velocity | Stage::Position);
        let (from, name) = (before.lerp(*now, blend), format!("{name} {called}"));
        Some(Arrow { from, vector, name, unit, is_fixed: moves && read.now.is_fixed })
    };
    let arrows: Vec<Arrow> = points.into_iter().filter_map(arrow).collect();
    let is_finite = |arrow: &Arrow| arrow.vector.is_finite() && arrow.from.is_finite();
    arrows.into_iter().filter(is_finite).collect()
}

/// A label beyond an arrow's end, inside the view and clear of those before.
fn label(
    ui: &mut Ui,
    view: Rect,
    (begin, end): (Pos2, Pos2),
    (text, ink): (&str, Color32),
    taken: &mut Vec<Rect>,
) {
    let text = RichText::new(text).size(12.5).color(ink);
    let label = Label::new(text.clone()).selectable(false).extend();
    let font = egui::FontId::proportional(12.5);
    let width = ui.painter().layout_no_wrap(text.text().to_owned(), font, ink).size().x + 18.0;
    let size = vec2(width.min(LABEL.x), LABEL.y);
    let along = (end - begin).normalized();
    let middle =
        end + vec2(along.x * (GAP + 0.5 * size.x), along.y * GAP + if along.y < 0.0 { -6.0 } else { 6.0 });
    let mut rect = Rect::from_center_size(middle, size);
    rect = rect.translate((view.min - rect.min).max(Vec2::ZERO));
    rect = rect.translate((view.max - rect.max).min(Vec2::ZERO));
    while let Some(other) = taken.iter().find(|other| other.intersects(rect)) {
        rect = rect.translate(vec2(0.0, other.max.y + 2.0 - rect.min.y));
    }
    taken.push(rect);
    ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| plate(ui).show(ui, |ui| ui.add(label)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explain::STAGES;
    use sprung::scene::Scene;
    use sprung_driver::{Command, Driver, Handle, Source};

    /// A scene, some frames after its start.
    fn moving(name: &str) -> Handle {
        let scene = Scene::builtin(name).expect("it is built in");
        let driver = Driver::new(Source { name: name.to_owned(), scene }).expect("it can be built");
        let mut driver = Handle::inline(driver);
        (0..5).for_each(|_| driver.send(Command::Frame));
        driver
    }

    #[test]
    fn the_ends_of_a_spring_are_pulled_in_opposite_directions() {
        let report = moving("chain").report();
        let [i, j] = &arrows(&report, Stage::Springs, Pick::Spring(5))[..] else { panic!("two ends") };
        assert!(i.vector.length() > 0.0 && i.vector == -j.vector, "{i:?} {j:?}");
    }

    #[test]
    fn every_stage_has_its_arrow_at_a_point_and_at_both_ends_of_a_spring() {
        let report = moving("chain").report();
        for info in &STAGES {
            assert_eq!(arrows(&report, info.stage, Pick::Point(7)).len(), 1);
            assert_eq!(arrows(&report, info.stage, Pick::Spring(7)).len(), 2);
            assert!(arrows(&report, info.stage, Pick::Point(usize::MAX)).is_empty());
            assert!(arrows(&report, info.stage, Pick::Spring(usize::MAX)).is_empty());
        }
    }

    #[test]
    fn the_way_is_the_one_that_the_next_step_goes() {
        let mut driver = moving("spring");
        let before = driver.report();
        let way = &arrows(&before, Stage::Position, Pick::Point(1))[0];
        driver.send(Command::Step);
        let after = driver.report();
        let went = after.now.positions[1] - before.now.positions[1];
        assert!((went.as_dvec3() - way.vector).length() < 1e-5, "{went} instead of {}", way.vector);
    }
}
