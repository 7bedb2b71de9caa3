//! An order for points that lie anyhow: near in space, near in the order.

use glam::Vec3;

/// The given points in slabs across the longest axis of the box around them, in each slab in rows along the shortest.
///
/// Slabs and rows are as thick as springs are long, so that most springs reach the next slab at most; and as every slab
/// has its rows in the same order, their other end is then little more than one slab further.
pub(super) fn spatial_order(positions: &[Vec3], springs: &[[u32; 2]], points: Vec<u32>) -> Vec<u32> {
    if points.is_empty() {
        return points;
    }
    let (low, extent) = bounds(points.iter().map(|&point| positions[point as usize]));
    let [slow, middle, fast] = longest_first(extent);
    let thickness = typical_length(positions, springs);
    // Without a length to go by all are in one cell. Very far out the cast saturates: those share the last one.
    let cell = |offset: f64| if thickness > 0.0 { (offset / thickness) as u32 } else { 0 };

    let mut keyed: Vec<([u32; 2], [f32; 3], u32)> = Vec::with_capacity(points.len());
    keyed.extend(points.iter().map(|&point| {
        let position = positions[point as usize].to_array();
        let [slab, row] = [slow, middle].map(|axis| cell(f64::from(position[axis]) - low[axis]));
        ([slab, row], [position[fast], position[middle], position[slow]], point)
    }));
    drop(points);
    keyed.sort_unstable_by(|a, b| a.0.cmp(&b.0).then_with(|| compare(a.1, b.1)).then(a.2.cmp(&b.2)));
    keyed.into_iter().map(|(_, _, point)| point).collect()
}

/// The length (m) of the longest spring, or half more than nine of ten have if a few are longer still; 0 without springs.
fn typical_length(positions: &[Vec3], springs: &[[u32; 2]]) -> f64 {
    let squared_length = |&[a, b]: &[u32; 2]| {
        let (a, b) = (positions[a as usize].as_dvec3(), positions[b as usize].as_dvec3());
        (a - b).length_squared() as f32
    };
    let mut squared: Vec<f32> = springs.iter().map(squared_length).collect();
    if squared.is_empty() {
        return 0.0;
    }
    let (_, &mut ninth_tenth, longer) =
        squared.select_nth_unstable_by(springs.len() * 9 / 10, f32::total_cmp);
    let longest = longer.iter().copied().fold(ninth_tenth, f32::max);
    f64::from(longest).sqrt().min(1.5 * f64::from(ninth_tenth).sqrt())
}

/// The lowest corner of the box around some positions, and its extent, m.
pub(super) fn bounds(positions: impl Iterator<Item = Vec3>) -> ([f64; 3], [f64; 3]) {
    let (low, high) = positions.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), position| {
        (low.min(position), high.max(position))
    });
    (low.as_dvec3().to_array(), (high.as_dvec3() - low.as_dvec3()).to_array())
}

/// The three axes by falling extent; of equal ones x before y before z.
pub(super) fn longest_first(extent: [f64; 3]) -> [usize; 3] {
    let mut axes = [0, 1, 2];
    axes.sort_by(|&a, &b| extent[b].total_cmp(&extent[a]));
    axes
}

/// By the first coordinate that differs.
pub(super) fn compare(a: [f32; 3], b: [f32; 3]) -> std::cmp::Ordering {
    a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2]))
}
