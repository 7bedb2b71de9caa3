//! A driver at the far end of a wire: messages in, messages out.

use std::collections::VecDeque;
use std::sync::Arc;

use sprung::Result;
use web_time::{Duration, Instant};

use crate::driver::Driver;
use crate::turns::{Clock, Turns};
use crate::wire::{Fingerprint, FromHost, Start, ToHost, Wire, Writer};

/// Reports that may be under way: while the front end takes one in, the next is on its way.
const MOST_UNDER_WAY: usize = 2;

/// Of larger reports only one may be under way, bytes.
const LARGE: usize = 256 << 10;

/// A driver that is reached by messages of bytes alone, such as in a page's worker. [`Handle::remote`](crate::Handle::remote)
/// is the other end.
///
/// Whoever runs it passes on every message that comes with [`hear`](Self::hear), gives it a [`turn`](Self::turn) then and
/// whenever it asked for one, and sends what [`report`](Self::report) has to say.
pub struct Host {
    turns: Turns,
    writer: Writer,
    greeting: Option<Fingerprint>,
    /// Sizes of the reports that are under way, bytes.
    under_way: VecDeque<usize>,
}

impl Host {
    /// By the first message of the other end.
    ///
    /// # Errors
    /// If it is none, or of another version; and as [`Driver::with`].
    pub fn new(first: &[u8]) -> Result<Self> {
        let begun = Instant::now();
        Self::with_clock(first, Box::new(move || begun.elapsed()))
    }

    pub(crate) fn with_clock(first: &[u8], clock: Clock) -> Result<Self> {
        let Start { beginning, options } = Start::from_bytes(first)?;
        let driver = Driver::with(beginning, options)?;
        let greeting = Some(driver.fingerprint());
        let turns = Turns::new(driver, clock);
        let writer = Writer::new(turns.newest().clone());
        Ok(Self { turns, writer, greeting, under_way: VecDeque::new() })
    }

    /// A message has come.
    pub fn hear(&mut self, message: &[u8]) {
        match ToHost::from_bytes(message) {
            Ok(ToHost::Command(command)) => self.turns.hear(command),
            Ok(ToHost::Heard) => _ = self.under_way.pop_front(),
            // Whoever asked for it is to know.
            Err(error) => self.turns.refuse(error),
        }
    }

    /// Does what was asked and what is due, for some milliseconds. Gives how long there is nothing to do then; `None`: for ever.
    pub fn turn(&mut self) -> Option<Duration> {
        self.turns.turn(&|| true);
        self.turns.rest()
    }

    /// What there is to tell, if there is something and the front end keeps up with it. To be asked until it is `None`.
    pub fn report(&mut self) -> Option<Vec<u8>> {
        if let Some(greeting) = self.greeting.take() {
            return Some(FromHost::greeting(greeting));
        }
        let most = if self.under_way.iter().any(|&bytes| bytes > LARGE) { 1 } else { MOST_UNDER_WAY };
        let newest = self.turns.newest();
        if self.under_way.len() >= most || Arc::ptr_eq(newest, self.writer.last()) {
            return None;
        }
        let bytes = self.writer.write(newest);
        self.under_way.push_back(bytes.len());
        Some(bytes)
    }

    /// A fingerprint of the state now: [`Simulation::state_hash`](sprung::Simulation::state_hash).
    pub fn state_hash(&self) -> u64 {
        self.turns.driver.state_hash()
    }
}
