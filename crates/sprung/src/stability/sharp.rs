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

/// The springs are held in float32, which changes K and C by up to 1.8e-7. The limit is raised by as much, so that it
/// stays what the iteration makes it, an upper bound, and is never below the certified one where both are exact.
const FLOAT32: f64 = 2e-7;

/// Work of one problem, in products with one spring: well under a second on one core.
const SPRING_PRODUCTS: usize = 60_000_000;

/// Limits of the products with the whole network for one problem.
const PRODUCTS: [usize; 2] = [20, 3_000];

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
/// fixed by the number of springs, never by a clock: a jelly of 64³ points and 2.3 million springs after 26 products, with a
/// limit 0.013 % too large.
///
/// Memory: 32 bytes per spring and 160 per point, given back on return.
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
/// assert!((dt * dt * 100.0 + 2.0 * dt * 2.0 - 4.0).abs() < 1e-5);
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

/// The demand of dt.
fn demand(dt: f64) -> Weights {
    Weights { stiffness: dt * dt, damping: 2.0 * dt }
}

/// C = γK: all three problems have the same modes.
fn one_problem(network: &Network, ratio: f64, budget: u32) -> Sharp {
    let mut mode = TopMode::new(network);
    mode.start(STIFFNESS);
    let Solved { eigenvalue, residual } = mode.solve(STIFFNESS, TOLERANCE, budget);
    let omega2_max = eigenvalue.max(0.0);
    let c_max = ratio * omega2_max;
    Sharp { dt: limit_of_mode(omega2_max, c_max), omega2_max, c_max, residual, iterations: mode.products }
}

/// The general case: K and C alone, with half of the budget each, as their modes may live in different corners of the
/// network. Each of the two modes bounds the limit; the joint problem starts from the smaller bound.
fn three_problems(network: &Network, budget: u32) -> Sharp {
    let mut mode = TopMode::new(network);
    let mut alone = |weights| {
        mode.start(weights);
        let eigenvalue = mode.solve(weights, TOLERANCE, budget / 2).eigenvalue.max(0.0);
        let (omega2, c) = mode.quotients();
        (eigenvalue, limit_of_mode(omega2, c))
    };
    let (omega2_max, of_stiffest) = alone(STIFFNESS);
    let (c_max, of_most_damped) = alone(DAMPING);

    let bound = [of_stiffest, of_most_damped].into_iter().flatten().reduce(f64::min);
    let joint = bound.map(|bound| joint_problem(&mut mode, bound, budget));
    Sharp {
        dt: joint.map(|(dt, _)| dt),
        omega2_max,
        c_max,
        residual: joint.map_or(0.0, |(_, residual)| residual),
        iterations: mode.products,
    }
}

/// Lowers dt from a bound to where the largest eigenvalue of M⁻¹(dt²K + 2dt·C) is 4; gives it and the last residual.
///
/// In turns: the top mode at this dt, then the dt at which that mode reaches its limit. No turn goes below the limit,
/// and each leaves an error that is about the square of the last.
fn joint_problem(mode: &mut TopMode, bound: f64, budget: u32) -> (f64, f64) {
    let end = mode.products + budget;
    let mut dt = bound;
    // The first turns need not be exact, as their dt is not.
    let mut turn_budget = 8;
    mode.start(demand(dt));
    loop {
        let left = end.saturating_sub(mode.products);
        let residual = mode.solve(demand(dt), TOLERANCE, left.min(turn_budget)).residual;
        let (omega2, c) = mode.quotients();
        let next = limit_of_mode(omega2, c).map_or(dt, |next| next.min(dt));
        let converged = residual <= TOLERANCE;
        let settled = converged && next >= dt * (1.0 - TOLERANCE);
        dt = next;
        if settled || mode.products >= end {
            return (dt, residual);
        }
        if converged {
            mode.add_noise(); // what was on top at the last dt need not be at this one
        }
        turn_budget *= 2;
    }
}
