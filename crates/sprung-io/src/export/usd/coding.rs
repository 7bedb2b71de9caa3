//! How the crate format packs the tables at its end: whole numbers as small differences, and bytes in LZ4 blocks.
//!
//! The layout is that of `pxr/usd/sdf/integerCoding.cpp` and `pxr/base/tf/fastCompression.cpp` of OpenUSD, and LZ4's
//! "block format description".

use std::collections::BTreeMap;

/// Whole numbers of 32 bits as the differences from one to the next, of which the commonest takes two bits.
///
/// First the commonest difference (i32); then a code of two bits for each number, four to a byte, the lowest bits first: 0
/// for the commonest, 1, 2 and 3 for a difference of 8, 16 and 32 bits; then those differences one after the other.
pub fn integers(numbers: &[u32]) -> Vec<u8> {
    if numbers.is_empty() {
        return Vec::new();
    }
    let mut previous = 0_u32;
    let differences: Vec<i32> = numbers
        .iter()
        .map(|&number| number.wrapping_sub(std::mem::replace(&mut previous, number)).cast_signed())
        .collect();
    let mut counts = BTreeMap::new();
    for difference in &differences {
        *counts.entry(*difference).or_insert(0_usize) += 1;
    }
    // Of several that are as common, the largest: any would do.
    let common = counts.iter().max_by_key(|(_, count)| **count).map_or(0, |(difference, _)| *difference);

    let mut bytes = common.to_le_bytes().to_vec();
    let mut tail = Vec::new();
    for four in differences.chunks(4) {
        let mut codes = 0_u8;
        for (place, &difference) in four.iter().enumerate() {
            let code = if difference == common {
                0
            } else if let Ok(small) = i8::try_from(difference) {
                tail.extend(small.to_le_bytes());
                1
            } else if let Ok(medium) = i16::try_from(difference) {
                tail.extend(medium.to_le_bytes());
                2
            } else {
                tail.extend(difference.to_le_bytes());
                3
            };
            codes |= code << (2 * place);
        }
        bytes.push(codes);
    }
    bytes.extend(tail);
    bytes
}

/// Bytes in the format's envelope for LZ4: a zero for "in one block", then the block.
///
/// The block is one run of literals. The tables are a few kilobytes however long the motion is, so there is nothing to gain
/// from a real compressor.
pub fn stored(bytes: &[u8]) -> Vec<u8> {
    let mut block = vec![0];
    // A sequence begins with a byte whose upper half is the count of literals; 15 means that more of it follows, in bytes
    // that add up, of which the last is below 255.
    if bytes.len() < 15 {
        block.push((bytes.len() as u8) << 4);
    } else {
        block.push(0xf0);
        let mut left = bytes.len() - 15;
        while left >= 255 {
            block.push(255);
            left -= 255;
        }
        block.push(left as u8);
    }
    block.extend(bytes);
    block
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The inverse, written from the same description.
    fn decoded(bytes: &[u8], count: usize) -> Vec<u32> {
        let common = i32::from_le_bytes(bytes[..4].try_into().expect("four bytes"));
        let codes = &bytes[4..4 + count.div_ceil(4)];
        let mut tail = bytes[4 + codes.len()..].iter().copied();
        let mut take = |n: usize| -> i32 {
            let mut value = 0_i64;
            for byte in 0..n {
                value |= i64::from(tail.next().expect("there is more")) << (8 * byte);
            }
            (value << (64 - 8 * n) >> (64 - 8 * n)) as i32
        };
        let mut number = 0_u32;
        (0..count)
            .map(|index| {
                let difference = match codes[index / 4] >> (2 * (index % 4)) & 3 {
                    0 => common,
                    1 => take(1),
                    2 => take(2),
                    _ => take(4),
                };
                number = number.wrapping_add_signed(difference);
                number
            })
            .collect()
    }

    #[test]
    fn numbers_come_back() {
        let cases: [&[u32]; 5] = [
            &[0],
            &[1, 2, 3, 4, 5, 6, 7],
            &[5, u32::MAX, 5, 70_000, 4, u32::MAX],
            &[0, 127, 255, 0, 32_767, 0, 32_768, 1 << 31, 0],
            &[u32::MAX, 0, u32::MAX, 0],
        ];
        for numbers in cases {
            assert_eq!(decoded(&integers(numbers), numbers.len()), numbers);
        }
        assert!(integers(&[]).is_empty());
    }

    #[test]
    fn literals_of_any_length_say_it() {
        for length in [0, 1, 14, 15, 16, 269, 270, 271, 1000] {
            let bytes = vec![7; length];
            let block = stored(&bytes);
            assert_eq!(block[0], 0);
            let mut told = usize::from(block[1] >> 4);
            let mut at = 2;
            if told == 15 {
                loop {
                    told += usize::from(block[at]);
                    at += 1;
                    if block[at - 1] < 255 {
                        break;
                    }
                }
            }
            assert_eq!(told, length);
            assert_eq!(block[at..], bytes);
        }
    }
}
