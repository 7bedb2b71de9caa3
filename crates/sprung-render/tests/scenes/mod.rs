//! The four scenes built by hand, each with a few bent shapes: what the picture tests and the `look` example draw.
#![allow(dead_code, reason = "each user takes what it needs")]

use std::sync::Arc;

use sprung::{Material, ModelBuilder, Params, Plane, Snapshot, State, SurfaceKind, Vec3};
use sprung_io::RunInfo;

/// A scene and some moments of a motion that it might make.
pub struct Motion {
    pub info: RunInfo,
    pub moments: Vec<Snapshot>,
}

fn motion(
    name: &str,
    title: &str,
    builder: ModelBuilder,
    tune: impl Fn(&mut Params),
    bend: impl Fn(f32, Vec3) -> Vec3,
    moments: usize,
    frame_time: f64,
) -> Motion {
    let (model, mut params, state): (_, _, State) = builder.build().expect("the scene is sound");
    tune(&mut params);
    let moment = |index: usize| {
        let share = index as f32 / (moments - 1).max(1) as f32;
        let positions: Vec<Vec3> = state.position.iter().map(|&place| bend(share, place)).collect();
        let velocities = vec![Vec3::ZERO; positions.len()];
        Snapshot { step: index as u64, time: index as f64 * frame_time, positions, velocities }
    };
    let info = RunInfo {
        scene: name.to_owned(),
        title: title.to_owned(),
        model: Arc::new(model),
        params,
        frame_time,
        frames: moments as u64,
    };
    Motion { info, moments: (0..moments).map(moment).collect() }
}

/// A mass on a spring that swings.
pub fn spring(moments: usize) -> Motion {
    let mut builder = ModelBuilder::new();
    builder.add_point(Vec3::ZERO, 0.0).expect("allowed");
    builder.add_point(Vec3::new(0.0, -5.0, 0.0), 1.0).expect("allowed");
    builder.add_spring(0, 1, Material { stiffness: 1.0, damping: 0.2 }).expect("allowed");
    let bend = |share: f32, place: Vec3| {
        let stretch = 1.0 + 1.6 * share;
        let side = 0.9 * share * (1.0 - share) * 4.0;
        Vec3::new(-place.y * side, place.y * stretch, 0.0)
    };
    motion(
        "spring",
        "A mass on a spring",
        builder,
        |params| (params.dt, params.substeps) = (0.01, 7),
        bend,
        moments,
        0.07,
    )
}

/// A chain that falls from level to hanging.
pub fn chain(moments: usize) -> Motion {
    let mut builder = ModelBuilder::new();
    for i in 0..15 {
        builder
            .add_point(Vec3::new(2.0 * i as f32, 25.0, 0.0), if i == 0 { 0.0 } else { 1.0 })
            .expect("allowed");
    }
    builder.connect_within(0..15, 2.0, Material { stiffness: 200.0, damping: 3.0 }).expect("allowed");
    let bend = |share: f32, place: Vec3| {
        // An arc that leaves its pin level and turns down; a little longer near the pin.
        let length = place.x * (1.0 + 0.3 * share * (1.0 - place.x / 40.0));
        let turn = 1.45 * share;
        let angle = turn * (0.45 + 0.55 * place.x / 28.0);
        Vec3::new(length * libm::cosf(angle), 25.0 - length * libm::sinf(angle), 0.0)
    };
    motion(
        "chain",
        "A chain pendulum",
        builder,
        |params| (params.dt, params.substeps) = (0.01, 7),
        bend,
        moments,
        0.07,
    )
}

/// A cube of jelly of n³ points that falls on a plane, sinks in and bulges.
pub fn jelly(n: usize, moments: usize) -> Motion {
    let mut builder = ModelBuilder::new();
    let turn = |place: Vec3| {
        // By 12.5 degrees about (1, 1, 1).
        let axis = Vec3::ONE / 3f32.sqrt();
        let (sin, cos) = (0.216_439_6, 0.976_296);
        place * cos + axis.cross(place) * sin + axis * (axis.dot(place) * (1.0 - cos))
    };
    let at = |i: usize, j: usize, k: usize| ((i * n + j) * n + k) as u32;
    let scale = 20.0 / n as f32;
    for (i, j, k) in (0..n).flat_map(|i| (0..n).flat_map(move |j| (0..n).map(move |k| (i, j, k)))) {
        let place = Vec3::new(i as f32 * scale - 10.0, j as f32 * scale, k as f32 * scale);
        builder.add_point(turn(place), 1.0).expect("allowed");
    }
    let radius = scale * 8f32.sqrt() / 2.0 + 0.001;
    builder
        .connect_within(0..n * n * n, radius, Material { stiffness: 750.0, damping: 10.0 })
        .expect("allowed");
    let mut skin = Vec::new();
    for (a, b) in (0..n - 1).flat_map(|a| (0..n - 1).map(move |b| (a, b))) {
        let mut quad = |f: &dyn Fn(usize, usize) -> u32, flip: bool| {
            let [p, q, r, s] = [f(a, b), f(a + 1, b), f(a + 1, b + 1), f(a, b + 1)];
            let pair = if flip { [[p, r, q], [p, s, r]] } else { [[p, q, r], [p, r, s]] };
            skin.extend(pair);
        };
        let last = n - 1;
        quad(&|a, b| at(a, b, 0), true);
        quad(&|a, b| at(a, b, last), false);
        quad(&|a, b| at(0, a, b), true);
        quad(&|a, b| at(last, a, b), false);
        quad(&|a, b| at(b, 0, a), true);
        quad(&|a, b| at(b, last, a), false);
    }
    builder.add_surface(SurfaceKind::Skin, skin).expect("allowed");
    let bend = |share: f32, place: Vec3| {
        let drop = (share * 2.0).min(1.0);
        let squash = (share * 2.0 - 1.0).max(0.0);
        let fallen = place.y - 9.0 * drop * drop;
        let floor = -9.0 - 3.0 * squash;
        let y = floor + (fallen + 9.0) * (1.0 - 0.25 * squash * (1.0 - (fallen + 9.0) / 40.0));
        let bulge = 1.0 + 0.25 * squash * (1.0 - ((fallen + 9.0) / 26.0 - 0.3).abs());
        Vec3::new(place.x * bulge, y, (place.z - 9.0) * bulge + 9.0)
    };
    let tune = |params: &mut Params| {
        (params.dt, params.substeps) = (0.01, 11);
        params.planes = vec![Plane::level(-10.0, 50.0, 10.0)];
    };
    motion("jelly", "A cube of jelly falls on a plane", builder, tune, bend, moments, 0.11)
}

/// A cloth of n² points that hangs from two corners.
pub fn cloth(n: usize, moments: usize) -> Motion {
    let mut builder = ModelBuilder::new();
    let scale = 40.0 / n as f32;
    for (j, i) in (0..n).flat_map(|j| (0..n).map(move |i| (j, i))) {
        let place = Vec3::new(scale * j as f32 - 20.0, 10.0, scale * i as f32);
        builder.add_point(place, 0.5).expect("allowed");
    }
    let radius = scale * 2f32.sqrt() + 0.001;
    builder.connect_within(0..n * n, radius, Material { stiffness: 600.0, damping: 3.0 }).expect("allowed");
    builder.pin(0).expect("allowed");
    builder.pin((n - 1) * n).expect("allowed");
    let at = |j: usize, i: usize| (j * n + i) as u32;
    let quads = (0..n - 1).flat_map(|j| (0..n - 1).map(move |i| (j, i)));
    let triangles = quads.flat_map(|(j, i)| {
        [[at(j, i), at(j, i + 1), at(j + 1, i + 1)], [at(j, i), at(j + 1, i + 1), at(j + 1, i)]]
    });
    builder.add_surface(SurfaceKind::Cloth, triangles.collect()).expect("allowed");
    let bend = |share: f32, place: Vec3| {
        let angle = 1.9 * share;
        let across = place.x / 20.0;
        let sag = 5.0 * share * (1.0 - across * across) * (1.0 - 0.3 * place.z / 40.0);
        let fold = 1.6 * share * libm::sinf(0.55 * place.x) * place.z / 40.0;
        let length = place.z * (1.0 + 0.08 * share * (1.0 - place.z / 40.0));
        let (sin, cos) = (libm::sinf(angle), libm::cosf(angle));
        Vec3::new(
            place.x * (1.0 - 0.18 * share * place.z / 40.0),
            10.0 - length * sin - sag,
            length * cos + fold,
        )
    };
    motion(
        "cloth",
        "A hanging cloth",
        builder,
        |params| (params.dt, params.substeps) = (0.01, 7),
        bend,
        moments,
        0.07,
    )
}
