//! Saving a running simulation and taking it up again.

use std::sync::Arc;

use super::Simulation;
use super::beginning::{check_counters, check_lengths, hold_fixed_points, load, vectors};
use crate::error::{Code, Error, Result};
use crate::model::Model;
use crate::params::Params;
use crate::state::State;

/// All of a running simulation but its model: what [`Simulation::resume_from`] takes to go on as if it had never stopped.
///
/// A front end keeps it together with the scene that the model was built from. `sprung-io` writes both into one file.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// Positions and velocities with what rounding dropped, step, time and clock, and the ledger's sums, of which one says
    /// for how long the watch has been suspicious.
    pub state: State,
    /// The parameters, with pins, cuts, planes, forces, grabs and what a hand carries.
    pub params: Arc<Params>,
    /// Whether the whole energy ledger was being kept.
    pub keeps_ledger: bool,
}

impl Simulation {
    /// The simulation as it is now, to be taken up again by [`resume_from`](Self::resume_from).
    ///
    /// It is looked over first: if no energy has come from nowhere, this is a good state, and the one that a blow-up
    /// hereafter goes back to, here as in the simulation that is taken up from it. When a blow-up is noticed and all bits of
    /// the motion are the same with and without a checkpoint. The log of what was done is not part of it.
    pub fn checkpoint(&mut self) -> Checkpoint {
        let is_calm = self.current.counters().ledger.suspect_steps == 0;
        // What was done at this very step may still be replaced, as by a slider: then the earlier good state stays.
        if is_calm && self.history.events_at(self.current.step()).is_empty() && !self.is_suspect() {
            self.watch.restart(&mut self.current, &self.params, 0);
        }
        Checkpoint {
            state: self.current.copied(),
            params: self.params.clone(),
            keeps_ledger: self.keeps_ledger(),
        }
    }

    /// Whether every step's works are summed for the energy ledger.
    pub fn keeps_ledger(&self) -> bool {
        self.ledger.is_some()
    }

    /// Goes on from a checkpoint: bit for bit as the simulation would have gone on that it was taken of, its ledger and its
    /// watch over the energy too, for any number of threads.
    ///
    /// ```
    /// use sprung::{Simulation, scene::Scene};
    ///
    /// let mut simulation = Scene::builtin("jelly")?.simulation()?;
    /// simulation.steps(30)?;
    /// let checkpoint = simulation.checkpoint();
    /// let mut again = Simulation::resume_from(simulation.model().clone(), checkpoint)?;
    /// simulation.steps(30)?;
    /// again.steps(30)?;
    /// assert_eq!(again.state_hash(), simulation.state_hash());
    /// # Ok::<(), sprung::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Code::OutOfRange`] or [`Code::Conflict`] if a value is not allowed or the parts do not fit together. A place or a
    /// velocity may be any finite number, as a simulation may have come to it.
    pub fn resume_from(model: impl Into<Arc<Model>>, checkpoint: Checkpoint) -> Result<Self> {
        let model = model.into();
        let Checkpoint { mut state, params, keeps_ledger } = checkpoint;
        params.validate(&model)?;
        check_lengths(&model, &state)?;
        for (field, vectors) in vectors(&state) {
            if let Some(index) = vectors.iter().position(|vector| !vector.is_finite()) {
                let sentence = format!("is {}, and must be finite", vectors[index]);
                return Err(Error::new(Code::OutOfRange, sentence).at_field(format!("{field}[{index}]")));
            }
        }
        check_counters(&state)?;
        hold_fixed_points(&params, &mut state);
        let current = load(&model, &params, state);
        let mut simulation = Self::begin(model, params, current);
        simulation.keep_ledger(keeps_ledger);
        Ok(simulation)
    }
}
