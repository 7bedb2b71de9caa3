//! The ground planes: where they lie and how they push.

use egui::{ComboBox, RichText, Ui};
use sprung::params::{DAMPING_RANGE, STIFFNESS_RANGE};
use sprung::{Change, ContactLaw, Plane, Vec3};
use sprung_driver::Edit;

use super::number::{Asked, Number, Scale, around, own_button};
use super::params::magnitude;
use crate::state::AppState;
use crate::text::with_minus;

/// How contact laws are called, and what they say.
pub static LAWS: [(ContactLaw, &str, &str); 2] = [
    (ContactLaw::Push, "only pushes", "max(0, k_c·p − k_c,d·v_n): never a pull."),
    (
        ContactLaw::Report,
        "as in the report",
        "k_c·p − k_c,d·v_n as the report writes it: near lift-off the damper can hold a point down.",
    ),
];

/// Steeper than this, a plane is a wall or a ceiling, degrees.
const STEEPEST: f64 = 85.0;

/// A plane that was asked for in the place of another.
struct PlaneEdit {
    plane: Plane,
    /// Whether it goes on with the one asked for last, as in a drag.
    continues: bool,
}

/// The section.
pub fn show(ui: &mut Ui, state: &mut AppState) {
    let (now, own) = (state.report.params.planes.clone(), state.report.opened.params.planes.clone());
    let mut asked: Option<(Vec<Plane>, bool, &str)> = None;
    if now.is_empty() {
        ui.weak("There is no ground here.");
    }
    for (index, plane) in now.iter().enumerate() {
        ui.push_id(index, |ui| {
            if now.len() > 1 {
                ui.label(RichText::new(format!("Plane {}", index + 1)).strong());
            }
            if let Some(PlaneEdit { plane, continues }) = one(ui, plane, own.get(index)) {
                let mut planes = now.clone();
                planes[index] = plane;
                asked = Some((planes, continues, "ground"));
            }
            if ui.small_button("Remove this plane").clicked() {
                let mut planes = now.clone();
                planes.remove(index);
                asked = Some((planes, false, "remove a plane"));
            }
        });
    }
    ui.horizontal(|ui| {
        if ui.button("Add a plane").on_hover_text("A level plane just below the scene.").clicked() {
            let lowest = state.report.now.positions.iter().fold(f32::INFINITY, |low, point| low.min(point.y));
            let height = if lowest.is_finite() { lowest.floor() - 1.0 } else { 0.0 };
            let mut planes = now.clone();
            planes.push(Plane::level(height, 1000.0, 10.0));
            asked = Some((planes, false, "add a plane"));
        }
        let button = ui.add_enabled(now != own, egui::Button::new("Own ground"));
        if button.on_hover_text("The planes that the scene itself has.").clicked() {
            asked = Some((own.clone(), false, "own ground"));
        }
    });
    if let Some((planes, continues, label)) = asked {
        state.edit(Edit { label: label.to_owned(), changes: vec![Change::Planes(planes)], continues });
    }
}

fn one(ui: &mut Ui, plane: &Plane, own: Option<&Plane>) -> Option<PlaneEdit> {
    let height = Number {
        name: "height y",
        unit: "m",
        about: "Height of the plane, or of the point that a sloping one goes through. The depth of a point below it is \
                p = (x_plane − x)·n.",
        allowed: magnitude(),
        slider: f64::from(plane.point.y.min(-30.0))..=f64::from(plane.point.y.max(30.0)),
        scale: Scale::Linear,
    };
    let mut changed = None;
    if let Some(Asked { value, continues }) =
        height.show(ui, f64::from(plane.point.y), own.map(|own| f64::from(own.point.y)))
    {
        let point = Vec3::new(plane.point.x, value as f32, plane.point.z);
        changed = Some(PlaneEdit { plane: Plane { point, ..*plane }, continues });
    }
    changed = normal(ui, plane, own).or(changed);
    let (k_allowed, d_allowed) = (
        f64::from(*STIFFNESS_RANGE.start())..=f64::from(*STIFFNESS_RANGE.end()),
        f64::from(*DAMPING_RANGE.start())..=f64::from(*DAMPING_RANGE.end()),
    );
    let own_k = own.map(|own| f64::from(own.stiffness));
    let stiffness = Number {
        name: "contact k_c",
        unit: "N/m",
        about: "Contact stiffness, for each touching point: F = k_c·p at depth p. A soft ground is sunk into: the jelly \
                rests about 2 m below its plane.",
        allowed: k_allowed,
        slider: around(own_k.unwrap_or(1000.0), 0.0..=1e5),
        scale: Scale::Logarithmic,
    };
    if let Some(Asked { value, continues }) = stiffness.show(ui, f64::from(plane.stiffness), own_k) {
        changed = Some(PlaneEdit { plane: Plane { stiffness: value as f32, ..*plane }, continues });
    }
    let own_d = own.map(|own| f64::from(own.damping));
    let damping = Number {
        name: "contact k_c,d",
        unit: "N·s/m",
        about: "Contact damping, for each touching point: F = −k_c,d·v_n. It decides how high things bounce.",
        allowed: d_allowed,
        slider: around(own_d.unwrap_or(10.0), 0.0..=1e3),
        scale: Scale::Logarithmic,
    };
    if let Some(Asked { value, continues }) = damping.show(ui, f64::from(plane.damping), own_d) {
        changed = Some(PlaneEdit { plane: Plane { damping: value as f32, ..*plane }, continues });
    }
    law(ui, plane, own).or(changed)
}

/// The direction out of the ground. That of a plane which faces upwards is two slopes: any two numbers are a direction, so
/// nothing needs refusing. No slope says how a wall or a ceiling stands; it can be levelled.
fn normal(ui: &mut Ui, plane: &Plane, own: Option<&Plane>) -> Option<PlaneEdit> {
    let mut asked: Option<(Vec3, bool)> = None;
    match slopes(plane.normal) {
        Some(now) => asked = tilts(ui, now),
        None => {
            ui.horizontal(|ui| {
                ui.label("A wall or a ceiling: it has no tilt.");
                let level = ui.small_button("Level it");
                if level.on_hover_text("Turns it to face straight up, as a floor.").clicked() {
                    asked = Some((Vec3::Y, false));
                }
            });
        }
    }
    ui.horizontal(|ui| {
        ui.weak(format!("Normal n = {}", components(plane.normal)));
        let Some(own) = own else { return };
        // One button for all of it: two slopes, one after the other, would be off by what rounding does to angles.
        if own_button(ui, "normal", &components(own.normal), own.normal != plane.normal) {
            asked = Some((own.normal, false));
        }
    });
    asked.map(|(normal, continues)| PlaneEdit { plane: Plane { normal, ..*plane }, continues })
}

/// How far a normal leans towards x and z, degrees; `None` for walls and ceilings.
fn slopes(normal: Vec3) -> Option<[f64; 2]> {
    let slopes = [normal.x, normal.z].map(|side| f64::from(side.atan2(normal.y).to_degrees()));
    // What was set to the very limit is a little beyond it once it has become a direction.
    slopes.iter().all(|slope| slope.abs() < STEEPEST + 0.01).then_some(slopes)
}

/// The two slopes; gives the normal that was asked for, and whether it goes on with the last one.
fn tilts(ui: &mut Ui, now: [f64; 2]) -> Option<(Vec3, bool)> {
    let mut asked = None;
    for (axis, name) in ["tilt to x", "tilt to z"].into_iter().enumerate() {
        let number = Number {
            name,
            unit: "°",
            about: "How far the plane's normal n leans towards an axis, from straight up. Contact forces act along n.",
            allowed: -STEEPEST..=STEEPEST,
            slider: -45.0..=45.0,
            scale: Scale::Linear,
        };
        if let Some(Asked { value, continues }) = number.show(ui, now[axis], None) {
            let mut slopes = now;
            slopes[axis] = value;
            let [x, z] = slopes.map(|slope| slope.clamp(-STEEPEST, STEEPEST).to_radians().tan() as f32);
            asked = Some((Vec3::new(x, 1.0, z).normalize(), continues));
        }
    }
    asked
}

fn components(normal: Vec3) -> String {
    let [x, y, z] = normal.to_array().map(|value| with_minus(format!("{value:.3}")));
    format!("({x}, {y}, {z})")
}

fn law(ui: &mut Ui, plane: &Plane, own: Option<&Plane>) -> Option<PlaneEdit> {
    let mut changed = None;
    ui.horizontal(|ui| {
        let label = ui.label("contact law");
        let chosen = LAWS.iter().find(|(law, ..)| *law == plane.law);
        let combo = ComboBox::from_id_salt("law")
            .selected_text(chosen.map_or("", |(_, name, _)| name))
            .show_ui(ui, |ui| {
                for (law, name, about) in LAWS {
                    if ui.selectable_label(plane.law == law, name).on_hover_text(about).clicked() {
                        changed = Some(PlaneEdit { plane: Plane { law, ..*plane }, continues: false });
                    }
                }
            });
        let about = chosen.map_or("", |(_, _, about)| about);
        combo.response.labelled_by(label.id).on_hover_text(about);
        let own = own.and_then(|own| LAWS.iter().find(|(law, ..)| *law == own.law));
        if let Some(&(law, name, _)) = own
            && own_button(ui, "contact law", name, law != plane.law)
        {
            changed = Some(PlaneEdit { plane: Plane { law, ..*plane }, continues: false });
        }
    });
    changed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_faces_upwards_has_slopes() {
        let near = |found: Option<[f64; 2]>, expected: [f64; 2]| {
            found.is_some_and(|found| found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4))
        };
        assert!(near(slopes(Vec3::Y), [0.0, 0.0]));
        assert!(near(slopes(Vec3::new(-1.0, 1.0, 0.0).normalize()), [-45.0, 0.0]));
        let steepest = STEEPEST.to_radians().tan() as f32;
        assert!(near(slopes(Vec3::new(steepest, 1.0, -steepest).normalize()), [85.0, -85.0]));
        for normal in [Vec3::X, Vec3::NEG_Z, Vec3::NEG_Y, Vec3::new(0.6, -0.8, 0.0)] {
            assert_eq!(slopes(normal), None, "{normal}");
        }
    }
}
