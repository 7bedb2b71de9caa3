//! A lattice of cells around a closed surface becomes points, masses and springs, and the surface is tied to it.
//!
//! The points are the corners of every cell that meets the inside. A cell of side s, filled to a share f, brings along its share
//! of the mass, f·ρ·s³/8 for each corner, and of the springs: an edge belongs to four cells and gets k/4 from each, the diagonal
//! of a face to two and gets k/2. Springs of equal stiffness along edges and diagonals of faces (all within 1.42·s) are an
//! isotropic solid: summed over a cell, k·ℓ²·n⊗n⊗n⊗n gives C₁₁ = 3k/s and C₁₂ = C₄₄ = k/s, so both Lamé constants are
//! k/s, Poisson's ratio is 1/4 and Young's modulus E = 5k/(2s). Hence k = 0.4·E·s. As every cell holds its share of the energy of
//! any uniform strain, the energy of the body does not depend on how finely it is filled.

use glam::DVec3;

use super::MeshSpring;
use super::inside::Cells;
use crate::error::{Code, Error, Result};
use crate::model::WeightedVertex;

/// A cell that is filled less than this counts as filled so much: points of hardly any mass would make for tiny steps, and thin
/// parts would fall apart.
const LEAST_SHARE: f32 = 0.1;

/// From a point to those that springs join it to: neighbours along an axis, diagonals of faces; those later in the order.
const PARTNERS: [[i64; 3]; 9] =
    [[0, 0, 1], [0, 1, -1], [0, 1, 0], [0, 1, 1], [1, -1, 0], [1, 0, -1], [1, 0, 0], [1, 0, 1], [1, 1, 0]];

/// No point there.
const NONE: u32 = u32::MAX;

/// A filled lattice.
pub(super) struct Filling {
    cells: Cells,
    /// Share of each cell; 0 for those that are left out.
    shares: Vec<f32>,
    /// The point at each corner of a cell.
    point_at: Vec<u32>,
    /// Where the points are, m.
    pub points: Vec<DVec3>,
    /// The corner that each point is.
    corners: Vec<[u32; 3]>,
}

impl Filling {
    /// Keeps the cells that meet the inside and those that hold one of the `surface`'s points (m).
    ///
    /// # Errors
    /// [`Code::TooLarge`] if so many cells have more springs than there may be.
    pub fn new(
        cells: Cells,
        mut shares: Vec<f32>,
        surface: impl Iterator<Item = DVec3>,
        most_springs: u64,
    ) -> Result<Self> {
        for place in surface {
            let (cell, _) = locate(&cells, place);
            let share = &mut shares[cells.index(cell)];
            *share = share.max(LEAST_SHARE);
        }
        shares.iter_mut().filter(|share| **share > 0.0).for_each(|share| *share = share.max(LEAST_SHARE));
        // At its first corner each cell has three edges, and on the sides there six diagonals, that are no other's: before any
        // memory is taken for points and springs, this is how many there will be at least.
        let kept = shares.iter().filter(|share| **share > 0.0).count() as u64;
        if kept * PARTNERS.len() as u64 > most_springs {
            return Err(too_many_springs(cells.spacing, most_springs));
        }
        let mut filling =
            Self { cells, shares, point_at: Vec::new(), points: Vec::new(), corners: Vec::new() };
        filling.number();
        Ok(filling)
    }

    /// Numbers the corners of all kept cells, z fastest.
    fn number(&mut self) {
        let [x, y, z] = self.cells.counts;
        self.point_at = vec![NONE; (x + 1) * (y + 1) * (z + 1)];
        for (cell, _) in kept(&self.cells, &self.shares) {
            for corner in 0..8 {
                let place = corner_of(cell, corner);
                let index = self.corner_index(place);
                self.point_at[index] = 0;
            }
        }
        for (index, slot) in self.point_at.iter_mut().enumerate().filter(|(_, slot)| **slot != NONE) {
            let corner = [index / (z + 1) / (y + 1), index / (z + 1) % (y + 1), index % (z + 1)];
            *slot = self.points.len() as u32;
            let place = DVec3::from_array(corner.map(|steps| steps as f64));
            self.points.push(self.cells.origin + place * self.cells.spacing);
            self.corners.push(corner.map(|steps| steps as u32));
        }
    }

    fn corner_index(&self, [x, y, z]: [usize; 3]) -> usize {
        (x * (self.cells.counts[1] + 1) + y) * (self.cells.counts[2] + 1) + z
    }

    /// The volume that all shares make together, m³.
    pub fn volume(&self) -> f64 {
        let sum: f64 = self.shares.iter().map(|&share| f64::from(share)).sum();
        sum * self.cells.spacing * self.cells.spacing * self.cells.spacing
    }

    /// Masses for a body that is all in all as heavy as `volume` (m³) of this density (kg/m³).
    pub fn masses(&self, density: f64, volume: f64) -> Vec<f64> {
        let mut masses = vec![0.0; self.points.len()];
        let share_mass =
            density * volume / (8.0 * self.shares.iter().map(|&share| f64::from(share)).sum::<f64>());
        for (cell, share) in kept(&self.cells, &self.shares) {
            for corner in 0..8 {
                masses[self.point_at[self.corner_index(corner_of(cell, corner))] as usize] +=
                    share * share_mass;
            }
        }
        masses
    }

    /// Springs for a body of this Young's modulus (Pa) that is as stiff as `volume` of it.
    ///
    /// # Errors
    /// [`Code::TooLarge`] if they are more than there may be.
    pub fn springs(
        &self,
        modulus: f64,
        volume: f64,
        damping_time: f64,
        most_springs: u64,
    ) -> Result<Vec<MeshSpring>> {
        let stiffness = 0.4 * modulus * self.cells.spacing * (volume / self.volume());
        let mut shares = vec![[0.0f64; 9]; self.points.len()];
        for (cell, share) in kept(&self.cells, &self.shares) {
            for first in 0..8 {
                let from = corner_of(cell, first);
                let point = self.point_at[self.corner_index(from)] as usize;
                for (slot, step) in PARTNERS.iter().enumerate() {
                    let to = [0, 1, 2].map(|axis| from[axis] as i64 + step[axis] - cell[axis] as i64);
                    if to.iter().all(|steps| (0..=1).contains(steps)) {
                        let is_edge = step.iter().filter(|along| **along != 0).count() == 1;
                        shares[point][slot] += share * if is_edge { 0.25 } else { 0.5 };
                    }
                }
            }
        }
        let count = shares.iter().flatten().filter(|share| **share > 0.0).count();
        if count as u64 > most_springs {
            return Err(too_many_springs(self.cells.spacing, most_springs));
        }
        let mut springs = Vec::with_capacity(count);
        for (point, shares) in shares.iter().enumerate() {
            let from = self.corners[point];
            for (step, &share) in PARTNERS.iter().zip(shares).filter(|(_, share)| **share > 0.0) {
                let to = [0, 1, 2].map(|axis| (i64::from(from[axis]) + step[axis]) as usize);
                let ends = [point as u32, self.point_at[self.corner_index(to)]];
                let stiffness = share * stiffness;
                springs.push(MeshSpring { ends, stiffness, damping: stiffness * damping_time });
            }
        }
        Ok(springs)
    }

    /// Ties a place (m) to the points around it.
    ///
    /// A cell is cut into six tetrahedra around the diagonal from its first corner to its last: with the local coordinates in
    /// descending order, u₁ ≥ u₂ ≥ u₃, the place is the sum of the first corner, of that one step further along the axis of u₁,
    /// of that another along the axis of u₂, and of the last, with the weights 1 − u₁, u₁ − u₂, u₂ − u₃ and u₃.
    pub fn embed(&self, place: DVec3) -> WeightedVertex {
        let (cell, local) = match locate(&self.cells, place) {
            (cell, local) if self.shares[self.cells.index(cell)] > 0.0 => (cell, local),
            // A vertex of no face may lie anywhere; it moves as the nearest cell would if it reached there.
            _ => self.nearest(place),
        };
        let mut axes = [0, 1, 2];
        axes.sort_by(|&a, &b| local[b].total_cmp(&local[a]));
        let u = axes.map(|axis| local[axis]);
        let weights = [1.0 - u[0], u[0] - u[1], u[1] - u[2], u[2]].map(|weight| weight as f32);
        let mut corner = cell;
        let points = [None, Some(axes[0]), Some(axes[1]), Some(axes[2])].map(|axis| {
            if let Some(axis) = axis {
                corner[axis] += 1;
            }
            self.point_at[self.corner_index(corner)]
        });
        WeightedVertex { points, weights }
    }

    /// The kept cell whose middle is nearest to a place.
    fn nearest(&self, place: DVec3) -> ([usize; 3], [f64; 3]) {
        let wanted = (place - self.cells.origin) / self.cells.spacing;
        let start = |cell: [usize; 3]| DVec3::from_array(cell.map(|steps| steps as f64));
        let distance = |cell: [usize; 3]| (start(cell) + 0.5 - wanted).length_squared();
        let cells = kept(&self.cells, &self.shares).map(|(cell, _)| cell);
        let cell = cells.min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or_default();
        (cell, (wanted - start(cell)).to_array())
    }
}

fn too_many_springs(spacing: f64, most: u64) -> Error {
    let sentence = format!("is {spacing} m, and would fill the mesh with more than {most} springs");
    Error::new(Code::TooLarge, sentence)
        .with_fix("make the spacing larger, or allow more with max_springs at the top of the scene")
        .at_field("spacing")
}

/// The cells with a share, and the share.
fn kept<'a>(cells: &'a Cells, shares: &'a [f32]) -> impl Iterator<Item = ([usize; 3], f64)> + 'a {
    let [_, y, z] = cells.counts;
    let some = shares.iter().enumerate().filter(|(_, share)| **share > 0.0);
    some.map(move |(index, &share)| ([index / z / y, index / z % y, index % z], f64::from(share)))
}

/// The cell that a place lies in, and where in it, from 0 to 1; the nearest for a place outside the lattice.
fn locate(cells: &Cells, place: DVec3) -> ([usize; 3], [f64; 3]) {
    let steps = ((place - cells.origin) / cells.spacing).to_array();
    let cell = [0, 1, 2].map(|axis| (steps[axis].max(0.0) as usize).min(cells.counts[axis] - 1));
    (cell, [0, 1, 2].map(|axis| steps[axis] - cell[axis] as f64))
}

/// One of the eight corners of a cell.
fn corner_of(cell: [usize; 3], corner: usize) -> [usize; 3] {
    [cell[0] + (corner >> 2 & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner & 1)]
}
