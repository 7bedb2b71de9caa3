//! Numbers as bytes, gathered into pieces before they are written.

use std::io::{self, Write};

use sprung::Vec3;

/// Bytes that are written at once.
const PIECE_BYTES: usize = 1 << 15;

/// Writes numbers that are given as bytes.
pub fn write_all<const N: usize>(
    out: &mut impl Write,
    numbers: impl IntoIterator<Item = [u8; N]>,
) -> io::Result<()> {
    let mut piece = Vec::with_capacity(PIECE_BYTES);
    for number in numbers {
        piece.extend_from_slice(&number);
        if piece.len() + N > PIECE_BYTES {
            out.write_all(&piece)?;
            piece.clear();
        }
    }
    out.write_all(&piece)
}

/// A vector as three little-endian numbers.
pub fn little(v: Vec3) -> [u8; 12] {
    twelve([v.x.to_le_bytes(), v.y.to_le_bytes(), v.z.to_le_bytes()])
}

/// A vector as three big-endian numbers.
pub fn big(v: Vec3) -> [u8; 12] {
    twelve([v.x.to_be_bytes(), v.y.to_be_bytes(), v.z.to_be_bytes()])
}

fn twelve([[a, b, c, d], [e, f, g, h], [i, j, k, l]]: [[u8; 4]; 3]) -> [u8; 12] {
    [a, b, c, d, e, f, g, h, i, j, k, l]
}
