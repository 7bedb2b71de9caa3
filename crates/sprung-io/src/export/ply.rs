//! PLY: a binary file for each frame, with velocities, normals and colours as properties.
//!
//! Little-endian. Vertices have `x y z`, `nx ny nz` where there are triangles, `vx vy vz`, `red green blue` and `point`, the
//! number of the point that they are, or −1; faces are polygons; springs are edges, with `vertex1` and `vertex2`.

use std::fmt::Write as _;
use std::io::{self, Write};

use sprung::{Result, Vec3};

use super::mesh_files::{Writer, begin};
use super::numbers::{little, write_all};
use super::obj::{one_line, unit_and_axes};
use super::vtp::number;
use super::{Estimate, Exporter, Geometry, Heeds, Options, RunInfo, Writes};

/// `.ply`: a binary mesh file for each frame.
pub const PLY: Exporter = Exporter {
    ending: "ply",
    description: "binary meshes with normals, velocities and colours, one file for each frame",
    heeds: &[Heeds::Geometry, Heeds::Springs],
    writes: Writes::Sequence,
    estimate,
    open: |path, run, options| begin(path, run, options, None, format),
    resume: Some(|path, run, options, mark| begin(path, run, options, Some(mark), format)),
};

fn format(run: &RunInfo, options: &Options, geometry: &Geometry) -> Writer {
    let (header, mut normals) = (header(run, options, geometry), Vec::new());
    Box::new(move |out, geometry, _| {
        if has_normals(geometry) {
            geometry.normals(&mut normals);
        }
        out.write_all(header.as_bytes())?;
        write_geometry(out, geometry, &normals)
    })
}

fn estimate(run: &RunInfo, options: &Options) -> Result<Estimate> {
    let geometry = Geometry::of_meshes(run, options)?;
    let vertex = 12 + if has_normals(&geometry) { 12 } else { 0 } + 12 + 3 + 4;
    let bytes = header(run, options, &geometry).len()
        + geometry.vertex_count() * vertex
        + geometry.face_count()
        + geometry.corner_count() * 4
        + geometry.lines().len() * 8;
    Ok(Estimate::Exact(run.frames * bytes as u64))
}

fn has_normals(geometry: &Geometry) -> bool {
    geometry.triangle_count() > 0
}

/// The same for every frame.
fn header(run: &RunInfo, options: &Options, geometry: &Geometry) -> String {
    let mut header = "ply\nformat binary_little_endian 1.0\n".to_owned();
    let mut line = |text: std::fmt::Arguments<'_>| {
        let _ = writeln!(header, "{text}");
    };
    line(format_args!("comment {}", one_line(&run.title)));
    line(format_args!("comment {}; velocities per second", unit_and_axes(options)));
    line(format_args!("comment {} s from one frame to the next", run.frame_time));
    line(format_args!("element vertex {}", geometry.vertex_count()));
    let normals: &[&str] = if has_normals(geometry) { &["nx", "ny", "nz"] } else { &[] };
    for name in ["x", "y", "z"].iter().chain(normals).chain(&["vx", "vy", "vz"]) {
        line(format_args!("property float {name}"));
    }
    for name in ["red", "green", "blue"] {
        line(format_args!("property uchar {name}"));
    }
    line(format_args!("property int point"));
    line(format_args!("element face {}", geometry.face_count()));
    line(format_args!("property list uchar int vertex_indices"));
    if !geometry.lines().is_empty() {
        line(format_args!("element edge {}", geometry.lines().len()));
        line(format_args!("property int vertex1\nproperty int vertex2"));
    }
    header + "end_header\n"
}

fn write_geometry(out: &mut impl Write, geometry: &Geometry, normals: &[Vec3]) -> io::Result<()> {
    let (positions, velocities) = (geometry.positions(), geometry.velocities());
    let colours = geometry.parts().iter().flat_map(|part| part.vertices.clone().map(|_| part.colour));
    let vertices = colours.zip(geometry.points().map(number)).enumerate();
    if has_normals(geometry) {
        let record = |(vertex, (colour, point)): (usize, ([u8; 3], [u8; 4]))| {
            let mut record = [0; 43];
            record[..12].copy_from_slice(&little(positions[vertex]));
            record[12..24].copy_from_slice(&little(normals[vertex]));
            record[24..36].copy_from_slice(&little(velocities[vertex]));
            record[36..39].copy_from_slice(&colour);
            record[39..].copy_from_slice(&point);
            record
        };
        write_all(out, vertices.map(record))?;
    } else {
        let record = |(vertex, (colour, point)): (usize, ([u8; 3], [u8; 4]))| {
            let mut record = [0; 31];
            record[..12].copy_from_slice(&little(positions[vertex]));
            record[12..24].copy_from_slice(&little(velocities[vertex]));
            record[24..27].copy_from_slice(&colour);
            record[27..].copy_from_slice(&point);
            record
        };
        write_all(out, vertices.map(record))?;
    }
    let mut record = Vec::new();
    for face in geometry.faces() {
        record.clear();
        record.push(face.len() as u8); // at most 255: see `MOST_CORNERS` of the engine's faces
        face.corners().for_each(|corner| record.extend(corner.to_le_bytes()));
        out.write_all(&record)?;
    }
    write_all(out, geometry.lines().iter().flat_map(|line| line.ends).map(u32::to_le_bytes))
}
