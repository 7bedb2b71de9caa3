//! Everything that a key or a button can do: the one list that menus, help and tests read.

use egui::{Event, Key, KeyboardShortcut, Modifiers};

use crate::icon::{self, Icon};

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
    /// To the first recorded moment.
    Start,
    /// To the newest recorded moment.
    End,
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
    /// Goes to the next stage of the step that is being explained.
    NextStage,
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
    /// Saves the running simulation as a checkpoint.
    Checkpoint,
    /// Saves the picture.
    Picture,
    /// Begins or ends an animation.
    Record,
    /// Saves the recorded motion for other programs.
    Motion,
    /// Copies a link to the scene as it is.
    #[cfg(target_arch = "wasm32")]
    Link,
    /// Closes the window.
    #[cfg(not(target_arch = "wasm32"))]
    Quit,
    /// Opens one of the four scenes of the report, by its number from zero.
    Scene(usize),
}

/// An action as people see it.
#[derive(Clone, Copy, Debug)]
pub struct ActionInfo {
    /// What it does.
    pub action: Action,
    /// Its keys; any of them.
    pub keys: &'static [KeyboardShortcut],
    /// A sign for buttons.
    pub icon: Icon,
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
    ($action:expr, [$($key:expr),*], $icon:expr, $name:literal, $description:literal) => {
        ActionInfo {
            action: $action,
            keys: &[$($key),*],
            icon: $icon,
            name: $name,
            description: $description,
        }
    };
}

/// Every action.
pub static ACTIONS: &[ActionInfo] = &[
    action!(Action::PlayPause, [key(Key::Space)], icon::PLAY, "Play", "Plays or pauses."),
    action!(Action::Step, [key(Key::S)], icon::STEP, "Step", "Pauses and takes one step of dt."),
    action!(
        Action::Frame,
        [key(Key::F)],
        icon::FRAME,
        "Frame",
        "Pauses and takes one frame: as many steps as there are substeps."
    ),
    action!(
        Action::Reset,
        [key(Key::R)],
        icon::RESET,
        "Reset",
        "Back to the first state, with the parameters as they are."
    ),
    action!(
        Action::Back,
        [key(Key::Z), key(Key::ArrowLeft)],
        icon::BACK,
        "Back",
        "Back by one frame of the recorded run."
    ),
    action!(
        Action::Forward,
        [key(Key::X), key(Key::ArrowRight)],
        icon::FORWARD,
        "Forward",
        "On by one frame of the recorded run."
    ),
    action!(
        Action::Start,
        [key(Key::Home)],
        icon::START,
        "To the start",
        "To the first moment of the recorded run."
    ),
    action!(
        Action::End,
        [key(Key::End)],
        icon::END,
        "To the end",
        "To the newest moment of the recorded run."
    ),
    action!(
        Action::Undo,
        [command(Key::Z)],
        icon::UNDO,
        "Undo",
        "Takes the last change of a parameter back."
    ),
    action!(
        Action::Redo,
        [command(Key::Y), KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z)],
        icon::REDO,
        "Redo",
        "Makes the change that was taken back once more."
    ),
    action!(Action::ResetView, [key(Key::V)], icon::WHOLE, "Reset view", "Looks at the whole scene again."),
    action!(
        Action::Scissors,
        [key(Key::C)],
        icon::SCISSORS,
        "Scissors",
        "Changes between the hand, which pulls, and scissors, which part springs."
    ),
    action!(Action::Panel, [key(Key::P)], icon::PANEL, "Panel", "Shows or hides the panel."),
    action!(Action::Plots, [key(Key::G)], icon::PLOTS, "Plots", "Shows or hides the plots."),
    action!(
        Action::Explain,
        [key(Key::E)],
        icon::BULB,
        "How it works",
        "Shows or hides the explanation of the step."
    ),
    action!(
        Action::NextStage,
        [key(Key::N)],
        icon::STEP,
        "Next stage",
        "Goes through the step stage by stage: forces, velocities, positions, and on."
    ),
    action!(
        Action::Help,
        [key(Key::H), key(Key::F1)],
        icon::HELP,
        "Help",
        "Shows or hides the list of keys."
    ),
    action!(
        Action::Presentation,
        [key(Key::F11)],
        icon::SCREEN,
        "Presentation",
        "Nothing but the scene, or everything again."
    ),
    action!(Action::Theme, [key(Key::T)], icon::THEME, "Theme", "Light or dark."),
    action!(Action::Open, [command(Key::O)], icon::FOLDER, "Open…", "Opens a scene file or a checkpoint."),
    action!(
        Action::Save,
        [command(Key::S)],
        icon::SAVE,
        "Save…",
        "Saves the scene with all parameters as they are now."
    ),
    action!(
        Action::Checkpoint,
        [KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S)],
        icon::SAVE,
        "Checkpoint…",
        "Saves the running simulation, to go on with it later."
    ),
    action!(Action::Picture, [command(Key::P)], icon::CAMERA, "Picture…", "Saves what is seen as a picture."),
    action!(Action::Record, [command(Key::R)], icon::FILM, "Film…", "Begins or ends a film of what is seen."),
    action!(
        Action::Motion,
        [command(Key::E)],
        icon::MOTION,
        "Motion…",
        "Saves the recorded motion for other programs: USD, glTF, caches, tables."
    ),
    #[cfg(target_arch = "wasm32")]
    action!(
        Action::Link,
        [command(Key::L)],
        icon::LINK,
        "Copy link",
        "Copies a link that opens this scene, with all that was changed, as it is seen now."
    ),
    #[cfg(not(target_arch = "wasm32"))]
    action!(Action::Quit, [command(Key::Q)], icon::CLOSE, "Quit", "Closes the window."),
    action!(Action::Scene(0), [key(Key::Num1)], icon::LAMP, "spring", "Opens the mass on a spring."),
    action!(Action::Scene(1), [key(Key::Num2)], icon::LAMP, "chain", "Opens the chain pendulum."),
    action!(Action::Scene(2), [key(Key::Num3)], icon::LAMP, "jelly", "Opens the cube of jelly."),
    action!(Action::Scene(3), [key(Key::Num4)], icon::LAMP, "cloth", "Opens the hanging cloth."),
];

impl Action {
    /// How it is shown.
    pub fn info(self) -> &'static ActionInfo {
        ACTIONS.iter().find(|info| info.action == self).unwrap_or(&ACTIONS[0])
    }
}

impl ActionInfo {
    /// Its keys as they are printed on this system's keyboards: `Ctrl+Y or Shift+Ctrl+Z`.
    pub fn keys_text(&self, context: &egui::Context) -> String {
        let keys: Vec<_> = self.keys.iter().map(|key| context.format_shortcut(key)).collect();
        keys.join(" or ")
    }

    /// Description and keys, for tooltips.
    pub fn tooltip(&self, context: &egui::Context) -> String {
        format!("{} ({})", self.description, self.keys_text(context))
    }
}

/// The actions whose keys were pressed. While someone types, keys are text; while a button or a slider has the focus,
/// the keys that work it are its own.
pub fn pressed(context: &egui::Context) -> Vec<Action> {
    if context.text_edit_focused() {
        return Vec::new();
    }
    // Over a card, nothing below it is worked; the help card's key puts it away again.
    let has_card = context.memory(|memory| memory.top_modal_layer().is_some());
    let has_focus = context.memory(|memory| memory.focused().is_some());
    let of_widgets = [Key::Space, Key::ArrowLeft, Key::ArrowRight, Key::Home, Key::End];
    let free = |key: &&KeyboardShortcut| !(has_focus && of_widgets.contains(&key.logical_key));
    let mut keys: Vec<_> = ACTIONS
        .iter()
        .filter(|info| !has_card || info.action == Action::Help)
        .flat_map(|info| info.keys.iter().filter(free).map(|key| (key, info.action)))
        .collect();
    // The longest combinations first: Ctrl+Shift+Z is not Ctrl+Z.
    let count = |key: &KeyboardShortcut| u8::from(key.modifiers.shift) + u8::from(key.modifiers.command);
    keys.sort_by_key(|(key, _)| std::cmp::Reverse(count(key)));
    // Each press counts, in the order of the presses: a slow frame may hold several of the same key.
    let mut pressed = Vec::new();
    context.input_mut(|input| {
        input.events.retain(|event| {
            let Event::Key { key, modifiers, pressed: true, .. } = event else { return true };
            let is_it =
                |of: &KeyboardShortcut| of.logical_key == *key && modifiers.matches_logically(of.modifiers);
            let found = keys.iter().find(|(of, _)| is_it(of));
            pressed.extend(found.map(|(_, action)| *action));
            found.is_none()
        });
    });
    pressed
}
