//! A sheet of lines and text that can be written as SVG or painted as pixels: what is drawn is said once.

use std::fmt::Write;

use glam::Vec2;

use crate::colour::{INK, srgb};
use crate::image::Image;
use crate::text::{self, Anchor, Style, pieces};

/// One thing on a sheet. Colours are sRGB, lengths are the sheet's units.
#[derive(Clone, Debug)]
enum Mark {
    Line { points: Vec<Vec2>, width: f32, dash: &'static [f32], colour: u32 },
    Text { text: String, place: Vec2, anchor: Anchor, size: f32, colour: u32, upwards: bool },
}

/// What has been drawn so far.
#[derive(Clone, Debug)]
pub struct Sheet {
    size: [u32; 2],
    marks: Vec<Mark>,
}

impl Sheet {
    /// An empty white sheet.
    pub fn new(size: [u32; 2]) -> Self {
        Self { size, marks: Vec::new() }
    }

    /// Draws a line with round joins.
    pub fn line(&mut self, points: Vec<Vec2>, width: f32, dash: &'static [f32], colour: u32) {
        self.marks.push(Mark::Line { points, width, dash, colour });
    }

    /// Writes text with its baseline at `place`.
    pub fn text(&mut self, text: impl Into<String>, place: Vec2, anchor: Anchor, size: f32, colour: u32) {
        self.marks.push(Mark::Text { text: text.into(), place, anchor, size, colour, upwards: false });
    }

    /// Writes text in ink that runs upwards, its middle at `place`.
    pub fn text_upwards(&mut self, text: impl Into<String>, place: Vec2, size: f32) {
        let text = text.into();
        self.marks.push(Mark::Text { text, place, anchor: Anchor::Middle, size, colour: INK, upwards: true });
    }

    /// The sheet as an SVG file.
    pub fn svg(&self) -> String {
        let [width, height] = self.size;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"Ubuntu, 'Noto Sans', 'Segoe UI', Helvetica, Arial, sans-serif\">\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
        );
        for mark in &self.marks {
            // Writing to a String cannot fail.
            let _ = match mark {
                Mark::Line { points, width, dash, colour } => {
                    let dash: Vec<String> = dash.iter().map(f32::to_string).collect();
                    writeln!(
                        svg,
                        "<path d=\"{}\" fill=\"none\" stroke=\"#{colour:06x}\" stroke-width=\"{width}\" \
                         stroke-linejoin=\"round\" stroke-dasharray=\"{}\"/>",
                        path(points),
                        if dash.is_empty() { "none".to_owned() } else { dash.join(" ") }
                    )
                }
                Mark::Text { text, place, anchor, size, colour, upwards } => {
                    let anchor = match anchor {
                        Anchor::Start => "start",
                        Anchor::Middle => "middle",
                        Anchor::End => "end",
                    };
                    let (x, y) = (place.x, place.y);
                    let turn = if *upwards {
                        format!(" transform=\"rotate(-90 {x:.1} {y:.1})\"")
                    } else {
                        String::new()
                    };
                    writeln!(
                        svg,
                        "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" fill=\"#{colour:06x}\" \
                         text-anchor=\"{anchor}\"{turn}>{}</text>",
                        spans(text)
                    )
                }
            };
        }
        svg.push_str("</svg>\n");
        svg
    }

    /// The sheet as a picture, each unit `scale` pixels wide.
    pub fn image(&self, scale: u32) -> Image {
        let white = srgb(0xff_ff_ff);
        let mut image = Image::new(self.size.map(|side| side * scale), white);
        let factor = scale as f32;
        for mark in &self.marks {
            match mark {
                Mark::Line { points, width, dash, colour } => {
                    let points: Vec<Vec2> = points.iter().map(|&point| point * factor).collect();
                    let dash: Vec<f32> = dash.iter().map(|length| length * factor).collect();
                    image.polyline(&points, width * factor, &dash, srgb(*colour));
                }
                Mark::Text { text, place, anchor, size, colour, upwards } => {
                    let style = Style { size: 1.18 * size * factor, colour: srgb(*colour), strong: true };
                    if *upwards {
                        draw_upwards(&mut image, text, *place * factor, style);
                    } else {
                        text::draw(&mut image, text, *place * factor, *anchor, style);
                    }
                }
            }
        }
        image
    }
}

/// Writes a text on a slip of its own and turns that by a quarter.
fn draw_upwards(image: &mut Image, text: &str, place: Vec2, style: Style) {
    let (length, depth) = (text::width(text, style.size).ceil() as u32 + 4, (1.5 * style.size) as u32);
    let mut slip = Image::new([length, depth], srgb(0xff_ff_ff));
    let ink = Style { colour: srgb(0), ..style };
    text::draw(&mut slip, text, Vec2::new(2.0, style.size), Anchor::Start, ink);
    for (x, y) in (0..length).flat_map(|x| (0..depth).map(move |y| (x, y))) {
        let Some([grey, ..]) = slip.pixel(x, y) else { continue };
        let cover = 1.0 - srgb(u32::from(grey)).z;
        let across = place.x + y as f32 - style.size;
        let upward = place.y + 0.5 * length as f32 - x as f32;
        image.blend(across as i64, upward as i64, style.colour, cover);
    }
}

fn path(points: &[Vec2]) -> String {
    let mut path = String::new();
    let mut pen_down = false;
    for point in points {
        if point.is_finite() {
            let _ = write!(path, "{}{:.2} {:.2}", if pen_down { "L" } else { "M" }, point.x, point.y);
        }
        pen_down = point.is_finite();
    }
    path
}

/// Text with its subscripts as SVG has them.
fn spans(text: &str) -> String {
    let span = |piece: text::Piece| {
        let text = escape(&piece.text);
        if piece.subscript { format!("<tspan font-size=\"72%\" dy=\"0.2em\">{text}</tspan>") } else { text }
    };
    pieces(text).into_iter().map(span).collect()
}

fn escape(text: &str) -> String {
    let clean = text.chars().filter(|letter| !letter.is_control()).collect::<String>();
    clean.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
