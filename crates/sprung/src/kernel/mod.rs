//! The explicit step's inner loops: spring forces, and the move of every point.

mod integrate;
mod springs;

pub(crate) use integrate::{Motion, advance};
pub(crate) use springs::SpringKernel;
