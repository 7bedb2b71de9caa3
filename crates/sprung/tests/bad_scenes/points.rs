//! `[[body]]`: its name, its shape, masses, velocities and forces.

use sprung::scene::Scene;

use crate::BadScene;

pub const BAD_SCENES: &[BadScene] = &[
    (
        "WrongType",
        r#"[[body]]
name = 3
"#,
        "my.toml:2:8: body[0].name: is 3, and must be text in quotes",
    ),
    (
        "WrongType",
        r#"[[body]]
name = "a"
chain = 3
"#,
        "my.toml:3:9: body[0].chain: is 3, and must be a table",
    ),
    (
        "WrongType",
        r#"[[body]]
name = "a"
points = [[0, 0], [1, 0, 0]]
"#,
        "my.toml:3:11: body[0].points[0]: has 2 entries, and must be a list of 3 numbers",
    ),
    (
        "WrongType",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
point_mass = "heavy"
"#,
        r#"my.toml:4:14: body[0].point_mass: is the text "heavy", and must be a number, or a list with one for each point"#,
    ),
    (
        "WrongType",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
point_mass = [1, "x", 1]
"#,
        r#"my.toml:4:18: body[0].point_mass[1]: is the text "x", and must be a number"#,
    ),
    (
        "WrongType",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
velocity = 3
"#,
        "my.toml:4:12: body[0].velocity: is 3, and must be a list of 3 numbers, or a list of such lists with one for each point",
    ),
    (
        "WrongType",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
velocity = [1, [0, 0, 0], 2]
"#,
        "my.toml:4:16: body[0].velocity[1]: is a list, and must be a number",
    ),
    (
        "WrongType",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
velocity = [[0, 0, 0], 3]
"#,
        "my.toml:4:24: body[0].velocity[1]: is 3, and must be a list of 3 numbers",
    ),
    (
        "MissingField",
        r#"[[body]]
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:1: body[0].name: is missing, and has no default",
    ),
    (
        "MissingField",
        r#"[[body]]
name = "a"
chain = { points = 3 }
"#,
        "my.toml:3:9: body[0].chain.step: is missing, and has no default",
    ),
    (
        "MissingField",
        r#"[[body]]
name = "a"
"#,
        "my.toml:1:1: body[0]: has no shape; say one of chain, grid, lattice, points, mesh",
    ),
    (
        "UnknownKey",
        r#"[[body]]
name = "a"
chian = { points = 3 }
"#,
        r#"my.toml:3:1: body[0].chian: is not a known key; allowed here are name, chain, grid, lattice, points, mesh, cloth, soft, net, scale, rotation, position, point_mass, body_mass, velocity, pins, springs, forces; did you mean "chain"?"#,
    ),
    (
        "UnknownKey",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0], spacing = 2 }
"#,
        "my.toml:3:41: body[0].chain.spacing: is not a known key; allowed here are points, step, origin",
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
grid = { points = [3, 3], spacing = 1, plane = "zx" }
"#,
        r#"my.toml:3:48: body[0].grid.plane: is "zx", and must be "xy", "xz" or "yz"; did you mean "xz"?"#,
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
point_mass = -1
"#,
        "my.toml:4:14: body[0].point_mass: is -1 kg, and must be 0 (fixed in space) or from 1e-12 to 1e12 kg",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
point_mass = [1, 1, nan]
"#,
        "my.toml:4:21: body[0].point_mass[2]: is nan, and must be a finite number",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
point_mass = 1e-300
"#,
        "my.toml:4:14: body[0].point_mass: is 1e-300 kg, and must be 0 (fixed in space) or from 1e-12 to 1e12 kg",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
body_mass = -2
"#,
        "my.toml:4:13: body[0].body_mass: is -2 kg, and must be 0 (fixed in space) or from 1e-12 to 1e12 kg",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
grid = { points = [3, 3], spacing = -1 }
"#,
        "my.toml:3:37: body[0].grid.spacing: is -1 m, and must be from 1e-9 to 1e9 m",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
grid = { points = [3, 0], spacing = 1 }
"#,
        "my.toml:3:19: body[0].grid.points: has a count of 0, and there must be at least 1 point",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
grid = { points = [3, 3], spacing = 0 }
"#,
        "my.toml:3:37: body[0].grid.spacing: is 0 m, and must be from 1e-9 to 1e9 m",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
scale = 0
"#,
        "my.toml:4:9: body[0].scale: is 0, and must be from 1e-9 to 1e9",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
rotation = { axis = [0, 0, 0], degrees = 5 }
"#,
        "my.toml:4:21: body[0].rotation.axis: has length 0, and must point somewhere",
    ),
    (
        "MissingField",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
rotation = { axis = [1, 0, 0] }
"#,
        "my.toml:4:12: body[0].rotation.degrees: is missing, and has no default",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = ""
"#,
        "my.toml:2:8: body[0].name: is empty, and must have at least one letter",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
position = [0, 0, 2e9]
"#,
        "my.toml:4:19: body[0].position[2]: is 2e9 m, and must be from -1e9 to 1e9 m",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1e9, 0, 0] }
"#,
        "my.toml:1:1: body[0]: puts point 2 at [2000000000, 0, 0] m, and coordinates must be from -1e9 to 1e9 m",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
points = []
"#,
        "my.toml:3:10: body[0].points: is an empty list, and must have at least one point",
    ),
    (
        "TooLarge",
        r#"[[body]]
name = "a"
lattice = { points = [100000, 100000, 100000], spacing = 1 }
"#,
        "my.toml:3:22: body[0].lattice.points: makes 1000000000000000 points in the scene, and there may be at most 50000000",
    ),
    (
        "TooLarge",
        r#"[[body]]
name = "a"
lattice = { points = [4294967295, 4294967295, 4294967295], spacing = 1 }
"#,
        "my.toml:3:22: body[0].lattice.points: makes 18446744073709551615 points in the scene, and there may be at most 50000000",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
lattice = { points = [4294967296, 1, 1], spacing = 1 }
"#,
        "my.toml:3:23: body[0].lattice.points[0]: is 4294967296, and must be a whole number from 0 to 4294967295",
    ),
    (
        "Duplicate",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        r#"my.toml:5:8: body[1].name: is "a", which another body is called already"#,
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
point_mass = [1, 1]
"#,
        "my.toml:4:14: body[0].point_mass: has 2 entries, and the body has 3 points",
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
velocity = [[0, 0, 0]]
"#,
        "my.toml:4:12: body[0].velocity: has 1 entries, and the body has 3 points",
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
velocity = []
"#,
        "my.toml:4:12: body[0].velocity: has 0 entries, and the body has 3 points",
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
point_mass = 1
body_mass = 3
"#,
        "my.toml:5:13: body[0].body_mass: says both point_mass and body_mass; one of them is enough",
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
points = [[0, 0, 0], [1, 0, 0]]
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:3:10: body[0].points: says both chain and points; say only one of chain, grid, lattice, points, mesh",
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
forces = [{ point = 3, force = [0, 1, 0] }]
"#,
        r#"my.toml:4:21: body[0].forces[0].point: names point 3, and "a" has the points 0 to 2"#,
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
forces = [{ point = 0, force = [0, 1e10, 0] }]
"#,
        r#"my.toml:4:36: body[0].forces[0].force[1]: is 1e10 N, and must be from -1e9 to 1e9 N"#,
    ),
    (
        "Duplicate",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
forces = [{ point = 0, force = [0, 1, 0] }, { point = 0, force = [1, 1, 0] }]
"#,
        r#"my.toml:4:55: body[0].forces[1].point: pushes point 0 a second time"#,
    ),
    (
        "MissingField",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
forces = [{ point = 0 }]
"#,
        r#"my.toml:4:11: body[0].forces[0].force: is missing, and has no default"#,
    ),
];

#[test]
fn names_of_bodies_have_a_greatest_length() {
    let scene = |length| format!("[[body]]\nname = \"{}\"\npoints = [[0, 0, 0]]\n", "é".repeat(length));
    assert!(Scene::parse(&scene(100), "my.toml").is_ok());
    assert_eq!(
        Scene::parse(&scene(101), "my.toml").unwrap_err().to_string(),
        "my.toml:2:8: body[0].name: has 101 characters, and may have at most 100"
    );
}
