//! Signs for buttons, drawn as lines: sharp at any size, in the colour of the text, and without a font of a megabyte.

use std::f32::consts::TAU;

use egui::{Atom, Button, Color32, IdSalt, Painter, Pos2, Rect, Response, Shape, Stroke, Ui, pos2, vec2};

/// The grid that signs are drawn on is so many units wide and high; y points down.
const GRID: f32 = 16.0;

/// A stroke of a sign.
#[derive(Clone, Copy, Debug)]
pub enum Mark {
    /// A line through these points.
    Line(&'static [(f32, f32)]),
    /// A convex area with these corners.
    Area(&'static [(f32, f32)]),
    /// Part of a circle: centre, radius, and from where to where in turns, clockwise from the right.
    Arc((f32, f32), f32, (f32, f32)),
    /// A disc: centre and radius.
    Disc((f32, f32), f32),
}

/// A sign.
pub type Icon = &'static [Mark];

use Mark::{Arc, Area, Disc, Line};

/// Goes.
pub const PLAY: Icon = &[Area(&[(4.5, 2.5), (13.0, 8.0), (4.5, 13.5)])];
/// Stands.
pub const PAUSE: Icon = &[
    Area(&[(4.0, 3.0), (6.8, 3.0), (6.8, 13.0), (4.0, 13.0)]),
    Area(&[(9.2, 3.0), (12.0, 3.0), (12.0, 13.0), (9.2, 13.0)]),
];
/// One on.
pub const STEP: Icon = &[
    Area(&[(3.5, 3.0), (10.5, 8.0), (3.5, 13.0)]),
    Area(&[(11.0, 3.0), (12.8, 3.0), (12.8, 13.0), (11.0, 13.0)]),
];
/// Several on.
pub const FRAME: Icon =
    &[Area(&[(2.0, 3.5), (8.0, 8.0), (2.0, 12.5)]), Area(&[(8.0, 3.5), (14.0, 8.0), (8.0, 12.5)])];
/// Round and back to where it began.
pub const RESET: Icon = &[Arc((8.0, 8.5), 5.0, (-0.16, 0.62)), Area(&[(4.6, 1.6), (4.6, 7.0), (0.8, 4.3)])];
/// One back.
pub const BACK: Icon = &[Area(&[(11.5, 3.0), (4.0, 8.0), (11.5, 13.0)])];
/// One on, of what is recorded.
pub const FORWARD: Icon = &[Area(&[(4.5, 3.0), (12.0, 8.0), (4.5, 13.0)])];
/// To the first.
pub const START: Icon = &[
    Area(&[(12.5, 3.0), (5.5, 8.0), (12.5, 13.0)]),
    Area(&[(3.2, 3.0), (5.0, 3.0), (5.0, 13.0), (3.2, 13.0)]),
];
/// To the last.
pub const END: Icon = STEP;
/// Takes back.
pub const UNDO: Icon = &[
    Line(&[(4.0, 6.0), (9.5, 6.0)]),
    Arc((9.5, 9.5), 3.5, (-0.25, 0.25)),
    Line(&[(9.5, 13.0), (6.0, 13.0)]),
    Area(&[(5.5, 2.6), (5.5, 9.4), (1.5, 6.0)]),
];
/// Makes once more.
pub const REDO: Icon = &[
    Line(&[(12.0, 6.0), (6.5, 6.0)]),
    Arc((6.5, 9.5), 3.5, (0.25, 0.75)),
    Line(&[(6.5, 13.0), (10.0, 13.0)]),
    Area(&[(10.5, 2.6), (14.5, 6.0), (10.5, 9.4)]),
];
/// The whole in sight.
pub const WHOLE: Icon = &[
    Line(&[(2.0, 6.0), (2.0, 2.0), (6.0, 2.0)]),
    Line(&[(10.0, 2.0), (14.0, 2.0), (14.0, 6.0)]),
    Line(&[(14.0, 10.0), (14.0, 14.0), (10.0, 14.0)]),
    Line(&[(6.0, 14.0), (2.0, 14.0), (2.0, 10.0)]),
    Disc((8.0, 8.0), 2.0),
];
/// Scissors.
pub const SCISSORS: Icon = &[
    Line(&[(5.6, 10.2), (12.0, 1.5)]),
    Line(&[(10.4, 10.2), (4.0, 1.5)]),
    Arc((4.3, 12.2), 2.2, (0.0, 1.0)),
    Arc((11.7, 12.2), 2.2, (0.0, 1.0)),
];
/// A window with a panel.
pub const PANEL: Icon = &[
    Line(&[(1.5, 3.0), (14.5, 3.0), (14.5, 13.0), (1.5, 13.0), (1.5, 3.0)]),
    Area(&[(1.5, 3.0), (6.0, 3.0), (6.0, 13.0), (1.5, 13.0)]),
];
/// A curve.
pub const PLOTS: Icon = &[
    Line(&[(2.0, 2.0), (2.0, 14.0), (14.5, 14.0)]),
    Line(&[(4.0, 11.0), (7.0, 6.5), (9.5, 9.0), (13.5, 3.5)]),
];
/// A bulb.
pub const BULB: Icon = &[
    Arc((8.0, 6.2), 4.2, (0.38, 1.12)),
    Line(&[(5.0, 9.1), (6.0, 11.5), (10.0, 11.5), (11.0, 9.1)]),
    Line(&[(6.3, 13.4), (9.7, 13.4)]),
];
/// A question.
pub const HELP: Icon = &[
    Arc((8.0, 8.0), 6.5, (0.0, 1.0)),
    Arc((8.0, 6.4), 2.0, (-0.5, 0.18)),
    Line(&[(8.8, 8.2), (8.0, 9.0), (8.0, 9.8)]),
    Disc((8.0, 11.8), 0.9),
];
/// A screen.
pub const SCREEN: Icon = &[
    Line(&[(1.5, 2.5), (14.5, 2.5), (14.5, 11.0), (1.5, 11.0), (1.5, 2.5)]),
    Line(&[(5.0, 14.0), (11.0, 14.0)]),
    Line(&[(8.0, 11.0), (8.0, 14.0)]),
];
/// Half light, half dark.
pub const THEME: Icon = &[
    Arc((8.0, 8.0), 6.0, (0.0, 1.0)),
    Area(&[
        (8.0, 2.0),
        (10.3, 2.5),
        (12.2, 3.8),
        (13.5, 5.7),
        (14.0, 8.0),
        (13.5, 10.3),
        (12.2, 12.2),
        (10.3, 13.5),
        (8.0, 14.0),
    ]),
];
/// A folder.
pub const FOLDER: Icon = &[Line(&[
    (1.5, 13.0),
    (1.5, 3.0),
    (6.0, 3.0),
    (7.5, 5.0),
    (14.5, 5.0),
    (14.5, 13.0),
    (1.5, 13.0),
    (1.5, 7.5),
    (14.5, 7.5),
])];
/// Into a tray.
pub const SAVE: Icon = &[
    Line(&[(1.5, 9.0), (1.5, 14.0), (14.5, 14.0), (14.5, 9.0)]),
    Line(&[(8.0, 1.5), (8.0, 8.0)]),
    Area(&[(4.5, 6.5), (11.5, 6.5), (8.0, 11.0)]),
];
/// A camera.
pub const CAMERA: Icon = &[
    Line(&[
        (1.5, 4.5),
        (4.5, 4.5),
        (6.0, 2.5),
        (10.0, 2.5),
        (11.5, 4.5),
        (14.5, 4.5),
        (14.5, 13.0),
        (1.5, 13.0),
        (1.5, 4.5),
    ]),
    Arc((8.0, 8.5), 2.8, (0.0, 1.0)),
];
/// A film camera.
pub const FILM: Icon = &[
    Line(&[(1.5, 4.0), (10.0, 4.0), (10.0, 12.0), (1.5, 12.0), (1.5, 4.0)]),
    Area(&[(10.5, 7.2), (14.5, 4.2), (14.5, 11.8), (10.5, 8.8)]),
];
/// Crosshairs.
pub const TARGET: Icon = &[
    Arc((8.0, 8.0), 4.5, (0.0, 1.0)),
    Line(&[(8.0, 1.0), (8.0, 5.5)]),
    Line(&[(8.0, 10.5), (8.0, 15.0)]),
    Line(&[(1.0, 8.0), (5.5, 8.0)]),
    Line(&[(10.5, 8.0), (15.0, 8.0)]),
];
/// Out of a box.
pub const MOTION: Icon = &[
    Line(&[(5.5, 6.5), (3.0, 6.5), (3.0, 13.5), (13.0, 13.5), (13.0, 6.5), (10.5, 6.5)]),
    Line(&[(8.0, 10.0), (8.0, 2.5)]),
    Line(&[(5.2, 5.2), (8.0, 2.4), (10.8, 5.2)]),
];
/// Two links of a chain.
#[cfg(target_arch = "wasm32")]
pub const LINK: Icon = &[
    Line(&[(6.0, 5.0), (3.8, 5.0)]),
    Arc((3.8, 8.0), 3.0, (0.25, 0.75)),
    Line(&[(3.8, 11.0), (6.0, 11.0)]),
    Line(&[(10.0, 5.0), (12.2, 5.0)]),
    Arc((12.2, 8.0), 3.0, (-0.25, 0.25)),
    Line(&[(12.2, 11.0), (10.0, 11.0)]),
    Line(&[(5.0, 8.0), (11.0, 8.0)]),
];
/// Away with it.
pub const CLOSE: Icon = &[Line(&[(3.5, 3.5), (12.5, 12.5)]), Line(&[(12.5, 3.5), (3.5, 12.5)])];
/// Mind this.
pub const WARNING: Icon = &[
    Line(&[(8.0, 2.0), (14.8, 13.5), (1.2, 13.5), (8.0, 2.0)]),
    Line(&[(8.0, 6.0), (8.0, 9.8)]),
    Disc((8.0, 11.7), 0.9),
];
/// A hand's pull: an arrow from a point.
pub const PULL: Icon = &[
    Disc((3.5, 12.5), 2.3),
    Line(&[(5.0, 11.0), (10.5, 5.5)]),
    Area(&[(7.8, 4.0), (14.0, 2.0), (12.0, 8.2)]),
];
/// All is well, or not: a lamp in the colour that says it.
pub const LAMP: Icon = &[Disc((8.0, 8.0), 4.5)];

/// Draws a sign.
pub fn paint(painter: &Painter, rect: Rect, icon: Icon, colour: Color32) {
    let scale = rect.width().min(rect.height()) / GRID;
    let corner = rect.center() - vec2(0.5, 0.5) * GRID * scale;
    let at = |&(x, y): &(f32, f32)| corner + vec2(x, y) * scale;
    let stroke = Stroke::new((1.5 * scale).max(1.0), colour);
    for mark in icon {
        match mark {
            Line(points) => {
                painter.add(Shape::line(points.iter().map(at).collect(), stroke));
            }
            Area(corners) => {
                painter.add(Shape::convex_polygon(corners.iter().map(at).collect(), colour, Stroke::NONE));
            }
            Arc(centre, radius, (from, to)) => {
                let points = arc(at(centre), radius * scale, *from, *to);
                painter.add(Shape::line(points, stroke));
            }
            Disc(centre, radius) => {
                painter.circle_filled(at(centre), radius * scale, colour);
            }
        }
    }
}

fn arc(centre: Pos2, radius: f32, from: f32, to: f32) -> Vec<Pos2> {
    let steps = (24.0 * (to - from).abs()).ceil().max(2.0) as usize;
    let angle = |step: usize| TAU * (from + (to - from) * step as f32 / steps as f32);
    (0..=steps)
        .map(|step| pos2(centre.x + radius * angle(step).cos(), centre.y + radius * angle(step).sin()))
        .collect()
}

/// A sign in a row of text.
pub fn label(ui: &mut Ui, icon: Icon, colour: Color32) -> Response {
    let side = ui.text_style_height(&egui::TextStyle::Body);
    let (rect, response) = ui.allocate_exact_size(vec2(side, side), egui::Sense::hover());
    paint(ui.painter(), rect, icon, colour);
    response
}

/// A button with a sign before its text, or the sign alone where the text is empty. `name` is what a screen reader says.
pub struct IconButton<'a> {
    icon: Icon,
    name: &'a str,
    text: &'a str,
    change: Box<dyn FnOnce(Button<'static>) -> Button<'static> + 'a>,
    enabled: bool,
    selected: Option<bool>,
}

impl<'a> IconButton<'a> {
    /// A button with a sign only.
    pub fn new(icon: Icon, name: &'a str) -> Self {
        Self { icon, name, text: "", change: Box::new(|button| button), enabled: true, selected: None }
    }

    /// With a text behind the sign.
    pub fn text(self, text: &'a str) -> Self {
        Self { text, ..self }
    }

    /// Whether it can be pressed.
    pub fn enabled(self, enabled: bool) -> Self {
        Self { enabled, ..self }
    }

    /// Whether what it stands for is on.
    pub fn selected(self, selected: bool) -> Self {
        Self { selected: Some(selected), ..self }
    }

    /// The button changed in other ways.
    pub fn with(self, change: impl FnOnce(Button<'static>) -> Button<'static> + 'a) -> Self {
        Self { change: Box::new(change), ..self }
    }

    /// The button.
    pub fn show(self, ui: &mut Ui) -> Response {
        let Self { icon, name, text, change, enabled, selected } = self;
        let side = ui.text_style_height(&egui::TextStyle::Button);
        let place = IdSalt::new("icon");
        let sign = Atom::custom(place, vec2(side, side));
        let button = if text.is_empty() { Button::new(sign) } else { Button::new((sign, text.to_owned())) };
        let is_on = selected == Some(true);
        let button = change(button.selected(is_on));
        let mut place_of_sign = None;
        // In the same row as what is around it, so that a row that is full goes on in the next.
        let response = ui.add_enabled(enabled, |ui: &mut Ui| {
            let atoms = button.atom_ui(ui);
            place_of_sign = atoms.rect(place);
            atoms.response
        });
        let visuals = ui.visuals();
        if let Some(rect) = place_of_sign {
            let colour = if !enabled {
                visuals.weak_text_color().gamma_multiply(0.6)
            } else if is_on {
                visuals.selection.stroke.color
            } else {
                ui.style().interact(&response).text_color()
            };
            paint(ui.painter(), rect, icon, colour);
        }
        response.widget_info(|| {
            let info = egui::WidgetInfo::labeled(egui::Role::Button, enabled, name);
            egui::WidgetInfo { selected, ..info }
        });
        response
    }
}
