//! The ground planes: where they lie and how they push.

use egui::{ComboBox, RichText, Ui};
use sprung::params::{DAMPING_RANGE, STIFFNESS_RANGE};
use sprung::{Change, ContactLaw, Plane, Vec3};
use sprung_driver::Edit;

use super::number::{Asked, Number, Scale, around};
use super::params::magnitude;
use crate::state::AppState;

/// How contact laws are called, and what they say.
pub static LAWS: [(ContactLaw, &str, &str); 2] = [
    (ContactLaw::Push, "only pushes", "max(0, k_c·p − k_c,d·v_n): never a pull."),
    (
        ContactLaw::Report,
        "as in the report",
        "k_c·p − k_c,d·v_n as the report writes it: near lift-off the damper can hold a point down.",
    ),
];

/// A change of a plane that was asked for: the plane, and whether it goes on with the last one.
type Change1 = Option<(Plane, bool)>;

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
            if let Some((plane, continues)) = one(ui, plane, own.get(index)) {
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

fn one(ui: &mut Ui, plane: &Plane, own: Option<&Plane>) -> Change1 {
    let height = Number {
        name: "height y",
        unit: "m",
        about: "Height of the plane, or of the point that a sloping one goes through. The depth of a point below it is \
                p = (x_plane − x)·n.",
        allowed: magnitude(),
        slider: f64::from(plane.point.y.min(-30.0))..=f64::from(plane.point.y.max(30.0)),
        scale: Scale::Linear,
    };
    let mut changed: Change1 = None;
    if let Some(Asked { value, continues }) =
        height.show(ui, f64::from(plane.point.y), own.map(|own| f64::from(own.point.y)))
    {
        let point = Vec3::new(plane.point.x, value as f32, plane.point.z);
        changed = Some((Plane { point, ..*plane }, continues));
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
        changed = Some((Plane { stiffness: value as f32, ..*plane }, continues));
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
        changed = Some((Plane { damping: value as f32, ..*plane }, continues));
    }
    law(ui, plane).or(changed)
}

/// The direction out of the ground, as two slopes: any two numbers are a direction, so nothing needs refusing.
fn normal(ui: &mut Ui, plane: &Plane, own: Option<&Plane>) -> Change1 {
    let slopes = |normal: Vec3| {
        let degrees = |side: f32| f64::from(side.atan2(normal.y).to_degrees());
        [degrees(normal.x), degrees(normal.z)]
    };
    let now = slopes(plane.normal);
    let own = own.map(|own| slopes(own.normal));
    let mut changed = None;
    for (axis, name) in ["tilt to x", "tilt to z"].into_iter().enumerate() {
        let number = Number {
            name,
            unit: "°",
            about: "How far the plane's normal n leans towards an axis, from straight up. Contact forces act along n.",
            allowed: -85.0..=85.0,
            slider: -45.0..=45.0,
            scale: Scale::Linear,
        };
        if let Some(Asked { value, continues }) = number.show(ui, now[axis], own.map(|own| own[axis])) {
            let mut tilt = now.map(|degrees| degrees.clamp(-85.0, 85.0).to_radians());
            tilt[axis] = value.to_radians();
            let normal = Vec3::new(tilt[0].tan() as f32, 1.0, tilt[1].tan() as f32).normalize();
            changed = Some((Plane { normal, ..*plane }, continues));
        }
    }
    let n = plane.normal;
    ui.weak(format!("Normal n = ({:.3}, {:.3}, {:.3})", n.x, n.y, n.z));
    changed
}

fn law(ui: &mut Ui, plane: &Plane) -> Change1 {
    let mut changed = None;
    ui.horizontal(|ui| {
        let label = ui.label("contact law");
        let chosen = LAWS.iter().find(|(law, ..)| *law == plane.law);
        let combo = ComboBox::from_id_salt("law")
            .selected_text(chosen.map_or("", |(_, name, _)| name))
            .show_ui(ui, |ui| {
                for (law, name, about) in LAWS {
                    if ui.selectable_label(plane.law == law, name).on_hover_text(about).clicked() {
                        changed = Some((Plane { law, ..*plane }, false));
                    }
                }
            });
        let about = chosen.map_or("", |(_, _, about)| about);
        combo.response.labelled_by(label.id).on_hover_text(about);
    });
    changed
}
