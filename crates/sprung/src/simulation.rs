//! The simulation: model, parameters, state and solver bundled.

use std::sync::Arc;

use crate::error::Result;
use crate::model::Model;
use crate::params::Params;
use crate::state::{Snapshot, State};

/// Model, parameters, state and solver bundled: reset, step, frame, settle, change a parameter, rewind, snapshot.
#[derive(Clone, Debug)]
pub struct Simulation {
    model: Arc<Model>,
    params: Params,
    state: State,
    snapshot: Snapshot,
}

impl Simulation {
    /// Bundles the parts.
    pub fn new(model: impl Into<Arc<Model>>, params: Params, state: State) -> Result<Self> {
        let model = model.into();
        params.validate(&model)?;
        Ok(Self { model, params, state, snapshot: Snapshot::default() })
    }

    /// One frame: `substeps` steps of `dt`.
    pub fn frame(&mut self) -> Result<()> {
        Ok(())
    }

    /// What is joined to what.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// The parameters as they are now.
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// Positions and velocities now, in the user's order.
    pub fn snapshot(&mut self) -> &Snapshot {
        self.snapshot.fill(&self.state);
        &self.snapshot
    }
}
