//! Cards over the scene: help, blow-ups, errors, files. One at a time, so that none covers another.

mod blow_up;
mod error;
mod file;
mod help;
mod hint;
mod warnings;

pub use help::GESTURES;

use egui::{Align2, Context, Frame, Id, Key, Margin, Modal, Modifiers, Rect, RichText, ScrollArea, Ui, vec2};
use sprung_driver::{Command, Trouble};

use crate::action::Action;
use crate::files::{self, Refused};
use crate::icon::{self, IconButton};
use crate::media::Film;
use crate::state::AppState;

/// The cards.
#[derive(Default)]
pub struct Cards {
    file: Option<file::FileCard>,
    blow_up: blow_up::BlowUpCard,
    notice: hint::Notice,
    /// What the one that is up is called.
    open: Option<&'static str>,
}

impl Cards {
    /// Shows the one that is up over the scene, and the hint and the notice where none is.
    pub fn show(&mut self, context: &Context, state: &mut AppState, scene: Rect) {
        if let Some(read) = files::dropped(context) {
            self.file = None;
            state.open_or_refuse(read);
        }
        if self.file.is_none() {
            let picture = state.save_requests.first().map(file::FileCard::picture);
            self.file = picture.or_else(|| match &state.filming.film {
                Film::Waits(name) => Some(file::FileCard::film(name)),
                _ => None,
            });
        }
        let trouble = state.report.trouble.clone();
        self.blow_up.follow(trouble.as_ref(), state);
        self.open = None;
        if let Some(Refused { error, text }) = state.refused.front() {
            self.open = Some(error::TITLE);
            if error::show(context, error, text.as_deref()) {
                state.refused.pop_front();
            }
        } else if let Some(card) = &mut self.file {
            self.open = Some(card.title());
            if card.show(context, state) {
                card.finish(state);
                self.file = None;
            }
        } else if let Some(trouble) = trouble {
            match trouble {
                Trouble::BlewUp(blow_up) => self.blow_up.show(context, state, &blow_up, scene),
                Trouble::Refused(error) => {
                    self.open = Some(error::TITLE);
                    if error::show(context, &error, None) {
                        state.send(Command::Dismiss);
                    }
                }
            }
        } else if !state.warnings.is_empty() {
            self.open = Some(warnings::TITLE);
            if warnings::show(context, &state.warnings) {
                state.warnings.clear();
            }
        } else if state.shown.help {
            self.open = Some(help::TITLE);
            state.shown.help = !help::show(context);
        } else {
            hint::show(context, state, scene);
            if state.shown.presentation && context.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape))
            {
                state.shown.presentation = false;
            }
        }
        self.notice.show(context, state, scene);
    }

    /// What the card over the scene is called, if one is up; that of a blow-up lies beside it.
    pub fn open(&self) -> Option<&'static str> {
        self.open
    }

    /// Puts up the card to open or save a file.
    pub fn file(&mut self, action: Action, state: &mut AppState) {
        self.file = match action {
            Action::Save => Some(file::FileCard::save(state)),
            Action::Checkpoint => Some(file::FileCard::checkpoint(state)),
            Action::Motion => Some(file::FileCard::motion(state)),
            _ => Some(file::FileCard::open()),
        };
    }
}

/// A card in the middle, over a dimmed window; gives whether it is to be closed. What is too long for the window scrolls.
fn modal(context: &Context, id: &str, title: &str, width: f32, add: impl FnOnce(&mut Ui) -> bool) -> bool {
    let room = context.content_rect().size();
    // The room it may take, or it would be as small as cards are when egui knows nothing of them.
    let area = Modal::default_area(Id::unique(id)).default_size(vec2(width, room.y));
    let response = Modal::new(Id::unique(id)).area(area).frame(frame(context)).show(context, |ui| {
        ui.set_width(width.min(room.x - 48.0));
        // More than what it took before, or it could not grow.
        ui.set_max_height((room.y - 60.0).max(160.0));
        let closed = ui
            .horizontal(|ui| {
                ui.label(RichText::new(title).heading());
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), close_button).inner
            })
            .inner;
        ui.add_space(6.0);
        let done = ScrollArea::vertical()
            .show(ui, |ui| {
                // Keeps text clear of the scroll bar.
                ui.set_width(ui.available_width() - 6.0);
                add(ui)
            })
            .inner;
        closed || done
    });
    response.inner || response.should_close()
}

/// A part of a card beside the scene.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Body,
    Foot,
}

/// Height of a foot with a row of buttons, which may take two lines in a narrow card, points.
const FOOT: f32 = 64.0;

/// A card beside what is seen, which stays bright and can be turned; gives whether Esc or its cross was pressed. What is
/// too long for the window scrolls, but not its foot, where the buttons are.
fn beside(
    context: &Context,
    id: &str,
    title: RichText,
    scene: Rect,
    mut add: impl FnMut(&mut Ui, Part),
) -> bool {
    let width = 400.0_f32.min(scene.width() - 24.0).max(240.0);
    let corner = scene.right_top() + vec2(-12.0, 12.0);
    let area =
        egui::Area::new(Id::unique(id)).order(egui::Order::Middle).pivot(Align2::RIGHT_TOP).fixed_pos(corner);
    let closed = area
        .show(context, |ui| {
            frame(context)
                .show(ui, |ui| {
                    ui.set_width(width - 34.0);
                    ui.set_max_height((scene.height() - 60.0).max(160.0));
                    let closed = ui
                        .horizontal(|ui| {
                            ui.label(title.heading());
                            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), close_button)
                                .inner
                        })
                        .inner;
                    let room = (ui.available_height() - FOOT).max(60.0);
                    ScrollArea::vertical().max_height(room).show(ui, |ui| add(ui, Part::Body));
                    ui.add_space(6.0);
                    add(ui, Part::Foot);
                    closed
                })
                .inner
        })
        .inner;
    closed || context.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape))
}

fn close_button(ui: &mut Ui) -> bool {
    let button =
        IconButton::new(icon::CLOSE, "Close the card").with(|button| button.frame_when_inactive(false));
    button.show(ui).on_hover_text("Close (Esc)").clicked()
}

fn frame(context: &Context) -> Frame {
    Frame::window(&context.global_style()).inner_margin(Margin::symmetric(18, 14))
}

/// The button that is most likely wanted.
fn primary(ui: &Ui, text: impl Into<String>) -> egui::Button<'static> {
    let visuals = ui.visuals();
    let text = RichText::new(text).strong().color(visuals.selection.stroke.color);
    egui::Button::new(text).fill(visuals.selection.bg_fill)
}
