//! Everything that a key or a button can do: the one list that menus, help and tests read.

use egui::{Key, KeyboardShortcut, Modifiers};

/// Something to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Plays or pauses.
    PlayPause,
    /// Pauses and takes one step.
    Step,
    /// Pauses and takes one frame.
    Frame,
    /// Back to the first state.
    Reset,
    /// Back by a frame.
    Back,
    /// On by a frame of what is recorded.
    Forward,
    /// Takes the last change back.
    Undo,
    /// Makes it once more.
    Redo,
    /// Looks at the whole scene again.
    ResetView,
    /// Hand or scissors.
    Scissors,
    /// Shows or hides the panel.
    Panel,
    /// Shows or hides the plots.
    Plots,
    /// Shows or hides "How it works".
    Explain,
    /// Shows or hides the card with all keys.
    Help,
    /// Nothing but the scene, or everything.
    Presentation,
    /// Light or dark.
    Theme,
    /// Opens a scene file.
    Open,
    /// Saves all parameters as a scene file.
    Save,
    /// Saves the picture.
    Picture,
    /// Begins or ends an animation.
    Record,
    /// Opens a built-in scene of the four, by its number from zero.
    Scene(usize),
}

/// An action as people see it.
#[derive(Clone, Copy, Debug)]
pub struct ActionInfo {
    /// What it does.
    pub action: Action,
    /// Its keys; any of them.
    pub keys: &'static [KeyboardShortcut],
    /// A few words for buttons.
    pub name: &'static str,
    /// A sentence for the help card and tooltips.
    pub description: &'static str,
}

const fn key(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}

const fn command(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}

macro_rules! action {
    ($action:expr, [$($key:expr),*], $name:literal, $description:literal) => {
        ActionInfo { action: $action, keys: &[$($key),*], name: $name, description: $description }
    };
}

/// Every action.
pub static ACTIONS: &[ActionInfo] = &[
    action!(Action::PlayPause, [key(Key::Space)], "Play", "Plays or pauses."),
    action!(Action::Step, [key(Key::S)], "Step", "Pauses and takes one step of dt."),
    action!(
        Action::Frame,
        [key(Key::F)],
        "Frame",
        "Pauses and takes one frame: as many steps as there are substeps."
    ),
    action!(
        Action::Reset,
        [key(Key::R)],
        "Reset",
        "Back to the first state, with the parameters as they are."
    ),
    action!(
        Action::Back,
        [key(Key::Z), key(Key::ArrowLeft)],
        "Back",
        "Back by one frame of the recorded run."
    ),
    action!(
        Action::Forward,
        [key(Key::X), key(Key::ArrowRight)],
        "Forward",
        "On by one frame of the recorded run."
    ),
    action!(Action::Undo, [command(Key::Z)], "Undo", "Takes the last change of a parameter back."),
    action!(
        Action::Redo,
        [command(Key::Y), KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z)],
        "Redo",
        "Makes the change that was taken back once more."
    ),
    action!(Action::ResetView, [key(Key::V)], "Reset view", "Looks at the whole scene again."),
    action!(
        Action::Scissors,
        [key(Key::C)],
        "Scissors",
        "Changes between the hand, which pulls, and scissors, which part springs."
    ),
    action!(Action::Panel, [key(Key::P)], "Panel", "Shows or hides the panel."),
    action!(Action::Plots, [key(Key::G)], "Plots", "Shows or hides the plots."),
    action!(Action::Explain, [key(Key::E)], "How it works", "Shows or hides the explanation of the step."),
    action!(Action::Help, [key(Key::H), key(Key::F1)], "Help", "Shows or hides the list of keys."),
    action!(
        Action::Presentation,
        [key(Key::F11)],
        "Presentation",
        "Nothing but the scene, or everything again."
    ),
    action!(Action::Theme, [key(Key::T)], "Theme", "Light or dark."),
    action!(Action::Open, [command(Key::O)], "Open…", "Opens a scene file."),
    action!(Action::Save, [command(Key::S)], "Save…", "Saves the scene with all parameters as they are now."),
    action!(Action::Picture, [command(Key::P)], "Picture…", "Saves what is seen as a picture."),
    action!(Action::Record, [command(Key::R)], "Film…", "Begins or ends a film of what is seen."),
    action!(Action::Scene(0), [key(Key::Num1)], "spring", "Opens the mass on a spring."),
    action!(Action::Scene(1), [key(Key::Num2)], "chain", "Opens the chain pendulum."),
    action!(Action::Scene(2), [key(Key::Num3)], "jelly", "Opens the cube of jelly."),
    action!(Action::Scene(3), [key(Key::Num4)], "cloth", "Opens the hanging cloth."),
];

impl Action {
    /// How it is shown.
    pub fn info(self) -> &'static ActionInfo {
        ACTIONS.iter().find(|info| info.action == self).unwrap_or(&ACTIONS[0])
    }
}

/// The actions whose keys were pressed, unless someone is typing.
pub fn pressed(context: &egui::Context) -> Vec<Action> {
    if context.egui_wants_keyboard_input() {
        return Vec::new();
    }
    // The longest combinations first: Ctrl+Shift+Z is not Ctrl+Z.
    let mut found = Vec::new();
    context.input_mut(|input| {
        let mut keys: Vec<_> =
            ACTIONS.iter().flat_map(|info| info.keys.iter().map(|key| (key, info.action))).collect();
        keys.sort_by_key(|(key, _)| !(key.modifiers.shift || key.modifiers.command));
        for (key, action) in keys {
            if input.consume_shortcut(key) {
                found.push(action);
            }
        }
    });
    found
}
