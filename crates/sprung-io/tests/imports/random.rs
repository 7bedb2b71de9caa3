//! No bytes make a reader panic, hang or ask for much memory: every sample with bites taken.

use sprung::build::mesh::{ClothMaterial, NetMaterial, SoftMaterial, cloth, net, soft_body};
use sprung_io::import::read_mesh;

use crate::formats::companion;
use crate::samples;

/// Pseudo-random numbers (xorshift, Marsaglia 2003).
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end.max(1) as u64) as usize
    }
}

/// What a byte or a number is replaced by.
const PIECES: [&[u8]; 16] = [
    b"",
    b"0",
    b"-1",
    b"4294967295",
    b"1e308",
    b"nan",
    b" ",
    b"\n",
    b"9",
    b"\xff\xff\xff\xff",
    b"\0\0\0\0",
    b"3 ",
    b"{",
    b"[",
    b"7",
    b"\x7f",
];

#[test]
fn damaged_files_end_in_a_mesh_or_a_sentence() {
    let samples = samples::all();
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let mut read = 0;
    for round in 0..20_000 {
        let (name, whole) = &samples[round % samples.len()];
        let mut bytes = whole.clone();
        for _ in 0..=random.below(3) {
            let start = random.below(bytes.len());
            let end = (start + random.below(6)).min(bytes.len());
            bytes.splice(start..end, PIECES[random.below(PIECES.len())].iter().copied());
        }
        let Ok(mesh) = read_mesh(&bytes, name, &mut companion) else { continue };
        read += 1;
        let density = 1.0;
        let made = cloth(
            &mesh,
            &ClothMaterial {
                density,
                stiffness: 1.0,
                bending: 1e-3,
                bending_radius: None,
                damping: 0.1,
                merge: None,
            },
        );
        for body in [
            made,
            soft_body(
                &mesh,
                &SoftMaterial { spacing: 0.3, density, stiffness: 1.0, damping: 0.1, merge: None },
            ),
            net(&mesh, &NetMaterial { stiffness: 1.0, damping: 0.1, merge: None }),
        ] {
            let Ok(body) = body else { continue };
            assert!(body.springs.iter().all(|spring| spring.ends[0] < spring.ends[1]));
            assert!(body.springs.iter().all(|spring| (spring.ends[1] as usize) < body.points.len()));
            assert_eq!(body.point_of_vertex.len(), mesh.positions.len());
        }
    }
    // Many a bite does no harm.
    assert!(read > 2_000, "{read}");
}
