//! Samples of a run for plots: bounded, and cheap to hand out sixty times a second.

use std::ops::Index;
use std::sync::Arc;

use crate::report::Sample;

/// Samples kept at the most. When they are full, every second one is dropped, and from then on half as many are taken.
const MOST_SAMPLES: usize = 20_000;

/// Springs whose energy costs so little that every step can have a sample.
const SPRINGS_FOR_EVERY_STEP: usize = 20_000;

/// Samples in one shared piece. Only the last piece is copied while a report holds it.
const PIECE: usize = 64;

/// Samples in order of time. A clone shares them.
#[derive(Clone, Debug)]
pub struct Samples {
    /// All but the last piece are full.
    pieces: Vec<Arc<Vec<Sample>>>,
    first: u64,
    every: u64,
}

impl Default for Samples {
    fn default() -> Self {
        Self { pieces: Vec::new(), first: 0, every: 1 }
    }
}

impl Samples {
    /// None yet of a run that begins at step `first`, of a model with so many springs.
    pub(crate) fn new(first: u64, springs: usize) -> Self {
        Self { pieces: Vec::new(), first, every: springs.div_ceil(SPRINGS_FOR_EVERY_STEP).max(1) as u64 }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.pieces.last().map_or(0, |last| (self.pieces.len() - 1) * PIECE + last.len())
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// Steps from one sample to the next.
    pub fn every(&self) -> u64 {
        self.every
    }

    /// The sample of this index.
    pub fn get(&self, index: usize) -> Option<&Sample> {
        self.pieces.get(index / PIECE)?.get(index % PIECE)
    }

    /// The newest.
    pub fn last(&self) -> Option<&Sample> {
        self.pieces.last()?.last()
    }

    /// All of them, in order of time.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &Sample> + Clone {
        self.pieces.iter().flat_map(|piece| piece.iter())
    }

    /// Whether a sample of this step is wanted: it is beyond the newest, and a multiple of the distance.
    pub(crate) fn wants(&self, step: u64) -> bool {
        step >= self.first
            && (step - self.first).is_multiple_of(self.every)
            && self.last().is_none_or(|last| step > last.step)
    }

    pub(crate) fn push(&mut self, sample: Sample) {
        if self.len() >= MOST_SAMPLES {
            self.thin_out();
            if !self.wants(sample.step) {
                return;
            }
        }
        self.append(sample);
    }

    fn append(&mut self, sample: Sample) {
        match self.pieces.last_mut() {
            Some(last) if last.len() < PIECE => Arc::make_mut(last).push(sample),
            _ => {
                let mut piece = Vec::with_capacity(PIECE);
                piece.push(sample);
                self.pieces.push(Arc::new(piece));
            }
        }
    }

    /// Drops the samples of this step and later ones: another branch is taken, or they are to be taken anew.
    pub(crate) fn drop_from(&mut self, step: u64) {
        while let Some(last) = self.pieces.last_mut() {
            if last.first().is_some_and(|first| first.step < step) {
                if last.last().is_some_and(|last| last.step >= step) {
                    Arc::make_mut(last).retain(|sample| sample.step < step);
                }
                return;
            }
            self.pieces.pop();
        }
    }

    /// The first step of which there can be one.
    pub(crate) fn first(&self) -> u64 {
        self.first
    }

    /// With how many samples both begin. What is shared is not looked at.
    pub(crate) fn in_common_with(&self, other: &Self) -> usize {
        let pairs = || self.pieces.iter().zip(&other.pieces);
        let shared = pairs().take_while(|(mine, theirs)| Arc::ptr_eq(mine, theirs)).count();
        let equal = pairs().nth(shared).map_or(0, |(mine, theirs)| {
            mine.iter().zip(&**theirs).take_while(|(mine, theirs)| mine == theirs).count()
        });
        self.len().min(shared * PIECE + equal)
    }

    /// So many of these samples, and then others. `None` if there are not so many.
    pub(crate) fn continued(&self, kept: usize, first: u64, every: u64, more: Vec<Sample>) -> Option<Self> {
        if kept > self.len() || every == 0 {
            return None;
        }
        let mut pieces = self.pieces[..kept.div_ceil(PIECE)].to_vec();
        if let Some(last) = pieces.last_mut().filter(|_| !kept.is_multiple_of(PIECE))
            && last.len() > kept % PIECE
        {
            Arc::make_mut(last).truncate(kept % PIECE);
        }
        let mut samples = Self { pieces, first, every };
        more.into_iter().for_each(|sample| samples.append(sample));
        Some(samples)
    }

    fn thin_out(&mut self) {
        self.every = self.every.saturating_mul(2);
        let (first, every) = (self.first, self.every);
        let kept: Vec<Sample> =
            self.iter().filter(|sample| (sample.step - first).is_multiple_of(every)).cloned().collect();
        self.pieces = kept.chunks(PIECE).map(|piece| Arc::new(piece.to_vec())).collect();
    }
}

impl Index<usize> for Samples {
    type Output = Sample;

    /// # Panics
    /// If there is no such sample; [`get`](Samples::get) does not.
    fn index(&self, index: usize) -> &Sample {
        &self.pieces[index / PIECE][index % PIECE]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::Energy;

    fn sample(step: u64) -> Sample {
        Sample { step, time: 0.01 * step as f64, energy: Energy::default(), values: Vec::new() }
    }

    #[test]
    fn they_stay_bounded_in_order_and_evenly_spaced() {
        let mut samples = Samples::new(0, 10);
        for step in 0..100_000 {
            if samples.wants(step) {
                samples.push(sample(step));
            }
            assert!(samples.len() <= MOST_SAMPLES);
        }
        assert_eq!(samples.every(), 8);
        let steps: Vec<u64> = samples.iter().map(|sample| sample.step).collect();
        assert_eq!(steps.len(), samples.len());
        assert!(steps.iter().enumerate().all(|(index, &step)| step == 8 * index as u64));
        assert_eq!(samples[777].step, 8 * 777);
    }

    #[test]
    fn a_branch_drops_what_lies_beyond_and_leaves_earlier_copies_alone() {
        let mut samples = Samples::new(0, 10);
        (0..200).for_each(|step| samples.push(sample(step)));
        let copy = samples.clone();
        samples.drop_from(130);
        assert_eq!((samples.len(), samples.last().map(|last| last.step)), (130, Some(129)));
        assert!(samples.wants(130) && !samples.wants(129));
        samples.push(sample(130));
        assert_eq!((copy.len(), copy[150].step), (200, 150));
        samples.drop_from(128);
        assert_eq!(samples.len(), 128);
        samples.drop_from(0);
        assert!(samples.is_empty() && samples.last().is_none() && samples.get(0).is_none());
    }
}
