//! The largest eigenvalue λ of A x = λ M x with A = αK + βC, by locally optimal conjugate gradients.
//!
//! Each iteration takes the best vector in the space of three: the current x, its residual w = M⁻¹A x − λx, and the
//! direction p that led to x (Knyazev 2001, "LOBPCG", with M as preconditioner). It converges about as fast as
//! Lanczos' method but keeps six vectors instead of one per iteration, and λ only ever grows.

use glam::DVec3;

use super::network::{Network, Weights};
use super::symmetric3::Symmetric3;

/// A vector of the search space with its product A·v. The space is spanned by x, w and p, in this order.
#[derive(Clone, Debug)]
struct Pair {
    v: Vec<DVec3>,
    av: Vec<DVec3>,
}

impl Pair {
    fn zero(points: usize) -> Self {
        Self { v: vec![DVec3::ZERO; points], av: vec![DVec3::ZERO; points] }
    }
}

/// The iteration, with its memory. `x` is the newest estimate of the mode, and stays between solves.
#[derive(Clone, Debug)]
pub(super) struct TopMode<'a> {
    network: &'a Network,
    x: Pair,
    w: Pair,
    p: Pair,
    /// Products with A taken so far.
    pub products: u32,
}

/// Length of the noise mixed into a vector, relative to the vector's.
const NOISE: f64 = 0.3;

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Solved {
    /// The Rayleigh quotient of x: a lower bound of the largest eigenvalue.
    pub eigenvalue: f64,
    /// |M⁻¹A x − λx| / (|λ| |x|) with lengths weighted by mass: some eigenvalue lies within this relative distance.
    pub residual: f64,
}

impl<'a> TopMode<'a> {
    /// The memory of an iteration: six vectors.
    pub fn new(network: &'a Network) -> Self {
        let pair = Pair::zero(network.mass.len());
        Self { network, x: pair.clone(), w: pair.clone(), p: pair, products: 0 }
    }

    /// Sets x to a good guess of the top mode, with some of every other mode mixed in.
    pub fn start(&mut self, weights: Weights) {
        self.network.opposed(weights, noise, &mut self.x.v);
        self.add_noise();
    }

    /// Adds noise: a converged x has lost every other mode, and can only find one again with some of it mixed in.
    pub fn add_noise(&mut self) {
        let Network { mass, inverse_mass, .. } = self.network;
        let noise = |point: usize| noise(point) * inverse_mass[point].sqrt();
        let squared_length = |v: DVec3, mass: f64| v.dot(v) * mass;
        let (mut length2, mut noise_length2) = (0.0, 0.0);
        for (point, (x, &mass)) in self.x.v.iter().zip(mass).enumerate() {
            length2 += squared_length(*x, mass);
            noise_length2 += squared_length(noise(point), mass);
        }
        if noise_length2 > 0.0 {
            let length = if length2 > 0.0 { length2.sqrt() } else { 1.0 };
            let scale = NOISE * length / noise_length2.sqrt();
            self.x.v.iter_mut().enumerate().for_each(|(point, x)| *x += noise(point) * scale);
        }
    }

    /// ω² = xᵀKx/xᵀMx (1/s²) and c = xᵀCx/xᵀMx (1/s) of the current x.
    pub fn quotients(&mut self) -> (f64, f64) {
        let omega2 = self.quotient(Weights { stiffness: 1.0, damping: 0.0 });
        (omega2, self.quotient(Weights { stiffness: 0.0, damping: 1.0 }))
    }

    /// Iterates from the current x until the residual is at most `tolerance`, or λ stands still, or `max_products` are
    /// used up.
    pub fn solve(&mut self, weights: Weights, tolerance: f64, max_products: u32) -> Solved {
        let end = self.products + max_products;
        let mut gram = self.restart(weights);
        let mut solved = gram.solved();
        while solved.residual > tolerance && self.products < end {
            self.network.apply(weights, &self.w.v, &mut self.w.av);
            self.products += 1;
            gram.a[1][1] = self.w.v.iter().zip(&self.w.av).map(|(w, aw)| w.dot(*aw)).sum();

            let Some(best) = gram.best() else { break };
            gram = self.combine(best, gram.quotient(best));
            let before = solved.eigenvalue;
            solved = gram.solved();
            if solved.eigenvalue <= before {
                break; // nothing but rounding is left to gain
            }
        }
        solved
    }

    /// Keeps x, forgets p, and makes w the residual of x.
    fn restart(&mut self, weights: Weights) -> Gram {
        let eigenvalue = self.quotient(weights);
        for pair in [&mut self.w, &mut self.p] {
            pair.v.fill(DVec3::ZERO);
            pair.av.fill(DVec3::ZERO);
        }
        self.combine([1.0, 0.0, 0.0], eigenvalue)
    }

    /// The Rayleigh quotient of x; refreshes A·x.
    fn quotient(&mut self, weights: Weights) -> f64 {
        self.network.apply(weights, &self.x.v, &mut self.x.av);
        self.products += 1;
        let (mut xax, mut xx) = (0.0, 0.0);
        for ((x, ax), mass) in self.x.v.iter().zip(&self.x.av).zip(&self.network.mass) {
            xax += x.dot(*ax);
            xx += x.dot(*x) * mass;
        }
        if xx > 0.0 { xax / xx } else { 0.0 }
    }

    /// x ← a·x + b·w + c·p, p ← b·w + c·p, w ← the residual of the new x, whose Rayleigh quotient is given; and the
    /// inner products that the next iteration needs. All in one pass, as the vectors do not fit into the cache.
    fn combine(&mut self, [a, b, c]: [f64; 3], eigenvalue: f64) -> Gram {
        let Self { network, x, w, p, .. } = self;
        let xs = x.v.iter_mut().zip(&mut x.av);
        let ws = w.v.iter_mut().zip(&w.av);
        let ps = p.v.iter_mut().zip(&mut p.av);
        let masses = network.mass.iter().zip(&network.inverse_mass);
        let mut gram = Gram::default();
        for ((((x, ax), (w, aw)), (p, ap)), (&mass, &inverse_mass)) in xs.zip(ws).zip(ps).zip(masses) {
            *p = *w * b + *p * c;
            *ap = *aw * b + *ap * c;
            *x = *x * a + *p;
            *ax = *ax * a + *ap;
            *w = *ax * inverse_mass - *x * eigenvalue;
            gram.add(mass, (*x, *ax), *w, (*p, *ap));
        }
        gram
    }
}

/// Inner products of x, w and p: with M, and with A. The lower triangles are not used.
#[derive(Clone, Copy, Debug, Default)]
struct Gram {
    mass: [[f64; 3]; 3],
    a: [[f64; 3]; 3],
}

impl Gram {
    /// Adds one point's part of all products but wᵀAw, which needs a new product.
    #[inline(always)]
    fn add(&mut self, mass: f64, (x, ax): (DVec3, DVec3), w: DVec3, (p, ap): (DVec3, DVec3)) {
        let (mx, mw, mp) = (x * mass, w * mass, p * mass);
        self.mass[0][0] += x.dot(mx);
        self.mass[0][1] += x.dot(mw);
        self.mass[0][2] += x.dot(mp);
        self.mass[1][1] += w.dot(mw);
        self.mass[1][2] += w.dot(mp);
        self.mass[2][2] += p.dot(mp);
        self.a[0][0] += x.dot(ax);
        self.a[0][1] += w.dot(ax);
        self.a[0][2] += p.dot(ax);
        self.a[1][2] += w.dot(ap);
        self.a[2][2] += p.dot(ap);
    }

    fn solved(&self) -> Solved {
        let (xx, ww) = (self.mass[0][0], self.mass[1][1]);
        let eigenvalue = if xx > 0.0 { self.a[0][0] / xx } else { 0.0 };
        let residual = if ww > 0.0 { (ww / xx).sqrt() / eigenvalue.abs() } else { 0.0 };
        Solved { eigenvalue, residual }
    }

    /// The Rayleigh quotient of a combination of x, w and p.
    fn quotient(&self, of: [f64; 3]) -> f64 {
        product(&self.a, of, of) / product(&self.mass, of, of)
    }

    /// The combination of x, w and p, of unit length, whose Rayleigh quotient is largest. `None` if x is zero.
    fn best(&self) -> Option<[f64; 3]> {
        // An M-orthonormal basis of the three, without those that add no new direction.
        let mut basis: Vec<[f64; 3]> = Vec::with_capacity(3);
        for vector in 0..3 {
            let length = self.mass[vector][vector].sqrt();
            let mut unit = [0.0; 3];
            unit[vector] = 1.0 / length;
            if !unit[vector].is_finite() {
                continue;
            }
            for _twice_is_enough in 0..2 {
                for other in &basis {
                    let overlap = product(&self.mass, unit, *other);
                    unit = [0, 1, 2].map(|i| unit[i] - overlap * other[i]);
                }
            }
            let left = product(&self.mass, unit, unit);
            if left > INDEPENDENT {
                basis.push(unit.map(|coefficient| coefficient / left.sqrt()));
            }
        }
        if basis.is_empty() {
            return None;
        }

        // A in this basis, and its top eigenvector back in terms of x, w and p. Absent directions come last, far below.
        let mut reduced = Symmetric3::default();
        for i in 0..3 {
            for j in i..3 {
                reduced.m[i][j] = match (basis.get(i), basis.get(j)) {
                    (Some(&u), Some(&v)) => product(&self.a, u, v),
                    _ => 0.0,
                };
            }
        }
        let lowest =
            -(0..basis.len()).map(|i| reduced.m[i].iter().map(|entry| entry.abs()).sum::<f64>()).sum::<f64>();
        for absent in basis.len()..3 {
            reduced.m[absent][absent] = 2.0 * lowest - 1.0;
        }
        let top = reduced.top_eigenvector();
        Some([0, 1, 2].map(|i| basis.iter().zip(top).map(|(u, weight)| weight * u[i]).sum()))
    }
}

/// Squared length, of one, that must be left of a direction when its part along the others is taken away. Below it
/// the products are so rounded that the direction would be noise.
const INDEPENDENT: f64 = 1e-10;

/// uᵀ G v for a symmetric G of which the upper triangle is kept.
fn product(gram: &[[f64; 3]; 3], u: [f64; 3], v: [f64; 3]) -> f64 {
    let mut sum = 0.0;
    for i in 0..3 {
        for j in 0..3 {
            sum += u[i] * gram[i.min(j)][i.max(j)] * v[j];
        }
    }
    sum
}

/// Three numbers in −1…1, never all zero, from a point's index: the mixing function of SplitMix64 (Steele, Lea, Flood 2014).
fn noise(point: usize) -> DVec3 {
    let component = |axis: u64| {
        let mut z = (3 * point as u64 + axis + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        (z >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    DVec3::new(component(0), component(1), component(2))
}
