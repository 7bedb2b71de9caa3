//! Every kind of bad scene file, and the sentence it gets: code, file, line, column, field, what is allowed.
#![allow(clippy::unwrap_used)]

mod changes;
mod joints;
mod meshes;
mod pins;
mod planes;
mod points;
mod springs;
mod text;
mod top;

use sprung::scene::Scene;

/// (code, scene, message)
type BadScene = (&'static str, &'static str, &'static str);

const ROOMS: &[&[BadScene]] = &[
    text::BAD_SCENES,
    top::BAD_SCENES,
    planes::BAD_SCENES,
    points::BAD_SCENES,
    pins::BAD_SCENES,
    springs::BAD_SCENES,
    joints::BAD_SCENES,
    meshes::BAD_SCENES,
];

#[test]
fn every_bad_scene_gets_its_sentence() {
    for (code, text, message) in ROOMS.iter().copied().flatten() {
        match Scene::parse(text, "my.toml").and_then(|scene| scene.build()) {
            Ok(_) => panic!("was accepted:\n{text}"),
            Err(error) => {
                assert_eq!(error.to_string(), *message, "{text}");
                assert_eq!(format!("{:?}", error.code()), *code, "{text}");
                assert_eq!(error.exit_status(), 2);
                assert_eq!(error.place().file.as_deref(), Some("my.toml"));
                assert!(error.place().line_column.is_some(), "{text}");
            }
        }
    }
}
