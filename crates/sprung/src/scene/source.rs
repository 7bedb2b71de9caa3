//! Where a scene came from: file, text and what `set` changed, so that an error found late still names its line.

use std::ops::Range;
use std::sync::Arc;

use toml::de::{DeTable, DeValue};

use super::read::ReadError;
use super::suggest::{one_line, shortened};
use super::types::Scene;
use crate::error::{Code, Error};

/// The source of a scene, if it has one. It is no part of what the scene says: any two are equal.
#[derive(Clone, Debug, Default)]
pub(super) struct Origin(Option<Arc<Source>>);

impl PartialEq for Origin {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

#[derive(Clone, Debug)]
struct Source {
    file: String,
    text: Arc<str>,
    overrides: Vec<Override>,
}

/// A field that `set` changed after the text was read.
#[derive(Clone, Debug)]
struct Override {
    field: String,
    argument: String,
}

/// Where a scene came from, for whoever hands the scene on to where its errors are to be found as here.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Provenance {
    /// The name that errors give the file.
    pub file: String,
    /// What it says.
    pub text: Arc<str>,
    /// Fields that were set since, each with the argument that said so, oldest first.
    pub set: Vec<(String, String)>,
}

impl Scene {
    /// Where it came from, if it was read from a text.
    pub fn provenance(&self) -> Option<Provenance> {
        let Source { file, text, overrides } = &**self.origin.0.as_ref()?;
        let set = overrides.iter().map(|change| (change.field.clone(), change.argument.clone()));
        Some(Provenance { file: file.clone(), text: text.clone(), set: set.collect() })
    }

    /// The scene, with errors that are found late quoting this source.
    pub fn with_provenance(mut self, from: Option<Provenance>) -> Self {
        self.origin = Origin(from.map(|Provenance { file, text, set }| {
            let overrides = set.into_iter().map(|(field, argument)| Override { field, argument });
            Arc::new(Source { file: one_line(&file), text, overrides: overrides.collect() })
        }));
        self
    }
}

impl Origin {
    pub(super) fn new(file: &str, text: &str) -> Self {
        Self(Some(Arc::new(Source { file: one_line(file), text: text.into(), overrides: Vec::new() })))
    }

    /// The same source, with these fields changed by an argument such as `--set dt=0.1`.
    pub(super) fn with_overrides(&self, fields: &[String], argument: &str) -> Self {
        let Some(source) = &self.0 else { return self.clone() };
        let mut source = Source::clone(source);
        let changed = |field: &String| Override { field: field.clone(), argument: argument.to_owned() };
        source.overrides.extend(fields.iter().map(changed));
        Self(Some(Arc::new(source)))
    }

    /// Adds file, line and column to an error that names its field.
    pub(super) fn locate(&self, error: Error) -> Error {
        let Some(source) = &self.0 else { return error };
        let field = error.place().field.clone().unwrap_or_default();
        // The newest change of a field is what it says now.
        if let Some(change) = source.overrides.iter().rev().find(|change| leads_to(&change.field, &field)) {
            return error.in_file(&change.argument);
        }
        let error = error.in_file(&source.file);
        // What is missing from the whole file is missing from its beginning.
        at_byte(error, &source.text, span_of(&source.text, &field).map_or(0, |span| span.start))
    }

    /// The error of a document that could not be read as a scene.
    pub(super) fn locate_read(&self, mut error: ReadError) -> Error {
        let span = error.span.take();
        let error = error.into_error();
        let Some(source) = &self.0 else { return error };
        match span {
            Some(span) => at_byte(error.in_file(&source.file), &source.text, span.start),
            None => error.in_file(&source.file),
        }
    }

    /// The error of a text that is not TOML.
    pub(super) fn locate_syntax(&self, error: &toml::de::Error) -> Error {
        let Some(source) = &self.0 else { return syntax_error(error, "") };
        let place = error.span().map_or(0, |span| span.start);
        at_byte(syntax_error(error, &source.text).in_file(&source.file), &source.text, place)
    }
}

/// The sentence of a text that is not TOML, with the key it happened at.
pub(super) fn syntax_error(error: &toml::de::Error, text: &str) -> Error {
    let span = error.span().unwrap_or(0..0);
    let rest = text.get(span.start..).unwrap_or_default();
    let message = one_line(&error.message().lines().map(str::trim).collect::<Vec<_>>().join(", "));
    if message.starts_with("duplicate key") {
        let key = shortened(text.get(span.clone()).unwrap_or_default());
        let error = Error::new(Code::Duplicate, "is said a second time in the same table");
        return if key.is_empty() { error } else { error.at_field(key) };
    }
    let error = match message.as_str() {
        // The parser takes what it cannot understand for text without quotes, or for a misspelt `false`.
        _ if message.starts_with("string values must be quoted")
            || message.starts_with("invalid boolean") =>
        {
            let found = text.get(span.clone()).unwrap_or_default().lines().next().unwrap_or_default().trim();
            let sentence = match found {
                "" => "has no value".to_owned(),
                _ => format!(
                    "has `{}` where a value must be; text needs quotes, lists need commas",
                    shortened(found)
                ),
            };
            Error::new(Code::Syntax, sentence)
        }
        "" => Error::new(Code::Syntax, "is not valid TOML"),
        // The parser's own words for this are about how it is made.
        message if message.contains("recurs") => Error::new(Code::Syntax, "is nested too deeply"),
        message => Error::new(
            Code::Syntax,
            format!("is not valid TOML: {}", message.trim_end_matches(", expected nothing")),
        ),
    };
    match key_of_line(text, text.len() - rest.len()) {
        Some(key) => error.at_field(key),
        None => error,
    }
}

/// The key before the `=` that stands left of a byte in its line.
fn key_of_line(text: &str, byte: usize) -> Option<String> {
    let line = text.get(..byte)?.rsplit('\n').next()?;
    let (key, _) = line.split_once('=')?;
    let key = key.trim();
    let is_plain = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || "_-.".contains(c));
    is_plain.then(|| shortened(key))
}

/// Adds the line and column of a byte; columns count characters.
pub(super) fn at_byte(error: Error, text: &str, byte: usize) -> Error {
    let mut byte = byte.min(text.len());
    while !text.is_char_boundary(byte) {
        byte -= 1;
    }
    let before = &text[..byte];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    error.at_line(before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}

/// Whether `field` is `path` or lies inside it.
fn leads_to(path: &str, field: &str) -> bool {
    field.strip_prefix(path).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// Where in the text a field's value stands; where it does not stand there, the innermost table around it.
fn span_of(text: &str, field: &str) -> Option<Range<usize>> {
    let document = DeTable::parse(text).ok()?;
    let mut steps =
        field.split(['.', '[']).map(|step| step.trim_end_matches(']')).filter(|step| !step.is_empty());
    let mut here = document.get_ref().get(steps.next()?)?;
    for step in steps {
        let next = match here.get_ref() {
            DeValue::Table(table) => table.get(step),
            DeValue::Array(list) => step.parse().ok().and_then(|index: usize| list.get(index)),
            _ => None,
        };
        match next {
            Some(inner) => here = inner,
            None => break,
        }
    }
    Some(here.span())
}

/// An error about a NUL byte, which other kinds of files have and no text has.
pub(super) fn not_text(text: &str, byte: usize, file: &str) -> Error {
    let sentence = "has a byte that is not text here (NUL); is this a TOML file?";
    at_byte(Error::new(Code::Syntax, sentence).in_file(one_line(file)), text, byte)
}

/// An error about bytes that are not UTF-8, at the first bad one.
pub(super) fn not_utf8(bytes: &[u8], valid: usize, file: &str) -> Error {
    let bad = bytes.get(valid).copied().unwrap_or_default();
    let error = Error::new(Code::Syntax, format!("is not UTF-8 text: it has the byte 0x{bad:02X} here"))
        .with_fix("save the file as UTF-8")
        .in_file(one_line(file));
    let text = String::from_utf8_lossy(&bytes[..valid]);
    at_byte(error, &text, text.len())
}
