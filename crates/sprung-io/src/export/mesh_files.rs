//! What formats have in common that write a mesh file for each frame.

use std::io;
use std::path::Path;

use sprung::Result;

use super::sequence::Sequence;
use super::{Export, Frame, Geometry, Mark, Options, Progress, RunInfo, Written};
use crate::files::PartialFile;

/// Writes the file of a frame, whose vertices the geometry has taken.
pub type Writer = Box<dyn FnMut(&mut PartialFile, &Geometry, &Frame<'_>) -> io::Result<()>>;

/// What a format is: given what stays the same in all frames of a run, how one of them is written.
pub type Format = fn(&RunInfo, &Options, &Geometry) -> Writer;

struct MeshFiles {
    files: Sequence,
    geometry: Geometry,
    write: Writer,
}

/// Begins the files of a run, or goes on with them where they were marked.
///
/// # Errors
/// As [`Geometry::of_meshes`], [`Sequence::begin`] and [`Mark::sequence_of`].
pub fn begin(
    path: &Path,
    run: &RunInfo,
    options: &Options,
    mark: Option<&Mark>,
    format: Format,
) -> Result<Box<dyn Export>> {
    let geometry = Geometry::of_meshes(run, options)?;
    let write = format(run, options, &geometry);
    let files = match mark {
        None => Sequence::begin(path)?,
        Some(mark) => mark.sequence_of(path)?,
    };
    Ok(Box::new(MeshFiles { files, geometry, write }))
}

impl Export for MeshFiles {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        let Self { files, geometry, write } = self;
        geometry.take(frame);
        files.write(frame.index, |out| write(out, geometry, frame)).map(drop)
    }

    fn finish(self: Box<Self>, _: &mut Progress<'_>) -> Result<Written> {
        self.files.finish()
    }

    fn mark(&mut self) -> Result<Mark> {
        Ok(Mark::of_sequence(&mut self.files))
    }
}
