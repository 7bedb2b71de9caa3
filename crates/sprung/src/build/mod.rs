//! Ways to make points and springs.

mod builder;
mod connect;

pub use builder::{DEFAULT_MAX_SPRINGS, Material, ModelBuilder};
pub use connect::pairs_within;
