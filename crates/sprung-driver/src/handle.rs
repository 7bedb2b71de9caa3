//! How a front end holds a driver, wherever that works.

use std::sync::Arc;

use crate::command::Command;
use crate::driver::Driver;
use crate::report::Report;

/// A driver as the front end sees it.
pub struct Handle(Box<Driver>);

impl Handle {
    /// A driver that works when it is told that time has passed.
    pub fn inline(driver: Driver) -> Self {
        Self(Box::new(driver))
    }

    /// Asks for something. It is done before the next report, or soon.
    pub fn send(&mut self, command: Command) {
        self.0.obey(command);
    }

    /// Real time has passed, s. Inline, this is when the work is done.
    pub fn pass(&mut self, seconds: f64) {
        self.0.advance(seconds, &mut || true);
    }

    /// The newest report.
    pub fn report(&mut self) -> Arc<Report> {
        self.0.report()
    }
}
