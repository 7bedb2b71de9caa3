//! Numbers out of bytes, in either order of bytes, and never beyond the end.

use sprung::{Code, Error, Result};

/// Which byte of a number comes first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Order {
    /// The smallest, as in most machines.
    #[default]
    Little,
    /// The largest.
    Big,
}

/// The bytes that have not been taken yet.
#[derive(Clone)]
pub(super) struct Bytes<'a> {
    all: usize,
    rest: &'a [u8],
    order: Order,
}

/// Methods that take one number.
macro_rules! numbers {
    ($($name:ident: $type:ty),*) => {$(
        /// The next number of this type.
        pub fn $name(&mut self) -> Result<$type> {
            let bytes = self.array()?;
            Ok(match self.order {
                Order::Little => <$type>::from_le_bytes(bytes),
                Order::Big => <$type>::from_be_bytes(bytes),
            })
        }
    )*};
}

impl<'a> Bytes<'a> {
    /// All of these.
    pub fn new(bytes: &'a [u8], order: Order) -> Self {
        Self { all: bytes.len(), rest: bytes, order }
    }

    /// How many are left.
    pub fn left(&self) -> usize {
        self.rest.len()
    }

    /// Those that are left.
    pub fn rest(&self) -> &'a [u8] {
        self.rest
    }

    /// The next so many.
    pub fn take(&mut self, count: usize) -> Result<&'a [u8]> {
        let Some((taken, rest)) = self.rest.split_at_checked(count) else {
            let at = self.all - self.rest.len();
            let sentence =
                format!("is cut short: it needs {count} more bytes at byte {at}, and has {}", self.left());
            return Err(Error::new(Code::Syntax, sentence));
        };
        self.rest = rest;
        Ok(taken)
    }

    /// Checks that so many things of so many bytes each can still come, before memory is taken for them.
    pub fn check_count(&self, count: u64, bytes_each: u64, what: &str) -> Result<usize> {
        let fits = count.checked_mul(bytes_each).is_some_and(|bytes| bytes <= self.left() as u64);
        if fits && let Ok(count) = usize::try_from(count) {
            return Ok(count);
        }
        let sentence =
            format!("says that it has {count} {what}, and has only {} bytes for them", self.left());
        Err(Error::new(Code::Syntax, sentence))
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N]> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        Ok(array)
    }

    numbers!(u8: u8, i8: i8, u16: u16, i16: i16, u32: u32, i32: i32, u64: u64, i64: i64, f32: f32, f64: f64);
}
