//! Noticing that a run blew up, and saying why.

use std::fmt;

/// How a blow-up showed itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// A position or velocity became infinite or NaN.
    NotFinite,
    /// More than half of kinetic + elastic energy came from nowhere, for 20 steps in a row.
    EnergyFromNowhere {
        /// Energy beyond what was there at the start and put in since, J.
        excess: f64,
    },
}

/// What happened when a run blew up (physics of it: [`stability`](crate::stability)).
#[derive(Clone, Debug, PartialEq)]
pub struct BlowUp {
    /// How it showed itself.
    pub cause: Cause,
    /// The step at which it was noticed.
    pub step: u64,
    /// Simulated time then, s.
    pub time: f64,
    /// Step and time of the last good state, which is kept.
    pub good_step: u64,
    /// Time of the last good state, s.
    pub good_time: f64,
    /// The spring that sets the certified limit at the last good state, if one does.
    pub spring: Option<usize>,
    /// That spring's points, or the point whose contact sets the limit, twice.
    pub points: Option<[usize; 2]>,
    /// The body or joint that the spring belongs to.
    pub owner: String,
    /// The step length in use, s.
    pub dt: f64,
    /// The certified limit on dt at the last good state, s.
    pub dt_limit_certified: Option<f64>,
    /// A step length that is safe in every configuration, s.
    pub dt_safe: Option<f64>,
}

impl fmt::Display for BlowUp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the simulation blew up at t = {:.4} s (step {})", self.time, self.step)
    }
}
