//! Motions whose exact discrete solution is known: the engine must follow it to rounding, and it must
//! approach the continuous one at first order.

mod common;

use common::{U, oscillator, position, simulation, steps, velocity};
use sprung::{Material, ModelBuilder, SettleOptions, Simulation, Vec3};

/// One free point, thrown.
fn thrown(x: Vec3, v: Vec3, mass: f32, dt: f64) -> Simulation {
    let mut builder = ModelBuilder::new();
    builder.add_point(x, mass).expect("allowed");
    builder.set_velocity(0, v).expect("allowed");
    let (model, mut params, state) = builder.build().expect("there is a point");
    params.dt = dt;
    simulation((model, params, state))
}

/// Free fall: v_n = v_0 − n·g·dt and x_n = x_0 + n·v_0·dt − g·dt²·n(n + 1)/2.
///
/// g, dt and the mass are rounded to float32 before the run and are what they then are; g·m, 1/m, a and a·dt are
/// rounded once each, 4u of the speed gained and of the height fallen; adding v·dt, whose v is rounded by u, to what was
/// dropped before makes 3u of the way more. Then half an ulp of the sum itself. Nothing grows with the number of steps.
#[test]
fn free_fall_follows_the_recurrence_to_the_ulp() {
    for (dt, count) in [(1e-6, 300_000), (1e-5, 300_000), (1e-3, 10_000), (0.01, 1000), (0.25, 40)] {
        for (x, v) in [(1000.0f32, 1000.0f32), (-3.0, 0.0), (0.0, 10.0)] {
            for mass in [1.0f32, 0.3] {
                let mut fall = thrown(Vec3::new(0.0, x, 0.0), Vec3::new(0.0, v, 0.0), mass, dt);
                steps(&mut fall, count);

                let (n, step, g) = (count as f64, f64::from(dt as f32), f64::from(9.81f32));
                let (x, v) = (f64::from(x), f64::from(v));
                let gained = n * g * step;
                let fallen = g * step * step * n * (n + 1.0) / 2.0;
                let (expected_v, expected_x) = (v - gained, x + n * v * step - fallen);
                let allowed_v = 4.0 * U * gained + U * expected_v.abs();
                let way = n * step * v.abs().max(expected_v.abs());
                let allowed_x = 4.0 * U * fallen + 3.0 * U * way + U * expected_x.abs();

                let state = fall.state();
                let off_v = f64::from(state.velocity[0].y) - expected_v;
                let off_x = f64::from(state.position[0].y) - expected_x;
                assert!(off_v.abs() <= allowed_v, "dt {dt}: v off by {off_v:e}, allowed {allowed_v:e}");
                assert!(off_x.abs() <= allowed_x, "dt {dt}: x off by {off_x:e}, allowed {allowed_x:e}");
            }
        }
    }
}

/// The exact recurrence ends g·dt·t/2 too low. With dt = 10⁻⁶ s, g·dt is far below half an ulp of the speed of 1000 m/s:
/// a plain float32 sum would never feel gravity at all. Ten times the steps must divide the error by ten, until nothing
/// but the float32 of the answer itself is left.
#[test]
fn more_substeps_never_make_free_fall_worse() {
    let time = 0.5;
    let (x0, v0, g) = (100.0f32, 1000.0f32, f64::from(9.81f32));
    let exact = f64::from(x0) + f64::from(v0) * time - 0.5 * g * time * time;
    let mut before = f64::INFINITY;
    for dt in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
        let mut fall = thrown(Vec3::new(0.0, x0, 0.0), Vec3::new(0.0, v0, 0.0), 1.0, dt);
        steps(&mut fall, (time / dt).round() as u64);
        let error = (position(fall.state(), 0).y - exact).abs();
        // dt itself is rounded to float32 (u of the way), and see above.
        let floor = (1.0 + 3.0) * U * f64::from(v0) * time;
        assert!(error <= 0.5 * g * dt * time + floor, "dt {dt}: off by {error:e}");
        assert!(error <= before + floor, "dt {dt}: off by {error:e}, and by {before:e} before");
        before = error;
    }
}

/// Symplectic Euler on q'' = −ω²q − c·q' is the recurrence q_{n+1} = τ·q_n − δ·q_{n−1} with
/// δ = 1 − c·dt and τ = 1 + δ − ω²dt², so q_n = rⁿ(A cos nθ + B sin nθ), r = √δ, cos θ = τ/2r.
struct Recurrence {
    r: f64,
    theta: f64,
    a: f64,
    b: f64,
}

impl Recurrence {
    fn new(omega2: f64, c: f64, dt: f64, q: f64, speed: f64) -> Self {
        let delta = 1.0 - c * dt;
        let r = delta.sqrt();
        let theta = ((1.0 + delta - omega2 * dt * dt) / (2.0 * r)).acos();
        let q1 = q + dt * (delta * speed - omega2 * dt * q);
        Self { r, theta, a: q, b: (q1 / r - q * theta.cos()) / theta.sin() }
    }

    fn at(&self, n: f64) -> f64 {
        self.r.powf(n) * (self.a * (n * self.theta).cos() + self.b * (n * self.theta).sin())
    }
}

#[test]
fn an_oscillator_follows_the_solution_of_the_recurrence() {
    for (damping, dt) in [(0.0f32, 0.01), (0.0, 0.1), (0.5, 0.01), (0.5, 0.1), (4.0, 0.02)] {
        let (mass, stiffness, rest, q, speed) = (2.0f32, 50.0f32, 3.0f32, 1.0f32, -2.0f32);
        let mut run = simulation(oscillator(mass, Material { stiffness, damping }, rest, rest + q, speed));
        let (omega2, c) = (f64::from(stiffness / mass), f64::from(damping / mass));
        let step = f64::from(dt as f32);
        let exact = Recurrence::new(omega2, c, step, f64::from(q), f64::from(speed));
        // Each step the position (at most 5 m) is rounded where the force looks at it, and the force itself three times:
        // ω²·4u·5 m of acceleration, a kick of dt times that. A kick moves q by 1/ω at the most (more where ω·dt nears 2, by
        // 1/√(1 − (ω·dt/2)²)), and n kicks add up to n times one.
        let omega = omega2.sqrt();
        let kick =
            step * 4.0 * U * (omega2 * 5.0 + c * 6.0) / omega / (1.0 - omega2 * step * step / 4.0).sqrt();
        for n in 1..=1500 {
            run.step(dt).expect("stable");
            let found = position(run.state(), 1).x - f64::from(rest);
            let off = (found - exact.at(f64::from(n))).abs();
            assert!(off <= f64::from(n) * kick, "c {c}, dt {dt}: off by {off:e} at step {n}");
        }
    }
}

#[test]
fn an_oscillator_approaches_the_continuous_solution_at_first_order() {
    let (omega2, time) = (25.0f64, 1.6);
    for c in [0.0, 0.75] {
        // q'' = −ω²q − c·q' from q = 1, q' = 0: e^{−ct/2}(cos wt + c/2w·sin wt), w² = ω² − c²/4.
        let w = (omega2 - c * c / 4.0).sqrt();
        let exact = (-c * time / 2.0).exp() * ((w * time).cos() + c / (2.0 * w) * (w * time).sin());
        let error = |dt: f64| {
            let material = Material { stiffness: omega2 as f32, damping: c as f32 };
            let mut run = simulation(oscillator(1.0, material, 3.0, 4.0, 0.0));
            (0..(time / dt).round() as u64).for_each(|_| run.step(dt).expect("stable"));
            position(run.state(), 1).x - 3.0 - exact
        };
        let errors = [0.008, 0.004, 0.002, 0.001].map(error);
        for pair in errors.windows(2) {
            // Error = C·dt + O(dt²): the ratio misses 2 by about ω·dt.
            let ratio = pair[0] / pair[1];
            assert!((ratio - 2.0).abs() < 0.08, "c {c}: the error fell by {ratio} when dt was halved");
        }
    }
}

/// The same on a whole scene: the chain against itself with a far smaller step, in float64.
#[test]
fn a_scene_converges_at_first_order() {
    let time = 0.96;
    let mut fine = common::scenes::chain().twin;
    (0..96_000).for_each(|_| fine.step(1e-5));
    let error = |dt: f64| {
        let mut run = common::scenes::engine(&common::scenes::chain());
        (0..(time / dt).round() as u64).for_each(|_| run.step(dt).expect("stable"));
        let apart = |(at, point): (usize, &common::twin::Point)| {
            (position(run.state(), at) - sprung::DVec3::from_array(point.x)).length_squared()
        };
        fine.points.iter().enumerate().map(apart).sum::<f64>().sqrt()
    };
    let errors = [0.008, 0.004, 0.002].map(error);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 1.0).abs() < 0.1, "order {order} from errors {errors:?}");
    }
}

/// At rest every spring of a hanging chain carries the weight of what hangs below it: k·(ℓ − L) = m_below·g.
#[test]
fn a_hanging_chain_stretches_spring_by_spring_under_what_hangs_below() {
    let (stiffness, rest) = (100.0f32, 1.0f32);
    let masses = [0.0f32, 1.0, 0.5, 2.0, 1.0, 1.0, 0.25, 3.0];
    let mut builder = ModelBuilder::new();
    for (index, &mass) in masses.iter().enumerate() {
        builder.add_point(Vec3::new(0.0, -rest * index as f32, 0.0), mass).expect("allowed");
        if index > 0 {
            builder.add_spring(index - 1, index, Material { stiffness, damping: 1.0 }).expect("allowed");
        }
    }
    let (model, mut params, state) = builder.build().expect("there are points");
    params.dt = 0.01;
    let mut chain = simulation((model, params, state));
    let residual = 1e-3;
    let options = SettleOptions { residual_force: Some(residual), ..SettleOptions::default() };
    let settled = chain.settle(options).expect("it comes to rest");
    assert!(settled.residual_force <= residual);
    assert!(chain.state().velocity.iter().all(|v| *v == Vec3::ZERO), "it is at rest");

    for spring in 0..masses.len() - 1 {
        let length = (position(chain.state(), spring) - position(chain.state(), spring + 1)).length();
        let below = &masses[spring + 1..];
        let weight = f64::from(below.iter().sum::<f32>()) * f64::from(9.81f32);
        let pull = f64::from(stiffness) * (length - f64::from(rest));
        // The residual forces of all points below add up; the force looks at rounded positions (two of them, under 16 m).
        let allowed = below.len() as f64 * residual + f64::from(stiffness) * 2.0 * 16.0 * U;
        assert!((pull - weight).abs() <= allowed, "spring {spring} pulls {pull} N under {weight} N");
    }
}

/// A row of n masses between two walls, `gap` m apart, springs of rest length `rest`.
fn taut_chain(
    n: usize,
    stiffness: f32,
    rest: f32,
    dt: f64,
) -> (sprung::Model, sprung::Params, sprung::State) {
    let mut builder = ModelBuilder::new();
    for index in 0..n + 2 {
        let mass = if index == 0 || index == n + 1 { 0.0 } else { 1.0 };
        builder.add_point(Vec3::X * index as f32, mass).expect("allowed");
        if index > 0 {
            let spring = builder.add_spring(index - 1, index, Material { stiffness, damping: 0.0 });
            builder.set_rest_length(spring.expect("allowed"), rest).expect("allowed");
        }
    }
    let (model, mut params, state) = builder.build().expect("there are points");
    params.gravity = Vec3::ZERO;
    params.dt = dt;
    (model, params, state)
}

/// Mode p of n masses, with φ_i = sin(π·p·i/(n + 1)), has ω_p = 2√(κ/m)·sin(π·p/2(n + 1)); along the chain κ is the
/// stiffness, across it the tension divided by the length. The *discrete* motion has θ = ω_d·dt with sin(θ/2) = ω·dt/2
/// exactly, and, let go at rest, q_n = A(cos nθ − tan(θ/2)·sin nθ).
#[test]
fn a_taut_chain_swings_in_its_normal_modes() {
    let (n, stiffness, rest, dt) = (9usize, 100.0f32, 0.6f32, 0.02);
    let step = f64::from(dt as f32);
    let tension_by_length = f64::from(stiffness) * (1.0 - f64::from(rest));
    for (axis, kappa, amplitude) in
        [(Vec3::X, f64::from(stiffness), 0.05f32), (Vec3::Y, tension_by_length, 0.002)]
    {
        for p in 1..=n {
            let phi = |i: usize| (std::f64::consts::PI * (p * i) as f64 / (n + 1) as f64).sin();
            let (model, params, mut state) = taut_chain(n, stiffness, rest, dt);
            for i in 1..=n {
                state.position[i] += axis * (amplitude * phi(i) as f32);
            }
            let mut run = simulation((model, params, state));
            let project = |run: &Simulation| {
                let along = |i: usize| {
                    let moved = position(run.state(), i) - sprung::DVec3::X * i as f64;
                    moved.dot(axis.as_dvec3()) * phi(i)
                };
                (1..=n).map(along).sum::<f64>() * 2.0 / (n + 1) as f64
            };
            let start = project(&run);
            let omega = 2.0 * kappa.sqrt() * (std::f64::consts::PI * p as f64 / (2 * (n + 1)) as f64).sin();
            let theta = 2.0 * (omega * step / 2.0).asin();
            // Rounding: as for one oscillator, kicks of dt·κ·(4u·1 m + 2u·10 m)/ω, n of them, at any of the masses.
            // Across the chain the springs also lengthen, by about ½(slope)²: a share k/κ·(π·p·A/(n + 1))² of the stiffness
            // at the most, and half of that share of the phase.
            let slope = std::f64::consts::PI * p as f64 / (n + 1) as f64 * f64::from(amplitude);
            let bend = if axis == Vec3::Y { f64::from(stiffness) / kappa * slope * slope } else { 0.0 };
            for count in 1..=400u32 {
                run.step(dt).expect("stable");
                let nth = f64::from(count);
                let expected = start * ((nth * theta).cos() - (theta / 2.0).tan() * (nth * theta).sin());
                let rounding = nth * step * f64::from(stiffness) * 24.0 * U / omega;
                let allowed = rounding + start.abs() * bend * nth * theta / 2.0;
                let off = (project(&run) - expected).abs();
                assert!(
                    off <= allowed,
                    "mode {p} along {axis}: off by {off:e} at step {count}, allowed {allowed:e}"
                );
            }
        }
    }
}

#[test]
fn a_pendulum_that_swings_once_around_stays_on_its_circle_without_a_push() {
    // Uniform circling without gravity: the spring's pull is the centripetal force, k(ℓ − L) = m·v²/ℓ. Symplectic Euler
    // lets the radius breathe by about ½ω·dt, and no more, over a hundred turns.
    let (stiffness, length, speed, dt) = (400.0f32, 2.0f32, 5.0f32, 0.002);
    let rest = length - speed * speed / (length * stiffness);
    let (model, mut params, mut state) =
        oscillator(1.0, Material { stiffness, damping: 0.0 }, rest, length, 0.0);
    params.dt = dt;
    state.velocity[1] = Vec3::Z * speed;
    let mut run = simulation((model, params, state));
    let breath = f64::from(length) * 0.5 * f64::from(stiffness).sqrt() * dt;
    for _ in 0..125_000 / 5 {
        steps(&mut run, 5);
        let radius = position(run.state(), 1).length();
        assert!((radius - f64::from(length)).abs() <= breath, "radius {radius}");
        assert!((velocity(run.state(), 1).length() - f64::from(speed)).abs() <= 5.0 * breath);
    }
}
