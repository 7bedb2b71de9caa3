//! What is told of a point or a spring: for the tooltip and the box of the selection.

use sprung::{PointReading, SpringReading};
use sprung_driver::Report;

use crate::state::Pick;
use crate::text::steady;

/// A title and lines of a quantity, its value and its unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reading {
    /// What it is: "point 3 of jelly".
    pub title: String,
    /// Whether it is fixed or cut, in a word.
    pub remark: Option<&'static str>,
    /// Quantity, value with its unit.
    pub lines: Vec<(&'static str, String)>,
}

impl Reading {
    /// Reads off the newest step; `None` for what the model does not have.
    pub fn of(report: &Report, pick: Pick) -> Option<Self> {
        let (model, params, now) = (&report.opened.model, &report.params, &*report.now);
        match pick {
            Pick::Point(point) => {
                let read = PointReading::of(model, params, now, point)?;
                let remark = read.is_fixed.then(|| {
                    let is_carried = params.carried.contains_key(&point);
                    if is_carried { "carried by the hand" } else { "fixed in space" }
                });
                let lines = vec![
                    ("mass", with_unit(read.mass, "kg")),
                    ("position", vector(read.position.to_array(), "m")),
                    ("speed", with_unit(read.velocity.length(), "m/s")),
                    ("force", with_unit(read.total_force.length(), "N")),
                ];
                Some(Self { title: title(report, pick), remark, lines })
            }
            Pick::Spring(spring) => {
                let read = SpringReading::of(model, params, now, spring)?;
                let strain = read.strain.map_or("none".to_owned(), |strain| with_unit(100.0 * strain, "%"));
                let lines = vec![
                    ("length", with_unit(read.length, "m")),
                    ("rest length", with_unit(read.rest_length, "m")),
                    ("strain", strain),
                    ("tension", with_unit(read.spring_force, "N")),
                    ("damper", with_unit(read.damper_force, "N")),
                    ("energy", with_unit(read.energy, "J")),
                ];
                let remark = read.is_cut.then_some("cut");
                Some(Self { title: title(report, pick), remark, lines })
            }
        }
    }
}

/// What to call a point or a spring: by its index in the model, and the body or joint it belongs to.
pub fn title(report: &Report, pick: Pick) -> String {
    let model = &report.opened.model;
    match pick {
        Pick::Point(point) => {
            let body = model.bodies().iter().find(|body| body.points.contains(&point));
            named("point", point, body.map_or("", |body| &body.name))
        }
        Pick::Spring(spring) => named("spring", spring, model.spring_owner(spring)),
    }
}

fn named(kind: &str, index: usize, owner: &str) -> String {
    if owner.is_empty() { format!("{kind} {index}") } else { format!("{kind} {index} of {owner}") }
}

fn with_unit(value: f64, unit: &str) -> String {
    format!("{} {unit}", steady(value))
}

fn vector(values: [f64; 3], unit: &str) -> String {
    let [x, y, z] = values.map(steady);
    format!("({x}, {y}, {z}) {unit}")
}
