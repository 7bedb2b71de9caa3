//! What the springs around points tell a picture: how far neighbours are apart, and how much light reaches each point.

use sprung::{Model, Vec3};

/// Springs at a point up to which it counts as one of a sheet or a chain.
const FEW: f32 = 8.0;

/// How much of the sky each point sees: less, the more evenly its springs surround it. Sheets and chains see all of it.
/// Points without a position see all of it.
pub fn openness(model: &Model, positions: &[Vec3]) -> Vec<f32> {
    let mut around = vec![(Vec3::ZERO, 0.0f32); model.point_count()];
    for &[i, j] in model.springs() {
        let (i, j) = (i as usize, j as usize);
        let (Some(a), Some(b)) = (positions.get(i), positions.get(j)) else { continue };
        let direction = (*b - *a).normalize_or_zero();
        around[i].0 += direction;
        around[j].0 -= direction;
        around[i].1 += 1.0;
        around[j].1 += 1.0;
    }
    let open = |(sum, count): (Vec3, f32)| {
        if count <= FEW { 1.0 } else { (0.42 + 1.5 * sum.length() / count).min(1.0) }
    };
    around.into_iter().map(open).collect()
}

/// The median rest length, m: the distance between neighbours. `None` where no spring has a length.
pub fn spacing(model: &Model) -> Option<f32> {
    let lengths = model.spring_rest_length().iter().copied();
    let mut lengths: Vec<f32> = lengths.filter(|&length| length > 0.0).collect();
    let middle = lengths.len() / 2;
    (!lengths.is_empty()).then(|| *lengths.select_nth_unstable_by(middle, f32::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::{Material, ModelBuilder};

    fn star(arms: &[Vec3]) -> (Model, Vec<Vec3>) {
        let mut builder = ModelBuilder::new();
        let middle = builder.add_point(Vec3::ZERO, 1.0).expect("allowed");
        for &arm in arms {
            let end = builder.add_point(arm, 1.0).expect("allowed");
            builder.add_spring(middle, end, Material { stiffness: 1.0, damping: 0.0 }).expect("allowed");
        }
        let (model, _, state) = builder.build().expect("sound");
        (model, state.position)
    }

    #[test]
    fn the_median_leaves_out_springs_of_no_length() {
        let (model, _) = star(&[Vec3::ZERO, Vec3::ZERO, Vec3::X, 2.0 * Vec3::Y, 3.0 * Vec3::Z]);
        assert_eq!(spacing(&model), Some(2.0));
        assert_eq!(spacing(&star(&[Vec3::ZERO]).0), None);
    }

    #[test]
    fn what_is_surrounded_sees_less_of_the_sky() {
        let axes = [Vec3::X, Vec3::Y, Vec3::Z];
        let all: Vec<Vec3> =
            axes.into_iter().flat_map(|axis| [axis, -axis, 2.0 * axis, -2.0 * axis]).collect();
        let (model, positions) = star(&all);
        let open = openness(&model, &positions);
        assert_eq!((open[0], open[1]), (0.42, 1.0), "twelve springs that cancel, and one");
        assert_eq!(openness(&model, &[]), vec![1.0; positions.len()]);
    }
}
