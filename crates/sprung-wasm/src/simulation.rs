//! A simulation as the package's JavaScript holds it.

use js_sys::{Array, Float32Array, Uint32Array};
use sprung::scene::Scene;
use sprung::{Change, Code, Error, Grab, Result, SettleOptions, Simulation, Snapshot};
use sprung_driver::grab;
use wasm_bindgen::prelude::*;

use crate::javascript::{Fields, Thrown, index, room_for, thrown, vector, whole};
use crate::pick::{Ray, Target, pick};
use crate::tell;

/// A simulation, its snapshot, and the part of a step that is still due.
#[wasm_bindgen]
#[derive(Debug)]
pub struct EngineSimulation {
    simulation: Simulation,
    title: String,
    description: String,
    snapshot: Snapshot,
    /// [`Simulation::changes`] when the snapshot was filled.
    filled: Option<u64>,
    /// Time handed to [`advance`](Self::advance) that was too short for another step, s.
    due: f64,
}

#[wasm_bindgen]
impl EngineSimulation {
    /// A built-in scene; `changes` are keys and values in turn, as `--set KEY=VALUE` takes them.
    pub fn builtin(name: &str, changes: Vec<String>) -> Thrown<Self> {
        Scene::builtin(name).and_then(|scene| Self::of(scene, &changes)).map_err(thrown)
    }

    /// The scene that a text says; `file` is the name that errors give.
    pub fn parse(text: &str, file: &str, changes: Vec<String>) -> Thrown<Self> {
        Scene::parse(text, file).and_then(|scene| Self::of(scene, &changes)).map_err(thrown)
    }

    /// So many steps of dt.
    pub fn step(&mut self, count: f64) -> Thrown {
        whole("step", count).and_then(|count| self.steps(count)).map_err(thrown)
    }

    /// `substeps` steps of dt.
    pub fn frame(&mut self) -> Thrown {
        self.steps(self.simulation.params().substeps.into()).map_err(thrown)
    }

    /// The steps that are due after so many more seconds, of which no more than `most` count; gives how many steps.
    pub fn advance(&mut self, seconds: f64, most: f64) -> Thrown<f64> {
        for (field, value) in [("seconds", seconds), ("most", most)] {
            if !(0.0..=1e9).contains(&value) {
                let sentence = format!("is {value}, and must be from 0 to 1e9 s");
                return Err(thrown(Error::new(Code::OutOfRange, sentence).at_field(field)));
            }
        }
        let dt = self.simulation.params().dt;
        let due = self.due + seconds.min(most);
        let count = (due / dt).floor();
        self.due = (due - count * dt).max(0.0);
        self.steps(count as u64).map(|()| count).map_err(thrown)
    }

    /// Back to how it began.
    pub fn reset(&mut self) {
        self.due = 0.0;
        self.simulation.reset();
    }

    /// Brings it to rest; gives the steps that took and the largest force that is left.
    pub fn settle(&mut self, residual_force: Option<f64>, max_steps: Option<f64>) -> Thrown<JsValue> {
        let options = settle_options(residual_force, max_steps);
        let settled = options.and_then(|options| self.simulation.settle(options)).map_err(thrown)?;
        let fields = Fields::new().with("steps", settled.steps as f64);
        Ok(fields.with("residualForce", settled.residual_force).done())
    }

    /// How often positions or velocities may have changed: as long as it stays the same, so do they.
    pub fn changes(&self) -> f64 {
        self.simulation.changes() as f64
    }

    /// Copies the positions into an array of three numbers for each point.
    pub fn copy_positions(&mut self, target: &Float32Array) -> Thrown {
        self.fill();
        copy(bytemuck::cast_slice(&self.snapshot.positions), target)
    }

    /// Copies the velocities likewise.
    pub fn copy_velocities(&mut self, target: &Float32Array) -> Thrown {
        self.fill();
        copy(bytemuck::cast_slice(&self.snapshot.velocities), target)
    }

    /// Where in memory the snapshot's positions and its velocities lie, filled anew.
    pub fn snapshot_at(&mut self) -> Vec<usize> {
        self.fill();
        vec![self.snapshot.positions.as_ptr() as usize, self.snapshot.velocities.as_ptr() as usize]
    }

    /// The step it is at.
    pub fn steps_taken(&self) -> f64 {
        self.simulation.now().0 as f64
    }

    /// The simulated time, s.
    pub fn time(&self) -> f64 {
        self.simulation.now().1
    }

    /// The fingerprint of positions, velocities and step, as the command prints it.
    pub fn state_hash(&self) -> String {
        format!("{:016x}", self.simulation.state_hash())
    }

    /// What the scene is called.
    pub fn title(&self) -> String {
        self.title.clone()
    }

    /// What there is to see.
    pub fn description(&self) -> String {
        self.description.clone()
    }

    /// How many points there are.
    pub fn point_count(&self) -> usize {
        self.simulation.model().point_count()
    }

    /// How many springs there are.
    pub fn spring_count(&self) -> usize {
        self.simulation.model().spring_count()
    }

    /// Both ends of every spring.
    pub fn springs(&self) -> Uint32Array {
        Uint32Array::from(bytemuck::cast_slice::<_, u32>(self.simulation.model().springs()))
    }

    /// Name, points and springs of every body.
    pub fn bodies(&self) -> Array {
        tell::bodies(self.simulation.model())
    }

    /// Name and springs of every joint.
    pub fn joints(&self) -> Array {
        tell::joints(self.simulation.model())
    }

    /// Body, kind and triangles of every surface.
    pub fn surfaces(&self) -> Array {
        tell::surfaces(self.simulation.model())
    }

    /// Where the energy is, and where it went.
    pub fn energy(&mut self) -> JsValue {
        tell::energy(&self.simulation.energy())
    }

    /// Sums every force's work from here on, or no longer.
    pub fn keep_ledger(&mut self, on: bool) {
        self.simulation.keep_ledger(on);
    }

    /// Whether it does.
    pub fn keeps_ledger(&self) -> bool {
        self.simulation.keeps_ledger()
    }

    /// The limits on dt, and what sets them.
    pub fn stability(&mut self) -> JsValue {
        tell::stability(&self.simulation)
    }

    /// The certified limit alone, as quickly as three steps.
    pub fn certified_limit(&mut self) -> JsValue {
        let limit = self.simulation.certified_limit();
        tell::limit(&self.simulation, limit)
    }

    /// A parameter as it is now.
    pub fn get(&self, name: &str) -> Thrown<JsValue> {
        tell::parameter(&self.simulation, name).map_err(thrown)
    }

    /// A parameter of one point or spring.
    pub fn get_of(&self, name: &str, of: f64) -> Thrown<f64> {
        tell::parameter_of(&self.simulation, name, of).map_err(thrown)
    }

    /// Length of a step, s.
    pub fn set_dt(&mut self, dt: f64) -> Thrown {
        self.change(Ok(Change::Dt(dt)))
    }

    /// Length of a step: the largest that is safely stable.
    pub fn set_dt_auto(&mut self) -> Thrown {
        let dt = sprung::stability::auto_dt(self.simulation.model(), self.simulation.params());
        self.change(dt.map(Change::Dt))
    }

    /// Steps per frame.
    pub fn set_substeps(&mut self, substeps: f64) -> Thrown {
        let substeps = whole("substeps", substeps).map(|count| u32::try_from(count).unwrap_or(u32::MAX));
        self.change(substeps.map(Change::Substeps))
    }

    /// Gravitational acceleration, m/s².
    pub fn set_gravity(&mut self, x: f64, y: f64, z: f64) -> Thrown {
        self.change(Ok(Change::Gravity(vector(x, y, z))))
    }

    /// All planes: nine numbers for each.
    pub fn set_planes(&mut self, numbers: &[f64]) -> Thrown {
        self.change(tell::planes_from(numbers).map(Change::Planes))
    }

    /// A parameter of some points or springs, by its name.
    pub fn set_range(&mut self, name: &str, first: f64, end: f64, value: f64) -> Thrown {
        let change = || {
            let (range, number) = (index(name, first)?..index(name, end)?, value as f32);
            Ok(match name {
                "mass" => Change::Mass(range, number),
                "stiffness" => Change::Stiffness(range, number),
                "damping" => Change::Damping(range, number),
                "restScale" => Change::RestScale(range, number),
                "pin" => Change::Pin(range, value != 0.0),
                "cut" => Change::Cut(range, value != 0.0),
                _ => return Err(tell::no_such_parameter(name)),
            })
        };
        self.change(change())
    }

    /// A constant force on a point, N.
    pub fn force(&mut self, point: f64, x: f64, y: f64, z: f64) -> Thrown {
        self.change(index("force", point).map(|point| Change::Force(point, vector(x, y, z))))
    }

    /// Puts a point there, m, at rest.
    pub fn place(&mut self, point: f64, x: f64, y: f64, z: f64) -> Thrown {
        self.change(index("place", point).map(|point| Change::Place(point, vector(x, y, z))))
    }

    /// Carries a point along at this velocity, m/s.
    pub fn carry(&mut self, point: f64, x: f64, y: f64, z: f64) -> Thrown {
        self.change(index("carry", point).map(|point| Change::Carry(point, Some(vector(x, y, z)))))
    }

    /// Pulls a point there by a spring: one of this stiffness (N/m) and damping (N·s/m), or else the one that pulls it
    /// already, or one that suits the point.
    pub fn drag(&mut self, point: f64, x: f64, y: f64, z: f64, spring: Option<Vec<f32>>) -> Thrown {
        let change = self
            .grab(point, spring.as_deref())
            .map(|grab| Change::Grab(Grab { target: vector(x, y, z), ..grab }));
        self.change(change)
    }

    /// Lets a point go that was dragged or carried.
    pub fn release(&mut self, point: f64) -> Thrown {
        let point = index("release", point).map_err(thrown)?;
        if self.simulation.params().carried.contains_key(&point) {
            self.change(Ok(Change::Carry(point, None)))?;
        }
        self.change(Ok(Change::Release(point)))
    }

    /// What a ray meets: the ray's origin (m), its direction, and within how far of it.
    #[allow(clippy::too_many_arguments, reason = "plain numbers, from our own JavaScript")]
    pub fn pick(
        &mut self,
        x: f64,
        y: f64,
        z: f64,
        along_x: f64,
        along_y: f64,
        along_z: f64,
        radius: f64,
        spread: f64,
    ) -> Thrown<JsValue> {
        let ray = Ray::new([x, y, z], [along_x, along_y, along_z], radius, spread).map_err(thrown)?;
        self.fill();
        let (model, params) = (self.simulation.model(), self.simulation.params());
        let Some(picked) = pick(model, &params.spring_cut, &self.snapshot.positions, &ray) else {
            return Ok(JsValue::NULL);
        };
        let fields = match picked.target {
            Target::Point(point) => Fields::new().with("kind", "point").with("index", point as f64),
            Target::Spring(spring) => Fields::new().with("kind", "spring").with("index", spring as f64),
        };
        let name = match picked.target {
            Target::Point(point) => model.point_name(point),
            Target::Spring(spring) => model.spring_name(spring),
        };
        let position: Array = picked.position.to_array().into_iter().map(JsValue::from).collect();
        Ok(fields.with("name", name).with("position", position).with("distance", picked.distance).done())
    }
}

impl EngineSimulation {
    /// Of a scene with its changes, if there is room for it.
    fn of(mut scene: Scene, changes: &[String]) -> Result<Self> {
        for change in changes.chunks_exact(2) {
            scene.set(&change[0], &change[1])?;
        }
        scene.check_spring_count()?;
        room_for(scene.estimated_bytes(), "the scene")?;
        let simulation = scene.simulation()?;
        Ok(Self::new(simulation, scene.title, scene.description))
    }

    /// Around one that has been made.
    pub(crate) fn new(mut simulation: Simulation, title: String, description: String) -> Self {
        simulation.keep_history(0);
        Self { simulation, title, description, snapshot: Snapshot::default(), filled: None, due: 0.0 }
    }

    fn steps(&mut self, count: u64) -> Result<()> {
        if count == 0 {
            return Ok(());
        }
        self.simulation.steps(count)?;
        self.simulation.forget_long_log();
        Ok(())
    }

    fn change(&mut self, change: Result<Change>) -> Thrown {
        change.and_then(|change| self.simulation.change(change)).map_err(thrown)
    }

    /// The pull at a point but for where it pulls to.
    fn grab(&mut self, point: f64, spring: Option<&[f32]>) -> Result<Grab> {
        let point = index("drag", point)?;
        let (model, params) = (self.simulation.model(), self.simulation.params());
        let spring = [0, 1].map(|at| spring.and_then(|spring| spring.get(at).copied()));
        let positions = &self.simulation.state().position;
        let made = grab(model, params, positions, point, sprung::Vec3::ZERO, spring);
        made.map_err(|error| error.at_field("drag"))
    }

    fn fill(&mut self) {
        let changes = self.simulation.changes();
        if self.filled != Some(changes) {
            self.simulation.fill(&mut self.snapshot);
            self.filled = Some(changes);
        }
    }
}

fn settle_options(residual_force: Option<f64>, max_steps: Option<f64>) -> Result<SettleOptions> {
    let max_steps =
        max_steps.map_or(Ok(SettleOptions::default().max_steps), |most| whole("maxSteps", most))?;
    match residual_force {
        Some(force) if !(force >= 0.0 && force.is_finite()) => {
            let sentence = format!("is {force}, and must be a finite number of at least 0 N");
            Err(Error::new(Code::OutOfRange, sentence).at_field("residualForce"))
        }
        _ => Ok(SettleOptions { residual_force, max_steps }),
    }
}

fn copy(values: &[f32], target: &Float32Array) -> Thrown {
    let (has, needs) = (target.length() as usize, values.len());
    if has == needs {
        target.copy_from(values);
        return Ok(());
    }
    let sentence = format!("has room for {has} numbers, and {needs} are needed: three for each point");
    Err(thrown(Error::new(Code::Conflict, sentence).at_field("target")))
}
