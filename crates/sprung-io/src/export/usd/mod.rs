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
use self::layer::Layer;
use self::package::Package;
use self::scene::Scene;
use self::text::Text;
use super::{Estimate, Export, Exporter, Frame, Heeds, Options, Progress, RunInfo, Written};

/// `.usdc`: USD in its binary form.
pub const USDC: Exporter = Exporter {
    ending: "usdc",
    description: "USD, binary: meshes, points and curves that move, for Blender, Houdini, Unreal, Maya",
    heeds: HEEDS,
    estimate: |run, options| Ok(Estimate::Exact(binary::bytes(&layer(run, options)?, None, run.frames))),
    open: |path, run, options| open(path, run, options, Form::crate_file),
    resume: None,
};

/// `.usda`: USD as text.
pub const USDA: Exporter = Exporter {
    ending: "usda",
    description: "USD as text: the same, to be read by people; several times as large",
    heeds: HEEDS,
    estimate: |run, options| Ok(Estimate::About(text::bytes(&layer(run, options)?, run.frames))),
    open: |path, run, options| open(path, run, options, Form::text),
    resume: None,
};

/// `.usdz`: an archive with the binary form in it.
pub const USDZ: Exporter = Exporter {
    ending: "usdz",
    description: "USD as a package, for phones and the web; at most 4 GiB",
    heeds: HEEDS,
    estimate: estimate_package,
    resume: None,
    open: |path, run, options| {
        estimate_package(run, options)?;
        open(path, run, options, Form::package)
    },
};

const HEEDS: &[Heeds] = &[Heeds::Geometry, Heeds::Springs];

struct UsdExport {
    scene: Scene,
    layer: Layer,
    form: Form,
    /// The number that the next frame must have, once there was one.
    next: Option<u64>,
}

enum Form {
    Binary(Binary),
    Text(Text),
}

impl Form {
    fn crate_file(path: &Path, layer: &Layer) -> Result<Self> {
        Binary::create(path, layer, None).map(Self::Binary)
    }

    fn package(path: &Path, layer: &Layer) -> Result<Self> {
        Binary::create(path, layer, Some(package_of(layer))).map(Self::Binary)
    }

    fn text(path: &Path, layer: &Layer) -> Result<Self> {
        Text::create(path, layer).map(Self::Text)
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
    let layer = layer(run, options)?;
    let bytes = binary::bytes(&layer, Some(&package_of(&layer)), run.frames);
    if bytes > package::MOST_CONTENT_BYTES {
        let gibibytes = bytes as f64 / f64::from(1 << 30);
        let sentence = format!("would take {gibibytes:.1} GiB, and a .usdz holds at most 4 GiB");
        return Err(Error::new(Code::TooLarge, sentence).with_fix("write a .usdc, which may be of any size"));
    }
    Ok(Estimate::Exact(bytes))
}

fn open(
    path: &Path,
    run: &RunInfo,
    options: &Options,
    begin: fn(&Path, &Layer) -> Result<Form>,
) -> Result<Box<dyn Export>> {
    let (scene, layer) = Scene::new(run, options)?;
    let form = begin(path, &layer)?;
    Ok(Box::new(UsdExport { scene, layer, form, next: None }))
}

impl Export for UsdExport {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<()> {
        // Time codes count up by one, from the first frame.
        let expected = self.next.unwrap_or(frame.index);
        if frame.index != expected {
            let sentence = format!("frame {expected} was to follow, and frame {} came", frame.index);
            let file = self.form.path().display().to_string();
            return Err(Error::new(Code::Conflict, sentence).in_file(file));
        }
        let columns = self.scene.columns(frame);
        match &mut self.form {
            Form::Binary(binary) => binary.frame(frame.index, columns)?,
            Form::Text(text) => text.frame(frame.index, columns)?,
        }
        self.next = Some(expected + 1);
        Ok(())
    }

    fn finish(self: Box<Self>, progress: &mut Progress<'_>) -> Result<Written> {
        let path = self.form.path().to_owned();
        let (bytes, frames) = match self.form {
            Form::Binary(binary) => binary.finish(&self.layer)?,
            Form::Text(text) => text.finish(&self.layer, progress)?,
        };
        Ok(Written { path, bytes, frames })
    }
}
