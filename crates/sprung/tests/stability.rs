//! The three limits on dt against the table of the four scenes, dense eigenvalue solves, and the step itself.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use nalgebra::{DMatrix, DVector, Matrix3, SymmetricEigen, Vector3};
use proptest::prelude::*;
use sprung::stability::{Setter, Sharp, auto_dt, certified, every_configuration, sharp};
use sprung::{Change, Grab, Material, Model, ModelBuilder, Params, Plane, State, Vec3};

// ---------------------------------------------------------------- the four scenes, by hand

fn spring() -> ModelBuilder {
    let mut builder = ModelBuilder::new();
    builder.add_point(Vec3::ZERO, 0.0).unwrap();
    builder.add_point(Vec3::new(0.0, -5.0, 0.0), 1.0).unwrap();
    builder.connect_within(0..2, 5.0, Material { stiffness: 1.0, damping: 0.2 }).unwrap();
    builder
}

fn chain() -> ModelBuilder {
    let mut builder = ModelBuilder::new();
    for i in 0..15 {
        builder.add_point(Vec3::new(2.0 * i as f32, 25.0, 0.0), 1.0).unwrap();
    }
    builder.pin(0).unwrap();
    builder.connect_within(0..15, 2.0, Material { stiffness: 200.0, damping: 3.0 }).unwrap();
    builder
}

/// An n×n×n cube of jelly, turned by 12.5° about (1, 1, 1).
fn lattice(n: i32) -> ModelBuilder {
    let axis = Vector3::new(1.0, 1.0, 1.0).normalize();
    let turn = nalgebra::Rotation3::from_scaled_axis(axis * 12.5f64.to_radians());
    let mut builder = ModelBuilder::new();
    for i in 0..n {
        for j in 0..n {
            for k in 0..n {
                let [x, y, z] = [2 * i - n, 2 * j, 2 * k].map(f64::from);
                let at = turn * Vector3::new(x, y, z);
                builder.add_point(Vec3::new(at.x as f32, at.y as f32, at.z as f32), 1.0).unwrap();
            }
        }
    }
    let points = builder.point_count();
    builder
        .connect_within(0..points, 8f32.sqrt() + 0.001, Material { stiffness: 750.0, damping: 10.0 })
        .unwrap();
    builder
}

fn jelly() -> (Model, Params, State) {
    let (model, mut params, state) = lattice(10).build().unwrap();
    params.planes.push(Plane::level(-10.0, 50.0, 10.0));
    (model, params, state)
}

fn cloth() -> ModelBuilder {
    let mut builder = ModelBuilder::new();
    for j in 0..20 {
        for i in 0..20 {
            builder.add_point(Vec3::new((2 * j - 20) as f32, 10.0, (2 * i) as f32), 0.5).unwrap();
        }
    }
    builder.pin(0).unwrap();
    builder.pin(19 * 20).unwrap();
    builder.connect_within(0..400, 8f32.sqrt() + 0.001, Material { stiffness: 600.0, damping: 3.0 }).unwrap();
    builder
}

/// Springs, ω²_max, c_max and the limit on dt at the rest shape, from a dense eigenvalue solve made elsewhere.
#[test]
fn the_table_of_the_four_scenes() {
    let table = [
        ("spring", spring().build().unwrap(), 1, 1.000, 0.200, 1.80998),
        ("chain", chain().build().unwrap(), 14, 790.648, 11.8597, 0.0576921),
        ("jelly", jelly(), 7560, 8643.98, 115.253, 0.0119753),
        ("cloth", cloth().build().unwrap(), 1482, 9512.24, 47.5612, 0.0161071),
    ];
    for (name, (model, params, state), springs, omega2_max, c_max, dt) in table {
        assert_eq!(model.spring_count(), springs, "{name}");
        let found = sharp(&model, &params, &state.position);
        // The table has six digits.
        assert!((found.omega2_max / omega2_max - 1.0).abs() < 1e-5, "{name}: {found:?}");
        assert!((found.c_max / c_max - 1.0).abs() < 1e-5, "{name}: {found:?}");
        let limit = found.dt.unwrap();
        assert!((limit / dt - 1.0).abs() < 1e-5, "{name}: {found:?}");

        let safe = certified(&model, &params, &state.position).unwrap().dt;
        let ever = every_configuration(&model, &params).unwrap().dt;
        assert!(
            ever <= safe && safe <= limit * (1.0 + 1e-9) && safe >= 0.52 * limit,
            "{name}: {ever} {safe} {limit}"
        );
        assert!(auto_dt(&model, &params).is_ok_and(|dt| dt <= ever.min(0.01)));
    }
}

// ---------------------------------------------------------------- random networks, against dense matrices

/// K and C per mass, M^(-½) · M^(-½), written from the formulas with nothing shared.
struct Dense {
    k: DMatrix<f64>,
    c: DMatrix<f64>,
}

impl Dense {
    /// `projected`: with the positive part of each spring's Hessian, and coincident springs as k·I and k_d·I.
    fn new(model: &Model, params: &Params, positions: &[Vec3], projected: bool) -> Self {
        let n = model.point_count();
        let (mut k, mut c) = (DMatrix::zeros(3 * n, 3 * n), DMatrix::zeros(3 * n, 3 * n));
        let add = |matrix: &mut DMatrix<f64>, i: usize, j: Option<usize>, block: Matrix3<f64>| {
            let mut at = |a: usize, b: usize, sign: f64| {
                let mut view = matrix.fixed_view_mut::<3, 3>(3 * a, 3 * b);
                view += block * sign;
            };
            at(i, i, 1.0);
            if let Some(j) = j {
                at(j, j, 1.0);
                at(i, j, -1.0);
                at(j, i, -1.0);
            }
        };
        for (s, &[i, j]) in model.springs().iter().enumerate() {
            if params.spring_cut[s] {
                continue;
            }
            let (i, j) = (i as usize, j as usize);
            let to = |p: Vec3| Vector3::new(f64::from(p.x), f64::from(p.y), f64::from(p.z));
            let e = to(positions[i]) - to(positions[j]);
            let stiffness = f64::from(params.spring_stiffness[s]);
            let damping = f64::from(params.spring_damping[s]);
            let rest = f64::from(params.spring_rest_length[s]);
            let identity = Matrix3::identity();
            if e.norm() < 1e-15 {
                if projected || rest == 0.0 {
                    add(&mut k, i, Some(j), identity * stiffness);
                }
                if projected {
                    add(&mut c, i, Some(j), identity * damping);
                }
                continue;
            }
            let u = e.normalize();
            let nn = u * u.transpose();
            let mut across = 1.0 - rest / e.norm();
            if projected {
                across = across.max(0.0);
            }
            add(&mut k, i, Some(j), (nn + (identity - nn) * across) * stiffness);
            add(&mut c, i, Some(j), nn * damping);
        }
        for (i, position) in positions.iter().enumerate() {
            for plane in &params.planes {
                if plane.depth(*position) > 0.0 {
                    let n = Vector3::new(plane.normal.x, plane.normal.y, plane.normal.z).cast::<f64>();
                    add(&mut k, i, None, n * n.transpose() * f64::from(plane.stiffness));
                    add(&mut c, i, None, n * n.transpose() * f64::from(plane.damping));
                }
            }
            for grab in params.grabs.iter().filter(|grab| grab.point == i) {
                add(&mut k, i, None, Matrix3::identity() * f64::from(grab.stiffness));
                add(&mut c, i, None, Matrix3::identity() * f64::from(grab.damping));
            }
        }
        for matrix in [&mut k, &mut c] {
            for a in 0..3 * n {
                for b in 0..3 * n {
                    let per_mass = |point: usize| {
                        let mass = f64::from(params.point_mass[point]);
                        if params.is_fixed(point) { 0.0 } else { 1.0 / mass.sqrt() }
                    };
                    matrix[(a, b)] *= per_mass(a / 3) * per_mass(b / 3);
                }
            }
        }
        Self { k, c }
    }

    /// The largest eigenvalue of dt²K + 2dt·C.
    fn demand(&self, dt: f64) -> f64 {
        largest(&self.k * (dt * dt) + &self.c * (2.0 * dt))
    }

    /// By bisection, the smallest dt of demand 4. The demand of a projected K only grows with dt; of the true one it
    /// may fall again where the network is compressed, so the bisection starts from the first crossing of a fine grid.
    fn limit(&self) -> Option<f64> {
        if largest(self.k.clone()).max(0.0) + largest(self.c.clone()) <= 0.0 {
            return None;
        }
        // The Frobenius norms bound the eigenvalues, so nothing lies below this.
        let (k, c) = (self.k.norm(), self.c.norm());
        let mut low = 4.0 / (c + (c * c + 4.0 * k).sqrt());
        let mut high = low;
        while self.demand(high) < 4.0 {
            low = high;
            high *= 1.1;
            if high > 1e9 {
                return None;
            }
        }
        while high - low > 1e-12 * high {
            let middle = 0.5 * (low + high);
            if self.demand(middle) < 4.0 { low = middle } else { high = middle }
        }
        Some(high)
    }
}

/// The largest eigenvalue. The library's solve gives NaN for some matrices of many zeros, so the matrix is scaled to 1
/// and mirrored at a plane that is askew to every axis: H A H with H = I − 2u uᵀ has the same eigenvalues and no zeros.
fn largest(matrix: DMatrix<f64>) -> f64 {
    let (n, scale) = (matrix.nrows(), matrix.amax());
    if scale == 0.0 {
        return 0.0;
    }
    let u = DVector::from_fn(n, |i, _| 1.0 + (i as f64 * 0.618).fract()).normalize();
    let mirror = DMatrix::identity(n, n) - &u * u.transpose() * 2.0;
    let mirrored = &mirror * (matrix / scale) * &mirror;
    let largest = SymmetricEigen::new((&mirrored + mirrored.transpose()) * 0.5).eigenvalues.max();
    assert!(largest.is_finite());
    largest * scale
}

/// A network of anything that may occur.
fn network(most_points: usize) -> impl Strategy<Value = (Model, Params, Vec<Vec3>)> {
    let points = prop::collection::vec(
        (
            prop::array::uniform3(-4i32..5),
            prop::array::uniform3(-0.4f32..0.4),
            -2.0f32..2.0,
            prop::sample::select(vec![0, 0, 0, 0, 0, 1, 2, 3]),
        ),
        2..most_points,
    );
    let springs = prop::collection::vec(
        (
            any::<prop::sample::Index>(),
            any::<prop::sample::Index>(),
            -1.0f32..4.0,
            0.0f32..4.0,
            0.5f32..2.0,
            0..12,
        ),
        1..4 * most_points,
    );
    let extras = (0.0f32..3.0, 0.0f32..2.0, any::<bool>(), any::<bool>(), any::<bool>());
    (points, springs, extras).prop_map(|(points, springs, (hard, damped, plane, grab, undamped))| {
        let mut builder = ModelBuilder::new();
        for &(at, offset, mass, kind) in &points {
            // Kind 1 is fixed by its mass, 2 pinned, 3 lies exactly on the grid where others may be too.
            let offset = if kind == 3 { [0.0; 3] } else { offset };
            let at = Vec3::new(at[0] as f32, at[1] as f32, at[2] as f32) + Vec3::from_array(offset);
            let point = builder.add_point(at, if kind == 1 { 0.0 } else { 10f32.powf(mass) }).unwrap();
            if kind == 2 {
                builder.pin(point).unwrap();
            }
        }
        let mut stretches = Vec::new();
        let mut cuts = Vec::new();
        for &(a, b, k, d, stretch, kind) in &springs {
            let (a, b) = (a.index(points.len()), b.index(points.len()));
            if a == b {
                continue;
            }
            // Kind 0 is cut, 1 undamped, 2 without stiffness, 3 of rest length zero.
            let stiffness = if kind == 2 { 0.0 } else { 10f32.powf(k) };
            let damping = if kind == 1 || undamped { 0.0 } else { 0.02 * 10f32.powf(d * 0.5) };
            let spring = builder.add_spring(a, b, Material { stiffness, damping }).unwrap();
            stretches.push(if kind == 3 { 0.0 } else { stretch });
            if kind == 0 {
                cuts.push(spring);
            }
        }
        let (model, mut params, state) = builder.build().unwrap();
        for (spring, stretch) in stretches.into_iter().enumerate() {
            params.apply(&model, &Change::RestScale(spring..spring + 1, stretch)).unwrap();
        }
        for spring in cuts {
            params.apply(&model, &Change::Cut(spring..spring + 1, true)).unwrap();
        }
        if plane {
            let mut ground = Plane::level(0.0, 10f32.powf(hard), damped);
            ground.normal = Vec3::new(0.6, 0.8, 0.0);
            params.planes.push(ground);
        }
        if grab {
            let point = model.point_count() / 2;
            params.grabs.push(Grab {
                point,
                target: Vec3::ZERO,
                stiffness: 10f32.powf(hard),
                damping: damped,
            });
        }
        (model, params, state.position)
    })
}

/// The dense solve is off by some roundings of the matrix's norm, n·2⁻⁵³ of it, which negative eigenvalues of compressed
/// springs make a few powers of ten larger than the largest eigenvalue.
const DENSE_ERROR: f64 = 1e-9;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn the_certified_limits_are_never_above_the_true_one((model, params, positions) in network(16)) {
        let safe = certified(&model, &params, &positions).map_or(f64::INFINITY, |limit| limit.dt);
        let ever = every_configuration(&model, &params).map_or(f64::INFINITY, |limit| limit.dt);
        prop_assert!(ever <= safe, "{} {}", ever, safe);
        for projected in [false, true] {
            let dense = Dense::new(&model, &params, &positions, projected);
            let truth = dense.limit().unwrap_or(f64::INFINITY);
            prop_assert!(safe <= truth * (1.0 + DENSE_ERROR), "{} {} {}", projected, safe, truth);
        }
    }

    #[test]
    fn the_sharp_limit_is_the_dense_one((model, params, positions) in network(24)) {
        check_sharp(&model, &params, &positions);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn the_sharp_limit_is_the_dense_one_in_larger_networks((model, params, positions) in network(60)) {
        check_sharp(&model, &params, &positions);
    }
}

fn check_sharp(model: &Model, params: &Params, positions: &[Vec3]) {
    let dense = Dense::new(model, params, positions, false);
    let found = sharp(model, params, positions);
    let (omega2_max, c_max) = (largest(dense.k.clone()).max(0.0), largest(dense.c.clone()).max(0.0));
    // Springs are held in float32: an eigenvalue may be off by 1e-6 of the largest entry, which compression may make
    // larger than the largest eigenvalue.
    let rounding = 1e-6 * dense.k.amax().max(omega2_max);
    assert!((found.omega2_max - omega2_max).abs() <= 1e-3 * omega2_max + rounding, "{found:?} {omega2_max}");
    assert!((found.c_max - c_max).abs() <= 1e-3 * c_max, "{found:?} {c_max}");
    match (found.dt, dense.limit()) {
        (Some(found_dt), Some(truth)) => {
            assert!((found_dt / truth - 1.0).abs() <= 1e-3, "{found:?} {truth}");
        }
        (found_dt, truth) => assert_eq!(found_dt, truth, "{found:?}"),
    }
}

// ---------------------------------------------------------------- no limit

#[test]
fn nothing_that_can_move_is_no_limit() {
    let material = Material { stiffness: 100.0, damping: 1.0 };
    let none = |model: &Model, params: &Params, state: &State| {
        assert_eq!(certified(model, params, &state.position), None);
        assert_eq!(every_configuration(model, params), None);
        let expected = Sharp { dt: None, omega2_max: 0.0, c_max: 0.0, residual: 0.0, iterations: 0 };
        let found = sharp(model, params, &state.position);
        assert_eq!(Sharp { iterations: 0, ..found }, expected);
        assert_eq!(auto_dt(model, params), Ok(0.01));
    };

    let mut points_only = ModelBuilder::new();
    points_only.add_point(Vec3::ZERO, 1.0).unwrap();
    let (model, params, state) = points_only.build().unwrap();
    none(&model, &params, &state);

    let mut all_fixed = ModelBuilder::new();
    all_fixed.add_point(Vec3::ZERO, 0.0).unwrap();
    all_fixed.add_point(Vec3::X, 1.0).unwrap();
    all_fixed.pin(1).unwrap();
    all_fixed.add_spring(0, 1, material).unwrap();
    let (model, mut params, state) = all_fixed.build().unwrap();
    params.planes.push(Plane::level(5.0, 100.0, 1.0));
    params.grabs.push(Grab { point: 1, target: Vec3::ZERO, stiffness: 10.0, damping: 1.0 });
    none(&model, &params, &state);

    let (model, mut params, state) = spring().build().unwrap();
    params.apply(&model, &Change::Cut(0..1, true)).unwrap();
    none(&model, &params, &state);
    params.apply(&model, &Change::Cut(0..1, false)).unwrap();
    params.apply(&model, &Change::Stiffness(0..1, 0.0)).unwrap();
    params.apply(&model, &Change::Damping(0..1, 0.0)).unwrap();
    none(&model, &params, &state);
}

// ---------------------------------------------------------------- single cases with a closed form

#[test]
fn contact_and_grabs_limit_a_free_point_and_are_named() {
    let mut builder = ModelBuilder::new();
    builder.add_point(Vec3::new(0.0, -1.0, 0.0), 2.0).unwrap();
    let (model, mut params, state) = builder.build().unwrap();
    params.planes.push(Plane::level(0.0, 50.0, 10.0));
    // ω² = 25, c = 5: 4/(5 + √(25 + 100)).
    let exact = 4.0 / (5.0 + 125f64.sqrt());
    for limit in [certified(&model, &params, &state.position), every_configuration(&model, &params)] {
        let limit = limit.unwrap();
        assert_eq!(limit.setter, Setter::Point(0));
        assert!((limit.dt / exact - 1.0).abs() < 1e-11);
    }
    let found = sharp(&model, &params, &state.position);
    assert!((found.dt.unwrap() / exact - 1.0).abs() < 1e-6, "{found:?}");

    // Above the plane nothing limits dt now, and it may later.
    let above = [Vec3::Y];
    assert_eq!(certified(&model, &params, &above), None);
    assert_eq!(sharp(&model, &params, &above).dt, None);
    assert!(every_configuration(&model, &params).is_some());

    // The grab adds to the contact: ω² = (50 + 150)/2 = 100, c = 10.
    params.grabs.push(Grab { point: 0, target: Vec3::ZERO, stiffness: 150.0, damping: 10.0 });
    let exact = 4.0 / (10.0 + 500f64.sqrt());
    assert!((certified(&model, &params, &state.position).unwrap().dt / exact - 1.0).abs() < 1e-11);
}

#[test]
fn a_hard_contact_under_a_soft_spring_is_named() {
    let mut builder = ModelBuilder::new();
    let a = builder.add_point(Vec3::ZERO, 1.0).unwrap();
    let b = builder.add_point(Vec3::Y, 1.0).unwrap();
    builder.add_spring(a, b, Material { stiffness: 1.0, damping: 0.0 }).unwrap();
    let (model, mut params, state) = builder.build().unwrap();
    params.planes.push(Plane::level(0.5, 1000.0, 0.0));
    assert_eq!(certified(&model, &params, &state.position).unwrap().setter, Setter::Point(a));
    params.planes[0].stiffness = 0.1;
    assert_eq!(certified(&model, &params, &state.position).unwrap().setter, Setter::Spring(0));
}

#[test]
fn repeated_springs_add_up_and_coincident_points_are_no_trouble() {
    let material = Material { stiffness: 50.0, damping: 0.0 };
    let mut builder = ModelBuilder::new();
    builder.add_point(Vec3::ZERO, 0.0).unwrap();
    builder.add_point(Vec3::ZERO, 1.0).unwrap();
    builder.add_spring(0, 1, material).unwrap();
    builder.add_spring(0, 1, material).unwrap();
    let (model, mut params, state) = builder.build().unwrap();
    // Rest length zero: ω² = 50 + 50, in every direction.
    let found = sharp(&model, &params, &state.position);
    assert!((found.dt.unwrap() - 0.2).abs() < 1e-6, "{found:?}");
    assert!((certified(&model, &params, &state.position).unwrap().dt - 0.2).abs() < 1e-11);
    // A rest length, but no direction to push: no force now, though soon.
    params.spring_rest_length = vec![1.0; 2].into();
    assert_eq!(sharp(&model, &params, &state.position).dt, None);
    assert!((certified(&model, &params, &state.position).unwrap().dt - 0.2).abs() < 1e-11);
}

#[test]
fn the_widest_allowed_values_give_finite_limits() {
    let mut builder = ModelBuilder::new();
    for (i, mass) in [1e-12, 1e12, 1e-12, 1.0].into_iter().enumerate() {
        builder.add_point(Vec3::new(i as f32, 0.0, 1e-3 * (i * i) as f32), mass).unwrap();
    }
    for (i, (stiffness, damping)) in [(1e12, 0.0), (1e12, 1e12), (1e-30, 1e-30)].into_iter().enumerate() {
        builder.add_spring(i, i + 1, Material { stiffness, damping }).unwrap();
    }
    let (model, params, state) = builder.build().unwrap();
    let safe = certified(&model, &params, &state.position).unwrap().dt;
    let found = sharp(&model, &params, &state.position);
    assert!(safe > 0.0 && safe <= found.dt.unwrap() * (1.0 + 1e-9), "{safe} {found:?}");
    assert!((found.c_max / 1e24 - 1.0).abs() < 1e-6, "{found:?}");
    // A state that blew up is still no panic and no NaN.
    let broken = [Vec3::NAN, Vec3::INFINITY, Vec3::NEG_INFINITY, Vec3::MAX];
    assert!(certified(&model, &params, &broken).unwrap().dt > 0.0);
    assert!(sharp(&model, &params, &broken).dt.is_none_or(|dt| dt > 0.0));
}

#[test]
fn two_bodies_apart_have_each_their_own_largest() {
    // One limited by its damper, one by its stiffness: three different answers from three different places.
    let mut builder = ModelBuilder::new();
    for (x, material) in [
        (0.0, Material { stiffness: 100.0, damping: 40.0 }),
        (10.0, Material { stiffness: 900.0, damping: 1.0 }),
        (20.0, Material { stiffness: 10.0, damping: 3.0 }),
    ] {
        let a = builder.add_point(Vec3::new(x, 0.0, 0.0), 1.0).unwrap();
        let b = builder.add_point(Vec3::new(x, 1.0, 0.0), 1.0).unwrap();
        builder.add_spring(a, b, material).unwrap();
    }
    let (model, params, state) = builder.build().unwrap();
    let found = sharp(&model, &params, &state.position);
    assert!((found.omega2_max - 1800.0).abs() < 1e-3, "{found:?}");
    assert!((found.c_max - 80.0).abs() < 1e-3, "{found:?}");
    let exact = 4.0 / (80.0 + (6400.0f64 + 800.0).sqrt());
    assert!((found.dt.unwrap() / exact - 1.0).abs() < 1e-6, "{found:?}");
}

/// One spring of another material: the three problems are no longer one, and their answers are nearly the table's.
#[test]
fn a_jelly_of_two_materials_is_close_to_one_of_a_single_material() {
    let (model, mut params, state) = jelly();
    let uniform = sharp(&model, &params, &state.position);
    params.apply(&model, &Change::Damping(0..1, 10.01)).unwrap(); // a corner, where the top mode is still
    let found = sharp(&model, &params, &state.position);
    assert!(found.iterations > uniform.iterations);
    for (found, uniform) in [
        (found.dt.unwrap(), uniform.dt.unwrap()),
        (found.omega2_max, uniform.omega2_max),
        (found.c_max, uniform.c_max),
    ] {
        assert!((found / uniform - 1.0).abs() < 1e-4, "{found} {uniform}");
    }
}

// ---------------------------------------------------------------- the step itself

/// Just below the limit every mode of a small lattice stays bounded, just above it the top mode grows.
#[test]
fn the_linear_step_is_stable_below_the_limit_and_grows_above_it() {
    let (model, mut params, state) = lattice(3).build().unwrap();
    // Different damping in one corner, so that K and C have different modes.
    params.apply(&model, &Change::Damping(0..20, 60.0)).unwrap();
    let limit = sharp(&model, &params, &state.position).dt.unwrap();
    let Dense { k, c } = Dense::new(&model, &params, &state.position, false);
    // The growth of the step's linear map over many steps, from a start in which every mode takes part.
    let growth = |dt: f64| {
        let n = k.nrows();
        let mut x = DVector::from_fn(n, |i, _| 1.0 + (i * i % 7) as f64);
        let mut v = DVector::zeros(n);
        let start = x.norm();
        for _ in 0..20_000 {
            v -= (&k * &x + &c * &v) * dt;
            x += &v * dt;
            if x.norm() > 1e100 {
                break;
            }
        }
        // Rigid motion aside, which neither grows nor decays: v carries none of it.
        v.norm() * dt / start
    };
    // One part in a thousand off the limit: the unstable eigenvalue is −1 − δ with δ ≥ 10⁻³ for damped modes,
    // so that 20,000 steps multiply by e^20 and more.
    assert!(growth(limit * 0.999) < 1.0);
    assert!(growth(limit * 1.001) > 1e3);
}

#[test]
#[ignore = "a measurement: cargo test --release -p sprung --test stability -- --ignored --nocapture"]
fn a_large_lattice_is_quick() {
    let clock = std::time::Instant::now();
    let (model, mut params, state) = lattice(64).build().unwrap();
    println!("built {} springs in {:.2?}", model.spring_count(), clock.elapsed());
    let clock = std::time::Instant::now();
    let ever = every_configuration(&model, &params).unwrap().dt;
    println!("every configuration {ever} in {:.2?}", clock.elapsed());
    let clock = std::time::Instant::now();
    let safe = certified(&model, &params, &state.position).unwrap().dt;
    println!("certified {safe} in {:.2?}", clock.elapsed());
    let clock = std::time::Instant::now();
    println!("sharp {:?} in {:.2?}", sharp(&model, &params, &state.position), clock.elapsed());
    // Two materials: three problems.
    params.apply(&model, &Change::Damping(0..1_000_000, 20.0)).unwrap();
    let clock = std::time::Instant::now();
    println!("sharp, two materials {:?} in {:.2?}", sharp(&model, &params, &state.position), clock.elapsed());
}
