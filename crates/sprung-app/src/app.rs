//! The window: its parts and where they lie.

use sprung::scene::Scene;
use sprung_driver::{Command, Handle, Source};
use sprung_render::appearance::Theme;
use sprung_render::camera::Bounds;
use sprung_render::turntable::Turntable;

use crate::action::{self, Action};
use crate::state::{AppState, Shown, Tool};
use crate::view::View;
use crate::{card, explain, panel, plots, theme, timeline};

/// The window.
pub struct App {
    state: AppState,
    view: View,
    plots: plots::Plots,
    explain: explain::Explain,
    cards: card::Cards,
    /// The scene that the camera was set up for.
    serial: Option<u64>,
}

impl App {
    /// A window on a driver.
    pub fn new(mut driver: Handle, context: &eframe::CreationContext<'_>) -> Self {
        let report = driver.report();
        driver.send(Command::Play(true));
        let camera = Turntable::framing(&Bounds::default(), 1.0);
        let shown = Shown { controls: true, plots: false, explain: false, help: false, presentation: false };
        let state = AppState {
            driver,
            report,
            appearance: Default::default(),
            camera,
            tool: Tool::Hand,
            selection: None,
            hovered: None,
            pointed_out: Vec::new(),
            shown,
            actions: Vec::new(),
        };
        Self {
            state,
            view: View::new(context.wgpu_render_state.as_ref()),
            plots: Default::default(),
            explain: Default::default(),
            cards: Default::default(),
            serial: None,
        }
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
        let state = &mut self.state;
        theme::apply(ui.ctx(), state.appearance.theme);
        if !state.shown.presentation {
            egui::Panel::top("transport").show(ui, |ui| panel::transport(ui, state));
            if state.shown.controls {
                egui::Panel::left("controls").show(ui, |ui| panel::controls(ui, state));
            }
            if state.shown.explain {
                egui::Panel::right("explain").show(ui, |ui| self.explain.show(ui, state));
            }
            egui::Panel::bottom("timeline").show(ui, |ui| timeline::show(ui, state));
            if state.shown.plots {
                egui::Panel::bottom("plots").show(ui, |ui| self.plots.show(ui, state));
            }
        }
        egui::CentralPanel::no_frame().show(ui, |ui| self.view.show(ui, state));
        self.cards.show(ui.ctx(), state);
    }

    /// Does what keys and buttons asked for.
    fn act(&mut self, action: Action) {
        let state = &mut self.state;
        match action {
            Action::PlayPause => state.send(Command::Play(!state.report.playing)),
            Action::Step => state.send(Command::Step),
            Action::Frame => state.send(Command::Frame),
            Action::Reset => state.send(Command::Reset),
            Action::Back => timeline::go(state, -1),
            Action::Forward => timeline::go(state, 1),
            Action::Undo => state.send(Command::Undo),
            Action::Redo => state.send(Command::Redo),
            Action::ResetView => self.view.frame_scene(state),
            Action::Scissors => {
                state.tool = if state.tool == Tool::Hand { Tool::Scissors } else { Tool::Hand };
            }
            Action::Panel => state.shown.controls ^= true,
            Action::Plots => state.shown.plots ^= true,
            Action::Explain => state.shown.explain ^= true,
            Action::Help => state.shown.help ^= true,
            Action::Presentation => state.shown.presentation ^= true,
            Action::Theme => {
                let theme = &mut state.appearance.theme;
                *theme = if *theme == Theme::Light { Theme::Dark } else { Theme::Light };
            }
            Action::Open | Action::Save => self.cards.file(action, state),
            Action::Picture | Action::Record => self.view.save(action, state),
            Action::Scene(number) => {
                let name = ["spring", "chain", "jelly", "cloth"][number.min(3)];
                if let Ok(scene) = Scene::builtin(name) {
                    state.send(Command::Open(Box::new(Source { name: name.to_owned(), scene })));
                }
            }
        }
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        let seconds = ui.input(|input| input.unstable_dt.min(0.25));
        self.state.driver.pass(f64::from(seconds));
        self.state.report = self.state.driver.report();
        if self.serial != Some(self.state.report.opened.serial) {
            self.serial = Some(self.state.report.opened.serial);
            self.state.selection = None;
            self.view.frame_scene(&mut self.state);
        }
        self.show(ui);
        let mut actions = std::mem::take(&mut self.state.actions);
        actions.extend(action::pressed(ui.ctx()));
        actions.into_iter().for_each(|action| self.act(action));
        if self.state.report.playing {
            ui.ctx().request_repaint();
        }
    }
}
