//! `[[joint]]`.

use crate::BadScene;

pub const BAD_SCENES: &[BadScene] = &[
    (
        "NotFound",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[joint]]
between = ["a", "b"]
radius = 1
stiffness = 1
"#,
        r#"my.toml:5:17: joint[0].between[1]: is "b", and there is no body of that name"#,
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body]]
name = "deck"
chain = { points = 3, step = [1, 0, 0] }
[[joint]]
between = ["a", "dekc"]
radius = 1
stiffness = 1
"#,
        r#"my.toml:8:17: joint[0].between[1]: is "dekc", and there is no body of that name; did you mean "deck"?"#,
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[joint]]
between = ["a", "a"]
radius = 1
stiffness = 1
"#,
        r#"my.toml:5:11: joint[0].between: joins "a" to itself; springs within a body go into [[body.springs]]"#,
    ),
    (
        "WrongType",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[joint]]
between = ["a"]
radius = 1
stiffness = 1
"#,
        "my.toml:5:11: joint[0].between: has 1 entry, and must be a list of 2",
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body]]
name = "b"
chain = { points = 3, step = [1, 0, 0] }
[[joint]]
between = ["a", "b"]
pairs = [[0, 7]]
stiffness = 1
"#,
        r#"my.toml:9:14: joint[0].pairs[0][1]: names point 7, and "b" has the points 0 to 2"#,
    ),
    (
        "MissingField",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body]]
name = "b"
chain = { points = 3, step = [1, 0, 0] }
[[joint]]
between = ["a", "b"]
stiffness = 1
"#,
        "my.toml:7:1: joint[0]: does not say which points to join; say one of radius, pairs",
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body]]
name = "b"
chain = { points = 3, step = [1, 0, 0] }
position = [0, 9, 0]
[[joint]]
between = ["a", "b"]
radius = 1
stiffness = 1
"#,
        "my.toml:10:10: joint[0].radius: is 1 m, and no points of the two bodies are that near",
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body]]
name = "b"
points = [[0, 1, 0]]
[[joint]]
between = ["a", "b"]
pairs = [[0, 0]]
stiffness = 1
cut = [1]
"#,
        r#"my.toml:11:8: joint[0].cut[0]: names spring 1, and this group has the springs 0 to 0"#,
    ),
];
