//! sprung: a mass-spring engine.
//!
//! A *scene* is built into an immutable [`Model`], its [`Params`] and a first [`State`]; a solver advances the state
//! under the params; everything else only reads [`Snapshot`]s. Units are SI throughout; the up axis is +Y.

mod buckets;
pub mod build;
pub mod contact;
mod current;
pub mod energy;
mod error;
pub mod force;
mod hand;
pub mod history;
mod kernel;
mod math;
mod model;
pub mod params;
pub mod probe;
pub mod scene;
mod settle;
mod simulation;
pub mod solver;
pub mod stability;
mod state;
mod text;
mod watch;
mod workers;

pub use build::{Material, ModelBuilder};
pub use contact::{ContactLaw, Plane};
pub use energy::Energy;
pub use error::{Code, Error, Place, Result};
pub use glam::{DVec3, Vec3};
pub use history::Event;
pub use kernel::Level;
pub use model::{Body, Joint, Model, Surface, SurfaceKind, SurfaceVertices, WeightedVertex};
pub use params::{Change, Grab, Params};
pub use probe::{PointReading, SpringReading};
pub use settle::{SettleOptions, Settled};
pub use simulation::{Checkpoint, MOST_STEPS, Settling, Simulation};
pub use state::{Moment, Snapshot, State};
pub use text::significant;
pub use watch::{BlowUp, Cause, PATIENCE, SAFE_SHARE};
pub use workers::{Inline, Workers};

/// The README's example is one of the tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
