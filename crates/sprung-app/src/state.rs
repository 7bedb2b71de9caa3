//! What all parts of the window share.

use std::collections::VecDeque;
use std::sync::Arc;

use sprung::Error;
use sprung::scene::Scene;
use sprung::stability::Setter;
use sprung_driver::{Command, Edit, Handle, Report, Source};
use sprung_render::appearance::Appearance;
use sprung_render::turntable::Turntable;

use crate::action::Action;
use crate::explain::Stage;
use crate::files::{Files, Found, Origin, Refused};
use crate::media::{Filming, SaveRequest};
use crate::motion::{Manner, Motion};
use crate::plots::PlotKind;

/// A point or a spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pick {
    /// A point, by its index in the model.
    Point(usize),
    /// A spring, by its index in the model.
    Spring(usize),
}

impl From<Setter> for Pick {
    fn from(setter: Setter) -> Self {
        match setter {
            Setter::Point(point) => Self::Point(point),
            Setter::Spring(spring) => Self::Spring(spring),
        }
    }
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

/// What may be written over the scene beyond the usual.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Overlays {
    /// The numbers of points, where there are few.
    pub labels: bool,
    /// How long a step, the upload and the drawing take.
    pub times: bool,
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
    /// The window is as narrow as a phone: there is no room for parts beside the scene, nor for words on buttons.
    pub is_narrow: bool,
    /// What is written over the scene.
    pub overlays: Overlays,
    /// How pictures and films are made, and what becomes of a film.
    pub filming: Filming,
    /// A motion that is being written.
    pub motion: Motion,
    /// How motions are to be written.
    pub motion_manner: Manner,
    /// Pixels for each of the window's points.
    pub pixels_per_point: f32,
    /// Files to be saved, until somebody asks where.
    pub save_requests: Vec<SaveRequest>,
    /// Which plot is shown.
    pub plot: PlotKind,
    /// The stage of the step that is being explained; the view draws its arrows.
    pub explain_stage: Option<Stage>,
    /// Where it is explained: the spring or the point that was chosen, else a spring that is worth a look.
    pub explain_at: Option<Pick>,
    /// Asked for by a key or a button; done at the end of the frame.
    pub actions: Vec<Action>,
    /// Where the scene came from.
    pub files: Files,
    /// On a page: a link to what is open, for the next start.
    pub kept_link: Option<String>,
    /// What this window could not do, one after the other, until each is read. The driver has its own in the report.
    pub refused: VecDeque<Refused>,
    /// What is odd about the meshes of the scene that was opened, a sentence each, until it is read.
    pub warnings: Vec<String>,
    /// A word that is shown for a moment, such as "saved chain.toml".
    pub notice: Option<String>,
    /// Whether the hint of the first start is still to be shown.
    pub hint: bool,
    /// Whether the ghost of an earlier run is wanted.
    pub compares: bool,
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

    /// Opens a scene from there.
    pub fn open(&mut self, source: Source, origin: Origin) {
        self.files.ask(origin);
        self.send(Command::Open(Box::new(source)));
    }

    /// Opens a built-in scene.
    pub fn open_builtin(&mut self, name: &str) {
        match Scene::builtin(name) {
            Ok(scene) => {
                let source = Source { name: name.to_owned(), scene };
                self.open(source, Origin::Builtin(name.to_owned()));
            }
            Err(error) => self.refuse(error),
        }
    }

    /// Opens what was found, or says why it cannot be.
    pub fn open_or_refuse(&mut self, found: Result<(Found, Origin), Refused>) {
        match found {
            Ok((Found::Scene(source), origin)) => self.open(source, origin),
            Ok((Found::Checkpoint(kept), origin)) => {
                self.files.ask(origin);
                self.send(Command::GoOn(kept));
            }
            Err(refused) => self.queue(refused),
        }
    }

    /// Puts up a card that says what could not be done; after those that are not read yet.
    pub fn refuse(&mut self, error: Error) {
        self.queue(Refused { error, text: None });
    }

    fn queue(&mut self, refused: Refused) {
        // Saying the same again and again would not help.
        if self.refused.back().is_none_or(|last| last.error != refused.error) {
            self.refused.push_back(refused);
        }
    }

    /// Says something for a moment.
    pub fn say(&mut self, notice: impl Into<String>) {
        self.notice = Some(notice.into());
    }
}
