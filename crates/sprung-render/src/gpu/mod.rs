//! The same scenes drawn by a graphics card, through wgpu: natively, in WebGPU and in WebGL2.
//!
//! Positions go up once a frame; what can be computed from them (blending between two steps, strains and their colours,
//! normals, coils) is computed in shaders. WebGL2 has neither storage buffers nor compute shaders, so positions are
//! textures that vertex shaders read.

use glam::Vec3;

/// A moment to draw: where the points are, between two steps.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moment<'a> {
    /// Positions at the step before, m.
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

/// What is pointed out.
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
