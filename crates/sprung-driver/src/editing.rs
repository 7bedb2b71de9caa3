//! Edits, undo and redo, automatic sub-steps, fixes.

use std::sync::Arc;

use sprung::{Change, Code, Error, Params, Result};

use crate::command::{Edit, Fix};
use crate::driver::Driver;
use crate::fixes::mended;
use crate::settings::{Setting, with_hands_of, without_hands};
use crate::substeps::Auto;

impl Driver {
    /// The setting as it is now.
    fn setting(&self) -> Setting {
        Setting { params: Arc::new(without_hands(self.run.params())), auto: self.auto }
    }

    /// Makes all of an edit's changes, or none.
    pub(crate) fn edit(&mut self, edit: &Edit) -> Result<()> {
        let is_hand =
            |change: &Change| matches!(change, Change::Grab(_) | Change::Release(_) | Change::Carry(..));
        if edit.changes.iter().any(is_hand) {
            let error = Error::new(Code::Unsupported, "an edit cannot grab, carry or release points");
            return Err(error.with_fix("pull at a point instead"));
        }
        let model = self.opened.model.clone();
        let mut wanted = self.run.params().clone();
        edit.changes.iter().try_for_each(|change| wanted.apply(&model, change))?;
        // Whoever sets the step by hand has taken it over.
        let sets_step =
            edit.changes.iter().any(|change| matches!(change, Change::Dt(_) | Change::Substeps(_)));
        let auto = self.auto.filter(|_| !sets_step);
        let before = self.setting();
        match &edit.changes[..] {
            // As it is, where that is all: what the run's log then keeps is not every spring's value, but one.
            [change] if auto.is_none() && !matches!(change, Change::Place(..)) => {
                if self.run.set_by(change.clone(), &wanted)? {
                    self.run.mark(&edit.label);
                }
                self.auto = None;
            }
            _ => self.put(&Setting { params: Arc::new(wanted), auto }, &edit.label)?,
        }
        self.undo.push(&edit.label, before, self.setting(), edit.continues);
        // Where a point is is no parameter: it cannot be undone.
        for change in edit.changes.iter().filter(|change| matches!(change, Change::Place(..))) {
            self.run.change(change.clone())?;
            self.jumped();
        }
        Ok(())
    }

    /// From now on these are the parameters, with sub-steps chosen if `auto` says so. Can be undone.
    fn edit_to(&mut self, label: &str, wanted: Params, auto: Option<Auto>, continues: bool) -> Result<()> {
        let before = self.setting();
        self.put(&Setting { params: Arc::new(wanted), auto }, label)?;
        self.undo.push(label, before, self.setting(), continues);
        Ok(())
    }

    /// Puts a setting in force from now on, and marks where that changes something.
    fn put(&mut self, setting: &Setting, label: &str) -> Result<()> {
        let mut params = with_hands_of(&setting.params, self.run.params());
        if let Some(auto) = setting.auto {
            (params.dt, params.substeps) = auto.choose(&self.opened.model, &params)?;
        }
        if self.run.set(&params)? {
            self.run.mark(label);
        }
        self.auto = setting.auto;
        Ok(())
    }

    pub(crate) fn take_back(&mut self) -> Result<()> {
        if let Some((label, setting)) = self.undo.last_done() {
            let (label, setting) = (format!("undo {label}"), setting.clone());
            self.put(&setting, &label)?;
            self.undo.took_back();
        }
        Ok(())
    }

    pub(crate) fn make_again(&mut self) -> Result<()> {
        if let Some((label, setting)) = self.undo.last_undone() {
            let (label, setting) = (format!("redo {label}"), setting.clone());
            self.put(&setting, &label)?;
            self.undo.made_again();
        }
        Ok(())
    }

    /// The scene's own parameters once more. Sub-steps are then the scene's, too.
    pub(crate) fn own_values(&mut self) -> Result<()> {
        self.edit_to("own values", (*self.opened.params).clone(), None, false)
    }

    /// Chooses sub-steps from now on, or puts back those from before.
    pub(crate) fn switch_auto(&mut self, on: bool) -> Result<()> {
        let mut params = self.run.params().clone();
        match (on, self.auto) {
            (true, None) => {
                let auto = Auto::new(&params);
                self.edit_to("auto sub-steps on", params, Some(auto), false)
            }
            (false, Some(auto)) => {
                (params.dt, params.substeps) = auto.own;
                self.edit_to("auto sub-steps off", params, None, false)
            }
            _ => Ok(()),
        }
    }

    /// A hand has come or gone: sub-steps are chosen anew if they are to be.
    pub(crate) fn choose_substeps(&mut self) -> Result<()> {
        match self.auto {
            Some(_) => self.put(&self.setting(), "sub-steps"),
            None => Ok(()),
        }
    }

    /// Mends what made the run blow up.
    pub(crate) fn fix(&mut self, fix: Fix) -> Result<()> {
        let params = mended(fix, &self.opened.model, self.run.params())?;
        let auto = self.auto.filter(|_| matches!(fix, Fix::Damping(_)));
        self.edit_to(&fix.to_string(), params, auto, false)?;
        self.clear_trouble();
        Ok(())
    }
}
