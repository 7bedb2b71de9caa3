//! Scenes: a name, a text, a file or another scene in, with changes by key.

use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use sprung::scene::{self as scenes, BUILTIN, Kind};
use sprung::{Code, Error, Result};
use sprung_io::{Pack, Unpack, files, import, link};

use crate::errors::raised;

/// Name, title and kind of every scene that comes with the engine.
pub fn builtin() -> Vec<(&'static str, String, &'static str)> {
    let entry = |builtin: &scenes::Builtin| {
        let kind = match builtin.kind {
            Kind::Report => "report",
            Kind::Gallery => "gallery",
            Kind::Benchmark => "benchmark",
        };
        let title = scenes::Scene::builtin(builtin.name).map(|scene| scene.title).unwrap_or_default();
        (builtin.name, title, kind)
    };
    BUILTIN.iter().map(entry).collect()
}

/// A scene and the name it goes by. It never changes.
#[pyclass(frozen, subclass, module = "sprung._engine")]
pub struct Scene {
    /// The name it goes by.
    ///
    /// >>> import sprung
    /// >>> sprung.scene("jelly").name
    /// 'jelly'
    #[pyo3(get)]
    pub name: String,
    pub scene: scenes::Scene,
    /// What is odd about its meshes, a sentence each.
    ///
    /// >>> import sprung
    /// >>> sprung.scene("jelly").warnings
    /// []
    #[pyo3(get)]
    warnings: Vec<String>,
}

#[pymethods]
impl Scene {
    /// One of `text`, `file`, `origin` and `packed`, or else a scene that is built in; then changed key by key.
    #[new]
    #[pyo3(signature = (name, *, text=None, file=None, folder=None, origin=None, packed=None, changes=Vec::new()))]
    #[allow(clippy::too_many_arguments, reason = "called by our own Python")]
    fn new(
        py: Python<'_>,
        name: String,
        text: Option<&str>,
        file: Option<PathBuf>,
        folder: Option<PathBuf>,
        origin: Option<PyRef<'_, Self>>,
        packed: Option<&[u8]>,
        changes: Vec<(String, String)>,
    ) -> PyResult<Self> {
        let (scene, beside): (Result<scenes::Scene>, Option<PathBuf>) = match (text, &file, origin, packed) {
            (Some(text), ..) => {
                (scenes::Scene::parse(text, &name), folder.map(|folder| folder.join("scene.toml")))
            }
            (_, Some(path), ..) => (read(path), file.clone()),
            (.., Some(origin), _) => (Ok(origin.scene.clone()), None),
            (.., Some(bytes)) => (unpacked(&name, bytes), None),
            _ => (scenes::Scene::builtin(&name), None),
        };
        py.detach(|| {
            let mut scene = scene?;
            changes.iter().try_for_each(|(key, value)| scene.set(key, value))?;
            let warnings = if scene.waits_for_meshes() {
                import::load_meshes(&mut scene, beside.as_deref())?
            } else {
                scene.mesh_warnings()
            };
            Ok(Self { name, scene, warnings })
        })
        .map_err(raised)
    }

    /// What it shows, in a few words.
    ///
    /// >>> import sprung
    /// >>> sprung.scene("spring").title
    /// 'A mass on a spring'
    #[getter]
    fn title(&self) -> &str {
        &self.scene.title
    }

    /// What to look at.
    ///
    /// >>> import sprung
    /// >>> print(sprung.scene("spring").description)
    /// One point hangs on a spring from a fixed point and is pushed sideways: it swings, bounces and slowly comes to rest.
    #[getter]
    fn description(&self) -> &str {
        &self.scene.description
    }

    /// As the text of a scene file.
    ///
    /// >>> import sprung
    /// >>> text = sprung.scene("jelly").to_toml()
    /// >>> sprung.Scene.from_toml(text).simulation().spring_count
    /// 7560
    fn to_toml(&self) -> String {
        self.scene.to_toml()
    }

    /// As a link has it behind the `#`.
    #[pyo3(name = "_link")]
    fn link(&self) -> PyResult<String> {
        let made = || {
            link::check_scene(&self.scene)?;
            let version = env!("CARGO_PKG_VERSION");
            let made = format!("v={version}&{}", link::parts(&self.name, &self.scene.to_toml()));
            link::check_length(&made).map(|()| made)
        };
        made().map_err(raised)
    }

    /// Its text and its meshes.
    #[pyo3(name = "_pack")]
    fn pack<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        let mut pack = Pack::new();
        pack.text(&self.scene.to_toml()).meshes(&self.scene.meshes());
        PyBytes::new(py, &pack.into_bytes())
    }
}

impl Scene {
    /// The simulation of it, if there is room.
    pub fn simulation(&self) -> Result<sprung::Simulation> {
        self.scene.check_spring_count()?;
        let room = sprung_cli::memory::check(self.scene.estimated_bytes(), "the scene");
        room.map_err(|error| error.with_fix("use fewer points or a smaller radius"))?;
        self.scene.simulation()
    }
}

/// A scene from the bytes that [`Scene::pack`] gives.
fn unpacked(name: &str, bytes: &[u8]) -> Result<scenes::Scene> {
    let mut unpack = Unpack::new(bytes);
    let mut scene = scenes::Scene::parse(unpack.text()?, name)?;
    scene.take_meshes(&unpack.meshes()?)?;
    unpack.end()?;
    Ok(scene)
}

fn read(path: &Path) -> Result<scenes::Scene> {
    let bytes = files::read_or_take(path, scenes::MAX_BYTES)?;
    scenes::Scene::from_bytes(&bytes, &path.display().to_string())
}

/// The text of a scene file from JSON.
#[pyfunction]
pub fn toml_of(json: &str) -> PyResult<String> {
    let value: serde_json::Value = serde_json::from_str(json)
        .map_err(|error| raised(Error::new(Code::Syntax, format!("is no JSON: {error}"))))?;
    toml::to_string(&value).map_err(|error| {
        // Of what JSON can hold, TOML has no word for nothing.
        let sentence = match error.to_string() {
            said if said.contains("unit type") => {
                "holds None, and must hold numbers, texts, lists and dictionaries".to_owned()
            }
            said => format!("cannot be a scene: {said}"),
        };
        raised(Error::new(Code::WrongType, sentence).at_field("content"))
    })
}
