//! Arrays that show the engine's own memory, without a copy.
//!
//! Nobody can write through such an array, and what it shows never changes: its memory belongs to an object that the array
//! keeps alive, and is written to again only when no array shows it any more.
#![allow(unsafe_code)]

use std::sync::Arc;

use numpy::ndarray::{ArrayView, Dimension, IntoDimension};
use numpy::{Element, PyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use sprung::{Simulation, Snapshot, Vec3};

/// An array over `values`, which `owner` has.
fn view<'py, T: Element, I: IntoDimension<Dim = D>, D: Dimension>(
    values: &[T],
    shape: I,
    owner: &Bound<'py, PyAny>,
) -> Bound<'py, PyArray<T, D>> {
    let values = ArrayView::from_shape(shape, values).expect("callers give as many values as the shape has");
    // SAFETY: the array keeps `owner` alive, and all three owners there are (below, and `Frames`) neither move nor change their
    // values while they are shared: `Shared` and `Frames` never do, `Buffer` only while nobody else has it.
    let array = unsafe { PyArray::borrow_from_array(&values, owner.clone()) };
    array.readwrite().make_nonwriteable();
    array
}

/// An array of the model or of the parameters.
#[pyclass(frozen)]
pub struct Shared(Values);

enum Values {
    Floats(Arc<Vec<f32>>),
    Flags(Arc<Vec<bool>>),
}

/// A number for each point or spring.
pub fn floats<'py>(py: Python<'py>, values: &Arc<Vec<f32>>) -> PyResult<Bound<'py, PyArray1<f32>>> {
    let owner = Bound::new(py, Shared(Values::Floats(values.clone())))?;
    let Values::Floats(values) = &owner.get().0 else { unreachable!() };
    Ok(view(values, values.len(), owner.as_any()))
}

/// True or false for each.
pub fn flags<'py>(py: Python<'py>, values: &Arc<Vec<bool>>) -> PyResult<Bound<'py, PyArray1<bool>>> {
    let owner = Bound::new(py, Shared(Values::Flags(values.clone())))?;
    let Values::Flags(values) = &owner.get().0 else { unreachable!() };
    Ok(view(values, values.len(), owner.as_any()))
}

/// Rows of three, in memory that nobody changes as long as `owner` lives.
pub fn rows<'py>(vectors: &[Vec3], owner: &Bound<'py, PyAny>) -> Bound<'py, PyArray2<f32>> {
    view(bytemuck::cast_slice(vectors), [vectors.len(), 3], owner)
}

/// A snapshot that arrays show.
#[pyclass]
pub struct Buffer(Snapshot);

/// The snapshot of a simulation, taken anew when it has moved on.
#[derive(Default)]
pub struct Current {
    buffer: Option<Py<Buffer>>,
    /// [`Simulation::changes`] when it was taken.
    taken: Option<u64>,
}

impl Current {
    /// Positions or velocities now. Arrays that were given before keep what they show.
    pub fn array<'py>(
        &mut self,
        py: Python<'py>,
        simulation: &Simulation,
        choose: impl Fn(&Snapshot) -> &Vec<Vec3>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let changes = simulation.changes();
        if self.taken != Some(changes) {
            // SAFETY: the object is alive, and we hold the interpreter.
            let is_ours = |buffer: &Py<Buffer>| unsafe { pyo3::ffi::Py_REFCNT(buffer.as_ptr()) } == 1;
            // Only we have it: no array shows it.
            let free = self.buffer.take().filter(is_ours);
            let buffer = free.map_or_else(|| Py::new(py, Buffer(Snapshot::default())), Ok)?;
            simulation.fill(&mut buffer.bind(py).borrow_mut().0);
            self.buffer = Some(buffer);
            self.taken = Some(changes);
        }
        let buffer = self.buffer.as_ref().expect("it was taken").bind(py);
        Ok(rows(choose(&buffer.borrow().0), buffer.as_any()))
    }
}

/// Three axes: so many frames of so many points.
pub fn frames<'py>(
    vectors: &[Vec3],
    frames: usize,
    owner: &Bound<'py, PyAny>,
) -> Bound<'py, numpy::PyArray3<f32>> {
    let points = vectors.len().checked_div(frames).unwrap_or(0);
    view(bytemuck::cast_slice(vectors), [frames, points, 3], owner)
}
