//! The parameters: each with its unit, its formula, and the scene's own value to go back to.

use std::ops::{Range, RangeInclusive};
use std::sync::Arc;

use egui::{ComboBox, RichText, Ui};
use sprung::params::{DAMPING_RANGE, DT_RANGE, MAGNITUDE_RANGE, MASS_RANGE, STIFFNESS_RANGE, SUBSTEPS_RANGE};
use sprung::{Change, Model, Params, Vec3, significant};
use sprung_driver::Edit;

use super::groups::{Group, Spread, Spreads, groups, stretches};
use super::number::{Asked, Number, Scale, around, own_button};
use super::section;
use crate::state::AppState;

/// Gravity at the surface of what people know, m/s² downwards.
pub static PLANETS: [(&str, f32); 11] = [
    ("Earth", 9.81),
    ("Moon", 1.62),
    ("Mars", 3.72),
    ("Mercury", 3.70),
    ("Venus", 8.87),
    ("Jupiter", 24.79),
    ("Saturn", 10.44),
    ("Uranus", 8.69),
    ("Neptune", 11.15),
    ("Sun", 274.0),
    ("zero g", 0.0),
];

/// The parameters' part of the panel.
#[derive(Default)]
pub struct ParamsPanel {
    serial: Option<u64>,
    groups: Vec<Group>,
    mass: Cache,
    stiffness: Cache,
    damping: Cache,
    rest_length: Cache,
}

/// Spreads of the values now and of the scene's own.
#[derive(Default)]
struct Cache {
    now: Spreads,
    own: Spreads,
}

/// One of the values that bodies and joints have.
struct Quantity {
    number: Number<'static>,
    /// What the slider spans where the scene's own value is zero.
    usual: RangeInclusive<f64>,
    /// Which points or springs of a group have it.
    range: fn(&Group) -> Range<usize>,
    /// The array that the value follows from.
    array: fn(&Params) -> &Arc<Vec<f32>>,
    change: fn(Range<usize>, f32) -> Change,
    /// The value of one of them; `None` where it has none, as a mass of zero, which fixes its point and stays.
    value: fn(&Model, &Params, usize) -> Option<f32>,
}

const MASS: Quantity = Quantity {
    number: Number {
        name: "mass m",
        unit: "kg",
        about: "Mass of each point. It appears in v += f/m·dt: the heavier, the slower, and the larger dt may be. \
                Points of zero mass are fixed in space and stay so.",
        allowed: *MASS_RANGE.start() as f64..=*MASS_RANGE.end() as f64,
        slider: 0.0..=1.0,
        scale: Scale::Logarithmic,
    },
    usual: 0.01..=100.0,
    range: |group| group.points.clone(),
    array: |params| &params.point_mass,
    change: Change::Mass,
    value: |_, params, point| Some(params.point_mass[point]).filter(|&mass| mass != 0.0),
};

const STIFFNESS: Quantity = Quantity {
    number: Number {
        name: "stiffness k_s",
        unit: "N/m",
        about: "Stiffness of each spring: F = −k_s (ℓ − L) u. The stiffer, the smaller dt must be: ω² = k_s/m enters the \
                limit.",
        allowed: *STIFFNESS_RANGE.start() as f64..=*STIFFNESS_RANGE.end() as f64,
        slider: 0.0..=1.0,
        scale: Scale::Logarithmic,
    },
    usual: 0.0..=1e4,
    range: |group| group.springs.clone(),
    array: |params| &params.spring_stiffness,
    change: Change::Stiffness,
    value: |_, params, spring| Some(params.spring_stiffness[spring]),
};

const DAMPING: Quantity = Quantity {
    number: Number {
        name: "damping k_d",
        unit: "N·s/m",
        about: "Damping along each spring: F = −k_d ((v_i − v_j)·u) u. It takes energy out, but too much of it needs a \
                smaller dt: c = k_d/m enters the limit.",
        allowed: *DAMPING_RANGE.start() as f64..=*DAMPING_RANGE.end() as f64,
        slider: 0.0..=1.0,
        scale: Scale::Logarithmic,
    },
    usual: 0.0..=100.0,
    range: |group| group.springs.clone(),
    array: |params| &params.spring_damping,
    change: Change::Damping,
    value: |_, params, spring| Some(params.spring_damping[spring]),
};

const REST_LENGTH: Quantity = Quantity {
    number: Number {
        name: "rest length L",
        unit: "× own",
        about: "Rest length of each spring, as a multiple of the one it was built with: F = −k_s (ℓ − L) u. Below 1 \
                everything draws together, above it swells.",
        allowed: 0.0..=1e6,
        slider: 0.0..=1.0,
        scale: Scale::Logarithmic,
    },
    usual: 0.01..=100.0,
    range: |group| group.springs.clone(),
    array: |params| &params.spring_rest_length,
    change: Change::RestScale,
    value: |model, params, spring| {
        let built = model.spring_rest_length()[spring];
        // What dividing rounds is no difference.
        let scale = (1e5 * params.spring_rest_length[spring] / built).round() / 1e5;
        (built > 0.0).then_some(scale)
    },
};

impl ParamsPanel {
    /// All sections.
    pub fn show(&mut self, ui: &mut Ui, state: &mut AppState) {
        let opened = state.report.opened.clone();
        if self.serial != Some(opened.serial) {
            *self = Self { serial: Some(opened.serial), groups: groups(&opened.model), ..Self::default() };
        }
        section(ui, "Time step", true, |ui| time_step(ui, state));
        section(ui, "Gravity", true, |ui| gravity(ui, state));
        section(ui, "Masses and springs", true, |ui| self.bodies(ui, state));
        section(ui, "Ground", !state.report.params.planes.is_empty(), |ui| super::ground::show(ui, state));
        section(ui, "Pins", false, |ui| pins(ui, state));
    }

    fn bodies(&mut self, ui: &mut Ui, state: &mut AppState) {
        let report = state.report.clone();
        let several = self.groups.len() > 1;
        for (index, group) in self.groups.iter().enumerate() {
            ui.push_id(index, |ui| {
                if several {
                    ui.label(RichText::new(&group.name).strong());
                }
                let rows = [
                    (&MASS, &mut self.mass),
                    (&STIFFNESS, &mut self.stiffness),
                    (&DAMPING, &mut self.damping),
                    (&REST_LENGTH, &mut self.rest_length),
                ];
                for (quantity, cache) in rows {
                    let ranges = || self.groups.iter().map(quantity.range);
                    let spread_of = |spreads: &mut Spreads, params: &Params| {
                        let value = |item| (quantity.value)(&report.opened.model, params, item);
                        spreads.of((quantity.array)(params), ranges(), value)[index]
                    };
                    let now = spread_of(&mut cache.now, &report.params);
                    let own = spread_of(&mut cache.own, &report.opened.params);
                    if let (Some(now), Some(own)) = (now, own) {
                        row(ui, state, quantity, group, now, own);
                    }
                }
            });
        }
    }
}

/// The row of one value of one group: a number where all are the same, else their range and a factor.
fn row(ui: &mut Ui, state: &mut AppState, quantity: &Quantity, group: &Group, now: Spread, own: Spread) {
    let report = state.report.clone();
    let value_now = |item| (quantity.value)(&report.opened.model, &report.params, item);
    let value_own = |item| (quantity.value)(&report.opened.model, &report.opened.params, item);
    let (name, range) = (quantity.number.name, (quantity.range)(group));
    let label = format!("{name} of {}", group.name);
    let to = |value: f32| stretches(range.clone(), |item| value_now(item).map(|_| value), quantity.change);
    let mut edit = None;
    if now.is_uniform() {
        let middle = f64::from(own.low.max(own.high));
        let number = Number { slider: around(middle, quantity.usual.clone()), ..quantity.number.clone() };
        let own_value = own.is_uniform().then_some(f64::from(own.low));
        if let Some(asked) = number.show(ui, f64::from(now.low), own_value) {
            edit = Some(Edit {
                label: label.clone(),
                changes: to(asked.value as f32),
                continues: asked.continues,
            });
        }
    } else if let Some(factor) = factor_row(ui, quantity, now) {
        let times = |item| value_now(item).map(|value| value * factor as f32);
        edit = Some(Edit::new(label.clone(), stretches(range.clone(), times, quantity.change)));
    }
    // Values that differ from spring to spring go back one by one.
    if !own.is_uniform() && range.clone().any(|item| value_now(item) != value_own(item)) {
        let text = format!("{} … {} {}", shown(own.low), shown(own.high), quantity.number.unit);
        if own_button(ui, name, &text, true) {
            edit = Some(Edit::new(label, stretches(range.clone(), value_own, quantity.change)));
        }
    }
    if let Some(edit) = edit {
        state.edit(edit);
    }
}

/// Values that vary: their range, and a factor for all of them.
fn factor_row(ui: &mut Ui, quantity: &Quantity, now: Spread) -> Option<f64> {
    let number = &quantity.number;
    // The factor may take neither the least nor the greatest out of what is allowed.
    let most = number.allowed.end() / f64::from(now.high).max(f64::MIN_POSITIVE);
    let least = if *number.allowed.start() > 0.0 { number.allowed.start() / f64::from(now.low) } else { 0.0 };
    let about = format!(
        "{}\n\nHere it varies, from {} to {} {}: a factor changes all of them in proportion.",
        number.about,
        shown(now.low),
        shown(now.high),
        number.unit
    );
    ui.weak(format!("{} from {} to {} {}", number.name, shown(now.low), shown(now.high), number.unit));
    let name = format!("× {}", number.name);
    let factor = Number {
        name: &name,
        unit: "",
        about: &about,
        allowed: least..=most.min(1e12),
        slider: 0.1..=10.0,
        scale: Scale::Logarithmic,
    };
    factor.show(ui, 1.0, None).map(|asked| asked.value)
}

fn shown(value: f32) -> String {
    significant(f64::from(value))
}

fn time_step(ui: &mut Ui, state: &mut AppState) {
    let (params, own) = (state.report.params.clone(), state.report.opened.params.clone());
    let dt = Number {
        name: "step dt",
        unit: "s",
        about: "Length of one step: v += f/m·dt, then x += v·dt. Stable while dt < 4/(c + √(c² + 4ω²)) in every mode; \
                the error is proportional to dt.",
        allowed: DT_RANGE,
        slider: around(own.dt, 1e-5..=0.1),
        scale: Scale::Logarithmic,
    };
    if let Some(Asked { value, continues }) = dt.show(ui, params.dt, Some(own.dt)) {
        state.edit(Edit { label: "dt".to_owned(), changes: vec![Change::Dt(value)], continues });
    }
    let substeps = Number {
        name: "sub-steps",
        unit: "/frame",
        about: "Steps for each frame: a frame is substeps·dt of simulated time. It counts for the report's pace, for \
                “Frame”, and for animations; in real time, only dt matters.",
        allowed: f64::from(*SUBSTEPS_RANGE.start())..=f64::from(*SUBSTEPS_RANGE.end()),
        slider: 1.0..=(20.0 * f64::from(own.substeps)).max(100.0),
        scale: Scale::Whole,
    };
    let own = Some(f64::from(own.substeps));
    if let Some(Asked { value, continues }) = substeps.show(ui, f64::from(params.substeps), own) {
        let changes = vec![Change::Substeps(value as u32)];
        state.edit(Edit { label: "sub-steps".to_owned(), changes, continues });
    }
    let frame = params.dt * f64::from(params.substeps);
    ui.weak(format!("A frame is {} s of simulated time.", significant(frame)));
}

fn gravity(ui: &mut Ui, state: &mut AppState) {
    let (now, own) = (state.report.params.gravity, state.report.opened.params.gravity);
    let mut asked: Option<(Vec3, bool)> = None;
    let planet = PLANETS.iter().find(|(_, g)| now == Vec3::new(0.0, 0.0 - g, 0.0));
    ui.horizontal(|ui| {
        let label = ui.label("as on");
        let chosen = planet.map_or("nowhere known", |(name, _)| name);
        let combo = ComboBox::from_id_salt("planet").selected_text(chosen).height(320.0).show_ui(ui, |ui| {
            for (name, g) in PLANETS {
                let text = format!("{name}   {g} m/s²");
                if ui.selectable_label(chosen == name, text).clicked() {
                    asked = Some((Vec3::new(0.0, 0.0 - g, 0.0), false));
                }
            }
        });
        combo.response.labelled_by(label.id).on_hover_text("Gravity at the surface, straight down.");
    });
    for (axis, name) in ["g_x", "g_y", "g_z"].into_iter().enumerate() {
        let number = Number {
            name,
            unit: "m/s²",
            about: "A component of gravity; +y is up. It appears in f += m·g.",
            allowed: magnitude(),
            slider: -30.0..=30.0,
            scale: Scale::Linear,
        };
        if let Some(Asked { value, continues }) =
            number.show(ui, f64::from(now[axis]), Some(f64::from(own[axis])))
        {
            let mut gravity = now;
            gravity[axis] = value as f32;
            asked = Some((gravity, continues));
        }
    }
    if let Some((gravity, continues)) = asked {
        state.edit(Edit { label: "gravity".to_owned(), changes: vec![Change::Gravity(gravity)], continues });
    }
}

/// The allowed size of coordinates, accelerations and forces.
pub fn magnitude() -> RangeInclusive<f64> {
    f64::from(*MAGNITUDE_RANGE.start())..=f64::from(*MAGNITUDE_RANGE.end())
}

fn pins(ui: &mut Ui, state: &mut AppState) {
    let (params, own) = (state.report.params.clone(), state.report.opened.params.clone());
    let count = params.point_pinned.iter().filter(|&&pinned| pinned).count();
    let massless = params.point_mass.iter().filter(|&&mass| mass == 0.0).count();
    ui.label(match count {
        0 => "No point is pinned.".to_owned(),
        1 => "1 point is pinned.".to_owned(),
        _ => format!("{count} points are pinned."),
    })
    .on_hover_text("A pinned point is fixed in space, whatever pulls at it. Double-click a point in the scene to pin or free it.");
    if massless > 0 {
        let (points, are) = if massless == 1 { ("point", "is") } else { ("points", "are") };
        ui.weak(format!("{massless} {points} of zero mass {are} fixed as well."));
    }
    ui.horizontal(|ui| {
        let points = params.point_pinned.len();
        let free = ui.add_enabled(count > 0, egui::Button::new("Free all"));
        if free.on_hover_text("Every pinned point may move.").clicked() {
            state.edit(Edit::new("free all pins", vec![Change::Pin(0..points, false)]));
        }
        let differs = params.point_pinned != own.point_pinned;
        let button = ui.add_enabled(differs, egui::Button::new("Own pins"));
        if button.on_hover_text("The points that the scene itself pins.").clicked() {
            let changed = |point: usize| {
                (params.point_pinned[point] != own.point_pinned[point]).then_some(own.point_pinned[point])
            };
            state.edit(Edit::new("own pins", stretches(0..points, changed, Change::Pin)));
        }
    });
}
