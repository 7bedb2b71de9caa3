//! Random bytes for the scene parser: no input may crash it, hang it or take more memory than was allowed.
#![no_main]

mod lines;

use libfuzzer_sys::{Corpus, fuzz_mutator, fuzz_target, fuzzer_mutate};
use sprung::scene::Scene;

/// Enough for every branch of the code that builds scenes, and little enough for thousands of scenes a second.
const MAX_POINTS: u64 = 100;
const MAX_SPRINGS: u64 = 1_000;

fuzz_target!(|bytes: &[u8]| -> Corpus {
    let scene = match Scene::from_bytes(bytes, "fuzz.toml") {
        Ok(scene) => scene,
        Err(error) => {
            assert_eq!(error.place().file.as_deref(), Some("fuzz.toml"), "an error names its file: {error}");
            // Reading ends at the first error, so every error is one change away from a scene that is right: only
            // those are kept to be changed further.
            return Corpus::Reject;
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
    Corpus::Keep
});

fuzz_mutator!(|bytes: &mut [u8], length: usize, max_length: usize, seed: u32| {
    if seed % 2 == 0 {
        return fuzzer_mutate(bytes, length, max_length);
    }
    let mut changed = lines::mutate(&bytes[..length], seed);
    changed.truncate(max_length);
    bytes[..changed.len()].copy_from_slice(&changed);
    changed.len()
});
