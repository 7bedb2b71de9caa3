//! Bodies made from a mesh: what it becomes, and of what.

use std::ops::RangeInclusive;

use super::values::{SIZE_RANGE, exactly_one, number};
use crate::error::{Code, Error, Result};
use crate::params::{DAMPING_RANGE, LENGTH_RANGE, STIFFNESS_RANGE};
use crate::scene::group::check_exceptions;
use crate::scene::suggest::steers;
use crate::scene::types::Body;

/// Allowed densities, kg/m² or kg/m³.
const DENSITY_RANGE: RangeInclusive<f32> = 1e-9..=1e9;

/// Allowed damping times, s.
const TIME_RANGE: RangeInclusive<f32> = 0.0..=1e6;

/// Bytes that the path of a mesh file may have.
const PATH_LENGTH: usize = 1000;

/// What a mesh becomes, and of what.
pub fn check_mesh(path: &str, body: &Body) -> Result<()> {
    let kinds = [("cloth", body.cloth.is_some()), ("soft", body.soft.is_some()), ("net", body.net.is_some())];
    let Some(mesh) = &body.mesh else {
        let Some((kind, _)) = kinds.iter().find(|(_, there)| *there) else { return Ok(()) };
        let error = Error::new(Code::Conflict, "is made from a mesh, and this body has none");
        return Err(error.with_fix("say mesh = \"FILE\"").at_field(format!("{path}.{kind}")));
    };
    let length = mesh.file.len();
    if length == 0 || length > PATH_LENGTH || mesh.file.chars().any(steers) {
        let sentence = format!("must be a file's name of 1 to {PATH_LENGTH} visible characters");
        return Err(Error::new(Code::OutOfRange, sentence).at_field(format!("{path}.mesh")));
    }
    let optional = |field: String, value: Option<f64>, range, unit| {
        value.map_or(Ok(()), |value| number(field, value, range, unit))
    };
    optional(format!("{path}.mesh.merge"), mesh.merge, &LENGTH_RANGE, "m")?;
    exactly_one(path, "does not say what its mesh becomes", &kinds)?;
    let at = |key: &str| format!("{path}.{}.{key}", body.material_key());
    if let Some(cloth) = &body.cloth {
        density(&at("density"), cloth.density, "kg/m²", body)?;
        number(at("stiffness"), cloth.stiffness, &STIFFNESS_RANGE, "N/m")?;
        number(at("bending"), cloth.bending, &STIFFNESS_RANGE, "N·m")?;
        optional(at("bending_radius"), cloth.bending_radius, &SIZE_RANGE, "m")?;
        number(at("damping"), cloth.damping, &TIME_RANGE, "s")?;
    }
    if let Some(soft) = &body.soft {
        number(at("spacing"), soft.spacing, &SIZE_RANGE, "m")?;
        density(&at("density"), soft.density, "kg/m³", body)?;
        number(at("stiffness"), soft.stiffness, &STIFFNESS_RANGE, "Pa")?;
        number(at("damping"), soft.damping, &TIME_RANGE, "s")?;
    }
    if let Some(net) = &body.net {
        number(at("stiffness"), net.stiffness, &STIFFNESS_RANGE, "N/m")?;
        number(at("damping"), net.damping, &DAMPING_RANGE, "N·s/m")?;
    }
    let Some((rest_scale, cut, except)) = body.mesh_springs() else { return Ok(()) };
    number(at("rest_scale"), rest_scale, &LENGTH_RANGE, "")?;
    check_exceptions(&format!("{path}.{}", body.material_key()), cut, except)
}

/// The mass of a material: its density, or the body's mass, or that of each point.
fn density(field: &str, value: Option<f64>, unit: &str, body: &Body) -> Result<()> {
    let other = match (&body.body_mass, &body.point_mass) {
        (Some(_), _) => Some("body_mass"),
        (None, Some(_)) => Some("point_mass"),
        (None, None) => None,
    };
    match (value, other) {
        (Some(_), Some(other)) => {
            let sentence = format!("is said besides the body's {other}; one of them is enough");
            Err(Error::new(Code::Conflict, sentence).at_field(field))
        }
        (Some(value), None) => number(field.to_owned(), value, &DENSITY_RANGE, unit),
        (None, None) => {
            let sentence = "is missing; say how heavy the material is, or the body's body_mass";
            Err(Error::new(Code::MissingField, sentence).at_field(field))
        }
        (None, Some(_)) => Ok(()),
    }
}
