//! The one hint of the first start, and notices that go away by themselves.

use egui::{Align2, Area, Context, Frame, Id, Order, Rect, RichText, vec2};

use crate::icon::{self, IconButton};
use crate::state::AppState;

/// How long a notice stays, s.
const NOTICE_SECONDS: f64 = 4.0;

/// "Pull it", until something has been pulled.
pub fn show(context: &Context, state: &mut AppState, scene: Rect) {
    if state.report.pull.is_some() {
        state.hint = false;
    }
    // It speaks of the jelly, which the first start opens.
    let is_jelly = state.report.opened.name == "jelly";
    if !state.hint || !is_jelly || state.shown.presentation {
        return;
    }
    let bubble = bubble(context, "hint", scene.center_top() + vec2(0.0, 20.0));
    bubble.show(context, |ui| {
        frame(context).show(ui, |ui| {
            ui.horizontal(|ui| {
                icon::label(ui, icon::PULL, ui.visuals().hyperlink_color);
                ui.label(RichText::new("Pull it!").size(16.0).strong());
                if !state.is_narrow {
                    ui.weak("Press on the jelly and drag.");
                }
                let close = IconButton::new(icon::CLOSE, "Close the hint").with(|button| button.small());
                if close.show(ui).clicked() {
                    state.hint = false;
                }
            });
        });
    });
}

/// A word such as "saved chain.toml".
#[derive(Default)]
pub struct Notice {
    said: Option<(String, f64)>,
}

impl Notice {
    /// Shows it for a while.
    pub fn show(&mut self, context: &Context, state: &mut AppState, scene: Rect) {
        let now = context.input(|input| input.time);
        if let Some(text) = state.notice.take() {
            self.said = Some((text, now));
        }
        let Some((text, since)) = &self.said else { return };
        let left = since + NOTICE_SECONDS - now;
        if left <= 0.0 {
            self.said = None;
            return;
        }
        let bubble = bubble(context, "notice", scene.center_top() + vec2(0.0, 68.0));
        bubble.interactable(false).show(context, |ui| frame(context).show(ui, |ui| ui.label(text)));
        context.request_repaint_after(std::time::Duration::from_secs_f64(left));
    }
}

fn bubble(context: &Context, id: &str, at: egui::Pos2) -> Area {
    // Never beyond the window, however narrow the scene is.
    let at = at.clamp(context.content_rect().min, context.content_rect().max);
    Area::new(Id::unique(id)).order(Order::Middle).pivot(Align2::CENTER_TOP).fixed_pos(at).constrain(true)
}

fn frame(context: &Context) -> Frame {
    Frame::popup(&context.global_style()).inner_margin(egui::Margin::symmetric(14, 8)).corner_radius(16)
}
