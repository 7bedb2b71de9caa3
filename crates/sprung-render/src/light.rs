//! The studio: a soft sky, a key light from above, a faint rim.

use glam::Vec3;

use crate::camera::Camera;
use crate::colour::{Colour, srgb};

/// The lights, in the camera's own space.
#[derive(Clone, Copy, Debug)]
pub struct Studio {
    /// Towards the key light, in the camera's space.
    key: Vec3,
    /// Between the key light and the viewer: where highlights sit.
    half: Vec3,
    /// Up, in the camera's space.
    up: Vec3,
    sky: Colour,
    floor: Colour,
    sun: Colour,
}

/// What a surface is like.
#[derive(Clone, Copy, Debug)]
pub struct Finish {
    /// Strength of the highlight.
    pub gloss: f32,
    /// How far the outline is darkened, 0 to 1: it sets equal neighbours apart.
    pub edge: f32,
}

impl Finish {
    /// Points.
    pub const BALL: Self = Self { gloss: 0.35, edge: 0.55 };
    /// Springs.
    pub const WIRE: Self = Self { gloss: 0.10, edge: 0.35 };
    /// Cloth and skins.
    pub const FABRIC: Self = Self { gloss: 0.05, edge: 0.25 };
}

impl Studio {
    /// The lights as a camera sees them. `up` is the direction against gravity, in the world.
    pub fn new(camera: &Camera, up: Vec3) -> Self {
        // The key light stands over the viewer's left shoulder.
        let [right, above, forward] = camera.axes;
        let world_key = (up * 1.2 + above * 0.2 - right * 0.7 - forward * 1.3).normalize_or(up);
        let key = camera.turn(world_key);
        Self {
            key,
            half: (key - Vec3::Z).normalize_or(-Vec3::Z),
            up: camera.turn(up),
            sky: Vec3::new(0.60, 0.63, 0.68),
            floor: Vec3::new(0.36, 0.34, 0.33),
            sun: Vec3::new(0.72, 0.69, 0.64),
        }
    }

    /// The light that leaves a surface of colour `base` with unit normal `normal` (camera space) towards the viewer.
    /// `open` is how much of the sky it sees, 0 to 1.
    pub fn shade(&self, base: Colour, normal: Vec3, finish: Finish, open: f32) -> Colour {
        let sky = 0.5 + 0.5 * normal.dot(self.up);
        let ambient = self.floor.lerp(self.sky, sky) * open;
        // Wrapped a little around the terminator, as light from a large soft box is.
        let key = ((normal.dot(self.key) + 0.2) / 1.2).max(0.0);
        let facing = (-normal.z).clamp(0.0, 1.0);
        let edge = 1.0 - finish.edge * (1.0 - facing) * (1.0 - facing);
        let mut highlight = normal.dot(self.half).max(0.0);
        for _ in 0..5 {
            highlight *= highlight; // to the 32nd power, without a library's powf
        }
        let lit = base * (ambient + self.sun * key * (0.4 + 0.6 * open)) * edge;
        lit + Vec3::splat(highlight * finish.gloss * open)
    }
}

/// The background at a height, 0 at the top and 1 at the bottom.
pub fn backdrop(height: f32) -> Colour {
    let (top, bottom) = (srgb(0xf6_f8_fa), srgb(0xd8_df_e6));
    top.lerp(bottom, height * height * (3.0 - 2.0 * height))
}
