//! Scene files: what a small TOML text says, checked and built into model, params and first state.
//!
//! ```
//! use sprung::scene::Scene;
//!
//! let mut scene = Scene::builtin("jelly")?;
//! scene.set("stiffness", "500")?;
//! let (model, params, _state) = scene.build()?;
//! assert_eq!((model.spring_count(), params.spring_stiffness[0]), (7560, 500.0));
//! # Ok::<(), sprung::Error>(())
//! ```
//!
//! The format is described in `docs/scene-format.md` and by [`json_schema`].

mod assemble;
mod builtin;
mod check;
mod choices;
mod group;
mod mesh;
mod read;
mod set;
mod shape;
mod source;
mod suggest;
mod types;
mod with_params;

use toml::de::DeTable;

pub use builtin::{BUILTIN, Builtin, Kind, STARTER};
pub use check::MAX_POINTS;
pub use choices::{Dt, Numbers, OneOrEach, Pin, PinWhere, Region};
pub use mesh::{Cloth, MeshFile, Net, Soft};
pub use source::Provenance;
pub use suggest::closest;
pub use types::{
    Block, Body, Chain, Exception, Force, Grid, GridPlane, Joint, Plane, Rotation, Scene, Springs,
};

use crate::error::{Code, Error, Result};
use source::Origin;

/// The largest scene file that is read, bytes.
pub const MAX_BYTES: u64 = 64 << 20;

impl Scene {
    /// Reads a scene and checks all that can be checked without building it. `file` is the name that errors give.
    ///
    /// # Errors
    /// With file, line, column and field: text that is not TOML, wrong types, missing and unknown keys, numbers out of
    /// range, names and indices that do not exist, statements that cannot both hold.
    pub fn parse(text: &str, file: &str) -> Result<Self> {
        if text.len() as u64 > MAX_BYTES {
            return Err(too_many_bytes(text.len() as u64).in_file(suggest::one_line(file)));
        }
        if text.trim().is_empty() {
            let error = Error::new(Code::MissingField, "is empty; a scene needs at least one [[body]]");
            return Err(error
                .with_fix("`sprung new FILE` writes a scene to start from")
                .in_file(suggest::one_line(file))
                .at_line(1, 1));
        }
        if let Some(byte) = text.find('\0') {
            return Err(source::not_text(text, byte, file));
        }
        let origin = Origin::new(file, text);
        let document = DeTable::parse(text).map_err(|error| origin.locate_syntax(&error))?;
        let mut scene: Self = read::from_document(&document).map_err(|error| origin.locate_read(error))?;
        check::check(&scene, MAX_POINTS).map_err(|error| origin.locate(error))?;
        scene.origin = origin;
        Ok(scene)
    }

    /// As [`parse`](Self::parse), from the bytes of a file.
    ///
    /// # Errors
    /// As [`parse`](Self::parse), and for bytes that are not UTF-8 the line and column of the first bad one.
    pub fn from_bytes(bytes: &[u8], file: &str) -> Result<Self> {
        if bytes.len() as u64 > MAX_BYTES {
            return Err(too_many_bytes(bytes.len() as u64).in_file(suggest::one_line(file)));
        }
        match std::str::from_utf8(bytes) {
            Ok(text) => Self::parse(text, file),
            Err(error) => Err(source::not_utf8(bytes, error.valid_up_to(), file)),
        }
    }

    /// The built-in scene called `name`.
    ///
    /// # Errors
    /// [`Code::NotFound`], with the names there are.
    pub fn builtin(name: &str) -> Result<Self> {
        if let Some(builtin) = BUILTIN.iter().find(|builtin| builtin.name == name) {
            return Self::parse(builtin.text, &format!("scenes/{name}.toml"));
        }
        let names = || BUILTIN.iter().map(|builtin| builtin.name);
        let all = names().collect::<Vec<_>>().join(", ");
        let sentence =
            format!("there is no built-in scene \"{}\"; there are {all}", suggest::shortened(name));
        let error = Error::new(Code::NotFound, sentence);
        Err(match suggest::did_you_mean(name, names()) {
            Some(fix) => error.with_fix(fix),
            None => error,
        })
    }

    /// The scene as TOML, with every default written out; reads back to an equal scene.
    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect("tables with text keys, numbers and text can always be written")
    }
}

/// The error for a scene file of so many bytes.
pub fn too_many_bytes(bytes: u64) -> Error {
    Error::new(Code::TooLarge, format!("has {bytes} bytes, and a scene file may have at most {MAX_BYTES}"))
}

/// The JSON Schema of scene files, made from the types that read them: editors check and complete with it.
pub fn json_schema() -> String {
    let schema = schemars::schema_for!(Scene);
    serde_json::to_string_pretty(&schema).expect("a schema is JSON")
}

#[cfg(test)]
mod tests;
