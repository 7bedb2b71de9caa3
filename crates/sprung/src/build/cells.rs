//! Points sorted by the cell of space they lie in, to find those near a place.

use std::ops::RangeInclusive;

use glam::{DVec3, Vec3};

/// Cells are longer than the reach by this factor: a partner just within reach stays in a neighbouring cell although the
/// numbers of cells, up to 10⁷, are computed with relative errors of some 10⁻¹⁶.
const SLACK: f64 = 1.000_001;

/// Slots of the table for each point, at the most.
const SLOTS_PER_POINT: usize = 2;

/// Slots that even the smallest set of points may have.
const FEWEST_SLOTS: usize = 64;

/// A cell, by its numbers along x, y and z.
pub(super) type Cell = [u32; 3];

/// A point and its number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Located {
    pub position: Vec3,
    pub index: u32,
}

/// Points sorted by cell. Cells are cubes a little longer than the reach, so that all points within reach of a place lie
/// in the 27 cells around it.
///
/// Where the box around all points has few cells, each has a slot of its own, and neighbours along z are read as one row.
/// Where it has many more cells than there are points (a long diagonal chain, a point far out), cells share slots by a
/// hash: work and memory then depend on how dense the points are, not on how far they spread.
pub(super) struct CellGrid {
    origin: DVec3,
    inverse_size: f64,
    /// Cells along each axis.
    counts: [u32; 3],
    layout: Layout,
    /// Where each slot's points begin in `points`, and the total at the end.
    starts: Vec<u32>,
    /// In each slot cell by cell, and in each cell in ascending order of their numbers.
    points: Vec<Located>,
}

/// How cells go into slots.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Layout {
    /// One slot for each cell, z innermost.
    Dense,
    /// Several cells may share a slot, which is the upper bits of a hash: all but so many.
    Hashed { shift: u32 },
}

impl CellGrid {
    /// Sorts points to be found within `reach` (m).
    pub fn new(positions: &[Vec3], reach: f64) -> Self {
        let low = positions.iter().copied().reduce(Vec3::min).unwrap_or_default().as_dvec3();
        let high = positions.iter().copied().reduce(Vec3::max).unwrap_or_default().as_dvec3();
        // Points that all coincide at the origin may have a reach of zero.
        let size = (SLACK * reach).max(1e-30);
        let counts = ((high - low) / size).to_array().map(|length| length as u32 + 1);

        let most_slots = (SLOTS_PER_POINT * positions.len()).max(FEWEST_SLOTS);
        let cells = counts.iter().try_fold(1u64, |product, &count| product.checked_mul(count.into()));
        let (layout, slots) = match cells.filter(|&cells| cells <= most_slots as u64) {
            Some(cells) => (Layout::Dense, cells as usize),
            None => {
                let slots = most_slots.next_power_of_two();
                (Layout::Hashed { shift: u64::BITS - slots.ilog2() }, slots)
            }
        };
        let mut grid = Self {
            origin: low,
            inverse_size: 1.0 / size,
            counts,
            layout,
            starts: vec![0; slots + 1],
            points: vec![Located { position: Vec3::ZERO, index: 0 }; positions.len()],
        };
        grid.sort(positions);
        grid
    }

    /// A counting sort by slot.
    fn sort(&mut self, positions: &[Vec3]) {
        let slots: Vec<u32> =
            positions.iter().map(|&position| self.slot(self.cell(position)) as u32).collect();
        for &slot in &slots {
            self.starts[slot as usize] += 1;
        }
        // Each slot's end for now; filling the slots from their ends turns it into their beginning.
        let mut total = 0;
        for start in &mut self.starts {
            total += *start;
            *start = total;
        }
        for (index, (&position, &slot)) in positions.iter().zip(&slots).enumerate().rev() {
            let start = &mut self.starts[slot as usize];
            *start -= 1;
            self.points[*start as usize] = Located { position, index: index as u32 };
        }
        if self.layout != Layout::Dense {
            let mut points = std::mem::take(&mut self.points);
            for slot in self.starts.windows(2) {
                let points = &mut points[slot[0] as usize..slot[1] as usize];
                points.sort_unstable_by_key(|point| (self.cell(point.position), point.index));
            }
            self.points = points;
        }
    }

    /// The points of each cell that has any.
    pub fn cells(&self) -> impl Iterator<Item = (Cell, &[Located])> {
        let cells = self.points.chunk_by(|one, next| self.cell(one.position) == self.cell(next.position));
        cells.map(|points| (self.cell(points[0].position), points))
    }

    /// The cell of a place; for one outside the box, the nearest cell of its border.
    pub fn cell(&self, position: Vec3) -> Cell {
        let offset = ((position.as_dvec3() - self.origin) * self.inverse_size).to_array();
        // The conversion rounds towards zero, and takes what is negative as zero.
        [0, 1, 2].map(|axis| (offset[axis] as u32).min(self.counts[axis] - 1))
    }

    fn slot(&self, cell: Cell) -> usize {
        let [x, y, z] = cell.map(u64::from);
        match self.layout {
            Layout::Dense => {
                let [_, y_count, z_count] = self.counts.map(u64::from);
                ((x * y_count + y) * z_count + z) as usize
            }
            // Multiplicative hashing (Knuth, volume 3, section 6.4), with the odd constants of splitmix64.
            Layout::Hashed { shift } => {
                let [x, y, z] = [
                    x.wrapping_mul(0x9e37_79b9_7f4a_7c15),
                    y.wrapping_mul(0xbf58_476d_1ce4_e5b9),
                    z.wrapping_mul(0x94d0_49bb_1331_11eb),
                ];
                (x.wrapping_add(y).wrapping_add(z) >> shift) as usize
            }
        }
    }

    /// The points of the 27 cells around one and in it, in a few runs.
    pub fn around(&self, cell: Cell, mut take: impl FnMut(&[Located])) {
        let [along_x, along_y, along_z] = [0, 1, 2].map(|axis| self.neighbours(cell, axis));
        for x in along_x {
            for y in along_y.clone() {
                self.row([x, y], along_z.clone(), &mut take);
            }
        }
    }

    /// Those of half of its neighbours, so that each two neighbouring cells meet once: of the 13 that come later, with x
    /// outermost.
    pub fn ahead_of(&self, cell: Cell, mut take: impl FnMut(&[Located])) {
        let [x, y, z] = cell;
        let [along_x, along_y, along_z] = [0, 1, 2].map(|axis| self.neighbours(cell, axis));
        self.row([x, y], z + 1..=*along_z.end(), &mut take);
        for y in y + 1..=*along_y.end() {
            self.row([x, y], along_z.clone(), &mut take);
        }
        for x in x + 1..=*along_x.end() {
            for y in along_y.clone() {
                self.row([x, y], along_z.clone(), &mut take);
            }
        }
    }

    /// The cells before, at and after one along an axis, as far as there are any.
    fn neighbours(&self, cell: Cell, axis: usize) -> RangeInclusive<u32> {
        cell[axis].saturating_sub(1)..=(cell[axis] + 1).min(self.counts[axis] - 1)
    }

    /// The points of some cells in a row.
    fn row(&self, [x, y]: [u32; 2], along_z: RangeInclusive<u32>, take: &mut impl FnMut(&[Located])) {
        if along_z.is_empty() {
            return;
        }
        if self.layout == Layout::Dense {
            let [first, last] = [along_z.start(), along_z.end()].map(|&z| self.slot([x, y, z]));
            take(&self.points[self.starts[first] as usize..self.starts[last + 1] as usize]);
            return;
        }
        for cell in along_z.map(|z| [x, y, z]) {
            let slot = self.slot(cell);
            let points = &self.points[self.starts[slot] as usize..self.starts[slot + 1] as usize];
            // Others may share the slot.
            let begin = points.partition_point(|point| self.cell(point.position) < cell);
            let end = points.partition_point(|point| self.cell(point.position) <= cell);
            take(&points[begin..end]);
        }
    }
}
