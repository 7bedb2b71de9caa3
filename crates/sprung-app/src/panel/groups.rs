//! Bodies and joints as groups of points and springs whose values are changed together.

use std::ops::Range;
use std::sync::{Arc, Weak};

use sprung::{Change, Model};

/// A body, or the springs of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The body's or joint's name.
    pub name: String,
    /// Its points; none for a joint.
    pub points: Range<usize>,
    /// Its springs.
    pub springs: Range<usize>,
}

/// The groups of a model: its bodies, then its joints.
pub fn groups(model: &Model) -> Vec<Group> {
    let bodies = model.bodies().iter().map(|body| Group {
        name: body.name.clone(),
        points: body.points.clone(),
        springs: body.springs.clone(),
    });
    let joints = model.joints().iter().map(|joint| Group {
        name: joint.name.clone(),
        points: 0..0,
        springs: joint.springs.clone(),
    });
    bodies.chain(joints).collect()
}

/// The least and the greatest of some values; equal where they do not vary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The least.
    pub low: f32,
    /// The greatest.
    pub high: f32,
}

impl Spread {
    /// Of some values; `None` if there are none.
    pub fn of(mut values: impl Iterator<Item = f32>) -> Option<Self> {
        let first = values.next()?;
        let start = Self { low: first, high: first };
        Some(
            values.fold(start, |spread, value| Self {
                low: spread.low.min(value),
                high: spread.high.max(value),
            }),
        )
    }

    /// Whether all values are the same.
    pub fn is_uniform(self) -> bool {
        self.low == self.high
    }
}

/// Spreads of one long array, one for each group: found anew only when the array is another one. A spring's value may
/// be one of millions, and the panel is drawn sixty times a second.
#[derive(Debug, Default)]
pub struct Spreads {
    array: Weak<Vec<f32>>,
    spreads: Vec<Option<Spread>>,
}

impl Spreads {
    /// The spreads of what `value` gives for the indices in these ranges, which follows from the array.
    pub fn of(
        &mut self,
        array: &Arc<Vec<f32>>,
        ranges: impl Iterator<Item = Range<usize>>,
        value: impl Fn(usize) -> Option<f32>,
    ) -> &[Option<Spread>] {
        // A weak reference keeps the place of an array that is gone from being taken by a new one.
        if !Weak::ptr_eq(&self.array, &Arc::downgrade(array)) {
            self.array = Arc::downgrade(array);
            self.spreads = ranges.map(|range| Spread::of(range.filter_map(&value))).collect();
        }
        &self.spreads
    }
}

/// One change for each stretch of neighbours that get the same value; `None` leaves one as it is.
pub fn stretches<T: PartialEq + Copy>(
    range: Range<usize>,
    value: impl Fn(usize) -> Option<T>,
    change: impl Fn(Range<usize>, T) -> Change,
) -> Vec<Change> {
    let mut changes = Vec::new();
    let mut open: Option<(usize, T)> = None;
    for index in range.clone() {
        let next = value(index);
        if open.map(|(_, value)| value) != next {
            changes.extend(open.map(|(start, value)| change(start..index, value)));
            open = next.map(|value| (index, value));
        }
    }
    changes.extend(open.map(|(start, value)| change(start..range.end, value)));
    changes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_with_the_same_value_are_one_change() {
        let values = [None, Some(1.0), Some(1.0), Some(2.0), None, Some(2.0)];
        let changes = stretches(0..6, |index| values[index], Change::Mass);
        assert_eq!(changes, [Change::Mass(1..3, 1.0), Change::Mass(3..4, 2.0), Change::Mass(5..6, 2.0)]);
        assert!(stretches(3..3, |_| Some(1.0), Change::Mass).is_empty());
    }

    #[test]
    fn spreads_are_found_anew_when_the_array_is_another() {
        let mut spreads = Spreads::default();
        let mut array = Arc::new(vec![1.0, 0.0, 2.0]);
        let spread = |spreads: &mut Spreads, array: &Arc<Vec<f32>>| {
            let counts = |index: usize| Some(array[index]).filter(|&value| value != 0.0);
            spreads.of(array, std::iter::once(0..3), counts)[0]
        };
        assert_eq!(spread(&mut spreads, &array), Some(Spread { low: 1.0, high: 2.0 }));
        Arc::make_mut(&mut array)[0] = -1.0;
        assert_eq!(spread(&mut spreads, &array), Some(Spread { low: -1.0, high: 2.0 }));
        assert_eq!(spread(&mut spreads, &Arc::new(vec![0.0; 3])), None);
    }
}
