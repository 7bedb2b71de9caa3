//! Chains, sheets and blocks of points: one regular lattice underneath.

use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::model::SurfaceKind;

/// Points at `i·steps[0] + j·steps[1] + k·steps[2]`, numbered with i outermost and k innermost.
///
/// A chain is a lattice with one count above 1, a sheet has two, a block three.
///
/// ```
/// use sprung::build::{Lattice, SpringKind};
///
/// let sheet = Lattice::new([20, 1, 20], 2.0); // level: along x and z
/// assert_eq!(sheet.point_count(), 400);
/// let springs = sheet.pairs(SpringKind::Structural).count() + sheet.pairs(SpringKind::Shear).count();
/// assert_eq!(springs, 1482);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    counts: [u32; 3],
    steps: [DVec3; 3],
}

/// Which neighbours in a lattice a spring joins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SpringKind {
    /// Neighbours along an axis: these keep lengths.
    Structural,
    /// Across the diagonal of a square of four neighbours, both ways: these keep right angles.
    Shear,
    /// Two apart along an axis: these keep straight lines straight.
    Bend,
}

impl SpringKind {
    /// From a point to its partners, as steps along the three axes.
    fn offsets(self) -> &'static [[i64; 3]] {
        match self {
            Self::Structural => &[[0, 0, 1], [0, 1, 0], [1, 0, 0]],
            Self::Shear => &[[0, 1, -1], [0, 1, 1], [1, -1, 0], [1, 0, -1], [1, 0, 1], [1, 1, 0]],
            Self::Bend => &[[0, 0, 2], [0, 2, 0], [2, 0, 0]],
        }
    }
}

/// A face, edge or corner of a lattice: for each axis its low end (false), its high end (true) or all of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Side([Option<bool>; 3]);

/// The names of the ends of each axis, low and high.
const END_NAMES: [[&str; 2]; 3] = [["left", "right"], ["bottom", "top"], ["back", "front"]];

impl Lattice {
    /// A lattice along x, y and z with one spacing (m) for all three. A count of zero is taken as one.
    pub fn new(counts: [u32; 3], spacing: f64) -> Self {
        Self::with_steps(counts, [DVec3::X * spacing, DVec3::Y * spacing, DVec3::Z * spacing])
    }

    /// A chain of `points` points, each `step` (m) from the one before.
    pub fn chain(points: u32, step: DVec3) -> Self {
        Self::with_steps([points, 1, 1], [step, DVec3::Y, DVec3::Z])
    }

    fn with_steps(counts: [u32; 3], steps: [DVec3; 3]) -> Self {
        Self { counts: counts.map(|count| count.max(1)), steps }
    }

    /// How many points there are; saturates instead of overflowing.
    pub fn point_count(&self) -> u64 {
        self.counts.iter().fold(1u64, |product, &count| product.saturating_mul(u64::from(count)))
    }

    /// The points' positions in their order, m.
    pub fn positions(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.cells().map(|[i, j, k]| {
            self.steps[0] * f64::from(i) + self.steps[1] * f64::from(j) + self.steps[2] * f64::from(k)
        })
    }

    /// The pairs that springs of one kind join: point by point, and for each point in the order of the table of offsets
    /// (those along z before those along y before those along x).
    pub fn pairs(&self, kind: SpringKind) -> impl Iterator<Item = [u32; 2]> + '_ {
        self.cells().flat_map(move |cell| {
            let partners = kind.offsets().iter().filter_map(move |&offset| self.shifted(cell, offset));
            partners.map(move |partner| [self.index(cell), self.index(partner)])
        })
    }

    /// How many pairs [`pairs`](Self::pairs) gives; saturates instead of overflowing.
    pub fn pair_count(&self, kind: SpringKind) -> u64 {
        kind.offsets().iter().fold(0, |sum: u64, &offset| sum.saturating_add(self.pairs_apart(offset)))
    }

    /// How many pairs are no further apart than `radius` (m), without making them; stops counting beyond `enough`.
    pub fn pair_count_within(&self, radius: f64, enough: u64) -> u64 {
        // Half of all offsets: each pair is met once, from the point with the smaller index.
        let last = self.counts.map(|count| i64::from(count) - 1);
        let mut sum = 0u64;
        for i in 0..=last[0] {
            // Along each axis offsets beyond the radius need not be looked at: the axes of a lattice are at right angles.
            if self.steps[0].length() * i as f64 > radius {
                break;
            }
            for j in self.offsets_within(1, radius, i == 0) {
                for k in self.offsets_within(2, radius, i == 0 && j == 0) {
                    let offset =
                        self.steps[0] * i as f64 + self.steps[1] * j as f64 + self.steps[2] * k as f64;
                    if [i, j, k] != [0, 0, 0] && offset.length() <= radius {
                        sum = sum.saturating_add(self.pairs_apart([i, j, k]));
                    }
                    if sum > enough {
                        return sum;
                    }
                }
            }
        }
        sum
    }

    fn offsets_within(&self, axis: usize, radius: f64, from_zero: bool) -> std::ops::RangeInclusive<i64> {
        let most = (radius / self.steps[axis].length()).min(f64::from(self.counts[axis] - 1)) as i64;
        if from_zero { 0..=most } else { -most..=most }
    }

    /// How many points have a partner at this offset.
    fn pairs_apart(&self, offset: [i64; 3]) -> u64 {
        (0..3).fold(1u64, |product, axis| {
            product.saturating_mul(u64::from(self.counts[axis]).saturating_sub(offset[axis].unsigned_abs()))
        })
    }

    /// The side with this name, such as `"top"`, `"left"` or `"left-back"`; `None` if this lattice has no such side.
    ///
    /// left/right are the ends along x, bottom/top along y, back/front along z; an axis with one point has none.
    /// A chain has `"start"` and `"end"` instead.
    pub fn side(&self, name: &str) -> Option<Side> {
        if self.is_chain() {
            return match name {
                "start" => Some(Side([Some(false), None, None])),
                "end" => Some(Side([Some(true), None, None])),
                _ => None,
            };
        }
        let mut side = [None; 3];
        for part in name.split('-') {
            let axis = (0..3).find(|&axis| self.counts[axis] > 1 && END_NAMES[axis].contains(&part))?;
            if side[axis].replace(part == END_NAMES[axis][1]).is_some() {
                return None; // "left-right", "left-left"
            }
        }
        Some(Side(side))
    }

    /// The names of all sides: faces, edges, corners.
    pub fn side_names(&self) -> Vec<String> {
        if self.is_chain() {
            return vec!["start".to_owned(), "end".to_owned()];
        }
        let mut names = vec![String::new()];
        for axis in (0..3).filter(|&axis| self.counts[axis] > 1) {
            let join = |name: &String, end: &str| {
                if name.is_empty() { end.to_owned() } else { format!("{name}-{end}") }
            };
            let longer: Vec<String> = names
                .iter()
                .flat_map(|name| END_NAMES[axis].iter().map(move |end| join(name, end)))
                .collect();
            names.extend(longer);
        }
        names.retain(|name| !name.is_empty());
        names.sort_by_key(|name| name.matches('-').count());
        names
    }

    /// The points of a side, in order.
    pub fn side_points(&self, Side(side): Side) -> impl Iterator<Item = u32> + '_ {
        let on_side = move |cell: &[u32; 3]| {
            (0..3).all(|axis| match side[axis] {
                None => true,
                Some(false) => cell[axis] == 0,
                Some(true) => cell[axis] + 1 == self.counts[axis],
            })
        };
        self.cells().filter(on_side).map(|cell| self.index(cell))
    }

    /// The surface for drawing: both triangles of every square of a sheet, or the skin of a block with its triangles
    /// counter-clockwise seen from outside. A chain has none.
    pub fn surface(&self) -> Option<(SurfaceKind, Vec<[u32; 3]>)> {
        let flat: Vec<usize> = (0..3).filter(|&axis| self.counts[axis] == 1).collect();
        let mut triangles = Vec::new();
        match flat[..] {
            [] => {
                for axis in 0..3 {
                    self.push_face(axis, false, &mut triangles);
                    self.push_face(axis, true, &mut triangles);
                }
                Some((SurfaceKind::Skin, triangles))
            }
            [axis] => {
                self.push_face(axis, true, &mut triangles);
                Some((SurfaceKind::Cloth, triangles))
            }
            _ => None,
        }
    }

    /// The triangles of the face at one end of an axis.
    fn push_face(&self, axis: usize, high: bool, triangles: &mut Vec<[u32; 3]>) {
        // Axis b towards axis c turns by the right hand about `axis`.
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        for u in 0..self.counts[b] - 1 {
            for v in 0..self.counts[c] - 1 {
                let corner = |u: u32, v: u32| {
                    let mut cell = [0; 3];
                    cell[axis] = if high { self.counts[axis] - 1 } else { 0 };
                    (cell[b], cell[c]) = (u, v);
                    self.index(cell)
                };
                let (p, q, r, s) = (corner(u, v), corner(u + 1, v), corner(u + 1, v + 1), corner(u, v + 1));
                triangles.extend(if high { [[p, q, r], [p, r, s]] } else { [[p, r, q], [p, s, r]] });
            }
        }
    }

    fn is_chain(&self) -> bool {
        self.counts[1] == 1 && self.counts[2] == 1
    }

    /// All (i, j, k) in the order of the points.
    fn cells(&self) -> impl Iterator<Item = [u32; 3]> + use<> {
        let [nx, ny, nz] = self.counts;
        (0..nx).flat_map(move |i| (0..ny).flat_map(move |j| (0..nz).map(move |k| [i, j, k])))
    }

    fn index(&self, [i, j, k]: [u32; 3]) -> u32 {
        (i * self.counts[1] + j) * self.counts[2] + k
    }

    fn shifted(&self, cell: [u32; 3], offset: [i64; 3]) -> Option<[u32; 3]> {
        let mut shifted = [0; 3];
        for axis in 0..3 {
            let place = i64::from(cell[axis]) + offset[axis];
            shifted[axis] = u32::try_from(place).ok().filter(|&place| place < self.counts[axis])?;
        }
        Some(shifted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_counted_are_the_pairs_made() {
        for counts in [[1, 1, 1], [15, 1, 1], [1, 4, 3], [5, 4, 3], [2, 2, 2]] {
            let lattice = Lattice::new(counts, 0.5);
            for kind in [SpringKind::Structural, SpringKind::Shear, SpringKind::Bend] {
                let pairs: Vec<_> = lattice.pairs(kind).collect();
                assert_eq!(pairs.len() as u64, lattice.pair_count(kind), "{counts:?} {kind:?}");
                assert!(pairs.iter().all(|[i, j]| i < j && u64::from(*j) < lattice.point_count()));
            }
            for radius in [0.0, 0.5, 0.75, 1.0, 1.2, 10.0] {
                let points: Vec<_> = lattice.positions().collect();
                let near =
                    |i: usize| points[..i].iter().filter(|p| p.distance(points[i]) <= radius).count() as u64;
                let double_loop: u64 = (0..points.len()).map(near).sum();
                assert_eq!(lattice.pair_count_within(radius, u64::MAX), double_loop, "{counts:?} {radius}");
            }
        }
    }

    #[test]
    fn structural_and_shear_springs_of_a_block_are_those_of_the_report() {
        let jelly = Lattice::new([10, 10, 10], 2.0);
        assert_eq!(jelly.pair_count(SpringKind::Structural) + jelly.pair_count(SpringKind::Shear), 7560);
        assert_eq!(jelly.pair_count_within(8f64.sqrt() + 0.001, u64::MAX), 7560);
    }

    #[test]
    fn sides_have_their_points() {
        let points = |lattice: &Lattice, name: &str| -> Vec<u32> {
            lattice.side_points(lattice.side(name).expect("there is such a side")).collect()
        };
        let sheet = Lattice::new([4, 1, 3], 1.0);
        assert_eq!(points(&sheet, "left"), [0, 1, 2]);
        assert_eq!(points(&sheet, "back"), [0, 3, 6, 9]);
        assert_eq!(points(&sheet, "front-right"), [11]);
        assert_eq!(sheet.side("top"), None);
        assert_eq!(sheet.side("left-right"), None);
        assert_eq!(
            sheet.side_names().join(" "),
            "left right back front left-back left-front right-back right-front"
        );
        assert_eq!(Lattice::new([2, 2, 2], 1.0).side_names().len(), 6 + 12 + 8);

        let chain = Lattice::chain(15, DVec3::X);
        assert_eq!((points(&chain, "start"), points(&chain, "end")), (vec![0], vec![14]));
        assert_eq!(chain.side("left"), None);
    }

    #[test]
    fn the_skin_of_a_block_is_closed_and_turned_outwards() {
        let block = Lattice::new([3, 4, 5], 1.0);
        let positions: Vec<_> = block.positions().collect();
        let (kind, triangles) = block.surface().expect("a block has a skin");
        assert_eq!(kind, SurfaceKind::Skin);
        // Gauss: a closed surface turned outwards has the volume it encloses.
        let corners = |t: &[u32; 3]| t.map(|point| positions[point as usize]);
        let volume: f64 = triangles.iter().map(corners).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum();
        assert!((volume - 2.0 * 3.0 * 4.0).abs() < 1e-12);
    }

    #[test]
    fn a_sheet_is_a_cloth_and_a_chain_has_no_surface() {
        let (kind, triangles) = Lattice::new([4, 3, 1], 1.0).surface().expect("a sheet has a surface");
        assert_eq!((kind, triangles.len()), (SurfaceKind::Cloth, 2 * 3 * 2));
        assert_eq!(Lattice::chain(5, DVec3::X).surface(), None);
    }
}
