//! Work that takes longer than a moment: done in portions.

use std::collections::VecDeque;
use std::ops::ControlFlow;

use sprung::{Code, Error, Params, Result, Settling, significant};

use crate::command::Command;
use crate::driver::Driver;
use crate::run::go_towards;
use crate::settings::without_hands;

/// Commands that wait while a job is under way, at the most: nobody presses that many buttons.
const MOST_WAITING: usize = 1000;

/// Work under way.
#[derive(Clone, Debug)]
pub(crate) enum Job {
    /// So many steps are left of so many.
    Steps { left: u64, of: u64 },
    /// On the way to a recorded step.
    Seek { from: u64, to: u64 },
    /// On the way to a recorded step, to go on from there with these parameters.
    Rewind { from: u64, to: u64, params: Box<Params> },
    /// Bringing the scene to rest.
    Settle(Box<Settling>),
}

impl Job {
    /// What it does and how far it is, for people.
    pub fn describe(&self, now: u64) -> String {
        let percent = |done: u64, all: u64| (100.0 * done.min(all) as f64 / all.max(1) as f64) as u64;
        match self {
            &Self::Steps { left, of } => format!("stepping, {} %", percent(of - left, of)),
            &Self::Seek { from, to } | &Self::Rewind { from, to, .. } => {
                let all = from.abs_diff(to);
                format!("replaying, {} %", percent(all.saturating_sub(now.abs_diff(to)), all))
            }
            Self::Settle(settling) => {
                let so_far = settling.so_far();
                let force = significant(so_far.residual_force);
                format!("settling: {} steps, {force} N left", so_far.steps)
            }
        }
    }
}

impl Driver {
    /// Whether a command breaks off what is under way, and all is as before that.
    pub(crate) fn breaks_off(&self, command: &Command) -> bool {
        matches!(self.job, Some(Job::Settle(_))) && !leaves_alone(command)
    }

    /// Whether a command has to wait for what is under way: it is about the state that this will lead to.
    pub(crate) fn must_wait(&self, command: &Command) -> bool {
        let takes_over = matches!(command, Command::Open(_) | Command::GoOn(_) | Command::Reset);
        let is_about_the_state = !leaves_alone(command);
        let newer_seek =
            matches!((&self.job, command), (Some(Job::Seek { .. } | Job::Steps { .. }), Command::Seek(_)));
        let goes_before =
            matches!((&self.job, command), (Some(Job::Steps { .. }), Command::Play(_) | Command::Settle));
        self.job.is_some()
            && is_about_the_state
            && !takes_over
            && !(self.waiting.is_empty() && (newer_seek || goes_before))
    }

    pub(crate) fn keep_waiting(&mut self, command: Command) {
        if self.waiting.len() < MOST_WAITING {
            queue(&mut self.waiting, command);
        }
    }

    /// Pauses, and takes so many steps.
    pub(crate) fn take_steps(&mut self, steps: u64) {
        self.playing.switch(false);
        self.clear_trouble();
        self.job = Some(Job::Steps { left: steps, of: steps });
    }

    /// Pauses, and goes to a recorded step.
    pub(crate) fn seek(&mut self, step: u64) -> Result<()> {
        let (first, newest) = (self.run.recorded.first.0, self.run.recorded.newest.0);
        if !(first..=newest).contains(&step) {
            let sentence = format!("step {step} is not recorded; steps {first} to {newest} are");
            return Err(Error::new(Code::OutOfRange, sentence));
        }
        self.release()?;
        self.playing.switch(false);
        self.clear_trouble();
        self.job = Some(Job::Seek { from: self.run.step_now(), to: step });
        Ok(())
    }

    /// Goes back by so many seconds, as far as they are recorded, to go on from there with the parameters of now.
    pub(crate) fn rewind_and_go_on(&mut self, seconds: f64) -> Result<()> {
        self.release()?;
        let seconds = if seconds > 0.0 { seconds } else { 0.0 };
        let (from, now) = (self.run.step_now(), self.run.simulation.now().1);
        let to = self.run.recorded.step_at(now - seconds).min(from);
        let params = Box::new(without_hands(self.run.params()));
        self.clear_trouble();
        self.job = Some(Job::Rewind { from, to, params });
        Ok(())
    }

    /// Back to the first state, with the parameters of now.
    pub(crate) fn reset(&mut self) -> Result<()> {
        self.job = None;
        self.waiting.clear();
        self.hand = None;
        self.clear_trouble();
        self.run.reset()?;
        self.jumped();
        Ok(())
    }

    /// Works on the job, and when it is done on what waited for it.
    pub(crate) fn work(&mut self, may_go_on: &mut dyn FnMut() -> bool) {
        match self.portion(may_go_on) {
            Ok(false) => return,
            Ok(true) => self.job = None,
            Err(error) => {
                self.job = None;
                self.stop_for(error);
            }
        }
        self.obey_waiting();
    }

    /// Does what waited for a job, until that is another one.
    pub(crate) fn obey_waiting(&mut self) {
        while self.job.is_none()
            && let Some(command) = self.waiting.pop_front()
        {
            self.obey(command);
        }
    }

    /// A portion of the job; gives whether it is done.
    fn portion(&mut self, may_go_on: &mut dyn FnMut() -> bool) -> Result<bool> {
        match self.job.take() {
            None => Ok(true),
            Some(Job::Steps { left, of }) => self.some_steps(left, of, may_go_on),
            Some(Job::Seek { from, to }) => {
                self.job = Some(Job::Seek { from, to });
                self.go(to, may_go_on)
            }
            Some(Job::Rewind { from, to, params }) => {
                let is_there = self.go(to, may_go_on)?;
                if is_there {
                    // Even with the same parameters this is a new run: what blew up once would only be replayed.
                    self.run.part();
                    self.run.set(&params)?;
                    self.run.mark("went on");
                    self.playing.switch(true);
                } else {
                    self.job = Some(Job::Rewind { from, to, params });
                }
                Ok(is_there)
            }
            Some(Job::Settle(settling)) => self.settle(*settling, may_go_on),
        }
    }

    fn some_steps(&mut self, mut left: u64, of: u64, may_go_on: &mut dyn FnMut() -> bool) -> Result<bool> {
        self.carry(left)?;
        while left > 0 && may_go_on() {
            self.step(left == 1)?;
            left -= 1;
        }
        if left > 0 {
            self.job = Some(Job::Steps { left, of });
        }
        Ok(left == 0)
    }

    fn go(&mut self, to: u64, may_go_on: &mut dyn FnMut() -> bool) -> Result<bool> {
        let is_there = go_towards(&mut self.run.simulation, to, may_go_on);
        self.jumped();
        is_there
    }

    fn settle(&mut self, settling: Settling, may_go_on: &mut dyn FnMut() -> bool) -> Result<bool> {
        match settling.go_on(may_go_on)? {
            ControlFlow::Continue(rest) => {
                self.job = Some(Job::Settle(Box::new(rest)));
                Ok(false)
            }
            ControlFlow::Break(simulation) => {
                self.run.settled(simulation);
                self.run.mark("settled");
                self.jumped();
                if self.hand.take().is_some() {
                    self.choose_substeps()?;
                }
                Ok(true)
            }
        }
    }
}

/// Puts a command behind those that wait. What it makes pointless goes.
pub(crate) fn queue(waiting: &mut VecDeque<Command>, mut command: Command) {
    if let Some(last) = waiting.back()
        && command.replaces(last)
    {
        // The first of a slider's edits says whether they go on with one from before.
        if let (Command::Edit(new), Command::Edit(old)) = (&mut command, last) {
            new.continues = old.continues;
        }
        waiting.pop_back();
    }
    waiting.push_back(command);
}

/// Whether a command leaves alone what is under way, and the state.
pub(crate) fn leaves_alone(command: &Command) -> bool {
    matches!(
        command,
        Command::Pace(_)
            | Command::KeepLedger(_)
            | Command::WantForces(_)
            | Command::Watch(_)
            | Command::Compare(_)
            | Command::Checkpoint(false)
            | Command::Dismiss
    )
}
