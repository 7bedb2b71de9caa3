//! Universal Scene Description: the motion of meshes, points and curves, for Blender, Houdini, Unreal, Maya and others.
//!
//! A [`Scene`](scene::Scene) turns frames into columns of vectors, and a [`Layer`](layer::Layer) says what they mean. How
//! these become a file is the business of [`binary`] and [`text`], neither of which keeps a frame in memory.

mod binary;
mod coding;
mod crate_file;
mod layer;
mod package;
mod scene;
mod text;

use std::path::Path;

use sprung::{Code, Error, Result};

use self::binary::Binary;
use self::layer::{Layer, Span};
use self::package::Package;
use self::scene::Scene;
use self::text::Text;
use super::{Estimate, Export, Exporter, Frame, Heeds, Mark, Options, Progress, RunInfo, Writes, Written};
use crate::files::write_error;

/// `.usdc`: USD in its binary form.
pub const USDC: Exporter = Exporter {
    ending: "usdc",
    description: "USD, binary: meshes, points and curves that move, for Blender, Houdini, Unreal, Maya",
    heeds: HEEDS,
    writes: Writes::File,
    estimate: |run, options| Ok(Estimate::Exact(binary::bytes(&layer(run, options)?, None, run.frames))),
    open: |path, run, options| begin(path, run, options, None, Form::crate_file),
    resume: Some(|path, run, options, mark| begin(path, run, options, Some(mark), Form::crate_file)),
};

/// `.usda`: USD as text.
pub const USDA: Exporter = Exporter {
    ending: "usda",
    description: "USD as text: the same, to be read by people; several times as large",
    heeds: HEEDS,
    writes: Writes::File,
    estimate: |run, options| Ok(Estimate::About(text::bytes(&layer(run, options)?, run.frames))),
    open: |path, run, options| begin(path, run, options, None, Form::text),
    resume: Some(|path, run, options, mark| begin(path, run, options, Some(mark), Form::text)),
};

/// `.usdz`: an archive with the binary form in it.
pub const USDZ: Exporter = Exporter {
    ending: "usdz",
    description: "USD as a package, for phones and the web; at most 4 GiB",
    heeds: HEEDS,
    writes: Writes::File,
    estimate: estimate_package,
    open: |path, run, options| begin(path, run, options, None, Form::package),
    resume: Some(|path, run, options, mark| begin(path, run, options, Some(mark), Form::package)),
};

const HEEDS: &[Heeds] = &[Heeds::Geometry, Heeds::Springs];

struct UsdExport {
    scene: Scene,
    layer: Layer,
    form: Form,
}

enum Form {
    Binary(Binary),
    Text(Text),
}

/// Begins a file, or goes on with one where it was marked.
type Begin = fn(&Path, &Layer, u64, &Options, Option<&Mark>) -> Result<Form>;

impl Form {
    fn crate_file(path: &Path, layer: &Layer, _: u64, _: &Options, mark: Option<&Mark>) -> Result<Self> {
        Self::binary(path, layer, None, mark)
    }

    fn package(path: &Path, layer: &Layer, frames: u64, _: &Options, mark: Option<&Mark>) -> Result<Self> {
        package_bytes(layer, frames)?;
        Self::binary(path, layer, Some(package_of(layer)), mark)
    }

    fn binary(path: &Path, layer: &Layer, package: Option<Package>, mark: Option<&Mark>) -> Result<Self> {
        let binary = match mark {
            None => Binary::create(path, layer, package),
            Some(mark) => Binary::resume(path, layer, package, mark),
        };
        binary.map(Self::Binary)
    }

    fn text(path: &Path, layer: &Layer, _: u64, options: &Options, mark: Option<&Mark>) -> Result<Self> {
        let text = match mark {
            None => Text::create(path, layer, options.resumable),
            Some(mark) => Text::resume(path, layer, mark),
        };
        text.map(Self::Text)
    }

    /// The frames that are in it.
    fn span(&self) -> Span {
        match self {
            Self::Binary(binary) => binary.span(),
            Self::Text(text) => text.span(),
        }
    }

    fn path(&self) -> &Path {
        match self {
            Self::Binary(binary) => binary.path(),
            Self::Text(text) => text.path(),
        }
    }
}

fn layer(run: &RunInfo, options: &Options) -> Result<Layer> {
    Scene::new(run, options).map(|(_, layer)| layer)
}

fn package_of(layer: &Layer) -> Package {
    Package::new(format!("{}.usdc", layer.root.name))
}

fn estimate_package(run: &RunInfo, options: &Options) -> Result<Estimate> {
    package_bytes(&layer(run, options)?, run.frames).map(Estimate::Exact)
}

/// How long a package with so many frames is, if it may be.
fn package_bytes(layer: &Layer, frames: u64) -> Result<u64> {
    let bytes = binary::bytes(layer, Some(&package_of(layer)), frames);
    if bytes > package::MOST_CONTENT_BYTES {
        let gibibytes = bytes as f64 / f64::from(1 << 30);
        let sentence = format!("would take {gibibytes:.1} GiB, and a .usdz holds at most 4 GiB");
        return Err(Error::new(Code::TooLarge, sentence).with_fix("write a .usdc, which may be of any size"));
    }
    Ok(bytes)
}

fn begin(
    path: &Path,
    run: &RunInfo,
    options: &Options,
    mark: Option<&Mark>,
    begin: Begin,
) -> Result<Box<dyn Export>> {
    let (scene, layer) = Scene::new(run, options)?;
    let form = begin(path, &layer, run.frames, options, mark)?;
    Ok(Box::new(UsdExport { scene, layer, form }))
}

impl Export for UsdExport {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        // Time codes count up by one, from the first frame.
        let expected = self.form.span().next().unwrap_or(frame.index);
        if frame.index != expected {
            let sentence = format!("frame {expected} was to follow, and frame {} came", frame.index);
            let file = self.form.path().display().to_string();
            return Err(Error::new(Code::Conflict, sentence).in_file(file));
        }
        let columns = self.scene.columns(frame);
        match &mut self.form {
            Form::Binary(binary) => binary.frame(frame.index, columns),
            Form::Text(text) => text.frame(frame.index, columns),
        }
    }

    fn finish(self: Box<Self>, progress: &mut Progress<'_>) -> Result<Written> {
        let path = self.form.path().to_owned();
        let (bytes, frames) = match self.form {
            Form::Binary(binary) => binary.finish(&self.layer)?,
            Form::Text(text) => text.finish(&self.layer, progress)?,
        };
        Ok(Written { path, bytes, frames })
    }

    fn mark(&mut self) -> Result<Mark> {
        let marked = match &mut self.form {
            Form::Binary(binary) => binary.mark(),
            Form::Text(text) => text.mark(),
        };
        marked.map_err(|error| write_error(self.form.path(), &error))
    }
}
