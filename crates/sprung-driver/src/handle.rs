//! How a front end holds a driver, wherever that works.

use std::sync::Arc;
use std::sync::mpsc::Receiver;

use crate::command::{Beginning, Command};
use crate::driver::Driver;
use crate::options::Options;
use crate::remote::{Post, Remote, Word};
use crate::report::Report;
#[cfg(not(target_arch = "wasm32"))]
use crate::thread::Thread;

/// A driver as the front end sees it. Dropping it ends the driver's work.
pub struct Handle(Place);

/// Where the driver works.
enum Place {
    /// Here, as long as it takes.
    Inline(Box<Driver>),
    #[cfg(not(target_arch = "wasm32"))]
    Thread(Thread),
    /// Where no memory is shared with it, such as in a page's worker.
    Remote(Box<Remote>),
}

impl Handle {
    /// A driver that does all its work when it is asked or told that time has passed, however long that takes, and reads no
    /// clock: the same calls give the same reports. For tests.
    pub fn inline(driver: Driver) -> Self {
        Self(Place::Inline(Box::new(driver)))
    }

    /// A driver on a thread of its own. `wake` is called there when there is a new report.
    ///
    /// # Errors
    /// [`Code::Unsupported`](sprung::Code::Unsupported) if the system gives no thread.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn thread(driver: Driver, wake: Box<dyn Fn() + Send>) -> sprung::Result<Self> {
        Ok(Self(Place::Thread(Thread::start(driver, wake)?)))
    }

    /// A driver in a [`Host`](crate::Host) at the far end of a wire, such as in a page's worker. `post` takes messages there:
    /// the first is what the host is made of. `words` come from there. What it begins with is built here, too, for the first
    /// report.
    ///
    /// # Errors
    /// As [`Driver::with`].
    pub fn remote(
        beginning: impl Into<Beginning>,
        options: Options,
        post: Post,
        words: Receiver<Word>,
    ) -> sprung::Result<Self> {
        Ok(Self(Place::Remote(Box::new(Remote::new(beginning.into(), options, post, words)?))))
    }

    /// Asks for something. Inline it is done at once, else soon.
    pub fn send(&mut self, command: Command) {
        match &mut self.0 {
            Place::Inline(driver) => {
                driver.obey(command);
                driver.advance(0.0, &mut || true);
            }
            #[cfg(not(target_arch = "wasm32"))]
            Place::Thread(thread) => thread.send(command),
            Place::Remote(remote) => remote.send(&command),
        }
    }

    /// Real time has passed, s. Inline, this is when the work is done; elsewhere the driver has its own clock.
    pub fn pass(&mut self, seconds: f64) {
        match &mut self.0 {
            Place::Inline(driver) => driver.advance(seconds, &mut || true),
            #[cfg(not(target_arch = "wasm32"))]
            Place::Thread(_) => {}
            Place::Remote(_) => {}
        }
    }

    /// The newest report.
    pub fn report(&mut self) -> Arc<Report> {
        match &mut self.0 {
            Place::Inline(driver) => driver.report(),
            #[cfg(not(target_arch = "wasm32"))]
            Place::Thread(thread) => thread.report(),
            Place::Remote(remote) => remote.report(),
        }
    }
}
