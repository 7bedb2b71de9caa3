//! What stands where a file is to go, and is not ours to replace.
#![cfg(unix)]
#![allow(clippy::unwrap_used)]

use std::fs;
use std::os::unix::fs::{FileTypeExt, symlink};
use std::path::Path;
use std::process::Command;

use tempfile::TempDir;

/// Runs, expects status 2, and gives what was said.
fn complaint(folder: &Path, arguments: &[&str]) -> String {
    let output =
        Command::new(env!("CARGO_BIN_EXE_sprung")).current_dir(folder).args(arguments).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
    said
}

fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn new_replaces_nothing() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    assert!(Command::new("mkfifo").arg(at("pipe.toml")).status().unwrap().success());
    symlink("nowhere.toml", at("dangling.toml")).unwrap();
    fs::write(at("mine.toml"), "mine").unwrap();
    symlink("mine.toml", at("link.toml")).unwrap();
    for name in ["pipe.toml", "dangling.toml", "mine.toml", "link.toml"] {
        let said = complaint(folder.path(), &["new", name]);
        assert_eq!(said, format!("sprung: {name}: exists already and is left as it is; give another name\n"));
    }
    assert!(at("pipe.toml").symlink_metadata().unwrap().file_type().is_fifo());
    assert!(at("link.toml").is_symlink() && at("dangling.toml").is_symlink());
    assert_eq!(fs::read(at("mine.toml")).unwrap(), b"mine");
    assert_eq!(names_in(folder.path()), ["dangling.toml", "link.toml", "mine.toml", "pipe.toml"]);
}

#[test]
fn outputs_replace_no_pipe() {
    let folder = TempDir::new().unwrap();
    for name in ["a.csv", "b.gif.partial", "c.svg"] {
        assert!(Command::new("mkfifo").arg(folder.path().join(name)).status().unwrap().success());
    }
    for arguments in [["-o", "a.csv"], ["-o", "b.gif"], ["--plot", "c.svg"]] {
        let said = complaint(folder.path(), &[&["run", "spring", "--frames", "2"], &arguments[..]].concat());
        assert!(said.contains("not a regular file"), "{said}");
    }
    assert_eq!(names_in(folder.path()), ["a.csv", "b.gif.partial", "c.svg"]);
}

/// Nobody writes into it, and so nobody waits; what the shell hands over is another matter.
#[test]
fn scenes_come_through_no_pipe_but_the_shells() {
    let folder = TempDir::new().unwrap();
    assert!(Command::new("mkfifo").arg(folder.path().join("pipe.toml")).status().unwrap().success());
    for arguments in [&["show", "pipe.toml"][..], &["run", "pipe.toml"], &["bench", "pipe.toml"]] {
        let said = complaint(folder.path(), arguments);
        assert_eq!(said, "sprung: pipe.toml: is a pipe or a device, and must be an ordinary file\n");
    }
    assert!(complaint(folder.path(), &["show", "/dev/zero"]).contains("is a pipe or a device"));
    assert!(
        complaint(folder.path(), &["show", "-"])
            .ends_with("; /dev/stdin is a scene from the standard input\n")
    );
    // A mesh that such a scene names is looked for in the current folder.
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    fs::copy(examples.join("towel.obj"), folder.path().join("towel.obj")).unwrap();
    let sprung = env!("CARGO_BIN_EXE_sprung");
    let scene = examples.join("towel.toml");
    for script in [
        "cat \"$1\" | \"$0\" show /dev/stdin",
        "\"$0\" show /dev/stdin < \"$1\"",
        "exec 3< \"$1\" && \"$0\" show /dev/fd/3",
        // The writer is gone before the reader comes.
        "cat \"$1\" > pipe.toml & { wait; \"$0\" show /dev/stdin; } < pipe.toml",
    ] {
        let shell =
            Command::new("sh").current_dir(folder.path()).args(["-c", script, sprung]).arg(&scene).output();
        let shell = shell.unwrap();
        let [said, wrong] = [shell.stdout, shell.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        assert!(shell.status.success(), "{script}: {wrong}");
        assert!(said.starts_with("scene: "), "{script}: {said}");
    }
}

/// Puts a program called ffmpeg before all others and runs a film with it; gives what was said.
fn film_with(folder: &Path, script: &str) -> String {
    use std::os::unix::fs::PermissionsExt;
    let bin = folder.join("bin");
    fs::create_dir_all(&bin).unwrap();
    let program = bin.join("ffmpeg");
    fs::write(&program, format!("#!/bin/sh\n{script}\n")).unwrap();
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap_or_default());
    let output = Command::new(env!("CARGO_BIN_EXE_sprung"))
        .current_dir(folder)
        .env("PATH", path)
        .args(["run", "spring", "--frames", "2", "--size", "64x64", "-o", "a.mp4"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(names_in(folder), ["bin"]);
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn an_ffmpeg_that_does_not_do_its_work_is_told() {
    let folder = TempDir::new().unwrap();
    let said = film_with(folder.path(), "cat > /dev/null");
    assert!(said.contains("a.mp4: cannot be written: ffmpeg wrote an empty file"), "{said}");
    let said = film_with(folder.path(), "exit 7");
    assert!(said.contains("the one on this machine does not work"), "{said}");
    let said = film_with(folder.path(), "exec sleep 60");
    assert!(said.contains("the one on this machine did not answer in 10 s"), "{said}");
}
