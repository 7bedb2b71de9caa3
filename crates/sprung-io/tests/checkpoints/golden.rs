//! Every version of the format is pinned for ever: a file of it, committed as hexadecimal digits, is read as what it was.

use std::path::{Path, PathBuf};

use crate::{bytes_of, netted, read, resumed};

/// The hash of the state in it.
const HASH: u64 = 17_633_895_676_557_729_817;

fn path(version: u32) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/checkpoints/version-{version}.hex"))
}

fn golden(version: u32) -> Vec<u8> {
    from_hex(&std::fs::read_to_string(path(version)).expect("it is committed"))
}

fn hex(bytes: &[u8]) -> String {
    let digits: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    digits.as_bytes().chunks(96).map(|line| String::from_utf8_lossy(line).into_owned() + "\n").collect()
}

fn from_hex(text: &str) -> Vec<u8> {
    let digits: Vec<char> = text.chars().filter(char::is_ascii_hexdigit).collect();
    let byte = |pair: &[char]| u8::from_str_radix(&pair.iter().collect::<String>(), 16).expect("digits");
    digits.chunks(2).map(byte).collect()
}

/// The file was written once, by the first program that could. If this fails, checkpoints that people have cannot be read
/// any more: the reader is to be mended, not the file.
#[test]
fn version_1_is_read_for_ever() {
    let saved = read(&golden(1)).expect("version 1 is read");
    // Some of it in numbers, so that it does not depend on how this test makes the other.
    let (state, params) = (&saved.checkpoint.state, &saved.checkpoint.params);
    assert_eq!((state.step, state.time, state.clock()), (7, 0.06125, (3, 0.03)));
    assert_eq!(state.hash(), HASH);
    assert_eq!((params.dt, params.substeps, params.gravity.y), (0.0078125, 2, -3.0));
    assert_eq!((params.grabs[0].point, params.planes.len(), params.carried[&2].x), (1, 2, 0.5));
    assert_eq!((*params.spring_cut).as_slice(), [false, true, false, false, false]);
    assert_eq!(params.spring_rest_length[0], 0.75);
    let ledger = &state.ledger;
    assert_eq!((ledger.start, ledger.work_in), (2.4525001049041815, -1.1250075422277042));
    assert_eq!(
        (ledger.lost_in_dampers, ledger.integrator_error),
        (0.0023200850251552394, -0.04683206211586318)
    );
    let (name, mesh) = &saved.meshes[0];
    assert_eq!((name.as_str(), mesh.positions.len(), mesh.faces.len()), ("gone/net.ply", 3, 1));
    assert_eq!((mesh.positions[0].z, mesh.groups[0].vertices[0], mesh.colours[2][1]), (0.1, 0, 0.5));
    // What does not hang on how the engine rounds, which a later version of it may change.
    let made = netted();
    assert_eq!((params, &saved.recording), (&made.checkpoint.params, &made.recording));
    assert_eq!(saved.meshes, made.meshes);
    resumed(&saved).expect("it goes on").steps(10).expect("it is stable");
}

/// As long as version 1 is the one that is written, it is written like this, but for the JSON of the plan, which may gain
/// fields. `SPRUNG_UPDATE_GOLDENS=1` makes the file, for a *new* version.
#[test]
fn version_1_is_written_the_same() {
    if std::env::var_os("SPRUNG_UPDATE_GOLDENS").is_some() {
        std::fs::write(path(1), hex(&bytes_of(&netted()))).expect("it can be written");
    }
    let before_the_plan = |bytes: &[u8]| {
        let name = *b"run\0\0\0\0\0\0\0\0\0\0\0\0\0";
        let plan = bytes.windows(16).position(|window| window == name).expect("there is a plan");
        hex(&bytes[..plan])
    };
    let golden = golden(1);
    let again = bytes_of(&read(&golden).expect("version 1 is read"));
    assert!(
        before_the_plan(&again) == before_the_plan(&golden),
        "the same checkpoint has other bytes: give the format a new version"
    );
}
