//! One pass through a region's blocks: the springs' forces, then all others, then the move.

use glam::Vec3;

use super::aligned::Arrays;
use super::integrate::{self, Doubt, Field, Motion, Response};
use super::laws::Laws;
use super::level::Work;
use super::packed::Force;
use super::plan::Plan;
use super::region::{Forces, Region};
use super::spring::SpringLanes;
use super::stripe::{Block, SETS, Stripes, block_mut, lanes_mut};
use super::{BLOCK, LANES, Lanes, packed, six, stripe};

/// A force on one point that not every point feels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Push {
    /// The point's place in the hidden order.
    pub place: usize,
    pub kind: PushKind,
}

/// What pushes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PushKind {
    /// A force that does not depend on the point's motion, N.
    Constant(Vec3),
    /// A pull towards a place, and a brake on the point's velocity.
    Grab { target: Vec3, stiffness: f32, damping: f32 },
}

/// What is to be done with the forces.
pub(super) enum Purpose<'a> {
    /// Move the points.
    Move,
    /// Leave the points where they are, and move them in the region's other arrays.
    MoveAway,
    /// Write them down for each of the region's own places, N, but for the weight.
    Forces(&'a mut [Vec3]),
}

/// One pass through a region's blocks.
pub(super) struct Sweep<'a> {
    pub region: &'a mut Region,
    pub plan: &'a Plan,
    pub laws: &'a Laws,
    pub field: Field<'a>,
    /// By ascending place; those of one place in the order in which they add up.
    pub pushes: &'a [Push],
    pub purpose: Purpose<'a>,
}

impl Work for Sweep<'_> {
    type Output = bool;

    /// Sweeps. Returns whether every position is finite.
    #[inline(always)]
    fn run(mut self) -> bool {
        let mut springs = SpringLanes::new();
        let mut doubt = Doubt::new();
        for (count, block) in (self.region.first_block..self.region.blocks.end).enumerate() {
            let far = self.region.forces.begin_block(count);
            self.springs(block, far, &mut springs);
            if self.region.blocks.contains(&block) {
                self.points(block, far, &mut doubt);
            }
        }
        doubt.finds_all_finite()
    }
}

impl Sweep<'_> {
    /// The forces of the springs that begin in a block.
    #[inline(always)]
    fn springs(&mut self, block: usize, far_at: usize, springs: &mut SpringLanes) {
        let Self { region, plan, laws, .. } = self;
        let first = region.index(block * BLOCK);
        // All of one length, so that one check is enough for all.
        let len = region.points.len() - first;
        let points = six(region.points.all(), |array| &array[first..][..len]);
        for index in plan.blocks[block].bundles.clone() {
            let forces = &mut region.forces.packed[far_at..];
            packed::accumulate(region.points.onwards(first), plan, laws, index, forces, springs);
        }
        let Forces { near, far, slide, .. } = &mut region.forces;
        let (len, reach) = (far.len() - far_at, slide.far_reach);
        let [far_x, far_y, far_z] = far.all_mut().map(|array| &mut array[far_at..][..len]);
        let [near_x, near_y, near_z] = near.all_mut();
        let [near_x, near_y, near_z] = [block_mut(near_x), block_mut(near_y), block_mut(near_z)];
        let stripes = Stripes::new(plan, laws, block);
        for set in 0..sets_of(plan, block) {
            let at = set * LANES;
            // Nothing else reaches as far as this.
            *lanes_mut(&mut far_x[at + reach..]) = [0.0; LANES];
            *lanes_mut(&mut far_y[at + reach..]) = [0.0; LANES];
            *lanes_mut(&mut far_z[at + reach..]) = [0.0; LANES];
            let ahead = six(points, |array| &array[at..]);
            let far = [&mut far_x[at..], &mut far_y[at..], &mut far_z[at..]];
            let [x, y, z] = stripes.accumulate(set, ahead, far, springs);
            (near_x[set], near_y[set], near_z[set]) = (x, y, z);
        }
    }

    /// The other forces on a block's points, and their move.
    #[inline(always)]
    fn points(&mut self, block: usize, far_at: usize, doubt: &mut Doubt) {
        let Self { region, plan, field, pushes, purpose, .. } = self;
        let first = region.index(block * BLOCK);
        let own = (block - region.blocks.start) * BLOCK;
        let forces = &region.forces;
        let [near_x, near_y, near_z] = forces.near.all();
        let near = [stripe::block(near_x), stripe::block(near_y), stripe::block(near_z)];
        let [far_x, far_y, far_z] = forces.far.all();
        let far = [
            stripe::block(&far_x[far_at..]),
            stripe::block(&far_y[far_at..]),
            stripe::block(&far_z[far_at..]),
        ];
        let packed = forces.packed.get(far_at..far_at + BLOCK);
        let [inverse_mass] = region.inverse_mass.all();
        let inverse_mass = stripe::block(&inverse_mass[first..]);
        let (points, low) = match (&*purpose, &mut region.other) {
            (Purpose::MoveAway, Some([points, low])) => {
                copy(&region.points, points, first);
                copy(&region.low, low, first);
                (points, low)
            }
            _ => (&mut region.points, &mut region.low),
        };
        let mut points = six(points.all_mut(), |array| block_mut(&mut array[first..]));
        let mut low = six(low.all_mut(), |array| block_mut(&mut array[first..]));
        for set in 0..sets_of(plan, block) {
            let mut force = sum(near, far, set);
            if let Some(packed) = packed {
                add_packed(&packed[set * LANES..], &mut force);
            }
            let here = [0, 1, 2, 3, 4, 5];
            for plane in field.planes {
                integrate::push_out(plane, six(here, |part| &points[part][set]), &mut force);
            }
            let place = block * BLOCK + set * LANES;
            let begin = pushes.partition_point(|push| push.place < place);
            for push in pushes[begin..].iter().take_while(|push| push.place < place + LANES) {
                let lane = push.place - place;
                push.add(six(here, |part| points[part][set][lane]), &mut force, lane);
            }
            match purpose {
                Purpose::Move | Purpose::MoveAway => {
                    let [x, y, z, u, v, w] = &mut points;
                    let [x_low, y_low, z_low, u_low, v_low, w_low] = &mut low;
                    let response = Response::new(&inverse_mass[set], *field);
                    let motion = |x, x_low, v, v_low| Motion {
                        position: x,
                        position_low: x_low,
                        velocity: v,
                        velocity_low: v_low,
                    };
                    let along_x = motion(&mut x[set], &mut x_low[set], &mut u[set], &mut u_low[set]);
                    integrate::advance(along_x, &force, &response, 0, field.dt);
                    let along_y = motion(&mut y[set], &mut y_low[set], &mut v[set], &mut v_low[set]);
                    integrate::advance(along_y, &force, &response, 1, field.dt);
                    let along_z = motion(&mut z[set], &mut z_low[set], &mut w[set], &mut w_low[set]);
                    integrate::advance(along_z, &force, &response, 2, field.dt);
                    doubt.look_at([&x_low[set], &y_low[set], &z_low[set]]);
                }
                Purpose::Forces(into) => {
                    let into = &mut into[own + set * LANES..];
                    for (lane, into) in into.iter_mut().take(LANES).enumerate() {
                        *into = Vec3::new(force[0][lane], force[1][lane], force[2][lane]);
                    }
                }
            }
        }
    }
}

/// How many sets of lanes a block has: the last one may have fewer.
#[inline(always)]
fn sets_of(plan: &Plan, block: usize) -> usize {
    (plan.points - block * BLOCK).div_ceil(LANES).min(SETS)
}

/// Copies a block, whose first point is at `first`.
#[inline(always)]
fn copy(from: &Arrays<6>, into: &mut Arrays<6>, first: usize) {
    for (from, into) in from.all().into_iter().zip(into.all_mut()) {
        into[first..first + BLOCK].copy_from_slice(&from[first..first + BLOCK]);
    }
}

/// The stripes' forces on a set of points.
#[inline(always)]
fn sum(near: [&Block; 3], far: [&Block; 3], set: usize) -> [Lanes; 3] {
    let mut sum = [[0.0; LANES]; 3];
    for axis in 0..3 {
        for lane in 0..LANES {
            sum[axis][lane] = near[axis][set][lane] + far[axis][set][lane];
        }
    }
    sum
}

/// Adds packed springs' forces on the points where they end.
#[inline(always)]
fn add_packed(packed: &[Force], force: &mut [Lanes; 3]) {
    let [x, y, z] = force;
    for (lane, packed) in packed.iter().take(LANES).enumerate() {
        x[lane] += packed[0];
        y[lane] += packed[1];
        z[lane] += packed[2];
    }
}

impl Push {
    /// Adds it to the force on a point that is at x, y, z and has the velocity u, v, w.
    #[inline(always)]
    fn add(&self, [x, y, z, u, v, w]: [f32; 6], force: &mut [Lanes; 3], lane: usize) {
        let push = match self.kind {
            PushKind::Constant(force) => force,
            PushKind::Grab { target, stiffness, damping } => {
                (target - Vec3::new(x, y, z)) * stiffness - Vec3::new(u, v, w) * damping
            }
        };
        for (force, along) in force.iter_mut().zip(push.to_array()) {
            force[lane] += along;
        }
    }
}
