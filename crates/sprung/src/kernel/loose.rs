//! Springs whose ends lie so far apart that no sweep has both at hand.
//!
//! Before the sweeps their ends are read from whichever regions have them, their forces computed one by one, and handed
//! to the sweeps as pushes on single points. In which order is settled when the plan is made: a step sorts nothing. A region
//! only moves points of its own, so of all pushes it takes those on its own places, and loose springs ask for no border.

use glam::Vec3;

use super::laws::Laws;
use super::plan::Plan;
use super::region::Region;
use super::spring::tension;
use super::sweep::{Push, PushKind};
use crate::math;

/// A spring whose ends lie far apart in the hidden order.
#[derive(Clone, Copy, Debug)]
pub(super) struct Loose {
    pub spring: u32,
    /// Places of the two ends.
    pub ends: [u32; 2],
}

/// One end of a loose spring.
#[derive(Clone, Copy, Debug)]
pub(super) struct LooseEnd {
    pub place: u32,
    /// Which of the plan's loose springs it belongs to.
    pub loose: u32,
    /// 0 or 1.
    pub end: u8,
}

/// No force: x + (−0) is x for every x, where −0 + 0 would be 0.
const NOTHING: Vec3 = Vec3::splat(-0.0);

/// Position and velocity of both ends of a plan's loose springs, in its order, while they are needed.
#[derive(Clone, Debug)]
pub(super) struct LooseMotions(Vec<[[Vec3; 2]; 2]>);

/// Both ends of some loose springs by ascending place; of one place in the order in which their forces add up.
pub(super) fn ends_by_place(springs: &[Loose]) -> Vec<LooseEnd> {
    let mut ends: Vec<LooseEnd> = Vec::with_capacity(2 * springs.len());
    for (loose, spring) in springs.iter().enumerate() {
        ends.extend([0, 1].map(|end| LooseEnd {
            place: spring.ends[usize::from(end)],
            loose: loose as u32,
            end,
        }));
    }
    ends.sort_by_key(|end| end.place);
    ends
}

impl LooseMotions {
    /// Memory for a plan's loose springs.
    pub fn new(plan: &Plan) -> Self {
        Self(vec![[[Vec3::ZERO; 2]; 2]; plan.loose.len()])
    }

    /// Looks up how the ends move now. `regions` are all there are, in order.
    pub fn read<'a>(&mut self, plan: &Plan, regions: impl Iterator<Item = &'a Region>) -> &[[[Vec3; 2]; 2]] {
        let mut ends = &plan.loose_ends[..];
        for region in regions {
            let (here, beyond) = ends.split_at(ends.partition_point(|end| region.is_before_end(end.place)));
            let arrays = region.points.all();
            for end in here {
                let at = region.index(end.place as usize);
                let [x, y, z, u, v, w] = arrays.map(|array| array[at]);
                let motion = [Vec3::new(x, y, z), Vec3::new(u, v, w)];
                self.0[end.loose as usize][usize::from(end.end)] = motion;
            }
            ends = beyond;
        }
        &self.0
    }

    /// Adds their pushes, as read last, to others; all are by ascending place, and at one place these are the first.
    pub fn merge_into(&self, pushes: &mut Vec<Push>, plan: &Plan, laws: &Laws) {
        let push_of = |end: &LooseEnd| {
            let loose = end.loose as usize;
            let on_first = laws.loose[loose].map(|law| pull(law, self.0[loose]));
            let force = on_first.map_or(NOTHING, |force| if end.end == 0 { force } else { -force });
            Push { place: end.place as usize, kind: PushKind::Constant(force) }
        };
        // From the last one on, so that each finds its place free.
        let (mut others, ends) = (pushes.len(), &plan.loose_ends);
        let mut free = others + ends.len();
        pushes.resize(free, Push { place: 0, kind: PushKind::Constant(NOTHING) });
        for end in ends.iter().rev() {
            while let Some(last) = others.checked_sub(1)
                && pushes[last].place >= end.place as usize
            {
                (free, others) = (free - 1, last);
                pushes[free] = pushes[last];
            }
            free -= 1;
            pushes[free] = push_of(end);
        }
    }
}

/// The force on the first end of one spring, N.
fn pull(law: [f32; 3], [[x_i, v_i], [x_j, v_j]]: [[Vec3; 2]; 2]) -> Vec3 {
    let (axis, apart) = (x_i - x_j, v_i - v_j);
    axis * -tension(math::dot(axis, axis), math::dot(apart, axis), law)
}
