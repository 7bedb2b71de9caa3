//! The two states that are drawn between, in buffers that are used again.

use std::sync::Arc;

use sprung::{Simulation, Snapshot};

/// Spare buffers kept: the front end may hold the last two reports, each with two snapshots.
const MOST_SPARE: usize = 4;

/// Snapshots for reports. A report's own are never written to while somebody holds them.
#[derive(Debug)]
pub(crate) struct Pictures {
    pub before: Arc<Snapshot>,
    pub now: Arc<Snapshot>,
    /// Whether there is a step between the two.
    pub moves: bool,
    /// [`Simulation::changes`] when `now` was made.
    changes: u64,
    spare: Vec<Arc<Snapshot>>,
}

impl Pictures {
    /// Of a simulation that is still at its first state.
    pub fn new(first: &Arc<Snapshot>, simulation: &Simulation) -> Self {
        let (before, now, changes) = (first.clone(), first.clone(), simulation.changes());
        Self { before, now, moves: false, changes, spare: Vec::new() }
    }

    /// Keeps the state that the last step of this advance starts from.
    pub fn begin(&mut self, simulation: &Simulation) {
        let mut before = self.buffer();
        fill(&mut before, simulation);
        let old = std::mem::replace(&mut self.before, before);
        self.keep(old);
        self.moves = true;
    }

    /// Shows the state now if it is not shown already, with the step that led to it.
    pub fn refresh(&mut self, simulation: &Simulation) {
        if self.changes != simulation.changes() {
            self.show(simulation, true);
        }
    }

    /// Shows the state now, with or without the step that led to it.
    pub fn show(&mut self, simulation: &Simulation, moves: bool) {
        let mut now = self.buffer();
        fill(&mut now, simulation);
        self.changes = simulation.changes();
        let old = std::mem::replace(&mut self.now, now);
        self.keep(old);
        self.moves = moves && self.before.step + 1 == self.now.step;
        if !self.moves {
            self.rest();
        }
    }

    /// Shows the newest state until the next step.
    pub fn rest(&mut self) {
        self.moves = false;
        let old = std::mem::replace(&mut self.before, self.now.clone());
        self.keep(old);
    }

    /// A buffer that nobody reads.
    fn buffer(&mut self) -> Arc<Snapshot> {
        let free = self.spare.iter_mut().position(|spare| Arc::get_mut(spare).is_some());
        free.map_or_else(Arc::default, |index| self.spare.swap_remove(index))
    }

    fn keep(&mut self, old: Arc<Snapshot>) {
        let is_in_use = Arc::ptr_eq(&old, &self.now) || Arc::ptr_eq(&old, &self.before);
        if !is_in_use && self.spare.len() < MOST_SPARE {
            self.spare.push(old);
        }
    }
}

fn fill(buffer: &mut Arc<Snapshot>, simulation: &Simulation) {
    if let Some(snapshot) = Arc::get_mut(buffer) {
        simulation.fill(snapshot);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::scene::Scene;
    use sprung::{Change, Vec3};

    fn falling() -> (Simulation, Pictures) {
        let scene = Scene::builtin("chain").expect("a built-in scene");
        let mut simulation = scene.simulation().expect("it can be built");
        let first = Arc::new(simulation.snapshot().clone());
        let pictures = Pictures::new(&first, &simulation);
        (simulation, pictures)
    }

    #[test]
    fn a_picture_that_is_held_is_not_written_to_and_others_are_used_again() {
        let (mut simulation, mut pictures) = falling();
        let (held, first) = (pictures.now.clone(), simulation.snapshot().clone());
        let mut seen = Vec::new();
        for step in 1..20 {
            pictures.begin(&simulation);
            simulation.steps(1).expect("it is stable");
            pictures.refresh(&simulation);
            assert!(pictures.moves);
            assert_eq!((pictures.before.step, pictures.now.step), (step - 1, step));
            assert_eq!(*pictures.now, *simulation.snapshot());
            seen.push(Arc::as_ptr(&pictures.now));
        }
        assert_eq!(*held, first);
        seen.sort();
        seen.dedup();
        assert!(seen.len() <= 4, "{} buffers", seen.len());
    }

    #[test]
    fn a_picture_is_made_anew_only_when_something_has_moved() {
        let (mut simulation, mut pictures) = falling();
        let first = Arc::as_ptr(&pictures.now);
        pictures.refresh(&simulation);
        assert_eq!(Arc::as_ptr(&pictures.now), first);
        let there = Vec3::new(1.0, 2.0, 3.0);
        simulation.change(Change::Place(1, there)).expect("allowed");
        pictures.refresh(&simulation);
        assert_eq!((pictures.now.positions[1], pictures.now.step), (there, 0));
    }
}
