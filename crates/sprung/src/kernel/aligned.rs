//! Arrays of floats that begin at a cache line, x, y and z apart.

use bytemuck::{Zeroable, zeroed_vec};

/// Bytes in a cache line, to which arrays are aligned.
const LINE_BYTES: usize = 64;

/// So many arrays of floats of the same length, each beginning at a cache line; zeros at first.
///
/// Some are read through windows of a fixed length, however short they are: a window that reaches beyond the end of an array
/// shows the next one, and beyond the last there is room to spare.
#[derive(Debug, Default)]
pub(super) struct Arrays<const N: usize, T = f32> {
    buffer: Vec<T>,
    start: usize,
    stride: usize,
    len: usize,
    spare: usize,
}

impl<const N: usize, T: Zeroable + Copy> Arrays<N, T> {
    /// Floats in a cache line.
    const LINE: usize = LINE_BYTES / size_of::<T>();

    pub fn new(len: usize) -> Self {
        Self::with_windows(len, 0)
    }

    /// Arrays in which windows of so many floats may begin anywhere.
    pub fn with_windows(len: usize, spare: usize) -> Self {
        // Some lines more than needed: arrays a multiple of 4096 bytes apart would compete for the same lines of the cache.
        let stride = len.next_multiple_of(Self::LINE) + 23 * Self::LINE;
        // Room to spare costs nothing where the system makes zeros only when they are touched.
        let buffer: Vec<T> = zeroed_vec(N * stride + Self::LINE + spare);
        let start = buffer.as_ptr().align_offset(LINE_BYTES).min(Self::LINE);
        Self { buffer, start, stride, len, spare }
    }

    /// Floats in each array.
    pub fn len(&self) -> usize {
        self.len
    }

    /// How long a window may be.
    pub fn spare(&self) -> usize {
        self.spare
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

    /// What lies from a place of each array on, until the end of all.
    #[inline(always)]
    pub fn onwards(&self, from: usize) -> [&[T]; N] {
        let mut all: [&[T]; N] = [&[]; N];
        for (index, array) in all.iter_mut().enumerate() {
            *array = &self.buffer[self.start + index * self.stride + from..];
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
        let mut copy = Self::with_windows(self.len, self.spare);
        copy.clone_from(self);
        copy
    }

    fn clone_from(&mut self, source: &Self) {
        if (self.len, self.spare) != (source.len, source.spare) {
            *self = Self::with_windows(source.len, source.spare);
        }
        let floats = N * source.stride;
        self.buffer[self.start..][..floats].copy_from_slice(&source.buffer[source.start..][..floats]);
    }
}
