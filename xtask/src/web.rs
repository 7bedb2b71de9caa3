//! The page: built into `web/dist`, a folder of static files for any server, served on this machine, and tested in a browser.

use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::Hasher;
use std::path::{Path, PathBuf};

use crate::shell::{Outcome, cargo, program, read, root, run, succeeds, target};
use crate::stages::{copy_folder, files_in, fresh_folder};
use crate::wasm::{self, Build};
use crate::window::Display;

/// What is drawn with.
const APP: Build<'_> =
    Build { package: "sprung-app", what: &["--bin", "sprung-app"], file: "sprung-app", profile: "page" };

/// What the worker steps with.
const ENGINE: Build<'_> = Build {
    package: "sprung-wasm",
    what: &["--lib", "--features", "worker"],
    file: "sprung_wasm",
    profile: "wasm",
};

/// Most bytes to the first motion, compressed as servers do it.
const MOST_BYTES: u64 = 4_000_000;

/// What is written by hand.
const BY_HAND: [&str; 7] =
    ["index.html", "page.css", "page.js", "worker.js", "offline.js", "icon.svg", "manifest.webmanifest"];

/// Builds the page and tests it in a browser. Without one it is only built; in continuous integration that is a failure.
pub fn web() -> Outcome {
    let page = build()?;
    let browser = ["chromium", "chromium-browser", "google-chrome"];
    let has_browser = browser.iter().any(|name| succeeds(&mut program(name, &["--version"])));
    if has_browser && succeeds(&mut program("npm", &["--version"])) {
        return check(&page);
    }
    if std::env::var_os("CI").is_some() {
        return Err("the page is not tested: first `apt-get install chromium nodejs npm`".to_owned());
    }
    println!("not tested: for that, install Chromium, Node.js and npm");
    Ok(())
}

/// Builds the page and serves it on this machine until Ctrl-C.
pub fn serve() -> Outcome {
    let page = build()?;
    crate::serve::serve(&page)
}

/// The page's folder, whole. The one that was there before is replaced when the new one is ready.
fn build() -> Outcome<PathBuf> {
    let folder = fresh_folder("web")?;
    for name in BY_HAND {
        let from = root().join("web").join(name);
        fs::copy(from, folder.join(name)).map_err(|error| format!("web/{name} cannot be copied: {error}"))?;
    }
    wasm::bind(&APP.run()?, &folder, "sprung-app")?;
    wasm::bind(&ENGINE.run()?, &folder, "engine")?;
    let said = |error: std::io::Error| format!("the page cannot be written: {error}");
    fs::write(folder.join("licences.txt"), licences()?).map_err(said)?;
    describe(&folder)?;
    let place = root().join("web/dist");
    if place.exists() {
        fs::remove_dir_all(&place).map_err(said)?;
    }
    copy_folder(&folder, &place)?;
    Ok(place)
}

/// Writes what the page must know of its files: how long they are, and which there are.
fn describe(folder: &Path) -> Outcome {
    let mut files = Vec::new();
    gather(folder, folder, &mut files)?;
    files.sort();
    let (mut build, mut sizes, mut compressed) = (DefaultHasher::new(), Vec::new(), 0);
    for name in &files {
        let bytes = fs::read(folder.join(name)).map_err(|error| format!("{name} cannot be read: {error}"))?;
        build.write(&bytes);
        let packed = gzipped(&folder.join(name))?;
        println!("{:>10} bytes, {packed:>9} compressed  {name}", bytes.len());
        sizes.push(format!("  \"{name}\": {}", bytes.len()));
        compressed += packed;
    }
    println!("{compressed:>27} compressed  in all");
    let write = |name: &str, text: String| {
        fs::write(folder.join(name), text).map_err(|error| format!("{name} cannot be written: {error}"))
    };
    write("sizes.json", format!("{{\n{}\n}}\n", sizes.join(",\n")))?;
    files.push("sizes.json".to_owned());
    let quoted: Vec<String> = files.iter().map(|name| format!("  \"{name}\",\n")).collect();
    let build = format!("sprung {} {:016x}", env!("CARGO_PKG_VERSION"), build.finish());
    write(
        "build.js",
        format!("self.BUILD = \"{build}\";\nself.FILES = [\n  \"./\",\n{}];\n", quoted.concat()),
    )?;
    if compressed > MOST_BYTES {
        return Err(format!(
            "the page has {compressed} bytes to the first motion, and at most {MOST_BYTES} are allowed"
        ));
    }
    Ok(())
}

/// The files of a folder and those below, by their paths from `root`, with `/` between folders.
fn gather(folder: &Path, root: &Path, files: &mut Vec<String>) -> Outcome {
    let entries =
        fs::read_dir(folder).map_err(|error| format!("{} cannot be read: {error}", folder.display()))?;
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.is_dir() {
            gather(&path, root, files)?;
        } else if let Ok(name) = path.strip_prefix(root) {
            let parts: Vec<_> = name.iter().map(|part| part.to_string_lossy()).collect();
            files.push(parts.join("/"));
        }
    }
    Ok(())
}

/// How long a file is when a server compresses it.
fn gzipped(path: &Path) -> Outcome<u64> {
    let file = path.display().to_string();
    let output = program("gzip", &["-9", "-c", &file]).output();
    let output = output.map_err(|error| format!("gzip did not start: {error}"))?;
    Ok(output.stdout.len() as u64)
}

/// Every crate that is in the page's files, with its licence.
fn licences() -> Outcome<String> {
    let mut lines = Vec::new();
    for package in [APP.package, ENGINE.package] {
        let tree = read(&mut cargo(&[
            "tree",
            "--locked",
            "--package",
            package,
            "--target",
            wasm::TARGET,
            "--edges",
            "normal",
            "--prefix",
            "none",
            "--format",
            "{p}\t{l}\t{r}",
        ]))?;
        lines.extend(String::from_utf8_lossy(&tree).lines().map(|line| {
            // Where the crate lies on this machine is of no interest, and it is marked where it was named before.
            let line = line.trim_end_matches(" (*)");
            let [name, licence, place] = [0, 1, 2].map(|part| line.split('\t').nth(part).unwrap_or(""));
            let name = name.split(" (").next().unwrap_or(name);
            format!("{name}: {licence} {place}").trim_end().to_owned()
        }));
    }
    lines.sort();
    lines.dedup();
    let head = "The page's files are made of these crates. sprung itself is under the MIT licence or the Apache licence, version 2.0.\n\n";
    Ok(format!("{head}{}\n", lines.join("\n")))
}

/// The tests in a browser, after that of the worker under Node.js, beside a driver here.
fn check(page: &Path) -> Outcome {
    let folder = root().join("web/tests");
    let modules = target().join("web-tests");
    fs::create_dir_all(&modules).map_err(|error| format!("{} cannot be made: {error}", modules.display()))?;
    for name in ["package.json", "package-lock.json"] {
        fs::copy(folder.join(name), modules.join(name))
            .map_err(|error| format!("{name} cannot be copied: {error}"))?;
    }
    for path in files_in(&folder)? {
        let name = path.file_name().unwrap_or_default();
        fs::copy(&path, modules.join(name))
            .map_err(|error| format!("{} cannot be copied: {error}", path.display()))?;
    }
    // Beside a package.json that says what modules are, as Node.js wants it.
    for name in ["engine.js", "engine_bg.wasm"] {
        fs::copy(page.join(name), modules.join(name))
            .map_err(|error| format!("{name} cannot be copied: {error}"))?;
    }
    run(cargo(&["test", "--locked", "--package", "sprung-wasm", "--test", "page"])
        .env("SPRUNG_ENGINE", &modules))?;
    run(program("npm", &["ci", "--no-audit", "--no-fund", "--ignore-scripts"]).current_dir(&modules))?;
    let tested = |file: &str, display: Option<&Display>| {
        let mut tests = program("node", &["--test", "--test-reporter=spec", file]);
        tests.current_dir(&modules).env("SPRUNG_PAGE", page).env("SPRUNG_ROOT", root());
        if let Some(display) = display {
            tests.env("DISPLAY", display.name());
        }
        run(&mut tests)
    };
    tested("page.test.mjs", None)?;
    // Firefox and WebKit draw on a display only; without one, or where they are not installed, the tests say that they are skipped.
    tested("engines.test.mjs", Display::start().ok().as_ref())
}
