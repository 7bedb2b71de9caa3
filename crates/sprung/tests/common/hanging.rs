//! The report's cloth at any size, hung by two corners; knocked, and left to come to rest again.
//!
//! It must come to rest where its forces balance, whatever the step. A loop that keeps nothing of what rounding drops does
//! not: a point whose way in a step is below half an ulp of its position stands still, and yet has a velocity. Drag and
//! dampers answer to that velocity, and balance forces that nothing else balances. The smaller the step, the larger these.

use super::motion::{Motion, Ours, at_rest, stir, twin_of};
use super::twin::{Spring, Twin, V3, dot, norm, sub};
use super::{U, rounding};
use sprung::{Material, Model, ModelBuilder, Params, State, Vec3};

/// The report's step for the cloth, s.
pub const DT: f64 = 0.01;

/// Share of its speed that every point loses per `DT`: a drag of 4 per second. Springs' dampers cannot stop a swing.
const DRAG: f64 = 0.04;

/// What a shape at rest is judged by.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// The largest |ℓ − L|/L of a spring.
    pub strain: f64,
    /// The largest total force on a point that can move, N.
    pub residual: f64,
}

/// A cloth that hangs at rest, and is about to be knocked.
pub struct Hanging {
    pub model: Model,
    pub params: Params,
    /// At rest in float64, every point then knocked at up to 0.1 m/s along each axis.
    pub knocked: State,
    /// At rest in float64.
    pub equilibrium: Shape,
    /// How far float32 may throw off this shape, however it was computed.
    pub rounding: Shape,
    twin: Twin,
}

impl Hanging {
    /// n × n points, brought nearly to rest by the engine, and by the twin to a hundredth of what float32 can tell.
    pub fn new(n: usize) -> Self {
        let (model, params, mut state) = cloth(n);
        // The shape that is the same left and right is an equilibrium too, and not a stable one.
        stir(&params, &mut state, 7, 0.1);
        let mut engine = Ours::new(&model, &params, &state);
        let falling = 2.0 * n as f64; // s
        for _ in 0..(falling / DT) as u64 {
            engine.steps(DT, 1);
            engine.slow_down(1.0 - 0.25 * DRAG);
        }
        let hung = at_rest(&engine.places());
        let mut twin = twin_of(&model, &params, &hung);
        relax(&mut twin, 0.01 * force_rounding(&model, &params, &hung));

        let places = twin.places();
        let mut knocked = at_rest(&places);
        let rounding = Shape {
            strain: strain_rounding(&twin, &places),
            residual: force_rounding(&model, &params, &knocked),
        };
        stir(&params, &mut knocked, 1, 0.1);
        let mut hanging = Self {
            model,
            params,
            knocked,
            equilibrium: Shape { strain: 0.0, residual: 0.0 },
            rounding,
            twin,
        };
        hanging.equilibrium = hanging.judge(&places);
        hanging
    }

    /// Lets it come to rest for so many seconds in steps of DT/parts, with a drag that is the same for all of them.
    pub fn rest(&self, motion: &mut dyn Motion, parts: u64, seconds: f64) -> Shape {
        for _ in 0..(seconds / DT).round() as u64 {
            motion.steps(DT / parts as f64, parts);
            motion.slow_down(1.0 - DRAG);
        }
        self.judge(&motion.places())
    }

    /// Strain and force of the points in these places, in float64.
    fn judge(&self, places: &[V3]) -> Shape {
        let mut twin = self.twin.clone();
        for (point, &place) in twin.points.iter_mut().zip(places) {
            point.x = place;
        }
        let strain = |spring: &Spring| {
            let length = norm(sub(places[spring.i], places[spring.j]));
            (length - spring.rest).abs() / spring.rest
        };
        Shape { strain: twin.springs.iter().map(strain).fold(0.0, f64::max), residual: largest_force(twin) }
    }

    /// How far a shape is from the equilibrium.
    pub fn error(&self, shape: Shape) -> Shape {
        Shape { strain: (shape.strain - self.equilibrium.strain).abs(), residual: shape.residual }
    }
}

impl Shape {
    /// Whether this error is no larger than another, but for so much.
    pub fn is_within(self, other: Self, but_for: Self) -> bool {
        self.strain <= other.strain + but_for.strain && self.residual <= other.residual + but_for.residual
    }
}

/// n × n points by the rule of scene 4: (2j − n, 10, 2i), with (0, 0) and (n − 1, 0) fixed, of 0.5 kg each.
fn cloth(n: usize) -> (Model, Params, State) {
    let mut builder = ModelBuilder::new();
    for j in 0..n {
        for i in 0..n {
            let corner = i == 0 && (j == 0 || j == n - 1);
            let place = Vec3::new((2 * j) as f32 - n as f32, 10.0, (2 * i) as f32);
            builder.add_point(place, if corner { 0.0 } else { 0.5 }).expect("allowed");
        }
    }
    let material = Material { stiffness: 600.0, damping: 3.0 };
    builder.connect_within(0..n * n, 8f32.sqrt() + 0.001, material).expect("allowed");
    let (model, mut params, state) = builder.build().expect("there are points");
    params.dt = DT;
    (model, params, state)
}

/// Brings the twin to rest by kinetic damping: all stops whenever the kinetic energy has passed a peak.
fn relax(twin: &mut Twin, residual: f64) {
    let mut before = 0.0;
    for _ in 0..200_000 {
        twin.step(DT);
        let kinetic = twin.points.iter().map(|point| point.m * dot(point.v, point.v)).sum();
        if kinetic >= before {
            before = kinetic;
            continue;
        }
        twin.slow_down(0.0);
        before = 0.0;
        if largest_force(twin.clone()) <= residual {
            return;
        }
    }
    panic!("the twin does not come to rest");
}

/// The largest total force on a point that can move, N, with all of them at rest.
fn largest_force(mut twin: Twin) -> f64 {
    // One step of 1 s from rest makes of a force f the velocity f/m.
    twin.slow_down(0.0);
    twin.step(1.0);
    twin.points.iter().map(|point| point.m * norm(point.v)).fold(0.0, f64::max)
}

/// What rounding every position once does to the force on a point, and computing it in float32, N: see [`rounding`].
fn force_rounding(model: &Model, params: &Params, state: &State) -> f64 {
    rounding::of_forces(model, params, state).iter().map(rounding::OfForce::total).fold(0.0, f64::max)
}

/// What rounding every position once does to the strain of a spring: each end is off by u·|x|, and so 2u·|x|/L.
fn strain_rounding(twin: &Twin, places: &[V3]) -> f64 {
    let farthest = places.iter().map(|&place| norm(place)).fold(0.0, f64::max);
    let shortest = twin.springs.iter().map(|spring| spring.rest).fold(f64::INFINITY, f64::min);
    2.0 * U * farthest / shortest
}
