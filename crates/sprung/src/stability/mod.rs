//! How large may dt be? Three answers, from cheap and safe to exact.
//!
//! Around a configuration x a network moves as M ẍ = −K x − C ẋ: M the masses, K the stiffness (the Hessian of the
//! energy), C the damping. The semi-implicit Euler step
//!
//! ```text
//! v⁺ = v − dt·M⁻¹(K x + C v)        x⁺ = x + dt·v⁺
//! ```
//!
//! taken in one mode of squared frequency ω² and damping c per mass, is the linear map
//!
//! ```text
//! ( x⁺ )   ( 1 − dt²ω²   dt(1 − dt·c) ) ( x )        determinant  1 − dt·c
//! ( v⁺ ) = (  −dt·ω²      1 − dt·c    ) ( v )        trace        2 − dt²ω² − dt·c
//! ```
//!
//! Both its eigenvalues lie inside the unit circle exactly when |trace| < 1 + determinant < 2 (Jury's criterion), that
//! is when
//!
//! ```text
//! dt²ω² + 2 dt·c < 4        or        dt < 4 / (c + √(c² + 4ω²))
//! ```
//!
//! For all modes together, K and C commuting or not: dt²K + 2dt·C ≺ 4M. The left side, per mass, is here called the
//! *demand* of dt; the limit is where the largest demand is 4.
//!
//! | function | answer | cost |
//! |---|---|---|
//! | [`every_configuration`] | a safe dt for ever, whatever shape the network takes | one pass over the springs |
//! | [`certified`] | a safe dt in this configuration, 52 to 100 % of the true limit in networks like the four scenes | one pass |
//! | [`sharp`] | the true limit in this configuration, to 0.1 % or better | tens to hundreds of passes |
//!
//! A running simulation finds the first two more cheaply: [`Simulation::certified_limit`](crate::Simulation::certified_limit)
//! in the layout of the step, a little on the safe side, and
//! [`limit_of_every_configuration`](crate::Simulation::limit_of_every_configuration) once for the same parameters.
//!
//! All three use only + − × ÷ √ in a fixed order: a dt chosen from them has the same bits on every machine.

mod certified;
mod network;
mod sharp;
mod symmetric3;
mod top_mode;

pub(crate) use certified::damping_scale;
#[cfg(test)]
pub(crate) use certified::limit_of_springs_at;
pub use certified::{certified, every_configuration};
pub use sharp::{Sharp, sharp};

use crate::error::{Code, Error, Result};
use crate::model::Model;
use crate::params::{DT_RANGE, Params};
use crate::text::significant;

/// A step length that is safe, and what keeps it from being larger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// The limit, s: a step must be shorter.
    pub dt: f64,
    /// What sets it.
    pub setter: Setter,
}

/// What sets a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setter {
    /// The spring of this index, with all that pulls at its two ends.
    Spring(usize),
    /// The contact with the planes and the grabs of the point of this index.
    Point(usize),
}

/// The longest step that `"auto"` chooses, s. Accuracy, not stability, caps it: semi-implicit Euler's error grows with
/// dt, and 0.01 s is the step of all four scenes of the report. Larger: soft scenes look sluggish and skip contacts.
const AUTO_DT_MAX: f64 = 0.01;

/// The part of the every-configuration limit that `"auto"` takes, 5 % below it. The limit itself is safe in real
/// numbers; the margin is for the rounding of a float32 step, and for a mode at its very limit, which rings undamped.
const AUTO_DT_FRACTION: f64 = 0.95;

/// The dt that `"auto"` stands for, s: 95 % of [`every_configuration`], and never more than 0.01 s.
///
/// The every-configuration limit, not the sharp one: it holds whatever happens later, costs one pass over the springs,
/// and does not depend on an iteration.
///
/// ```
/// use sprung::{Material, ModelBuilder, Vec3, stability};
///
/// let mut builder = ModelBuilder::new();
/// let hook = builder.add_point(Vec3::ZERO, 0.0)?;
/// let bob = builder.add_point(Vec3::new(0.0, -1.0, 0.0), 1.0)?;
/// builder.add_spring(hook, bob, Material { stiffness: 1.0e6, damping: 0.0 })?;
/// let (model, params, _) = builder.build()?;
/// // ω = √(k/m) = 1000 1/s, so the limit is 2/ω = 2 ms.
/// assert!((stability::auto_dt(&model, &params)? - 0.95 * 0.002).abs() < 1e-9);
/// # Ok::<(), sprung::Error>(())
/// ```
///
/// # Errors
/// [`Code::OutOfRange`] where that is less than the smallest step allowed, 10⁻⁹ s.
pub fn auto_dt(model: &Model, params: &Params) -> Result<f64> {
    let limit = every_configuration(model, params).map_or(f64::INFINITY, |limit| limit.dt);
    let dt = (AUTO_DT_FRACTION * limit).min(AUTO_DT_MAX);
    if dt >= *DT_RANGE.start() {
        return Ok(dt);
    }
    let (least, limit) = (significant(*DT_RANGE.start()), significant(limit));
    let sentence =
        format!("no step of {least} s or more is stable here in every configuration; the limit is {limit} s");
    Err(Error::new(Code::OutOfRange, sentence).with_fix("raise masses, or lower stiffness or damping"))
}

/// The dt at which a mode's demand dt²ω² + 2dt·c reaches 4, s. `None` if it never does.
///
/// A compressed network has modes with ω² < 0: their demand rises, by c, and falls again. The first crossing counts.
fn limit_of_mode(omega2: f64, c: f64) -> Option<f64> {
    let discriminant = c * c + 4.0 * omega2;
    let denominator = c + discriminant.max(0.0).sqrt();
    let dt = 4.0 / denominator;
    (discriminant >= 0.0 && denominator > 0.0 && dt.is_finite()).then_some(dt)
}

/// The largest eigenvalue of the symmetric matrix xx, yy, zz, xy, xz, yz, for the kernel's tests.
#[cfg(test)]
pub(crate) fn largest_eigenvalue([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> f64 {
    symmetric3::Symmetric3 { m: [[xx, xy, xz], [0.0, yy, yz], [0.0, 0.0, zz]] }.largest_eigenvalue()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn demand_at_the_limit_of_a_mode_is_four() {
        for (omega2, c) in [(1.0, 0.0), (1.0, 0.2), (0.0, 3.0), (-1.0, 2.5), (1e24, 1e24), (1e-30, 0.0)] {
            let dt = limit_of_mode(omega2, c).expect("it has a limit");
            assert!((dt * dt * omega2 + 2.0 * dt * c - 4.0).abs() < 1e-13);
        }
        for (omega2, c) in [(0.0, 0.0), (-1.0, 0.0), (-1.0, 1.9)] {
            assert_eq!(limit_of_mode(omega2, c), None);
        }
    }
}
