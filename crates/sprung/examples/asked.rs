//! What is found out only when somebody asks, in steps of the same scene: how large dt may be.
//!
//! `cargo run --release -p sprung --features rayon --example asked [SCENE…]`

// Printing is what this program is for.
#![allow(clippy::print_stdout)]

use std::sync::Arc;
use std::time::Instant;

use sprung::scene::Scene;
use sprung::{Code, Error, Inline, Result, Simulation, Workers, stability};

/// Timed runs, of which the fastest counts.
const REPEATS: usize = 9;
/// Steps in each timed run of steps.
const STEPS: u64 = 5;

fn main() -> Result<()> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build();
    let pool = Arc::new(pool.map_err(|error| Error::new(Code::Unsupported, error.to_string()))?);
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let names = if asked.is_empty() { vec!["cloth512".to_owned(), "jelly64".to_owned()] } else { asked };
    println!("milliseconds, and how many steps that is");
    println!(
        "{:<10} {:>7} {:>8} {:>16} {:>16} {:>16}",
        "scene", "threads", "step", "certified", "in float64", "every, float64"
    );
    for name in names {
        let mut simulation = Scene::builtin(&name)?.simulation()?;
        simulation.keep_history(0);
        // In motion: at rest it tells less.
        simulation.steps(50)?;
        let threads: [Arc<dyn Workers>; 2] = [Arc::new(Inline), pool.clone()];
        for workers in threads {
            let threads = workers.count();
            simulation.set_workers(workers);
            simulation.steps(STEPS)?;
            let step = fastest(&mut simulation, |simulation| simulation.steps(STEPS))? / STEPS as f64;
            let certified = fastest(&mut simulation, |simulation| Ok(simulation.certified_limit()))?;
            let exact = fastest(&mut simulation, |simulation| {
                let (model, params, state) = (simulation.model(), simulation.params(), simulation.state());
                Ok(stability::certified(model, params, &state.position))
            })?;
            let every = fastest(&mut simulation, |simulation| {
                Ok(stability::every_configuration(simulation.model(), simulation.params()))
            })?;
            let steps = |time: f64| format!("{:.2} = {:.2}", 1e3 * time, time / step);
            println!(
                "{name:<10} {threads:>7} {:>8.2} {:>16} {:>16} {:>16}",
                1e3 * step,
                steps(certified),
                steps(exact),
                steps(every)
            );
            let limit = |limit: Option<stability::Limit>| limit.map_or(f64::INFINITY, |limit| limit.dt);
            let fast = limit(simulation.certified_limit());
            let (model, params, state) = (simulation.model(), simulation.params(), simulation.state());
            let exact = limit(stability::certified(model, params, &state.position));
            println!("{:<10} {fast:.9} s, {:.2e} below the one in float64", "", 1.0 - fast / exact);
        }
    }
    Ok(())
}

/// The shortest time that something takes, s.
fn fastest<T>(
    simulation: &mut Simulation,
    mut what: impl FnMut(&mut Simulation) -> Result<T>,
) -> Result<f64> {
    let mut best = f64::INFINITY;
    for _ in 0..REPEATS {
        let begun = Instant::now();
        std::hint::black_box(what(simulation)?);
        best = best.min(begun.elapsed().as_secs_f64());
    }
    Ok(best)
}
