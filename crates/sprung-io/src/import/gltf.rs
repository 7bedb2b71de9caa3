//! glTF 2.0, by the library `gltf`: the meshes of the default scene, each placed as its nodes say. Positions, faces, lines and
//! the first vertex colours; a group for each node that has a mesh and a name. Materials, textures, skins and animations are of
//! no concern here.

mod checked;

use std::borrow::Cow;

use glam::{DAffine3, DMat4, DQuat};
use gltf::buffer::Source;
use gltf::mesh::Mode;
use gltf::scene::Transform;
use gltf::{Document, Node, Primitive};
use sprung::build::Mesh;
use sprung::{Code, DVec3, Error, Result};

use super::words::{from_base64, quoted};
use super::{Companions, Groups};

/// Nodes within nodes.
const DEEPEST: usize = 100;

/// Vertices and corners that a file may make by using its meshes several times, besides one for each of its bytes.
const SPARE: usize = 1_000_000;

pub(super) fn read(bytes: &[u8], companions: &mut Companions<'_>) -> Result<Mesh> {
    let (document, mut piece) = checked::document(bytes)?;
    if let Some(extension) = document.extensions_required().find(|name| !is_harmless(name)) {
        let sentence = format!("needs the extension \"{}\", which is not read", quoted(extension.as_bytes()));
        return Err(Error::new(Code::Unsupported, sentence).with_fix("export it without compression"));
    }
    let mut buffers = Vec::new();
    let mut total = bytes.len();
    for buffer in document.buffers() {
        let index = buffer.index();
        let content: Cow<'_, [u8]> = match buffer.source() {
            Source::Bin if index == 0 => piece.take().unwrap_or_default(),
            Source::Bin => return Err(wrong(Code::MissingField, "buffers", index, "has no uri")),
            Source::Uri(uri) => match uri.strip_prefix("data:") {
                Some(data) => inline(data)
                    .ok_or_else(|| wrong(Code::Syntax, "buffers", index, "is not valid base64"))?
                    .into(),
                None => companions(&unescaped(uri))?.into(),
            },
        };
        if content.len() < buffer.length() {
            let sentence = format!("says {} bytes, and has {}", buffer.length(), content.len());
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
        buffers,
        mesh: Mesh::default(),
        groups: Groups::default(),
        budget: SPARE + total,
        colourless: false,
        posed: false,
    };
    reading.scene(&document)?;
    Ok(reading.finish())
}

/// Extensions that say nothing of where vertices are.
fn is_harmless(name: &str) -> bool {
    name.starts_with("KHR_materials") || name == "KHR_texture_transform" || name == "KHR_lights_punctual"
}

fn wrong(code: Code, list: &str, index: usize, what: &str) -> Error {
    Error::new(code, what).at_field(format!("{list}[{index}]"))
}

/// The bytes of a `data:` address, after that word.
fn inline(data: &str) -> Option<Vec<u8>> {
    let (_, encoded) = data.split_once(";base64,")?;
    from_base64(encoded.as_bytes())
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

/// Where a node puts its mesh.
fn placement(node: &Node<'_>) -> DAffine3 {
    match node.transform() {
        Transform::Matrix { matrix } => {
            DAffine3::from_mat4(DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from))))
        }
        Transform::Decomposed { translation, rotation, scale } => DAffine3::from_scale_rotation_translation(
            scale.map(f64::from).into(),
            DQuat::from_array(rotation.map(f64::from)),
            translation.map(f64::from).into(),
        ),
    }
}

struct Reading<'a> {
    buffers: Vec<Cow<'a, [u8]>>,
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
    fn scene(&mut self, document: &Document) -> Result<()> {
        let roots: Vec<Node<'_>> = match document.default_scene().or_else(|| document.scenes().next()) {
            Some(scene) => scene.nodes().collect(),
            None if document.nodes().len() == 0 => {
                // A file of meshes alone.
                return document
                    .meshes()
                    .try_for_each(|mesh| self.add_mesh(&mesh, None, &DAffine3::IDENTITY));
            }
            None => {
                let mut is_child = vec![false; document.nodes().len()];
                for node in document.nodes() {
                    node.children().for_each(|child| is_child[child.index()] = true);
                }
                document.nodes().filter(|node| !is_child[node.index()]).collect()
            }
        };
        let mut visits = 0usize;
        // A stack of our own: nodes may lie within each other as deeply as they like, up to a limit.
        let mut waiting: Vec<(Node<'_>, usize, DAffine3)> =
            roots.into_iter().rev().map(|node| (node, 0, DAffine3::IDENTITY)).collect();
        while let Some((node, depth, outer)) = waiting.pop() {
            visits += 1;
            // In a tree each node comes once.
            if depth > DEEPEST || visits > document.nodes().len() {
                let sentence = "lies within itself, or too deeply within others";
                return Err(wrong(Code::Conflict, "nodes", node.index(), sentence));
            }
            let own = outer * placement(&node);
            if let Some(mesh) = node.mesh() {
                self.posed |= node.skin().is_some();
                self.add_mesh(&mesh, node.name(), &own)?;
            }
            let first = waiting.len();
            waiting.extend(node.children().map(|child| (child, depth + 1, own)));
            waiting[first..].reverse();
        }
        Ok(())
    }

    fn add_mesh(&mut self, mesh: &gltf::Mesh<'_>, name: Option<&str>, placement: &DAffine3) -> Result<()> {
        let name = name.or(mesh.name()).filter(|name| !name.is_empty());
        for primitive in mesh.primitives() {
            self.posed |= primitive.morph_targets().next().is_some();
            let first = self.mesh.positions.len() as u32;
            self.add_primitive(mesh.index(), &primitive, placement)?;
            if let Some(name) = name {
                let group = self.groups.named(&quoted(name.as_bytes()));
                let vertices: Vec<u32> = (first..self.mesh.positions.len() as u32).collect();
                self.groups.extend(group, &vertices)?;
            }
        }
        Ok(())
    }

    fn add_primitive(&mut self, mesh: usize, primitive: &Primitive<'_>, placement: &DAffine3) -> Result<()> {
        let positions = checked::positions(primitive, &self.buffers)?;
        let first = self.mesh.positions.len();
        let count = positions.len();
        // Parts without vertices may be used often, too.
        self.spend(1 + count, mesh)?;
        if count == 0 {
            return Ok(());
        }
        for (vertex, place) in positions.into_iter().enumerate() {
            let place = placement.transform_point3(DVec3::from_array(place.map(f64::from)));
            if !place.is_finite() {
                let sentence =
                    format!("puts vertex {vertex} at {place}, and coordinates must be finite numbers");
                return Err(wrong(Code::OutOfRange, "meshes", mesh, &sentence));
            }
            self.mesh.positions.push(place);
        }
        match checked::colours(primitive, &self.buffers)? {
            Some(colours) if colours.len() != count => {
                let sentence = "has more or fewer colours than vertices";
                return Err(wrong(Code::Conflict, "meshes", mesh, sentence));
            }
            Some(colours) => {
                self.mesh.colours.resize(first, [1.0; 3]);
                self.mesh.colours.extend(colours);
            }
            None => self.colourless = true,
        }
        let corners = checked::indices(primitive, &self.buffers)?;
        let mut corners = corners.unwrap_or_else(|| (0..count as u32).collect());
        self.spend(corners.len(), mesh)?;
        if let Some(&index) = corners.iter().find(|&&index| index as usize >= count) {
            let sentence = format!("names vertex {index} of a part that has {count}");
            return Err(wrong(Code::NotFound, "meshes", mesh, &sentence));
        }
        corners.iter_mut().for_each(|corner| *corner += first as u32);
        self.connect(primitive.mode(), &corners);
        Ok(())
    }

    /// Adds the lines or faces that corners make in a mode.
    fn connect(&mut self, mode: Mode, corners: &[u32]) {
        let Mesh { lines, faces, .. } = &mut self.mesh;
        match mode {
            Mode::Points => {}
            Mode::Lines => lines.extend(corners.chunks_exact(2).map(|pair| [pair[0], pair[1]])),
            Mode::LineStrip => lines.extend(corners.windows(2).map(|pair| [pair[0], pair[1]])),
            Mode::LineLoop => {
                lines.extend(corners.windows(2).map(|pair| [pair[0], pair[1]]));
                if let (Some(&last), Some(&start)) = (corners.last(), corners.first()) {
                    lines.push([last, start]);
                }
            }
            Mode::Triangles => corners.chunks_exact(3).for_each(|three| faces.push(three)),
            Mode::TriangleStrip => {
                for (index, three) in corners.windows(3).enumerate() {
                    let turned = if index % 2 == 0 { [0, 1, 2] } else { [0, 2, 1] };
                    faces.push(&turned.map(|k| three[k]));
                }
            }
            Mode::TriangleFan => {
                for pair in corners.windows(2).skip(1) {
                    faces.push(&[corners[0], pair[0], pair[1]]);
                }
            }
        }
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

    fn finish(self) -> Mesh {
        let mut mesh = self.mesh;
        mesh.groups = self.groups.finish();
        if !mesh.colours.is_empty() {
            mesh.colours.resize(mesh.positions.len(), [1.0; 3]);
            if self.colourless {
                let warning = "some parts have colours and some have none; those became white";
                mesh.warnings.push(warning.to_owned());
            }
        }
        if self.posed {
            let warning = "has a skin or morph targets, which were left out: it is taken as it was modelled";
            mesh.warnings.push(warning.to_owned());
        }
        mesh
    }
}
