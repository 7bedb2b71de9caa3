//! What must hold beyond the types: ranges, names, indices, and statements that cannot both be made.
//!
//! Each check names its field, such as `body[0].springs[1].stiffness`; the scene's origin turns that into a line.

use std::collections::HashSet;
use std::ops::RangeInclusive;

use super::assemble::pinned_vertices;
use super::choices::{Dt, OneOrEach, Pin, PinWhere};
use super::group::check_exceptions;
use super::suggest::{did_you_mean, shortened, steers};
use super::types::{Body, Joint, Plane, Scene, Springs};
use crate::build::Lattice;
use crate::error::{Code, Error, Result};
use crate::params::{
    DAMPING_RANGE, DT_RANGE, LENGTH_RANGE, MAGNITUDE_RANGE, MASS_RANGE, STIFFNESS_RANGE, SUBSTEPS_RANGE,
};

/// Points that a scene may have.
pub const MAX_POINTS: u64 = 50_000_000;

/// Characters that a body's name may have.
const NAME_LENGTH: usize = 100;

/// Allowed spacings (m) and scales: so small that they are never in the way, and large enough that no division by
/// them overflows.
const SIZE_RANGE: RangeInclusive<f32> = 1e-9..=1e9;

/// Allowed densities, kg/m² or kg/m³.
const DENSITY_RANGE: RangeInclusive<f32> = 1e-9..=1e9;

/// Allowed damping times, s.
const TIME_RANGE: RangeInclusive<f32> = 0.0..=1e6;

/// Bytes that the path of a mesh file may have.
const PATH_LENGTH: usize = 1000;

/// Checks a whole scene.
pub(super) fn check(scene: &Scene, max_points: u64) -> Result<()> {
    if let Dt::Seconds(dt) = scene.dt
        && !DT_RANGE.contains(&dt)
    {
        let sentence = format!(
            "is {} s, and must be from {:e} to {:e} s, or \"auto\"",
            plainly(dt),
            DT_RANGE.start(),
            DT_RANGE.end()
        );
        return Err(Error::new(Code::OutOfRange, sentence).at_field("dt"));
    }
    if !SUBSTEPS_RANGE.contains(&scene.substeps) {
        let (low, high) = (SUBSTEPS_RANGE.start(), SUBSTEPS_RANGE.end());
        let sentence = format!("is {}, and must be from {low} to {high}", scene.substeps);
        return Err(Error::new(Code::OutOfRange, sentence).at_field("substeps"));
    }
    vector("gravity", scene.gravity, "m/s²")?;
    if scene.max_springs == Some(0) {
        return Err(Error::new(Code::OutOfRange, "is 0, and must be at least 1").at_field("max_springs"));
    }
    for (index, plane) in scene.planes.iter().enumerate() {
        check_plane(&format!("plane[{index}]"), plane)?;
    }
    check_bodies(scene, max_points)?;
    for (index, joint) in scene.joints.iter().enumerate() {
        check_joint(&format!("joint[{index}]"), joint, &scene.bodies)?;
    }
    Ok(())
}

fn check_plane(path: &str, plane: &Plane) -> Result<()> {
    match (plane.y, plane.point, plane.normal) {
        (Some(y), None, None) => number(format!("{path}.y"), y, &MAGNITUDE_RANGE, "m")?,
        (None, Some(point), Some(normal)) => {
            vector(&format!("{path}.point"), point, "m")?;
            direction(&format!("{path}.normal"), normal)?;
        }
        (None, None, None) => {
            let sentence = "has no height; say y for a level plane, or point and normal for a sloping one";
            return Err(Error::new(Code::MissingField, sentence).at_field(path));
        }
        (Some(_), ..) => {
            let sentence =
                "says y and also point or normal; a level plane has y, a sloping one point and normal";
            return Err(Error::new(Code::Conflict, sentence).at_field(path));
        }
        (None, ..) => {
            let sentence = "has only one of point and normal; a sloping plane needs both";
            return Err(Error::new(Code::MissingField, sentence).at_field(path));
        }
    }
    number(format!("{path}.stiffness"), plane.stiffness, &STIFFNESS_RANGE, "N/m")?;
    number(format!("{path}.damping"), plane.damping, &DAMPING_RANGE, "N·s/m")
}

fn check_bodies(scene: &Scene, max_points: u64) -> Result<()> {
    if scene.bodies.is_empty() {
        let sentence = "is missing; a scene needs at least one [[body]]";
        return Err(Error::new(Code::MissingField, sentence).at_field("body"));
    }
    let mut names = HashSet::new();
    let mut points = 0u64;
    for (index, body) in scene.bodies.iter().enumerate() {
        let path = format!("body[{index}]");
        check_name(&body.name).map_err(|error| error.at_field(format!("{path}.name")))?;
        if !names.insert(&body.name) {
            let sentence = format!("is \"{}\", which another body is called already", shortened(&body.name));
            return Err(Error::new(Code::Duplicate, sentence).at_field(path + ".name"));
        }
        check_shape(&path, body)?;
        points = points.saturating_add(body.point_count());
        if points > max_points {
            let sentence =
                format!("makes {points} points in the scene, and there may be at most {max_points}");
            return Err(Error::new(Code::TooLarge, sentence).at_field(format!("{path}.{}", body.shape_key())));
        }
        check_placement(&path, body)?;
        check_masses(&path, body)?;
        check_velocity(&path, body)?;
        check_pins(&path, body)?;
        for (index, springs) in body.springs.iter().enumerate() {
            check_springs(&format!("{path}.springs[{index}]"), springs, body)?;
        }
        check_forces(&path, body)?;
    }
    Ok(())
}

/// Names come back in messages and plots, so they must be possible to show there.
fn check_name(name: &str) -> Result<()> {
    let length = name.chars().count();
    if length == 0 {
        return Err(Error::new(Code::OutOfRange, "is empty, and must have at least one letter"));
    }
    if length > NAME_LENGTH {
        let sentence = format!("has {length} characters, and may have at most {NAME_LENGTH}");
        return Err(Error::new(Code::TooLarge, sentence));
    }
    if let Some(letter) = name.chars().find(|&letter| steers(letter)) {
        let sentence = format!(
            "has the invisible character {}, and must be made of visible ones",
            letter.escape_default()
        );
        return Err(Error::new(Code::OutOfRange, sentence));
    }
    Ok(())
}

fn check_shape(path: &str, body: &Body) -> Result<()> {
    let shapes = [
        ("chain", body.chain.is_some()),
        ("grid", body.grid.is_some()),
        ("lattice", body.lattice.is_some()),
        ("points", body.points.is_some()),
        ("mesh", body.mesh.is_some()),
    ];
    exactly_one(path, "has no shape", &shapes)?;
    check_mesh(path, body)?;
    if let Some(chain) = &body.chain {
        count(&format!("{path}.chain.points"), chain.points)?;
        vector(&format!("{path}.chain.step"), chain.step, "m")?;
        vector(&format!("{path}.chain.origin"), chain.origin, "m")?;
    }
    if let Some(grid) = &body.grid {
        grid.points.iter().try_for_each(|&points| count(&format!("{path}.grid.points"), points))?;
        number(format!("{path}.grid.spacing"), grid.spacing, &SIZE_RANGE, "m")?;
        vector(&format!("{path}.grid.origin"), grid.origin, "m")?;
    }
    if let Some(block) = &body.lattice {
        block.points.iter().try_for_each(|&points| count(&format!("{path}.lattice.points"), points))?;
        number(format!("{path}.lattice.spacing"), block.spacing, &SIZE_RANGE, "m")?;
        vector(&format!("{path}.lattice.origin"), block.origin, "m")?;
    }
    if let Some(points) = &body.points {
        if points.is_empty() {
            let sentence = "is an empty list, and must have at least one point";
            return Err(Error::new(Code::OutOfRange, sentence).at_field(format!("{path}.points")));
        }
        for (index, &point) in points.iter().enumerate() {
            vector(&format!("{path}.points[{index}]"), point, "m")?;
        }
    }
    Ok(())
}

/// What a mesh becomes, and of what.
fn check_mesh(path: &str, body: &Body) -> Result<()> {
    let kinds = [("cloth", body.cloth.is_some()), ("soft", body.soft.is_some()), ("net", body.net.is_some())];
    let Some(mesh) = &body.mesh else {
        let Some((kind, _)) = kinds.iter().find(|(_, there)| *there) else { return Ok(()) };
        let error = Error::new(Code::Conflict, "is made from a mesh, and this body has none");
        return Err(error.with_fix("say mesh = \"FILE\"").at_field(format!("{path}.{kind}")));
    };
    let length = mesh.file.len();
    if length == 0 || length > PATH_LENGTH || mesh.file.chars().any(steers) {
        let sentence = format!("must be a file's name of 1 to {PATH_LENGTH} visible characters");
        return Err(Error::new(Code::OutOfRange, sentence).at_field(format!("{path}.mesh")));
    }
    let optional = |field: String, value: Option<f64>, range, unit| {
        value.map_or(Ok(()), |value| number(field, value, range, unit))
    };
    optional(format!("{path}.mesh.merge"), mesh.merge, &LENGTH_RANGE, "m")?;
    exactly_one(path, "does not say what its mesh becomes", &kinds)?;
    let at = |key: &str| format!("{path}.{}.{key}", body.material_key());
    if let Some(cloth) = &body.cloth {
        density(&at("density"), cloth.density, "kg/m²", body)?;
        number(at("stiffness"), cloth.stiffness, &STIFFNESS_RANGE, "N/m")?;
        number(at("bending"), cloth.bending, &STIFFNESS_RANGE, "N·m")?;
        optional(at("bending_radius"), cloth.bending_radius, &SIZE_RANGE, "m")?;
        number(at("damping"), cloth.damping, &TIME_RANGE, "s")?;
    }
    if let Some(soft) = &body.soft {
        number(at("spacing"), soft.spacing, &SIZE_RANGE, "m")?;
        density(&at("density"), soft.density, "kg/m³", body)?;
        number(at("stiffness"), soft.stiffness, &STIFFNESS_RANGE, "Pa")?;
        number(at("damping"), soft.damping, &TIME_RANGE, "s")?;
    }
    if let Some(net) = &body.net {
        number(at("stiffness"), net.stiffness, &STIFFNESS_RANGE, "N/m")?;
        number(at("damping"), net.damping, &DAMPING_RANGE, "N·s/m")?;
    }
    let Some((rest_scale, cut, except)) = body.mesh_springs() else { return Ok(()) };
    number(at("rest_scale"), rest_scale, &LENGTH_RANGE, "")?;
    check_exceptions(&format!("{path}.{}", body.material_key()), cut, except)
}

/// The mass of a material: its density, or the body's mass, or that of each point.
fn density(field: &str, value: Option<f64>, unit: &str, body: &Body) -> Result<()> {
    let other = match (&body.body_mass, &body.point_mass) {
        (Some(_), _) => Some("body_mass"),
        (None, Some(_)) => Some("point_mass"),
        (None, None) => None,
    };
    match (value, other) {
        (Some(_), Some(other)) => {
            let sentence = format!("is said besides the body's {other}; one of them is enough");
            Err(Error::new(Code::Conflict, sentence).at_field(field))
        }
        (Some(value), None) => number(field.to_owned(), value, &DENSITY_RANGE, unit),
        (None, None) => {
            let sentence = "is missing; say how heavy the material is, or the body's body_mass";
            Err(Error::new(Code::MissingField, sentence).at_field(field))
        }
        (None, Some(_)) => Ok(()),
    }
}

fn check_placement(path: &str, body: &Body) -> Result<()> {
    number(format!("{path}.scale"), body.scale, &SIZE_RANGE, "")?;
    if let Some(rotation) = &body.rotation {
        direction(&format!("{path}.rotation.axis"), rotation.axis)?;
        number(format!("{path}.rotation.degrees"), rotation.degrees, &MAGNITUDE_RANGE, "degrees")?;
    }
    vector(&format!("{path}.position"), body.position, "m")
}

fn check_masses(path: &str, body: &Body) -> Result<()> {
    if let (Some(_), Some(_)) = (&body.point_mass, body.body_mass) {
        let sentence = "says both point_mass and body_mass; one of them is enough";
        return Err(Error::new(Code::Conflict, sentence).at_field(format!("{path}.body_mass")));
    }
    if let Some(total) = body.body_mass {
        let field = format!("{path}.body_mass");
        mass(&field, total)?;
        if !body.waits_for_mesh() {
            mass(&field, total / body.point_count() as f64)?;
        }
    }
    let Some(masses) = &body.point_mass else { return Ok(()) };
    let field = format!("{path}.point_mass");
    each_point(&field, masses, body)?;
    let is_list = matches!(masses, OneOrEach::Each(_));
    for (index, &value) in masses.values().iter().enumerate() {
        mass(&entry(&field, is_list, index), value)?;
    }
    Ok(())
}

fn check_velocity(path: &str, body: &Body) -> Result<()> {
    let field = format!("{path}.velocity");
    each_point(&field, &body.velocity, body)?;
    let is_list = matches!(body.velocity, OneOrEach::Each(_));
    for (index, &value) in body.velocity.values().iter().enumerate() {
        vector(&entry(&field, is_list, index), value, "m/s")?;
    }
    Ok(())
}

fn check_pins(path: &str, body: &Body) -> Result<()> {
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
            1..=12 => format!("the groups {}", names().map(shortened).collect::<Vec<_>>().join(", ")),
            count => format!("{count} others"),
        };
        let sentence = format!("is \"{}\", and the mesh has {there}", shortened(name));
        let error = Error::new(Code::NotFound, sentence).at_field(format!("{field}.group"));
        return Err(match did_you_mean(name, names().take(1000)) {
            Some(fix) => error.with_fix(fix),
            None => error,
        });
    }
    if pin.colour.is_some() && pinned_vertices(pin, mesh).is_empty() {
        let sentence = match mesh.colours.is_empty() {
            true => "is a colour, and the mesh has none",
            false => "is the colour of no vertex",
        };
        return Err(Error::new(Code::NotFound, sentence).at_field(format!("{field}.colour")));
    }
    Ok(())
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

fn check_springs(path: &str, springs: &Springs, body: &Body) -> Result<()> {
    let ways = [
        ("radius", springs.radius.is_some()),
        ("kinds", springs.kinds.is_some()),
        ("pairs", springs.pairs.is_some()),
    ];
    exactly_one(path, "does not say which points to join", &ways)?;
    if let Some(kinds) = &springs.kinds {
        let field = format!("{path}.kinds");
        if body.shape().is_none() {
            let (sentence, fix) = match &body.mesh {
                Some(_) => (
                    "cannot be used with a mesh",
                    "say cloth, soft or net, and radius or pairs for more springs",
                ),
                None => {
                    ("cannot be used with explicit points, which have no neighbours", "use radius or pairs")
                }
            };
            return Err(Error::new(Code::Conflict, sentence).with_fix(fix).at_field(field));
        }
        if let Some(index) = (1..kinds.len()).find(|&index| kinds[..index].contains(&kinds[index])) {
            let sentence = "names this kind a second time";
            return Err(Error::new(Code::Duplicate, sentence).at_field(format!("{field}[{index}]")));
        }
    }
    for (index, pair) in springs.pairs.iter().flatten().enumerate() {
        let field = format!("{path}.pairs[{index}]");
        pair.iter().try_for_each(|&point| point_of(&field, point, body))?;
        if pair[0] == pair[1] {
            let sentence = format!("joins point {} to itself", pair[0]);
            return Err(Error::new(Code::Conflict, sentence).at_field(field));
        }
    }
    let material = [springs.radius, springs.rest_length, Some(springs.stiffness), Some(springs.damping)];
    check_material(path, material, springs.rest_scale, springs.pairs.is_some())?;
    check_exceptions(path, &springs.cut, &springs.except)
}

fn check_joint(path: &str, joint: &Joint, bodies: &[Body]) -> Result<()> {
    let mut ends = Vec::new();
    for (index, name) in joint.between.iter().enumerate() {
        let Some(body) = bodies.iter().find(|body| body.name == *name) else {
            let sentence = format!("is \"{}\", and there is no body of that name", shortened(name));
            let error = Error::new(Code::NotFound, sentence).at_field(format!("{path}.between[{index}]"));
            let names = bodies.iter().map(|body| body.name.as_str());
            return Err(match did_you_mean(name, names) {
                Some(fix) => error.with_fix(fix),
                None => error,
            });
        };
        ends.push(body);
    }
    if joint.between[0] == joint.between[1] {
        let sentence = format!("joins \"{}\" to itself", shortened(&joint.between[0]));
        let error =
            Error::new(Code::Conflict, sentence).with_fix("springs within a body go into [[body.springs]]");
        return Err(error.at_field(format!("{path}.between")));
    }
    let ways = [("radius", joint.radius.is_some()), ("pairs", joint.pairs.is_some())];
    exactly_one(path, "does not say which points to join", &ways)?;
    for (index, pair) in joint.pairs.iter().flatten().enumerate() {
        for (end, &point) in pair.iter().enumerate() {
            point_of(&format!("{path}.pairs[{index}][{end}]"), point, ends[end])?;
        }
    }
    let material = [joint.radius, joint.rest_length, Some(joint.stiffness), Some(joint.damping)];
    check_material(path, material, joint.rest_scale, joint.pairs.is_some())?;
    check_exceptions(path, &joint.cut, &joint.except)
}

/// What springs and joints have in common: [radius, rest_length, stiffness, damping], and the rest scale.
fn check_material(path: &str, material: [Option<f64>; 4], rest_scale: f64, by_pairs: bool) -> Result<()> {
    let fields = [
        ("radius", &LENGTH_RANGE, "m"),
        ("rest_length", &LENGTH_RANGE, "m"),
        ("stiffness", &STIFFNESS_RANGE, "N/m"),
        ("damping", &DAMPING_RANGE, "N·s/m"),
    ];
    for (value, (key, range, unit)) in material.into_iter().zip(fields) {
        value.map_or(Ok(()), |value| number(format!("{path}.{key}"), value, range, unit))?;
    }
    if material[1].is_some() && !by_pairs {
        let error = Error::new(Code::Conflict, "can be said only of springs given by pairs")
            .with_fix("use rest_scale");
        return Err(error.at_field(format!("{path}.rest_length")));
    }
    number(format!("{path}.rest_scale"), rest_scale, &LENGTH_RANGE, "")
}

fn check_forces(path: &str, body: &Body) -> Result<()> {
    let mut points = HashSet::new();
    for (index, force) in body.forces.iter().enumerate() {
        let field = format!("{path}.forces[{index}]");
        point_of(&format!("{field}.point"), force.point, body)?;
        vector(&format!("{field}.force"), force.force, "N")?;
        if !points.insert(force.point) {
            let sentence = format!("pushes point {} a second time", force.point);
            return Err(Error::new(Code::Duplicate, sentence).at_field(format!("{field}.point")));
        }
    }
    Ok(())
}

/// Of several keys that exclude each other, one must be there.
fn exactly_one(path: &str, none: &str, keys: &[(&str, bool)]) -> Result<()> {
    let all: Vec<&str> = keys.iter().map(|(key, _)| *key).collect();
    let found: Vec<&str> = keys.iter().filter(|(_, there)| *there).map(|(key, _)| *key).collect();
    match found[..] {
        [_] => Ok(()),
        [] => {
            let sentence = format!("{none}; say one of {}", all.join(", "));
            Err(Error::new(Code::MissingField, sentence).at_field(path))
        }
        [first, second, ..] => {
            let sentence = format!("says both {first} and {second}; say only one of {}", all.join(", "));
            Err(Error::new(Code::Conflict, sentence).at_field(format!("{path}.{second}")))
        }
    }
}

/// A list must have one entry for each point of the body.
fn each_point<T>(field: &str, values: &OneOrEach<T>, body: &Body) -> Result<()> {
    match values {
        // How many points a mesh makes is known when it has been read.
        _ if body.waits_for_mesh() => Ok(()),
        OneOrEach::Each(list) if list.len() as u64 != body.point_count() => {
            let sentence =
                format!("has {} entries, and the body has {} points", list.len(), body.point_count());
            Err(Error::new(Code::Conflict, sentence).at_field(field))
        }
        _ => Ok(()),
    }
}

fn point_of(field: &str, point: u32, body: &Body) -> Result<()> {
    let count = body.point_count();
    if u64::from(point) < count || body.waits_for_mesh() {
        return Ok(());
    }
    let name = shortened(&body.name);
    let sentence = format!("names point {point}, and \"{name}\" has the points 0 to {}", count - 1);
    Err(Error::new(Code::NotFound, sentence).at_field(field))
}

fn count(field: &str, points: u32) -> Result<()> {
    if points > 0 {
        return Ok(());
    }
    Err(Error::new(Code::OutOfRange, "has a count of 0, and there must be at least 1 point").at_field(field))
}

fn mass(field: &str, value: f64) -> Result<()> {
    if value == 0.0 || MASS_RANGE.contains(&(value as f32)) {
        return Ok(());
    }
    let (low, high) = (MASS_RANGE.start(), MASS_RANGE.end());
    let sentence =
        format!("is {} kg, and must be 0 (fixed in space) or from {low:e} to {high:e} kg", plainly(value));
    Err(Error::new(Code::OutOfRange, sentence).at_field(field))
}

/// A direction has any length but zero.
fn direction(field: &str, value: [f64; 3]) -> Result<()> {
    vector(field, value, "")?;
    // So small that its square is lost counts as zero, too.
    if value.iter().map(|component| component * component).sum::<f64>() > 1e-200 {
        return Ok(());
    }
    Err(Error::new(Code::OutOfRange, "has length 0, and must point somewhere").at_field(field))
}

fn vector(field: &str, value: [f64; 3], unit: &str) -> Result<()> {
    value.iter().enumerate().try_for_each(|(axis, &component)| {
        number(format!("{field}[{axis}]"), component, &MAGNITUDE_RANGE, unit)
    })
}

pub(super) fn number(field: String, value: f64, range: &RangeInclusive<f32>, unit: &str) -> Result<()> {
    if range.contains(&(value as f32)) {
        return Ok(());
    }
    let space = if unit.is_empty() { "" } else { " " };
    let (low, high) = (plainly(f64::from(*range.start())), plainly(f64::from(*range.end())));
    let sentence =
        format!("is {}{space}{unit}, and must be from {low} to {high}{space}{unit}", plainly(value));
    Err(Error::new(Code::OutOfRange, sentence).at_field(field))
}

fn entry(field: &str, is_list: bool, index: usize) -> String {
    if is_list { format!("{field}[{index}]") } else { field.to_owned() }
}

/// A number as a person writes it: -3, 0.01, 1e9.
fn plainly(value: f64) -> String {
    let ordinary = value == 0.0 || (1e-4..1e7).contains(&value.abs());
    // The limits are float32 numbers: as such 1e12 is written 1e12.
    let rounded = value as f32;
    match ordinary {
        true => value.to_string(),
        false if f64::from(rounded) == value => format!("{rounded:e}"),
        false => format!("{value:e}"),
    }
}
