//! Playing: when the next step is due, and how fast it goes.

use sprung::Params;

use crate::command::Pace;

/// Frames a second of [`Pace::Frames`].
const FRAMES_PER_SECOND: f64 = 60.0;

/// Real time over which the speed is measured, s.
const SPEED_WINDOW: f64 = 0.5;

/// The longest stretch of real time that is caught up on, s. After a longer pause of the program, such as a laptop's sleep,
/// nobody waits for what was missed.
const LONGEST_STRETCH: f64 = 0.25;

/// How much a new measurement of a step's cost counts against those before.
const NEW_SHARE: f64 = 0.1;

/// The accumulator of due time: real time goes in, whole steps come out, the rest waits.
#[derive(Clone, Debug, Default)]
pub(crate) struct Playing {
    pub on: bool,
    pub pace: Pace,
    /// Simulated time that is due, s.
    due: f64,
    /// Real and simulated seconds of the window so far: of these also the part of a step that is due, as it is drawn.
    window: (f64, f64),
    speed: Option<f64>,
    seconds_per_step: f64,
}

impl Playing {
    /// Plays or pauses. Whatever was due is forgotten.
    pub fn switch(&mut self, on: bool) {
        self.on = on;
        self.forget();
    }

    /// Nothing is due, and the speed is measured anew.
    pub fn forget(&mut self) {
        (self.due, self.window, self.speed) = (0.0, (0.0, 0.0), None);
    }

    /// Real time has passed, s.
    pub fn pass(&mut self, seconds: f64, params: &Params) {
        if !(seconds > 0.0 && seconds.is_finite()) {
            return;
        }
        if self.window.0 >= SPEED_WINDOW {
            self.speed = Some(self.window.1 / self.window.0);
            self.window = (0.0, 0.0);
        }
        let due = seconds.min(LONGEST_STRETCH) * self.factor(params);
        self.due += due;
        self.window = (self.window.0 + seconds, self.window.1 + due);
    }

    /// How many steps of `dt` (s) are due.
    pub fn steps_due(&self, dt: f64) -> u64 {
        // Sixty sixtieths of a second make a second: what rounding took from the sum must not take a step.
        (self.due / dt * (1.0 + 1e-12)) as u64
    }

    /// A step of `dt` (s) was taken.
    pub fn stepped(&mut self, dt: f64) {
        self.due = (self.due - dt).max(0.0);
    }

    /// What could not be done in time is dropped: simulated time slows down instead of piling up.
    pub fn drop_arrears(&mut self, dt: f64) {
        let dropped = (self.due - dt).max(0.0);
        self.due -= dropped;
        self.window.1 -= dropped;
    }

    /// Where between the last two steps the moment to draw lies.
    pub fn blend(&self, dt: f64) -> f64 {
        if self.on { (self.due / dt).clamp(0.0, 1.0) } else { 1.0 }
    }

    /// Real seconds until the next step of `dt` (s) is due.
    pub fn seconds_to_step(&self, params: &Params) -> f64 {
        ((params.dt - self.due) / self.factor(params)).max(0.0)
    }

    /// So many steps took so many real seconds.
    pub fn measured(&mut self, steps: u64, seconds: f64) {
        if steps == 0 || !(seconds >= 0.0 && seconds.is_finite()) {
            return;
        }
        let each = seconds / steps as f64;
        let old = self.seconds_per_step;
        self.seconds_per_step = if old == 0.0 { each } else { old + NEW_SHARE * (each - old) };
    }

    pub fn seconds_per_step(&self) -> f64 {
        self.seconds_per_step
    }

    /// Simulated seconds for each second: measured, and until half a second has passed what it is to be. Zero while paused.
    pub fn speed(&self, params: &Params) -> f64 {
        if self.on { self.speed.unwrap_or_else(|| self.factor(params)) } else { 0.0 }
    }

    /// Simulated seconds for each second, as wanted.
    pub fn factor(&self, params: &Params) -> f64 {
        match self.pace {
            Pace::RealTime => 1.0,
            Pace::Frames => FRAMES_PER_SECOND * params.dt * f64::from(params.substeps),
            Pace::Slow(times) if times >= 1.0 && times.is_finite() => 1.0 / times,
            Pace::Slow(_) => 1.0,
        }
    }
}
