//! The camera of the window: it turns around a target, stays upright, comes nearer and moves aside.

use glam::{Vec2, Vec3};
use sprung::Plane;

use crate::camera::{Bounds, Camera, Framing};

/// Half the height of the view at distance 1: a long lens (about 26 degrees), so that spheres stay round.
const TAN_HALF_HEIGHT: f32 = 0.23;

/// About the share of the picture that a framed box leaves free on every side.
const MARGIN: f32 = 0.06;

/// The eye's smallest and largest distance from its target, m: beyond, 32 bits no longer tell places apart.
const DISTANCE_RANGE: (f32, f32) = (1e-5, 1e8);

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
    /// Whether it is a place that one can look from.
    pub fn is_sane(&self) -> bool {
        let Self { target, distance, azimuth, elevation } = *self;
        target.is_finite()
            && (DISTANCE_RANGE.0..=DISTANCE_RANGE.1).contains(&distance)
            && azimuth.is_finite()
            && elevation.abs() <= STEEPEST
    }

    /// The tightest view of a box of the world in a picture of this shape (width over height), flat boxes nearly from
    /// the front.
    pub fn framing(bounds: &Bounds, aspect: f32) -> Self {
        Self::framing_with(bounds, &[], aspect)
    }

    /// The same, with the places on ground planes that lie below the box's middle, unless they are far away.
    pub fn framing_with(bounds: &Bounds, planes: &[Plane], aspect: f32) -> Self {
        let bounds = bounds.grown(0.0);
        let size = bounds.size();
        let is_flat = size.z < 0.15 * size.x.max(size.y);
        let (azimuth, elevation) = if is_flat { (0.34, 0.22) } else { (0.76, 0.39) };
        let turned = Self { target: bounds.centre(), distance: 1.0, azimuth, elevation };

        let picture = 1000.0 * Vec2::new(aspect.clamp(0.05, 20.0), 1.0);
        let axes = turned.axes().map(Vec3::as_dvec3);
        let mut framing = Framing::along(axes, Vec2::ZERO, picture);
        let ball = (0.02 * size.max_element()).max(1e-4);
        bounds.corners().into_iter().for_each(|corner| framing.include(corner, ball));
        for plane in planes {
            let height = -plane.depth(bounds.centre());
            if height > 0.0 && height < size.length() {
                framing.include(bounds.centre() - plane.normal * height, 0.0);
            }
        }

        // The eye is found; the target is the place before it that is as far away as the middle of the box. From there one
        // steps back a little.
        let camera = framing.camera();
        let distance = camera.view(bounds.centre()).z.max(1e-3 * ball);
        let target = camera.eye + camera.axes[2] * distance;
        Self { target, distance: distance / (1.0 - 2.0 * MARGIN), azimuth, elevation }
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

    /// The place in the world that is seen at a pixel, at a distance along the view, m.
    pub fn place(&self, pixel: Vec2, depth: f32, size: Vec2) -> Vec3 {
        let Camera { eye, axes: [right, up, forward], focal, middle, .. } = self.camera(size);
        let aside = (pixel - middle) * (depth / focal);
        eye + forward * depth + right * aside.x - up * aside.y
    }

    /// Between this view (0) and another (1), turning the shorter way around.
    pub fn between(&self, other: &Self, share: f32) -> Self {
        use std::f32::consts::{PI, TAU};
        let turn = (other.azimuth - self.azimuth + PI).rem_euclid(TAU) - PI;
        Self {
            target: self.target.lerp(other.target, share),
            distance: self.distance * (other.distance / self.distance).powf(share),
            azimuth: (self.azimuth + turn * share).rem_euclid(TAU),
            elevation: self.elevation + (other.elevation - self.elevation) * share,
        }
    }

    /// Comes nearer by a factor (above 1) or goes away (below), keeping what is under the cursor where it is.
    pub fn zoom(&mut self, factor: f32, cursor: Vec2, size: Vec2) {
        let old = self.distance;
        self.distance = (old / factor.clamp(0.01, 100.0)).clamp(DISTANCE_RANGE.0, DISTANCE_RANGE.1);
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
    fn a_framed_box_is_seen_whole_and_fills_the_picture() {
        let boxes = [(Vec3::new(-3.0, 0.0, -2.0), Vec3::new(5.0, 4.0, 2.0)), (Vec3::ZERO, Vec3::splat(1e-3))];
        for (low, high) in boxes.into_iter().chain([(Vec3::splat(-1e5), Vec3::splat(1e5))]) {
            for size in [SIZE, Vec2::new(300.0, 900.0), Vec2::new(1.0, 1.0)] {
                let bounds = Bounds { low, high };
                let camera = Turntable::framing(&bounds, size.x / size.y).camera(size);
                let mut used = Bounds::default();
                for corner in bounds.corners() {
                    let pixel = camera.project(corner).expect("it is in front of the camera").pixel;
                    assert!(pixel.cmpge(Vec2::ZERO).all() && pixel.cmple(size).all(), "{pixel} of {size}");
                    used.include(pixel.extend(0.0));
                }
                assert!((used.size().truncate() / size).max_element() > 0.7, "{used:?} of {size}");
            }
        }
    }

    #[test]
    fn a_plane_near_below_is_framed_and_a_far_one_is_not() {
        let bounds = Bounds { low: Vec3::splat(-1.0), high: Vec3::splat(1.0) };
        let view = |height: f32| {
            let plane = Plane::level(height, 1.0, 1.0);
            Turntable::framing_with(&bounds, &[plane], 1.5)
        };
        let foot = view(-3.0).camera(SIZE).project(Vec3::new(0.0, -3.0, 0.0)).expect("it is in front");
        assert!(foot.pixel.y < SIZE.y && foot.pixel.y > 0.7 * SIZE.y, "{foot:?}");
        assert_eq!(view(-300.0), Turntable::framing(&bounds, 1.5));
    }

    #[test]
    fn places_and_pixels_belong_together() {
        let view = turntable();
        let place = view.place(Vec2::new(123.0, 456.0), 7.0, SIZE);
        let seen = view.camera(SIZE).project(place).expect("it is in front of the camera");
        assert!((seen.pixel - Vec2::new(123.0, 456.0)).length() < 1e-2 && (seen.depth - 7.0).abs() < 1e-4);
    }

    #[test]
    fn between_two_views_the_shorter_way_is_taken() {
        let (mut a, mut b) = (turntable(), turntable());
        (a.azimuth, b.azimuth) = (0.2, 6.1);
        let azimuth = a.between(&b, 0.5).azimuth;
        assert!((azimuth - 0.0084).abs() < 1e-3 || azimuth > 6.0, "{azimuth}");
        assert_eq!(a.between(&b, 0.0).target, a.target);
        assert!((a.between(&b, 1.0).azimuth - b.azimuth).abs() < 1e-5);
    }
}
