use super::*;
use crate::build::{Material, ModelBuilder};
use crate::solver::SymplecticEuler;
use glam::Vec3;

/// A small generator of numbers from 0 to 1 (Numerical Recipes), the same everywhere.
struct Random(u32);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as f32 / (1 << 24) as f32
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }
}

/// So many workers in one thread, which take turns.
struct Turns(usize);

impl Workers for Turns {
    fn count(&self) -> usize {
        self.0
    }

    fn run(&self, job: &(dyn Fn(usize) + Sync)) {
        (0..self.0).for_each(job);
    }
}

/// A square cloth, large enough for two regions, that flutters.
fn cloth() -> (Arc<Model>, Params, State) {
    const SIDE: usize = 190;
    let mut builder = ModelBuilder::new();
    let mut random = Random(1);
    for point in 0..SIDE * SIDE {
        builder
            .add_point(Vec3::new((point % SIDE) as f32, 1.0, (point / SIDE) as f32), 0.1)
            .expect("allowed");
        builder.set_velocity(point, random.vector()).expect("allowed");
    }
    builder.connect_within(0..SIDE * SIDE, 1.5, Material { stiffness: 50.0, damping: 0.1 }).expect("allowed");
    let (model, params, state) = builder.build().expect("there are points");
    (Arc::new(model), params, state)
}

#[test]
fn the_state_that_was_kept_outlives_steps_and_another_number_of_threads() {
    let (model, params, state) = cloth();
    let mut current = Current::new(SymplecticEuler::new(model, &params), state);
    assert!(*current.state() == current.kept(), "the first state is kept until another is");
    for threads in [2, 1, 2] {
        assert!(current.advance(&params, 1, &Turns(threads)));
        let then = current.state().clone();
        current.keep();
        assert!(current.advance(&params, 3, &Turns(3 - threads)));
        assert!(current.kept() == then && *current.state() != then);
        current.state_mut().position[0] = Vec3::ZERO;
        assert!(current.clone().kept() == then, "a clone has its own");
    }
}
