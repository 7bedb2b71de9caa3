//! Numbers, texts and arrays as little-endian bytes, and back: for checkpoints and for what an output must remember.
//!
//! Reading is guarded: a length is held against the bytes that are left before any memory is taken, and the end must come
//! where it is expected.

mod mesh;
mod params;

use bytemuck::{AnyBitPattern, NoUninit};
use sprung::{Code, Error, Result, Vec3};

/// Bytes being written.
#[derive(Clone, Debug, Default)]
pub struct Pack(Vec<u8>);

impl Pack {
    /// No bytes yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// No bytes yet, and room for so many.
    pub fn with_capacity(bytes: usize) -> Self {
        Self(Vec::with_capacity(bytes))
    }

    /// What was written.
    pub fn into_bytes(self) -> Vec<u8> {
        self.0
    }

    /// One byte.
    pub fn u8(&mut self, value: u8) -> &mut Self {
        self.0.push(value);
        self
    }

    /// Four bytes.
    pub fn u32(&mut self, value: u32) -> &mut Self {
        self.0.extend(value.to_le_bytes());
        self
    }

    /// Eight bytes.
    pub fn u64(&mut self, value: u64) -> &mut Self {
        self.0.extend(value.to_le_bytes());
        self
    }

    /// A float32, by its bits.
    pub fn f32(&mut self, value: f32) -> &mut Self {
        self.u32(value.to_bits())
    }

    /// A float64, by its bits.
    pub fn f64(&mut self, value: f64) -> &mut Self {
        self.u64(value.to_bits())
    }

    /// x, y and z.
    pub fn vec3(&mut self, vector: Vec3) -> &mut Self {
        vector.to_array().into_iter().fold(self, Self::f32)
    }

    /// A length, and so many bytes.
    pub fn bytes(&mut self, bytes: &[u8]) -> &mut Self {
        self.u64(bytes.len() as u64);
        self.0.extend_from_slice(bytes);
        self
    }

    /// A length, and so many bytes of UTF-8.
    pub fn text(&mut self, text: &str) -> &mut Self {
        self.bytes(text.as_bytes())
    }

    /// A count, and so many numbers.
    pub fn f32s(&mut self, values: &[f32]) -> &mut Self {
        self.u64(values.len() as u64);
        self.numbers(values, |pack, &value| _ = pack.f32(value))
    }

    /// A count, and so many numbers.
    pub fn u32s(&mut self, values: &[u32]) -> &mut Self {
        self.u64(values.len() as u64);
        self.numbers(values, |pack, &value| _ = pack.u32(value))
    }

    /// A count, and so many numbers.
    pub fn f64s(&mut self, values: &[f64]) -> &mut Self {
        self.u64(values.len() as u64);
        self.numbers(values, |pack, &value| _ = pack.f64(value))
    }

    /// A count, and so many vectors.
    pub fn vec3s(&mut self, vectors: &[Vec3]) -> &mut Self {
        self.u64(vectors.len() as u64);
        self.numbers(vectors, |pack, &vector| _ = pack.vec3(vector))
    }

    /// All of them in one go where they lie in memory as they are written.
    fn numbers<T: NoUninit>(&mut self, values: &[T], one: impl Fn(&mut Self, &T)) -> &mut Self {
        if cfg!(target_endian = "little") {
            self.0.extend_from_slice(bytemuck::cast_slice(values));
        } else {
            self.0.reserve(size_of_val(values));
            values.iter().for_each(|value| one(self, value));
        }
        self
    }

    /// A count, and so many answers, a byte each.
    pub fn bools(&mut self, values: &[bool]) -> &mut Self {
        self.u64(values.len() as u64);
        self.0.extend(values.iter().map(|&value| u8::from(value)));
        self
    }
}

/// Bytes being read. Every method fails, with a sentence, where there are too few bytes left.
#[derive(Clone, Debug)]
pub struct Unpack<'a>(&'a [u8]);

impl<'a> Unpack<'a> {
    /// Begins to read.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self(bytes)
    }

    /// Nothing may be left.
    ///
    /// # Errors
    /// [`Code::Unreadable`].
    pub fn end(&self) -> Result<()> {
        if self.0.is_empty() { Ok(()) } else { Err(damaged("holds more than it should")) }
    }

    fn take(&mut self, count: u64) -> Result<&'a [u8]> {
        let all = usize::try_from(count).ok().and_then(|count| self.0.split_at_checked(count));
        let (taken, rest) = all.ok_or_else(|| damaged("ends too early"))?;
        self.0 = rest;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N]> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N as u64)?);
        Ok(array)
    }

    /// A count of things that take so many bytes each, and these bytes.
    fn several(&mut self, bytes_each: u64) -> Result<&'a [u8]> {
        let count = self.u64()?;
        self.take(count.saturating_mul(bytes_each))
    }

    /// One byte.
    ///
    /// # Errors
    /// [`Code::Unreadable`], as of all of these.
    pub fn u8(&mut self) -> Result<u8> {
        Ok(self.array::<1>()?[0])
    }

    /// Yes or no.
    ///
    /// # Errors
    /// [`Code::Unreadable`], also for a byte that is neither 0 nor 1.
    pub fn bool(&mut self) -> Result<bool> {
        truth(self.u8()?)
    }

    /// Four bytes.
    ///
    /// # Errors
    /// [`Code::Unreadable`].
    pub fn u32(&mut self) -> Result<u32> {
        Ok(u32::from_le_bytes(self.array()?))
    }

    /// Eight bytes.
    ///
    /// # Errors
    /// [`Code::Unreadable`].
    pub fn u64(&mut self) -> Result<u64> {
        Ok(u64::from_le_bytes(self.array()?))
    }

    /// A float32, of any bits.
    ///
    /// # Errors
    /// [`Code::Unreadable`].
    pub fn f32(&mut self) -> Result<f32> {
        Ok(f32::from_bits(self.u32()?))
    }

    /// A float64, of any bits.
    ///
    /// # Errors
    /// [`Code::Unreadable`].
    pub fn f64(&mut self) -> Result<f64> {
        Ok(f64::from_bits(self.u64()?))
    }

    /// x, y and z.
    ///
    /// # Errors
    /// [`Code::Unreadable`].
    pub fn vec3(&mut self) -> Result<Vec3> {
        Ok(Vec3::new(self.f32()?, self.f32()?, self.f32()?))
    }

    /// A length, and so many bytes.
    ///
    /// # Errors
    /// [`Code::Unreadable`].
    pub fn bytes(&mut self) -> Result<&'a [u8]> {
        self.several(1)
    }

    /// A length, and so many bytes of UTF-8.
    ///
    /// # Errors
    /// [`Code::Unreadable`].
    pub fn text(&mut self) -> Result<&'a str> {
        std::str::from_utf8(self.bytes()?).map_err(|_| damaged("holds a text that is not UTF-8"))
    }

    /// A count, and so many numbers.
    ///
    /// # Errors
    /// [`Code::Unreadable`].
    pub fn f32s(&mut self) -> Result<Vec<f32>> {
        Ok(numbers(self.several(4)?, f32_of))
    }

    /// A count, and so many numbers.
    ///
    /// # Errors
    /// [`Code::Unreadable`].
    pub fn u32s(&mut self) -> Result<Vec<u32>> {
        Ok(numbers(self.several(4)?, |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])))
    }

    /// A count, and so many numbers.
    ///
    /// # Errors
    /// [`Code::Unreadable`].
    pub fn f64s(&mut self) -> Result<Vec<f64>> {
        let value = |b: &[u8]| f64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]]);
        Ok(numbers(self.several(8)?, value))
    }

    /// A count, and so many vectors.
    ///
    /// # Errors
    /// [`Code::Unreadable`].
    pub fn vec3s(&mut self) -> Result<Vec<Vec3>> {
        let vector = |b: &[u8]| Vec3::new(f32_of(&b[..4]), f32_of(&b[4..8]), f32_of(&b[8..]));
        Ok(numbers(self.several(12)?, vector))
    }

    /// A count, and so many answers.
    ///
    /// # Errors
    /// [`Code::Unreadable`].
    pub fn bools(&mut self) -> Result<Vec<bool>> {
        self.several(1)?.iter().map(|&byte| truth(byte)).collect()
    }
}

/// Whole numbers of these bytes: in one go where they lie in memory as they are written.
fn numbers<T: AnyBitPattern + NoUninit>(bytes: &[u8], one: impl Fn(&[u8]) -> T) -> Vec<T> {
    if cfg!(target_endian = "little") {
        bytemuck::pod_collect_to_vec(bytes)
    } else {
        bytes.chunks_exact(size_of::<T>()).map(one).collect()
    }
}

fn f32_of(bytes: &[u8]) -> f32 {
    f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
}

fn truth(byte: u8) -> Result<bool> {
    match byte {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(damaged("holds a byte that is neither yes nor no")),
    }
}

fn damaged(sentence: &str) -> Error {
    Error::new(Code::Unreadable, sentence)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back_to_the_same_bits() {
        let mut pack = Pack::new();
        pack.u8(7).u32(1 << 31).u64(u64::MAX).f32(-0.0).f64(f64::MIN_POSITIVE).text("ä").bytes(&[1, 2]);
        pack.vec3(Vec3::new(0.1, -0.0, 3.0)).f32s(&[0.5, f32::INFINITY]).f64s(&[1e300]);
        pack.vec3s(&[Vec3::Y, Vec3::NEG_X]).bools(&[true, false]);
        let bytes = pack.into_bytes();

        let mut read = Unpack::new(&bytes);
        assert_eq!((read.u8(), read.u32(), read.u64()), (Ok(7), Ok(1 << 31), Ok(u64::MAX)));
        assert_eq!(read.f32().map(f32::to_bits), Ok((-0.0f32).to_bits()));
        assert_eq!(read.f64(), Ok(f64::MIN_POSITIVE));
        assert_eq!((read.text(), read.bytes()), (Ok("ä"), Ok(&[1u8, 2][..])));
        assert_eq!(read.vec3(), Ok(Vec3::new(0.1, -0.0, 3.0)));
        assert_eq!((read.f32s(), read.f64s()), (Ok(vec![0.5, f32::INFINITY]), Ok(vec![1e300])));
        assert_eq!((read.vec3s(), read.bools()), (Ok(vec![Vec3::Y, Vec3::NEG_X]), Ok(vec![true, false])));
        assert_eq!(read.end(), Ok(()));
        // Cut anywhere, it is noticed, and no memory is taken for what is not there.
        for length in 0..bytes.len() {
            let mut read = Unpack::new(&bytes[..length]);
            let mut all = || -> Result<()> {
                read.u8()?;
                read.u32()?;
                read.u64()?;
                read.f32()?;
                read.f64()?;
                read.text()?;
                read.bytes()?;
                read.vec3()?;
                read.f32s()?;
                read.f64s()?;
                read.vec3s()?;
                read.bools()?;
                Ok(())
            };
            assert!(all().is_err(), "{length} bytes");
        }
    }

    #[test]
    fn a_huge_count_is_refused() {
        let mut pack = Pack::new();
        pack.u64(u64::MAX / 2);
        let bytes = pack.into_bytes();
        assert!(Unpack::new(&bytes).vec3s().is_err());
        assert!(Unpack::new(&bytes).bytes().is_err());
        assert!(Unpack::new(&bytes).bools().is_err());
    }
}
