//! The run log and sparse checkpoints: exact rewind by replay.

use std::sync::Arc;

use crate::params::{Change, Params};
use crate::settle::SettleOptions;
use crate::state::State;

/// Memory for checkpoints unless said otherwise, bytes. The first state is always kept.
pub const DEFAULT_HISTORY_BYTES: usize = 64 << 20;

/// Steps between the newest checkpoints; older ones lie further apart when the memory is used up.
const GAP: u64 = 64;

/// Checkpoints kept at the most.
const MOST_CHECKPOINTS: usize = 256;

/// Something that was done to a run between two steps.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// A change of the parameters.
    Change(Change),
    /// The scene was brought to rest.
    Settle(SettleOptions),
}

impl Event {
    /// Whether this leaves nothing of an event that came just before it.
    fn replaces(&self, before: &Self) -> bool {
        use Change::{Carry, Grab, Place};
        let (Self::Change(new), Self::Change(old)) = (self, before) else { return false };
        match (new, old) {
            (Grab(new), Grab(old)) => new.point == old.point,
            // Letting go is another matter: the point keeps the velocity that it was carried with.
            (Carry(new, Some(_)), Carry(old, Some(_))) | (Place(new, _), Place(old, _)) => new == old,
            _ => false,
        }
    }
}

/// A run: a first state, what was done to it and when, and some states on the way.
///
/// A checkpoint at step s is the state on arriving there, before the events logged for s. They are shared by clones.
///
/// A person looks at the last seconds most, so checkpoints lie every 64 steps there, and the older they are the further
/// apart: when the memory is used up, that one goes whose neighbours would then lie nearest to each other in proportion
/// to their age. Gaps then grow like age, so that n checkpoints reach back exponentially far, and what a replay costs is a
/// share of how long ago it was.
#[derive(Clone, Debug)]
pub(crate) struct History {
    first: Arc<Checkpoint>,
    /// In ascending order of the step.
    checkpoints: Vec<Arc<Checkpoint>>,
    /// In ascending order of the step.
    log: Vec<(u64, Event)>,
    budget: usize,
    newest: u64,
}

/// A state to go on from, and the parameters then.
#[derive(Clone, Debug)]
pub(crate) struct Checkpoint {
    pub state: State,
    pub params: Arc<Params>,
}

impl History {
    pub fn new(first: Arc<Checkpoint>, bytes: usize) -> Self {
        let newest = first.state.step;
        Self { first, checkpoints: Vec::new(), log: Vec::new(), budget: bytes, newest }
    }

    pub fn first(&self) -> &Arc<Checkpoint> {
        &self.first
    }

    pub fn log(&self) -> &[(u64, Event)] {
        &self.log
    }

    /// The newest step that was reached.
    pub fn newest(&self) -> u64 {
        self.newest
    }

    /// Something new is about to be done at `step`: what was recorded beyond it is another branch, and is dropped.
    pub fn branch_at(&mut self, step: u64) {
        if step < self.newest {
            self.log.retain(|(at, _)| *at <= step);
            self.checkpoints.retain(|checkpoint| checkpoint.state.step <= step);
            self.newest = step;
        }
    }

    /// Notes what was done. Of a point that is dragged along between two steps only the last grab, carry or place counts.
    pub fn record(&mut self, step: u64, event: Event) {
        match self.log.last_mut() {
            Some((at, last)) if *at == step && event.replaces(last) => *last = event,
            _ => self.log.push((step, event)),
        }
    }

    /// A step was taken.
    pub fn arrived(&mut self, state: &State, params: &Arc<Params>) {
        self.newest = state.step;
        if !(state.step - self.first.state.step).is_multiple_of(GAP) {
            return;
        }
        let last = self.checkpoints.last().unwrap_or(&self.first);
        let needed = size(state, params, &last.params);
        if needed > self.budget {
            return;
        }
        while self.checkpoint_bytes() + needed > self.budget || self.checkpoints.len() >= MOST_CHECKPOINTS {
            let Some(dispensable) = self.most_dispensable(state.step) else { return };
            self.checkpoints.remove(dispensable);
        }
        self.checkpoints.push(Arc::new(Checkpoint { state: state.clone(), params: params.clone() }));
    }

    /// The checkpoint without which the gap left behind is smallest in proportion to how long ago it began; a checkpoint
    /// at step `next` is about to follow.
    fn most_dispensable(&self, next: u64) -> Option<usize> {
        let step = |index: usize| self.checkpoints[index].state.step;
        let share = |index: usize| {
            let before = if index == 0 { self.first.state.step } else { step(index - 1) };
            let after = if index + 1 == self.checkpoints.len() { next } else { step(index + 1) };
            (after - before) as f64 / (next - before) as f64
        };
        (0..self.checkpoints.len()).min_by(|&a, &b| share(a).total_cmp(&share(b)))
    }

    /// The last checkpoint at or before `step`.
    pub fn before(&self, step: u64) -> &Checkpoint {
        let later = self.checkpoints.partition_point(|checkpoint| checkpoint.state.step <= step);
        if later == 0 { &self.first } else { &self.checkpoints[later - 1] }
    }

    /// The events logged for `step`, in order.
    pub fn events_at(&self, step: u64) -> Vec<Event> {
        let begin = self.log.partition_point(|(at, _)| *at < step);
        let end = self.log.partition_point(|(at, _)| *at <= step);
        self.log[begin..end].iter().map(|(_, event)| event.clone()).collect()
    }

    /// Memory of everything that is kept, bytes: the first state, the checkpoints, and the log.
    pub fn bytes(&self) -> usize {
        let mut before = &self.first.params;
        let mut bytes = size(&self.first.state, before, before) + self.checkpoint_bytes();
        for (_, event) in &self.log {
            bytes += size_of::<(u64, Event)>();
            if let Event::Change(Change::Params(params)) = event {
                bytes += params.bytes_apart_from(before);
                before = params;
            }
        }
        bytes
    }

    /// Memory of the checkpoints, bytes.
    fn checkpoint_bytes(&self) -> usize {
        let mut before = &self.first.params;
        let mut bytes = 0;
        for checkpoint in &self.checkpoints {
            bytes += size(&checkpoint.state, &checkpoint.params, before);
            before = &checkpoint.params;
        }
        bytes
    }
}

/// Memory of a checkpoint, bytes: its state, and what its parameters do not share with those before.
fn size(state: &State, params: &Arc<Params>, before: &Arc<Params>) -> usize {
    let own = if Arc::ptr_eq(params, before) { 0 } else { params.bytes_apart_from(before) };
    4 * size_of::<glam::Vec3>() * state.position.len() + own
}
