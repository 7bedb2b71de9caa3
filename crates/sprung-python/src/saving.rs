//! A simulation as a picture, as bytes, and as a checkpoint.

use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use sprung::{Code, Error, Result};
use sprung_io::checkpoint::{self, Saved, Stored};
use sprung_io::{Pack, PartialFile};
use sprung_render::export::write_png;
use sprung_render::{Motion, Quality, SceneView};

use crate::errors::raised;
use crate::simulation::{Inner, Simulation};

#[pymethods]
impl Simulation {
    /// A picture of it now, of so many pixels, as the bytes of a PNG.
    ///
    /// >>> import sprung
    /// >>> jelly = sprung.scene("jelly").simulation()
    /// >>> jelly.picture(160, 90).startswith(b"\x89PNG")
    /// True
    fn picture<'py>(&self, py: Python<'py>, width: u32, height: u32) -> PyResult<Bound<'py, PyBytes>> {
        let mut guard = self.lock(py);
        let inner = &mut *guard;
        let picture = py.detach(|| inner.picture([width, height])).map_err(raised)?;
        Ok(PyBytes::new(py, &picture))
    }

    /// All of it but where it came from, as bytes.
    #[pyo3(name = "_pack")]
    fn pack<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let mut guard = self.lock(py);
        let inner = &mut *guard;
        let bytes = py.detach(|| packed(&inner.saved())).map_err(raised)?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Writes a checkpoint.
    #[pyo3(name = "_save_checkpoint")]
    fn save_checkpoint(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let mut guard = self.lock(py);
        let inner = &mut *guard;
        py.detach(|| inner.save(&path)).map_err(raised)
    }
}

/// Of a checkpoint: the name of its scene, the scene as [`Scene`] packs it, and the simulation as [`Simulation`] does.
#[pyfunction]
pub fn read_checkpoint<'py>(
    py: Python<'py>,
    path: PathBuf,
) -> PyResult<(String, Bound<'py, PyBytes>, Bound<'py, PyBytes>)> {
    let read = || -> Result<(String, Vec<u8>, Vec<u8>)> {
        let saved = Stored::open(&path)?.read(&sprung_cli::memory::check)?;
        // Looked over here, where the file's name is at hand.
        let resumed = saved.resume(&sprung_cli::memory::check);
        resumed.map_err(|error| error.in_file(path.display().to_string()))?;
        let mut scene = Pack::new();
        scene.text(&saved.scene).meshes(&saved.meshes);
        Ok((saved.scene_name.clone(), scene.into_bytes(), packed(&saved)?))
    };
    let (name, scene, simulation) = py.detach(read).map_err(raised)?;
    Ok((name, PyBytes::new(py, &scene), PyBytes::new(py, &simulation)))
}

/// What is saved, as bytes.
fn packed(saved: &Saved) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let written = saved.write_to(&mut bytes);
    written.map_err(|error| Error::new(Code::TooLarge, format!("cannot be packed: {error}")))?;
    Ok(bytes)
}

/// The same the other way round.
pub fn unpacked(bytes: &[u8]) -> Result<Saved> {
    Saved::read_from(&mut &*bytes, bytes.len() as u64)
}

impl Inner {
    fn saved(&mut self) -> Saved {
        let checkpoint = self.simulation.checkpoint();
        match &self.scene {
            Some(scene) => Saved::of(&self.name, scene, self.simulation.model(), checkpoint),
            None => Saved {
                program: env!("CARGO_PKG_VERSION").to_owned(),
                scene_name: self.name.clone(),
                scene: String::new(),
                meshes: Vec::new(),
                fingerprint: self.simulation.model().fingerprint(),
                checkpoint,
                recording: None,
            },
        }
    }

    fn save(&mut self, path: &Path) -> Result<()> {
        let named = |error: Error| error.in_file(path.display().to_string());
        if self.scene.is_none() {
            let sentence = "a checkpoint holds a scene, and this simulation is of a model made of arrays";
            return Err(named(Error::new(Code::Unsupported, sentence).with_fix("use pickle")));
        }
        if !checkpoint::is_name(path) {
            return Err(named(Error::new(
                Code::Unsupported,
                "is no name for a checkpoint; they end in .sprung",
            )));
        }
        let mut file = PartialFile::create(path)?;
        let saved = self.saved();
        let failed = |error: std::io::Error| sprung_io::files::write_error(path, &error);
        saved.write_to(&mut file).map_err(failed)?;
        file.finish().map(|_| ())
    }

    fn picture(&mut self, size: [u32; 2]) -> Result<Vec<u8>> {
        let range = sprung_render::export::SIZE_RANGE;
        if !size.iter().all(|side| range.contains(side)) {
            let sentence = format!(
                "is {}x{}, and width and height must be from {} to {} pixels",
                size[0],
                size[1],
                range.start(),
                range.end()
            );
            return Err(Error::new(Code::OutOfRange, sentence).at_field("size"));
        }
        let info = self.info(self.simulation.params().dt, 1);
        let (_, time) = self.simulation.now();
        let positions = &self.simulation.snapshot().positions;
        let mut motion = Motion::new(&info, size);
        motion.include(&info.model, &info.params, positions);
        let view = SceneView::new(&info, &motion, Quality::Still);
        let image = view.picture(&info.params, time, positions);
        let mut bytes = Vec::new();
        write_png(&mut bytes, &image).map_err(|error| {
            Error::new(Code::Unwritable, format!("the picture cannot be packed: {error}"))
        })?;
        Ok(bytes)
    }
}
