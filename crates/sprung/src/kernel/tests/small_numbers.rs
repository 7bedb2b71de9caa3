//! Denormal numbers, which hosts treat differently and some slowly: none is ever kept, and none matters.

use std::ops::{Add, Div, Mul, Sub};

use glam::Vec3;

use super::networks::Random;
use super::twin::{self, Order, Real};
use super::{Parts, arrays, first_difference};
use crate::build::{Material, ModelBuilder};
use crate::kernel::level::Level;
use crate::state::State;

/// A number of a host that takes denormal numbers for zero, and gives zero instead of them.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
struct Flushed(f32);

impl Real for Flushed {
    fn of(value: f32) -> Self {
        Self(if value.is_subnormal() { 0.0f32.copysign(value) } else { value })
    }

    fn get(self) -> f32 {
        self.0
    }

    fn sqrt(self) -> Self {
        Self::of(self.0.sqrt())
    }
}

macro_rules! flushed {
    ($($operation:ident $name:ident),*) => {$(
        impl $operation for Flushed {
            type Output = Self;

            fn $name(self, other: Self) -> Self {
                Self::of(self.0.$name(other.0))
            }
        }
    )*};
}

flushed!(Add add, Sub sub, Mul mul, Div div);

/// Every number of a state, with its name.
fn numbers(state: &State) -> impl Iterator<Item = (&'static str, f32)> {
    arrays(state).into_iter().flat_map(|(name, vectors)| {
        vectors.iter().flat_map(|vector| vector.to_array()).map(move |number| (name, number))
    })
}

/// What `integrate` argues: positions and their residues are multiples of the last bit of the smallest position, 2⁻¹²³ m,
/// or of the smallest way, 2⁻⁶³ m/s for 10⁻⁹ s, which is coarser; velocities and theirs of the last bit of the smallest
/// kick, 2⁻⁹⁵ m/s, 2⁻¹¹⁸ m/s. The smallest normal number is 2⁻¹²⁶.
fn assert_is_coarse(name: &str, state: &State) {
    for (array, number) in numbers(state) {
        let bit = if array.starts_with("position") { -123 } else { -118 };
        let units = f64::from(number) * 2f64.powi(-bit);
        assert!(units.fract() == 0.0, "{name}: {array} has {number:e}, which is no multiple of 2^{bit}");
    }
}

/// What is promised beyond that no denormal number is kept.
#[derive(Clone, Copy)]
struct Promise {
    /// A host without denormal numbers gives the same bits.
    hosts_agree: bool,
    /// Forces are not denormal either: they would slow down every step.
    forces_are_normal: bool,
}

const ALL: Promise = Promise { hosts_agree: true, forces_are_normal: true };

/// Steps on, looks at all numbers at every step, and gives the last state.
fn assert_denormals_do_not_matter(name: &str, parts: &Parts, steps: u64, promise: Promise) -> State {
    let (order, mut flushed) = (Order::new(&parts.model), parts.state.clone());
    let (mut team, mut state, mut forces) = (parts.team(Level::best()), parts.state.clone(), Vec::new());
    for step in 1..=steps {
        let name = format!("{name}, step {step}");
        parts.advance(&mut team, 1, 1);
        team.store(&parts.model, &mut state);
        assert_is_coarse(&name, &state);
        if promise.hosts_agree {
            twin::step::<Flushed>(parts, &order, &mut flushed);
            assert_eq!(first_difference(&state, &flushed), None, "{name}: a host without denormals differs");
        }
        if promise.forces_are_normal {
            team.forces(&parts.model, &parts.params, &mut forces);
            let denormal =
                forces.iter().position(|force| force.to_array().into_iter().any(f32::is_subnormal));
            assert_eq!(denormal, None, "{name}: the force on this point is denormal");
        }
    }
    state
}

/// Points about the origin, each joined to those near it, some of them pinned, shaken; nothing else acts on them.
/// Stiffness is `ratio` s⁻² times the mass.
fn shaken(seed: u64, ratio: f32, dt: f64) -> Parts {
    let random = &mut Random(seed);
    let mut builder = ModelBuilder::new();
    for point in 0..40 {
        builder.add_point(random.vector() * 2.0, 0.1).expect("allowed");
        builder.set_velocity(point, random.vector() * ratio.sqrt() * 0.1).expect("allowed");
    }
    (0..4).for_each(|point| builder.pin(point).expect("it was just made"));
    let material = Material { stiffness: 0.1 * ratio, damping: 0.1 * ratio.sqrt() };
    builder.connect_within(0..40, 1.6, material).expect("allowed");
    let (model, mut params, state) = builder.parts().expect("there are points");
    params.dt = dt;
    params.gravity = Vec3::ZERO;
    Parts::new((model, params, state))
}

#[test]
fn irregular_networks_come_to_rest_without_denormal_numbers() {
    for (seed, ratio) in [(1, 100.0), (2, 1e-2), (3, 1e-9), (4, 1e-18)] {
        let dt = 0.1 / f64::from(ratio).sqrt();
        let name = format!("stiffness/mass {ratio}/s²");
        if dt <= 1e3 {
            assert_denormals_do_not_matter(&name, &shaken(seed, ratio, dt), 4_000, ALL);
        } else {
            // Too slow ever to come to rest: it crawls.
            assert_denormals_do_not_matter(&name, &shaken(seed, ratio, 1e3), 1_000, ALL);
        }
    }
}

/// Pairs of balls drawn together about the origin, damped: here coordinates, too, go to zero, and so do the springs'
/// lengths and forces. Along the axes, as off them rounding makes the balls circle each other, which nothing brakes.
#[test]
fn balls_that_meet_at_the_origin_come_to_rest_without_denormal_numbers() {
    let mut builder = ModelBuilder::new();
    for (pair, at) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
        builder.add_point(at, 1.0).expect("allowed");
        builder.add_point(-at, 1.0).expect("allowed");
        builder
            .add_spring(2 * pair, 2 * pair + 1, Material { stiffness: 50.0, damping: 5.0 })
            .expect("allowed");
        builder.set_rest_length(pair, 0.0).expect("allowed");
    }
    let (model, mut params, state) = builder.parts().expect("there are points");
    params.gravity = Vec3::ZERO;
    let parts = Parts::new((model, params, state));
    let end = assert_denormals_do_not_matter("balls", &parts, 3_000, ALL);
    // So near to each other a damper has faded out.
    let vectors = end.position.iter().chain(&end.velocity);
    assert!(vectors.into_iter().all(|vector| vector.abs().max_element() < 1e-15), "{end:?}");
}

/// Whatever the parameters are, as long as the motion is stable.
///
/// Forces may be denormal here, as stiffness may be. The error of a host without denormal numbers, 10⁻³⁸ N, then counts
/// where it is more than half the last bit of the smallest kick, 2⁻¹¹⁸ m/s: for points lighter than dt/250 (kg, s).
#[test]
fn extreme_parameters_leave_no_denormal_numbers() {
    let mut agreed = 0;
    for seed in 0..400 {
        let parts = extreme(&mut Random(seed));
        let lightest = parts.params.point_mass.iter().copied().fold(f32::INFINITY, f32::min);
        let hosts_agree = f64::from(lightest) > parts.params.dt / 250.0;
        agreed += u32::from(hosts_agree);
        let promise = Promise { hosts_agree, forces_are_normal: false };
        assert_denormals_do_not_matter(&format!("network {seed}"), &parts, 60, promise);
    }
    assert!(agreed > 200, "hosts were compared on {agreed} networks only");
}

/// A few points joined at random, with parameters of any size, but stable.
fn extreme(random: &mut Random) -> Parts {
    let dt = random.size(-30, 0);
    let (lightest, length, speed) = (random.size(-39, 30), random.size(-20, 20), random.size(-70, 10));
    let stiffest = lightest / dt / dt * random.size(-110, -8);
    let thickest = lightest / dt * random.size(-110, -6);
    let mut builder = ModelBuilder::new();
    let count = 2 + random.below(10);
    for point in 0..count {
        let mass = (lightest * random.size(0, 10)).clamp(1e-12, 1e12);
        builder.add_point(random.vector() * length, mass).expect("allowed");
        builder.set_velocity(point, random.vector() * speed).expect("allowed");
    }
    for _ in 0..3 * count {
        let (a, b) = (random.below(count), random.below(count));
        let stiffness = (stiffest * random.size(-8, 0)).min(1e12);
        let damping = (thickest * random.size(-8, 0)).min(1e12);
        if a != b {
            let spring = builder.add_spring(a, b, Material { stiffness, damping }).expect("allowed");
            builder.set_rest_length(spring, length * random.size(-10, 2)).expect("allowed");
        }
    }
    let (model, mut params, state) = builder.parts().expect("there are points");
    params.dt = f64::from(dt).max(1e-9);
    params.gravity = if random.below(2) == 0 { Vec3::ZERO } else { random.vector() * random.size(-100, 3) };
    Parts::new((model, params, state))
}
