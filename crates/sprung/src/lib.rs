//! sprung: a mass-spring engine.
//!
//! A *scene* is built into an immutable [`Model`], its [`Params`] and a first [`State`]; a solver advances the state
//! under the params; everything else only reads [`Snapshot`]s. Units are SI throughout; the up axis is +Y.

pub mod build;
pub mod contact;
pub mod energy;
mod error;
mod math;
mod model;
pub mod params;
mod simulation;
pub mod stability;
mod state;
mod watch;

pub use build::{Material, ModelBuilder};
pub use contact::{ContactLaw, Plane};
pub use error::{Code, Error, Place, Result};
pub use glam::{DVec3, Vec3};
pub use model::{Body, Joint, Model, Surface, SurfaceKind};
pub use params::{Change, Grab, Params};
pub use simulation::Simulation;
pub use state::{Snapshot, State};
pub use watch::{BlowUp, Cause};
