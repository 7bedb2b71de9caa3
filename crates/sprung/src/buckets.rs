//! Sorting by a small whole number.

/// Values sorted by bucket, and within a bucket in the order in which they came.
#[derive(Clone, Debug)]
pub(crate) struct Buckets<T> {
    /// Where each bucket begins in `values`, and the total at the end.
    starts: Vec<usize>,
    values: Vec<T>,
}

impl<T: Copy + Default> Buckets<T> {
    /// From pairs of bucket and value. Counting sort: goes through the pairs twice.
    pub fn new(buckets: usize, pairs: impl Iterator<Item = (usize, T)> + Clone) -> Self {
        // Each bucket is counted two places up. So sums turn counts into where to write next, one place up, and writing
        // turns these into where the next bucket begins.
        let mut starts = vec![0usize; buckets + 2];
        for (bucket, _) in pairs.clone() {
            starts[bucket + 2] += 1;
        }
        for bucket in 2..starts.len() {
            starts[bucket] += starts[bucket - 1];
        }
        let mut values = vec![T::default(); starts[buckets + 1]];
        for (bucket, value) in pairs {
            values[starts[bucket + 1]] = value;
            starts[bucket + 1] += 1;
        }
        starts.pop();
        Self { starts, values }
    }

    /// The values of one bucket.
    pub fn of(&self, bucket: usize) -> &[T] {
        &self.values[self.starts[bucket]..self.starts[bucket + 1]]
    }

    /// The values of all buckets, one after the other.
    pub fn into_values(self) -> Vec<T> {
        self.values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_sorted_by_bucket_and_keep_their_order() {
        let buckets = Buckets::new(4, [(2, 'a'), (0, 'b'), (2, 'c'), (3, 'd')].into_iter());
        assert_eq!([0, 1, 2, 3].map(|bucket| buckets.of(bucket)), [&['b'][..], &[], &['a', 'c'], &['d']]);
        assert_eq!(buckets.into_values(), ['b', 'a', 'c', 'd']);
        assert!(Buckets::<u32>::new(0, [].into_iter()).into_values().is_empty());
    }
}
