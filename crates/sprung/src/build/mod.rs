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

/// Memory of one point in a simulation (state, the first and the last good one, parameters, forces: 260 as measured on
/// large scenes) and in the vectors with which the sharp limit is found (160), bytes.
const POINT_BYTES: u64 = 420;
/// Memory of one spring in a simulation (41 as measured), as several threads see it (40), and where the sharp limit is
/// found (32), bytes.
const SPRING_BYTES: u64 = 115;

/// About how much memory simulating so many points and springs and finding their limits will take, bytes: for a check against what
/// there is before it is asked for. Saturates instead of overflowing.
pub fn estimated_bytes(points: u64, springs: u64) -> u64 {
    points.saturating_mul(POINT_BYTES).saturating_add(springs.saturating_mul(SPRING_BYTES))
}
