//! Forces, one file each, and the one list of them.
//!
//! Each force is written twice: in float32 for the step, in the private module `kernel`, and here in float64, split into the
//! part that stores energy and the rest, for the energy ledger and for the tests that hold every force against its potential.

pub(crate) mod contact;
pub(crate) mod external;
pub(crate) mod grab;
pub(crate) mod gravity;
pub(crate) mod spring;

use glam::DVec3;

use crate::model::Model;
use crate::params::Params;
use crate::state::{Moment, State};

/// Where the ledger books the energy that a force stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Store {
    /// It stores none.
    None,
    /// In height.
    Gravitational,
    /// In springs.
    Elastic,
    /// In what is pressed into.
    Contact,
}

/// Where the ledger books the work of a force that does not come out of its stored energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Account {
    /// The force has no such part.
    None,
    /// Lost in the springs' dampers.
    Dampers,
    /// Lost in contact.
    Contact,
    /// Put in from outside.
    WorkIn,
}

/// A force: its name and formula for people, its float64 form for the ledger.
pub struct Force {
    /// Short name, such as `spring`.
    pub name: &'static str,
    /// What it does, in a phrase.
    pub description: &'static str,
    /// The formula, with the symbols of the guide.
    pub formula: &'static str,
    /// Where the energy that it stores goes.
    pub store: Store,
    /// Where the work of its non-conservative part goes.
    pub account: Account,
    /// The energy it stores at a state, J.
    pub potential: fn(&Model, &Params, &State) -> f64,
    /// Adds its conservative part, −∇potential, and all the rest of it, to one entry per point each, N.
    pub parts: fn(&Model, &Params, &State, conservative: &mut [DVec3], rest: &mut [DVec3]),
    /// Both parts together on one point, N, without looking at the others but its neighbours.
    pub at: fn(&Model, &Params, Moment<'_>, point: usize) -> DVec3,
}

/// Every force of the engine.
pub static FORCES: &[Force] = &[spring::FORCE, gravity::FORCE, contact::FORCE, external::FORCE, grab::FORCE];
