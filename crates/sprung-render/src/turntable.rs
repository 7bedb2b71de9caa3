//! The camera of the window: it turns around a target, stays upright, comes nearer and moves aside.

use glam::{Vec2, Vec3};

use crate::camera::{Bounds, Camera};

/// Half the height of the view at distance 1: a long lens (about 26 degrees), so that spheres stay round.
const TAN_HALF_HEIGHT: f32 = 0.23;

/// How far up or down one can look, rad: short of the poles, where "upright" has no meaning.
const STEEPEST: f32 = 1.55;

/// A camera on a turntable around a target, always upright.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turntable {
    /// What is looked at, m.
    pub target: Vec3,
    /// Distance of the eye from it, m.
    pub distance: f32,
    /// Angle around the vertical axis, rad: 0 looks along −z.
    pub azimuth: f32,
    /// Angle above the horizon, rad.
    pub elevation: f32,
}

impl Turntable {
    /// A view of a box of the world, flat ones nearly from the front.
    pub fn framing(bounds: &Bounds, aspect: f32) -> Self {
        let bounds = bounds.grown(0.0);
        let size = bounds.size();
        let is_flat = size.z < 0.15 * size.x.max(size.y);
        let (azimuth, elevation) = if is_flat { (0.34, 0.22) } else { (0.76, 0.39) };
        let radius = (0.5 * size.length()).max(1e-3);
        let tan = TAN_HALF_HEIGHT * aspect.clamp(0.1, 1.0);
        Self { target: bounds.centre(), distance: 1.1 * radius / tan, azimuth, elevation }
    }

    /// Right, up and along the view, unit vectors of the world.
    pub fn axes(&self) -> [Vec3; 3] {
        let (sin_a, cos_a) = self.azimuth.sin_cos();
        let (sin_e, cos_e) = self.elevation.sin_cos();
        let forward = -Vec3::new(sin_a * cos_e, sin_e, cos_a * cos_e);
        let right = Vec3::new(cos_a, 0.0, -sin_a);
        [right, right.cross(forward), forward]
    }

    /// The camera for a picture of this size, pixels.
    pub fn camera(&self, size: Vec2) -> Camera {
        let axes = self.axes();
        Camera {
            eye: self.target - axes[2] * self.distance,
            axes,
            focal: 0.5 * size.y.max(1.0) / TAN_HALF_HEIGHT,
            middle: 0.5 * size,
            near: 1e-3 * self.distance,
        }
    }

    /// Turns by a drag of so many pixels: half a turn across the picture's height.
    pub fn orbit(&mut self, pixels: Vec2, size: Vec2) {
        let angle = std::f32::consts::PI * pixels / size.y.max(1.0);
        self.azimuth = (self.azimuth - angle.x).rem_euclid(std::f32::consts::TAU);
        self.elevation = (self.elevation + angle.y).clamp(-STEEPEST, STEEPEST);
    }

    /// Moves aside, so that what lies at the target's distance follows the drag.
    pub fn pan(&mut self, pixels: Vec2, size: Vec2) {
        let [right, up, _] = self.axes();
        let metres = 2.0 * TAN_HALF_HEIGHT * self.distance / size.y.max(1.0);
        self.target += (up * pixels.y - right * pixels.x) * metres;
    }

    /// Comes nearer by a factor (above 1) or goes away (below), keeping what is under the cursor where it is.
    pub fn zoom(&mut self, factor: f32, cursor: Vec2, size: Vec2) {
        let old = self.distance;
        self.distance = (old / factor.clamp(0.01, 100.0)).clamp(1e-4, 1e7);
        let [right, up, _] = self.axes();
        let aside = (cursor - 0.5 * size) * (2.0 * TAN_HALF_HEIGHT / size.y.max(1.0)) * (old - self.distance);
        self.target += right * aside.x - up * aside.y;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Vec2 = Vec2::new(800.0, 600.0);

    fn turntable() -> Turntable {
        Turntable { target: Vec3::new(1.0, 2.0, 3.0), distance: 10.0, azimuth: 0.7, elevation: 0.4 }
    }

    #[test]
    fn the_target_is_in_the_middle() {
        let seen =
            turntable().camera(SIZE).project(turntable().target).expect("it is in front of the camera");
        assert!((seen.pixel - 0.5 * SIZE).length() < 1e-3);
    }

    #[test]
    fn what_is_panned_follows_the_cursor() {
        let mut moved = turntable();
        moved.pan(Vec2::new(30.0, -12.0), SIZE);
        let seen = moved.camera(SIZE).project(turntable().target).expect("it is in front of the camera");
        assert!((seen.pixel - 0.5 * SIZE - Vec2::new(30.0, -12.0)).length() < 0.01);
    }

    #[test]
    fn zooming_keeps_what_is_under_the_cursor() {
        let mut near = turntable();
        let [right, up, _] = near.axes();
        let point = near.target + right * 1.3 - up * 0.4;
        let cursor = near.camera(SIZE).project(point).expect("it is in front of the camera").pixel;
        near.zoom(1.7, cursor, SIZE);
        let seen = near.camera(SIZE).project(point).expect("it is in front of the camera");
        assert!((seen.pixel - cursor).length() < 0.01);
    }

    #[test]
    fn the_poles_are_out_of_reach() {
        let mut turned = turntable();
        turned.orbit(Vec2::new(0.0, 1e6), SIZE);
        assert!(turned.elevation < std::f32::consts::FRAC_PI_2);
        assert!(turned.axes().iter().all(|axis| (axis.length() - 1.0).abs() < 1e-5));
    }

    #[test]
    fn a_framed_box_is_seen_whole() {
        let bounds = Bounds { low: Vec3::new(-3.0, 0.0, -2.0), high: Vec3::new(5.0, 4.0, 2.0) };
        for size in [SIZE, Vec2::new(300.0, 900.0)] {
            let camera = Turntable::framing(&bounds, size.x / size.y).camera(size);
            for corner in bounds.corners() {
                let pixel = camera.project(corner).expect("it is in front of the camera").pixel;
                assert!(pixel.cmpge(Vec2::ZERO).all() && pixel.cmple(size).all(), "{pixel} of {size}");
            }
        }
    }
}
