//! Single values and keys: ranges, counts, numbers of points, one of several keys.

use std::ops::RangeInclusive;

use crate::error::{Code, Error, Result};
use crate::params::{MAGNITUDE_RANGE, MASS_RANGE};
use crate::scene::choices::OneOrEach;
use crate::scene::suggest::shortened;
use crate::scene::types::Body;

/// Allowed spacings (m) and scales: so small that they are never in the way, and large enough that no division by
/// them overflows.
pub const SIZE_RANGE: RangeInclusive<f32> = 1e-9..=1e9;

/// Of several keys that exclude each other, one must be there.
pub fn exactly_one(path: &str, none: &str, keys: &[(&str, bool)]) -> Result<()> {
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
pub fn each_point<T>(field: &str, values: &OneOrEach<T>, body: &Body) -> Result<()> {
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

pub fn point_of(field: &str, point: u32, body: &Body) -> Result<()> {
    let count = body.point_count();
    if u64::from(point) < count || body.waits_for_mesh() {
        return Ok(());
    }
    let name = shortened(&body.name);
    let sentence = format!("names point {point}, and \"{name}\" has the points 0 to {}", count - 1);
    Err(Error::new(Code::NotFound, sentence).at_field(field))
}

pub fn count(field: &str, points: u32) -> Result<()> {
    if points > 0 {
        return Ok(());
    }
    Err(Error::new(Code::OutOfRange, "has a count of 0, and there must be at least 1 point").at_field(field))
}

pub fn mass(field: &str, value: f64) -> Result<()> {
    if value == 0.0 || MASS_RANGE.contains(&(value as f32)) {
        return Ok(());
    }
    let (low, high) = (MASS_RANGE.start(), MASS_RANGE.end());
    let sentence =
        format!("is {} kg, and must be 0 (fixed in space) or from {low:e} to {high:e} kg", plainly(value));
    Err(Error::new(Code::OutOfRange, sentence).at_field(field))
}

/// A direction has any length but zero.
pub fn direction(field: &str, value: [f64; 3]) -> Result<()> {
    vector(field, value, "")?;
    // So small that its square is lost counts as zero, too.
    if value.iter().map(|component| component * component).sum::<f64>() > 1e-200 {
        return Ok(());
    }
    Err(Error::new(Code::OutOfRange, "has length 0, and must point somewhere").at_field(field))
}

pub fn vector(field: &str, value: [f64; 3], unit: &str) -> Result<()> {
    value.iter().enumerate().try_for_each(|(axis, &component)| {
        number(format!("{field}[{axis}]"), component, &MAGNITUDE_RANGE, unit)
    })
}

pub(in crate::scene) fn number(
    field: String,
    value: f64,
    range: &RangeInclusive<f32>,
    unit: &str,
) -> Result<()> {
    if range.contains(&(value as f32)) {
        return Ok(());
    }
    let space = if unit.is_empty() { "" } else { " " };
    let (low, high) = (plainly(f64::from(*range.start())), plainly(f64::from(*range.end())));
    let sentence =
        format!("is {}{space}{unit}, and must be from {low} to {high}{space}{unit}", plainly(value));
    Err(Error::new(Code::OutOfRange, sentence).at_field(field))
}

pub fn entry(field: &str, is_list: bool, index: usize) -> String {
    if is_list { format!("{field}[{index}]") } else { field.to_owned() }
}

/// A number as a person writes it: -3, 0.01, 1e9.
pub fn plainly(value: f64) -> String {
    let ordinary = value == 0.0 || (1e-4..1e7).contains(&value.abs());
    // The limits are float32 numbers: as such 1e12 is written 1e12.
    let rounded = value as f32;
    match ordinary {
        true => value.to_string(),
        false if f64::from(rounded) == value => format!("{rounded:e}"),
        false => format!("{value:e}"),
    }
}
