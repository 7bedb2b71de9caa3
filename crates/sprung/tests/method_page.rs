//! The pages for people cannot rot unseen: code quoted in the guide stands in the file it names, and links lead somewhere.

use std::fs;
use std::path::{Path, PathBuf};

const PAGES: &[&str] = &[
    "README.md",
    "ARCHITECTURE.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "docs/method.md",
    "docs/scene-format.md",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Lines without their indentation: a quotation may be indented otherwise than its source.
fn trimmed(text: &str) -> Vec<&str> {
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect()
}

/// The fenced blocks that name a file, as (file, code): the fence reads "```rust file=crates/…".
fn quotations(page: &str) -> Vec<(&str, &str)> {
    let mut found = Vec::new();
    let mut rest = page;
    while let Some((_, from_name)) = rest.split_once("\n```rust file=") {
        let (file, body) = from_name.split_once('\n').expect("a fence is a line of its own");
        let (code, after) = body.split_once("\n```").expect("every fence is closed");
        found.push((file.trim(), code));
        rest = after;
    }
    found
}

#[test]
fn quoted_code_stands_in_the_file_it_names() {
    let page = read("docs/method.md");
    let quotations = quotations(&page);
    assert!(quotations.len() >= 15, "only {} quotations were found", quotations.len());
    for (file, code) in quotations {
        let source = read(file);
        let (quoted, lines) = (trimmed(code), trimmed(&source));
        let stands = lines.windows(quoted.len()).any(|window| window == quoted);
        assert!(stands, "docs/method.md quotes what does not stand in {file}:\n{code}");
    }
}

#[test]
fn links_lead_to_files_that_exist() {
    for page in PAGES {
        let text = read(page);
        let folder = root().join(page).parent().map(Path::to_path_buf).unwrap_or_default();
        for (_, after) in text.match_indices("](").map(|(at, link)| (at, &text[at + link.len()..])) {
            let target = after.split(')').next().unwrap_or_default();
            let file = target.split('#').next().unwrap_or_default();
            if file.is_empty() || target.contains("://") {
                continue;
            }
            assert!(folder.join(file).exists(), "{page} links to {target}, which is not there");
        }
    }
}

/// Every scene, every source file of the engine and every crate has its line in the description of the whole.
#[test]
fn the_architecture_names_every_crate_and_every_module_of_the_engine() {
    let text = read("ARCHITECTURE.md");
    let crates = root().join("crates");
    for folder in fs::read_dir(crates).expect("there are crates").flatten() {
        let name = folder.file_name().to_string_lossy().into_owned();
        assert!(text.contains(&format!("crates/{name}")), "ARCHITECTURE.md does not name {name}");
    }
    for entry in fs::read_dir(root().join("crates/sprung/src")).expect("the engine has sources").flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        assert!(text.contains(&format!("/{name})")), "ARCHITECTURE.md does not name {name} of the engine");
    }
}
