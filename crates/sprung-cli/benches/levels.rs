//! The step at every level of vector instructions, on one thread and on two: nanoseconds per spring and step. Large scenes
//! also with their points numbered at random, and a network without any order. `cargo bench --bench levels [SCENE…]`

// Printing is what this program is for.
#![allow(clippy::print_stdout)]

#[path = "../../sprung/examples/networks/irregular.rs"]
mod irregular;

use std::time::Instant;

use irregular::{Random, irregular};
use sprung::scene::Scene;
use sprung::solver::SymplecticEuler;
use sprung::{Code, Error, Inline, Level, Material, ModelBuilder, Result, Simulation, Vec3, Workers};

const SCENES: &[&str] =
    &["jelly", "cloth", "cloth512", "cloth512-random", "jelly64", "jelly64-random", "irregular"];
/// Springs evaluated in each timed run.
const SPRINGS: usize = 20_000_000;
/// Timed runs, of which the fastest counts.
const REPEATS: usize = 6;
/// Speeds of the noise that every point starts with, m/s: a scene at rest tells nothing.
const NOISE: f32 = 0.1;
/// Points of the irregular network.
const POINTS: usize = 262_144;

fn main() -> Result<()> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build();
    let pool = pool.map_err(|error| Error::new(Code::Unsupported, error.to_string()))?;
    let asked: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let names: Vec<&str> =
        if asked.is_empty() { SCENES.to_vec() } else { asked.iter().map(String::as_str).collect() };
    println!("{:<16} {:>9} {:>9} {:>9} {:>9}", "scene", "springs", "level", "1 thread", "2 threads");
    for name in names {
        let simulation = simulation(name)?;
        let (model, params) = (simulation.model().clone(), simulation.params().clone());
        let mut state = simulation.state().clone();
        let mut random = Random(1);
        for (point, velocity) in state.velocity.iter_mut().enumerate() {
            if !params.is_fixed(point) {
                *velocity += (random.point() * 2.0 - Vec3::ONE) * NOISE;
            }
        }
        let springs = model.spring_count();
        let steps = (SPRINGS / springs).clamp(3, 5000) as u64;
        let mut solver = SymplecticEuler::new(model, &params);
        let mut hashes = Vec::new();
        for level in Level::available() {
            solver.set_level(level);
            let mut time = |workers: &dyn Workers| {
                solver.load(&state);
                let mut best = f64::INFINITY;
                for _ in 0..REPEATS {
                    let begun = Instant::now();
                    solver.advance(&params, steps, workers);
                    best = best.min(begun.elapsed().as_secs_f64());
                }
                let mut end = state.clone();
                solver.store(&mut end);
                hashes.push(end.hash());
                1e9 * best / (steps as usize * springs) as f64
            };
            let (one, two) = (time(&Inline), time(&pool));
            println!("{name:<16} {springs:>9} {:>9} {one:>9.2} {two:>9.2}", level.name());
        }
        assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{name}: other bits");
    }
    Ok(())
}

fn simulation(name: &str) -> Result<Simulation> {
    match name.strip_suffix("-random") {
        Some(name) => renumbered(&Scene::builtin(name)?.simulation()?),
        None if name == "irregular" => irregular(POINTS),
        None => Scene::builtin(name)?.simulation(),
    }
}

/// The same scene with its points numbered at random.
fn renumbered(ordered: &Simulation) -> Result<Simulation> {
    let (model, params, state) = (ordered.model(), ordered.params(), ordered.state());
    let mut points: Vec<usize> = (0..model.point_count()).collect();
    let mut random = Random(1);
    for left in (1..points.len()).rev() {
        points.swap(left, random.below(left + 1));
    }
    let mut number = vec![0; points.len()];
    let mut builder = ModelBuilder::new();
    for &point in &points {
        number[point] = builder.add_point(state.position[point], params.point_mass[point])?;
        if params.point_pinned[point] {
            builder.pin(number[point])?;
        }
    }
    let ends = |spring: &[u32; 2]| spring.map(|point| number[point as usize]);
    let mut springs: Vec<[usize; 2]> = model.springs().iter().map(ends).collect();
    // In the order in which somebody would find them who knows no better.
    springs.iter_mut().for_each(|ends| ends.sort_unstable());
    springs.sort_unstable();
    let material = Material { stiffness: params.spring_stiffness[0], damping: params.spring_damping[0] };
    for [a, b] in springs {
        builder.add_spring(a, b, material)?;
    }
    let (model, mut own, state) = builder.build()?;
    (own.dt, own.planes, own.gravity) = (params.dt, params.planes.clone(), params.gravity);
    Simulation::new(model, own, state)
}
