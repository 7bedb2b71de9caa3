//! What a page's worker holds: a driver that is reached by messages. `web/worker.js` gives it its turns.

use std::sync::{Mutex, Once, PoisonError};

use sprung_driver::Host;
use wasm_bindgen::JsError;
use wasm_bindgen::prelude::wasm_bindgen;

/// What was said when the module stopped for good.
static LAST_WORDS: Mutex<Option<String>> = Mutex::new(None);

/// A driver in a page's worker.
///
/// It works on one thread. Several would need memory that threads share, which pages have only where their server isolates them
/// from others, and a module that is built for it.
#[wasm_bindgen]
pub struct PageDriver(Host);

#[wasm_bindgen]
impl PageDriver {
    /// By the first message of the page.
    ///
    /// # Errors
    /// If it is none, or the scene in it cannot be built.
    #[wasm_bindgen(constructor)]
    pub fn new(first: &[u8]) -> Result<Self, JsError> {
        keep_last_words();
        Host::new(first).map(Self).map_err(|error| JsError::new(&error.to_string()))
    }

    /// A message of the page has come.
    pub fn hear(&mut self, message: &[u8]) {
        self.0.hear(message);
    }

    /// Does what was asked and what is due, for some milliseconds. Gives the milliseconds in which there is nothing to do then;
    /// −1: nothing until the next message.
    pub fn turn(&mut self) -> f64 {
        self.0.turn().map_or(-1.0, |rest| 1e3 * rest.as_secs_f64())
    }

    /// A message for the page, if there is one and the page keeps up with them. To be asked until there is none.
    pub fn report(&mut self) -> Option<Vec<u8>> {
        self.0.report()
    }
}

/// Why the module has stopped for good, if it has.
#[wasm_bindgen(js_name = lastWords)]
pub fn last_words() -> Option<String> {
    LAST_WORDS.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

/// In a page a panic tells nobody anything.
fn keep_last_words() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        std::panic::set_hook(Box::new(|panic| {
            *LAST_WORDS.lock().unwrap_or_else(PoisonError::into_inner) = Some(panic.to_string());
        }));
    });
}
