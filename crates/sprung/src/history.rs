//! The run log and sparse checkpoints: exact rewind by replay.

use std::sync::Arc;

use crate::params::{Change, Params};
use crate::settle::SettleOptions;
use crate::state::State;

/// Memory for checkpoints and log unless said otherwise, bytes. The first state and the log are always kept.
pub const DEFAULT_HISTORY_BYTES: usize = 64 << 20;

/// Steps between the newest checkpoints; older ones lie further apart when the memory is used up.
const GAP: u64 = 64;

/// The part of the memory that checkpoints may take however much has been done: without any, each look back would be a
/// replay from the first state.
const LEAST_SHARE: usize = 4;

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
        matches!((self, before), (Self::Change(new), Self::Change(old)) if replaces(new, old))
    }

    fn params(&self) -> Option<&Arc<Params>> {
        match self {
            Self::Change(Change::Params(params)) => Some(params),
            _ => None,
        }
    }
}

/// Whether a change leaves nothing of one that came just before it.
pub(crate) fn replaces(new: &Change, old: &Change) -> bool {
    use Change::{
        Carry, Cut, Damping, Force, Grab, Gravity, Mass, Params, Pin, Place, Planes, RestScale, Stiffness,
        Substeps,
    };
    match (new, old) {
        (Grab(new), Grab(old)) => new.point == old.point,
        // Letting go is another matter: the point keeps the velocity that it was carried with.
        (Carry(new, Some(_)), Carry(old, Some(_)))
        | (Place(new, _), Place(old, _))
        | (Force(new, _), Force(old, _)) => new == old,
        (Mass(new, _), Mass(old, _))
        | (Pin(new, _), Pin(old, _))
        | (Cut(new, _), Cut(old, _))
        | (Stiffness(new, _), Stiffness(old, _))
        | (Damping(new, _), Damping(old, _))
        | (RestScale(new, _), RestScale(old, _)) => new == old,
        // Not dt: the clock starts anew with each.
        (Gravity(_), Gravity(_))
        | (Planes(_), Planes(_))
        | (Substeps(_), Substeps(_))
        | (Params(_), Params(_)) => true,
        _ => false,
    }
}

/// A log of more events, or of more memory (bytes), is long.
const LONG_LOG: usize = 1024;
const LARGE_LOG: usize = 16 << 20;

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
    first: Arc<Past>,
    /// In ascending order of the step.
    checkpoints: Vec<Arc<Past>>,
    /// In ascending order of the step.
    log: Vec<(u64, Event)>,
    /// For both together, bytes. The log is kept whole, and checkpoints make room for it.
    budget: usize,
    checkpoint_bytes: usize,
    log_bytes: usize,
    newest: u64,
}

/// A checkpoint: a state to go on from, and the parameters then.
#[derive(Clone, Debug)]
pub(crate) struct Past {
    pub state: State,
    pub params: Arc<Params>,
}

impl History {
    pub fn new(first: Arc<Past>, bytes: usize) -> Self {
        let newest = first.state.step;
        Self {
            first,
            checkpoints: Vec::new(),
            log: Vec::new(),
            budget: bytes,
            checkpoint_bytes: 0,
            log_bytes: 0,
            newest,
        }
    }

    pub fn first(&self) -> &Arc<Past> {
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
            while self.log.last().is_some_and(|(at, _)| *at > step) {
                self.drop_last_event();
            }
            self.checkpoints.retain(|checkpoint| checkpoint.state.step <= step);
            self.count_checkpoints();
            self.newest = step;
        }
    }

    /// Notes what was done. Of a point that is dragged along between two steps only the last grab, carry or place counts,
    /// and of a parameter that a slider sets over and over only the last value.
    pub fn record(&mut self, step: u64, event: Event) {
        if self.log.last().is_some_and(|(at, last)| *at == step && event.replaces(last)) {
            self.drop_last_event();
        }
        self.log_bytes += self.bytes_of(&event);
        self.log.push((step, event));
        while self.checkpoint_bytes > self.room() && self.drop_most_dispensable(step) {}
    }

    fn drop_last_event(&mut self) {
        if let Some((_, event)) = self.log.pop() {
            self.log_bytes -= self.bytes_of(&event);
        }
    }

    /// Whether the log has grown beyond what is worth keeping where nobody goes back.
    pub fn log_is_long(&self) -> bool {
        self.log.len() > LONG_LOG || self.log_bytes > LARGE_LOG
    }

    /// Memory of an event that comes last in the log, bytes.
    fn bytes_of(&self, event: &Event) -> usize {
        let own = event.params().map_or(0, |own| {
            let before = self.log.iter().rev().find_map(|(_, event)| event.params());
            own.bytes_apart_from(before.unwrap_or(&self.first.params))
        });
        size_of::<(u64, Event)>() + own
    }

    /// A step was taken.
    pub fn arrived(&mut self, state: State, params: &Arc<Params>) {
        self.newest = state.step;
        if !(state.step - self.first.state.step).is_multiple_of(GAP) {
            return;
        }
        let last = self.checkpoints.last().unwrap_or(&self.first);
        let needed = size(&state, params, &last.params);
        if needed > self.room() {
            return;
        }
        while self.checkpoint_bytes + needed > self.room() || self.checkpoints.len() >= MOST_CHECKPOINTS {
            if !self.drop_most_dispensable(state.step) {
                return;
            }
        }
        self.checkpoints.push(Arc::new(Past { state, params: params.clone() }));
        self.count_checkpoints();
    }

    /// Memory for checkpoints, bytes.
    fn room(&self) -> usize {
        self.budget.saturating_sub(self.log_bytes).max(self.budget / LEAST_SHARE)
    }

    /// Drops a checkpoint, now that the run is at step `next`; gives whether there was one.
    fn drop_most_dispensable(&mut self, next: u64) -> bool {
        let Some(dispensable) = self.most_dispensable(next) else { return false };
        self.checkpoints.remove(dispensable);
        self.count_checkpoints();
        true
    }

    /// A step was reached at which no checkpoint is due.
    pub fn reached(&mut self, step: u64) {
        self.newest = step;
    }

    /// Whether there is to be a checkpoint at `step`.
    pub fn is_due(&self, step: u64) -> bool {
        let state = 4 * size_of::<glam::Vec3>() * self.first.state.position.len();
        state <= self.budget && (step - self.first.state.step).is_multiple_of(GAP)
    }

    /// How many steps from `step` there are to the next checkpoint.
    pub fn steps_to_checkpoint(&self, step: u64) -> u64 {
        GAP - (step - self.first.state.step) % GAP
    }

    /// The next step after `step` for which an event is logged.
    pub fn next_event(&self, step: u64) -> Option<u64> {
        let next = self.log.partition_point(|(at, _)| *at <= step);
        self.log.get(next).map(|(at, _)| *at)
    }

    /// The checkpoint without which the gap left behind is smallest in proportion to how long ago it began, seen from
    /// step `next`.
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
    pub fn before(&self, step: u64) -> &Past {
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
        let first = &self.first;
        size(&first.state, &first.params, &first.params) + self.checkpoint_bytes + self.log_bytes
    }

    fn count_checkpoints(&mut self) {
        let mut before = &self.first.params;
        self.checkpoint_bytes = 0;
        for checkpoint in &self.checkpoints {
            self.checkpoint_bytes += size(&checkpoint.state, &checkpoint.params, before);
            before = &checkpoint.params;
        }
    }
}

/// Memory of a checkpoint, bytes: its state, and what its parameters do not share with those before.
fn size(state: &State, params: &Arc<Params>, before: &Arc<Params>) -> usize {
    let own = if Arc::ptr_eq(params, before) { 0 } else { params.bytes_apart_from(before) };
    4 * size_of::<glam::Vec3>() * state.position.len() + own
}
