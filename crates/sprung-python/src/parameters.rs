//! The parameters: read as arrays that never change, set as a whole.

use std::collections::BTreeMap;
use std::sync::Arc;

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use sprung::{Change, Code, ContactLaw, DVec3, Error, Params, Plane, Vec3};
use sprung_driver::grab;

use crate::errors::raised;
use crate::simulation::{Inner, Simulation};
use crate::{numbers, tell, views};

#[pymethods]
impl Simulation {
    /// Length of a step, s; set `"auto"` for the largest that is safely stable.
    ///
    /// >>> import sprung
    /// >>> jelly = sprung.scene("jelly").simulation()
    /// >>> jelly.dt = 0.005
    /// >>> jelly.dt = "auto"
    #[getter]
    fn dt(&self, py: Python<'_>) -> f64 {
        self.lock(py).simulation.params().dt
    }

    #[setter]
    fn set_dt(&self, py: Python<'_>, dt: &Bound<'_, PyAny>) -> PyResult<()> {
        self.change_with(py, |inner| match step_length(dt)? {
            Some(dt) => Ok(Change::Dt(dt)),
            None => tell::auto_dt(&inner.simulation).map(Change::Dt).map_err(raised),
        })
    }

    /// Steps in a displayed frame.
    ///
    /// >>> import sprung
    /// >>> jelly = sprung.scene("jelly").simulation()
    /// >>> jelly.substeps = 4
    /// >>> jelly.frame()
    /// >>> jelly.steps_taken
    /// 4
    #[getter]
    fn substeps(&self, py: Python<'_>) -> u32 {
        self.lock(py).simulation.params().substeps
    }

    #[setter]
    fn set_substeps(&self, py: Python<'_>, substeps: i64) -> PyResult<()> {
        // What does not fit is out of range in any case.
        let substeps = u32::try_from(substeps).unwrap_or(if substeps < 0 { 0 } else { u32::MAX });
        self.change(py, Change::Substeps(substeps))
    }

    /// Gravitational acceleration, (3,), m/s².
    ///
    /// >>> import sprung
    /// >>> jelly = sprung.scene("jelly").simulation()
    /// >>> jelly.gravity = [0, -1.62, 0]  # as on the moon
    #[getter]
    fn gravity<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        let gravity = PyArray1::from_slice(py, &self.lock(py).simulation.params().gravity.to_array());
        gravity.readwrite().make_nonwriteable();
        gravity
    }

    #[setter]
    fn set_gravity(&self, py: Python<'_>, gravity: &Bound<'_, PyAny>) -> PyResult<()> {
        self.change(py, Change::Gravity(numbers::vec3("gravity", gravity)?))
    }

    #[pyo3(name = "_tell_planes")]
    fn tell_planes(&self, py: Python<'_>) -> Vec<tell::Ground> {
        self.lock(py).simulation.params().planes.iter().map(tell::plane).collect()
    }

    /// All ground planes.
    #[pyo3(name = "_set_planes")]
    fn set_planes(&self, py: Python<'_>, planes: Vec<Bound<'_, PyAny>>) -> PyResult<()> {
        self.change(py, Change::Planes(planes_from(&planes)?))
    }

    /// Mass of each point, (n,), kg; zero fixes it in space. Set one number, or one for each.
    ///
    /// >>> import sprung
    /// >>> chain = sprung.scene("chain").simulation()
    /// >>> mass = chain.mass.copy()
    /// >>> mass[-1] = 2
    /// >>> chain.mass = mass
    #[getter]
    fn mass<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        views::floats(py, &self.lock(py).simulation.params().point_mass).map(Bound::into_any)
    }

    #[setter]
    fn set_mass(&self, py: Python<'_>, given: &Bound<'_, PyAny>) -> PyResult<()> {
        let mass = numbers::for_each("mass", given, self.points)?;
        self.set(py, |params| params.point_mass = Arc::new(mass))
    }

    /// Whether each point is pinned, (n,): it then stays where it is. Set one for all, or one for each.
    ///
    /// >>> import sprung
    /// >>> cloth = sprung.scene("cloth").simulation()
    /// >>> cloth.settle() > 0
    /// True
    /// >>> cloth.pinned = False  # let it fall
    #[getter]
    fn pinned<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        views::flags(py, &self.lock(py).simulation.params().point_pinned).map(Bound::into_any)
    }

    #[setter]
    fn set_pinned(&self, py: Python<'_>, given: &Bound<'_, PyAny>) -> PyResult<()> {
        let pinned = numbers::flags("pinned", given, self.points)?;
        self.set(py, |params| params.point_pinned = Arc::new(pinned))
    }

    /// Stiffness of each spring, (m,), N/m. Set one number, or one for each.
    ///
    /// >>> import sprung
    /// >>> jelly = sprung.scene("jelly").simulation()
    /// >>> jelly.stiffness = jelly.stiffness / 2
    #[getter]
    fn stiffness<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        views::floats(py, &self.lock(py).simulation.params().spring_stiffness).map(Bound::into_any)
    }

    #[setter]
    fn set_stiffness(&self, py: Python<'_>, given: &Bound<'_, PyAny>) -> PyResult<()> {
        let stiffness = numbers::for_each("stiffness", given, self.springs)?;
        self.set(py, |params| params.spring_stiffness = Arc::new(stiffness))
    }

    /// Damping along each spring, (m,), N·s/m. Set one number, or one for each.
    ///
    /// >>> import sprung
    /// >>> jelly = sprung.scene("jelly").simulation()
    /// >>> jelly.damping = 0
    /// >>> float(jelly.damping.max())
    /// 0.0
    #[getter]
    fn damping<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        views::floats(py, &self.lock(py).simulation.params().spring_damping).map(Bound::into_any)
    }

    #[setter]
    fn set_damping(&self, py: Python<'_>, given: &Bound<'_, PyAny>) -> PyResult<()> {
        let damping = numbers::for_each("damping", given, self.springs)?;
        self.set(py, |params| params.spring_damping = Arc::new(damping))
    }

    /// Rest length of each spring, (m,), m. Set one number, or one for each.
    ///
    /// >>> import sprung
    /// >>> jelly = sprung.scene("jelly").simulation()
    /// >>> jelly.rest_lengths = 1.1 * jelly.rest_lengths  # it swells
    #[getter]
    fn rest_lengths<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        views::floats(py, &self.lock(py).simulation.params().spring_rest_length).map(Bound::into_any)
    }

    #[setter]
    fn set_rest_lengths(&self, py: Python<'_>, given: &Bound<'_, PyAny>) -> PyResult<()> {
        let lengths = numbers::for_each("rest_lengths", given, self.springs)?;
        self.set(py, |params| params.spring_rest_length = Arc::new(lengths))
    }

    /// Whether each spring is cut, (m,): it then exerts no force. Set one for all, or one for each.
    ///
    /// >>> import sprung
    /// >>> chain = sprung.scene("chain").simulation()
    /// >>> cut = chain.cut.copy()
    /// >>> cut[4] = True
    /// >>> chain.cut = cut
    #[getter]
    fn cut<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        views::flags(py, &self.lock(py).simulation.params().spring_cut).map(Bound::into_any)
    }

    #[setter]
    fn set_cut(&self, py: Python<'_>, given: &Bound<'_, PyAny>) -> PyResult<()> {
        let cut = numbers::flags("cut", given, self.springs)?;
        self.set(py, |params| params.spring_cut = Arc::new(cut))
    }

    /// A constant force on each point, (n, 3), N, until others are set; `None` takes them away.
    ///
    /// >>> import sprung
    /// >>> import numpy as np
    /// >>> flag = sprung.scene("flag").simulation()
    /// >>> flag.external_forces = np.full((flag.point_count, 3), [0, 0, 0.01])
    /// >>> flag.step(100)
    /// >>> flag.external_forces = None
    #[getter]
    fn external_forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let inner = self.lock(py);
        let mut forces = vec![[0.0; 3]; self.points];
        for (&point, &force) in &inner.simulation.params().external_forces {
            forces[point] = force.to_array();
        }
        let flat: Vec<f32> = forces.into_flattened();
        let array = PyArray1::from_vec(py, flat).reshape([self.points, 3])?;
        array.readwrite().make_nonwriteable();
        Ok(array)
    }

    #[setter]
    fn set_external_forces(&self, py: Python<'_>, given: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let forces = match given {
            Some(given) => numbers::vectors("external_forces", given, Some(self.points))?,
            None => Vec::new(),
        };
        let acting: BTreeMap<usize, Vec3> =
            forces.into_iter().enumerate().filter(|(_, force)| *force != Vec3::ZERO).collect();
        self.set(py, |params| params.external_forces = acting)
    }

    /// Puts a point there, m, at rest.
    ///
    /// >>> import sprung
    /// >>> chain = sprung.scene("chain").simulation()
    /// >>> chain.place(5, chain.positions[5] + [0, 0.1, 0])
    /// >>> chain.velocities[5].tolist()
    /// [0.0, 0.0, 0.0]
    fn place(&self, py: Python<'_>, point: i64, position: &Bound<'_, PyAny>) -> PyResult<()> {
        let point = numbers::point("place", point, self.points)?;
        self.change(py, Change::Place(point, numbers::vec3("place", position)?))
    }

    /// Carries a point along at this velocity, m/s.
    ///
    /// >>> import sprung
    /// >>> cloth = sprung.scene("cloth").simulation()
    /// >>> cloth.carry(399, [0, 0, 0.5])
    /// >>> cloth.step(100)
    /// >>> cloth.velocities[399].tolist()
    /// [0.0, 0.0, 0.5]
    /// >>> cloth.release(399)
    fn carry(&self, py: Python<'_>, point: i64, velocity: &Bound<'_, PyAny>) -> PyResult<()> {
        let point = numbers::point("carry", point, self.points)?;
        self.change(py, Change::Carry(point, Some(numbers::vec3("carry", velocity)?)))
    }

    /// Pulls a point there, m, by a spring of this stiffness (N/m) and damping (N·s/m), or by one that suits it.
    ///
    /// >>> import sprung
    /// >>> jelly = sprung.scene("jelly").simulation()
    /// >>> jelly.drag(999, [8, 8, 8])
    /// >>> jelly.step(50)
    /// >>> jelly.release(999)
    #[pyo3(signature = (point, target, stiffness=None, damping=None))]
    fn drag(
        &self,
        py: Python<'_>,
        point: i64,
        target: &Bound<'_, PyAny>,
        stiffness: Option<f32>,
        damping: Option<f32>,
    ) -> PyResult<()> {
        let (point, target) = (numbers::point("drag", point, self.points)?, numbers::vec3("drag", target)?);
        self.change_with(py, |Inner { simulation, .. }| {
            let (model, params) = (simulation.model(), simulation.params());
            let made = grab(model, params, &simulation.state().position, point, target, [stiffness, damping]);
            made.map(Change::Grab).map_err(|error| raised(error.at_field("drag")))
        })
    }

    /// Lets a point go that was dragged or carried.
    ///
    /// >>> import sprung
    /// >>> cloth = sprung.scene("cloth").simulation()
    /// >>> cloth.drag(399, [2, 2, 2])
    /// >>> cloth.release(399)
    fn release(&self, py: Python<'_>, point: i64) -> PyResult<()> {
        let point = numbers::point("release", point, self.points)?;
        if self.lock(py).simulation.params().carried.contains_key(&point) {
            self.change(py, Change::Carry(point, None))?;
        }
        self.change(py, Change::Release(point))
    }
}

impl Simulation {
    fn change(&self, py: Python<'_>, change: Change) -> PyResult<()> {
        self.change_with(py, |_| Ok(change))
    }

    fn change_with(&self, py: Python<'_>, change: impl FnOnce(&Inner) -> PyResult<Change>) -> PyResult<()> {
        let mut guard = self.lock(py);
        let inner = &mut *guard;
        let change = change(inner)?;
        py.detach(|| inner.simulation.change(change)).map_err(raised)
    }

    /// Sets whole arrays, or none if they are not allowed.
    fn set(&self, py: Python<'_>, set: impl FnOnce(&mut Params)) -> PyResult<()> {
        self.change_with(py, |inner| {
            let mut params = inner.simulation.params().clone();
            set(&mut params);
            Ok(Change::Params(Arc::new(params)))
        })
    }
}

/// How long a step is to be: a number, s, or "auto", for which it gives nothing.
pub fn step_length(given: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    match given.extract::<String>() {
        Ok(word) if word == "auto" => Ok(None),
        Ok(word) => {
            let sentence = format!("is \"{word}\", and must be a number of seconds or \"auto\"");
            Err(raised(Error::new(Code::WrongType, sentence).at_field("dt")))
        }
        Err(_) => given.extract().map(Some),
    }
}

/// Planes from objects with `point`, `normal`, `stiffness`, `damping` and `law`. A normal may have any length but zero.
pub fn planes_from(planes: &[Bound<'_, PyAny>]) -> PyResult<Vec<Plane>> {
    planes.iter().enumerate().map(|(index, plane)| plane_from(index, plane)).collect()
}

fn plane_from(index: usize, plane: &Bound<'_, PyAny>) -> PyResult<Plane> {
    let field = |name: &str| format!("planes[{index}].{name}");
    let point = numbers::vec3(&field("point"), &plane.getattr("point")?)?;
    let normal = DVec3::from_array(numbers::vector(&field("normal"), &plane.getattr("normal")?)?);
    let law: String = plane.getattr("law")?.extract()?;
    let law = match law.as_str() {
        "push" => ContactLaw::Push,
        "report" => ContactLaw::Report,
        _ => {
            let sentence = format!("is \"{law}\", and must be \"push\" or \"report\"");
            return Err(raised(Error::new(Code::OutOfRange, sentence).at_field(field("law"))));
        }
    };
    let number = |name: &str| plane.getattr(name)?.extract::<f32>();
    let made = Plane::new(point, normal, number("stiffness")?, number("damping")?, law);
    made.map_err(|error| raised(error.within(format!("planes[{index}]"))))
}
