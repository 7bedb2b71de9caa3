//! Files of checkpoints: one run at a time, whole or not at all, and nothing else is taken for one.

use std::fs;
use std::path::Path;

use sprung::{Code, Error};
use sprung_io::checkpoint::{Keeper, Stored};

use crate::{bytes_of, small};

fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder is there");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn one_run_at_a_time_keeps_a_checkpoint() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.sprung");
    let mut keeper = Keeper::begin(&path).expect("it can be written");
    assert_eq!(names_in(folder.path()), [""; 0]);
    let mut saved = small();
    for steps in 0..3 {
        saved.checkpoint.state.ledger.work_in = f64::from(steps);
        let bytes = keeper.write(&saved).expect("there is room");
        assert_eq!(bytes, bytes_of(&saved).len() as u64);
        // To look at it is allowed, at any time.
        assert_eq!(Stored::open(&path).and_then(|stored| stored.read(&|_, _| Ok(()))), Ok(saved.clone()));
        for refused in [Keeper::resume(&path).map(drop), Keeper::begin(&path).map(drop)] {
            let text = refused.expect_err("it is kept already").to_string();
            assert!(text.contains("is the checkpoint of a run that is still going"), "{text}");
        }
        assert_eq!(names_in(folder.path()), ["a.sprung"]);
    }
    drop(keeper);
    let (mut keeper, stored) = Keeper::resume(&path).expect("nobody keeps it any more");
    assert_eq!(stored.read(&|_, _| Ok(())), Ok(saved.clone()));
    keeper.write(&saved).expect("it goes on");
}

#[test]
fn what_is_no_file_is_refused_without_waiting() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    let text = |name: &str| {
        let [a, b] = [Stored::open(&path(name)).map(drop), Keeper::resume(&path(name)).map(drop)];
        let (a, b) = (a.expect_err("it is refused").to_string(), b.expect_err("it is refused").to_string());
        assert_eq!(a, b);
        a
    };
    assert!(text("none.sprung").ends_with("there is no such file"));
    fs::create_dir(path("folder.sprung")).expect("a folder");
    assert!(text("folder.sprung").ends_with("is a folder, and must be a file"));
    #[cfg(unix)]
    {
        let made = std::process::Command::new("mkfifo").arg(path("pipe.sprung")).status();
        assert!(made.expect("there is mkfifo").success());
        assert!(text("pipe.sprung").ends_with("is a pipe or a device, and must be an ordinary file"));
        std::os::unix::fs::symlink("nowhere", path("link.sprung")).expect("a link");
        assert!(text("link.sprung").ends_with("there is no such file"));
        // A link to a checkpoint is as good as the checkpoint, and stays a link.
        let mut keeper = Keeper::begin(&path("real.sprung")).expect("it can be written");
        keeper.write(&small()).expect("there is room");
        drop(keeper);
        std::os::unix::fs::symlink("real.sprung", path("good.sprung")).expect("a link");
        let (mut keeper, stored) = Keeper::resume(&path("good.sprung")).expect("it is one");
        assert_eq!(stored.read(&|_, _| Ok(())), Ok(small()));
        keeper.write(&small()).expect("there is room");
        assert!(path("good.sprung").is_symlink());
    }
}

#[test]
fn a_huge_file_takes_no_memory_before_it_is_asked_for() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("huge.sprung");
    // A header that is right, a section that claims a terabyte, and a file that has one, as a hole.
    let mut bytes = bytes_of(&small())[..20].to_vec();
    let mut header = b"positions\0\0\0\0\0\0\0".to_vec();
    header.extend((1u64 << 40).to_le_bytes());
    header.extend([0; 4]);
    header.extend(crc32fast::hash(&header).to_le_bytes());
    bytes.extend(header);
    fs::write(&path, &bytes).expect("written");
    let file = fs::OpenOptions::new().write(true).open(&path).expect("it is there");
    if file.set_len((1 << 40) + bytes.len() as u64).is_err() {
        return; // a file system without holes
    }
    let stored = Stored::open(&path).expect("it is a file");
    // Whoever is asked says no; the file is not blamed, nor are its points.
    let error = stored.read(&|bytes, what| {
        assert!(bytes > 1 << 41);
        Err(Error::new(Code::TooLarge, format!("{what} is more than there is room for")))
    });
    let said = "the checkpoint is more than there is room for; free some, or go on with it on a machine that has more";
    assert!(error.expect_err("there is no room").to_string().ends_with(said));
}
