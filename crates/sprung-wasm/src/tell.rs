//! What is told of a simulation: its model, energies, limits and parameters, as JavaScript values.

use js_sys::{Array, Float32Array, Uint8Array, Uint32Array};
use sprung::stability::{self, Limit, Setter};
use sprung::{Code, ContactLaw, DVec3, Energy, Error, Model, Plane, Result, Simulation, SurfaceKind};
use wasm_bindgen::JsValue;

use crate::javascript::{Fields, index};

/// Numbers with which JavaScript says a plane: point, normal, stiffness, damping, and 1 where it follows the report.
const PLANE_NUMBERS: usize = 9;

/// The parameters that [`parameter`] knows.
const PARAMETERS: [&str; 10] =
    ["dt", "substeps", "gravity", "planes", "mass", "pinned", "stiffness", "damping", "restLength", "cut"];

pub fn bodies(model: &Model) -> Array {
    let body = |body: &sprung::Body| {
        let fields = Fields::new().with("name", body.name.as_str()).with("points", range(&body.points));
        fields.with("springs", range(&body.springs)).done()
    };
    model.bodies().iter().map(body).collect()
}

pub fn joints(model: &Model) -> Array {
    let joint = |joint: &sprung::Joint| {
        Fields::new().with("name", joint.name.as_str()).with("springs", range(&joint.springs)).done()
    };
    model.joints().iter().map(joint).collect()
}

pub fn surfaces(model: &Model) -> Array {
    let surface = |surface: &sprung::Surface| {
        let kind = match surface.kind {
            SurfaceKind::Cloth => "cloth",
            SurfaceKind::Skin => "skin",
        };
        let triangles = Uint32Array::from(bytemuck::cast_slice::<_, u32>(&surface.triangles));
        let body = model.bodies()[surface.body].name.as_str();
        Fields::new().with("body", body).with("kind", kind).with("triangles", triangles).done()
    };
    // No mesh can be read here, and only meshes have vertices that are not points.
    model.surfaces().iter().filter(|surface| surface.weighted().is_empty()).map(surface).collect()
}

fn range(range: &std::ops::Range<usize>) -> Array {
    Array::of2(&(range.start as f64).into(), &(range.end as f64).into())
}

fn numbers(values: impl IntoIterator<Item = f32>) -> Array {
    values.into_iter().map(|value| JsValue::from(f64::from(value))).collect()
}

pub fn energy(energy: &Energy) -> JsValue {
    let sums = &energy.sums;
    Fields::new()
        .with("total", energy.total())
        .with("kinetic", energy.kinetic)
        .with("gravitational", energy.gravitational)
        .with("elastic", energy.elastic)
        .with("contact", energy.contact)
        .with("start", sums.start)
        .with("workIn", sums.work_in)
        .with("lostInDampers", sums.lost_in_dampers)
        .with("lostInContact", sums.lost_in_contact)
        .with("integratorError", sums.integrator_error)
        .done()
}

/// As `sprung show` has them.
pub fn stability(simulation: &Simulation) -> JsValue {
    let (model, params, positions) = (simulation.model(), simulation.params(), &simulation.state().position);
    let sharp = stability::sharp(model, params, positions);
    let sharp = Fields::new()
        .with("dt", sharp.dt.unwrap_or(f64::INFINITY))
        .with("omega2Max", sharp.omega2_max)
        .with("cMax", sharp.c_max);
    Fields::new()
        .with("dt", params.dt)
        .with("sharp", sharp.done())
        .with("certified", limit(simulation, stability::certified(model, params, positions)))
        .with("everyConfiguration", limit(simulation, stability::every_configuration(model, params)))
        .done()
}

/// A limit and what sets it; one that does not exist is infinite.
pub fn limit(simulation: &Simulation, limit: Option<Limit>) -> JsValue {
    let model = simulation.model();
    let Some(limit) = limit else {
        return Fields::new().with("dt", f64::INFINITY).with("setBy", "nothing").done();
    };
    let fields = Fields::new().with("dt", limit.dt);
    match limit.setter {
        Setter::Spring(spring) => {
            let points = model.springs()[spring].map(f64::from);
            fields
                .with("setBy", model.spring_name(spring))
                .with("spring", spring as f64)
                .with("points", Array::of2(&points[0].into(), &points[1].into()))
        }
        Setter::Point(point) => fields
            .with("setBy", format!("the contact or grab at {}", model.point_name(point)))
            .with("points", Array::of1(&(point as f64).into())),
    }
    .done()
}

/// A parameter: a number, a vector, or an array with an entry for each point or spring.
pub fn parameter(simulation: &Simulation, name: &str) -> Result<JsValue> {
    let params = simulation.params();
    let flags = |flags: &[bool]| Uint8Array::from(bytemuck::cast_slice::<bool, u8>(flags)).into();
    let floats = |values: &[f32]| Float32Array::from(values).into();
    Ok(match name {
        "dt" => params.dt.into(),
        "substeps" => f64::from(params.substeps).into(),
        "gravity" => numbers(params.gravity.to_array()).into(),
        "planes" => params.planes.iter().map(plane).collect::<Array>().into(),
        "mass" => floats(&params.point_mass),
        "pinned" => flags(&params.point_pinned),
        "stiffness" => floats(&params.spring_stiffness),
        "damping" => floats(&params.spring_damping),
        "restLength" => floats(&params.spring_rest_length),
        "cut" => flags(&params.spring_cut),
        _ => return Err(no_such_parameter(name)),
    })
}

/// The same of one point or spring; of what is true or false, 1 or 0.
pub fn parameter_of(simulation: &Simulation, name: &str, of: f64) -> Result<f64> {
    let params = simulation.params();
    let number = index(name, of)?;
    let (value, kind, count) = match name {
        "mass" => {
            (params.point_mass.get(number).map(|&mass| f64::from(mass)), "point", params.point_mass.len())
        }
        "pinned" => (
            params.point_pinned.get(number).map(|&on| f64::from(u8::from(on))),
            "point",
            params.point_pinned.len(),
        ),
        "stiffness" | "damping" | "restLength" => {
            let values = match name {
                "stiffness" => &params.spring_stiffness,
                "damping" => &params.spring_damping,
                _ => &params.spring_rest_length,
            };
            (values.get(number).map(|&value| f64::from(value)), "spring", values.len())
        }
        "cut" => (
            params.spring_cut.get(number).map(|&on| f64::from(u8::from(on))),
            "spring",
            params.spring_cut.len(),
        ),
        _ => return Err(no_such_parameter(name)),
    };
    value.ok_or_else(|| {
        let sentence = match count {
            0 => format!("there is no {kind} {number}; there is none at all"),
            _ => format!("there is no {kind} {number}; {kind}s are 0 to {}", count - 1),
        };
        Error::new(Code::NotFound, sentence).at_field(name)
    })
}

pub fn no_such_parameter(name: &str) -> Error {
    let error = Error::new(
        Code::NotFound,
        format!("there is no parameter \"{name}\" here; there are {}", PARAMETERS.join(", ")),
    );
    match sprung::scene::closest(name, PARAMETERS) {
        Some(near) => error.with_fix(format!("did you mean \"{near}\"?")),
        None => error,
    }
}

fn plane(plane: &Plane) -> JsValue {
    let law = match plane.law {
        ContactLaw::Push => "push",
        ContactLaw::Report => "report",
    };
    Fields::new()
        .with("point", numbers(plane.point.to_array()))
        .with("normal", numbers(plane.normal.to_array()))
        .with("stiffness", plane.stiffness)
        .with("damping", plane.damping)
        .with("law", law)
        .done()
}

/// Planes from nine numbers each. A normal may have any length but zero.
pub fn planes_from(numbers: &[f64]) -> Result<Vec<Plane>> {
    let plane = |(number, values): (usize, &[f64])| {
        let law = if values[8] == 1.0 { ContactLaw::Report } else { ContactLaw::Push };
        let [point, normal] = [&values[..3], &values[3..6]].map(DVec3::from_slice);
        let made = Plane::new(point.as_vec3(), normal, values[6] as f32, values[7] as f32, law);
        made.map_err(|error| error.within(format!("planes[{number}]")))
    };
    numbers.chunks_exact(PLANE_NUMBERS).enumerate().map(plane).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_length_of_a_normal_does_not_matter_unless_it_is_zero() {
        let level = [0.0, -1.0, 0.0, 0.0, 1e300, 0.0, 50.0, 1.0, 0.0];
        let planes = planes_from(&level).expect("allowed");
        assert_eq!(planes, [Plane::level(-1.0, 50.0, 1.0)]);
        let mut flat = level;
        flat[4] = 0.0;
        let error = planes_from(&flat).expect_err("it has no direction");
        assert_eq!(error.place().field.as_deref(), Some("planes[0].normal"));
    }

    #[test]
    fn a_parameter_that_is_not_there_is_named_with_those_that_are() {
        let simulation = sprung::scene::Scene::builtin("chain").and_then(|scene| scene.simulation());
        let simulation = simulation.expect("it is built in");
        assert_eq!(
            parameter_of(&simulation, "stiffness", 0.0).expect("it has springs"),
            f64::from(simulation.params().spring_stiffness[0])
        );
        let error = parameter_of(&simulation, "stifness", 0.0).expect_err("misspelt");
        assert_eq!(error.fix(), Some("did you mean \"stiffness\"?"));
        let error = parameter_of(&simulation, "mass", 99.0).expect_err("there is none");
        assert!(error.to_string().starts_with("mass: there is no point 99; points are 0 to "), "{error}");
    }
}
