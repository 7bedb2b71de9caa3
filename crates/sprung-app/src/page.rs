//! What the page does for the app: `web.js`.

use js_sys::Function;
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen(module = "/src/web.js")]
extern "C" {
    /// The part of the address behind `#`.
    pub fn fragment() -> String;
    /// The page's address without that part.
    pub fn address() -> String;
    /// Hands a file to the person.
    pub fn download(name: &str, bytes: &[u8]);
    /// Asks for files; `take(names, bytes of each)` is called when they are read.
    pub fn pick(accept: &str, take: &JsValue);
    /// A worker to simulate in: `take` hears its messages, or why there will be no more, and the function that is given takes
    /// messages there.
    pub fn work(take: &JsValue) -> Function;
    /// What the page is called: what it shows.
    pub fn name(title: &str);
    /// Says something to those who do not see the canvas, if it is not empty.
    pub fn tell(words: &str);
    /// The first picture is drawn.
    pub fn ready();
    /// The app cannot go on.
    pub fn failed(reason: &str);
}
