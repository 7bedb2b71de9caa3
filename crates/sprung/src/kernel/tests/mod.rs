//! The fast step against a plain one, and against itself: whatever instructions and however many regions, the same bits.

mod energy;
mod far_apart;
mod limit;
mod march;
mod networks;
mod order;
mod same_bits;
mod small_numbers;
mod twin;

use glam::Vec3;

use super::level::Level;
use super::team::{Team, Worth};
use crate::model::Model;
use crate::params::Params;
use crate::scene::{Builtin, Kind, Scene};
use crate::simulation::Simulation;
use crate::state::State;
use crate::workers::Workers;

/// What a step needs.
#[derive(Clone, Debug)]
struct Parts {
    model: Model,
    params: Params,
    state: State,
}

impl Parts {
    /// Parts that a simulation accepts, after it has stopped the points that are fixed.
    fn new((model, params, state): (Model, Params, State)) -> Self {
        Self::of(&Simulation::new(model, params, state).expect("the parts fit"))
    }

    fn of(simulation: &Simulation) -> Self {
        let (params, state) = (simulation.params().clone(), simulation.state().clone());
        Self { model: Model::clone(simulation.model()), params, state }
    }

    fn built_in(scene: &Builtin) -> Self {
        Self::of(&Scene::builtin(scene.name).and_then(|scene| scene.simulation()).expect("it is built in"))
    }

    fn team(&self, level: Level) -> Team {
        let mut team = Team::new(&self.model, &self.params);
        team.set_level(level);
        team.load(&self.model, &self.state);
        team
    }

    /// A team that is divided for as many threads as it can be, however small the model is.
    fn divided_team(&self, level: Level) -> Team {
        let mut team = self.team(level);
        team.set_worth(Worth { springs: 1, blocks_per_border: 2 });
        team
    }

    /// Steps with so many threads, all of which leave finite positions.
    fn advance(&self, team: &mut Team, steps: u64, threads: usize) {
        assert_eq!(team.advance(&self.model, &self.params, steps, &Threads(threads)), (steps, true));
    }

    /// The team's state.
    fn state_of(&self, team: &Team) -> State {
        let mut state = self.state.clone();
        team.store(&self.model, &mut state);
        state
    }
}

/// Steps that a test can afford.
fn affordable(scene: &Builtin, few: u64, many: u64) -> u64 {
    if scene.kind == Kind::Benchmark { few } else { many }
}

/// Threads of the standard library, started anew for each step; the last worker first, so that finishing in order is
/// nothing to rely on.
struct Threads(usize);

impl Workers for Threads {
    fn count(&self) -> usize {
        self.0
    }

    fn run(&self, job: &(dyn Fn(usize) + Sync)) {
        // WebAssembly has no threads here: the work is divided as it would be among them, and done part by part.
        if cfg!(target_family = "wasm") {
            return (0..self.0).rev().for_each(job);
        }
        std::thread::scope(|scope| {
            for worker in (0..self.0).rev() {
                scope.spawn(move || job(worker));
            }
        });
    }
}

/// The arrays of a state that a step changes, by name.
fn arrays(state: &State) -> [(&'static str, &[Vec3]); 4] {
    [
        ("position", &state.position),
        ("position_low", &state.position_low),
        ("velocity", &state.velocity),
        ("velocity_low", &state.velocity_low),
    ]
}

/// The first number in which two states differ, bit for bit: −0 is not 0.
fn first_difference(a: &State, b: &State) -> Option<String> {
    arrays(a).into_iter().zip(arrays(b)).find_map(|((name, a), (_, b))| {
        assert_eq!(a.len(), b.len(), "{name}");
        let bits = |vector: &Vec3| vector.to_array().map(f32::to_bits);
        let point = a.iter().zip(b).position(|(a, b)| bits(a) != bits(b))?;
        Some(format!("{name} of point {point}: {:?} and {:?}", a[point], b[point]))
    })
}
