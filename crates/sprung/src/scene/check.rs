//! What must hold beyond the types: ranges, names, indices, and statements that cannot both be made.
//!
//! Each check names its field, such as `body[0].springs[1].stiffness`; the scene's origin turns that into a line.

mod made;
mod mesh;
mod pins;
mod values;

use std::collections::HashSet;

use self::made::check_made;
use self::mesh::check_mesh;
use self::pins::check_pins;
pub(super) use self::values::number;
use self::values::{
    SIZE_RANGE, count, direction, each_point, entry, exactly_one, mass, plainly, point_of, vector,
};
use super::choices::{Dt, OneOrEach};
use super::group::check_exceptions;
use super::suggest::{did_you_mean, shortened, steers};
use super::types::{Body, Joint, Plane, Scene, Springs};
use crate::error::{Code, Error, Result};
use crate::params::{
    DAMPING_RANGE, DT_RANGE, LENGTH_RANGE, MAGNITUDE_RANGE, STIFFNESS_RANGE, SUBSTEPS_RANGE,
};

/// Points that a scene may have.
pub const MAX_POINTS: u64 = 50_000_000;

/// Characters that a body's name may have.
const NAME_LENGTH: usize = 100;

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
        check_made(&path, body)?;
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
        // A mesh that says where there is more of the material has it shared out otherwise: see `made.rs`.
        if !body.waits_for_mesh() && body.made().is_none_or(|made| made.masses.is_empty()) {
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
