//! Values that may be written in more than one way: each says in one sentence what it accepts.

use std::fmt;
use std::ops::RangeInclusive;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, SeqAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::params::SUBSTEPS_RANGE;

/// A whole number from `low` to `high`, said with the bounds that hold for it. Numbers out of bounds are left to the
/// scene's check, save those that no `u32` can hold.
struct WholeVisitor(RangeInclusive<u32>);

impl Visitor<'_> for WholeVisitor {
    type Value = u32;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a whole number from {} to {}", self.0.start(), self.0.end())
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<u32, E> {
        u32::try_from(value).map_err(|_| E::invalid_value(Unexpected::Signed(value), &self))
    }
}

/// Reads `substeps`.
pub(super) fn substeps<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    deserializer.deserialize_u32(WholeVisitor(SUBSTEPS_RANGE))
}

/// Reads `max_springs`.
pub(super) fn max_springs<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<u32>, D::Error> {
    deserializer.deserialize_u32(WholeVisitor(1..=u32::MAX)).map(Some)
}

/// Length of one step: a number of seconds, or the word `"auto"`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Dt {
    /// This long, s.
    Seconds(f64),
    /// As long as is safely stable.
    #[default]
    Auto,
}

impl Serialize for Dt {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Seconds(seconds) => serializer.serialize_f64(*seconds),
            Self::Auto => serializer.serialize_str("auto"),
        }
    }
}

impl<'de> Deserialize<'de> for Dt {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(DtVisitor)
    }
}

impl JsonSchema for Dt {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Dt".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "number", "exclusiveMinimum": 0 }, { "const": "auto" }] })
    }
}

struct DtVisitor;

impl Visitor<'_> for DtVisitor {
    type Value = Dt;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number of seconds or \"auto\"")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Dt, E> {
        Ok(Dt::Seconds(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Dt, E> {
        Ok(Dt::Seconds(value as f64))
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<Dt, E> {
        if value == "auto" { Ok(Dt::Auto) } else { Err(E::invalid_value(Unexpected::Str(value), &self)) }
    }
}

/// One value for all points of a body, or a list with one for each.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum OneOrEach<T> {
    /// The same for all.
    One(T),
    /// One for each point, in order.
    Each(Vec<T>),
}

impl<T: Copy> OneOrEach<T> {
    /// The value of one point. A list must be long enough.
    pub(super) fn of(&self, point: usize) -> T {
        match self {
            Self::One(value) => *value,
            Self::Each(values) => values[point],
        }
    }

    /// All values that were written.
    pub(super) fn values(&self) -> &[T] {
        match self {
            Self::One(value) => std::slice::from_ref(value),
            Self::Each(values) => values,
        }
    }
}

impl Default for OneOrEach<[f64; 3]> {
    fn default() -> Self {
        Self::One([0.0; 3])
    }
}

impl<'de> Deserialize<'de> for OneOrEach<f64> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumbersVisitor)
    }
}

struct NumbersVisitor;

impl<'de> Visitor<'de> for NumbersVisitor {
    type Value = OneOrEach<f64>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or a list with one for each point")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
        Ok(OneOrEach::One(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
        Ok(OneOrEach::One(value as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
        let mut values = Vec::new();
        while let Some(value) = list.next_element()? {
            values.push(value);
        }
        Ok(OneOrEach::Each(values))
    }
}

impl<'de> Deserialize<'de> for OneOrEach<[f64; 3]> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(VectorsVisitor)
    }
}

struct VectorsVisitor;

impl<'de> Visitor<'de> for VectorsVisitor {
    type Value = OneOrEach<[f64; 3]>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of 3 numbers, or a list of such lists with one for each point")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
        // The first entry tells whether this is one vector or a list of them.
        match list.next_element::<Entry>()? {
            Some(Entry::Number(x)) => {
                let mut rest = |length: usize| {
                    list.next_element::<f64>()?
                        .ok_or_else(|| A::Error::invalid_length(length, &"an array of length 3"))
                };
                Ok(OneOrEach::One([x, rest(1)?, rest(2)?]))
            }
            Some(Entry::Vector(first)) => {
                let mut vectors = vec![first];
                while let Some(vector) = list.next_element()? {
                    vectors.push(vector);
                }
                Ok(OneOrEach::Each(vectors))
            }
            None => Ok(OneOrEach::Each(Vec::new())),
        }
    }
}

enum Entry {
    Number(f64),
    Vector([f64; 3]),
}

impl<'de> Deserialize<'de> for Entry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(EntryVisitor)
    }
}

struct EntryVisitor;

impl<'de> Visitor<'de> for EntryVisitor {
    type Value = Entry;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or a list of 3 numbers")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Entry, E> {
        Ok(Entry::Number(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Entry, E> {
        Ok(Entry::Number(value as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Entry, A::Error> {
        let mut vector = [0.0; 3];
        for (length, component) in vector.iter_mut().enumerate() {
            let next = list.next_element()?;
            *component = next.ok_or_else(|| A::Error::invalid_length(length, &"an array of length 3"))?;
        }
        Ok(Entry::Vector(vector))
    }
}

/// Some of many things, by their numbers: one, or all from a first to a last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Numbers {
    /// One, by its number (from 0).
    One(u32),
    /// All from the first to the last, both included.
    Span([u32; 2]),
}

impl Numbers {
    /// The first and the last.
    pub(super) fn ends(self) -> [u32; 2] {
        match self {
            Self::One(number) => [number; 2],
            Self::Span(ends) => ends,
        }
    }
}

impl<'de> Deserialize<'de> for Numbers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(SomeVisitor)
    }
}

struct SomeVisitor;

impl<'de> Visitor<'de> for SomeVisitor {
    type Value = Numbers;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number (from 0), or a list of the first and the last")
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Numbers, E> {
        let number = u32::try_from(value).map_err(|_| E::invalid_value(Unexpected::Signed(value), &self))?;
        Ok(Numbers::One(number))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Numbers, A::Error> {
        let mut ends = [0; 2];
        for (length, end) in ends.iter_mut().enumerate() {
            let next = list.next_element()?;
            *end =
                next.ok_or_else(|| A::Error::invalid_length(length, &"a list of the first and the last"))?;
        }
        Ok(Numbers::Span(ends))
    }
}

/// Points held in space.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Pin {
    /// One point, by its number in the body (from 0).
    Index(u32),
    /// A side, such as "left" or "left-back"; of a chain "start" or "end".
    Side(String),
    /// Points found by where they are or what they are called.
    Where(PinWhere),
}

/// Points found by one of `box`, `nearest`, `group` and `colour`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PinWhere {
    /// All points of the body within a box, in the coordinates of the world.
    #[serde(rename = "box", skip_serializing_if = "Option::is_none")]
    pub region: Option<Region>,
    /// The point nearest to this place in the world, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nearest: Option<[f64; 3]>,
    /// The points at the vertices of this group of the mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub group: Option<String>,
    /// The points at the vertices of the mesh that have this colour: red, green and blue, 0 to 1, each to within 0.05.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub colour: Option<[f64; 3]>,
}

/// A box with its edges along the axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// The corner with the smallest coordinates, m.
    pub min: [f64; 3],
    /// The corner with the largest coordinates, m.
    pub max: [f64; 3],
}

impl<'de> Deserialize<'de> for Pin {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(PinVisitor)
    }
}

struct PinVisitor;

impl<'de> Visitor<'de> for PinVisitor {
    type Value = Pin;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a point's number (from 0), the name of a side, or { box = { min = …, max = … } }")
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Pin, E> {
        let index = u32::try_from(value).map_err(|_| E::invalid_value(Unexpected::Signed(value), &self))?;
        Ok(Pin::Index(index))
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<Pin, E> {
        Ok(Pin::Side(value.to_owned()))
    }

    fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<Pin, A::Error> {
        PinWhere::deserialize(MapAccessDeserializer::new(table)).map(Pin::Where)
    }
}
