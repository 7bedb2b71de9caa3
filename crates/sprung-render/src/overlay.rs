//! What is written on a picture: the caption with scene, time and parameters, and the legend of the colours.

use glam::Vec2;
use sprung::Params;
use sprung_io::RunInfo;

use crate::colour::{INK, INK_SOFT, diverging, srgb};
use crate::image::Image;
use crate::palette::LIGHT;
use crate::text::{self, Anchor, Style, number};

/// Pictures lower than this carry no text, pixels.
const LOWEST_WITH_TEXT: u32 = 120;

/// The text of a motion's pictures, laid out for one size.
#[derive(Clone, Debug)]
pub struct Overlay {
    size: Vec2,
    margin: f32,
    title_size: f32,
    text_size: f32,
    title: String,
    facts: Vec<String>,
    /// Force at the ends of the legend, N; `None` where no spring is drawn.
    full_force: Option<f32>,
    any_fixed: bool,
    shown: bool,
}

impl Overlay {
    /// Lays out what stays the same; `grid` is the distance between the ground's lines, m.
    pub fn new(
        info: &RunInfo,
        [width, height]: [u32; 2],
        full_force: Option<f32>,
        grid: Option<f32>,
    ) -> Self {
        let size = Vec2::new(width as f32, height as f32);
        let unit = size.y.min(size.x * 0.7);
        let margin = (0.036 * unit).max(6.0);
        let text_size = (0.0255 * unit).max(10.0);
        let facts = wrap(&facts(info, grid), text_size, size.x - 2.0 * margin);
        let points = 0..info.model.point_count();
        Self {
            size,
            margin,
            title_size: (0.043 * unit).max(13.0),
            text_size,
            title: if info.title.is_empty() { info.scene.clone() } else { info.title.clone() },
            facts,
            full_force,
            any_fixed: points.into_iter().any(|point| info.params.is_fixed(point)),
            shown: height >= LOWEST_WITH_TEXT,
        }
    }

    /// The corners of the part of the picture that is left for the scene, pixels.
    fn free_area(&self) -> (Vec2, Vec2) {
        let margin = Vec2::splat(self.margin);
        if !self.shown {
            return (0.5 * margin, self.size - 0.5 * margin);
        }
        let top = self.title_size + 0.9 * self.text_size;
        let bottom = self.facts_height() + 0.5 * self.text_size;
        (margin + Vec2::new(0.0, top), self.size - margin - Vec2::new(0.0, bottom))
    }

    /// Writes on a picture.
    pub fn draw(&self, image: &mut Image, time: f64) {
        if !self.shown {
            return;
        }
        let left = self.margin;
        let mut line = self.margin + 0.8 * self.title_size;
        let title = Style { size: self.title_size, colour: srgb(INK), strong: true };
        text::draw(image, &self.title, Vec2::new(left, line), Anchor::Start, title);
        line += 1.45 * self.text_size;
        let style = Style { size: 1.15 * self.text_size, colour: srgb(INK), strong: true };
        text::draw(image, &format!("t = {} s", clock(time)), Vec2::new(left, line), Anchor::Start, style);

        let style = Style { size: self.text_size, colour: srgb(INK_SOFT), strong: true };
        let mut line = self.size.y - self.margin - self.facts_height() + self.text_size;
        for facts in &self.facts {
            text::draw(image, facts, Vec2::new(left, line), Anchor::Start, style);
            line += 1.3 * self.text_size;
        }
        self.draw_legend(image, style);
    }

    /// The colour bar with its numbers, at the top right.
    fn draw_legend(&self, image: &mut Image, style: Style) {
        let unit = self.text_size;
        let right = self.size.x - self.margin;
        let mut below = self.margin + 0.8 * unit;
        if let Some(force) = self.full_force {
            let (length, thickness) = ((13.0 * unit).min(0.4 * self.size.x), 0.55 * unit);
            let left = right - length;
            text::draw(image, "compression", Vec2::new(left, below), Anchor::Start, style);
            text::draw(image, "tension", Vec2::new(right, below), Anchor::End, style);
            let top = below + 0.4 * unit;
            let columns = length as usize;
            for column in 0..columns {
                let share = 2.0 * (column as f32 + 0.5) / columns as f32 - 1.0;
                let low = Vec2::new(left + column as f32, top);
                image.fill(low.round(), (low + Vec2::new(1.0, thickness)).round(), diverging(share), 1.0);
            }
            below = top + thickness + 1.15 * unit;
            let label = number(f64::from(force));
            let ink = Style { colour: srgb(INK), ..style };
            text::draw(image, &format!("−{label} N"), Vec2::new(left, below), Anchor::Start, ink);
            text::draw(image, "0", Vec2::new(0.5 * (left + right), below), Anchor::Middle, ink);
            text::draw(image, &format!("+{label} N"), Vec2::new(right, below), Anchor::End, ink);
            below += 1.5 * unit;
        }
        if self.any_fixed {
            text::draw(image, "fixed point", Vec2::new(right, below), Anchor::End, style);
            let left = right - text::width("fixed point", unit) - 0.8 * unit;
            image.disc(Vec2::new(left, below - 0.3 * unit), 0.32 * unit, srgb(LIGHT.fixed));
        }
    }

    fn facts_height(&self) -> f32 {
        1.3 * self.text_size * self.facts.len() as f32
    }
}

/// The corners of the part of a picture that its text leaves free, pixels.
pub fn free_area(info: &RunInfo, size: [u32; 2]) -> (Vec2, Vec2) {
    // The grid's size is not known yet; a number as long as any keeps room for it.
    Overlay::new(info, size, None, (!info.params.planes.is_empty()).then_some(0.002)).free_area()
}

/// The parameters, each as a short phrase.
fn facts(info: &RunInfo, grid: Option<f32>) -> Vec<String> {
    let Params { dt, planes, .. } = &info.params;
    // As many as there are from one frame to the next: a run with a frame rate of its own has other ones than the scene.
    let substeps = (info.frame_time / dt).round() as usize;
    let plural = |count: usize, thing: &str| {
        format!("{} {thing}{}", text::count(count), if count == 1 { "" } else { "s" })
    };
    let mut facts = vec![
        plural(info.model.point_count(), "point"),
        plural(info.model.spring_count(), "spring"),
        format!("dt = {} s", number(*dt)),
        plural(substeps, "substep"),
    ];
    facts.extend(range(&info.params.spring_stiffness).map(|value| format!("k_s = {value} N/m")));
    facts.extend(range(&info.params.spring_damping).map(|value| format!("k_d = {value} N·s/m")));
    if let Some(plane) = planes.first() {
        facts.push(format!("k_c = {} N/m", number(f64::from(plane.stiffness))));
    }
    facts.extend(grid.map(|grid| format!("grid {} m", number(f64::from(grid)))));
    facts
}

/// `750`, or `100 to 750` where values differ; `None` without any.
fn range(values: &[f32]) -> Option<String> {
    let low = values.iter().copied().reduce(f32::min)?;
    let high = values.iter().copied().reduce(f32::max)?;
    // A float32 is written with the digits it has, not those of its float64.
    let [low, high] = [low, high].map(|value| number(value.to_string().parse().unwrap_or(f64::from(value))));
    Some(if low == high { low } else { format!("{low} to {high}") })
}

/// Sets phrases into lines no longer than `width`, pixels.
fn wrap(phrases: &[String], size: f32, width: f32) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for phrase in phrases {
        match lines.last_mut() {
            Some(line) if text::width(&format!("{line}   ·   {phrase}"), size) <= width => {
                line.push_str("   ·   ");
                line.push_str(phrase);
            }
            _ => lines.push(phrase.clone()),
        }
    }
    lines
}

/// A time with two decimals, or more significant digits if it is short.
fn clock(time: f64) -> String {
    if time == 0.0 || time.abs() >= 0.1 { format!("{time:.2}") } else { number(time) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phrases_fill_lines_and_never_overflow() {
        let phrases: Vec<String> = (0..12).map(|index| format!("phrase {index}")).collect();
        let lines = wrap(&phrases, 12.0, 220.0);
        assert!(lines.len() > 1 && lines.len() < 12);
        assert!(lines.iter().all(|line| text::width(line, 12.0) <= 220.0));
    }

    #[test]
    fn steps_from_frame_to_frame_are_those_of_the_run() {
        let (model, params, _) =
            sprung::scene::Scene::builtin("spring").and_then(|scene| scene.build()).expect("it is built in");
        let params = Params { dt: 1.0 / 120.0, substeps: 7, ..params };
        let (scene, title, model) = ("spring".to_owned(), "A spring".to_owned(), model.into());
        let info = RunInfo { scene, title, model, params, frame_time: 1.0 / 24.0, frames: 49 };
        assert_eq!(facts(&info, None)[3], "5 substeps");
    }

    #[test]
    fn ranges_and_times_read_well() {
        assert_eq!(range(&[0.1, 0.1]), Some("0.1".to_owned()));
        assert_eq!(range(&[3.0, 750.0]), Some("3 to 750".to_owned()));
        assert_eq!(range(&[]), None);
        assert_eq!([0.0, 1.5, 0.07, 2e-6].map(clock), ["0.00", "1.50", "0.07", "2e−6"]);
    }
}
