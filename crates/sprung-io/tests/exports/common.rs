//! A small model and made-up frames of it, for the tests of exporters.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use sprung::{Material, ModelBuilder, Params, Result, Snapshot, Vec3};
use sprung_io::{Export, Exporter, Frame, Options, RunInfo};

/// A row of points, each joined to the next.
pub fn run_of(points: usize) -> RunInfo {
    let mut builder = ModelBuilder::new();
    for point in 0..points {
        builder.add_point(Vec3::X * point as f32, 0.5 + point as f32 / 3.0).expect("an ordinary point");
    }
    for point in 1..points {
        builder
            .add_spring(point - 1, point, Material { stiffness: 10.0, damping: 0.1 })
            .expect("an ordinary spring");
    }
    let (model, params, _) = builder.build().expect("an ordinary model");
    RunInfo {
        scene: "row".into(),
        title: "A row of points".into(),
        model: Arc::new(model),
        params,
        frame_time: 0.07,
        frames: 1000,
    }
}

/// A frame whose numbers use all their bits.
pub fn snapshot(points: usize, frame: u64) -> Snapshot {
    let number = |point: usize, salt: u32| {
        let mixed = (frame as u32 * 7919 + point as u32 * 31 + salt).wrapping_mul(0x9E37_79B9);
        f32::from_bits(mixed & 0xBFFF_FFFF) // finite, of any size below 2
    };
    let vector = |point: usize, salt: u32| {
        Vec3::new(number(point, salt), number(point, salt + 1), -number(point, salt + 2))
    };
    Snapshot {
        step: frame * 7,
        time: frame as f64 * 0.07,
        positions: (0..points).map(|point| vector(point, 1)).collect(),
        velocities: (0..points).map(|point| vector(point, 9)).collect(),
    }
}

/// Begins an output and gives it frames 0 … `frames` − 1.
pub fn begin(exporter: Exporter, path: &Path, run: &RunInfo, frames: u64) -> Result<Box<dyn Export>> {
    let mut export = (exporter.open)(path, run, &Options::default())?;
    for index in 0..frames {
        give(&mut *export, run, index)?;
    }
    Ok(export)
}

/// Gives an output one frame.
pub fn give(export: &mut dyn Export, run: &RunInfo, index: u64) -> Result<()> {
    let snapshot = snapshot(run.model.point_count(), index);
    let params: &Params = &run.params;
    export.frame(&Frame { index, snapshot: &snapshot, params, energy: None })
}

/// Progress that nobody breaks off.
pub fn to_the_end(_: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// The names of the files in a folder, sorted.
pub fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder is there");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}
