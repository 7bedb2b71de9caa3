//! Scenes with their meshes, kept simulations, and what a driver begins with.

use sprung::scene::{Provenance, Scene};
use sprung::{Error, Result};
use sprung_io::{Pack, Unpack};

use crate::command::{Beginning, Source};
use crate::kept::{Kept, Running};
use crate::options::Options;

use super::{Wire, damaged, structs};

structs! {
    Source { name, scene }
}

impl Wire for Scene {
    fn write(&self, pack: &mut Pack) {
        pack.text(&self.to_toml()).meshes(&self.meshes());
        let from = self.provenance();
        from.is_some().write(pack);
        if let Some(Provenance { file, text, set }) = from {
            pack.text(&file).text(&text);
            set.write(pack);
        }
    }

    fn read(read: &mut Unpack<'_>) -> Result<Self> {
        let mut scene = Self::parse(read.text()?, "the scene in a message")?;
        let meshes = read.meshes()?;
        scene.take_meshes(&meshes)?;
        let from = if bool::read(read)? {
            let (file, text) = (read.text()?.to_owned(), read.text()?.into());
            Some(Provenance { file, text, set: Vec::read(read)? })
        } else {
            None
        };
        Ok(scene.with_provenance(from))
    }
}

/// The bytes of a checkpoint, or why there are none: then that is what bringing it comes to.
impl Wire for Kept {
    fn write(&self, pack: &mut Pack) {
        let bytes = self.to_bytes(&Options::default());
        pack.text(&self.name);
        bytes.as_ref().err().cloned().write(pack);
        if let Ok(bytes) = bytes {
            pack.bytes(&bytes);
        }
    }

    fn read(read: &mut Unpack<'_>) -> Result<Self> {
        let name = read.text()?.to_owned();
        Ok(match Option::<Error>::read(read)? {
            Some(error) => Self::elsewhere(name, move |_| Err(error.clone())),
            None => Self::in_bytes(name, read.bytes()?),
        })
    }
}

/// All that a driver at the other end begins with, but for threads.
pub(crate) struct Start {
    pub beginning: Beginning,
    pub options: Options,
}

impl Start {
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        let Self { beginning, options } = self;
        let Options { history_bytes, memory_limit, workers: _, settle } = options;
        let mut pack = Pack::new();
        pack.text(env!("CARGO_PKG_VERSION"));
        history_bytes.write(&mut pack);
        memory_limit.write(&mut pack);
        settle.write(&mut pack);
        match beginning {
            Beginning::Scene(source) => {
                pack.u8(0);
                source.write(&mut pack);
            }
            Beginning::Running(running) => {
                pack.u8(1).bytes(&running.to_bytes()?);
            }
        }
        Ok(pack.into_bytes())
    }

    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let mut read = Unpack::new(bytes);
        let (theirs, ours) = (read.text()?, env!("CARGO_PKG_VERSION"));
        if theirs != ours {
            return Err(damaged(&format!("is of version {theirs}, and is read by version {ours}"))
                .with_fix("load the page anew"));
        }
        let options = Options {
            history_bytes: Wire::read(&mut read)?,
            memory_limit: Wire::read(&mut read)?,
            settle: Wire::read(&mut read)?,
            ..Options::default()
        };
        let beginning = match read.u8()? {
            0 => Source::read(&mut read)?.into(),
            1 => Running::from_bytes(read.bytes()?, &options)?.into(),
            _ => return Err(damaged("begins with something that there is not")),
        };
        read.end()?;
        Ok(Self { beginning, options })
    }
}
