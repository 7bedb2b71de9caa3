//! The library `gltf` kept from what it does not expect of a file: it counts on a file that it has found valid, but finds too few
//! of them so, as few exporters write all that is required, and takes for granted that bytes are as many as a file says.

use std::borrow::Cow;

use gltf::accessor::sparse::IndexType;
use gltf::accessor::util::{ItemIter, SparseIndicesIter};
use gltf::accessor::{DataType, Dimensions};
use gltf::json::{Path, Root, validation};
use gltf::{Accessor, Document, Glb, Primitive, Semantic, binary, buffer};
use sprung::{Code, Error, Result};
use validation::Validate;

use super::{SPARE, wrong};
use crate::import::malformed;
use crate::import::words::quoted_long;

/// Objects and list entries in what describes a file. One of three bytes may take some hundreds when it is read.
const MOST_THINGS: usize = 5_000_000;

/// The head of a binary file.
const HEAD: usize = 12;

type Buffers<'a> = [Cow<'a, [u8]>];

/// What a file describes, and the bytes that it carries. Whatever has to do with meshes names only what is there.
pub(super) fn document(bytes: &[u8]) -> Result<(Document, Option<Cow<'_, [u8]>>)> {
    let is_binary = bytes.starts_with(b"glTF");
    let (json, piece) = match is_binary {
        true => pieces(bytes).map(|glb| (glb.json, glb.bin))?,
        false => (bytes.into(), None),
    };
    if json.iter().filter(|byte| matches!(byte, b',' | b'{' | b'[')).count() > MOST_THINGS {
        return Err(Error::new(Code::TooLarge, format!("describes more than {MOST_THINGS} things")));
    }
    let mut root = Root::from_slice(&json).map_err(|error| {
        // What the reader of JSON says, without its place, which is said otherwise; in a binary file there are no lines.
        let text = error.to_string();
        let end = text.rfind(" at line ").unwrap_or(text.len());
        let refused = malformed(format!("is not valid glTF: {}", quoted_long(&text.as_bytes()[..end])));
        match is_binary || error.line() == 0 {
            true => refused,
            false => refused.at_line(error.line(), error.column().max(1)),
        }
    })?;
    // The library's check copies the bounds of positions for each part that uses them, be they as long as the file.
    for accessor in &mut root.accessors {
        (accessor.min, accessor.max) = (None, None);
    }
    // And it looks positions up before it has found that they are there.
    let key = validation::Checked::Valid(Semantic::Positions);
    for (index, mesh) in root.meshes.iter().enumerate() {
        let mut positions = mesh.primitives.iter().filter_map(|part| part.attributes.get(&key));
        if positions.any(|&accessor| root.get(accessor).is_none()) {
            return Err(wrong(Code::NotFound, "meshes", index, "has positions that are not there"));
        }
    }
    let mut found = None;
    root.validate(&root, Path::new, &mut |path, error| {
        if found.is_none() && error != validation::Error::Missing {
            found = Some((path(), error)).filter(|(path, error)| concerns_meshes(path.as_str(), *error));
        }
    });
    if let Some((Path(path), error)) = found {
        let (code, sentence) = match error {
            validation::Error::IndexOutOfBounds => (Code::NotFound, sentence_of(&path)),
            _ => (Code::OutOfRange, "has a value that glTF does not have".to_owned()),
        };
        return Err(Error::new(code, sentence).at_field(quoted_long(path.as_bytes())));
    }
    Ok((Document::from_json_without_validation(root), piece))
}

/// Whether something wrong at this place could do harm: nothing else of a file is looked at.
fn concerns_meshes(path: &str, error: validation::Error) -> bool {
    let list = path.split(['[', '.']).next().unwrap_or_default();
    let of_meshes = ["scene", "scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers"];
    let unused = [".camera", ".material", ".target", ".byteStride", ".rotation"];
    // Attributes with names that glTF does not know are invalid, and common.
    let is_name = error == validation::Error::Invalid && path.ends_with("\"]");
    of_meshes.contains(&list) && !is_name && !unused.iter().any(|ending| path.ends_with(ending))
}

/// What is said of an index that is out of range.
fn sentence_of(path: &str) -> String {
    let last = path.rsplit('.').next().unwrap_or_default();
    let what = match last.split('[').next().unwrap_or_default() {
        "nodes" | "children" => "node",
        name @ ("scene" | "mesh" | "skin" | "bufferView" | "buffer") => name,
        _ => "accessor",
    };
    format!("is {} {what} that is not there", if what == "accessor" { "an" } else { "a" })
}

/// The two pieces of a binary file.
fn pieces(bytes: &[u8]) -> Result<Glb<'_>> {
    // A length that does not even hold the head would be taken from without a check.
    let length = bytes.get(HEAD - 4..HEAD).and_then(|length| length.try_into().ok()).map(u32::from_le_bytes);
    if length.is_none_or(|length| (length as usize) < HEAD) {
        return Err(malformed("is cut short: it has no whole head of a binary glTF"));
    }
    Glb::from_slice(bytes).map_err(|error| match error {
        gltf::Error::Binary(binary::Error::Version(version)) => {
            Error::new(Code::Unsupported, format!("is a binary glTF of version {version}, and 2 is read"))
        }
        gltf::Error::Binary(binary::Error::Length { length, length_read }) => {
            malformed(format!("is cut short: it says {length} bytes after its head, and has {length_read}"))
        }
        gltf::Error::Binary(binary::Error::ChunkLength { length, length_read, .. }) => {
            malformed(format!("is cut short: it says {length} bytes in a piece, and has {length_read}"))
        }
        error => malformed(format!("is not a whole binary glTF: {error}")),
    })
}

/// The places of the vertices, of which there may be none.
pub(super) fn positions(part: &Primitive<'_>, buffers: &Buffers<'_>) -> Result<Vec<[f32; 3]>> {
    let Some(accessor) = part.get(&Semantic::Positions) else { return Ok(Vec::new()) };
    let sentence = "must be VEC3 of float32, as it is used for positions";
    let is_right = accessor.data_type() == DataType::F32 && accessor.dimensions() == Dimensions::Vec3;
    if !check(&accessor, buffers, is_right, sentence)? {
        return Ok(Vec::new());
    }
    let read = part.reader(|buffer| bytes_of(buffers, &buffer)).read_positions();
    Ok(read.map(Iterator::collect).unwrap_or_default())
}

/// The colours of the vertices, if they have some: full is 1.
pub(super) fn colours(part: &Primitive<'_>, buffers: &Buffers<'_>) -> Result<Option<Vec<[f32; 3]>>> {
    let Some(accessor) = part.get(&Semantic::Colors(0)) else { return Ok(None) };
    let sentence = "must be VEC3 or VEC4 of uint8, uint16 or float32, as it is used for colours";
    let is_right = matches!(accessor.data_type(), DataType::U8 | DataType::U16 | DataType::F32)
        && matches!(accessor.dimensions(), Dimensions::Vec3 | Dimensions::Vec4);
    if !check(&accessor, buffers, is_right, sentence)? {
        return Ok(Some(Vec::new()));
    }
    let read = part.reader(|buffer| bytes_of(buffers, &buffer)).read_colors(0);
    Ok(read.map(|read| read.into_rgb_f32().collect()))
}

/// The numbers of vertices in the order in which they make faces or lines, if it is not their own.
pub(super) fn indices(part: &Primitive<'_>, buffers: &Buffers<'_>) -> Result<Option<Vec<u32>>> {
    let Some(accessor) = part.indices() else { return Ok(None) };
    let sentence = "must be SCALAR of uint8, uint16 or uint32, as it is used for indices";
    let is_right = matches!(accessor.data_type(), DataType::U8 | DataType::U16 | DataType::U32)
        && accessor.dimensions() == Dimensions::Scalar;
    if !check(&accessor, buffers, is_right, sentence)? {
        return Ok(Some(Vec::new()));
    }
    let read = part.reader(|buffer| bytes_of(buffers, &buffer)).read_indices();
    Ok(read.map(|read| read.into_u32().collect()))
}

fn bytes_of<'a>(buffers: &'a Buffers<'_>, buffer: &buffer::Buffer<'_>) -> Option<&'a [u8]> {
    buffers.get(buffer.index()).map(|bytes| &**bytes)
}

/// Whether there is anything to read; if so, the library can read it all.
fn check(accessor: &Accessor<'_>, buffers: &Buffers<'_>, is_right: bool, sentence: &str) -> Result<bool> {
    let wrong = |code, sentence: &str| Err(wrong(code, "accessors", accessor.index(), sentence));
    if !is_right {
        return wrong(Code::WrongType, sentence);
    }
    let (count, size) = (accessor.count(), accessor.size());
    match (accessor.view(), accessor.sparse()) {
        _ if count == 0 => return Ok(false),
        (Some(view), _) => _ = entries(accessor, buffers, &view, accessor.offset(), count, size)?,
        // Zeros, of which some are then replaced.
        (None, _) if count > SPARE => {
            return wrong(Code::TooLarge, "has no bufferView and more than a million entries");
        }
        (None, Some(_)) => {}
        (None, None) => return wrong(Code::MissingField, "has neither a bufferView nor sparse entries"),
    }
    let Some(sparse) = accessor.sparse() else { return Ok(true) };
    if sparse.count() == 0 {
        return wrong(Code::OutOfRange, "says that it has no sparse entries");
    }
    let (indices, values) = (sparse.indices(), sparse.values());
    entries(accessor, buffers, &values.view(), values.offset(), sparse.count(), size)?;
    let (view, kind) = (indices.view(), indices.index_type());
    let (bytes, stride) = entries(accessor, buffers, &view, indices.offset(), sparse.count(), kind.size())?;
    let indices = match kind {
        IndexType::U8 => SparseIndicesIter::U8(ItemIter::new(bytes, stride)),
        IndexType::U16 => SparseIndicesIter::U16(ItemIter::new(bytes, stride)),
        IndexType::U32 => SparseIndicesIter::U32(ItemIter::new(bytes, stride)),
    };
    // The library passes over those that do not ascend, and those beyond the end.
    let mut least = 0;
    for index in indices.map(|index| index as usize) {
        if index < least || index >= count {
            return wrong(Code::OutOfRange, "replaces entries that are not there, or not in their order");
        }
        least = index + 1;
    }
    Ok(true)
}

/// The bytes that hold so many entries of a size, and how many there are from one to the next.
fn entries<'a>(
    accessor: &Accessor<'_>,
    buffers: &'a Buffers<'_>,
    view: &buffer::View<'_>,
    offset: usize,
    count: usize,
    size: usize,
) -> Result<(&'a [u8], usize)> {
    let end = view.offset().checked_add(view.length());
    let bytes =
        bytes_of(buffers, &view.buffer()).zip(end).and_then(|(bytes, end)| bytes.get(view.offset()..end));
    let Some(bytes) = bytes else {
        return Err(wrong(Code::NotFound, "bufferViews", view.index(), "reaches beyond its buffer"));
    };
    let stride = view.stride().unwrap_or(size);
    if stride < size {
        let sentence = format!("has a byteStride of {stride}, and entries of {size} bytes");
        return Err(wrong(Code::Conflict, "bufferViews", view.index(), &sentence));
    }
    let bytes = bytes.get(offset..).unwrap_or_default();
    let needed = count.saturating_sub(1).saturating_mul(stride).saturating_add(size);
    bytes.get(..needed).map(|bytes| (bytes, stride)).ok_or_else(|| {
        let sentence =
            format!("says that it has {count} entries, and has only {} bytes for them", bytes.len());
        wrong(Code::Conflict, "accessors", accessor.index(), &sentence)
    })
}
