//! Pulling at points: what the hand does to the run.

use sprung::{Change, Code, Error, Result};

use crate::command::Pull;
use crate::driver::Driver;
use crate::hand::{Hand, soft_spring};

impl Driver {
    /// Takes hold of a point, or moves the hand that does.
    pub(crate) fn pull(&mut self, pull: Pull) -> Result<()> {
        let Pull { point, target, hard } = pull;
        // Whether there is such a point and such a place.
        self.run.params().clone().apply(&self.opened.model, &Change::Place(point, target))?;
        let held = self.hand.filter(|hand| (hand.point, hand.hard) == (point, hard));
        if held.is_none() {
            self.release()?;
            if !hard && self.run.params().is_anchored(point) {
                let sentence = format!("point {point} is fixed, and a soft pull does not move it");
                return Err(Error::new(Code::Conflict, sentence).with_fix("unpin it, or carry it along"));
            }
        }
        // In the past this is a branch, in which no earlier hand holds anything.
        self.run.part();
        let mut hand = held.unwrap_or(Hand { point, target, hard, spring: (0.0, 0.0) });
        hand.target = target;
        if hard {
            self.hold(hand)?;
        } else {
            if held.is_none() {
                let state = self.run.simulation.state();
                hand.spring = soft_spring(&self.opened.model, self.run.params(), &state.position, point);
            }
            self.run.change(Change::Grab(hand.grab()))?;
        }
        self.hand = Some(hand);
        if held.is_none() {
            self.run.mark("pull");
            self.choose_substeps()?;
        }
        Ok(())
    }

    /// A hard hand while time stands still puts the point where it is; while it plays, the next steps carry it there.
    fn hold(&mut self, hand: Hand) -> Result<()> {
        if !self.run.params().carried.contains_key(&hand.point) {
            self.run.change(Change::Carry(hand.point, Some(sprung::Vec3::ZERO)))?;
        }
        if !self.playing.on && self.job.is_none() {
            self.run.change(Change::Place(hand.point, hand.target))?;
            self.jumped();
        }
        Ok(())
    }

    /// So many steps are due: a carried point is to be at the hand's target after them.
    pub(crate) fn carry(&mut self, steps: u64) -> Result<()> {
        let Some(hand) = self.hand.filter(|hand| hand.hard && steps > 0) else { return Ok(()) };
        let params = self.run.params();
        let position = self.run.simulation.state().position[hand.point];
        let velocity = hand.velocity(position, steps, params.dt, self.size);
        if params.carried.get(&hand.point) != Some(&velocity) {
            self.run.change(Change::Carry(hand.point, Some(velocity)))?;
        }
        Ok(())
    }

    /// Lets go. The point keeps its velocity.
    pub(crate) fn release(&mut self) -> Result<()> {
        if self.hand.take().is_some() {
            self.run.let_go();
            self.run.state_changed();
            self.choose_substeps()?;
        }
        Ok(())
    }
}
