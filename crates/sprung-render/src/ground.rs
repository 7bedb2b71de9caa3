//! The ground: a translucent plane with a grid, and the soft shadows of what is near it.
//!
//! It is found by one ray for each pixel and laid over whatever lies behind it. So things that have sunk below a plane
//! stay visible through it: the report's jelly rests two metres deep.

use glam::{Vec2, Vec3};
use sprung::Plane;

use crate::camera::{Bounds, Camera};
use crate::colour::{Colour, srgb};

/// Texels along each side of a shadow.
const SHADOW_SIDE: usize = 160;

/// A plane as it is drawn: everything that stays the same through a motion.
#[derive(Clone, Debug)]
pub struct Ground {
    plane: Plane,
    /// The middle of the drawn part, m, and two unit vectors along the plane, in the world.
    origin: Vec3,
    along: [Vec3; 2],
    /// Distance from the middle at which the plane has faded away, m.
    reach: f32,
    /// Half the side of the shadow's square, m.
    shadow_reach: f32,
    /// Distance between the grid's lines, m.
    grid: f32,
    /// Direction in which shadows fall, for 1 m of height.
    slant: Vec3,
    /// Colours of the sheet, its lines and its shadows.
    colours: [Colour; 3],
}

/// How dark the ground is, at one moment.
#[derive(Clone, Debug)]
pub struct Shadow(Vec<f32>);

/// What a ray meets: the plane's distance (m), its colour, and how much it hides.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// Distance along the view, m.
    pub depth: f32,
    /// Colour.
    pub colour: Colour,
    /// Share of what lies behind that is hidden.
    pub alpha: f32,
}

impl Ground {
    /// Prepares a plane for a motion within `bounds`.
    pub fn new(plane: &Plane, bounds: &Bounds) -> Self {
        let normal = plane.normal;
        let centre = bounds.centre();
        let origin = centre + normal * plane.depth(centre);
        // Level planes have their grid along x and z.
        let toward = if normal.x.abs() < 0.9 { Vec3::X } else { Vec3::Z };
        let u = (toward - normal * toward.dot(normal)).normalize_or(Vec3::X);
        let v = normal.cross(u);
        let extent = |axis: Vec3| {
            bounds.corners().iter().map(|corner| (*corner - origin).dot(axis).abs()).fold(0.0, f32::max)
        };
        let half = extent(u).max(extent(v)).max(1e-6);
        let light = (normal * 1.5 - u * 0.3 + v * 0.25).normalize_or(normal);
        Self {
            plane: *plane,
            origin,
            along: [u, v],
            reach: 2.6 * half,
            shadow_reach: 1.5 * half,
            grid: nice_step(half / 5.0),
            slant: light / light.dot(normal) - normal,
            colours: [0xfb_fc_fd, 0x4a_58_68, 0x26_2f_3c].map(srgb),
        }
    }

    /// Distance between the grid's lines, m.
    pub fn grid(&self) -> f32 {
        self.grid
    }

    /// The shadow of points that stand for balls `spacing` (m) apart.
    ///
    /// Each darkens a patch of its own size where it touches the plane, and a wider, fainter one the higher it is.
    pub fn shadow(&self, positions: &[Vec3], spacing: f32) -> Shadow {
        let texel = 2.0 * self.shadow_reach / SHADOW_SIDE as f32;
        let footprint = std::f32::consts::PI * 0.3 * spacing * spacing / (texel * texel);
        let highest = 1.2 * self.shadow_reach;
        // Three blurs; a point's share goes to the two nearest to its height.
        let heights = [0.0, 3.0 * spacing, 12.0 * spacing];
        let mut layers = [(); 3].map(|()| vec![0.0f32; SHADOW_SIDE * SHADOW_SIDE]);
        for &position in positions.iter().filter(|position| position.is_finite()) {
            let height = -self.plane.depth(position);
            let fade = 1.0 - height.abs() / highest;
            if fade <= 0.0 {
                continue;
            }
            let foot = position - self.slant * height.max(0.0) - self.origin;
            let at =
                (Vec2::new(foot.dot(self.along[0]), foot.dot(self.along[1])) + self.shadow_reach) / texel;
            let weight = footprint * fade * fade;
            let height = height.abs();
            let upper = usize::from(height >= heights[1]);
            let share =
                ((height - heights[upper]) / (heights[upper + 1] - heights[upper]).max(1e-9)).clamp(0.0, 1.0);
            splat(&mut layers[upper], at, weight * (1.0 - share));
            splat(&mut layers[upper + 1], at, weight * share);
        }
        let mut total = vec![0.0f32; SHADOW_SIDE * SHADOW_SIDE];
        for (layer, width) in layers.iter_mut().zip([0.55, 1.4, 4.0]) {
            let radius = ((width * spacing / texel) as usize).clamp(1, SHADOW_SIDE / 6);
            for _ in 0..2 {
                blur(layer, radius);
            }
            total.iter_mut().zip(layer.iter()).for_each(|(sum, value)| *sum += value);
        }
        total.iter_mut().for_each(|density| *density /= 1.0 + *density);
        Shadow(total)
    }

    /// What the rays of a row of pixels meet.
    pub fn row<'a>(
        &'a self,
        camera: &Camera,
        shadow: &'a Shadow,
        y: f32,
    ) -> impl Fn(f32) -> Option<Hit> + use<'a> {
        // In the camera's space the ray of pixel (x, y) is direction·z with direction = (dx, dy, 1). It meets the plane at
        // z = height / (direction·normal); the place along the plane is a fraction whose parts are linear in x and y.
        let normal = camera.turn(self.plane.normal);
        let origin = camera.view(self.origin);
        let axes = self.along.map(|axis| camera.turn(axis));
        let offset = Vec2::new(origin.dot(axes[0]), origin.dot(axes[1]));
        let height = origin.dot(normal);
        let inverse_focal = 1.0 / camera.focal;
        let (middle, near) = (camera.middle, camera.near);
        move |x| {
            let direction = Vec3::new((x - middle.x) * inverse_focal, (middle.y - y) * inverse_focal, 1.0);
            let slope = direction.dot(normal);
            let depth = height / slope;
            if !(depth > near && depth.is_finite()) {
                return None;
            }
            let place = Vec2::new(direction.dot(axes[0]), direction.dot(axes[1])) * depth - offset;
            let far = place.length() / self.reach;
            if far >= 1.0 {
                return None;
            }
            // How far the place moves from pixel to pixel, for lines of an even width.
            let scale = depth * inverse_focal;
            let steps = [
                Vec2::new(
                    axes[0].x - (place.x + offset.x) / depth * normal.x / slope,
                    axes[0].y - (place.x + offset.x) / depth * normal.y / slope,
                ),
                Vec2::new(
                    axes[1].x - (place.y + offset.y) / depth * normal.x / slope,
                    axes[1].y - (place.y + offset.y) / depth * normal.y / slope,
                ),
            ];
            let widths = Vec2::new(steps[0].length(), steps[1].length()) * scale;
            Some(self.paint(place, widths, far, depth, shadow))
        }
    }

    /// Sheet, lines and shadow at a place of the plane.
    fn paint(&self, place: Vec2, widths: Vec2, far: f32, depth: f32, shadow: &Shadow) -> Hit {
        let [sheet, line_colour, dark] = self.colours;
        let fade = {
            let near = ((1.0 - far) / 0.75).clamp(0.0, 1.0);
            near * near * (3.0 - 2.0 * near)
        };
        let line = |value: f32, width: f32, step: f32| {
            let distance = (value - (value / step).round() * step).abs() / width;
            // Where lines come closer than a few pixels they fade to their average instead of shimmering.
            let crowd = (1.5 - 5.0 * width / step).clamp(0.0, 1.0);
            (1.1 - distance).clamp(0.0, 1.0) * crowd
        };
        let lines = |step| line(place.x, widths.x, step).max(line(place.y, widths.y, step));
        let strongest = (0.32 * lines(self.grid)).max(0.5 * lines(5.0 * self.grid));
        let mut hit = Hit { depth, colour: sheet, alpha: 0.5 * fade };
        hit.cover(line_colour, strongest * fade);
        let texel = (place + self.shadow_reach) * (SHADOW_SIDE as f32 / (2.0 * self.shadow_reach));
        hit.cover(dark, 0.62 * shadow.at(texel));
        hit
    }
}

impl Hit {
    /// Lays a colour over this one.
    fn cover(&mut self, colour: Colour, alpha: f32) {
        let total = alpha + self.alpha * (1.0 - alpha);
        if total > 0.0 {
            self.colour = self.colour.lerp(colour, alpha / total);
            self.alpha = total;
        }
    }
}

impl Shadow {
    /// The darkness at a place in texels, between the four nearest.
    fn at(&self, place: Vec2) -> f32 {
        let place = place - 0.5;
        let last = SHADOW_SIDE as f32 - 1.001;
        if place.x < 0.0 || place.y < 0.0 || place.x > last || place.y > last {
            return 0.0;
        }
        let (x, y) = (place.x as usize, place.y as usize);
        let (s, t) = (place.x - x as f32, place.y - y as f32);
        let value = |x: usize, y: usize| self.0[y * SHADOW_SIDE + x];
        let mix = |a: f32, b: f32, share: f32| a + (b - a) * share;
        mix(mix(value(x, y), value(x + 1, y), s), mix(value(x, y + 1), value(x + 1, y + 1), s), t)
    }
}

/// The largest of …, 0.5, 1, 2, 5, 10, … that is not above `length` by much; for grids and scales.
pub fn nice_step(length: f32) -> f32 {
    let mut step = 1.0f64;
    let length = f64::from(length.clamp(1e-9, 1e12)) * 1.1;
    while step > length {
        step /= 10.0;
    }
    while step * 10.0 <= length {
        step *= 10.0;
    }
    let factor = [5.0, 2.0].into_iter().find(|factor| step * factor <= length).unwrap_or(1.0);
    (step * factor) as f32
}

/// Adds a weight to the four texels around a place.
fn splat(layer: &mut [f32], at: Vec2, weight: f32) {
    let at = at - 0.5;
    let last = SHADOW_SIDE as f32 - 1.001;
    if !(at.x >= 0.0 && at.y >= 0.0 && at.x <= last && at.y <= last) {
        return;
    }
    let (x, y) = (at.x as usize, at.y as usize);
    let (s, t) = (at.x - x as f32, at.y - y as f32);
    let first = y * SHADOW_SIDE + x;
    layer[first] += weight * (1.0 - s) * (1.0 - t);
    layer[first + 1] += weight * s * (1.0 - t);
    layer[first + SHADOW_SIDE] += weight * (1.0 - s) * t;
    layer[first + SHADOW_SIDE + 1] += weight * s * t;
}

/// A box blur along both directions, at a cost that does not depend on the radius.
fn blur(layer: &mut [f32], radius: usize) {
    let side = SHADOW_SIDE;
    let mut line = vec![0.0f32; side];
    let scale = 1.0 / (2 * radius + 1) as f32;
    for (stride, step) in [(1, side), (side, 1)] {
        for row in 0..side {
            let first = row * step;
            let value = |index: usize| layer[first + index * stride];
            let mut sum: f32 = (0..=radius.min(side - 1)).map(value).sum();
            for (index, slot) in line.iter_mut().enumerate() {
                *slot = sum.max(0.0) * scale;
                sum += if index + radius + 1 < side { value(index + radius + 1) } else { 0.0 };
                sum -= if index >= radius { value(index - radius) } else { 0.0 };
            }
            for (index, &slot) in line.iter().enumerate() {
                layer[first + index * stride] = slot;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ground() -> Ground {
        let bounds = Bounds { low: Vec3::new(-10.0, -10.0, -10.0), high: Vec3::splat(10.0) };
        Ground::new(&Plane::level(-10.0, 50.0, 10.0), &bounds)
    }

    #[test]
    fn shadows_are_darkest_under_what_touches() {
        let ground = ground();
        let middle = Vec2::splat(SHADOW_SIDE as f32 / 2.0);
        let dark = |y: f32| ground.shadow(&[Vec3::new(0.0, y, 0.0)], 2.0).at(middle);
        assert!(dark(-10.0) > dark(-8.0), "{} {}", dark(-10.0), dark(-8.0));
        assert!(dark(-8.0) > dark(40.0));
        assert_eq!(dark(40.0), 0.0);
        assert_eq!(dark(f32::NAN), 0.0);
    }

    #[test]
    fn a_blur_keeps_the_sum() {
        let mut layer = vec![0.0; SHADOW_SIDE * SHADOW_SIDE];
        splat(&mut layer, Vec2::splat(80.0), 1.0);
        blur(&mut layer, 7);
        assert!((layer.iter().sum::<f32>() - 1.0).abs() < 1e-4);
    }

    #[test]
    fn steps_are_nice() {
        assert_eq!([0.3, 1.0, 1.9, 6.0, 420.0].map(nice_step), [0.2, 1.0, 2.0, 5.0, 200.0]);
    }
}
