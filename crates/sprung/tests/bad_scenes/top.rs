//! The top of the file, and the list of bodies.

use crate::BadScene;

pub const BAD_SCENES: &[BadScene] = &[
    (
        "MissingField",
        "# nothing here\n",
        "my.toml:1:1: body: is missing; a scene needs at least one [[body]]",
    ),
    ("MissingField", "dt = 0.01\n", "my.toml:1:1: body: is missing; a scene needs at least one [[body]]"),
    (
        "WrongType",
        r#"dt = "fast"
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        r#"my.toml:1:6: dt: is the text "fast", and must be a number of seconds or "auto""#,
    ),
    (
        "WrongType",
        r#"dt = [1]
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        r#"my.toml:1:6: dt: is a list, and must be a number of seconds or "auto""#,
    ),
    (
        "WrongType",
        r#"substeps = 1.5
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:12: substeps: is 1.5, and must be a whole number from 1 to 1000000",
    ),
    (
        "WrongType",
        r#"substeps = "many"
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        r#"my.toml:1:12: substeps: is the text "many", and must be a whole number from 1 to 1000000"#,
    ),
    (
        "WrongType",
        r#"gravity = 9.81
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:11: gravity: is 9.81, and must be a list of 3 numbers",
    ),
    (
        "WrongType",
        r#"gravity = [0, -9.81]
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:11: gravity: has 2 entries, and must be a list of 3 numbers",
    ),
    (
        "WrongType",
        r#"gravity = [0, -9.81, 0, 0]
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:11: gravity: has 4 entries, and must have 3",
    ),
    (
        "WrongType",
        r#"gravity = [0, "down", 0]
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        r#"my.toml:1:15: gravity[1]: is the text "down", and must be a number"#,
    ),
    (
        "WrongType",
        r#"title = 3
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:9: title: is 3, and must be text in quotes",
    ),
    (
        "WrongType",
        r#"[body]
name = "a"
"#,
        "my.toml:1:1: body: is a table, and must be a list; begin each entry with [[…]], two pairs of brackets",
    ),
    (
        "WrongType",
        r#"title = 1979-05-27
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:9: title: is a date or time, and must be text in quotes",
    ),
    (
        "OutOfRange",
        r#"substeps = 99999999999999999999
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:12: substeps: is 99999999999999999999, and must be a whole number from 1 to 1000000",
    ),
    (
        "OutOfRange",
        r#"substeps = -1
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:12: substeps: is -1, and must be a whole number from 1 to 1000000",
    ),
    (
        "UnknownKey",
        r#"dtt = 0.01
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        r#"my.toml:1:1: dtt: is not a known key; allowed here are title, description, dt, substeps, gravity, max_springs, plane, body, joint; did you mean "dt"?"#,
    ),
    (
        "UnknownKey",
        r#"colour = "red"
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:1: colour: is not a known key; allowed here are title, description, dt, substeps, gravity, max_springs, plane, body, joint",
    ),
    (
        "OutOfRange",
        r#"dt = nan
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:6: dt: is nan, and must be a finite number",
    ),
    (
        "OutOfRange",
        r#"dt = 0
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        r#"my.toml:1:6: dt: is 0 s, and must be from 1e-9 to 1e3 s, or "auto""#,
    ),
    (
        "OutOfRange",
        r#"dt = -0.01
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        r#"my.toml:1:6: dt: is -0.01 s, and must be from 1e-9 to 1e3 s, or "auto""#,
    ),
    (
        "OutOfRange",
        r#"dt = 1e999
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:6: dt: is 1e999, and must be a finite number",
    ),
    (
        "OutOfRange",
        r#"substeps = 0
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:12: substeps: is 0, and must be from 1 to 1000000",
    ),
    (
        "OutOfRange",
        r#"gravity = [0, -inf, 0]
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:15: gravity[1]: is -inf, and must be a finite number",
    ),
    (
        "OutOfRange",
        r#"gravity = [0, -1e12, 0]
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:15: gravity[1]: is -1e12 m/s², and must be from -1e9 to 1e9 m/s²",
    ),
    (
        "OutOfRange",
        r#"max_springs = 0
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:15: max_springs: is 0, and must be at least 1",
    ),
    (
        "UnknownKey",
        r#"title = "ééé"
substep = 3
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        r#"my.toml:2:1: substep: is not a known key; allowed here are title, description, dt, substeps, gravity, max_springs, plane, body, joint; did you mean "substeps"?"#,
    ),
    (
        "UnknownKey",
        r#""a b.c" = 3
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:1: a b.c: is not a known key; allowed here are title, description, dt, substeps, gravity, max_springs, plane, body, joint",
    ),
];
