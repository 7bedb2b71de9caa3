//! Draws the four scenes, and two large ones, into a folder, to be looked at: `cargo run --release --example look FOLDER`.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "an example for people")]

#[path = "../tests/scenes/mod.rs"]
mod scenes;

use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use sprung::energy::{Energy, LedgerSums};
use sprung_io::{Frame, Options};
use sprung_render::export::exporter_for;

fn main() -> sprung::Result<()> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "look".to_owned());
    let only = std::env::args().nth(2).unwrap_or_default();
    let make = [
        ("spring.png", scenes::spring(30)),
        ("spring.gif", scenes::spring(30)),
        ("chain.png", scenes::chain(30)),
        ("jelly.png", scenes::jelly(10, 30)),
        ("jelly-early.png", scenes::jelly(10, 30)),
        ("jelly.gif", scenes::jelly(10, 60)),
        ("jelly.mp4", scenes::jelly(10, 60)),
        ("cloth.png", scenes::cloth(20, 30)),
        ("cloth.gif", scenes::cloth(20, 30)),
        ("jelly-large.png", scenes::jelly(40, 3)),
        ("cloth-large.png", scenes::cloth(256, 3)),
        ("small.png", scenes::jelly(10, 3)),
    ];
    for (name, motion) in make.iter().filter(|(name, _)| name.contains(&only)) {
        let path = Path::new(&folder).join(name);
        let begin = Instant::now();
        let mut options = Options::default();
        if name.contains("early") {
            options.at = Some(0.0);
        }
        if name.contains("small") {
            options.size = Some([320, 180]);
        }
        let mut output = match (exporter_for(&path)?.open)(&path, &motion.info, &options) {
            Ok(output) => output,
            Err(error) => {
                eprintln!("{error}");
                continue;
            }
        };
        for (index, snapshot) in motion.moments.iter().enumerate() {
            let params = &motion.info.params;
            output.frame(&Frame { index: index as u64, snapshot, params, energy: None })?;
        }
        let written = output.finish(&mut |_| ControlFlow::Continue(()))?;
        println!(
            "{}: {} bytes, {:.2} s",
            written.path.display(),
            written.bytes,
            begin.elapsed().as_secs_f64()
        );
    }
    for name in ["energy.svg", "energy.png"] {
        let plot = sprung_render::plot::EnergyPlot::begin(&Path::new(&folder).join(name))?;
        plot.finish("Energy of a mass on a spring", &energies())?;
    }
    Ok(())
}

/// A damped oscillation, and where its energy goes.
fn energies() -> Vec<(f64, Energy)> {
    let sample = |index: u32| {
        let time = f64::from(index) * 0.02;
        let left = 4200.0 * libm::exp(-0.35 * time);
        let (sin, cos) = libm::sincos(4.0 * time);
        let sums = LedgerSums {
            lost_in_dampers: 4150.0 - 0.99 * left,
            integrator_error: -0.01 * (4200.0 - left),
            ..LedgerSums::default()
        };
        (
            time,
            Energy {
                kinetic: left * sin * sin,
                elastic: 0.6 * left * cos * cos,
                gravitational: 0.4 * left * cos * cos,
                contact: 0.0,
                sums,
            },
        )
    };
    (0..400).map(sample).collect()
}
