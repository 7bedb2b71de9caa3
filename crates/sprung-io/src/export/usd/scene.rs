//! What is exported of a run, as a layer, and the columns that its frames fill.

use std::ops::Range;

use sprung::{Result, Vec3};

use super::layer::{Attribute, Layer, Prim, Value, identifier};
use crate::export::colour::linear;
use crate::export::faces::Face;
use crate::export::geometry::{Part, SPRING_COLOUR, tube_radius};
use crate::export::{Frame, Geometry, Options, RunInfo, Up};

/// Radius of points, in radii of the tubes that springs are drawn as.
const POINT_RADIUS: f32 = 3.0;

/// Where a column's vectors come from.
#[derive(Clone, Debug)]
enum Source {
    Positions(Range<usize>),
    Velocities(Range<usize>),
    Normals(Range<usize>),
    /// The corners of a box around all of the positions, and so much more on all sides.
    Extent(Range<usize>, f32),
    /// The same at both ends of each line.
    LinePositions,
    LineVelocities,
    LineExtent(f32),
}

/// A run's geometry as columns.
pub struct Scene {
    geometry: Geometry,
    sources: Vec<Source>,
    normals: Vec<Vec3>,
    columns: Vec<Vec<[f32; 3]>>,
}

impl Scene {
    /// With the layer that says what the columns mean.
    ///
    /// # Errors
    /// As [`Geometry::new`].
    pub fn new(run: &RunInfo, options: &Options) -> Result<(Self, Layer)> {
        let springs = Geometry::springs_or_default(run, options);
        let geometry = Geometry::new(run, options, springs)?;
        let tube = tube_radius(&run.model) * options.scale as f32;
        let mut names = Vec::new();
        let mut builder = Builder { sources: Vec::new(), lengths: Vec::new() };
        let mut children = Vec::new();
        let points: Vec<Option<usize>> = geometry.points().collect();
        // Curves have points of their own, and need no others to end at.
        let shown = geometry.parts().iter().filter(|part| !part.vertices.is_empty() && !part.is_line_ends());
        for part in shown {
            let name = identifier(part.label(), &names);
            names.push(name.clone());
            let points = points[part.vertices.clone()].iter().copied().collect::<Option<Vec<_>>>();
            children.push(builder.part(part, name, points, POINT_RADIUS * tube));
        }
        if !geometry.lines().is_empty() {
            children.push(builder.curves(geometry.lines().len(), identifier("springs", &names), tube));
        }
        let layer = Layer {
            documentation: format!("{}, simulated by sprung {}", run.title, env!("CARGO_PKG_VERSION")),
            up_axis: if options.up == Up::Y { "Y" } else { "Z" },
            metres_per_unit: 1.0 / options.scale,
            rate: rate(run.frame_time),
            root: Prim {
                name: identifier(&run.scene, &[]),
                type_name: "Xform",
                display_name: run.scene.clone(),
                attributes: Vec::new(),
                children,
            },
            columns: builder.lengths,
        };
        let columns = vec![Vec::new(); layer.columns.len()];
        Ok((Self { geometry, sources: builder.sources, normals: Vec::new(), columns }, layer))
    }

    /// The columns of a frame.
    pub fn columns(&mut self, frame: &Frame<'_>) -> &[Vec<[f32; 3]>] {
        let Self { geometry, sources, normals, columns } = self;
        geometry.take(frame);
        if geometry.triangle_count() > 0 {
            geometry.normals(normals);
        }
        let (positions, velocities) = (geometry.positions(), geometry.velocities());
        for (source, column) in sources.iter().zip(columns.iter_mut()) {
            column.clear();
            let ends = || geometry.lines().iter().flat_map(|line| line.ends).map(|end| end as usize);
            match source {
                Source::Positions(range) => column.extend(arrays(&positions[range.clone()])),
                Source::Velocities(range) => column.extend(arrays(&velocities[range.clone()])),
                Source::Normals(range) => column.extend(arrays(&normals[range.clone()])),
                Source::Extent(range, margin) => {
                    column.extend(extent(positions[range.clone()].iter().copied(), *margin));
                }
                Source::LinePositions => column.extend(ends().map(|end| positions[end].to_array())),
                Source::LineVelocities => column.extend(ends().map(|end| velocities[end].to_array())),
                Source::LineExtent(margin) => {
                    column.extend(extent(ends().map(|end| positions[end]), *margin));
                }
            }
        }
        columns
    }
}

fn arrays(vectors: &[Vec3]) -> impl Iterator<Item = [f32; 3]> + '_ {
    vectors.iter().map(|vector| vector.to_array())
}

/// The lowest and highest corner.
fn extent(positions: impl Iterator<Item = Vec3>, margin: f32) -> [[f32; 3]; 2] {
    let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = positions.fold(start, |(low, high), p| (low.min(p), high.max(p)));
    [(low - margin).to_array(), (high + margin).to_array()]
}

/// Collects columns while the prims that have them are made.
struct Builder {
    sources: Vec<Source>,
    lengths: Vec<usize>,
}

impl Builder {
    fn column(&mut self, source: Source, length: usize) -> Value {
        self.sources.push(source);
        self.lengths.push(length);
        Value::Samples(self.sources.len() - 1)
    }

    /// A body: a mesh if it has triangles, points otherwise. `points` are the numbers of its points in the whole scene, if
    /// its vertices are points.
    fn part(&mut self, part: &Part, name: String, points: Option<Vec<usize>>, radius: f32) -> Prim {
        let (range, count) = (&part.vertices, part.vertices.len());
        let is_mesh = !part.triangles.is_empty();
        let margin = if is_mesh { 0.0 } else { radius };
        let mut attributes = vec![
            Attribute::varying("extent", "float3[]", self.column(Source::Extent(range.clone(), margin), 2)),
            Attribute::varying("points", "point3f[]", self.column(Source::Positions(range.clone()), count)),
            Attribute::varying(
                "velocities",
                "vector3f[]",
                self.column(Source::Velocities(range.clone()), count),
            ),
            colour(part.colour),
        ];
        if let Some(points) = points {
            let numbers = Value::Ints(points.into_iter().map(|point| point as i32).collect());
            attributes.push(Attribute::varying("primvars:point", "int[]", numbers).interpolated("vertex"));
        }
        if is_mesh {
            let corners = part.faces().flat_map(Face::corners).map(u32::cast_signed).collect();
            let counts = part.faces().map(|face| face.len() as i32).collect();
            let normals = self.column(Source::Normals(range.clone()), count);
            attributes.extend([
                Attribute::varying("normals", "normal3f[]", normals).interpolated("vertex"),
                Attribute::varying("faceVertexCounts", "int[]", Value::Ints(counts)),
                Attribute::varying("faceVertexIndices", "int[]", Value::Ints(corners)),
                Attribute::uniform("orientation", "token", Value::Token("rightHanded")),
                Attribute::uniform("subdivisionScheme", "token", Value::Token("none")),
                Attribute::uniform("doubleSided", "bool", Value::Bool(!part.is_closed)),
            ]);
        } else {
            attributes.push(widths(2.0 * radius));
        }
        let type_name = if is_mesh { "Mesh" } else { "Points" };
        Prim { name, type_name, display_name: part.label().to_owned(), attributes, children: Vec::new() }
    }

    /// All springs: each a straight curve of two points.
    fn curves(&mut self, count: usize, name: String, radius: f32) -> Prim {
        let [_, r, g, b] = SPRING_COLOUR.to_be_bytes();
        let attributes = vec![
            Attribute::varying("extent", "float3[]", self.column(Source::LineExtent(radius), 2)),
            Attribute::varying("points", "point3f[]", self.column(Source::LinePositions, 2 * count)),
            Attribute::varying("velocities", "vector3f[]", self.column(Source::LineVelocities, 2 * count)),
            colour([r, g, b]),
            Attribute::varying("curveVertexCounts", "int[]", Value::Ints(vec![2; count])),
            Attribute::uniform("type", "token", Value::Token("linear")),
            Attribute::uniform("wrap", "token", Value::Token("nonperiodic")),
            widths(2.0 * radius),
        ];
        let display_name = "springs".to_owned();
        Prim { name, type_name: "BasisCurves", display_name, attributes, children: Vec::new() }
    }
}

fn widths(width: f32) -> Attribute {
    Attribute::varying("widths", "float[]", Value::Floats(vec![width])).interpolated("constant")
}

fn colour(srgb: [u8; 3]) -> Attribute {
    let linear = Value::Vec3s(vec![srgb.map(|part| linear(part) as f32)]);
    Attribute::varying("primvars:displayColor", "color3f[]", linear).interpolated("constant")
}

/// Frames in a second; a whole number where it is one up to the rounding of the frame's time.
fn rate(frame_time: f64) -> f64 {
    let rate = 1.0 / frame_time;
    let whole = rate.round();
    if (rate - whole).abs() < 1e-9 * whole { whole } else { rate }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_of_films_are_whole() {
        let steps = 7.0;
        for fps in [24.0, 25.0, 30.0, 60.0] {
            assert_eq!(rate((1.0 / (fps * steps)) * steps), fps);
        }
        assert_eq!(rate(0.07), 1.0 / 0.07);
    }
}
