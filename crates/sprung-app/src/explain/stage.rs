//! The stages of a step, in order: one list for the formulas, the key that goes through them, and the arrows of the view.

/// A stage of one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Springs and their dampers pull at their ends.
    Springs,
    /// Gravity, the ground and hands pull at points.
    Forces,
    /// Velocities follow the forces.
    Velocity,
    /// Positions follow the new velocities.
    Position,
}

/// A stage as people see it.
pub struct StageInfo {
    /// The stage.
    pub stage: Stage,
    /// A few words.
    pub name: &'static str,
    /// Its formula, in the markup of the formulas (`x_i`, `k_{s}`).
    pub formula: &'static str,
    /// What happens, in a sentence.
    pub meaning: &'static str,
}

/// All stages of a step, in order.
pub static STAGES: [StageInfo; 4] = [
    StageInfo {
        stage: Stage::Springs,
        name: "Springs pull",
        formula: "f_i += −k_s (ℓ − L) u − k_d ((v_i − v_j)·u) u",
        meaning: "Each spring pulls its two ends together as far as it is stretched, and its damper brakes them as fast as they \
                  part. The point at the other end, j, gets exactly the opposite.",
    },
    StageInfo {
        stage: Stage::Forces,
        name: "Gravity, ground, hand",
        formula: "f_i += m_i g + (k_c p − k_{c,d} v_n) n + F",
        meaning: "Gravity pulls every point down. The ground pushes back points that are a depth p below it. A hand or an outer \
                  force F pulls where there is one.",
    },
    StageInfo {
        stage: Stage::Velocity,
        name: "Velocity follows force",
        formula: "v_i += (f_i/m_i) dt",
        meaning: "All forces together change the velocity: force over mass, for as long as the step lasts. Fixed points stay.",
    },
    StageInfo {
        stage: Stage::Position,
        name: "Position follows velocity",
        formula: "x_i += v_i dt",
        meaning: "The point moves, with its new velocity. That little word makes the method stable: with the old velocity every \
                  swing would grow. Then all forces are set to zero, and the next step begins.",
    },
];

impl Stage {
    /// The stage after this one; none after the last, where the step is done.
    pub fn next(self) -> Option<Self> {
        let here = STAGES.iter().position(|info| info.stage == self)?;
        STAGES.get(here + 1).map(|info| info.stage)
    }
}
