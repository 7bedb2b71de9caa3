//! The parameters: everything that may change while a simulation runs, each with its unit and its allowed range.

use std::collections::BTreeMap;
use std::ops::{Range, RangeInclusive};
use std::sync::Arc;

use glam::Vec3;

use crate::contact::Plane;
use crate::error::{Code, Error, Result};
use crate::model::Model;

/// Allowed step lengths, s.
pub const DT_RANGE: RangeInclusive<f64> = 1e-9..=1e3;
/// Allowed steps per frame.
pub const SUBSTEPS_RANGE: RangeInclusive<u32> = 1..=1_000_000;
/// Allowed masses of points that can move, kg; zero fixes a point in space.
pub const MASS_RANGE: RangeInclusive<f32> = 1e-12..=1e12;
/// Allowed stiffness, N/m.
pub const STIFFNESS_RANGE: RangeInclusive<f32> = 0.0..=1e12;
/// Allowed damping, N·s/m.
pub const DAMPING_RANGE: RangeInclusive<f32> = 0.0..=1e12;
/// Allowed size of a coordinate (m), speed (m/s), acceleration (m/s²) or force (N).
pub const MAGNITUDE_RANGE: RangeInclusive<f32> = -1e9..=1e9;
/// Allowed rest lengths, m.
pub const LENGTH_RANGE: RangeInclusive<f32> = 0.0..=1e9;

/// A pull on one point by a spring whose other end is held somewhere in space, such as a mouse cursor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grab {
    /// The point that is pulled.
    pub point: usize,
    /// Where the other end is held, m.
    pub target: Vec3,
    /// Stiffness of the pulling spring (rest length zero), N/m.
    pub stiffness: f32,
    /// Damping of the point's velocity while it is held, N·s/m.
    pub damping: f32,
}

/// All that may change while a simulation runs. Cheap to clone: the long arrays are shared until one side changes them.
///
/// Arrays over points have one entry per point of the [`Model`], arrays over springs one per spring.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Length of one step, s.
    pub dt: f64,
    /// Steps per displayed frame.
    pub substeps: u32,
    /// Gravitational acceleration, m/s².
    pub gravity: Vec3,
    /// Ground planes.
    pub planes: Vec<Plane>,
    /// Mass of each point, kg. Zero: fixed in space.
    pub point_mass: Arc<Vec<f32>>,
    /// Whether each point is pinned: fixed in space while this is true, whatever its mass.
    pub point_pinned: Arc<Vec<bool>>,
    /// Stiffness k_s of each spring, N/m.
    pub spring_stiffness: Arc<Vec<f32>>,
    /// Damping k_d along each spring, N·s/m.
    pub spring_damping: Arc<Vec<f32>>,
    /// Rest length L of each spring, m.
    pub spring_rest_length: Arc<Vec<f32>>,
    /// Whether each spring has been cut: it then exerts no force.
    pub spring_cut: Arc<Vec<bool>>,
    /// Constant forces on single points, N.
    pub external_forces: BTreeMap<usize, Vec3>,
    /// Pulls on single points.
    pub grabs: Vec<Grab>,
    /// Points that a hand carries along, and at which velocity, m/s: they move so whatever pulls at them.
    pub carried: BTreeMap<usize, Vec3>,
}

/// One change of the parameters, as the run log keeps it; [`Place`](Self::Place) alone changes the state instead.
///
/// Points and springs are given as ranges of indices: `7..8` is one of them, `body.points.clone()` a body's,
/// `0..model.spring_count()` all.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// Length of one step, s.
    Dt(f64),
    /// Steps per displayed frame.
    Substeps(u32),
    /// Gravitational acceleration, m/s².
    Gravity(Vec3),
    /// All ground planes.
    Planes(Vec<Plane>),
    /// Mass of some points, kg; zero fixes them.
    Mass(Range<usize>, f32),
    /// Pins (true) or frees (false) some points. A point that is pinned stops at once.
    Pin(Range<usize>, bool),
    /// Stiffness of some springs, N/m.
    Stiffness(Range<usize>, f32),
    /// Damping of some springs, N·s/m.
    Damping(Range<usize>, f32),
    /// Rest length of some springs, as a multiple of the length they were built with.
    RestScale(Range<usize>, f32),
    /// Cuts (true) or mends (false) some springs.
    Cut(Range<usize>, bool),
    /// A constant force on a point, N; zero takes it away.
    Force(usize, Vec3),
    /// Pulls a point; replaces an earlier grab of the same point.
    Grab(Grab),
    /// Lets a grabbed point go.
    Release(usize),
    /// Carries a point along at this velocity, m/s, whatever pulls at it and even if it is pinned; `None` lets it go: it
    /// keeps the velocity, or stops if it is pinned or has no mass.
    Carry(usize, Option<Vec3>),
    /// Puts a point there at once, m, and at rest, unless it is being carried.
    Place(usize, Vec3),
    /// All parameters at once: undo, redo, back to the scene's own values. Cheap, as the long arrays are shared.
    Params(Arc<Params>),
}

impl Params {
    /// 1/m of each point, 1/kg; zero for one that no force can move: see [`is_fixed`](Self::is_fixed).
    pub fn inverse_mass(&self, point: usize) -> f32 {
        if self.is_fixed(point) { 0.0 } else { 1.0 / self.point_mass[point] }
    }

    /// Whether no force can move a point: it has zero mass, is pinned, or is carried by a hand.
    pub fn is_fixed(&self, point: usize) -> bool {
        self.is_anchored(point) || self.carried.contains_key(&point)
    }

    /// Whether a point stays where it is as long as no hand carries it: it has zero mass or is pinned.
    pub fn is_anchored(&self, point: usize) -> bool {
        self.point_mass[point] == 0.0 || self.point_pinned[point]
    }

    /// Whether a spring can move anything: not cut, and not between two fixed points.
    pub fn is_live(&self, model: &Model, spring: usize) -> bool {
        let an_end_is_free = model.springs[spring].iter().any(|&point| !self.is_fixed(point as usize));
        an_end_is_free && !self.spring_cut[spring]
    }

    /// Whether masses and pins are the very arrays of `other`, and not merely equal ones.
    pub(crate) fn shares_masses_with(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.point_mass, &other.point_mass)
            && Arc::ptr_eq(&self.point_pinned, &other.point_pinned)
    }

    /// Whether the springs' laws and cuts are the very arrays of `other`.
    pub(crate) fn shares_springs_with(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.spring_stiffness, &other.spring_stiffness)
            && Arc::ptr_eq(&self.spring_damping, &other.spring_damping)
            && Arc::ptr_eq(&self.spring_rest_length, &other.spring_rest_length)
            && Arc::ptr_eq(&self.spring_cut, &other.spring_cut)
    }

    /// Whether all that the limit of every configuration depends on is that of `other`: the very same arrays, and equal planes,
    /// grabs and hands.
    pub(crate) fn shares_limits_with(&self, other: &Self) -> bool {
        let pull = |grab: &Grab| (grab.point, grab.stiffness, grab.damping);
        self.shares_masses_with(other)
            && Arc::ptr_eq(&self.spring_stiffness, &other.spring_stiffness)
            && Arc::ptr_eq(&self.spring_damping, &other.spring_damping)
            && Arc::ptr_eq(&self.spring_cut, &other.spring_cut)
            && self.planes == other.planes
            && self.grabs.iter().map(pull).eq(other.grabs.iter().map(pull))
            && self.carried.keys().eq(other.carried.keys())
    }

    /// Memory of what is not shared with `other`, bytes: long arrays, and forces and hands, which never are.
    pub(crate) fn bytes_apart_from(&self, other: &Self) -> usize {
        fn bytes<T>(mine: &Arc<Vec<T>>, theirs: &Arc<Vec<T>>) -> usize {
            if Arc::ptr_eq(mine, theirs) { 0 } else { size_of::<T>() * mine.len() }
        }
        bytes(&self.point_mass, &other.point_mass)
            + bytes(&self.point_pinned, &other.point_pinned)
            + bytes(&self.spring_stiffness, &other.spring_stiffness)
            + bytes(&self.spring_damping, &other.spring_damping)
            + bytes(&self.spring_rest_length, &other.spring_rest_length)
            + bytes(&self.spring_cut, &other.spring_cut)
            + 2 * size_of::<(usize, Vec3)>() * (self.external_forces.len() + self.carried.len())
    }

    /// Checks every value against its range and every array against the model.
    ///
    /// # Errors
    /// [`Code::OutOfRange`] or [`Code::Conflict`], naming the field.
    pub fn validate(&self, model: &Model) -> Result<()> {
        check_in("dt", self.dt, &DT_RANGE)?;
        check_in("substeps", self.substeps, &SUBSTEPS_RANGE)?;
        check_vector("gravity", self.gravity)?;
        for (index, plane) in self.planes.iter().enumerate() {
            plane.validate().map_err(|error| error.at_field(format!("plane[{index}]")))?;
        }
        let (points, springs) = (model.point_count(), model.spring_count());
        check_len("point_mass", self.point_mass.len(), points)?;
        check_len("point_pinned", self.point_pinned.len(), points)?;
        check_len("spring_stiffness", self.spring_stiffness.len(), springs)?;
        check_len("spring_damping", self.spring_damping.len(), springs)?;
        check_len("spring_rest_length", self.spring_rest_length.len(), springs)?;
        check_len("spring_cut", self.spring_cut.len(), springs)?;
        check_all("point_mass", &self.point_mass, &MASS_RANGE, check_mass)?;
        for (field, values, range) in [
            ("spring_stiffness", &self.spring_stiffness, &STIFFNESS_RANGE),
            ("spring_damping", &self.spring_damping, &DAMPING_RANGE),
            ("spring_rest_length", &self.spring_rest_length, &LENGTH_RANGE),
        ] {
            check_all(field, values, range, |value| check_in("", value, range))?;
        }
        for (&point, &force) in &self.external_forces {
            check_index("external_forces", point, points)?;
            check_vector("external_forces", force)?;
        }
        for (&point, &velocity) in &self.carried {
            check_index("carried", point, points)?;
            check_vector("carried", velocity)?;
        }
        self.grabs.iter().try_for_each(|grab| check_grab(grab, points))
    }

    /// Makes one change, or none at all if it is not allowed.
    ///
    /// # Errors
    /// [`Code::OutOfRange`] for a value or index out of range.
    pub fn apply(&mut self, model: &Model, change: &Change) -> Result<()> {
        let (points, springs) = (model.point_count(), model.spring_count());
        match change {
            Change::Dt(dt) => {
                check_in("dt", *dt, &DT_RANGE)?;
                self.dt = *dt;
            }
            Change::Substeps(substeps) => {
                check_in("substeps", *substeps, &SUBSTEPS_RANGE)?;
                self.substeps = *substeps;
            }
            Change::Gravity(gravity) => {
                check_vector("gravity", *gravity)?;
                self.gravity = *gravity;
            }
            Change::Planes(planes) => {
                planes.iter().try_for_each(Plane::validate)?;
                self.planes = planes.clone();
            }
            Change::Mass(range, mass) => {
                check_mass(*mass).map_err(|error| error.at_field("mass"))?;
                fill("mass", &mut self.point_mass, range, points, *mass)?;
            }
            Change::Pin(range, pinned) => fill("pin", &mut self.point_pinned, range, points, *pinned)?,
            Change::Stiffness(range, stiffness) => {
                check_in("stiffness", *stiffness, &STIFFNESS_RANGE)?;
                fill("stiffness", &mut self.spring_stiffness, range, springs, *stiffness)?;
            }
            Change::Damping(range, damping) => {
                check_in("damping", *damping, &DAMPING_RANGE)?;
                fill("damping", &mut self.spring_damping, range, springs, *damping)?;
            }
            Change::RestScale(range, scale) => {
                check_in("rest_scale", *scale, &LENGTH_RANGE)?;
                check_range("rest_scale", range, springs)?;
                for &length in &model.spring_rest_length[range.clone()] {
                    check_in("rest_scale", length * scale, &LENGTH_RANGE)?;
                }
                let lengths = Arc::make_mut(&mut self.spring_rest_length);
                for spring in range.clone() {
                    lengths[spring] = model.spring_rest_length[spring] * scale;
                }
            }
            Change::Cut(range, cut) => fill("cut", &mut self.spring_cut, range, springs, *cut)?,
            Change::Force(point, force) => {
                check_index("force", *point, points)?;
                check_vector("force", *force)?;
                if *force == Vec3::ZERO {
                    self.external_forces.remove(point);
                } else {
                    self.external_forces.insert(*point, *force);
                }
            }
            Change::Grab(grab) => {
                check_grab(grab, points)?;
                self.grabs.retain(|other| other.point != grab.point);
                self.grabs.push(*grab);
            }
            Change::Release(point) => {
                check_index("release", *point, points)?;
                self.grabs.retain(|grab| grab.point != *point);
            }
            Change::Carry(point, velocity) => {
                check_index("carry", *point, points)?;
                check_vector("carry", velocity.unwrap_or_default())?;
                match velocity {
                    Some(velocity) => self.carried.insert(*point, *velocity),
                    None => self.carried.remove(point),
                };
            }
            // Where a point is belongs to the state, which `Simulation` changes.
            Change::Place(point, position) => {
                check_index("place", *point, points)?;
                check_vector("place", *position)?;
            }
            Change::Params(params) => {
                params.validate(model)?;
                self.clone_from(params);
            }
        }
        Ok(())
    }
}

fn check_grab(grab: &Grab, points: usize) -> Result<()> {
    check_index("grab", grab.point, points)?;
    check_vector("grab", grab.target)?;
    check_in("grab", grab.stiffness, &STIFFNESS_RANGE)?;
    check_in("grab", grab.damping, &DAMPING_RANGE)
}

/// A mass is zero (fixed) or within [`MASS_RANGE`].
pub(crate) fn check_mass(mass: f32) -> Result<()> {
    if mass == 0.0 || MASS_RANGE.contains(&mass) {
        return Ok(());
    }
    let (low, high) = (MASS_RANGE.start(), MASS_RANGE.end());
    let sentence = format!("is {mass}, and must be 0 kg (fixed) or from {low:e} to {high:e} kg");
    Err(Error::new(Code::OutOfRange, sentence))
}

/// A value within a range; false for a NaN.
pub(crate) fn check_in<T>(field: &str, value: T, range: &RangeInclusive<T>) -> Result<()>
where
    T: PartialOrd + std::fmt::Display + std::fmt::LowerExp + Copy,
{
    if range.contains(&value) {
        return Ok(());
    }
    let (low, high) = (*range.start(), *range.end());
    let error = Error::new(Code::OutOfRange, format!("is {value}, and must be from {low:e} to {high:e}"));
    Err(if field.is_empty() { error } else { error.at_field(field) })
}

/// A vector of finite numbers of sensible size.
pub(crate) fn check_vector(field: &str, vector: Vec3) -> Result<()> {
    vector.to_array().iter().try_for_each(|&value| check_in(field, value, &MAGNITUDE_RANGE))
}

/// As [`check_vector`] for each, with its number.
pub(crate) fn check_vectors(field: &str, vectors: &[Vec3]) -> Result<()> {
    // All at once first, in vector code: that one of them is bad is rare.
    let numbers: &[f32] = bytemuck::cast_slice(vectors);
    if numbers.iter().fold(true, |good, number| good & MAGNITUDE_RANGE.contains(number)) {
        return Ok(());
    }
    vectors.iter().enumerate().try_for_each(|(index, &vector)| {
        check_vector("", vector).map_err(|error| error.at_field(format!("{field}[{index}]")))
    })
}

fn check_len(field: &str, found: usize, expected: usize) -> Result<()> {
    if found == expected {
        return Ok(());
    }
    let sentence = format!("has {found} entries, and the model needs {expected}");
    Err(Error::new(Code::Conflict, sentence).at_field(field))
}

fn check_index(field: &str, index: usize, count: usize) -> Result<()> {
    check_range(field, &(index..index.saturating_add(1)), count)
}

fn check_range(field: &str, range: &Range<usize>, count: usize) -> Result<()> {
    if range.start <= range.end && range.end <= count {
        return Ok(());
    }
    let sentence =
        format!("names indices {} to {}, and there are {count}", range.start, range.end.saturating_sub(1));
    Err(Error::new(Code::OutOfRange, sentence).at_field(field))
}

/// Every value is allowed by `check`, which allows all values of `usual`.
fn check_all(
    field: &str,
    values: &[f32],
    usual: &RangeInclusive<f32>,
    check: impl Fn(f32) -> Result<()>,
) -> Result<()> {
    // All at once first, in vector code: that one of them is unusual is rare.
    if values.iter().fold(true, |good, value| good & usual.contains(value)) {
        return Ok(());
    }
    values.iter().enumerate().try_for_each(|(index, &value)| {
        check(value).map_err(|error| error.at_field(format!("{field}[{index}]")))
    })
}

fn fill<T: Clone>(
    field: &str,
    values: &mut Arc<Vec<T>>,
    range: &Range<usize>,
    count: usize,
    value: T,
) -> Result<()> {
    check_range(field, range, count)?;
    Arc::make_mut(values)[range.clone()].fill(value);
    Ok(())
}
