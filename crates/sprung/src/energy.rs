//! The energy ledger: where the energy is, and where it went.

/// Works summed over the steps taken while the ledger was on, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LedgerSums {
    /// Energy taken out by the springs' dampers.
    pub lost_in_dampers: f64,
    /// Energy taken out by contact.
    pub lost_in_contact: f64,
    /// Work put in by external forces, grabs and changes of the parameters.
    pub work_in: f64,
    /// Energy that the integrator made (positive) or lost (negative).
    pub integrator_error: f64,
}

/// Where the energy is at one moment, and where it went since the start, J.
///
/// kinetic + gravitational + elastic + contact = their sum at the start + work_in − lost_in_dampers − lost_in_contact +
/// integrator_error, to rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Σ ½mv².
    pub kinetic: f64,
    /// −Σ m g·x.
    pub gravitational: f64,
    /// Σ ½k_s(ℓ − L)².
    pub elastic: f64,
    /// Σ ½k_c p².
    pub contact: f64,
    /// What went where since the start.
    pub sums: LedgerSums,
}

impl Energy {
    /// Kinetic and all potential energy, J.
    pub fn total(&self) -> f64 {
        self.kinetic + self.gravitational + self.elastic + self.contact
    }
}
