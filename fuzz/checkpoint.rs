//! Random bytes for the reader of checkpoints: no input may crash it, hang it or take more memory than it has bytes.
#![no_main]

use libfuzzer_sys::{Corpus, fuzz_target};
use sprung_io::checkpoint::{MAGIC, Saved};

/// Enough for every branch, and little enough for thousands of them a second.
const MAX_POINTS: u64 = 100;
const MAX_SPRINGS: u64 = 1_000;

const FILE_HEADER: usize = 20;
const SECTION_HEADER: usize = 32;

fuzz_target!(|bytes: &[u8]| -> Corpus {
    // As it is, checksums end almost every try; so they are mended, and what lies behind them is reached.
    let _ = look(bytes);
    let mut mended = bytes.to_vec();
    mend(&mut mended);
    if look(&mended) { Corpus::Keep } else { Corpus::Reject }
});

/// Reads, writes, reads again, and goes on with what a simulation accepts. Tells whether it was a checkpoint.
fn look(bytes: &[u8]) -> bool {
    let read = |bytes: &[u8]| Saved::read_from(&mut &bytes[..], bytes.len() as u64);
    let Ok(saved) = read(bytes) else { return false };
    let written = |saved: &Saved| {
        let mut bytes = Vec::new();
        saved.write_to(&mut bytes).expect("memory takes everything");
        bytes
    };
    let first = written(&saved);
    let again = read(&first).expect("what is written is read");
    assert_eq!(written(&again), first, "the same checkpoint has the same bytes");

    // Filling a mesh may take long, and has a target of its own.
    let is_small = saved.meshes.iter().all(|(_, mesh)| mesh.positions.len() <= MAX_POINTS as usize);
    if !is_small || saved.scene.contains("soft") {
        return true;
    }
    let built = saved.scene().and_then(|scene| scene.build_within(MAX_POINTS, MAX_SPRINGS));
    let Ok((model, ..)) = built else { return true };
    if let Ok(mut simulation) = saved.simulation(model) {
        // A blow-up is an answer too.
        let _ = simulation.steps(3);
        let _ = simulation.checkpoint();
    }
    true
}

/// Right checksums, as far as the sections can be followed.
fn mend(bytes: &mut [u8]) {
    if bytes.len() < FILE_HEADER {
        return;
    }
    bytes[..8].copy_from_slice(&MAGIC);
    sum(bytes, 0, 16);
    let mut at = FILE_HEADER;
    while at + SECTION_HEADER <= bytes.len() {
        let length = u64::from_le_bytes(bytes[at + 16..at + 24].try_into().expect("eight bytes"));
        let content = at + SECTION_HEADER;
        let end = content.saturating_add(length as usize).min(bytes.len());
        let checksum = crc32fast::hash(&bytes[content..end]);
        bytes[at + 24..at + 28].copy_from_slice(&checksum.to_le_bytes());
        sum(bytes, at, 28);
        at = end;
    }
}

/// The checksum of a header, behind it.
fn sum(bytes: &mut [u8], start: usize, length: usize) {
    let checksum = crc32fast::hash(&bytes[start..start + length]);
    bytes[start + length..start + length + 4].copy_from_slice(&checksum.to_le_bytes());
}
