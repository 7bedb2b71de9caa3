//! The tetrahedron comes out the same from every format.

use sprung::build::Mesh;
use sprung::{DVec3, Error};
use sprung_io::import::{READERS, read_mesh};

use crate::samples::{self, CORNERS, FACES};

/// Files that a file may refer to.
pub fn companion(name: &str) -> sprung::Result<Vec<u8>> {
    match name {
        "buf fer.bin" => Ok(samples::gltf_buffer()),
        _ => Err(Error::new(sprung::Code::Unreadable, "there is no such file").in_file(name)),
    }
}

fn read(name: &str, bytes: &[u8]) -> Mesh {
    read_mesh(bytes, name, &mut companion).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn every_format_gives_the_same_tetrahedron() {
    for (name, bytes) in samples::all() {
        let mesh = read(name, &bytes);
        let lifted = if name.contains("gl") || name.contains("usd") { DVec3::Y * 2.0 } else { DVec3::ZERO };
        let places: Vec<DVec3> =
            CORNERS.iter().map(|corner| DVec3::from_array(corner.map(f64::from)) + lifted).collect();
        if name.to_lowercase().ends_with("stl") {
            // Triangles with corners of their own.
            let corners: Vec<DVec3> = FACES.iter().flatten().map(|&corner| places[corner as usize]).collect();
            assert_eq!(mesh.positions, corners, "{name}");
        } else {
            assert_eq!(mesh.positions, places, "{name}");
            let faces: Vec<Vec<u32>> = mesh.faces.iter().map(<[u32]>::to_vec).collect();
            let mut expected = FACES.map(|face| face.to_vec()).to_vec();
            if name.ends_with("obj") {
                expected[2] = vec![1, 2, 3];
            }
            assert_eq!(faces, expected, "{name}");
        }
        assert_eq!(mesh.warnings, [""; 0], "{name}");
        let has_tetrahedra = ["msh", "vtk", "vtu"].iter().any(|ending| name.ends_with(ending));
        assert_eq!(
            mesh.tetrahedra.as_slice(),
            if has_tetrahedra { &[[0, 1, 2, 3]][..] } else { &[] },
            "{name}"
        );
        if ["obj", "ply", "gltf", "glb", "usda", "usdc", "usdz"].iter().any(|ending| name.ends_with(ending)) {
            assert_eq!(
                mesh.colours,
                [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]],
                "{name}"
            );
        }
        let groups: Vec<(&str, &[u32])> =
            mesh.groups.iter().map(|group| (group.name.as_str(), group.vertices.as_slice())).collect();
        let all: &[u32] = &[0, 1, 2, 3];
        let expected: &[(&str, &[u32])] = match name.rsplit_once('.').unwrap().1 {
            "obj" => &[("solid", all), ("bottom", &[0, 1, 2]), ("rest", all)],
            "gltf" | "glb" => &[("tetra", all)],
            "usda" | "usdc" | "usdz" => &[("tetra", all), ("bottom", &[0, 1, 2])],
            "msh" => &[("inside", all)],
            "stl" => &[("tetra", &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11])],
            _ => &[],
        };
        assert_eq!(groups, expected, "{name}");
    }
    // A format without a sample here would not be tested by any of these.
    for reader in READERS {
        let has_sample = |(name, _): &(&str, Vec<u8>)| {
            reader.endings.iter().any(|ending| name.to_lowercase().ends_with(ending))
        };
        assert!(samples::all().iter().any(has_sample), "{}", reader.description);
    }
}

/// Writes the samples for the fuzzer, a folder for each reader, where it is asked for.
#[test]
fn samples_are_written_where_asked_for() {
    let Some(folder) = std::env::var_os("SPRUNG_WRITE_SAMPLES") else { return };
    for (name, bytes) in samples::all() {
        let reader = sprung_io::import::reader_for(name).unwrap();
        let folder = std::path::Path::new(&folder).join(reader.endings[0]);
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join(name), bytes).unwrap();
    }
}

#[test]
fn a_buffer_inside_a_gltf_text_is_read() {
    let letters = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let encoded: String = samples::gltf_buffer()
        .chunks(3)
        .map(|three| {
            let bits =
                three.iter().fold(0u32, |bits, &byte| bits << 8 | u32::from(byte)) << (8 * (3 - three.len()));
            (0..4)
                .map(|k| {
                    if k <= three.len() { letters[(bits >> (18 - 6 * k) & 63) as usize] as char } else { '=' }
                })
                .collect::<String>()
        })
        .collect();
    let text = samples::gltf(Some(&format!("data:application/octet-stream;base64,{encoded}")));
    assert_eq!(read("a.gltf", text.as_bytes()), read("a.glb", &samples::glb()));
}

/// Transforms, units and the up axis of USD, against places computed by Pixar's library; the file is made by hand.
#[test]
fn usd_places_what_lies_in_transforms() {
    let text = b"#usda 1.0\n(\n metersPerUnit = 0.01\n upAxis = \"Z\"\n)\ndef Xform \"a\" {\n float3 xformOp:rotateXYZ = (10, 20, 30)\n\
        float3 xformOp:scale = (1, 2, 3)\n uniform token[] xformOpOrder = [\"xformOp:rotateXYZ\", \"xformOp:scale\"]\n def Xform \"c\" {\n\
        quatf xformOp:orient = (0.5, 0.5, 0.5, 0.5)\n matrix4d xformOp:transform = ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (1, 2, 3, 1) )\n\
        uniform token[] xformOpOrder = [\"xformOp:orient\", \"xformOp:transform\"]\n def Mesh \"m\" {\n point3f[] points = [(POINTS)]\n} } }\n";
    let text = String::from_utf8(text.to_vec()).unwrap().replace("(POINTS)", "(0.5, 0.25, 0.1)");
    let found = read("a.usda", text.as_bytes()).positions[0];
    let exact = DVec3::new(0.037548895485895115, 0.05675827193378713, -0.04225907020841322);
    // Numbers in degrees and float32 halves leave seven digits.
    assert!((found - exact).length() < 1e-8, "{found}");
}

#[test]
fn quads_lines_and_polygons_stay_what_they_are() {
    let mesh =
        read("a.obj", b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 2 0\nf 1 2 3 4\nf 1 2 3 5 4\nl 1 2 3\n");
    let faces: Vec<&[u32]> = mesh.faces.iter().collect();
    assert_eq!(faces, [&[0, 1, 2, 3][..], &[0, 1, 2, 4, 3]]);
    assert_eq!(mesh.faces.triangles(), [[0, 1, 2], [0, 2, 3], [0, 1, 2], [0, 2, 4], [0, 4, 3]]);
    assert_eq!(mesh.lines, [[0, 1], [1, 2]]);
}

/// Two parts, as several processes write them: the points of the second are numbered from 0 again.
#[test]
fn the_pieces_of_a_vtu_become_one_mesh() {
    let part = |cells: &str| {
        format!(
            "<Piece NumberOfPoints=\"3\" NumberOfCells=\"2\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" \
             format=\"ascii\">0 0 0 1 0 0 0 1 0</DataArray></Points><Cells>{cells}</Cells></Piece>"
        )
    };
    let cells = "<DataArray type=\"Int32\" Name=\"types\" format=\"ascii\">5 3</DataArray>\
                 <DataArray type=\"Int32\" Name=\"faces\" format=\"ascii\"/>\
                 <DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3 5</DataArray>\
                 <DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 <!-- a line --> 2 0</DataArray>";
    let empty = "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>";
    let text = format!(
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>{}{empty}{}</UnstructuredGrid></VTKFile>\n",
        part(cells),
        part(&cells.replace("5 3", "42 3"))
    );
    let mesh = read("a.vtu", text.as_bytes());
    assert_eq!((mesh.positions.len(), mesh.faces.triangles()), (6, vec![[0, 1, 2]]));
    assert_eq!(mesh.lines, [[2, 0], [5, 3]]);
    assert!(mesh.warnings[0].starts_with("has 1 cells other than lines"), "{:?}", mesh.warnings);
}

/// Groups in an OBJ file and nodes in a glTF file may be as many as its faces: each costs a look, and not one for each of the others.
#[test]
fn very_many_groups_and_nodes_are_read_one_by_one() {
    let count = 50_000;
    let face = |k: usize| format!("v {k} 0 0\nv {k} 1 0\nv {k} 0 1\ng part{k}\nf -1 -2 -3\n");
    let text: String = (0..count).map(face).collect();
    let mesh = read("a.obj", text.as_bytes());
    assert_eq!((mesh.groups.len(), mesh.faces.len()), (count, count));

    let list = |one: &dyn Fn(usize) -> String| (0..count).map(one).collect::<Vec<_>>().join(",");
    let text = samples::gltf(Some("buf%20fer.bin"));
    let node = |k: usize| format!("{{\"mesh\": 0, \"name\": \"part{k}\", \"translation\": [{k}, 0, 0]}}");
    let mut document: serde_json::Value = serde_json::from_str(&text).unwrap();
    document["nodes"] = serde_json::from_str(&format!("[{}]", list(&node))).unwrap();
    document["scenes"][0]["nodes"] = (0..count).collect::<Vec<_>>().into();
    let mesh = read("a.gltf", document.to_string().as_bytes());
    assert_eq!((mesh.groups.len(), mesh.positions.len()), (count, 4 * count));
}
