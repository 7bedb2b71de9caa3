//! The rasteriser: spheres, capsules and triangles into a z-buffer, one band of rows at a time.
//!
//! Every pixel has N samples on a rotated grid, N = 4 in animations and 8 in single pictures. Coverage and depth are
//! found for each sample, the light once for each pixel and shape. A band of rows keeps its samples in the cache, bounds
//! the memory of a large picture, and lets several threads share one picture.

use glam::{Vec2, Vec3};

use crate::colour::Colour;
use crate::light::{Finish, Studio};

/// Where the samples of a pixel lie: the usual rotated grids, as multisampling hardware has them.
pub const SAMPLES_4: [Vec2; 4] = [at(6, 2), at(14, 6), at(2, 10), at(10, 14)];
/// Eight samples, no two of them in a row or column.
pub const SAMPLES_8: [Vec2; 8] =
    [at(9, 5), at(7, 11), at(13, 9), at(5, 3), at(3, 13), at(1, 7), at(11, 15), at(15, 1)];

const fn at(x: u8, y: u8) -> Vec2 {
    Vec2::new(x as f32 / 16.0, y as f32 / 16.0)
}

/// A sphere as it is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// Centre, pixels.
    pub centre: Vec2,
    /// Distance of the centre from the camera, m.
    pub depth: f32,
    /// Radius, m.
    pub radius: f32,
    /// Radius, pixels.
    pub pixel_radius: f32,
    /// Colour before light.
    pub colour: Colour,
    /// How much of the sky it sees, 0 to 1.
    pub open: f32,
}

/// A piece of wire with round ends.
#[derive(Clone, Copy, Debug)]
pub struct Capsule {
    /// Both ends, pixels.
    pub ends: [Vec2; 2],
    /// Distance of the ends from the camera, m.
    pub depths: [f32; 2],
    /// Radius, m.
    pub radius: f32,
    /// Radius at both ends, pixels.
    pub pixel_radii: [f32; 2],
    /// Unit vectors across the wire, camera space: to the side, and towards the viewer.
    pub across: [Vec3; 2],
    /// Colour before light.
    pub colour: Colour,
    /// How much of the sky it sees, 0 to 1.
    pub open: f32,
}

/// A corner of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// Place, pixels.
    pub pixel: Vec2,
    /// Distance from the camera, m.
    pub depth: f32,
    /// Unit normal of the front, camera space.
    pub normal: Vec3,
}

/// A triangle seen from both sides; the front is the side from which the corners run counter-clockwise.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    /// The corners.
    pub corners: [Corner; 3],
    /// Colours of front and back before light.
    pub colours: [Colour; 2],
}

/// Air: distant things fade a little towards a colour.
#[derive(Clone, Copy, Debug)]
pub struct Haze {
    /// What they fade to.
    pub colour: Colour,
    /// Distance at which fading begins, m.
    pub begin: f32,
    /// Distance at which it is strongest, m.
    pub end: f32,
    /// The largest share, 0 to 1.
    pub strength: f32,
}

/// Some rows of a picture while they are drawn.
pub struct Band<'a, const N: usize> {
    width: usize,
    first_row: usize,
    rows: usize,
    samples: &'a [Vec2; N],
    studio: &'a Studio,
    haze: Haze,
    /// Distance of what each sample shows, m; infinite where it shows nothing.
    depth: Vec<[f32; N]>,
    /// Its colour.
    colour: Vec<[Colour; N]>,
}

impl<'a, const N: usize> Band<'a, N> {
    /// An empty band.
    pub fn new(
        width: usize,
        first_row: usize,
        rows: usize,
        samples: &'a [Vec2; N],
        studio: &'a Studio,
        haze: Haze,
    ) -> Self {
        let depth = vec![[f32::INFINITY; N]; width * rows];
        let colour = vec![[Colour::ZERO; N]; width * rows];
        Self { width, first_row, rows, samples, studio, haze, depth, colour }
    }

    /// Empties the band and moves it to other rows.
    pub fn restart(&mut self, first_row: usize, rows: usize) {
        (self.first_row, self.rows) = (first_row, rows);
        self.depth.clear();
        self.depth.resize(self.width * rows, [f32::INFINITY; N]);
        // Colours count only where there is a depth, so what is left of other rows does no harm.
        self.colour.resize(self.width * rows, [Colour::ZERO; N]);
    }

    /// Depths and colours of the samples of a pixel; `row` counts from the band's first.
    pub fn pixel(&self, column: usize, row: usize) -> (&[f32; N], &[Colour; N]) {
        let index = row * self.width + column;
        (&self.depth[index], &self.colour[index])
    }

    /// Draws a sphere. The long lens makes its outline a circle to a fraction of a pixel.
    pub fn sphere(&mut self, sphere: &Sphere) {
        let Sphere { centre, pixel_radius: radius, .. } = *sphere;
        let inverse = 1.0 / radius;
        for y in self.rows_between(centre.y - radius, centre.y + radius) {
            let nearest = (centre.y - y as f32).clamp(0.0, 1.0) + y as f32 - centre.y;
            let half = (radius * radius - nearest * nearest).max(0.0).sqrt();
            for x in self.columns_between(centre.x - half, centre.x + half) {
                let corner = Vec2::new(x as f32, y as f32) - centre;
                self.cover(
                    x,
                    y,
                    |offset| {
                        let out = (corner + offset) * inverse;
                        let height = 1.0 - out.length_squared();
                        (height > 0.0).then(|| sphere.depth - sphere.radius * height.sqrt())
                    },
                    |studio, offset| {
                        let out = (corner + offset) * inverse;
                        let normal = Vec3::new(out.x, -out.y, -(1.0 - out.length_squared()).max(0.0).sqrt());
                        studio.shade(sphere.colour, normal, Finish::BALL, sphere.open)
                    },
                );
            }
        }
    }

    /// Draws a piece of wire.
    pub fn capsule(&mut self, wire: &Capsule) {
        let [a, b] = wire.ends;
        let along = b - a;
        let inverse_length_squared = 1.0 / along.length_squared().max(1e-12);
        let side = Vec2::new(-along.y, along.x) * inverse_length_squared.sqrt();
        let widest = wire.pixel_radii[0].max(wire.pixel_radii[1]);
        let inverse_depths = wire.depths.map(|depth| 1.0 / depth);
        let place = |point: Vec2| {
            let share = ((point - a).dot(along) * inverse_length_squared).clamp(0.0, 1.0);
            let radius = mix(wire.pixel_radii, share);
            (share, (point - a - along * share) / radius)
        };
        for y in self.rows_between(a.y.min(b.y) - widest, a.y.max(b.y) + widest) {
            // The part of the centre line near this row, widened by the radius.
            let (mut from, mut to) = (0.0, 1.0);
            if along.y.abs() > 1e-6 {
                let s = (y as f32 - widest - a.y) / along.y;
                let t = (y as f32 + 1.0 + widest - a.y) / along.y;
                (from, to) = (s.min(t).clamp(0.0, 1.0), s.max(t).clamp(0.0, 1.0));
            }
            let (s, t) = (a.x + along.x * from, a.x + along.x * to);
            for x in self.columns_between(s.min(t) - widest, s.max(t) + widest) {
                let corner = Vec2::new(x as f32, y as f32);
                self.cover(
                    x,
                    y,
                    |offset| {
                        let (share, out) = place(corner + offset);
                        let height = 1.0 - out.length_squared();
                        (height > 0.0).then(|| 1.0 / mix(inverse_depths, share) - wire.radius * height.sqrt())
                    },
                    |studio, offset| {
                        let (_, out) = place(corner + offset);
                        let sideways = out.dot(side).clamp(-1.0, 1.0);
                        let normal = wire.across[0] * sideways
                            + wire.across[1] * (1.0 - sideways * sideways).max(0.0).sqrt();
                        studio.shade(wire.colour, normal, Finish::WIRE, wire.open)
                    },
                );
            }
        }
    }

    /// Draws a triangle.
    pub fn triangle(&mut self, triangle: &Triangle) {
        let [a, b, c] = triangle.corners;
        let (ab, ac) = (b.pixel - a.pixel, c.pixel - a.pixel);
        let area = ab.perp_dot(ac);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let inverse_area = 1.0 / area;
        // Rows run downwards, so corners that run counter-clockwise have a negative area.
        let front = area < 0.0;
        let (colour, sign) = if front { (triangle.colours[0], 1.0) } else { (triangle.colours[1], -1.0) };
        let weights = |point: Vec2| {
            let out = point - a.pixel;
            let (v, w) = (out.perp_dot(ac) * inverse_area, ab.perp_dot(out) * inverse_area);
            [1.0 - v - w, v, w]
        };
        let low = a.pixel.min(b.pixel).min(c.pixel);
        let high = a.pixel.max(b.pixel).max(c.pixel);
        let inverse_depths = [1.0 / a.depth, 1.0 / b.depth, 1.0 / c.depth];
        for y in self.rows_between(low.y, high.y) {
            for x in self.columns_between(low.x, high.x) {
                let corner = Vec2::new(x as f32, y as f32);
                self.cover(
                    x,
                    y,
                    |offset| {
                        let [u, v, w] = weights(corner + offset);
                        let inside = u >= 0.0 && v >= 0.0 && w >= 0.0;
                        inside.then(|| {
                            1.0 / (u * inverse_depths[0] + v * inverse_depths[1] + w * inverse_depths[2])
                        })
                    },
                    |studio, offset| {
                        let [u, v, w] = weights(corner + offset);
                        let normal = (a.normal * u + b.normal * v + c.normal * w) * sign;
                        studio.shade(colour, normal.normalize_or(-Vec3::Z), Finish::FABRIC, 1.0)
                    },
                );
            }
        }
    }

    /// Tests every sample of a pixel, and lights those that the shape wins with the light at their middle.
    #[inline(always)]
    fn cover(
        &mut self,
        x: usize,
        y: usize,
        depth_at: impl Fn(Vec2) -> Option<f32>,
        light_at: impl Fn(&Studio, Vec2) -> Colour,
    ) {
        let index = (y - self.first_row) * self.width + x;
        let depths = &mut self.depth[index];
        let mut won = [false; N];
        let (mut middle, mut nearest, mut count) = (Vec2::ZERO, f32::INFINITY, 0.0);
        for sample in 0..N {
            if let Some(depth) = depth_at(self.samples[sample])
                && depth < depths[sample]
            {
                depths[sample] = depth;
                won[sample] = true;
                middle += self.samples[sample];
                nearest = nearest.min(depth);
                count += 1.0;
            }
        }
        if count == 0.0 {
            return;
        }
        let light = self.haze.apply(light_at(self.studio, middle / count), nearest);
        for (slot, _) in self.colour[index].iter_mut().zip(won).filter(|(_, won)| *won) {
            *slot = light;
        }
    }

    fn rows_between(&self, low: f32, high: f32) -> std::ops::Range<usize> {
        let first = self.first_row as f32;
        let from = (low - first).max(0.0) as usize;
        let to = (high - first + 1.0).clamp(0.0, self.rows as f32) as usize;
        self.first_row + from.min(to)..self.first_row + to
    }

    fn columns_between(&self, low: f32, high: f32) -> std::ops::Range<usize> {
        let to = (high + 1.0).clamp(0.0, self.width as f32) as usize;
        (low.max(0.0) as usize).min(to)..to
    }
}

impl Haze {
    fn apply(&self, colour: Colour, depth: f32) -> Colour {
        let share = ((depth - self.begin) / (self.end - self.begin)).clamp(0.0, 1.0);
        colour.lerp(self.colour, self.strength * share)
    }
}

fn mix([a, b]: [f32; 2], share: f32) -> f32 {
    a + (b - a) * share
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Framing, Side};
    use crate::colour::srgb;

    const HAZE: Haze = Haze { colour: Colour::ONE, begin: 1e3, end: 2e3, strength: 0.0 };

    fn studio() -> Studio {
        Studio::new(&Framing::new(Side::Corner, Vec2::ZERO, Vec2::splat(32.0)).camera(), Vec3::Y)
    }

    fn ball(x: f32, depth: f32, colour: u32) -> Sphere {
        let centre = Vec2::new(x, 16.0);
        Sphere { centre, depth, radius: 1.0, pixel_radius: 8.0, colour: srgb(colour), open: 1.0 }
    }

    #[test]
    fn a_sphere_covers_its_disc_and_nothing_else() {
        let studio = studio();
        let mut band = Band::new(32, 0, 32, &SAMPLES_4, &studio, HAZE);
        band.sphere(&ball(16.0, 10.0, 0xff_00_00));
        let (depths, colours) = band.pixel(16, 16);
        assert!(depths.iter().all(|&depth| (8.99..9.02).contains(&depth)), "{depths:?}");
        assert!(colours[0].x > 0.3 && colours[0].x > 3.0 * colours[0].y, "{:?}", colours[0]);
        assert_eq!(band.pixel(16, 5).0, &[f32::INFINITY; 4]);
        assert_eq!(band.pixel(23, 23).0, &[f32::INFINITY; 4]);
        let covered: usize =
            (0..1024).map(|i| band.pixel(i % 32, i / 32).0.iter().filter(|d| d.is_finite()).count()).sum();
        let area = covered as f32 / 4.0;
        assert!((area - 201.0).abs() < 4.0, "π·8² is 201 pixels, found {area}");
    }

    #[test]
    fn the_nearer_thing_is_seen_whatever_the_order() {
        let studio = studio();
        let (near, far) = (ball(14.0, 10.0, 0xff_00_00), ball(18.0, 12.0, 0x00_00_ff));
        for order in [[near, far], [far, near]] {
            let mut band = Band::new(32, 0, 32, &SAMPLES_8, &studio, HAZE);
            order.iter().for_each(|sphere| band.sphere(sphere));
            let colour = band.pixel(16, 16).1[0];
            assert!(colour.x > colour.z, "{colour}");
        }
    }

    #[test]
    fn a_triangle_shows_the_tint_of_the_side_that_is_seen() {
        let studio = studio();
        let corner = |x, y| Corner { pixel: Vec2::new(x, y), depth: 5.0, normal: -Vec3::Z };
        let colours = [srgb(0xff_00_00), srgb(0x00_00_ff)];
        for (flip, red) in [(false, true), (true, false)] {
            let mut corners = [corner(2.0, 30.0), corner(30.0, 30.0), corner(16.0, 2.0)];
            if flip {
                corners.swap(0, 1);
            }
            let mut band = Band::new(32, 0, 32, &SAMPLES_4, &studio, HAZE);
            band.triangle(&Triangle { corners, colours });
            let colour = band.pixel(16, 20).1[0];
            assert_eq!(colour.x > colour.z, red);
        }
    }

    #[test]
    fn bands_draw_what_one_band_draws() {
        let studio = studio();
        let ends = [Vec2::new(3.0, 4.0), Vec2::new(28.0, 27.0)];
        let wire = Capsule {
            ends,
            depths: [5.0, 6.0],
            radius: 0.1,
            pixel_radii: [2.0, 1.5],
            across: [Vec3::X, -Vec3::Z],
            colour: srgb(0x80_80_80),
            open: 1.0,
        };
        let draw = |first, rows| {
            let mut band = Band::new(32, first, rows, &SAMPLES_4, &studio, HAZE);
            band.capsule(&wire);
            band.sphere(&ball(12.0, 5.5, 0x20_80_20));
            band
        };
        let (whole, upper, lower) = (draw(0, 32), draw(0, 17), draw(17, 15));
        for (x, y) in (0..32).flat_map(|y| (0..32).map(move |x| (x, y))) {
            let part = if y < 17 { upper.pixel(x, y) } else { lower.pixel(x, y - 17) };
            assert_eq!(whole.pixel(x, y), part);
        }
    }
}
