//! Ways to make points and springs.

mod builder;
mod connect;
mod lattice;
#[cfg_attr(not(test), expect(dead_code, reason = "the step does not use it yet"))]
pub(crate) mod numbering;

pub use builder::{DEFAULT_MAX_SPRINGS, Material, ModelBuilder};
pub use connect::{pairs_between, pairs_within};
pub use lattice::{Lattice, Side, SpringKind};
