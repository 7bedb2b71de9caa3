//! USD: the `Mesh` prims of one layer, as text, binary or in an archive that stores it, each placed by the transforms around it.
//!
//! A layer by itself: what it refers to (other layers, instances, variants) is left out with a sentence. Values at times are left
//! out, too: a mesh is as its defaults say. Units and up axis are those of the scene: metres and +Y.

mod crate_file;
mod layer;
mod lz4;
mod text;

use glam::{DMat4, DQuat, DVec3 as Vector};
use sprung::build::Mesh;
use sprung::{Code, DVec3, Error, Result};

use self::layer::{Layer, Prim};
use super::bytes::{Bytes, Order};
use super::words::quoted;
use super::{Companions, Groups, malformed};

/// USD's unit where a file does not say: centimetres.
const METRES: f64 = 0.01;

/// Longest name or word that is kept.
const LONGEST: usize = 200;

pub(super) fn read(bytes: &[u8], _: &mut Companions<'_>) -> Result<Mesh> {
    let layer = match bytes {
        [b'P', b'K', ..] => archived(bytes).and_then(layer_of)?,
        _ => layer_of(bytes)?,
    };
    Reading { layer: &layer, mesh: Mesh::default(), groups: Groups::default(), colourless: false }.read()
}

fn layer_of(bytes: &[u8]) -> Result<Layer> {
    if bytes.starts_with(b"PXR-USDC") { crate_file::read(bytes) } else { text::read(bytes) }
}

/// The first file of a `.usdz` archive, which is its scene. Such archives store their files without compression.
fn archived(bytes: &[u8]) -> Result<&[u8]> {
    let mut head = Bytes::new(bytes, Order::Little);
    head.take(6)?;
    let (flags, method) = (head.u16()?, head.u16()?);
    head.take(8)?;
    let (packed, size) = (head.u32()?, head.u32()?);
    let (name, extra) = (head.u16()?, head.u16()?);
    let name = head.take(name.into())?;
    head.take(extra.into())?;
    if method != 0 || packed != size || flags & 9 != 0 {
        return Err(Error::new(
            Code::Unsupported,
            "is an archive that compresses its files, which .usdz does not allow",
        ));
    }
    if ![&b".usda"[..], b".usdc", b".usd"].iter().any(|ending| name.ends_with(ending)) {
        return Err(malformed("is an archive that does not begin with a layer of USD"));
    }
    head.take(size as usize)
}

/// Numbers that a layer may have: compressed ones take less than a byte each.
fn budget(bytes: &[u8]) -> u64 {
    (4_000_000 + 16 * bytes.len() as u64).min(200_000_000)
}

/// Properties that meshes and their places are made of.
fn is_wanted(name: &str) -> bool {
    matches!(
        name,
        "points" | "faceVertexCounts" | "faceVertexIndices" | "primvars:displayColor" | "xformOpOrder"
    ) || matches!(name, "indices" | "orientation")
        || name.starts_with("xformOp:")
}

/// A word as it is kept.
fn shortened(word: &[u8]) -> String {
    String::from_utf8_lossy(&word[..word.len().min(LONGEST)]).into_owned()
}

struct Reading<'a> {
    layer: &'a Layer,
    mesh: Mesh,
    groups: Groups,
    colourless: bool,
}

impl Reading<'_> {
    fn read(mut self) -> Result<Mesh> {
        let layer = self.layer;
        let mut placed: Vec<Placed> = Vec::with_capacity(layer.prims.len());
        // The vertices and faces of each prim that is a mesh, for its subsets.
        let mut firsts: Vec<Option<(u32, usize)>> = vec![None; layer.prims.len()];
        let unit = self.unit()?;
        let (mut refers, mut odd) = (false, 0u64);
        for (index, prim) in layer.prims.iter().enumerate() {
            let outer = prim.parent.map_or(Placed { world: unit, is_there: true }, |parent| placed[parent]);
            let (own, left_out) = transform(prim);
            odd += left_out;
            refers |= prim.refers;
            let place = Placed { world: outer.world * own, is_there: outer.is_there && prim.kind != "class" };
            placed.push(place);
            if !place.is_there {
                continue;
            }
            if prim.kind == "Mesh" {
                firsts[index] = Some((self.mesh.positions.len() as u32, self.mesh.faces.len()));
                self.add(prim, &place.world)?;
            }
            if prim.kind == "GeomSubset"
                && let Some((_, first_face)) = prim.parent.and_then(|parent| firsts[parent])
            {
                self.add_subset(prim, first_face)?;
            }
        }
        let mut mesh = self.mesh;
        mesh.groups = self.groups.finish();
        if !mesh.colours.is_empty() {
            mesh.colours.resize(mesh.positions.len(), [1.0; 3]);
            if self.colourless {
                mesh.warnings.push(
                    "some parts have colours for each vertex and some have not; those became white"
                        .to_owned(),
                );
            }
        }
        if refers {
            mesh.warnings.push("refers to other layers or prims, which were left out".to_owned());
        }
        if odd > 0 {
            mesh.warnings
                .push(format!("has {odd} transforms of a kind that is not read, which were left out"));
        }
        if mesh.positions.is_empty() {
            let error = Error::new(Code::MissingField, "has no prim of the type Mesh with points");
            return Err(if refers { error.with_fix("export it with everything in one file") } else { error });
        }
        Ok(mesh)
    }

    /// From the file's unit and up axis to metres and +Y.
    fn unit(&self) -> Result<DMat4> {
        let metres = self.layer.metres.unwrap_or(METRES);
        if !(metres.is_finite() && metres > 0.0) {
            let sentence =
                format!("says that its unit is {metres} m, and it must be a finite number above 0");
            return Err(Error::new(Code::OutOfRange, sentence).at_field("metersPerUnit"));
        }
        let turn = match self.layer.up.as_deref() {
            Some("Z") => [Vector::X, -Vector::Z, Vector::Y],
            Some("Y") | None => [Vector::X, Vector::Y, Vector::Z],
            Some(other) => {
                let sentence = format!("is \"{}\", and must be \"Y\" or \"Z\"", quoted(other.as_bytes()));
                return Err(Error::new(Code::OutOfRange, sentence).at_field("upAxis"));
            }
        };
        let [x, y, z] = turn.map(|axis| (axis * metres).extend(0.0));
        Ok(DMat4::from_cols(x, y, z, glam::DVec4::W))
    }

    fn add(&mut self, prim: &Prim, world: &DMat4) -> Result<()> {
        let wrong = |code, sentence: String| Error::new(code, sentence).at_field(prim.name.clone());
        let Some(points) = prim.numbers("points").filter(|points| points.len() >= 3) else { return Ok(()) };
        let first = self.mesh.positions.len() as u32;
        for (vertex, place) in points.chunks_exact(3).enumerate() {
            let place = world.transform_point3(Vector::from_slice(place));
            if !place.is_finite() {
                let sentence =
                    format!("puts vertex {vertex} at {place}, and coordinates must be finite numbers");
                return Err(wrong(Code::OutOfRange, sentence));
            }
            self.mesh.positions.push(DVec3::from_array(place.to_array()));
        }
        let count = points.len() / 3;
        let indices = prim.numbers("faceVertexIndices").unwrap_or_default();
        let is_left_handed =
            prim.words("orientation").is_some_and(|words| words.iter().any(|word| word == "leftHanded"));
        let (mut rest, mut corners, mut few) = (indices, Vec::new(), 0u64);
        for &size in prim.numbers("faceVertexCounts").unwrap_or_default() {
            let size = size as usize;
            let Some((face, after)) = rest.split_at_checked(size) else {
                return Err(wrong(
                    Code::Conflict,
                    "has faces with more corners than faceVertexIndices holds".to_owned(),
                ));
            };
            rest = after;
            corners.clear();
            for &index in face {
                if !(0.0..count as f64).contains(&index) {
                    return Err(wrong(
                        Code::NotFound,
                        format!("names vertex {index}, and has the vertices 0 to {}", count - 1),
                    ));
                }
                corners.push(first + index as u32);
            }
            if is_left_handed {
                corners.reverse();
            }
            // Kept as a face without area, so that subsets count faces as the file does.
            if corners.len() < 3 {
                few += 1;
                corners.resize(3, corners.first().copied().unwrap_or(first));
            }
            self.mesh.faces.push(&corners);
        }
        if few > 0 {
            self.mesh.warnings.push(format!("has {few} faces with fewer than three corners"));
        }
        match prim.numbers("primvars:displayColor") {
            Some(colours) if colours.len() == points.len() => {
                self.mesh.colours.resize(first as usize, [1.0; 3]);
                self.mesh.colours.extend(
                    colours.chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2]].map(|channel| channel as f32)),
                );
            }
            _ => self.colourless = true,
        }
        let group = self.groups.named(&quoted(prim.name.as_bytes()));
        let vertices: Vec<u32> = (first..first + count as u32).collect();
        self.groups.extend(group, &vertices)
    }

    /// Some faces of a mesh, by number.
    fn add_subset(&mut self, prim: &Prim, first_face: usize) -> Result<()> {
        let Some(indices) = prim.numbers("indices") else { return Ok(()) };
        let mut chosen: Vec<usize> =
            indices.iter().filter(|index| **index >= 0.0).map(|&index| first_face + index as usize).collect();
        chosen.sort_unstable();
        chosen.dedup();
        let mut chosen = chosen.into_iter().peekable();
        let group = self.groups.named(&quoted(prim.name.as_bytes()));
        for (number, face) in self.mesh.faces.iter().enumerate().skip(first_face) {
            if chosen.next_if_eq(&number).is_some() {
                self.groups.extend(group, face)?;
            }
        }
        Ok(())
    }
}

#[derive(Clone, Copy)]
struct Placed {
    world: DMat4,
    is_there: bool,
}

/// Where a prim puts what is in it: its transforms in their order, and how many are of a kind that is not read.
fn transform(prim: &Prim) -> (DMat4, u64) {
    let (mut all, mut left_out) = (DMat4::IDENTITY, 0);
    for name in prim.words("xformOpOrder").unwrap_or_default() {
        let numbers = prim.numbers(name);
        let kind = name.strip_prefix("xformOp:").and_then(|rest| rest.split(':').next()).unwrap_or_default();
        // A rotation about one axis, by libm: the same bits everywhere.
        let about = |axis: usize, degrees: f64| {
            let (sin, cos) = libm::sincos(0.5 * degrees.to_radians());
            let mut q = [0.0; 4];
            (q[axis], q[3]) = (sin, cos);
            DMat4::from_quat(DQuat::from_array(q))
        };
        let own = match (kind, numbers) {
            ("translate", Some(&[x, y, z])) => Some(DMat4::from_translation(Vector::new(x, y, z))),
            ("scale", Some(&[x, y, z])) => Some(DMat4::from_scale(Vector::new(x, y, z))),
            ("rotateX", Some(&[degrees])) => Some(about(0, degrees)),
            ("rotateY", Some(&[degrees])) => Some(about(1, degrees)),
            ("rotateZ", Some(&[degrees])) => Some(about(2, degrees)),
            // About x first, then about y and z, as a column vector is turned.
            ("rotateXYZ", Some(&[x, y, z])) => Some(about(2, z) * about(1, y) * about(0, x)),
            ("transform", Some(values)) if values.len() == 16 => {
                // Rows there are columns here: USD's vectors stand left of their matrices.
                let mut columns = [0.0; 16];
                columns.copy_from_slice(values);
                Some(DMat4::from_cols_array(&columns))
            }
            ("orient", Some(&[x, y, z, w])) => Some(DMat4::from_quat(DQuat::from_xyzw(x, y, z, w))),
            _ => None,
        };
        match own {
            Some(own) => all *= own,
            None => left_out += 1,
        }
    }
    (all, left_out)
}
