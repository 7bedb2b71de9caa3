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

/// From where a motion is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Nearly from the front: for flat motions, such as a pendulum's.
    Front,
    /// From above and aside.
    Corner,
}

/// The tightest view of some points, grown point by point.
///
/// Seen along the view's axis, all points must fit between four planes through the eye with slopes ±tan. For each pair of
/// planes only the outermost point counts, so four numbers are enough, however long the motion; and the tightest place of
/// the eye has a closed form: the farther of the two distances serves both pairs.
#[derive(Clone, Copy, Debug)]
pub struct Framing {
    /// Right, up, along the view.
    axes: [DVec3; 3],
    /// Slopes of the side planes, and of those above and below.
    tan: [f64; 2],
    /// Largest offset right of (above) the falling plane, smallest of the rising one, m.
    most: [f64; 2],
    least: [f64; 2],
    /// The nearest point along the view, m.
    nearest: f64,
    /// The rectangle of the picture that is to be filled, pixels.
    low: Vec2,
    high: Vec2,
}

impl Framing {
    /// Begins a view that fills a rectangle of the picture (two corners, pixels).
    pub fn new(side: Side, low: Vec2, high: Vec2) -> Self {
        // Sine and cosine of azimuth and elevation, as right-angled triangles: nothing to round differently.
        let (azimuth, elevation) = match side {
            Side::Front => ((5.0, 14.0), (9.0, 40.0)),
            Side::Corner => ((20.0, 21.0), (20.0, 48.0)),
        };
        let [(sin_a, cos_a), (sin_e, cos_e)] = [azimuth, elevation].map(|(a, b): (f64, f64)| {
            let length = (a * a + b * b).sqrt();
            (a / length, b / length)
        });
        let forward = -DVec3::new(sin_a * cos_e, sin_e, cos_a * cos_e);
        let right = DVec3::new(cos_a, 0.0, -sin_a);
        Self::along([right, right.cross(forward), forward], low, high)
    }

    /// Begins a view along the third of three unit vectors (right, up, along the view) that fills a rectangle of the
    /// picture (two corners, pixels).
    pub fn along(axes: [DVec3; 3], low: Vec2, high: Vec2) -> Self {
        let area = (high - low).max(Vec2::ONE).as_dvec2();
        Self {
            axes,
            tan: [TAN_HALF_HEIGHT * area.x / area.y, TAN_HALF_HEIGHT],
            most: [f64::MIN; 2],
            least: [f64::MAX; 2],
            nearest: f64::MAX,
            low,
            high,
        }
    }

    /// Makes room for a ball; one that is not finite is left out.
    pub fn include(&mut self, centre: Vec3, radius: f32) {
        if !centre.is_finite() {
            return;
        }
        let centre = centre.as_dvec3();
        let along = centre.dot(self.axes[2]);
        self.nearest = self.nearest.min(along - f64::from(radius));
        for pair in 0..2 {
            let (across, tan) = (centre.dot(self.axes[pair]), self.tan[pair]);
            let room = f64::from(radius) * (1.0 + tan * tan).sqrt();
            self.most[pair] = self.most[pair].max(across - tan * along + room);
            self.least[pair] = self.least[pair].min(across + tan * along - room);
        }
    }

    /// What was learnt from the points so far.
    pub(crate) fn extent(&self) -> [f64; 5] {
        [self.most[0], self.most[1], self.least[0], self.least[1], self.nearest]
    }

    /// The same view, as if these were its points so far.
    pub(crate) fn with_extent(self, [right, up, left, down, nearest]: [f64; 5]) -> Self {
        Self { most: [right, up], least: [left, down], nearest, ..self }
    }

    /// Makes every ball so far larger by `radius`, m.
    pub fn grow(&mut self, radius: f32) {
        self.nearest -= f64::from(radius);
        for pair in 0..2 {
            let room = f64::from(radius) * (1.0 + self.tan[pair] * self.tan[pair]).sqrt();
            self.most[pair] += room;
            self.least[pair] -= room;
        }
    }

    /// The camera. Without any point, it sees a ball of 1 m around the origin.
    pub fn camera(&self) -> Camera {
        let mut tight = *self;
        if tight.nearest == f64::MAX {
            tight.include(Vec3::ZERO, 1.0);
        }
        let [right, up, forward] = tight.axes;
        let middle = |pair: usize| 0.5 * (tight.most[pair] + tight.least[pair]);
        let back = |pair: usize| (tight.least[pair] - tight.most[pair]) / (2.0 * tight.tan[pair]);
        let distance = back(0).min(back(1));
        // A hair further back than exact, for rounding; a single point is given some distance.
        let gap = (tight.nearest - distance).max(0.0);
        let distance = distance - 0.003 * gap - 1e-6 * (1.0 + distance.abs());
        let eye = right * middle(0) + up * middle(1) + forward * distance;
        let height = f64::from((tight.high.y - tight.low.y).max(1.0));
        Camera {
            eye: eye.as_vec3(),
            axes: [right.as_vec3(), up.as_vec3(), forward.as_vec3()],
            focal: (0.5 * height / TAN_HALF_HEIGHT) as f32,
            middle: 0.5 * (tight.low + tight.high),
            near: (0.2 * (tight.nearest - distance)).max(1e-9) as f32,
        }
    }
}

impl Camera {
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

    fn framing(side: Side, bounds: &Bounds, low: Vec2, high: Vec2) -> Camera {
        let mut framing = Framing::new(side, low, high);
        bounds.corners().into_iter().for_each(|corner| framing.include(corner, 0.0));
        framing.camera()
    }

    #[test]
    fn every_point_lies_inside_the_frame() {
        let boxes = [
            (Vec3::new(-14.0, -12.0, -14.0), Vec3::new(14.0, 20.0, 14.0)),
            (Vec3::new(-28.0, -3.0, 0.0), Vec3::new(28.0, 25.0, 0.0)),
            (Vec3::ZERO, Vec3::ZERO),
            (Vec3::splat(-1e6), Vec3::splat(1e6)),
            (Vec3::splat(100.0), Vec3::splat(100.1)),
        ];
        let (from, to) = (Vec2::new(20.0, 60.0), Vec2::new(620.0, 300.0));
        for (side, (low, high)) in
            boxes.into_iter().flat_map(|pair| [(Side::Front, pair), (Side::Corner, pair)])
        {
            let bounds = Bounds { low, high };
            let camera = framing(side, &bounds, from, to);
            for corner in bounds.corners() {
                let seen =
                    camera.project(corner).unwrap_or_else(|| panic!("{corner} is in front of the camera"));
                assert!(
                    seen.pixel.cmpge(from).all() && seen.pixel.cmple(to).all(),
                    "{corner}: {:?}",
                    seen.pixel
                );
            }
        }
    }

    #[test]
    fn the_frame_is_filled_in_one_direction_at_least() {
        let bounds = Bounds { low: Vec3::splat(-1.0), high: Vec3::splat(1.0) };
        let camera = framing(Side::Corner, &bounds, Vec2::ZERO, Vec2::new(1600.0, 900.0));
        let heights = bounds.corners().map(|corner| camera.project(corner).map_or(0.0, |seen| seen.pixel.y));
        let (low, high) = heights.iter().fold((f32::MAX, f32::MIN), |(l, h), &y| (l.min(y), h.max(y)));
        assert!(low < 10.0 && high > 890.0, "{low} to {high}");
    }

    #[test]
    fn points_that_are_not_finite_are_left_out() {
        let mut bounds = Bounds::default();
        let mut framing = Framing::new(Side::Front, Vec2::ZERO, Vec2::ONE);
        for point in [Vec3::ONE, Vec3::new(f32::NAN, 0.0, 0.0)] {
            bounds.include(point);
            framing.include(point, 0.1);
        }
        assert_eq!(bounds, Bounds { low: Vec3::ONE, high: Vec3::ONE });
        assert!(framing.camera().project(Vec3::ONE).is_some());
        assert_eq!(framing.camera().project(Vec3::splat(f32::INFINITY)), None);
    }
}
