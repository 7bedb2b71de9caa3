//! The energies of a state in the layout of the step, in float64: one pass that costs about as much as a step.
//!
//! It takes positions and velocities with what rounding dropped of them, as [`Energy::of`](crate::Energy::of) does, which
//! goes through springs and points one after another in the user's order. The two differ by the order of their sums and by
//! how a root is found.
//!
//! *The root.* Float64 roots and divisions are several times as slow as those of float32. So the length ℓ = √q of a spring is
//! the float32 root s of q, corrected once by Newton's method, with the division in float32 too:
//!
//! ```text
//! ℓ ≈ s + (q − s²)·h    h = ½/s
//! ```
//!
//! With u = 2⁻²⁴, the most by which rounding to float32 is off in proportion: q is off by u, its root by u/2, and that is
//! rounded, so s = ℓ(1 + δ) with |δ| ≤ 1.5u. The square of s is exact in float64. Newton's method leaves ½δ²ℓ, and h, off by
//! u, leaves δuℓ: together 2.7u² ≈ 10⁻¹⁴ of ℓ. Elastic energy is the square of a norm of the stretches ℓ − L, so
//!
//! ```text
//! |√Ê − √E| ≤ 10⁻¹⁴·(√E + √(Σ ½k_s L²))
//! ```
//!
//! Where q is too small or too large for a float32, s is made zero or is infinite, and the sum is no finite number. A block
//! with such a sum is taken once more, with float64 roots.
//!
//! *The order of sums* is that of the layout: springs and points of a block by lane, lanes by halves, blocks from the first
//! to the last, and then loose springs. Threads do not enter into it.

use glam::{DVec3, Vec3};

use super::aligned::Arrays;
use super::laws::Laws;
use super::level::Work;
use super::packed::{gather, window};
use super::plan::{Bundle, Plan, WINDOW};
use super::region::Region;
use super::spring::LawLanes;
use super::stripe::SETS;
use super::{BLOCK, LANES, Lanes, six, stripe};
use crate::contact::Plane;
use crate::energy::Energy;
use crate::math::COINCIDENT_SQUARED;

/// Blocks, at the least, before the positions that their springs reach are moved to the front of their arrays.
const LEAST_SLIDE: usize = 32;

/// A float64 for each of the springs that go through together, or of so many points.
type Wide = [f64; LANES];

/// What some points and the springs that begin there have of each energy, J.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    pub kinetic: f64,
    gravitational: f64,
    elastic: f64,
    contact: f64,
}

impl Sums {
    /// Adds those of another block.
    pub fn add(&mut self, block: &Self) {
        self.kinetic += block.kinetic;
        self.gravitational += block.gravitational;
        self.elastic += block.elastic;
        self.contact += block.contact;
    }

    /// Adds one spring of this law (k_s, k_d, L) between two positions.
    pub fn add_spring(&mut self, [stiffness, _, rest_length]: [f32; 3], [near, far]: [DVec3; 2]) {
        let stretch = near.distance(far) - f64::from(rest_length);
        self.elastic += 0.5 * f64::from(stiffness) * stretch * stretch;
    }

    /// The energies, without the ledger's sums.
    pub fn energy(self) -> Energy {
        let Self { kinetic, gravitational, elastic, contact } = self;
        Energy { kinetic, gravitational, elastic, contact, ..Energy::default() }
    }
}

/// Float64 positions of a block and of the points where its springs end, made as the pass goes on: little enough to stay
/// in the cache.
#[derive(Clone, Debug)]
pub(super) struct WidePositions {
    arrays: Arrays<3, f64>,
    /// Blocks in a slide.
    slide: usize,
    /// How far beyond a block its springs reach.
    reach: usize,
}

impl WidePositions {
    /// For a region of so many blocks.
    pub fn new(plan: &Plan, blocks: usize) -> Self {
        let reach = plan.reach().next_multiple_of(LANES);
        let slide = blocks.clamp(1, LEAST_SLIDE.max(2 * reach / BLOCK));
        let window = if plan.bundles.is_empty() { 0 } else { WINDOW };
        Self { arrays: Arrays::with_windows(slide * BLOCK + reach, window), slide, reach }
    }

    /// Before the block that is looked at as number `count`, whose points begin these arrays: where they are among the
    /// float64 positions. Makes those that this block is the first to need.
    #[inline(always)]
    fn begin_block(&mut self, count: usize, high: [&[f32]; 6], low: [&[f32]; 6]) -> usize {
        let Self { slide, reach, .. } = *self;
        let first = count % slide * BLOCK;
        let begun = slide * BLOCK..slide * BLOCK + reach;
        let new = if count == 0 { 0..reach + BLOCK } else { reach..reach + BLOCK };
        for ((wide, high), low) in self.arrays.all_mut().into_iter().zip(high).zip(low) {
            if count > 0 && first == 0 {
                wide.copy_within(begun.clone(), 0);
            }
            let wide = &mut wide[first + new.start..first + new.end];
            for ((wide, &high), &low) in wide.iter_mut().zip(&high[new.clone()]).zip(&low[new.clone()]) {
                *wide = f64::from(high) + f64::from(low);
            }
        }
        first
    }
}

/// One pass through a region's blocks for their energies, which it leaves in the region.
pub(super) struct Survey<'a> {
    pub region: &'a mut Region,
    pub plan: &'a Plan,
    pub laws: &'a Laws,
    pub gravity: Vec3,
    pub planes: &'a [Plane],
}

impl Work for Survey<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (count, block) in self.region.blocks.clone().enumerate() {
            let first = self.region.index(block * BLOCK);
            let Region { points, low, wide, .. } = &mut *self.region;
            let [points, low] = [points, low].map(|arrays| six(arrays.all(), |array| &array[first..]));
            let at = wide.begin_block(count, points, low);
            let quick = self.springs::<false>(block, at);
            let elastic = if quick.is_finite() { quick } else { self.springs::<true>(block, at) };
            let [gravitational, contact] = self.points(block, at);
            let kinetic = kinetic(self.region, block);
            self.region.energies[count] = Sums { kinetic, gravitational, elastic, contact };
        }
    }
}

impl Survey<'_> {
    /// Σ ½k(ℓ − L)² over the springs that begin in a block, whose float64 positions begin at `at`, J.
    #[inline(always)]
    fn springs<const EXACT_ROOTS: bool>(&self, index: usize, at: usize) -> f64 {
        let Self { region, plan, laws, .. } = self;
        let points = region.wide.arrays.all().map(|array| &array[at..]);
        let near = points.map(stripe::block);
        let mut sum = [0.0; LANES];
        for stripe in plan.blocks[index].stripes.clone() {
            let far = points.map(|array| stripe::block(&array[plan.stripes[stripe].offset..]));
            let (law, mask) = (&laws.stripes[stripe], &laws.masks[stripe]);
            for set in (0..SETS).filter(|&set| mask[set] != 0) {
                let squares = squares(near.map(|near| &near[set]), far.map(|far| &far[set]));
                let lengths = lengths::<EXACT_ROOTS>(&squares);
                add_stretch(&mut sum, &lengths, laws.values.lanes(law, set), mask[set]);
            }
        }
        for bundle in plan.blocks[index].bundles.clone() {
            let Bundle { points: begins, rows } = &plan.bundles[bundle];
            let windows = region.wide.arrays.onwards(at).map(window);
            let near = windows.map(|array| gather(array, begins));
            for (set, row) in rows.clone().enumerate() {
                let far = windows.map(|array| gather(array, &plan.rows[row]));
                let lengths = lengths::<EXACT_ROOTS>(&squares(near.each_ref(), far.each_ref()));
                let law = laws.values.lanes(&laws.bundles[bundle], set);
                add_stretch(&mut sum, &lengths, law, laws.rows[row]);
            }
        }
        0.5 * total(sum)
    }

    /// −Σ m g·x and Σ ½k_c p² over a block's points that forces can move, J.
    #[inline(always)]
    fn points(&self, index: usize, at: usize) -> [f64; 2] {
        let Self { region, gravity, planes, .. } = self;
        let [x, y, z] = region.wide.arrays.all().map(|array| stripe::block(&array[at..]));
        let mass = masses(region, index);
        let [gx, gy, gz] = gravity.as_dvec3().to_array();
        let [mut lift, mut contact] = [[0.0; LANES]; 2];
        for set in 0..SETS {
            for lane in 0..LANES {
                let height = gx * x[set][lane] + gy * y[set][lane] + gz * z[set][lane];
                lift[lane] += f64::from(mass[set][lane]) * height;
            }
            for plane in planes.iter() {
                press(plane, [&x[set], &y[set], &z[set]], &mass[set], &mut contact);
            }
        }
        [-total(lift), total(contact)]
    }
}

/// One pass through a region's blocks for their kinetic energies alone, which it leaves in the region.
pub(super) struct KineticSurvey<'a>(pub &'a mut Region);

impl Work for KineticSurvey<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (count, block) in self.0.blocks.clone().enumerate() {
            self.0.energies[count].kinetic = kinetic(self.0, block);
        }
    }
}

/// Σ ½mv² over a block's points that forces can move, J.
#[inline(always)]
fn kinetic(region: &Region, index: usize) -> f64 {
    let first = region.index(index * BLOCK);
    let high = six(region.points.all(), |array| stripe::block(&array[first..]));
    let low = six(region.low.all(), |array| stripe::block(&array[first..]));
    let mass = masses(region, index);
    let mut sum = [0.0; LANES];
    for set in 0..SETS {
        for lane in 0..LANES {
            let speed = |part: usize| f64::from(high[part][set][lane]) + f64::from(low[part][set][lane]);
            let (u, v, w) = (speed(3), speed(4), speed(5));
            sum[lane] += f64::from(mass[set][lane]) * (u * u + v * v + w * w);
        }
    }
    0.5 * total(sum)
}

/// The masses of a block's points, kg: zero where no force can move a point, or where there is none.
#[inline(always)]
fn masses(region: &Region, index: usize) -> &stripe::Block {
    let [mass] = region.mass.all();
    stripe::block(&mass[region.index(index * BLOCK)..])
}

/// Adds ½k_c p² of the points that are below a plane and can move.
#[inline(always)]
fn press(plane: &Plane, [x, y, z]: [&Wide; 3], mass: &Lanes, energy: &mut Wide) {
    let (point, normal) = (plane.point.as_dvec3(), plane.normal.as_dvec3());
    let stiffness = 0.5 * f64::from(plane.stiffness);
    for lane in 0..LANES {
        let along_x = (point.x - x[lane]) * normal.x;
        let along_y = (point.y - y[lane]) * normal.y;
        let along_z = (point.z - z[lane]) * normal.z;
        let depth = along_x + along_y + along_z;
        let stored = stiffness * depth * depth;
        energy[lane] += if depth > 0.0 && mass[lane] > 0.0 { stored } else { 0.0 };
    }
}

#[inline(always)]
fn squares(near: [&Wide; 3], far: [&Wide; 3]) -> Wide {
    let mut squares = [0.0; LANES];
    for lane in 0..LANES {
        let x = near[0][lane] - far[0][lane];
        let y = near[1][lane] - far[1][lane];
        let z = near[2][lane] - far[2][lane];
        squares[lane] = x * x + y * y + z * z;
    }
    squares
}

/// The roots of squares, to 10⁻¹⁴ of them; not finite where a square is beyond float32, unless roots are to be exact.
#[inline(always)]
fn lengths<const EXACT_ROOTS: bool>(squares: &Wide) -> Wide {
    let mut lengths = [0.0; LANES];
    if EXACT_ROOTS {
        for lane in 0..LANES {
            lengths[lane] = squares[lane].sqrt();
        }
        return lengths;
    }
    let [mut roots, mut halves] = [[0.0; LANES]; 2];
    for lane in 0..LANES {
        let square = squares[lane] as f32;
        // Also keeps denormal numbers out, which have fewer digits.
        let root = if square > COINCIDENT_SQUARED { square } else { 0.0 }.sqrt();
        roots[lane] = root;
        halves[lane] = 0.5 / root;
    }
    for lane in 0..LANES {
        let root = f64::from(roots[lane]);
        lengths[lane] = root + (squares[lane] - root * root) * f64::from(halves[lane]);
    }
    lengths
}

/// Adds k(ℓ − L)² of the lanes whose bit of `mask` is set.
#[inline(always)]
fn add_stretch(sum: &mut Wide, lengths: &Wide, law: LawLanes<'_>, mask: u32) {
    // One loop for each kind of law: the choice is made out here.
    match law {
        LawLanes::Same([k, _, rest]) => add_stretch_by(sum, lengths, mask, |_| (k, rest)),
        LawLanes::Lengths([k, _], rest) => add_stretch_by(sum, lengths, mask, |lane| (k, rest[lane])),
        LawLanes::Each([k, _, rest]) => add_stretch_by(sum, lengths, mask, |lane| (k[lane], rest[lane])),
    }
}

#[inline(always)]
fn add_stretch_by(sum: &mut Wide, lengths: &Wide, mask: u32, law: impl Fn(usize) -> (f32, f32)) {
    for lane in 0..LANES {
        let (stiffness, rest_length) = law(lane);
        let stretch = lengths[lane] - f64::from(rest_length);
        let energy = f64::from(stiffness) * stretch * stretch;
        sum[lane] += if (mask >> lane) & 1 != 0 { energy } else { 0.0 };
    }
}

/// The sum of all lanes, by halves.
#[inline(always)]
fn total(mut sum: Wide) -> f64 {
    let mut half = LANES / 2;
    while half > 0 {
        for way in 0..half {
            sum[way] += sum[way + half];
        }
        half /= 2;
    }
    sum[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Squares of all sizes, those next to powers of two among them, where rounding is worst.
    #[test]
    fn a_length_is_off_by_no_more_than_stated() {
        let u = 2f64.powi(-24);
        let bound = 2.625 * u * u + 2.0 * f64::EPSILON;
        let mut worst = 0f64;
        for exponent in -99..127 {
            for start in [1.0, 1.3, 1.999] {
                let squares = std::array::from_fn(|lane| {
                    2f64.powi(exponent) * (start + 1e-7 * 0.618_033_988_749_895 * lane as f64)
                });
                let (quick, exact) = (lengths::<false>(&squares), lengths::<true>(&squares));
                for (quick, exact) in quick.into_iter().zip(exact) {
                    worst = worst.max((quick - exact).abs() / exact);
                }
            }
        }
        assert!(worst <= bound, "{worst:e}, over {bound:e}");
    }

    #[test]
    fn a_square_beyond_float32_gives_no_finite_length() {
        for square in [0.0, 1e-300, 1e-45, 1e-31, 1e39, 1e77, f64::INFINITY, f64::NAN] {
            assert!(!lengths::<false>(&[square; LANES])[0].is_finite(), "{square:e}");
        }
        assert_eq!(lengths::<true>(&[1e77; LANES])[0], 1e77f64.sqrt());
    }
}
