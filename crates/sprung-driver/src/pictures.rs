//! The two states that are drawn between, in buffers that are used again.

use std::sync::Arc;

use sprung::{Snapshot, State};

/// Spare buffers kept: the front end may hold the last two reports, each with two snapshots.
const MOST_SPARE: usize = 4;

/// Snapshots for reports. A report's own are never written to while somebody holds them.
#[derive(Debug)]
pub(crate) struct Pictures {
    pub before: Arc<Snapshot>,
    pub now: Arc<Snapshot>,
    /// Whether there is a step between the two.
    pub moves: bool,
    spare: Vec<Arc<Snapshot>>,
}

impl Pictures {
    pub fn new(first: &Arc<Snapshot>) -> Self {
        Self { before: first.clone(), now: first.clone(), moves: false, spare: Vec::new() }
    }

    /// Keeps the state that the last step of this advance starts from.
    pub fn begin(&mut self, state: &State) {
        let mut before = self.buffer();
        fill(&mut before, state);
        let old = std::mem::replace(&mut self.before, before);
        self.keep(old);
        self.moves = true;
    }

    /// Shows this state, with or without the step that leads to it.
    pub fn show(&mut self, state: &State, moves: bool) {
        let mut now = self.buffer();
        fill(&mut now, state);
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

fn fill(buffer: &mut Arc<Snapshot>, state: &State) {
    if let Some(snapshot) = Arc::get_mut(buffer) {
        snapshot.fill(state);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::Vec3;

    #[test]
    fn a_picture_that_is_held_is_not_written_to_and_others_are_used_again() {
        let mut state = State::new(vec![Vec3::ZERO], vec![Vec3::ZERO]);
        let mut first = Snapshot::default();
        first.fill(&state);
        let mut pictures = Pictures::new(&Arc::new(first));
        let held = pictures.now.clone();
        let mut seen = Vec::new();
        for step in 1..20 {
            pictures.begin(&state);
            state.step = step;
            state.position[0] = Vec3::splat(step as f32);
            pictures.show(&state, true);
            assert!(pictures.moves);
            assert_eq!((pictures.before.step, pictures.now.step), (step - 1, step));
            assert_eq!(pictures.now.positions[0].x, step as f32);
            seen.push(Arc::as_ptr(&pictures.now));
        }
        assert_eq!((held.step, held.positions[0]), (0, Vec3::ZERO));
        seen.sort();
        seen.dedup();
        assert!(seen.len() <= 4, "{} buffers", seen.len());
    }
}
