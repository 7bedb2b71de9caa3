//! The engine in the benchmark against others: steps a network that `bench/scenes.py` wrote.
//!
//! `bench_network FILE THREADS`; the file's layout stands at the head of `bench/network.py`, and what is asked and
//! answered at the head of `bench/measure.py`. `python3 bench/run.py` builds and drives it.

// Answering is what this program is for.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::fs::{self, File};
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::sync::Arc;
use std::time::Instant;

use sprung::{Material, ModelBuilder, Simulation, Vec3};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, path, threads] = &arguments[..] else { return Err("usage: bench_network FILE THREADS".into()) };
    let begun = Instant::now();
    let mut simulation = simulation(path)?;
    let threads = threads.parse()?;
    if threads > 1 {
        simulation.set_workers(Arc::new(rayon::ThreadPoolBuilder::new().num_threads(threads).build()?));
    }
    simulation.steps(1)?;
    println!("{{\"setup_s\": {}}}", begun.elapsed().as_secs_f64());

    for line in std::io::stdin().lines() {
        match line?.split_whitespace().collect::<Vec<_>>()[..] {
            ["run", steps, times] => {
                let (steps, times) = (steps.parse::<usize>()?, times.parse::<usize>()?);
                let mut best = f64::INFINITY;
                for _ in 0..times {
                    simulation.reset();
                    let begun = Instant::now();
                    simulation.steps(steps as u64)?;
                    best = best.min(begun.elapsed().as_secs_f64());
                }
                println!("{{\"best_s\": {best}}}");
            }
            ["save", file] => {
                let positions = simulation.state().position.iter().flat_map(|point| point.to_array());
                fs::write(file, positions.flat_map(|c| f64::from(c).to_le_bytes()).collect::<Vec<_>>())?;
                println!("{{}}");
            }
            _ => return Err("the commands are: run STEPS TIMES, save FILE".into()),
        }
    }
    Ok(())
}

/// The network as a user of the engine would build it, point by point and spring by spring. It is read on the way and
/// never held, so that the memory measured is the engine's own.
fn simulation(path: &str) -> Result<Simulation, Box<dyn Error>> {
    let mut head = Numbers::from(path, 0)?;
    if head.words()? != [*b"netw", *b"ork1"] {
        return Err("this file holds no network".into());
    }
    let [points, springs] = head.indices()?;
    let [dt, gravity] = head.floats()?;
    // The arrays follow one another; each is read in a place of its own.
    let mut at = 6;
    let mut array = |length: usize| {
        let begin = at;
        at += length;
        Numbers::from(path, begin)
    };
    let (mut position, mut velocity, mut inverse_mass) =
        (array(3 * points)?, array(3 * points)?, array(points)?);
    let mut ends = array(2 * springs)?;
    let (mut stiffness, mut damping, mut rest_length) = (array(springs)?, array(springs)?, array(springs)?);

    let mut builder = ModelBuilder::new();
    builder.reserve(points, springs);
    for _ in 0..points {
        let [inverse] = inverse_mass.floats()?;
        let mass = if inverse > 0.0 { 1.0 / inverse } else { 0.0 };
        let point = builder.add_point(Vec3::from_array(position.floats()?), mass)?;
        builder.set_velocity(point, Vec3::from_array(velocity.floats()?))?;
    }
    for _ in 0..springs {
        let [i, j] = ends.indices()?;
        let ([stiffness], [damping], [length]) =
            (stiffness.floats()?, damping.floats()?, rest_length.floats()?);
        let spring = builder.add_spring(i, j, Material { stiffness, damping })?;
        builder.set_rest_length(spring, length)?;
    }
    let (model, mut params, state) = builder.build()?;
    params.dt = f64::from(dt);
    params.gravity = Vec3::Y * gravity;
    let mut simulation = Simulation::new(model, params, state)?;
    simulation.keep_history(0);
    Ok(simulation)
}

/// Numbers of four bytes each, little-endian, read one after the other.
struct Numbers(BufReader<File>);

impl Numbers {
    /// From the number at this place of the file on.
    fn from(path: &str, place: usize) -> std::io::Result<Self> {
        let mut file = File::open(path)?;
        file.seek(SeekFrom::Start(4 * place as u64))?;
        Ok(Self(BufReader::new(file)))
    }

    fn words<const N: usize>(&mut self) -> std::io::Result<[[u8; 4]; N]> {
        let mut words = [[0; 4]; N];
        words.iter_mut().try_for_each(|word| self.0.read_exact(word))?;
        Ok(words)
    }

    fn indices<const N: usize>(&mut self) -> std::io::Result<[usize; N]> {
        Ok(self.words()?.map(|word| u32::from_le_bytes(word) as usize))
    }

    fn floats<const N: usize>(&mut self) -> std::io::Result<[f32; N]> {
        Ok(self.words()?.map(f32::from_le_bytes))
    }
}
