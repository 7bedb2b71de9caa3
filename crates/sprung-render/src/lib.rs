//! Pictures of mass-spring motions, without any graphics driver.
//!
//! [`SceneView`] makes an [`Image`] of a moment; [`export`] writes pictures and animations; [`plot`] draws the energy
//! ledger. The same input gives the same pixels on every machine: plain float32 arithmetic, `libm` for the rest.

pub mod appearance;
pub mod camera;
pub mod colour;
mod draw;
pub mod export;
#[cfg(feature = "gpu")]
pub mod gpu;
mod ground;
mod image;
mod light;
mod motion;
mod overlay;
pub mod palette;
pub mod plot;
mod quantise;
mod raster;
mod surroundings;
mod text;
pub mod turntable;
mod view;

pub use image::Image;
pub use motion::Motion;
pub use view::{Quality, SceneView};
