//! A simulation as Python holds it.

use std::sync::{Mutex, MutexGuard, PoisonError};

use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use pyo3::types::{PyDict, PySlice};
use sprung::{Code, Error, Result, SettleOptions};
use sprung_io::RunInfo;

use crate::errors::raised;
use crate::model::Model;
use crate::parameters::{planes_from, step_length};
use crate::scene::Scene;
use crate::threads::{Lent, lend};
use crate::{numbers, saving, tell, views};

/// Springs and points that are stepped over between two looks whether somebody pressed Ctrl-C: about a tenth of a second. Less
/// would part the steps that threads take in one go.
const WORK_BETWEEN_LOOKS: u64 = 1 << 27;

/// A simulation. Any thread may use it; one after another.
#[pyclass(frozen, subclass, module = "sprung._engine")]
pub struct Simulation {
    inner: Mutex<Inner>,
    pub points: usize,
    pub springs: usize,
}

pub struct Inner {
    pub simulation: sprung::Simulation,
    current: views::Current,
    lent: Lent,
    /// Where it is from, and what it is called: what checkpoints and exports want to know.
    pub scene: Option<sprung::scene::Scene>,
    pub name: String,
    title: String,
}

type Vertices<'py> = Bound<'py, PyArray2<f32>>;
type Triangles<'py> = Bound<'py, PyArray2<u32>>;

/// What a simulation is made of.
#[derive(FromPyObject)]
pub enum Source {
    Scene(Py<Scene>),
    Model(Py<Model>),
}

#[pymethods]
impl Simulation {
    /// Of a scene or a model at its start, or where `packed` has it. The rest is for models: scenes say it themselves.
    #[new]
    #[pyo3(signature = (source, *, threads=None, packed=None, dt=None, substeps=None, gravity=None, planes=None))]
    #[allow(clippy::too_many_arguments, reason = "called by our own Python")]
    fn new(
        py: Python<'_>,
        source: Source,
        threads: Option<i64>,
        packed: Option<&[u8]>,
        dt: Option<&Bound<'_, PyAny>>,
        substeps: Option<u32>,
        gravity: Option<&Bound<'_, PyAny>>,
        planes: Option<Vec<Bound<'_, PyAny>>>,
    ) -> PyResult<Self> {
        let (scene, name, title) = match &source {
            Source::Scene(scene) => {
                let scene = scene.get();
                (Some(scene.scene.clone()), scene.name.clone(), scene.scene.title.clone())
            }
            Source::Model(model) => (None, "model".to_owned(), model.get().title.clone()),
        };
        let simulation = match &source {
            Source::Scene(scene) => {
                let scene = scene.get();
                py.detach(|| match packed {
                    Some(bytes) => saving::unpacked(bytes)?.simulation(scene.scene.build()?.0),
                    None => scene.simulation(),
                })
            }
            Source::Model(model) => {
                let model = model.get();
                let mut params = model.params.clone();
                let dt = dt.map(step_length).transpose()?.flatten();
                if let Some(substeps) = substeps {
                    params.substeps = substeps;
                }
                if let Some(gravity) = gravity {
                    params.gravity = numbers::vec3("gravity", gravity)?;
                }
                if let Some(planes) = planes {
                    params.planes = planes_from(&planes)?;
                }
                py.detach(|| match packed {
                    Some(bytes) => saving::unpacked(bytes)?.simulation(model.model.clone()),
                    None => {
                        params.dt = match dt {
                            Some(dt) => dt,
                            None => sprung::stability::auto_dt(&model.model, &params)?,
                        };
                        sprung::Simulation::new(model.model.clone(), params, model.state.clone())
                    }
                })
            }
        };
        Self::lent(simulation, scene, name, title, threads).map_err(raised)
    }

    /// So many steps of dt.
    #[pyo3(signature = (count=1))]
    fn step(&self, py: Python<'_>, count: i64) -> PyResult<()> {
        let count = u64::try_from(count).map_err(|_| {
            let sentence = format!("is {count}, and must be a whole number of at least 0");
            raised(Error::new(Code::OutOfRange, sentence).at_field("count"))
        })?;
        self.steps(py, count)
    }

    /// `substeps` steps of dt.
    fn frame(&self, py: Python<'_>) -> PyResult<()> {
        let count = self.lock(py).simulation.params().substeps;
        self.steps(py, count.into())
    }

    /// Back to how it began.
    fn reset(&self, py: Python<'_>) {
        let mut guard = self.lock(py);
        let inner = &mut *guard;
        py.detach(|| inner.simulation.reset());
    }

    /// Brings it to rest; gives the steps that took and the largest force that is left, N.
    #[pyo3(name = "_bring_to_rest")]
    fn bring_to_rest(
        &self,
        py: Python<'_>,
        residual_force: Option<f64>,
        max_steps: Option<u64>,
    ) -> PyResult<(u64, f64)> {
        if let Some(force) = residual_force.filter(|force| !(*force >= 0.0 && force.is_finite())) {
            let sentence = format!("is {force}, and must be a finite number of at least 0 N");
            return Err(raised(Error::new(Code::OutOfRange, sentence).at_field("residual_force")));
        }
        let max_steps = max_steps.unwrap_or(SettleOptions::default().max_steps);
        let options = SettleOptions { residual_force, max_steps };
        let mut guard = self.lock(py);
        let inner = &mut *guard;
        inner.renew_threads()?;
        let mut signal = None;
        let settled = py.detach(|| {
            inner.simulation.settle_with(options, &mut |_| match Python::attach(|py| py.check_signals()) {
                Ok(()) => std::ops::ControlFlow::Continue(()),
                Err(raised) => {
                    signal = Some(raised);
                    std::ops::ControlFlow::Break(())
                }
            })
        });
        if let Some(signal) = signal {
            return Err(signal);
        }
        settled.map(|settled| (settled.steps, settled.residual_force)).map_err(raised)
    }

    /// Positions, (n, 3), m: read-only, and as they are now; after the next step ask again.
    ///
    /// >>> import sprung
    /// >>> cloth = sprung.scene("cloth").simulation()
    /// >>> cloth.step(100)
    /// >>> lowest = cloth.positions[:, 1].argmin()
    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let Inner { simulation, current, .. } = &mut *self.lock(py);
        current.array(py, simulation, |snapshot| &snapshot.positions)
    }

    /// Velocities, (n, 3), m/s: read-only, and as they are now.
    ///
    /// >>> import sprung
    /// >>> jelly = sprung.scene("jelly").simulation()
    /// >>> jelly.step(50)
    /// >>> bool((jelly.velocities[:, 1] < 0).all())
    /// True
    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let Inner { simulation, current, .. } = &mut *self.lock(py);
        current.array(py, simulation, |snapshot| &snapshot.velocities)
    }

    /// Begins anew with these positions, (n, 3), m, and velocities, (n, 3), m/s, or with those there are. `reset` comes back to here.
    ///
    /// >>> import sprung
    /// >>> jelly = sprung.scene("jelly").simulation()
    /// >>> thrown = jelly.velocities + [3, 4, 0]
    /// >>> jelly.set_state(velocities=thrown)
    /// >>> jelly.steps_taken, jelly.velocities[0].tolist()
    /// (0, [3.0, 4.0, 0.0])
    #[pyo3(signature = (positions=None, velocities=None))]
    fn set_state(
        &self,
        py: Python<'_>,
        positions: Option<&Bound<'_, PyAny>>,
        velocities: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let vectors = |field, given: Option<&Bound<'_, PyAny>>| {
            given.map(|given| numbers::vectors(field, given, Some(self.points))).transpose()
        };
        let (positions, velocities) = (vectors("positions", positions)?, vectors("velocities", velocities)?);
        let mut guard = self.lock(py);
        let inner = &mut *guard;
        py.detach(|| inner.begin_with(positions, velocities)).map_err(raised)
    }

    /// The total force on each point now, (n, 3), N, as the next step would use it.
    ///
    /// >>> import sprung
    /// >>> chain = sprung.scene("chain").simulation()
    /// >>> left = chain.settle()
    /// >>> bool((abs(chain.forces()[~chain.pinned]) <= left).all())
    /// True
    fn forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let mut guard = self.lock(py);
        let inner = &mut *guard;
        let forces: Vec<f32> = bytemuck::cast_slice(inner.simulation.forces()).to_vec();
        forces.into_pyarray(py).reshape([self.points, 3])
    }

    /// The step it is at.
    ///
    /// >>> import sprung
    /// >>> jelly = sprung.scene("jelly").simulation()
    /// >>> jelly.step(50)
    /// >>> jelly.steps_taken
    /// 50
    #[getter]
    fn steps_taken(&self, py: Python<'_>) -> u64 {
        self.lock(py).simulation.now().0
    }

    /// The simulated time, s.
    ///
    /// >>> import sprung
    /// >>> jelly = sprung.scene("jelly", {"dt": 0.01}).simulation()
    /// >>> jelly.step(50)
    /// >>> jelly.time
    /// 0.5
    #[getter]
    fn time(&self, py: Python<'_>) -> f64 {
        self.lock(py).simulation.now().1
    }

    /// The fingerprint of positions, velocities and step, as the command prints it.
    ///
    /// >>> import sprung
    /// >>> one, other = (sprung.scene("jelly").simulation(threads=threads) for threads in (1, 2))
    /// >>> one.step(100), other.step(100)
    /// (None, None)
    /// >>> one.state_hash == other.state_hash
    /// True
    #[getter]
    fn state_hash(&self, py: Python<'_>) -> String {
        format!("{:016x}", self.lock(py).simulation.state_hash())
    }

    /// What it is called.
    ///
    /// >>> import sprung
    /// >>> sprung.scene("jelly").simulation().title
    /// 'A cube of jelly falling on a plane'
    #[getter]
    fn title(&self, py: Python<'_>) -> String {
        self.lock(py).title.clone()
    }

    /// How many threads it has been lent.
    ///
    /// >>> import sprung
    /// >>> sprung.scene("jelly").simulation(threads=2).threads
    /// 2
    #[getter]
    fn threads(&self, py: Python<'_>) -> usize {
        self.lock(py).lent.count()
    }

    /// How many points there are.
    ///
    /// >>> import sprung
    /// >>> sprung.scene("jelly").simulation().point_count
    /// 1000
    #[getter]
    fn point_count(&self) -> usize {
        self.points
    }

    /// How many springs there are.
    ///
    /// >>> import sprung
    /// >>> sprung.scene("jelly").simulation().spring_count
    /// 7560
    #[getter]
    fn spring_count(&self) -> usize {
        self.springs
    }

    /// Both ends of every spring, (m, 2).
    ///
    /// >>> import sprung
    /// >>> chain = sprung.scene("chain").simulation()
    /// >>> a, b = chain.springs.T
    /// >>> along = chain.positions[b] - chain.positions[a]
    #[getter]
    fn springs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let inner = self.lock(py);
        let ends: Vec<u32> = inner.simulation.model().springs().as_flattened().to_vec();
        let array = ends.into_pyarray(py).reshape([self.springs, 2])?;
        array.readwrite().make_nonwriteable();
        Ok(array)
    }

    #[pyo3(name = "_tell_bodies")]
    fn tell_bodies<'py>(&self, py: Python<'py>) -> Vec<tell::Body<'py>> {
        tell::bodies(py, self.lock(py).simulation.model())
    }

    #[pyo3(name = "_tell_joints")]
    fn tell_joints<'py>(&self, py: Python<'py>) -> Vec<(String, Bound<'py, PySlice>)> {
        tell::joints(py, self.lock(py).simulation.model())
    }

    /// Body and kind of every surface.
    #[pyo3(name = "_tell_surfaces")]
    fn tell_surfaces(&self, py: Python<'_>) -> Vec<(String, &'static str)> {
        tell::surfaces(self.lock(py).simulation.model())
    }

    /// Vertices (m) and triangles of a surface now: points, or an artist's mesh that they carry along.
    #[pyo3(name = "_surface")]
    fn surface<'py>(&self, py: Python<'py>, index: usize) -> PyResult<(Vertices<'py>, Triangles<'py>)> {
        let mut guard = self.lock(py);
        let inner = &mut *guard;
        let model = inner.simulation.model().clone();
        let surface = &model.surfaces()[index];
        let positions = &inner.simulation.snapshot().positions;
        let vertices: Vec<f32> = match surface.weighted() {
            [] => bytemuck::cast_slice(positions).to_vec(),
            carried => carried.iter().flat_map(|vertex| vertex.of(positions).to_array()).collect(),
        };
        let count = vertices.len() / 3;
        let triangles: Vec<u32> = surface.triangles.as_flattened().to_vec();
        let rows = triangles.len() / 3;
        Ok((vertices.into_pyarray(py).reshape([count, 3])?, triangles.into_pyarray(py).reshape([rows, 3])?))
    }

    /// Where the energy is, and where it went.
    #[pyo3(name = "_energies")]
    fn energies(&self, py: Python<'_>) -> PyResult<[f64; 9]> {
        let mut guard = self.lock(py);
        let inner = &mut *guard;
        inner.renew_threads()?;
        Ok(tell::energy(&py.detach(|| inner.simulation.energy())))
    }

    /// Whether every force's work is summed from here on: at several times the cost of a step, with the same motion.
    ///
    /// >>> import sprung
    /// >>> spring = sprung.scene("spring").simulation()
    /// >>> spring.keeps_ledger = True
    /// >>> spring.step(1000)
    /// >>> spring.energy.lost_in_dampers > 0
    /// True
    #[getter]
    fn keeps_ledger(&self, py: Python<'_>) -> bool {
        self.lock(py).simulation.keeps_ledger()
    }

    #[setter]
    fn set_keeps_ledger(&self, py: Python<'_>, on: bool) {
        self.lock(py).simulation.keep_ledger(on);
    }

    /// The limits on dt, and what sets them.
    #[pyo3(name = "_limits")]
    fn limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        tell::stability(py, &self.lock(py).simulation)
    }

    /// The certified limit alone, as quickly as three steps.
    #[pyo3(name = "_quick_limit")]
    fn quick_limit(&self, py: Python<'_>) -> PyResult<tell::Told> {
        let mut guard = self.lock(py);
        let inner = &mut *guard;
        inner.renew_threads()?;
        let limit = py.detach(|| inner.simulation.certified_limit());
        Ok(tell::limit(&inner.simulation, limit))
    }
}

impl Simulation {
    fn lent(
        simulation: Result<sprung::Simulation>,
        scene: Option<sprung::scene::Scene>,
        name: String,
        title: String,
        threads: Option<i64>,
    ) -> Result<Self> {
        let mut simulation = simulation?;
        let (workers, lent) = lend(threads)?;
        simulation.keep_history(0);
        simulation.set_workers(workers);
        let (points, springs) = (simulation.model().point_count(), simulation.model().spring_count());
        let inner = Inner { simulation, current: views::Current::default(), lent, scene, name, title };
        Ok(Self { inner: Mutex::new(inner), points, springs })
    }

    /// The simulation, once no other thread is using it; those of Python go on meanwhile.
    pub fn lock(&self, py: Python<'_>) -> MutexGuard<'_, Inner> {
        self.inner.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner)
    }

    /// So many steps, in portions: between two of them somebody may press Ctrl-C.
    fn steps(&self, py: Python<'_>, count: u64) -> PyResult<()> {
        let portion = (WORK_BETWEEN_LOOKS / (self.springs + self.points) as u64).max(1);
        let mut left = count;
        while left > 0 {
            let now = left.min(portion);
            let mut guard = self.lock(py);
            let inner = &mut *guard;
            inner.renew_threads()?;
            py.detach(|| inner.steps(now)).map_err(raised)?;
            drop(guard);
            left -= now;
            py.check_signals()?;
        }
        Ok(())
    }
}

impl Inner {
    fn steps(&mut self, count: u64) -> Result<()> {
        self.simulation.steps(count)?;
        self.simulation.forget_long_log();
        Ok(())
    }

    /// Other threads in a process that was forked off.
    pub fn renew_threads(&mut self) -> PyResult<()> {
        if let Some((workers, lent)) = self.lent.anew().map_err(raised)? {
            self.simulation.set_workers(workers);
            self.lent = lent;
        }
        Ok(())
    }

    fn begin_with(
        &mut self,
        positions: Option<Vec<sprung::Vec3>>,
        velocities: Option<Vec<sprung::Vec3>>,
    ) -> Result<()> {
        let mut state = self.simulation.state().clone();
        if let Some(positions) = positions {
            state.position = positions;
            state.position_low.fill(sprung::Vec3::ZERO);
        }
        if let Some(velocities) = velocities {
            state.velocity = velocities;
            state.velocity_low.fill(sprung::Vec3::ZERO);
        }
        let (model, params) = (self.simulation.model().clone(), self.simulation.params().clone());
        let mut simulation = sprung::Simulation::new(model, params, state)?;
        simulation.keep_ledger(self.simulation.keeps_ledger());
        simulation.keep_history(0);
        simulation.set_workers(lend(Some(self.lent.count() as i64))?.0);
        self.simulation = simulation;
        self.current = views::Current::default();
        Ok(())
    }

    /// What exporters want to know of so many frames.
    pub fn info(&self, frame_time: f64, frames: u64) -> RunInfo {
        RunInfo {
            scene: self.name.clone(),
            title: self.title.clone(),
            model: self.simulation.model().clone(),
            params: self.simulation.params().clone(),
            frame_time,
            frames,
        }
    }
}
