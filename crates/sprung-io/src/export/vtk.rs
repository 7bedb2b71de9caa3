//! VTK: a `.pvd` file that lists every frame with its time, and beside it a folder with the frames' `.vtp` files.
//!
//! A frame is one or two of them. `points` holds the simulated points with `velocity`, `force`, `mass`, `fixed` and
//! `body`, and the springs as lines with `strain` and `tension`. `surface` holds the faces, where there are any, with
//! `velocity`, `normal` and `body`: they are apart, as a surface may have vertices that are no points, on which no force
//! acts.
//!
//! The collection grows with each whole frame. What ends it needs room too, which is set aside at the start.

use std::io::{self, Write};
use std::path::Path;

use sprung::{Code, Error, Result};

use super::vtp::Layer;
use super::{
    Estimate, Export, Exporter, Frame, Geometry, Heeds, Mark, Options, Progress, RunInfo, Springs, Writes,
    Written,
};
use crate::files::{File, Folder, PartialFile, spool_beside, write_error};
use crate::pack::{Pack, Unpack};

/// `.pvd`: for ParaView and everything else that is built on VTK.
pub const VTK: Exporter = Exporter {
    ending: "pvd",
    description: "for ParaView: springs with strain and tension, points with force and velocity, surfaces; a .vtp for \
                  each frame in a folder of that name",
    heeds: &[Heeds::Geometry, Heeds::Springs],
    writes: Writes::FileAndFolder,
    estimate,
    open,
    resume: Some(resume),
};

const HEAD: &str = "<?xml version=\"1.0\"?>\n\
                    <VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
const TAIL: &str = "</Collection>\n</VTKFile>\n";
/// Room on the disk that is set aside for the tail.
const RESERVE_BYTES: usize = 1 << 12;
/// Length of the attributes for time and file without the two names: at most, so that all entries have one length.
const ATTRIBUTES: usize = 70;

struct VtkExport {
    /// Dropped before their folder.
    layers: Vec<Layer>,
    folder: Folder,
    collection: PartialFile,
    /// The folder's name as it stands in the collection.
    name: String,
    reserve: File,
    frames: u64,
}

/// What the layers hold: the geometry of each, and its name.
fn geometries(run: &RunInfo, options: &Options) -> Result<Vec<(&'static str, Geometry)>> {
    // Lines always: ParaView draws them as tubes itself.
    let springs = match options.springs {
        Some(Springs::None) => Springs::None,
        _ => Springs::Lines,
    };
    let points = Geometry::new(run, &Options { points: true, ..options.clone() }, springs)?;
    let whole = Geometry::new(run, options, Springs::None)?;
    let with_surface = whole.parts().iter().filter(|part| !part.triangles.is_empty());
    let bodies: Vec<String> = with_surface.map(|part| part.name.clone()).collect();
    let mut layers = vec![("points", points)];
    if !bodies.is_empty() {
        let options = Options { bodies: Some(bodies), ..options.clone() };
        layers.push(("surface", Geometry::new(run, &options, Springs::None)?));
    }
    layers.iter().try_for_each(|(_, geometry)| Layer::check(geometry))?;
    Ok(layers)
}

fn open(path: &Path, run: &RunInfo, options: &Options) -> Result<Box<dyn Export>> {
    let geometries = geometries(run, options)?;
    let Some(name) = path.file_stem().and_then(|stem| stem.to_str()).filter(|name| is_xml(name)) else {
        let sentence = "cannot be written: its name stands in the file, and so must be Unicode text";
        let error = Error::new(Code::Unwritable, sentence).in_file(path.display().to_string());
        return Err(error.with_fix("give another name"));
    };
    let mut collection = PartialFile::create(path)?;
    let mut reserve = spool_beside(path)?;
    // Not zeros: some file systems take no room for those.
    let begun = reserve.write_all(&[0xA5; RESERVE_BYTES]);
    let begun = begun.and_then(|()| collection.write_all(HEAD.as_bytes())).and_then(|()| collection.commit());
    begun.map_err(|error| write_error(path, &error))?;
    let folder = Folder::make(&path.with_file_name(name))?;
    let layers = geometries
        .into_iter()
        .map(|(layer, geometry)| {
            Layer::begin(&folder.path().join(layer).with_extension("vtp"), run, geometry)
        })
        .collect::<Result<_>>()?;
    Ok(Box::new(VtkExport { layers, folder, collection, name: escaped(name), reserve, frames: 0 }))
}

fn resume(path: &Path, run: &RunInfo, options: &Options, mark: &Mark) -> Result<Box<dyn Export>> {
    let geometries = geometries(run, options)?;
    let Some(name) = path.file_stem().and_then(|stem| stem.to_str()) else { return Err(Mark::strange(path)) };
    let [file] = mark.files_of(path)?;
    let collection = PartialFile::resume(path, file)?;
    let mut reserve = spool_beside(path)?;
    reserve.write_all(&[0xA5; RESERVE_BYTES]).map_err(|error| write_error(path, &error))?;
    let folder = Folder::make(&path.with_file_name(name))?;
    let mut memory = Unpack::new(&mark.memory);
    let layers = geometries
        .into_iter()
        .map(|(layer, geometry)| {
            Layer::resume(&folder.path().join(layer).with_extension("vtp"), run, geometry, &mut memory)
        })
        .collect::<Result<_>>()?;
    memory.end()?;
    let name = escaped(name);
    Ok(Box::new(VtkExport { layers, folder, collection, name, reserve, frames: mark.frames }))
}

fn estimate(run: &RunInfo, options: &Options) -> Result<Estimate> {
    let mut bytes = (HEAD.len() + TAIL.len()) as u64;
    for (part, (name, geometry)) in geometries(run, options)?.into_iter().enumerate() {
        // But for the folder's name, which is not known here and short beside a frame.
        bytes += run.frames * (Layer::bytes(&geometry) + entry("", (part, name), 0, 0.0).len() as u64);
    }
    Ok(Estimate::About(bytes))
}

/// A frame of a layer in the collection.
fn entry(folder: &str, (part, layer): (usize, &str), frame: u64, time: f64) -> String {
    let width = ATTRIBUTES + folder.len() + layer.len();
    let attributes = format!("timestep=\"{time:?}\" file=\"{folder}/{layer}.{frame:04}.vtp\"");
    format!("<DataSet {attributes:<width$} group=\"\" part=\"{part}\" name=\"{layer}\"/>\n")
}

impl Export for VtkExport {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        let mut written = Vec::with_capacity(self.layers.len());
        let mut outcome = Ok(());
        for layer in &mut self.layers {
            match layer.write(frame) {
                Ok(bytes) => written.push(bytes),
                Err(error) => {
                    outcome = Err(error);
                    break;
                }
            }
        }
        let outcome = outcome
            .and_then(|()| self.list(frame).map_err(|error| write_error(self.collection.path(), &error)));
        if outcome.is_err() {
            // A frame is whole or it is not there.
            self.layers.iter_mut().zip(written).for_each(|(layer, bytes)| layer.take_back(bytes));
        } else {
            self.frames += 1;
        }
        outcome
    }

    fn finish(self: Box<Self>, _: &mut Progress<'_>) -> Result<Written> {
        let Self { layers, folder, mut collection, reserve, frames, .. } = *self;
        let path = collection.path().to_owned();
        drop(reserve);
        let tail = collection.roll_back().and_then(|()| collection.write_all(TAIL.as_bytes()));
        tail.map_err(|error| write_error(&path, &error))?;
        let mut bytes = 0;
        for layer in layers {
            bytes += layer.finish()?.bytes;
        }
        bytes += collection.finish()?;
        drop(folder); // goes if it is empty
        Ok(Written { path, bytes, frames })
    }

    fn mark(&mut self) -> Result<Mark> {
        let file = self.collection.mark("", 0);
        let file = file.map_err(|error| write_error(self.collection.path(), &error))?;
        let mut memory = Pack::new();
        self.layers.iter_mut().for_each(|layer| layer.mark(&mut memory));
        Ok(Mark { frames: self.frames, files: vec![file], memory: memory.into_bytes() })
    }
}

impl VtkExport {
    /// Adds a frame to the collection.
    fn list(&mut self, frame: &Frame<'_>) -> io::Result<()> {
        let (index, time) = (frame.index, frame.snapshot.time);
        let layers = self.layers.iter().map(Layer::name).enumerate();
        let entries: String = layers.map(|layer| entry(&self.name, layer, index, time)).collect();
        let added = self.collection.write_all(entries.as_bytes()).and_then(|()| self.collection.commit());
        if added.is_err() {
            self.collection.roll_back()?;
        }
        added
    }
}

/// Whether XML can hold a text: it knows no control characters, escaped or not.
fn is_xml(text: &str) -> bool {
    !text.chars().any(|c| c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}'))
}

/// A text as it stands in an attribute.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_entries_have_one_length() {
        let length = entry("a", (0, "points"), 0, 0.0).len();
        for (frame, time) in
            [(7, 0.07 * 7.0), (100_000_000, 1.234_567_890_123_456_7e-100), (1, 1e300), (2, 0.1 + 0.2)]
        {
            assert_eq!(entry("a", (0, "points"), frame, time).len(), length);
        }
    }
}
