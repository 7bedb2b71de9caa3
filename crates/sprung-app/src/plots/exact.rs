//! Motions and shapes that have a formula, in float64: pure functions, each with the equation it solves.

use std::f64::consts::TAU;

/// One damped oscillator, x″ = −ω²x − c x′.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Damped {
    /// ω = √(k/m), 1/s.
    pub omega: f64,
    /// c = k_d/m, 1/s.
    pub c: f64,
}

impl Damped {
    /// Position and velocity a time `t` (s) after it was at `x` and moved at `v`.
    ///
    /// With Ω² = ω² − (c/2)² and B = v + ½c x the solution is e^(−ct/2) times
    /// x cos Ωt + (B/Ω) sin Ωt  (Ω² > 0: it swings),
    /// x + B t  (Ω² = 0),  or the same with cosh and sinh (Ω² < 0: it creeps).
    pub fn after(&self, x: f64, v: f64, t: f64) -> (f64, f64) {
        let half = 0.5 * self.c;
        let square = self.omega * self.omega - half * half;
        let b = v + half * x;
        let rate = square.abs().sqrt();
        // `cosine` and `sine` stand for cos Ωt and (sin Ωt)/Ω; the derivative of the former is −Ω² times the latter.
        let (cosine, sine) = if rate * t.abs() < 1e-9 {
            (1.0, t)
        } else if square > 0.0 {
            ((rate * t).cos(), (rate * t).sin() / rate)
        } else {
            ((rate * t).cosh(), (rate * t).sinh() / rate)
        };
        let decay = (-half * t).exp();
        let place = decay * (x * cosine + b * sine);
        let speed = decay * (b * cosine - x * square * sine) - half * place;
        (place, speed)
    }

    /// The time between two crossings in the same direction, T = 2π/√(ω² − (c/2)²), s. `None` if it creeps.
    pub fn period(&self) -> Option<f64> {
        let square = self.omega * self.omega - 0.25 * self.c * self.c;
        (square > 0.0).then(|| TAU / square.sqrt())
    }
}

/// Length at which a spring carries a mass at rest, m: k(ℓ − L) = m g.
pub fn hanging_length(rest_length: f64, stiffness: f64, mass: f64, g: f64) -> f64 {
    rest_length + mass * g / stiffness
}

/// Stretch of each spring of a hanging chain at rest, m, from the fixed end on: each spring carries all masses below it,
/// k_s · stretch_s = g Σ m. `masses` are those of the points at the lower end of each spring.
pub fn hanging_stretch(masses: &[f64], stiffness: &[f64], g: f64) -> Vec<f64> {
    let mut below = 0.0;
    let mut stretch: Vec<f64> = masses
        .iter()
        .zip(stiffness)
        .rev()
        .map(|(mass, k)| {
            below += mass;
            g * below / k
        })
        .collect();
    stretch.reverse();
    stretch
}

/// The times at which a curve crosses zero on its way up, by straight lines between its points. A curve that has just
/// crossed must first fall below zero again.
pub fn rising_crossings(curve: &[(f64, f64)]) -> Vec<f64> {
    let crossing = |pair: &[(f64, f64)]| {
        let [(t0, x0), (t1, x1)] = [pair[0], pair[1]];
        (x0 < 0.0 && x1 >= 0.0).then(|| t0 + (t1 - t0) * x0 / (x0 - x1))
    };
    curve.windows(2).filter_map(crossing).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::scene::Scene;
    use sprung::{Change, Material, ModelBuilder, SettleOptions, Simulation, Vec3};

    /// A mass of 1 kg on a spring of 1 N/m and 5 m, as in the scene, from some place and velocity.
    fn spring(place: Vec3, velocity: Vec3, dt: f64) -> Simulation {
        let mut builder = ModelBuilder::new();
        let hook = builder.add_point(Vec3::ZERO, 0.0).expect("a point");
        let bob = builder.add_point(place, 1.0).expect("a point");
        builder.set_velocity(bob, velocity).expect("a velocity");
        let spring =
            builder.add_spring(hook, bob, Material { stiffness: 1.0, damping: 0.2 }).expect("a spring");
        builder.set_rest_length(spring, 5.0).expect("a length");
        let mut simulation = builder.simulation().expect("a simulation");
        simulation.change(Change::Dt(dt)).expect("an allowed dt");
        simulation
    }

    #[test]
    fn the_oscillator_solves_its_equation_in_all_three_cases() {
        for c in [0.0, 0.2, 2.0, 5.0] {
            let damped = Damped { omega: 1.0, c };
            let (x, v) = damped.after(0.7, -0.3, 0.0);
            assert!((x - 0.7).abs() < 1e-15 && (v + 0.3).abs() < 1e-15);
            let h = 1e-4;
            for t in [0.3, 2.0, 7.0] {
                let (x, v) = damped.after(0.7, -0.3, t);
                let ((before, v0), (after, v1)) =
                    (damped.after(0.7, -0.3, t - h), damped.after(0.7, -0.3, t + h));
                assert!(((after - before) / (2.0 * h) - v).abs() < 1e-7, "the velocity is the derivative");
                assert!(((v1 - v0) / (2.0 * h) + x + c * v).abs() < 1e-7, "x″ = −ω²x − c x′");
            }
        }
        assert_eq!(Damped { omega: 1.0, c: 2.5 }.period(), None);
        assert!((Damped { omega: 2.0, c: 0.0 }.period().expect("it swings") - TAU / 2.0).abs() < 1e-15);
    }

    /// The engine's error against the formula falls with dt, at first order.
    #[test]
    fn vertical_motion_of_the_engine_comes_closer_to_the_formula_with_dt() {
        let length = hanging_length(5.0, 1.0, 1.0, f64::from(9.81f32));
        let error = |dt: f64| {
            let mut run = spring(Vec3::new(0.0, -(length as f32) - 3.0, 0.0), Vec3::ZERO, dt);
            (0..(8.0 / dt).round() as u32).for_each(|_| run.step(dt).expect("a step"));
            let exact = -length - Damped { omega: 1.0, c: 0.2 }.after(3.0, 0.0, 8.0).0;
            (f64::from(run.state().position[1].y) - exact).abs()
        };
        let (coarse, fine) = (error(0.02), error(0.01));
        assert!(coarse < 0.05 && (1.7..2.3).contains(&(coarse / fine)), "{coarse} {fine}");
    }

    /// A sideways swing of 1 % of the length: ω² = g/ℓ, and a damper along the spring does not brake it.
    #[test]
    fn a_small_swing_of_the_engine_follows_the_pendulum() {
        let g = f64::from(9.81f32);
        let length = hanging_length(5.0, 1.0, 1.0, g);
        let mut run = spring(Vec3::new(0.148, -(length as f32), 0.0), Vec3::ZERO, 0.001);
        let swing = Damped { omega: (g / length).sqrt(), c: 0.0 };
        for _ in 0..10_000 {
            run.step(0.001).expect("a step");
        }
        let exact = swing.after(0.148, 0.0, 10.0).0;
        assert!((f64::from(run.state().position[1].x) - exact).abs() < 0.01 * 0.148);
    }

    #[test]
    fn the_measured_period_is_the_formulas() {
        let damped = Damped { omega: 1.0, c: 0.2 };
        let curve: Vec<(f64, f64)> =
            (0..4000).map(|i| 0.01 * f64::from(i)).map(|t| (t, damped.after(1.0, 0.0, t).0)).collect();
        let crossings = rising_crossings(&curve);
        assert_eq!(crossings.len(), 6);
        let period = damped.period().expect("it swings");
        assert!(crossings.windows(2).all(|pair| (pair[1] - pair[0] - period).abs() < 1e-4));
        assert!(rising_crossings(&[]).is_empty());
        assert!(rising_crossings(&[(0.0, f64::NAN), (1.0, 1.0)]).is_empty());
    }

    #[test]
    fn the_settled_chain_is_stretched_as_the_formula_says() {
        let mut chain = Scene::builtin("chain").expect("it is there").simulation().expect("it builds");
        chain
            .settle(SettleOptions { residual_force: Some(1e-3), ..SettleOptions::default() })
            .expect("it settles");
        let exact = hanging_stretch(&[1.0; 14], &[200.0; 14], f64::from(9.81f32));
        assert!((exact[0] - 14.0 * 9.81 / 200.0).abs() < 1e-6 && (exact[13] - 9.81 / 200.0).abs() < 1e-7);
        for (spring, exact) in exact.iter().enumerate() {
            let [i, j] = chain.model().springs()[spring].map(|end| chain.state().position[end as usize]);
            let stretch = f64::from((i - j).length()) - 2.0;
            assert!((stretch - exact).abs() < 2e-4, "spring {spring}: {stretch} for {exact}");
        }
    }
}
