//! Random bytes for the readers of meshes, and what they read for the makers of bodies: no input may crash them, hang them or take
//! more memory than its bytes and a few megabytes account for.
//!
//! The environment variable `SPRUNG_READER` names the reader by one of its endings, such as `obj`: a corpus belongs to a format.
#![no_main]

use std::sync::OnceLock;

use libfuzzer_sys::{Corpus, fuzz_target};
use sprung::build::mesh::{ClothMaterial, NetMaterial, SoftMaterial, cloth, net, soft_body};
use sprung::{Code, Error};
use sprung_io::import::{READERS, Reader, read_mesh};

/// Bodies are made of small meshes only: their makers are tried thousands of times a second.
const MOST_VERTICES: usize = 200;

fn chosen() -> &'static Reader {
    static READER: OnceLock<&'static Reader> = OnceLock::new();
    READER.get_or_init(|| {
        let ending = std::env::var("SPRUNG_READER").unwrap_or_default();
        let found = READERS.iter().find(|reader| reader.endings.contains(&ending.as_str()));
        found
            .unwrap_or_else(|| panic!("SPRUNG_READER must be the ending of a mesh file, and is \"{ending}\""))
    })
}

fuzz_target!(|bytes: &[u8]| -> Corpus {
    let file = format!("fuzz.{}", chosen().endings[0]);
    // A file that it refers to has the same bytes: there is something to find.
    let mut companions = |name: &str| match name.contains("gone") {
        true => Err(Error::new(Code::Unreadable, "there is no such file").in_file(name)),
        false => Ok(bytes.to_vec()),
    };
    let mesh = match read_mesh(bytes, &file, &mut companions) {
        Ok(mesh) => mesh,
        Err(error) => {
            assert!(error.place().file.is_some(), "an error names its file: {error}");
            return Corpus::Keep;
        }
    };
    mesh.check().expect("what is read is sound");
    if mesh.positions.len() > MOST_VERTICES {
        return Corpus::Keep;
    }
    let bent = ClothMaterial {
        density: 1.0,
        stiffness: 1.0,
        bending: 1e-3,
        bending_radius: None,
        damping: 0.1,
        merge: None,
    };
    let diagonal = mesh.positions.iter().fold(1e-9f64, |size, place| size.max(place.length()));
    let filled =
        SoftMaterial { spacing: diagonal / 4.0, density: 1.0, stiffness: 1.0, damping: 0.1, merge: None };
    let knotted = NetMaterial { stiffness: 1.0, damping: 0.1, merge: None };
    for body in [cloth(&mesh, &bent), soft_body(&mesh, &filled), net(&mesh, &knotted)].into_iter().flatten() {
        assert!(body.springs.iter().all(|spring| spring.ends[0] < spring.ends[1]));
        assert!(body.springs.iter().all(|spring| (spring.ends[1] as usize) < body.points.len()));
        assert_eq!(body.point_of_vertex.len(), mesh.positions.len());
    }
    Corpus::Keep
});
