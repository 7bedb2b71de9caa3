//! The tightest spring: the second pass of the certified [limit](super::limit), through the loads of all points.

use super::laws::Laws;
use super::level::Work;
use super::limit::{LOADS, Loads, larger, largest};
use super::plan::{Bundle, Plan};
use super::region::Region;
use super::stripe::{SETS, block};
use super::{BLOCK, GROUP, LANES, Lanes};

/// The largest f, 1/s, and the first block that has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Top {
    pub f: f32,
    pub block: usize,
}

/// f of the loads that a spring's ends have together.
#[inline(always)]
fn demand(omega2: f32, c: f32) -> f32 {
    c + (c * c + 4.0 * omega2).sqrt()
}

/// The same, of the loads of both ends.
#[inline(always)]
pub(super) fn demand_between(near: [f32; LOADS], far: [f32; LOADS]) -> f32 {
    let [omega2, c, held, braked] = near;
    let [far_omega2, far_c, far_held, far_braked] = far;
    demand(omega2 + far_omega2 + larger(held, far_held), c + far_c + larger(braked, far_braked))
}

/// f of a point's anchors alone.
#[inline(always)]
pub(super) fn demand_of_anchors([_, _, held, braked]: [f32; LOADS]) -> f32 {
    demand(held, braked)
}

/// The second pass: the region's top.
pub(super) struct Search<'a> {
    pub loads: &'a mut Loads,
    pub region: &'a Region,
    pub plan: &'a Plan,
    pub laws: &'a Laws,
}

impl Work for Search<'_> {
    type Output = Top;

    #[inline(always)]
    fn run(self) -> Top {
        let Self { loads, region, plan, laws } = self;
        let mut order = std::mem::take(&mut loads.order);
        let blocks = region.blocks.clone();
        order.clear();
        order.extend(blocks.clone().map(|block| (loads.promise(plan, block, blocks.start), block as u32)));
        order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
        let mut top = Top { f: 0.0, block: blocks.start };
        for &(promise, block) in &order {
            if promise < top.f {
                break;
            }
            let f = loads.top(plan, laws, block as usize, blocks.start);
            if f > top.f || f == top.f && (block as usize) < top.block {
                top = Top { f, block: block as usize };
            }
        }
        loads.order = order;
        top
    }
}

impl Loads {
    /// At least f of every spring and every anchor of a block.
    #[inline(always)]
    fn promise(&self, plan: &Plan, block: usize, first_own: usize) -> f32 {
        let own = block - first_own;
        let planned = &plan.blocks[block];
        let mut far = [0.0; LOADS];
        for stripe in &plan.stripes[planned.stripes.clone()] {
            let there = own + stripe.offset / BLOCK;
            far = larger_of_each(far, larger_of_each(self.tops[there], self.tops[there + 1]));
        }
        let promise = demand_between(self.tops[own], far);
        if planned.bundles.is_empty() {
            return promise;
        }
        let ends = own + plan.reach().div_ceil(BLOCK);
        let group = self.tops[own..].iter().take(GROUP);
        let near = group.fold([0.0; LOADS], |top, &other| larger_of_each(top, other));
        let reached = self.tops[own..].iter().take(ends + 1 - own);
        let far = reached.fold([0.0; LOADS], |top, &other| larger_of_each(top, other));
        larger(promise, demand_between(near, far))
    }

    /// The largest f of a block.
    #[inline(always)]
    fn top(&self, plan: &Plan, laws: &Laws, index: usize, first_own: usize) -> f32 {
        let first = (index - first_own) * BLOCK;
        let loads = self.at.all().map(|array| &array[first..]);
        let near = loads.map(block);
        let mut top = [0.0; LANES];
        for stripe in plan.blocks[index].stripes.clone() {
            let far = loads.map(|array| block(&array[plan.stripes[stripe].offset..]));
            let mask = &laws.masks[stripe];
            for set in (0..SETS).filter(|&set| mask[set] != 0) {
                raise(&mut top, near.map(|near| &near[set]), far.map(|far| &far[set]), mask[set]);
            }
        }
        for bundle in plan.blocks[index].bundles.clone() {
            let Bundle { points, rows } = &plan.bundles[bundle];
            let near = loads.map(|array| gather_short(array, points));
            for row in rows.clone() {
                let far = loads.map(|array| gather_short(array, &plan.rows[row]));
                raise(&mut top, near.each_ref(), far.each_ref(), laws.rows[row]);
            }
        }
        for (held, braked) in near[2].iter().zip(near[3]) {
            for lane in 0..LANES {
                top[lane] = larger(top[lane], demand(held[lane], braked[lane]));
            }
        }
        largest(top)
    }
}

/// top = max(top, f) in the lanes whose bit of `mask` is set.
#[inline(always)]
fn raise(top: &mut Lanes, near: [&Lanes; LOADS], far: [&Lanes; LOADS], mask: u32) {
    for lane in 0..LANES {
        let f = demand_between(
            [near[0][lane], near[1][lane], near[2][lane], near[3][lane]],
            [far[0][lane], far[1][lane], far[2][lane], far[3][lane]],
        );
        let is_live = (mask >> lane) & 1 != 0;
        top[lane] = if is_live && f > top[lane] { f } else { top[lane] };
    }
}

#[inline(always)]
fn gather_short(values: &[f32], at: &[u16; LANES]) -> Lanes {
    let mut gathered = [0.0; LANES];
    for lane in 0..LANES {
        gathered[lane] = values[at[lane] as usize];
    }
    gathered
}

#[inline(always)]
fn larger_of_each(a: [f32; LOADS], b: [f32; LOADS]) -> [f32; LOADS] {
    [larger(a[0], b[0]), larger(a[1], b[1]), larger(a[2], b[2]), larger(a[3], b[3])]
}
