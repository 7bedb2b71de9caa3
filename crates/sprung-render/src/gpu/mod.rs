//! The same scenes drawn by a graphics card, through wgpu: natively, in WebGPU and in WebGL2.
//!
//! Positions go up once a frame; what can be computed from them (lengths of springs and their colours, normals, coils)
//! is computed in shaders. WebGL2 has neither storage buffers nor compute shaders, so all long lists are
//! tables: textures that vertex shaders read. Blending between two steps is the one thing done for each point
//! on the processor: positions are copied for the upload anyway, and the card then reads one table instead of two.
//!
//! A picture is made in three passes: what the key light sees (the shadow map), the scene itself in linear light with
//! four samples for each pixel, and a last one that turns linear light into the sRGB numbers that egui expects. Depth is
//! near/z, which is evenly fine at all distances.
//!
//! Drivers that draw on the processor (Mesa's lavapipe) take time for each sample, each texture read and each triangle.
//! For them there is [`Quality::Software`], which looks nearly the same for a fraction of the work; the shaders know it
//! as the constant `quick`.

mod coarse;
mod data;
mod device;
mod frame;
mod passes;
mod pipelines;
mod plan;
mod quality;
mod read;
mod scenery;
mod shaders;
mod stage;
mod table;
mod target;
mod topology;

use glam::Vec3;

pub use device::{Headless, headless};
pub use plan::{Shown, joints_shown, shown};
pub use quality::Quality;
pub use read::Reading;
pub use stage::{Stage, Timings};

/// A moment to draw: where the points are, between two steps.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moment<'a> {
    /// Positions at the step before, m. If there are none, those of `now` are taken as they are.
    pub before: &'a [Vec3],
    /// Positions at the newest step, m.
    pub now: &'a [Vec3],
    /// Where between the two, from 0 to 1.
    pub blend: f32,
    /// Velocities, m/s, for their arrows; may be empty.
    pub velocities: &'a [Vec3],
    /// Forces, N, for their arrows; may be empty.
    pub forces: &'a [Vec3],
    /// Positions of an earlier run to compare with, m, drawn as a ghost; may be empty.
    pub ghost: &'a [Vec3],
}

/// What is pointed out. Indices that the model does not have are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Marks {
    /// Points with a ring of the selection's colour.
    pub selected_points: Vec<usize>,
    /// Springs drawn thick in the selection's colour.
    pub selected_springs: Vec<usize>,
    /// The point under the cursor.
    pub hovered_point: Option<usize>,
    /// The spring under the cursor.
    pub hovered_spring: Option<usize>,
    /// Springs that set the limit or blew up: drawn thick in the warning's colour, through everything else.
    pub alarming_springs: Vec<usize>,
    /// Points likewise.
    pub alarming_points: Vec<usize>,
    /// Lines from a point to the cursor that pulls at it, m.
    pub pulls: Vec<(Vec3, Vec3)>,
}
