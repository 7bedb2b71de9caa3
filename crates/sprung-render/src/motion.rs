//! What a picture must know of the whole motion before the first frame is drawn: its extent and its forces.

use sprung::{Model, Params, Vec3};

use crate::camera::Bounds;

/// Springs looked at for the colour scale; of more, an even selection.
const SPRINGS_SAMPLED: usize = 100_000;

/// Extent and forces of a motion, grown frame by frame.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    /// The box around every position so far.
    pub bounds: Bounds,
    /// The largest spring force so far, N, but for the strongest hundredth of a frame's springs.
    pub force: f32,
    scratch: Vec<f32>,
}

impl Motion {
    /// Takes one frame in.
    pub fn include(&mut self, model: &Model, params: &Params, positions: &[Vec3]) {
        positions.iter().for_each(|&position| self.bounds.include(position));
        let stride = model.spring_count().div_ceil(SPRINGS_SAMPLED).max(1);
        self.scratch.clear();
        let forces = (0..model.spring_count()).step_by(stride).map(|spring| {
            spring_force(model, params, positions, spring).abs()
        });
        self.scratch.extend(forces.filter(|force| force.is_finite()));
        if let Some(last) = self.scratch.len().checked_sub(1) {
            let (_, &mut force, _) = self.scratch.select_nth_unstable_by(last - last / 100, f32::total_cmp);
            self.force = self.force.max(force);
        }
    }
}

/// The pull of a spring, k_s(ℓ − L), N: positive in tension, negative in compression, zero when cut.
pub fn spring_force(model: &Model, params: &Params, positions: &[Vec3], spring: usize) -> f32 {
    let [i, j] = model.springs()[spring].map(|point| positions.get(point as usize).copied());
    let (Some(a), Some(b)) = (i, j) else { return 0.0 };
    if params.spring_cut[spring] {
        return 0.0;
    }
    params.spring_stiffness[spring] * ((a - b).length() - params.spring_rest_length[spring])
}
