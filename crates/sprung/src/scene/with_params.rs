//! The other way round: a scene file that says what the parameters are now.
//!
//! What has not changed stays as it is written. What has is written as shortly as it can be: one value for a group of
//! springs where all have it, exceptions by number where some do not. In the end the scene is built again and held against
//! the parameters, so that a file that does not say all of them is never given out.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::Vec3;

use super::assemble::{Built, pinned_by, plane, vec3};
use super::choices::{Dt, Numbers, OneOrEach, Pin};
use super::source::Origin;
use super::types::{Body, Exception, Force, Plane, Scene};
use super::{MAX_BYTES, too_many_bytes};
use crate::build::mesh::MeshSpring;
use crate::contact;
use crate::error::{Code, Error, Result};
use crate::model::Model;
use crate::params::{LENGTH_RANGE, Params};
use crate::stability;

impl Scene {
    /// This scene with the parameters as they are now, changed as little as possible: built, it gives the same model, the
    /// same parameters to the bit, and the same first state, but that points which are now fixed start at rest.
    ///
    /// Grabs and carried points are left out: they belong to a hand, not to a scene.
    ///
    /// ```
    /// use sprung::{Change, scene::Scene};
    ///
    /// let scene = Scene::builtin("jelly")?;
    /// let mut simulation = scene.simulation()?;
    /// simulation.change(Change::Stiffness(0..7560, 500.0))?;
    /// let saved = scene.with_params(simulation.model(), simulation.params())?;
    /// assert_eq!(saved.bodies[0].springs[0].stiffness, 500.0);
    /// assert_eq!(Scene::parse(&saved.to_toml(), "saved.toml")?.build()?.1, *simulation.params());
    /// # Ok::<(), sprung::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Code::Conflict`] if the model is not this scene's, [`Code::TooLarge`] if the file would be larger than
    /// [`MAX_BYTES`], [`Code::OutOfRange`] for parameters that are not allowed.
    pub fn with_params(&self, model: &Model, params: &Params) -> Result<Self> {
        params.validate(model)?;
        let own = self.build_in_groups()?;
        if own.model != *model {
            return Err(Error::new(Code::Conflict, "the model was not built from this scene"));
        }
        let target = Params { grabs: Vec::new(), carried: BTreeMap::new(), ..params.clone() };

        let mut scene = Self { origin: Origin::default(), ..self.clone() };
        scene.substeps = target.substeps;
        if vec3(scene.gravity) != target.gravity {
            scene.gravity = decimals(target.gravity);
        }
        if !scene.planes.iter().map(plane).eq(target.planes.iter().copied()) {
            scene.planes = target.planes.iter().map(written_plane).collect();
        }
        for (body, part) in scene.bodies.iter_mut().zip(model.bodies()) {
            save_body(body, &part.points, &own, &target);
        }
        // In the order in which the groups were made: of each body first the springs of its mesh.
        let mut groups = own.groups.iter();
        let mut save = |text: GroupText<'_>| {
            if let Some(springs) = groups.next() {
                text.save(springs, model, &own.params, &target);
            }
        };
        for body in &mut scene.bodies {
            let loaded = body.loaded.clone();
            if let (Some(made), Some((rest_scale, cut, except))) = (loaded.made(), body.mesh_springs_mut()) {
                save(GroupText { material: Said::OfEach(&made.springs), rest_scale, cut, except });
            }
            for springs in &mut body.springs {
                save(GroupText {
                    material: Said::OfAll {
                        stiffness: &mut springs.stiffness,
                        damping: &mut springs.damping,
                    },
                    rest_scale: &mut springs.rest_scale,
                    cut: &mut springs.cut,
                    except: &mut springs.except,
                });
            }
        }
        for joint in &mut scene.joints {
            save(GroupText {
                material: Said::OfAll { stiffness: &mut joint.stiffness, damping: &mut joint.damping },
                rest_scale: &mut joint.rest_scale,
                cut: &mut joint.cut,
                except: &mut joint.except,
            });
        }
        // "auto" may now stand for another step.
        let is_auto = scene.dt == Dt::Auto && stability::auto_dt(model, &target) == Ok(target.dt);
        if !is_auto {
            scene.dt = Dt::Seconds(target.dt);
        }

        let bytes = scene.to_toml().len() as u64;
        if bytes > MAX_BYTES {
            return Err(too_many_bytes(bytes).with_fix("too many points or springs differ from their group"));
        }
        let (_, built, _) = scene.build()?;
        if built != target {
            return Err(Error::new(Code::Unsupported, "a scene file cannot say all of these parameters"));
        }
        Ok(scene)
    }
}

/// The shortest decimal that reads back to the same float32.
fn decimal(value: f32) -> f64 {
    let shortest: f64 = value.to_string().parse().unwrap_or(f64::from(value));
    if (shortest as f32).to_bits() == value.to_bits() { shortest } else { f64::from(value) }
}

fn decimals(vector: Vec3) -> [f64; 3] {
    vector.to_array().map(decimal)
}

fn written_plane(plane: &contact::Plane) -> Plane {
    let is_level = plane.normal == Vec3::Y && plane.point.x == 0.0 && plane.point.z == 0.0;
    Plane {
        y: is_level.then(|| decimal(plane.point.y)),
        point: (!is_level).then(|| decimals(plane.point)),
        normal: (!is_level).then(|| decimals(plane.normal)),
        stiffness: decimal(plane.stiffness),
        damping: decimal(plane.damping),
        law: plane.law,
    }
}

/// Masses, pins, first velocities and forces of one body.
fn save_body(body: &mut Body, points: &Range<usize>, own: &Built, target: &Params) {
    let masses = &target.point_mass[points.clone()];
    if *masses != own.params.point_mass[points.clone()] {
        body.body_mass = None;
        body.cloth.iter_mut().for_each(|cloth| cloth.density = None);
        body.soft.iter_mut().for_each(|soft| soft.density = None);
        body.point_mass = Some(match masses {
            [first, rest @ ..] if rest.iter().all(|mass| mass == first) => OneOrEach::One(decimal(*first)),
            _ => OneOrEach::Each(masses.iter().map(|&mass| decimal(mass)).collect()),
        });
    }

    let pinned = &target.point_pinned;
    if pinned[points.clone()] != own.params.point_pinned[points.clone()] {
        // Pins all of whose points are still held stay as they are written; the others are named one by one.
        let mut left: Vec<bool> = pinned[points.clone()].to_vec();
        let mut pins = std::mem::take(&mut body.pins);
        pins.retain(|pin| {
            let held = pinned_by(pin, body, points, |point| own.state.position[point]);
            let stays = held.iter().all(|&point| pinned[point]);
            if stays {
                held.iter().for_each(|&point| left[point - points.start] = false);
            }
            stays
        });
        pins.extend((0..).zip(&left).filter(|(_, left)| **left).map(|(index, _)| Pin::Index(index)));
        body.pins = pins;
    }

    // A point that was fixed started at rest, whatever velocity was written for it.
    let starts_otherwise = |point: usize| {
        !target.is_fixed(point) && vec3(body.velocity.of(point - points.start)) != own.state.velocity[point]
    };
    if points.clone().any(starts_otherwise) {
        body.velocity =
            OneOrEach::Each(points.clone().map(|point| decimals(own.state.velocity[point])).collect());
    }

    let forces = |params: &Params| -> Vec<Force> {
        let within = params.external_forces.range(points.clone());
        let number = |point: usize| (point - points.start) as u32;
        within.map(|(&point, &force)| Force { point: number(point), force: decimals(force) }).collect()
    };
    if forces(target) != forces(&own.params) {
        body.forces = forces(target);
    }
}

/// What a group of springs is made of, besides its exceptions.
enum Said<'a> {
    /// The scene says it, the same for all.
    OfAll { stiffness: &'a mut f64, damping: &'a mut f64 },
    /// It follows from a mesh, and is another for each.
    OfEach(&'a [MeshSpring]),
}

/// What a scene says of one group of springs, in a body or a joint.
struct GroupText<'a> {
    material: Said<'a>,
    rest_scale: &'a mut f64,
    cut: &'a mut Vec<Numbers>,
    except: &'a mut Vec<Exception>,
}

impl GroupText<'_> {
    fn save(self, springs: &Range<usize>, model: &Model, own: &Params, target: &Params) {
        let cut = &target.spring_cut[springs.clone()];
        if *cut != own.spring_cut[springs.clone()] {
            *self.cut = spans((0..).zip(cut).filter(|(_, cut)| **cut).map(|(number, _)| number));
        }

        let of = |params: &Params| {
            [&params.spring_stiffness, &params.spring_damping, &params.spring_rest_length]
                .map(|values| values[springs.clone()].to_vec())
        };
        let [stiffness, damping, rest_length] = of(target);
        if of(own) == [&stiffness, &damping, &rest_length].map(Vec::clone) {
            return;
        }
        let mut exceptions = Exceptions::default();
        let numbers = || 0u32..;
        let (usual_stiffness, usual_damping): (Vec<f32>, Vec<f32>) = match self.material {
            Said::OfAll { stiffness: written_stiffness, damping: written_damping } => {
                *written_stiffness = most_common(&stiffness, *written_stiffness);
                *written_damping = most_common(&damping, *written_damping);
                let count = springs.len();
                (vec![*written_stiffness as f32; count], vec![*written_damping as f32; count])
            }
            Said::OfEach(made) => {
                made.iter().map(|spring| (spring.stiffness as f32, spring.damping as f32)).unzip()
            }
        };
        let numbered = |values: &[f32], usual: &[f32]| {
            let unlike: Vec<(u32, u32)> = numbers()
                .zip(values.iter().zip(usual))
                .filter(|(_, (value, usual))| value != usual)
                .map(|(number, (value, _))| (value.to_bits(), number))
                .collect();
            unlike
        };
        for (bits, number) in numbered(&stiffness, &usual_stiffness) {
            exceptions.stiffness.entry(bits).or_default().push(number);
        }
        for (bits, number) in numbered(&damping, &usual_damping) {
            exceptions.damping.entry(bits).or_default().push(number);
        }
        let lengths: Vec<[f32; 2]> = model.spring_rest_length()[springs.clone()]
            .iter()
            .copied()
            .zip(rest_length)
            .map(Into::into)
            .collect();
        *self.rest_scale = exceptions.save_rest_lengths(&lengths, *self.rest_scale);
        *self.except = exceptions.written();
    }
}

/// The value that most springs have, as a decimal; the written one where no other is more frequent.
fn most_common(values: &[f32], written: f64) -> f64 {
    let mut counts = BTreeMap::<u32, usize>::new();
    values.iter().for_each(|value| *counts.entry(value.to_bits()).or_default() += 1);
    let of_written = counts.get(&(written as f32).to_bits()).copied().unwrap_or_default();
    match counts.into_iter().max_by_key(|&(_, count)| count) {
        Some((bits, count)) if count > of_written => decimal(f32::from_bits(bits)),
        _ => written,
    }
}

/// Springs that are unlike the others of their group, by the bits of their value.
#[derive(Default)]
struct Exceptions {
    stiffness: BTreeMap<u32, Vec<u32>>,
    damping: BTreeMap<u32, Vec<u32>>,
    /// By the bits of a float64.
    rest_scale: BTreeMap<u64, Vec<u32>>,
    rest_length: BTreeMap<u32, Vec<u32>>,
}

impl Exceptions {
    /// Finds the scales that lead from the lengths as built to the rest lengths now. Gives the group's own.
    fn save_rest_lengths(&mut self, lengths: &[[f32; 2]], written: f64) -> f64 {
        let fits = |scale: f32| move |[built, now]: [f32; 2]| built * scale == now;
        let runs = runs_of_one_scale(lengths, |_| false);
        let longest = runs.iter().max_by_key(|run| run.numbers.len()).and_then(|run| run.scales);
        let count = |scale: f64| lengths.iter().filter(|&&pair| fits(scale as f32)(pair)).count();
        let found = longest.map_or(written, plainest);
        let base = if count(found) > count(written) { found } else { written };
        for Run { numbers, scales } in runs_of_one_scale(lengths, fits(base as f32)) {
            match scales {
                Some(scales) => {
                    self.rest_scale.entry(plainest(scales).to_bits()).or_default().extend(numbers)
                }
                None => {
                    for number in numbers {
                        let now = lengths[number as usize][1];
                        self.rest_length.entry(now.to_bits()).or_default().push(number);
                    }
                }
            }
        }
        base
    }

    /// One entry for each set of springs, in the order of their numbers.
    fn written(self) -> Vec<Exception> {
        let mut entries = BTreeMap::<Vec<u32>, Exception>::new();
        for (bits, numbers) in self.stiffness {
            entries.entry(numbers).or_default().stiffness = Some(decimal(f32::from_bits(bits)));
        }
        for (bits, numbers) in self.damping {
            entries.entry(numbers).or_default().damping = Some(decimal(f32::from_bits(bits)));
        }
        for (bits, numbers) in self.rest_scale {
            entries.entry(numbers).or_default().rest_scale = Some(f64::from_bits(bits));
        }
        for (bits, numbers) in self.rest_length {
            // No scale leads to this length, so the springs have none either.
            entries.entry(numbers).or_default().rest_length = Some(decimal(f32::from_bits(bits)));
        }
        let with_springs =
            |(numbers, exception): (Vec<u32>, Exception)| Exception { springs: spans(numbers), ..exception };
        entries.into_iter().map(with_springs).collect()
    }
}

/// Springs in a row, but for those left out, whose rest lengths are the built ones times one scale.
struct Run {
    numbers: Vec<u32>,
    /// The smallest and the largest scale that will do; `None` where no scale does.
    scales: Option<[f32; 2]>,
}

/// Rounding leaves several scales that lead from one length to another. A run goes on for as long as there is one that
/// does for all of its springs.
fn runs_of_one_scale(lengths: &[[f32; 2]], left_out: impl Fn([f32; 2]) -> bool) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (number, &pair) in (0u32..).zip(lengths).filter(|&(_, &pair)| !left_out(pair)) {
        let scales = scales_between(pair);
        if let (Some(Run { numbers, scales: Some([low, high]) }), Some(these)) = (runs.last_mut(), scales) {
            let common = [low.max(these[0]), high.min(these[1])];
            if common[0] <= common[1] {
                [*low, *high] = common;
                numbers.push(number);
                continue;
            }
        }
        runs.push(Run { numbers: vec![number], scales });
    }
    runs
}

/// The smallest and the largest float32 that, times the first length, give the second, if any does.
fn scales_between([built, now]: [f32; 2]) -> Option<[f32; 2]> {
    let fits = |scale: f32| LENGTH_RANGE.contains(&scale) && built * scale == now;
    if built == 0.0 {
        return (now == 0.0).then_some([*LENGTH_RANGE.start(), *LENGTH_RANGE.end()]);
    }
    let near = now / built;
    let some = [near, near.next_down(), near.next_up()].into_iter().find(|&scale| fits(scale))?;
    // A product has few neighbours that round to it, but for products so small that almost all do.
    let reach = |step: fn(f32) -> f32| {
        (0..8).fold(some, |scale, _| if fits(step(scale)) { step(scale) } else { scale })
    };
    Some([reach(f32::next_down), reach(f32::next_up)])
}

/// The shortest decimal between two scales.
fn plainest([low, high]: [f32; 2]) -> f64 {
    if (low..=high).contains(&1.0) {
        return 1.0;
    }
    let middle = 0.5 * (f64::from(low) + f64::from(high));
    let rounded = |digits: usize| format!("{middle:.digits$e}").parse::<f64>().ok();
    let within = |scale: &f64| (low..=high).contains(&(*scale as f32));
    (0..9).filter_map(rounded).find(within).unwrap_or(f64::from(low))
}

/// Ascending numbers as single ones and spans.
fn spans(numbers: impl IntoIterator<Item = u32>) -> Vec<Numbers> {
    let mut spans: Vec<[u32; 2]> = Vec::new();
    for number in numbers {
        match spans.last_mut() {
            Some([_, last]) if *last + 1 == number => *last = number,
            _ => spans.push([number; 2]),
        }
    }
    let short = |[first, last]: [u32; 2]| {
        if first == last { Numbers::One(first) } else { Numbers::Span([first, last]) }
    };
    spans.into_iter().map(short).collect()
}
