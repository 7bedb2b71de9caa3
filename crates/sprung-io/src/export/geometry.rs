//! A frame becomes what is exported: vertices, triangles and springs of the chosen bodies, in the chosen axes and units.
//!
//! ```text
//! let mut geometry = Geometry::new(run, options, Springs::None)?;   // what stays the same
//! geometry.take(frame);                                             // where it is now
//! for part in geometry.parts() {
//!     write(&part.name, &geometry.positions()[part.vertices.clone()], part.faces());
//! }
//! ```
//!
//! All vertices lie in one list, part after part. The order is the bodies', and within a body its points', and it never
//! changes: vertex 7 of one frame, format or version is vertex 7 of every other that was written with the same options.
//!
//! Of a body that is shown by its surface, only the points of the surface leave: a reader of meshes may drop vertices that
//! nothing uses, and then a point cache fits the mesh no more. With springs as lines all of them are used.
//!
//! A surface that points carry along leaves as the mesh it came from: all of that mesh's vertices, in its order, so that a
//! point cache fits the artist's own file. Lines have their ends on points, which then follow in a part of their own.

use std::ops::{Range, RangeInclusive};
use std::sync::Arc;

use sprung::{Code, Error, Model, Result, Surface, SurfaceKind, SurfaceVertices, Vec3};

use super::{Frame, Options, RunInfo, Springs, Up};

/// Allowed scales, units per metre.
pub const SCALE_RANGE: RangeInclusive<f64> = 1e-6..=1e6;

/// Display colours of bodies, in turn, sRGB as `0xRRGGBB`: in exported files, and of points in pictures.
pub const BODY_COLOURS: [u32; 6] = [0x12_7a_8a, 0x76_4d_a6, 0x4c_8a_26, 0xb8_55_7c, 0x8c_6c_2c, 0x34_63_ae];
/// Display colour of springs.
pub const SPRING_COLOUR: u32 = 0x8b_95_a1;

/// A tube's cross-section, a hexagon of radius one.
const TUBE_RING: [[f32; 2]; 6] =
    [[1.0, 0.0], [0.5, ROOT_3_4], [-0.5, ROOT_3_4], [-1.0, 0.0], [-0.5, -ROOT_3_4], [0.5, -ROOT_3_4]];
/// Its corners.
const TUBE_SIDES: usize = TUBE_RING.len();
/// √3/2.
const ROOT_3_4: f32 = 0.866_025_4;
/// A tube's radius as a share of the median rest length: thick enough to be seen, and two do not touch.
const TUBE_RADIUS: f32 = 0.03;

/// One thing that is exported: a body; all springs as tubes; or points that only lines end at.
#[derive(Clone, Debug)]
pub struct Part {
    /// The body's name, or `springs`.
    pub name: String,
    /// The body, as an index into [`Model::bodies`]; none for tubes and for ends of lines.
    pub body: Option<usize>,
    /// Its vertices, as indices into [`Geometry::positions`].
    pub vertices: Range<usize>,
    /// Corners, counted from the part's first vertex, counter-clockwise seen from the front; none for points.
    pub triangles: Vec<[u32; 3]>,
    /// How many triangles each face is, as in [`Surface::fans`].
    pub fans: Vec<u32>,
    /// Whether the triangles enclose something, and need to be seen from outside only.
    pub is_closed: bool,
    /// Display colour, sRGB.
    pub colour: [u8; 3],
}

impl Part {
    /// What it is called where it has to be called something.
    pub fn label(&self) -> &str {
        if self.name.is_empty() { "points" } else { &self.name }
    }

    /// Whether it is there for lines alone: points of bodies that are themselves exported as meshes which these points carry.
    pub fn is_line_ends(&self) -> bool {
        self.body.is_none() && self.triangles.is_empty()
    }
}

/// A spring as a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// The spring, as an index into the model's.
    pub spring: usize,
    /// Its ends, as indices into [`Geometry::positions`].
    pub ends: [u32; 2],
}

/// What is exported of a run, and where it is at one frame.
#[derive(Clone, Debug)]
pub struct Geometry {
    parts: Vec<Part>,
    lines: Vec<Line>,
    /// The points of the chosen bodies, in ascending order.
    bodies: Vec<Range<usize>>,
    /// Where the vertices come from, in order, but for those of tubes.
    sources: Vec<Source>,
    model: Arc<Model>,
    /// Springs drawn as tubes: their ends as points of the model, and the radius, m.
    tubes: Option<(Vec<[u32; 2]>, f32)>,
    place: Placement,
    positions: Vec<Vec3>,
    velocities: Vec<Vec3>,
}

/// Where vertices come from.
#[derive(Clone, Debug)]
enum Source {
    /// They are all points of a body.
    All(Range<usize>),
    /// They are these points, in ascending order.
    Some(Vec<u32>),
    /// They are the weighted vertices of this surface of the model.
    Weighted(usize),
}

/// Axes and unit of the file.
#[derive(Clone, Copy, Debug)]
struct Placement {
    up: Up,
    scale: f32,
}

impl Placement {
    /// A direction in the file's axes.
    fn turn(self, v: Vec3) -> Vec3 {
        match self.up {
            Up::Y => v,
            Up::Z => Vec3::new(v.x, -v.z, v.y),
        }
    }
}

impl Geometry {
    /// Chooses what is exported. `springs` is what the format makes of [`Options::springs`].
    ///
    /// # Errors
    /// [`Code::NotFound`] for a body that there is not, listing those there are; [`Code::OutOfRange`] for the scale.
    pub fn new(run: &RunInfo, options: &Options, springs: Springs) -> Result<Self> {
        let model = &*run.model;
        if !SCALE_RANGE.contains(&options.scale) {
            let (low, high) = (SCALE_RANGE.start(), SCALE_RANGE.end());
            let sentence = format!("is {}, and must be from {low} to {high} units per metre", options.scale);
            return Err(Error::new(Code::OutOfRange, sentence).in_file("--scale"));
        }
        let mut geometry = Self {
            parts: Vec::new(),
            lines: Vec::new(),
            bodies: Vec::new(),
            sources: Vec::new(),
            model: Arc::clone(&run.model),
            tubes: None,
            place: Placement { up: options.up, scale: options.scale as f32 },
            positions: Vec::new(),
            velocities: Vec::new(),
        };
        for index in chosen(model, options.bodies.as_deref())? {
            geometry.add_body(model, index, options.points, springs == Springs::Lines);
        }
        match springs {
            Springs::None => {}
            Springs::Lines => geometry.add_lines(run),
            Springs::Tubes => geometry.add_tubes(run),
        }
        Ok(geometry)
    }

    /// What mesh files hold, and point caches that fit them: springs are left out unless they are asked for.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn of_meshes(run: &RunInfo, options: &Options) -> Result<Self> {
        Self::new(run, options, options.springs.unwrap_or(Springs::None))
    }

    /// What becomes of springs: what the user says, or else lines where a body that is exported has no surface.
    pub fn springs_or_default(run: &RunInfo, options: &Options) -> Springs {
        let is_chosen = |name: &String| options.bodies.as_ref().is_none_or(|bodies| bodies.contains(name));
        let has_surface = |body| run.model.surfaces().iter().any(|surface| surface.body == body);
        let mut bodies = run.model.bodies().iter().enumerate();
        let any_bare =
            options.points || bodies.any(|(index, body)| is_chosen(&body.name) && !has_surface(index));
        options.springs.unwrap_or(if any_bare { Springs::Lines } else { Springs::None })
    }

    /// The parts, in order; together they hold every vertex.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// The springs as lines; none unless they were asked for.
    pub fn lines(&self) -> &[Line] {
        &self.lines
    }

    /// How many vertices there are, in every frame.
    pub fn vertex_count(&self) -> usize {
        self.parts.last().map_or(0, |part| part.vertices.end)
    }

    /// How many triangles there are, in every frame.
    pub fn triangle_count(&self) -> usize {
        self.parts.iter().map(|part| part.triangles.len()).sum()
    }

    /// For each vertex, the point of the model that it is; none for a corner of a tube, and for a vertex that points carry.
    pub fn points(&self) -> impl Iterator<Item = Option<usize>> + '_ {
        let of_bodies = self.sources.iter().flat_map(|source| source.points(&self.model));
        of_bodies.chain(std::iter::repeat(None)).take(self.vertex_count())
    }

    /// All triangles, their corners as indices into [`positions`](Self::positions).
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.parts.iter().flat_map(|part| {
            let first = part.vertices.start as u32;
            part.triangles.iter().map(move |triangle| triangle.map(|corner| first + corner))
        })
    }

    /// Takes the vertices of a frame.
    pub fn take(&mut self, frame: &Frame<'_>) {
        let (points, speeds) = (&frame.snapshot.positions, &frame.snapshot.velocities);
        let Placement { scale, .. } = self.place;
        for (from, to) in [(points, &mut self.positions), (speeds, &mut self.velocities)] {
            to.clear();
            for source in &self.sources {
                match source {
                    Source::All(points) => {
                        to.extend(from[points.clone()].iter().map(|&v| self.place.turn(v) * scale));
                    }
                    Source::Some(points) => {
                        to.extend(points.iter().map(|&p| self.place.turn(from[p as usize]) * scale));
                    }
                    Source::Weighted(surface) => {
                        let vertices = self.model.surfaces()[*surface].weighted().iter();
                        to.extend(vertices.map(|vertex| self.place.turn(vertex.of(from)) * scale));
                    }
                }
            }
        }
        if let Some((tubes, radius)) = &self.tubes {
            for ends in tubes {
                let [a, b] = ends.map(|end| self.place.turn(points[end as usize]) * scale);
                self.positions.extend(tube(a, b, radius * scale));
                let speeds = ends.map(|end| self.place.turn(speeds[end as usize]) * scale);
                self.velocities.extend(speeds.iter().flat_map(|&speed| [speed; TUBE_SIDES]));
            }
        }
    }

    /// Where the vertices are, in the file's axes and unit.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// How fast they move, in the file's unit per second.
    pub fn velocities(&self) -> &[Vec3] {
        &self.velocities
    }

    /// The normal of each vertex, of length one: the mean over its triangles, weighted by their areas. Zero where there is
    /// none.
    pub fn normals(&self, normals: &mut Vec<Vec3>) {
        normals.clear();
        normals.resize(self.positions.len(), Vec3::ZERO);
        for triangle in self.triangles() {
            let [a, b, c] = triangle.map(|corner| self.positions[corner as usize]);
            let normal = (b - a).cross(c - a);
            triangle.iter().for_each(|&corner| normals[corner as usize] += normal);
        }
        // Through the largest component: the square of a small number may have few digits or none.
        let unit = |normal: Vec3| (normal / normal.abs().max_element()).normalize_or_zero();
        normals.iter_mut().for_each(|normal| *normal = unit(*normal));
    }

    /// A vector without a length in space, such as a force, in the file's axes.
    pub fn turned(&self, vector: Vec3) -> Vec3 {
        self.place.turn(vector)
    }

    fn add_body(&mut self, model: &Model, index: usize, as_points: bool, whole: bool) {
        let body = &model.bodies()[index];
        let surfaces: Vec<(usize, &Surface)> =
            model.surfaces().iter().enumerate().filter(|(_, s)| s.body == index && !as_points).collect();
        let is_weighted = |surface: &Surface| matches!(surface.vertices, SurfaceVertices::Weighted(_));
        let (weighted, plain): (Vec<_>, Vec<_>) =
            surfaces.iter().copied().partition(|(_, surface)| is_weighted(surface));
        let corners = || plain.iter().flat_map(|(_, surface)| &surface.triangles);
        let has_corners = corners().next().is_some();
        let first = body.points.start as u32;
        let mut sources = Vec::new();

        // The surface's points in ascending order, and where in that list each of the body's is.
        let mut place_of: Vec<u32> = (0..body.points.len() as u32).collect();
        if weighted.is_empty() && (whole || !has_corners) {
            sources.push(Source::All(body.points.clone()));
        } else if has_corners {
            let mut is_used = vec![false; body.points.len()];
            corners().flatten().for_each(|&corner| is_used[(corner - first) as usize] = true);
            let mut used = Vec::new();
            for point in (0..body.points.len()).filter(|&point| is_used[point]) {
                place_of[point] = used.len() as u32;
                used.push(first + point as u32);
            }
            sources.push(Source::Some(used));
        }
        let on_points = |triangle: &[u32; 3]| triangle.map(|corner| place_of[(corner - first) as usize]);
        let mut triangles: Vec<[u32; 3]> = corners().map(on_points).collect();
        let mut count = sources.iter().map(|source| source.points(model).count()).sum();
        for &(number, surface) in &weighted {
            let before = count as u32;
            let own = surface.triangles.iter();
            triangles.extend(own.map(|triangle| triangle.map(|corner| before + corner)));
            count += surface.weighted().len();
            sources.push(Source::Weighted(number));
        }
        let vertices = self.extend(count);
        self.bodies.push(body.points.clone());
        self.sources.extend(sources);
        let is_skin = |(_, surface): &(usize, &Surface)| surface.kind == SurfaceKind::Skin;
        self.parts.push(Part {
            name: body.name.clone(),
            body: Some(index),
            vertices,
            triangles,
            fans: fans_of(plain.iter().chain(&weighted).map(|(_, surface)| *surface)),
            is_closed: !surfaces.is_empty() && surfaces.iter().all(is_skin),
            colour: rgb(BODY_COLOURS[index % BODY_COLOURS.len()]),
        });
    }

    /// The range of so many more vertices.
    fn extend(&self, count: usize) -> Range<usize> {
        let start = self.vertex_count();
        start..start + count
    }

    /// The chosen body that a point belongs to, as an index into those.
    fn body_of(&self, point: usize) -> Option<usize> {
        let body = self.bodies.partition_point(|points| points.end <= point);
        self.bodies.get(body).filter(|points| points.contains(&point)).map(|_| body)
    }

    /// The springs between chosen bodies that are not cut when the run begins.
    fn springs<'a>(&'a self, run: &'a RunInfo) -> impl Iterator<Item = (usize, [u32; 2])> + 'a {
        let is_chosen = |ends: &[u32; 2]| ends.iter().all(|&end| self.body_of(end as usize).is_some());
        let springs = run.model.springs().iter().copied().enumerate();
        springs.filter(move |(spring, ends)| !run.params.spring_cut[*spring] && is_chosen(ends))
    }

    fn add_lines(&mut self, run: &RunInfo) {
        let springs: Vec<(usize, [u32; 2])> = self.springs(run).collect();
        let mut has_lines = vec![false; self.bodies.len()];
        let ends = springs.iter().flat_map(|(_, ends)| ends);
        ends.filter_map(|&end| self.body_of(end as usize)).for_each(|body| has_lines[body] = true);

        // A body's vertices are all its points, or vertices that these carry: then the points follow after all bodies.
        let start = self.vertex_count();
        let mut end = start;
        let mut first_of = vec![0; self.bodies.len()];
        let mut sources = Vec::new();
        for (body, points) in self.bodies.iter().enumerate() {
            first_of[body] = self.parts[body].vertices.start;
            if has_lines[body] && self.is_carried(body) {
                first_of[body] = end;
                end += points.len();
                sources.push(Source::All(points.clone()));
            }
        }
        let vertex_of = |point: u32| {
            let body = self.body_of(point as usize).unwrap_or(0);
            (point as usize - self.bodies[body].start + first_of[body]) as u32
        };
        self.lines =
            springs.into_iter().map(|(spring, ends)| Line { spring, ends: ends.map(vertex_of) }).collect();
        if end > start {
            self.sources.extend(sources);
            self.parts.push(Part {
                name: "springs".into(),
                body: None,
                vertices: start..end,
                triangles: Vec::new(),
                fans: Vec::new(),
                is_closed: false,
                colour: rgb(SPRING_COLOUR),
            });
        }
    }

    /// Whether a chosen body is exported as vertices that its points carry.
    fn is_carried(&self, body: usize) -> bool {
        let mut weighted = self.sources.iter().filter_map(|source| match source {
            Source::Weighted(surface) => Some(self.model.surfaces()[*surface].body),
            _ => None,
        });
        weighted.any(|index| Some(index) == self.parts[body].body)
    }

    fn add_tubes(&mut self, run: &RunInfo) {
        let ends: Vec<[u32; 2]> = self.springs(run).map(|(_, ends)| ends).collect();
        let vertices = self.extend(2 * TUBE_SIDES * ends.len());
        let triangles = (0..ends.len()).flat_map(|tube| tube_triangles((2 * TUBE_SIDES * tube) as u32));
        self.parts.push(Part {
            name: "springs".into(),
            body: None,
            vertices,
            triangles: triangles.collect(),
            fans: Vec::new(),
            is_closed: true,
            colour: rgb(SPRING_COLOUR),
        });
        self.tubes = Some((ends, tube_radius(&run.model)));
    }
}

impl Source {
    /// For each vertex the point that it is, if it is one.
    fn points<'a>(&'a self, model: &Model) -> Box<dyn Iterator<Item = Option<usize>> + 'a> {
        match self {
            Self::All(points) => Box::new(points.clone().map(Some)),
            Self::Some(points) => Box::new(points.iter().map(|&point| Some(point as usize))),
            Self::Weighted(surface) => {
                Box::new(std::iter::repeat_n(None, model.surfaces()[*surface].weighted().len()))
            }
        }
    }
}

/// The fans of surfaces, one after the other; none if all of their faces are triangles.
fn fans_of<'a>(surfaces: impl Iterator<Item = &'a Surface> + Clone) -> Vec<u32> {
    if surfaces.clone().all(|surface| surface.fans.is_empty()) {
        return Vec::new();
    }
    let of = |surface: &Surface| match surface.fans.is_empty() {
        true => vec![1; surface.triangles.len()],
        false => surface.fans.clone(),
    };
    surfaces.flat_map(of).collect()
}

/// The bodies that are exported, as indices in the model's order.
fn chosen(model: &Model, names: Option<&[String]>) -> Result<Vec<usize>> {
    let Some(names) = names else { return Ok((0..model.bodies().len()).collect()) };
    let called = |name: &String| model.bodies().iter().position(|body| body.name == *name);
    let mut bodies = names
        .iter()
        .map(|name| {
            called(name).ok_or_else(|| {
                let there: Vec<&str> = model.bodies().iter().map(|body| body.name.as_str()).collect();
                let sentence = format!("there is no body \"{name}\"; there are {}", there.join(", "));
                Error::new(Code::NotFound, sentence).in_file("--body")
            })
        })
        .collect::<Result<Vec<usize>>>()?;
    bodies.sort_unstable();
    bodies.dedup();
    Ok(bodies)
}

/// The radius of springs that are exported as tubes, m.
pub fn tube_radius(model: &Model) -> f32 {
    let mut lengths: Vec<f32> = model.spring_rest_length().iter().copied().filter(|&l| l > 0.0).collect();
    if lengths.is_empty() {
        return 0.01;
    }
    let middle = lengths.len() / 2;
    TUBE_RADIUS * *lengths.select_nth_unstable_by(middle, f32::total_cmp).1
}

/// A tube's two ends, a ring of corners each. Around which axis the rings start depends on the direction alone.
fn tube(a: Vec3, b: Vec3, radius: f32) -> impl Iterator<Item = Vec3> {
    let along = (b - a).normalize_or(Vec3::Y);
    let (u, v) = along.any_orthonormal_pair();
    let ring = move |centre: Vec3| TUBE_RING.into_iter().map(move |[x, y]| centre + radius * (x * u + y * v));
    ring(a).chain(ring(b))
}

/// The triangles of a tube whose first corner is `first`: its sides, then its two caps.
fn tube_triangles(first: u32) -> impl Iterator<Item = [u32; 3]> {
    let sides = TUBE_SIDES as u32;
    let around = (0..sides).flat_map(move |side| {
        let next = (side + 1) % sides;
        [[side, next, sides + next], [side, sides + next, sides + side]]
    });
    let caps =
        (1..sides - 1).flat_map(move |side| [[0, side + 1, side], [sides, sides + side, sides + side + 1]]);
    around.chain(caps).map(move |triangle| triangle.map(|corner| first + corner))
}

fn rgb(hex: u32) -> [u8; 3] {
    let [_, r, g, b] = hex.to_be_bytes();
    [r, g, b]
}
