//! How fast each format is written, beside a plain copy of the same bytes.
//!
//! `cargo run --release -p sprung-io --example export_speed -- FOLDER [FRAMES]` writes some frames of the cloth of 512×512
//! points to every format that holds geometry. The folder decides which disk is measured; what is in it stays, for
//! `bench/exports.py` to measure other writers with.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::fs::{self, File};
use std::io::Write;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use sprung::Snapshot;
use sprung::scene::Scene;
use sprung_io::export::{CSV, GLB, MDD, NPZ, OBJ, PC2, PLY, USDA, USDC, USDZ, VTK};
use sprung_io::{Exporter, Frame, Options, RunInfo, Springs};

/// Each is measured so often, and the fastest counts.
const TIMES: u32 = 3;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().ok_or("give a folder to write to")?);
    let count: u64 = arguments.next().map_or(Ok(10), |frames| frames.parse())?;

    let mut simulation = Scene::builtin("cloth512")?.simulation()?;
    let mut snapshots = vec![simulation.snapshot().clone()];
    for _ in 1..count {
        simulation.frame()?;
        snapshots.push(simulation.snapshot().clone());
    }
    let run = RunInfo {
        scene: "cloth512".into(),
        title: "A cloth of 512 by 512 points".into(),
        model: Arc::clone(simulation.model()),
        params: simulation.params().clone(),
        frame_time: 1.0 / 24.0,
        frames: count,
    };

    println!("| format | MB/frame | frames/s | MB/s | copy, MB/s |\n|---|---:|---:|---:|---:|");
    let (default, alone) =
        (Options::default(), Options { springs: Some(Springs::None), ..Options::default() });
    for exporter in [PC2, MDD, NPZ, USDC, USDZ, USDA, GLB, PLY, OBJ, CSV, VTK] {
        measure(exporter, "", &folder, &run, &default, &snapshots)?;
    }
    measure(VTK, ", without springs", &folder, &run, &alone, &snapshots)
}

/// Writes the frames, then copies what was written, and prints a line of the table.
fn measure(
    exporter: Exporter,
    what: &str,
    folder: &Path,
    run: &RunInfo,
    options: &Options,
    snapshots: &[Snapshot],
) -> Result<(), Box<dyn Error>> {
    let folder = folder.join(format!("{}{}", exporter.ending, if what.is_empty() { "" } else { "-alone" }));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder)?;

    let (mut seconds, mut copy_seconds) = (f64::INFINITY, f64::INFINITY);
    let mut bytes = 0;
    for _ in 0..TIMES {
        let begun = Instant::now();
        let path = folder.join("cloth").with_extension(exporter.ending);
        let mut export = (exporter.open)(&path, run, options)?;
        for (snapshot, index) in snapshots.iter().zip(0..) {
            export.frame(&Frame { index, snapshot, params: &run.params, energy: None })?;
        }
        bytes = export.finish(&mut |_| ControlFlow::Continue(()))?.bytes;
        seconds = seconds.min(begun.elapsed().as_secs_f64());
    }

    // As the exporters do: each file is whole on the disk before it counts.
    let contents = files_below(&folder)?.into_iter().map(fs::read).collect::<Result<Vec<_>, _>>()?;
    let copies = folder.join("copies");
    for _ in 0..TIMES {
        fs::create_dir(&copies)?;
        let begun = Instant::now();
        for (number, content) in contents.iter().enumerate() {
            let mut file = File::create(copies.join(number.to_string()))?;
            file.write_all(content)?;
            file.sync_all()?;
        }
        copy_seconds = copy_seconds.min(begun.elapsed().as_secs_f64());
        fs::remove_dir_all(&copies)?;
    }

    let (megabytes, frames) = (bytes as f64 / 1e6, snapshots.len() as f64);
    println!(
        "| `.{}`{what} | {:.1} | {:.1} | {:.0} | {:.0} |",
        exporter.ending,
        megabytes / frames,
        frames / seconds,
        megabytes / seconds,
        megabytes / copy_seconds,
    );
    Ok(())
}

fn files_below(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() { files.extend(files_below(&path)?) } else { files.push(path) }
    }
    Ok(files)
}
