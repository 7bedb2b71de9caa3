//! Contact: what happens to a point that enters a collider. One file per collider shape.

mod plane;

pub(crate) use plane::unit;
pub use plane::{ContactLaw, Plane};
