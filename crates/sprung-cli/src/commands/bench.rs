//! `sprung bench`: nanoseconds per spring and step.

use std::process::{Command, Stdio};
use std::time::Instant;

use serde::{Deserialize, Serialize};
use sprung::scene::{BUILTIN, Kind};
use sprung::{Code, Error, PATIENCE, Result, Simulation, Vec3};

use crate::args::{BenchArgs, SceneArgs};
use crate::console::{grouped, say};
use crate::{memory, source};

/// Every point that can move starts with noise up to this speed along each axis, m/s: a scene at rest tells nothing.
const NOISE: f32 = 0.1;

/// Runs of which the fastest counts; machines are noisy, and noise only ever slows.
const REPEATS: usize = 5;

/// Springs evaluated in each run, in all; or somewhat more, so that every run has as many looks at the energy.
const STEPS_TIMES_SPRINGS: u64 = 20_000_000;

/// One scene's figures.
#[derive(Serialize, Deserialize)]
struct Figures {
    scene: String,
    points: usize,
    springs: usize,
    /// Steps in each of the repeated runs.
    steps: u64,
    threads: usize,
    /// `null` for a scene without springs.
    ns_per_spring_step: Option<f64>,
    steps_per_second: f64,
    /// From the scene's text to the first step.
    setup_s: f64,
    /// The most memory the process has held; `null` where the system does not tell.
    peak_mb: Option<f64>,
}

/// Measures and prints.
pub fn run(args: &BenchArgs) -> Result<()> {
    let scenes: Vec<&str> = match &args.scenes[..] {
        [] => {
            let measured = BUILTIN.iter().filter(|builtin| builtin.kind != Kind::Gallery);
            measured.map(|builtin| builtin.name).collect()
        }
        scenes => scenes.iter().map(String::as_str).collect(),
    };
    // What is wrong with a scene is said before anything is measured.
    for scene in &scenes {
        source::scene(&SceneArgs { scene: (*scene).to_owned(), set: Vec::new() })?;
    }
    if !args.json {
        say(format_args!(
            "{:<12} {:>9} {:>10} {:>8} {:>8} {:>14} {:>12} {:>9} {:>9}",
            "scene",
            "points",
            "springs",
            "steps",
            "threads",
            "ns/spring/step",
            "steps/s",
            "set-up s",
            "peak MB"
        ));
    }
    let threads = args.threads.unwrap_or_else(source::processors);
    if let [scene] = scenes[..] {
        print(&measure(scene, threads)?, args.json);
        return Ok(());
    }
    // A process for each, as the peak of memory is a process's.
    for scene in scenes {
        print(&measure_apart(scene, threads)?, args.json);
    }
    Ok(())
}

fn measure_apart(scene: &str, threads: usize) -> Result<Figures> {
    let failed = |reason: String| Error::new(Code::Unsupported, format!("cannot measure {scene}: {reason}"));
    let program = std::env::current_exe().map_err(|error| failed(error.to_string()))?;
    let mut command = Command::new(program);
    command.args(["bench", scene, "--json", &format!("--threads={threads}")]);
    let output = command.stderr(Stdio::inherit()).output().map_err(|error| failed(error.to_string()))?;
    serde_json::from_slice(&output.stdout).map_err(|_| failed(format!("it ended with {}", output.status)))
}

fn measure(scene: &str, threads: usize) -> Result<Figures> {
    let args = SceneArgs { scene: scene.to_owned(), set: Vec::new() };
    let begun = Instant::now();
    let (name, scene) = source::scene(&args)?;
    source::check_memory(&scene)?;
    let (model, params, mut state) = scene.build()?;
    let (points, springs) = (model.point_count(), model.spring_count());
    // Points that cannot move lose it again when the simulation is made.
    add_noise(&mut state.velocity);
    let mut simulation = Simulation::new(model, params, state)?;
    simulation.keep_history(0);
    simulation.set_workers(source::workers(Some(threads))?);
    simulation.steps(1)?;
    let setup_s = begun.elapsed().as_secs_f64();

    let steps =
        (STEPS_TIMES_SPRINGS / springs.max(points) as u64).clamp(1, 100_000).next_multiple_of(PATIENCE);
    let mut best = f64::INFINITY;
    for _ in 0..REPEATS {
        let begun = Instant::now();
        simulation.steps(steps)?;
        best = best.min(begun.elapsed().as_secs_f64() / steps as f64);
    }
    Ok(Figures {
        scene: name,
        points,
        springs,
        steps,
        threads,
        ns_per_spring_step: (springs > 0).then(|| 1e9 * best / springs as f64),
        steps_per_second: 1.0 / best,
        setup_s,
        peak_mb: memory::peak().map(|bytes| bytes as f64 / 1e6),
    })
}

/// Seeded noise from splitmix64 (Steele, Lea, Flood 2014), uniform within ±[`NOISE`]: the same on every machine.
fn add_noise(velocities: &mut [Vec3]) {
    let mut seed = 1u64;
    let mut next = || {
        seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = seed;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let unit = ((z ^ (z >> 31)) >> 40) as f32 / (1u32 << 24) as f32;
        NOISE * (2.0 * unit - 1.0)
    };
    velocities.iter_mut().for_each(|velocity| *velocity += Vec3::new(next(), next(), next()));
}

fn print(figures: &Figures, json: bool) {
    if json {
        say(serde_json::to_string(figures).unwrap_or_default());
        return;
    }
    let ns = figures.ns_per_spring_step.map_or("-".to_owned(), |ns| format!("{ns:.2}"));
    let peak = figures.peak_mb.map_or("-".to_owned(), |mb| format!("{mb:.0}"));
    say(format_args!(
        "{:<12} {:>9} {:>10} {:>8} {:>8} {ns:>14} {:>12.1} {:>9.3} {peak:>9}",
        figures.scene,
        grouped(figures.points),
        grouped(figures.springs),
        figures.steps,
        figures.threads,
        figures.steps_per_second,
        figures.setup_s
    ));
}
