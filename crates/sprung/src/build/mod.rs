//! Ways to make points and springs.

mod builder;
mod cells;
mod connect;
mod lattice;
pub mod mesh;
mod numbering;

pub use builder::{DEFAULT_MAX_SPRINGS, Material, ModelBuilder};
pub use connect::{pairs_between, pairs_within};
pub use lattice::{Lattice, Side, SpringKind};
pub use mesh::{Mesh, MeshBody};
