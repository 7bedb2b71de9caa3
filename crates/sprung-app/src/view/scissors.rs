//! Scissors: a line drawn across springs parts them.

use std::collections::BTreeSet;

use glam::Vec2;
use sprung::{Change, Model};
use sprung_driver::Edit;

use super::drawn::Drawn;
use super::pick::{Seen, segments_cross};

/// A cut that is being drawn.
///
/// Springs move while it is drawn, so each piece of the line is held against the springs as they are at that moment; all
/// that were crossed are cut at the end, as one edit.
#[derive(Clone, Debug, Default)]
pub struct Cut {
    /// The line so far, from the view's corner.
    pub line: Vec<Vec2>,
    /// The springs that it crossed.
    pub springs: BTreeSet<usize>,
}

impl Cut {
    /// Begins at a place.
    pub fn begin(cursor: Vec2) -> Self {
        Self { line: vec![cursor], springs: BTreeSet::new() }
    }

    /// Goes on to a place, across what is drawn and not yet cut.
    pub fn go_on(&mut self, cursor: Vec2, model: &Model, cut: &[bool], drawn: &Drawn, seen: &Seen) {
        let Some(&last) = self.line.last() else { return };
        if (cursor - last).length() < 1.0 {
            return;
        }
        self.springs.extend(crossed(last, cursor, model, cut, drawn, seen));
        self.line.push(cursor);
    }

    /// Cuts the spring that was clicked, unless the line has crossed some on the way.
    pub fn click(&mut self, spring: usize) {
        if self.springs.is_empty() {
            self.springs.insert(spring);
        }
    }

    /// The edit that makes the cut; `None` if nothing was crossed.
    pub fn edit(&self) -> Option<Edit> {
        let label = match self.springs.len() {
            0 => return None,
            1 => "cut a spring".to_owned(),
            count => format!("cut {count} springs"),
        };
        Some(Edit::new(label, changes(&self.springs)))
    }
}

/// The springs that a line from `a` to `b` crosses in the picture.
pub fn crossed(a: Vec2, b: Vec2, model: &Model, cut: &[bool], drawn: &Drawn, seen: &Seen) -> Vec<usize> {
    // Most are far away, which these tell at once.
    let sides = seen.sides(a.min(b), a.max(b));
    let is_crossed = |&spring: &usize| {
        let [i, j] = model.springs()[spring];
        if sides[i as usize] & sides[j as usize] != 0 || cut.get(spring) != Some(&false) {
            return false;
        }
        seen.ends([i, j]).is_some_and(|(c, d)| segments_cross(a, b, c, d))
    };
    drawn.springs_in_reach().filter(is_crossed).collect()
}

/// A change for each run of neighbours in the list.
fn changes(springs: &BTreeSet<usize>) -> Vec<Change> {
    let mut ranges: Vec<std::ops::Range<usize>> = Vec::new();
    for &spring in springs {
        match ranges.last_mut() {
            Some(range) if range.end == spring => range.end += 1,
            _ => ranges.push(spring..spring + 1),
        }
    }
    ranges.into_iter().map(|range| Change::Cut(range, true)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_cut_together() {
        let springs = BTreeSet::from([3, 4, 5, 9]);
        assert_eq!(changes(&springs), [Change::Cut(3..6, true), Change::Cut(9..10, true)]);
        let cut = Cut { springs, ..Cut::default() };
        assert_eq!(cut.edit().map(|edit| edit.label), Some("cut 4 springs".to_owned()));
        assert_eq!(Cut::default().edit(), None);
    }
}
