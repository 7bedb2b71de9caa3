//! From a parsed TOML document to the scene's types, knowing at every moment where it stands.
//!
//! This is a serde deserializer over the document's tree. Other deserializers report errors as finished text; this one
//! keeps their parts (what was found, what is allowed, which key, where), so that every error has a field and a line.

use std::fmt;
use std::ops::Range;

use serde::de::value::StrDeserializer;
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, Error as _, Expected, IntoDeserializer, MapAccess,
    SeqAccess, Unexpected, Visitor,
};
use serde::forward_to_deserialize_any;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::suggest::{did_you_mean, shortened};
use crate::error::{Code, Error};

/// Reads a value of the scene's types from the whole document.
pub(super) fn from_document<T: DeserializeOwned>(document: &Spanned<DeTable<'_>>) -> Result<T, ReadError> {
    let root = TableReader::new(document.get_ref());
    T::deserialize(serde::de::value::MapAccessDeserializer::new(root))
}

/// The keys that a table of type `T` may have.
pub(super) fn keys_of<T: DeserializeOwned>() -> &'static [&'static str] {
    // The list is known to serde alone, which tells it to whoever uses a key that is not in it.
    let document = DeTable::parse("'' = 0");
    document.ok().and_then(|document| from_document::<T>(&document).err()).map_or(&[], |error| error.allowed)
}

/// What was wrong, and where: filled in from the inside out as the error travels up through tables and lists.
#[derive(Debug)]
pub(super) struct ReadError {
    code: Code,
    sentence: String,
    fix: Option<String>,
    /// Innermost step first.
    path: Vec<Step>,
    /// Where in the text, in bytes.
    pub(super) span: Option<Range<usize>>,
    /// The keys that are allowed where an unknown one was found.
    allowed: &'static [&'static str],
}

#[derive(Debug)]
enum Step {
    Key(String),
    Index(usize),
}

impl ReadError {
    fn new(code: Code, sentence: String) -> Self {
        Self { code, sentence, fix: None, path: Vec::new(), span: None, allowed: &[] }
    }

    fn inside(mut self, step: Step) -> Self {
        self.path.push(step);
        self
    }

    fn at(mut self, span: Range<usize>) -> Self {
        self.span.get_or_insert(span);
        self
    }

    /// The field, such as `body[0].springs[1].stiffness`.
    fn field(&self) -> String {
        let mut field = String::new();
        for step in self.path.iter().rev() {
            match step {
                Step::Key(key) if field.is_empty() => field.push_str(&shortened(key)),
                Step::Key(key) => field = format!("{field}.{}", shortened(key)),
                Step::Index(index) => field = format!("{field}[{index}]"),
            }
        }
        field
    }

    /// The error for everyone, still without a file and a line.
    pub(super) fn into_error(self) -> Error {
        let field = self.field();
        let mut error = Error::new(self.code, self.sentence);
        if let Some(fix) = self.fix {
            error = error.with_fix(fix);
        }
        if field.is_empty() { error } else { error.at_field(field) }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence)
    }
}

impl std::error::Error for ReadError {}

impl serde::de::Error for ReadError {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self::new(Code::WrongType, message.to_string())
    }

    fn invalid_type(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        let expected = expected.to_string();
        let expected = in_words(&expected);
        let mut error =
            Self::new(Code::WrongType, format!("is {}, and must be {expected}", found_in_words(found)));
        if found == Unexpected::Map && expected == "a list" {
            error.fix = Some("begin each entry with [[…]], two pairs of brackets".to_owned());
        }
        error
    }

    fn invalid_value(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        let sentence =
            format!("is {}, and must be {}", found_in_words(found), in_words(&expected.to_string()));
        let code = if matches!(found, Unexpected::Str(_)) { Code::WrongType } else { Code::OutOfRange };
        Self::new(code, sentence)
    }

    fn invalid_length(length: usize, expected: &dyn Expected) -> Self {
        let entries = if length == 1 { "entry" } else { "entries" };
        let sentence = format!("has {length} {entries}, and must be {}", in_words(&expected.to_string()));
        Self::new(Code::WrongType, sentence)
    }

    fn unknown_variant(found: &str, allowed: &'static [&'static str]) -> Self {
        let mut error = Self::new(
            Code::NotFound,
            format!("is \"{}\", and must be {}", shortened(found), alternatives(allowed)),
        );
        error.fix = did_you_mean(found, allowed.iter().copied());
        error
    }

    fn unknown_field(key: &str, allowed: &'static [&'static str]) -> Self {
        let are = if allowed.len() == 1 { "is" } else { "are" };
        let sentence = format!("is not a known key; allowed here {are} {}", allowed.join(", "));
        let mut error = Self::new(Code::UnknownKey, sentence).inside(Step::Key(key.to_owned()));
        error.fix = did_you_mean(key, allowed.iter().copied());
        error.allowed = allowed;
        error
    }

    fn missing_field(key: &'static str) -> Self {
        Self::new(Code::MissingField, "is missing, and has no default".to_owned())
            .inside(Step::Key(key.to_owned()))
    }
}

/// What was found, as the end of a sentence.
fn found_in_words(found: Unexpected<'_>) -> String {
    match found {
        Unexpected::Bool(value) => value.to_string(),
        Unexpected::Signed(value) => value.to_string(),
        Unexpected::Float(value) => format!("{value:?}"),
        Unexpected::Str(text) => format!("the text \"{}\"", shortened(text)),
        Unexpected::Seq => "a list".to_owned(),
        Unexpected::Map => "a table".to_owned(),
        other => other.to_string(),
    }
}

/// What serde calls a type, in the words of a person.
fn in_words(expected: &str) -> &str {
    match expected {
        "f64" => "a number",
        "u32" => "a whole number from 0 to 4294967295",
        "a string" => "text in quotes",
        "a sequence" => "a list",
        "an array of length 2" => "a list of 2",
        "an array of length 3" => "a list of 3 numbers",
        _ if expected.starts_with("struct ") => "a table",
        _ => expected,
    }
}

/// `"a", "b" or "c"`.
fn alternatives(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => quoted.concat(),
    }
}

/// One value of the document.
struct ValueReader<'a>(&'a Spanned<DeValue<'a>>);

impl ValueReader<'_> {
    fn read<'de, V: Visitor<'de>>(&self, visitor: V) -> Result<V::Value, ReadError> {
        match self.0.get_ref() {
            DeValue::String(text) => visitor.visit_str(text),
            DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
                Ok(value) => visitor.visit_i64(value),
                Err(_) => {
                    Err(ReadError::invalid_value(Unexpected::Other(&shortened(integer.as_str())), &visitor))
                }
            },
            DeValue::Float(float) => match float.as_str().parse::<f64>() {
                Ok(value) if value.is_finite() => visitor.visit_f64(value),
                _ => {
                    let sentence = format!("is {}, and must be a finite number", shortened(float.as_str()));
                    Err(ReadError::new(Code::OutOfRange, sentence))
                }
            },
            DeValue::Boolean(value) => visitor.visit_bool(*value),
            DeValue::Datetime(_) => {
                Err(ReadError::invalid_type(Unexpected::Other("a date or time"), &visitor))
            }
            DeValue::Array(list) => {
                let mut reader = ListReader { rest: list.iter(), index: 0 };
                let value = visitor.visit_seq(&mut reader)?;
                match reader.rest.len() {
                    0 => Ok(value),
                    // Types of fixed length stop reading when they have enough.
                    _ => {
                        let sentence = format!("has {} entries, and must have {}", list.len(), reader.index);
                        Err(ReadError::new(Code::WrongType, sentence))
                    }
                }
            }
            DeValue::Table(table) => visitor.visit_map(TableReader::new(table)),
        }
    }
}

impl<'de> Deserializer<'de> for ValueReader<'_> {
    type Error = ReadError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        self.read(visitor).map_err(|error| error.at(self.0.span()))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        visitor.visit_some(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        let word = match self.0.get_ref() {
            DeValue::String(text) => visitor.visit_enum(IntoDeserializer::into_deserializer(text.as_ref())),
            _ => self.read(WordVisitor(variants)).map(|never| match never {}),
        };
        word.map_err(|error| error.at(self.0.span()))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct
        newtype_struct seq tuple tuple_struct map struct identifier ignored_any
    }
}

/// Refuses whatever stands where one of a few words must stand.
struct WordVisitor(&'static [&'static str]);

impl Visitor<'_> for WordVisitor {
    type Value = std::convert::Infallible;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&alternatives(self.0))
    }
}

struct ListReader<'a> {
    rest: std::slice::Iter<'a, Spanned<DeValue<'a>>>,
    index: usize,
}

impl<'de> SeqAccess<'de> for &mut ListReader<'_> {
    type Error = ReadError;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, ReadError> {
        let Some(value) = self.rest.next() else { return Ok(None) };
        let index = self.index;
        self.index += 1;
        seed.deserialize(ValueReader(value)).map(Some).map_err(|error| error.inside(Step::Index(index)))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

struct TableReader<'a> {
    entries: toml::map::Iter<'a, Spanned<std::borrow::Cow<'a, str>>, Spanned<DeValue<'a>>>,
    current: Option<(&'a str, &'a Spanned<DeValue<'a>>)>,
}

impl<'a> TableReader<'a> {
    fn new(table: &'a DeTable<'a>) -> Self {
        Self { entries: table.iter(), current: None }
    }
}

impl<'de> MapAccess<'de> for TableReader<'_> {
    type Error = ReadError;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, ReadError> {
        let Some((key, value)) = self.entries.next() else { return Ok(None) };
        self.current = Some((key.get_ref(), value));
        let name: StrDeserializer<'_, ReadError> = key.get_ref().as_ref().into_deserializer();
        seed.deserialize(name).map(Some).map_err(|error| error.at(key.span()))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, ReadError> {
        let Some((key, value)) = self.current.take() else {
            return Err(ReadError::custom("a value was read before its key"));
        };
        seed.deserialize(ValueReader(value)).map_err(|error| error.inside(Step::Key(key.to_owned())))
    }
}
