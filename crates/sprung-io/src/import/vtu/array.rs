//! The numbers of an array: text; or bytes, which begin with how many there are, and may be base64, and may be compressed in blocks.

use std::borrow::Cow;
use std::cell::Cell;
use std::io::Read;

use flate2::read::ZlibDecoder;
use sprung::{Code, Error, Result};

use crate::import::bytes::{Bytes, Order};
use crate::import::malformed;
use crate::import::words::{Words, base64_value};

/// Bytes that one compressed byte can stand for: 258 for two bits, and no more than this with what else zlib writes.
const MOST_FOR_ONE: u64 = 1032;

/// What all arrays of a file share.
#[derive(Default)]
pub struct Context<'a> {
    pub order: Order,
    /// The type of the counts before bytes.
    pub header: Kind,
    pub is_compressed: bool,
    /// What follows the tree, from which appended arrays count.
    pub appended: Option<&'a [u8]>,
    /// Whether that is base64.
    pub is_base64: bool,
    /// Bytes that arrays may still make: several may lie in one place.
    pub budget: Cell<u64>,
}

/// The types of numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    #[default]
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Kind {
    /// By VTK's name.
    pub fn of(name: &str) -> Option<Self> {
        Some(match name {
            "Int8" => Self::I8,
            "UInt8" => Self::U8,
            "Int16" => Self::I16,
            "UInt16" => Self::U16,
            "Int32" => Self::I32,
            "UInt32" => Self::U32,
            "Int64" => Self::I64,
            "UInt64" => Self::U64,
            "Float32" => Self::F32,
            "Float64" => Self::F64,
            _ => return None,
        })
    }

    fn width(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The next number as a whole one, if it is.
    fn integer(self, bytes: &mut Bytes<'_>) -> Result<i64> {
        let too_large = |number: u64| {
            i64::try_from(number).map_err(|_| malformed(format!("has {number}, which is too large")))
        };
        Ok(match self {
            Self::I8 => bytes.i8()?.into(),
            Self::U8 => bytes.u8()?.into(),
            Self::I16 => bytes.i16()?.into(),
            Self::U16 => bytes.u16()?.into(),
            Self::I32 => bytes.i32()?.into(),
            Self::U32 => bytes.u32()?.into(),
            Self::I64 => bytes.i64()?,
            Self::U64 => too_large(bytes.u64()?)?,
            Self::F32 | Self::F64 => {
                return Err(Error::new(Code::WrongType, "has fractions where whole numbers must be"));
            }
        })
    }

    /// The next number.
    fn float(self, bytes: &mut Bytes<'_>) -> Result<f64> {
        match self {
            Self::F32 => bytes.f32().map(f64::from),
            Self::F64 => bytes.f64(),
            _ => self.integer(bytes).map(|whole| whole as f64),
        }
    }
}

/// Where the numbers of an array are.
pub enum Form<'a> {
    Text(Cow<'a, [u8]>),
    Base64(Cow<'a, [u8]>),
    /// So far behind the beginning of the appended data.
    Appended(u64),
}

pub struct Array<'a> {
    pub kind: Kind,
    pub form: Form<'a>,
    pub line: usize,
}

impl Array<'_> {
    /// So many finite numbers.
    pub fn floats(&self, context: &Context<'_>, count: usize) -> Result<Vec<f64>> {
        let values = self.numbers(context, count, |words| words.float("a number"), Kind::float)?;
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            let sentence = format!("has a coordinate of point {} that is not a number", index / 3);
            return Err(Error::new(Code::OutOfRange, sentence).at_line(self.line, 1));
        }
        Ok(values)
    }

    /// So many whole numbers.
    pub fn integers(&self, context: &Context<'_>, count: usize) -> Result<Vec<i64>> {
        self.numbers(context, count, |words| words.integer("a whole number"), Kind::integer)
    }

    fn numbers<T>(
        &self,
        context: &Context<'_>,
        count: usize,
        text: impl Fn(&mut Words<'_>) -> Result<T>,
        binary: impl Fn(Kind, &mut Bytes<'_>) -> Result<T>,
    ) -> Result<Vec<T>> {
        let at = |error: Error| error.at_line(self.line, 1);
        let Form::Text(content) = &self.form else {
            let left = context.budget.get().checked_sub(count as u64 * 8);
            let too_large = || Error::new(Code::TooLarge, "has arrays that are far larger than its file");
            context.budget.set(left.ok_or_else(too_large).map_err(at)?);
            let bytes = self.bytes(context, count as u64 * self.kind.width() as u64).map_err(at)?;
            let mut bytes = Bytes::new(&bytes, context.order);
            return (0..count).map(|_| binary(self.kind, &mut bytes).map_err(at)).collect();
        };
        let mut words = Words::new(content, self.line);
        let room = Bytes::new(content, context.order).check_count(count as u64, 1, "numbers").map_err(at)?;
        let mut values = Vec::with_capacity(room);
        for _ in 0..count {
            values.push(text(&mut words)?);
        }
        match words.next() {
            None => Ok(values),
            Some(word) => Err(words.not_a(word, "the end of the array")),
        }
    }

    /// The bytes of the numbers, of which there must be so many.
    fn bytes(&self, context: &Context<'_>, wanted: u64) -> Result<Vec<u8>> {
        let mut source = match (&self.form, context.appended) {
            (Form::Text(_), _) => return Ok(Vec::new()),
            (Form::Base64(content), _) => {
                let letters = content.iter().copied().filter(|letter| !letter.is_ascii_whitespace());
                Source::of_base64(Cow::Owned(letters.collect()))
            }
            (Form::Appended(_), None) => {
                return Err(Error::new(Code::MissingField, "has an appended array, and no appended data"));
            }
            (&Form::Appended(offset), Some(appended)) => {
                let rest = usize::try_from(offset).ok().and_then(|offset| appended.get(offset..));
                let rest = rest.ok_or_else(|| {
                    let sentence =
                        format!("has an array {offset} bytes behind the beginning of {}", appended.len());
                    malformed(sentence)
                })?;
                if context.is_base64 { Source::of_base64(Cow::Borrowed(rest)) } else { Source::Raw(rest) }
            }
        };
        let differs = |found: u64| {
            let sentence = format!("has an array of {found} bytes where {wanted} must be");
            Error::new(Code::Conflict, sentence)
        };
        let first = source.count(context)?;
        if !context.is_compressed {
            if first != wanted {
                return Err(differs(first));
            }
            return source.take(first);
        }
        let (blocks, whole, last) = (first, source.count(context)?, source.count(context)?);
        source.check(blocks.saturating_mul(context.header.width() as u64))?;
        let sizes: Vec<u64> = (0..blocks).map(|_| source.count(context)).collect::<Result<_>>()?;
        // The last block is a whole one unless its size is said.
        let last = if last == 0 { whole } else { last };
        let all = blocks.checked_sub(1).map_or(0, |before| whole.saturating_mul(before).saturating_add(last));
        if all != wanted {
            return Err(differs(all));
        }
        let compressed = sizes.iter().fold(0u64, |sum, &size| sum.saturating_add(size));
        source.check(compressed)?;
        if all > compressed.saturating_mul(MOST_FOR_ONE) {
            let sentence = format!("says that {compressed} compressed bytes are {all}, and they cannot be");
            return Err(malformed(sentence));
        }
        let mut bytes = Vec::with_capacity(all as usize);
        for (index, &size) in (1..).zip(&sizes) {
            let wanted = if index == blocks { last } else { whole };
            let before = bytes.len();
            let block = source.take(size)?;
            // One more than there may be, to notice if there are.
            let read = ZlibDecoder::new(&block[..]).take(wanted.saturating_add(1)).read_to_end(&mut bytes);
            if read.is_err() || (bytes.len() - before) as u64 != wanted {
                let sentence = format!("has a compressed block that is not {wanted} bytes in zlib");
                return Err(malformed(sentence));
            }
        }
        Ok(bytes)
    }
}

/// Bytes from which to take, as they are or as base64.
enum Source<'a> {
    Raw(&'a [u8]),
    Base64 {
        letters: Cow<'a, [u8]>,
        next: usize,
        /// Decoded and not taken: of one group of letters.
        spare: Vec<u8>,
    },
}

impl<'a> Source<'a> {
    fn of_base64(letters: Cow<'a, [u8]>) -> Self {
        Self::Base64 { letters, next: 0, spare: Vec::new() }
    }

    /// Checks that so many bytes can still come.
    fn check(&self, count: u64) -> Result<()> {
        let left = match self {
            Self::Raw(bytes) => bytes.len(),
            Self::Base64 { letters, next, spare } => (letters.len() - next) / 4 * 3 + spare.len(),
        };
        if count <= left as u64 {
            return Ok(());
        }
        // Of letters only those that fill up groups were not looked at.
        let filled = match self {
            Self::Raw(_) => 0,
            Self::Base64 { letters, next, .. } => letters[*next..].iter().filter(|&&one| one == b'=').count(),
        };
        let left = left.saturating_sub(filled);
        Err(malformed(format!("is cut short: an array needs {count} more bytes, and {left} are left")))
    }

    fn take(&mut self, count: u64) -> Result<Vec<u8>> {
        self.check(count)?;
        let count = count as usize;
        match self {
            Self::Raw(bytes) => {
                let (taken, rest) = bytes.split_at(count);
                *bytes = rest;
                Ok(taken.to_vec())
            }
            Self::Base64 { letters, next, spare } => {
                let mut taken = Vec::with_capacity(count + 3);
                taken.append(spare);
                // Counts and bytes may be encoded one by one or together: each group of four ends by itself.
                while taken.len() < count {
                    let four = letters.get(*next..*next + 4).and_then(group);
                    let (three, whole) =
                        four.ok_or_else(|| malformed("has an array that is not valid base64"))?;
                    taken.extend_from_slice(&three[..whole]);
                    *next += 4;
                }
                *spare = taken.split_off(count);
                Ok(taken)
            }
        }
    }

    /// The next count.
    fn count(&mut self, context: &Context<'_>) -> Result<u64> {
        let taken = self.take(context.header.width() as u64)?;
        let mut bytes = Bytes::new(&taken, context.order);
        if context.header == Kind::U64 { bytes.u64() } else { bytes.u32().map(u64::from) }
    }
}

/// The one to three bytes that four letters stand for, and how many they are.
fn group(four: &[u8]) -> Option<([u8; 3], usize)> {
    let letters = four.strip_suffix(b"==").or(four.strip_suffix(b"=")).unwrap_or(four);
    let mut bits = 0u32;
    for &letter in letters {
        bits = bits << 6 | base64_value(letter)?;
    }
    bits <<= 6 * (4 - letters.len());
    let [_, three @ ..] = bits.to_be_bytes();
    Some((three, letters.len() - 1))
}
