//! What is told of a simulation: plain values, of which the Python makes its own.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PySlice};
use sprung::stability::{self, Limit, Setter};
use sprung::{ContactLaw, Energy, Model, Plane, Result, Simulation, SurfaceKind};
use sprung_render::export;

/// Ending and description of every format that can be written.
pub fn exporters() -> Vec<(&'static str, &'static str)> {
    export::EXPORTERS.iter().map(|exporter| (exporter.ending, exporter.description)).collect()
}

/// The energies, J, in the order of `sprung.Energy`'s fields.
pub fn energy(energy: &Energy) -> [f64; 9] {
    let sums = &energy.sums;
    [
        energy.kinetic,
        energy.gravitational,
        energy.elastic,
        energy.contact,
        sums.start,
        sums.work_in,
        sums.lost_in_dampers,
        sums.lost_in_contact,
        sums.integrator_error,
    ]
}

fn slice<'py>(py: Python<'py>, range: &std::ops::Range<usize>) -> Bound<'py, PySlice> {
    PySlice::new(py, range.start as isize, range.end as isize, 1)
}

/// Name, points and springs of a body.
pub type Body<'py> = (String, Bound<'py, PySlice>, Bound<'py, PySlice>);

/// What every body is.
pub fn bodies<'py>(py: Python<'py>, model: &Model) -> Vec<Body<'py>> {
    let body = |body: &sprung::Body| (body.name.clone(), slice(py, &body.points), slice(py, &body.springs));
    model.bodies().iter().map(body).collect()
}

/// Name and springs of every joint.
pub fn joints<'py>(py: Python<'py>, model: &Model) -> Vec<(String, Bound<'py, PySlice>)> {
    model.joints().iter().map(|joint| (joint.name.clone(), slice(py, &joint.springs))).collect()
}

/// Body and kind of every surface.
pub fn surfaces(model: &Model) -> Vec<(String, &'static str)> {
    let surface = |surface: &sprung::Surface| {
        let kind = match surface.kind {
            SurfaceKind::Cloth => "cloth",
            SurfaceKind::Skin => "skin",
        };
        (model.bodies()[surface.body].name.clone(), kind)
    };
    model.surfaces().iter().map(surface).collect()
}

/// The limits on dt, as `sprung show` has them.
pub fn stability<'py>(py: Python<'py>, simulation: &Simulation) -> PyResult<Bound<'py, PyDict>> {
    let (model, params, positions) = (simulation.model(), simulation.params(), &simulation.state().position);
    let sharp = py.detach(|| stability::sharp(model, params, positions));
    let told = PyDict::new(py);
    told.set_item("dt", params.dt)?;
    told.set_item("sharp", sharp.dt.unwrap_or(f64::INFINITY))?;
    told.set_item("omega2_max", sharp.omega2_max)?;
    told.set_item("c_max", sharp.c_max)?;
    told.set_item("certified", limit(simulation, stability::certified(model, params, positions)))?;
    told.set_item("every_configuration", limit(simulation, stability::every_configuration(model, params)))?;
    Ok(told)
}

/// A limit, s, what sets it in words, its spring, and its points.
pub type Told = (f64, String, Option<usize>, Vec<usize>);

/// A limit; one that does not exist is infinite.
pub fn limit(simulation: &Simulation, limit: Option<Limit>) -> Told {
    let model = simulation.model();
    let Some(limit) = limit else { return (f64::INFINITY, "nothing".to_owned(), None, Vec::new()) };
    match limit.setter {
        Setter::Spring(spring) => {
            let points = model.springs()[spring].map(|point| point as usize).to_vec();
            (limit.dt, model.spring_name(spring), Some(spring), points)
        }
        Setter::Point(point) => {
            let words = format!("the contact or grab at {}", model.point_name(point));
            (limit.dt, words, None, vec![point])
        }
    }
}

type Vector = (f32, f32, f32);

/// Point, normal, stiffness, damping and law of a plane.
pub type Ground = (Vector, Vector, f32, f32, &'static str);

/// What a plane is.
pub fn plane(plane: &Plane) -> Ground {
    let law = match plane.law {
        ContactLaw::Push => "push",
        ContactLaw::Report => "report",
    };
    (plane.point.into(), plane.normal.into(), plane.stiffness, plane.damping, law)
}

/// The largest dt that is safely stable.
pub fn auto_dt(simulation: &Simulation) -> Result<f64> {
    stability::auto_dt(simulation.model(), simulation.params())
}
