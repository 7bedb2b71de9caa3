//! The one door to files: dialogs, reading, writing.

#[cfg(target_arch = "wasm32")]
mod page;
#[cfg(not(target_arch = "wasm32"))]
mod system;

use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sprung::scene::{BUILTIN, MAX_BYTES, Scene};
use sprung::{Checkpoint, Code, Error, Result};
use sprung_driver::{Beginning, Kept, Options, Report, Source};
use sprung_io::checkpoint::{self, Keeper, Saved};
use sprung_io::files::PartialFile;

use crate::media::file_stem;

#[cfg(target_arch = "wasm32")]
pub use page::{Dialog, dropped, hand_out};
#[cfg(not(target_arch = "wasm32"))]
pub use system::{Dialog, dropped};
#[cfg(not(target_arch = "wasm32"))]
use {sprung_driver::Running, sprung_io::checkpoint::Stored};

/// The ending of scene files.
pub const ENDING: &str = "toml";

/// What can be opened: scenes and checkpoints.
pub const OPENED: [&str; 2] = [ENDING, checkpoint::ENDING];

/// What was found where something is to be opened.
#[derive(Clone, Debug)]
pub enum Found {
    /// A scene.
    Scene(Source),
    /// A checkpoint, which is not read yet: it may be large.
    Checkpoint(Kept),
}

impl Found {
    /// It as a driver begins with it.
    ///
    /// # Errors
    /// If it is a checkpoint that cannot be gone on with.
    pub fn begin(self, options: &Options) -> Result<Beginning> {
        match self {
            Self::Scene(source) => Ok(source.into()),
            Self::Checkpoint(kept) => Ok(kept.bring(options)?.into()),
        }
    }
}

/// Where a scene came from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Origin {
    /// It comes with the program, under this name.
    Builtin(String),
    /// A file.
    File(PathBuf),
    /// A link that holds it: see [`link`](crate::link).
    Link(String),
    /// None of these: handed in by the caller, or dropped where files have no path.
    Other(String),
}

impl Origin {
    /// A file, by a path that still holds when the program is started elsewhere.
    pub fn file(path: &Path) -> Self {
        Self::File(std::path::absolute(path).unwrap_or_else(|_| path.to_owned()))
    }

    /// Of a scene that was handed in under this name.
    pub fn of(name: &str, scene: &Scene) -> Self {
        let is_builtin = BUILTIN.iter().any(|builtin| builtin.name == name)
            && Scene::builtin(name).is_ok_and(|builtin| builtin == *scene);
        if is_builtin { Self::Builtin(name.to_owned()) } else { Self::Other(name.to_owned()) }
    }

    /// The scene or the checkpoint that lies there.
    ///
    /// # Errors
    /// If there is none any more, or it cannot be read.
    pub fn find(&self) -> Result<Found> {
        match self {
            Self::Builtin(name) | Self::Other(name) => {
                Ok(Found::Scene(Source { name: name.clone(), scene: Scene::builtin(name)? }))
            }
            Self::File(path) => find(path).map_err(|refused| refused.error),
            Self::Link(link) => match crate::link::read(link)? {
                Some(link) => Ok(Found::Scene(link.source)),
                None => Err(Error::new(Code::MissingField, "the link is empty")),
            },
        }
    }
}

/// What the window knows of files.
#[derive(Debug)]
pub struct Files {
    /// Where the open scene came from.
    pub origin: Origin,
    /// Where the scene that was asked for lies; it becomes `origin` when it is open.
    asked: Option<Origin>,
}

impl Files {
    /// Beginning with a scene from there.
    pub fn new(origin: Origin) -> Self {
        Self { origin, asked: None }
    }

    /// A scene from there has been asked for.
    pub fn ask(&mut self, origin: Origin) {
        self.asked = Some(origin);
    }

    /// The scene that was asked for is open.
    pub fn opened(&mut self) {
        if let Some(origin) = self.asked.take() {
            self.origin = origin;
        }
    }

    /// A path to save the open scene to: its own file, or a name for one that is not there yet.
    pub fn path_to_save(&self) -> PathBuf {
        match &self.origin {
            Origin::File(path) if checkpoint::is_name(path) => path.with_extension(ENDING),
            Origin::File(path) => path.clone(),
            Origin::Builtin(name) | Origin::Other(name) => {
                PathBuf::from(format!("my-{}.{ENDING}", file_stem(name)))
            }
            Origin::Link(_) => PathBuf::from(format!("my-scene.{ENDING}")),
        }
    }
}

/// What cannot be done, such as opening a scene: why, and the scene's text if there is any.
#[derive(Clone, Debug)]
pub struct Refused {
    /// Why.
    pub error: Error,
    /// What the file says, so that the line at fault can be shown.
    pub text: Option<String>,
}

/// What lies there to be opened, by the ending of its name. Scenes are read.
///
/// # Errors
/// As [`read_scene`]; what is wrong with a checkpoint comes out when it is wanted.
pub fn find(path: &Path) -> Result<Found, Refused> {
    if checkpoint::is_name(path) {
        kept(path).map(Found::Checkpoint)
    } else {
        read_scene(path).map(Found::Scene)
    }
}

/// The checkpoint in a file, to be read by whoever wants it.
#[cfg(not(target_arch = "wasm32"))]
fn kept(path: &Path) -> Result<Kept, Refused> {
    let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let file = path.display().to_string();
    let path = path.to_owned();
    let read = move |options: &Options| {
        let saved = Stored::open(&path)?.read(&|needed, what| options.check_memory(needed, what))?;
        Running::from_saved(saved, options)
    };
    Ok(Kept::elsewhere(name, move |options| read(options).map_err(|error| error.in_file(&file))))
}

/// The same on a page, whose driver does not see its files: it is given the bytes.
#[cfg(target_arch = "wasm32")]
fn kept(path: &Path) -> Result<Kept, Refused> {
    let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    match sprung_io::files::read_ordinary(path, u64::MAX >> 1) {
        Ok(bytes) => Ok(Kept::in_bytes(name, bytes)),
        Err(error) => Err(Refused { error, text: None }),
    }
}

/// Writes a checkpoint of the open scene, and gives its size.
///
/// # Errors
/// As [`write()`], and if the file belongs to a run that is still going.
pub fn write_checkpoint(path: &Path, report: &Report, checkpoint: &Checkpoint) -> Result<u64> {
    checkpoint::check_name(path)?;
    let opened = &report.opened;
    let saved = Saved::of(&opened.name, &opened.scene, &opened.model, checkpoint.clone());
    Keeper::begin(path)?.write(&saved)
}

/// Reads a scene file.
///
/// # Errors
/// With the file's line and field where its text is at fault.
pub fn read_scene(path: &Path) -> Result<Source, Refused> {
    // Small as scene files are (most have less than 2 KiB), reading one does not hold up the window.
    let bytes =
        sprung_io::files::read_ordinary(path, MAX_BYTES).map_err(|error| Refused { error, text: None })?;
    let mut source = parse_scene(&bytes, &path.display().to_string())?;
    // What is odd about a mesh is told by a card once the scene is open.
    match sprung_io::import::load_meshes(&mut source.scene, Some(path)) {
        Ok(_) => Ok(source),
        Err(error) => {
            // The line may be one of the mesh's file.
            let is_own = error.place().file.as_deref() == Some(&*path.display().to_string());
            Err(Refused { error, text: String::from_utf8(bytes).ok().filter(|_| is_own) })
        }
    }
}

/// A scene from the bytes of a file of this name.
///
/// # Errors
/// With line and field.
pub fn parse_scene(bytes: &[u8], file: &str) -> Result<Source, Refused> {
    let name = Path::new(file).file_stem().map_or_else(|| file.into(), |stem| stem.to_string_lossy());
    match Scene::from_bytes(bytes, file) {
        Ok(scene) => Ok(Source { name: name.into_owned(), scene }),
        Err(error) => Err(Refused { error, text: String::from_utf8(bytes.to_vec()).ok() }),
    }
}

/// Writes the open scene with all parameters as they are now, and gives the file's size.
///
/// # Errors
/// As [`scene_text`] and [`write()`], and if the name is that of a checkpoint.
pub fn write_scene(path: &Path, report: &Report) -> Result<u64> {
    if checkpoint::is_name(path) {
        let error =
            Error::new(Code::Unsupported, "is a name for a checkpoint, and a scene's ends with .toml");
        return Err(error.in_file(path.display().to_string()));
    }
    write(path, scene_text(report)?.as_bytes())
}

/// The open scene with all parameters as they are now, as the text of a scene file that `sprung run` takes.
///
/// # Errors
/// Where a scene file has no way to say it.
pub fn scene_text(report: &Report) -> Result<String> {
    let scene = report.opened.scene.with_params(&report.opened.model, &report.params)?;
    Ok(scene.to_toml())
}

/// Writes a file: beside its place, and renamed when whole.
///
/// # Errors
/// [`Code::Unwritable`], naming the file; what was there before is left as it was.
pub fn write(path: &Path, bytes: &[u8]) -> Result<u64> {
    let mut file = PartialFile::create(path)?;
    file.write_all(bytes).map_err(|error| sprung_io::files::write_error(path, &error))?;
    file.finish()
}

/// What is chosen in a dialog, and for what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wanted<'a> {
    /// The dialog's title.
    pub title: &'a str,
    /// What such files are called: `"scenes"`.
    pub kind: &'a str,
    /// Their endings.
    pub endings: &'a [&'a str],
    /// The name for a file to save; `None`: a file to open.
    pub save_as: Option<&'a str>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_is_named_after_its_file() {
        let text = "[[body]]\nname = \"a\"\npoints = [[0, 0, 0]]\n";
        let source = parse_scene(text.as_bytes(), "some/where/two.words.toml").expect("it is a scene");
        assert_eq!(source.name, "two.words");
    }

    #[test]
    fn a_bad_scene_keeps_its_text_for_the_error() {
        let refused = parse_scene(b"dt = -1\n", "x.toml").expect_err("dt is negative");
        assert_eq!(refused.text.as_deref(), Some("dt = -1\n"));
        assert_eq!(refused.error.place().line_column.map(|(line, _)| line), Some(1));
        assert!(parse_scene(&[0xff, 0xfe], "x.toml").expect_err("it is no text").text.is_none());
    }

    #[test]
    fn a_file_is_found_again_from_elsewhere() {
        let Origin::File(path) = Origin::file(Path::new("some/where.toml")) else { panic!("it is a file") };
        assert!(path.is_absolute() && path.ends_with("some/where.toml"), "{}", path.display());
        assert_eq!(Files::new(Origin::file(&path)).path_to_save(), path);
        // A scene is not suggested to be written over the checkpoint that it came from.
        let from = Files::new(Origin::file(Path::new("/some/where.sprung")));
        assert_eq!(from.path_to_save().file_name(), Some("where.toml".as_ref()));
        let handed_in = Files::new(Origin::Other("a/b".to_owned()));
        assert_eq!(handed_in.path_to_save(), Path::new("my-a-b.toml"));
    }

    #[test]
    fn a_built_in_scene_that_was_changed_is_no_longer_it() {
        let mut scene = Scene::builtin("chain").expect("it is built in");
        assert_eq!(Origin::of("chain", &scene), Origin::Builtin("chain".to_owned()));
        scene.substeps += 1;
        assert_eq!(Origin::of("chain", &scene), Origin::Other("chain".to_owned()));
    }
}
