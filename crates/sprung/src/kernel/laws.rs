//! Stiffness, damping and rest length of every spring, packed in the order of their use: one number where all springs
//! that go through together share it.

use super::plan::Plan;
use super::spring::LawLanes;
use super::stripe::Mask;
use super::{BLOCK, LANES, Lanes};
use crate::model::Model;
use crate::params::Params;

/// Where the laws of a stripe or a bundle are.
#[derive(Clone, Copy, Debug)]
pub(super) enum Law {
    /// The same for all: k_s, k_d, L.
    Same([f32; 3]),
    /// k_s and k_d the same, L from this set of lanes on.
    Lengths([f32; 2], u32),
    /// All of them for each spring, from this set of lanes on: each set of k_s, k_d and L in turn.
    Each(u32),
}

/// Values for each lane.
#[derive(Clone, Debug, Default)]
pub(super) struct Values(Vec<Lanes>);

/// The springs' laws under some parameters.
#[derive(Clone, Debug, Default)]
pub(crate) struct Laws {
    pub values: Values,
    pub stripes: Vec<Law>,
    /// Which lanes of each stripe are springs that are not cut.
    pub masks: Vec<Mask>,
    pub bundles: Vec<Law>,
    /// Which lanes of each row are springs that are not cut.
    pub rows: Vec<u32>,
    /// k_s, k_d and L of the loose springs; none if it is cut.
    pub loose: Vec<Option<[f32; 3]>>,
}

impl Laws {
    pub fn new(plan: &Plan, model: &Model, params: &Params) -> Self {
        let mut laws = Self::default();
        laws.fill(plan, model, params);
        laws
    }

    /// Packs them anew, into the memory that is there.
    pub fn fill(&mut self, plan: &Plan, model: &Model, params: &Params) {
        let Self { values, stripes, masks, bundles, rows, loose } = self;
        values.0.clear();
        stripes.clear();
        masks.clear();
        bundles.clear();
        rows.clear();
        loose.clear();
        let is_live = |spring: &usize| !params.spring_cut[*spring];
        let law_of = |spring: usize| {
            let (k, d) = (params.spring_stiffness[spring], params.spring_damping[spring]);
            [k, d, params.spring_rest_length[spring]]
        };
        for stripe in &plan.stripes {
            let springs = plan.springs_of(stripe);
            let mut mask = Mask::default();
            let place = |spring: u32| model.places(spring)[0] as usize % BLOCK;
            let live = || springs.iter().map(|&spring| spring as usize).filter(is_live);
            for spring in live() {
                let place = place(spring as u32);
                mask[place / LANES] |= 1 << (place % LANES);
            }
            masks.push(mask);
            let shared = Shared::of(live().map(law_of));
            let law = values.push(shared, BLOCK / LANES, |put| {
                live().for_each(|spring| put(place(spring as u32), law_of(spring)));
            });
            stripes.push(law);
        }
        for bundle in &plan.bundles {
            let live_rows = || {
                bundle.rows.clone().map(|row| plan.springs_in_row(row).map(|spring| spring.filter(is_live)))
            };
            for springs in live_rows() {
                let bit = |(lane, spring): (usize, &Option<usize>)| u32::from(spring.is_some()) << lane;
                rows.push(springs.iter().enumerate().map(bit).sum());
            }
            let shared = Shared::of(live_rows().flatten().flatten().map(law_of));
            let law = values.push(shared, bundle.rows.len(), |put| {
                for (row, springs) in live_rows().enumerate() {
                    for (lane, spring) in springs.into_iter().enumerate() {
                        put(row * LANES + lane, spring.map_or([0.0; 3], law_of));
                    }
                }
            });
            bundles.push(law);
        }
        loose.extend(plan.loose.iter().map(|loose| Some(loose.spring as usize).filter(is_live).map(law_of)));
    }
}

/// Which numbers some springs share.
struct Shared {
    law: [f32; 3],
    material: bool,
    length: bool,
}

impl Shared {
    fn of(mut laws: impl Iterator<Item = [f32; 3]>) -> Self {
        let law = laws.next().unwrap_or_default();
        let mut shared = Self { law, material: true, length: true };
        for [k, d, rest] in laws {
            shared.material &= k == law[0] && d == law[1];
            shared.length &= rest == law[2];
        }
        shared
    }
}

impl Values {
    /// Packs the laws of so many sets of lanes. `fill` is given what puts a law at a lane.
    fn push(
        &mut self,
        shared: Shared,
        sets: usize,
        fill: impl FnOnce(&mut dyn FnMut(usize, [f32; 3])),
    ) -> Law {
        let [k, d, rest] = shared.law;
        let first = self.0.len();
        match shared {
            Shared { material: true, length: true, .. } => Law::Same([k, d, rest]),
            Shared { material: true, .. } => {
                self.0.resize(first + sets, [0.0; LANES]);
                fill(&mut |lane, law| self.0[first + lane / LANES][lane % LANES] = law[2]);
                Law::Lengths([k, d], first as u32)
            }
            _ => {
                self.0.resize(first + 3 * sets, [0.0; LANES]);
                fill(&mut |lane, law| {
                    for (part, value) in law.into_iter().enumerate() {
                        self.0[first + 3 * (lane / LANES) + part][lane % LANES] = value;
                    }
                });
                Law::Each(first as u32)
            }
        }
    }

    /// The laws of one set of lanes of a stripe, or of one row of a bundle.
    #[inline(always)]
    pub fn lanes(&self, law: &Law, set: usize) -> LawLanes<'_> {
        match *law {
            Law::Same(law) => LawLanes::Same(law),
            Law::Lengths(material, first) => LawLanes::Lengths(material, &self.0[first as usize + set]),
            Law::Each(first) => {
                let [k, d, rest] =
                    self.0[first as usize + 3 * set..].first_chunk().expect("three for each set");
                LawLanes::Each([k, d, rest])
            }
        }
    }
}
