//! Recorded frames: positions, velocities and energies over time, and every exporter.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use pyo3::types::PyBytes;
use sprung::{Code, Error, Model, Params, Result, Snapshot, Vec3};
use sprung_io::{Frame, Options, Pack, RunInfo, Springs, Unpack, Up};
use sprung_render::export::exporter_for;

use crate::errors::raised;
use crate::simulation::{Simulation, Source};
use crate::{tell, views};

/// Numbers that tell the energies of a frame.
const ENERGIES: usize = 9;

/// Frames of one simulation, growing until they are finished.
#[pyclass(frozen, module = "sprung._engine")]
pub struct Recorder(Mutex<Content>);

/// The same, finished: they never change again.
#[pyclass(frozen, subclass, module = "sprung._engine")]
pub struct Frames(Content);

struct Content {
    /// What is recorded: the scene, the model, the time from one frame to the next.
    info: RunInfo,
    /// Whether velocities are kept.
    keeps_velocities: bool,
    /// Of each frame: step, time (s), the energies (J), and the parameters, which frames share while they are the same.
    steps: Vec<u64>,
    times: Vec<f64>,
    energies: Vec<[f64; ENERGIES]>,
    params: Vec<Arc<Params>>,
    /// One frame after another, m and m/s.
    positions: Vec<Vec3>,
    velocities: Vec<Vec3>,
    /// Frames at the end in which energy came from nowhere: they may belong to a blow-up.
    suspect: usize,
    snapshot: Snapshot,
}

#[pymethods]
impl Recorder {
    /// For so many frames of a simulation, if there is memory for them.
    #[new]
    fn new(
        py: Python<'_>,
        simulation: &Simulation,
        frame_time: f64,
        frames: u64,
        velocities: bool,
    ) -> PyResult<Self> {
        let info = simulation.lock(py).info(frame_time, frames);
        let bytes = (simulation.points as u64 * if velocities { 24 } else { 12 }).saturating_mul(frames);
        sprung_cli::memory::check(bytes, "the recording").map_err(|error| {
            raised(error.with_fix(
                "record fewer frames or leave out velocities; `sprung run` writes files as it goes",
            ))
        })?;
        Ok(Self(Mutex::new(Content::new(info, velocities))))
    }

    /// Takes the simulation as it is now.
    fn take(&self, py: Python<'_>, simulation: &Simulation) -> PyResult<()> {
        let (mut content, mut inner) = (self.lock(py), simulation.lock(py));
        let (content, inner) = (&mut *content, &mut *inner);
        inner.renew_threads()?;
        py.detach(|| content.take(&mut inner.simulation));
        Ok(())
    }

    /// What was taken, but for what may belong to a blow-up if there was one; nothing is left here.
    fn finish(&self, py: Python<'_>, blew_up: bool) -> Frames {
        let mut content = self.lock(py);
        let mut taken = content.take_all();
        if blew_up {
            taken.drop_suspects();
        }
        Frames(taken)
    }
}

impl Recorder {
    fn lock(&self, py: Python<'_>) -> MutexGuard<'_, Content> {
        self.0.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner)
    }
}

impl Content {
    fn new(info: RunInfo, keeps_velocities: bool) -> Self {
        Self {
            info,
            keeps_velocities,
            steps: Vec::new(),
            times: Vec::new(),
            energies: Vec::new(),
            params: Vec::new(),
            positions: Vec::new(),
            velocities: Vec::new(),
            suspect: 0,
            snapshot: Snapshot::default(),
        }
    }

    /// All frames so far; none are left here.
    fn take_all(&mut self) -> Self {
        let empty = Self::new(self.info.clone(), self.keeps_velocities);
        std::mem::replace(self, empty)
    }

    fn take(&mut self, simulation: &mut sprung::Simulation) {
        let is_suspect = simulation.is_suspect();
        self.suspect = if is_suspect { self.suspect + 1 } else { 0 };
        self.energies.push(tell::energy(&simulation.energy()));
        // What acts from outside is in no file: frames of a wind that changes share the rest.
        let params = Params {
            external_forces: BTreeMap::new(),
            carried: BTreeMap::new(),
            grabs: Vec::new(),
            ..simulation.params().clone()
        };
        match self.params.last() {
            Some(last) if **last == params => self.params.push(last.clone()),
            _ => self.params.push(Arc::new(params)),
        }
        simulation.fill(&mut self.snapshot);
        self.steps.push(self.snapshot.step);
        self.times.push(self.snapshot.time);
        self.positions.extend_from_slice(&self.snapshot.positions);
        if self.keeps_velocities {
            self.velocities.extend_from_slice(&self.snapshot.velocities);
        }
    }

    fn drop_suspects(&mut self) {
        // The first frame is how it began.
        let kept = (self.steps.len() - self.suspect.min(self.steps.len())).max(1).min(self.steps.len());
        let points = self.info.model.point_count();
        self.steps.truncate(kept);
        self.times.truncate(kept);
        self.energies.truncate(kept);
        self.params.truncate(kept);
        self.positions.truncate(kept * points);
        self.velocities.truncate(kept * points);
        self.suspect = 0;
    }

    fn frame(&self, index: usize, snapshot: &mut Snapshot) {
        let points = self.info.model.point_count();
        let range = index * points..(index + 1) * points;
        snapshot.step = self.steps[index];
        snapshot.time = self.times[index];
        snapshot.positions.clear();
        snapshot.positions.extend_from_slice(&self.positions[range.clone()]);
        snapshot.velocities.clear();
        if self.keeps_velocities {
            snapshot.velocities.extend_from_slice(&self.velocities[range]);
        } else {
            snapshot.velocities.resize(points, Vec3::ZERO);
        }
    }
}

#[pymethods]
impl Frames {
    /// From the bytes that `pack` gives, and what the simulation was of.
    #[new]
    fn new(py: Python<'_>, source: Source, packed: &[u8]) -> PyResult<Self> {
        let model = match &source {
            Source::Scene(scene) => {
                let scene = scene.get();
                Arc::new(py.detach(|| scene.scene.build()).map_err(raised)?.0)
            }
            Source::Model(model) => model.get().model.clone(),
        };
        py.detach(|| unpacked(model, packed)).map(Self).map_err(raised)
    }

    /// All of it but the model.
    fn pack<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &py.detach(|| packed(&self.0)))
    }

    fn __len__(&self) -> usize {
        self.0.steps.len()
    }

    #[getter]
    fn title(&self) -> &str {
        &self.0.info.title
    }

    #[getter]
    fn frame_time(&self) -> f64 {
        self.0.info.frame_time
    }

    #[getter]
    fn steps<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u64>> {
        self.0.steps.clone().into_pyarray(py)
    }

    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.0.times.clone().into_pyarray(py)
    }

    /// A row for each frame.
    #[getter]
    fn energies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let rows = self.0.energies.len();
        self.0.energies.as_flattened().to_vec().into_pyarray(py).reshape([rows, ENERGIES])
    }

    #[getter]
    fn positions<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray3<f32>> {
        let content = &slf.get().0;
        views::frames(&content.positions, content.steps.len(), slf.as_any())
    }

    #[getter]
    fn velocities<'py>(slf: &Bound<'py, Self>) -> Option<Bound<'py, PyArray3<f32>>> {
        let content = &slf.get().0;
        content
            .keeps_velocities
            .then(|| views::frames(&content.velocities, content.steps.len(), slf.as_any()))
    }

    /// The vertices of a surface in every frame, m.
    fn surface<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let (points, frames) = (self.0.info.model.point_count(), self.0.steps.len());
        let surface = &self.0.info.model.surfaces()[index];
        let vertices: Vec<f32> = match surface.weighted() {
            [] => bytemuck::cast_slice(&self.0.positions).to_vec(),
            carried => {
                let of_frame = |positions: &[Vec3]| -> Vec<[f32; 3]> {
                    carried.iter().map(|vertex| vertex.of(positions).to_array()).collect()
                };
                self.0.positions.chunks_exact(points).flat_map(of_frame).flatten().collect()
            }
        };
        let count = vertices.len() / 3 / frames.max(1);
        vertices.into_pyarray(py).reshape([frames, count, 3])
    }

    fn tell_bodies<'py>(&self, py: Python<'py>) -> Vec<tell::Body<'py>> {
        tell::bodies(py, &self.0.info.model)
    }

    /// Writes them in the format that the file's ending asks for; gives the file's size in bytes.
    #[pyo3(signature = (path, *, size, at, up, scale, springs, bodies, points, told))]
    #[allow(clippy::too_many_arguments, reason = "called by our own Python")]
    fn write(
        &self,
        py: Python<'_>,
        path: PathBuf,
        size: Option<[u32; 2]>,
        at: Option<f64>,
        up: &str,
        scale: f64,
        springs: Option<&str>,
        bodies: Option<Vec<String>>,
        points: bool,
        told: Option<Py<PyAny>>,
    ) -> PyResult<u64> {
        let options = Options {
            size,
            at,
            up: one_of("up", up, &[("y", Up::Y), ("z", Up::Z)])?,
            scale,
            springs: springs
                .map(|springs| {
                    let styles =
                        [("none", Springs::None), ("lines", Springs::Lines), ("tubes", Springs::Tubes)];
                    one_of("springs", springs, &styles)
                })
                .transpose()?,
            bodies,
            points,
            resumable: false,
        };
        let mut signal = None;
        let mut tell = |share: f64| {
            Python::attach(|py| {
                let heard = told.as_ref().map_or(Ok(()), |told| told.call1(py, (share,)).map(|_| ()));
                match heard.and_then(|()| py.check_signals()) {
                    Ok(()) => ControlFlow::Continue(()),
                    Err(raised) => {
                        signal = Some(raised);
                        ControlFlow::Break(())
                    }
                }
            })
        };
        let written = py.detach(|| self.0.write(&path, &options, &mut tell));
        match signal {
            Some(signal) => Err(signal),
            None => written.map_err(raised),
        }
    }
}

impl Content {
    fn write(
        &self,
        path: &std::path::Path,
        options: &Options,
        tell: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<u64> {
        let exporter = exporter_for(path)?;
        let info = RunInfo {
            params: (*self.params[0]).clone(),
            frames: self.steps.len() as u64,
            ..self.info.clone()
        };
        let mut export = (exporter.open)(path, &info, options)?;
        let mut snapshot = Snapshot::default();
        let count = self.steps.len();
        for index in 0..count {
            self.frame(index, &mut snapshot);
            let frame =
                Frame { index: index as u64, snapshot: &snapshot, params: &self.params[index], energy: None };
            export.frame(&frame)?;
            // Half of it, as some formats do the other half at the end.
            if tell(0.5 * (index + 1) as f64 / count as f64).is_break() {
                return Err(Error::new(Code::Interrupted, "interrupted"));
            }
        }
        Ok(export.finish(&mut |share| tell(0.5 + 0.5 * share))?.bytes)
    }
}

fn one_of<T: Copy>(field: &str, given: &str, allowed: &[(&str, T)]) -> PyResult<T> {
    allowed.iter().find(|(name, _)| *name == given).map(|(_, value)| *value).ok_or_else(|| {
        let names = allowed.iter().map(|(name, _)| format!("\"{name}\"")).collect::<Vec<_>>().join(" or ");
        raised(Error::new(Code::OutOfRange, format!("is \"{given}\", and must be {names}")).at_field(field))
    })
}

fn packed(content: &Content) -> Vec<u8> {
    let mut pack = Pack::new();
    let RunInfo { scene, title, frame_time, .. } = &content.info;
    pack.text(scene).text(title).f64(*frame_time);
    pack.u8(content.keeps_velocities.into()).u64(content.steps.len() as u64);
    content.steps.iter().for_each(|&step| {
        pack.u64(step);
    });
    pack.f64s(&content.times).f64s(content.energies.as_flattened());
    let mut last: Option<&Arc<Params>> = None;
    for params in &content.params {
        let is_new = last.is_none_or(|last| !Arc::ptr_eq(last, params));
        pack.u8(is_new.into());
        if is_new {
            pack.params(params);
        }
        last = Some(params);
    }
    pack.vec3s(&content.positions).vec3s(&content.velocities);
    pack.into_bytes()
}

fn unpacked(model: Arc<Model>, bytes: &[u8]) -> Result<Content> {
    let mut unpack = Unpack::new(bytes);
    let (scene, title) = (unpack.text()?.to_owned(), unpack.text()?.to_owned());
    let (frame_time, keeps_velocities) = (unpack.f64()?, unpack.bool()?);
    let frames = unpack.u64()?;
    let steps = (0..frames).map(|_| unpack.u64()).collect::<Result<Vec<_>>>()?;
    let (times, energies) = (unpack.f64s()?, unpack.f64s()?.as_chunks::<ENERGIES>().0.to_vec());
    let mut params: Vec<Arc<Params>> = Vec::new();
    for _ in 0..frames {
        let is_new = unpack.bool()?;
        match params.last().filter(|_| !is_new).cloned() {
            Some(same) => params.push(same),
            None => {
                let own = unpack.params()?;
                own.validate(&model)?;
                params.push(Arc::new(own));
            }
        }
    }
    let (positions, velocities) = (unpack.vec3s()?, unpack.vec3s()?);
    unpack.end()?;
    let count = steps.len() * model.point_count();
    let fits = times.len() == steps.len()
        && energies.len() == steps.len()
        && positions.len() == count
        && velocities.len() == if keeps_velocities { count } else { 0 };
    if !fits {
        return Err(Error::new(Code::Conflict, "the frames are not those of this model"));
    }
    let Some(first) = params.first() else {
        return Err(Error::new(Code::Conflict, "there are no frames"));
    };
    let info = RunInfo { scene, title, model, params: (**first).clone(), frame_time, frames };
    let content = Content::new(info, keeps_velocities);
    Ok(Content { steps, times, energies, params, positions, velocities, ..content })
}
