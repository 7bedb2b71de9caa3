//! The few vector operations of the step, written out so that the order of every operation is fixed.

use glam::{DMat3, DVec3, Vec3};

/// Squared length below which two points count as coincident, m²: there a spring has no axis.
/// Above it no square in a length is a denormal number.
pub(crate) const COINCIDENT_SQUARED: f32 = 1e-30;

/// Coordinates smaller than this are taken as zero, m: no denormal number ever enters a step.
const NEGLIGIBLE: f32 = 1e-30;

/// A position without coordinates that are too small to matter.
pub(crate) fn without_negligible(position: Vec3) -> Vec3 {
    Vec3::from_array(position.to_array().map(|value| if value.abs() < NEGLIGIBLE { 0.0 } else { value }))
}

/// A vector without denormal components, which hosts treat differently.
pub(crate) fn without_subnormals(vector: Vec3) -> Vec3 {
    Vec3::from_array(vector.to_array().map(|value| if value.is_subnormal() { 0.0 } else { value }))
}

/// a.x·b.x + a.y·b.y + a.z·b.z, summed from left to right.
#[inline(always)]
pub(crate) fn dot(a: Vec3, b: Vec3) -> f32 {
    a.x * b.x + a.y * b.y + a.z * b.z
}

/// The Euclidean distance exactly as the step computes it, so that a spring made at rest has no force at all.
#[inline(always)]
pub(crate) fn distance(a: Vec3, b: Vec3) -> f32 {
    let e = a - b;
    dot(e, e).sqrt()
}

/// The rotation by `degrees` about `axis` (any length but zero), by Rodrigues' formula.
/// `libm` rather than the system's sine: the same bits everywhere.
pub(crate) fn rotation(axis: DVec3, degrees: f64) -> DMat3 {
    let u = axis / axis.length();
    let (sin, cos) = libm::sincos(degrees.to_radians());
    let cross =
        DMat3::from_cols(DVec3::new(0.0, u.z, -u.y), DVec3::new(-u.z, 0.0, u.x), DVec3::new(u.y, -u.x, 0.0));
    let outer = DMat3::from_cols(u * u.x, u * u.y, u * u.z);
    DMat3::IDENTITY * cos + cross * sin + outer * (1.0 - cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotation_keeps_the_axis_and_turns_by_the_right_hand() {
        let axis = DVec3::new(1.0, 1.0, 1.0);
        let r = rotation(axis, 120.0);
        assert!((r * axis - axis).length() < 1e-15);
        assert!((r * DVec3::X - DVec3::Y).length() < 1e-15);
    }
}
