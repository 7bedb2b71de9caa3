//! The camera: a perspective view that frames a whole motion.

use glam::{DVec3, Vec2, Vec3};

/// Half the height of the view at distance 1: a long lens (about 26 degrees), so that spheres stay round.
const TAN_HALF_HEIGHT: f64 = 0.23;

/// An axis-aligned box in space, m. Starts empty and grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub low: Vec3,
    /// Largest coordinates.
    pub high: Vec3,
}

impl Default for Bounds {
    fn default() -> Self {
        Self { low: Vec3::MAX, high: Vec3::MIN }
    }
}

impl Bounds {
    /// Grows to hold a point; one that is not finite is left out.
    pub fn include(&mut self, point: Vec3) {
        if point.is_finite() {
            self.low = self.low.min(point);
            self.high = self.high.max(point);
        }
    }

    /// The same box, larger by `margin` on every side; a box around the origin if it was empty.
    pub fn grown(&self, margin: f32) -> Self {
        if self.low.x > self.high.x {
            return Self { low: Vec3::splat(-1.0), high: Vec3::splat(1.0) };
        }
        Self { low: self.low - margin, high: self.high + margin }
    }

    /// Its middle.
    pub fn centre(&self) -> Vec3 {
        0.5 * (self.low + self.high)
    }

    /// Its edges' lengths.
    pub fn size(&self) -> Vec3 {
        (self.high - self.low).max(Vec3::ZERO)
    }

    /// Its eight corners.
    pub fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|corner| {
            let pick = |bit: usize, low, high| if corner >> bit & 1 == 0 { low } else { high };
            Vec3::new(
                pick(0, self.low.x, self.high.x),
                pick(1, self.low.y, self.high.y),
                pick(2, self.low.z, self.high.z),
            )
        })
    }
}

/// A point as the camera sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projected {
    /// Place in the picture, pixels from the top left corner.
    pub pixel: Vec2,
    /// Distance from the camera along its view, m.
    pub depth: f32,
}

/// A perspective camera. Its own space has x to the right, y up and z along the view, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where it stands, m.
    pub eye: Vec3,
    /// Unit vectors of its space, in world coordinates: right, up, along the view.
    pub axes: [Vec3; 3],
    /// Pixels for a length of 1 m at a distance of 1 m.
    pub focal: f32,
    /// The pixel that the view's axis meets.
    pub middle: Vec2,
    /// Smallest distance that is drawn, m.
    pub near: f32,
}

impl Camera {
    /// Frames a box inside a rectangle of the picture (two corners, pixels).
    ///
    /// Flat motions, such as a pendulum's, are seen nearly from the front; others from above and aside.
    pub fn framing(bounds: &Bounds, low: Vec2, high: Vec2) -> Self {
        let size = bounds.size();
        let flat = size.z < 0.15 * size.x.max(size.y);
        // Sine and cosine of azimuth and elevation, as right-angled triangles: nothing to round differently.
        let (azimuth, elevation) = if flat { ((5.0, 12.0), (9.0, 40.0)) } else { ((20.0, 21.0), (20.0, 48.0)) };
        let [(sin_a, cos_a), (sin_e, cos_e)] = [azimuth, elevation].map(|(a, b): (f64, f64)| {
            let length = (a * a + b * b).sqrt();
            (a / length, b / length)
        });
        let forward = -DVec3::new(sin_a * cos_e, sin_e, cos_a * cos_e);
        let right = DVec3::new(cos_a, 0.0, -sin_a);
        let up = right.cross(forward);

        // Seen along the view's axis, the box must fit between four planes through the eye with slopes ±tan. For each
        // pair of planes the tightest place of the eye has a closed form; the farther of the two distances serves both.
        let area = (high - low).max(Vec2::ONE).as_dvec2();
        let (tan_y, tan_x) = (TAN_HALF_HEIGHT, TAN_HALF_HEIGHT * area.x / area.y);
        let extremes = |axis: DVec3, tan: f64| {
            let corners = bounds.corners().map(|corner| corner.as_dvec3());
            let upper = corners.iter().map(|c| c.dot(axis) - tan * c.dot(forward)).fold(f64::MIN, f64::max);
            let lower = corners.iter().map(|c| c.dot(axis) + tan * c.dot(forward)).fold(f64::MAX, f64::min);
            (0.5 * (upper + lower), (lower - upper) / (2.0 * tan))
        };
        let ((x, z_for_x), (y, z_for_y)) = (extremes(right, tan_x), extremes(up, tan_y));
        let longest = f64::from(size.max_element()).max(1e-6);
        let z = z_for_x.min(z_for_y) - 0.01 * longest;
        let eye = right * x + up * y + forward * z;
        Self {
            eye: eye.as_vec3(),
            axes: [right.as_vec3(), up.as_vec3(), forward.as_vec3()],
            focal: (0.5 * area.y / tan_y) as f32,
            middle: 0.5 * (low + high),
            near: (0.01 * longest) as f32,
        }
    }

    /// A direction in the camera's own space.
    pub fn turn(&self, direction: Vec3) -> Vec3 {
        let [right, up, forward] = self.axes;
        Vec3::new(direction.dot(right), direction.dot(up), direction.dot(forward))
    }

    /// A point in the camera's own space.
    pub fn view(&self, point: Vec3) -> Vec3 {
        self.turn(point - self.eye)
    }

    /// Where a point appears; `None` if it is too near, behind the camera or not finite.
    pub fn project(&self, point: Vec3) -> Option<Projected> {
        let view = self.view(point);
        let in_front = view.z > self.near && view.is_finite();
        in_front.then(|| {
            let scale = self.focal / view.z;
            Projected { pixel: self.middle + Vec2::new(view.x * scale, -view.y * scale), depth: view.z }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_of_the_box_lies_inside_the_frame() {
        let boxes = [
            (Vec3::new(-14.0, -12.0, -14.0), Vec3::new(14.0, 20.0, 14.0)),
            (Vec3::new(-28.0, -3.0, 0.0), Vec3::new(28.0, 25.0, 0.0)),
            (Vec3::ZERO, Vec3::ZERO),
            (Vec3::splat(-1e6), Vec3::splat(1e6)),
            (Vec3::splat(100.0), Vec3::splat(100.001)),
        ];
        for (low, high) in boxes {
            let bounds = Bounds { low, high };
            let (from, to) = (Vec2::new(20.0, 60.0), Vec2::new(620.0, 300.0));
            let camera = Camera::framing(&bounds, from, to);
            for corner in bounds.corners() {
                let seen = camera.project(corner).unwrap_or_else(|| panic!("{corner} is in front of the camera"));
                assert!(seen.pixel.cmpge(from).all() && seen.pixel.cmple(to).all(), "{corner}: {:?}", seen.pixel);
            }
        }
    }

    #[test]
    fn the_frame_is_filled_in_one_direction_at_least() {
        let bounds = Bounds { low: Vec3::splat(-1.0), high: Vec3::splat(1.0) };
        let camera = Camera::framing(&bounds, Vec2::ZERO, Vec2::new(1600.0, 900.0));
        let heights = bounds.corners().map(|corner| camera.project(corner).map_or(0.0, |seen| seen.pixel.y));
        let (low, high) = heights.iter().fold((f32::MAX, f32::MIN), |(l, h), &y| (l.min(y), h.max(y)));
        assert!(low < 30.0 && high > 870.0, "{low} to {high}");
    }

    #[test]
    fn points_that_are_not_finite_are_left_out() {
        let mut bounds = Bounds::default();
        bounds.include(Vec3::ONE);
        bounds.include(Vec3::new(f32::NAN, 0.0, 0.0));
        assert_eq!(bounds, Bounds { low: Vec3::ONE, high: Vec3::ONE });
        let camera = Camera::framing(&bounds, Vec2::ZERO, Vec2::ONE);
        assert_eq!(camera.project(Vec3::splat(f32::INFINITY)), None);
    }
}
