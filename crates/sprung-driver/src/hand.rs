//! A hand that pulls at a point, softly by a spring or hard by carrying it along.
//!
//! *The soft hand's stiffness.* It must hold the point against whatever pulls there, so it starts as stiff as all springs at
//! the point together, and at least such that the point alone would swing at 1.5 Hz (it then sags by 11 cm under its weight):
//!
//! ```text
//! k = max(Σ k_s, m·(2π·1.5 Hz)²)        d = 2ζ√(k·m),  ζ = ½
//! ```
//!
//! A stiff hand asks for short steps as a stiff spring does. If dt is within a limit without the hand, it stays 5 % within
//! that limit with it: in every configuration where dt was within that, else in this one. First ζ falls to ¼ and 0.1, then k
//! is halved, until that holds.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::Arc;

use sprung::{Code, Error, Grab, Material, Model, ModelBuilder, Params, Result, SAFE_SHARE, Vec3, stability};

/// The slowest a point alone may swing at the hand's spring, Hz.
const SLOWEST: f64 = 1.5;

/// Shares of the critical damping, best first.
const DAMPING_RATIOS: [f64; 3] = [0.5, 0.25, 0.1];

/// Halvings of the stiffness before it is taken as it is.
const MOST_HALVINGS: u32 = 60;

/// Simulated time in which a carried point catches up with the hand, s, if the steps that are due are shorter: a step would
/// be a jolt.
const CATCH_UP: f64 = 1.0 / 60.0;

/// The fastest a hand carries, in sizes of the scene for each second.
const SIZES_PER_SECOND: f64 = 10.0;

/// Distances below this part of the scene's size are rounding: the point has arrived.
const ARRIVED: f64 = 1e-6;

/// A hand that holds a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hand {
    pub point: usize,
    pub target: Vec3,
    pub hard: bool,
    /// The soft hand's spring, N/m, and damping, N·s/m.
    pub spring: (f32, f32),
}

impl Hand {
    /// The grab of a soft hand.
    pub fn grab(&self) -> Grab {
        let (stiffness, damping) = self.spring;
        Grab { point: self.point, target: self.target, stiffness, damping }
    }

    /// The velocity, m/s, at which a point carried from `position` is at the target after so many steps of `dt` (s), or a
    /// sixtieth of a second if that is longer. `size` is the scene's, m.
    pub fn velocity(&self, position: Vec3, steps: u64, dt: f64, size: f64) -> Vec3 {
        let way = self.target.as_dvec3() - position.as_dvec3();
        let distance = way.length();
        if distance <= ARRIVED * size {
            return Vec3::ZERO;
        }
        let speed = (distance / (steps as f64 * dt).max(CATCH_UP)).min(SIZES_PER_SECOND * size);
        (way * (speed / distance)).as_vec3()
    }
}

/// A pull at a point: by a spring of the given stiffness (N/m) and damping (N·s/m), or else by the one that pulls at it already, or
/// one that suits it.
///
/// # Errors
/// [`Code::NotFound`] for a point that is not there, [`Code::Conflict`] for one that is fixed.
///
/// # Panics
/// If the parts are not of one model.
pub fn grab(
    model: &Model,
    params: &Params,
    positions: &[Vec3],
    point: usize,
    target: Vec3,
    [stiffness, damping]: [Option<f32>; 2],
) -> Result<Grab> {
    if point >= model.point_count() {
        let sentence = format!("there is no point {point}; points are 0 to {}", model.point_count() - 1);
        return Err(Error::new(Code::NotFound, sentence));
    }
    if params.is_anchored(point) {
        let sentence = format!("{} is fixed, and a pull does not move it", model.point_name(point));
        return Err(Error::new(Code::Conflict, sentence).with_fix("unpin it"));
    }
    let there = params.grabs.iter().find(|grab| grab.point == point);
    let suits = there
        .map_or_else(|| soft_spring(model, params, positions, point), |grab| (grab.stiffness, grab.damping));
    let (stiffness, damping) = (stiffness.unwrap_or(suits.0), damping.unwrap_or(suits.1));
    Ok(Grab { point, target, stiffness, damping })
}

/// Stiffness (N/m) and damping (N·s/m) of a soft hand at a point that can move: as stiff as all springs at the point
/// together, as far as dt stays within the limit that it is within.
///
/// # Panics
/// If there is no such point, or if the parts are not of one model.
pub(crate) fn soft_spring(model: &Model, params: &Params, positions: &[Vec3], point: usize) -> (f32, f32) {
    let mass = f64::from(params.point_mass[point]);
    let springs = model.springs_at(point).iter().map(|&spring| spring as usize);
    let around: f64 = springs
        .filter(|&spring| !params.spring_cut[spring])
        .map(|spring| f64::from(params.spring_stiffness[spring]))
        .sum();
    let mut stiffness = around.max(mass * (2.0 * PI * SLOWEST).powi(2)).min(1e11);
    let spring = |stiffness: f64, ratio: f64| {
        (stiffness as f32, (2.0 * ratio * (stiffness * mass).sqrt()).min(1e11) as f32)
    };
    let Some(near) = Neighbourhood::new(model, params, positions, point) else {
        return spring(stiffness, DAMPING_RATIOS[0]);
    };
    // Which limit the step is within now, if any.
    let needed = params.dt / SAFE_SHARE;
    let is_within = |which| near.limit(which, (0.0, 0.0)) >= needed;
    let Some(limit) =
        [Which::EveryConfiguration, Which::Certified].into_iter().find(|&which| is_within(which))
    else {
        return spring(stiffness, DAMPING_RATIOS[0]);
    };
    for _ in 0..MOST_HALVINGS {
        let fits = |&ratio: &f64| near.limit(limit, spring(stiffness, ratio)) >= needed;
        if let Some(ratio) = DAMPING_RATIOS.into_iter().find(fits) {
            return spring(stiffness, ratio);
        }
        stiffness *= 0.5;
    }
    spring(stiffness, 0.0)
}

/// The limits that a step may be within.
#[derive(Clone, Copy)]
enum Which {
    EveryConfiguration,
    Certified,
}

/// A point, its neighbours, and theirs (held fixed): all that a grab of the point adds to the certified limits.
struct Neighbourhood {
    model: Model,
    params: Params,
    positions: Vec<Vec3>,
}

impl Neighbourhood {
    /// `None` if it cannot be built, which no valid model causes.
    fn new(model: &Model, params: &Params, positions: &[Vec3], point: usize) -> Option<Self> {
        let live = |point: usize| {
            let springs = model.springs_at(point).iter().map(|&spring| spring as usize);
            springs.filter(|&spring| !params.spring_cut[spring])
        };
        let mut springs: Vec<usize> = live(point).collect();
        let ends = |spring: usize| model.springs()[spring].map(|end| end as usize);
        let mut near: Vec<usize> = springs.iter().flat_map(|&spring| ends(spring)).collect();
        near.push(point);
        near.sort_unstable();
        near.dedup();
        springs.extend(near.iter().flat_map(|&neighbour| live(neighbour)));
        springs.sort_unstable();
        springs.dedup();

        let mut builder = ModelBuilder::new();
        let mut local = BTreeMap::new();
        let mut rest_lengths = Vec::with_capacity(springs.len());
        // The point itself comes first.
        for global in std::iter::once(point).chain(springs.iter().flat_map(|&spring| ends(spring))) {
            if local.contains_key(&global) {
                continue;
            }
            let held = near.binary_search(&global).is_err() || (params.is_fixed(global) && global != point);
            let mass = if held { 0.0 } else { params.point_mass[global] };
            local.insert(global, builder.add_point(positions[global], mass).ok()?);
        }
        for &spring in &springs {
            let [i, j] = ends(spring).map(|end| local[&end]);
            let (stiffness, damping) = (params.spring_stiffness[spring], params.spring_damping[spring]);
            builder.add_spring(i, j, Material { stiffness, damping }).ok()?;
            rest_lengths.push(params.spring_rest_length[spring]);
        }
        let (model, mut own, state) = builder.build().ok()?;
        own.planes.clone_from(&params.planes);
        own.spring_rest_length = Arc::new(rest_lengths);
        Some(Self { model, params: own, positions: state.position })
    }

    /// A limit here with a grab of this stiffness and damping, s.
    fn limit(&self, which: Which, (stiffness, damping): (f32, f32)) -> f64 {
        let mut params = self.params.clone();
        params.grabs.push(Grab { point: 0, target: Vec3::ZERO, stiffness, damping });
        let limit = match which {
            Which::EveryConfiguration => stability::every_configuration(&self.model, &params),
            Which::Certified => stability::certified(&self.model, &params, &self.positions),
        };
        limit.map_or(f64::INFINITY, |limit| limit.dt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::scene::{BUILTIN, Kind, Scene};

    /// At some points of every scene: dt stays 5 % below the limit that it is within, and the hand is as stiff as the springs
    /// at the point, or, where that limit does not allow it, stiffer than half of what it allows.
    #[test]
    fn a_soft_hand_is_as_stiff_as_the_limits_allow() {
        for builtin in BUILTIN {
            let (model, params, state) =
                Scene::builtin(builtin.name).and_then(|scene| scene.build()).expect("a built-in scene");
            let needed = params.dt / SAFE_SHARE;
            // Of the whole model, not of a neighbourhood.
            let limit = |which: Which, params: &Params| {
                let limit = match which {
                    Which::EveryConfiguration => stability::every_configuration(&model, params),
                    Which::Certified => stability::certified(&model, params, &state.position),
                };
                limit.expect("it has springs").dt
            };
            let within = [Which::EveryConfiguration, Which::Certified]
                .into_iter()
                .find(|&which| limit(which, &params) >= needed);
            let points = (0..model.point_count()).filter(|&point| !params.is_fixed(point));
            // Limits take their time.
            let tried = if builtin.kind == Kind::Benchmark { 2 } else { 7 };
            for point in points.step_by(model.point_count() / tried + 1) {
                let (stiffness, damping) = soft_spring(&model, &params, &state.position, point);
                let mass = f64::from(params.point_mass[point]);
                let around = model.springs_at(point).iter();
                let around = around.map(|&spring| f64::from(params.spring_stiffness[spring as usize]));
                let wanted = (mass * (2.0 * PI * SLOWEST).powi(2)).max(around.sum()) as f32;
                let name = format!("{} point {point}: {stiffness} of {wanted} N/m", builtin.name);
                assert!(damping > 0.0, "{name}");
                let is_stable = |stiffness: f32, damping: f32| {
                    let grabs = vec![Grab { point, target: Vec3::ZERO, stiffness, damping }];
                    let grabbed = Params { grabs, ..params.clone() };
                    within.is_none_or(|which| limit(which, &grabbed) >= needed)
                };
                assert!(is_stable(stiffness, damping), "{name}");
                if stiffness != wanted {
                    let least_damping = 2.0 * 0.1 * (f64::from(2.0 * stiffness) * mass).sqrt();
                    assert!(
                        !is_stable(2.0 * stiffness, least_damping as f32),
                        "{name}, and could be twice that"
                    );
                }
            }
        }
    }

    #[test]
    fn the_hand_arrives_after_the_steps_that_are_due_and_then_rests() {
        let hand = Hand { point: 0, target: Vec3::X, hard: true, spring: (0.0, 0.0) };
        assert_eq!(hand.velocity(Vec3::ZERO, 10, 0.01, 5.0), Vec3::new(10.0, 0.0, 0.0));
        assert_eq!(hand.velocity(Vec3::X, 10, 0.01, 5.0), Vec3::ZERO);
        // No faster than ten sizes a second, and no jolt in one short step.
        assert_eq!(hand.velocity(Vec3::ZERO, 10, 0.01, 0.5), Vec3::new(5.0, 0.0, 0.0));
        assert!((hand.velocity(Vec3::ZERO, 1, 1e-6, 100.0).x - 60.0).abs() < 1e-3);
    }
}
