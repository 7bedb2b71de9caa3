//! What is read off a point or a spring is what the engine computes with.

mod common;

use common::{driven, network, rounding, scenes, simulation, steps};
use proptest::prelude::*;
use sprung::force::FORCES;
use sprung::{Change, DVec3, Material, Model, Params, PointReading, SpringReading, State, Vec3};

fn point(model: &Model, params: &Params, state: &State, point: usize) -> PointReading {
    PointReading::of(model, params, state, point).expect("there is such a point")
}

fn spring(model: &Model, params: &Params, state: &State, spring: usize) -> SpringReading {
    SpringReading::of(model, params, state, spring).expect("there is such a spring")
}

proptest! {
    #![proptest_config(common::cases(150))]

    #[test]
    fn every_force_on_a_point_is_that_of_the_ledger(network in network()) {
        let (model, params, state) = driven(&network);
        for (index, force) in FORCES.iter().enumerate() {
            let mut all = vec![DVec3::ZERO; model.point_count()];
            let mut rest = all.clone();
            (force.parts)(&model, &params, &state, &mut all, &mut rest);
            for at in 0..model.point_count() {
                let (name, found) = point(&model, &params, &state, at).forces[index];
                let expected = all[at] + rest[at];
                prop_assert_eq!(name, force.name);
                // The same terms in another order: some thirty roundings of what may cancel.
                let size: f64 = model.springs_at(at).iter().map(|&s| spring(&model, &params, &state, s as usize)).map(|s| s.spring_force.abs() + s.damper_force.abs()).sum();
                let allowed = 64.0 * 2f64.powi(-53) * (size + expected.length() + found.length());
                prop_assert!((found - expected).length() <= allowed, "{} at point {}: {} N, {} N", name, at, found, expected);
            }
        }
    }

    #[test]
    fn the_sum_is_the_force_of_the_step(network in network()) {
        let (model, params, state) = driven(&network);
        let mut run = simulation((model.clone(), params.clone(), state));
        let before = run.state().clone();
        let forces = run.forces().to_vec();
        prop_assert_eq!(run.state(), &before);
        let allowed = rounding::of_forces(&model, &params, &before);
        for at in (0..model.point_count()).filter(|&at| !params.is_fixed(at)) {
            let reading = point(&model, &params, &before, at);
            let off = (forces[at].as_dvec3() - reading.total_force).length();
            prop_assert!(off <= allowed[at].total(), "point {}: off by {:e} N, allowed {:e}", at, off, allowed[at].total());
        }
        // And asking for forces is no step: the next one has the same bits.
        let mut other = simulation((model, params.clone(), before));
        steps(&mut run, 2);
        steps(&mut other, 2);
        prop_assert_eq!(run.state(), other.state());
    }

    #[test]
    fn springs_at_a_point_are_those_that_end_there(network in network()) {
        let (model, params, state) = network.build();
        for at in 0..model.point_count() {
            let ends_here = |spring: &u32| model.springs()[*spring as usize].contains(&(at as u32));
            let expected: Vec<u32> = (0..model.spring_count() as u32).filter(ends_here).collect();
            prop_assert_eq!(model.springs_at(at), &expected[..]);
        }
        prop_assert!(model.springs_at(model.point_count()).is_empty() && model.springs_at(usize::MAX).is_empty());
        let energy: f64 = (0..model.spring_count()).map(|s| spring(&model, &params, &state, s).energy).sum();
        let expected = sprung::Energy::of(&model, &params, &state).elastic;
        prop_assert!((energy - expected).abs() <= 1e-13 * expected);
    }
}

#[test]
fn a_spring_reads_as_the_formulas_say() {
    // L = 2 m, ℓ = 3 m growing by 4 m/s, k_s = 10 N/m, k_d = 0.5 N·s/m.
    let material = Material { stiffness: 10.0, damping: 0.5 };
    let (model, mut params, state) = common::oscillator(1.0, material, 2.0, 3.0, 4.0);
    let reading = spring(&model, &params, &state, 0);
    let expected = SpringReading {
        points: [0, 1],
        length: 3.0,
        rest_length: 2.0,
        strain: Some(0.5),
        stretch_rate: 4.0,
        spring_force: 10.0,
        damper_force: 2.0,
        tension: 12.0,
        energy: 5.0,
        is_cut: false,
    };
    assert_eq!(reading, expected);
    let pulled = point(&model, &params, &state, 1);
    assert_eq!((pulled.total_force, pulled.mass), (DVec3::new(-12.0, 0.0, 0.0), 1.0));
    assert_eq!(point(&model, &params, &state, 0).total_force, DVec3::new(12.0, 0.0, 0.0));
    // Cut, it is still there to be measured, and pulls no more.
    params.apply(&model, &Change::Cut(0..1, true)).expect("allowed");
    let cut = spring(&model, &params, &state, 0);
    assert_eq!((cut.length, cut.tension, cut.energy, cut.is_cut), (3.0, 0.0, 0.0, true));
}

#[test]
fn coincident_ends_and_a_rest_length_of_zero_are_no_nonsense() {
    let (model, mut params, mut state) =
        common::oscillator(1.0, Material { stiffness: 10.0, damping: 0.5 }, 2.0, 3.0, 4.0);
    state.position[1] = Vec3::ZERO;
    let reading = spring(&model, &params, &state, 0);
    assert_eq!((reading.length, reading.stretch_rate, reading.tension), (0.0, 0.0, 0.0));
    assert_eq!(reading.strain, Some(-1.0));
    params.apply(&model, &Change::RestScale(0..1, 0.0)).expect("allowed");
    assert_eq!(spring(&model, &params, &state, 0).strain, None);
}

#[test]
fn a_snapshot_tells_what_its_state_tells_but_for_what_rounding_dropped() {
    let mut run = scenes::engine(&scenes::jelly());
    steps(&mut run, 100);
    let snapshot = run.snapshot().clone();
    let (model, params) = (run.model(), run.params());
    for at in [0, 500, 999] {
        let from_snapshot = PointReading::of(model, params, &snapshot, at).expect("there is such a point");
        let from_state = point(model, params, run.state(), at);
        assert_eq!(from_snapshot.position, run.state().position[at].as_dvec3());
        // Positions are off by half an ulp of some 20 m at either end, 18 springs of 750 N/m hang there.
        let allowed = 18.0 * 750.0 * 2.0 * 3.0 * 20.0 * common::U;
        assert!((from_snapshot.total_force - from_state.total_force).length() < allowed);
    }
}

#[test]
fn what_is_not_there_is_not_read() {
    let run = scenes::engine(&scenes::chain());
    let other = scenes::engine(&scenes::cloth());
    let (model, params, state) = (run.model(), run.params(), run.state());
    assert!(PointReading::of(model, params, state, 15).is_none());
    assert!(SpringReading::of(model, params, state, 14).is_none());
    assert!(SpringReading::of(model, params, state, usize::MAX).is_none());
    assert!(PointReading::of(model, params, other.state(), 3).is_none());
    assert!(PointReading::of(model, other.params(), state, 3).is_none());
    assert!(SpringReading::of(other.model(), params, state, 3).is_none());
}

#[test]
fn asking_for_forces_notices_what_has_changed() {
    let mut run = scenes::engine(&scenes::chain());
    steps(&mut run, 20);
    run.forces();
    run.change(Change::Stiffness(0..14, 400.0)).expect("allowed");
    let forces = run.forces().to_vec();
    let reading = point(run.model(), run.params(), run.state(), 3);
    assert!((forces[3].as_dvec3() - reading.total_force).length() < 1e-3 * reading.total_force.length());
}
