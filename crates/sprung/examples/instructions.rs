//! What `cargo xtask instructions` counts the instructions of: the step, and what is asked for beside it.
//!
//! It runs under valgrind's callgrind, which counts what is done in [`counted`] and closes a count where [`tell`] is
//! called. By itself it only says what would have been counted: scene, work, level and springs, with tabs between them.

// Saying so is what this program is for.
#![allow(clippy::print_stdout)]

#[path = "networks/irregular.rs"]
mod irregular;

use std::{panic, thread};

use sprung::scene::Scene;
use sprung::solver::SymplecticEuler;
use sprung::{Change, Inline, Level, Result, Simulation, Workers};

const SCENES: &[&str] = &["cloth", "jelly", "cloth512", "jelly64", "irregular"];

/// Points of the irregular network. With four times as many, counts for each spring are the same within 1 %.
const IRREGULAR_POINTS: usize = 16_384;

/// Springs evaluated in a count, at least: what a call costs by itself is little beside them.
const SPRINGS: usize = 100_000;

/// Springs from which on two threads are given a region each.
const DIVIDED: usize = 200_000;

/// The last of so many steps is the one after which [`Simulation::steps`] looks at the energy.
const STEPS_TO_LOOK: u64 = 20;

/// What does not depend on the level of vector instructions.
const NO_LEVEL: &str = "–";

fn main() -> Result<()> {
    // On a thread of its own, as copies take more or fewer instructions by how they are aligned: the first thread's stack
    // begins where the environment and the name of the program leave off, any other's at a page.
    let all = thread::spawn(|| SCENES.iter().try_for_each(|scene| count(scene)));
    all.join().unwrap_or_else(|panic| panic::resume_unwind(panic))
}

/// Everything that is counted of one scene.
fn count(scene: &str) -> Result<()> {
    let mut simulation = counted(|| simulation(scene))?;
    let (model, params) = (simulation.model().clone(), simulation.params().clone());
    let springs = model.spring_count();
    tell(scene, "set-up", NO_LEVEL, springs);

    let mut solver = counted(|| SymplecticEuler::new(model.clone(), &params));
    tell(scene, "plan and laws", NO_LEVEL, springs);

    solver.load(simulation.state());
    let steps = SPRINGS.div_ceil(springs);
    for level in Level::available() {
        solver.set_level(level);
        counted(|| solver.advance(&params, steps as u64, &Inline));
        tell(scene, "step", level.name(), steps * springs);
    }
    let widest = Level::best().name();
    if springs >= DIVIDED {
        // The first one divides the points.
        solver.advance(&params, 1, &TwoInTurn);
        counted(|| solver.advance(&params, 1, &TwoInTurn));
        tell(scene, "step, two threads", widest, springs);
    } else {
        simulation.keep_history(0);
        simulation.steps(STEPS_TO_LOOK - 1)?;
        counted(|| simulation.steps(1))?;
        tell(scene, "step and look at energy", widest, springs);
    }

    let mut softer = params.clone();
    softer.apply(&model, &Change::Stiffness(0..springs, 50.0))?;
    counted(|| solver.refresh(&params, &softer));
    tell(scene, "new stiffness", NO_LEVEL, springs);
    Ok(())
}

fn simulation(scene: &str) -> Result<Simulation> {
    match scene {
        "irregular" => irregular::irregular(IRREGULAR_POINTS),
        _ => Scene::builtin(scene)?.simulation(),
    }
}

/// Does some work, which callgrind counts: it knows this function by its name.
#[inline(never)]
fn counted<T>(work: impl FnOnce() -> T) -> T {
    work()
}

/// Says what the last count was of: callgrind knows this function too.
#[inline(never)]
fn tell(scene: &str, work: &str, level: &str, springs: usize) {
    println!("{scene}\t{work}\t{level}\t{springs}");
}

/// The work of two threads, one after the other: waiting for one another would be counted too.
struct TwoInTurn;

impl Workers for TwoInTurn {
    fn count(&self) -> usize {
        2
    }

    fn run(&self, job: &(dyn Fn(usize) + Sync)) {
        (0..2).for_each(job);
    }
}
