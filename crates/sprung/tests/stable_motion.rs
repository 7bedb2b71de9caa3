//! The stability limit in motion: just below it a mode decays, just above it grows.

mod common;

use common::{oscillator, scenes};
use nalgebra::{DMatrix, DVector};
use sprung::{Inline, Material, Model, ModelBuilder, Params, State, Vec3, solver::SymplecticEuler};

/// How much of a mode there is after `count` steps of `dt` from a small displacement in its shape, as a multiple of that.
/// Modes are orthogonal by mass, so this is blind to what rounding feeds into the others. The solver alone: `Simulation`
/// would stop a run that grows.
fn growth(model: &Model, params: &Params, rest: &State, shape: &[Vec3], dt: f64, count: usize) -> f64 {
    let mut params = params.clone();
    params.dt = dt;
    let mut state = rest.clone();
    state.position.iter_mut().zip(shape).for_each(|(x, moved)| *x += *moved);
    let mut solver = SymplecticEuler::new(model.clone(), &params);
    let size = |state: &State| {
        let of_point = |at: usize| {
            let moved = common::position(state, at) - rest.position[at].as_dvec3();
            f64::from(params.point_mass[at]) * shape[at].as_dvec3().dot(moved)
        };
        (0..state.position.len()).map(of_point).sum::<f64>().abs()
    };
    let start = size(&state);
    (0..count).for_each(|_| {
        solver.step(&params, &mut state, &Inline);
    });
    size(&state) / start
}

/// dt < 4/(c + √(c² + 4ω²)) for one oscillator: docs/method.md.
#[test]
fn one_oscillator_decays_below_the_limit_and_grows_above_it() {
    for (mass, stiffness, damping) in
        [(1.0f32, 1.0f32, 0.2f32), (0.5, 600.0, 3.0), (2.0, 50.0, 40.0), (1.0, 0.0, 10.0)]
    {
        let (c, omega2) = (f64::from(damping / mass), f64::from(stiffness / mass));
        let limit = 4.0 / (c + (c * c + 4.0 * omega2).sqrt());
        let (model, params, state) = oscillator(mass, Material { stiffness, damping }, 1.0, 1.0, 0.0);
        let mut moving = state.clone();
        // A damper alone has nothing that pulls back: there the speed decays or grows, and the way with it.
        moving.velocity[1] = Vec3::X * 1e-3 / limit as f32;
        let run = |dt: f64| {
            let mut params = params.clone();
            params.dt = dt;
            let mut state = moving.clone();
            let mut solver = SymplecticEuler::new(model.clone(), &params);
            (0..400).for_each(|_| {
                solver.step(&params, &mut state, &Inline);
            });
            f64::from(state.velocity[1].x.abs()) * limit / 1e-3
        };
        assert!(run(0.99 * limit) < 0.5, "m {mass}, k {stiffness}, d {damping}: grows below the limit");
        assert!(run(1.01 * limit) > 10.0, "m {mass}, k {stiffness}, d {damping}: decays above the limit");
    }
}

/// The matrices M^(−1/2) K M^(−1/2) and the same of C at the current shape, every spring at its rest length.
fn matrices(model: &Model, params: &Params, state: &State) -> (DMatrix<f64>, DMatrix<f64>) {
    let size = 3 * model.point_count();
    let (mut k, mut c) = (DMatrix::zeros(size, size), DMatrix::zeros(size, size));
    for (spring, &[i, j]) in model.springs().iter().enumerate() {
        let (i, j) = (i as usize, j as usize);
        let n = (state.position[i] - state.position[j]).as_dvec3().normalize().to_array();
        let root = |at: usize| f64::from(params.inverse_mass(at)).sqrt();
        for (a, b, sign) in [(i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)] {
            for (row, column) in (0..3).flat_map(|row| (0..3).map(move |column| (row, column))) {
                let entry = sign * n[row] * n[column] * root(a) * root(b);
                k[(3 * a + row, 3 * b + column)] += entry * f64::from(params.spring_stiffness[spring]);
                c[(3 * a + row, 3 * b + column)] += entry * f64::from(params.spring_damping[spring]);
            }
        }
    }
    (k, c)
}

/// The dt at which the largest eigenvalue of dt²K + 2dt·C is 4, by bisection, and the shape of that mode.
fn dense_limit(k: &DMatrix<f64>, c: &DMatrix<f64>) -> (f64, DVector<f64>) {
    let top = |dt: f64| {
        let eigen = (k * (dt * dt) + c * (2.0 * dt)).symmetric_eigen();
        let at = eigen.eigenvalues.imax();
        (eigen.eigenvalues[at], eigen.eigenvectors.column(at).into_owned())
    };
    let (mut low, mut high) = (1e-6, 1e3);
    while high / low > 1.0 + 1e-9 {
        let middle = f64::sqrt(low * high);
        if top(middle).0 < 4.0 { low = middle } else { high = middle }
    }
    (low, top(low).1)
}

#[test]
fn networks_decay_below_the_limit_of_a_dense_solve_and_grow_above_it() {
    for (name, (model, mut params, state)) in [("chain", chain()), ("block", block()), ("uneven", uneven())] {
        params.gravity = Vec3::ZERO;
        params.planes.clear();
        let (k, c) = matrices(&model, &params, &state);
        let (limit, mode) = dense_limit(&k, &c);
        if name == "chain" {
            assert!((limit / 0.0576921 - 1.0).abs() < 1e-5, "a dense solve gives 0.0576921 s, here {limit}");
        }
        // The mode as a displacement of a tenth of a millimetre: linear, and far above the rounding of positions.
        let shape: Vec<Vec3> = (0..model.point_count())
            .map(|at| {
                let moved = [0, 1, 2].map(|axis| mode[3 * at + axis] as f32);
                Vec3::from_array(moved) * (1e-4 * params.inverse_mass(at).sqrt())
            })
            .collect();
        let below = growth(&model, &params, &state, &shape, 0.99 * limit, 150);
        let above = growth(&model, &params, &state, &shape, 1.01 * limit, 150);
        assert!(below < 0.1, "{name}: grows {below}-fold below the limit of {limit} s");
        assert!(above > 10.0, "{name}: grows only {above}-fold above the limit of {limit} s");
    }
}

fn chain() -> (Model, Params, State) {
    let run = scenes::engine(&scenes::chain());
    ((**run.model()).clone(), run.params().clone(), run.state().clone())
}

/// 3 × 3 × 3 points, every two within √2 joined, all alike.
fn block() -> (Model, Params, State) {
    let mut builder = ModelBuilder::new();
    for at in 0..27 {
        let corner = Vec3::new((at / 9) as f32, (at / 3 % 3) as f32, (at % 3) as f32);
        builder.add_point(corner, 1.0).expect("allowed");
    }
    builder.connect_within(0..27, 1.5, Material { stiffness: 500.0, damping: 4.0 }).expect("allowed");
    builder.build().expect("there are points")
}

/// Unlike masses, stiffnesses and dampings, one point pinned: K and C do not commute.
fn uneven() -> (Model, Params, State) {
    let mut builder = ModelBuilder::new();
    for (at, mass) in [1.0f32, 0.2, 3.0, 0.5, 1.0].into_iter().enumerate() {
        let angle = at as f32;
        builder.add_point(Vec3::new(angle.cos(), 0.4 * angle, angle.sin()), mass).expect("allowed");
    }
    for (index, (a, b)) in
        [(0, 1), (0, 2), (1, 2), (1, 3), (2, 3), (2, 4), (3, 4), (0, 4)].into_iter().enumerate()
    {
        let (stiffness, damping) = (50.0 * (index + 1) as f32, (7 * index % 5) as f32);
        builder.add_spring(a, b, Material { stiffness, damping }).expect("allowed");
    }
    builder.pin(0).expect("there is such a point");
    builder.build().expect("there are points")
}
