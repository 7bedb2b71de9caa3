//! Every kind of broken file, and the sentence it gets.

use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use sprung_io::import::read_mesh;

use crate::formats::companion;
use crate::samples;

/// The endings that are read, as sentences list them.
macro_rules! endings {
    () => {
        ".obj, .ply, .stl, .gltf, .glb, .usd, .usda, .usdc, .usdz, .msh, .vtk, .vtu"
    };
}

/// A glTF that says so much.
macro_rules! gltf {
    ($said:expr) => {
        concat!("{\"asset\": {\"version\": \"2.0\"}, ", $said, "}")
    };
}

/// One whose only part has the positions of an accessor.
macro_rules! accessed {
    ($accessor:literal) => {
        accessed!("", $accessor)
    };
    ($more:expr, $accessor:expr) => {
        gltf!(concat!(
            "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}], ",
            $more,
            "\"accessors\": [{",
            $accessor,
            "}]"
        ))
    };
}

/// One whose accessor has a view of a buffer of 88 bytes.
macro_rules! viewed {
    ($view:literal, $accessor:literal) => {
        accessed!(
            concat!(
                "\"buffers\": [{\"uri\": \"buf%20fer.bin\", \"byteLength\": 88}], \"bufferViews\": [{\"buffer\": 0, ",
                $view,
                "}], "
            ),
            concat!("\"bufferView\": 0, \"componentType\": 5126, \"type\": \"VEC3\", ", $accessor)
        )
    };
}

/// A Gmsh text of version 2.2 that goes on so.
macro_rules! msh {
    ($sections:literal) => {
        concat!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", $sections)
    };
}

/// A VTK XML file with these attributes, and this in its grid.
macro_rules! vtu {
    ($attributes:literal, $grid:expr) => {
        concat!(
            "<VTKFile type=\"UnstructuredGrid\" ",
            $attributes,
            ">\n<UnstructuredGrid>",
            $grid,
            "</UnstructuredGrid>\n</VTKFile>\n"
        )
    };
}

/// One of a point, whose places are an array of such a form.
macro_rules! pointed {
    ($attributes:literal, $array:literal, $content:literal) => {
        vtu!(
            $attributes,
            concat!(
                "<Piece NumberOfPoints=\"1\" NumberOfCells=\"0\">\n<Points>\n<DataArray type=\"Float32\" ",
                "NumberOfComponents=\"3\" ",
                $array,
                ">",
                $content,
                "</DataArray></Points></Piece>"
            )
        )
    };
}

/// One of a point and a cell.
macro_rules! celled {
    ($offsets:literal, $corners:literal) => {
        vtu!(
            "",
            concat!(
                "<Piece NumberOfPoints=\"1\" NumberOfCells=\"1\"><Points><DataArray type=\"Int8\" ",
                "NumberOfComponents=\"3\" format=\"ascii\">0 0 0</DataArray></Points>\n<Cells>",
                "<DataArray type=\"Int8\" Name=\"offsets\" format=\"ascii\">",
                $offsets,
                "</DataArray><DataArray type=\"Int8\" Name=\"connectivity\" format=\"ascii\">",
                $corners,
                "</DataArray></Cells></Piece>"
            )
        )
    };
}

/// (file, what it says, the sentence)
const BROKEN: &[(&str, &str, &str)] = &[
    ("a.fbx", "", concat!("a.fbx: is not a mesh file that can be read; meshes are read from ", endings!())),
    (
        "a.object",
        "",
        concat!("a.object: is not a mesh file that can be read; meshes are read from ", endings!()),
    ),
    (
        "a.obk",
        "",
        concat!(
            "a.obk: is not a mesh file that can be read; meshes are read from ",
            endings!(),
            "; did you mean .obj?"
        ),
    ),
    ("mesh", "", concat!("mesh: has no ending that tells its format; meshes are read from ", endings!())),
    ("a.obj", "", "a.obj: has no vertices; is it an OBJ file?"),
    ("a.obj", "v 0 0\n", "a.obj:1:1: ends where z must be"),
    ("a.obj", "v 0 0 0\nv 0 nan 0\n", "a.obj:2:1: has \"nan\" where y must be"),
    ("a.obj", "v 0 0 1e999\n", "a.obj:1:1: has \"1e999\" where z must be"),
    ("a.obj", "v 0 0 0\nf 1 2 3\n", "a.obj:2:1: names vertex 3, and has the vertices 1 to 1"),
    ("a.obj", "v 0 0 0\nf 1 0 1\n", "a.obj:2:1: names vertex 0, and has the vertices 1 to 1 so far"),
    ("a.obj", "v 0 0 0\nf 1 -2 1\n", "a.obj:2:1: names vertex -2, and has the vertices 1 to 1 so far"),
    ("a.obj", "v 0 0 0\nf 1 x 1\n", "a.obj:2:1: has \"x\" where a vertex's number must be"),
    (
        "a.obj",
        "v 0 0 0\nf 1 99999999999 1\n",
        "a.obj:2:1: names vertex 99999999999, and has the vertices 1 to 1 so far",
    ),
    ("a.ply", "plu", "a.ply: does not begin with \"ply\"; is it a PLY file?"),
    (
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n",
        "a.ply: says that it has 4000000000 \"vertex\", and has only 6 bytes for them",
    ),
    (
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 nan\n",
        "a.ply:8:1: puts vertex 0 at [0, 0, NaN], and coordinates must be finite numbers",
    ),
    (
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
        "a.ply:7:1: has vertices without x, y or z",
    ),
    (
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n3 0 0 7\n",
        "a.ply: names vertex 7, and has the vertices 0 to 0",
    ),
    ("a.ply", "ply\nelement vertex 1\nend_header\n", "a.ply:4:1: says no format"),
    (
        "a.stl",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0\n",
        "a.stl:6:1: ends where z must be",
    ),
    ("a.stl", "solid a\nfacet\nouter loop\nvertex 0 0 0\nendloop\n", "a.stl:5:1: has a face with 1 corners"),
    (
        "a.stl",
        "solid a\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n",
        "a.stl:9:1: ends before endsolid: it is cut short",
    ),
    (
        "a.stl",
        "not one",
        "a.stl: is neither an STL text, which begins with \"solid\", nor long enough for a binary STL",
    ),
    ("a.gltf", "{", "a.gltf:1:1: is not valid glTF: EOF while parsing an object"),
    ("a.gltf", gltf!("\"scene\": 3"), "a.gltf: scene: is a scene that is not there"),
    (
        "a.gltf",
        gltf!("\"scenes\": [{\"nodes\": [0]}], \"nodes\": [{\"children\": [0]}]"),
        "a.gltf: nodes[0]: lies within itself, or too deeply within others",
    ),
    (
        "a.gltf",
        gltf!("\"scenes\": [{\"nodes\": [0]}], \"nodes\": [{\"mesh\": 1}]"),
        "a.gltf: nodes[0].mesh: is a mesh that is not there",
    ),
    (
        "a.gltf",
        gltf!("\"buffers\": [{\"uri\": \"gone.bin\", \"byteLength\": 3}]"),
        "gone.bin: there is no such file",
    ),
    (
        "a.gltf",
        gltf!("\"buffers\": [{\"uri\": \"data:;base64,AAA=\", \"byteLength\": 3}]"),
        "a.gltf: buffers[0]: says 3 bytes, and has 2",
    ),
    (
        "a.gltf",
        gltf!("\"extensionsRequired\": [\"KHR_draco_mesh_compression\"]"),
        "a.gltf: needs the extension \"KHR_draco_mesh_compression\", which is not read; export it without compression",
    ),
    (
        "a.gltf",
        accessed!("\"componentType\": 5126, \"count\": 4000000000, \"type\": \"VEC3\""),
        "a.gltf: accessors[0]: has no bufferView and more than a million entries",
    ),
    ("a.gltf", "{}", "a.gltf:1:2: is not valid glTF: missing field `asset`"),
    (
        "a.gltf",
        gltf!("\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 9}}]}]"),
        "a.gltf: meshes[0]: has positions that are not there",
    ),
    (
        "a.gltf",
        gltf!("\"meshes\": [{\"primitives\": [{\"attributes\": {}, \"mode\": 9}]}]"),
        "a.gltf: meshes[0].primitives[0].mode: has a value that glTF does not have",
    ),
    (
        "a.gltf",
        accessed!("\"componentType\": 5121, \"count\": 1, \"type\": \"VEC3\""),
        "a.gltf: accessors[0]: must be VEC3 of float32, as it is used for positions",
    ),
    (
        "a.gltf",
        viewed!("\"byteLength\": 89, \"byteStride\": 12", "\"count\": 1"),
        "a.gltf: bufferViews[0]: reaches beyond its buffer",
    ),
    (
        "a.gltf",
        viewed!("\"byteLength\": 48, \"byteStride\": 4", "\"count\": 1"),
        "a.gltf: bufferViews[0]: has a byteStride of 4, and entries of 12 bytes",
    ),
    (
        "a.gltf",
        viewed!("\"byteLength\": 48, \"byteStride\": 12", "\"count\": 5"),
        "a.gltf: accessors[0]: says that it has 5 entries, and has only 48 bytes for them",
    ),
    (
        "a.gltf",
        viewed!(
            "\"byteLength\": 48, \"byteStride\": 12",
            "\"count\": 4, \"sparse\": {\"count\": 1, \"indices\": {\"bufferView\": 0, \"byteOffset\": 15, \"componentType\": 5121}, \"values\": {\"bufferView\": 0}}"
        ),
        "a.gltf: accessors[0]: replaces entries that are not there, or not in their order",
    ),
    ("a.glb", "glTF\x02\0\0\0\x01\0\0\0", "a.glb: is cut short: it has no whole head of a binary glTF"),
    ("a.glb", "glTF\x02\0\0\0\x10\0\0\0", "a.glb: is cut short: it says 4 bytes after its head, and has 0"),
    ("a.glb", "glTF\x01\0\0\0\x0c\0\0\0", "a.glb: is a binary glTF of version 1, and 2 is read"),
    ("a.usda", "#usda 1.0\n", "a.usda: has no prim of the type Mesh with points"),
    (
        "a.usda",
        "#usda 1.0\ndef Mesh \"m\" {\npoints = [1, 2]\nfaceVertexCounts = [3]\nfaceVertexIndices = [0, 1, 2]\n}\n",
        "a.usda: has no prim of the type Mesh with points",
    ),
    (
        "a.usda",
        "#usda 1.0\n(\n metersPerUnit = \"1 cm\"\n)\n",
        "a.usda: metersPerUnit: is \"1 cm\", and must be a number",
    ),
    (
        "a.usda",
        "#usda 1.0\n(\n metersPerUnit = -1\n)\n",
        "a.usda: metersPerUnit: says that its unit is -1 m, and it must be a finite number above 0",
    ),
    ("a.usda", "#usda 1.0\n(\n upAxis = \"X\"\n)\n", "a.usda: upAxis: is \"X\", and must be \"Y\" or \"Z\""),
    (
        "a.msh",
        "$MeshFormat\n1.0 0 8\n",
        "a.msh:2:1: is of version 1, and versions 2.2 and 4.1 are read; save it anew with Mesh.MshFileVersion = 4.1",
    ),
    (
        "a.msh",
        msh!("$Nodes\n4000000000\n1 0 0 0\n"),
        "a.msh: says that it has 4000000000 nodes, and has only 9 bytes for them",
    ),
    (
        "a.msh",
        msh!("$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 2 0 1 1 5\n"),
        "a.msh: names node 5, which is not there",
    ),
    ("a.msh", msh!("$Stuff\n"), "a.msh:4:1: has no end of the section \"$Stuff\""),
    ("a.msh", msh!("$Nodes\n1\n1 0 0 0\n"), "a.msh:7:1: ends where $EndNodes must be"),
    (
        "a.msh",
        msh!("$Nodes\n1\n1 0 0 0\n2 1 0 0\n$EndNodes\n"),
        "a.msh:7:1: has \"2\" where $EndNodes must be",
    ),
    (
        "a.vtk",
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 1 float\n0 0 0\nCELLS 1 2\n1 0\n",
        "a.vtk:9:1: has 1 cells and the types of none: it is cut short",
    ),
    ("a.vtk", "# vtk\n", "a.vtk: does not begin with \"# vtk DataFile Version\"; is it a VTK legacy file?"),
    (
        "a.vtk",
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_GRID\n",
        "a.vtk:4:1: is a STRUCTURED_GRID, and POLYDATA and UNSTRUCTURED_GRID are read",
    ),
    (
        "a.vtk",
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 2000000000 float\n0 0 0\n",
        "a.vtk:5:1: says that it has 6000000000 numbers, and has only 7 bytes for them",
    ),
    (
        "a.vtk",
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 0 0\nPOLYGONS 1 4\n3 0 0 1\n",
        "a.vtk: names vertex 1, and has the vertices 0 to 0",
    ),
    ("a.vtu", "", "a.vtu: has no element VTKFile; is it a VTK XML file?"),
    ("a.vtu", "<svg/>", "a.vtu: does not begin with the element VTKFile; is it a VTK XML file?"),
    (
        "a.vtu",
        "<VTKFile type=\"PolyData\">",
        "a.vtu:1:1: is a PolyData, and UnstructuredGrid is read of VTK XML; save it as a legacy .vtk file or as .ply",
    ),
    (
        "a.vtu",
        "<VTKFile>\n<Piece>\n</Points>",
        "a.vtu:2:1: has NumberOfPoints=\"\", which must be a number from 0 to 50000000",
    ),
    (
        "a.vtu",
        "<VTKFile>\n<a>\n</b>",
        "a.vtu:3:1: is not valid XML: ill-formed document: expected `</a>`, but `</b>` was found",
    ),
    (
        "a.vtu",
        vtu!("compressor=\"vtkLZ4DataCompressor\"", ""),
        "a.vtu:1:1: is compressed by vtkLZ4DataCompressor, and vtkZLibDataCompressor is read; save it with zlib, or without compression",
    ),
    (
        "a.vtu",
        vtu!("byte_order=\"Middle\"", ""),
        "a.vtu:1:1: has the byte_order \"Middle\", which must be LittleEndian or BigEndian",
    ),
    (
        "a.vtu",
        vtu!("header_type=\"Int8\"", ""),
        "a.vtu:1:1: has the header_type \"Int8\", which must be UInt32 or UInt64",
    ),
    ("a.vtu", vtu!("", ""), "a.vtu: has no vertices"),
    (
        "a.vtu",
        vtu!("", "\n<Piece NumberOfPoints=\"9999999999\" NumberOfCells=\"0\"/>"),
        "a.vtu:3:1: has NumberOfPoints=\"9999999999\", which must be a number from 0 to 50000000",
    ),
    (
        "a.vtu",
        vtu!("", "\n<Piece NumberOfPoints=\"1\" NumberOfCells=\"0\"></Piece>"),
        "a.vtu:3:1: has a Piece with points and without Points",
    ),
    ("a.vtu", pointed!("", "format=\"ascii\"", "0 0"), "a.vtu:4:1: ends where a number must be"),
    ("a.vtu", pointed!("", "format=\"ascii\"", "0 0 nan"), "a.vtu:4:1: has \"nan\" where a number must be"),
    (
        "a.vtu",
        pointed!("", "format=\"ascii\"", "0 0 0 1"),
        "a.vtu:4:1: has \"1\" where the end of the array must be",
    ),
    (
        "a.vtu",
        pointed!("", "format=\"hex\"", ""),
        "a.vtu:4:1: has an array of the format \"hex\", which must be ascii, binary or appended",
    ),
    ("a.vtu", pointed!("", "format=\"appended\"", ""), "a.vtu:4:1: has an appended array without an offset"),
    (
        "a.vtu",
        pointed!("", "format=\"appended\" offset=\"3\"", ""),
        "a.vtu:4:1: has an appended array, and no appended data",
    ),
    (
        "a.vtu",
        pointed!("", "format=\"binary\"", "BAAAAAAAAAA="),
        "a.vtu:4:1: has an array of 4 bytes where 12 must be",
    ),
    (
        "a.vtu",
        pointed!("", "format=\"binary\"", "DAAAAAAAAAA="),
        "a.vtu:4:1: is cut short: an array needs 12 more bytes, and 4 are left",
    ),
    (
        "a.vtu",
        pointed!("", "format=\"binary\"", "????"),
        "a.vtu:4:1: is cut short: an array needs 4 more bytes, and 3 are left",
    ),
    (
        "a.vtu",
        pointed!("", "format=\"binary\"", "????????"),
        "a.vtu:4:1: has an array that is not valid base64",
    ),
    (
        // One block that says it has 12 bytes, of one compressed byte; and 4·10⁹ blocks.
        "a.vtu",
        pointed!("compressor=\"vtkZLibDataCompressor\"", "format=\"binary\"", "AQAAAAwAAAAMAAAAAQAAAA==AAAA"),
        "a.vtu:4:1: has a compressed block that is not 12 bytes in zlib",
    ),
    (
        "a.vtu",
        pointed!("compressor=\"vtkZLibDataCompressor\"", "format=\"binary\"", "/////wwAAAAMAAAAAQAAAA==AAAA"),
        "a.vtu:4:1: is cut short: an array needs 17179869180 more bytes, and 7 are left",
    ),
    ("a.vtu", celled!("0 1", ""), "a.vtu:3:1: has \"1\" where the end of the array must be"),
    (
        "a.vtu",
        celled!("-1", ""),
        "a.vtu:3:1: has an offset of -1 after 0, and offsets must not fall, nor be over 50000000",
    ),
    ("a.vtu", celled!("1", "1"), "a.vtu:3:1: names point 1, and has the points 0 to 0"),
    ("a.vtu", celled!("1", "0"), "a.vtu:2:1: has a Piece with points and without the types of its cells"),
];

#[test]
fn every_broken_file_gets_its_sentence() {
    let mut wrong = String::new();
    for (file, text, sentence) in BROKEN {
        let error = read_mesh(text.as_bytes(), file, &mut companion).expect_err(text).to_string();
        if error != *sentence {
            wrong += &format!("{text}\nis said to be {error}\nand not       {sentence}\n\n");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// Each of these nodes takes a hundred times as much memory as it has bytes.
#[test]
fn a_gltf_of_too_many_things_is_refused() {
    let text = format!("{{\"nodes\": [{}]}}", "{},".repeat(2_500_000));
    let error = read_mesh(text.as_bytes(), "a.gltf", &mut companion).unwrap_err();
    assert_eq!(error.to_string(), "a.gltf: describes more than 5000000 things");
}

/// Cut anywhere, a file is refused, or used with a word of it, unless it says all the same. But an OBJ file may end with any line.
#[test]
fn files_that_are_cut_are_noticed() {
    for (name, bytes) in samples::all() {
        let whole = read_mesh(&bytes, name, &mut companion).unwrap();
        for length in 0..bytes.len() {
            let cut = read_mesh(&bytes[..length], name, &mut companion);
            if let Ok(mesh) = cut
                && mesh != whole
                && mesh.warnings.is_empty()
                && !name.ends_with("obj")
                && !(mesh.faces.is_empty() && mesh.tetrahedra.is_empty())
            {
                panic!(
                    "{name} cut to {length} of {} bytes reads as {mesh:?} instead of {whole:?}",
                    bytes.len()
                );
            }
        }
    }
}

/// In a text whose numbers are counted the last may still be cut, and only the end of its line tells.
#[test]
fn a_last_number_that_may_be_cut_is_said() {
    for (name, bytes) in [("a.vtk", samples::VTK5), ("a.ply", samples::PLY)] {
        let text = bytes.trim_end();
        let mesh = read_mesh(text.as_bytes(), name, &mut companion).unwrap();
        let line = text.lines().count();
        let said = format!("ends right after a number, in line {line}, and may be cut short there");
        assert_eq!(mesh.warnings, [said], "{name}");
    }
}

/// A binary layer whose metadata are of another type than they must be.
#[test]
fn metadata_of_a_wrong_type_are_refused_in_binary_usd() {
    let (_, bytes) = samples::all().into_iter().find(|(name, _)| name.ends_with("usdc")).unwrap();
    // The type of a value is in its seventh byte: of metersPerUnit a double (9) in the value itself (0x40), of upAxis a token.
    for (kind, other, said) in [
        (9u8, 11u8, "metersPerUnit: is no number of a kind that is read"),
        (11, 9, "upAxis: is no word, and must be \"Y\" or \"Z\""),
    ] {
        let refused = (0..bytes.len() - 1).any(|at| {
            if bytes[at..at + 2] != [kind, 0x40] {
                return false;
            }
            let mut changed = bytes.clone();
            changed[at] = other;
            let read = read_mesh(&changed, "a.usdc", &mut companion);
            read.is_err_and(|error| error.to_string() == format!("a.usdc: {said}"))
        });
        assert!(refused, "{said}");
    }
}

/// What zlib makes of a million zeros is a thousandth of them: more is no honest count, and nothing is taken for it. Nor is it for
/// arrays that lie in one place, over and over.
#[test]
fn a_decompression_bomb_in_a_vtu_is_refused_before_it_grows() {
    let bomb = |points: u32, pieces: usize, compressed: &[u8]| {
        let piece = format!(
            "<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"0\"><Points><DataArray type=\"Float32\" \
             NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points></Piece>"
        );
        let mut file = format!(
            "<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkZLibDataCompressor\"><UnstructuredGrid>{}\
             </UnstructuredGrid><AppendedData encoding=\"raw\">_",
            piece.repeat(pieces)
        )
        .into_bytes();
        let counts = [1, points * 12, points * 12, compressed.len() as u32];
        file.extend(counts.into_iter().flat_map(u32::to_le_bytes));
        file.extend(compressed);
        file.extend(b"</AppendedData></VTKFile>");
        read_mesh(&file, "a.vtu", &mut companion).unwrap_err().to_string()
    };
    let larger = "a.vtu:1:1: has arrays that are far larger than its file";
    assert_eq!(bomb(40_000_000, 1, &[0; 9]), larger);
    let said = bomb(1_000_000, 1, &[0; 9]);
    assert_eq!(said, "a.vtu:1:1: says that 9 compressed bytes are 12000000, and they cannot be");
    // A million points at the origin, as zlib writes them.
    let mut zeros = ZlibEncoder::new(Vec::new(), Compression::best());
    zeros.write_all(&vec![0; 12_000_000]).unwrap();
    assert_eq!(bomb(1_000_000, 50, &zeros.finish().unwrap()), larger);
}
