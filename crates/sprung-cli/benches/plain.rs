//! The step beside the plainest loop that does the same, in turn in one run: what its extra work (sums that keep what
//! rounding drops, the watch over energy, contact) costs or saves. The ratio is the figure; times are the machine's.

// Printing is what this program is for.
#![allow(clippy::print_stdout)]

use std::time::Instant;

use sprung::scene::Scene;
use sprung::{Simulation, Vec3};

/// Springs evaluated in each timed run.
const SPRINGS: usize = 10_000_000;
/// Timed runs of each, of which the fastest counts.
const REPEATS: usize = 7;

fn main() -> sprung::Result<()> {
    println!("{:<10} {:>16} {:>16} {:>7}", "scene", "sprung ns/spring", "plain ns/spring", "ratio");
    for name in ["jelly", "cloth", "cloth512", "jelly64"] {
        let mut simulation = Scene::builtin(name)?.simulation()?;
        simulation.keep_history(0);
        let mut plain = Plain::new(&simulation);
        let (dt, springs) = (simulation.params().dt, simulation.model().spring_count());
        let steps = SPRINGS.div_ceil(springs);
        let (mut ours, mut theirs) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..REPEATS {
            let begun = Instant::now();
            simulation.steps(steps as u64)?;
            ours = ours.min(begun.elapsed().as_secs_f64());
            let begun = Instant::now();
            (0..steps).for_each(|_| plain.step(dt as f32));
            theirs = theirs.min(begun.elapsed().as_secs_f64());
        }
        let per_spring = 1e9 / (steps * springs) as f64;
        let (ours, theirs) = (ours * per_spring, theirs * per_spring);
        println!("{name:<10} {ours:>16.2} {theirs:>16.2} {:>7.2}", ours / theirs);
    }
    Ok(())
}

struct Spring {
    ends: [usize; 2],
    stiffness: f32,
    damping: f32,
    rest_length: f32,
}

/// Semi-implicit Euler over an array of springs, as one writes it on the first day. No contact, no checks.
struct Plain {
    position: Vec<Vec3>,
    velocity: Vec<Vec3>,
    force: Vec<Vec3>,
    inverse_mass: Vec<f32>,
    springs: Vec<Spring>,
    gravity: Vec3,
}

impl Plain {
    fn new(simulation: &Simulation) -> Self {
        let (model, params, state) = (simulation.model(), simulation.params(), simulation.state());
        let springs = model.springs().iter().enumerate().map(|(spring, ends)| Spring {
            ends: ends.map(|end| end as usize),
            stiffness: params.spring_stiffness[spring],
            damping: params.spring_damping[spring],
            rest_length: params.spring_rest_length[spring],
        });
        Self {
            position: state.position.clone(),
            velocity: state.velocity.clone(),
            force: vec![Vec3::ZERO; model.point_count()],
            inverse_mass: (0..model.point_count()).map(|point| params.inverse_mass(point)).collect(),
            springs: springs.collect(),
            gravity: params.gravity,
        }
    }

    fn step(&mut self, dt: f32) {
        for Spring { ends: [i, j], stiffness, damping, rest_length } in &self.springs {
            let axis = self.position[*i] - self.position[*j];
            let length = axis.length();
            let u = axis / length;
            let speed = (self.velocity[*i] - self.velocity[*j]).dot(u);
            let force = u * -(stiffness * (length - rest_length) + damping * speed);
            self.force[*i] += force;
            self.force[*j] -= force;
        }
        for point in 0..self.position.len() {
            if self.inverse_mass[point] > 0.0 {
                self.velocity[point] += (self.force[point] * self.inverse_mass[point] + self.gravity) * dt;
                self.position[point] += self.velocity[point] * dt;
            }
            self.force[point] = Vec3::ZERO;
        }
    }
}
