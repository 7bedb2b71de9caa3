//! Ctrl-C: the first one asks a run to end cleanly, the second one ends the process.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use sprung::{Code, Error, Result};

/// Whether the user has asked to stop.
#[derive(Clone, Debug)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Listens from now on.
    pub fn listen() -> Result<Self> {
        static FLAG: OnceLock<Interrupt> = OnceLock::new();
        if let Some(interrupt) = FLAG.get() {
            return Ok(interrupt.clone());
        }
        let interrupt = FLAG.get_or_init(|| Self(Arc::new(AtomicBool::new(false))));
        let flag = interrupt.0.clone();
        let handler = move || {
            if flag.swap(true, Ordering::SeqCst) {
                std::process::exit(130);
            }
        };
        ctrlc::set_handler(handler)
            .map_err(|error| Error::new(Code::Unsupported, format!("cannot listen for Ctrl-C: {error}")))?;
        Ok(interrupt.clone())
    }

    /// Whether Ctrl-C was pressed.
    pub fn came(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
