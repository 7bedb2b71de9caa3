//! The certified limit of all regions together.

use std::sync::Mutex;

use super::{Team, for_each, lock, own, receive};
use crate::kernel::limit::{Extra, Held, LOADS, Loads, TRUSTED, Weighing, longest_sum, margin};
use crate::kernel::tensor::tensors;
use crate::kernel::tightest::{Search, Top, demand_between, demand_of_anchors};
use crate::kernel::{BLOCK, LANES};
use crate::model::Model;
use crate::params::Params;
use crate::stability::{Limit, Setter};
use crate::workers::Workers;

/// What the limit takes that a step does not: made when it is first asked for.
#[derive(Debug, Default)]
pub(super) struct Certifier {
    /// Of each region.
    loads: Vec<Mutex<Loads>>,
    /// The most numbers that are added up at a point, once it has been counted under these laws.
    longest_sum: Option<usize>,
}

impl Certifier {
    /// The points have been divided anew.
    pub fn forget_regions(&mut self) {
        self.loads.clear();
    }

    /// The springs have other laws.
    pub fn forget_laws(&mut self) {
        self.longest_sum = None;
    }
}

impl Team {
    /// The certified limit of this state, made smaller by all that rounding may have done to it; the same bits for any number
    /// of threads. `None` where float32 does not suffice to say, as where there is no limit at all.
    pub fn certified(&mut self, model: &Model, params: &Params, workers: &dyn Workers) -> Option<Limit> {
        let held = held(model, params);
        let extra = self.loose_tensors();
        let Self { plan, laws, level, regions, borders, are_behind, certifier, .. } = self;
        let Certifier { loads, longest_sum: longest } = certifier;
        if loads.len() != regions.len() {
            let all = regions.iter_mut().map(|region| Mutex::new(Loads::new(plan, own(region))));
            *loads = all.collect();
        }
        let longest = *longest.get_or_insert_with(|| longest_sum(plan, laws));

        for_each(regions.len(), workers, &|index| {
            let (mut region, mut loads) = (lock(&regions[index]), lock(&loads[index]));
            if *are_behind {
                receive(&mut region, &borders[0], index);
            }
            let (region, loads, planes) = (&*region, &mut *loads, &params.planes[..]);
            level.run(Weighing { region, loads, plan, laws, planes, held: &held, extra: &extra });
        });
        *are_behind = false;
        if !loads.iter_mut().all(|loads| own(loads).are_finite()) {
            return None;
        }
        self.exchange_loads();

        let Self { plan, laws, level, regions, certifier, .. } = self;
        let loads = &certifier.loads;
        let tops = Mutex::new(vec![None; regions.len()]);
        for_each(regions.len(), workers, &|index| {
            let (region, mut loads) = (lock(&regions[index]), lock(&loads[index]));
            let top = level.run(Search { loads: &mut loads, region: &region, plan, laws });
            lock(&tops)[index] = Some(top);
        });
        let found = own(&mut { tops }).iter().flatten().fold(None, |best: Option<Top>, top| match best {
            Some(best) if best.f >= top.f => Some(best),
            _ => Some(*top),
        });
        let (f, setter) = self.setter(model, found?)?;
        let dt = 4.0 / f64::from(f) * (1.0 - margin(longest.max(params.planes.len() + 1)));
        TRUSTED.contains(&dt).then(|| Limit { dt, setter: self.blame(model, setter, dt) })
    }

    /// Tells each region the loads of those after it, as far as its springs reach.
    fn exchange_loads(&mut self) {
        let Self { plan, regions, certifier, .. } = self;
        let blocks: Vec<_> = regions.iter_mut().map(|region| own(region).blocks.clone()).collect();
        let beyond = plan.reach().div_ceil(BLOCK);
        for (index, own_blocks) in blocks.iter().enumerate() {
            let (until, after) = certifier.loads.split_at_mut(index + 1);
            let Some(into) = until.last_mut().map(own) else { continue };
            for (other, theirs) in after.iter_mut().map(own).zip(&blocks[index + 1..]) {
                for block in theirs.start..theirs.end.min(own_blocks.end + beyond) {
                    into.copy_block(block - own_blocks.start, other, block - theirs.start);
                }
            }
        }
    }

    /// What has the largest f, and that f: of the springs that begin in the block and have it the first in the user's order, or
    /// else of its points.
    fn setter(&self, model: &Model, top: Top) -> Option<(f32, Setter)> {
        let Self { plan, laws, .. } = self;
        let between =
            |[near, far]: [u32; 2]| demand_between(self.loads_at(near as usize), self.loads_at(far as usize));
        // Loose springs end anywhere and are in no block.
        let live = plan.loose.iter().zip(&laws.loose).filter(|(_, law)| law.is_some());
        let loose = live.map(|(loose, _)| (between(loose.ends), loose.spring));
        let loose = loose.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        if let Some((f, spring)) = loose.filter(|(f, _)| *f > top.f) {
            return Some((f, Setter::Spring(spring as usize)));
        }
        let planned = &plan.blocks[top.block];
        let in_stripes = planned.stripes.clone().flat_map(|index| {
            let springs = plan.springs_of(&plan.stripes[index]).iter().copied();
            springs.filter(move |&spring| {
                let at = model.places(spring)[0] as usize % BLOCK;
                (laws.masks[index][at / LANES] >> (at % LANES)) & 1 != 0
            })
        });
        let rows = plan.bundles[planned.bundles.clone()].iter().flat_map(|bundle| bundle.rows.clone());
        let in_rows = rows.flat_map(|row| {
            let springs = plan.springs_in_row(row).into_iter().enumerate();
            let live = springs.filter(move |(lane, _)| (laws.rows[row] >> lane) & 1 != 0);
            live.filter_map(|(_, spring)| spring).map(|spring| spring as u32)
        });
        let has_it = |spring: &u32| between(model.places(*spring)) == top.f;
        if let Some(spring) = in_stripes.chain(in_rows).filter(has_it).min() {
            return Some((top.f, Setter::Spring(spring as usize)));
        }
        let places = top.block * BLOCK..plan.points.min((top.block + 1) * BLOCK);
        let alike = places.filter(|&place| demand_of_anchors(self.loads_at(place)) == top.f);
        alike.map(|place| model.point_at(place)).min().map(|point| (top.f, Setter::Point(point)))
    }

    /// Where a contact or grab at a spring's end makes more than half of the demand, it is to blame and not the spring.
    fn blame(&self, model: &Model, setter: Setter, dt: f64) -> Setter {
        let Setter::Spring(spring) = setter else { return setter };
        let is_to_blame = |point: &usize| {
            let [_, _, held, braked] = self.loads_at(model.place_of(*point)).map(f64::from);
            dt * dt * held + 2.0 * dt * braked > 2.0
        };
        let ends = model.springs()[spring].map(|end| end as usize);
        ends.into_iter().find(is_to_blame).map_or(setter, Setter::Point)
    }

    /// The loads of a point, by place.
    fn loads_at(&self, place: usize) -> [f32; LOADS] {
        let index = self.region_index(place);
        let first = lock(&self.regions[index]).blocks.start * BLOCK;
        lock(&self.certifier.loads[index]).of(place - first)
    }

    /// The tensors of loose springs at their ends, by place.
    fn loose_tensors(&mut self) -> Vec<Extra> {
        let Self { plan, laws, regions, loose, .. } = self;
        let mut extra = Vec::new();
        let motions = loose.read(plan, regions.iter_mut().map(|region| &*own(region)));
        for ((spring, law), [[near, _], [far, _]]) in plan.loose.iter().zip(&laws.loose).zip(motions) {
            let Some(law) = *law else { continue };
            let tensors = tensors((*near - *far).to_array(), law, true);
            extra.extend(spring.ends.map(|place| (place as usize, tensors)));
        }
        extra.sort_by_key(|(place, _)| *place);
        extra
    }
}

/// Stiffness and damping of all grabs at a point together, by place.
fn held(model: &Model, params: &Params) -> Vec<Held> {
    let mut grabs: Vec<_> = params
        .grabs
        .iter()
        .map(|grab| (model.place_of(grab.point), [grab.stiffness, grab.damping]))
        .collect();
    grabs.sort_by_key(|(place, _)| *place);
    let together = |grabs: &[Held]| {
        let sum = |part: usize| grabs.iter().map(|(_, grab)| f64::from(grab[part])).sum::<f64>() as f32;
        (grabs[0].0, [sum(0), sum(1)])
    };
    grabs.chunk_by(|a, b| a.0 == b.0).map(together).collect()
}
