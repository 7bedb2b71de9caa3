//! Semi-implicit ("symplectic") Euler: the method of the report.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use crate::energy::Energy;
use crate::kernel::{Level, Team};
use crate::model::Model;
use crate::params::Params;
use crate::stability::Limit;
use crate::state::{Snapshot, State};
use crate::workers::Workers;

/// The semi-implicit Euler method (Hairer, Lubich, Wanner, *Geometric Numerical Integration*, eq. I.1.9):
/// v⁺ = v + dt·M⁻¹ f(x, v), then x⁺ = x + dt·v⁺.
///
/// It keeps the points in an order and a layout of its own: [`load`](Self::load) a state, [`advance`](Self::advance) it by
/// any number of steps, and [`store`](Self::store) it; [`step`](Self::step) does all three. It also packs masses and
/// springs: tell it with [`refresh`](Self::refresh) when parameters have changed. Each step is the same function of
/// parameters and state, whatever was computed before.
///
/// ```
/// use sprung::{Inline, scene::Scene, solver::SymplecticEuler};
///
/// let simulation = Scene::builtin("jelly")?.simulation()?;
/// let (model, params, mut state) = (simulation.model(), simulation.params(), simulation.state().clone());
/// let mut solver = SymplecticEuler::new(model.clone(), params);
/// solver.load(&state);
/// solver.advance(params, 100, &Inline);
/// solver.store(&mut state);
/// # Ok::<(), sprung::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SymplecticEuler {
    model: Arc<Model>,
    team: Team,
}

impl SymplecticEuler {
    /// A solver for this model under these parameters, with every point at the origin and at rest.
    pub fn new(model: impl Into<Arc<Model>>, params: &Params) -> Self {
        let model = model.into();
        Self { team: Team::new(&model, params), model }
    }

    /// Uses these vector instructions if the processor has them, instead of the widest that it has. The bits are the same.
    pub fn set_level(&mut self, level: Level) {
        self.team.set_level(level);
    }

    /// Takes over new parameters; what is the same as in `old` is not packed again.
    pub fn refresh(&mut self, old: &Params, params: &Params) {
        if !params.shares_springs_with(old) {
            self.team.set_laws(&self.model, params);
        }
        if !params.shares_masses_with(old) || !params.carried.keys().eq(old.carried.keys()) {
            self.team.set_masses(&self.model, params);
        }
    }

    /// Learns that a point is now [carried](Params::carried), or no longer: cheaper than [`refresh`](Self::refresh).
    ///
    /// # Panics
    /// If there is no such point.
    pub fn refresh_point(&mut self, params: &Params, point: usize) {
        self.team.set_mass(&self.model, params, point);
    }

    /// Takes over positions and velocities.
    ///
    /// # Panics
    /// If the state has not as many points as the model.
    pub fn load(&mut self, state: &State) {
        self.team.load(&self.model, state);
    }

    /// Takes up to so many steps of [`Params::dt`], and stops after one that leaves a position that is not finite: the state
    /// is then of no use any more. Returns how many it took, and whether every position is finite.
    ///
    /// Forces add up in this order: springs (in that of the layout, a function of the model), planes, springs between points
    /// that lie very far apart in the layout, external forces, grabs; after the division by the mass, gravity.
    pub fn advance(&mut self, params: &Params, steps: u64, workers: &dyn Workers) -> (u64, bool) {
        self.team.advance(&self.model, params, steps, workers)
    }

    /// Hands out positions and velocities, and leaves the rest of the state as it is.
    ///
    /// # Panics
    /// If the state has not as many points as the model.
    pub fn store(&self, state: &mut State) {
        self.team.store(&self.model, state);
    }

    pub(crate) fn point_count(&self) -> usize {
        self.model.point_count()
    }

    /// Keeps positions and velocities of now, to go back to, in place of those kept before: the next steps leave them alone.
    pub(crate) fn keep(&mut self) {
        self.team.keep();
    }

    /// Hands out positions and velocities as they were kept.
    pub(crate) fn store_kept(&self, state: &mut State) {
        self.team.store_kept(&self.model, state);
    }

    /// Where the energy is now, J, with sums of zero: [`Energy::of`] but for rounding (10⁻¹⁴ of a spring's length), and several
    /// times as fast. The bits are the same for any number of threads.
    pub fn energy(&mut self, params: &Params, workers: &dyn Workers) -> Energy {
        self.team.energy(params, workers)
    }

    /// The kinetic energy now, J: that of [`energy`](Self::energy), bit for bit.
    pub(crate) fn kinetic_energy(&mut self, workers: &dyn Workers) -> f64 {
        self.team.kinetic_energy(workers)
    }

    /// Stops every point where it is, in the middle of a step of `dt` (s).
    pub(crate) fn stop(&mut self, dt: f64) {
        self.team.stop(dt);
    }

    /// Hands out positions and velocities, without what rounding dropped, and leaves the rest of the snapshot as it is.
    pub(crate) fn fill(&self, snapshot: &mut Snapshot) {
        self.team.fill(&self.model, snapshot);
    }

    /// The certified limit now, cheaply; `None` where only the exact one can tell.
    pub(crate) fn certified(&mut self, params: &Params, workers: &dyn Workers) -> Option<Limit> {
        self.team.certified(&self.model, params, workers)
    }

    /// One step of a state: its positions, velocities, step and time. Returns whether every position is still finite.
    pub fn step(&mut self, params: &Params, state: &mut State, workers: &dyn Workers) -> bool {
        self.load(state);
        let (_, finite) = self.advance(params, 1, workers);
        self.store(state);
        state.tick(params.dt);
        finite
    }

    /// Position (m) and velocity (m/s) of one point, with what rounding dropped.
    pub(crate) fn motion64(&self, point: usize) -> [DVec3; 2] {
        self.team.motion64(&self.model, point)
    }

    /// The largest force on any point that it can move, N; infinite where a force is not a number.
    pub fn residual_force(&mut self, params: &Params) -> f64 {
        let mut forces = Vec::new();
        self.forces(params, &mut forces);
        let free = forces.iter().enumerate().filter(|&(point, _)| !params.is_fixed(point));
        let sizes = free.map(|(_, force)| force.as_dvec3().length());
        sizes.map(|size| if size.is_nan() { f64::INFINITY } else { size }).fold(0.0, f64::max)
    }

    /// The total force on each point now, N, as the next step would use it, in the user's order.
    pub fn forces(&mut self, params: &Params, into: &mut Vec<Vec3>) {
        self.team.forces(&self.model, params, into);
    }
}
