//! The energies of a state in the layout of the step: one pass that costs less than a step, and how far it may be off.
//!
//! The pass takes each spring's length in float32, from positions without what rounding dropped of them, and all else in
//! float64. So it is a *screen*: where its [`bound`](Screen::bound) leaves no doubt, nobody needs the exact
//! [`Energy::of`](crate::Energy::of), which takes every spring in float64 and in the user's order.
//!
//! *The bound.* Let u = 2⁻²⁴, the most by which rounding to float32 is off in proportion.
//!
//! - The mass is found as 1/(1/m), with both divisions rounded: it is off by 2u. So is kinetic energy; that of height is off
//!   by 2u·Σ m|g·x|. Depths below planes have the very bits of `Energy::of`.
//! - The root of elastic energy is a norm of the stretches d = ℓ − L: √E = ‖d‖, where ‖a‖² = Σ ½k a². Hence with d̂ the computed
//!   ones, √Ê and √E differ by no more than ‖d̂ − d‖. A component of the axis is rounded once (u), squared (u more) and added up
//!   (2u more): that makes 5u of ℓ², 2.5u of ℓ, and 3.5u with the root's own rounding. The difference ℓ − L adds u|d|, the
//!   residues that are left out 2λ, with λ the longest of any point. As |ℓ| ≤ |d| + L,
//!
//!   ```text
//!   ‖d̂ − d‖ ≤ r = 4.5u(‖d‖ + ‖L‖) + 2λ‖1‖        |Ê − E| ≤ 2√E·r + r²
//!   ```
//!
//!   and the products k·d·d are off by another 2u of E. Below float32's range a square may hide a length of 10⁻²² m, which is
//!   added to λ, and a product 10⁻⁴⁵ J.
//! - A sum of n numbers in float64, in whatever order, is off by n·2⁻⁵³ of the sum of their sizes.
//!
//! The sum of these is doubled, which is ample for all terms of second order in u.

use glam::Vec3;

use super::laws::Laws;
use super::level::Work;
use super::packed::{gather, window};
use super::plan::{Bundle, Plan};
use super::region::Region;
use super::spring::LawLanes;
use super::stripe::{SETS, block};
use super::{BLOCK, LANES, Lanes, six};
use crate::contact::Plane;
use crate::energy::Energy;
use crate::math;

/// The most by which rounding to float32 is off, in proportion.
const U: f64 = 0.5 * f32::EPSILON as f64;

/// A length that a square below float32's range may hide, m.
const HIDDEN_LENGTH: f64 = 1e-22;

/// What all springs together may hide below float32's range, J.
const HIDDEN_ENERGY: f64 = 1e-35;

/// Partial sums that are kept apart, so that vectors can be added.
const WAYS: usize = 16;

/// Partial sums.
type Partial = [f64; WAYS];

/// The energies of a state, and how far they may be off.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Screen {
    /// The energies, without the ledger's sums.
    pub energy: Energy,
    /// The most by which they are off, all errors together, J. Infinite or NaN where an energy is.
    pub bound: f64,
}

/// What some points and the springs that begin there add to the energies.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    kinetic: f64,
    gravitational: f64,
    elastic: f64,
    contact: f64,
    /// Σ m|g·x|, J.
    height: f64,
    /// The largest component of what rounding dropped of a position, m.
    residue: f32,
}

/// Sums over springs that do not depend on the state, for the bound.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Norms {
    /// Σ ½k, N/m.
    pub ones: f64,
    /// Σ ½k L², J.
    pub rest_lengths: f64,
}

impl Screen {
    /// From the sums over all blocks.
    pub(super) fn new(sums: Sums, norms: Norms, plan: &Plan) -> Self {
        let Sums { kinetic, gravitational, elastic, contact, height, .. } = sums;
        let residue = 3f64.sqrt() * f64::from(sums.residue) + HIDDEN_LENGTH;
        let root = elastic.sqrt();
        let root_off = 4.5 * U * (root + norms.rest_lengths.sqrt()) + 2.0 * residue * norms.ones.sqrt();
        let elastic_off = (2.0 * root + root_off) * root_off + HIDDEN_ENERGY;
        let numbers = (plan.points + plan.springs) as f64;
        let rounding = 2.0 * U + numbers * f64::EPSILON;
        let size = kinetic + height + elastic + contact;
        Self {
            energy: Energy { kinetic, gravitational, elastic, contact, ..Energy::default() },
            bound: 2.0 * (elastic_off + rounding * size),
        }
    }
}

impl Sums {
    /// Adds those of another block.
    pub fn add(&mut self, block: &Self) {
        self.kinetic += block.kinetic;
        self.gravitational += block.gravitational;
        self.elastic += block.elastic;
        self.contact += block.contact;
        self.height += block.height;
        self.residue = self.residue.max(block.residue);
    }

    /// Adds one spring of this law (k_s, k_d, L) between two positions.
    pub fn add_spring(&mut self, [stiffness, _, rest_length]: [f32; 3], [near, far]: [Vec3; 2]) {
        let stretch = math::distance(near, far) - rest_length;
        self.elastic += 0.5 * f64::from(stiffness * stretch * stretch);
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
        for index in 0..self.region.blocks.len() {
            let block = self.region.blocks.start + index;
            self.region.energies[index] = Sums { elastic: 0.5 * self.springs(block), ..self.points(block) };
        }
    }
}

impl Survey<'_> {
    /// Σ k(ℓ − L)² over the springs that begin in a block, J.
    #[inline(always)]
    fn springs(&self, index: usize) -> f64 {
        let Self { region, plan, laws, .. } = self;
        let first = region.index(index * BLOCK);
        let [x, y, z, ..] = six(region.points.all(), |array| &array[first..]);
        let points = [x, y, z];
        let near = points.map(block);
        let mut sum = [0.0; WAYS];
        for stripe in plan.blocks[index].stripes.clone() {
            let far = points.map(|array| block(&array[plan.stripes[stripe].offset..]));
            let (law, mask) = (&laws.stripes[stripe], &laws.masks[stripe]);
            for set in (0..SETS).filter(|&set| mask[set] != 0) {
                let squared = squared_lengths(near.map(|near| &near[set]), far.map(|far| &far[set]));
                add_stretch(&mut sum, &squared, laws.values.lanes(law, set), mask[set]);
            }
        }
        for bundle in plan.blocks[index].bundles.clone() {
            let Bundle { points: begins, rows } = &plan.bundles[bundle];
            let [x, y, z, ..] = region.points.onwards(first);
            let windows = [x, y, z].map(window);
            let near = windows.map(|array| gather(array, begins));
            for (set, row) in rows.clone().enumerate() {
                let far = windows.map(|array| gather(array, &plan.rows[row]));
                let squared = squared_lengths(near.each_ref(), far.each_ref());
                add_stretch(
                    &mut sum,
                    &squared,
                    laws.values.lanes(&laws.bundles[bundle], set),
                    laws.rows[row],
                );
            }
        }
        total(sum)
    }

    /// The energies of a block's points by themselves.
    #[inline(always)]
    fn points(&self, index: usize) -> Sums {
        let Self { region, plan, gravity, planes, .. } = self;
        let first = region.index(index * BLOCK);
        let high = six(region.points.all(), |array| block(&array[first..]));
        let low = six(region.low.all(), |array| block(&array[first..]));
        let [inverse_mass] = region.inverse_mass.all().map(|array| block(&array[first..]));
        let [gx, gy, gz] = gravity.as_dvec3().to_array();
        let mut residues = [0.0f32; LANES];
        let [mut kinetic, mut lift, mut height, mut contact] = [[0.0; WAYS]; 4];
        let len = BLOCK.min(plan.points - index * BLOCK);
        for set in 0..len.div_ceil(LANES).min(SETS) {
            // What no force can move has no energy of its own: a mass of zero.
            let mut mass = [0.0; LANES];
            for lane in 0..LANES {
                let inverse = inverse_mass[set][lane];
                mass[lane] = if inverse > 0.0 { 1.0 / inverse } else { 0.0 };
            }
            let [mut x, mut y, mut z] = [[0.0; LANES]; 3];
            let [mut moving, mut lifted, mut high_up, mut pressed] = [[0.0; LANES]; 4];
            for lane in 0..LANES {
                let mass = f64::from(mass[lane]);
                let u = f64::from(high[3][set][lane]) + f64::from(low[3][set][lane]);
                let v = f64::from(high[4][set][lane]) + f64::from(low[4][set][lane]);
                let w = f64::from(high[5][set][lane]) + f64::from(low[5][set][lane]);
                moving[lane] = mass * (u * u + v * v + w * w);
                x[lane] = f64::from(high[0][set][lane]) + f64::from(low[0][set][lane]);
                y[lane] = f64::from(high[1][set][lane]) + f64::from(low[1][set][lane]);
                z[lane] = f64::from(high[2][set][lane]) + f64::from(low[2][set][lane]);
                lifted[lane] = mass * (gx * x[lane] + gy * y[lane] + gz * z[lane]);
                high_up[lane] = lifted[lane].abs();
            }
            for plane in planes.iter() {
                press(plane, [&x, &y, &z], &mass, &mut pressed);
            }
            for low in &low[..3] {
                for lane in 0..LANES {
                    let size = low[set][lane].abs();
                    residues[lane] = if size > residues[lane] { size } else { residues[lane] };
                }
            }
            add(&mut kinetic, &moving);
            add(&mut lift, &lifted);
            add(&mut height, &high_up);
            add(&mut contact, &pressed);
        }
        Sums {
            kinetic: 0.5 * total(kinetic),
            gravitational: -total(lift),
            elastic: 0.0,
            contact: total(contact),
            height: total(height),
            residue: largest(residues),
        }
    }
}

/// Adds ½k_c p² of the points that are below a plane and can move.
#[inline(always)]
fn press(plane: &Plane, [x, y, z]: [&[f64; LANES]; 3], mass: &Lanes, energy: &mut [f64; LANES]) {
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
fn squared_lengths(near: [&Lanes; 3], far: [&Lanes; 3]) -> Lanes {
    let mut squared = [0.0; LANES];
    for lane in 0..LANES {
        let x = near[0][lane] - far[0][lane];
        let y = near[1][lane] - far[1][lane];
        let z = near[2][lane] - far[2][lane];
        squared[lane] = x * x + y * y + z * z;
    }
    squared
}

/// Adds k(ℓ − L)² of the lanes whose bit of `mask` is set.
#[inline(always)]
fn add_stretch(sum: &mut Partial, squared: &Lanes, law: LawLanes<'_>, mask: u32) {
    // One loop for each kind of law: the choice is made out here.
    let energy = match law {
        LawLanes::Same([k, _, rest]) => stretch(squared, mask, |_| (k, rest)),
        LawLanes::Lengths([k, _], rest) => stretch(squared, mask, |lane| (k, rest[lane])),
        LawLanes::Each([k, _, rest]) => stretch(squared, mask, |lane| (k[lane], rest[lane])),
    };
    for energies in energy.as_chunks::<WAYS>().0 {
        for way in 0..WAYS {
            sum[way] += f64::from(energies[way]);
        }
    }
}

#[inline(always)]
fn stretch(squared: &Lanes, mask: u32, law: impl Fn(usize) -> (f32, f32)) -> Lanes {
    let mut energy = [0.0; LANES];
    for lane in 0..LANES {
        let (stiffness, rest_length) = law(lane);
        let stretch = squared[lane].sqrt() - rest_length;
        energy[lane] = if (mask >> lane) & 1 != 0 { stiffness * stretch * stretch } else { 0.0 };
    }
    energy
}

#[inline(always)]
fn add(sum: &mut Partial, values: &[f64; LANES]) {
    for values in values.as_chunks::<WAYS>().0 {
        for way in 0..WAYS {
            sum[way] += values[way];
        }
    }
}

/// The sum of partial sums, by halves.
#[inline(always)]
fn total(mut sum: Partial) -> f64 {
    let mut half = WAYS / 2;
    while half > 0 {
        for way in 0..half {
            sum[way] += sum[way + half];
        }
        half /= 2;
    }
    sum[0]
}

/// The largest of all lanes, by halves.
#[inline(always)]
fn largest(mut values: Lanes) -> f32 {
    let mut half = LANES / 2;
    while half > 0 {
        for lane in 0..half {
            let other = values[lane + half];
            values[lane] = if other > values[lane] { other } else { values[lane] };
        }
        half /= 2;
    }
    values[0]
}
