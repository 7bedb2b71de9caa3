//! Why things sink into the ground: the plane as a spring, with the numbers of the moment.

use egui::Ui;
use sprung::ContactLaw;
use sprung_driver::Report;

use super::formula;

/// What the planes carry now.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GroundReading {
    /// Points that touch.
    pub touching: usize,
    /// The deepest, m.
    pub deepest: f64,
    /// Points at least half as deep as that: the others carry little.
    pub deep: usize,
    /// How hard the ground pushes in all, along its normals, N.
    pub push: f64,
    /// The weight of all that can move, N.
    pub weight: f64,
}

/// Looks at all points.
pub fn read(report: &Report) -> GroundReading {
    let params = &report.params;
    let mut ground = GroundReading::default();
    let mut depths = Vec::new();
    let moments = report.now.positions.iter().zip(&report.now.velocities).enumerate();
    for (point, (&position, &velocity)) in moments.filter(|(point, _)| !params.is_fixed(*point)) {
        ground.weight += f64::from(params.point_mass[point]) * f64::from(params.gravity.length());
        for plane in &params.planes {
            let depth = f64::from(plane.depth(position));
            if depth > 0.0 {
                let push = f64::from(plane.stiffness) * depth
                    - f64::from(plane.damping * velocity.dot(plane.normal));
                ground.touching += 1;
                depths.push(depth);
                ground.deepest = ground.deepest.max(depth);
                ground.push += if plane.law == ContactLaw::Push { push.max(0.0) } else { push };
            }
        }
    }
    ground.deep = depths.iter().filter(|depth| **depth >= 0.5 * ground.deepest).count();
    ground
}

/// The section about the ground, in scenes that have one.
pub fn show(ui: &mut Ui, report: &Report) {
    let Some(plane) = report.params.planes.first() else { return };
    ui.add_space(8.0);
    ui.heading("The ground");
    let GroundReading { touching, deepest, deep, push, weight } = read(report);
    let stiffness = f64::from(plane.stiffness);
    formula::prose(
        ui,
        &format!(
            "The ground is soft. A point that is below it by a depth p is pushed up with k_c p, and here k_c is {} N/m for each \
         touching point. So whatever lies on it sinks in until the pushes add up to its weight.",
            sprung::significant(stiffness)
        ),
    );
    let numbers = format!(
        "{touching} points touch\npushed up by {push:.0} N\nthe weight is {weight:.0} N\ndeepest {deepest:.2} m"
    );
    ui.add_space(2.0);
    ui.monospace(numbers);
    ui.add_space(2.0);
    if deep > 0 && stiffness > 0.0 {
        let all = weight / stiffness;
        formula::prose(
            ui,
            &format!(
                "At rest all depths together come to p = weight/k_c = {weight:.0}/{} = {all:.1} m. Shared by the {deep} points that are \
             deep, that is {:.2} m each. A stiffer ground needs less depth, and a shorter step.",
                sprung::significant(stiffness),
                all / deep as f64,
            ),
        );
    } else {
        ui.label("Nothing touches it yet.");
    }
}
