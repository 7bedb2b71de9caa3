//! The true limit of the current configuration, as the solution of an eigenvalue problem.

use glam::Vec3;

use super::limit_of_mode;
use super::network::{Network, Weights};
use super::top_mode::{Solved, TopMode};
use crate::model::Model;
use crate::params::Params;

/// The sharp limit and the quantities beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sharp {
    /// The limit on dt, s: just below it every mode decays or stays, just above it one grows. `None`: nothing limits dt.
    pub dt: Option<f64>,
    /// The largest squared frequency ω² = λ_max(M^(-½) K M^(-½)), 1/s². Zero if no mode oscillates.
    pub omega2_max: f64,
    /// The largest damping per mass c = λ_max(M^(-½) C M^(-½)), 1/s.
    pub c_max: f64,
    /// |A x − 4x| / |4x| at the limit, A = M^(-½)(dt²K + 2dt·C)M^(-½): how well the iteration converged. An eigenvalue of A
    /// lies within this part of 4; in a long iteration that was cut off, the limit is off by far less.
    pub residual: f64,
    /// Products with K or C that it took.
    pub iterations: u32,
}

/// The residual at which an iteration stops. The error of the limit falls with its square.
const TOLERANCE: f64 = 1e-6;

/// Noise mixed into a mode before the next problem starts from it, relative to the mode's length.
const NOISE: f64 = 0.3;

/// The springs are held in float32, which changes K and C by up to 1.8e-7. The limit is raised by as much, so that it
/// stays what the iteration makes it, an upper bound, and is never below the certified one where both are exact.
const FLOAT32: f64 = 2e-7;

/// Work that all solves together may take, in products with one spring: about a second on one core.
const SPRING_PRODUCTS: usize = 100_000_000;

/// Limits of the products with the whole network that all solves together may take.
const PRODUCTS: [usize; 2] = [30, 6_000];

/// The limit on dt in the given configuration: where λ_max(M^(-½)(dt²K + 2dt·C)M^(-½)) = 4.
///
/// K is the true Hessian Σ k[n nᵀ + (1 − L/ℓ)(I − n nᵀ)], to which a compressed spring gives less than nothing across its
/// axis, C = Σ k_d n nᵀ; touching contacts add k_c n nᵀ and k_c,d n nᵀ, grabs k·I and k_d·I. A spring between coincident
/// points counts with k·I if its rest length is zero, and else not at all. The three problems (dt, ω²_max, c_max) are
/// solved apart: taking the limit from ω²_max and c_max would be up to a third too low, as different modes may have them.
///
/// For any vector y, the dt that solves dt²ω²(y) + 2dt·c(y) = 4 is at least the limit. So the iteration approaches it from
/// above, and where a step is *chosen*, a margin belongs in between ([`auto_dt`](super::auto_dt) has one).
/// Networks of up to some tens of thousands of springs converge fully. Larger ones stop after an amount of work
/// fixed by the number of springs, never by a clock, within 0.1 % of the limit in practice.
///
/// Memory: 32 bytes per spring and 170 per point, given back on return.
///
/// ```
/// use sprung::{Material, ModelBuilder, Vec3, stability};
///
/// // Two masses on a spring: ω² = 2k/m, c = 2k_d/m.
/// let mut builder = ModelBuilder::new();
/// let a = builder.add_point(Vec3::ZERO, 1.0)?;
/// let b = builder.add_point(Vec3::X, 1.0)?;
/// builder.add_spring(a, b, Material { stiffness: 50.0, damping: 1.0 })?;
/// let (model, params, state) = builder.build()?;
/// let sharp = stability::sharp(&model, &params, &state.position);
/// assert!((sharp.omega2_max - 100.0).abs() < 1e-6);
/// assert!((sharp.c_max - 2.0).abs() < 1e-6);
/// let dt = sharp.dt.expect("a live spring limits dt");
/// assert!((dt * dt * 100.0 + 2.0 * dt * 2.0 - 4.0).abs() < 1e-6);
/// # Ok::<(), sprung::Error>(())
/// ```
///
/// # Panics
/// If `params` is not of this model ([`Params::validate`]), or there are fewer positions than points.
pub fn sharp(model: &Model, params: &Params, positions: &[Vec3]) -> Sharp {
    let network = Network::new(model, params, positions);
    let [fewest, most] = PRODUCTS;
    let budget = (SPRING_PRODUCTS / network.size().max(1)).clamp(fewest, most) as u32;
    let sharp = match network.damping_per_stiffness() {
        Some(ratio) => one_problem(&network, ratio, budget),
        None => three_problems(&network, budget),
    };
    Sharp { dt: sharp.dt.map(|dt| dt * (1.0 + FLOAT32)), ..sharp }
}

const STIFFNESS: Weights = Weights { stiffness: 1.0, damping: 0.0 };
const DAMPING: Weights = Weights { stiffness: 0.0, damping: 1.0 };

/// C = γK: all three problems have the same modes.
fn one_problem(network: &Network, ratio: f64, budget: u32) -> Sharp {
    let mut mode = TopMode::new(network);
    let Solved { eigenvalue, residual } = mode.solve(STIFFNESS, TOLERANCE, budget);
    let omega2_max = eigenvalue.max(0.0);
    let c_max = ratio * omega2_max;
    Sharp { dt: limit_of_mode(omega2_max, c_max), omega2_max, c_max, residual, iterations: mode.products }
}

/// The general case: half of the budget for the joint problem, a quarter for each of K and C alone.
fn three_problems(network: &Network, budget: u32) -> Sharp {
    let mut mode = TopMode::new(network);
    let mut joint = Joint { dt: None, residual: 0.0 };
    joint.solve(&mut mode, budget / 2);
    // K and C alone, each started from the mode before and some noise, as the mode may live in one corner of the
    // network and the next in another.
    let mut alone = |weights| {
        mode.add_noise(NOISE);
        let solved = mode.solve(weights, TOLERANCE, budget / 4);
        // Their modes bound the limit too. Should the joint iteration have missed one, it goes on from there.
        let (omega2, c) = mode.quotients();
        if let Some(dt) = limit_of_mode(omega2, c)
            && joint.dt.is_none_or(|known| dt < known * (1.0 - TOLERANCE))
        {
            joint.solve(&mut mode, budget / 4);
        }
        solved.eigenvalue.max(0.0)
    };
    let omega2_max = alone(STIFFNESS);
    let c_max = alone(DAMPING);
    Sharp { dt: joint.dt, omega2_max, c_max, residual: joint.residual, iterations: mode.products }
}

/// The joint problem: the dt at which the largest eigenvalue of M⁻¹(dt²K + 2dt·C) is 4.
struct Joint {
    dt: Option<f64>,
    residual: f64,
}

impl Joint {
    /// Lowers dt from the current mode on: the top mode at this dt, the dt at which that mode reaches its limit, and
    /// again. Each round's dt is at least the limit and at most the last, and its error is the square of the last.
    fn solve(&mut self, mode: &mut TopMode, budget: u32) {
        let end = mode.products + budget;
        // The first rounds need not be exact, as their dt is not.
        let mut round_budget = 8;
        let mut converged = false;
        loop {
            let (omega2, c) = mode.quotients();
            let Some(dt) = limit_of_mode(omega2, c) else { return };
            let settled = converged && self.dt.is_some_and(|last| dt >= last * (1.0 - TOLERANCE));
            self.dt = Some(self.dt.map_or(dt, |last| last.min(dt)));
            if settled || mode.products >= end {
                return;
            }
            if converged {
                // What was on top at the last dt need not be at this one, and a converged x has lost all else.
                mode.add_noise(NOISE);
            }
            let weights = Weights { stiffness: dt * dt, damping: 2.0 * dt };
            let left = end - mode.products;
            self.residual = mode.solve(weights, TOLERANCE, left.min(round_budget)).residual;
            converged = self.residual <= TOLERANCE;
            round_budget *= 2;
        }
    }
}
