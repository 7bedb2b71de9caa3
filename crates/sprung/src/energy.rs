//! The energy ledger: where the energy is, and where it went.
//!
//! In a step from state n to n + 1 a force F does the work F_n·(v_n + v_{n+1})·dt/2. Over all forces these works add up to
//! the change of kinetic energy exactly, since v_{n+1} − v_n = dt·ΣF_n/m. What the integrator adds of its own is then
//! the change of each potential plus the work of its force: computed, not what is left over. It halves with dt.

use glam::DVec3;

use crate::force::{self, Account, FORCES, Store};
use crate::hand::Hand;
use crate::model::Model;
use crate::params::Params;
use crate::state::State;

/// Works summed since the start, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LedgerSums {
    /// Kinetic and potential energy at the start.
    pub start: f64,
    /// Work put in by external forces, grabs, carrying hands and changes of the parameters. Always kept.
    pub work_in: f64,
    /// Energy taken out by the springs' dampers, while the ledger is on.
    pub lost_in_dampers: f64,
    /// Energy taken out by contact, while the ledger is on.
    pub lost_in_contact: f64,
    /// Energy that the integrator made (positive) or lost (negative), while the ledger is on.
    pub integrator_error: f64,
    /// Steps in a row in which energy came from nowhere; after 20 of them the run counts as blown up.
    pub suspect_steps: u64,
}

/// Where the energy is at one moment, and where it went since the start, J.
///
/// With the ledger on from the start, [`total`](Energy::total) = `sums.start` + `sums.work_in` − `sums.lost_in_dampers` −
/// `sums.lost_in_contact` + `sums.integrator_error`, to rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Σ ½mv² over the points that forces can move.
    pub kinetic: f64,
    /// −Σ m g·x over the points that forces can move.
    pub gravitational: f64,
    /// Σ ½k_s(ℓ − L)².
    pub elastic: f64,
    /// Σ ½k_c p².
    pub contact: f64,
    /// What went where since the start.
    pub sums: LedgerSums,
}

impl Energy {
    /// The energy of a state under some parameters, one spring and one point after another in float64.
    /// [`Simulation::energy`](crate::Simulation::energy) is several times as fast.
    pub fn of(model: &Model, params: &Params, state: &State) -> Self {
        let mut energy = Self { kinetic: kinetic(params, state), sums: state.ledger, ..Self::default() };
        for force in FORCES {
            let potential = (force.potential)(model, params, state);
            match force.store {
                Store::Gravitational => energy.gravitational += potential,
                Store::Elastic => energy.elastic += potential,
                Store::Contact => energy.contact += potential,
                Store::None => {}
            }
        }
        energy
    }

    /// Kinetic and all potential energy, J.
    pub fn total(&self) -> f64 {
        self.kinetic + self.gravitational + self.elastic + self.contact
    }
}

/// Σ ½mv² over the points that can move, J. A point that is carried moves, but its speed is the hand's to give and to take.
fn kinetic(params: &Params, state: &State) -> f64 {
    (0..params.point_mass.len()).map(|point| kinetic_of(params, state, point)).sum()
}

fn kinetic_of(params: &Params, state: &State, point: usize) -> f64 {
    let mass = if params.carried.contains_key(&point) { 0.0 } else { f64::from(params.point_mass[point]) };
    0.5 * mass * state.velocity64(point).length_squared()
}

/// All energy in which one point takes part, J: what a change of this point alone can alter.
pub(crate) fn around(model: &Model, params: &Params, state: &State, point: usize) -> f64 {
    let position = state.position64(point);
    let elastic = model.springs_at(point).iter().map(|&spring| {
        let [i, j] = model.springs[spring as usize].map(|end| state.position64(end as usize));
        force::spring::stored(params, spring as usize, i - j)
    });
    kinetic_of(params, state, point)
        + force::gravity::stored(params, point, position)
        + force::contact::stored(params, point, position)
        + elastic.sum::<f64>()
}

/// The works of one step. Holds the forces at its beginning until its end is known.
#[derive(Clone, Debug)]
pub(crate) struct Ledger {
    /// One entry per force that stores or loses the system's own energy: what it stored, and its two parts on each point.
    accounts: Vec<(Account, f64, Vec<DVec3>, Vec<DVec3>)>,
    velocity: Vec<DVec3>,
}

impl Ledger {
    pub fn new(model: &Model) -> Self {
        let zeros = vec![DVec3::ZERO; model.point_count()];
        let accounts =
            FORCES.iter().map(|force| (force.account, 0.0, zeros.clone(), zeros.clone())).collect();
        Self { accounts, velocity: zeros }
    }

    /// Before a step: the forces, the potentials and the velocities it starts from.
    pub fn begin(&mut self, model: &Model, params: &Params, state: &State) {
        for (force, (_, potential, conservative, rest)) in FORCES.iter().zip(&mut self.accounts) {
            conservative.fill(DVec3::ZERO);
            rest.fill(DVec3::ZERO);
            *potential = (force.potential)(model, params, state);
            (force.parts)(model, params, state, conservative, rest);
        }
        for (point, velocity) in self.velocity.iter_mut().enumerate() {
            *velocity = state.velocity64(point);
        }
    }

    /// After it: the sums with every force's work booked. `Drives` books what outside forces put in, and has found how
    /// much of that a carrying hand stored in springs, J.
    pub fn end(&mut self, model: &Model, params: &Params, state: &State, stored_by_hand: f64) -> LedgerSums {
        let half_dt = 0.5 * f64::from(params.dt as f32);
        for (point, velocity) in self.velocity.iter_mut().enumerate() {
            *velocity = (*velocity + state.velocity64(point)) * half_dt;
        }
        let work =
            |forces: &[DVec3]| forces.iter().zip(&self.velocity).map(|(f, path)| f.dot(*path)).sum::<f64>();
        // What springs give to a carried point, the hand takes: all of it is in `stored_by_hand`.
        let free = |(point, _): &(usize, &DVec3)| !params.carried.contains_key(point);
        let work_on_free = |forces: &[DVec3]| {
            let forces = forces.iter().enumerate().filter(free);
            forces.map(|(point, force)| force.dot(self.velocity[point])).sum::<f64>()
        };
        let mut sums = state.ledger;
        sums.integrator_error -= stored_by_hand;
        for (force, (account, potential, conservative, rest)) in FORCES.iter().zip(&self.accounts) {
            let stored = (force.potential)(model, params, state) - potential;
            sums.integrator_error += stored + work_on_free(conservative);
            match account {
                Account::Dampers => sums.lost_in_dampers -= work(rest),
                Account::Contact => sums.lost_in_contact -= work(rest),
                Account::WorkIn | Account::None => {}
            }
        }
        sums
    }
}

/// The work that external forces, grabs and carrying hands put in, which is kept even while the ledger is off: they act on
/// few points.
#[derive(Clone, Debug, Default)]
pub(crate) struct Drives {
    /// Point, force on it and velocity at the beginning of the step.
    driven: Vec<(usize, DVec3, DVec3)>,
    hand: Hand,
}

impl Drives {
    /// Before a step. `motion` gives a point's position and velocity.
    pub fn begin(&mut self, model: &Model, params: &Params, motion: impl Fn(usize) -> [DVec3; 2]) {
        self.driven.clear();
        let external = force::external::forces(params);
        let grabs = params.grabs.iter().map(|grab| {
            let [position, velocity] = motion(grab.point);
            (grab.point, force::grab::force(grab, position, velocity))
        });
        let free = external.chain(grabs).filter(|&(point, _)| !params.is_fixed(point));
        self.driven.extend(free.map(|(point, force)| (point, force, motion(point)[1])));
        self.hand.begin(model, params, motion);
    }

    /// After it: the work that was put in, J, and how much of that hands stored in springs.
    pub fn end(&self, model: &Model, params: &Params, motion: impl Fn(usize) -> [DVec3; 2]) -> (f64, f64) {
        let half_dt = 0.5 * f64::from(params.dt as f32);
        let mut work_in = 0.0;
        for &(point, force, velocity) in &self.driven {
            work_in += force.dot(velocity + motion(point)[1]) * half_dt;
        }
        let (stored, braked) = self.hand.work(model, params, motion);
        (work_in + stored + braked, stored)
    }
}
