//! STL: triangles, each with corners of its own. They become the same points when a body is made of them.

use sprung::build::Mesh;
use sprung::{Code, DVec3, Result};

use super::bytes::{Bytes, Order};
use super::words::{Words, quoted};
use super::{Companions, Groups, malformed};

/// Before the triangles of a binary file: a comment of 80 bytes and their number.
const HEADER: usize = 84;
/// A normal, three corners, and two bytes that some programs put a colour in.
const TRIANGLE: usize = 50;

pub(super) fn read(bytes: &[u8], _: &mut Companions<'_>) -> Result<Mesh> {
    // A binary file may well begin with "solid", too: its length tells.
    let says_text = bytes.trim_ascii_start().starts_with(b"solid");
    let is_text = says_text && !is_binary(bytes);
    if is_text { text(bytes) } else { binary(bytes) }
}

fn is_binary(bytes: &[u8]) -> bool {
    let count = bytes.get(HEADER - 4..HEADER).map(|count| Bytes::new(count, Order::Little).u32());
    let Some(Ok(count)) = count else { return false };
    (count as usize).checked_mul(TRIANGLE).is_some_and(|all| all + HEADER == bytes.len())
}

fn binary(bytes: &[u8]) -> Result<Mesh> {
    if bytes.len() < HEADER {
        return Err(malformed(
            "is neither an STL text, which begins with \"solid\", nor long enough for a binary STL",
        ));
    }
    let mut bytes = Bytes::new(bytes, Order::Little);
    bytes.take(HEADER - 4)?;
    let count = u64::from(bytes.u32()?);
    let count = bytes.check_count(count, TRIANGLE as u64, "triangles")?;
    let mut mesh = Mesh::default();
    mesh.positions.reserve_exact(3 * count);
    for triangle in 0..count {
        bytes.take(12)?;
        let first = 3 * triangle as u32;
        for _ in 0..3 {
            let place = [bytes.f32()?, bytes.f32()?, bytes.f32()?].map(f64::from);
            if !place.iter().all(|x| x.is_finite()) {
                let sentence = format!("has a corner of triangle {triangle} that is not a number");
                return Err(sprung::Error::new(Code::OutOfRange, sentence));
            }
            mesh.positions.push(DVec3::from_array(place));
        }
        bytes.take(2)?;
        mesh.faces.push(&[first, first + 1, first + 2]);
    }
    if bytes.left() > 0 {
        mesh.warnings
            .push(format!("has {} bytes after its last triangle, which were left out", bytes.left()));
    }
    Ok(mesh)
}

fn text(bytes: &[u8]) -> Result<Mesh> {
    let mut mesh = Mesh::default();
    let mut groups = Groups::default();
    let mut words = Words::new(bytes, 1);
    let (mut solid, mut corners, mut is_inside) = (None, Vec::new(), false);
    while let Some(word) = words.next() {
        match word {
            b"solid" => {
                is_inside = true;
                let name = words.rest_of_line();
                solid = (!name.is_empty()).then(|| groups.named(&quoted(name)));
            }
            b"facet" | b"outer" => {
                words.rest_of_line();
            }
            b"endsolid" => {
                is_inside = false;
                words.rest_of_line();
            }
            b"vertex" => {
                corners.push(mesh.positions.len() as u32);
                mesh.positions.push(DVec3::new(words.float("x")?, words.float("y")?, words.float("z")?));
            }
            b"endloop" => {
                if corners.len() < 3 {
                    let sentence = format!("has a face with {} corners", corners.len());
                    return Err(words.error(Code::Syntax, sentence));
                }
                mesh.faces.push(&corners);
                if let Some(group) = solid {
                    groups.extend(group, &corners)?;
                }
                corners.clear();
            }
            b"endfacet" => {}
            other => return Err(words.not_a(other, "facet, vertex or endsolid")),
        }
    }
    if !corners.is_empty() {
        return Err(words.error(Code::Syntax, "ends in the middle of a face"));
    }
    if is_inside {
        return Err(words.error(Code::Syntax, "ends before endsolid: it is cut short"));
    }
    mesh.groups = groups.finish();
    Ok(mesh)
}
