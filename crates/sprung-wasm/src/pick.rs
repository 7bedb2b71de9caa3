//! What a ray meets: a point, else a spring, and never one that a surface hides.
//!
//! Everything is looked at along the ray, as through a tube that grows wider with the distance: a place counts by how far it
//! is from the ray, as a multiple of the tube's radius there.

use sprung::{Code, DVec3, Error, Model, Result, Vec3};

/// Springs have to be this near, points may be as far away as the tube is wide: points are few and small.
const SPRING_REACH: f64 = 0.5;

/// Of what is as near to the ray as this, the first along it is meant.
const TIE: f64 = 0.25;

/// A surface hides what is further away than this beyond it, as a share of the distance: its own corners are not.
const BEHIND: f64 = 1e-3;

/// A ray with the tube around it.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    origin: DVec3,
    direction: DVec3,
    /// Two directions across.
    across: [DVec3; 2],
    /// The tube's radius at the origin, m.
    radius: f64,
    /// By how much it grows with each metre.
    spread: f64,
}

/// A point or a spring, by its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    Point(usize),
    Spring(usize),
}

/// What was met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picked {
    pub target: Target,
    /// The place on it that is nearest to the ray, m.
    pub position: DVec3,
    /// How far along the ray that is, m.
    pub distance: f64,
}

/// A place as the ray sees it.
#[derive(Clone, Copy, Debug)]
struct Seen {
    /// Across the ray, as a multiple of the tube's radius.
    across: [f64; 2],
    /// Along it, m.
    depth: f64,
    /// The tube's radius there, m.
    radius: f64,
}

impl Ray {
    /// A ray from its origin (m) along a direction of any length, in a tube of this radius (m) that grows by so much with each
    /// metre.
    pub fn new(origin: [f64; 3], direction: [f64; 3], radius: f64, spread: f64) -> Result<Self> {
        let refuse =
            |field: &str, sentence: String| Err(Error::new(Code::OutOfRange, sentence).at_field(field));
        let (origin, direction) = (DVec3::from_array(origin), DVec3::from_array(direction));
        if !origin.is_finite() {
            return refuse("origin", format!("is {origin}, and must be finite"));
        }
        let largest = direction.abs().max_element();
        if !(direction.is_finite() && largest > 0.0) {
            return refuse("direction", format!("is {direction}, and must be finite and not zero"));
        }
        for (field, value) in [("radius", radius), ("spread", spread)] {
            if !(0.0..=1e9).contains(&value) {
                return refuse(field, format!("is {value}, and must be from 0 to 1e9"));
            }
        }
        let direction = (direction / largest).normalize();
        let across = direction.any_orthonormal_pair();
        Ok(Self { origin, direction, across: [across.0, across.1], radius, spread })
    }

    /// How a place is seen; nothing of what lies behind the origin.
    fn see(&self, place: Vec3) -> Option<Seen> {
        let way = place.as_dvec3() - self.origin;
        let depth = way.dot(self.direction);
        let radius = self.radius + self.spread * depth;
        (depth > 0.0 && radius > 0.0).then(|| Seen {
            across: self.across.map(|axis| way.dot(axis) / radius),
            depth,
            radius,
        })
    }
}

impl Seen {
    /// How far from the ray, as a multiple of the tube's radius.
    fn miss(&self) -> f64 {
        self.across[0].hypot(self.across[1])
    }
}

/// What a ray meets first: the point nearest to it within the tube, else the spring within half of it, and of near ties the
/// one nearest to the origin; where nothing is as near, but the ray meets a surface, the nearest corner of the triangle there.
pub fn pick(model: &Model, cut: &[bool], positions: &[Vec3], ray: &Ray) -> Option<Picked> {
    let all = model.with_weighted(positions);
    let seen: Vec<Option<Seen>> = all.iter().map(|&place| ray.see(place)).collect();
    let front = Front::new(model, &seen);

    let mut best = Best::new(1.0);
    for (point, seen) in seen[..positions.len()].iter().enumerate() {
        if let Some(seen) = seen {
            best.offer(Target::Point(point), *seen, positions[point].as_dvec3());
        }
    }
    let point = best.chosen(&front);

    let spring = || {
        let mut best = Best::new(SPRING_REACH);
        for (spring, ends) in model.springs().iter().enumerate() {
            let [i, j] = ends.map(|end| end as usize);
            if let (Some(a), Some(b), false) = (seen[i], seen[j], cut[spring]) {
                let (near, share) = nearest(a, b);
                if near.miss() <= SPRING_REACH {
                    let place = positions[i].as_dvec3().lerp(positions[j].as_dvec3(), share);
                    best.offer(Target::Spring(spring), near, place);
                }
            }
        }
        best.chosen(&front)
    };
    let corner = || {
        let point = carrier(model, front.at_ray()?);
        let seen = seen[point]?;
        let position = positions[point].as_dvec3();
        Some(Picked { target: Target::Point(point), position, distance: seen.depth })
    };
    point.or_else(spring).or_else(corner)
}

/// The place of a segment that is nearest to the ray, and the share of the way to it from the first end.
fn nearest(a: Seen, b: Seen) -> (Seen, f64) {
    let [x, y] = [0, 1].map(|axis| b.across[axis] - a.across[axis]);
    let squared = x * x + y * y;
    let share = if squared > 0.0 { -(a.across[0] * x + a.across[1] * y) / squared } else { 0.0 };
    let share = share.clamp(0.0, 1.0);
    let across = [a.across[0] + share * x, a.across[1] + share * y];
    // Across the tube everything is seen in perspective: what is in the middle there is nearer to the wider end in space.
    let (near, far) = ((1.0 - share) / a.radius, share / b.radius);
    let share = far / (near + far);
    let mix = |from: f64, to: f64| from + (to - from) * share;
    (Seen { across, depth: mix(a.depth, b.depth), radius: mix(a.radius, b.radius) }, share)
}

/// A point on which a corner of a surface lies, or the one that carries most of it.
fn carrier(model: &Model, corner: usize) -> usize {
    let vertices = || model.surfaces().iter().flat_map(sprung::Surface::weighted);
    let Some(vertex) = corner.checked_sub(model.point_count()).and_then(|place| vertices().nth(place)) else {
        return corner;
    };
    let heaviest = (0..4).max_by(|&a, &b| vertex.weights[a].total_cmp(&vertex.weights[b])).unwrap_or(0);
    vertex.points[heaviest] as usize
}

/// The nearest of what was offered, and of near ties the first along the ray.
struct Best {
    reach: f64,
    offers: Vec<(Target, Seen, DVec3)>,
}

impl Best {
    fn new(reach: f64) -> Self {
        Self { reach, offers: Vec::new() }
    }

    fn offer(&mut self, target: Target, seen: Seen, place: DVec3) {
        if seen.miss() <= self.reach {
            self.offers.push((target, seen, place));
        }
    }

    fn chosen(mut self, front: &Front) -> Option<Picked> {
        self.offers.retain(|(_, seen, _)| !front.hides(seen));
        let nearest = self.offers.iter().map(|(_, seen, _)| seen.miss()).fold(f64::INFINITY, f64::min);
        let ties = self.offers.iter().filter(|(_, seen, _)| seen.miss() <= nearest + TIE * self.reach);
        let first =
            ties.min_by(|a, b| a.1.depth.total_cmp(&b.1.depth).then(a.1.miss().total_cmp(&b.1.miss())));
        first.map(|&(target, seen, position)| Picked { target, position, distance: seen.depth })
    }
}

/// The triangles of surfaces that lie within the tube.
struct Front {
    triangles: Vec<([usize; 3], [Seen; 3])>,
}

impl Front {
    fn new(model: &Model, seen: &[Option<Seen>]) -> Self {
        let mut triangles = Vec::new();
        for surface in 0..model.surfaces().len() {
            for corners in model.triangles_in_list(surface).iter() {
                let corners = corners.map(|corner| corner as usize);
                if let [Some(a), Some(b), Some(c)] = corners.map(|corner| seen[corner])
                    && touches_tube([a, b, c])
                {
                    triangles.push((corners, [a, b, c]));
                }
            }
        }
        Self { triangles }
    }

    /// Whether a surface lies before a place.
    fn hides(&self, place: &Seen) -> bool {
        let before = |depth: f64| depth < place.depth * (1.0 - BEHIND);
        self.triangles.iter().any(|(_, corners)| depth_at(corners, place.across).is_some_and(before))
    }

    /// The corner nearest to the ray of the first triangle that it meets.
    fn at_ray(&self) -> Option<usize> {
        let met = self.triangles.iter().filter_map(|met| Some((depth_at(&met.1, [0.0; 2])?, met)));
        let (_, (corners, seen)) = met.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let nearest = (0..3).min_by(|&a, &b| seen[a].miss().total_cmp(&seen[b].miss()))?;
        Some(corners[nearest])
    }
}

/// Whether a triangle may have a place within the tube: its bounds do.
fn touches_tube(corners: [Seen; 3]) -> bool {
    (0..2).all(|axis| {
        let values = corners.map(|corner| corner.across[axis]);
        values.iter().any(|&value| value >= -1.0) && values.iter().any(|&value| value <= 1.0)
    })
}

/// How far along the ray a triangle is where it is seen at a place; `None` if it is not seen there.
fn depth_at(corners: &[Seen; 3], [x, y]: [f64; 2]) -> Option<f64> {
    let [a, b, c] = corners.map(|corner| [corner.across[0] - x, corner.across[1] - y]);
    let turn = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let areas = [turn(b, c), turn(c, a), turn(a, b)];
    let all = areas.iter().sum::<f64>();
    // Inside, all three areas have the sign of the whole.
    if all == 0.0 || !areas.iter().all(|area| area / all >= 0.0) {
        return None;
    }
    // Depth over radius, and one over radius, are linear across the tube.
    let sum = |value: fn(&Seen) -> f64| -> f64 {
        areas.iter().zip(corners).map(|(area, corner)| area * value(corner) / corner.radius).sum()
    };
    Some(sum(|corner| corner.depth) / sum(|_| 1.0))
}

#[cfg(test)]
mod tests {
    use sprung::build::{Lattice, Material, ModelBuilder, SpringKind};
    use sprung::scene::Scene;

    use super::*;

    /// A block of 3 × 3 × 3 points at the whole numbers from −1 to 1, with its skin.
    fn block() -> (Model, Vec<Vec3>) {
        let lattice = Lattice::new([3, 3, 3], 1.0);
        let mut builder = ModelBuilder::new();
        for place in lattice.positions() {
            builder.add_point((place - DVec3::ONE).as_vec3(), 1.0).expect("allowed");
        }
        for [i, j] in lattice.pairs(SpringKind::Structural) {
            let material = Material { stiffness: 1.0, damping: 0.0 };
            builder.add_spring(i as usize, j as usize, material).expect("allowed");
        }
        let (kind, triangles) = lattice.surface().expect("a block has a skin");
        builder.add_surface(kind, triangles).expect("allowed");
        let (model, _, state) = builder.build().expect("there are points");
        (model, state.position)
    }

    fn picked(origin: [f64; 3], direction: [f64; 3], radius: f64) -> Option<Picked> {
        let (model, positions) = block();
        let ray = Ray::new(origin, direction, radius, 0.0).expect("a ray");
        pick(&model, &vec![false; model.spring_count()], &positions, &ray)
    }

    #[test]
    fn the_nearest_point_is_met_and_not_the_one_behind_it() {
        let found = picked([0.02, 0.01, 10.0], [0.0, 0.0, -3.0], 0.1).expect("the middle of the front");
        assert_eq!(found.position, DVec3::new(0.0, 0.0, 1.0));
        assert!((found.distance - 9.0).abs() < 1e-12);
        // From behind, the other side.
        let found = picked([0.02, 0.01, -10.0], [0.0, 0.0, 1.0], 0.1).expect("the middle of the back");
        assert_eq!(found.position, DVec3::new(0.0, 0.0, -1.0));
        assert_eq!(picked([5.0, 5.0, 10.0], [0.0, 0.0, -1.0], 0.1), None);
        // Looking away.
        assert_eq!(picked([0.0, 0.0, 10.0], [0.0, 0.0, 1.0], 0.1), None);
    }

    #[test]
    fn far_from_points_a_spring_is_met_and_far_from_springs_a_corner_of_the_surface() {
        let found = picked([0.5, 0.01, 10.0], [0.0, 0.0, -1.0], 0.1).expect("between two points");
        assert!(matches!(found.target, Target::Spring(_)));
        assert!(found.position.distance(DVec3::new(0.5, 0.0, 1.0)) < 1e-12);
        let found = picked([0.4, 0.3, 10.0], [0.0, 0.0, -1.0], 0.05).expect("on the skin");
        assert_eq!(found.position, DVec3::new(0.0, 0.0, 1.0));
    }

    #[test]
    fn in_perspective_the_middle_of_a_segment_lies_beyond_the_middle_of_its_picture() {
        // From (1, 0, −1) to (−1, 0, −3), seen from the origin: the ray along −z crosses it at −2 in space.
        let ray = Ray::new([0.0; 3], [0.0, 0.0, -1.0], 0.0, 0.1).expect("a ray");
        let see = |place: Vec3| ray.see(place).expect("before it");
        let (seen, share) = nearest(see(Vec3::new(1.0, 0.0, -1.0)), see(Vec3::new(-1.0, 0.0, -3.0)));
        assert!((share - 0.5).abs() < 1e-12 && (seen.depth - 2.0).abs() < 1e-12 && seen.miss() < 1e-12);
    }

    /// Through every point of a real scene's front: what is met is never behind something else.
    #[test]
    fn inner_points_of_the_jelly_are_never_met() {
        let (model, params, state) =
            Scene::builtin("jelly").and_then(|scene| scene.build()).expect("built in");
        let outside: std::collections::BTreeSet<usize> =
            model.surfaces()[0].triangles.iter().flatten().map(|&corner| corner as usize).collect();
        let eye = [30.0, 20.0, 40.0];
        for point in (0..model.point_count()).step_by(7) {
            let direction = (state.position[point].as_dvec3() - DVec3::from_array(eye)).to_array();
            let ray = Ray::new(eye, direction, 0.0, 0.005).expect("a ray");
            let found =
                pick(&model, &params.spring_cut, &state.position, &ray).expect("it looks at the cube");
            let met = match found.target {
                Target::Point(point) => vec![point],
                Target::Spring(spring) => model.springs()[spring].map(|end| end as usize).to_vec(),
            };
            assert!(met.iter().all(|point| outside.contains(point)), "{point}: {found:?}");
        }
    }

    #[test]
    fn a_ray_without_a_direction_is_refused() {
        let error = Ray::new([0.0; 3], [0.0; 3], 0.1, 0.0).expect_err("no direction");
        assert_eq!(error.to_string(), "direction: is [0, 0, 0], and must be finite and not zero");
        assert!(Ray::new([f64::NAN, 0.0, 0.0], [1.0; 3], 0.1, 0.0).is_err());
        assert!(Ray::new([0.0; 3], [1.0; 3], -1.0, 0.0).is_err());
    }
}
