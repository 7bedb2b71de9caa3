//! The command says of a mistake what the npm package says: both meet the sentences of `npm/test/sentences.json`.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::process::Command;

use serde::Deserialize;
use serde_json::Value;
use tempfile::TempDir;

#[derive(Deserialize)]
struct Case {
    about: String,
    /// The text of a scene.
    scene: Option<String>,
    /// Or the name of one that is built in.
    builtin: Option<String>,
    /// What `--set` changes.
    #[serde(default)]
    set: BTreeMap<String, Value>,
    sentence: String,
}

#[test]
fn mistakes_are_worded_as_in_javascript() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../npm/test/sentences.json");
    let cases: Vec<Case> = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    assert!(cases.len() > 20);
    let folder = TempDir::new().unwrap();
    for case in cases {
        let mut command = Command::new(env!("CARGO_BIN_EXE_sprung"));
        command.current_dir(folder.path()).arg("show");
        match (&case.scene, &case.builtin) {
            (Some(text), _) => {
                std::fs::write(folder.path().join("bad.toml"), text).unwrap();
                command.arg("bad.toml")
            }
            (None, name) => command.arg(name.as_ref().unwrap()),
        };
        for (key, value) in &case.set {
            let value = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
            command.arg("--set").arg(format!("{key}={value}"));
        }
        let output = command.output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(said.trim_end(), format!("sprung: {}", case.sentence), "{}", case.about);
        assert_eq!(output.status.code(), Some(2), "{}", case.about);
    }
}
