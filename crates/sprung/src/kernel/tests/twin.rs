//! The plain twin: one spring after another, in the order that [`kernel`](super::super) documents.

use std::collections::BTreeMap;
use std::ops::{Add, Div, Mul, Sub};

use glam::Vec3;

use super::Parts;
use crate::contact::{ContactLaw, Plane};
use crate::kernel::plan::{FEW, LONG, MOST_ROWS, WINDOW, WORTH};
use crate::kernel::{BLOCK, GROUP, LANES};
use crate::math::COINCIDENT_SQUARED;
use crate::model::Model;
use crate::params::Params;
use crate::state::State;

/// In which order the springs' forces add up, found anew from the model.
pub struct Order {
    /// Springs of stripes: set by set of points, by ascending offset and then place.
    stripes: Vec<u32>,
    /// Bundles of packed springs: of each lane, the springs of one point.
    bundles: Vec<Vec<Vec<u32>>>,
    /// Springs that are evaluated before all others, and added after the planes.
    loose: Vec<u32>,
}

impl Order {
    pub fn new(model: &Model) -> Self {
        let order = Self::with_stripes(model, u32::MAX);
        let offset = |&spring: &u32| model.places(spring)[1] - model.places(spring)[0];
        let long = order.stripes.iter().filter(|spring| offset(spring) as usize >= WINDOW).count();
        let are_worth_it = long * LONG >= model.spring_count();
        if are_worth_it { order } else { Self::with_stripes(model, WINDOW as u32) }
    }

    /// With stripes of offsets below a limit.
    fn with_stripes(model: &Model, limit: u32) -> Self {
        let mut order = Self { stripes: Vec::new(), bundles: Vec::new(), loose: Vec::new() };
        let mut by_block = vec![Vec::new(); model.point_count().div_ceil(BLOCK)];
        for spring in 0..model.spring_count() as u32 {
            by_block[model.places(spring)[0] as usize / BLOCK].push(spring);
        }
        by_block.chunks(GROUP).for_each(|blocks| order.push_group(model, limit, blocks));
        order
    }

    /// The springs that begin in one group of blocks.
    fn push_group(&mut self, model: &Model, limit: u32, blocks: &[Vec<u32>]) {
        let (mut at_point, mut loose) = (BTreeMap::<u32, Vec<(u32, u32)>>::new(), Vec::new());
        for springs in blocks {
            for (near, offset, spring) in self.push_block(model, limit, springs) {
                if near as usize % (GROUP * BLOCK) + offset as usize >= WINDOW {
                    loose.push((near, offset, spring));
                } else {
                    at_point.entry(near).or_default().push((offset, spring));
                }
            }
        }
        loose.sort_unstable();
        self.loose.extend(loose.into_iter().map(|(.., spring)| spring));
        self.push_bundles(at_point.into_values().map(|mut springs| {
            springs.sort_unstable();
            springs.into_iter().map(|(_, spring)| spring).collect()
        }));
    }

    /// The stripes of one block; gives the springs that are in none: where they begin, their offset and their number.
    fn push_block(&mut self, model: &Model, limit: u32, springs: &[u32]) -> Vec<(u32, u32, u32)> {
        // Springs by offset, and within an offset by place and then number.
        let mut by_offset = BTreeMap::<u32, Vec<(u32, u32)>>::new();
        for &spring in springs {
            let [near, far] = model.places(spring);
            by_offset.entry(far - near).or_default().push((near, spring));
        }
        let (mut left_over, count, begin) = (Vec::new(), springs.len(), self.stripes.len());
        for (offset, mut springs) in by_offset {
            springs.sort_unstable();
            let mut sets: Vec<u32> = springs.iter().map(|(near, _)| near / LANES as u32).collect();
            sets.dedup();
            let is_few = count <= FEW && (offset as usize) < WINDOW;
            let is_worth_it = is_few || springs.len() as f64 >= WORTH * (sets.len() * LANES) as f64;
            let is_stripe = offset < limit && is_worth_it;
            let mut last = None;
            for (near, spring) in springs {
                if is_stripe && last.replace(near) != Some(near) {
                    self.stripes.push(spring);
                } else {
                    left_over.push((near, offset, spring));
                }
            }
        }
        self.stripes[begin..].sort_by_key(|&spring| model.places(spring)[0] / LANES as u32);
        left_over
    }

    /// A group's packed springs, by point: a lane for each point, those with most springs first, a set of lanes at a time.
    fn push_bundles(&mut self, at_points: impl Iterator<Item = Vec<u32>>) {
        let mut lanes: Vec<Vec<u32>> = Vec::new();
        at_points.for_each(|springs| lanes.extend(springs.chunks(MOST_ROWS).map(<[u32]>::to_vec)));
        lanes.sort_by_key(|lane| std::cmp::Reverse(lane.len()));
        self.bundles.extend(lanes.chunks(LANES).map(<[Vec<u32>]>::to_vec));
    }
}

/// A number to compute with.
pub trait Real:
    Copy + PartialOrd + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    fn of(value: f32) -> Self;
    fn get(self) -> f32;
    fn sqrt(self) -> Self;
}

impl Real for f32 {
    fn of(value: f32) -> Self {
        value
    }

    fn get(self) -> f32 {
        self
    }

    fn sqrt(self) -> Self {
        f32::sqrt(self)
    }
}

type V3<R> = [R; 3];

fn vector<R: Real>(vector: Vec3) -> V3<R> {
    vector.to_array().map(R::of)
}

fn zip<R: Real>(a: V3<R>, b: V3<R>, with: impl Fn(R, R) -> R) -> V3<R> {
    [with(a[0], b[0]), with(a[1], b[1]), with(a[2], b[2])]
}

fn add<R: Real>(a: V3<R>, b: V3<R>) -> V3<R> {
    zip(a, b, |a, b| a + b)
}

fn sub<R: Real>(a: V3<R>, b: V3<R>) -> V3<R> {
    zip(a, b, |a, b| a - b)
}

fn dot<R: Real>(a: V3<R>, b: V3<R>) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// One step of a state, in numbers that may be no ordinary ones.
pub fn step<R: Real>(Parts { model, params, .. }: &Parts, order: &Order, state: &mut State) {
    let forces = forces::<R>(model, params, order, state);
    let dt = R::of(params.dt as f32);
    for (point, force) in forces.into_iter().enumerate() {
        let inverse_mass = params.inverse_mass(point);
        let motion = [
            &mut state.position[point],
            &mut state.position_low[point],
            &mut state.velocity[point],
            &mut state.velocity_low[point],
        ];
        for axis in 0..3 {
            let [x, x_low, v, v_low] = motion.each_ref().map(|vector| R::of(vector[axis]));
            let fall = R::of(if inverse_mass > 0.0 { params.gravity[axis] } else { 0.0 });
            let kick = force[axis] * (R::of(inverse_mass) * dt) + fall * dt + v_low;
            let kick = if kick.get().abs() < 2f32.powi(-95) { R::of(0.0) } else { kick };
            let (v, v_low) = fast_two_sum(v, kick);
            let v = if v.get().abs() < 2f32.powi(-63) { R::of(0.0) } else { v };
            let (x, x_low) = fast_two_sum(x, v * dt + x_low);
            for (value, new) in [x, x_low, v, v_low].into_iter().enumerate() {
                motion[value][axis] = new.get();
            }
        }
    }
}

fn fast_two_sum<R: Real>(a: R, b: R) -> (R, R) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// The force on each point, N, but for its weight.
fn forces<R: Real>(model: &Model, params: &Params, order: &Order, state: &State) -> Vec<V3<R>> {
    let zeros = || vec![[R::of(0.0); 3]; model.point_count()];
    let ends = |spring: u32| model.places(spring).map(|place| model.point_at(place as usize));
    let motion = |point: usize| [vector::<R>(state.position[point]), vector(state.velocity[point])];
    // On the far end; on the near one it is subtracted.
    let force = |spring: u32| {
        let [[x_i, v_i], [x_j, v_j]] = ends(spring).map(motion);
        let spring = spring as usize;
        let (e, w) = (sub(x_i, x_j), sub(v_i, v_j));
        let squared = dot(e, e);
        let coincident = R::of(COINCIDENT_SQUARED);
        let squared = if squared > coincident { squared } else { coincident };
        let length = squared.sqrt();
        let inverse = R::of(1.0) / squared;
        let [k, d, rest] = [&params.spring_stiffness, &params.spring_damping, &params.spring_rest_length]
            .map(|of| R::of(of[spring]));
        let tension = (k * (length - rest) * length + d * dot(w, e)) * inverse;
        e.map(|e| e * tension)
    };
    let live = |spring: &&u32| !params.spring_cut[**spring as usize];

    let [mut begin, mut end, mut packed] = [zeros(), zeros(), zeros()];
    for &spring in order.stripes.iter().filter(live) {
        let [near, far] = ends(spring);
        begin[near] = sub(begin[near], force(spring));
        end[far] = add(end[far], force(spring));
    }
    for lanes in &order.bundles {
        for row in 0..lanes[0].len() {
            for spring in lanes.iter().filter_map(|lane| lane.get(row)).filter(live) {
                let far = ends(*spring)[1];
                packed[far] = add(packed[far], force(*spring));
            }
        }
        for lane in lanes {
            let sum = lane.iter().filter(live).fold([R::of(0.0); 3], |sum, &spring| add(sum, force(spring)));
            let near = ends(lane[0])[0];
            packed[near] = sub(packed[near], sum);
        }
    }
    let springs = begin.into_iter().zip(end).zip(packed);
    let mut forces: Vec<V3<R>> = springs.map(|((begin, end), packed)| add(add(begin, end), packed)).collect();

    for (point, sum) in forces.iter_mut().enumerate() {
        for plane in &params.planes {
            *sum = add(*sum, push_out(plane, motion(point)));
        }
    }
    for &spring in order.loose.iter().filter(live) {
        let [near, far] = ends(spring);
        forces[near] = sub(forces[near], force(spring));
        forces[far] = add(forces[far], force(spring));
    }
    for (&point, &force) in &params.external_forces {
        forces[point] = add(forces[point], vector(force));
    }
    for grab in &params.grabs {
        let [x, v] = motion(grab.point);
        let [k, d] = [grab.stiffness, grab.damping].map(R::of);
        let pull = sub(vector(grab.target), x).map(|away| away * k);
        forces[grab.point] = add(forces[grab.point], sub(pull, v.map(|speed| speed * d)));
    }
    forces
}

/// The push of a plane, N.
fn push_out<R: Real>(plane: &Plane, [x, v]: [V3<R>; 2]) -> V3<R> {
    let (zero, normal) = (R::of(0.0), vector(plane.normal));
    let (depth, speed) = (dot(sub(vector(plane.point), x), normal), dot(v, normal));
    let answer = R::of(plane.stiffness) * depth - R::of(plane.damping) * speed;
    let touches = depth > zero && (plane.law == ContactLaw::Report || answer > zero);
    normal.map(|along| if touches { answer } else { zero } * along)
}
