//! `[[body.springs]]`.

use crate::BadScene;

pub const BAD_SCENES: &[BadScene] = &[
    (
        "MissingField",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
"#,
        "my.toml:4:1: body[0].springs[0].stiffness: is missing, and has no default",
    ),
    (
        "MissingField",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
stiffness = 5
"#,
        "my.toml:4:1: body[0].springs[0]: does not say which points to join; say one of radius, kinds, pairs",
    ),
    (
        "UnknownKey",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stifness = 5
"#,
        r#"my.toml:6:1: body[0].springs[0].stifness: is not a known key; allowed here are radius, kinds, pairs, rest_length, stiffness, damping, rest_scale, cut, except; did you mean "stiffness"?"#,
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
kinds = ["shaer"]
stiffness = 1
"#,
        r#"my.toml:5:10: body[0].springs[0].kinds[0]: is "shaer", and must be "structural", "shear" or "bend"; did you mean "shear"?"#,
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = -3
"#,
        "my.toml:6:13: body[0].springs[0].stiffness: is -3 N/m, and must be from 0 to 1e12 N/m",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = 1
damping = -0.5
"#,
        "my.toml:7:11: body[0].springs[0].damping: is -0.5 N·s/m, and must be from 0 to 1e12 N·s/m",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = -1
stiffness = 1
"#,
        "my.toml:5:10: body[0].springs[0].radius: is -1 m, and must be from 0 to 1e9 m",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = 1e300
"#,
        "my.toml:6:13: body[0].springs[0].stiffness: is 1e300 N/m, and must be from 0 to 1e12 N/m",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = 1
rest_scale = -1
"#,
        "my.toml:7:14: body[0].springs[0].rest_scale: is -1, and must be from 0 to 1e9",
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
kinds = ["bend"]
stiffness = 1
"#,
        "my.toml:6:9: body[0].springs[0].kinds: says both radius and kinds; say only one of radius, kinds, pairs",
    ),
    (
        "Duplicate",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
kinds = ["bend", "bend"]
stiffness = 1
"#,
        "my.toml:5:18: body[0].springs[0].kinds[1]: names this kind a second time",
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
points = [[0, 0, 0], [1, 0, 0]]
[[body.springs]]
kinds = ["bend"]
stiffness = 1
"#,
        "my.toml:5:9: body[0].springs[0].kinds: cannot be used with explicit points, which have no neighbours; use radius or pairs",
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
rest_length = 1
stiffness = 1
"#,
        "my.toml:6:15: body[0].springs[0].rest_length: can be said only of springs given by pairs; use rest_scale",
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
pairs = [[0, 1], [2, 2]]
stiffness = 1
"#,
        "my.toml:5:18: body[0].springs[0].pairs[1]: joins point 2 to itself",
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
pairs = [[0, 1], [1, 3]]
stiffness = 1
"#,
        r#"my.toml:5:18: body[0].springs[0].pairs[1]: names point 3, and "a" has the points 0 to 2"#,
    ),
    (
        "WrongType",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
pairs = [[0, 1, 2]]
stiffness = 1
"#,
        "my.toml:5:10: body[0].springs[0].pairs[0]: has 3 entries, and must have 2",
    ),
    (
        "TooLarge",
        r#"[[body]]
name = "a"
lattice = { points = [100, 100, 10], spacing = 1 }
[[body.springs]]
radius = 1e6
stiffness = 1
"#,
        "my.toml:5:10: body[0].springs[0].radius: brings the scene to more than 20000000 springs; make the radius smaller or the points fewer, or allow more with max_springs at the top of the scene",
    ),
    (
        "TooLarge",
        r#"max_springs = 2
[[body]]
name = "a"
points = [[0, 0, 0], [0, 0, 0], [0, 0, 0], [1, 0, 0]]
[[body.springs]]
radius = 1
stiffness = 1
"#,
        "my.toml:6:10: body[0].springs[0].radius: brings the scene to more than 2 springs; make the radius smaller or the points fewer, or allow more with max_springs at the top of the scene",
    ),
    (
        "TooLarge",
        r#"max_springs = 1
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
kinds = ["structural"]
stiffness = 1
"#,
        "my.toml:5:1: body[0].springs[0]: brings the scene to more than 1 springs; make the radius smaller or the points fewer, or allow more with max_springs at the top of the scene",
    ),
    (
        "TooLarge",
        r#"max_springs = 1
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
pairs = [[0, 1], [1, 2]]
stiffness = 1
"#,
        "my.toml:5:1: body[0].springs[0]: brings the scene to more than 1 springs; make the radius smaller or the points fewer, or allow more with max_springs at the top of the scene",
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [100, 0, 0] }
[[body.springs]]
radius = 100
stiffness = 1
rest_scale = 1e8
"#,
        "my.toml:7:14: body[0].springs[0].rest_scale: makes a spring 1e10 m long at rest, and it may be at most 1e9 m",
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = 5
cut = [[1, 0]]
"#,
        r#"my.toml:7:8: body[0].springs[0].cut[0]: runs from 1 back to 0; say the smaller number first"#,
    ),
    (
        "Duplicate",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = 5
cut = [1, [0, 2]]
"#,
        r#"my.toml:7:11: body[0].springs[0].cut[1]: names spring 1 a second time"#,
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = 5
cut = [2]
"#,
        r#"my.toml:7:8: body[0].springs[0].cut[0]: names spring 2, and this group has the springs 0 to 1"#,
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = 5
cut = [[0, 4294967295]]
"#,
        r#"my.toml:7:8: body[0].springs[0].cut[0]: names spring 4294967295, and this group has the springs 0 to 1"#,
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = 5
cut = [-1]
"#,
        r#"my.toml:7:8: body[0].springs[0].cut[0]: is -1, and must be a number (from 0), or a list of the first and the last"#,
    ),
    (
        "WrongType",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = 5
cut = [[1]]
"#,
        r#"my.toml:7:8: body[0].springs[0].cut[0]: has 1 entry, and must be a list of the first and the last"#,
    ),
    (
        "WrongType",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = 5
cut = ["all"]
"#,
        r#"my.toml:7:8: body[0].springs[0].cut[0]: is the text "all", and must be a number (from 0), or a list of the first and the last"#,
    ),
    (
        "MissingField",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = 5
[[body.springs.except]]
stiffness = 1
"#,
        r#"my.toml:7:1: body[0].springs[0].except[0].springs: is missing, and has no default"#,
    ),
    (
        "MissingField",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = 5
[[body.springs.except]]
springs = [0]
"#,
        r#"my.toml:7:1: body[0].springs[0].except[0]: says nothing; say stiffness, damping, rest_scale or rest_length"#,
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = 5
[[body.springs.except]]
springs = []
stiffness = 1
"#,
        r#"my.toml:8:11: body[0].springs[0].except[0].springs: is an empty list, and must name at least one spring"#,
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = 5
[[body.springs.except]]
springs = [0]
damping = -1
"#,
        r#"my.toml:9:11: body[0].springs[0].except[0].damping: is -1 N·s/m, and must be from 0 to 1e12 N·s/m"#,
    ),
    (
        "Conflict",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = 5
[[body.springs.except]]
springs = [0]
rest_scale = 1
rest_length = 1
"#,
        r#"my.toml:10:15: body[0].springs[0].except[0].rest_length: says both rest_scale and rest_length; one of them is enough"#,
    ),
    (
        "NotFound",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
[[body.springs]]
radius = 1
stiffness = 5
[[body.springs.except]]
springs = [0, [1, 2]]
stiffness = 1
"#,
        r#"my.toml:8:15: body[0].springs[0].except[0].springs[1]: names spring 2, and this group has the springs 0 to 1"#,
    ),
    (
        "OutOfRange",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [10, 0, 0] }
[[body.springs]]
radius = 10
stiffness = 5
[[body.springs.except]]
springs = [1]
rest_scale = 1e9
"#,
        r#"my.toml:9:14: body[0].springs[0].except[0].rest_scale: makes a spring 1e10 m long at rest, and it may be at most 1e9 m"#,
    ),
];
