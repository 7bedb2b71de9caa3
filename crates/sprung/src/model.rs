//! The model: what is joined to what. Immutable once built, shared by every run that uses it.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use glam::Vec3;

use crate::buckets::Buckets;
use crate::state::Fnv;

/// A named part of a model: a range of its points, and of the springs among them.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// The body's name, unique within the model.
    pub name: String,
    /// Its points, as indices into the model's.
    pub points: Range<usize>,
    /// The springs that were added with it, as indices into the model's.
    pub springs: Range<usize>,
}

/// A named set of springs that join bodies to each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// The joint's name, such as `"left post - deck"`.
    pub name: String,
    /// Its springs, as indices into the model's.
    pub springs: Range<usize>,
}

/// What a surface is the surface of, which decides how it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceKind {
    /// An open sheet, seen from both sides.
    Cloth,
    /// The closed skin of a solid, whose triangles turn counter-clockwise seen from outside.
    Skin,
}

/// Triangles of one body, for drawing and export.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// The body, as an index into [`Model::bodies`].
    pub body: usize,
    /// Open sheet or closed skin.
    pub kind: SurfaceKind,
    /// Where its vertices are.
    pub vertices: SurfaceVertices,
    /// Corners of each triangle: indices into the model's points, or into the list of weighted vertices.
    pub triangles: Vec<[u32; 3]>,
    /// How many triangles each face of an artist's mesh is, in order: they are a fan around its first corner. Empty where
    /// every triangle is a face of its own.
    pub fans: Vec<u32>,
    /// Whether it is what is meant to be seen of its body, as the artist's mesh is of cloth or of a soft body made from it.
    /// Points and springs are then drawn where somebody asks for them.
    pub stands_for_body: bool,
}

/// What the corners of a surface's triangles are.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceVertices {
    /// Points of the model.
    Points,
    /// The vertices of an artist's mesh, in the mesh's order, carried along by the points.
    Weighted(Vec<WeightedVertex>),
}

/// A vertex that up to four points carry along: the sum of their positions, each times its weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeightedVertex {
    /// Indices into the model's points. Points that are not needed have weight 0.
    pub points: [u32; 4],
    /// Their weights, which add up to 1.
    pub weights: [f32; 4],
}

impl WeightedVertex {
    /// One that lies on a point.
    pub fn on(point: u32) -> Self {
        Self { points: [point; 4], weights: [1.0, 0.0, 0.0, 0.0] }
    }

    /// The sum over any values that the points have: positions (m) or velocities (m/s), in the model's order.
    ///
    /// As the weights add up to 1, differences from the first point will do: what rounding leaves of them does not grow
    /// with the distance from the origin, and a vertex that lies on a point is there to the bit.
    ///
    /// # Panics
    /// If there are fewer values than points.
    pub fn of(&self, values: &[Vec3]) -> Vec3 {
        let first = values[self.points[0] as usize];
        let moved = |k: usize| (values[self.points[k] as usize] - first) * self.weights[k];
        first + (moved(1) + moved(2) + moved(3))
    }
}

impl Surface {
    /// The weighted vertices; none if the triangles stand on points.
    pub fn weighted(&self) -> &[WeightedVertex] {
        match &self.vertices {
            SurfaceVertices::Points => &[],
            SurfaceVertices::Weighted(vertices) => vertices,
        }
    }
}

/// Topology: points, springs, bodies, surfaces. Made by [`ModelBuilder`](crate::ModelBuilder), never changed after.
///
/// What may change while a run goes on is in [`Params`](crate::Params); what a step changes is in
/// [`State`](crate::State).
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    pub(crate) point_count: usize,
    pub(crate) springs: Vec<[u32; 2]>,
    /// Shared with the parameters until they change it.
    pub(crate) spring_rest_length: Arc<Vec<f32>>,
    pub(crate) bodies: Vec<Body>,
    pub(crate) joints: Vec<Joint>,
    pub(crate) surfaces: Vec<Surface>,
    pub(crate) springs_at: SpringsAt,
    pub(crate) hidden_order: HiddenOrder,
}

impl Model {
    /// How many points there are.
    pub fn point_count(&self) -> usize {
        self.point_count
    }

    /// How many springs there are.
    pub fn spring_count(&self) -> usize {
        self.springs.len()
    }

    /// The two points of each spring, the smaller index first.
    pub fn springs(&self) -> &[[u32; 2]] {
        &self.springs
    }

    /// Rest length of each spring as it was built, m. [`Params::spring_rest_length`](crate::Params) starts from it.
    pub fn spring_rest_length(&self) -> &[f32] {
        &self.spring_rest_length
    }

    /// A fingerprint of the points, springs, rest lengths, bodies and joints: whether what was stored belongs to this model.
    ///
    /// 64-bit FNV-1a over little-endian bytes: the count of points (u64), both ends of every spring (u32), every rest length
    /// (float32), and of every body and joint the name, a zero byte, and where its points (a body's) and springs end (u64).
    pub fn fingerprint(&self) -> u64 {
        let mut hash = Fnv::new();
        hash.write(&(self.point_count as u64).to_le_bytes());
        self.springs.iter().flatten().for_each(|end| hash.write(&end.to_le_bytes()));
        self.spring_rest_length.iter().for_each(|length| hash.write(&length.to_le_bytes()));
        let mut name = |name: &str, ends: &[usize]| {
            hash.write(name.as_bytes());
            hash.write(&[0]);
            ends.iter().for_each(|&end| hash.write(&(end as u64).to_le_bytes()));
        };
        self.bodies.iter().for_each(|body| name(&body.name, &[body.points.end, body.springs.end]));
        self.joints.iter().for_each(|joint| name(&joint.name, &[joint.springs.end]));
        hash.0
    }

    /// The springs that end at a point, in ascending order; none if there is no such point.
    ///
    /// The table behind it is made when it is first asked for: 8 bytes per spring and per point.
    pub fn springs_at(&self, point: usize) -> &[u32] {
        let table = self.springs_at.0.get_or_init(|| {
            let both = |(spring, ends): (usize, &[u32; 2])| ends.map(|end| (end as usize, spring as u32));
            Buckets::new(self.point_count, self.springs.iter().enumerate().flat_map(both))
        });
        if point < self.point_count { table.of(point) } else { &[] }
    }

    /// The named bodies; together they hold every point, in order.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// The sets of springs that join bodies.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// The surfaces of those bodies that have one.
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// How many weighted vertices all surfaces have together.
    pub fn weighted_count(&self) -> usize {
        self.surfaces.iter().map(|surface| surface.weighted().len()).sum()
    }

    /// The values of all points (positions, velocities), and after them those of all weighted vertices, surface by surface:
    /// for a renderer that wants one list. [`triangles_in_list`](Self::triangles_in_list) are the triangles over it.
    pub fn with_weighted<'a>(&self, values: &'a [Vec3]) -> Cow<'a, [Vec3]> {
        let count = self.weighted_count();
        if count == 0 || values.len() != self.point_count {
            return Cow::Borrowed(values);
        }
        let mut all = Vec::with_capacity(values.len() + count);
        all.extend_from_slice(values);
        let vertices = self.surfaces.iter().flat_map(Surface::weighted);
        all.extend(vertices.map(|vertex| vertex.of(values)));
        Cow::Owned(all)
    }

    /// The triangles of a surface, by its index, as indices into the list that [`with_weighted`](Self::with_weighted) makes.
    pub fn triangles_in_list(&self, surface: usize) -> Cow<'_, [[u32; 3]]> {
        let Some(chosen) = self.surfaces.get(surface) else { return Cow::Borrowed(&[]) };
        if matches!(chosen.vertices, SurfaceVertices::Points) {
            return Cow::Borrowed(&chosen.triangles);
        }
        let before = self.surfaces[..surface].iter().map(|surface| surface.weighted().len()).sum::<usize>();
        let first = (self.point_count + before) as u32;
        Cow::Owned(chosen.triangles.iter().map(|corners| corners.map(|corner| first + corner)).collect())
    }

    /// Whether a body has a surface that is what is meant to be seen of it: see [`Surface::stands_for_body`].
    pub fn is_seen_by_surface(&self, body: usize) -> bool {
        self.surfaces.iter().any(|surface| surface.body == body && surface.stands_for_body)
    }

    /// The body called `name`.
    pub fn body(&self, name: &str) -> Option<&Body> {
        self.bodies.iter().find(|body| body.name == name)
    }

    /// What a point is called in messages: by its number within its body, "point 3 of jelly".
    pub fn point_name(&self, point: usize) -> String {
        match self.body_of(point) {
            Some(body) => format!("point {} of {}", point - body.points.start, body.name),
            None => format!("point {point}"),
        }
    }

    /// What a spring is called in messages: by numbers within its body, "spring 12 of jelly (points 3 and 4)"; in a joint,
    /// "spring 0 of post - deck (point 3 of post and point 0 of deck)".
    pub fn spring_name(&self, spring: usize) -> String {
        let Some(&[i, j]) = self.springs.get(spring) else { return format!("spring {spring}") };
        let (i, j) = (i as usize, j as usize);
        if let Some(body) = self.bodies.iter().find(|body| body.springs.contains(&spring)) {
            let (spring, first) = (spring - body.springs.start, body.points.start);
            // Springs built without a scene may belong to one body and end at another.
            if body.points.contains(&i) && body.points.contains(&j) {
                return format!("spring {spring} of {} (points {} and {})", body.name, i - first, j - first);
            }
            return format!(
                "spring {spring} of {} ({} and {})",
                body.name,
                self.point_name(i),
                self.point_name(j)
            );
        }
        let joint = self.joints.iter().find(|joint| joint.springs.contains(&spring));
        let (number, owner) =
            joint.map_or((spring, ""), |joint| (spring - joint.springs.start, joint.name.as_str()));
        format!("spring {number} of {owner} ({} and {})", self.point_name(i), self.point_name(j))
    }

    /// Where a point is in the hidden order, in which a step goes through the points.
    #[inline(always)]
    pub(crate) fn place_of(&self, point: usize) -> usize {
        self.hidden_order.place_of.get(point).map_or(point, |&place| place as usize)
    }

    /// The point at a place of the hidden order.
    #[inline(always)]
    pub(crate) fn point_at(&self, place: usize) -> usize {
        self.hidden_order.point_at.get(place).map_or(place, |&point| point as usize)
    }

    /// The places of a spring's ends in the hidden order, the smaller one first.
    #[inline(always)]
    pub(crate) fn places(&self, spring: u32) -> [u32; 2] {
        let [a, b] = self.springs[spring as usize].map(|point| self.place_of(point as usize) as u32);
        [a.min(b), a.max(b)]
    }

    fn body_of(&self, point: usize) -> Option<&Body> {
        self.bodies.iter().find(|body| body.points.contains(&point))
    }

    /// The name of the body or joint that a spring belongs to.
    pub fn spring_owner(&self, spring: usize) -> &str {
        let body = self.bodies.iter().find(|body| body.springs.contains(&spring)).map(|body| &body.name);
        let joint = self.joints.iter().find(|joint| joint.springs.contains(&spring)).map(|joint| &joint.name);
        body.or(joint).map_or("", |name| name)
    }
}

/// The order in which a step goes through the points, chosen when the model is built so that points that are joined lie
/// near each other. Both lists are empty where it is the user's own.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct HiddenOrder {
    place_of: Vec<u32>,
    point_at: Vec<u32>,
}

impl HiddenOrder {
    /// From the list of points by place; `None` is the user's own order.
    pub fn new(point_at: Option<Vec<u32>>) -> Self {
        let point_at = point_at.unwrap_or_default();
        let mut place_of = vec![0; point_at.len()];
        for (place, &point) in point_at.iter().enumerate() {
            place_of[point as usize] = place as u32;
        }
        Self { place_of, point_at }
    }
}

/// A table that follows from the rest of the model: two models are equal whether or not they have made it yet.
#[derive(Clone, Debug, Default)]
pub(crate) struct SpringsAt(OnceLock<Buckets<u32>>);

impl PartialEq for SpringsAt {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
