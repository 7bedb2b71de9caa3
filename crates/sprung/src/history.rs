//! The run log and sparse checkpoints: exact rewind by replay.

use crate::params::{Change, Params};
use crate::settle::SettleOptions;
use crate::state::State;

/// Memory for checkpoints unless said otherwise, bytes. The first state is always kept.
pub const DEFAULT_HISTORY_BYTES: usize = 64 << 20;

/// Steps between checkpoints at first; the gap doubles whenever the memory is used up.
const FIRST_GAP: u64 = 64;

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

/// A run: a first state, what was done to it and when, and some states on the way.
///
/// A checkpoint at step s is the state on arriving there, before the events logged for s.
#[derive(Clone, Debug)]
pub(crate) struct History {
    first: (State, Params),
    checkpoints: Vec<(State, Params)>,
    log: Vec<(u64, Event)>,
    most: usize,
    gap: u64,
    newest: u64,
}

impl History {
    pub fn new(state: &State, params: &Params, bytes: usize) -> Self {
        let size = 4 * size_of::<glam::Vec3>() * state.position.len();
        Self {
            first: (state.clone(), params.clone()),
            checkpoints: Vec::new(),
            log: Vec::new(),
            most: (bytes / size.max(1)).min(MOST_CHECKPOINTS),
            gap: FIRST_GAP,
            newest: state.step,
        }
    }

    pub fn first(&self) -> &(State, Params) {
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
            self.checkpoints.retain(|(state, _)| state.step <= step);
            self.newest = step;
        }
    }

    pub fn record(&mut self, step: u64, event: Event) {
        self.log.push((step, event));
    }

    /// A step was taken.
    pub fn arrived(&mut self, state: &State, params: &Params) {
        self.newest = state.step;
        if self.most == 0 || !(state.step - self.first.0.step).is_multiple_of(self.gap) {
            return;
        }
        if self.checkpoints.len() >= self.most {
            // Every other one, so that the rest lie twice as far apart.
            self.gap *= 2;
            let (first, gap) = (self.first.0.step, self.gap);
            self.checkpoints.retain(|(state, _)| (state.step - first).is_multiple_of(gap));
            if !(state.step - first).is_multiple_of(gap) || self.checkpoints.len() >= self.most {
                return;
            }
        }
        self.checkpoints.push((state.clone(), params.clone()));
    }

    /// The last checkpoint at or before `step`.
    pub fn before(&self, step: u64) -> &(State, Params) {
        self.checkpoints.iter().rev().find(|(state, _)| state.step <= step).unwrap_or(&self.first)
    }

    /// The events logged for `step`, in order.
    pub fn events_at(&self, step: u64) -> Vec<Event> {
        self.log.iter().filter(|(at, _)| *at == step).map(|(_, event)| event.clone()).collect()
    }
}
