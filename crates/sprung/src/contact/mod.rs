//! Contact: what happens to a point that enters a collider. One file per collider shape.

mod plane;

pub(crate) use plane::UNIT_TOLERANCE;
pub use plane::{ContactLaw, Plane};
