//! Taking turns: what a driver does next that works beside its front end, and how long it may rest until then.
//!
//! Whoever gives it its turns, a thread or a page's worker, tells it what was asked and hands its reports on.

use std::collections::VecDeque;
use std::sync::Arc;

use sprung::Error;
use web_time::Duration;

use crate::command::Command;
use crate::driver::Driver;
use crate::job::queue;
use crate::report::Report;

/// The longest that the driver works before it reports and hears what is asked.
const BUDGET: Duration = Duration::from_millis(8);

/// The shortest and the longest rest while it plays: reports say where between two steps to draw, but more than a few
/// hundred of them a second are of no use, however short the steps.
const REST: [Duration; 2] = [Duration::from_millis(4), Duration::from_millis(8)];

/// Idle time after which the true limit of a large model is looked for, which may take seconds.
const IDLE: Duration = Duration::from_millis(700);

/// Tells how much time has passed since some moment.
pub(crate) type Clock = Box<dyn Fn() -> Duration + Send>;

/// A driver, and what it was asked.
pub(crate) struct Turns {
    pub driver: Driver,
    heard: VecDeque<Command>,
    clock: Clock,
    /// When the last turn began.
    then: Duration,
    /// Since when nothing has been asked and there was nothing to do.
    idle_since: Duration,
    /// It has been said that the first of what was heard is being done, which takes a while.
    is_announced: bool,
    newest: Arc<Report>,
}

impl Turns {
    pub fn new(mut driver: Driver, clock: Clock) -> Self {
        let (now, newest) = (clock(), driver.report());
        let heard = VecDeque::new();
        Self { driver, heard, then: now, idle_since: now, is_announced: false, newest, clock }
    }

    /// Somebody asks for this.
    pub fn hear(&mut self, command: Command) {
        queue(&mut self.heard, command);
    }

    /// What somebody asked for cannot even be understood.
    pub fn refuse(&mut self, error: Error) {
        self.driver.refuse(error);
    }

    /// Whether there is something that was asked and not done yet.
    pub fn has_heard(&self) -> bool {
        !self.heard.is_empty()
    }

    /// The report that the last turn gave.
    pub fn newest(&self) -> &Arc<Report> {
        &self.newest
    }

    /// Does what was asked and what is due, for some milliseconds and as long as `may_go_on`. Gives a report, the same one
    /// where nothing has happened.
    pub fn turn(&mut self, may_go_on: &dyn Fn() -> bool) -> Arc<Report> {
        let (played, is_asked) = (self.driver.plays(), self.has_heard());
        if let Some(name) = self.obey() {
            let busy = Some(format!("opening {name}"));
            self.newest = Arc::new(Report { busy, ..(*self.newest).clone() });
            return self.newest.clone();
        }
        let now = (self.clock)();
        if !is_asked && self.driver.wants_sharp() && self.idle_since + IDLE <= now {
            self.driver.obey(Command::FindSharpLimit);
        }
        // What went by before something began to play is not owed to it, such as the rest while nothing did.
        let passed =
            if self.driver.plays() == played { now.saturating_sub(self.then) } else { Duration::ZERO };
        self.then = now;
        let (clock, end) = (&self.clock, now + BUDGET);
        self.driver.advance(passed.as_secs_f64(), &mut || clock() < end && may_go_on());
        let done = clock();
        self.driver.measured(done.saturating_sub(now).as_secs_f64());
        if is_asked || !self.driver.is_idle() {
            self.idle_since = done;
        }
        self.newest = self.driver.report();
        self.newest.clone()
    }

    /// How long there is nothing to do, if nothing is asked; `None`: for ever.
    pub fn rest(&self) -> Option<Duration> {
        if self.has_heard() {
            return Some(Duration::ZERO);
        }
        if self.driver.wants_sharp() {
            return Some((self.idle_since + IDLE).saturating_sub((self.clock)()));
        }
        if self.driver.is_idle() {
            return None;
        }
        let seconds = self.driver.seconds_to_step();
        let [shortest, longest] = REST.map(|rest| rest.as_secs_f64());
        let is_behind = seconds <= 0.0;
        Some(if is_behind {
            Duration::ZERO
        } else {
            Duration::from_secs_f64(seconds.clamp(shortest, longest))
        })
    }

    /// Does what was asked. Opening something may take a while: it ends before that the first time, and gives its name.
    fn obey(&mut self) -> Option<String> {
        while let Some(command) = self.heard.pop_front() {
            let opens = match &command {
                Command::Open(source) => Some(&source.name),
                Command::GoOn(kept) => Some(&kept.name),
                _ => None,
            };
            if let (Some(name), false) = (opens, self.is_announced) {
                let name = name.clone();
                self.heard.push_front(command);
                self.is_announced = true;
                return Some(name);
            }
            self.is_announced = false;
            self.driver.obey(command);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU64, Ordering};

    use sprung::scene::Scene;

    use super::*;
    use crate::command::Source;

    fn source(name: &str) -> Source {
        Source { name: name.to_owned(), scene: Scene::builtin(name).expect("a built-in scene") }
    }

    /// Turns by a clock that is set by hand, ms. Looking at it takes a hundredth of a millisecond.
    fn turns(name: &str) -> (Turns, Arc<AtomicU64>) {
        let clock = Arc::new(AtomicU64::new(0));
        let theirs = clock.clone();
        let tell = move || Duration::from_micros(10 * theirs.fetch_add(1, Ordering::Relaxed));
        (Turns::new(Driver::new(source(name)).expect("it opens"), Box::new(tell)), clock)
    }

    impl Turns {
        /// All turns that these commands need, two seconds after the last one.
        fn turn_after_rest(
            &mut self,
            clock: &AtomicU64,
            commands: impl IntoIterator<Item = Command>,
        ) -> Arc<Report> {
            commands.into_iter().for_each(|command| self.hear(command));
            clock.fetch_add(200_000, Ordering::Relaxed);
            let mut report = self.turn(&|| true);
            while self.has_heard() {
                report = self.turn(&|| true);
            }
            report
        }
    }

    #[test]
    fn the_time_of_a_pause_is_not_made_up_for() {
        let (mut turns, clock) = turns("chain");
        for _ in 0..2 {
            let paused = turns.turn_after_rest(&clock, [Command::Play(false)]);
            let begun = turns.turn_after_rest(&clock, [Command::Play(true)]);
            assert_eq!((begun.now.step, begun.speed), (paused.now.step, 1.0), "playing begins now");
            // While it plays, time is made up for.
            assert!(turns.turn_after_rest(&clock, []).now.step > begun.now.step);
        }
    }

    #[test]
    fn the_time_of_opening_is_not_owed_to_the_scene_that_was_opened() {
        let (mut turns, clock) = turns("chain");
        turns.turn_after_rest(&clock, [Command::Play(true)]);
        let report = turns.turn_after_rest(&clock, [Command::Open(Box::new(source("chain")))]);
        assert_eq!((report.now.step, report.playing, report.speed), (0, true, 1.0));
    }

    #[test]
    fn what_takes_a_while_is_announced() {
        let (mut turns, _) = turns("chain");
        turns.hear(Command::Open(Box::new(source("jelly"))));
        turns.hear(Command::Open(Box::new(source("spring"))));
        let said: Vec<_> = (0..3)
            .map(|_| {
                assert_eq!(turns.rest(), Some(Duration::ZERO));
                let report = turns.turn(&|| true);
                (report.opened.name.clone(), report.busy.clone())
            })
            .collect();
        let opening = |name: &str| Some(format!("opening {name}"));
        assert_eq!(
            said,
            [
                ("chain".to_owned(), opening("jelly")),
                ("chain".to_owned(), opening("spring")),
                ("spring".to_owned(), None)
            ]
        );
        assert_eq!(turns.rest(), None);
    }

    #[test]
    fn it_rests_as_long_as_nothing_is_due() {
        let (mut turns, clock) = turns("chain");
        assert_eq!(turns.rest(), None);
        turns.turn_after_rest(&clock, [Command::Play(true)]);
        let rest = turns.rest().expect("it plays");
        assert!((REST[0]..=REST[1]).contains(&rest), "{rest:?}");
        let first = turns.turn_after_rest(&clock, [Command::Play(false)]);
        assert_eq!(turns.rest(), None);
        assert!(Arc::ptr_eq(&first, &turns.turn(&|| true)), "nothing happens");
    }

    /// Of a model with so many springs that this takes a while.
    #[test]
    fn the_true_limit_of_a_large_model_is_found_when_it_has_been_idle() {
        let (mut turns, clock) = turns("cloth512");
        let rest = turns.rest().expect("it is to be found");
        assert!(rest <= IDLE);
        assert_eq!(turns.turn(&|| true).stability.sharp, None);
        clock.fetch_add(rest.as_micros() as u64 / 10, Ordering::Relaxed);
        assert!(turns.turn(&|| true).stability.sharp.is_some());
        assert_eq!(turns.rest(), None);
    }
}
