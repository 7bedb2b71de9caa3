//! What of each body is drawn: what cannot be seen cannot be picked or cut.

use std::ops::Range;

use sprung::Model;
use sprung_render::appearance::Appearance;
use sprung_render::gpu::{joints_shown, shown};

/// What of a body is drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DrawnBody {
    /// Its points.
    pub point_range: Range<usize>,
    /// Its springs.
    pub spring_range: Range<usize>,
    /// Whether points are drawn.
    pub points: bool,
    /// Whether springs are drawn.
    pub springs: bool,
    /// Whether its surface is drawn, and hides what is behind it.
    pub surface: bool,
}

/// What of a model is drawn.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Drawn {
    /// Each body of the model, in order.
    pub bodies: Vec<DrawnBody>,
    /// Springs of joints that are drawn.
    pub joints: Vec<Range<usize>>,
}

impl Drawn {
    /// Follows the same choices as the picture.
    pub fn new(model: &Model, appearance: &Appearance) -> Self {
        let bodies = model.bodies().iter().enumerate().map(|(index, body)| {
            let shown = shown(model, appearance, index);
            let mut surfaces = model.surfaces().iter().filter(|surface| surface.body == index);
            DrawnBody {
                point_range: body.points.clone(),
                spring_range: body.springs.clone(),
                points: shown.points,
                springs: shown.springs,
                surface: surfaces.any(|surface| shown.surface(surface.kind)),
            }
        });
        let joints = model.joints().iter().filter(|_| joints_shown(appearance));
        Self { bodies: bodies.collect(), joints: joints.map(|joint| joint.springs.clone()).collect() }
    }

    /// The springs that are drawn as such.
    pub fn springs(&self) -> impl Iterator<Item = usize> + '_ {
        let bodies = self.bodies.iter().filter(|body| body.springs).map(|body| body.spring_range.clone());
        bodies.chain(self.joints.iter().cloned()).flatten()
    }

    /// The springs that scissors reach: those that are drawn, and those in surfaces.
    pub fn springs_in_reach(&self) -> impl Iterator<Item = usize> + '_ {
        let bodies = self.bodies.iter().filter(|body| body.springs || body.surface);
        bodies.map(|body| body.spring_range.clone()).chain(self.joints.iter().cloned()).flatten()
    }

    /// How many springs a surface covers instead of being drawn.
    pub fn covered_springs(&self) -> usize {
        let covered = self.bodies.iter().filter(|body| body.surface && !body.springs);
        covered.map(|body| body.spring_range.len()).sum()
    }
}
