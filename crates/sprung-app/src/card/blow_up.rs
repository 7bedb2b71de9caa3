//! The card for a simulation that blew up: what happened, where, why, and what mends it.

use std::sync::Arc;

use egui::{Context, Key, Modifiers, Rect, RichText, Ui};
use sprung::{BlowUp, Cause, Params, significant};
use sprung_driver::{Command, Fix, Trouble};

use super::error::capital;
use super::{Part, beside, primary};
use crate::icon::{self, IconButton};
use crate::state::{AppState, Pick};
use crate::text::three_digits;
use crate::theme::Meaning;

/// How far back it is rewound, s.
const REWIND: f64 = 2.0;

/// The card; it remembers which blow-up it is about.
#[derive(Default)]
pub struct BlowUpCard {
    about: Option<BlowUp>,
    /// The parameters that it came from.
    params: Option<Arc<Params>>,
    /// Whether something had the keys in the last frame: Enter was meant for that.
    had_focus: bool,
    fix: Option<Fix>,
    /// What it points out in the scene.
    pointed_out: Vec<Pick>,
}

impl BlowUpCard {
    /// Points out the spring of a new blow-up, and no longer that of one that is mended.
    pub fn follow(&mut self, trouble: Option<&Trouble>, state: &mut AppState) {
        let about = match trouble {
            Some(Trouble::BlewUp(blow_up)) => Some(&**blow_up),
            _ => None,
        };
        if about == self.about.as_ref() {
            // Under other parameters, causes and fixes are others, too: whoever changes them has mended it by hand.
            let now = &state.report.params;
            if self.about.is_some() && self.params.as_ref().is_some_and(|params| !is_same(params, now)) {
                self.params = None;
                state.send(Command::Dismiss);
            }
            return;
        }
        self.params = about.map(|_| state.report.params.clone());
        if state.pointed_out == self.pointed_out {
            state.pointed_out.clear();
        }
        self.about = about.cloned();
        self.fix = state.report.fixes.first().copied();
        self.pointed_out = about.map(picks).unwrap_or_default();
        if about.is_some() {
            state.pointed_out.clone_from(&self.pointed_out);
        }
    }

    /// The card.
    pub fn show(&mut self, context: &Context, state: &mut AppState, blow_up: &BlowUp, scene: Rect) {
        let colour = Meaning::Bad.colour(&context.global_style().visuals);
        let title = RichText::new("It blew up").color(colour);
        let closed = beside(context, "blow-up", title, scene, |ui, part| {
            if part == Part::Foot {
                return self.ways_on(ui, state);
            }
            ui.label(what(blow_up));
            ui.weak(format!(
                "You see the last good state, of t = {} s (step {}).",
                significant(blow_up.good_time),
                blow_up.good_step
            ));
            heading(ui, "Where");
            self.place(ui, state, blow_up);
            heading(ui, "Why");
            ui.label(why(blow_up));
            heading(ui, "What mends it");
            self.fixes(ui, state);
        });
        self.had_focus = context.memory(|memory| memory.focused().is_some());
        if closed {
            state.send(Command::Dismiss);
        }
    }

    fn place(&self, ui: &mut Ui, state: &mut AppState, blow_up: &BlowUp) {
        let model = &state.report.opened.model;
        let text = match (blow_up.spring, &blow_up.points[..]) {
            (Some(spring), _) => capital(&model.spring_name(spring)),
            (None, &[point]) => format!("The contact or grab at {}", model.point_name(point)),
            _ => {
                ui.label("No single spring sets the limit.");
                return;
            }
        };
        let is_out = state.pointed_out == self.pointed_out;
        let button = IconButton::new(icon::TARGET, &text).text(&text).selected(is_out);
        if button.show(ui).on_hover_text("Points it out in the scene.").clicked() {
            state.pointed_out = if is_out { Vec::new() } else { self.pointed_out.clone() };
            state.selection = self.pointed_out.first().copied();
        }
    }

    fn fixes(&mut self, ui: &mut Ui, state: &AppState) {
        let fixes = &state.report.fixes;
        if fixes.is_empty() {
            ui.label("Nothing simple: raise masses, or lower stiffness or damping.");
        }
        for &fix in fixes {
            let (text, about) = words(fix, state);
            if ui.radio(self.fix == Some(fix), text).on_hover_text(about).clicked() {
                self.fix = Some(fix);
            }
        }
        if ui.radio(self.fix.is_none(), "Nothing: leave all as it is").clicked() {
            self.fix = None;
        }
    }

    fn ways_on(&self, ui: &mut Ui, state: &mut AppState) {
        let mut go_on = None;
        ui.horizontal_wrapped(|ui| {
            let rewind = primary(ui, "Rewind two seconds and go on");
            let about =
                "Back by two seconds of simulated time, as far as they are recorded, and on from there.";
            let entered = !self.had_focus
                && ui.memory(|memory| memory.focused().is_none())
                && ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Enter));
            if ui.add(rewind).on_hover_text(about).clicked() || entered {
                go_on = Some(Command::RewindAndGoOn(REWIND));
            }
            if ui.button("Go on from here").on_hover_text("On from the last good state.").clicked() {
                go_on = Some(Command::Play(true));
            }
        });
        if let Some(command) = go_on {
            match self.fix {
                Some(fix) => state.send(Command::Fix(fix)),
                None => state.send(Command::Dismiss),
            }
            state.send(command);
        }
    }
}

/// Whether the same would happen again: hands come and go without changing that.
fn is_same(a: &Arc<Params>, b: &Arc<Params>) -> bool {
    let without_hands =
        |params: &Params| Params { grabs: Vec::new(), carried: Default::default(), ..params.clone() };
    Arc::ptr_eq(a, b) || without_hands(a) == without_hands(b)
}

fn heading(ui: &mut Ui, text: &str) {
    ui.add_space(4.0);
    ui.label(RichText::new(text).strong());
}

fn picks(blow_up: &BlowUp) -> Vec<Pick> {
    let points = blow_up.points.iter().map(|&point| Pick::Point(point));
    blow_up.spring.map(Pick::Spring).into_iter().chain(points).collect()
}

fn what(blow_up: &BlowUp) -> String {
    let (time, step) = (significant(blow_up.time), blow_up.step);
    match blow_up.cause {
        Cause::NotFinite => {
            format!("At t = {time} s (step {step}) a position was no longer a finite number.")
        }
        Cause::EnergyFromNowhere { excess } => {
            let excess = three_digits(excess);
            format!(
                "Up to t = {time} s (step {step}), more than half of the energy had come from nowhere: {excess} J that nobody \
                 put in."
            )
        }
    }
}

fn why(blow_up: &BlowUp) -> String {
    let dt = significant(blow_up.dt);
    let share = |limit: f64| format!("{:.0} %", 100.0 * blow_up.dt / limit);
    match (blow_up.dt_limit_certified, blow_up.dt_limit_every_configuration) {
        (Some(limit), _) if blow_up.dt > limit => format!(
            "dt = {dt} s is {} of the {} s that are certain to be stable there. A step that is too long overshoots the rest \
             length by more than it was off before, and the next one by more again.",
            share(limit),
            significant(limit)
        ),
        (_, Some(every)) if blow_up.dt > every => format!(
            "dt = {dt} s was short enough for that state, but not for every one: beyond {} s some shapes are unstable, and the \
             motion has come to one.",
            significant(every)
        ),
        (Some(limit), _) => format!(
            "dt = {dt} s was {} of the certified limit, so the step length alone is not the cause.",
            share(limit)
        ),
        (None, _) => format!("No spring or contact limits dt = {dt} s at that state."),
    }
}

/// A fix in words, and why it helps.
fn words(fix: Fix, state: &AppState) -> (String, String) {
    let formula = "Stable while dt < 4/(c + √(c² + 4ω²)).";
    match fix {
        Fix::Dt(dt) => (format!("Use dt = {} s", significant(dt)), formula.to_owned()),
        Fix::Substeps => {
            let frame = state.report.params.dt * f64::from(state.report.params.substeps);
            let about = format!(
                "More and shorter steps, so that a frame is still {} s of simulated time. {formula}",
                significant(frame)
            );
            ("More sub-steps for the same frame".to_owned(), about)
        }
        Fix::Damping(factor) => (
            format!("Less damping: k_d × {}", significant(factor)),
            format!("Damping c makes the limit smaller, too. {formula}"),
        ),
    }
}
