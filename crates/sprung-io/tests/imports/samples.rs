//! The same tetrahedron in every format, and what else formats can say.

/// A tetrahedron with its corners at the origin and one along each axis, turned outwards.
pub const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
pub const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];

pub const OBJ: &str = "# one\nmtllib none.mtl\no solid\nv 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 0 0 1\nv 0 0 1 0 0 1\nvt 0 0\nvn 0 0 1\n\
g bottom\nusemtl red\nf 1/1/1 3/1/1 \\\n2/1/1\ng rest\ns 1\nf 1//1 2//1 4//1\nf -3 -2 -1\nf 1 4 3\n";

pub const PLY: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n\
0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 0 0 255\n0 0 1 0 0 255\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

pub const MSH2: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 7 \"inside\"\n$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n\
3 0 1 0\n9 0 0 1\n$EndNodes\n$Elements\n5\n1 2 2 0 1 1 3 2\n2 2 2 0 1 1 2 9\n3 2 2 0 1 2 3 9\n4 2 2 0 1 1 9 3\n5 4 2 7 1 1 2 3 9\n$EndElements\n";

pub const MSH4: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 7 \"inside\"\n$EndPhysicalNames\n$Entities\n0 0 1 1\n\
1 0 0 0 1 1 1 0 0\n1 0 0 0 1 1 1 1 7 1 1\n$EndEntities\n$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n\
$Elements\n2 5 1 5\n2 1 2 4\n1 1 3 2\n2 1 2 4\n3 2 3 4\n4 1 4 3\n3 1 4 1\n5 1 2 3 4\n$EndElements\n";

pub const VTK: &str = "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n\
CELLS 5 21\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n4 0 1 2 3\nCELL_TYPES 5\n5 5 5 5 10\nPOINT_DATA 4\nSCALARS a float\n";

pub const VTK5: &str = "# vtk DataFile Version 5.1\nby hand\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 1\n\
CELLS 6 16\nOFFSETS vtktypeint64\n0 3 6 9 12 16\nCONNECTIVITY vtktypeint64\n0 2 1 0 1 3 1 2 3 0 3 2 0 1 2 3\nCELL_TYPES 5\n5 5 5 5 10\n";

/// Text STL of the tetrahedron.
pub fn stl_text() -> String {
    let mut text = "solid tetra\n".to_owned();
    for face in FACES {
        text += " facet normal 0 0 0\n  outer loop\n";
        for corner in face {
            let [x, y, z] = CORNERS[corner as usize];
            text += &format!("   vertex {x} {y} {z:e}\n");
        }
        text += "  endloop\n endfacet\n";
    }
    text + "endsolid tetra\n"
}

/// Binary STL, with a header that begins as a text does.
pub fn stl_binary() -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes[..5].copy_from_slice(b"solid");
    bytes.extend(4u32.to_le_bytes());
    for face in FACES {
        bytes.extend([0; 12]);
        bytes.extend(face.iter().flat_map(|&corner| CORNERS[corner as usize]).flat_map(f32::to_le_bytes));
        bytes.extend([0; 2]);
    }
    bytes
}

/// Binary PLY.
pub fn ply_binary(big: bool) -> Vec<u8> {
    let name = if big { "binary_big_endian" } else { "binary_little_endian" };
    let mut bytes = format!(
        "ply\nformat {name} 1.0\nelement vertex 4\nproperty float32 x\nproperty float32 y\nproperty float32 z\n\
         property uint8 red\nproperty uint8 green\nproperty uint8 blue\nelement face 4\n\
         property list uint8 int32 vertex_index\nend_header\n"
    )
    .into_bytes();
    for (index, corner) in CORNERS.iter().enumerate() {
        bytes.extend(corner.iter().flat_map(|x| if big { x.to_be_bytes() } else { x.to_le_bytes() }));
        bytes.extend(if index < 2 { [255, 0, 0] } else { [0, 0, 255] });
    }
    for face in FACES {
        bytes.push(3);
        bytes.extend(face.iter().flat_map(|x| if big { x.to_be_bytes() } else { x.to_le_bytes() }));
    }
    bytes
}

/// VTK with big-endian numbers.
pub fn vtk_binary() -> Vec<u8> {
    let mut bytes =
        b"# vtk DataFile Version 3.0\nby hand\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n".to_vec();
    bytes.extend(CORNERS.iter().flatten().flat_map(|x| x.to_be_bytes()));
    bytes.extend(b"\nCELLS 5 21\n");
    let triangles = FACES.iter().flat_map(|&[a, b, c]| [3, a, b, c]);
    bytes.extend(triangles.chain([4, 0, 1, 2, 3]).flat_map(u32::to_be_bytes));
    bytes.extend(b"\nCELL_TYPES 5\n");
    bytes.extend([5u32, 5, 5, 5, 10].iter().flat_map(|x| x.to_be_bytes()));
    bytes.extend(b"\n");
    bytes
}

/// Binary Gmsh files, of version 2 or 4.
pub fn msh_binary(four: bool) -> Vec<u8> {
    let mut bytes = format!("$MeshFormat\n{} 1 8\n", if four { "4.1" } else { "2.2" }).into_bytes();
    bytes.extend(1i32.to_le_bytes());
    bytes.extend(b"\n$EndMeshFormat\n$PhysicalNames\n1\n3 7 \"inside\"\n$EndPhysicalNames\n");
    let int = |bytes: &mut Vec<u8>, values: &[i32]| bytes.extend(values.iter().flat_map(|x| x.to_le_bytes()));
    let size =
        |bytes: &mut Vec<u8>, values: &[u64]| bytes.extend(values.iter().flat_map(|x| x.to_le_bytes()));
    let float =
        |bytes: &mut Vec<u8>, values: &[f64]| bytes.extend(values.iter().flat_map(|x| x.to_le_bytes()));
    if four {
        bytes.extend(b"$Entities\n");
        size(&mut bytes, &[0, 0, 0, 1]);
        int(&mut bytes, &[1]);
        float(&mut bytes, &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
        size(&mut bytes, &[1]);
        int(&mut bytes, &[7]);
        size(&mut bytes, &[0]);
        bytes.extend(b"\n$EndEntities\n$Nodes\n");
        size(&mut bytes, &[1, 4, 1, 4]);
        int(&mut bytes, &[3, 1, 0]);
        size(&mut bytes, &[4, 1, 2, 3, 4]);
        CORNERS.iter().for_each(|corner| float(&mut bytes, &corner.map(f64::from)));
        bytes.extend(b"\n$EndNodes\n$Elements\n");
        size(&mut bytes, &[2, 5, 1, 5]);
        int(&mut bytes, &[2, 1, 2]);
        size(&mut bytes, &[4]);
        FACES.iter().zip(1u64..).for_each(|(&[a, b, c], tag)| {
            size(&mut bytes, &[tag, u64::from(a) + 1, u64::from(b) + 1, u64::from(c) + 1])
        });
        int(&mut bytes, &[3, 1, 4]);
        size(&mut bytes, &[1, 5, 1, 2, 3, 4]);
    } else {
        bytes.extend(b"$Nodes\n4\n");
        for (corner, tag) in CORNERS.iter().zip(1..) {
            int(&mut bytes, &[tag]);
            float(&mut bytes, &corner.map(f64::from));
        }
        bytes.extend(b"\n$EndNodes\n$Elements\n5\n");
        int(&mut bytes, &[2, 4, 2]);
        FACES.iter().zip(1..).for_each(|(&[a, b, c], tag)| {
            int(&mut bytes, &[tag, 0, 1, a as i32 + 1, b as i32 + 1, c as i32 + 1])
        });
        int(&mut bytes, &[4, 1, 2, 5, 7, 1, 1, 2, 3, 4]);
    }
    bytes.extend(b"\n$EndElements\n");
    bytes
}

/// The bytes that the glTF files refer to: positions, colours of 8 bits, indices of 16.
pub fn gltf_buffer() -> Vec<u8> {
    let mut bytes: Vec<u8> = CORNERS.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend([[255, 0, 0, 255], [255, 0, 0, 255], [0, 0, 255, 255], [0, 0, 255, 255u8]].iter().flatten());
    bytes.extend(FACES.iter().flatten().flat_map(|&x| (x as u16).to_le_bytes()));
    bytes
}

/// The text of a glTF file with its buffer at `uri`, or without one. Its node is moved up by 2.
pub fn gltf(uri: Option<&str>) -> String {
    let uri = uri.map_or(String::new(), |uri| format!("\"uri\": \"{uri}\", "));
    format!(
        r#"{{ "asset": {{ "version": "2.0" }}, "scene": 0, "scenes": [{{ "nodes": [0] }}],
  "nodes": [{{ "name": "root", "translation": [0, 1, 0], "children": [1] }},
    {{ "name": "tetra", "mesh": 0, "translation": [0, 1, 0] }}],
  "meshes": [{{ "primitives": [{{ "attributes": {{ "POSITION": 0, "COLOR_0": 1 }}, "indices": 2, "material": 0 }}] }}],
  "materials": [{{ "pbrMetallicRoughness": {{ "baseColorTexture": {{ "index": 0 }} }} }}],
  "textures": [{{ "source": 0 }}], "images": [{{ "uri": "not-there.png" }}],
  "accessors": [{{ "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" }},
    {{ "bufferView": 1, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC4" }},
    {{ "bufferView": 2, "componentType": 5123, "count": 12, "type": "SCALAR" }}],
  "bufferViews": [{{ "buffer": 0, "byteLength": 48 }}, {{ "buffer": 0, "byteOffset": 48, "byteLength": 16 }},
    {{ "buffer": 0, "byteOffset": 64, "byteLength": 24 }}],
  "buffers": [{{ {uri}"byteLength": 88 }}] }}"#
    )
}

/// The binary form.
pub fn glb() -> Vec<u8> {
    let mut json = gltf(None).into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let buffer = gltf_buffer();
    let mut bytes = b"glTF".to_vec();
    bytes.extend(2u32.to_le_bytes());
    bytes.extend((12 + 8 + json.len() as u32 + 8 + buffer.len() as u32).to_le_bytes());
    bytes.extend((json.len() as u32).to_le_bytes());
    bytes.extend(b"JSON");
    bytes.extend(json);
    bytes.extend((buffer.len() as u32).to_le_bytes());
    bytes.extend(b"BIN\0");
    bytes.extend(buffer);
    bytes
}

/// Text USD, as Pixar's library writes it.
pub const USDA: &str = r#"#usda 1.0
(
    metersPerUnit = 1
    upAxis = "Y"
)

def Xform "root"
{
    double3 xformOp:translate = (0, 1, 0)
    uniform token[] xformOpOrder = ["xformOp:translate"]

    def Mesh "tetra"
    {
        int[] faceVertexCounts = [3, 3, 3, 3]
        int[] faceVertexIndices = [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
        color3f[] primvars:displayColor = [(1, 0, 0), (1, 0, 0), (0, 0, 1), (0, 0, 1)] (
            interpolation = "vertex"
        )
        double3 xformOp:translate = (0, 1, 0)
        uniform token[] xformOpOrder = ["xformOp:translate"]

        def GeomSubset "bottom"
        {
            uniform token elementType = "face"
            uniform token familyName = ""
            int[] indices = [0]
        }
    }
}
"#;

/// The same as binary USD by the same library, in hexadecimal.
pub fn usdc() -> Vec<u8> {
    let digits: Vec<u8> =
        include_bytes!("tetra.usdc.hex").iter().copied().filter(u8::is_ascii_hexdigit).collect();
    let byte = |pair: &[u8]| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap();
    digits.chunks(2).map(byte).collect()
}

/// An archive that stores it.
pub fn usdz() -> Vec<u8> {
    let content = usdc();
    let mut bytes = b"PK\x03\x04\x0a\0\0\0\0\0\0\0\0\0".to_vec();
    bytes.extend([0; 4]);
    bytes.extend((content.len() as u32).to_le_bytes().repeat(2));
    bytes.extend([6, 0, 0, 0]);
    bytes.extend(b"a.usdc");
    bytes.extend(content);
    bytes
}

/// As VTK 9.7 writes XML: each way of writing numbers, in either order of bytes, with counts of 4 and 8 bytes; in `blocks.vtu` also
/// with fields before the geometry, and compressed in blocks of 40 bytes.
pub const VTU: &[(&str, &[u8])] = &[
    ("text.vtu", include_bytes!("vtu/text.vtu")),
    ("binary.vtu", include_bytes!("vtu/binary.vtu")),
    ("binary64.vtu", include_bytes!("vtu/binary64.vtu")),
    ("zlib.vtu", include_bytes!("vtu/zlib.vtu")),
    ("appended.vtu", include_bytes!("vtu/appended.vtu")),
    ("appended-zlib.vtu", include_bytes!("vtu/appended-zlib.vtu")),
    ("raw.vtu", include_bytes!("vtu/raw.vtu")),
    ("raw-zlib.vtu", include_bytes!("vtu/raw-zlib.vtu")),
    ("blocks.vtu", include_bytes!("vtu/blocks.vtu")),
];

/// One of every format and form: name and bytes.
pub fn all() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("a.obj", OBJ.as_bytes().to_vec()),
        ("a.ply", PLY.as_bytes().to_vec()),
        ("little.ply", ply_binary(false)),
        ("big.ply", ply_binary(true)),
        ("a.stl", stl_text().into_bytes()),
        ("binary.STL", stl_binary()),
        ("outside.gltf", gltf(Some("buf%20fer.bin")).into_bytes()),
        ("a.glb", glb()),
        ("a.usda", USDA.as_bytes().to_vec()),
        ("a.usdc", usdc()),
        ("a.usdz", usdz()),
        ("two.msh", MSH2.as_bytes().to_vec()),
        ("four.msh", MSH4.as_bytes().to_vec()),
        ("binary2.msh", msh_binary(false)),
        ("binary4.msh", msh_binary(true)),
        ("a.vtk", VTK.as_bytes().to_vec()),
        ("offsets.vtk", VTK5.as_bytes().to_vec()),
        ("binary.vtk", vtk_binary()),
    ]
    .into_iter()
    .chain(VTU.iter().map(|(name, bytes)| (*name, bytes.to_vec())))
    .collect()
}
