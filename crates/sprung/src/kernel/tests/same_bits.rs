//! The same bits whichever vector instructions are used and into however many regions a model is divided.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::Vec3;

use super::networks::{Random, mixed, with_hidden_order};
use super::{Parts, affordable, first_difference};
use crate::kernel::Team;
use crate::kernel::level::Level;
use crate::scene::BUILTIN;

const THREADS: [usize; 4] = [1, 2, 3, 7];

/// Compares all levels and all numbers of regions that a model allows with one region of the narrowest vectors; gives the
/// numbers of regions. `at_least` is the largest that must be among them.
pub fn assert_same_bits(name: &str, parts: &Parts, steps: u64, at_least: usize) {
    let levels = Level::available();
    let mut plain = parts.team(levels[0]);
    parts.advance(&mut plain, steps, 1);
    let expected = parts.state_of(&plain);

    let mut seen = BTreeSet::new();
    for &level in &levels {
        for threads in THREADS {
            let mut team = parts.divided_team(level);
            parts.advance(&mut team, steps, threads);
            // As many regions as before are the same again.
            seen.insert(team.region_count());
            let difference = first_difference(&expected, &parts.state_of(&team));
            assert_eq!(difference, None, "{name}, {} with {threads} threads", level.name());
        }
    }
    assert!(seen.last() >= Some(&at_least), "{name} was divided into {seen:?} regions only");
    let names: Vec<&str> = levels.into_iter().map(Level::name).collect();
    report(&format!("{name}: {steps} steps by {} in {seen:?} regions", names.join(", ")));
}

/// For `--nocapture`: what was compared.
#[allow(clippy::print_stdout)]
fn report(line: &str) {
    println!("{line}");
}

#[test]
fn levels_and_regions_give_the_same_bits_on_built_in_scenes() {
    for scene in BUILTIN {
        let parts = Parts::built_in(scene);
        let at_least = if parts.model.point_count() > 100_000 { 7 } else { 1 };
        assert_same_bits(scene.name, &parts, affordable(scene, 2, 30), at_least);
    }
}

#[test]
fn levels_and_regions_give_the_same_bits_on_mixed_networks() {
    for seed in 0..3 {
        assert_same_bits(&format!("network {seed}"), &mixed(seed, 36_000, false), 4, 7);
    }
}

#[test]
fn levels_give_the_same_bits_where_nothing_can_be_divided() {
    let parts = mixed(3, 1_500, false);
    let model = with_hidden_order(&parts.model, &mut Random(3));
    assert_same_bits("a network in any order", &Parts { model, ..parts }, 20, 1);
    assert_same_bits("a wide network", &mixed(4, 70_000, true), 2, 1);
}

#[test]
fn forces_are_the_same_in_any_number_of_regions() {
    let parts = mixed(5, 24_000, false);
    let (mut plain, mut expected, mut found) = (parts.team(Level::best()), Vec::new(), Vec::new());
    for level in Level::available() {
        let mut team = parts.divided_team(level);
        for threads in [1, 7, 2] {
            plain.load(&parts.model, &parts.state);
            team.load(&parts.model, &parts.state);
            parts.advance(&mut plain, 3, 1);
            parts.advance(&mut team, 3, threads);
            plain.forces(&parts.model, &parts.params, &mut expected);
            team.forces(&parts.model, &parts.params, &mut found);
            let bits = |forces: &[Vec3]| -> Vec<[u32; 3]> {
                forces.iter().map(|force| force.to_array().map(f32::to_bits)).collect()
            };
            assert!(bits(&expected) == bits(&found), "{} in {} regions", level.name(), team.region_count());
            // Asking moved nothing, and the next step knows its neighbours.
            parts.advance(&mut plain, 2, 1);
            parts.advance(&mut team, 2, threads);
            assert_eq!(first_difference(&parts.state_of(&plain), &parts.state_of(&team)), None);
        }
    }
}

/// Threads come and go, parameters change and points are taken in hand between steps: in a model of several regions each of
/// them is told.
#[test]
fn regions_may_change_in_mid_run() {
    let mut parts = mixed(6, 36_000, false);
    let mut regions = Vec::new();
    let (mut plain, mut team) = (parts.team(Level::best()), parts.divided_team(Level::Baseline));
    let count = parts.model.point_count();
    for (round, threads) in [3, 7, 7, 1, 2, 64, 3].into_iter().enumerate() {
        let params = &mut parts.params;
        Arc::make_mut(&mut params.point_mass)[round * count / 7..].fill(1.5 + round as f32);
        Arc::make_mut(&mut params.spring_stiffness)[round * 5_000..].fill(30.0 - round as f32);
        for team in [&mut plain, &mut team] {
            team.set_masses(&parts.model, &parts.params);
            team.set_laws(&parts.model, &parts.params);
        }
        // One point is taken in hand, which only that is said of.
        let taken = count - 1 - round * count / 8;
        parts.params.carried.insert(taken, Vec3::X);
        for team in [&mut plain, &mut team] {
            team.set_mass(&parts.model, &parts.params, taken);
        }
        parts.advance(&mut plain, 5, 1);
        parts.advance(&mut team, 5, threads);
        regions.push(team.region_count());
        let difference = first_difference(&parts.state_of(&plain), &parts.state_of(&team));
        assert_eq!(difference, None, "round {round} with {threads} threads");
        let motion = |team: &Team| [0, count / 2, count - 1].map(|point| team.motion64(&parts.model, point));
        assert_eq!(motion(&plain), motion(&team), "round {round}");
    }
    assert_eq!(regions[..5], [3, 7, 7, 1, 2]);
}
