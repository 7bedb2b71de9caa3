//! What is not a regular file is neither replaced nor waited for; a link keeps leading where it leads.

use std::fs;
use std::os::unix::fs::{FileTypeExt, symlink};
use std::path::Path;
use std::process::Command;

use sprung::Code;
use sprung_io::{PartialFile, files};

use crate::common::names_in;

fn make_pipe(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().expect("there is mkfifo").success());
}

fn is_pipe(path: &Path) -> bool {
    path.symlink_metadata().expect("it is there").file_type().is_fifo()
}

/// The sentence of a file that may not be begun.
fn refusal(path: &Path) -> String {
    let error = PartialFile::create(path).expect_err("it is refused");
    assert_eq!(error.code(), Code::Unwritable);
    assert_eq!(error.place().file, Some(path.display().to_string()));
    error.sentence().to_owned()
}

#[test]
fn a_pipe_is_left_alone() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [pipe, link] = ["pipe.csv", "link.csv"].map(|name| folder.path().join(name));
    make_pipe(&pipe);
    symlink(&pipe, &link).expect("a link");
    assert_eq!(refusal(&pipe), "cannot be written: it is not a regular file");
    assert_eq!(refusal(&link), "cannot be written: it is not a regular file");
    assert!(is_pipe(&pipe) && link.is_symlink());
    assert_eq!(names_in(folder.path()), ["link.csv", "pipe.csv"]);
}

#[test]
fn a_pipe_is_not_waited_for() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let pipe = folder.path().join("pipe.toml");
    make_pipe(&pipe);
    let error = files::read_ordinary(&pipe, 100).expect_err("nobody writes into it");
    assert_eq!(error.sentence(), "is a pipe or a device, and must be an ordinary file");
    // Nor by what the command reads scenes with, unless the shell handed it over.
    assert_eq!(files::read_or_take(&pipe, 100).expect_err("nobody writes into it"), error);
    fs::write(folder.path().join("file.toml"), "abc").expect("a file");
    assert_eq!(files::read_ordinary(&folder.path().join("file.toml"), 100).expect("it is ordinary"), b"abc");
}

#[test]
fn links_that_lead_to_no_file_are_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [dangling, looping] = ["dangling.csv", "looping.csv"].map(|name| folder.path().join(name));
    symlink("nowhere.csv", &dangling).expect("a link");
    symlink("looping.csv", &looping).expect("a link");
    assert_eq!(refusal(&dangling), "cannot be written: it is a link that leads to no file");
    assert_eq!(refusal(&looping), "cannot be written: it is a link that leads to no file");
    assert_eq!(names_in(folder.path()), ["dangling.csv", "looping.csv"]);
}

#[test]
fn through_a_link_the_file_behind_it_is_replaced() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::create_dir(folder.path().join("far")).expect("a folder");
    let [link, file] = ["link.csv", "far/file.csv"].map(|name| folder.path().join(name));
    fs::write(&file, "a longer text than the new one").expect("a file");
    symlink("far/file.csv", &link).expect("a link");
    let mut output = PartialFile::create(&link).expect("it can be written");
    assert_eq!(output.path(), link);
    std::io::Write::write_all(&mut output, b"new").expect("written");
    // The same file by its other name is the same place.
    assert_eq!(refusal(&file), "cannot be written: another output is being written there");
    output.finish().expect("completed");
    assert!(link.is_symlink());
    assert_eq!(fs::read(&file).expect("the file"), b"new");
    assert_eq!(names_in(&folder.path().join("far")), ["file.csv"]);
}

#[test]
fn what_is_in_the_way_of_the_partial_file_is_left_alone() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [output, partial, precious] =
        ["a.csv", "a.csv.partial", "precious.txt"].map(|name| folder.path().join(name));
    let sentence =
        format!("cannot be written: {} is in the way, and is not a regular file", partial.display());

    make_pipe(&partial);
    assert_eq!(refusal(&output), sentence);
    assert!(is_pipe(&partial));
    fs::remove_file(&partial).expect("removed");

    fs::write(&precious, "precious").expect("a file");
    symlink(&precious, &partial).expect("a link");
    assert_eq!(refusal(&output), sentence);
    assert!(partial.is_symlink());
    assert_eq!(fs::read(&precious).expect("the file"), b"precious");
    fs::remove_file(&partial).expect("removed");

    // What a killed run left behind is written over.
    fs::write(&partial, "half a").expect("a file");
    let output = PartialFile::create(&output).expect("it can be written");
    assert_eq!(output.finish(), Ok(0));
    assert_eq!(names_in(folder.path()), ["a.csv", "precious.txt"]);
}
