//! Undo and redo: settings before and after each edit.
//!
//! An edit holds from the step on at which it is made, and so does taking it back: the past stays as it was.

use sprung::Model;

use crate::settings::Setting;

/// Edits kept at the most.
const DEEPEST: usize = 200;

/// Edits kept of even the largest model.
const SHALLOWEST: usize = 10;

/// Memory that edits of long arrays may take in the worst case, bytes.
const BYTES: usize = 256 << 20;

/// The edits that were made, and those that were taken back.
#[derive(Clone, Debug)]
pub(crate) struct Undo {
    done: Vec<Entry>,
    undone: Vec<Entry>,
    deepest: usize,
    /// Whether the last edit may go on: nothing else has happened since.
    is_open: bool,
}

#[derive(Clone, Debug)]
struct Entry {
    label: String,
    before: Setting,
    after: Setting,
}

impl Undo {
    pub fn new(model: &Model) -> Self {
        // Stiffness, damping, rest length and cut of a spring; mass and pin of a point.
        let most_bytes = 13 * model.spring_count() + 5 * model.point_count();
        let deepest = (BYTES / most_bytes.max(1)).clamp(SHALLOWEST, DEEPEST);
        Self { done: Vec::new(), undone: Vec::new(), deepest, is_open: false }
    }

    /// An edit was made. If it goes on with the last one, the two are one.
    pub fn push(&mut self, label: &str, before: Setting, after: Setting, continues: bool) {
        if before.is_same(&after) {
            return;
        }
        self.undone.clear();
        match self.done.last_mut() {
            Some(last) if continues && self.is_open && last.label == label => last.after = after,
            _ => {
                if self.done.len() >= self.deepest {
                    self.done.remove(0);
                }
                self.done.push(Entry { label: label.to_owned(), before, after });
            }
        }
        self.is_open = true;
        // A slider that is back where it was has changed nothing. Should it go on, that is another edit.
        if self.done.pop_if(|last| last.before.is_same(&last.after)).is_some() {
            self.is_open = false;
        }
    }

    /// The last edit's label and the setting before it.
    pub fn last_done(&self) -> Option<(&str, &Setting)> {
        self.done.last().map(|entry| (&*entry.label, &entry.before))
    }

    /// The label of the edit that was taken back last, and the setting after it.
    pub fn last_undone(&self) -> Option<(&str, &Setting)> {
        self.undone.last().map(|entry| (&*entry.label, &entry.after))
    }

    /// The last edit has been taken back.
    pub fn took_back(&mut self) {
        self.is_open = false;
        self.undone.extend(self.done.pop());
    }

    /// The edit that was taken back last has been made once more.
    pub fn made_again(&mut self) {
        self.is_open = false;
        self.done.extend(self.undone.pop());
    }
}
