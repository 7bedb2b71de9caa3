//! The network as it moves around one configuration: K and C, applied without ever being stored as matrices.

use glam::{DVec3, Vec3};

use crate::math::COINCIDENT_SQUARED;
use crate::model::Model;
use crate::params::Params;

/// The unit vector from b to a and the distance, m. `None` where a spring has no axis: coincident points, or positions
/// that are not finite.
pub(super) fn axis_and_length(a: Vec3, b: Vec3) -> Option<(DVec3, f64)> {
    let e = a.as_dvec3() - b.as_dvec3();
    let squared = e.dot(e);
    let length = squared.sqrt();
    (squared >= f64::from(COINCIDENT_SQUARED) && length.is_finite()).then(|| (e / length, length))
}

/// αK + βC: which problem is meant. (dt², 2dt) is the demand of dt, (1, 0) the stiffness, (0, 1) the damping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Weights {
    pub stiffness: f64,
    pub damping: f64,
}

/// A symmetric 3×3 matrix along·n nᵀ + all·I each of stiffness (N/m) and damping (N·s/m).
///
/// Float32 and 24 bytes, because a pass over millions of them is bound by memory. The rounding of n changes an
/// eigenvalue by one part in 10⁷ of the largest stiffness in it.
#[derive(Clone, Copy, Debug)]
struct Tensor {
    axis: Vec3,
    stiffness_along: f32,
    stiffness_all: f32,
    damping_along: f32,
}

impl Tensor {
    /// (αK + βC) d.
    #[inline(always)]
    fn times(&self, weights: Weights, d: DVec3) -> DVec3 {
        let n = self.axis.as_dvec3();
        let along = weights.stiffness * f64::from(self.stiffness_along)
            + weights.damping * f64::from(self.damping_along);
        let all = weights.stiffness * f64::from(self.stiffness_all);
        d * all + n * (along * n.dot(d))
    }
}

/// A live spring.
#[derive(Clone, Copy, Debug)]
struct Link {
    ends: [u32; 2],
    tensor: Tensor,
}

/// A touching contact or a grab: it ties one point to space.
#[derive(Clone, Copy, Debug)]
struct Anchor {
    point: u32,
    tensor: Tensor,
    /// The grab's damping, which acts on all of the velocity.
    damping_all: f64,
}

/// K and C of a network around one configuration, and its masses.
#[derive(Clone, Debug)]
pub(super) struct Network {
    links: Vec<Link>,
    anchors: Vec<Anchor>,
    /// Mass of each point, kg; zero if fixed.
    pub mass: Vec<f64>,
    /// 1/m of each point, 1/kg; zero if fixed.
    pub inverse_mass: Vec<f64>,
}

impl Network {
    /// Linearises around a configuration. A spring's Hessian is k[n nᵀ + (1 − L/ℓ)(I − n nᵀ)]: less than nothing
    /// across a compressed spring. Between coincident points it is k·I for a spring of rest length zero, and nothing
    /// otherwise, as the step exerts no force there.
    pub fn new(model: &Model, params: &Params, positions: &[Vec3]) -> Self {
        let live = || (0..model.spring_count()).filter(|&spring| params.is_live(model, spring));
        let mut links = Vec::with_capacity(live().count());
        for spring in live() {
            let ends = model.springs()[spring];
            let [a, b] = ends.map(|end| positions[end as usize]);
            let k = f64::from(params.spring_stiffness[spring]);
            let rest_length = f64::from(params.spring_rest_length[spring]);
            let tensor = match axis_and_length(a, b) {
                Some((n, length)) => {
                    let across = k * (1.0 - rest_length / length);
                    Tensor {
                        axis: n.as_vec3(),
                        stiffness_along: (k - across) as f32,
                        stiffness_all: across as f32,
                        damping_along: params.spring_damping[spring],
                    }
                }
                None if rest_length == 0.0 => Tensor {
                    axis: Vec3::X,
                    stiffness_along: 0.0,
                    stiffness_all: k as f32,
                    damping_along: 0.0,
                },
                None => continue,
            };
            links.push(Link { ends, tensor });
        }
        let free = |point: usize| !params.is_fixed(point);
        let mass: Vec<f64> = (0..model.point_count())
            .map(|point| if free(point) { f64::from(params.point_mass[point]) } else { 0.0 })
            .collect();
        let inverse_mass = mass.iter().map(|&mass| if mass == 0.0 { 0.0 } else { 1.0 / mass }).collect();
        Self { links, anchors: anchors(params, positions), mass, inverse_mass }
    }

    /// Springs and anchors together: the cost of one product.
    pub fn size(&self) -> usize {
        self.links.len() + self.anchors.len()
    }

    /// product = (αK + βC) x.
    pub fn apply(&self, weights: Weights, x: &[DVec3], product: &mut [DVec3]) {
        product.fill(DVec3::ZERO);
        for Link { ends: [i, j], tensor } in &self.links {
            let (i, j) = (*i as usize, *j as usize);
            let force = tensor.times(weights, x[i] - x[j]);
            product[i] += force;
            product[j] -= force;
        }
        for anchor in &self.anchors {
            let point = anchor.point as usize;
            let all = weights.damping * anchor.damping_all;
            product[point] += anchor.tensor.times(weights, x[point]) + x[point] * all;
        }
    }

    /// A vector x, of one length per mass at every point, in which each point moves against the neighbours before it:
    /// as far from them as αK + βC pulls back hardest. In a lattice, where neighbours move against each other in the
    /// stiffest modes, this is within a few per cent of the largest Rayleigh quotient. `first` gives the directions of points
    /// without a neighbour before them.
    pub fn opposed(&self, weights: Weights, first: impl Fn(usize) -> DVec3, x: &mut [DVec3]) {
        // Until a point is placed, its x gathers the pulls of its placed neighbours.
        x.fill(DVec3::ZERO);
        let mut placed = vec![false; x.len()];
        let place = |point: usize, x: &mut DVec3| {
            let direction = if *x == DVec3::ZERO { first(point) } else { *x };
            *x = direction * (self.inverse_mass[point].sqrt() / direction.length());
        };
        for Link { ends: [i, j], tensor } in &self.links {
            let (i, j) = (*i as usize, *j as usize);
            if !placed[i] {
                place(i, &mut x[i]);
                placed[i] = true;
            }
            if !placed[j] {
                x[j] -= tensor.times(weights, x[i]);
            }
        }
        for (point, _) in placed.iter().enumerate().filter(|(_, placed)| !**placed) {
            place(point, &mut x[point]);
        }
    }

    /// γ if C = γK to one part in 10⁵, as in a network of one material near its rest shape: then one eigenproblem answers
    /// for all. Compares every tensor's part along and across its axis.
    pub fn damping_per_stiffness(&self) -> Option<f64> {
        const TOLERANCE: f64 = 1e-5;
        if self.anchors.iter().any(|anchor| anchor.damping_all != 0.0) {
            return None;
        }
        let tensors =
            || self.links.iter().map(|link| &link.tensor).chain(self.anchors.iter().map(|a| &a.tensor));
        let stiffest = tensors().max_by(|a, b| a.stiffness_along.total_cmp(&b.stiffness_along))?;
        if stiffest.stiffness_along <= 0.0 {
            return None;
        }
        let ratio = f64::from(stiffest.damping_along) / f64::from(stiffest.stiffness_along);
        let proportional = tensors().all(|tensor| {
            let [along, all, damping] =
                [tensor.stiffness_along, tensor.stiffness_all, tensor.damping_along].map(f64::from);
            let across_matters = ratio != 0.0 && all.abs() > TOLERANCE * along;
            !across_matters && (damping - ratio * along).abs() <= TOLERANCE * ratio * along
        });
        proportional.then_some(ratio)
    }
}

/// The contacts that touch, and the grabs.
fn anchors(params: &Params, positions: &[Vec3]) -> Vec<Anchor> {
    let mut anchors = Vec::new();
    for plane in &params.planes {
        for (point, &position) in positions.iter().enumerate().take(params.point_mass.len()) {
            if plane.depth(position) > 0.0 && !params.is_fixed(point) {
                let tensor = Tensor {
                    axis: plane.normal,
                    stiffness_along: plane.stiffness,
                    stiffness_all: 0.0,
                    damping_along: plane.damping,
                };
                anchors.push(Anchor { point: point as u32, tensor, damping_all: 0.0 });
            }
        }
    }
    for grab in params.grabs.iter().filter(|grab| !params.is_fixed(grab.point)) {
        let tensor =
            Tensor { axis: Vec3::X, stiffness_along: 0.0, stiffness_all: grab.stiffness, damping_along: 0.0 };
        anchors.push(Anchor { point: grab.point as u32, tensor, damping_all: f64::from(grab.damping) });
    }
    anchors
}
