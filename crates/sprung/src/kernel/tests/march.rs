//! Regions that take many steps and wait for each other.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::networks::mixed;
use super::{Threads, first_difference};
use crate::kernel::level::Level;
use crate::workers::Workers;

/// Not threads but one, which does the work of all in turn, the last first.
#[derive(Default)]
struct InTurn {
    count: usize,
    called: AtomicUsize,
}

impl Workers for InTurn {
    fn count(&self) -> usize {
        self.count
    }

    fn run(&self, job: &(dyn Fn(usize) + Sync)) {
        self.called.fetch_add(1, Ordering::Relaxed);
        (0..self.count).rev().for_each(job);
    }
}

#[test]
fn a_region_does_not_wait_for_ever() {
    let parts = mixed(7, 24_000, false);
    let (mut plain, mut team) = (parts.team(Level::best()), parts.divided_team(Level::best()));
    let workers = InTurn { count: 5, ..InTurn::default() };
    parts.advance(&mut plain, 12, 1);
    assert_eq!(team.advance(&parts.model, &parts.params, 12, &workers), (12, true));
    assert_eq!(team.region_count(), 5);
    let called = workers.called.into_inner();
    assert!((2..=12).contains(&called), "called {called} times: each time a step of all at least");
    assert_eq!(first_difference(&parts.state_of(&plain), &parts.state_of(&team)), None);
}

#[test]
fn the_first_step_that_fails_is_the_same_in_any_number_of_regions() {
    let parts = mixed(8, 24_000, false);
    let springs = parts.model.spring_count();
    for (place, factor) in [(0, 1e6), (springs / 2, 1e8), (springs - 1, 1e7)] {
        let mut parts = parts.clone();
        for stiffness in Arc::make_mut(&mut parts.params.spring_stiffness)[place..].iter_mut().take(1) {
            *stiffness *= factor;
        }
        let advance = |threads: usize| {
            let mut team = parts.divided_team(Level::best());
            team.advance(&parts.model, &parts.params, 1_000, &Threads(threads))
        };
        let (steps, finite) = advance(1);
        assert!(!finite && (2..1_000).contains(&steps), "it fails on the way, at step {steps}");
        for threads in [2, 3, 7] {
            assert_eq!(advance(threads), (steps, false), "{threads} threads, spring {place}");
        }
    }
}
