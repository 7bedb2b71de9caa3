//! From a scene to model, params and first state.

use std::ops::Range;

use glam::{DMat3, DVec3, Vec3};

use super::check::{MAX_POINTS, check};
use super::choices::{Dt, Numbers, OneOrEach, Pin, PinWhere};
use super::group::Group;
use super::suggest::shortened;
use super::types::{Body, Exception, Joint, Plane, Scene, Springs};
use crate::build::{Material, Mesh, ModelBuilder};
use crate::contact;
use crate::error::{Code, Error, Result};
use crate::math::rotation;
use crate::model::Model;
use crate::params::{MAGNITUDE_RANGE, Params};
use crate::simulation::Simulation;
use crate::stability;
use crate::state::State;

/// How far each of red, green and blue may be from what a pin asks for: colours in files have 8 bits, and painted ones vary.
const SAME_COLOUR: f64 = 0.05;

impl Scene {
    /// Builds model, params and first state.
    ///
    /// # Errors
    /// Names the field, and the line where the scene was read from a text: all that [`parse`](Self::parse) checks (the
    /// fields may have been changed since), a box that holds no point, points too far out, too many springs.
    pub fn build(&self) -> Result<(Model, Params, State)> {
        self.build_within(MAX_POINTS, self.spring_limit())
    }

    /// As [`build`](Self::build), but with at most so many points and springs, whatever the scene allows: for a caller
    /// who wants a bound on work and memory.
    ///
    /// # Errors
    /// As [`build`](Self::build).
    pub fn build_within(&self, max_points: u64, max_springs: u64) -> Result<(Model, Params, State)> {
        self.built(max_points.min(MAX_POINTS), max_springs.min(self.spring_limit()))
            .map(|built| (built.model, built.params, built.state))
    }

    /// Refuses a scene whose lattices and meshes make more springs than it allows, without building it: [`build`](Self::build)
    /// does the same, but a caller may want to ask for memory before that.
    ///
    /// # Errors
    /// [`Code::TooLarge`](crate::Code::TooLarge), with the field and its line.
    pub fn check_spring_count(&self) -> Result<()> {
        let checked = Assembly::new(self, self.spring_limit()).refuse_too_many_springs();
        checked.map_err(|error| self.origin.locate(error))
    }

    /// As [`build`](Self::build), and knows which springs each group made.
    pub(super) fn build_in_groups(&self) -> Result<Built> {
        self.built(MAX_POINTS, self.spring_limit())
    }

    fn built(&self, max_points: u64, max_springs: u64) -> Result<Built> {
        let build = || {
            let remade = self.up_to_date()?;
            let scene = remade.as_ref().unwrap_or(self);
            check(scene, max_points)?;
            Assembly::new(scene, max_springs).build()
        };
        build().map_err(|error| self.origin.locate(error))
    }

    /// Builds the scene and bundles it, ready to step.
    ///
    /// # Errors
    /// As [`build`](Self::build).
    pub fn simulation(&self) -> Result<Simulation> {
        let (model, params, state) = self.build()?;
        Simulation::new(model, params, state)
    }
}

/// What a scene was built into.
pub(super) struct Built {
    pub model: Model,
    pub params: Params,
    pub state: State,
    /// The springs of each group of each body, and then of each joint, in the order of the file.
    pub groups: Vec<Range<usize>>,
}

/// A scene being built.
struct Assembly<'a> {
    scene: &'a Scene,
    max_springs: u64,
    builder: ModelBuilder,
    /// The points of each body, as it is finished.
    bodies: Vec<Range<usize>>,
    groups: Vec<Group<'a>>,
}

impl<'a> Assembly<'a> {
    fn new(scene: &'a Scene, max_springs: u64) -> Self {
        let mut builder = ModelBuilder::new();
        builder.allow_springs(usize::try_from(max_springs).unwrap_or(usize::MAX));
        Self { scene, max_springs, builder, bodies: Vec::new(), groups: Vec::new() }
    }

    fn build(mut self) -> Result<Built> {
        self.refuse_too_many_springs()?;
        let points = usize::try_from(self.scene.point_count()).unwrap_or(usize::MAX);
        self.builder.reserve(points, 0);
        let scene = self.scene;
        for (index, body) in scene.bodies.iter().enumerate() {
            self.add_body(&format!("body[{index}]"), body)?;
        }
        for (index, joint) in scene.joints.iter().enumerate() {
            self.add_joint(&format!("joint[{index}]"), joint)?;
        }

        let (model, mut params, state) = self.builder.parts()?;
        params.substeps = self.scene.substeps;
        params.gravity = vec3(self.scene.gravity);
        params.planes = self.scene.planes.iter().map(plane).collect();
        for (body, points) in self.scene.bodies.iter().zip(&self.bodies) {
            let pushed =
                body.forces.iter().map(|push| (points.start + push.point as usize, vec3(push.force)));
            params.external_forces.extend(pushed.filter(|(_, force)| *force != Vec3::ZERO));
        }
        self.groups.iter().try_for_each(|group| group.apply(&model, &mut params))?;
        params.dt = match self.scene.dt {
            Dt::Seconds(dt) => dt,
            Dt::Auto => stability::auto_dt(&model, &params).map_err(|error| error.at_field("dt"))?,
        };
        params.validate(&model)?;
        let groups = self.groups.into_iter().map(|group| group.springs).collect();
        Ok(Built { model, params, state, groups })
    }

    /// Counts the springs of lattices before any memory is asked for.
    fn refuse_too_many_springs(&self) -> Result<()> {
        let mut sum = 0u64;
        for (index, body) in self.scene.bodies.iter().enumerate() {
            sum = sum.saturating_add(body.made().map_or(0, |made| made.springs.len() as u64));
            if sum > self.max_springs {
                return Err(too_many_springs(
                    self.max_springs,
                    format!("body[{index}].{}", body.material_key()),
                ));
            }
            for (group, springs) in body.springs.iter().enumerate() {
                sum = sum.saturating_add(body.fewest_springs(springs, self.max_springs));
                if sum > self.max_springs {
                    let key = if springs.radius.is_some() { ".radius" } else { "" };
                    return Err(too_many_springs(
                        self.max_springs,
                        format!("body[{index}].springs[{group}]{key}"),
                    ));
                }
            }
        }
        Ok(())
    }

    fn add_body(&mut self, path: &str, body: &'a Body) -> Result<()> {
        let at = |error: Error| replaced(error, path);
        if let (true, Some(mesh)) = (body.waits_for_mesh(), &body.mesh) {
            let sentence = format!("is \"{}\", which has not been read", shortened(&mesh.file));
            let error = Error::new(Code::Unreadable, sentence).at_field(format!("{path}.mesh"));
            return Err(error.with_fix("open the scene's file, so that its folder is known"));
        }
        self.builder.begin_body(&body.name).map_err(at)?;
        let first = self.builder.point_count();
        let placement = Placement::new(body);
        let masses = masses(body);
        let shape = body.shape();
        let from_lattice =
            shape.iter().flat_map(|lattice| lattice.positions()).map(|p| body.shape_origin() + p);
        let explicit = body.points.iter().flatten().map(|&point| DVec3::from_array(point));
        let from_mesh = body.made().into_iter().flat_map(|made| made.points.iter().copied());
        for (index, local) in from_lattice.chain(explicit).chain(from_mesh).enumerate() {
            let position = placement.world(local);
            if !position.to_array().iter().all(|coordinate| MAGNITUDE_RANGE.contains(coordinate)) {
                let sentence =
                    format!("puts point {index} at {position} m, and coordinates must be from -1e9 to 1e9 m");
                return Err(Error::new(Code::OutOfRange, sentence).at_field(path));
            }
            let point = self.builder.add_point(position, masses.of(index) as f32).map_err(at)?;
            self.builder.set_velocity(point, vec3(body.velocity.of(index))).map_err(at)?;
        }
        let points = first..self.builder.point_count();
        for (index, pin) in body.pins.iter().enumerate() {
            self.pin(&format!("{path}.pins[{index}]"), body, &points, pin)?;
        }
        self.add_mesh(path, body, &points)?;
        for (index, springs) in body.springs.iter().enumerate() {
            self.add_springs(&format!("{path}.springs[{index}]"), body, &points, springs)?;
        }
        if let Some((kind, mut triangles)) = shape.and_then(|lattice| lattice.surface()) {
            triangles.iter_mut().flatten().for_each(|corner| *corner += first as u32);
            self.builder.add_surface(kind, triangles).map_err(at)?;
        }
        self.bodies.push(points);
        Ok(())
    }

    /// Springs and surface of a body made from a mesh.
    fn add_mesh(&mut self, path: &str, body: &'a Body, points: &Range<usize>) -> Result<()> {
        let (Some(made), Some((rest_scale, cut, except))) = (body.made(), body.mesh_springs()) else {
            return Ok(());
        };
        let key = format!("{path}.{}", body.material_key());
        let first = self.builder.spring_count();
        self.builder.reserve(0, made.springs.len());
        for spring in &made.springs {
            let [i, j] = spring.ends.map(|end| points.start + end as usize);
            let material = material(spring.stiffness, spring.damping);
            self.builder.add_spring(i, j, material).map_err(|error| self.explained(error, key.clone()))?;
        }
        self.end_group(first, rest_scale, cut, except, &key);

        let Some(surface) = &made.surface else { return Ok(()) };
        let mut triangles = surface.triangles.clone();
        match &surface.vertices {
            Some(vertices) => {
                let mut vertices = vertices.clone();
                vertices.iter_mut().for_each(|vertex| {
                    vertex.points = vertex.points.map(|point| points.start as u32 + point);
                });
                self.builder.add_weighted_surface(surface.kind, vertices, triangles)
            }
            None => {
                triangles.iter_mut().flatten().for_each(|corner| *corner += points.start as u32);
                self.builder.add_surface(surface.kind, triangles)
            }
        }
        .and_then(|()| self.builder.join_into_faces(surface.fans.clone()))
        .map_err(|error| replaced(error, &format!("{path}.mesh")))?;
        if surface.stands_for_body {
            self.builder.show_surface_alone();
        }
        Ok(())
    }

    fn pin(&mut self, path: &str, body: &Body, points: &Range<usize>, pin: &Pin) -> Result<()> {
        let chosen = pinned_by(pin, body, points, |point| self.builder.position(point));
        if chosen.is_empty() {
            let sentence = format!("contains no point of \"{}\"", body.name);
            let error =
                Error::new(Code::NotFound, sentence).with_fix("the box is in the coordinates of the world");
            return Err(error.at_field(format!("{path}.box")));
        }
        chosen
            .into_iter()
            .try_for_each(|point| self.builder.pin(point))
            .map_err(|error| replaced(error, path))
    }

    fn add_springs(
        &mut self,
        path: &str,
        body: &Body,
        points: &Range<usize>,
        springs: &'a Springs,
    ) -> Result<()> {
        let material = material(springs.stiffness, springs.damping);
        let first = self.builder.spring_count();
        let at = |error: Error| replaced(error, path);
        if let Some(radius) = springs.radius {
            let made = self.builder.connect_within(points.clone(), radius as f32, material);
            made.map_err(|error| self.explained(error, format!("{path}.radius")))?;
            if self.builder.spring_count() == first {
                let sentence = format!("is {radius} m, and no two points of the body are that near");
                return Err(Error::new(Code::NotFound, sentence).at_field(format!("{path}.radius")));
            }
        }
        if let (Some(kinds), Some(lattice)) = (&springs.kinds, body.shape()) {
            for &kind in kinds {
                self.builder.reserve(0, lattice.pair_count(kind) as usize);
                for [i, j] in lattice.pairs(kind) {
                    self.builder
                        .add_spring(points.start + i as usize, points.start + j as usize, material)
                        .map_err(at)?;
                }
            }
        }
        if let Some(pairs) = &springs.pairs {
            self.add_pairs(path, pairs, [points.start, points.start], springs.rest_length, material)?;
        }
        self.end_group(first, springs.rest_scale, &springs.cut, &springs.except, path);
        Ok(())
    }

    fn add_joint(&mut self, path: &str, joint: &'a Joint) -> Result<()> {
        let body = |name: &String| self.scene.bodies.iter().position(|body| body.name == *name);
        let (Some(a), Some(b)) = (body(&joint.between[0]), body(&joint.between[1])) else {
            return Err(Error::new(Code::NotFound, "joins a body that is not there").at_field(path));
        };
        let (a, b) = (self.bodies[a].clone(), self.bodies[b].clone());
        let material = material(joint.stiffness, joint.damping);
        self.builder.begin_joint(joint.between.join(" - "));
        let first = self.builder.spring_count();
        if let Some(radius) = joint.radius {
            let made = self.builder.connect_between(a.clone(), b.clone(), radius as f32, material);
            made.map_err(|error| self.explained(error, format!("{path}.radius")))?;
            if self.builder.spring_count() == first {
                let sentence = format!("is {radius} m, and no points of the two bodies are that near");
                return Err(Error::new(Code::NotFound, sentence).at_field(format!("{path}.radius")));
            }
        }
        if let Some(pairs) = &joint.pairs {
            self.add_pairs(path, pairs, [a.start, b.start], joint.rest_length, material)?;
        }
        self.end_group(first, joint.rest_scale, &joint.cut, &joint.except, path);
        Ok(())
    }

    fn add_pairs(
        &mut self,
        path: &str,
        pairs: &[[u32; 2]],
        starts: [usize; 2],
        rest_length: Option<f64>,
        material: Material,
    ) -> Result<()> {
        for (index, &[i, j]) in pairs.iter().enumerate() {
            let field = format!("{path}.pairs[{index}]");
            let spring = self
                .builder
                .add_spring(starts[0] + i as usize, starts[1] + j as usize, material)
                .map_err(|error| self.explained(error, field))?;
            if let Some(length) = rest_length {
                self.builder.set_rest_length(spring, length as f32).map_err(|error| replaced(error, path))?;
            }
        }
        Ok(())
    }

    /// Notes what is to be done with all springs made since `first`.
    fn end_group(
        &mut self,
        first: usize,
        rest_scale: f64,
        cut: &'a [Numbers],
        except: &'a [Exception],
        path: &str,
    ) {
        let springs = first..self.builder.spring_count();
        let rest_scale = rest_scale as f32;
        self.groups.push(Group { springs, rest_scale, cut, except, path: path.to_owned() });
    }

    fn explained(&self, error: Error, field: String) -> Error {
        match error.code() {
            Code::TooLarge => too_many_springs(self.max_springs, field),
            _ => replaced(error, &field),
        }
    }
}

/// The points that a pin holds; `position` tells where each point starts.
pub(super) fn pinned_by(
    pin: &Pin,
    body: &Body,
    points: &Range<usize>,
    position: impl Fn(usize) -> Vec3,
) -> Vec<usize> {
    match pin {
        Pin::Index(index) => vec![points.start + *index as usize],
        Pin::Side(name) => {
            let shape = body.shape();
            let side = shape.as_ref().and_then(|lattice| Some(lattice.side_points(lattice.side(name)?)));
            side.into_iter().flatten().map(|index| points.start + index as usize).collect()
        }
        Pin::Where(PinWhere { region: Some(region), .. }) => {
            let (min, max) = (vec3(region.min), vec3(region.max));
            let inside =
                |&point: &usize| position(point).cmpge(min).all() && position(point).cmple(max).all();
            points.clone().filter(inside).collect()
        }
        Pin::Where(PinWhere { nearest: Some(place), .. }) => {
            let distance =
                |&point: &usize| position(point).as_dvec3().distance_squared(DVec3::from_array(*place));
            points.clone().min_by(|a, b| distance(a).total_cmp(&distance(b))).into_iter().collect()
        }
        Pin::Where(pin) => {
            let vertices = body.read_mesh().map(|mesh| pinned_vertices(pin, mesh)).unwrap_or_default();
            let points_at = body.made().map_or(&[][..], |made| &made.point_of_vertex);
            let mut chosen: Vec<usize> =
                vertices.into_iter().map(|vertex| points.start + points_at[vertex] as usize).collect();
            chosen.sort_unstable();
            chosen.dedup();
            chosen
        }
    }
}

/// The vertices of a mesh that a pin names by group or colour.
pub(super) fn pinned_vertices(pin: &PinWhere, mesh: &Mesh) -> Vec<usize> {
    if let Some(name) = &pin.group {
        let groups = mesh.groups.iter().filter(|group| group.name == *name);
        return groups.flat_map(|group| group.vertices.iter().map(|&vertex| vertex as usize)).collect();
    }
    let Some(colour) = pin.colour else { return Vec::new() };
    let near = |found: &[f32; 3]| {
        found.iter().zip(colour).all(|(&found, wanted)| (f64::from(found) - wanted).abs() <= SAME_COLOUR)
    };
    mesh.colours.iter().enumerate().filter(|(_, found)| near(found)).map(|(vertex, _)| vertex).collect()
}

/// The mass of each point of a body, kg.
pub(super) fn masses(body: &Body) -> OneOrEach<f64> {
    if let Some(masses) = &body.point_mass {
        return masses.clone();
    }
    let of_mesh = body.made().map(|made| &made.masses).filter(|masses| !masses.is_empty());
    match (body.body_mass, of_mesh) {
        (None, None) => OneOrEach::One(1.0),
        (None, Some(masses)) => OneOrEach::Each(masses.clone()),
        (Some(total), None) => OneOrEach::One(total / body.point_count() as f64),
        (Some(total), Some(masses)) => {
            let sum: f64 = masses.iter().sum();
            OneOrEach::Each(masses.iter().map(|mass| mass / sum * total).collect())
        }
    }
}

fn too_many_springs(limit: u64, field: String) -> Error {
    Error::new(Code::TooLarge, format!("brings the scene to more than {limit} springs"))
        .with_fix("make the radius smaller or the points fewer, or allow more with max_springs at the top of the scene")
        .at_field(field)
}

/// The builder's error, with the scene's field instead of the builder's.
fn replaced(error: Error, field: &str) -> Error {
    let moved = Error::new(error.code(), error.sentence()).at_field(field);
    match error.fix() {
        Some(fix) => moved.with_fix(fix),
        None => moved,
    }
}

/// Scaled, then rotated, then moved: in float64, rounded once.
pub(super) struct Placement {
    scale: f64,
    rotation: Option<DMat3>,
    position: DVec3,
}

impl Placement {
    pub fn new(body: &Body) -> Self {
        let turned = |turn: &super::types::Rotation| {
            // Brought to a sensible length first, so that squaring it neither overflows nor vanishes.
            let axis = DVec3::from_array(turn.axis);
            rotation(axis / axis.abs().max_element(), turn.degrees)
        };
        let rotation = body.rotation.as_ref().map(turned);
        // A mesh is scaled before anything is made of it: its springs depend on its size.
        let scale = if body.mesh.is_some() { 1.0 } else { body.scale };
        Self { scale, rotation, position: DVec3::from_array(body.position) }
    }

    /// Where a point of the shape is, m.
    pub fn world(&self, local: DVec3) -> Vec3 {
        let scaled = local * self.scale;
        let turned = self.rotation.map_or(scaled, |rotation| rotation * scaled);
        (turned + self.position).as_vec3()
    }
}

pub(super) fn plane(plane: &Plane) -> contact::Plane {
    let level = || DVec3::new(0.0, plane.y.unwrap_or(0.0), 0.0);
    contact::Plane {
        point: plane.point.map_or_else(level, DVec3::from_array).as_vec3(),
        normal: plane.normal.map_or(Vec3::Y, |normal| contact::unit(DVec3::from_array(normal))),
        stiffness: plane.stiffness as f32,
        damping: plane.damping as f32,
        law: plane.law,
    }
}

fn material(stiffness: f64, damping: f64) -> Material {
    Material { stiffness: stiffness as f32, damping: damping as f32 }
}

pub(super) fn vec3(vector: [f64; 3]) -> Vec3 {
    DVec3::from_array(vector).as_vec3()
}
