//! Automatic sub-steps: as many as are stable in every configuration, for the same time of a frame.

use sprung::params::{DT_RANGE, SUBSTEPS_RANGE};
use sprung::{Code, Error, Model, Params, Result, SAFE_SHARE, significant, stability};

/// How sub-steps are chosen while the switch is on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Auto {
    /// dt and sub-steps when it was switched on: they come back when it is switched off. dt is never longer than this.
    pub own: (f64, u32),
}

impl Auto {
    pub fn new(params: &Params) -> Self {
        Self { own: (params.dt, params.substeps) }
    }

    /// dt (s) and sub-steps for these parameters: dt is a safe share of the limit in every configuration, as with
    /// `dt = "auto"` in a scene.
    ///
    /// # Errors
    /// [`Code::OutOfRange`] if no number of sub-steps that is allowed is stable.
    pub fn choose(&self, model: &Model, params: &Params) -> Result<(f64, u32)> {
        let limit = stability::every_configuration(model, params).map_or(f64::INFINITY, |limit| limit.dt);
        self.choose_for(limit)
    }

    fn choose_for(&self, limit: f64) -> Result<(f64, u32)> {
        let (dt, substeps) = self.own;
        let longest = SAFE_SHARE * limit;
        if dt <= longest {
            return Ok(self.own);
        }
        let frame_time = dt * f64::from(substeps);
        // Rounding may leave the quotient just above: then one more.
        let first = (frame_time / longest).ceil();
        let chosen = [first, first + 1.0].into_iter().find(|&n| frame_time / n <= longest);
        match chosen {
            Some(n) if n <= f64::from(*SUBSTEPS_RANGE.end()) && frame_time / n >= *DT_RANGE.start() => {
                Ok((frame_time / n, n as u32))
            }
            _ => Err(self.impossible(frame_time, limit)),
        }
    }

    fn impossible(&self, frame_time: f64, limit: f64) -> Error {
        let (frame, limit) = (significant(frame_time), significant(limit));
        let (most, least) = (SUBSTEPS_RANGE.end(), significant(*DT_RANGE.start()));
        let sentence = format!(
            "a frame of {frame} s cannot be split into stable steps: the limit in every configuration is {limit} s, and there \
             may be at most {most} sub-steps of at least {least} s"
        );
        Error::new(Code::OutOfRange, sentence).with_fix("raise masses, or lower stiffness or damping")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_of_a_frame_stays_and_the_step_is_below_the_limit() {
        let auto = Auto { own: (0.01, 11) };
        for limit in [2e-7, 1e-5, 0.0047, 0.005, 0.009999, 0.0105, 0.0106, 1.0, f64::INFINITY] {
            let (dt, substeps) = auto.choose_for(limit).expect("possible");
            assert!(dt <= 0.95 * limit && dt <= 0.01);
            assert!((dt * f64::from(substeps) - 0.11).abs() < 1e-15);
            // One fewer would be too few, or fewer than the scene's own.
            assert!(substeps == 11 || 0.11 / f64::from(substeps - 1) > 0.95 * limit);
        }
        assert_eq!(auto.choose_for(0.0106), Ok((0.01, 11)), "not fewer than the scene's own");
        for limit in [0.0, 1e-9, 1e-8] {
            let error = auto.choose_for(limit).expect_err("more than a million sub-steps");
            assert_eq!(error.code(), Code::OutOfRange);
        }
    }
}
