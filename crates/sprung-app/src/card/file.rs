//! The cards to open and to save a scene or a checkpoint, and the question whether a file may be replaced.

use std::path::{Path, PathBuf};

use egui::{ComboBox, Context, RichText, TextEdit, Ui, vec2};
use sprung::scene::Kind;
use sprung_driver::Command;
use sprung_io::{Up, checkpoint};

use super::{modal, primary};
use crate::files::{self, Dialog, ENDING, OPENED, Origin, Wanted};
use crate::media::{Film, SaveRequest, file_stem};
use crate::motion::{self, Motion};
use crate::panel::scenes::{entries, scene_button};
use crate::state::AppState;
use crate::text::steady;

/// What the card is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Purpose {
    Open,
    Save,
    /// The simulation as it is, which the driver keeps meanwhile.
    Checkpoint,
    /// A picture, or the numbers of a plot, that is ready.
    Picture,
    /// A film that was recorded; the view writes it.
    Film,
    /// The recorded motion, for other programs.
    Motion,
}

/// A card with a path.
pub struct FileCard {
    purpose: Purpose,
    path: String,
    dialog: Option<Dialog>,
    /// A file that is there already, and may be replaced only if the user says so.
    asks_to_replace: Option<PathBuf>,
    /// It was closed while a film waits, which is lost only if the user says so.
    asks_to_discard: bool,
    /// The ending of what is saved, for a path that has none.
    ending: &'static str,
    /// The path is to be taken, once what is to be saved is there.
    is_entered: bool,
    /// It has just been put up.
    is_new: bool,
}

impl FileCard {
    /// To open a scene.
    pub fn open() -> Self {
        Self {
            purpose: Purpose::Open,
            path: String::new(),
            dialog: None,
            asks_to_replace: None,
            asks_to_discard: false,
            ending: ENDING,
            is_entered: false,
            is_new: true,
        }
    }

    /// To save the one that is open.
    pub fn save(state: &AppState) -> Self {
        let path = state.files.path_to_save().display().to_string();
        Self { purpose: Purpose::Save, path, ..Self::open() }
    }

    /// To save the simulation as it is now.
    pub fn checkpoint(state: &mut AppState) -> Self {
        let mut card = Self::save(state);
        card.choose(Purpose::Checkpoint, state);
        card
    }

    /// To save a picture that waits in the state.
    pub fn picture(request: &SaveRequest) -> Self {
        let ending =
            ["svg", "csv"].into_iter().find(|ending| request.name.ends_with(ending)).unwrap_or("png");
        Self { purpose: Purpose::Picture, path: request.name.clone(), ending, ..Self::open() }
    }

    /// To save a film that waits; its ending says as what.
    pub fn film(name: &str) -> Self {
        Self { purpose: Purpose::Film, path: name.to_owned(), ending: "gif", ..Self::open() }
    }

    /// To save the recorded motion.
    pub fn motion(state: &mut AppState) -> Self {
        state.send(Command::Play(false));
        let ending = "usdc";
        let path = format!("{}.{ending}", file_stem(&state.report.opened.name));
        Self { purpose: Purpose::Motion, path, ending, ..Self::open() }
    }

    /// What it is called.
    pub fn title(&self) -> &'static str {
        match self.purpose {
            Purpose::Open => "Open a scene",
            Purpose::Save => "Save the scene",
            Purpose::Checkpoint => "Save a checkpoint",
            Purpose::Picture if self.ending == "csv" => "Save the numbers",
            Purpose::Picture => "Save the picture",
            Purpose::Film => "Save the film",
            Purpose::Motion => "Save the motion",
        }
    }

    /// What waited to be saved has been, or is not wanted.
    pub fn finish(&self, state: &mut AppState) {
        match self.purpose {
            Purpose::Picture if !state.save_requests.is_empty() => {
                state.save_requests.remove(0);
            }
            Purpose::Checkpoint => state.send(Command::Checkpoint(false)),
            Purpose::Film if matches!(state.filming.film, Film::Waits(_)) => {
                state.filming.film = Film::Unwanted;
            }
            _ => {}
        }
    }

    /// The card; gives whether it is done with.
    pub fn show(&mut self, context: &Context, state: &mut AppState) -> bool {
        if let Some(dialog) = &mut self.dialog
            && let Some(chosen) = dialog.poll(context)
        {
            self.dialog = None;
            if let Some(path) = chosen {
                self.path = path.display().to_string();
                // A dialog of the system has asked about replacing already.
                return self.go(state, true);
            }
        }
        if let Some(path) = self.asks_to_replace.clone() {
            return self.ask_to_replace(context, state, &path);
        }
        if self.asks_to_discard {
            return self.ask_to_discard(context);
        }
        let (purpose, title) = (self.purpose, self.title());
        // The same card, whichever of the two is chosen in it.
        let id = if purpose == Purpose::Checkpoint { Purpose::Save } else { purpose };
        let is_done = modal(context, &format!("{id:?} card"), title, 520.0, |ui| match purpose {
            Purpose::Open => self.open_ui(ui, state),
            Purpose::Save | Purpose::Checkpoint => self.save_ui(ui, state),
            Purpose::Picture => {
                let ending = self.ending;
                let about = match ending {
                    "csv" => "A table with a row for each sample, as CSV.",
                    "svg" => "The plot, as SVG.",
                    _ => "A picture of what is seen, as PNG.",
                };
                self.media_ui(ui, state, "files", &[ending], about)
            }
            Purpose::Film => {
                let (endings, about): (&[&str], _) = if cfg!(target_arch = "wasm32") {
                    (&["gif"], "As an animation that plays everywhere (.gif).")
                } else {
                    (&["gif", "mp4"], "As an animation (.gif), or as a film (.mp4), which needs ffmpeg.")
                };
                self.media_ui(ui, state, "films", endings, about)
            }
            Purpose::Motion => self.motion_ui(ui, state),
        });
        if is_done && purpose == Purpose::Film && matches!(state.filming.film, Film::Waits(_)) {
            self.asks_to_discard = true;
            return false;
        }
        is_done
    }

    fn open_ui(&mut self, ui: &mut Ui, state: &mut AppState) -> bool {
        let wanted =
            Wanted { title: "Open", kind: "scenes and checkpoints", endings: &OPENED, save_as: None };
        let entered = self.path_row(ui, &wanted, "Open");
        ui.weak("A scene (.toml) or a checkpoint (.sprung). Or drop a file onto the window.");
        let mut chosen = false;
        for (kind, title) in [
            (Kind::Report, "The four scenes of the report"),
            (Kind::Gallery, "Gallery"),
            (Kind::Benchmark, "Large, for measuring speed"),
        ] {
            ui.add_space(8.0);
            ui.label(RichText::new(title).strong());
            for entry in entries().iter().filter(|entry| entry.kind == kind) {
                ui.horizontal(|ui| {
                    chosen |= scene_button(ui, state, entry, entry.name, vec2(92.0, 0.0));
                    ui.add(egui::Label::new(&entry.title).truncate());
                });
            }
        }
        chosen || (entered && self.go(state, false))
    }

    fn save_ui(&mut self, ui: &mut Ui, state: &mut AppState) -> bool {
        ui.horizontal(|ui| {
            for (purpose, name) in [(Purpose::Save, "Scene"), (Purpose::Checkpoint, "Checkpoint")] {
                if ui.radio(self.purpose == purpose, name).clicked() {
                    self.choose(purpose, state);
                }
            }
        });
        ui.add_space(4.0);
        let (name, ending) = (self.path.clone(), [self.ending]);
        let kind = if self.purpose == Purpose::Save { "scenes" } else { "checkpoints" };
        let wanted = Wanted { title: self.title(), kind, endings: &ending, save_as: Some(&name) };
        self.is_entered |= self.path_row(ui, &wanted, "Save");
        ui.add_space(4.0);
        if self.purpose == Purpose::Checkpoint {
            let Some(checkpoint) = &state.report.checkpoint else {
                ui.weak("Taking it…");
                return false;
            };
            let time = steady(checkpoint.state.time);
            ui.weak(format!(
                "Saved is the simulation as it is at {time} s, with its scene and all parameters. It goes on from there bit for \
                 bit, when opened here or by `sprung run`. The recorded past and undo are not saved."
            ));
            return std::mem::take(&mut self.is_entered) && self.go(state, false);
        }
        ui.weak(
            "Saved are the scene's bodies as they began, with all parameters as they are now: gravity, dt, sub-steps, masses, \
             springs, pins, ground. `sprung run` takes the same file. Where things are at this moment is not saved.",
        );
        std::mem::take(&mut self.is_entered) && self.go(state, false)
    }

    /// Saves the scene or, as it is at this moment, the simulation.
    fn choose(&mut self, purpose: Purpose, state: &mut AppState) {
        let keeps = purpose == Purpose::Checkpoint;
        self.ending = if keeps { checkpoint::ENDING } else { ENDING };
        (self.purpose, self.is_entered) = (purpose, false);
        if !self.path.is_empty() {
            self.path = Path::new(&self.path).with_extension(self.ending).display().to_string();
        }
        state.send(Command::Checkpoint(keeps));
    }

    fn media_ui(
        &mut self,
        ui: &mut Ui,
        state: &mut AppState,
        kind: &str,
        endings: &[&str],
        about: &str,
    ) -> bool {
        let name = self.path.clone();
        let wanted = Wanted { title: "Save", kind, endings, save_as: Some(&name) };
        let entered = self.path_row(ui, &wanted, "Save");
        ui.weak(about);
        entered && self.go(state, false)
    }

    fn motion_ui(&mut self, ui: &mut Ui, state: &mut AppState) -> bool {
        let endings: Vec<_> = motion::formats().map(|format| format.ending).collect();
        let name = self.path.clone();
        let wanted = Wanted { title: "Save", kind: "motions", endings: &endings, save_as: Some(&name) };
        let entered = self.path_row(ui, &wanted, "Save");
        let of_path = Path::new(&self.path).extension().map(|it| it.to_string_lossy().to_lowercase());
        let chosen = motion::formats().find(|format| Some(format.ending) == of_path.as_deref());
        ui.horizontal(|ui| {
            let shown = chosen.map_or_else(|| "format".to_owned(), |format| format!(".{}", format.ending));
            ComboBox::from_id_salt("format").width(80.0).selected_text(shown).show_ui(ui, |ui| {
                for format in motion::formats() {
                    let text = format!(".{}: {}", format.ending, format.description);
                    if ui
                        .selectable_label(chosen.is_some_and(|it| it.ending == format.ending), text)
                        .clicked()
                    {
                        self.ending = format.ending;
                        self.path = Path::new(&self.path).with_extension(format.ending).display().to_string();
                    }
                }
            });
            let manner = &mut state.motion_manner;
            let rate = |rate: u32| format!("{rate} frames a second");
            ComboBox::from_id_salt("rate").width(150.0).selected_text(rate(manner.rate)).show_ui(ui, |ui| {
                for choice in motion::RATES {
                    ui.selectable_value(&mut manner.rate, choice, rate(choice));
                }
            });
            for (up, name) in [(Up::Y, "Y up"), (Up::Z, "Z up")] {
                ui.radio_value(&mut manner.up, up, name);
            }
        });
        if let Some(format) = chosen {
            ui.weak(format!("{}.", capitalised(format.description)));
        }
        let timeline = &state.report.timeline;
        ui.weak(format!(
            "Saved is the recorded run, {} s of it, with all that hands and changes did. What else formats can hold is said in \
             docs/export.md; `sprung run` has all options.",
            steady(timeline.newest.1 - timeline.first.1)
        ));
        entered && self.go(state, false)
    }

    /// The field for a path, the system's dialog, and the button; gives whether the path is to be taken.
    fn path_row(&mut self, ui: &mut Ui, wanted: &Wanted<'_>, verb: &str) -> bool {
        let mut entered = false;
        // A page sees no files but those that are chosen, and the browser knows where downloads go.
        let (is_page, opens) = (cfg!(target_arch = "wasm32"), wanted.save_as.is_none());
        if is_page && opens {
            if ui.add(primary(ui, "Choose files…")).clicked() {
                self.dialog = Some(Dialog::open(wanted));
            }
            return false;
        }
        ui.horizontal(|ui| {
            let label = ui.label("File");
            let room = (ui.available_width() - if is_page { 90.0 } else { 170.0 }).max(100.0);
            let hint = if is_page { "name of a file" } else { "path of a file" };
            let field = TextEdit::singleline(&mut self.path).hint_text(hint);
            let response = ui.add(field.desired_width(room)).labelled_by(label.id);
            if std::mem::take(&mut self.is_new) {
                response.request_focus();
            }
            entered = response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            let is_free = self.dialog.is_none();
            if !is_page && ui.add_enabled(is_free, egui::Button::new("Browse…")).clicked() {
                self.dialog = Some(Dialog::open(wanted));
            }
            let has_path = !self.path.trim().is_empty();
            let button = primary(ui, verb);
            entered |= ui.add_enabled(has_path, button).clicked();
            entered &= has_path;
        });
        entered
    }

    /// Opens or saves; gives whether the card is done with.
    fn go(&mut self, state: &mut AppState, may_replace: bool) -> bool {
        let path = PathBuf::from(self.path.trim());
        match self.purpose {
            Purpose::Open => {
                let found = files::find(&path);
                state.open_or_refuse(found.map(|found| (found, Origin::file(&path))));
                true
            }
            _ => {
                let path = if path.extension().is_none() { path.with_extension(self.ending) } else { path };
                if path.exists() && !may_replace {
                    self.asks_to_replace = Some(path);
                    return false;
                }
                self.save_to(state, &path)
            }
        }
    }

    /// Whether the file may be replaced; gives whether the card is done with.
    fn ask_to_replace(&mut self, context: &Context, state: &mut AppState, path: &Path) -> bool {
        let text = format!("{} is there already. What it holds now would be lost.", path.display());
        match question(context, "Replace the file?", &text, ["Replace it", "Keep it"]) {
            Some(true) => return self.save_to(state, path),
            Some(false) => self.choose_again(),
            None => {}
        }
        false
    }

    /// Back to the path, to choose another one.
    fn choose_again(&mut self) {
        (self.asks_to_replace, self.is_new) = (None, true);
    }

    /// Whether the film may be lost; gives whether the card is done with.
    fn ask_to_discard(&mut self, context: &Context) -> bool {
        let text = "It is not saved yet, and cannot be made again.";
        let answer = question(context, "Discard the film?", text, ["Discard it", "Back"]);
        if answer == Some(false) {
            (self.asks_to_discard, self.is_new) = (false, true);
        }
        answer == Some(true)
    }

    /// Writes the file and says so, or says why not and keeps all for another path; gives whether the card is done with.
    fn save_to(&mut self, state: &mut AppState, path: &Path) -> bool {
        let written = match self.purpose {
            Purpose::Film => {
                // The view writes it, a little in each frame.
                state.filming.film = Film::To(path.to_owned());
                return true;
            }
            Purpose::Motion => {
                // Written a little in each frame, too.
                return match Motion::begin(state, path, state.motion_manner) {
                    Ok(()) => true,
                    Err(error) => {
                        state.refuse(error);
                        self.choose_again();
                        false
                    }
                };
            }
            Purpose::Picture => match state.save_requests.first() {
                Some(request) => files::write(path, &request.bytes),
                None => return true,
            },
            Purpose::Checkpoint => match state.report.checkpoint.clone() {
                Some(checkpoint) => files::write_checkpoint(path, &state.report, &checkpoint),
                None => return false,
            },
            _ => files::write_scene(path, &state.report),
        };
        match written {
            Ok(bytes) => {
                if self.purpose == Purpose::Save {
                    state.files.origin = Origin::file(path);
                }
                state.say(format!("Saved {} ({bytes} bytes)", path.display()));
                true
            }
            Err(error) => {
                state.refuse(error);
                self.choose_again();
                false
            }
        }
    }
}

/// A phrase as the beginning of a sentence.
fn capitalised(phrase: &str) -> String {
    let mut letters = phrase.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A question whose first answer does harm, and whose second, or closing it, does not; `None` as long as it is open.
fn question(context: &Context, title: &str, text: &str, [harm, harmless]: [&str; 2]) -> Option<bool> {
    let mut answer = None;
    let closed = modal(context, "question card", title, 440.0, |ui| {
        ui.label(text);
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            if ui.add(primary(ui, harm)).clicked() {
                answer = Some(true);
            }
            let keep = ui.button(harmless);
            // The harmless answer is the one under the Enter key.
            if ui.memory(|memory| memory.focused().is_none()) {
                keep.request_focus();
            }
            if keep.clicked() {
                answer = Some(false);
            }
        });
        false
    });
    answer.or(closed.then_some(false))
}
