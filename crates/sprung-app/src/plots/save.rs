//! Plots as files: the numbers as `.csv`, the curves as `.svg` or `.png`. Bytes only; the files' door asks where.

use std::fmt::Write;

use egui_plot::LineStyle;
use sprung::{Code, Error, Result};
use sprung_driver::{Probe, Sample};
use sprung_render::plot::{self, Chart};

use super::entries::ENTRIES;
use super::quantity;
use super::{Page, value};
use crate::media::{SaveRequest, file_stem};

/// A format that plots are saved in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Numbers.
    Csv,
    /// A picture of lines.
    Svg,
    /// A picture of pixels.
    Png,
}

/// A format as the menu shows it.
#[derive(Clone, Copy, Debug)]
pub struct FormatInfo {
    /// The format.
    pub format: Format,
    /// Its name.
    pub name: &'static str,
    /// What it is good for.
    pub description: &'static str,
}

/// All formats.
pub const FORMATS: [FormatInfo; 3] = [
    FormatInfo {
        format: Format::Csv,
        name: "Numbers (.csv)",
        description: "A table with one row for each sample, for a spreadsheet or a program.",
    },
    FormatInfo {
        format: Format::Svg,
        name: "Picture of lines (.svg)",
        description: "Sharp at any size, for a report or a page.",
    },
    FormatInfo {
        format: Format::Png,
        name: "Picture of pixels (.png)",
        description: "For slides and messages.",
    },
];

/// A curve to be drawn in a file.
pub struct Curve {
    /// What the legend calls it.
    pub name: String,
    /// sRGB on white.
    pub colour: u32,
    /// Solid, dashed, dotted.
    pub style: LineStyle,
    /// Its points.
    pub points: Vec<(f64, f64)>,
}

/// The energy ledger.
///
/// # Errors
/// If the picture cannot be encoded, as with all pictures here.
pub fn ledger(page: Page<'_>, format: Format) -> Result<SaveRequest> {
    if format == Format::Csv {
        let header = ENTRIES.iter().map(|entry| format!("{} (J)", entry.name)).collect::<Vec<_>>();
        let row = |sample: &Sample| ENTRIES.iter().map(|entry| Some((entry.value)(&sample.energy))).collect();
        return Ok(csv(page, "energy", table(&header, page.samples, row)));
    }
    let energies: Vec<_> = page.samples.iter().map(|sample| (sample.time, sample.energy)).collect();
    picture(page, "energy", &plot::energy_chart(&title(page, "energy"), &energies), format)
}

/// The recorded values of some probes as a table; cells are empty where nothing was recorded.
pub fn values(page: Page<'_>, probes: &[Probe]) -> SaveRequest {
    let header: Vec<String> = probes.iter().map(|probe| quantity::axis(*probe)).collect();
    let row = |sample: &Sample| probes.iter().map(|probe| value(sample, *probe)).collect();
    csv(page, "traces", table(&header, page.samples, row))
}

/// A table of anything against time.
pub fn rows(page: Page<'_>, what: &str, header: &[String], rows: &[(f64, Vec<f64>)]) -> SaveRequest {
    let mut text = format!("time (s),{}\n", header.join(","));
    for (time, values) in rows {
        let cells: Vec<String> = values.iter().map(f64::to_string).collect();
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{time},{}", cells.join(","));
    }
    csv(page, what, text)
}

/// A table that is ready.
pub fn csv(page: Page<'_>, what: &str, text: String) -> SaveRequest {
    request(page, what, Format::Csv, text.into_bytes())
}

/// Some curves as a picture.
///
/// # Errors
/// If it cannot be encoded.
pub fn chart(
    page: Page<'_>,
    what: &str,
    across: String,
    upwards: String,
    curves: Vec<Curve>,
    format: Format,
) -> Result<SaveRequest> {
    let curves = curves.into_iter().map(|Curve { name, colour, style, points }| plot::Curve {
        name,
        colour,
        width: 1.8,
        dash: match style {
            LineStyle::Solid => &[],
            LineStyle::Dashed { .. } => &[7.0, 4.0],
            LineStyle::Dotted { .. } => &[2.0, 3.0],
        },
        points,
    });
    let chart =
        Chart { title: title(page, what), across, upwards, unit: "", curves: curves.collect(), note: None };
    picture(page, what, &chart, format)
}

/// One row for each sample: step, time, and the cells. Numbers read back to the same float64.
fn table(header: &[String], samples: &[&Sample], row: impl Fn(&Sample) -> Vec<Option<f64>>) -> String {
    let mut text = "step,time (s)".to_owned();
    for name in header {
        let _ = write!(text, ",{name}");
    }
    text.push('\n');
    for sample in samples {
        let _ = write!(text, "{},{}", sample.step, sample.time);
        for cell in row(sample) {
            text.push(',');
            if let Some(value) = cell {
                let _ = write!(text, "{value}");
            }
        }
        text.push('\n');
    }
    text
}

fn picture(page: Page<'_>, what: &str, chart: &Chart, format: Format) -> Result<SaveRequest> {
    let bytes = match format {
        Format::Svg => chart.svg(plot::SIZE).into_bytes(),
        _ => chart
            .png(plot::SIZE)
            .map_err(|error| Error::new(Code::Unwritable, format!("the plot cannot be encoded: {error}")))?,
    };
    Ok(request(page, what, format, bytes))
}

fn title(page: Page<'_>, what: &str) -> String {
    format!("{}: {what}", page.report.opened.scene.title)
}

fn request(page: Page<'_>, what: &str, format: Format, bytes: Vec<u8>) -> SaveRequest {
    let ending = match format {
        Format::Csv => "csv",
        Format::Svg => "svg",
        Format::Png => "png",
    };
    SaveRequest { name: format!("{}-{what}.{ending}", file_stem(&page.report.opened.name)), bytes }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::Energy;

    #[test]
    fn tables_hold_the_very_numbers() {
        let sample = |step: u64, values: Vec<(Probe, f64)>| Sample {
            step,
            time: 0.1 + 0.2 * step as f64,
            energy: Energy { kinetic: 1.0 / 3.0, elastic: f64::NAN, ..Energy::default() },
            values,
        };
        let samples = [sample(0, vec![]), sample(1, vec![(Probe::Speed(1), 0.1 + 0.2)])];
        let samples: Vec<&Sample> = samples.iter().collect();
        let row = |sample: &Sample| vec![value(sample, Probe::Speed(1)), Some(sample.energy.kinetic)];
        let text = table(&["speed".to_owned(), "kinetic".to_owned()], &samples, row);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "step,time (s),speed,kinetic");
        assert_eq!(lines[1], "0,0.1,,0.3333333333333333");
        let cells: Vec<&str> = lines[2].split(',').collect();
        assert_eq!(cells[1].parse(), Ok(0.1 + 0.2 * 1.0));
        assert_eq!(cells[2].parse(), Ok(0.1 + 0.2));
        assert_eq!(lines.len(), 3);
    }
}
