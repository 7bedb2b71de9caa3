//! What a closed system keeps: momentum and angular momentum; and what a damper may never do: make energy.

mod common;

use common::{Network, U, network, position, velocity};
use proptest::prelude::*;
use sprung::{DVec3, Inline, Model, Params, State, solver::SymplecticEuler};

/// Momentum, kg·m/s, and angular momentum about the origin, kg·m²/s.
fn momenta(params: &Params, state: &State) -> (DVec3, DVec3) {
    let of_point = |at: usize| {
        let p = velocity(state, at) * f64::from(params.point_mass[at]);
        (p, position(state, at).cross(p))
    };
    (0..state.position.len())
        .map(of_point)
        .fold(Default::default(), |sum: (DVec3, DVec3), (p, l)| (sum.0 + p, sum.1 + l))
}

/// How much one step may change either by rounding, with u = 2⁻²⁴: a spring's two forces are exactly opposite, but each
/// point adds n of them up (n·u), divides by m, multiplies by dt and adds (4u), all of ΣF·dt, F the sizes of its forces.
/// About the origin that counts times the radius r. A force is besides not quite along the line between its points:
/// its axis is that of rounded positions (2u·r at each end) and is rounded itself (6u·ℓ): (4r + 6ℓ)·u·F·dt, ℓ ≤ 2r.
/// And x moves with the rounded velocity, rounded twice: m·v·dt·3u·v.
fn rounding(model: &Model, params: &Params, state: &State) -> (f64, f64) {
    let mut forces = vec![0.0; state.position.len()];
    let mut count = vec![4.0; state.position.len()];
    for (spring, &[i, j]) in model.springs().iter().enumerate() {
        let (i, j) = (i as usize, j as usize);
        let length = (position(state, i) - position(state, j)).length();
        let stretch = (length - f64::from(params.spring_rest_length[spring])).abs();
        let speed = (velocity(state, i) - velocity(state, j)).length();
        let force = f64::from(params.spring_stiffness[spring]) * stretch
            + f64::from(params.spring_damping[spring]) * speed;
        for point in [i, j] {
            forces[point] += force;
            count[point] += 1.0;
        }
    }
    let of_point = |at: usize| {
        let (radius, speed) = (position(state, at).length(), velocity(state, at).length());
        let mass = f64::from(params.point_mass[at]);
        // The new speed; and 2⁻⁶³ m/s where one counts as zero.
        let speed = speed + forces[at] * params.dt / mass;
        let linear = params.dt * count[at] * U * forces[at] + mass * (4.0 * U * U * speed + 2f64.powi(-63));
        let turning = params.dt * 16.0 * U * radius * forces[at] + 3.0 * U * mass * speed * speed * params.dt;
        (linear, radius * linear + turning)
    };
    (0..forces.len()).map(of_point).fold((0.0, 0.0), |sum, (p, l)| (sum.0 + p, sum.1 + l))
}

fn check(network: &Network) -> Result<(), TestCaseError> {
    let (model, params, mut state) = network.closed();
    let mut solver = SymplecticEuler::new(model.clone(), &params);
    let start = momenta(&params, &state);
    let (mut allowed_p, mut allowed_l) = (1e-9, 1e-9); // float64 sums
    for step in 0..100 {
        let (p, l) = rounding(&model, &params, &state);
        allowed_p += p;
        allowed_l += l;
        solver.step(&params, &mut state, &Inline);
        let now = momenta(&params, &state);
        let (off_p, off_l) = ((now.0 - start.0).length(), (now.1 - start.1).length());
        prop_assert!(
            off_p <= allowed_p,
            "step {}: momentum off by {:e}, allowed {:e}",
            step,
            off_p,
            allowed_p
        );
        prop_assert!(off_l <= allowed_l, "step {}: spin off by {:e}, allowed {:e}", step, off_l, allowed_l);
    }
    Ok(())
}

proptest! {
    #![proptest_config(common::cases(200))]

    #[test]
    fn a_closed_system_keeps_momentum_and_angular_momentum(network in network()) {
        check(&network)?;
    }

    #[test]
    fn a_damper_takes_energy_out(network in network()) {
        // Springs without stiffness: whatever the state, a step small against every damper makes no kinetic energy.
        // Symplectic Euler on v' = −C·v is v⁺ = (1 − dt·C)v: no mode grows while dt·c ≤ 2, and c ≤ 2·Σk_d/m < 12,000/s.
        let (model, mut params, mut state) = network.closed();
        let zeros = vec![0.0; model.spring_count()];
        params.spring_stiffness = std::sync::Arc::new(zeros);
        params.dt = 1e-4;
        let mut solver = SymplecticEuler::new(model.clone(), &params);
        let kinetic = |state: &State| sprung::Energy::of(&model, &params, state).kinetic;
        for _ in 0..50 {
            let before = kinetic(&state);
            solver.step(&params, &mut state, &Inline);
            prop_assert!(kinetic(&state) <= before * (1.0 + 20.0 * U), "{} J became {} J", before, kinetic(&state));
        }
    }
}

/// The report prints the force on j as F^s − F^d. Then the two forces of a spring add up to 2F^s instead of zero, and each
/// step makes a momentum of 2·F^s·dt out of nothing: on a stretched spring, all of what the engine keeps and more.
#[test]
fn the_reports_sign_error_would_lose_momentum_and_the_engine_does_not() {
    let (stiffness, damping, rest, dt) = (100.0f64, 4.0f64, 1.0f64, 0.01f64);
    let network = Network {
        points: vec![([0.0; 3], [0.0; 3], 1.0, false), ([1.5, 0.0, 0.0], [1.0, 0.0, 0.0], 1.0, false)],
        springs: vec![(0, 1, stiffness as f32, damping as f32, rest as f32)],
        low: vec![0.0; 6],
    };
    let (mut x, mut v, mut made) = ([0.0, 1.5], [0.0, 1.0], 0.0);
    let (model, mut params, mut state) = network.closed();
    params.dt = dt;
    let mut solver = SymplecticEuler::new(model.clone(), &params);
    for _ in 0..20 {
        let (e, w): (f64, f64) = (x[0] - x[1], v[0] - v[1]);
        let spring = -stiffness * (e.abs() - rest) * e.signum();
        let damper = -damping * w; // along one line, (w·u)u is w
        v = [v[0] + dt * (spring + damper), v[1] + dt * (spring - damper)];
        x = [x[0] + dt * v[0], x[1] + dt * v[1]];
        made += 2.0 * spring * dt;
        solver.step(&params, &mut state, &Inline);
    }
    assert!((v[0] + v[1] - 1.0 - made).abs() < 1e-9 && made.abs() > 10.0, "{made} kg·m/s from nowhere");
    // Twenty steps of two forces under 100 N, each rounded a dozen times.
    let kept = momenta(&params, &state).0.x;
    assert!((kept - 1.0).abs() < 20.0 * dt * 2.0 * 100.0 * 12.0 * U, "{kept} kg·m/s");
}

#[test]
fn a_damper_stops_what_it_can_and_nothing_else() {
    // Two points with a damper between them, moving apart and sideways: the axial motion dies, the common motion and the
    // speed of the middle stay as they are.
    let network = Network {
        points: vec![
            ([0.0; 3], [1.0, 3.0, 0.0], 1.0, false),
            ([2.0, 0.0, 0.0], [-1.0, 3.0, 0.0], 1.0, false),
        ],
        springs: vec![(0, 1, 0.0, 5.0, 0.0)],
        low: vec![0.0; 6],
    };
    let (model, params, mut state) = network.closed();
    let mut solver = SymplecticEuler::new(model.clone(), &params);
    (0..30_000).for_each(|_| {
        solver.step(&params, &mut state, &Inline);
    });
    // The difference of the velocities dies as e^{−2·k_d·t/m} = e^{−30}.
    assert!((state.velocity[0] - state.velocity[1]).length() < 1e-6);
    assert!((state.velocity[0] - sprung::Vec3::new(0.0, 3.0, 0.0)).length() < 1e-5);
}
