//! What lies around each point: its triangles, its springs, and the edges of surfaces. Worked out once for a model.

use sprung::Model;

/// For each point its triangles and springs, in lists one after the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rims {
    /// For each point: first and number of its triangles, first and number of its springs.
    pub rims: Vec<[u32; 4]>,
    /// The other two corners of each triangle at a point, in order.
    pub fans: Vec<[u32; 2]>,
    /// The other point of each spring at a point, and the spring; only for points of surfaces.
    pub spokes: Vec<[u32; 2]>,
}

impl Rims {
    /// Works out what lies around the points of surfaces. Lists longer than `most` are left empty: then normals or
    /// colours of surfaces are plain.
    pub fn new(model: &Model, most: usize) -> Self {
        // Points, and after them the vertices that they carry, which end no springs.
        let mut rims = vec![[0u32; 4]; model.point_count() + model.weighted_count()];
        let surfaces: Vec<_> =
            (0..model.surfaces().len()).map(|surface| model.triangles_in_list(surface)).collect();
        let triangles = || surfaces.iter().flat_map(|triangles| triangles.iter());
        for &corner in triangles().flatten() {
            rims[corner as usize][1] += 1;
        }
        let on_surface: Vec<bool> = rims.iter().map(|rim| rim[1] > 0).collect();
        let seen = |point: u32| on_surface[point as usize];
        for &point in model.springs().iter().flatten().filter(|&&point| seen(point)) {
            rims[point as usize][3] += 1;
        }
        let counts = [1, 3].map(|slot| rims.iter().map(|rim| rim[slot] as usize).sum::<usize>());
        for (slot, &count) in counts.iter().enumerate() {
            // Counts become places where each point's entries begin, and are counted anew while these are filled in.
            let mut next = 0;
            for rim in &mut rims {
                let entries = if count > most { 0 } else { rim[2 * slot + 1] };
                [rim[2 * slot], rim[2 * slot + 1]] = [next, 0];
                next += entries;
            }
        }
        let mut fans = vec![[0; 2]; if counts[0] > most { 0 } else { counts[0] }];
        if !fans.is_empty() {
            for &[a, b, c] in triangles() {
                for [point, second, third] in [[a, b, c], [b, c, a], [c, a, b]] {
                    let rim = &mut rims[point as usize];
                    fans[(rim[0] + rim[1]) as usize] = [second, third];
                    rim[1] += 1;
                }
            }
        }
        let mut spokes = vec![[0; 2]; if counts[1] > most { 0 } else { counts[1] }];
        if !spokes.is_empty() {
            for (spring, &[a, b]) in model.springs().iter().enumerate() {
                for (point, other) in [(a, b), (b, a)].into_iter().filter(|&(point, _)| seen(point)) {
                    let rim = &mut rims[point as usize];
                    spokes[(rim[2] + rim[3]) as usize] = [other, spring as u32];
                    rim[3] += 1;
                }
            }
        }
        Self { rims, fans, spokes }
    }
}

/// The edges of triangles, each once, the smaller index first.
pub fn edges(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut edges: Vec<[u32; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::{Material, ModelBuilder, SurfaceKind, Vec3};

    /// A square of two triangles, with a spring along each edge and one to a point aside.
    fn model() -> Model {
        let mut builder = ModelBuilder::new();
        for place in [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y, Vec3::splat(5.0)] {
            builder.add_point(place, 1.0).expect("allowed");
        }
        let material = Material { stiffness: 1.0, damping: 0.0 };
        for [a, b] in [[0, 1], [1, 2], [2, 3], [0, 3], [2, 4]] {
            builder.add_spring(a, b, material).expect("allowed");
        }
        builder.add_surface(SurfaceKind::Cloth, vec![[0, 1, 2], [0, 2, 3]]).expect("allowed");
        builder.build().expect("sound").0
    }

    #[test]
    fn every_point_knows_its_triangles_and_springs() {
        let found = Rims::new(&model(), 1000);
        assert_eq!(found.rims, [[0, 2, 0, 2], [2, 1, 2, 2], [3, 2, 4, 3], [5, 1, 7, 2], [6, 0, 9, 0]]);
        assert_eq!(found.fans, [[1, 2], [2, 3], [2, 0], [0, 1], [3, 0], [0, 2]]);
        assert_eq!(found.spokes[4..7], [[1, 1], [3, 2], [4, 4]]);
    }

    #[test]
    fn lists_that_do_not_fit_are_left_out() {
        let found = Rims::new(&model(), 8);
        assert_eq!((found.fans.len(), found.spokes.len()), (6, 0));
        assert!(found.rims.iter().all(|rim| rim[3] == 0));
    }

    #[test]
    fn edges_are_found_once() {
        assert_eq!(edges(&[[0, 1, 2], [0, 2, 3]]), [[0, 1], [0, 2], [0, 3], [1, 2], [2, 3]]);
    }
}
