//! The ground plane, and the two laws by which it pushes.

use glam::{DVec3, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Code, Error, Result};
use crate::math::dot;
use crate::params::{DAMPING_RANGE, STIFFNESS_RANGE, check_in, check_vector};

/// How far the length of a normal may be from 1.
const UNIT_TOLERANCE: f32 = 1e-5;

/// How a touched plane answers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ContactLaw {
    /// Spring and damper, k_c·p − k_c,d·v_n, but never a pull: negative forces become zero.
    #[default]
    Push,
    /// Spring and damper as the report writes them: k_c·p − k_c,d·v_n. Near lift-off the damper can hold the point down.
    Report,
}

/// A ground plane: points below it are pushed back along its normal.
///
/// With depth p = (point − x)·n and normal speed v_n = v·n, a point with p > 0 feels f = (k_c·p − k_c,d·v_n)·n.
/// Nothing happens at p = 0 or above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Any point of the plane, m.
    pub point: Vec3,
    /// Unit normal, pointing out of the ground.
    pub normal: Vec3,
    /// Contact stiffness k_c, N/m for each touching point.
    pub stiffness: f32,
    /// Contact damping k_c,d, N·s/m for each touching point.
    pub damping: f32,
    /// Whether the contact may pull.
    pub law: ContactLaw,
}

impl Plane {
    /// A level plane at height `y` (m) that never pulls.
    pub fn level(y: f32, stiffness: f32, damping: f32) -> Self {
        let point = Vec3::new(0.0, y, 0.0);
        Self { point, normal: Vec3::Y, stiffness, damping, law: ContactLaw::default() }
    }

    /// A plane out of whose ground `normal` points, of any length but zero.
    ///
    /// # Errors
    /// [`Code::OutOfRange`], naming the field.
    pub fn new(point: Vec3, normal: DVec3, stiffness: f32, damping: f32, law: ContactLaw) -> Result<Self> {
        if !(normal.is_finite() && normal != DVec3::ZERO) {
            let sentence = format!("is {normal}, and must be finite and not zero");
            return Err(Error::new(Code::OutOfRange, sentence).at_field("normal"));
        }
        let plane = Self { point, normal: unit(normal), stiffness, damping, law };
        plane.validate()?;
        Ok(plane)
    }

    /// Checks ranges and that the normal has unit length.
    ///
    /// # Errors
    /// [`Code::OutOfRange`], naming the field.
    pub fn validate(&self) -> Result<()> {
        check_vector("point", self.point)?;
        check_vector("normal", self.normal)?;
        check_in("stiffness", self.stiffness, &STIFFNESS_RANGE)?;
        check_in("damping", self.damping, &DAMPING_RANGE)?;
        let length = self.normal.length();
        if (length - 1.0).abs() > UNIT_TOLERANCE {
            let sentence = format!("has length {length}, and must have length 1");
            return Err(Error::new(Code::OutOfRange, sentence).at_field("normal"));
        }
        Ok(())
    }

    /// How deep a position lies below the plane, m; negative above it.
    #[inline(always)]
    pub fn depth(&self, position: Vec3) -> f32 {
        dot(self.point - position, self.normal)
    }

    /// Depth in float64, for the ledger.
    pub(crate) fn depth64(&self, position: DVec3) -> f64 {
        (self.point.as_dvec3() - position).dot(self.normal.as_dvec3())
    }

    /// The stored energy ½k_c·p² of a touching point, J.
    pub(crate) fn potential(&self, position: DVec3) -> f64 {
        let depth = self.depth64(position).max(0.0);
        0.5 * f64::from(self.stiffness) * depth * depth
    }

    /// The two parts of the force in float64: the spring's, and all the rest, which only takes energy out.
    pub(crate) fn force_parts(&self, position: DVec3, velocity: DVec3) -> (DVec3, DVec3) {
        let depth = self.depth64(position);
        if depth <= 0.0 {
            return (DVec3::ZERO, DVec3::ZERO);
        }
        let normal = self.normal.as_dvec3();
        let spring = f64::from(self.stiffness) * depth;
        let push = spring - f64::from(self.damping) * velocity.dot(normal);
        let total = if self.law == ContactLaw::Push { push.max(0.0) } else { push };
        (normal * spring, normal * (total - spring))
    }
}

/// A direction of length 1. One that has it already is taken as it is, so that what was saved comes back to the bit.
pub(crate) fn unit(direction: DVec3) -> Vec3 {
    let written = direction.as_vec3();
    if (written.length() - 1.0).abs() <= UNIT_TOLERANCE {
        return written;
    }
    // One that is so long or short that its square would overflow or vanish is brought to a sensible length first.
    let largest = direction.abs().max_element();
    let sensible = if (1e-100..1e100).contains(&largest) { direction } else { direction / largest };
    sensible.normalize().as_vec3()
}
