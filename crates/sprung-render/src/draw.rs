//! What is drawn: points become balls, springs wires or coils, surfaces triangles.

use glam::{Vec2, Vec3};
use sprung::{Model, Params, SurfaceKind};

use crate::camera::{Camera, Projected};
use crate::colour::{Colour, diverging, srgb};
use crate::motion::spring_force;
use crate::palette::LIGHT;
use crate::raster::{Capsule, Corner, Sphere, Triangle};
use crate::surroundings::{openness, spacing};

/// Up to this many springs are drawn as coils.
const COILS: usize = 40;
/// More points than this are too many for balls and wires where there is a surface.
const CROWD: usize = 20_000;
/// Neighbours closer than this, in pixels, are too close for balls and wires where there is a surface.
const CLOSEST_PIXELS: f32 = 6.0;
/// Fixed points that are marked on a body shown by its surface alone.
const MOST_MARKS: usize = 200;
/// Springs that are drawn at all.
const MOST_WIRES: usize = 400_000;

/// What is drawn of a model, and how large: chosen once for a motion.
#[derive(Clone, Debug)]
pub struct Look {
    /// Radius of a ball, m.
    pub ball: f32,
    /// Median rest length, m: the distance between neighbours.
    pub spacing: f32,
    /// Force of the strongest colour, N.
    pub full_force: f32,
    /// Whether any spring is drawn.
    pub any_wires: bool,
    /// For each body: whether its points and springs are drawn, not only its surface.
    body_in_detail: Vec<bool>,
    coils: bool,
    few: bool,
}

/// The shapes of one picture.
#[derive(Clone, Debug, Default)]
pub struct Shapes {
    /// Points.
    pub spheres: Vec<Sphere>,
    /// Springs.
    pub capsules: Vec<Capsule>,
    /// Surfaces.
    pub triangles: Vec<Triangle>,
}

impl Look {
    /// Chooses for a model; `extent` (m) is the size of the motion, for models without springs.
    pub fn new(model: &Model, extent: f32, full_force: f32) -> Self {
        let points = model.point_count();
        let spacing = spacing(model).unwrap_or_else(|| extent / libm::cbrtf(points as f32).max(4.0));
        let few = points <= 40;
        Self {
            ball: if points <= 4 { 0.09 } else { 0.16 } * spacing,
            spacing,
            full_force,
            any_wires: false,
            body_in_detail: Vec::new(),
            coils: model.spring_count() <= COILS,
            few,
        }
    }

    /// Chooses between balls and wires or surfaces alone, once the camera is known.
    pub fn choose_detail(&mut self, model: &Model, camera: &Camera, centre: Vec3) {
        let depth = camera.view(centre).z.max(camera.near);
        let crowded = model.point_count() > CROWD || self.spacing * camera.focal / depth < CLOSEST_PIXELS;
        let has_surface = |body| model.surfaces().iter().any(|surface| surface.body == body);
        let covered = |body| has_surface(body) && (crowded || model.is_seen_by_surface(body));
        self.body_in_detail = (0..model.bodies().len()).map(|body| !covered(body)).collect();
        let any_wires = self.wires(model).next().is_some();
        self.any_wires = any_wires;
    }

    /// The shapes of one moment.
    pub fn shapes(&self, model: &Model, params: &Params, positions: &[Vec3], camera: &Camera) -> Shapes {
        let mut shapes = Shapes::default();
        // Points, and after them the vertices that they carry.
        let all = model.with_weighted(positions);
        let seen: Vec<Option<Projected>> = all.iter().map(|&position| camera.project(position)).collect();
        let open = if self.any_wires { openness(model, positions) } else { vec![1.0; positions.len()] };
        self.add_wires(&mut shapes, model, params, positions, camera, &open);
        self.add_balls(&mut shapes, model, params, camera, &seen, &open);
        self.add_surfaces(&mut shapes, model, &all, camera, &seen);
        shapes
    }

    /// Springs that are drawn.
    fn wires<'a>(&'a self, model: &'a Model) -> impl Iterator<Item = usize> + 'a {
        let bodies = model.bodies().iter().zip(&self.body_in_detail).filter(|(_, detail)| **detail);
        let ranges = bodies
            .map(|(body, _)| body.springs.clone())
            .chain(model.joints().iter().map(|joint| joint.springs.clone()));
        ranges.flatten().take(MOST_WIRES)
    }

    fn add_balls(
        &self,
        shapes: &mut Shapes,
        model: &Model,
        params: &Params,
        camera: &Camera,
        seen: &[Option<Projected>],
        open: &[f32],
    ) {
        for (index, body) in model.bodies().iter().enumerate() {
            let detail = self.body_in_detail[index];
            let colour = srgb(LIGHT.balls[index % LIGHT.balls.len()]);
            let mut marks_left = MOST_MARKS;
            for point in body.points.clone() {
                let fixed = params.is_fixed(point);
                let Some(Projected { pixel, depth }) = seen[point] else { continue };
                // Of a body shown by its surface alone, only the fixed points are marked, large enough to be seen.
                let (radius, least) = match (detail, fixed) {
                    (true, true) => (1.25 * self.ball, 2.2),
                    (true, false) => (self.ball, 0.9),
                    (false, true) if marks_left > 0 => {
                        marks_left -= 1;
                        (self.ball, 4.5)
                    }
                    (false, _) => continue,
                };
                let radius = radius.max(least * depth / camera.focal);
                shapes.spheres.push(Sphere {
                    centre: pixel,
                    depth,
                    radius,
                    pixel_radius: radius * camera.focal / depth,
                    colour: if fixed { srgb(LIGHT.fixed) } else { colour },
                    open: open[point],
                });
            }
        }
    }

    fn add_wires(
        &self,
        shapes: &mut Shapes,
        model: &Model,
        params: &Params,
        positions: &[Vec3],
        camera: &Camera,
        open: &[f32],
    ) {
        for spring in self.wires(model) {
            if params.spring_cut[spring] {
                continue;
            }
            let [i, j] = model.springs()[spring].map(|point| point as usize);
            let (a, b) = (positions[i], positions[j]);
            let colour = diverging(spring_force(model, params, positions, spring) / self.full_force);
            let open = 0.5 * (open[i] + open[j]);
            let rest = params.spring_rest_length[spring].min(4.0 * self.spacing).max(0.2 * self.spacing);
            if self.coils {
                let path = coil(a, b, rest, self.ball);
                for pair in path.windows(2) {
                    shapes.capsules.extend(wire(camera, pair[0], pair[1], 0.017 * rest, 1.0, colour, open));
                }
            } else {
                let thickness = if self.few { 0.05 } else { 0.02 } * self.spacing;
                shapes.capsules.extend(wire(camera, a, b, thickness, 0.62, colour, open));
            }
        }
    }

    fn add_surfaces(
        &self,
        shapes: &mut Shapes,
        model: &Model,
        positions: &[Vec3],
        camera: &Camera,
        seen: &[Option<Projected>],
    ) {
        let mut normals = Vec::new();
        for (index, surface) in model.surfaces().iter().enumerate() {
            let triangles = model.triangles_in_list(index);
            let detail = self.body_in_detail[surface.body];
            let tints = match (surface.kind, detail) {
                // Inside a skin of a solid shown in detail nothing could be seen.
                (SurfaceKind::Skin, true) => continue,
                (SurfaceKind::Skin, false) => LIGHT.skin,
                (SurfaceKind::Cloth, true) => LIGHT.cloth_pale,
                (SurfaceKind::Cloth, false) => LIGHT.cloth_rich,
            };
            // Normals of the corners: the sum over their triangles, weighted by area as cross products are.
            normals.clear();
            normals.resize(positions.len(), Vec3::ZERO);
            for triangle in triangles.iter() {
                let [a, b, c] = triangle.map(|point| positions[point as usize]);
                let normal = (b - a).cross(c - a);
                triangle.iter().for_each(|&point| normals[point as usize] += normal);
            }
            let colours = tints.map(srgb);
            shapes.triangles.reserve(triangles.len());
            for triangle in triangles.iter() {
                let corner = |point: u32| {
                    let Projected { pixel, depth } = seen[point as usize]?;
                    let normal = camera.turn(normals[point as usize]).normalize_or(-Vec3::Z);
                    Some(Corner { pixel, depth, normal })
                };
                let [a, b, c] = triangle.map(corner);
                if let (Some(a), Some(b), Some(c)) = (a, b, c) {
                    shapes.triangles.push(Triangle { corners: [a, b, c], colours });
                }
            }
        }
    }
}

/// A piece of wire between two places, at least `thinnest` pixels in radius.
fn wire(
    camera: &Camera,
    a: Vec3,
    b: Vec3,
    radius: f32,
    thinnest: f32,
    colour: Colour,
    open: f32,
) -> Option<Capsule> {
    let ends = [camera.project(a)?, camera.project(b)?];
    let along = camera.turn(b - a);
    // To the side of the wire as the picture shows it, as the rasteriser measures it, and from there towards the viewer.
    let toward = -Vec3::Z;
    let side = toward.cross(along).normalize_or(Vec3::X);
    let outward = along.cross(side).normalize_or(toward);
    let shown = ends[1].pixel - ends[0].pixel;
    let across = Vec2::new(-shown.y, shown.x);
    let sign = if across.x * side.x - across.y * side.y < 0.0 { -1.0 } else { 1.0 };
    let outward = if outward.z > 0.0 { -outward } else { outward };
    Some(Capsule {
        ends: ends.map(|end| end.pixel),
        depths: ends.map(|end| end.depth),
        radius,
        pixel_radii: ends.map(|end| (radius * camera.focal / end.depth).max(thinnest)),
        across: [side * sign, outward],
        colour,
        open,
    })
}

/// The path of a coil spring from `a` to `b`: two straight leads and a helix whose turns stay when it is stretched.
fn coil(a: Vec3, b: Vec3, rest: f32, ball: f32) -> Vec<Vec3> {
    const TURNS: usize = 11;
    const STEPS: usize = 24;
    let axis = b - a;
    let length = axis.length();
    let along = axis.normalize_or(Vec3::Y);
    let side = along.any_orthonormal_vector();
    let other = along.cross(side);
    let radius = 0.11 * rest;
    let lead = (1.4 * ball).min(0.25 * length);
    let mut path = vec![a];
    for step in 0..=TURNS * STEPS {
        let share = step as f32 / (TURNS * STEPS) as f32;
        let angle = (step % STEPS) as f32 / STEPS as f32 * std::f32::consts::TAU;
        // The first and last turn grow out of the axis.
        let swell = (share * TURNS as f32).min((1.0 - share) * TURNS as f32).min(1.0);
        let out = (side * libm::cosf(angle) + other * libm::sinf(angle)) * (radius * swell);
        path.push(a + along * (lead + (length - 2.0 * lead) * share) + out);
    }
    path.push(b);
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coil_begins_and_ends_at_its_points() {
        let (a, b) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.0, -3.0, 3.0));
        let path = coil(a, b, 5.0, 0.5);
        assert_eq!((path.first(), path.last()), (Some(&a), Some(&b)));
        assert!(path.iter().all(|place| (place.x - 1.0).hypot(place.z - 3.0) < 0.6));
        assert!(coil(a, a, 5.0, 0.5).iter().all(|place| place.is_finite()));
    }
}
