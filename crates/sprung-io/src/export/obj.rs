//! OBJ: a text file for each frame, which everything reads.

use std::io::{self, Write};

use sprung::Result;

use super::geometry::Part;
use super::mesh_files::{Writer, begin};
use super::{Estimate, Exporter, Geometry, Heeds, Options, RunInfo, Up, Writes};

/// `.obj`: a mesh file for each frame; numbers read back to the same float32.
pub const OBJ: Exporter = Exporter {
    ending: "obj",
    description: "meshes, one file for each frame: NAME.0000.obj and so on",
    heeds: &[Heeds::Geometry, Heeds::Springs],
    writes: Writes::Sequence,
    estimate,
    open: |path, run, options| begin(path, run, options, None, format),
    resume: Some(|path, run, options, mark| begin(path, run, options, Some(mark), format)),
};

fn format(run: &RunInfo, options: &Options, _: &Geometry) -> Writer {
    let (title, head) = (one_line(&run.title), unit_and_axes(options));
    Box::new(move |out, geometry, frame| {
        writeln!(out, "# {title}")?;
        writeln!(out, "# frame {} at {} s; {head}", frame.index, frame.snapshot.time)?;
        write_geometry(out, geometry)
    })
}

/// Numbers of about nine characters; corners as long as the numbers of the vertices.
fn estimate(run: &RunInfo, options: &Options) -> Result<Estimate> {
    let geometry = Geometry::of_meshes(run, options)?;
    let vertices = geometry.vertex_count() as u64;
    let corner = 1 + u64::from(vertices.max(1).ilog10());
    let corners = (geometry.corner_count() + 2 * geometry.lines().len()) as u64;
    Ok(Estimate::About(run.frames * (150 + vertices * 34 + corners * (corner + 2))))
}

/// Which unit and which axes a file has, for people.
pub(super) fn unit_and_axes(options: &Options) -> String {
    let up = match options.up {
        Up::Y => "+Y",
        Up::Z => "+Z",
    };
    format!("{} to a metre, {up} up", units(options.scale))
}

fn units(scale: f64) -> String {
    if scale == 1.0 { "1 unit".into() } else { format!("{scale} units") }
}

/// A text without line breaks and other control characters.
pub(super) fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// An object for each part, and one for the lines. Vertices count from 1 and through all parts.
fn write_geometry(out: &mut impl Write, geometry: &Geometry) -> io::Result<()> {
    let mut digits = zmij::Buffer::new();
    let mut whole = Digits::default();
    for part in geometry.parts() {
        writeln!(out, "o {}", word(&part.name))?;
        for v in &geometry.positions()[part.vertices.clone()] {
            out.write_all(b"v")?;
            for component in v.to_array() {
                out.write_all(b" ")?;
                out.write_all(digits.format(component).as_bytes())?;
            }
            out.write_all(b"\n")?;
        }
        if !part.triangles.is_empty() {
            out.write_all(b"s 1\n")?; // smooth
        }
        let first = 1 + part.vertices.start as u64;
        for face in part.faces() {
            out.write_all(b"f")?;
            for corner in face.corners() {
                out.write_all(b" ")?;
                out.write_all(whole.of(first + u64::from(corner)))?;
            }
            out.write_all(b"\n")?;
        }
    }
    if !geometry.lines().is_empty() {
        // Points that only lines end at have begun that object.
        if !geometry.parts().last().is_some_and(Part::is_line_ends) {
            out.write_all(b"o springs\n")?;
        }
        for line in geometry.lines() {
            out.write_all(b"l")?;
            for end in line.ends {
                out.write_all(b" ")?;
                out.write_all(whole.of(1 + u64::from(end)))?;
            }
            out.write_all(b"\n")?;
        }
    }
    Ok(())
}

/// A name as one word, as the format asks.
fn word(name: &str) -> String {
    let word: String =
        name.chars().map(|c| if c.is_control() || c.is_whitespace() { '_' } else { c }).collect();
    if word.is_empty() { "_".into() } else { word }
}

/// The digits of a whole number, without an allocation.
#[derive(Default)]
struct Digits([u8; 20]);

impl Digits {
    fn of(&mut self, mut number: u64) -> &[u8] {
        let mut start = self.0.len();
        loop {
            start -= 1;
            self.0[start] = b'0' + (number % 10) as u8;
            number /= 10;
            if number == 0 {
                return &self.0[start..];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_words() {
        for (name, expected) in
            [("jelly", "jelly"), ("left post\n", "left_post_"), ("", "_"), ("Würfel", "Würfel")]
        {
            assert_eq!(word(name), expected);
        }
    }

    #[test]
    fn whole_numbers_have_their_digits() {
        let mut digits = Digits::default();
        for number in [0, 1, 9, 10, 4_294_967_296, u64::MAX] {
            assert_eq!(digits.of(number), number.to_string().as_bytes());
        }
    }
}
