//! Networks with something of everything that a step treats in a way of its own.

use std::sync::Arc;

use glam::Vec3;

use super::Parts;
use crate::build::{Material, ModelBuilder};
use crate::contact::{ContactLaw, Plane};
use crate::model::{HiddenOrder, Model};
use crate::params::{Grab, Params};

/// Random numbers, the same on every machine (Steele, Lea, Flood 2014, *Fast splittable pseudorandom number generators*).
pub struct Random(pub u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// From 0 to `end` − 1.
    pub fn below(&mut self, end: usize) -> usize {
        (self.bits() % end as u64) as usize
    }

    /// From −1 to 1.
    pub fn signed(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1 << 23) as f32 - 1.0
    }

    /// From 2^`low` to 2^`high`, all sizes alike.
    pub fn size(&mut self, low: i32, high: i32) -> f32 {
        let exponent = low + self.below((high - low) as usize) as i32;
        (1.5 + 0.5 * self.signed()) * 2f32.powi(exponent)
    }

    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.signed(), self.signed(), self.signed())
    }

    fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }
}

/// How far a spring of a mixed network may reach, in places.
const NEAR: usize = 600;

/// What most springs are made of.
const MATERIAL: Material = Material { stiffness: 20.0, damping: 0.1 };

/// Sheets, blocks and loose points one after another along a line, with springs of all kinds among them and all kinds of
/// forces on them, in motion. With `far`, some springs also join points anywhere.
///
/// In the first half all springs are alike but for their rest lengths; in the second some are not, and some are cut. The springs are so soft that a hundred steps are stable.
pub fn mixed(seed: u64, points: usize, far: bool) -> Parts {
    mixed_with(seed, points, |random, count| {
        let long = if far { count / 20 } else { 0 };
        (0..long).map(|_| [random.below(count), random.below(count)]).collect()
    })
}

/// The same with some springs from the first points to the last ones, among which some points have several.
pub fn ring(seed: u64, points: usize, long: usize) -> Parts {
    mixed_with(seed, points, |random, count| {
        (0..long).map(|_| [random.below(99), count - 1 - random.below(2_000)]).collect()
    })
}

/// A mixed network with springs that some function adds to so many points.
fn mixed_with(seed: u64, points: usize, long: impl Fn(&mut Random, usize) -> Vec<[usize; 2]>) -> Parts {
    let random = &mut Random(seed);
    let mut builder = ModelBuilder::new();
    while builder.point_count() < points {
        let room = points - builder.point_count();
        match random.below(3) {
            0 => lattice(&mut builder, random, [31, 9 + random_less(room), 1]),
            1 => lattice(&mut builder, random, [9, 8, 7]),
            _ => {
                // Points without a spring for now: some stay so.
                for _ in 0..room.min(70) {
                    add_point(&mut builder, random, Vec3::ZERO);
                }
            }
        }
    }
    let count = builder.point_count();
    let join = |builder: &mut ModelBuilder, random: &mut Random, a: usize, b: usize| {
        if a == b {
            return;
        }
        let material = if a.min(b) < count / 2 { MATERIAL } else { any_material(random) };
        let spring = builder.add_spring(a, b, material).expect("allowed");
        if random.one_in(2) {
            builder.set_rest_length(spring, 1.0 + random.signed()).expect("allowed");
        }
    };
    for _ in 0..2 * count {
        let a = random.below(count);
        let b = (a + random.below(NEAR)).min(count - 1);
        join(&mut builder, random, a, b);
        // Side by side with itself, now and then.
        if random.one_in(9) {
            join(&mut builder, random, b, a);
        }
    }
    // Stars: with more springs than a bundle has rows, at its beginning and at its end.
    for _ in 0..2 {
        let hub = NEAR + random.below(count - 2 * NEAR);
        for spoke in 0..300 {
            join(&mut builder, random, hub, hub + spoke / 2 + 1);
            join(&mut builder, random, hub, hub - spoke / 2 - 1);
        }
    }
    for [a, b] in long(random, count) {
        join(&mut builder, random, a, b);
    }
    let (model, params, state) = builder.parts().expect("there are points");
    let mut parts = Parts { model, params, state };
    drive(&mut parts, random);
    Parts::new((parts.model, parts.params, parts.state))
}

/// Some rows more than a handful, as far as there is room for them.
fn random_less(room: usize) -> usize {
    (room / 31).min(24)
}

/// One of a few, so that neighbours often share it.
fn any_material(random: &mut Random) -> Material {
    let stiffness = [0.0, 20.0, 20.0, 20.0, 35.5][random.below(5)];
    Material { stiffness, damping: if random.one_in(3) { 0.3 } else { 0.1 } }
}

/// A point, somewhere about `at` of the structure that is being built.
fn add_point(builder: &mut ModelBuilder, random: &mut Random, at: Vec3) {
    let along = builder.point_count() as f32 * 0.02;
    let mass = if random.one_in(40) { 0.0 } else { 1.0 + 0.5 * random.signed() };
    let position = at + random.vector() * 0.1 + Vec3::X * along;
    // Now and then two points coincide.
    let twin = builder.point_count().checked_sub(1).filter(|_| random.one_in(50));
    let position = twin.map_or(position, |twin| builder.position(twin));
    let point = builder.add_point(position, mass).expect("allowed");
    builder.set_velocity(point, random.vector()).expect("allowed");
    if random.one_in(40) {
        builder.pin(point).expect("it was just made");
    }
}

/// A lattice with springs to the nearest neighbours along the axes and along one diagonal, all of one material.
fn lattice(builder: &mut ModelBuilder, random: &mut Random, [columns, rows, layers]: [usize; 3]) {
    let first = builder.point_count();
    for index in 0..columns * rows * layers {
        let [i, j, k] = [index % columns, index / columns % rows, index / (columns * rows)];
        add_point(builder, random, Vec3::new(i as f32, j as f32, k as f32));
    }
    for index in 0..columns * rows * layers {
        let [i, j, k] = [index % columns, index / columns % rows, index / (columns * rows)];
        let neighbours = [
            (i + 1 < columns, 1),
            (j + 1 < rows, columns),
            (k + 1 < layers, columns * rows),
            (i + 1 < columns && j + 1 < rows, columns + 1),
        ];
        for (_, offset) in neighbours.into_iter().filter(|(is_there, _)| *is_there) {
            builder.add_spring(first + index, first + index + offset, MATERIAL).expect("allowed");
        }
    }
}

/// Makes everything act on it that can.
fn drive(Parts { model, params, state }: &mut Parts, random: &mut Random) {
    let count = model.point_count();
    params.dt = 0.002;
    params.gravity = Vec3::new(1.0, -9.81, 0.5);
    let normal = Vec3::new(1.0, 2.0, -0.5).normalize();
    params.planes = vec![
        Plane { point: Vec3::ZERO, normal, stiffness: 300.0, damping: 8.0, law: ContactLaw::Push },
        Plane { law: ContactLaw::Report, ..Plane::level(2.0, 50.0, 10.0) },
    ];
    let cut = |&[a, _]: &[u32; 2]| a as usize >= count / 2 && random.one_in(30);
    params.spring_cut = Arc::new(model.springs.iter().map(cut).collect());
    for _ in 0..20 {
        let point = random.below(count);
        params.external_forces.insert(point, random.vector() * 9.0);
        let grabbed = if random.one_in(2) { point } else { random.below(count) };
        if params.grabs.iter().all(|grab| grab.point != grabbed) {
            let target = state.position[grabbed] + random.vector();
            params.grabs.push(Grab { point: grabbed, target, stiffness: 70.0, damping: 3.0 });
        }
        params.carried.insert(random.below(count), random.vector());
    }
    for (low, x) in state.position_low.iter_mut().zip(&state.position) {
        *low = random.vector() * *x * 2e-8;
    }
}

/// A lattice of layers of so many points, numbered layer by layer, each point joined to the next one and to two of the next
/// layer, and a few to others nearby. The user's order stays.
pub fn layers(seed: u64, layer: usize, points: usize) -> Parts {
    let random = &mut Random(seed);
    let mut builder = ModelBuilder::new();
    for _ in 0..points {
        let point = builder.add_point(random.vector(), 1.0).expect("allowed");
        builder.set_velocity(point, random.vector()).expect("allowed");
    }
    for point in 0..points {
        let nearby = point + 2 + random.below(NEAR);
        let neighbours = [point + 1, point + layer, point + layer + 1, nearby];
        let kinds = if random.one_in(30) { 4 } else { 3 };
        for &other in neighbours[..kinds].iter().filter(|other| **other < points) {
            builder.add_spring(point, other, MATERIAL).expect("allowed");
        }
    }
    let (mut model, params, state) = builder.parts().expect("there are points");
    model.hidden_order = HiddenOrder::default();
    Parts::new((model, Params { dt: 0.002, ..params }, state))
}

/// The same model, gone through in some order.
pub fn with_hidden_order(model: &Model, random: &mut Random) -> Model {
    let mut order: Vec<u32> = (0..model.point_count() as u32).collect();
    for last in (1..order.len()).rev() {
        order.swap(last, random.below(last + 1));
    }
    Model { hidden_order: HiddenOrder::new(Some(order)), ..model.clone() }
}
