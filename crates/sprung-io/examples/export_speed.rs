//! How fast each format is written, beside a plain copy of the bytes: a moving cloth of 100 by 100 points.
//!
//!     cargo run --release -p sprung-io --example export_speed -- FOLDER [FRAMES]
//!
//! The frames are made before the clock starts, and each format has three tries, of which the fastest counts. What is
//! written last stays in the folder, for other programs to write it again; see bench/usd_writer.py.

// Printing is what this program is for.
#![allow(clippy::print_stdout)]

use std::fs::File;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use sprung::{Material, ModelBuilder, Snapshot, SurfaceKind, Vec3};
use sprung_io::export::{CSV, GLB, MDD, NPZ, OBJ, PC2, PLY, USDA, USDC, USDZ, VTK};
use sprung_io::{Exporter, Frame, Options, RunInfo};

const SIDE: u32 = 100;
const TRIES: usize = 3;

fn main() -> sprung::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().unwrap_or_else(|| "target/export-speed".into());
    let frames: u64 = arguments.next().and_then(|frames| frames.parse().ok()).unwrap_or(200);
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder).map_err(|error| sprung_io::files::write_error(folder, &error))?;
    let run = cloth(frames)?;
    let snapshots: Vec<Snapshot> = (0..frames).map(snapshot).collect();

    println!("{:<6} {:>9} {:>9} {:>9}", "format", "MB", "MB/s", "frames/s");
    for exporter in [NPZ, CSV, USDC, USDZ, USDA, GLB, PC2, MDD, OBJ, PLY, VTK] {
        let mut best = Duration::MAX;
        let mut bytes = 0;
        for _ in 0..TRIES {
            let (taken, written) = write(exporter, folder, &run, &snapshots)?;
            best = best.min(taken);
            bytes = written;
        }
        row(exporter.ending, bytes, frames, best);
    }
    let copied = 1 << 28;
    let mut best = Duration::MAX;
    for _ in 0..TRIES {
        let path = folder.join("plain.bin");
        let taken = copy(&path, copied).map_err(|error| sprung_io::files::write_error(&path, &error))?;
        best = best.min(taken);
    }
    let floats = u64::from(SIDE * SIDE) * 12;
    row("plain", copied, copied / floats, best);
    Ok(())
}

fn row(name: &str, bytes: u64, frames: u64, taken: Duration) {
    let (megabytes, seconds) = (bytes as f64 / 1e6, taken.as_secs_f64());
    println!("{name:<6} {megabytes:>9.1} {:>9.0} {:>9.0}", megabytes / seconds, frames as f64 / seconds);
}

fn write(
    exporter: Exporter,
    folder: &Path,
    run: &RunInfo,
    snapshots: &[Snapshot],
) -> sprung::Result<(Duration, u64)> {
    let path = folder.join(format!("cloth.{}", exporter.ending));
    let begun = Instant::now();
    let mut export = (exporter.open)(&path, run, &Options::default())?;
    for (index, snapshot) in (0..).zip(snapshots) {
        export.frame(&Frame { index, snapshot, params: &run.params, energy: None })?;
    }
    let written = export.finish(&mut |_| ControlFlow::Continue(()))?;
    Ok((begun.elapsed(), written.bytes))
}

/// Writes so many bytes as they are, and waits for the disk as exporters do.
fn copy(path: &Path, bytes: u64) -> std::io::Result<Duration> {
    let piece = vec![0x5A; 1 << 16];
    let begun = Instant::now();
    let mut file = File::create(path)?;
    for _ in 0..bytes / piece.len() as u64 {
        file.write_all(&piece)?;
    }
    file.sync_all()?;
    let taken = begun.elapsed();
    std::fs::remove_file(path)?;
    Ok(taken)
}

fn cloth(frames: u64) -> sprung::Result<RunInfo> {
    let mut builder = ModelBuilder::new();
    builder.begin_body("cloth")?;
    for point in 0..SIDE * SIDE {
        builder.add_point(place(point, 0), 0.01)?;
    }
    let material = Material { stiffness: 100.0, damping: 0.1 };
    let mut triangles = Vec::new();
    for column in 0..SIDE - 1 {
        for row in 0..SIDE - 1 {
            let [a, b] = [column * SIDE + row, (column + 1) * SIDE + row];
            triangles.extend([[a, a + 1, b], [b, a + 1, b + 1]]);
            builder.add_spring(a as usize, b as usize, material)?;
            builder.add_spring(a as usize, a as usize + 1, material)?;
        }
    }
    builder.add_surface(SurfaceKind::Cloth, triangles)?;
    let (model, params, _) = builder.build()?;
    Ok(RunInfo {
        scene: "cloth".into(),
        title: "A cloth".into(),
        model: Arc::new(model),
        params,
        frame_time: 1.0 / 24.0,
        frames,
    })
}

fn place(point: u32, frame: u64) -> Vec3 {
    let (x, z) = ((point / SIDE) as f32 * 0.013, (point % SIDE) as f32 * 0.013);
    Vec3::new(x, ((x * 5.0 + frame as f32) * 0.7).sin() * (z * 3.0).cos(), z)
}

fn snapshot(frame: u64) -> Snapshot {
    let positions: Vec<Vec3> = (0..SIDE * SIDE).map(|point| place(point, frame)).collect();
    let velocities = positions.iter().map(|p| *p * 0.37 - Vec3::Y).collect();
    Snapshot { step: frame, time: frame as f64 / 24.0, positions, velocities }
}
