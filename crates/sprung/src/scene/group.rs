//! Single springs of a group: those that are cut, and those unlike the others.

use std::ops::Range;
use std::sync::Arc;

use super::check::number;
use super::choices::Numbers;
use super::types::Exception;
use crate::error::{Code, Error, Result};
use crate::model::Model;
use crate::params::{DAMPING_RANGE, LENGTH_RANGE, Params, STIFFNESS_RANGE};

/// Springs that are unlike the others of their group. How many the group has is known when it is built.
pub(super) fn check_exceptions(path: &str, cut: &[Numbers], except: &[Exception]) -> Result<()> {
    check_numbers(&format!("{path}.cut"), cut)?;
    for (index, exception) in except.iter().enumerate() {
        let path = format!("{path}.except[{index}]");
        if exception.springs.is_empty() {
            let sentence = "is an empty list, and must name at least one spring";
            return Err(Error::new(Code::OutOfRange, sentence).at_field(format!("{path}.springs")));
        }
        check_numbers(&format!("{path}.springs"), &exception.springs)?;
        let Exception { stiffness, damping, rest_scale, rest_length, .. } = *exception;
        if let (Some(_), Some(_)) = (rest_scale, rest_length) {
            let sentence = "says both rest_scale and rest_length; one of them is enough";
            return Err(Error::new(Code::Conflict, sentence).at_field(format!("{path}.rest_length")));
        }
        let values = [
            ("stiffness", stiffness, &STIFFNESS_RANGE, "N/m"),
            ("damping", damping, &DAMPING_RANGE, "N·s/m"),
            ("rest_scale", rest_scale, &LENGTH_RANGE, ""),
            ("rest_length", rest_length, &LENGTH_RANGE, "m"),
        ];
        if values.iter().all(|(_, value, ..)| value.is_none()) {
            let sentence = "says nothing; say stiffness, damping, rest_scale or rest_length";
            return Err(Error::new(Code::MissingField, sentence).at_field(path));
        }
        for (key, value, range, unit) in values {
            value.map_or(Ok(()), |value| number(format!("{path}.{key}"), value, range, unit))?;
        }
    }
    Ok(())
}

/// Each thing is named once, and no span runs backwards.
fn check_numbers(field: &str, numbers: &[Numbers]) -> Result<()> {
    let mut spans: Vec<([u32; 2], usize)> =
        numbers.iter().enumerate().map(|(index, some)| (some.ends(), index)).collect();
    for &([first, last], index) in &spans {
        if first > last {
            let sentence = format!("runs from {first} back to {last}; say the smaller number first");
            return Err(Error::new(Code::Conflict, sentence).at_field(format!("{field}[{index}]")));
        }
    }
    spans.sort_unstable();
    for pair in spans.windows(2) {
        let ([_, last], [first, _]) = (pair[0].0, pair[1].0);
        if first <= last {
            let sentence = format!("names spring {first} a second time");
            let index = pair[0].1.max(pair[1].1);
            return Err(Error::new(Code::Duplicate, sentence).at_field(format!("{field}[{index}]")));
        }
    }
    Ok(())
}

/// The springs of one group, and what is said of them besides the material they are built with.
pub(super) struct Group<'a> {
    pub springs: Range<usize>,
    pub rest_scale: f32,
    pub cut: &'a [Numbers],
    pub except: &'a [Exception],
    pub path: String,
}

impl Group<'_> {
    /// Scales rest lengths, then makes the exceptions, then cuts.
    pub fn apply(&self, model: &Model, params: &mut Params) -> Result<()> {
        let too_long = |length: f32, path: &str| {
            let sentence = format!("makes a spring {length:e} m long at rest, and it may be at most 1e9 m");
            Error::new(Code::OutOfRange, sentence).at_field(format!("{path}.rest_scale"))
        };
        let scaled = |&length: &f32| length * self.rest_scale;
        let lengths = &params.spring_rest_length[self.springs.clone()];
        if let Some(length) = lengths.iter().map(scaled).find(|length| !LENGTH_RANGE.contains(length)) {
            return Err(too_long(length, &self.path));
        }
        // Shared with the model for as long as nothing is said of them.
        if self.rest_scale != 1.0 {
            let lengths = &mut Arc::make_mut(&mut params.spring_rest_length)[self.springs.clone()];
            lengths.iter_mut().for_each(|length| *length = scaled(length));
        }
        for (index, exception) in self.except.iter().enumerate() {
            let path = format!("{}.except[{index}]", self.path);
            for (index, some) in exception.springs.iter().enumerate() {
                let springs = self.range(*some, || format!("{path}.springs[{index}]"))?;
                if let Some(stiffness) = exception.stiffness {
                    Arc::make_mut(&mut params.spring_stiffness)[springs.clone()].fill(stiffness as f32);
                }
                if let Some(damping) = exception.damping {
                    Arc::make_mut(&mut params.spring_damping)[springs.clone()].fill(damping as f32);
                }
                if let Some(length) = exception.rest_length {
                    Arc::make_mut(&mut params.spring_rest_length)[springs.clone()].fill(length as f32);
                }
                if let Some(scale) = exception.rest_scale {
                    let rest_length = Arc::make_mut(&mut params.spring_rest_length);
                    for spring in springs {
                        rest_length[spring] = model.spring_rest_length()[spring] * scale as f32;
                        if !LENGTH_RANGE.contains(&rest_length[spring]) {
                            return Err(too_long(rest_length[spring], &path));
                        }
                    }
                }
            }
        }
        for (index, some) in self.cut.iter().enumerate() {
            let springs = self.range(*some, || format!("{}.cut[{index}]", self.path))?;
            Arc::make_mut(&mut params.spring_cut)[springs].fill(true);
        }
        Ok(())
    }

    /// The springs of these numbers in the group.
    fn range(&self, numbers: Numbers, field: impl Fn() -> String) -> Result<Range<usize>> {
        let ([first, last], count) = (numbers.ends().map(|end| end as usize), self.springs.len());
        if last < count {
            return Ok(self.springs.start + first..self.springs.start + last + 1);
        }
        let sentence = match count {
            0 => format!("names spring {last}, and this group has no springs"),
            _ => format!("names spring {last}, and this group has the springs 0 to {}", count - 1),
        };
        Err(Error::new(Code::NotFound, sentence).at_field(field()))
    }
}
