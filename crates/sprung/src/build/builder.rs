//! The builder: points and springs, body by body, checked once, then an immutable model.

use std::ops::Range;
use std::sync::Arc;

use glam::Vec3;

use super::connect::{pairs_between, pairs_within};
use super::numbering::hidden_order;
use crate::error::{Code, Error, Result};
use crate::math::{distance, without_negligible};
use crate::model::{Body, HiddenOrder, Joint, Model, Surface, SurfaceKind, SurfaceVertices, WeightedVertex};
use crate::params::{
    DAMPING_RANGE, DT_RANGE, LENGTH_RANGE, Params, STIFFNESS_RANGE, check_in, check_mass, check_vector,
};
use crate::simulation::Simulation;
use crate::stability;
use crate::state::State;

/// Springs that a model may have unless [`ModelBuilder::allow_springs`] says otherwise.
pub const DEFAULT_MAX_SPRINGS: usize = 20_000_000;

/// What a spring is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Stiffness k_s, N/m.
    pub stiffness: f32,
    /// Damping k_d along the spring, N·s/m.
    pub damping: f32,
}

/// Collects points and springs and makes a [`Model`], its [`Params`] and a first [`State`] of them.
///
/// What unusual input means:
/// - A point of *zero mass* is fixed in space; a *negative* mass is refused.
/// - A spring from a point to itself is refused. Its ends are otherwise put in order, the smaller index first.
/// - *Repeated springs* all act, as springs side by side do: two of stiffness k pull like one of 2k.
/// - A spring *between two fixed points* is kept, drawn and counted, and never moves anything.
/// - *Coincident points* may be joined; their spring has rest length zero. While two points coincide their spring has no
///   axis and exerts no force; closer than 10⁻¹⁵ m its damper fades in, and it is never a NaN.
/// - A spring of *rest length zero* always pulls its ends together.
///
/// ```
/// use sprung::{Material, ModelBuilder, Vec3};
///
/// let mut builder = ModelBuilder::new();
/// let anchor = builder.add_point(Vec3::ZERO, 0.0)?; // zero mass: fixed in space
/// let bob = builder.add_point(Vec3::new(0.0, -5.0, 0.0), 1.0)?;
/// builder.add_spring(anchor, bob, Material { stiffness: 20.0, damping: 0.2 })?;
/// let mut simulation = builder.simulation()?;
/// simulation.frame()?;
/// # Ok::<(), sprung::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct ModelBuilder {
    position: Vec<Vec3>,
    velocity: Vec<Vec3>,
    mass: Vec<f32>,
    pinned: Vec<bool>,
    springs: Vec<[u32; 2]>,
    rest_length: Vec<f32>,
    stiffness: Vec<f32>,
    damping: Vec<f32>,
    bodies: Vec<Body>,
    joints: Vec<Joint>,
    surfaces: Vec<Surface>,
    max_springs: Option<usize>,
}

impl ModelBuilder {
    /// An empty builder.
    pub fn new() -> Self {
        Self::default()
    }

    /// Allows up to `max_springs` springs instead of 20 million.
    pub fn allow_springs(&mut self, max_springs: usize) {
        self.max_springs = Some(max_springs);
    }

    /// Makes room for so many more points and springs, so that a large model is built without copying as it grows.
    pub fn reserve(&mut self, points: usize, springs: usize) {
        self.position.reserve_exact(points);
        self.velocity.reserve_exact(points);
        self.mass.reserve_exact(points);
        self.pinned.reserve_exact(points);
        self.springs.reserve_exact(springs);
        for list in [&mut self.rest_length, &mut self.stiffness, &mut self.damping] {
            list.reserve_exact(springs);
        }
    }

    /// Begins a body: points and springs added from here on belong to it.
    ///
    /// # Errors
    /// [`Code::Duplicate`] if the name is taken, [`Code::Conflict`] after the first joint.
    pub fn begin_body(&mut self, name: impl Into<String>) -> Result<()> {
        let name = name.into();
        if self.bodies.iter().any(|body| body.name == name) {
            return Err(Error::new(Code::Duplicate, format!("the name \"{name}\" is used by two bodies")));
        }
        if !self.joints.is_empty() {
            return Err(Error::new(
                Code::Conflict,
                format!("body \"{name}\" comes after a joint; bodies come first"),
            ));
        }
        let (points, springs) = (self.position.len(), self.springs.len());
        self.bodies.push(Body { name, points: points..points, springs: springs..springs });
        Ok(())
    }

    /// Begins a joint: springs added from here on belong to it and may join any two points.
    pub fn begin_joint(&mut self, name: impl Into<String>) {
        let springs = self.springs.len();
        self.joints.push(Joint { name: name.into(), springs: springs..springs });
    }

    /// Adds a point at rest and gives its index. Position in m, mass in kg; zero mass fixes it in space.
    ///
    /// # Errors
    /// [`Code::OutOfRange`] for a mass or coordinate that is negative, not finite or too large.
    pub fn add_point(&mut self, position: Vec3, mass: f32) -> Result<usize> {
        check_vector("position", position)?;
        check_mass(mass).map_err(|error| error.at_field("mass"))?;
        if self.position.len() >= u32::MAX as usize {
            return Err(Error::new(Code::TooLarge, "a model can have at most 4,294,967,295 points"));
        }
        self.ensure_body()?;
        let index = self.position.len();
        self.position.push(without_negligible(position));
        self.velocity.push(Vec3::ZERO);
        self.mass.push(mass);
        self.pinned.push(false);
        self.last_body().points.end = index + 1;
        Ok(index)
    }

    /// Pins a point: it stays where it is until it is unpinned, and keeps its mass for then.
    ///
    /// # Errors
    /// [`Code::NotFound`] if there is no such point.
    pub fn pin(&mut self, point: usize) -> Result<()> {
        self.check_point(point)?;
        self.pinned[point] = true;
        Ok(())
    }

    /// Gives a point its first velocity, m/s. That of a fixed point is ignored.
    ///
    /// # Errors
    /// [`Code::NotFound`] or [`Code::OutOfRange`].
    pub fn set_velocity(&mut self, point: usize, velocity: Vec3) -> Result<()> {
        self.check_point(point)?;
        check_vector("velocity", velocity)?;
        self.velocity[point] = velocity;
        Ok(())
    }

    /// Joins two points with a spring whose rest length is their distance, and gives its index.
    ///
    /// # Errors
    /// [`Code::NotFound`], [`Code::OutOfRange`], [`Code::TooLarge`], or [`Code::Conflict`] for a point joined to itself.
    pub fn add_spring(&mut self, a: usize, b: usize, material: Material) -> Result<usize> {
        self.check_point(a)?;
        self.check_point(b)?;
        check_material(material)?;
        if a == b {
            return Err(Error::new(Code::Conflict, format!("a spring joins point {a} to itself")));
        }
        if self.springs.len() >= self.spring_limit() {
            return Err(self.too_many_springs());
        }
        self.ensure_body()?;
        let (i, j) = (a.min(b), a.max(b));
        self.push_spring([i as u32, j as u32], material);
        Ok(self.springs.len() - 1)
    }

    /// Sets a spring's rest length, m.
    ///
    /// # Errors
    /// [`Code::NotFound`] or [`Code::OutOfRange`].
    pub fn set_rest_length(&mut self, spring: usize, length: f32) -> Result<()> {
        check_in("rest_length", length, &LENGTH_RANGE)?;
        let Some(slot) = self.rest_length.get_mut(spring) else {
            return Err(Error::new(Code::NotFound, format!("there is no spring {spring}")));
        };
        *slot = length;
        Ok(())
    }

    /// Joins every pair of the given points that is no further apart than `radius` (m): the report's `createSprings`.
    ///
    /// The springs and their order are those of the double loop over i < j, found through a cell grid.
    /// Gives the range of springs made. See [`pairs_within`] for how the comparison survives rounding.
    ///
    /// # Errors
    /// [`Code::OutOfRange`] for a radius that is negative or not finite, [`Code::TooLarge`] if it would make too many.
    pub fn connect_within(
        &mut self,
        points: Range<usize>,
        radius: f32,
        material: Material,
    ) -> Result<Range<usize>> {
        check_material(material)?;
        if points.start > points.end || points.end > self.position.len() {
            let sentence = format!("points {}..{} are not all there", points.start, points.end);
            return Err(Error::new(Code::NotFound, sentence));
        }
        let allowed = self.spring_limit().saturating_sub(self.springs.len());
        let mut pairs = pairs_within(&self.position[points.clone()], radius, allowed)?
            .ok_or_else(|| self.too_many_springs().at_field("radius"))?;
        self.ensure_body()?;
        let offset = points.start as u32;
        pairs.iter_mut().flatten().for_each(|point| *point += offset);
        Ok(self.push_springs(pairs, material))
    }

    /// Joins every point of `a` to every point of `b` that is no further away than `radius` (m), and none within `a` or
    /// within `b`; the ranges must not overlap. Gives the range of springs made.
    ///
    /// # Errors
    /// As [`connect_within`](Self::connect_within), and [`Code::Conflict`] for ranges that overlap.
    pub fn connect_between(
        &mut self,
        a: Range<usize>,
        b: Range<usize>,
        radius: f32,
        material: Material,
    ) -> Result<Range<usize>> {
        check_material(material)?;
        for range in [&a, &b] {
            if range.start > range.end || range.end > self.position.len() {
                let sentence = format!("points {}..{} are not all there", range.start, range.end);
                return Err(Error::new(Code::NotFound, sentence));
            }
        }
        if a.start < b.end && b.start < a.end {
            return Err(Error::new(Code::Conflict, "the two sets of points overlap"));
        }
        let allowed = self.spring_limit().saturating_sub(self.springs.len());
        let (here, there) = (&self.position[a.clone()], &self.position[b.clone()]);
        let mut pairs = pairs_between(here, there, radius, allowed)?
            .ok_or_else(|| self.too_many_springs().at_field("radius"))?;
        let (a, b) = (a.start as u32, b.start as u32);
        for pair in &mut pairs {
            let (i, j) = (pair[0] + a, pair[1] + b);
            *pair = [i.min(j), i.max(j)];
        }
        Ok(self.push_springs(pairs, material))
    }

    /// Gives the current body a surface for drawing and export.
    ///
    /// # Errors
    /// [`Code::NotFound`] if a triangle names a point that is not there.
    pub fn add_surface(&mut self, kind: SurfaceKind, triangles: Vec<[u32; 3]>) -> Result<()> {
        triangles.iter().flatten().try_for_each(|&point| self.check_point(point as usize))?;
        self.ensure_body()?;
        let body = self.bodies.len() - 1;
        self.surfaces.push(Surface {
            body,
            kind,
            vertices: SurfaceVertices::Points,
            triangles,
            fans: Vec::new(),
            stands_for_body: false,
        });
        Ok(())
    }

    /// Gives the current body a surface whose vertices are carried along by its points; the triangles are indices into
    /// `vertices`.
    ///
    /// # Errors
    /// [`Code::NotFound`] for a point or vertex that is not there, [`Code::OutOfRange`] for weights that do not add up
    /// to 1, [`Code::TooLarge`] for more vertices than 32 bits can count.
    pub fn add_weighted_surface(
        &mut self,
        kind: SurfaceKind,
        vertices: Vec<WeightedVertex>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<()> {
        vertices.iter().flat_map(|vertex| vertex.points).try_for_each(|p| self.check_point(p as usize))?;
        for (index, vertex) in vertices.iter().enumerate() {
            let sum: f32 = vertex.weights.iter().sum();
            // Not a number is not near 1 either.
            if (sum - 1.0).abs() > 1e-4 || sum.is_nan() {
                let sentence = format!("vertex {index} has weights that add up to {sum}, and must to 1");
                return Err(Error::new(Code::OutOfRange, sentence));
            }
        }
        if let Some(corner) = triangles.iter().flatten().find(|&&corner| corner as usize >= vertices.len()) {
            let sentence = format!("there is no vertex {corner}; the surface has {}", vertices.len());
            return Err(Error::new(Code::NotFound, sentence));
        }
        let others: usize = self.surfaces.iter().map(|surface| surface.weighted().len()).sum();
        if self.position.len() + others + vertices.len() >= u32::MAX as usize {
            return Err(Error::new(Code::TooLarge, "points and vertices are more than 4,294,967,295"));
        }
        self.ensure_body()?;
        let body = self.bodies.len() - 1;
        self.surfaces.push(Surface {
            body,
            kind,
            vertices: SurfaceVertices::Weighted(vertices),
            triangles,
            fans: Vec::new(),
            stands_for_body: false,
        });
        Ok(())
    }

    /// The triangles of the surface that was added last make faces together, as many in turn as `fans` says: see
    /// [`Surface::fans`].
    ///
    /// # Errors
    /// [`Code::Conflict`] if they are not all of its triangles, or no fans.
    pub fn join_into_faces(&mut self, fans: Vec<u32>) -> Result<()> {
        let Some(surface) = self.surfaces.last_mut() else {
            return Err(Error::new(Code::Conflict, "there is no surface whose triangles could make faces"));
        };
        let mut rest = &surface.triangles[..];
        for &fan in &fans {
            let is_fan = |face: &&[[u32; 3]]| {
                !face.is_empty()
                    && face.windows(2).all(|two| two[1][0] == two[0][0] && two[1][1] == two[0][2])
            };
            if rest.split_off(..fan as usize).filter(is_fan).is_none() {
                let sentence = format!("there are no {fan} triangles around one corner to make a face");
                return Err(Error::new(Code::Conflict, sentence));
            }
        }
        if !(rest.is_empty() || fans.is_empty()) {
            let sentence = format!("{} triangles of the surface belong to no face", rest.len());
            return Err(Error::new(Code::Conflict, sentence));
        }
        surface.fans = fans;
        Ok(())
    }

    /// The surface that was added last is what is meant to be seen of its body: see [`Surface::stands_for_body`].
    pub fn show_surface_alone(&mut self) {
        if let Some(surface) = self.surfaces.last_mut() {
            surface.stands_for_body = true;
        }
    }

    /// How many points there are so far.
    pub fn point_count(&self) -> usize {
        self.position.len()
    }

    /// How many springs there are so far.
    pub fn spring_count(&self) -> usize {
        self.springs.len()
    }

    /// Where a point is, m.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn position(&self, point: usize) -> Vec3 {
        self.position[point]
    }

    /// The finished model, its parameters and its first state.
    ///
    /// The parameters start with standard gravity (0, −9.81, 0) m/s², no plane, one step per frame, and the `dt` that
    /// [`stability::auto_dt`] chooses (the smallest there is, where none is safe); change them before a [`Simulation`] is made
    /// of them.
    ///
    /// # Errors
    /// [`Code::Conflict`] for a builder without points.
    pub fn build(self) -> Result<(Model, Params, State)> {
        let (model, mut params, state) = self.parts()?;
        params.dt = stability::auto_dt(&model, &params).unwrap_or(*DT_RANGE.start());
        Ok((model, params, state))
    }

    /// As [`build`](Self::build), but leaves `dt` at 0.01 s: for a caller who sets it, which spares the search for a safe one.
    pub(crate) fn parts(mut self) -> Result<(Model, Params, State)> {
        if self.position.is_empty() {
            return Err(Error::new(Code::Conflict, "there are no points; a model needs at least one"));
        }
        for (point, velocity) in self.velocity.iter_mut().enumerate() {
            if self.mass[point] == 0.0 || self.pinned[point] {
                *velocity = Vec3::ZERO;
            }
        }
        let hidden_order = HiddenOrder::new(hidden_order(&self.position, &self.springs));
        let rest_length = Arc::new(self.rest_length);
        let model = Model {
            point_count: self.position.len(),
            springs: self.springs,
            spring_rest_length: rest_length.clone(),
            bodies: self.bodies,
            joints: self.joints,
            surfaces: self.surfaces,
            springs_at: Default::default(),
            hidden_order,
        };
        let params = Params {
            dt: 0.01,
            substeps: 1,
            gravity: Vec3::new(0.0, -9.81, 0.0),
            planes: Vec::new(),
            point_mass: Arc::new(self.mass),
            point_pinned: Arc::new(self.pinned),
            spring_stiffness: Arc::new(self.stiffness),
            spring_damping: Arc::new(self.damping),
            spring_rest_length: rest_length,
            spring_cut: Arc::new(vec![false; model.springs.len()]),
            external_forces: Default::default(),
            grabs: Vec::new(),
            carried: Default::default(),
        };
        Ok((model, params, State::new(self.position, self.velocity)))
    }

    /// A simulation of what was built, ready to step.
    ///
    /// # Errors
    /// As [`build`](Self::build).
    pub fn simulation(self) -> Result<Simulation> {
        let (model, params, state) = self.build()?;
        Simulation::new(model, params, state)
    }

    fn push_spring(&mut self, [i, j]: [u32; 2], material: Material) {
        self.rest_length.push(distance(self.position[i as usize], self.position[j as usize]));
        self.springs.push([i, j]);
        self.stiffness.push(material.stiffness);
        self.damping.push(material.damping);
        self.end_springs_here();
    }

    /// As [`push_spring`](Self::push_spring) with each in turn; gives the range of them all.
    fn push_springs(&mut self, mut springs: Vec<[u32; 2]>, material: Material) -> Range<usize> {
        let first = self.springs.len();
        let end = first + springs.len();
        self.rest_length.reserve_exact(springs.len());
        self.rest_length.extend(
            springs.iter().map(|&[i, j]| distance(self.position[i as usize], self.position[j as usize])),
        );
        for (list, value) in
            [(&mut self.stiffness, material.stiffness), (&mut self.damping, material.damping)]
        {
            list.reserve_exact(springs.len());
            list.resize(end, value);
        }
        if self.springs.capacity() == 0 {
            // The first springs of a model, and often all of them: no copy.
            self.springs = springs;
        } else {
            self.springs.reserve_exact(springs.len());
            self.springs.append(&mut springs);
        }
        self.end_springs_here();
        first..end
    }

    /// The springs so far belong to the last joint or body.
    fn end_springs_here(&mut self) {
        let end = self.springs.len();
        match self.joints.last_mut() {
            Some(joint) => joint.springs.end = end,
            None => self.last_body().springs.end = end,
        }
    }

    /// Points added before any body was begun belong to one called "body".
    fn ensure_body(&mut self) -> Result<()> {
        if self.bodies.is_empty() { self.begin_body("body") } else { Ok(()) }
    }

    fn last_body(&mut self) -> &mut Body {
        self.bodies.last_mut().expect("ensure_body was called")
    }

    fn check_point(&self, point: usize) -> Result<()> {
        if point < self.position.len() {
            return Ok(());
        }
        let sentence =
            format!("there is no point {point}; points are 0 to {}", self.position.len().saturating_sub(1));
        Err(Error::new(Code::NotFound, sentence))
    }

    fn spring_limit(&self) -> usize {
        self.max_springs.unwrap_or(DEFAULT_MAX_SPRINGS).min(u32::MAX as usize)
    }

    fn too_many_springs(&self) -> Error {
        let limit = self.spring_limit();
        Error::new(Code::TooLarge, format!("would make more than {limit} springs"))
            .with_fix("make the radius smaller, or allow more with max_springs")
    }
}

fn check_material(material: Material) -> Result<()> {
    check_in("stiffness", material.stiffness, &STIFFNESS_RANGE)?;
    check_in("damping", material.damping, &DAMPING_RANGE)
}
