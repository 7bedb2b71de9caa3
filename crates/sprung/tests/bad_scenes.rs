//! Every kind of bad scene file, and the sentence it gets: code, file, line, column, field, what is allowed.
#![allow(clippy::unwrap_used)]

use sprung::scene::Scene;

/// (code, scene, message)
const BAD_SCENES: &[(&str, &str, &str)] = &[
    (
        "MissingField",
        "",
        "my.toml:1:1: is empty; a scene needs at least one [[body]]; `sprung new FILE` writes a scene to start from",
    ),
    (
        "MissingField",
        "# nothing here\n",
        "my.toml:1:1: body: is missing; a scene needs at least one [[body]]",
    ),
    ("Syntax", "dt = \n", "my.toml:1:6: dt: has no value"),
    (
        "Duplicate",
        r#"dt = 0.01
dt = 0.02
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:2:1: dt: is said a second time in the same table",
    ),
    (
        "Syntax",
        "title = \"x\n",
        r#"my.toml:1:11: title: is not valid TOML: invalid basic string, expected `"`"#,
    ),
    ("Syntax", "hello\n", "my.toml:1:6: is not valid TOML: key with no value, expected `=`"),
    ("Syntax", "[[body]\n", "my.toml:1:8: is not valid TOML: unclosed array table, expected `]`"),
    ("MissingField", "dt = 0.01\n", "my.toml:1:1: body: is missing; a scene needs at least one [[body]]"),
    ("Syntax", "\0", "my.toml:1:1: has a byte that is not text here (NUL); is this a TOML file?"),
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
        r#"plane = 3
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:9: plane: is 3, and must be a list",
    ),
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
        "NotFound",
        r#"[[body]]
name = "a"
grid = { points = [3, 3], spacing = 1, plane = "zx" }
"#,
        r#"my.toml:3:48: body[0].grid.plane: is "zx", and must be "xy", "xz" or "yz"; did you mean "xz"?"#,
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
[[plane]]
y = 0
normal = [0, 1, 0]
stiffness = 1
"#,
        "my.toml:4:1: plane[0]: says y and also point or normal; a level plane has y, a sloping one point and normal",
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
pins = [3]
"#,
        r#"my.toml:4:9: body[0].pins[0]: names point 3, and "a" has the points 0 to 2"#,
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
pins = [{ box = { min = [5, 0, 0], max = [6, 1, 1] } }]
"#,
        r#"my.toml:4:17: body[0].pins[0].box: contains no point of "a"; the box is in the coordinates of the world"#,
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
    (
        "Syntax",
        r#"dt = fast
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:6: dt: has `fast` where a value must be; text needs quotes, lists need commas",
    ),
    (
        "Syntax",
        r#"dt = # s
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:6: dt: has no value",
    ),
    (
        "Syntax",
        r#"title = "a" "b"
[[body]]
name = "a"
chain = { points = 3, step = [1, 0, 0] }
"#,
        "my.toml:1:13: title: is not valid TOML: unexpected key or value, expected newline, `#`",
    ),
    (
        "Syntax",
        r#"[[body]]
name = "a"
chain = { points = 3, step = [1, 0 0] }
"#,
        "my.toml:3:34: chain: has `0 0` where a value must be; text needs quotes, lists need commas",
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
        "OutOfRange",
        r#"[[body]]
name = "a\u001b[31m"
points = [[0, 0, 0]]
"#,
        r"my.toml:2:8: body[0].name: has the invisible character \u{1b}, and must be made of visible ones",
    ),
    (
        "OutOfRange",
        "[[body]]\nname = \"a\u{202e}b\"\npoints = [[0, 0, 0]]\n",
        r"my.toml:2:8: body[0].name: has the invisible character \u{202e}, and must be made of visible ones",
    ),
    (
        "WrongType",
        r#"substeps = "two\nlines and \u001b[31mred"
[[body]]
name = "a"
points = [[0, 0, 0]]
"#,
        r#"my.toml:1:12: substeps: is the text "two\nlines and \u{1b}[31mred", and must be a whole number from 1 to 1000000"#,
    ),
    (
        "UnknownKey",
        r#""d\u001bt" = 1"#,
        r#"my.toml:1:1: d\u{1b}t: is not a known key; allowed here are title, description, dt, substeps, gravity, max_springs, plane, body, joint; did you mean "dt"?"#,
    ),
    (
        "Syntax",
        "dt = 1\ntitle = \"a\0\"",
        "my.toml:2:11: has a byte that is not text here (NUL); is this a TOML file?",
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
fn every_bad_scene_gets_its_sentence() {
    for (code, text, message) in BAD_SCENES {
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
fn bytes_that_are_not_utf8_have_a_place() {
    let error = Scene::from_bytes(b"title = \"\xC3\xA9\xFF\"\n", "my.toml").unwrap_err();
    assert_eq!(
        error.to_string(),
        "my.toml:1:11: is not UTF-8 text: it has the byte 0xFF here; save the file as UTF-8"
    );
}

#[test]
fn a_huge_file_is_refused_before_it_is_read() {
    let bytes = vec![b' '; sprung::scene::MAX_BYTES as usize + 1];
    let error = Scene::from_bytes(&bytes, "my.toml").unwrap_err();
    assert_eq!(error.to_string(), "my.toml: has 67108865 bytes, and a scene file may have at most 67108864");
}

#[test]
fn deep_nesting_is_refused() {
    for text in [
        "a = ".to_owned() + &"[".repeat(100_000),
        "a.".repeat(100_000) + "a = 1",
        "a = ".to_owned() + &"{a=".repeat(100_000),
    ] {
        let error = Scene::parse(&text, "my.toml").unwrap_err();
        assert_eq!((error.code(), error.sentence()), (sprung::Code::Syntax, "is nested too deeply"));
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
fn names_of_bodies_have_a_greatest_length() {
    let scene = |length| format!("[[body]]\nname = \"{}\"\npoints = [[0, 0, 0]]\n", "é".repeat(length));
    assert!(Scene::parse(&scene(100), "my.toml").is_ok());
    assert_eq!(
        Scene::parse(&scene(101), "my.toml").unwrap_err().to_string(),
        "my.toml:2:8: body[0].name: has 101 characters, and may have at most 100"
    );
}

#[test]
fn a_file_name_stays_on_its_line() {
    let error = Scene::parse("dt = -1\n", "my\n\u{1b}[31m.toml").unwrap_err();
    assert!(error.to_string().starts_with(r"my\n\u{1b}[31m.toml:1:"), "{error}");
    let error = Scene::from_bytes(b"\xFF", "my\u{202e}.toml").unwrap_err();
    assert!(error.to_string().starts_with(r"my\u{202e}.toml:1:1:"), "{error}");
}

#[test]
fn a_long_key_is_quoted_in_part() {
    let error = Scene::parse(&format!("{} = 1\n", "x".repeat(1000)), "my.toml").unwrap_err();
    assert!(error.to_string().starts_with(&format!("my.toml:1:1: {}…: is not a known key", "x".repeat(40))));
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
