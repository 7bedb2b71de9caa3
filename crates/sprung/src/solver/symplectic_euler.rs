//! Semi-implicit ("symplectic") Euler: the method of the report.

use glam::Vec3;

use crate::force;
use crate::kernel::{Motion, SpringKernel, advance};
use crate::model::Model;
use crate::params::Params;
use crate::state::State;
use crate::workers::Workers;

/// The semi-implicit Euler method (Hairer, Lubich, Wanner, *Geometric Numerical Integration*, eq. I.1.9):
/// v⁺ = v + dt·M⁻¹ f(x, v), then x⁺ = x + dt·v⁺.
///
/// Owns its scratch memory, in which it packs masses and springs: make it anew when masses, pins, springs or their
/// parameters have changed, and [`refresh_point`](Self::refresh_point) where a hand takes or leaves one. Each step is the same function of parameters and state, whatever was computed before.
#[derive(Clone, Debug)]
pub struct SymplecticEuler {
    springs: SpringKernel,
    inverse_mass: Vec<f32>,
    /// Forces, N, and after division by the mass accelerations, m/s². Zero between steps.
    forces: Vec<Vec3>,
}

impl SymplecticEuler {
    /// A solver for this model under these parameters.
    pub fn new(model: &Model, params: &Params) -> Self {
        Self {
            springs: SpringKernel::new(model, params),
            inverse_mass: (0..model.point_count()).map(|point| params.inverse_mass(point)).collect(),
            forces: vec![Vec3::ZERO; model.point_count()],
        }
    }

    /// Learns that a point is now [carried](Params::carried), or no longer: cheaper than making the solver anew.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn refresh_point(&mut self, params: &Params, point: usize) {
        self.inverse_mass[point] = params.inverse_mass(point);
    }

    /// Takes one step. Returns whether every position is still finite; if not, the state is of no use any more.
    ///
    /// Forces add up in this order: springs (each point's in ascending order of their index), external forces, grabs, gravity, planes.
    pub fn step(&mut self, params: &Params, state: &mut State, workers: &dyn Workers) -> bool {
        // 1. and 2. Forces on every point.
        self.accumulate(params, state, workers);

        // Accelerations f/m; zero where the point is fixed.
        for (force, &inverse_mass) in self.forces.iter_mut().zip(&self.inverse_mass) {
            *force *= inverse_mass;
        }

        // 3. v += f/m·dt, then x += v·dt.
        let motion = Motion {
            position: bytemuck::cast_slice_mut(&mut state.position),
            position_low: bytemuck::cast_slice_mut(&mut state.position_low),
            velocity: bytemuck::cast_slice_mut(&mut state.velocity),
            velocity_low: bytemuck::cast_slice_mut(&mut state.velocity_low),
        };
        let finite = advance(motion, bytemuck::cast_slice(&self.forces), params.dt as f32);

        // Then every f is set to zero.
        self.forces.fill(Vec3::ZERO);
        state.tick(params.dt);
        finite
    }

    /// The largest force on any point that it can move, N, at this state.
    pub fn residual_force(&mut self, params: &Params, state: &State, workers: &dyn Workers) -> f64 {
        self.accumulate(params, state, workers);
        let free =
            self.forces.iter().zip(&self.inverse_mass).filter(|&(_, &inverse_mass)| inverse_mass > 0.0);
        let largest = free.map(|(force, _)| force.as_dvec3().length()).fold(0.0, f64::max);
        self.forces.fill(Vec3::ZERO);
        largest
    }

    /// The total force on each point at this state, N, as a step would use it. At a point that no force can move this is
    /// what pulls at it, but for springs to others that are held, which a step need not know.
    pub fn forces(&mut self, params: &Params, state: &State, workers: &dyn Workers, into: &mut Vec<Vec3>) {
        self.accumulate(params, state, workers);
        into.clone_from(&self.forces);
        self.forces.fill(Vec3::ZERO);
    }

    fn accumulate(&mut self, params: &Params, state: &State, workers: &dyn Workers) {
        let forces = &mut self.forces;
        self.springs.accumulate(&state.position, &state.velocity, forces, workers);
        force::external::accumulate(params, forces);
        force::grab::accumulate(params, state, forces);
        force::gravity::accumulate(params, forces);
        force::contact::accumulate(params, state, forces);
    }
}
