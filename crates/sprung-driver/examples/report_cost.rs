//! What a large scene's driver is asked with each report, in steps' worth, and how many steps a second are left.
//!
//! `cargo run --release -p sprung-driver --example report_cost [SCENE…]`

// Printing is what this program is for.
#![allow(clippy::print_stdout)]

use std::sync::Arc;
use std::time::{Duration, Instant};

use sprung::scene::Scene;
use sprung::{Code, Error, Result, Simulation, Workers};
use sprung_driver::{Command, Driver, Options, Pace, Source};

/// Each question is asked so many times, and the fastest answer counts: noise only ever slows.
const REPEATS: usize = 15;
/// Steps in each run that is timed.
const STEPS: u64 = 20;
/// How long the driver plays.
const PLAYED: Duration = Duration::from_secs(3);
/// From one report to the next.
const FRAME: Duration = Duration::from_micros(16_667);

fn main() -> Result<()> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| Error::new(Code::Unsupported, error.to_string()))?;
    let workers: Arc<dyn Workers> = Arc::new(pool);
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let names = if asked.is_empty() { vec!["cloth512".to_owned(), "jelly64".to_owned()] } else { asked };
    for name in names {
        let step = ask(&name, &workers)?;
        play(&name, &workers, step)?;
    }
    Ok(())
}

/// Asks a simulation after each of some steps; gives what a step costs, s.
fn ask(name: &str, workers: &Arc<dyn Workers>) -> Result<f64> {
    let mut simulation = Scene::builtin(name)?.simulation()?;
    simulation.set_workers(workers.clone());
    simulation.keep_history(0);
    let mut step = f64::INFINITY;
    for _ in 0..REPEATS {
        let begun = Instant::now();
        simulation.steps(STEPS)?;
        step = step.min(begun.elapsed().as_secs_f64() / STEPS as f64);
    }
    let springs = simulation.model().spring_count();
    println!("{name}: {springs} springs, {} threads, {:.3} ms for a step", workers.count(), 1e3 * step);
    type Question = fn(&mut Simulation);
    let questions: [(&str, Question); 3] = [
        ("energies", |simulation| _ = simulation.energy()),
        ("a snapshot", |simulation| _ = simulation.snapshot()),
        ("the whole state", |simulation| _ = simulation.state()),
    ];
    for (what, question) in questions {
        let mut best = f64::INFINITY;
        for _ in 0..REPEATS {
            simulation.steps(1)?;
            let begun = Instant::now();
            question(&mut simulation);
            best = best.min(begun.elapsed().as_secs_f64());
        }
        print(what, best, step);
    }
    Ok(step)
}

/// Plays with a report for each frame, in which as many steps are taken as there is time for.
fn play(name: &str, workers: &Arc<dyn Workers>, step: f64) -> Result<()> {
    let options = Options { workers: workers.clone(), ..Options::default() };
    let mut driver = Driver::with(Source { name: name.to_owned(), scene: Scene::builtin(name)? }, options)?;
    driver.obey(Command::Pace(Pace::Frames));
    driver.obey(Command::Play(true));
    let (begun, mut then, mut took) = (Instant::now(), Instant::now(), Vec::new());
    while begun.elapsed() < PLAYED {
        std::thread::sleep(FRAME.saturating_sub(then.elapsed()));
        let passed = then.elapsed();
        then += passed;
        driver.advance(passed.as_secs_f64(), &mut || then.elapsed() < FRAME);
        let asked = Instant::now();
        let report = driver.report();
        took.push(asked.elapsed().as_secs_f64());
        if let Some(trouble) = &report.trouble {
            println!("  {trouble:?}");
        }
    }
    let (seconds, reports) = (begun.elapsed().as_secs_f64(), took.len());
    print("a report, on average", took.iter().sum::<f64>() / reports as f64, step);
    took.sort_by(f64::total_cmp);
    print("a report, most often", took[reports / 2], step);
    let (steps, reports) = (driver.report().now.step as f64 / seconds, reports as f64 / seconds);
    println!("  {steps:.0} steps/s and {reports:.0} reports/s; {:.0} steps/s if nobody asks", 1.0 / step);
    Ok(())
}

fn print(what: &str, seconds: f64, step: f64) {
    println!("  {what:<22} {:>8.3} ms {:>7.2} steps", 1e3 * seconds, seconds / step);
}
