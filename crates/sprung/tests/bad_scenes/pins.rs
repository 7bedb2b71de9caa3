//! `pins`.

use crate::BadScene;

pub const BAD_SCENES: &[BadScene] = &[
    (
        "WrongType",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
pins = "start"
"#,
        r#"my.toml:4:8: body[0].pins: is the text "start", and must be a list"#,
    ),
    (
        "WrongType",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
pins = [true]
"#,
        "my.toml:4:9: body[0].pins[0]: is true, and must be a point's number (from 0), the name of a side, or { box = { min = …, max = … } }",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
pins = [-1]
"#,
        "my.toml:4:9: body[0].pins[0]: is -1, and must be a point's number (from 0), the name of a side, or { box = { min = …, max = … } }",
    ),
    (
        "UnknownKey",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
pins = [{ bocks = 3 }]
"#,
        "my.toml:4:11: body[0].pins[0].bocks: is not a known key; allowed here are box, nearest, group, colour",
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
pins = ["strat"]
"#,
        r#"my.toml:4:9: body[0].pins[0]: is "strat", and this shape has the sides start, end; did you mean "start"?"#,
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
grid = { points = [3, 3], spacing = 1 }
pins = ["left-bakc"]
"#,
        r#"my.toml:4:9: body[0].pins[0]: is "left-bakc", and this shape has the sides left, right, back, front, or such names joined by "-"; did you mean "left-back"?"#,
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
grid = { points = [3, 3], spacing = 1 }
pins = ["top"]
"#,
        r#"my.toml:4:9: body[0].pins[0]: is "top", and this shape has the sides left, right, back, front, or such names joined by "-""#,
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
grid = { points = [3, 3], spacing = 1 }
pins = ["left-right"]
"#,
        r#"my.toml:4:9: body[0].pins[0]: is "left-right", and this shape has the sides left, right, back, front, or such names joined by "-""#,
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
points = [[0, 0, 0], [1, 0, 0]]
pins = ["left"]
"#,
        r#"my.toml:4:9: body[0].pins[0]: is "left", but a body of explicit points has no named sides; pin its points by number, or by a box"#,
    ),
    (
        "Duplicate",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
pins = [1, 0, 1]
"#,
        "my.toml:4:15: body[0].pins[2]: pins point 1 a second time",
    ),
    (
        "Duplicate",
        r#"[[body]]
name = "a"
grid = { points = [3, 3], spacing = 1 }
pins = ["left-back", "back-left"]
"#,
        r#"my.toml:4:22: body[0].pins[1]: pins the side "back-left" a second time"#,
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
pins = [{ box = { min = [0, 1, 0], max = [1, 0, 1] } }]
"#,
        "my.toml:4:17: body[0].pins[0].box: has min 1 above max 0 along y",
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
pins = [3]
"#,
        r#"my.toml:4:9: body[0].pins[0]: names point 3, and "a" has the points 0 to 2"#,
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
pins = [{ box = { min = [5, 0, 0], max = [6, 1, 1] } }]
"#,
        r#"my.toml:4:17: body[0].pins[0].box: contains no point of "a"; the box is in the coordinates of the world"#,
    ),
];
