//! What the engine's tests share: the naive twin, the report's four scenes, random networks, and a few helpers.
#![allow(dead_code)] // each test file uses its own part

pub mod hanging;
pub mod motion;
pub mod moving;
pub mod plain;
pub mod rounding;
pub mod scenes;
pub mod twin;

use proptest::prelude::*;
use sprung::{ContactLaw, DVec3, Material, Model, ModelBuilder, Params, Plane, Simulation, State, Vec3};

/// Half an ulp of a float32, relative: no rounded operation is wrong by more than this share of its result.
pub const U: f64 = 1.0 / (1 << 24) as f64;

/// So many random cases, the same ones on every machine.
pub fn cases(count: u32) -> ProptestConfig {
    let rng_seed = proptest::test_runner::RngSeed::Fixed(2);
    ProptestConfig { rng_seed, failure_persistence: None, ..ProptestConfig::with_cases(count) }
}

/// Position of a point with what rounding dropped, m.
pub fn position(state: &State, point: usize) -> DVec3 {
    state.position[point].as_dvec3() + state.position_low[point].as_dvec3()
}

/// Velocity of a point with what rounding dropped, m/s.
pub fn velocity(state: &State, point: usize) -> DVec3 {
    state.velocity[point].as_dvec3() + state.velocity_low[point].as_dvec3()
}

/// Takes `count` steps of the simulation's own dt.
pub fn steps(simulation: &mut Simulation, count: u64) {
    for _ in 0..count {
        simulation.step(simulation.params().dt).expect("the scene is stable");
    }
}

/// A simulation of parts that are known to fit.
pub fn simulation((model, params, state): (Model, Params, State)) -> Simulation {
    Simulation::new(model, params, state).expect("the parts fit")
}

/// A mass on a spring along +x, held at the origin, without gravity: at `length` m, moving at `speed` m/s.
pub fn oscillator(
    mass: f32,
    material: Material,
    rest: f32,
    length: f32,
    speed: f32,
) -> (Model, Params, State) {
    let mut builder = ModelBuilder::new();
    builder.add_point(Vec3::ZERO, 0.0).expect("allowed");
    builder.add_point(Vec3::X * length, mass).expect("allowed");
    builder.set_velocity(1, Vec3::X * speed).expect("allowed");
    builder.add_spring(0, 1, material).expect("allowed");
    builder.set_rest_length(0, rest).expect("allowed");
    let (model, mut params, state) = builder.build().expect("there are points");
    params.gravity = Vec3::ZERO;
    (model, params, state)
}

/// A random network in a random state, as plain numbers that proptest can shrink.
#[derive(Clone, Debug)]
pub struct Network {
    pub points: Vec<([f32; 3], [f32; 3], f32, bool)>,
    pub springs: Vec<(usize, usize, f32, f32, f32)>,
    /// What rounding dropped, as a share of half an ulp: one number for each component of each position.
    pub low: Vec<f32>,
}

/// Up to 12 points in a box of 20 m, some of them coincident and some fixed, up to 30 springs, some of them repeated.
pub fn network() -> impl Strategy<Value = Network> {
    let component = -10.0f32..10.0;
    let vector = prop::array::uniform3(component);
    let mass = prop_oneof![1 => Just(0.0f32), 6 => 0.1f32..10.0];
    let point = (vector.clone(), vector, mass, prop::bool::weighted(0.1));
    let points = prop::collection::vec(point, 2..12);
    let twins = prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>()), 0..2);
    (points, twins).prop_flat_map(|(mut points, twins)| {
        for (a, b) in twins {
            let (a, b) = (a.index(points.len()), b.index(points.len()));
            points[a].0 = points[b].0;
        }
        let count = points.len();
        let spring = (0..count, 0..count, 0.0f32..1000.0, 0.0f32..20.0, 0.0f32..10.0);
        let springs = prop::collection::vec(spring, 0..30);
        let low = prop::collection::vec(-1.0f32..1.0, 3 * count);
        (Just(points), springs, low).prop_map(|(points, springs, low)| {
            let springs = springs.into_iter().filter(|(a, b, ..)| a != b).collect();
            Network { points, springs, low }
        })
    })
}

impl Network {
    /// The engine's parts. Positions carry a rounding residue, equal where points coincide.
    pub fn build(&self) -> (Model, Params, State) {
        let mut builder = ModelBuilder::new();
        for (point, &(x, v, mass, pinned)) in self.points.iter().enumerate() {
            builder.add_point(Vec3::from_array(x), mass).expect("allowed");
            builder.set_velocity(point, Vec3::from_array(v)).expect("allowed");
            if pinned {
                builder.pin(point).expect("there is such a point");
            }
        }
        for &(a, b, stiffness, damping, rest) in &self.springs {
            let spring = builder.add_spring(a, b, Material { stiffness, damping }).expect("allowed");
            builder.set_rest_length(spring, rest).expect("allowed");
        }
        let (model, mut params, mut state) = builder.build().expect("there are points");
        // Below the limit of the worst case: 30 dampers of 20 N·s/m at two points of 0.1 kg, 4/(2·2·30·20/0.1) = 1.7e-4 s.
        params.dt = 1e-4;
        for point in 0..state.position.len() {
            let x = state.position[point];
            let first = state.position.iter().position(|&other| other == x).expect("itself at least");
            let low = Vec3::from_slice(&self.low[3 * first..]);
            state.position_low[point] = low * x.abs() * (0.4 * U as f32);
        }
        (model, params, state)
    }

    /// The same without anything fixed, without gravity: a closed system.
    pub fn closed(&self) -> (Model, Params, State) {
        let mut free = self.clone();
        for (_, _, mass, pinned) in &mut free.points {
            *mass = mass.max(0.1);
            *pinned = false;
        }
        let (model, mut params, state) = free.build();
        params.gravity = Vec3::ZERO;
        (model, params, state)
    }
}

/// A tilted plane through the box of the random networks.
pub fn tilted_plane(law: ContactLaw) -> Plane {
    let normal = Vec3::new(1.0, 2.0, -0.5).normalize();
    Plane { point: Vec3::new(0.3, -1.0, 0.2), normal, stiffness: 300.0, damping: 8.0, law }
}

/// A network with everything acting on it: gravity, both contact laws, a push and a grab.
pub fn driven(network: &Network) -> (Model, Params, State) {
    let (model, mut params, state) = network.build();
    params.gravity = Vec3::new(1.0, -9.81, 0.5);
    params.planes = vec![
        tilted_plane(ContactLaw::Push),
        Plane { law: ContactLaw::Report, ..Plane::level(-5.0, 50.0, 10.0) },
    ];
    params.external_forces.insert(0, Vec3::new(3.0, -4.0, 12.0));
    params.grabs.push(sprung::Grab {
        point: 1,
        target: Vec3::new(1.0, 8.0, -2.0),
        stiffness: 70.0,
        damping: 3.0,
    });
    (model, params, state)
}

/// A square cloth of so many points a side, 1 m apart, held at two corners and moving. From 225 a side on it is large enough
/// to be divided among three threads.
pub fn large_cloth(side: usize) -> Simulation {
    let mut builder = ModelBuilder::new();
    let mut random = Random(side as u64);
    for point in 0..side * side {
        let at = Vec3::new((point % side) as f32, 0.0, (point / side) as f32);
        builder.add_point(at, 1.0).expect("allowed");
        builder.set_velocity(point, random.vector()).expect("allowed");
    }
    [0, side - 1].into_iter().for_each(|corner| builder.pin(corner).expect("there is such a point"));
    let material = Material { stiffness: 100.0, damping: 1.0 };
    builder.connect_within(0..side * side, 1.5, material).expect("allowed");
    let mut run = builder.simulation().expect("there are points");
    run.keep_history(0);
    run
}

/// Asserts that two states are the same bit for bit; −0 is not 0.
pub fn assert_same_bits(a: &State, b: &State, what: &str) {
    let arrays = |state: &State| {
        let arrays = [&state.position, &state.position_low, &state.velocity, &state.velocity_low];
        arrays.map(|array| array.iter().map(|vector| vector.to_array().map(f32::to_bits)).collect::<Vec<_>>())
    };
    for (name, (a, b)) in ["x", "x low", "v", "v low"].into_iter().zip(arrays(a).iter().zip(arrays(b))) {
        let differs = a.iter().zip(&b).position(|(a, b)| a != b);
        assert_eq!(differs, None, "{what}: {name} of this point differs");
    }
    assert_eq!((a.step, a.time.to_bits(), a.ledger), (b.step, b.time.to_bits(), b.ledger), "{what}");
}

/// Random numbers for what is too large to let proptest shrink it: a linear congruence (Knuth, MMIX), its upper half.
pub struct Random(pub u64);

impl Random {
    /// From 0 to `end` − 1.
    pub fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % end
    }

    /// From 0 to 1.
    pub fn share(&mut self) -> f32 {
        self.below(1 << 23) as f32 / (1 << 23) as f32
    }

    /// Components from −1 to 1.
    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.share(), self.share(), self.share()) * 2.0 - Vec3::ONE
    }

    /// Some consecutive ones of so many, at least one.
    pub fn range(&mut self, count: usize) -> std::ops::Range<usize> {
        let start = self.below(count);
        start..start + 1 + self.below(count - start)
    }
}
