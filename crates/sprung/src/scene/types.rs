//! What a scene file can say: one struct for each table, one field for each key.
//!
//! The doc comments are also the descriptions in the JSON Schema, so they give units and defaults.
//!
//! Keys that several tables have, such as `rest_scale`, `cut` and `except`, are written out in each. Serde's `flatten` would say them
//! once, but it takes a table to pieces before it looks at the values, and by then nobody knows the line that a wrong one stands
//! in; and of an unknown key it no longer tells which ones are allowed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::choices::{Dt, Numbers, OneOrEach, Pin, max_springs, substeps};
use super::mesh::{Cloth, Loaded, MeshFile, Net, Soft};
use super::source::Origin;
use crate::build::SpringKind;
use crate::contact::ContactLaw;

/// A scene of the mass-spring engine sprung. SI units throughout (m, kg, s, N); the up axis is +y.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// What the scene shows, in a few words. Default: none.
    #[serde(default)]
    pub title: String,
    /// What to look at, in a few sentences. Default: none.
    #[serde(default)]
    pub description: String,
    /// Length of one step, s; or "auto": the largest that is safely stable. Default: "auto".
    #[serde(default)]
    pub dt: Dt,
    /// Steps for each displayed frame. Default: 1.
    #[serde(default = "one_substep", deserialize_with = "substeps")]
    #[schemars(range(min = 1, max = 1_000_000))]
    pub substeps: u32,
    /// Gravitational acceleration, m/s². Default: [0, -9.81, 0].
    #[serde(default = "standard_gravity")]
    pub gravity: [f64; 3],
    /// How many springs the scene may have. Only a scene of over 20 million has to say it.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "max_springs")]
    #[schemars(range(min = 1))]
    pub max_springs: Option<u32>,
    /// Ground planes. Default: none.
    #[serde(default, rename = "plane", skip_serializing_if = "Vec::is_empty")]
    pub planes: Vec<Plane>,
    /// The bodies; at least one. Their points are numbered in the order of the file.
    #[serde(default, rename = "body", skip_serializing_if = "Vec::is_empty")]
    #[schemars(required, length(min = 1))]
    pub bodies: Vec<Body>,
    /// Springs that join bodies to each other. Default: none.
    #[serde(default, rename = "joint", skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<Joint>,
    /// Where the scene came from; errors quote it.
    #[serde(skip)]
    pub(super) origin: Origin,
}

/// A ground plane: points that sink into it are pushed back out. Say `y`, or `point` and `normal`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// Height of a level plane, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<f64>,
    /// A point of a sloping plane, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point: Option<[f64; 3]>,
    /// The direction out of the ground of a sloping plane; any length but zero.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub normal: Option<[f64; 3]>,
    /// Contact stiffness, N/m for each touching point.
    #[schemars(range(min = 0))]
    pub stiffness: f64,
    /// Contact damping, N·s/m for each touching point. Default: 0.
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub damping: f64,
    /// "push": the contact never pulls. "report": as the report writes it; near lift-off it can hold a point down.
    /// Default: "push".
    #[serde(default)]
    pub law: ContactLaw,
}

/// A named set of points and the springs among them. Its shape is one of `chain`, `grid`, `lattice`, `points` and `mesh`.
///
/// The shape is scaled, then rotated about the origin, then moved by `position`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// The body's name, unlike that of any other body.
    #[schemars(length(min = 1))]
    pub name: String,
    /// Shape: points in a row.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chain: Option<Chain>,
    /// Shape: a flat sheet of points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grid: Option<Grid>,
    /// Shape: a block of points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lattice: Option<Block>,
    /// Shape: every point by itself, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<Vec<[f64; 3]>>,
    /// Shape: a mesh file, which becomes one of `cloth`, `soft` and `net`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshFile>,
    /// The mesh becomes cloth of this material.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cloth: Option<Cloth>,
    /// The mesh becomes a soft body of this material.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub soft: Option<Soft>,
    /// The mesh becomes a net of such springs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub net: Option<Net>,
    /// Size, as a multiple of the shape's. Default: 1.
    #[serde(default = "unscaled")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub scale: f64,
    /// Rotation about the origin. Default: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation: Option<Rotation>,
    /// Where the shape's own origin comes to lie, m. Default: [0, 0, 0].
    #[serde(default)]
    pub position: [f64; 3],
    /// Mass of each point, kg: one number, or one for each point. Zero fixes a point in space.
    /// Say this or `body_mass`. Default: 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point_mass: Option<OneOrEach<f64>>,
    /// Mass of the whole body, kg, shared equally by its points.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub body_mass: Option<f64>,
    /// First velocity, m/s: one vector, or one for each point. Default: at rest.
    #[serde(default)]
    pub velocity: OneOrEach<[f64; 3]>,
    /// Points held in space. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pins: Vec<Pin>,
    /// The springs among the body's points, in groups. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub springs: Vec<Springs>,
    /// Constant forces on single points. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub forces: Vec<Force>,
    /// The mesh, once it has been read.
    #[serde(skip)]
    pub(super) loaded: Loaded,
}

/// Points in a row: the first at `origin`, each `step` from the one before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Chain {
    /// How many points.
    #[schemars(range(min = 1))]
    pub points: u32,
    /// From one point to the next, m.
    pub step: [f64; 3],
    /// The first point, m. Default: [0, 0, 0].
    #[serde(default)]
    pub origin: [f64; 3],
}

/// A flat sheet of points. Points along the plane's first axis are outermost in the numbering.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    /// How many points along the plane's first axis and along its second.
    pub points: [u32; 2],
    /// Distance of neighbours, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub spacing: f64,
    /// The two axes the sheet lies along: "xy" and "yz" stand upright, "xz" is level. Default: "xz".
    #[serde(default)]
    pub plane: GridPlane,
    /// The first point, m. Default: [0, 0, 0].
    #[serde(default)]
    pub origin: [f64; 3],
}

/// The two axes a sheet lies along.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum GridPlane {
    /// Upright, facing z.
    Xy,
    /// Level.
    #[default]
    Xz,
    /// Upright, facing x.
    Yz,
}

/// A block of points. Points along x are outermost in the numbering, points along z innermost.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// How many points along x, y and z.
    pub points: [u32; 3],
    /// Distance of neighbours, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub spacing: f64,
    /// The first point, m. Default: [0, 0, 0].
    #[serde(default)]
    pub origin: [f64; 3],
}

/// A rotation about the origin, by the right hand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// The axis; any length but zero.
    pub axis: [f64; 3],
    /// The angle, degrees.
    pub degrees: f64,
}

/// Springs within one body. Say which points they join by one of `radius`, `kinds` and `pairs`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Springs {
    /// Joins every two points no further apart than this, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub radius: Option<f64>,
    /// Joins neighbours in a chain, grid or lattice: "structural", "shear", "bend".
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kinds: Option<Vec<SpringKind>>,
    /// Joins these points, by their numbers in the body (from 0).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pairs: Option<Vec<[u32; 2]>>,
    /// Rest length of springs given by `pairs`, m. Default: each spring's length as built.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub rest_length: Option<f64>,
    /// Stiffness, N/m.
    #[schemars(range(min = 0))]
    pub stiffness: f64,
    /// Damping along the spring, N·s/m. Default: 0.
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub damping: f64,
    /// Rest length, as a multiple of what it would be otherwise: below 1 the springs start stretched. Default: 1.
    #[serde(default = "unscaled")]
    #[schemars(range(min = 0))]
    pub rest_scale: f64,
    /// Springs of this group that are cut, by their numbers in the group (from 0): a number, or [first, last].
    /// Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cut: Vec<Numbers>,
    /// Springs of this group that are unlike the others. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub except: Vec<Exception>,
}

/// Springs from one body to another. Say which points they join by `radius` or `pairs`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// The names of the two bodies.
    pub between: [String; 2],
    /// Joins every point of the first body to every point of the second no further away than this, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub radius: Option<f64>,
    /// Joins these points: the number of one in the first body, the number of one in the second.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pairs: Option<Vec<[u32; 2]>>,
    /// Rest length of springs given by `pairs`, m. Default: each spring's length as built.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub rest_length: Option<f64>,
    /// Stiffness, N/m.
    #[schemars(range(min = 0))]
    pub stiffness: f64,
    /// Damping along the spring, N·s/m. Default: 0.
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub damping: f64,
    /// Rest length, as a multiple of what it would be otherwise. Default: 1.
    #[serde(default = "unscaled")]
    #[schemars(range(min = 0))]
    pub rest_scale: f64,
    /// Springs of this group that are cut, by their numbers in the group (from 0): a number, or [first, last].
    /// Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cut: Vec<Numbers>,
    /// Springs of this group that are unlike the others. Default: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub except: Vec<Exception>,
}

/// Some springs of a group that are unlike the others. What is not said here they have from the group; where two entries
/// say the same thing of a spring, the later one holds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Exception {
    /// Which springs, by their numbers in the group (from 0): a number, or [first, last].
    #[schemars(length(min = 1))]
    pub springs: Vec<Numbers>,
    /// Stiffness, N/m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub stiffness: Option<f64>,
    /// Damping along the spring, N·s/m.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub damping: Option<f64>,
    /// Rest length, as a multiple of the length as built.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub rest_scale: Option<f64>,
    /// Rest length, m. Say this or `rest_scale`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0))]
    pub rest_length: Option<f64>,
}

/// A constant force on a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Force {
    /// The point's number in the body (from 0).
    pub point: u32,
    /// The force, N.
    pub force: [f64; 3],
}

fn one_substep() -> u32 {
    1
}

fn standard_gravity() -> [f64; 3] {
    [0.0, -9.81, 0.0]
}

pub(super) fn unscaled() -> f64 {
    1.0
}
