//! What lies under the cursor: a point, else a spring, and never one that a surface hides.

use glam::{Vec2, Vec3};
use sprung::Model;
use sprung_render::camera::Camera;

use super::drawn::Drawn;
use crate::state::Pick;

/// How far from the cursor a point may be, in the window's points.
pub const POINT_REACH: f32 = 12.0;
/// The same for springs.
pub const SPRING_REACH: f32 = 6.0;
/// A finger covers more.
pub const TOUCH: f32 = 2.2;
/// Of what is as near to the cursor as this, the nearest to the eye is meant.
const TIE: f32 = 3.0;
/// Cells on each side of the middle one in the little depth picture around the cursor.
const CELLS: i32 = 14;

/// The code of points that are not seen: on every side.
const UNSEEN: u8 = 0b1_1111;

/// Every point of the model as the picture shows it.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    /// Where each point appears, from the view's corner.
    pub pixels: Vec<Vec2>,
    /// Distance of each along the view, m; infinite where it is not seen at all.
    pub depths: Vec<f32>,
    /// The same of the vertices that points carry along, surface by surface.
    carried: Vec<(Vec2, f32)>,
}

impl Seen {
    /// Looks at some positions.
    pub fn new(camera: &Camera, positions: impl Iterator<Item = Vec3>) -> Self {
        let (mut pixels, mut depths) = (Vec::new(), Vec::new());
        for position in positions {
            let seen = camera.project(position);
            pixels.push(seen.map_or(Vec2::NAN, |seen| seen.pixel));
            depths.push(seen.map_or(f32::INFINITY, |seen| seen.depth));
        }
        Self { pixels, depths, carried: Vec::new() }
    }

    /// Looks at the vertices that points at some positions carry along, too.
    pub fn carrying(mut self, camera: &Camera, model: &Model, positions: &[Vec3]) -> Self {
        let vertices = model.surfaces().iter().flat_map(sprung::Surface::weighted);
        let seen = vertices.map(|vertex| camera.project(vertex.of(positions)));
        self.carried = seen
            .map(|seen| seen.map_or((Vec2::NAN, f32::INFINITY), |seen| (seen.pixel, seen.depth)))
            .collect();
        self
    }

    /// Where a corner of a surface appears: a point, or a vertex that comes after all points.
    fn corner(&self, corner: u32) -> (Vec2, f32) {
        let corner = corner as usize;
        match self.pixels.get(corner) {
            Some(&pixel) => (pixel, self.depths[corner]),
            None => {
                self.carried.get(corner - self.pixels.len()).copied().unwrap_or((Vec2::NAN, f32::INFINITY))
            }
        }
    }

    /// Where a point appears, if it does.
    pub fn pixel(&self, point: usize) -> Option<Vec2> {
        self.pixels.get(point).copied().filter(|pixel| pixel.is_finite())
    }

    /// On which sides of a rectangle each point lies, for telling fast what misses it: if the codes of all corners have a
    /// bit in common, the whole lies on that side.
    pub fn sides(&self, low: Vec2, high: Vec2) -> Vec<u8> {
        let side = |pixel: &Vec2| {
            let aside = u8::from(pixel.x < low.x) | u8::from(pixel.x > high.x) << 1;
            let along = u8::from(pixel.y < low.y) << 2 | u8::from(pixel.y > high.y) << 3;
            if pixel.is_nan() { UNSEEN } else { aside | along }
        };
        self.pixels.iter().chain(self.carried.iter().map(|(pixel, _)| pixel)).map(side).collect()
    }

    /// Both ends of a spring, if they are seen.
    pub fn ends(&self, [i, j]: [u32; 2]) -> Option<(Vec2, Vec2)> {
        Some((self.pixel(i as usize)?, self.pixel(j as usize)?))
    }
}

/// What is meant by the cursor; `reach` is 1 for a mouse and [`TOUCH`] for a finger.
///
/// The nearest point within [`POINT_REACH`], else the nearest spring within [`SPRING_REACH`]; where nothing is as near
/// but the cursor is on a surface, the nearest corner of the triangle there.
pub fn pick(
    model: &Model,
    cut: &[bool],
    drawn: &Drawn,
    seen: &Seen,
    cursor: Vec2,
    reach: f32,
) -> Option<Pick> {
    let front = Front::new(model, drawn, seen, cursor, reach * POINT_REACH);
    let point = nearest_point(seen, drawn, cursor, reach * POINT_REACH, &front).map(Pick::Point);
    let spring = || nearest_spring(model, cut, drawn.springs(), seen, cursor, reach * SPRING_REACH, &front);
    let corner = || front.corner(model, seen, cursor).map(Pick::Point);
    point.or_else(|| spring().map(Pick::Spring)).or_else(corner)
}

/// The spring that scissors at the cursor are on: the nearest within [`SPRING_REACH`] that is drawn or lies in a surface,
/// and that none hides. Points are in no way: where springs are short, all of them is near a point.
pub fn pick_to_cut(
    model: &Model,
    cut: &[bool],
    drawn: &Drawn,
    seen: &Seen,
    cursor: Vec2,
    reach: f32,
) -> Option<usize> {
    let reach = reach * SPRING_REACH;
    let front = Front::new(model, drawn, seen, cursor, reach);
    // Most springs of a large surface are far away, which this tells at once.
    let sides = seen.sides(cursor - reach, cursor + reach);
    let may_be_near = |spring: &usize| {
        let [i, j] = model.springs()[*spring];
        sides[i as usize] & sides[j as usize] == 0
    };
    let springs = drawn.springs_in_reach().filter(may_be_near);
    nearest_spring(model, cut, springs, seen, cursor, reach, &front)
}

fn nearest_point(seen: &Seen, drawn: &Drawn, cursor: Vec2, reach: f32, front: &Front) -> Option<usize> {
    let mut best = Best::new(reach);
    for body in &drawn.bodies {
        if !body.points && !body.surface {
            continue;
        }
        for point in body.point_range.clone() {
            let (pixel, depth) = (seen.pixels[point], seen.depths[point]);
            let distance = (pixel - cursor).length();
            if distance <= reach && !front.hides(pixel, depth) {
                best.offer(point, distance, depth);
            }
        }
    }
    best.chosen()
}

fn nearest_spring(
    model: &Model,
    cut: &[bool],
    springs: impl Iterator<Item = usize>,
    seen: &Seen,
    cursor: Vec2,
    reach: f32,
    front: &Front,
) -> Option<usize> {
    let mut best = Best::new(reach);
    for spring in springs {
        let [i, j] = model.springs()[spring];
        let Some((a, b)) = seen.ends([i, j]) else { continue };
        if cut.get(spring) == Some(&true) {
            continue;
        }
        let (distance, share) = distance_to_segment(cursor, a, b);
        if distance <= reach {
            let depth = seen.depths[i as usize] * (1.0 - share) + seen.depths[j as usize] * share;
            if !front.hides(a.lerp(b, share), depth) {
                best.offer(spring, distance, depth);
            }
        }
    }
    best.chosen()
}

/// The nearest of what was offered, and of near ties the one nearest to the eye.
struct Best {
    nearest: f32,
    offers: Vec<(usize, f32, f32)>,
}

impl Best {
    fn new(reach: f32) -> Self {
        Self { nearest: reach, offers: Vec::new() }
    }

    fn offer(&mut self, index: usize, distance: f32, depth: f32) {
        self.nearest = self.nearest.min(distance);
        if distance <= self.nearest + TIE {
            self.offers.push((index, distance, depth));
        }
    }

    fn chosen(self) -> Option<usize> {
        let ties = self.offers.iter().filter(|(_, distance, _)| *distance <= self.nearest + TIE);
        ties.min_by(|a, b| a.2.total_cmp(&b.2).then(a.1.total_cmp(&b.1))).map(|&(index, ..)| index)
    }
}

/// The front of filled surfaces around the cursor: a depth picture of a few hundred cells.
struct Front {
    /// The picture's corner, and cells for each of the window's points.
    corner: Vec2,
    scale: f32,
    depths: Vec<f32>,
    /// The triangle in front at the cursor, and its distance.
    at_cursor: Option<([u32; 3], f32)>,
}

impl Front {
    const SIDE: i32 = 2 * CELLS + 1;

    fn new(model: &Model, drawn: &Drawn, seen: &Seen, cursor: Vec2, reach: f32) -> Self {
        let cell = (reach + 2.0) / CELLS as f32;
        let half = cell * Self::SIDE as f32 * 0.5;
        let cells = (Self::SIDE * Self::SIDE) as usize;
        let corner = cursor - half;
        let mut front =
            Self { corner, scale: 1.0 / cell, depths: vec![f32::INFINITY; cells], at_cursor: None };
        if !drawn.bodies.iter().any(|body| body.surface) {
            return front;
        }
        let sides = seen.sides(cursor - half, cursor + half);
        for (index, surface) in model.surfaces().iter().enumerate() {
            if !drawn.bodies[surface.body].surface {
                continue;
            }
            for &[a, b, c] in model.triangles_in_list(index).iter() {
                let [p, q, r] = [a, b, c].map(|corner| sides.get(corner as usize).copied().unwrap_or(UNSEEN));
                if p & q & r == 0 && (p | q | r) < 16 {
                    let places = [a, b, c].map(|corner| seen.corner(corner));
                    front.draw(
                        [a, b, c],
                        places.map(|(pixel, _)| pixel),
                        places.map(|(_, depth)| depth),
                        cursor,
                    );
                }
            }
        }
        front
    }

    fn draw(&mut self, triangle: [u32; 3], corners: [Vec2; 3], depths: [f32; 3], cursor: Vec2) {
        let depth_at = |pixel: Vec2| {
            let weights = barycentric(corners, pixel)?;
            // 1/depth is what runs straight across the picture.
            let inverse: f32 = weights.iter().zip(depths).map(|(weight, depth)| weight / depth).sum();
            Some(1.0 / inverse)
        };
        if let Some(depth) = depth_at(cursor)
            && self.at_cursor.is_none_or(|(_, nearest)| depth < nearest)
        {
            self.at_cursor = Some((triangle, depth));
        }
        let cell =
            |pixel: Vec2| ((pixel - self.corner) * self.scale).clamp(Vec2::splat(-1.0), Vec2::splat(99.0));
        let low = corners.into_iter().map(cell).reduce(Vec2::min).unwrap_or_default();
        let high = corners.into_iter().map(cell).reduce(Vec2::max).unwrap_or_default();
        for row in (low.y as i32).max(0)..=(high.y as i32).min(Self::SIDE - 1) {
            for column in (low.x as i32).max(0)..=(high.x as i32).min(Self::SIDE - 1) {
                let middle = self.corner + (Vec2::new(column as f32, row as f32) + 0.5) / self.scale;
                if let Some(depth) = depth_at(middle) {
                    let slot = &mut self.depths[(row * Self::SIDE + column) as usize];
                    *slot = slot.min(depth);
                }
            }
        }
    }

    /// Whether a surface lies clearly before a place, in its own cell and in all those around it: a slanting surface does
    /// not hide its own points, nor an edge those at the edge.
    fn hides(&self, pixel: Vec2, depth: f32) -> bool {
        if self.at_cursor.is_none() && self.depths.iter().all(|depth| *depth == f32::INFINITY) {
            return false;
        }
        let cell = ((pixel - self.corner) * self.scale).floor();
        let (left, top) = (cell.x as i32, cell.y as i32);
        let mut behind = f32::MIN;
        for y in -1..=1 {
            for x in -1..=1 {
                let (column, row) = (left + x, top + y);
                if (0..Self::SIDE).contains(&column) && (0..Self::SIDE).contains(&row) {
                    behind = behind.max(self.depths[(row * Self::SIDE + column) as usize]);
                }
            }
        }
        depth > behind * 1.0005
    }

    /// The point at the nearest corner of the triangle in front; where points carry the surface, the one that carries most of
    /// that corner.
    fn corner(&self, model: &Model, seen: &Seen, cursor: Vec2) -> Option<usize> {
        let (triangle, _) = self.at_cursor?;
        let away = |corner: &u32| (seen.corner(*corner).0 - cursor).length();
        let corner = triangle.into_iter().min_by(|a, b| away(a).total_cmp(&away(b)))? as usize;
        let Some(carried) = corner.checked_sub(model.point_count()) else { return Some(corner) };
        let mut vertices = model.surfaces().iter().flat_map(sprung::Surface::weighted);
        let vertex = vertices.nth(carried)?;
        let heaviest = (0..4).max_by(|&a, &b| vertex.weights[a].total_cmp(&vertex.weights[b]))?;
        Some(vertex.points[heaviest] as usize)
    }
}

/// Shares of a triangle's corners in a place inside it; `None` outside.
fn barycentric([a, b, c]: [Vec2; 3], place: Vec2) -> Option<[f32; 3]> {
    let area = (b - a).perp_dot(c - a);
    if area == 0.0 {
        return None;
    }
    let (u, v) = ((b - place).perp_dot(c - place) / area, (c - place).perp_dot(a - place) / area);
    let w = 1.0 - u - v;
    (u >= 0.0 && v >= 0.0 && w >= 0.0).then_some([u, v, w])
}

/// How far a place is from a segment, and where on it (0 to 1) the nearest place lies.
pub fn distance_to_segment(place: Vec2, a: Vec2, b: Vec2) -> (f32, f32) {
    let along = b - a;
    let share = ((place - a).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
    ((place - a - along * share).length(), share)
}

/// Whether two segments cross.
pub fn segments_cross(a: Vec2, b: Vec2, c: Vec2, d: Vec2) -> bool {
    let side = |from: Vec2, to: Vec2, place: Vec2| (to - from).perp_dot(place - from);
    let (c_side, d_side) = (side(a, b, c), side(a, b, d));
    let (a_side, b_side) = (side(c, d, a), side(c, d, b));
    // Both ends of each on different sides of the other; an end on the line counts as one side only.
    (c_side > 0.0) != (d_side > 0.0) && (a_side > 0.0) != (b_side > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::scene::{BUILTIN, Scene};
    use sprung::{Material, ModelBuilder, SurfaceKind};
    use sprung_render::appearance::Appearance;
    use sprung_render::camera::Bounds;
    use sprung_render::turntable::Turntable;

    const SIZE: Vec2 = Vec2::new(800.0, 600.0);

    /// A few numbers from 0 to 1 that look random.
    fn random(seed: u32) -> impl FnMut() -> f32 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 24) as f32
        }
    }

    #[test]
    fn without_surfaces_it_is_the_nearest_point_or_else_spring() {
        for name in ["spring", "chain", "jelly", "bridge"] {
            let scene = Scene::builtin(name).expect("it is built in").simulation().expect("it can be built");
            let (model, positions) = (scene.model(), &scene.state().position);
            let mut bounds = Bounds::default();
            positions.iter().for_each(|&position| bounds.include(position));
            let camera = Turntable::framing(&bounds, SIZE.x / SIZE.y).camera(SIZE);
            let seen = Seen::new(&camera, positions.iter().copied());
            let drawn = Drawn::new(model, &Appearance::default());
            let uncut = vec![false; model.spring_count()];
            let mut next = random(7);
            for _ in 0..300 {
                let cursor = Vec2::new(next() * SIZE.x, next() * SIZE.y);
                let distances = seen.pixels.iter().map(|pixel| (*pixel - cursor).length());
                let nearest = distances.fold(f32::MAX, f32::min);
                let spring = model.springs().iter().filter_map(|&ends| seen.ends(ends));
                let spring =
                    spring.map(|(a, b)| distance_to_segment(cursor, a, b).0).fold(f32::MAX, f32::min);
                match pick(model, &uncut, &drawn, &seen, cursor, 1.0) {
                    Some(Pick::Point(point)) => {
                        let found = (seen.pixels[point] - cursor).length();
                        assert!(found <= POINT_REACH && found <= nearest + TIE, "{name} {cursor}");
                        let nearer = (0..seen.pixels.len()).find(|&other| {
                            (seen.pixels[other] - cursor).length() <= nearest + TIE
                                && (seen.pixels[other] - cursor).length() <= POINT_REACH
                                && seen.depths[other] < seen.depths[point]
                        });
                        assert_eq!(nearer, None, "{name} {cursor}");
                    }
                    Some(Pick::Spring(found)) => {
                        assert!(nearest > POINT_REACH && spring <= SPRING_REACH, "{name} {cursor}");
                        let (a, b) = seen.ends(model.springs()[found]).expect("it is seen");
                        assert!(distance_to_segment(cursor, a, b).0 <= spring + TIE);
                    }
                    None => assert!(nearest > POINT_REACH && spring > SPRING_REACH, "{name} {cursor}"),
                }
            }
        }
    }

    /// Two cloths of one triangle each, one before the other, with the camera before both.
    fn sheets() -> (Model, Vec<Vec3>) {
        let mut builder = ModelBuilder::new();
        let mut positions = Vec::new();
        for (depth, name) in [(0.0, "front"), (-4.0, "back")] {
            builder.begin_body(name).expect("the name is free");
            let first = positions.len();
            for (x, y) in [(-3.0, -2.0), (3.0, -2.0), (0.0, 3.0)] {
                // The back one is small: all of it lies behind the front one.
                let scale = if depth == 0.0 { 1.0 } else { 0.3 };
                positions.push(Vec3::new(x * scale, y * scale, depth));
                builder.add_point(positions[positions.len() - 1], 1.0).expect("allowed");
            }
            let material = Material { stiffness: 1.0, damping: 0.0 };
            for (i, j) in [(0, 1), (1, 2), (0, 2)] {
                builder.add_spring(first + i, first + j, material).expect("allowed");
            }
            let corners = [0, 1, 2].map(|corner| first as u32 + corner);
            builder.add_surface(SurfaceKind::Cloth, vec![corners]).expect("allowed");
        }
        let (model, ..) = builder.build().expect("sound");
        (model, positions)
    }

    #[test]
    fn what_a_surface_hides_is_not_picked_through_it() {
        let (model, positions) = sheets();
        let camera = Turntable { target: Vec3::ZERO, distance: 20.0, azimuth: 0.0, elevation: 0.0 };
        let seen = Seen::new(&camera.camera(SIZE), positions.iter().copied());
        let drawn = Drawn::new(&model, &Appearance::default());
        let uncut = vec![false; model.spring_count()];
        // At a corner of the back sheet, in the middle of the front one: its nearest corner is meant, or one of its springs.
        for hidden in 3..6 {
            let cursor = seen.pixels[hidden];
            let found = pick(&model, &uncut, &drawn, &seen, cursor, 1.0);
            assert!(matches!(found, Some(Pick::Point(0..3) | Pick::Spring(0..3))), "{hidden}: {found:?}");
        }
        // From behind it is the nearest.
        let camera = Turntable { azimuth: std::f32::consts::PI, ..camera };
        let seen = Seen::new(&camera.camera(SIZE), positions.iter().copied());
        for open in 3..6 {
            let found = pick(&model, &uncut, &drawn, &seen, seen.pixels[open], 1.0);
            assert_eq!(found, Some(Pick::Point(open)));
        }
    }

    #[test]
    fn large_scenes_are_picked_on_their_surface() {
        for builtin in BUILTIN.iter().filter(|builtin| ["cloth512", "jelly64"].contains(&builtin.name)) {
            let scene =
                Scene::builtin(builtin.name).expect("it is built in").simulation().expect("it can be built");
            let (model, positions) = (scene.model(), &scene.state().position);
            let mut bounds = Bounds::default();
            positions.iter().for_each(|&position| bounds.include(position));
            let camera = Turntable::framing(&bounds, SIZE.x / SIZE.y).camera(SIZE);
            let seen = Seen::new(&camera, positions.iter().copied());
            let drawn = Drawn::new(model, &Appearance::default());
            let uncut = vec![false; model.spring_count()];
            let Some(Pick::Point(point)) = pick(model, &uncut, &drawn, &seen, 0.5 * SIZE, 1.0) else {
                panic!("{}: the middle of the picture is full of it", builtin.name)
            };
            let surface = model.surfaces().iter().flat_map(|surface| surface.triangles.iter().flatten());
            assert!(surface.clone().any(|&corner| corner as usize == point), "{}", builtin.name);
            // No corner near the cursor is much nearer to the eye.
            let near = surface.filter(|&&corner| (seen.pixels[corner as usize] - 0.5 * SIZE).length() < 3.0);
            let front = near.map(|&corner| seen.depths[corner as usize]).fold(f32::MAX, f32::min);
            assert!(
                seen.depths[point] <= front * 1.01,
                "{}: {} behind {front}",
                builtin.name,
                seen.depths[point]
            );
        }
    }

    #[test]
    fn crossing_is_told_from_touching_nothing() {
        let v = Vec2::new;
        assert!(segments_cross(v(0.0, 0.0), v(2.0, 2.0), v(0.0, 2.0), v(2.0, 0.0)));
        assert!(!segments_cross(v(0.0, 0.0), v(2.0, 2.0), v(3.0, 2.0), v(5.0, 0.0)));
        assert!(!segments_cross(v(0.0, 0.0), v(2.0, 0.0), v(0.0, 1.0), v(2.0, 1.0)));
        // A line drawn in two pieces crosses a spring through their joint once and not twice.
        let (a, joint, b) = (v(0.0, 0.0), v(1.0, 0.0), v(2.0, 0.0));
        let (c, d) = (v(1.0, -1.0), v(1.0, 1.0));
        assert!(segments_cross(a, joint, c, d) != segments_cross(joint, b, c, d));
    }
}
