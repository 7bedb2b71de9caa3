//! Surfaces with fewer triangles: where triangles are as small as pixels, a processor that draws them spends its time on
//! triangles that nobody can see.

use sprung::Vec3;

/// Surfaces with more triangles than this are made coarser.
const MANY: usize = 20_000;
/// And once more while they have more than this.
const TOO_MANY: usize = 100_000;

/// Triangles between fewer of the same points; `None` if there are few enough. `positions` are those of the points at
/// first: they say where there are corners and edges, which stay.
pub fn coarser(triangles: &[[u32; 3]], positions: &[Vec3]) -> Option<Vec<[u32; 3]>> {
    if triangles.len() <= MANY {
        return None;
    }
    let mut fewer = merged(triangles, positions);
    while fewer.len() > TOO_MANY {
        let next = merged(&fewer, positions);
        if next.len() >= fewer.len() {
            break;
        }
        fewer = next;
    }
    Some(fewer)
}

/// Merges each point with its neighbours that are not merged yet. On a grid these are squares of four points, so that
/// one triangle is left of four. Corners and edges come first and so stay where they are.
fn merged(triangles: &[[u32; 3]], positions: &[Vec3]) -> Vec<[u32; 3]> {
    let (starts, neighbours) = neighbours(triangles, positions.len());
    let around = |point: usize| &neighbours[starts[point]..starts[point + 1]];
    let sharpness = |point: usize| {
        let mut sum = Vec3::ZERO;
        for &other in around(point) {
            sum += (positions[other as usize] - positions[point]).normalize_or_zero();
        }
        // In a few steps, so that what is almost flat keeps the order of its points.
        (4.0 * sum.length() / around(point).len().max(1) as f32) as u32
    };
    let sharpness: Vec<u32> = (0..positions.len()).map(sharpness).collect();
    let mut order: Vec<usize> = (0..positions.len()).filter(|&point| !around(point).is_empty()).collect();
    order.sort_by_key(|&point| std::cmp::Reverse(sharpness[point]));

    let mut kept: Vec<Option<u32>> = vec![None; positions.len()];
    for point in order {
        if kept[point].is_some() {
            continue;
        }
        kept[point] = Some(point as u32);
        for &other in around(point) {
            kept[other as usize].get_or_insert(point as u32);
        }
    }
    let whole = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| kept[corner as usize].unwrap_or(corner));
        (a != b && b != c && c != a).then_some([a, b, c])
    };
    triangles.iter().filter_map(whole).collect()
}

/// For each point where its neighbours begin in the second list; in order, and each twice where two triangles meet.
fn neighbours(triangles: &[[u32; 3]], points: usize) -> (Vec<usize>, Vec<u32>) {
    let mut starts = vec![0; points + 1];
    for &corner in triangles.iter().flatten() {
        starts[corner as usize + 1] += 2;
    }
    for point in 0..points {
        starts[point + 1] += starts[point];
    }
    let mut next = starts.clone();
    let mut found = vec![0; 6 * triangles.len()];
    for &[a, b, c] in triangles {
        for [point, second, third] in [[a, b, c], [b, c, a], [c, a, b]] {
            let place = &mut next[point as usize];
            found[*place] = second;
            found[*place + 1] = third;
            *place += 2;
        }
    }
    (starts, found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flat square of `side` × `side` points.
    fn grid(side: u32) -> (Vec<[u32; 3]>, Vec<Vec3>) {
        let places =
            (0..side * side).map(|index| Vec3::new((index % side) as f32, 0.0, (index / side) as f32));
        let cells = (0..side - 1).flat_map(|row| (0..side - 1).map(move |column| row * side + column));
        let triangles = cells.flat_map(|a| [[a, a + 1, a + side + 1], [a, a + side + 1, a + side]]);
        (triangles.collect(), places.collect())
    }

    fn area(triangles: &[[u32; 3]], positions: &[Vec3]) -> f32 {
        let of = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| positions[corner as usize]);
            0.5 * (b - a).cross(c - a).y
        };
        triangles.iter().map(of).sum()
    }

    #[test]
    fn small_surfaces_stay_as_they_are() {
        let (triangles, positions) = grid(20);
        assert_eq!(coarser(&triangles, &positions), None);
    }

    #[test]
    fn a_large_sheet_keeps_its_outline_with_a_quarter_of_its_triangles() {
        for side in [120, 400] {
            let (triangles, positions) = grid(side);
            let fewer = coarser(&triangles, &positions).expect("it is large");
            let share = fewer.len() as f32 / triangles.len() as f32;
            assert!((0.05..0.4).contains(&share), "{share}");
            // Signed area: neither holes nor folds, and of each corner not more than a small triangle is cut off.
            let [before, after] = [&triangles, &fewer].map(|list| area(list, &positions));
            assert!((after - before).abs() <= 4.0 * 4.0, "{before} and {after}");
        }
    }

    #[test]
    fn places_that_are_not_finite_do_no_harm() {
        let (triangles, mut positions) = grid(120);
        positions[7] = Vec3::NAN;
        positions[900] = Vec3::splat(f32::INFINITY);
        let fewer = coarser(&triangles, &positions).expect("it is large");
        assert!(fewer.iter().flatten().all(|&corner| (corner as usize) < positions.len()));
    }
}
