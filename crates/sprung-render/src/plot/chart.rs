//! A line chart: axes with round numbers, a grid, curves, and a legend beside them that covers nothing.

use glam::Vec2;

use super::sheet::Sheet;
use crate::colour::{INK, INK_SOFT};
use crate::export::write_png;
use crate::text::{Anchor, number};

/// Space for the title, the numbers of both axes and the legend, in the sheet's units.
const TOP: f32 = 56.0;
const LEFT: f32 = 78.0;
const BOTTOM: f32 = 58.0;
const RIGHT: f32 = 206.0;
const GRID: u32 = 0xe3_e7_eb;
const AXIS: u32 = 0x9a_a4_ae;

/// A curve of a [`Chart`].
#[derive(Clone, Debug)]
pub struct Curve {
    /// What the legend calls it; `k_s` and `k_{c,d}` have subscripts.
    pub name: String,
    /// sRGB.
    pub colour: u32,
    /// Width of the line, in the sheet's units.
    pub width: f32,
    /// Lengths of dashes and gaps in turn; none for a solid line.
    pub dash: &'static [f32],
    /// Its points in order, in the units of the axes. What is not finite leaves a gap.
    pub points: Vec<(f64, f64)>,
}

/// Curves over axes with round numbers, and a legend with the value at each curve's end.
#[derive(Clone, Debug)]
pub struct Chart {
    /// The line above it.
    pub title: String,
    /// What runs to the right, with its unit: `time (s)`.
    pub across: String,
    /// What runs upwards, without its unit.
    pub upwards: String,
    /// The unit of that; joules get a prefix that keeps the numbers short. Empty if curves have several units.
    pub unit: &'static str,
    /// The curves; the first is drawn on top.
    pub curves: Vec<Curve>,
    /// A line below the legend.
    pub note: Option<&'static str>,
}

impl Chart {
    /// The chart as an SVG file.
    pub fn svg(&self, size: [u32; 2]) -> String {
        self.draw(size).svg()
    }

    /// The chart as a PNG file, two pixels for each unit of `size`.
    ///
    /// # Errors
    /// None in practice: the bytes go to memory.
    pub fn png(&self, size: [u32; 2]) -> std::io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        write_png(&mut bytes, &self.draw(size).image(2))?;
        Ok(bytes)
    }

    /// Draws it on a sheet of its own.
    pub(super) fn draw(&self, size: [u32; 2]) -> Sheet {
        let mut sheet = Sheet::new(size);
        let [width, height] = size.map(|side| side as f32);
        let low = Vec2::new(LEFT, height - BOTTOM);
        let high = Vec2::new(width - RIGHT, TOP);
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let across = Axis::covering(points().map(|point| point.0), 8.0, false);
        let upwards = Axis::covering(points().map(|point| point.1).chain([0.0]), 6.0, true);
        let (unit, factor) = match self.unit {
            "J" => unit(upwards.low.abs().max(upwards.high.abs())),
            unit => (unit, 1.0),
        };
        let x = |value: f64| low.x + (high.x - low.x) * across.share(value);
        let y = |value: f64| low.y + (high.y - low.y) * upwards.share(value);

        sheet.text(self.title.as_str(), Vec2::new(LEFT, 33.0), Anchor::Start, 19.0, INK);
        for value in upwards.marks() {
            let colour = if value == 0.0 { AXIS } else { GRID };
            sheet.line(vec![Vec2::new(low.x, y(value)), Vec2::new(high.x, y(value))], 1.0, &[], colour);
            let place = Vec2::new(low.x - 9.0, y(value) + 4.5);
            sheet.text(number(value * factor), place, Anchor::End, 13.0, INK_SOFT);
        }
        for value in across.marks() {
            sheet.line(vec![Vec2::new(x(value), low.y), Vec2::new(x(value), high.y)], 1.0, &[], GRID);
            sheet.text(number(value), Vec2::new(x(value), low.y + 20.0), Anchor::Middle, 13.0, INK_SOFT);
        }
        sheet.line(vec![Vec2::new(low.x, high.y), low, Vec2::new(high.x, low.y)], 1.2, &[], AXIS);
        let place = Vec2::new(0.5 * (low.x + high.x), height - 14.0);
        sheet.text(self.across.as_str(), place, Anchor::Middle, 14.0, INK);
        let name = &self.upwards;
        let label = if unit.is_empty() { name.clone() } else { format!("{name} ({unit})") };
        sheet.text_upwards(label, Vec2::new(22.0, 0.5 * (low.y + high.y)), 14.0);

        for curve in self.curves.iter().rev() {
            let points = thinned(&curve.points).into_iter();
            let points = points.map(|(across, upwards)| Vec2::new(x(across), y(upwards)));
            sheet.line(points.collect(), curve.width, curve.dash, curve.colour);
        }
        self.draw_legend(&mut sheet, Vec2::new(high.x + 20.0, TOP + 6.0), unit, factor);
        sheet
    }

    /// Each curve's name, and its value at the end.
    fn draw_legend(&self, sheet: &mut Sheet, place: Vec2, unit: &str, factor: f64) {
        let mut line = place;
        for curve in &self.curves {
            let ends = vec![line + Vec2::new(0.0, 4.0), line + Vec2::new(26.0, 4.0)];
            sheet.line(ends, curve.width, curve.dash, curve.colour);
            sheet.text(curve.name.as_str(), line + Vec2::new(34.0, 8.0), Anchor::Start, 13.0, INK);
            if let Some((_, value)) = curve.points.last() {
                let text = format!("{} {unit} at the end", number(value * factor)).replace("  ", " ");
                sheet.text(text, line + Vec2::new(34.0, 24.0), Anchor::Start, 11.0, INK_SOFT);
            }
            line.y += 43.0;
        }
        if let Some(note) = self.note {
            sheet.text(note, Vec2::new(line.x, line.y + 16.0), Anchor::Start, 11.0, INK_SOFT);
        }
    }
}

/// A range of values with round marks.
#[derive(Clone, Copy, Debug)]
struct Axis {
    low: f64,
    high: f64,
    step: f64,
}

impl Axis {
    /// The range of some values, with about `count` marks; `whole` widens it to whole steps.
    fn covering(values: impl Iterator<Item = f64>, count: f64, whole: bool) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.filter(|value| value.is_finite()) {
            (low, high) = (low.min(value), high.max(value));
        }
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        if high - low < 1e-12 * low.abs().max(high.abs()).max(1e-3) {
            high = low + low.abs().max(1.0);
        }
        let step = round_step((high - low) / count);
        if whole {
            // A curve that just touches a mark keeps a little air.
            (low, high) = ((low / step - 0.02).floor() * step, (high / step + 0.02).ceil() * step);
        }
        Self { low, high, step }
    }

    fn share(&self, value: f64) -> f32 {
        ((value - self.low) / (self.high - self.low)) as f32
    }

    fn marks(&self) -> impl Iterator<Item = f64> + use<> {
        let Self { low, high, step } = *self;
        let first = (low / step - 1e-9).ceil();
        let count = ((high / step + 1e-9).floor() - first).clamp(0.0, 100.0) as u32;
        (0..=count).map(move |index| (first + f64::from(index)) * step)
    }
}

/// The 1, 2, 5, 10, … nearest above a step.
fn round_step(step: f64) -> f64 {
    let power = libm::pow(10.0, libm::log10(step).floor());
    [1.0, 2.0, 5.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|round| *round >= step * 0.999)
        .unwrap_or(10.0 * power)
}

/// A unit that keeps numbers short, and by how much joules are multiplied for it.
fn unit(largest: f64) -> (&'static str, f64) {
    match largest {
        size if size >= 2e9 => ("GJ", 1e-9),
        size if size >= 2e6 => ("MJ", 1e-6),
        size if size >= 2e3 => ("kJ", 1e-3),
        size if size < 2e-3 => ("µJ", 1e6),
        size if size < 2.0 => ("mJ", 1e3),
        _ => ("J", 1.0),
    }
}

/// At most some 4,000 points of a curve: of each stretch the lowest and the highest, so that no peak is lost.
fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    const STRETCHES: usize = 2000;
    if points.len() <= 2 * STRETCHES {
        return points.to_vec();
    }
    let mut kept = Vec::with_capacity(2 * STRETCHES + 2);
    for stretch in points.chunks(points.len().div_ceil(STRETCHES)) {
        let by_height = |a: &(usize, (f64, f64)), b: &(usize, (f64, f64))| a.1.1.total_cmp(&b.1.1);
        let lowest = stretch.iter().copied().enumerate().min_by(by_height);
        let highest = stretch.iter().copied().enumerate().max_by(by_height);
        if let (Some((first, a)), Some((second, b))) = (lowest, highest) {
            kept.extend(if first <= second { [a, b] } else { [b, a] });
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_round_marks_that_hold_the_data() {
        let axis = Axis::covering([-120.0, 980.0].into_iter(), 6.0, true);
        assert_eq!((axis.low, axis.high, axis.step), (-200.0, 1000.0, 200.0));
        assert_eq!(axis.marks().count(), 7);
        let axis = Axis::covering(std::iter::empty(), 6.0, true);
        assert!(axis.high > axis.low && axis.marks().count() > 2);
    }

    #[test]
    fn thinning_keeps_the_peaks() {
        let points: Vec<(f64, f64)> =
            (0..50_000).map(|i| (f64::from(i), if i == 31_234 { 7.0 } else { 0.0 })).collect();
        let kept = thinned(&points);
        assert!(kept.len() <= 4002 && kept.contains(&(31_234.0, 7.0)));
        assert!(kept.windows(2).all(|pair| pair[0].0 <= pair[1].0));
    }

    #[test]
    fn units_follow_the_size() {
        assert_eq!(
            [5e-4, 0.5, 50.0, 5e4, 5e7, 5e10].map(|size| unit(size).0),
            ["µJ", "mJ", "J", "kJ", "MJ", "GJ"]
        );
    }
}
