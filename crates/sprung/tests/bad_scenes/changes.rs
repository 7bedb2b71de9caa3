//! Changes by `--set`.

use sprung::scene::Scene;

/// (code, key, value, message): changes that are refused, to the scene of the jelly.
const BAD_CHANGES: &[(&str, &str, &str, &str)] = &[
    ("OutOfRange", "dt", "nan", "--set dt=nan: dt: is nan, and must be a finite number"),
    (
        "UnknownKey",
        "dtt",
        "1",
        r#"--set dtt=1: dtt: is not a known key; allowed here are title, description, dt, substeps, gravity, max_springs, plane, body, joint, stiffness, damping, rest_scale; did you mean "dt"?"#,
    ),
    (
        "WrongType",
        "dt",
        "fast",
        r#"--set dt=fast: dt: is the text "fast", and must be a number of seconds or "auto""#,
    ),
    (
        "Syntax",
        "dt",
        "",
        "--set dt=: has no value; write the value as in a scene file, such as 0.5 or [0, 1, 0]",
    ),
    (
        "Syntax",
        "dt",
        "0.1 0.2",
        "--set dt=0.1 0.2: has `0.1 0.2` where a value must be; text needs quotes, lists need commas; write the value as in a scene file, such as 0.5 or [0, 1, 0]",
    ),
    (
        "UnknownKey",
        "plane.z",
        "3",
        "--set plane.z=3: plane[0].z: is not a known key; allowed here are y, point, normal, stiffness, damping, law",
    ),
    (
        "WrongType",
        "plane.y",
        "low",
        r#"--set plane.y=low: plane[0].y: is the text "low", and must be a number"#,
    ),
    ("NotFound", "plane.3.y", "1", "--set plane.3.y=1: plane: there is no entry 3 here; entries are 0 to 0"),
    (
        "UnknownKey",
        "body.jely.springs.stiffness",
        "5",
        r#"--set body.jely.springs.stiffness=5: body.jely: is neither a body's name nor a key of bodies; the bodies are jelly; did you mean "jelly"?"#,
    ),
    (
        "UnknownKey",
        "body.jelly.springs.stifness",
        "5",
        r#"--set body.jelly.springs.stifness=5: body[0].springs[0].stifness: is not a known key; allowed here are radius, kinds, pairs, rest_length, stiffness, damping, rest_scale, cut, except; did you mean "stiffness"?"#,
    ),
    (
        "NotFound",
        "body.5.scale",
        "1",
        "--set body.5.scale=1: body: there is no entry 5 here; entries are 0 to 0",
    ),
    ("OutOfRange", "dt", "1e400", "--set dt=1e400: dt: is 1e400, and must be a finite number"),
    (
        "OutOfRange",
        "max_springs",
        "-1",
        "--set max_springs=-1: max_springs: is -1, and must be a whole number from 1 to 4294967295",
    ),
    (
        "Syntax",
        "d\u{1b}[31mt",
        "\u{202e}",
        r"--set d\u{1b}[31mt=\u{202e}: has `\u{202e}` where a value must be; text needs quotes, lists need commas; write the value as in a scene file, such as 0.5 or [0, 1, 0]",
    ),
    ("NotFound", "joint.stiffness", "5", "--set joint.stiffness=5: this scene has no joint"),
    (
        "OutOfRange",
        "stiffness",
        "-5",
        "--set stiffness=-5: body[0].springs[0].stiffness: is -5 N/m, and must be from 0 to 1e12 N/m",
    ),
    ("Syntax", "", "1", "--set =1: needs a key, a name such as dt or names joined by dots such as plane.y"),
    (
        "Syntax",
        "a..b",
        "1",
        "--set a..b=1: needs a key, a name such as dt or names joined by dots such as plane.y",
    ),
    ("WrongType", "title.x", "1", "--set title.x=1: title: is a single value, and has nothing inside"),
    (
        "WrongType",
        "gravity",
        "[0, -1.62]",
        "--set gravity=[0, -1.62]: gravity: has 2 entries, and must be a list of 3 numbers",
    ),
    (
        "Syntax",
        "dt",
        "1\nsubsteps = 3",
        r"--set dt=1\nsubsteps = 3: is not valid TOML: unexpected content; write the value as in a scene file, such as 0.5 or [0, 1, 0]",
    ),
    (
        "UnknownKey",
        "body.jelly.pairs",
        "3",
        "--set body.jelly.pairs=3: body[0].pairs: is not a known key; allowed here are name, chain, grid, lattice, points, mesh, cloth, soft, net, scale, rotation, position, point_mass, body_mass, velocity, pins, springs, forces",
    ),
    (
        "OutOfRange",
        "body.scale",
        "0",
        "--set body.scale=0: body[0].scale: is 0, and must be from 1e-9 to 1e9",
    ),
    (
        "OutOfRange",
        "body.jelly.damping",
        "-1",
        "--set body.jelly.damping=-1: body[0].springs[0].damping: is -1 N·s/m, and must be from 0 to 1e12 N·s/m",
    ),
    (
        "UnknownKey",
        "body.cube.scale",
        "1",
        "--set body.cube.scale=1: body.cube: is neither a body's name nor a key of bodies; the bodies are jelly",
    ),
    (
        "NotFound",
        "body.jelly.pins",
        "[2000]",
        r#"--set body.jelly.pins=[2000]: body[0].pins[0]: names point 2000, and "jelly" has the points 0 to 999"#,
    ),
    (
        "UnknownKey",
        "body.jelly.rotation.degres",
        "3",
        r#"--set body.jelly.rotation.degres=3: body[0].rotation.degres: is not a known key; allowed here are axis, degrees; did you mean "degrees"?"#,
    ),
    (
        "Syntax",
        "substeps",
        "2 3",
        "--set substeps=2 3: has `2 3` where a value must be; text needs quotes, lists need commas; write the value as in a scene file, such as 0.5 or [0, 1, 0]",
    ),
    (
        "UnknownKey",
        "nothing.at.all",
        "1",
        "--set nothing.at.all=1: nothing: is not a known key; allowed here are title, description, dt, substeps, gravity, max_springs, plane, body, joint",
    ),
];

#[test]
fn every_bad_change_gets_its_sentence_and_changes_nothing() {
    let jelly = Scene::builtin("jelly").unwrap();
    for (code, key, value, message) in BAD_CHANGES {
        let mut scene = jelly.clone();
        match scene.set(key, value) {
            Ok(()) => panic!("was accepted: {key} = {value}"),
            Err(error) => {
                assert_eq!(error.to_string(), *message, "{key} = {value}");
                assert_eq!(format!("{:?}", error.code()), *code, "{key} = {value}");
                assert_eq!(scene, jelly);
            }
        }
    }
}

#[test]
fn a_key_of_very_many_parts_is_refused() {
    let mut scene = Scene::builtin("jelly").unwrap();
    for parts in [33, 20_000] {
        let error = scene.set(&vec!["a"; parts].join("."), "1").unwrap_err();
        assert_eq!(error.code(), sprung::Code::TooLarge);
        assert_eq!(error.sentence(), format!("has a key of {parts} parts, and there may be at most 32"));
    }
}

#[test]
fn an_error_found_while_building_names_the_change_that_made_it() {
    let mut scene = Scene::builtin("jelly").unwrap();
    scene.set("max_springs", "9999").unwrap();
    scene.set("body.jelly.springs.radius", "100").unwrap();
    let error = scene.build().unwrap_err();
    assert_eq!(
        error.to_string(),
        "--set body.jelly.springs.radius=100: body[0].springs[0].radius: brings the scene to more than 9999 springs; \
         make the radius smaller or the points fewer, or allow more with max_springs at the top of the scene"
    );
}
