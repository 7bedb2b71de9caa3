//! The points that a body holds: each pin must find some.

use std::collections::HashSet;

use super::values::{exactly_one, point_of, vector};
use crate::build::{Lattice, Mesh};
use crate::error::{Code, Error, Result};
use crate::scene::assemble::pinned_vertices;
use crate::scene::choices::{Pin, PinWhere};
use crate::scene::suggest::{did_you_mean, shortened};
use crate::scene::types::Body;

/// Groups or colours of a mesh that a sentence lists.
const MOST_LISTED: usize = 12;

pub fn check_pins(path: &str, body: &Body) -> Result<()> {
    let shape = body.shape();
    let mut indices = HashSet::new();
    let mut sides = Vec::new();
    for (index, pin) in body.pins.iter().enumerate() {
        let field = format!("{path}.pins[{index}]");
        match pin {
            Pin::Index(point) => {
                point_of(&field, *point, body)?;
                if !indices.insert(*point) {
                    let sentence = format!("pins point {point} a second time");
                    return Err(Error::new(Code::Duplicate, sentence).at_field(field));
                }
            }
            Pin::Side(name) => {
                let side = shape.as_ref().and_then(|lattice| lattice.side(name));
                let side = side.ok_or_else(|| {
                    unknown_side(name, shape.as_ref(), body.mesh.is_some()).at_field(&field)
                })?;
                if sides.contains(&side) {
                    let sentence = format!("pins the side \"{name}\" a second time");
                    return Err(Error::new(Code::Duplicate, sentence).at_field(field));
                }
                sides.push(side);
            }
            Pin::Where(place) => check_place(&field, place, body)?,
        }
    }
    Ok(())
}

/// A pin by box, place, group or colour.
fn check_place(field: &str, pin: &PinWhere, body: &Body) -> Result<()> {
    let ways = [
        ("box", pin.region.is_some()),
        ("nearest", pin.nearest.is_some()),
        ("group", pin.group.is_some()),
        ("colour", pin.colour.is_some()),
    ];
    exactly_one(field, "does not say which points to hold", &ways)?;
    if let Some(region) = &pin.region {
        vector(&format!("{field}.box.min"), region.min, "m")?;
        vector(&format!("{field}.box.max"), region.max, "m")?;
        if let Some(axis) = (0..3).find(|&axis| region.min[axis] > region.max[axis]) {
            let (min, max) = (region.min[axis], region.max[axis]);
            let sentence = format!("has min {min} above max {max} along {}", ["x", "y", "z"][axis]);
            return Err(Error::new(Code::Conflict, sentence).at_field(format!("{field}.box")));
        }
    }
    if let Some(place) = pin.nearest {
        vector(&format!("{field}.nearest"), place, "m")?;
    }
    if let Some(colour) = pin.colour {
        vector(&format!("{field}.colour"), colour, "")?;
    }
    let key = if pin.group.is_some() { "group" } else { "colour" };
    if (pin.group.is_some() || pin.colour.is_some()) && body.mesh.is_none() {
        let sentence = format!("is a {key}, and only meshes have those");
        let error = Error::new(Code::Conflict, sentence).with_fix("pin points by number, or by a box");
        return Err(error.at_field(format!("{field}.{key}")));
    }
    let Some(mesh) = body.read_mesh() else { return Ok(()) };
    if let Some(name) = &pin.group
        && pinned_vertices(pin, mesh).is_empty()
    {
        let names = || mesh.groups.iter().map(|group| group.name.as_str());
        let there = match mesh.groups.len() {
            0 => "no groups".to_owned(),
            count => format!("the groups {}", listed(names().map(shortened), count)),
        };
        let sentence = format!("is \"{}\", and the mesh has {there}", shortened(name));
        let error = Error::new(Code::NotFound, sentence).at_field(format!("{field}.group"));
        return Err(match did_you_mean(name, names().take(1000)) {
            Some(fix) => error.with_fix(fix),
            None => error,
        });
    }
    if pin.colour.is_some() && pinned_vertices(pin, mesh).is_empty() {
        let colours = colours_of(mesh);
        let sentence = match colours.len() {
            0 => "is a colour, and the mesh has none".to_owned(),
            count => {
                let there = listed(colours.into_iter().map(in_hundredths), count);
                format!("is the colour of no vertex, and the mesh has the colours {there}")
            }
        };
        return Err(Error::new(Code::NotFound, sentence).at_field(format!("{field}.colour")));
    }
    Ok(())
}

/// The first of some names, and how many more there are.
fn listed(names: impl Iterator<Item = String>, count: usize) -> String {
    let some = names.take(MOST_LISTED).collect::<Vec<_>>().join(", ");
    match count.saturating_sub(MOST_LISTED) {
        0 => some,
        more => format!("{some} and {more} more"),
    }
}

/// The colours of a mesh in hundredths, each once, in the order of its vertices: a pin does not tell them apart more finely.
fn colours_of(mesh: &Mesh) -> Vec<[i64; 3]> {
    let mut seen = HashSet::new();
    let hundredths = |colour: &[f32; 3]| colour.map(|share| (100.0 * share).round() as i64);
    mesh.colours.iter().map(hundredths).filter(|colour| seen.insert(*colour)).collect()
}

/// A colour as a pin says it.
fn in_hundredths(colour: [i64; 3]) -> String {
    let [red, green, blue] = colour.map(|share| share as f64 / 100.0);
    format!("[{red}, {green}, {blue}]")
}

fn unknown_side(name: &str, shape: Option<&Lattice>, of_mesh: bool) -> Error {
    let short = shortened(name);
    let Some(lattice) = shape else {
        if of_mesh {
            let sentence = format!("is \"{short}\", but a mesh has no named sides");
            let error = Error::new(Code::NotFound, sentence);
            return error.with_fix(format!("say {{ group = \"{short}\" }}, or a box or a nearest place"));
        }
        let sentence = format!("is \"{short}\", but a body of explicit points has no named sides");
        return Error::new(Code::NotFound, sentence).with_fix("pin its points by number, or by a box");
    };
    let names = lattice.side_names();
    // Faces and ends are listed; edges and corners are put together from them.
    let simple: Vec<&str> = names.iter().map(String::as_str).filter(|name| !name.contains('-')).collect();
    let joined = if names.len() > simple.len() { ", or such names joined by \"-\"" } else { "" };
    let error = Error::new(
        Code::NotFound,
        format!("is \"{short}\", and this shape has the sides {}{joined}", simple.join(", ")),
    );
    match did_you_mean(name, names.iter().map(String::as_str)) {
        Some(fix) => error.with_fix(fix),
        None => error,
    }
}
