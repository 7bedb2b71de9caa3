//! The certified limit on dt in the layout of the step: what [`certified`](crate::stability::certified) finds in float64, never
//! above it, and hardly below.
//!
//! Two passes. The first adds up the [`tensor`](super::tensor)s of the springs at each point, as a step does their forces, and
//! takes the [largest eigenvalue](super::eigenvalue) of each sum by the point's mass: the point's *loads* ω² and c. The second
//! looks for the spring with the largest
//!
//! ```text
//! f = c + √(c² + 4ω²)        dt = 4/f        of the loads of both its ends together
//! ```
//!
//! block after block: those first whose largest loads promise most. When none that is left can have a larger f, it is found;
//! mostly that is soon. Which spring it is, where several share the largest f: of the first block of the hidden order that
//! has one, the first in the user's order. So neither threads nor vectors decide on it, nor on a single bit of the limit.
//!
//! *The margin.* Let u = 2⁻²⁴, and n the most numbers that are added up one after another at a point.
//!
//! - The difference of two positions is off by u in each component: that turns the axis and changes its length by no more. The
//!   square of what is then the axis is off by 3u, 1/ℓ by 3.5u. With it h is off by 6u, and a product of two components of n by
//!   9u. What h is off moves stiffness from along the spring to across or back, by that part of k; with the roundings of
//!   products and sums, B is off by less than 20u·k and D by less than 13u·k_d, in the norm of matrices.
//! - To add up n of them is off by n·u of the sum of their sizes. As the trace of B is at least k, the largest eigenvalue of
//!   the sum is at least ⅓Σk, and so it is off by 3(20 + n)u of itself; that of D by 3(13 + n)u.
//! - The [eigenvalue](super::eigenvalue::ERROR) by itself adds 40u, the inverse mass and its product 2u.
//! - In f an error of c counts whole at the most, and one of ω² half: 3(13 + n)u is more than half of 3(20 + n)u. Sums, root and
//!   square add 4u.
//!
//! Anchors are sums of as many numbers as there are planes, and one for the grabs; n is no smaller than that. All together
//! f is off by 3n + [`MARGIN`] in units of u, to the first order; one part in ten thousand of it covers all other orders, and
//! what lies below float32's range. The limit is made smaller by that. Limits that are not [`TRUSTED`], where that range does
//! not suffice, are not given.

use std::ops::RangeInclusive;

use super::aligned::Arrays;
use super::eigenvalue;
use super::laws::Laws;
use super::level::Work;
use super::packed::{Force, gather, window};
use super::plan::{Bundle, Plan};
use super::region::{Region, Slide};
use super::stripe::{SETS, block, block_mut};
use super::tensor::{self, PARTS, Tensors};
use super::{BLOCK, LANES, Lanes};
use crate::contact::Plane;

/// The margin without what the length of the sums adds, in units of u.
const MARGIN: f64 = 3.0 * 13.0 + eigenvalue::ERROR + 2.0 + 4.0;

/// Limits that float32 can be trusted with, s: more than all step lengths that are allowed.
pub(super) const TRUSTED: RangeInclusive<f64> = 5e-10..=1e4;

/// Loads of a point or of several: ω² and c of its springs, ω² and c of its anchors (1/s², 1/s).
pub(super) const LOADS: usize = 4;

/// What packed springs add up at a point lies side by side, four numbers in each of so many arrays.
const FOURS: usize = PARTS / 4;

/// Sums at the points of a block from stripes that begin there; a vector begins at a cache line.
#[repr(C, align(64))]
struct Near([[Lanes; PARTS]; SETS]);

/// A region's sums, and what comes of them.
#[derive(Debug)]
pub(super) struct Loads {
    /// From stripes that end at a point.
    far: Arrays<PARTS>,
    /// From packed springs, at either end.
    packed: [Vec<Force>; FOURS],
    slide: Slide,
    /// Of each point of its own blocks, and of those in blocks after it where its springs may end.
    pub at: Arrays<LOADS>,
    /// The largest of each block.
    pub tops: Vec<[f32; LOADS]>,
    /// Zero, unless a load is infinite or NaN.
    doubt: f32,
    /// Blocks in the order in which they are looked at, and how much each promises.
    pub order: Vec<(f32, u32)>,
}

/// Stiffness and damping that hold a point in space, by place: those of its grabs together.
pub(super) type Held = (usize, [f32; 2]);

/// A tensor that is added to a point's by itself, by place.
pub(super) type Extra = (usize, Tensors);

impl Loads {
    pub fn new(plan: &Plan, region: &Region) -> Self {
        let beyond = plan.reach().div_ceil(BLOCK);
        let blocks = region.blocks.len() + beyond;
        let slide = Slide::new(plan, region.blocks.end - region.first_block);
        Self {
            far: Arrays::new(slide.len()),
            packed: std::array::from_fn(|_| vec![[0.0; 4]; slide.packed_len()]),
            slide,
            // A block more, where stripes end that have no spring at the end of the last one.
            at: Arrays::new((blocks + 1) * BLOCK),
            tops: vec![[0.0; LOADS]; blocks + 1],
            doubt: 0.0,
            order: Vec::with_capacity(region.blocks.len()),
        }
    }

    /// Copies a block of another region, whose own it is as number `from`, to number `to` here.
    pub fn copy_block(&mut self, to: usize, other: &Self, from: usize) {
        let (to_place, from_place) = (to * BLOCK, from * BLOCK);
        for (into, values) in self.at.all_mut().into_iter().zip(other.at.all()) {
            into[to_place..to_place + BLOCK].copy_from_slice(&values[from_place..from_place + BLOCK]);
        }
        self.tops[to] = other.tops[from];
    }

    /// Whether all loads are numbers.
    pub fn are_finite(&self) -> bool {
        self.doubt == 0.0
    }

    /// The loads at a place, from the region's first own one.
    pub fn of(&self, at: usize) -> [f32; LOADS] {
        self.at.all().map(|loads| loads[at])
    }
}

#[inline(always)]
pub(super) fn larger(a: f32, b: f32) -> f32 {
    if b > a { b } else { a }
}

/// The first pass.
pub(super) struct Weighing<'a> {
    pub region: &'a Region,
    pub loads: &'a mut Loads,
    pub plan: &'a Plan,
    pub laws: &'a Laws,
    pub planes: &'a [Plane],
    /// By ascending place.
    pub held: &'a [Held],
    /// By ascending place.
    pub extra: &'a [Extra],
}

impl Work for Weighing<'_> {
    type Output = ();

    #[inline(always)]
    fn run(mut self) {
        let mut near = Near([[[0.0; LANES]; PARTS]; SETS]);
        let mut doubt = [0.0; LANES];
        for (count, block) in (self.region.first_block..self.region.blocks.end).enumerate() {
            let Loads { far, packed, slide, .. } = &mut *self.loads;
            let reach = slide.far_reach;
            let far_at = slide.begin_block(count, far, packed);
            for sums in far.all_mut() {
                sums[far_at + reach..][..BLOCK].fill(0.0);
            }
            near.0.as_flattened_mut().as_flattened_mut().fill(0.0);
            self.springs(block, far_at, &mut near);
            if self.region.blocks.contains(&block) {
                self.points(block, far_at, &near, &mut doubt);
            }
        }
        self.loads.doubt = doubt.iter().sum();
    }
}

impl Weighing<'_> {
    /// The tensors of the springs that begin in a block.
    #[inline(always)]
    fn springs(&mut self, block_index: usize, far_at: usize, Near(near_sums): &mut Near) {
        let Self { region, loads, plan, laws, .. } = self;
        let first = region.index(block_index * BLOCK);
        let [x, y, z, ..] = region.points.all();
        let points = [&x[first..], &y[first..], &z[first..]];
        let near = points.map(block);
        let Loads { far: far_sums, packed, .. } = &mut **loads;
        let mut far_sums = far_sums.all_mut();
        let planned = &plan.blocks[block_index];
        for index in planned.stripes.clone() {
            let (law, mask) = (&laws.stripes[index], &laws.masks[index]);
            let offset = plan.stripes[index].offset;
            let far = points.map(|array| block(&array[offset..]));
            let mut far_sums = far_sums.each_mut().map(|array| block_mut(&mut array[far_at + offset..]));
            for set in (0..SETS).filter(|&set| mask[set] != 0) {
                let ends = [near.map(|block| &block[set]), far.map(|block| &block[set])];
                let far_sums = far_sums.each_mut().map(|sums| &mut sums[set]);
                let law = laws.values.lanes(law, set);
                tensor::accumulate(ends, law, mask[set], &mut near_sums[set], far_sums);
            }
        }
        for index in planned.bundles.clone() {
            let [x, y, z, ..] = region.points.onwards(first);
            bundle([x, y, z], plan, laws, index, packed.each_mut().map(|sums| &mut sums[far_at..]));
        }
    }

    /// The loads of a block's points.
    #[inline(always)]
    fn points(&mut self, index: usize, far_at: usize, Near(near): &Near, doubt: &mut Lanes) {
        let Self { region, loads, plan, planes, held, extra, .. } = self;
        let first = region.index(index * BLOCK);
        let [x, y, z, ..] = region.points.all().map(|array| block(&array[first..]));
        let [inverse_mass] = region.inverse_mass.all().map(|array| block(&array[first..]));
        let far = loads.far.all().map(|array| block(&array[far_at..]));
        let own = index - region.blocks.start;
        let at = loads.at.all_mut().map(|array| block_mut(&mut array[own * BLOCK..]));
        let mut tops = [[0.0; LANES]; LOADS];
        for set in 0..SETS {
            let far = far.map(|sums| &sums[set]);
            let mut sums = [[0.0; LANES]; PARTS];
            for lane in 0..LANES {
                for part in 0..PARTS {
                    sums[part][lane] = near[set][part][lane] + far[part][lane];
                }
            }
            if !plan.bundles.is_empty() {
                for (packed, sums) in loads.packed.iter().zip(sums.as_chunks_mut::<4>().0) {
                    let [a, b, c, d] = sums;
                    add_packed(&packed[far_at + set * LANES..], a, b, c, d);
                }
            }
            let place = index * BLOCK + set * LANES;
            for (at, tensors) in of_lanes(extra, place) {
                sums.iter_mut().zip(tensors).for_each(|(sum, part)| sum[at - place] += part);
            }
            let [xx, yy, zz, xy, xz, yz, damped @ ..] = &sums;
            load([xx, yy, zz, xy, xz, yz], &inverse_mass[set], &mut at[0][set]);
            load(damped.each_ref(), &inverse_mass[set], &mut at[1][set]);
            let [mut stiffness, mut damping] = [[0.0; LANES]; 2];
            for plane in planes.iter() {
                touch(plane, [&x[set], &y[set], &z[set]], &mut stiffness, &mut damping);
            }
            for &(at, [k, d]) in of_lanes(held, place) {
                stiffness[at - place] += k;
                damping[at - place] += d;
            }
            for lane in 0..LANES {
                at[2][set][lane] = stiffness[lane] * inverse_mass[set][lane];
                at[3][set][lane] = damping[lane] * inverse_mass[set][lane];
            }
            for (top, at) in tops.iter_mut().zip(&at) {
                for lane in 0..LANES {
                    let load = at[set][lane];
                    top[lane] = larger(top[lane], load);
                    doubt[lane] += 0.0 * load;
                }
            }
        }
        loads.tops[own] = tops.map(largest);
    }
}

/// Adds the tensors of one bundle; `points` and `sums` from the group's first point on.
#[inline(always)]
fn bundle(points: [&[f32]; 3], plan: &Plan, laws: &Laws, index: usize, mut sums: [&mut [Force]; FOURS]) {
    let (Bundle { points: begins, rows }, law) = (&plan.bundles[index], &laws.bundles[index]);
    let points = points.map(window);
    let near = points.map(|array| gather(array, begins));
    let mut at_near = [[0.0; LANES]; PARTS];
    for (set, row) in rows.clone().enumerate() {
        let ends = &plan.rows[row];
        let far = points.map(|array| gather(array, ends));
        let law = laws.values.lanes(law, set);
        let parts = tensor::of_lanes(near.each_ref(), far.each_ref(), law, laws.rows[row]);
        for lane in 0..LANES {
            for part in 0..PARTS {
                at_near[part][lane] += parts[part][lane];
            }
        }
        hand_out(&parts, ends, &mut sums);
    }
    hand_out(&at_near, begins, &mut sums);
}

/// Adds tensors to those of some points, one after another, as the same point may be there twice.
#[inline(always)]
fn hand_out(parts: &[Lanes; PARTS], points: &[u16; LANES], sums: &mut [&mut [Force]; FOURS]) {
    for (sums, [a, b, c, d]) in sums.iter_mut().zip(parts.as_chunks::<4>().0) {
        // Side by side first, so that they are added as vectors.
        let mut lanes = [[0.0; 4]; LANES];
        for lane in 0..LANES {
            lanes[lane] = [a[lane], b[lane], c[lane], d[lane]];
        }
        for (&point, four) in points.iter().zip(&lanes) {
            let sum = &mut sums[point as usize];
            *sum = [sum[0] + four[0], sum[1] + four[1], sum[2] + four[2], sum[3] + four[3]];
        }
    }
}

/// Adds packed springs' tensors at a set of points.
#[inline(always)]
fn add_packed(packed: &[Force], a: &mut Lanes, b: &mut Lanes, c: &mut Lanes, d: &mut Lanes) {
    let Some(packed) = packed.first_chunk::<LANES>() else { return };
    for lane in 0..LANES {
        a[lane] += packed[lane][0];
        b[lane] += packed[lane][1];
        c[lane] += packed[lane][2];
        d[lane] += packed[lane][3];
    }
}

/// The largest eigenvalues of some tensors, by mass.
#[inline(always)]
fn load([xx, yy, zz, xy, xz, yz]: [&Lanes; 6], inverse_mass: &Lanes, loads: &mut Lanes) {
    for lane in 0..LANES {
        let tensor = [xx[lane], yy[lane], zz[lane], xy[lane], xz[lane], yz[lane]];
        loads[lane] = eigenvalue::largest(tensor) * inverse_mass[lane];
    }
}

/// Adds a plane's stiffness and damping where points touch it.
#[inline(always)]
fn touch(plane: &Plane, [x, y, z]: [&Lanes; 3], stiffness: &mut Lanes, damping: &mut Lanes) {
    // The normal enters the force twice, and float32 lets it be a little longer than 1.
    let normal = plane.normal.as_dvec3();
    let squared = normal.dot(normal);
    let (k, d) = ((f64::from(plane.stiffness) * squared) as f32, (f64::from(plane.damping) * squared) as f32);
    let (point, normal) = (plane.point, plane.normal);
    for lane in 0..LANES {
        let along_x = (point.x - x[lane]) * normal.x;
        let along_y = (point.y - y[lane]) * normal.y;
        let along_z = (point.z - z[lane]) * normal.z;
        let touches = along_x + along_y + along_z > 0.0;
        stiffness[lane] += if touches { k } else { 0.0 };
        damping[lane] += if touches { d } else { 0.0 };
    }
}

/// The largest of all lanes, by halves; none is NaN.
#[inline(always)]
pub(super) fn largest(mut values: Lanes) -> f32 {
    let mut half = LANES / 2;
    while half > 0 {
        for lane in 0..half {
            values[lane] = larger(values[lane], values[lane + half]);
        }
        half /= 2;
    }
    values[0]
}

/// Those of some entries, which are sorted by place, that are at a set of lanes.
#[inline(always)]
fn of_lanes<T>(entries: &[(usize, T)], place: usize) -> impl Iterator<Item = &(usize, T)> {
    let begin = entries.partition_point(|(at, _)| *at < place);
    entries[begin..].iter().take_while(move |(at, _)| *at < place + LANES)
}

/// The most numbers that are added up one after another at a point.
pub(super) fn longest_sum(plan: &Plan, laws: &Laws) -> usize {
    let mut counts = vec![[0u32; 3]; plan.blocks.len() * BLOCK + plan.reach() + BLOCK];
    for (index, planned) in plan.blocks.iter().enumerate() {
        let first = index * BLOCK;
        for stripe in planned.stripes.clone() {
            let offset = plan.stripes[stripe].offset;
            for at in 0..BLOCK {
                let live = (laws.masks[stripe][at / LANES] >> (at % LANES)) & 1;
                counts[first + at][0] += live;
                counts[first + at + offset][1] += live;
            }
        }
        for Bundle { points, rows } in &plan.bundles[planned.bundles.clone()] {
            for row in rows.clone() {
                for lane in 0..LANES {
                    let live = (laws.rows[row] >> lane) & 1;
                    counts[first + points[lane] as usize][2] += live;
                    counts[first + plan.rows[row][lane] as usize][2] += live;
                }
            }
        }
    }
    for place in plan.loose.iter().flat_map(|loose| loose.ends) {
        counts[place as usize].iter_mut().for_each(|count| *count += 1);
    }
    // And one more where the three come together.
    counts.iter().flatten().max().map_or(1, |&most| most as usize + 1)
}

/// By which part a limit is made smaller, for sums of at most so many numbers.
pub(super) fn margin(longest_sum: usize) -> f64 {
    let units = (MARGIN + 3.0 * longest_sum as f64) * 1.0001;
    0.5 * f64::from(f32::EPSILON) * units
}
