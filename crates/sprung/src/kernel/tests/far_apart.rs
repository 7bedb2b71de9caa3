//! Springs between points far apart in the order: stripes may reach any distance, and what is left over is loose, which
//! costs no threads.

use std::sync::Arc;

use glam::Vec3;

use super::networks::{Random, layers, ring};
use super::order::assert_is_the_twin;
use super::same_bits::assert_same_bits;
use super::{Parts, Threads};
use crate::build::{Material, ModelBuilder};
use crate::kernel::BLOCK;
use crate::kernel::level::Level;
use crate::kernel::plan::{LONG, Plan, WINDOW};
use crate::kernel::region::Region;
use crate::model::HiddenOrder;
use crate::workers::Inline;

/// Points of a layer that 16 bits cannot number.
const LAYER: usize = WINDOW + 320;

#[test]
fn stripes_reach_beyond_the_window() {
    // As many as two regions need, with two layers each and a border of one.
    let parts = layers(1, LAYER, 4 * LAYER + 5_000);
    let plan = Plan::new(&parts.model);
    assert_eq!((plan.loose.len(), plan.stripe_reach), (0, LAYER + 1));
    assert!(!plan.bundles.is_empty() && plan.packed_reach < WINDOW / 2, "packed springs reach less far");
    let region = Region::new(&plan, 0..plan.blocks.len());
    // Memory for the points and as far as they reach, whatever the window is.
    let most = plan.points + plan.reach() + 2 * BLOCK;
    assert!(region.points.len() <= most && region.low.len() <= most);
    assert!(region.forces.far.len() <= most && region.forces.packed.len() <= most + WINDOW);
    assert_is_the_twin("layers", &parts, 2);
    assert_same_bits("layers", &parts, 2, 2);
}

/// A chain, some of whose points are also joined to others 70,000 further on.
fn chain_with_long_stripes(long: usize) -> Parts {
    let (points, offset) = (64 * 1024 + 8 * 1024, 70_000);
    let mut builder = ModelBuilder::new();
    let random = &mut Random(7);
    for _ in 0..points {
        builder.add_point(random.vector(), 1.0).expect("allowed");
    }
    let long = (0..long).map(|point| [point, point + offset]);
    for [a, b] in (1..points).map(|point| [point - 1, point]).chain(long) {
        builder.add_spring(a, b, Material { stiffness: 5.0, damping: 0.1 }).expect("allowed");
    }
    let (mut model, params, state) = builder.parts().expect("there are points");
    model.hidden_order = HiddenOrder::default();
    Parts::new((model, params, state))
}

/// Long stripes cost threads: only many springs are worth it.
#[test]
fn few_long_springs_are_loose_even_side_by_side() {
    let chain = 72 * 1024 - 1;
    let enough = chain / (LONG - 1) + 1;
    for (long, loose) in [(enough - 1, enough - 1), (enough, 0)] {
        let parts = chain_with_long_stripes(long);
        let plan = Plan::new(&parts.model);
        assert_eq!(plan.loose.len(), loose, "{long} long springs of {}", chain + long);
        assert_eq!(plan.stripe_reach, if loose == 0 { 70_000 } else { 1 });
        assert_is_the_twin(&format!("{long} long springs"), &parts, 1);
    }
}

/// Long springs from the first points to the last ones, several at some points.
fn ring_in_motion() -> Parts {
    let parts = ring(30, 70_000, 500);
    let plan = Plan::new(&parts.model);
    assert!(plan.loose.len() > 400 && plan.border_blocks() <= 8, "the long springs alone are loose");
    parts
}

#[test]
fn loose_springs_cost_no_threads() {
    let mut parts = ring_in_motion();
    let loose = Plan::new(&parts.model).loose;
    let cut = Arc::make_mut(&mut parts.params.spring_cut);
    loose.iter().step_by(30).for_each(|loose| cut[loose.spring as usize] = true);
    // Other forces where loose springs end, which come after theirs.
    for end in loose.iter().step_by(7).flat_map(|loose| loose.ends) {
        parts
            .params
            .external_forces
            .insert(parts.model.point_at(end as usize), Vec3::splat(end as f32 * 1e-4));
    }
    assert_is_the_twin("a ring", &parts, 3);
    assert_same_bits("a ring", &parts, 4, 7);
}

#[test]
fn forces_and_energies_of_loose_springs_are_the_same_in_any_number_of_regions() {
    let parts = ring_in_motion();
    let (mut plain, mut team) = (parts.team(Level::best()), parts.divided_team(Level::best()));
    let (mut expected, mut found) = (Vec::new(), Vec::new());
    for threads in [7, 1, 3] {
        parts.advance(&mut plain, 2, 1);
        parts.advance(&mut team, 2, threads);
        assert_eq!(team.region_count(), threads);
        let energies = [plain.energy(&parts.params, &Inline), team.energy(&parts.params, &Threads(threads))]
            .map(|energy| [energy.elastic, energy.kinetic].map(f64::to_bits));
        assert_eq!(energies[0], energies[1], "in {threads} regions");
        plain.forces(&parts.model, &parts.params, &mut expected);
        team.forces(&parts.model, &parts.params, &mut found);
        assert!(expected == found, "in {threads} regions");
    }
}
