//! Energies in the layout of the step against those of plain code, and against themselves.

use glam::Vec3;

use super::networks::mixed;
use super::{Parts, Threads, affordable, first_difference};
use crate::energy::Energy;
use crate::force::{contact, gravity, spring};
use crate::kernel::level::Level;
use crate::scene::BUILTIN;
use crate::state::{Snapshot, State};

fn parts_of(energy: &Energy) -> [(&'static str, f64); 4] {
    [
        ("kinetic", energy.kinetic),
        ("gravitational", energy.gravitational),
        ("elastic", energy.elastic),
        ("contact", energy.contact),
    ]
}

/// Plain sums over a model, in which nothing is lost: the energies, and the sizes of the numbers that each is a sum or a
/// difference of, J.
fn plain(Parts { model, params, .. }: &Parts, state: &State) -> ([f64; 4], [f64; 4]) {
    let (points, springs) = (0..model.point_count(), 0..model.spring_count());
    let mass = |point: usize| if params.is_fixed(point) { 0.0 } else { f64::from(params.point_mass[point]) };
    let kinetic = sum(points.clone().map(|i| 0.5 * mass(i) * state.velocity64(i).length_squared()));
    let gravitational = sum(points.clone().map(|i| gravity::stored(params, i, state.position64(i))));
    let weights =
        points.clone().map(|i| mass(i) * params.gravity.as_dvec3().abs().dot(state.position64(i).abs()));
    let elastic = sum(springs.clone().map(|index| {
        let [i, j] = model.springs[index].map(|end| state.position64(end as usize));
        spring::stored(params, index, i - j)
    }));
    let at_rest = springs.map(|index| {
        let length = f64::from(params.spring_rest_length[index]);
        0.5 * f64::from(params.spring_stiffness[index]) * length * length
    });
    let contact = sum(points.map(|i| contact::stored(params, i, state.position64(i))));
    let sizes = [kinetic, sum(weights), elastic + sum(at_rest), contact];
    ([kinetic, gravitational, elastic, contact], sizes)
}

/// A sum with what rounding drops carried along (Neumaier 1974).
fn sum(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut low) = (0.0f64, 0.0f64);
    for value in values {
        let new = sum + value;
        low += if sum.abs() >= value.abs() { (sum - new) + value } else { (value - new) + sum };
        sum = new;
    }
    sum + low
}

/// A length is off by 10⁻¹⁴ of itself, so elastic energy by 4·10⁻¹⁴ of its size; and sums go through no more than 1300
/// additions one after another, each off by 2⁻⁵³.
const TOLERANCE: f64 = 2e-13;

fn assert_like_plain(name: &str, parts: &Parts, state: &State) {
    let mut team = parts.team(Level::best());
    team.load(&parts.model, state);
    let found = team.energy(&parts.params, &Threads(1));
    let reference = Energy::of(&parts.model, &parts.params, state);
    let (expected, sizes) = plain(parts, state);
    for (((what, found), (_, reference)), (expected, size)) in
        parts_of(&found).into_iter().zip(parts_of(&reference)).zip(expected.into_iter().zip(sizes))
    {
        let off = (found - expected).abs();
        assert!(off <= TOLERANCE * size, "{name}: {what} is {found} J, not {expected} J: off by {off:e} J");
        // One number after another: the sum is rounded each time.
        let numbers = (parts.model.point_count() + parts.model.spring_count()) as f64;
        let apart = (found - reference).abs();
        assert!(apart <= (TOLERANCE + numbers * f64::EPSILON) * size, "{name}: {what}, off by {apart:e} J");
    }
    assert_eq!(found.kinetic.to_bits(), team.kinetic_energy(&Threads(1)).to_bits(), "{name}");
}

/// The state with everything drawn out or pushed together by this factor.
fn scaled(state: &State, factor: f32) -> State {
    let mut scaled = state.clone();
    for vectors in [&mut scaled.position, &mut scaled.position_low] {
        vectors.iter_mut().for_each(|vector| *vector *= factor);
    }
    scaled
}

#[test]
fn they_are_those_of_plain_code() {
    for scene in BUILTIN {
        let parts = Parts::built_in(scene);
        let mut team = parts.team(Level::best());
        assert_like_plain(scene.name, &parts, &parts.state);
        parts.advance(&mut team, affordable(scene, 2, 100), 1);
        assert_like_plain(scene.name, &parts, &parts.state_of(&team));
    }
    for (name, parts) in networks() {
        for factor in [1.0, 3.0, 0.01, 1e-12] {
            assert_like_plain(&format!("{name} × {factor}"), &parts, &scaled(&parts.state, factor));
        }
    }
}

/// Where squares are beyond float32, and where there is no distance at all.
#[test]
fn they_are_those_of_plain_code_out_of_range() {
    let (name, parts) = networks().swap_remove(0);
    for factor in [0.0, 1e-25, 1e-18, 1e19, 1e25] {
        assert_like_plain(&format!("{name} × {factor}"), &parts, &scaled(&parts.state, factor));
    }
    let mut lost = parts.state.clone();
    lost.position[700].y = f32::INFINITY;
    let mut team = parts.team(Level::best());
    team.load(&parts.model, &lost);
    assert!(!team.energy(&parts.params, &Threads(1)).total().is_finite(), "what is lost is not hidden");
}

/// Networks of stripes, packed and loose springs with something of everything, pins, cuts and carried points among it.
fn networks() -> Vec<(String, Parts)> {
    let mut networks: Vec<(String, Parts)> =
        (0..3).map(|seed| (format!("network {seed}"), mixed(seed, 12_000, false))).collect();
    networks.push(("a wide network".to_owned(), mixed(4, 70_000, true)));
    networks
}

#[test]
fn levels_and_regions_give_the_same_bits_and_asking_changes_nothing() {
    for (name, parts) in [("network", mixed(5, 36_000, false)), ("a wide network", mixed(4, 70_000, true))] {
        let mut plain = parts.team(Level::Baseline);
        parts.advance(&mut plain, 3, 1);
        let energy = plain.energy(&parts.params, &Threads(1));
        let bits = |energy: &Energy| parts_of(energy).map(|(_, energy)| energy.to_bits());
        assert!(parts_of(&energy).into_iter().all(|(_, energy)| energy != 0.0), "{energy:?}");
        parts.advance(&mut plain, 2, 1);
        let end = parts.state_of(&plain);
        let mut most_regions = 0;
        for level in Level::available() {
            for threads in [1, 2, 3, 7] {
                let mut team = parts.divided_team(level);
                parts.advance(&mut team, 3, threads);
                // As the points have just been divided, and as they were moved by a step.
                for workers in [threads, 1] {
                    let found = team.energy(&parts.params, &Threads(workers));
                    assert_eq!(bits(&found), bits(&energy), "{name}: {} and {threads} threads", level.name());
                    let kinetic = team.kinetic_energy(&Threads(workers));
                    assert_eq!(kinetic.to_bits(), energy.kinetic.to_bits(), "{name}");
                }
                parts.advance(&mut team, 2, threads);
                assert_eq!(first_difference(&end, &parts.state_of(&team)), None, "{name}");
                most_regions = most_regions.max(team.region_count());
            }
        }
        assert!(name != "network" || most_regions == 7, "{most_regions} regions");
    }
}

#[test]
fn points_are_stopped_half_a_step_back_and_what_was_kept_stays() {
    let parts = mixed(6, 36_000, false);
    let dt = parts.params.dt;
    let whole = |high: Vec3, low: Vec3| high.as_dvec3() + low.as_dvec3();
    for threads in [1, 2, 7] {
        let mut team = parts.divided_team(Level::best());
        for keeps in [true, false] {
            parts.advance(&mut team, 3, threads);
            if keeps {
                team.keep();
            }
            let moving = parts.state_of(&team);
            let mut stopped = moving.clone();
            let free = |&point: &usize| !parts.params.is_fixed(point);
            for point in (0..stopped.position.len()).filter(free) {
                let exact = whole(moving.position[point], moving.position_low[point])
                    - 0.5 * dt * whole(moving.velocity[point], moving.velocity_low[point]);
                stopped.position[point] = exact.as_vec3();
                stopped.position_low[point] = (exact - stopped.position[point].as_dvec3()).as_vec3();
            }
            stopped.velocity.fill(Vec3::ZERO);
            stopped.velocity_low.fill(Vec3::ZERO);
            team.stop(dt);
            assert_eq!(first_difference(&stopped, &parts.state_of(&team)), None);
            if keeps {
                let mut kept = moving.clone();
                team.store_kept(&parts.model, &mut kept);
                assert_eq!(first_difference(&moving, &kept), None, "{threads} threads");
            }
            // It goes on as from a state that was stopped by hand.
            let mut by_hand = parts.team(Level::best());
            by_hand.load(&parts.model, &stopped);
            parts.advance(&mut by_hand, 2, 1);
            parts.advance(&mut team, 2, threads);
            assert_eq!(first_difference(&parts.state_of(&by_hand), &parts.state_of(&team)), None);
        }
    }
}

#[test]
fn a_snapshot_is_the_state_in_the_users_order() {
    let parts = mixed(7, 24_000, false);
    let mut team = parts.divided_team(Level::best());
    parts.advance(&mut team, 2, 3);
    let (mut snapshot, state) = (Snapshot::default(), parts.state_of(&team));
    team.fill(&parts.model, &mut snapshot);
    assert!(snapshot.positions == state.position && snapshot.velocities == state.velocity);
}
