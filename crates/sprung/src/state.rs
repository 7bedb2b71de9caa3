//! The state: all that a step changes.

use bytemuck::zeroed_vec;
use glam::{DVec3, Vec3};

use crate::energy::LedgerSums;
use crate::math::without_subnormals;

/// All that a step changes. Arrays have one entry per point of the [`Model`](crate::Model), in the user's order.
///
/// Positions and velocities are float32 and carry along what their rounding dropped, so that any number of tiny
/// steps adds up: with dt = 10⁻⁵ s and v = 10 m/s, the increment g·dt would otherwise be rounded by half a per cent.
#[derive(Debug, PartialEq)]
pub struct State {
    /// Steps taken since the start.
    pub step: u64,
    /// Simulated time, s.
    pub time: f64,
    /// Positions x, m.
    pub position: Vec<Vec3>,
    /// What rounding dropped of the positions, m.
    pub position_low: Vec<Vec3>,
    /// Velocities v, m/s. Zero for fixed points.
    pub velocity: Vec<Vec3>,
    /// What rounding dropped of the velocities, m/s.
    pub velocity_low: Vec<Vec3>,
    /// Works done since the start, as far as the ledger is switched on.
    pub ledger: LedgerSums,
    /// Step and time since which dt has not changed: time is their sum with whole steps, not a running sum that drifts.
    pub(crate) clock: (u64, f64),
}

impl Clone for State {
    fn clone(&self) -> Self {
        Self {
            position: self.position.clone(),
            position_low: sparing_copy(&self.position_low),
            velocity: sparing_copy(&self.velocity),
            velocity_low: sparing_copy(&self.velocity_low),
            step: self.step,
            time: self.time,
            ledger: self.ledger,
            clock: self.clock,
        }
    }

    /// Into the memory that is there: a step allocates nothing.
    fn clone_from(&mut self, source: &Self) {
        self.position.clone_from(&source.position);
        self.position_low.clone_from(&source.position_low);
        self.velocity.clone_from(&source.velocity);
        self.velocity_low.clone_from(&source.velocity_low);
        let Self { step, time, ledger, clock, .. } = *source;
        (self.step, self.time, self.ledger, self.clock) = (step, time, ledger, clock);
    }
}

impl State {
    /// A state at time zero.
    pub fn new(position: Vec<Vec3>, velocity: Vec<Vec3>) -> Self {
        let low = || zeroed_vec(position.len());
        Self {
            step: 0,
            time: 0.0,
            position_low: low(),
            velocity_low: low(),
            position,
            velocity,
            ledger: LedgerSums::default(),
            clock: (0, 0.0),
        }
    }

    /// Step and time (s) since which dt has not changed: time is their sum with whole steps. For whoever stores a state.
    pub fn clock(&self) -> (u64, f64) {
        self.clock
    }

    /// Sets what [`clock`](Self::clock) gives. One that does not show this state's time is started anew when a simulation
    /// goes on from the state.
    pub fn set_clock(&mut self, clock: (u64, f64)) {
        self.clock = clock;
    }

    /// Its step, time and sums, without a point.
    pub(crate) fn counters(&self) -> Self {
        Self::at_origin(self, 0)
    }

    /// With this step, time and these sums, and so many points at the origin and at rest.
    pub(crate) fn at_origin(counters: &Self, points: usize) -> Self {
        let Self { step, time, ledger, clock, .. } = *counters;
        Self { step, time, ledger, clock, ..Self::new(zeroed_vec(points), zeroed_vec(points)) }
    }

    /// Takes out denormal numbers, which no step leaves behind. Writes only where there is one.
    pub(crate) fn drop_subnormals(&mut self) {
        let Self { position, position_low, velocity, velocity_low, .. } = self;
        for vector in [position, position_low, velocity, velocity_low].into_iter().flatten() {
            if vector.to_array().iter().any(|value| value.is_subnormal()) {
                *vector = without_subnormals(*vector);
            }
        }
    }

    /// One step of `dt` (s) has passed.
    pub(crate) fn tick(&mut self, dt: f64) {
        self.step += 1;
        self.time = self.clock.1 + (self.step - self.clock.0) as f64 * dt;
    }

    /// Starts the clock anew unless it shows this state's time: a state that was put together by hand has none.
    pub(crate) fn check_clock(&mut self, dt: f64) {
        let (step, time) = self.clock;
        if self.step < step || time + (self.step - step) as f64 * dt != self.time {
            self.restart_clock();
        }
    }

    /// From here on steps have another length.
    pub(crate) fn restart_clock(&mut self) {
        self.clock = (self.step, self.time);
    }

    /// A fingerprint of positions, velocities and step, the same on every machine.
    ///
    /// 64-bit FNV-1a over the little-endian bytes of: the step (u64), every position (x, y, z as float32), every velocity.
    pub fn hash(&self) -> u64 {
        let mut hash = Fnv::new();
        hash.write(&self.step.to_le_bytes());
        for vector in self.position.iter().chain(&self.velocity) {
            for component in vector.to_array() {
                hash.write(&component.to_le_bytes());
            }
        }
        hash.0
    }

    /// Position of a point in float64, with what rounding dropped.
    pub(crate) fn position64(&self, point: usize) -> DVec3 {
        self.position[point].as_dvec3() + self.position_low[point].as_dvec3()
    }

    /// Velocity of a point in float64, with what rounding dropped.
    pub(crate) fn velocity64(&self, point: usize) -> DVec3 {
        self.velocity[point].as_dvec3() + self.velocity_low[point].as_dvec3()
    }
}

/// A copy. One of zeros alone, as most of a first state is, takes no memory from the system until something is written to
/// it.
fn sparing_copy(vectors: &[Vec3]) -> Vec<Vec3> {
    let bits: &[u32] = bytemuck::cast_slice(vectors);
    if bits.iter().all(|&bits| bits == 0) { zeroed_vec(vectors.len()) } else { vectors.to_vec() }
}

/// A picture of a state that nobody else writes to: the user's order, xyz interleaved.
#[derive(Debug, Default, PartialEq)]
pub struct Snapshot {
    /// Steps taken since the start.
    pub step: u64,
    /// Simulated time, s.
    pub time: f64,
    /// Positions, m.
    pub positions: Vec<Vec3>,
    /// Velocities, m/s.
    pub velocities: Vec<Vec3>,
}

impl Clone for Snapshot {
    fn clone(&self) -> Self {
        let (positions, velocities) = (self.positions.clone(), self.velocities.clone());
        Self { step: self.step, time: self.time, positions, velocities }
    }

    /// Into the memory that is there.
    fn clone_from(&mut self, source: &Self) {
        (self.step, self.time) = (source.step, source.time);
        self.positions.clone_from(&source.positions);
        self.velocities.clone_from(&source.velocities);
    }
}

impl Snapshot {
    /// Copies a state into this buffer.
    pub fn fill(&mut self, state: &State) {
        self.step = state.step;
        self.time = state.time;
        self.positions.clone_from(&state.position);
        self.velocities.clone_from(&state.velocity);
    }
}

/// Where the points are and how fast they go at one moment, to read from: that of a [`State`], with what rounding
/// dropped, or that of a [`Snapshot`].
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    high: [&'a [Vec3]; 2],
    low: Option<[&'a [Vec3]; 2]>,
}

impl<'a> From<&'a State> for Moment<'a> {
    fn from(state: &'a State) -> Self {
        Self {
            high: [&state.position, &state.velocity],
            low: Some([&state.position_low, &state.velocity_low]),
        }
    }
}

impl<'a> From<&'a Snapshot> for Moment<'a> {
    fn from(snapshot: &'a Snapshot) -> Self {
        Self { high: [&snapshot.positions, &snapshot.velocities], low: None }
    }
}

impl Moment<'_> {
    /// Whether there is an entry for each of so many points.
    pub(crate) fn has(&self, points: usize) -> bool {
        self.high.iter().chain(self.low.iter().flatten()).all(|vectors| vectors.len() == points)
    }

    /// Where a point is, m.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn position(&self, point: usize) -> DVec3 {
        self.vector(0, point)
    }

    /// How fast a point goes, m/s.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn velocity(&self, point: usize) -> DVec3 {
        self.vector(1, point)
    }

    fn vector(&self, which: usize, point: usize) -> DVec3 {
        let low = self.low.map_or(DVec3::ZERO, |low| low[which][point].as_dvec3());
        self.high[which][point].as_dvec3() + low
    }
}

/// FNV-1a, 64 bits (Fowler, Noll, Vo): five lines that any language can repeat.
pub(crate) struct Fnv(pub u64);

impl Fnv {
    pub fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    pub fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_has_the_same_bits_zeros_and_their_signs_included() {
        for low in [0.0, -0.0, 1e-9] {
            let mut state = State::new(vec![Vec3::ONE; 3], vec![Vec3::ZERO; 3]);
            state.position_low[2].z = low;
            let copy = state.clone();
            assert_eq!(copy, state);
            assert_eq!(copy.position_low[2].z.to_bits(), low.to_bits());
            assert_eq!(copy.hash(), state.hash());
        }
    }
}
