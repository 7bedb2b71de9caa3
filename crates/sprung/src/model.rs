//! The model: what is joined to what. Immutable once built, shared by every run that uses it.

use std::ops::Range;

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

/// Triangles over the points of one body, for drawing and export.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// The body, as an index into [`Model::bodies`].
    pub body: usize,
    /// Open sheet or closed skin.
    pub kind: SurfaceKind,
    /// Corner points of each triangle, as indices into the model's points.
    pub triangles: Vec<[u32; 3]>,
}

/// Topology: points, springs, bodies, surfaces. Made by [`ModelBuilder`](crate::ModelBuilder), never changed after.
///
/// What may change while a run goes on is in [`Params`](crate::Params); what a step changes is in
/// [`State`](crate::State).
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    pub(crate) point_count: usize,
    pub(crate) springs: Vec<[u32; 2]>,
    pub(crate) spring_rest_length: Vec<f32>,
    pub(crate) bodies: Vec<Body>,
    pub(crate) joints: Vec<Joint>,
    pub(crate) surfaces: Vec<Surface>,
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

    /// The body called `name`.
    pub fn body(&self, name: &str) -> Option<&Body> {
        self.bodies.iter().find(|body| body.name == name)
    }

    /// The name of the body or joint that a spring belongs to.
    pub fn spring_owner(&self, spring: usize) -> &str {
        let body = self.bodies.iter().find(|body| body.springs.contains(&spring)).map(|body| &body.name);
        let joint = self.joints.iter().find(|joint| joint.springs.contains(&spring)).map(|joint| &joint.name);
        body.or(joint).map_or("", |name| name)
    }
}
