//! What was made of a mesh: its points, masses and springs must be in range. What is not follows from the size of the mesh as a
//! rule, and so the sentences say it.

use crate::build::mesh::{Mesh, MeshBody};
use crate::error::{Code, Error, Result};
use crate::params::{DAMPING_RANGE, MAGNITUDE_RANGE, MASS_RANGE, STIFFNESS_RANGE};
use crate::scene::assemble::{Placement, masses};
use crate::scene::suggest::shortened;
use crate::scene::types::Body;
use crate::text::significant;

/// How a mesh in another unit is brought to metres.
const SCALE: &str = "which says how many metres a unit of the file is";

/// Checks what was made, once there is something.
pub fn check_made(path: &str, body: &Body) -> Result<()> {
    let (Some(made), Some(mesh), Some(file)) = (body.made(), body.read_mesh(), &body.mesh) else {
        return Ok(());
    };
    let file = shortened(&file.file);
    check_places(path, body, made, || sized(&file, mesh, body.scale))?;
    check_masses(path, body, made, || sized(&file, mesh, body.scale), &file)?;
    check_springs(path, body, made)
}

/// `"bunny.obj" is 0.2 × 0.1 × 0.2 m in size`.
fn sized(file: &str, mesh: &Mesh, scale: f64) -> String {
    let size = mesh.extent().map_or(glam::DVec3::ZERO, |[low, high]| (high - low) * scale);
    let [x, y, z] = size.to_array().map(significant);
    format!("\"{file}\" is {x} × {y} × {z} m in size")
}

fn check_places(path: &str, body: &Body, made: &MeshBody, sized: impl Fn() -> String) -> Result<()> {
    let placement = Placement::new(body);
    let is_far = |place: &glam::Vec3| !place.to_array().iter().all(|at| MAGNITUDE_RANGE.contains(at));
    let places = made.points.iter().map(|&point| placement.world(point));
    let Some((point, place)) = places.enumerate().find(|(_, place)| is_far(place)) else { return Ok(()) };
    let sentence =
        format!("{}, and places point {point} at {place} m; coordinates must be from -1e9 to 1e9 m", sized());
    let error = Error::new(Code::OutOfRange, sentence).with_fix(format!("make the scale smaller, {SCALE}"));
    Err(error.at_field(format!("{path}.mesh")))
}

/// Masses that follow from a density, or that share out the mass of the whole body.
fn check_masses(
    path: &str,
    body: &Body,
    made: &MeshBody,
    sized: impl Fn() -> String,
    file: &str,
) -> Result<()> {
    if body.point_mass.is_some() || made.masses.is_empty() {
        return Ok(());
    }
    let masses = masses(body);
    let masses = masses.values();
    let is_fine = |mass: f64| mass == 0.0 || MASS_RANGE.contains(&(mass as f32));
    let Some((point, &mass)) = masses.iter().enumerate().find(|(_, mass)| !is_fine(**mass)) else {
        return Ok(());
    };
    let (low, high) = (MASS_RANGE.start(), MASS_RANGE.end());
    let found = significant(mass);
    let allowed = format!("masses must be from {low:e} to {high:e} kg, or 0 (fixed in space)");
    if let Some(total) = body.body_mass {
        let total = significant(total);
        let sentence = format!("is {total} kg, which makes a point of {found} kg, and {allowed}");
        return Err(Error::new(Code::OutOfRange, sentence).at_field(format!("{path}.body_mass")));
    }
    let mean = masses.iter().sum::<f64>() / masses.len() as f64;
    let error = if is_fine(mean) {
        // Its size is no matter: a few faces are far smaller than the others.
        let sentence = format!("\"{file}\" makes point {point} of {found} kg, and {allowed}");
        let fix = "its faces there are very small: merge near vertices by mesh = { file = …, merge = … }, or say point_mass";
        Error::new(Code::OutOfRange, sentence).with_fix(fix)
    } else {
        let wanted = if mass < f64::from(*low) { "larger" } else { "smaller" };
        let sentence = format!("{}, which makes a point of {found} kg, and {allowed}", sized());
        Error::new(Code::OutOfRange, sentence).with_fix(format!("make the scale {wanted}, {SCALE}"))
    };
    Err(error.at_field(format!("{path}.mesh")))
}

/// Springs, of which a material says how stiff and damped they are together.
fn check_springs(path: &str, body: &Body, made: &MeshBody) -> Result<()> {
    let (key, [stiffness, damping], units) = match (&body.cloth, &body.soft) {
        (Some(cloth), _) => ("cloth", [cloth.stiffness, cloth.damping], ["N/m", "s"]),
        (None, Some(soft)) => ("soft", [soft.stiffness, soft.damping], ["Pa", "s"]),
        // A net's springs have what is said of them.
        (None, None) => return Ok(()),
    };
    let refused = |name: &str, said: f64, unit: &str, found: f64, most: f32, of_spring: &str| {
        let (said, found) = (significant(said), significant(found));
        let sentence = format!(
            "is {said} {unit}, which gives a spring {found} {of_spring}, and there may be at most {most:e} {of_spring}"
        );
        Err(Error::new(Code::OutOfRange, sentence).at_field(format!("{path}.{key}.{name}")))
    };
    for spring in &made.springs {
        if !STIFFNESS_RANGE.contains(&(spring.stiffness as f32)) {
            let most = *STIFFNESS_RANGE.end();
            return refused("stiffness", stiffness, units[0], spring.stiffness, most, "N/m");
        }
        if !DAMPING_RANGE.contains(&(spring.damping as f32)) {
            return refused("damping", damping, units[1], spring.damping, *DAMPING_RANGE.end(), "N·s/m");
        }
    }
    Ok(())
}
