//! Random bytes for the scene parser: no input may crash it, hang it or take more memory than was allowed.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sprung::scene::Scene;

/// Enough for every branch of the code that builds scenes, and little enough for thousands of scenes a second.
const MAX_POINTS: u64 = 500;
const MAX_SPRINGS: u64 = 5_000;

fuzz_target!(|bytes: &[u8]| {
    let scene = match Scene::from_bytes(bytes, "fuzz.toml") {
        Ok(scene) => scene,
        Err(error) => {
            assert_eq!(error.place().file.as_deref(), Some("fuzz.toml"), "an error names its file: {error}");
            return;
        }
    };
    // What is written of a scene says the same as what was read.
    let written = scene.to_toml();
    match Scene::parse(&written, "written.toml") {
        Ok(again) => assert_eq!(again, scene, "reads back to another scene:\n{written}"),
        Err(error) => panic!("does not read back: {error}\n{written}"),
    }
    if let Ok((model, params, state)) = scene.build_within(MAX_POINTS, MAX_SPRINGS) {
        assert!(model.point_count() as u64 <= MAX_POINTS && model.spring_count() as u64 <= MAX_SPRINGS);
        // What is built, a simulation accepts.
        sprung::Simulation::new(model, params, state).expect("a scene that builds is valid");
    }
});
