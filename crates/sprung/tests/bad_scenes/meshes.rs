//! Bodies that are made from a mesh.

use crate::BadScene;

pub const BAD_SCENES: &[BadScene] = &[
    (
        "MissingField",
        r#"[[body]]
name = "a"
mesh = "a.obj"
"#,
        r#"my.toml:1:1: body[0]: does not say what its mesh becomes; say one of cloth, soft, net"#,
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
points = [[0, 0, 0]]
net = { stiffness = 1 }
"#,
        r#"my.toml:4:7: body[0].net: is made from a mesh, and this body has none; say mesh = "FILE""#,
    ),
    (
        "MissingField",
        r#"[[body]]
name = "a"
mesh = "a.obj"
cloth = { stiffness = 1 }
"#,
        r#"my.toml:4:9: body[0].cloth.density: is missing; say how heavy the material is, or the body's body_mass"#,
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
mesh = "a.obj"
body_mass = 1
cloth = { stiffness = 1, density = 1 }
"#,
        r#"my.toml:5:36: body[0].cloth.density: is said besides the body's body_mass; one of them is enough"#,
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
mesh = "a.obj"
soft = { stiffness = 1, density = 1, spacing = 0 }
"#,
        r#"my.toml:4:48: body[0].soft.spacing: is 0 m, and must be from 1e-9 to 1e9 m"#,
    ),
    (
        "WrongType",
        r#"[[body]]
name = "a"
mesh = 3
"#,
        r#"my.toml:3:8: body[0].mesh: is 3, and must be the name of a mesh file, or { file = …, merge = … }"#,
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
points = [[0, 0, 0]]
pins = [{ group = "top" }]
"#,
        r#"my.toml:4:19: body[0].pins[0].group: is a group, and only meshes have those; pin points by number, or by a box"#,
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
mesh = "a.obj"
net = { stiffness = 1 }
pins = ["top"]
"#,
        r#"my.toml:5:9: body[0].pins[0]: is "top", but a mesh has no named sides; say { group = "top" }, or a box or a nearest place"#,
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
mesh = "a.obj"
net = { stiffness = 1 }
pins = [{ group = "top", colour = [1, 0, 0] }]
"#,
        r#"my.toml:5:35: body[0].pins[0].colour: says both group and colour; say only one of box, nearest, group, colour"#,
    ),
];
