//! Who says how long the driver may work.

/// Bounds the work of one `Driver::advance_under`.
pub(crate) trait Supervisor {
    /// Whether there is time for one more step.
    fn may_go_on(&mut self) -> bool;

    /// Asked now and then during work that cannot be taken in portions: whether it may go on, and what it is.
    fn may_keep_busy(&mut self, _what: &str) -> bool {
        true
    }
}

impl<F: FnMut() -> bool> Supervisor for F {
    fn may_go_on(&mut self) -> bool {
        self()
    }
}
