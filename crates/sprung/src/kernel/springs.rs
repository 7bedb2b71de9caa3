//! Spring and damper forces on every point.
//!
//! The order of summation, which fixes the bits: each point's force is the sum, in float32, over its live springs in
//! ascending order of their index in the model, starting from zero.
//!
//! Two ways to walk the same springs give that same order. One thread *scatters*: it evaluates each spring once, in
//! order, and adds the force to one end and takes it from the other. Several threads *gather*: each point evaluates all
//! of its own springs, so that no two threads write to the same place. Seen from its other end a spring has the
//! exactly opposite force, bit for bit, because every product in it merely changes sign.
//!
//! Either way springs go through in lanes: a few dozen axes are fetched, their forces computed by plain loops over
//! arrays, of which the compiler makes vector code, and handed out again in order.

use std::sync::{Arc, Mutex};

use glam::Vec3;

use crate::math::COINCIDENT_SQUARED;
use crate::model::Model;
use crate::params::Params;
use crate::workers::Workers;

/// Points whose forces one thread sums at a time.
const BLOCK: usize = 1024;

/// Springs that go through the arithmetic together.
const LANES: usize = 64;

/// What the forces of many springs depend on besides their ends; followed by lanes of zeros, so that any spring
/// begins a whole set of lanes.
#[derive(Debug, Default)]
struct Laws {
    stiffness: Vec<f32>,
    damping: Vec<f32>,
    rest_length: Vec<f32>,
}

impl Laws {
    fn with_len(len: usize) -> Self {
        let zeros = vec![0.0; len + LANES];
        Self { stiffness: zeros.clone(), damping: zeros.clone(), rest_length: zeros }
    }

    fn set(&mut self, at: usize, params: &Params, spring: usize) {
        self.stiffness[at] = params.spring_stiffness[spring];
        self.damping[at] = params.spring_damping[spring];
        self.rest_length[at] = params.spring_rest_length[spring];
    }
}

/// Axes and relative velocities of some springs, and then their forces; x, y and z apart.
struct Lanes {
    axis: [[f32; LANES]; 3],
    velocity: [[f32; LANES]; 3],
    force: [[f32; LANES]; 3],
}

impl Lanes {
    fn new() -> Self {
        let zeros = [[0.0; LANES]; 3];
        Self { axis: zeros, velocity: zeros, force: zeros }
    }

    /// Fills the first lanes with e = x_i − x_j and w = v_i − v_j of some springs.
    #[inline(always)]
    fn fetch(&mut self, ends: &[[u32; 2]], position: &[Vec3], velocity: &[Vec3]) {
        let [ex, ey, ez] = &mut self.axis;
        let [wx, wy, wz] = &mut self.velocity;
        // Said once, so that it need not be checked for every lane.
        assert!(ends.len() <= LANES);
        for (lane, &[i, j]) in ends.iter().enumerate() {
            let (i, j) = (i as usize, j as usize);
            let e = position[i] - position[j];
            let w = velocity[i] - velocity[j];
            (ex[lane], ey[lane], ez[lane]) = (e.x, e.y, e.z);
            (wx[lane], wy[lane], wz[lane]) = (w.x, w.y, w.z);
        }
    }

    /// The force on the first end of each spring, N: F = −(k_s(ℓ − L) + k_d(w·u))·u with ℓ = |e|, u = e/ℓ.
    /// Zero while the ends coincide. Sums of three go from left to right.
    #[inline(always)]
    fn compute(&mut self, laws: &Laws, first: usize) {
        let stiffness = lanes_from(&laws.stiffness, first);
        let damping = lanes_from(&laws.damping, first);
        let rest_length = lanes_from(&laws.rest_length, first);
        let [ex, ey, ez] = &self.axis;
        let [wx, wy, wz] = &self.velocity;
        let [fx, fy, fz] = &mut self.force;
        for lane in 0..LANES {
            let length_squared = ex[lane] * ex[lane] + ey[lane] * ey[lane] + ez[lane] * ez[lane];
            // Coincident ends have no axis: u = e/10⁻¹⁵ m is then zero, without a branch.
            let at_least =
                if length_squared > COINCIDENT_SQUARED { length_squared } else { COINCIDENT_SQUARED };
            let length = at_least.sqrt();
            let inverse = 1.0 / length;
            let (ux, uy, uz) = (ex[lane] * inverse, ey[lane] * inverse, ez[lane] * inverse);
            let speed = wx[lane] * ux + wy[lane] * uy + wz[lane] * uz;
            let tension = stiffness[lane] * (length - rest_length[lane]) + damping[lane] * speed;
            fx[lane] = ux * -tension;
            fy[lane] = uy * -tension;
            fz[lane] = uz * -tension;
        }
    }

    #[inline(always)]
    fn force(&self, lane: usize) -> Vec3 {
        Vec3::new(self.force[0][lane], self.force[1][lane], self.force[2][lane])
    }
}

/// A whole set of lanes, as the fixed-size array that vector code needs.
#[inline(always)]
fn lanes_from(values: &[f32], first: usize) -> &[f32; LANES] {
    values[first..].first_chunk().expect("laws are followed by a set of lanes")
}

/// The live springs of a model under its parameters, packed in the order of their use.
#[derive(Clone, Debug)]
pub(crate) struct SpringKernel {
    /// Shared by clones, as it never changes.
    packed: Arc<Packed>,
    /// The same springs sorted by point, made when several threads first ask for it.
    gather: Option<Gather>,
}

#[derive(Debug)]
struct Packed {
    ends: Vec<[u32; 2]>,
    laws: Laws,
}

impl SpringKernel {
    /// Packs the springs that can move anything.
    pub fn new(model: &Model, params: &Params) -> Self {
        // A point that is carried may be let go: its springs are packed with all others.
        let can_move = |&point: &u32| !params.is_anchored(point as usize);
        let live: Vec<usize> = (0..model.spring_count())
            .filter(|&spring| !params.spring_cut[spring] && model.springs[spring].iter().any(can_move))
            .collect();
        let mut laws = Laws::with_len(live.len());
        for (at, &spring) in live.iter().enumerate() {
            laws.set(at, params, spring);
        }
        let ends = live.iter().map(|&spring| model.springs[spring]).collect();
        Self { packed: Arc::new(Packed { ends, laws }), gather: None }
    }

    /// Adds every spring's force to `forces`, which hold zeros.
    pub fn accumulate(
        &mut self,
        position: &[Vec3],
        velocity: &[Vec3],
        forces: &mut [Vec3],
        workers: &dyn Workers,
    ) {
        if workers.count() == 1 {
            self.scatter(position, velocity, forces);
        } else {
            let Self { packed, gather } = self;
            let Packed { ends, laws } = &**packed;
            let gather = gather.get_or_insert_with(|| Gather::new(ends, laws, position.len()));
            gather.accumulate(position, velocity, forces, workers);
        }
    }

    fn scatter(&self, position: &[Vec3], velocity: &[Vec3], forces: &mut [Vec3]) {
        let Packed { ends, laws } = &*self.packed;
        let mut lanes = Lanes::new();
        for (chunk, ends) in ends.chunks(LANES).enumerate() {
            lanes.fetch(ends, position, velocity);
            lanes.compute(laws, chunk * LANES);
            for (lane, &[i, j]) in ends.iter().enumerate() {
                let force = lanes.force(lane);
                forces[i as usize] += force;
                forces[j as usize] -= force;
            }
        }
    }
}

/// Every spring seen from both ends, sorted by point, in blocks of points.
#[derive(Debug)]
struct Gather {
    /// Where each point's half-springs begin, and the total at the end.
    starts: Arc<Vec<usize>>,
    /// The springs, each by the point itself and the point at the other end.
    packed: Arc<Packed>,
    /// One block's forces each; a lock that is never waited for, as each block has one thread.
    blocks: Vec<Mutex<Vec<Vec3>>>,
}

impl Clone for Gather {
    fn clone(&self) -> Self {
        let blocks = Self::blocks(self.starts.len() - 1);
        Self { starts: self.starts.clone(), packed: self.packed.clone(), blocks }
    }
}

impl Gather {
    fn new(ends: &[[u32; 2]], laws: &Laws, points: usize) -> Self {
        let mut starts = vec![0usize; points + 1];
        for &end in ends.iter().flatten() {
            starts[end as usize + 1] += 1;
        }
        for point in 0..points {
            starts[point + 1] += starts[point];
        }
        let mut next = starts.clone();
        let mut halves = vec![[0u32; 2]; 2 * ends.len()];
        let mut half_laws = Laws::with_len(halves.len());
        for (spring, &[i, j]) in ends.iter().enumerate() {
            for [point, other] in [[i, j], [j, i]] {
                let at = next[point as usize];
                next[point as usize] += 1;
                halves[at] = [point, other];
                half_laws.stiffness[at] = laws.stiffness[spring];
                half_laws.damping[at] = laws.damping[spring];
                half_laws.rest_length[at] = laws.rest_length[spring];
            }
        }
        let packed = Arc::new(Packed { ends: halves, laws: half_laws });
        Self { starts: Arc::new(starts), packed, blocks: Self::blocks(points) }
    }

    fn blocks(points: usize) -> Vec<Mutex<Vec<Vec3>>> {
        let sizes = (0..points).step_by(BLOCK).map(|first| BLOCK.min(points - first));
        sizes.map(|size| Mutex::new(vec![Vec3::ZERO; size])).collect()
    }

    fn accumulate(&self, position: &[Vec3], velocity: &[Vec3], forces: &mut [Vec3], workers: &dyn Workers) {
        let threads = workers.count();
        workers.run(&|worker| {
            let mut lanes = Lanes::new();
            for block in (worker..self.blocks.len()).step_by(threads) {
                self.sum_block(block * BLOCK, &mut lock(&self.blocks[block]), position, velocity, &mut lanes);
            }
        });
        for (sums, forces) in self.blocks.iter().zip(forces.chunks_mut(BLOCK)) {
            forces.copy_from_slice(&lock(sums));
        }
    }

    fn sum_block(
        &self,
        first: usize,
        sums: &mut [Vec3],
        position: &[Vec3],
        velocity: &[Vec3],
        lanes: &mut Lanes,
    ) {
        sums.fill(Vec3::ZERO);
        let halves = self.starts[first]..self.starts[first + sums.len()];
        for begin in halves.clone().step_by(LANES) {
            let end = halves.end.min(begin + LANES);
            let ends = &self.packed.ends[begin..end];
            lanes.fetch(ends, position, velocity);
            lanes.compute(&self.packed.laws, begin);
            for (lane, &[i, _]) in ends.iter().enumerate() {
                sums[i as usize - first] += lanes.force(lane);
            }
        }
    }
}

/// A block's forces; if another thread panicked meanwhile they are overwritten anyway.
fn lock(block: &Mutex<Vec<Vec3>>) -> std::sync::MutexGuard<'_, Vec<Vec3>> {
    block.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}
