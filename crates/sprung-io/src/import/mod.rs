//! Meshes in: one file per format, chosen by the ending of the file's name.
//!
//! A reader takes bytes and gives a [`Mesh`]; it never trusts a count that the bytes do not bear out. Whatever the bytes are, it
//! takes time and memory in proportion to them, and ends with a mesh or with one sentence that names the place. Formats that were
//! made for more than meshes are read as far as meshes go.
//!
//! glTF is read by a library, between checks of our own, and so is the tree of VTK's XML. The other readers are our own, and small. What was found of the libraries
//! that there are, each tried on whole, hostile and 20 000 damaged files, with the overflow of numbers checked:
//! - OBJ, `tobj` 4.0.5: of five vertices with `f 4 2 1` it gives three, in that order, as float32; refuses a face that goes on after
//!   a backslash; has no lines in its errors; three panics.
//! - PLY, `ply-rs-bw` 4.0.1, as `ply-rs` 0.1.3 of 2020: ended by a file of 72 bytes, which counts elements without properties, at 5 GB of
//!   memory; else 27 times the file; refuses a comment that is not UTF-8, and says only "couldn't read" of `nan`.
//! - STL, `stl_io` 0.11.0: of a text with two solids it gives the first, and no word of the other; has no names of solids, and
//!   no lines in its errors.
//! - VTK, `vtkio` 0.7.0-rc2: refuses a mesh whose point data are cut, which is of no concern here; says "Parse error: Complete" of
//!   that and of too large a count alike, with no place.
//! - Gmsh, `mshio` 0.4.2 of 2020: version 4.1 only, without physical groups; six panics, two of which no check of overflow makes.
//! - USD, `openusd` 0.6.0: one damaged byte in 1420 makes it ask for 3·10¹⁸ bytes, which ends the process.

mod bytes;
mod folder;
mod gltf;
mod msh;
mod obj;
mod ply;
mod stl;
mod usd;
mod vtk;
mod vtu;
mod words;

use std::collections::BTreeMap;
use std::path::Path;

use sprung::build::Mesh;
use sprung::build::mesh::MeshGroup;
use sprung::scene::closest;
use sprung::{Code, Error, Result};

use crate::files;
pub use folder::{Folder, load_meshes};

/// The largest mesh file that is read, bytes.
pub const MOST_BYTES: u64 = 1 << 30;

/// Vertices in all groups together, each as often as it is named.
const MOST_GROUP_ENTRIES: usize = 50_000_000;

/// Gives the bytes of another file that the one being read refers to, by its path from there.
pub type Companions<'a> = dyn FnMut(&str) -> Result<Vec<u8>> + 'a;

/// A format that meshes are read from.
#[derive(Clone, Copy)]
pub struct Reader {
    /// The endings of file names, without the dot.
    pub endings: &'static [&'static str],
    /// What the format is, in a phrase.
    pub description: &'static str,
    /// Reads one; errors say the line where there are lines, and no file.
    pub read: fn(&[u8], &mut Companions<'_>) -> Result<Mesh>,
}

/// All formats that meshes are read from.
pub static READERS: &[Reader] = &[
    Reader { endings: &["obj"], description: "Wavefront OBJ", read: obj::read },
    Reader { endings: &["ply"], description: "PLY, as text or binary", read: ply::read },
    Reader { endings: &["stl"], description: "STL, as text or binary", read: stl::read },
    Reader { endings: &["gltf", "glb"], description: "glTF 2.0", read: gltf::read },
    Reader {
        endings: &["usd", "usda", "usdc", "usdz"],
        description: "USD, as text, binary or archive",
        read: usd::read,
    },
    Reader { endings: &["msh"], description: "Gmsh 2 and 4, as text or binary", read: msh::read },
    Reader { endings: &["vtk"], description: "VTK legacy, as text or binary", read: vtk::read },
    Reader {
        endings: &["vtu"],
        description: "VTK XML unstructured grid, as text or binary, compressed by zlib or not",
        read: vtu::read,
    },
];

/// The reader for a file of this name.
///
/// # Errors
/// [`Code::Unsupported`], with the endings there are.
pub fn reader_for(file: &str) -> Result<&'static Reader> {
    let ending = Path::new(file).extension().map(|ending| ending.to_string_lossy().to_lowercase());
    let ending = ending.unwrap_or_default();
    if let Some(reader) = READERS.iter().find(|reader| reader.endings.contains(&ending.as_str())) {
        return Ok(reader);
    }
    let endings = || READERS.iter().flat_map(|reader| reader.endings.iter().copied());
    let all = endings().map(|ending| format!(".{ending}")).collect::<Vec<_>>().join(", ");
    let sentence = match ending.as_str() {
        "" => format!("has no ending that tells its format; meshes are read from {all}"),
        _ => format!("is not a mesh file that can be read; meshes are read from {all}"),
    };
    let error = Error::new(Code::Unsupported, sentence).in_file(file);
    Err(match closest(&ending, endings()) {
        Some(near) => error.with_fix(format!("did you mean .{near}?")),
        None => error,
    })
}

/// Reads a mesh from bytes; `file` is its name, whose ending tells the format and which errors give.
///
/// # Errors
/// With the file, and the line where there are lines: what is not in the format, is cut short, has vertices that are not there or
/// no numbers, or is too large.
pub fn read_mesh(bytes: &[u8], file: &str, companions: &mut Companions<'_>) -> Result<Mesh> {
    let reader = reader_for(file)?;
    let mesh = (reader.read)(bytes, companions).and_then(|mesh| mesh.check().map(|()| mesh));
    mesh.map_err(|error| error.in_file(file))
}

/// Reads a mesh file by itself; others that it refers to must lie in its folder or below.
///
/// # Errors
/// As [`read_mesh`], and if the file cannot be read.
pub fn read_mesh_file(path: &Path) -> Result<Mesh> {
    let bytes = files::read_ordinary(path, MOST_BYTES)?;
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = Folder::new(parent);
    read_mesh(&bytes, &path.display().to_string(), &mut |name| folder.read(name, MOST_BYTES))
}

/// Groups being read: names, and vertices in any order and any number of times.
#[derive(Default)]
struct Groups {
    by_name: BTreeMap<String, usize>,
    groups: Vec<MeshGroup>,
    entries: usize,
}

impl Groups {
    /// The number of the group of this name, which is made if it is new.
    fn named(&mut self, name: &str) -> usize {
        if let Some(&group) = self.by_name.get(name) {
            return group;
        }
        self.by_name.insert(name.to_owned(), self.groups.len());
        self.groups.push(MeshGroup { name: name.to_owned(), vertices: Vec::new() });
        self.groups.len() - 1
    }

    /// Puts vertices into a group.
    fn extend(&mut self, group: usize, vertices: &[u32]) -> Result<()> {
        self.entries += vertices.len();
        if self.entries > MOST_GROUP_ENTRIES {
            let sentence = format!("has groups with more than {MOST_GROUP_ENTRIES} vertices in all");
            return Err(Error::new(Code::TooLarge, sentence));
        }
        self.groups[group].vertices.extend_from_slice(vertices);
        Ok(())
    }

    /// The groups that have vertices, each vertex once.
    fn finish(mut self) -> Vec<MeshGroup> {
        for group in &mut self.groups {
            group.vertices.sort_unstable();
            group.vertices.dedup();
        }
        self.groups.retain(|group| !group.vertices.is_empty());
        self.groups
    }
}

/// The error of text or bytes that are not in the format.
fn malformed(sentence: impl Into<String>) -> Error {
    Error::new(Code::Syntax, sentence)
}
