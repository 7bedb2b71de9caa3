//! Safe limits in one pass over the springs.
//!
//! *Why they are safe.* Write the stiffness as K = Σ_s G_sᵀ B_s G_s, where G_s takes the difference of spring s's ends. The
//! non-zero eigenvalues of M^(-½) K M^(-½) are those of the matrix over springs N = B^½ G M⁻¹ Gᵀ B^½, a sum of one
//! block P_i per point that involves only the springs at i, and whose norm is S_i = λ_max(Σ_{s∋i} B_s)/m_i. Hence
//!
//! ```text
//! zᵀN z = Σ_i zᵀP_i z ≤ Σ_i S_i Σ_{s∋i} |z_s|² = Σ_s (S_i + S_j) |z_s|² ≤ max_s (S_i + S_j) · |z|²
//! ```
//!
//! (for graphs, the bound of Anderson and Morley, 1985). A contact or grab of stiffness A_i per mass is a spring from i
//! to a fixed place. Splitting P_i so that the anchor bears S_i/q + A_i and each spring S_i + q·A_i, with
//! q = S_i/(S_i + T_i) and T_i the largest S across a spring from i, gives at every spring no more than
//!
//! ```text
//! S_i + S_j + max(A_i, A_j)
//! ```
//!
//! and A_i at a point without springs. (Counting A_i and A_j both would be safe too, and up to √2 too careful.)
//! The same holds for C, and so for dt²K + 2dt·C at any dt.

use std::ops::Add;

use glam::Vec3;

use super::network::axis_and_length;
use super::symmetric3::Symmetric3;
use super::{Limit, Setter, limit_of_mode};
use crate::contact::Plane;
use crate::model::Model;
use crate::params::Params;

/// The limits are rounded down by this part. It covers the rounding of all sums above it at points with fewer than
/// 10⁴ springs (each addition is off by 1.1e-16 at most).
const ROUNDING: f64 = 1e-12;

/// A limit on dt that is safe in the given configuration: with its springs' directions and lengths, the contacts that
/// touch, and the grabs. `None` if nothing limits dt.
///
/// With n a spring's direction and B = k[n nᵀ + max(0, 1 − L/ℓ)(I − n nᵀ)], the positive part of its Hessian:
///
/// ```text
/// S_i = λ_max(Σ_{s∋i} B_s)/m_i        A_i = (Σ k_c over touched planes + Σ k over grabs)/m_i
/// ω² = S_i + S_j + max(A_i, A_j)       c likewise, of k_d n nᵀ and k_c,d
/// dt = min over springs of 4/(c + √(c² + 4ω²))
/// ```
///
/// S and A of a fixed point are zero. A spring between coincident points has no direction: B = k·I, damping k_d·I.
/// Cut springs and springs between two fixed points do not count; repeated springs add up.
///
/// It takes as long as some hundred steps, in float64 and on one thread;
/// [`Simulation::certified_limit`](crate::Simulation::certified_limit) is the same for a simulation at what a few steps take.
///
/// `positions` holds one position per point, m. It may hold anything: a spring at a position that is not finite
/// counts as if it had no direction.
///
/// ```
/// use sprung::{Material, ModelBuilder, Vec3, stability};
///
/// let mut builder = ModelBuilder::new();
/// let hook = builder.add_point(Vec3::ZERO, 0.0)?;
/// let bob = builder.add_point(Vec3::new(0.0, -5.0, 0.0), 1.0)?;
/// let spring = builder.add_spring(hook, bob, Material { stiffness: 1.0, damping: 0.2 })?;
/// let (model, params, state) = builder.build()?;
/// let limit = stability::certified(&model, &params, &state.position).expect("it has a live spring");
/// assert_eq!(limit.setter, stability::Setter::Spring(spring));
/// assert!((limit.dt - 1.80998).abs() < 1e-5); // 4/(0.2 + √(0.04 + 4)), exact for a single mode
/// # Ok::<(), sprung::Error>(())
/// ```
///
/// # Panics
/// If `params` is not of this model ([`Params::validate`]), or there are fewer positions than points.
pub fn certified(model: &Model, params: &Params, positions: &[Vec3]) -> Option<Limit> {
    let inverse_masses = inverse_masses(params);
    let (springs, anchors) = loads(model, params, positions, &inverse_masses);
    tightest(model, params, &inverse_masses, &springs, &anchors)
}

/// The loads of springs and of anchors at each point in one configuration.
fn loads(
    model: &Model,
    params: &Params,
    positions: &[Vec3],
    inverse_masses: &[f64],
) -> (Vec<Load>, Vec<Load>) {
    let mut stiffness = vec![Symmetric3::default(); model.point_count()];
    let mut damping = stiffness.clone();
    for (spring, [i, j]) in live_springs(model, params, inverse_masses) {
        let k = f64::from(params.spring_stiffness[spring]);
        let d = f64::from(params.spring_damping[spring]);
        let rest_length = f64::from(params.spring_rest_length[spring]);
        // n, B = k·n nᵀ + across·(I − n nᵀ), and the damper's part across n.
        let (n, across, damping_across) = match axis_and_length(positions[i], positions[j]) {
            Some((n, length)) => (n, k * (1.0 - rest_length / length).max(0.0), 0.0),
            None => (glam::DVec3::X, k, d),
        };
        for end in [i, j] {
            stiffness[end].add(n, k, across);
            damping[end].add(n, d, damping_across);
        }
    }
    let load = |(point, &per_mass): (usize, &f64)| {
        if per_mass == 0.0 {
            return Load::default();
        }
        let [omega2, c] = [stiffness[point], damping[point]].map(|sum| sum.largest_eigenvalue() * per_mass);
        Load { omega2, c }
    };
    let springs = inverse_masses.iter().enumerate().map(load).collect();
    let touches = |plane: &Plane, point: usize| plane.depth(positions[point]) > 0.0;
    (springs, anchor_loads(params, inverse_masses, touches))
}

/// A limit on dt that is safe in every configuration the network can ever take, with every point touching every
/// plane. `None` if nothing limits dt. It changes only with masses, pins, stiffness, damping, cuts, planes and grabs.
///
/// It takes as long as six or seven steps; a simulation remembers it
/// ([`limit_of_every_configuration`](crate::Simulation::limit_of_every_configuration)).
///
/// As [`certified`], but with B ⪯ k·I for every direction and length: S_i = Σ_{s∋i} k_s/m_i, likewise of k_d.
///
/// ```
/// use sprung::{Material, ModelBuilder, Plane, Vec3, stability};
///
/// let mut builder = ModelBuilder::new();
/// let a = builder.add_point(Vec3::ZERO, 1.0)?;
/// let b = builder.add_point(Vec3::X, 1.0)?;
/// builder.add_spring(a, b, Material { stiffness: 50.0, damping: 0.0 })?;
/// let (model, mut params, _) = builder.build()?;
/// let limit = |params: &_| stability::every_configuration(&model, params).expect("it has a live spring").dt;
/// assert!((limit(&params) - 0.2).abs() < 1e-9); // 2/√(50 + 50)
/// params.planes.push(Plane::level(0.0, 300.0, 0.0));
/// assert!((limit(&params) - 0.1).abs() < 1e-9); // 2/√(50 + 50 + 300)
/// # Ok::<(), sprung::Error>(())
/// ```
///
/// # Panics
/// If `params` is not of this model ([`Params::validate`]).
pub fn every_configuration(model: &Model, params: &Params) -> Option<Limit> {
    let inverse_masses = inverse_masses(params);
    let (springs, anchors) = loads_everywhere(model, params, &inverse_masses);
    // Rounded down once more: equal limits may round differently, and this one is never to be above the certified.
    let limit = tightest(model, params, &inverse_masses, &springs, &anchors)?;
    Some(Limit { dt: limit.dt * (1.0 - ROUNDING), ..limit })
}

/// The largest loads of springs and of anchors at each point that any configuration has.
fn loads_everywhere(model: &Model, params: &Params, inverse_masses: &[f64]) -> (Vec<Load>, Vec<Load>) {
    let mut springs = vec![Load::default(); model.point_count()];
    for (spring, ends) in live_springs(model, params, inverse_masses) {
        let k = f64::from(params.spring_stiffness[spring]);
        let d = f64::from(params.spring_damping[spring]);
        for end in ends {
            springs[end] = springs[end] + Load { omega2: k, c: d };
        }
    }
    for (load, &per_mass) in springs.iter_mut().zip(inverse_masses) {
        *load = load.times(per_mass);
    }
    (springs, anchor_loads(params, inverse_masses, |_, _| true))
}

/// The factor on the damping of all springs that makes the step `dt` this share of the certified limit, or, where it is
/// within that, of the limit of every configuration. `None` where it is within both, or no factor above 0 does.
pub(crate) fn damping_scale(
    model: &Model,
    params: &Params,
    positions: &[Vec3],
    dt: f64,
    share: f64,
) -> Option<f64> {
    let is_over = |limit: Option<Limit>| limit.is_some_and(|limit| dt > limit.dt);
    let inverse_masses = inverse_masses(params);
    let (springs, anchors) = if is_over(certified(model, params, positions)) {
        loads(model, params, positions, &inverse_masses)
    } else if is_over(every_configuration(model, params)) {
        loads_everywhere(model, params, &inverse_masses)
    } else {
        return None;
    };
    let dt = dt / share;
    // dt²ω² + 2dt(s·c + c_anchor) ≤ 4 at every spring, and at every anchor by itself.
    let anchors_allow = anchors.iter().all(|anchor| anchor.demand(dt) < 4.0);
    let mut scale: f64 = 1.0;
    for (_, [i, j]) in live_springs(model, params, &inverse_masses) {
        let (here, anchor) = (springs[i] + springs[j], anchors[i].max(anchors[j]));
        let without_dampers = Load { c: anchor.c, ..here + anchor };
        let left = 4.0 - without_dampers.demand(dt);
        if here.c > 0.0 || left <= 0.0 {
            scale = scale.min(left / (2.0 * dt * here.c));
        }
    }
    (anchors_allow && scale > 0.0 && scale < 1.0).then_some(scale)
}

/// Bounds of the squared frequency ω² (1/s²) and the damping per mass c (1/s).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Load {
    omega2: f64,
    c: f64,
}

impl Load {
    fn times(self, factor: f64) -> Self {
        Self { omega2: self.omega2 * factor, c: self.c * factor }
    }

    fn max(self, other: Self) -> Self {
        Self { omega2: self.omega2.max(other.omega2), c: self.c.max(other.c) }
    }

    /// dt²ω² + 2dt·c, of which 4 is the most that is stable.
    fn demand(self, dt: f64) -> f64 {
        dt * dt * self.omega2 + 2.0 * dt * self.c
    }
}

impl Add for Load {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { omega2: self.omega2 + other.omega2, c: self.c + other.c }
    }
}

/// 1/m of each point in float64, zero for a fixed one.
fn inverse_masses(params: &Params) -> Vec<f64> {
    let inverse =
        |point| if params.is_fixed(point) { 0.0 } else { 1.0 / f64::from(params.point_mass[point]) };
    (0..params.point_mass.len()).map(inverse).collect()
}

/// The springs that can move anything, as [`Params::is_live`] has it, and their ends.
fn live_springs(
    model: &Model,
    params: &Params,
    inverse_masses: &[f64],
) -> impl Iterator<Item = (usize, [usize; 2])> {
    let springs = model.springs().iter().zip(params.spring_cut.iter()).enumerate();
    springs.filter_map(|(spring, (ends, is_cut))| {
        let ends = ends.map(|end| end as usize);
        let is_live = !is_cut && ends.iter().any(|&end| inverse_masses[end] > 0.0);
        is_live.then_some((spring, ends))
    })
}

/// What the touched planes and the grabs add at each point.
fn anchor_loads(
    params: &Params,
    inverse_masses: &[f64],
    touches: impl Fn(&Plane, usize) -> bool,
) -> Vec<Load> {
    let mut loads = vec![Load::default(); params.point_mass.len()];
    for plane in &params.planes {
        // The normal enters the force twice, and float32 lets it be a little longer than 1.
        let normal = plane.normal.as_dvec3();
        let load = Load { omega2: f64::from(plane.stiffness), c: f64::from(plane.damping) }
            .times(normal.dot(normal));
        for (point, sum) in loads.iter_mut().enumerate() {
            if touches(plane, point) {
                *sum = *sum + load;
            }
        }
    }
    for grab in &params.grabs {
        loads[grab.point] =
            loads[grab.point] + Load { omega2: f64::from(grab.stiffness), c: f64::from(grab.damping) };
    }
    for (load, &per_mass) in loads.iter_mut().zip(inverse_masses) {
        *load = load.times(per_mass);
    }
    loads
}

/// The smallest limit over all live springs and anchored points, and what sets it.
fn tightest(
    model: &Model,
    params: &Params,
    inverse_masses: &[f64],
    springs: &[Load],
    anchors: &[Load],
) -> Option<Limit> {
    let mut tightest: Option<(Limit, Load)> = None;
    let mut consider = |load: Load, setter: Setter| {
        // No root for a load that is no larger in anything: in a lattice most are alike.
        if tightest.is_some_and(|(_, most)| load.omega2 <= most.omega2 && load.c <= most.c) {
            return;
        }
        if let Some(dt) = limit_of_mode(load.omega2, load.c)
            && tightest.is_none_or(|(limit, _)| dt < limit.dt)
        {
            tightest = Some((Limit { dt, setter }, load));
        }
    };
    for (spring, [i, j]) in live_springs(model, params, inverse_masses) {
        consider(springs[i] + springs[j] + anchors[i].max(anchors[j]), Setter::Spring(spring));
    }
    for (point, &load) in anchors.iter().enumerate() {
        consider(load, Setter::Point(point));
    }
    let (limit, _) = tightest?;
    Some(Limit { dt: limit.dt * (1.0 - ROUNDING), setter: blame(model, limit, anchors) })
}

/// The smallest limit that some springs set, and the anchors of a point, s: for the kernel's tests.
#[cfg(test)]
pub(crate) fn limit_of_springs_at(
    model: &Model,
    params: &Params,
    positions: &[Vec3],
    springs: &[usize],
    point: Option<usize>,
) -> f64 {
    let (loads, anchors) = loads(model, params, positions, &inverse_masses(params));
    let live = springs.iter().filter(|&&spring| params.is_live(model, spring));
    let of_springs = live.map(|&spring| {
        let [i, j] = model.springs()[spring].map(|end| end as usize);
        loads[i] + loads[j] + anchors[i].max(anchors[j])
    });
    let all = of_springs.chain(point.map(|point| anchors[point]));
    all.filter_map(|load| limit_of_mode(load.omega2, load.c)).fold(f64::INFINITY, f64::min)
}

/// Where a contact or grab at a spring's end makes more than half of the demand, it is to blame and not the spring.
fn blame(model: &Model, limit: Limit, anchors: &[Load]) -> Setter {
    let Setter::Spring(spring) = limit.setter else { return limit.setter };
    let ends = model.springs()[spring].map(|end| end as usize);
    let culprit = ends.into_iter().find(|&end| anchors[end].demand(limit.dt) > 2.0);
    culprit.map_or(limit.setter, Setter::Point)
}
