//! What a picture must know of the whole motion before the first frame is drawn: its extent and its forces.

use sprung::{Model, Params, Result, Vec3};
use sprung_io::{Pack, RunInfo, Unpack};

use crate::camera::{Bounds, Framing, Side};
use crate::overlay::free_area;

/// Springs looked at for the colour scale; of more, an even selection.
const SPRINGS_SAMPLED: usize = 100_000;

/// Extent and forces of a motion, grown frame by frame.
#[derive(Clone, Debug)]
pub struct Motion {
    /// The size of the pictures, pixels.
    pub(crate) size: [u32; 2],
    /// The box around every position so far.
    pub bounds: Bounds,
    /// How the two sides would see it.
    front: Framing,
    corner: Framing,
    /// The largest spring force so far, N, but for the strongest hundredth of a frame's springs.
    pub force: f32,
    scratch: Vec<f32>,
}

impl Motion {
    /// No motion yet, to be shown in pictures of this size (width and height in pixels).
    pub fn new(info: &RunInfo, size: [u32; 2]) -> Self {
        let (low, high) = free_area(info, size);
        let [front, corner] = [Side::Front, Side::Corner].map(|side| Framing::new(side, low, high));
        Self { size, bounds: Bounds::default(), front, corner, force: 0.0, scratch: Vec::new() }
    }

    /// For the mark of a checkpoint: all that was learnt from the frames so far.
    pub(crate) fn pack(&self, pack: &mut Pack) {
        pack.vec3(self.bounds.low).vec3(self.bounds.high).f32(self.force);
        [&self.front, &self.corner].into_iter().flat_map(Framing::extent).for_each(|number| {
            pack.f64(number);
        });
    }

    /// The other way round, for pictures of the same run and size.
    pub(crate) fn unpack(info: &RunInfo, size: [u32; 2], unpack: &mut Unpack<'_>) -> Result<Self> {
        let empty = Self::new(info, size);
        let bounds = Bounds { low: unpack.vec3()?, high: unpack.vec3()? };
        let force = unpack.f32()?;
        let mut framing = |framing: Framing| -> Result<Framing> {
            let mut extent = [0.0; 5];
            for number in &mut extent {
                *number = unpack.f64()?;
            }
            Ok(framing.with_extent(extent))
        };
        let (front, corner) = (framing(empty.front)?, framing(empty.corner)?);
        Ok(Self { bounds, force, front, corner, ..empty })
    }

    /// The view that suits the motion: nearly from the front if it is flat.
    pub(crate) fn framing(&self) -> Framing {
        let size = self.bounds.grown(0.0).size();
        if size.z < 0.15 * size.x.max(size.y) { self.front } else { self.corner }
    }

    /// Takes one frame in.
    pub fn include(&mut self, model: &Model, params: &Params, positions: &[Vec3]) {
        for &position in positions {
            self.bounds.include(position);
            self.front.include(position, 0.0);
            self.corner.include(position, 0.0);
        }
        let stride = model.spring_count().div_ceil(SPRINGS_SAMPLED).max(1);
        self.scratch.clear();
        let forces = (0..model.spring_count())
            .step_by(stride)
            .map(|spring| spring_force(model, params, positions, spring).abs());
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
