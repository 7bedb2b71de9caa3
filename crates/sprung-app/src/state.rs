//! What all parts of the window share.

use std::sync::Arc;

use sprung_driver::{Command, Edit, Handle, Report};
use sprung_render::appearance::Appearance;
use sprung_render::turntable::Turntable;

use crate::action::Action;

/// A point or a spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pick {
    /// A point, by its index in the model.
    Point(usize),
    /// A spring, by its index in the model.
    Spring(usize),
}

/// What a press in the scene does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Pulls at points.
    #[default]
    Hand,
    /// Parts springs.
    Scissors,
}

/// Which parts of the window are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    /// The panel with scenes and parameters.
    pub controls: bool,
    /// The plots.
    pub plots: bool,
    /// "How it works".
    pub explain: bool,
    /// The card with all keys.
    pub help: bool,
    /// Nothing but the scene.
    pub presentation: bool,
}

/// What all parts of the window share: they read the report, and ask for things through the driver or as actions.
pub struct AppState {
    /// Where commands go.
    pub driver: Handle,
    /// How the simulation is; the same through a whole frame of the window.
    pub report: Arc<Report>,
    /// How the scene is to look.
    pub appearance: Appearance,
    /// From where it is seen.
    pub camera: Turntable,
    /// What a press in the scene does.
    pub tool: Tool,
    /// What was chosen to be looked at.
    pub selection: Option<Pick>,
    /// What the cursor is on.
    pub hovered: Option<Pick>,
    /// Springs and points that a card, a lesson or the stability meter points out.
    pub pointed_out: Vec<Pick>,
    /// Which parts are shown.
    pub shown: Shown,
    /// Asked for by a key or a button; done at the end of the frame.
    pub actions: Vec<Action>,
}

impl AppState {
    /// Asks the driver for something.
    pub fn send(&mut self, command: Command) {
        self.driver.send(command);
    }

    /// Changes parameters, as one edit that can be undone.
    pub fn edit(&mut self, edit: Edit) {
        self.driver.send(Command::Edit(edit));
    }

    /// Asks for an action, as its key would.
    pub fn act(&mut self, action: Action) {
        self.actions.push(action);
    }
}
