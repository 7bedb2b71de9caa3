//! The window: its parts and where they lie.

use sprung::scene::Kind;
use sprung_driver::{Command, Handle, Report, Trouble};
use sprung_render::appearance::Theme;
use sprung_render::camera::Bounds;
use sprung_render::turntable::Turntable;

use crate::action::{self, Action};
use crate::files::{Files, Origin};
#[cfg(target_arch = "wasm32")]
use crate::link;
use crate::motion::Motion;
use crate::settings::Settings;
use crate::state::{AppState, Shown, Tool};
use crate::view::View;
use crate::{card, explain, panel, plots, theme, timeline};

/// Width of the panel when the window opens first, points.
const PANEL_WIDTH: f32 = 360.0;

/// Width that its rows need, points.
const LEAST_PANEL_WIDTH: f32 = 336.0;

/// A window that is narrower has no room for the panel beside the scene, points: a phone that is held upright.
const NARROW: f32 = 440.0;

/// A changed scene of more springs is not kept for the next start on a page: to write it down, it has to be built.
#[cfg(target_arch = "wasm32")]
const MOST_KEPT: usize = 100_000;

/// The window.
pub struct App {
    state: AppState,
    timeline: timeline::TimelineBar,
    controls: panel::Controls,
    view: View,
    plots: plots::Plots,
    explain: explain::Explain,
    cards: card::Cards,
    /// The scene that the camera was set up for.
    serial: Option<u64>,
    /// From where the first scene is to be seen.
    first_view: Option<Turntable>,
    /// How much larger everything is, to be kept.
    zoom: f32,
    /// What the window is called now.
    title: String,
    /// The parameters that the kept link was made of.
    #[cfg(target_arch = "wasm32")]
    linked: Option<std::sync::Arc<sprung::Params>>,
}

impl App {
    /// A window on a driver, looking as it did the last time.
    pub fn new(mut driver: Handle, context: &eframe::CreationContext<'_>) -> Self {
        theme::install(&context.egui_ctx);
        let settings = Settings::load(context.storage);
        context.egui_ctx.set_zoom_factor(settings.zoom());
        let report = driver.report();
        driver.send(Command::Play(true));
        let camera = Turntable::framing(&Bounds::default(), 1.0);
        let origin = Origin::of(&report.opened.name, &report.opened.scene);
        let warnings = report.opened.scene.mesh_warnings();
        let state = AppState {
            driver,
            report,
            appearance: settings.appearance(),
            camera,
            tool: Tool::Hand,
            selection: None,
            hovered: None,
            pointed_out: Vec::new(),
            shown: settings.shown(),
            is_narrow: false,
            overlays: Default::default(),
            filming: Default::default(),
            motion: Default::default(),
            motion_manner: Default::default(),
            pixels_per_point: 1.0,
            save_requests: Vec::new(),
            plot: Default::default(),
            explain_stage: None,
            explain_at: None,
            actions: Vec::new(),
            files: Files::new(origin),
            kept_link: None,
            refused: Default::default(),
            warnings,
            notice: None,
            hint: !settings.hint_taken,
            compares: false,
        };
        Self {
            state,
            timeline: Default::default(),
            controls: Default::default(),
            view: View::new(context.wgpu_render_state.as_ref()),
            plots: Default::default(),
            explain: Default::default(),
            cards: Default::default(),
            serial: None,
            first_view: None,
            zoom: settings.zoom(),
            title: String::new(),
            #[cfg(target_arch = "wasm32")]
            linked: None,
        }
    }

    /// The scene that is open first is seen from there.
    pub fn look_from(&mut self, view: Turntable) {
        self.first_view = Some(view);
    }

    /// What the parts of the window share.
    pub fn state(&self) -> &AppState {
        &self.state
    }

    /// The same, to act on.
    pub fn state_mut(&mut self) -> &mut AppState {
        &mut self.state
    }

    fn show(&mut self, ui: &mut egui::Ui) {
        let is_narrow = ui.available_width() < NARROW;
        if is_narrow && !self.state.is_narrow {
            // The scene first: the parts beside it fold away until they are asked for.
            self.state.shown = Shown { controls: false, plots: false, explain: false, ..self.state.shown };
        }
        self.state.is_narrow = is_narrow;
        let state = &mut self.state;
        theme::apply(ui.ctx(), state.appearance.theme);
        if !state.shown.presentation {
            egui::Panel::top("bar").show(ui, |ui| panel::bar(ui, state));
            egui::Panel::bottom("timeline").show(ui, |ui| self.timeline.show(ui, state));
            if state.shown.controls && is_narrow {
                // Below the scene, as wide as the screen: there is no room beside it.
                let most = 0.5 * ui.available_height();
                let panel = egui::Panel::bottom("controls below").exact_size(most);
                panel.show(ui, |ui| self.controls.show(ui, state));
            } else if state.shown.controls {
                // The scene keeps at least two fifths of the window.
                let most = 0.6 * ui.available_width();
                let panel = egui::Panel::left("controls").default_size(PANEL_WIDTH.min(most));
                let panel = panel.size_range(LEAST_PANEL_WIDTH.min(most)..=most);
                panel.show(ui, |ui| self.controls.show(ui, state));
            }
            if state.shown.explain {
                explain::panel(ui, is_narrow).show(ui, |ui| self.explain.show(ui, state));
            }
            if state.shown.plots {
                plots::panel(ui).show(ui, |ui| self.plots.show(ui, state));
            }
        }
        let scene = egui::CentralPanel::no_frame().show(ui, |ui| self.view.show(ui, state)).response.rect;
        self.cards.show(ui.ctx(), state, scene);
    }

    /// Does what keys and buttons asked for.
    fn act(&mut self, context: &egui::Context, action: Action) {
        let state = &mut self.state;
        match action {
            Action::PlayPause => state.send(Command::Play(!state.report.playing)),
            Action::Step => state.send(Command::Step),
            Action::Frame => state.send(Command::Frame),
            Action::Reset => state.send(Command::Reset),
            Action::Back => timeline::go(state, -1),
            Action::Forward => timeline::go(state, 1),
            Action::Start => timeline::go_to_start(state),
            Action::End => timeline::go_to_end(state),
            Action::Undo => state.send(Command::Undo),
            Action::Redo => state.send(Command::Redo),
            Action::ResetView => self.view.frame_scene(state),
            Action::Scissors => {
                state.tool = if state.tool == Tool::Hand { Tool::Scissors } else { Tool::Hand };
            }
            Action::Panel => toggle(state, |shown| &mut shown.controls),
            Action::Plots => toggle(state, |shown| &mut shown.plots),
            Action::Explain => toggle(state, |shown| &mut shown.explain),
            Action::NextStage => self.explain.next_stage(state),
            Action::Help => state.shown.help ^= true,
            Action::Presentation => state.shown.presentation ^= true,
            Action::Theme => {
                let theme = &mut state.appearance.theme;
                *theme = if *theme == Theme::Light { Theme::Dark } else { Theme::Light };
            }
            Action::Open | Action::Save | Action::Checkpoint | Action::Motion => {
                self.cards.file(action, state)
            }
            Action::Picture | Action::Record => self.view.save(action, state),
            #[cfg(target_arch = "wasm32")]
            Action::Link => match link::link(&state.report, &state.camera) {
                Ok(link) => {
                    context.copy_text(format!("{}#{link}", crate::page::address()));
                    state.say("Copied a link to this scene");
                }
                Err(error) => state.refuse(error),
            },
            #[cfg(not(target_arch = "wasm32"))]
            Action::Quit => context.send_viewport_cmd(egui::ViewportCommand::Close),
            Action::Scene(number) => {
                let name = panel::scenes::of_kind(Kind::Report).nth(number).map(|entry| entry.name);
                name.into_iter().for_each(|name| state.open_builtin(name));
            }
        }
    }

    /// Makes the link for the next start anew, where anything was changed since the last.
    #[cfg(target_arch = "wasm32")]
    fn keep_link(&mut self) {
        let state = &mut self.state;
        let params = state.report.params.clone();
        if self.linked.as_ref().is_none_or(|linked| !std::sync::Arc::ptr_eq(linked, &params)) {
            let opened = &state.report.opened;
            let is_quick = params == opened.params || opened.model.spring_count() <= MOST_KEPT;
            // What no link can hold is not kept, nor what would hold up the page.
            state.kept_link = is_quick.then(|| link::link(&state.report, &state.camera).ok()).flatten();
            self.linked = Some(params);
        }
    }

    /// A new scene has been opened: looks at it.
    fn follow(&mut self) {
        let opened = self.state.report.opened.clone();
        if self.serial == Some(opened.serial) {
            return;
        }
        if self.serial.is_some() {
            self.state.files.opened();
            self.state.warnings = opened.scene.mesh_warnings();
            self.state.send(Command::Play(true));
        }
        self.serial = Some(opened.serial);
        // Nothing of the last scene goes on in this one.
        self.state.tool = Tool::Hand;
        self.state.selection = None;
        self.state.hovered = None;
        self.state.explain_stage = None;
        self.state.pointed_out.clear();
        match self.first_view.take() {
            Some(view) => self.state.camera = view,
            None => self.view.frame_scene(&mut self.state),
        }
    }

    /// Calls the window by what it shows, so that it can be told in a list of windows, or by one who does not see it.
    fn name_window(&mut self, context: &egui::Context) {
        let title = title(&self.state.report, self.cards.open());
        if title != self.title {
            self.title.clone_from(&title);
            #[cfg(target_arch = "wasm32")]
            crate::page::name(&title);
            context.send_viewport_cmd(egui::ViewportCommand::Title(title));
        }
    }
}

/// Shows or hides a part beside the scene; where it is narrow, one at a time.
fn toggle(state: &mut AppState, part: fn(&mut Shown) -> &mut bool) {
    let is_on = !*part(&mut state.shown);
    if state.is_narrow {
        state.shown = Shown { controls: false, plots: false, explain: false, ..state.shown };
    }
    *part(&mut state.shown) = is_on;
}

/// The scene, what it is doing unless it plays, and the card that is up: "jelly, paused – sprung".
fn title(report: &Report, card: Option<&str>) -> String {
    let doing = match (&report.trouble, &report.busy) {
        (Some(Trouble::BlewUp(_)), _) => Some("blew up"),
        (_, Some(busy)) => Some(busy.as_str()),
        _ if !report.playing => Some("paused"),
        _ => None,
    };
    let doing = doing.map_or_else(String::new, |doing| format!(", {doing}"));
    let card = card.map_or_else(String::new, |card| format!(", card: {card}"));
    format!("{}{doing}{card} – sprung", report.opened.name)
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        let seconds = ui.input(|input| input.unstable_dt.min(0.25));
        self.state.driver.pass(f64::from(seconds));
        // While a motion is written, the run is gone through behind a picture that stands: to draw it would take longer.
        if !self.state.motion.is_being_written() {
            self.state.report = self.state.driver.report();
        }
        self.follow();
        self.zoom = ui.ctx().zoom_factor();
        self.state.pixels_per_point = ui.ctx().pixels_per_point();
        self.explain.keep_up(&mut self.state);
        self.show(ui);
        let mut actions = std::mem::take(&mut self.state.actions);
        actions.extend(action::pressed(ui.ctx()));
        actions.into_iter().for_each(|action| self.act(ui.ctx(), action));
        self.name_window(ui.ctx());
        if Motion::go_on(&mut self.state) {
            ui.ctx().request_repaint();
        }
        #[cfg(target_arch = "wasm32")]
        {
            crate::files::hand_out();
            // What the keyboard is at, for those who do not see it.
            crate::page::tell(&ui.ctx().output(|output| output.events_description()));
        }
        if self.state.report.playing {
            ui.ctx().request_repaint();
        }
    }

    fn on_exit(&mut self) {
        self.view.drop_film();
        self.state.motion.drop_it();
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        #[cfg(target_arch = "wasm32")]
        self.keep_link();
        Settings::of(&self.state, self.zoom).save(storage);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::scene::Scene;
    use sprung_driver::{Driver, Source};

    #[test]
    fn the_window_is_called_by_what_it_does() {
        let scene = Scene::builtin("jelly").expect("it is built in");
        let mut driver = Driver::new(Source { name: "jelly".to_owned(), scene }).expect("it can be built");
        let mut report = (*driver.report()).clone();
        report.playing = true;
        assert_eq!(title(&report, None), "jelly – sprung");
        report.playing = false;
        assert_eq!(title(&report, None), "jelly, paused – sprung");
        assert_eq!(title(&report, Some("Help")), "jelly, paused, card: Help – sprung");
        report.busy = Some("settling".to_owned());
        assert_eq!(title(&report, None), "jelly, settling – sprung");
    }
}
