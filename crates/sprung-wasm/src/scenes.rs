//! The scenes that come with the engine.

use js_sys::Array;
use sprung::scene::{BUILTIN, Kind, Scene};
use wasm_bindgen::prelude::*;

use crate::javascript::Fields;

/// Name, title, kind and text of every built-in scene.
#[wasm_bindgen]
pub fn scenes() -> Array {
    let entry = |builtin: &sprung::scene::Builtin| {
        let title = Scene::builtin(builtin.name).map(|scene| scene.title).unwrap_or_default();
        let kind = match builtin.kind {
            Kind::Report => "report",
            Kind::Gallery => "gallery",
            Kind::Benchmark => "benchmark",
        };
        let fields = Fields::new().with("name", builtin.name).with("title", title);
        fields.with("kind", kind).with("text", builtin.text).done()
    };
    BUILTIN.iter().map(entry).collect()
}

/// The version of the engine.
#[wasm_bindgen]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}
