//! Exports read back, and what is left behind when they end early.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use sprung::{Code, Vec3};
use sprung_io::export::{CSV, MDD, NPZ, PC2};
use sprung_io::{Exporter, Options, PartialFile};

use crate::common::{begin, names_in, run_of, snapshot, to_the_end};
use crate::npz;

const TABLES: [Exporter; 4] = [CSV, NPZ, PC2, MDD];

fn bits(vectors: &[Vec3]) -> Vec<u32> {
    vectors.iter().flat_map(|vector| vector.to_array().map(f32::to_bits)).collect()
}

#[test]
fn a_csv_file_reads_back_to_the_same_bits() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.csv");
    let run = run_of(5);
    let written = begin(CSV, &path, &run, 4).expect("written").finish(&mut to_the_end).expect("written");

    assert_eq!((written.frames, &written.path), (4, &path));
    let text = fs::read_to_string(&path).expect("text");
    assert_eq!(written.bytes, text.len() as u64);
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("frame,time,point,x,y,z,vx,vy,vz"));
    for frame in 0..4 {
        let expected = snapshot(5, frame);
        for point in 0..5 {
            let cells: Vec<&str> = lines.next().expect("a row").split(',').collect();
            assert_eq!((cells[0].parse(), cells[2].parse()), (Ok(frame), Ok(point)));
            assert_eq!(cells[1].parse(), Ok(expected.time));
            let numbers: Vec<u32> =
                cells[3..].iter().map(|cell| cell.parse::<f32>().expect("a number").to_bits()).collect();
            assert_eq!(numbers, bits(&[expected.positions[point], expected.velocities[point]]));
        }
    }
    assert_eq!(lines.next(), None);
    assert_eq!(names_in(folder.path()), ["a.csv"]);
}

#[test]
fn an_npz_file_reads_back_to_the_same_bits() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.npz");
    // Frames of 144 kB, so that pieces begin and end within frames, and 30 of them, so that there are many pieces.
    let (points, frames) = (12_000, 30);
    let run = run_of(points);
    let mut heard = Vec::new();
    let export = begin(NPZ, &path, &run, frames).expect("written");
    // It has nothing to draw, so it goes on when asked to break off.
    let mut listen = |share| {
        heard.push(share);
        ControlFlow::Break(())
    };
    let written = export.finish(&mut listen).expect("written");

    assert_eq!(written.frames, frames);
    assert_eq!(written.bytes, fs::metadata(&path).expect("the file is there").len());
    assert!(heard.is_sorted() && heard.last() == Some(&1.0), "progress ends at 1: {heard:?}");

    let [time, positions, velocities, springs, mass] =
        ["time", "positions", "velocities", "springs", "mass"].map(|name| npz::load(&path, name));
    assert_eq!(time.shape, [30]);
    assert_eq!(positions.shape, [30, points, 3]);
    assert_eq!(velocities.shape, [30, points, 3]);
    assert_eq!(springs.shape, [points - 1, 2]);
    assert_eq!(mass.shape, [points]);

    let (positions, velocities) = (positions.f32s(), velocities.f32s());
    for frame in 0..frames {
        let expected = snapshot(points, frame);
        assert_eq!(time.f64s()[frame as usize].to_bits(), expected.time.to_bits());
        let numbers = frame as usize * points * 3..(frame as usize + 1) * points * 3;
        let same = |read: &[f32], expected: &[Vec3]| read.iter().map(|x| x.to_bits()).eq(bits(expected));
        assert!(same(&positions[numbers.clone()], &expected.positions), "positions of frame {frame}");
        assert!(same(&velocities[numbers], &expected.velocities), "velocities of frame {frame}");
    }
    assert_eq!(springs.u32s(), run.model.springs().as_flattened());
    assert_eq!(mass.f32s(), **run.params.point_mass);
    assert_eq!(names_in(folder.path()), ["a.npz"]);
}

#[test]
fn the_same_frames_make_the_same_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for exporter in TABLES {
        let [first, second] = ["1", "2"].map(|name| {
            let path = folder.path().join(name).with_extension(exporter.ending);
            begin(exporter, &path, &run_of(9), 3).expect("written").finish(&mut to_the_end).expect("written");
            fs::read(path).expect("the file is there")
        });
        assert!(first == second, "{} files differ", exporter.ending);
    }
}

#[test]
fn a_run_without_frames_or_springs_makes_a_file_too() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for exporter in TABLES {
        let path = folder.path().join("a").with_extension(exporter.ending);
        let written =
            begin(exporter, &path, &run_of(1), 0).expect("written").finish(&mut to_the_end).expect("written");
        assert_eq!(written.frames, 0);
    }
    let path = folder.path().join("a.npz");
    assert_eq!(npz::load(&path, "positions").shape, [0, 1, 3]);
    assert_eq!(npz::load(&path, "springs").shape, [0, 2]);
}

#[test]
fn an_output_that_is_dropped_leaves_nothing_behind_and_the_old_file_in_place() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for exporter in TABLES {
        let path = folder.path().join("a").with_extension(exporter.ending);
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        fs::write(&path, "an earlier run's").expect("written");

        let export = begin(exporter, &path, &run_of(100), 20).expect("written");
        assert_eq!(names_in(folder.path()), [name.clone(), format!("{name}.partial")]);
        drop(export);

        assert_eq!(names_in(folder.path()), [name]);
        assert_eq!(fs::read(&path).expect("the file is there"), b"an earlier run's");
        fs::remove_file(path).expect("removed");
    }
}

#[test]
fn two_runs_do_not_write_to_one_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for exporter in TABLES {
        let path = folder.path().join("a").with_extension(exporter.ending);
        let run = run_of(3);
        let first = begin(exporter, &path, &run, 2).expect("written");
        let error = begin(exporter, &path, &run, 0).err().expect("refused");
        assert_eq!(error.code(), Code::Unwritable);
        assert_eq!(error.sentence(), "cannot be written: another output is being written there");
        first.finish(&mut to_the_end).expect("the first run goes on unharmed");
        begin(exporter, &path, &run, 1).expect("the name is free again");
    }
}

#[test]
fn what_a_killed_run_left_behind_does_not_block_the_next() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for exporter in TABLES {
        let path = folder.path().join("a").with_extension(exporter.ending);
        let partial = folder.path().join(format!("a.{}.partial", exporter.ending));
        fs::write(&partial, vec![b'#'; 1_000_000]).expect("written");
        let written =
            begin(exporter, &path, &run_of(3), 2).expect("written").finish(&mut to_the_end).expect("written");
        assert!(written.bytes < 10_000, "nothing of the killed run is in {} bytes", written.bytes);
    }
    assert_eq!(names_in(folder.path()), ["a.csv", "a.mdd", "a.npz", "a.pc2"]);
}

/// Many threads begin, write and finish the same name as fast as they can: whoever succeeds wrote a whole file.
#[test]
fn outputs_raced_for_one_name_never_mix() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.txt");
    let finished = std::sync::atomic::AtomicU32::new(0);
    std::thread::scope(|scope| {
        for thread in 0..4u8 {
            let (path, finished) = (&path, &finished);
            scope.spawn(move || {
                for _ in 0..200 {
                    let Ok(mut file) = PartialFile::create(path) else { continue };
                    use std::io::Write;
                    file.write_all(&vec![thread; 1000 + usize::from(thread)]).expect("written");
                    file.finish().expect("whoever holds the lock can finish");
                    finished.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                    let read = fs::read(path).expect("there is always a finished file");
                    assert!(
                        read.iter().all(|byte| *byte == read[0]) && read.len() == 1000 + usize::from(read[0])
                    );
                }
            });
        }
    });
    assert!(finished.into_inner() > 0);
    assert_eq!(names_in(folder.path()), ["a.txt"]);
}

#[test]
fn places_that_cannot_be_written_get_one_sentence() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("file"), "").expect("written");
    let long = "n".repeat(300);
    for exporter in TABLES {
        let refusal = |path: &Path| {
            let error = (exporter.open)(path, &run_of(2), &Options::default()).err().expect("refused");
            assert_eq!((error.code(), error.exit_status()), (Code::Unwritable, 2));
            assert_eq!(error.place().file.as_deref(), path.to_str());
            error.sentence().to_owned()
        };
        assert_eq!(refusal(folder.path()), "cannot be written: it is a folder");
        assert_eq!(refusal(&folder.path().join("none/a")), "cannot be written: its folder does not exist");
        assert_eq!(refusal(Path::new("..")), "cannot be written: it is a folder");
        assert_eq!(refusal(Path::new("")), "cannot be written: it is not a file's name");
        if cfg!(unix) {
            assert_eq!(
                refusal(&folder.path().join("file/a")),
                "cannot be written: its folder is not a folder"
            );
            assert_eq!(
                refusal(&folder.path().join(&long)),
                "cannot be written: its name is too long or not allowed here"
            );
        }
    }
    assert_eq!(names_in(folder.path()), ["file"]);
}
