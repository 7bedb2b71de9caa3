//! What a `.glb` says of its data: which bytes are whose positions, normals, indices, and how they move.
//!
//! ```text
//! data: shape | shape | … | indices | times | weights
//! shape: positions of all vertices | normals of all vertices that have some
//! ```
//!
//! Names such as "accessor" are those of the glTF 2.0 specification.

use std::ops::Range;

use serde_json::{Value, json};
use sprung::Vec3;

use crate::export::colour::linear;
use crate::export::geometry::{Part, SPRING_COLOUR};
use crate::export::{Frame, Geometry, RunInfo};

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const POINTS: u32 = 0;
const LINES: u32 = 1;
const TRIANGLES: u32 = 4;

/// Bytes of a vector.
const VECTOR_BYTES: u64 = 12;
/// The most that an accessor, or a shape that is blended, takes in the description.
const ACCESSOR_TEXT_BYTES: u64 = 400;
/// The most that a mesh, its node, its material and all that there is once take, besides their names.
const MESH_TEXT_BYTES: u64 = 1000;

/// The smallest and the largest of each component.
pub type Bounds = [[f32; 3]; 2];

/// Which vertices one thing that is drawn has, in a shape.
#[derive(Clone, Debug)]
struct Drawn {
    positions: Range<usize>,
    /// Where its normals begin; there are as many as positions.
    normals: Option<usize>,
}

/// Where in a shape is what.
#[derive(Clone, Debug)]
pub struct Layout {
    drawn: Vec<Drawn>,
    /// Positions and normals.
    vectors: usize,
}

impl Layout {
    fn new(geometry: &Geometry) -> Self {
        let mut vectors = geometry.vertex_count();
        let mut drawn: Vec<Drawn> = drawn_parts(geometry)
            .map(|part| {
                let normals = (!part.triangles.is_empty()).then_some(vectors);
                vectors += if normals.is_some() { part.vertices.len() } else { 0 };
                Drawn { positions: part.vertices.clone(), normals }
            })
            .collect();
        if !geometry.lines().is_empty() {
            drawn.push(Drawn { positions: 0..geometry.vertex_count(), normals: None });
        }
        Self { drawn, vectors }
    }

    /// How many bytes a frame takes.
    pub fn frame_bytes(&self) -> u64 {
        VECTOR_BYTES * self.vectors as u64
    }

    /// The bounds of the positions of all that is drawn.
    pub fn bounds(&self, shape: &[Vec3]) -> impl Iterator<Item = Bounds> {
        let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        self.drawn.iter().map(move |drawn| {
            let positions = &shape[drawn.positions.clone()];
            let (low, high) = positions.iter().fold(start, |(low, high), p| (low.min(*p), high.max(*p)));
            [low.to_array(), high.to_array()]
        })
    }

    /// How many accessors each frame has.
    fn accessors(&self) -> u64 {
        self.drawn.iter().map(|drawn| if drawn.normals.is_some() { 2 } else { 1 }).sum()
    }
}

/// Parts that have vertices, as glTF knows no empty accessors, and are more than what lines end at.
fn drawn_parts(geometry: &Geometry) -> impl Iterator<Item = &Part> {
    geometry.parts().iter().filter(|part| !part.vertices.is_empty() && !part.is_line_ends())
}

/// A run's geometry as glTF.
pub struct Document {
    geometry: Geometry,
    pub layout: Layout,
    normals: Vec<Vec3>,
    scene: String,
    frame_time: f64,
}

impl Document {
    pub fn new(run: &RunInfo, geometry: Geometry) -> Self {
        let layout = Layout::new(&geometry);
        let (scene, frame_time) = (run.scene.clone(), run.frame_time);
        Self { geometry, layout, normals: Vec::new(), scene, frame_time }
    }

    /// Positions and normals of a frame, in their places.
    pub fn shape(&mut self, frame: &Frame<'_>) -> Vec<Vec3> {
        self.geometry.take(frame);
        let mut shape = Vec::with_capacity(self.layout.vectors);
        shape.extend_from_slice(self.geometry.positions());
        if self.geometry.triangle_count() > 0 {
            self.geometry.normals(&mut self.normals);
            for drawn in self.layout.drawn.iter().filter(|drawn| drawn.normals.is_some()) {
                // A normal has length one, also where there is none.
                let upright = |n: &Vec3| if *n == Vec3::ZERO { Vec3::Y } else { *n };
                shape.extend(self.normals[drawn.positions.clone()].iter().map(upright));
            }
        }
        shape
    }

    /// The indices of all that is drawn with some.
    fn indices(&self) -> impl Iterator<Item = Vec<u32>> + '_ {
        let parts = drawn_parts(&self.geometry).map(|part| part.triangles.as_flattened().to_vec());
        let lines: Vec<u32> = self.geometry.lines().iter().flat_map(|line| line.ends).collect();
        parts.chain([lines]).filter(|indices| !indices.is_empty())
    }

    /// The data behind the shapes.
    pub fn tail(&self, frames: u64) -> Vec<u8> {
        let mut tail: Vec<u8> = self.indices().flatten().flat_map(u32::to_le_bytes).collect();
        if frames > 1 {
            let times = (0..frames).map(|frame| (frame as f64 * self.frame_time) as f32);
            tail.extend(times.flat_map(f32::to_le_bytes));
            // Frame 0 is the mesh as it is; every other blends in its own shape and none else.
            for frame in 0..frames {
                let weights = (1..frames).map(|shape| if shape == frame { 1.0_f32 } else { 0.0 });
                tail.extend(weights.flat_map(f32::to_le_bytes));
            }
        }
        tail
    }

    /// How long [`tail`](Self::tail) is.
    pub fn tail_bytes(&self, frames: u64) -> u64 {
        let indices: usize = self.indices().map(|indices| indices.len()).sum();
        let moving = if frames > 1 { frames + frames * (frames - 1) } else { 0 };
        4 * (indices as u64 + moving)
    }

    /// How long [`text`](Self::text) is at most, with what stands around it.
    pub fn text_bytes(&self, frames: u64) -> u64 {
        let names: usize = drawn_parts(&self.geometry).map(|part| part.label().len()).sum();
        // A name may stand in four places, and a byte of it may take six.
        let names = 24 * (names + self.scene.len()) as u64;
        let meshes = 1 + self.layout.drawn.len() as u64;
        MESH_TEXT_BYTES * meshes + names + ACCESSOR_TEXT_BYTES * self.layout.accessors() * (frames + 1)
    }

    /// The description, as JSON; the shapes take `shape_bytes` in all.
    pub fn text(&self, frames: u64, bounds: &[Bounds], shape_bytes: u64) -> String {
        let mut accessors = Accessors::default();
        let tail_bytes = self.tail_bytes(frames);
        let moves = frames > 1;
        let indices_bytes = tail_bytes - if moves { 4 * frames * frames } else { 0 };

        let mut views = vec![json!({
            "buffer": 0, "byteOffset": 0, "byteLength": shape_bytes,
            "byteStride": VECTOR_BYTES, "target": ARRAY_BUFFER,
        })];
        if indices_bytes > 0 {
            views.push(json!({
                "buffer": 0, "byteOffset": shape_bytes, "byteLength": indices_bytes,
                "target": ELEMENT_ARRAY_BUFFER,
            }));
        }
        let animation_view = views.len();
        if moves {
            views.push(json!({
                "buffer": 0, "byteOffset": shape_bytes + indices_bytes,
                "byteLength": tail_bytes - indices_bytes,
            }));
        }

        let (mut meshes, mut materials, mut nodes) = (Vec::new(), Vec::new(), Vec::new());
        let mut indices_at = 0;
        for (number, drawn) in self.layout.drawn.iter().enumerate() {
            let part = drawn_parts(&self.geometry).nth(number);
            let (name, colour, mode, indices, is_closed) = match part {
                Some(part) => {
                    let mode = if part.triangles.is_empty() { POINTS } else { TRIANGLES };
                    (part.label(), part.colour, mode, 3 * part.triangles.len(), part.is_closed)
                }
                None => {
                    let [_, r, g, b] = SPRING_COLOUR.to_be_bytes();
                    ("springs", [r, g, b], LINES, 2 * self.geometry.lines().len(), true)
                }
            };
            let mut primitive = json!({
                "attributes": self.attributes(&mut accessors, number, drawn, 0, bounds),
                "material": number, "mode": mode,
            });
            if indices > 0 {
                primitive["indices"] = accessors.add(json!({
                    "bufferView": 1, "byteOffset": indices_at, "componentType": UNSIGNED_INT,
                    "count": indices, "type": "SCALAR",
                }));
                indices_at += 4 * indices;
            }
            let mut mesh = json!({ "name": name });
            if moves {
                let shapes = (1..frames as usize)
                    .map(|frame| self.attributes(&mut accessors, number, drawn, frame, bounds));
                primitive["targets"] = shapes.collect();
                mesh["weights"] = vec![0.0; frames as usize - 1].into();
                let names: Vec<String> = (1..frames).map(|frame| format!("frame {frame}")).collect();
                mesh["extras"] = json!({ "targetNames": names });
            }
            mesh["primitives"] = json!([primitive]);
            meshes.push(mesh);
            let [r, g, b] = colour.map(linear);
            materials.push(json!({
                "name": name, "doubleSided": !is_closed,
                "pbrMetallicRoughness": {
                    "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.7,
                },
            }));
            nodes.push(json!({ "name": name, "mesh": number }));
        }

        let mut document = json!({
            "asset": { "version": "2.0", "generator": concat!("sprung ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "name": self.scene, "nodes": (0..nodes.len()).collect::<Vec<_>>() }],
            "buffers": [{ "byteLength": shape_bytes + tail_bytes }],
        });
        if moves {
            let times = accessors.add(json!({
                "bufferView": animation_view, "byteOffset": 0, "componentType": FLOAT, "count": frames,
                "type": "SCALAR", "min": [0.0],
                "max": [f64::from(((frames - 1) as f64 * self.frame_time) as f32)],
            }));
            let weights = accessors.add(json!({
                "bufferView": animation_view, "byteOffset": 4 * frames, "componentType": FLOAT,
                "count": frames * (frames - 1), "type": "SCALAR",
            }));
            let channels: Vec<Value> = (0..nodes.len())
                .map(|node| json!({ "sampler": 0, "target": { "node": node, "path": "weights" } }))
                .collect();
            document["animations"] = json!([{
                "name": self.scene, "channels": channels,
                "samplers": [{ "input": times, "interpolation": "LINEAR", "output": weights }],
            }]);
        }
        document["accessors"] = accessors.0.into();
        document["bufferViews"] = views.into();
        document["materials"] = materials.into();
        document["meshes"] = meshes.into();
        document["nodes"] = nodes.into();
        document.to_string()
    }

    /// Positions and normals of one thing at one frame.
    fn attributes(
        &self,
        accessors: &mut Accessors,
        number: usize,
        drawn: &Drawn,
        frame: usize,
        bounds: &[Bounds],
    ) -> Value {
        let vectors = |start: usize| {
            let at = self.layout.frame_bytes() * frame as u64 + VECTOR_BYTES * start as u64;
            json!({
                "bufferView": 0, "byteOffset": at, "componentType": FLOAT,
                "count": drawn.positions.len(), "type": "VEC3",
            })
        };
        let mut positions = vectors(drawn.positions.start);
        let [low, high] = bounds[frame * self.layout.drawn.len() + number];
        positions["min"] = json!(low.map(f64::from));
        positions["max"] = json!(high.map(f64::from));
        let mut attributes = json!({ "POSITION": accessors.add(positions) });
        if let Some(start) = drawn.normals {
            attributes["NORMAL"] = accessors.add(vectors(start));
        }
        attributes
    }
}

/// The accessors so far.
#[derive(Default)]
struct Accessors(Vec<Value>);

impl Accessors {
    /// Adds one and gives its number.
    fn add(&mut self, accessor: Value) -> Value {
        self.0.push(accessor);
        (self.0.len() - 1).into()
    }
}
