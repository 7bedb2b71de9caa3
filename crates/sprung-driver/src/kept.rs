//! A simulation that is kept somewhere, to go on with.

use std::fmt;
use std::sync::Arc;

use sprung::scene::Scene;
use sprung::{Code, Error, Params, Result, Simulation};
use sprung_io::checkpoint::{Resumed, Saved};

use crate::options::Options;

/// A simulation that is under way, to go on with.
#[derive(Clone)]
pub struct Running {
    /// What to call its scene.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// The scene's own parameters.
    pub params: Arc<Params>,
    /// The simulation, of a model that the scene was built into.
    pub simulation: Simulation,
}

impl Running {
    /// What goes on with a checkpoint that was read.
    ///
    /// # Errors
    /// If its scene cannot be built, or the two do not fit each other.
    pub fn from_saved(saved: Saved, options: &Options) -> Result<Self> {
        let Resumed { scene, params, simulation } =
            saved.resume(&|needed, what| options.check_memory(needed, what))?;
        Ok(Self { name: saved.scene_name, scene, params: Arc::new(params), simulation })
    }

    /// What goes on with a checkpoint file of these bytes.
    ///
    /// # Errors
    /// As [`Saved::read_from`] and [`from_saved`](Self::from_saved).
    pub fn from_bytes(bytes: &[u8], options: &Options) -> Result<Self> {
        Self::from_saved(Saved::read_from(&mut &*bytes, bytes.len() as u64)?, options)
    }

    /// The bytes of a checkpoint file of it.
    ///
    /// # Errors
    /// None that a valid simulation causes.
    pub(crate) fn to_bytes(&self) -> Result<Vec<u8>> {
        let saved = Saved::new(&self.name, &self.scene, &mut self.simulation.clone());
        let mut bytes = Vec::new();
        let failed = |error| Error::new(Code::Unsupported, format!("cannot be handed on: {error}"));
        saved.write_to(&mut bytes).map_err(failed)?;
        Ok(bytes)
    }
}

/// Brings a simulation.
type Bring = dyn Fn(&Options) -> Result<Running> + Send + Sync;

/// A simulation that is kept somewhere, such as in a file.
#[derive(Clone)]
pub struct Kept {
    /// What to call it until it is there.
    pub name: String,
    place: Place,
}

/// Where it is kept.
#[derive(Clone)]
enum Place {
    /// Where somebody else knows.
    Elsewhere(Arc<Bring>),
    /// Here, as the bytes of a checkpoint file.
    Here(Arc<[u8]>),
}

impl Kept {
    /// One that somebody else knows how to bring. As that may take a while, the driver asks for it where it works itself; the
    /// options say how much memory may be taken.
    pub fn elsewhere(
        name: impl Into<String>,
        bring: impl Fn(&Options) -> Result<Running> + Send + Sync + 'static,
    ) -> Self {
        Self { name: name.into(), place: Place::Elsewhere(Arc::new(bring)) }
    }

    /// A checkpoint file of this name and these bytes.
    pub fn in_bytes(name: impl Into<String>, bytes: impl Into<Arc<[u8]>>) -> Self {
        Self { name: name.into(), place: Place::Here(bytes.into()) }
    }

    /// Brings it.
    ///
    /// # Errors
    /// If it cannot be gone on with.
    pub fn bring(&self, options: &Options) -> Result<Running> {
        match &self.place {
            Place::Elsewhere(bring) => bring(options),
            Place::Here(bytes) => {
                Running::from_bytes(bytes, options).map_err(|error| error.in_file(&self.name))
            }
        }
    }

    /// The same, kept here; or, if it cannot be brought, one that cannot for the same reason.
    pub(crate) fn brought(&self, options: &Options) -> Self {
        match self.to_bytes(options) {
            Ok(bytes) => Self::in_bytes(&*self.name, bytes),
            Err(error) => Self::elsewhere(&*self.name, move |_| Err(error.clone())),
        }
    }

    /// The bytes of a checkpoint file of it.
    ///
    /// # Errors
    /// As [`bring`](Self::bring), if they are not here yet.
    pub(crate) fn to_bytes(&self, options: &Options) -> Result<Arc<[u8]>> {
        match &self.place {
            Place::Elsewhere(bring) => Ok(bring(options)?.to_bytes()?.into()),
            Place::Here(bytes) => Ok(bytes.clone()),
        }
    }
}

impl fmt::Debug for Kept {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Kept").field("name", &self.name).finish_non_exhaustive()
    }
}
