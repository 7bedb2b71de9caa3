//! Arrays of floats that begin at a cache line, x, y and z apart.

use bytemuck::{Zeroable, zeroed_vec};

/// Bytes in a cache line, to which arrays are aligned.
const LINE_BYTES: usize = 64;

/// So many arrays of floats of the same length, each beginning at a cache line; zeros at first.
#[derive(Debug, Default)]
pub(super) struct Arrays<const N: usize, T = f32> {
    buffer: Vec<T>,
    start: usize,
    stride: usize,
    len: usize,
}

impl<const N: usize, T: Zeroable + Copy> Arrays<N, T> {
    /// Floats in a cache line.
    const LINE: usize = LINE_BYTES / size_of::<T>();

    pub fn new(len: usize) -> Self {
        // Some lines more than needed: arrays a multiple of 4096 bytes apart would compete for the same lines of the cache.
        let stride = len.next_multiple_of(Self::LINE) + 23 * Self::LINE;
        let buffer: Vec<T> = zeroed_vec(N * stride + Self::LINE);
        let start = buffer.as_ptr().align_offset(LINE_BYTES).min(Self::LINE);
        Self { buffer, start, stride, len }
    }

    /// Floats in each array.
    pub fn len(&self) -> usize {
        self.len
    }

    /// The arrays.
    #[inline(always)]
    pub fn all(&self) -> [&[T]; N] {
        let mut all: [&[T]; N] = [&[]; N];
        for (index, array) in all.iter_mut().enumerate() {
            *array = &self.buffer[self.start + index * self.stride..][..self.len];
        }
        all
    }

    /// The arrays, to write to.
    #[inline(always)]
    pub fn all_mut(&mut self) -> [&mut [T]; N] {
        let mut all: [&mut [T]; N] = std::array::from_fn(|_| Default::default());
        let arrays = self.buffer[self.start..].chunks_exact_mut(self.stride.max(1));
        for (slot, array) in all.iter_mut().zip(arrays) {
            *slot = &mut array[..self.len];
        }
        all
    }
}

impl<const N: usize, T: Zeroable + Copy> Clone for Arrays<N, T> {
    /// A copy lies elsewhere, so that its lines begin elsewhere.
    fn clone(&self) -> Self {
        let mut copy = Self::new(self.len);
        copy.clone_from(self);
        copy
    }

    fn clone_from(&mut self, source: &Self) {
        if (self.len, self.stride) != (source.len, source.stride) {
            *self = Self::new(source.len);
        }
        let floats = N * source.stride;
        self.buffer[self.start..][..floats].copy_from_slice(&source.buffer[source.start..][..floats]);
    }
}
