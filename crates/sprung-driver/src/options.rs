//! What a driver is given to work with.

use std::fmt;
use std::sync::Arc;

use sprung::{Code, Error, Inline, Result, SettleOptions, Workers};

/// Memory for the recording unless said otherwise, bytes.
pub const DEFAULT_HISTORY_BYTES: usize = 256 << 20;

/// Memory and threads for a driver.
#[derive(Clone)]
pub struct Options {
    /// Memory for the recorded run, bytes: the log of what was done, which is kept whole, and checkpoints in what that
    /// leaves, or in a quarter. The rest is replayed from them, so that less memory means slower seeking, never less to go
    /// back to.
    pub history_bytes: usize,
    /// Scenes and checkpoints that need more than this are refused, bytes. `None`: no limit.
    pub memory_limit: Option<u64>,
    /// Threads to step with.
    pub workers: Arc<dyn Workers>,
    /// When a scene counts as settled.
    pub settle: SettleOptions,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            history_bytes: DEFAULT_HISTORY_BYTES,
            memory_limit: None,
            workers: Arc::new(Inline),
            settle: SettleOptions::default(),
        }
    }
}

impl Options {
    /// Refuses what needs more memory than there is.
    ///
    /// # Errors
    /// [`Code::TooLarge`].
    pub fn check_memory(&self, needed: u64, what: &str) -> Result<()> {
        let Some(limit) = self.memory_limit.filter(|limit| needed > *limit) else { return Ok(()) };
        let mib = |bytes: u64| bytes.div_ceil(1 << 20);
        let sentence =
            format!("{what} needs about {} MiB of memory, and there are {} MiB", mib(needed), mib(limit));
        Err(Error::new(Code::TooLarge, sentence))
    }
}

impl fmt::Debug for Options {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { history_bytes, memory_limit, workers, settle } = self;
        f.debug_struct("Options")
            .field("history_bytes", history_bytes)
            .field("memory_limit", memory_limit)
            .field("workers", &workers.count())
            .field("settle", settle)
            .finish()
    }
}
