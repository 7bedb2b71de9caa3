//! Integrators, one file each.

mod symplectic_euler;

pub use symplectic_euler::SymplecticEuler;
