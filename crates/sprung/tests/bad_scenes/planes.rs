//! `[[plane]]`.

use crate::BadScene;

pub const BAD_SCENES: &[BadScene] = &[
    (
        "WrongType",
        r#"plane = 3
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:9: plane: is 3, and must be a list",
    ),
    (
        "MissingField",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[plane]]
y = 0
"#,
        "my.toml:4:1: plane[0].stiffness: is missing, and has no default",
    ),
    (
        "MissingField",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[plane]]
stiffness = 1
"#,
        "my.toml:4:1: plane[0]: has no height; say y for a level plane, or point and normal for a sloping one",
    ),
    (
        "MissingField",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[plane]]
point = [0, 0, 0]
stiffness = 1
"#,
        "my.toml:4:1: plane[0]: has only one of point and normal; a sloping plane needs both",
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[plane]]
y = 0
stiffness = 1
law = "repport"
"#,
        r#"my.toml:7:7: plane[0].law: is "repport", and must be "push" or "report"; did you mean "report"?"#,
    ),
    (
        "WrongType",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[plane]]
y = 0
stiffness = 1
law = 3
"#,
        r#"my.toml:7:7: plane[0].law: is 3, and must be "push" or "report""#,
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[plane]]
point = [0, 0, 0]
normal = [0, 0, 0]
stiffness = 1
"#,
        "my.toml:6:10: plane[0].normal: has length 0, and must point somewhere",
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[plane]]
y = 0
normal = [0, 1, 0]
stiffness = 1
"#,
        "my.toml:4:1: plane[0]: says y and also point or normal; a level plane has y, a sloping one point and normal",
    ),
];
