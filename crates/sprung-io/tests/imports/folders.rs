//! A scene's meshes are looked for in its folder, and nowhere else; the examples are such scenes.

use std::fs;
use std::path::Path;

use sprung::Code;
use sprung::scene::Scene;
use sprung_io::import::{Folder, load_meshes};

use crate::samples;

#[test]
fn meshes_are_read_from_the_folder_of_the_scene_alone() {
    let folder = tempfile::tempdir().unwrap();
    let scenes = folder.path().join("scenes");
    fs::create_dir_all(scenes.join("parts/deep")).unwrap();
    fs::write(folder.path().join("outside.obj"), samples::OBJ).unwrap();
    fs::write(scenes.join("a.obj"), samples::OBJ).unwrap();
    fs::write(scenes.join("parts/deep/b.gltf"), samples::gltf(Some("b.bin"))).unwrap();
    fs::write(scenes.join("parts/deep/b.bin"), samples::gltf_buffer()).unwrap();
    fs::write(scenes.join("parts/out.gltf"), samples::gltf(Some("../../outside.obj"))).unwrap();
    fs::create_dir(scenes.join("folder.obj")).unwrap();
    let here = Folder::new(&scenes);
    for name in ["a.obj", "./a.obj", "parts/deep/b.gltf"] {
        assert_eq!(here.read_mesh(name).unwrap_or_else(|error| panic!("{error}")).positions.len(), 4);
    }
    let outside = "leads out of the scene's folder, and only files in it and below are read; put a copy of the file beside the scene";
    let absolute = folder.path().join("outside.obj").display().to_string();
    for name in ["../outside.obj", "parts/../../outside.obj", &absolute] {
        let error = here.read_mesh(name).unwrap_err();
        assert_eq!((error.code(), error.to_string()), (Code::Conflict, format!("{name}: {outside}")));
    }
    let error = here.read_mesh("parts/out.gltf").unwrap_err();
    assert_eq!(error.to_string(), format!("parts/../../outside.obj: {outside}"));
    assert_eq!(here.read_mesh("folder.obj").unwrap_err().sentence(), "is a folder, and must be a file");
    assert_eq!(here.read_mesh("none.obj").unwrap_err().sentence(), "there is no such file");
    assert_eq!(here.read_mesh("c:\\a.obj").unwrap_err().code(), Code::Conflict);
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("../outside.obj", scenes.join("link.obj")).unwrap();
        assert_eq!(here.read_mesh("link.obj").unwrap_err().to_string(), format!("link.obj: {outside}"));
    }
}

#[test]
fn every_example_can_be_built() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut built = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|ending| ending != "toml") {
            continue;
        }
        let mut scene = Scene::from_bytes(&fs::read(&path).unwrap(), &path.display().to_string()).unwrap();
        let warnings = load_meshes(&mut scene, Some(&path)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(warnings, [""; 0], "{}", path.display());
        let mut simulation = scene.simulation().unwrap_or_else(|error| panic!("{error}"));
        (0..30)
            .for_each(|_| simulation.frame().unwrap_or_else(|error| panic!("{}: {error}", path.display())));
        built += 1;
    }
    assert_eq!(built, 3);
}
