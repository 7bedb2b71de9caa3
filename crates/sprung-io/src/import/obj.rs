//! Wavefront OBJ: `v`, `f`, `l`, `g` and `o`; colours as three more numbers after a vertex. Everything else, such as
//! textures and materials, is of no concern to a mesh of points, and is not looked for.

use sprung::build::Mesh;
use sprung::{Code, DVec3, Result};

use super::words::{Words, quoted};
use super::{Companions, Groups};

/// Groups that a face may be in at once.
const MOST_NAMES: usize = 16;

pub(super) fn read(bytes: &[u8], _: &mut Companions<'_>) -> Result<Mesh> {
    let mut mesh = Mesh::default();
    let mut groups = Groups::default();
    let (mut named, mut object): (Vec<usize>, Option<usize>) = (Vec::new(), None);
    let mut corners: Vec<u32> = Vec::new();
    // A face may name a vertex that comes later; the largest number is remembered with its line, and checked in the end.
    let mut largest = (0u32, 0usize);
    let (mut curved, mut without_colour, mut few) = (0u64, false, 0u64);
    let joined;
    let bytes =
        if bytes.windows(2).any(|pair| pair == b"\\\n") || bytes.windows(3).any(|three| three == b"\\\r\n") {
            joined = join_lines(bytes);
            &joined
        } else {
            bytes
        };

    for (line, text) in (1..).zip(bytes.split(|&byte| byte == b'\n')) {
        let text = text.split(|&byte| byte == b'#').next().unwrap_or_default();
        let mut words = Words::new(text, line);
        match words.next() {
            Some(b"v") => {
                mesh.positions.push(DVec3::new(words.float("x")?, words.float("y")?, words.float("z")?));
                let mut more = Vec::new();
                while !words.rest().trim_ascii().is_empty() && more.len() < 4 {
                    more.push(words.float("a number")? as f32);
                }
                // One more is a weight for curves, three are a colour, four are both.
                if let [r, g, b] | [_, r, g, b] = more[..] {
                    mesh.colours.resize(mesh.positions.len() - 1, [1.0; 3]);
                    mesh.colours.push([r, g, b]);
                } else {
                    without_colour = true;
                }
            }
            Some(kind @ (b"f" | b"l")) => {
                corners.clear();
                while let Some(word) = words.next() {
                    let index = vertex(word, mesh.positions.len(), &words)?;
                    if index >= largest.0 {
                        largest = (index, line);
                    }
                    corners.push(index);
                }
                if kind == b"l" {
                    mesh.lines.extend(corners.windows(2).map(|pair| [pair[0], pair[1]]));
                } else if corners.len() < 3 {
                    few += 1;
                } else {
                    mesh.faces.push(&corners);
                }
                for &group in named.iter().chain(&object) {
                    groups.extend(group, &corners).map_err(|error| error.at_line(line, 1))?;
                }
            }
            Some(b"g") => {
                named.clear();
                while let Some(name) = words.next() {
                    if named.len() == MOST_NAMES {
                        let sentence = format!("puts faces into more than {MOST_NAMES} groups at once");
                        return Err(words.error(Code::TooLarge, sentence));
                    }
                    named.push(groups.named(&quoted(name)));
                }
            }
            Some(b"o") => object = Some(groups.named(&quoted(words.rest_of_line()))),
            Some(b"curv" | b"curv2" | b"surf" | b"cstype") => curved += 1,
            _ => {}
        }
    }
    if mesh.positions.is_empty() {
        return Err(super::malformed("has no vertices; is it an OBJ file?"));
    }
    let count = mesh.positions.len();
    if largest.1 > 0 && largest.0 as usize >= count {
        let sentence =
            format!("names vertex {}, and has the vertices 1 to {count}", u64::from(largest.0) + 1);
        return Err(sprung::Error::new(Code::NotFound, sentence).at_line(largest.1, 1));
    }
    if !mesh.colours.is_empty() {
        mesh.colours.resize(count, [1.0; 3]);
        if without_colour {
            mesh.warnings
                .push("some vertices have a colour and some have none; those became white".to_owned());
        }
    }
    if curved > 0 {
        mesh.warnings.push("has curves or curved surfaces, which were left out".to_owned());
    }
    if few > 0 {
        mesh.warnings.push(format!("has {few} faces with fewer than three corners, which were left out"));
    }
    mesh.groups = groups.finish();
    Ok(mesh)
}

/// A vertex as a face names it: `3`, `3/1`, `3//2` or `3/1/2`, from 1 on, or backwards from the last one with −1.
fn vertex(word: &[u8], count: usize, words: &Words<'_>) -> Result<u32> {
    let number = word.split(|&byte| byte == b'/').next().unwrap_or_default();
    let number: i64 = std::str::from_utf8(number)
        .ok()
        .and_then(|number| number.parse().ok())
        .ok_or_else(|| words.not_a(word, "a vertex's number"))?;
    let index = if number < 0 { count as i64 + number } else { number - 1 };
    u32::try_from(index).map_err(|_| {
        let sentence = format!("names vertex {number}, and has the vertices 1 to {count} so far");
        words.error(Code::NotFound, sentence)
    })
}

/// The text with lines that end in a backslash joined to the next; the lines they take are made up for by empty ones.
fn join_lines(text: &[u8]) -> Vec<u8> {
    let mut joined = Vec::with_capacity(text.len());
    let mut owed = 0;
    for line in text.split_inclusive(|&byte| byte == b'\n') {
        let content = line.trim_ascii_end();
        if let (Some(start), true) = (content.strip_suffix(b"\\"), line.ends_with(b"\n")) {
            joined.extend_from_slice(start);
            joined.push(b' ');
            owed += 1;
        } else {
            joined.extend_from_slice(line);
            joined.resize(joined.len() + owed, b'\n');
            owed = 0;
        }
    }
    joined
}
