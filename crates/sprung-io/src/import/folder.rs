//! A scene's folder: what lies in it or below may be read, and nothing else.

use std::path::{Component, Path, PathBuf};

use sprung::build::Mesh;
use sprung::scene::Scene;
use sprung::{Code, Error, Result};

use super::{MOST_BYTES, read_mesh};
use crate::files;

/// A folder that files are read from by their paths in it.
#[derive(Clone, Debug)]
pub struct Folder(PathBuf);

impl Folder {
    /// This one.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self(path.into())
    }

    /// The folder that a file lies in.
    pub fn of(file: &Path) -> Self {
        let parent = file.parent().filter(|parent| !parent.as_os_str().is_empty());
        Self::new(parent.unwrap_or(Path::new(".")))
    }

    /// Reads a file of at most `most` bytes by its path from this folder, with `/` between folders.
    ///
    /// # Errors
    /// [`Code::Conflict`] for a path that leads out of the folder, be it through a link; [`Code::Unreadable`] or
    /// [`Code::TooLarge`].
    pub fn read(&self, name: &str, most: u64) -> Result<Vec<u8>> {
        let outside = || {
            Error::new(
                Code::Conflict,
                "leads out of the scene's folder, and only files in it and below are read",
            )
            .with_fix("put a copy of the file beside the scene")
            .in_file(name)
        };
        // A colon is what a drive has on one system, and a part of a name on others.
        if name.contains(['\\', ':']) {
            let error = Error::new(
                Code::Conflict,
                "has \\ or : in its name, and must be a path with / between folders",
            );
            return Err(error.in_file(name));
        }
        let stays =
            Path::new(name).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        if !stays {
            return Err(outside());
        }
        let path = self.0.join(name);
        if let (Ok(folder), Ok(target)) = (self.0.canonicalize(), path.canonicalize())
            && !target.starts_with(folder)
        {
            return Err(outside());
        }
        files::read_ordinary(&path, most)
    }

    /// Reads a mesh by its path from this folder. Files that it refers to are looked for beside it.
    ///
    /// # Errors
    /// As [`read`](Self::read) and [`read_mesh`].
    pub fn read_mesh(&self, name: &str) -> Result<Mesh> {
        // The format first: no file is read that would be of no use.
        super::reader_for(name)?;
        let bytes = self.read(name, MOST_BYTES)?;
        let beside = name.rsplit_once('/').map(|(folder, _)| folder);
        let file = self.0.join(name).display().to_string();
        read_mesh(&bytes, &file, &mut |other| match beside {
            Some(folder) => self.read(&format!("{folder}/{other}"), MOST_BYTES),
            None => self.read(other, MOST_BYTES),
        })
    }
}

/// Reads all meshes that a scene names, from the folder of its file; a built-in scene has none. Gives what is odd about them, a
/// sentence each.
///
/// # Errors
/// As [`Folder::read_mesh`] and [`Scene::load_meshes`].
pub fn load_meshes(scene: &mut Scene, file: Option<&Path>) -> Result<Vec<String>> {
    let folder = file.map_or_else(|| Folder::new("."), Folder::of);
    scene.load_meshes(&mut |name| folder.read_mesh(name))
}
