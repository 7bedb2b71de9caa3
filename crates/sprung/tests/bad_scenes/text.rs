//! What is no TOML, no text, or cannot be told apart.

use sprung::scene::Scene;

use crate::BadScene;

pub const BAD_SCENES: &[BadScene] = &[
    (
        "MissingField",
        "",
        "my.toml:1:1: is empty; a scene needs at least one [[body]]; `sprung new FILE` writes a scene to start from",
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
    ("Syntax", "\0", "my.toml:1:1: has a byte that is not text here (NUL); is this a TOML file?"),
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
];

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
