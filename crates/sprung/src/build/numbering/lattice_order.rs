//! Finds lattices among points that are numbered anyhow, and numbers them row by row.
//!
//! Spring vectors show a lattice: in its midst every one has its opposite, and the three shortest that are independent
//! of each other are its axes. From such a point we walk to all others along springs that are whole multiples of the
//! axes, and count steps. So every point that is reached knows its site, three whole numbers. Nothing is measured over
//! more than one spring: a large lattice gathers no rounding errors, and each body has its own axes, however it is turned.

use glam::{DMat3, DVec3, Vec3};

use super::spatial_order::{bounds, longest_first, spatial_order};
use crate::buckets::Buckets;

/// Fewer points than these are not worth being called a lattice.
const FEWEST_POINTS: usize = 8;

/// How far a spring vector may be from whole steps, in lengths of the shortest axis. Rounding of coordinates is far
/// below, other sites of a lattice are far above.
const TOLERANCE: f64 = 1.0 / 16.0;

/// Steps along an axis that one spring may take: longer ones are rather a joint that happens to fit.
const MOST_STEPS: f64 = 4.0;

/// A point with more springs is the hub of something rather than one of a lattice.
const MOST_AT_SEED: usize = 128;

/// Points or springs by which a share is estimated.
const SAMPLE: usize = 1024;

/// There is no lattice unless one spring in so many goes straight on in another. In a bar of two by two points, which has
/// fewest, it is one of three.
const FEWEST_GO_ON: usize = 8;

/// The least sine of an angle between axes.
const INDEPENDENT: f64 = 0.1;

/// Of axes that are equally long, those are taken that are most along this: of two opposite directions always the same
/// one, wherever in the lattice we begin. Any direction does that is in no plane of symmetry of a likely lattice.
const PREFERRED: DVec3 = DVec3::new(1.0, 0.618, 0.273);

/// All points, lattices first; the points of each row by row, the longest axis slowest, so that the bandwidth is small.
/// Points outside any lattice follow in their [`spatial_order`].
///
/// `None` if clearly less than `least_share` of the springs join points of lattices.
pub(super) fn lattice_order(positions: &[Vec3], springs: &[[u32; 2]], least_share: f64) -> Option<Vec<u32>> {
    let mut search = Search::new(positions, springs);
    if !search.looks_regular(springs) {
        return None;
    }
    // If all their springs join two points outside, there are half as many springs as ends.
    let most_outside = (1.0 - least_share) * 2.0 * springs.len() as f64;
    let mut lattices = Vec::new();
    let seeds = search.seeds();
    // From the midst of each lattice; then from what has no midst, such as a strip.
    for from in [From::Midst, From::Anywhere] {
        for &seed in &seeds {
            if search.lattice[seed as usize] == UNKNOWN {
                lattices.extend(search.lattice_from(seed, from));
            }
            if search.ends_outside as f64 > most_outside {
                return None;
            }
        }
    }

    // Lattices one after the other along the longest axis of everything: what is joined is mostly near.
    let along = longest_first(bounds(positions.iter().copied()).1)[0];
    let coordinate = |&point: &u32| positions[point as usize][along];
    let begin = |points: &[u32]| points.iter().map(coordinate).fold(f32::INFINITY, f32::min);
    let mut lattices: Vec<(f32, Vec<u32>)> =
        lattices.into_iter().map(|points| (begin(&points), points)).collect();
    lattices.sort_by(|a, b| a.0.total_cmp(&b.0));

    let outside =
        (0..positions.len() as u32).filter(|&point| search.lattice[point as usize] >= OUTSIDE).collect();
    let mut order: Vec<u32> = Vec::with_capacity(positions.len());
    order.extend(lattices.into_iter().flat_map(|(_, points)| points));
    order.extend(spatial_order(positions, springs, outside));
    Some(order)
}

/// Where a lattice is looked for.
#[derive(Clone, Copy, PartialEq)]
enum From {
    /// Only at points whose springs all have their opposites: whatever is glued to a lattice does not mislead there.
    Midst,
    /// At any point where some spring has its opposite.
    Anywhere,
}

/// Instead of the number of a lattice: none was found yet, there is none. Larger than any number of a lattice, as each
/// has several points.
const UNKNOWN: u32 = u32::MAX;
const OUTSIDE: u32 = u32::MAX - 1;

/// The search for the lattice and site of every point.
struct Search<'a> {
    positions: &'a [Vec3],
    /// The points that each point is joined to.
    neighbours: Buckets<u32>,
    /// The number of the lattice that each point belongs to, and its steps from where that began.
    lattice: Vec<u32>,
    site: Vec<[i32; 3]>,
    /// How many lattices were begun.
    begun: u32,
    /// How many ends of springs are at points that proved to be outside all lattices.
    ends_outside: usize,
    /// Those of the springs at one point; kept for its memory.
    vectors: Vec<DVec3>,
}

impl<'a> Search<'a> {
    fn new(positions: &'a [Vec3], springs: &[[u32; 2]]) -> Self {
        let points = positions.len();
        let both_ways = |&[a, b]: &[u32; 2]| [(a as usize, b), (b as usize, a)];
        Self {
            positions,
            neighbours: Buckets::new(points, springs.iter().flat_map(both_ways)),
            lattice: vec![UNKNOWN; points],
            site: vec![[0; 3]; points],
            begun: 0,
            ends_outside: 0,
            vectors: Vec::new(),
        }
    }

    /// Whether springs that go straight on at one of their ends are common, judged by a sample. It spares a network
    /// without any lattice the search for one.
    fn looks_regular(&self, springs: &[[u32; 2]]) -> bool {
        let goes_on = |&[a, b]: &[u32; 2]| {
            let spring = self.vector(a, b);
            let at = |end: u32, onwards: DVec3| {
                let others = self.neighbours.of(end as usize).iter().take(MOST_AT_SEED);
                others.map(|&other| self.vector(end, other)).any(|v| alike(v, onwards))
            };
            at(b, spring) || at(a, -spring)
        };
        let sample = springs.iter().step_by(springs.len() / SAMPLE + 1);
        sample.clone().filter(|&spring| goes_on(spring)).count() * FEWEST_GO_ON >= sample.count()
    }

    /// All points, those with most springs first, as they see all axes of their lattice.
    fn seeds(&self) -> Vec<u32> {
        let springs_at = |point: u32| self.neighbours.of(point as usize).len();
        let points = 0..self.positions.len() as u32;
        let most = points.clone().map(springs_at).max().unwrap_or(0);
        Buckets::new(most + 1, points.map(|point| (most - springs_at(point), point))).into_values()
    }

    /// The points of the lattice that a point belongs to, row by row; `None` if there is none worth the name.
    fn lattice_from(&mut self, seed: u32, from: From) -> Option<Vec<u32>> {
        let Some(axes) = self.axes_at(seed, from) else {
            if from == From::Anywhere {
                self.ends_outside += self.neighbours.of(seed as usize).len();
            }
            return None;
        };
        let points = self.walk(seed, &axes);
        if points.len() < FEWEST_POINTS {
            // Another seed may see the lattice that they belong to.
            self.assign(&points, UNKNOWN);
            return None;
        }
        if !self.holds_most_springs(&points) {
            // For good: no part of the network is walked again and again.
            self.assign(&points, OUTSIDE);
            self.ends_outside +=
                points.iter().map(|&point| self.neighbours.of(point as usize).len()).sum::<usize>();
            return None;
        }
        self.begun += 1;
        Some(self.sorted_by_rows(points))
    }

    fn axes_at(&mut self, seed: u32, from: From) -> Option<Axes> {
        let neighbours = self.neighbours.of(seed as usize);
        if neighbours.len() > MOST_AT_SEED {
            return None;
        }
        let mut vectors = std::mem::take(&mut self.vectors);
        vectors.clear();
        vectors.extend(neighbours.iter().map(|&other| self.vector(seed, other)));
        let axes = Axes::new(&vectors, from);
        self.vectors = vectors;
        axes
    }

    /// All points that are reached from one by whole steps. Breadth first, which takes few springs to each.
    fn walk(&mut self, seed: u32, axes: &Axes) -> Vec<u32> {
        let mut points = vec![seed];
        self.lattice[seed as usize] = self.begun;
        self.site[seed as usize] = [0; 3];
        let mut next = 0;
        while let Some(&point) = points.get(next) {
            next += 1;
            let here = self.site[point as usize];
            for &other in self.neighbours.of(point as usize) {
                if self.lattice[other as usize] != UNKNOWN {
                    continue;
                }
                if let Some(steps) = axes.steps(self.vector(point, other)) {
                    self.lattice[other as usize] = self.begun;
                    self.site[other as usize] =
                        std::array::from_fn(|axis| here[axis].wrapping_add(steps[axis]));
                    points.push(other);
                }
            }
        }
        points
    }

    fn assign(&mut self, points: &[u32], lattice: u32) {
        for &point in points {
            self.lattice[point as usize] = lattice;
        }
    }

    /// Whether most springs at points of the lattice just walked stay in it, judged by a sample: among many points that
    /// lie anyhow some seem to make a lattice by chance.
    fn holds_most_springs(&self, points: &[u32]) -> bool {
        let (mut ends, mut inside) = (0, 0);
        for &point in points.iter().step_by(points.len() / SAMPLE + 1) {
            let others = self.neighbours.of(point as usize);
            ends += others.len();
            inside += others.iter().filter(|&&other| self.lattice[other as usize] == self.begun).count();
        }
        2 * inside >= ends
    }

    /// The longest axis is slowest, so that the slabs across it, and the bandwidth with them, are small.
    fn sorted_by_rows(&self, mut points: Vec<u32>) -> Vec<u32> {
        let steps = |point: u32, axis: usize| i64::from(self.site[point as usize][axis]);
        let ranges = [0, 1, 2].map(|axis| {
            let along = points.iter().map(|&point| steps(point, axis));
            (along.clone().min().unwrap_or(0), along.max().unwrap_or(0))
        });
        let axes = longest_first(ranges.map(|(low, high)| (high - low) as f64));
        // The slowest axis is sorted by last; what is equal keeps its order.
        for axis in axes.into_iter().rev() {
            let (low, high) = ranges[axis];
            let along = points.iter().map(|&point| ((steps(point, axis) - low) as usize, point));
            points = Buckets::new((high - low) as usize + 1, along).into_values();
        }
        points
    }

    /// From one point to another, m.
    fn vector(&self, from: u32, to: u32) -> DVec3 {
        self.positions[to as usize].as_dvec3() - self.positions[from as usize].as_dvec3()
    }
}

/// One to three axes of a lattice.
struct Axes {
    /// How many there are. The others are filled up at right angles: no spring may step along them.
    count: usize,
    axes: DMat3,
    inverse: DMat3,
    /// How far from whole steps a vector may end, squared, m².
    tolerance_squared: f64,
}

impl Axes {
    /// The shortest vectors that are independent of each other, of those with an opposite if possible; `None` if this
    /// is no point to begin at.
    fn new(vectors: &[DVec3], from: From) -> Option<Self> {
        let has_opposite = |v: &DVec3| vectors.iter().any(|&other| alike(-*v, other));
        if from == From::Midst && !vectors.iter().all(has_opposite) {
            return None;
        }
        let of_pairs: Vec<DVec3> =
            vectors.iter().copied().filter(|v| *v != DVec3::ZERO && has_opposite(v)).collect();
        let axis = |admitted: &dyn Fn(&DVec3) -> bool| {
            preferred(of_pairs.iter().copied().filter(admitted))
                .or_else(|| preferred(vectors.iter().copied().filter(admitted)))
        };

        // Squared sines, without dividing.
        let least = INDEPENDENT * INDEPENDENT;
        let first = preferred(of_pairs.iter().copied())?;
        let second = axis(&|&v| {
            let area_squared = first.cross(v).length_squared();
            area_squared > least * first.length_squared() * v.length_squared()
        });
        let normal = first.cross(second.unwrap_or_else(|| first.any_orthogonal_vector()));
        let third = second.and_then(|_| {
            axis(&|&v| {
                let height = normal.dot(v);
                height * height > least * normal.length_squared() * v.length_squared()
            })
        });

        let length = first.length();
        let filled = |v: DVec3| v * (length / v.length());
        let axes = DMat3::from_cols(
            first,
            second.unwrap_or_else(|| filled(first.any_orthogonal_vector())),
            third.unwrap_or_else(|| filled(normal)),
        );
        let tolerance = TOLERANCE * length;
        Some(Self {
            count: 1 + usize::from(second.is_some()) + usize::from(third.is_some()),
            axes,
            inverse: axes.inverse(),
            tolerance_squared: tolerance * tolerance,
        })
    }

    /// The whole steps along the axes that make a vector; `None` if there are none, or too many.
    fn steps(&self, vector: DVec3) -> Option<[i32; 3]> {
        let exact = self.inverse * vector;
        if exact.abs().max_element() > MOST_STEPS {
            return None;
        }
        let steps = exact.round();
        let fits = (self.axes * steps - vector).length_squared() <= self.tolerance_squared;
        let within = (self.count..3).all(|axis| steps[axis] == 0.0);
        (fits && within && steps != DVec3::ZERO).then(|| steps.to_array().map(|step| step as i32))
    }
}

/// Whether two vectors are the same but for rounding.
fn alike(a: DVec3, b: DVec3) -> bool {
    (a - b).length_squared() <= TOLERANCE * TOLERANCE * a.length_squared()
}

/// The shortest vector; of those about as short the most preferred one.
fn preferred(vectors: impl Iterator<Item = DVec3> + Clone) -> Option<DVec3> {
    let shortest = vectors.clone().map(DVec3::length_squared).min_by(f64::total_cmp)?;
    let about_as_short = shortest * (1.0 + TOLERANCE);
    let rank = |v: &DVec3| v.dot(PREFERRED);
    vectors.filter(|v| v.length_squared() <= about_as_short).max_by(|a, b| rank(a).total_cmp(&rank(b)))
}
