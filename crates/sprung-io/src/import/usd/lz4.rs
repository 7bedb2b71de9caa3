//! The compression inside binary USD: LZ4 blocks, and whole numbers as differences of two bits and up.

use sprung::{Code, Error, Result};

use crate::import::bytes::{Bytes, Order};

/// The most that one piece may become, bytes.
const MOST: usize = 1 << 28;

fn damaged() -> Error {
    Error::new(Code::Syntax, "has a compressed piece that is damaged")
}

/// Decompresses a piece that must become exactly so many bytes. Every byte of the piece makes 255 at most.
pub(super) fn decompressed(piece: &[u8], size: usize) -> Result<Vec<u8>> {
    if size > MOST || size / 256 > piece.len() {
        let sentence = format!("has a piece of {} bytes that would become {size}", piece.len());
        return Err(Error::new(Code::TooLarge, sentence));
    }
    let (&chunks, rest) = piece.split_first().ok_or_else(damaged)?;
    let mut out = Vec::with_capacity(size);
    if chunks == 0 {
        block(rest, size, &mut out)?;
    } else {
        let mut rest = Bytes::new(rest, Order::Little);
        for _ in 0..chunks {
            let length = usize::try_from(rest.i32()?).map_err(|_| damaged())?;
            // Matches do not reach back beyond the chunk.
            let mut chunk = Vec::new();
            block(rest.take(length)?, size - out.len(), &mut chunk)?;
            out.extend(chunk);
        }
    }
    if out.len() == size { Ok(out) } else { Err(damaged()) }
}

/// One LZ4 block: runs of bytes as they are, each followed by a repetition of earlier ones.
fn block(block: &[u8], most: usize, out: &mut Vec<u8>) -> Result<()> {
    let mut bytes = Bytes::new(block, Order::Little);
    while bytes.left() > 0 {
        let token = bytes.u8()?;
        let plain = length(&mut bytes, token >> 4)?;
        out.extend_from_slice(bytes.take(plain)?);
        if bytes.left() == 0 {
            break;
        }
        let back = usize::from(bytes.u16()?);
        let repeated = length(&mut bytes, token & 15)? + 4;
        if back == 0 || back > out.len() || out.len() + repeated > most {
            return Err(damaged());
        }
        for _ in 0..repeated {
            out.push(out[out.len() - back]);
        }
    }
    if out.len() > most { Err(damaged()) } else { Ok(()) }
}

/// A length of up to 14, or more in the bytes that follow.
fn length(bytes: &mut Bytes<'_>, short: u8) -> Result<usize> {
    let mut length = usize::from(short);
    if short == 15 {
        loop {
            let more = bytes.u8()?;
            length += usize::from(more);
            if more < 255 {
                break;
            }
        }
    }
    Ok(length)
}

/// So many whole numbers of 32 bits: a code of two bits for each difference to the one before says whether it is the common
/// one, or has 8, 16 or 32 bits of its own.
pub(super) fn integers(piece: &[u8], count: usize) -> Result<Vec<i32>> {
    let codes = count.div_ceil(4);
    // The fewest bytes that they may have become, and the most.
    if codes / 256 > piece.len() || count > MOST / 4 {
        let sentence = format!("has a piece of {} bytes that would become {count} numbers", piece.len());
        return Err(Error::new(Code::TooLarge, sentence));
    }
    let plain = at_most(piece, 4 + codes + 4 * count)?;
    let mut bytes = Bytes::new(&plain, Order::Little);
    let common = bytes.i32()?;
    let codes = bytes.take(codes)?;
    let (mut value, mut values) = (0i32, Vec::with_capacity(count));
    for index in 0..count {
        let difference = match codes[index / 4] >> (2 * (index % 4)) & 3 {
            0 => common,
            1 => bytes.i8()?.into(),
            2 => bytes.i16()?.into(),
            _ => bytes.i32()?,
        };
        value = value.wrapping_add(difference);
        values.push(value);
    }
    Ok(values)
}

/// Decompresses a piece that becomes no more than so many bytes.
fn at_most(piece: &[u8], most: usize) -> Result<Vec<u8>> {
    let (&chunks, rest) = piece.split_first().ok_or_else(damaged)?;
    let mut out = Vec::new();
    if chunks == 0 {
        block(rest, most, &mut out)?;
        return Ok(out);
    }
    let mut rest = Bytes::new(rest, Order::Little);
    for _ in 0..chunks {
        let length = usize::try_from(rest.i32()?).map_err(|_| damaged())?;
        let mut chunk = Vec::new();
        block(rest.take(length)?, most - out.len(), &mut chunk)?;
        out.extend(chunk);
    }
    Ok(out)
}
