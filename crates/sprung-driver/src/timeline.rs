//! The times of steps, and the marks on the timeline.

use std::sync::Arc;

use sprung::State;

/// Marks kept at the most; then the oldest go.
const MOST_MARKS: usize = 1000;

/// Marks of the same label nearer than this (s of simulated time) are one.
const SAME_MARK: f64 = 0.5;

/// When the recorded steps were, and where something was changed.
#[derive(Clone, Debug)]
pub(crate) struct Recorded {
    pub first: (u64, f64),
    pub newest: (u64, f64),
    /// From this step, at this time, steps of this length: one entry for each change of dt.
    pub clock: Arc<Vec<(u64, f64, f64)>>,
    pub marks: Arc<Vec<(u64, String)>>,
}

impl Recorded {
    /// From this state on, with steps of length `dt` (s).
    pub fn new(state: &State, dt: f64) -> Self {
        let first = (state.step, state.time);
        // Of a run that is gone on with, the steps of this length may have begun earlier: times are counted from there.
        let (step, time) = state.clock();
        let clock = if step < state.step { vec![(step, time, dt)] } else { Vec::new() };
        Self { first, newest: first, clock: Arc::new(clock), marks: Arc::default() }
    }

    /// The time of a recorded step, s.
    pub fn time_of(&self, step: u64) -> f64 {
        time_of(&self.clock, self.first, step)
    }

    /// A new step of length `dt` (s) has led to this state.
    pub fn arrived(&mut self, now: (u64, f64), dt: f64) {
        let (step, time) = self.newest;
        if self.clock.last().is_none_or(|last| last.2 != dt) {
            Arc::make_mut(&mut self.clock).push((step, time, dt));
        }
        self.newest = now;
    }

    /// The run goes another way from this state on.
    pub fn branch_at(&mut self, state: &State) {
        if self.newest.0 <= state.step {
            return;
        }
        self.newest = (state.step, state.time);
        if self.clock.last().is_some_and(|last| last.0 >= state.step) {
            Arc::make_mut(&mut self.clock).retain(|segment| segment.0 < state.step);
        }
        if self.marks.last().is_some_and(|last| last.0 > state.step) {
            Arc::make_mut(&mut self.marks).retain(|mark| mark.0 <= state.step);
        }
    }

    /// Something was done at this state.
    pub fn mark(&mut self, state: &State, label: &str) {
        if let Some((step, last)) = self.marks.last()
            && last == label
            && state.time - self.time_of(*step) < SAME_MARK
        {
            return;
        }
        let marks = Arc::make_mut(&mut self.marks);
        if marks.len() >= MOST_MARKS {
            marks.remove(0);
        }
        marks.push((state.step, label.to_owned()));
    }

    /// The step at this time (s), or the last before it.
    pub fn step_at(&self, time: f64) -> u64 {
        let segment = self.clock.partition_point(|segment| segment.1 <= time);
        let Some(&(step, start, dt)) = segment.checked_sub(1).and_then(|index| self.clock.get(index)) else {
            return self.first.0;
        };
        // What rounding took must not take a step: a time is start + n·dt, rounded twice, and so is that of another run at
        // the same moment; difference and quotient are rounded once each. That makes six halves of an ulp at the most.
        let rounding = 3.0 * f64::EPSILON * (time.abs() + start.abs()) / dt;
        let steps = ((time - start) / dt + rounding) as u64;
        let end = self.clock.get(segment).map_or(self.newest.0, |next| next.0);
        step.saturating_add(steps).min(end).max(self.first.0)
    }
}

/// The time of a step of a run that begins with this step and time, s.
pub(crate) fn time_of(clock: &[(u64, f64, f64)], begin: (u64, f64), step: u64) -> f64 {
    let segment = clock.partition_point(|segment| segment.0 <= step).saturating_sub(1);
    clock.get(segment).map_or(begin.1, |&(first, start, dt)| start + step.saturating_sub(first) as f64 * dt)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(step: u64, time: f64) -> State {
        let mut state = State::new(Vec::new(), Vec::new());
        (state.step, state.time) = (step, time);
        state
    }

    #[test]
    fn steps_and_times_agree_across_changes_of_dt() {
        let mut recorded = Recorded::new(&state(0, 0.0), 0.1);
        (1..=10u32).for_each(|step| recorded.arrived((step.into(), 0.1 * f64::from(step)), 0.1));
        (1..=10u32).for_each(|step| recorded.arrived(((10 + step).into(), 1.0 + 0.5 * f64::from(step)), 0.5));
        for step in 0..=20 {
            assert_eq!(recorded.step_at(recorded.time_of(step)), step);
        }
        assert_eq!((recorded.step_at(-1.0), recorded.step_at(1.4), recorded.step_at(99.0)), (0, 10, 20));
        recorded.branch_at(&state(10, 1.0));
        assert_eq!((recorded.clock.len(), recorded.newest), (1, (10, 1.0)));
    }

    /// A run that is gone on with counts from where its steps became so long, and knows nothing of before its first one.
    #[test]
    fn a_run_may_begin_in_the_middle() {
        let mut begun = state(10, 0.5 + 7.0 * 0.1);
        begun.set_clock((3, 0.5));
        let mut recorded = Recorded::new(&begun, 0.1);
        assert_eq!(
            (recorded.time_of(10), recorded.step_at(0.0), recorded.step_at(9.0)),
            (begun.time, 10, 10)
        );
        recorded.arrived((11, 0.5 + 8.0 * 0.1), 0.1);
        assert_eq!((recorded.time_of(11), recorded.step_at(recorded.newest.1)), (0.5 + 8.0 * 0.1, 11));
        // With steps of another length from just there.
        let mut begun = state(10, 1.25);
        begun.set_clock((10, 1.25));
        let at_once = Recorded::new(&begun, 0.1);
        assert_eq!((at_once.time_of(10), at_once.step_at(1.25)), (1.25, 10));
    }

    /// Far from the start, where a step is a few thousand ulps of the time.
    #[test]
    fn rounding_neither_takes_nor_gives_a_step() {
        for (start, dt, first) in [(0.0, 1e-9, 1u64 << 40), (1e5, 3e-8, 7), (0.1, 0.013, 999_999_999)] {
            let time = |step: u64| start + step as f64 * dt;
            let newest = first + 1000;
            let clock = Arc::new(vec![(0, start, dt)]);
            let recorded =
                Recorded { first: (0, start), newest: (newest, time(newest)), clock, marks: Arc::default() };
            for step in first..newest {
                assert_eq!(recorded.step_at(time(step)), step, "{start} s and steps of {dt} s");
                let just_before = time(step) - 0.05 * dt;
                assert_eq!(recorded.step_at(just_before), step - 1, "{start} s and steps of {dt} s");
            }
        }
    }

    #[test]
    fn marks_of_one_edit_are_one_and_a_branch_drops_later_ones() {
        let mut recorded = Recorded::new(&state(0, 0.0), 0.1);
        for step in 0..100u32 {
            let state = state(step.into(), 0.01 * f64::from(step));
            if step > 0 {
                recorded.arrived((state.step, state.time), 0.01);
            }
            recorded.mark(&state, if step < 40 { "gravity" } else { "mass" });
        }
        let steps: Vec<u64> = recorded.marks.iter().map(|mark| mark.0).collect();
        assert_eq!(steps, [0, 40, 90]);
        recorded.branch_at(&state(40, 0.4));
        assert_eq!(recorded.marks.len(), 2);
    }
}
