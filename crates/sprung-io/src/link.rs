//! A scene's text in an address: deflated (RFC 1951), in base64 for addresses (RFC 4648). What else a link says is the window's.

use base64::Engine;
use base64::engine::general_purpose::URL_SAFE_NO_PAD as BASE64;
use miniz_oxide::deflate::compress_to_vec;
use miniz_oxide::inflate::decompress_to_vec_with_limit;
use sprung::scene::Scene;
use sprung::{Code, Error, Result};

/// The most characters that a link is given: every browser and most programs for messages take them.
const MOST_CHARACTERS: usize = 32_000;

/// The longest text of a scene that is unpacked, bytes.
pub const MOST_TEXT: usize = 4 << 20;

/// Effort in packing, from 0 to 10: a scene's text is short.
const EFFORT: u8 = 10;

/// A name and the text of a scene as parts of a link, `name=…&toml=…`.
pub fn parts(name: &str, text: &str) -> String {
    format!("name={}&toml={}", plain(name), BASE64.encode(compress_to_vec(text.as_bytes(), EFFORT)))
}

/// The text that the part `toml` holds.
///
/// # Errors
/// [`Code::Unreadable`] if it was cut or changed, or would be longer than [`MOST_TEXT`].
pub fn unpacked(toml: &str) -> Result<String> {
    let damaged = || Error::new(Code::Unreadable, "is cut or changed: its scene cannot be unpacked");
    let bytes = BASE64.decode(toml).map_err(|_| damaged())?;
    let text = decompress_to_vec_with_limit(&bytes, MOST_TEXT).map_err(|_| damaged())?;
    String::from_utf8(text).map_err(|_| damaged())
}

/// Refuses a scene with meshes, whose files no link can hold.
///
/// # Errors
/// [`Code::Unsupported`].
pub fn check_scene(scene: &Scene) -> Result<()> {
    let Some(mesh) = scene.bodies.iter().find_map(|body| body.mesh.as_ref()) else { return Ok(()) };
    let sentence =
        format!("cannot be a link: the scene has the mesh {}, and a link holds no files", mesh.file);
    Err(Error::new(Code::Unsupported, sentence).with_fix("send the scene's file and its meshes"))
}

/// Refuses a link that is longer than all programs take.
///
/// # Errors
/// [`Code::TooLarge`].
pub fn check_length(link: &str) -> Result<()> {
    if link.len() <= MOST_CHARACTERS {
        return Ok(());
    }
    let sentence = format!(
        "is too large for a link: that would have {} characters, and at most {MOST_CHARACTERS} are allowed",
        link.len()
    );
    Err(Error::new(Code::TooLarge, sentence).with_fix("save the scene and send the file"))
}

/// A name in characters that an address leaves as they are.
pub fn plain(name: &str) -> String {
    let keep = |c: char| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '-' };
    name.chars().take(60).map(keep).collect()
}
