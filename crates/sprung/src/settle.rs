//! Bringing a scene to rest by kinetic damping.

/// When a scene counts as settled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SettleOptions {
    /// The largest force that may remain on any point that can move, N.
    /// `None`: a thousandth of the largest weight m·g, or 10⁻³ N without gravity.
    pub residual_force: Option<f64>,
    /// Steps after which to give up.
    pub max_steps: u64,
}

impl Default for SettleOptions {
    fn default() -> Self {
        Self { residual_force: None, max_steps: 1_000_000 }
    }
}

/// How a scene came to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// Steps it took. They count neither as steps of the run nor as time: a scene is not in motion while it is settled.
    pub steps: u64,
    /// The largest force that remains on any point that can move, N.
    pub residual_force: f64,
}
