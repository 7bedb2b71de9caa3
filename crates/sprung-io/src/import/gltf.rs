//! glTF 2.0: the meshes of the default scene, each placed as its nodes say. Positions, faces, lines and the first vertex colours;
//! a group for each node that has a mesh and a name. Materials, textures, skins and animations are of no concern here.

use serde::Deserialize;
use sprung::build::Mesh;
use sprung::{Code, DVec3, Error, Result};

use super::bytes::{Bytes, Order};
use super::{Companions, Groups, malformed};

/// Nodes within nodes.
const DEEPEST: usize = 100;

/// Vertices and corners that a file may make by using its meshes several times, besides one for each of its bytes.
const SPARE: usize = 1_000_000;

/// "glTF" and the names of the two pieces of a binary file.
const MAGIC: u32 = 0x4654_6C67;
const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Document {
    #[serde(default)]
    scene: Option<usize>,
    #[serde(default)]
    scenes: Vec<Nodes>,
    #[serde(default)]
    nodes: Vec<Node>,
    #[serde(default)]
    meshes: Vec<Meshes>,
    #[serde(default)]
    accessors: Vec<Accessor>,
    #[serde(default)]
    buffer_views: Vec<View>,
    #[serde(default)]
    buffers: Vec<Buffer>,
    #[serde(default)]
    extensions_required: Vec<String>,
}

#[derive(Deserialize)]
struct Nodes {
    #[serde(default)]
    nodes: Vec<usize>,
}

#[derive(Deserialize)]
struct Node {
    name: Option<String>,
    #[serde(default)]
    children: Vec<usize>,
    mesh: Option<usize>,
    matrix: Option<[f64; 16]>,
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
    skin: Option<usize>,
}

#[derive(Deserialize)]
struct Meshes {
    name: Option<String>,
    #[serde(default)]
    primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
struct Primitive {
    attributes: Attributes,
    indices: Option<usize>,
    mode: Option<u32>,
    #[serde(default)]
    targets: Vec<serde::de::IgnoredAny>,
}

#[derive(Deserialize)]
struct Attributes {
    #[serde(rename = "POSITION")]
    position: Option<usize>,
    #[serde(rename = "COLOR_0")]
    colour: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Accessor {
    buffer_view: Option<usize>,
    #[serde(default)]
    byte_offset: usize,
    component_type: u32,
    count: usize,
    #[serde(rename = "type")]
    kind: String,
    sparse: Option<Sparse>,
}

#[derive(Deserialize)]
struct Sparse {
    count: usize,
    indices: Part,
    values: Part,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Part {
    buffer_view: usize,
    #[serde(default)]
    byte_offset: usize,
    component_type: Option<u32>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct View {
    buffer: usize,
    #[serde(default)]
    byte_offset: usize,
    byte_length: usize,
    byte_stride: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Buffer {
    uri: Option<String>,
    byte_length: usize,
}

pub(super) fn read(bytes: &[u8], companions: &mut Companions<'_>) -> Result<Mesh> {
    let (json, chunk) = if bytes.starts_with(b"glTF") { pieces(bytes)? } else { (bytes, None) };
    let document: Document = serde_json::from_slice(json).map_err(|error| {
        let sentence = format!("is not valid glTF: {}", sentence_of(&error));
        let refused = malformed(sentence);
        // In a binary file there are no lines for a person.
        if chunk.is_none() && error.line() > 0 {
            refused.at_line(error.line(), error.column().max(1))
        } else {
            refused
        }
    })?;
    if let Some(extension) = document.extensions_required.iter().find(|name| !is_harmless(name)) {
        let sentence = format!(
            "needs the extension \"{}\", which is not read",
            super::words::quoted(extension.as_bytes())
        );
        return Err(Error::new(Code::Unsupported, sentence).with_fix("export it without compression"));
    }
    let mut buffers = Vec::new();
    let mut total = bytes.len();
    for (index, buffer) in document.buffers.iter().enumerate() {
        let content = match &buffer.uri {
            None if index == 0 => chunk.unwrap_or_default().to_vec(),
            None => return Err(wrong(Code::MissingField, "buffers", index, "has no uri")),
            Some(uri) => match uri.strip_prefix("data:") {
                Some(data) => inline(data)
                    .ok_or_else(|| wrong(Code::Syntax, "buffers", index, "is not valid base64"))?,
                None => companions(&unescaped(uri))?,
            },
        };
        if content.len() < buffer.byte_length {
            let sentence = format!("says {} bytes, and has {}", buffer.byte_length, content.len());
            return Err(wrong(Code::Conflict, "buffers", index, &sentence));
        }
        // Two names may lead to one file, over and over.
        total = total.saturating_add(content.len());
        if total as u64 > super::MOST_BYTES {
            return Err(wrong(Code::TooLarge, "buffers", index, "makes more than 1 GiB in all"));
        }
        buffers.push(content);
    }
    let mut reading = Reading {
        document: &document,
        buffers,
        mesh: Mesh::default(),
        groups: Groups::default(),
        budget: SPARE + total,
        colourless: false,
        posed: false,
    };
    reading.scene()?;
    Ok(reading.finish())
}

/// The two pieces of a binary file.
fn pieces(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>)> {
    let mut bytes = Bytes::new(bytes, Order::Little);
    let (magic, version, length) = (bytes.u32()?, bytes.u32()?, bytes.u32()?);
    if magic != MAGIC || version != 2 {
        return Err(Error::new(
            Code::Unsupported,
            format!("is a binary glTF of version {version}, and 2 is read"),
        ));
    }
    // Whatever follows the length that is said is not part of the file.
    let content = bytes.take((length as usize).saturating_sub(12).min(bytes.left()))?;
    let mut content = Bytes::new(content, Order::Little);
    let mut piece = |wanted: u32| -> Result<Option<&[u8]>> {
        if content.left() == 0 {
            return Ok(None);
        }
        let (length, kind) = (content.u32()?, content.u32()?);
        let found = content.take(length as usize)?;
        Ok((kind == wanted).then_some(found))
    };
    let json = piece(JSON)?.ok_or_else(|| malformed("does not begin with a piece of JSON"))?;
    Ok((json, piece(BIN)?.or(Some(&[]))))
}

/// Extensions that say nothing of where vertices are.
fn is_harmless(name: &str) -> bool {
    name.starts_with("KHR_materials") || name == "KHR_texture_transform" || name == "KHR_lights_punctual"
}

/// What the JSON reader says, without its place, which is said otherwise.
fn sentence_of(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let end = text.rfind(" at line ").unwrap_or(text.len());
    super::words::quoted_long(&text.as_bytes()[..end])
}

fn wrong(code: Code, list: &str, index: usize, what: &str) -> Error {
    Error::new(code, what).at_field(format!("{list}[{index}]"))
}

/// The bytes of a `data:` address, after that word.
fn inline(data: &str) -> Option<Vec<u8>> {
    let (_, encoded) = data.split_once(";base64,")?;
    super::words::from_base64(encoded.as_bytes())
}

/// A path in which `%20` stands for a space and the like.
fn unescaped(uri: &str) -> String {
    let bytes = uri.as_bytes();
    let (mut plain, mut at) = (Vec::with_capacity(bytes.len()), 0);
    while at < bytes.len() {
        let code = bytes.get(at + 1..at + 3).filter(|_| bytes[at] == b'%');
        let code = code
            .and_then(|code| std::str::from_utf8(code).ok())
            .and_then(|code| u8::from_str_radix(code, 16).ok());
        plain.push(code.unwrap_or(bytes[at]));
        at += if code.is_some() { 3 } else { 1 };
    }
    String::from_utf8_lossy(&plain).into_owned()
}

/// Where a node puts its mesh: columns of a matrix, and a shift.
#[derive(Clone, Copy)]
struct Placement {
    turn: [DVec3; 3],
    shift: DVec3,
}

impl Placement {
    const NONE: Self = Self { turn: [DVec3::X, DVec3::Y, DVec3::Z], shift: DVec3::ZERO };

    fn of(node: &Node) -> Self {
        if let Some(m) = node.matrix {
            let column = |k: usize| DVec3::new(m[4 * k], m[4 * k + 1], m[4 * k + 2]);
            return Self { turn: [column(0), column(1), column(2)], shift: column(3) };
        }
        let [x, y, z, w] = node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
        let scale = node.scale.unwrap_or([1.0; 3]);
        // The rotation of a quaternion of length 1, written out.
        let turn = [
            DVec3::new(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)) * scale[0],
            DVec3::new(2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)) * scale[1],
            DVec3::new(2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)) * scale[2],
        ];
        Self { turn, shift: DVec3::from_array(node.translation.unwrap_or_default()) }
    }

    fn turned(&self, v: DVec3) -> DVec3 {
        self.turn[0] * v.x + self.turn[1] * v.y + self.turn[2] * v.z
    }

    fn place(&self, p: DVec3) -> DVec3 {
        self.turned(p) + self.shift
    }

    fn within(&self, outer: &Self) -> Self {
        Self { turn: self.turn.map(|column| outer.turned(column)), shift: outer.place(self.shift) }
    }
}

struct Reading<'a> {
    document: &'a Document,
    buffers: Vec<Vec<u8>>,
    mesh: Mesh,
    groups: Groups,
    /// Vertices and corners that may still be made.
    budget: usize,
    /// Whether something has no colour.
    colourless: bool,
    /// Whether something would be moved by a skin or by morph targets.
    posed: bool,
}

impl Reading<'_> {
    fn scene(&mut self) -> Result<()> {
        let document = self.document;
        let roots: Vec<usize> = match document.scenes.get(document.scene.unwrap_or(0)) {
            Some(scene) => scene.nodes.clone(),
            None if document.scene.is_some() => {
                return Err(Error::new(Code::NotFound, "is a scene that is not there").at_field("scene"));
            }
            None if document.nodes.is_empty() => {
                // A file of meshes alone.
                return (0..document.meshes.len())
                    .try_for_each(|mesh| self.add_mesh(mesh, None, &Placement::NONE));
            }
            None => {
                let mut is_child = vec![false; document.nodes.len()];
                for &child in document.nodes.iter().flat_map(|node| &node.children) {
                    if let Some(slot) = is_child.get_mut(child) {
                        *slot = true;
                    }
                }
                (0..document.nodes.len()).filter(|&node| !is_child[node]).collect()
            }
        };
        let mut visits = 0usize;
        // A stack of our own: nodes may lie within each other as deeply as they like, up to a limit.
        let mut waiting: Vec<(usize, usize, Placement)> =
            roots.into_iter().rev().map(|node| (node, 0, Placement::NONE)).collect();
        while let Some((index, depth, outer)) = waiting.pop() {
            let Some(node) = document.nodes.get(index) else {
                let sentence = format!("is named, and there are {} nodes", document.nodes.len());
                return Err(wrong(Code::NotFound, "nodes", index, &sentence));
            };
            visits += 1;
            // In a tree each node comes once.
            if depth > DEEPEST || visits > document.nodes.len() {
                return Err(wrong(
                    Code::Conflict,
                    "nodes",
                    index,
                    "lies within itself, or too deeply within others",
                ));
            }
            let own = Placement::of(node).within(&outer);
            if let Some(mesh) = node.mesh {
                self.posed |= node.skin.is_some();
                self.add_mesh(mesh, node.name.as_deref(), &own)?;
            }
            waiting.extend(node.children.iter().rev().map(|&child| (child, depth + 1, own)));
        }
        Ok(())
    }

    fn add_mesh(&mut self, index: usize, name: Option<&str>, placement: &Placement) -> Result<()> {
        let document = self.document;
        let Some(found) = document.meshes.get(index) else {
            let sentence = format!("is named, and there are {} meshes", document.meshes.len());
            return Err(wrong(Code::NotFound, "meshes", index, &sentence));
        };
        let name = name.or(found.name.as_deref()).filter(|name| !name.is_empty());
        for primitive in &found.primitives {
            self.posed |= !primitive.targets.is_empty();
            self.add_primitive(index, primitive, name, placement)?;
        }
        Ok(())
    }

    fn add_primitive(
        &mut self,
        mesh: usize,
        primitive: &Primitive,
        name: Option<&str>,
        placement: &Placement,
    ) -> Result<()> {
        let Some(positions) = primitive.attributes.position else { return Ok(()) };
        let positions = self.vectors(positions)?;
        let first = self.mesh.positions.len();
        let count = positions.len();
        self.spend(count, mesh)?;
        for (vertex, place) in positions.into_iter().enumerate() {
            let place = placement.place(DVec3::from_array(place));
            if !place.is_finite() {
                let sentence =
                    format!("puts vertex {vertex} at {place}, and coordinates must be finite numbers");
                return Err(wrong(Code::OutOfRange, "meshes", mesh, &sentence));
            }
            self.mesh.positions.push(place);
        }
        match primitive.attributes.colour {
            Some(colour) => {
                let colours = self.vectors(colour)?;
                if colours.len() != count {
                    return Err(wrong(
                        Code::Conflict,
                        "meshes",
                        mesh,
                        "has more or fewer colours than vertices",
                    ));
                }
                self.mesh.colours.resize(first, [1.0; 3]);
                self.mesh.colours.extend(colours.iter().map(|colour| colour.map(|channel| channel as f32)));
            }
            None => self.colourless = true,
        }
        let indices = match primitive.indices {
            Some(indices) => self.indices(indices)?,
            None => (0..count as u32).collect(),
        };
        self.spend(indices.len(), mesh)?;
        if let Some(&index) = indices.iter().find(|&&index| index as usize >= count) {
            let sentence = format!("names vertex {index} of a part that has {count}");
            return Err(wrong(Code::NotFound, "meshes", mesh, &sentence));
        }
        let corner = |index: u32| first as u32 + index;
        let faces = &mut self.mesh.faces;
        match primitive.mode.unwrap_or(4) {
            0 => {}
            1 => {
                self.mesh.lines.extend(indices.chunks_exact(2).map(|pair| [corner(pair[0]), corner(pair[1])]))
            }
            mode @ (2 | 3) => {
                self.mesh.lines.extend(indices.windows(2).map(|pair| [corner(pair[0]), corner(pair[1])]));
                if let (2, Some(&last), Some(&start)) = (mode, indices.last(), indices.first()) {
                    self.mesh.lines.push([corner(last), corner(start)]);
                }
            }
            4 => indices.chunks_exact(3).for_each(|three| faces.push(&[0, 1, 2].map(|k| corner(three[k])))),
            5 => {
                for (index, three) in indices.windows(3).enumerate() {
                    let turned = if index % 2 == 0 { [0, 1, 2] } else { [0, 2, 1] };
                    faces.push(&turned.map(|k| corner(three[k])));
                }
            }
            6 => {
                for pair in indices.windows(2).skip(1) {
                    faces.push(&[corner(indices[0]), corner(pair[0]), corner(pair[1])]);
                }
            }
            mode => {
                let sentence = format!("has the mode {mode}, and modes are 0 to 6");
                return Err(wrong(Code::OutOfRange, "meshes", mesh, &sentence));
            }
        }
        if let Some(name) = name {
            let group = self.groups.named(&super::words::quoted(name.as_bytes()));
            let vertices: Vec<u32> = (first as u32..(first + count) as u32).collect();
            self.groups.extend(group, &vertices)?;
        }
        Ok(())
    }

    fn spend(&mut self, count: usize, mesh: usize) -> Result<()> {
        match self.budget.checked_sub(count) {
            Some(left) => {
                self.budget = left;
                Ok(())
            }
            None => {
                let sentence = "is used so often that the scene would be far larger than its file";
                Err(wrong(Code::TooLarge, "meshes", mesh, sentence))
            }
        }
    }

    /// The numbers of an accessor, three of each entry: the fourth of a colour is its opacity.
    fn vectors(&mut self, index: usize) -> Result<Vec<[f64; 3]>> {
        let components = match self.accessor(index)?.kind.as_str() {
            "VEC3" => 3,
            "VEC4" => 4,
            _ => return Err(wrong(Code::WrongType, "accessors", index, "must have the type VEC3 or VEC4")),
        };
        let values = self.values(index, components)?;
        Ok(values.chunks_exact(components).map(|entry| [entry[0], entry[1], entry[2]]).collect())
    }

    fn indices(&mut self, index: usize) -> Result<Vec<u32>> {
        let accessor = self.accessor(index)?;
        if accessor.kind != "SCALAR" || !matches!(accessor.component_type, 5121 | 5123 | 5125) {
            return Err(wrong(
                Code::WrongType,
                "accessors",
                index,
                "must hold whole numbers, as it is used for indices",
            ));
        }
        // Whole numbers of at most 32 bits are exact in float64, and unsigned ones not scaled.
        let values = self.values(index, 1)?;
        Ok(values.into_iter().map(|value| value as u32).collect())
    }

    fn accessor(&self, index: usize) -> Result<&Accessor> {
        self.document.accessors.get(index).ok_or_else(|| {
            let sentence = format!("is named, and there are {} accessors", self.document.accessors.len());
            wrong(Code::NotFound, "accessors", index, &sentence)
        })
    }

    /// All numbers of an accessor. Whole ones of vectors are colours: full is 1.
    fn values(&mut self, index: usize, components: usize) -> Result<Vec<f64>> {
        let accessor = self.accessor(index)?;
        let kind = accessor.component_type;
        let width = width_of(kind)
            .ok_or_else(|| wrong(Code::WrongType, "accessors", index, "has no known componentType"))?;
        let scaled = components > 1;
        let size = width * components;
        let mut values = match accessor.buffer_view {
            Some(view) => {
                let (bytes, stride) = self.view(view, accessor.byte_offset)?;
                let stride = stride.unwrap_or(size).max(1);
                let needed = accessor
                    .count
                    .checked_sub(1)
                    .map(|count| count.saturating_mul(stride).saturating_add(size));
                if needed.is_some_and(|needed| needed > bytes.len()) {
                    let sentence = format!(
                        "says that it has {} entries, and has only {} bytes for them",
                        accessor.count,
                        bytes.len()
                    );
                    return Err(wrong(Code::Conflict, "accessors", index, &sentence));
                }
                let mut values = Vec::with_capacity(accessor.count.min(bytes.len()) * components);
                for entry in 0..accessor.count {
                    let mut entry = Bytes::new(&bytes[entry * stride..], Order::Little);
                    for _ in 0..components {
                        values.push(number(&mut entry, kind, scaled)?);
                    }
                }
                values
            }
            // Zeros, of which some are then replaced.
            None if accessor.count <= SPARE => vec![0.0; accessor.count * components],
            None => {
                return Err(wrong(
                    Code::TooLarge,
                    "accessors",
                    index,
                    "has no bufferView and more than a million entries",
                ));
            }
        };
        if let Some(sparse) = &accessor.sparse {
            let kind_of_index =
                sparse.indices.component_type.filter(|kind| matches!(kind, 5121 | 5123 | 5125));
            let kind_of_index = kind_of_index.ok_or_else(|| {
                wrong(Code::WrongType, "accessors", index, "has sparse indices of no whole type")
            })?;
            let mut indices = Bytes::new(
                self.view(sparse.indices.buffer_view, sparse.indices.byte_offset)?.0,
                Order::Little,
            );
            let mut replaced =
                Bytes::new(self.view(sparse.values.buffer_view, sparse.values.byte_offset)?.0, Order::Little);
            replaced
                .check_count(sparse.count as u64, size as u64, "sparse values")
                .map_err(|error| error.at_field(format!("accessors[{index}]")))?;
            for _ in 0..sparse.count {
                let entry = number(&mut indices, kind_of_index, false)? as usize;
                let Some(slots) = values
                    .get_mut(entry.saturating_mul(components)..)
                    .filter(|slots| slots.len() >= components)
                else {
                    return Err(wrong(
                        Code::NotFound,
                        "accessors",
                        index,
                        "replaces an entry that is not there",
                    ));
                };
                for slot in &mut slots[..components] {
                    *slot = number(&mut replaced, kind, scaled)?;
                }
            }
        }
        Ok(values)
    }

    /// The bytes of a view from an offset on, and its stride.
    fn view(&self, index: usize, offset: usize) -> Result<(&[u8], Option<usize>)> {
        let Some(view) = self.document.buffer_views.get(index) else {
            let sentence =
                format!("is named, and there are {} bufferViews", self.document.buffer_views.len());
            return Err(wrong(Code::NotFound, "bufferViews", index, &sentence));
        };
        let bytes = self.buffers.get(view.buffer).and_then(|buffer| {
            let end = view.byte_offset.checked_add(view.byte_length)?;
            buffer.get(view.byte_offset..end)?.get(offset..)
        });
        let bytes =
            bytes.ok_or_else(|| wrong(Code::NotFound, "bufferViews", index, "reaches beyond its buffer"))?;
        Ok((bytes, view.byte_stride))
    }

    fn finish(self) -> Mesh {
        let mut mesh = self.mesh;
        mesh.groups = self.groups.finish();
        if !mesh.colours.is_empty() {
            mesh.colours.resize(mesh.positions.len(), [1.0; 3]);
            if self.colourless {
                mesh.warnings
                    .push("some parts have colours and some have none; those became white".to_owned());
            }
        }
        if self.posed {
            mesh.warnings.push(
                "has a skin or morph targets, which were left out: it is taken as it was modelled".to_owned(),
            );
        }
        mesh
    }
}

fn width_of(kind: u32) -> Option<usize> {
    Some(match kind {
        5120 | 5121 => 1,
        5122 | 5123 => 2,
        5125 | 5126 => 4,
        _ => return None,
    })
}

fn number(bytes: &mut Bytes<'_>, kind: u32, scaled: bool) -> Result<f64> {
    let (value, full) = match kind {
        5120 => (f64::from(bytes.i8()?), 127.0),
        5121 => (f64::from(bytes.u8()?), 255.0),
        5122 => (f64::from(bytes.i16()?), 32767.0),
        5123 => (f64::from(bytes.u16()?), 65535.0),
        5125 => (f64::from(bytes.u32()?), 1.0),
        _ => (f64::from(bytes.f32()?), 1.0),
    };
    Ok(if scaled { value / full } else { value })
}
