//! The one error type that every door of the project shows: a code, a sentence, the place, the fix.

use std::fmt;

use crate::watch::BlowUp;

/// What kind of thing went wrong; stable names for programs to match on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Code {
    /// Text that is not valid TOML, or a command line that cannot be understood.
    Syntax,
    /// A value of the wrong type.
    WrongType,
    /// A required field is absent.
    MissingField,
    /// A key that does not exist.
    UnknownKey,
    /// A number outside its allowed range, or not finite.
    OutOfRange,
    /// A name, index or built-in scene that does not exist.
    NotFound,
    /// The same thing was said twice.
    Duplicate,
    /// Two statements that cannot both hold.
    Conflict,
    /// More points, springs, bytes or memory than is allowed.
    TooLarge,
    /// A file that cannot be read.
    Unreadable,
    /// A file that cannot be written.
    Unwritable,
    /// Something this build or machine cannot do.
    Unsupported,
    /// There can be no window: there is no display, or no graphics driver or library for it.
    NoWindow,
    /// A settling scene did not come to rest.
    NotSettled,
    /// The simulation blew up; [`Error::blow_up`] tells the rest.
    BlewUp,
    /// Stopped by the user.
    Interrupted,
}

impl Code {
    /// All of them. A code keeps its place in this list: what is new comes last.
    pub const ALL: [Self; 16] = [
        Self::Syntax,
        Self::WrongType,
        Self::MissingField,
        Self::UnknownKey,
        Self::OutOfRange,
        Self::NotFound,
        Self::Duplicate,
        Self::Conflict,
        Self::TooLarge,
        Self::Unreadable,
        Self::Unwritable,
        Self::Unsupported,
        Self::NoWindow,
        Self::NotSettled,
        Self::BlewUp,
        Self::Interrupted,
    ];
}

/// Where it went wrong. Every part is optional; lines and columns count from 1.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// The file's name as the user gave it, or the argument, such as `--set dt=x`.
    pub file: Option<String>,
    /// Line and column in that file.
    pub line_column: Option<(usize, usize)>,
    /// The field, such as `body[0].springs[1].stiffness`.
    pub field: Option<String>,
}

/// An error: one sentence for a person, and its parts for a program.
///
/// ```
/// let error = sprung::Error::new(sprung::Code::OutOfRange, "is -3, and must be at least 0").at_field("damping");
/// assert_eq!(error.to_string(), "damping: is -3, and must be at least 0");
/// ```
#[derive(Clone, PartialEq)]
pub struct Error(Box<Parts>);

#[derive(Clone, Debug, PartialEq)]
struct Parts {
    code: Code,
    sentence: String,
    place: Place,
    fix: Option<String>,
    blow_up: Option<BlowUp>,
}

/// The engine's result type.
pub type Result<T, E = Error> = std::result::Result<T, E>;

impl Error {
    /// An error with a code and a sentence that says what was found and what is allowed.
    pub fn new(code: Code, sentence: impl Into<String>) -> Self {
        Self(Box::new(Parts {
            code,
            sentence: sentence.into(),
            place: Place::default(),
            fix: None,
            blow_up: None,
        }))
    }

    /// The error of a run that blew up.
    pub fn from_blow_up(blow_up: BlowUp) -> Self {
        let mut error = Self::new(Code::BlewUp, blow_up.to_string());
        error.0.blow_up = Some(blow_up);
        error
    }

    /// Names the field, unless an inner place named one already.
    pub fn at_field(mut self, field: impl Into<String>) -> Self {
        self.0.place.field.get_or_insert_with(|| field.into());
        self
    }

    /// Says that what it is about is a part of `outer`: `damping` becomes `planes[1].damping`.
    pub fn within(mut self, outer: impl Into<String>) -> Self {
        let outer = outer.into();
        self.0.place.field = Some(match self.0.place.field.take() {
            Some(inner) => format!("{outer}.{inner}"),
            None => outer,
        });
        self
    }

    /// Names the file or argument, unless an inner place named one already.
    pub fn in_file(mut self, file: impl Into<String>) -> Self {
        self.0.place.file.get_or_insert_with(|| file.into());
        self
    }

    /// Gives the line and column, both counted from 1.
    pub fn at_line(mut self, line: usize, column: usize) -> Self {
        self.0.place.line_column = Some((line, column));
        self
    }

    /// Adds what would mend it, as a phrase.
    pub fn with_fix(mut self, fix: impl Into<String>) -> Self {
        self.0.fix = Some(fix.into());
        self
    }

    /// The kind of error.
    pub fn code(&self) -> Code {
        self.0.code
    }

    /// What was found and what is allowed, without the place and the fix.
    pub fn sentence(&self) -> &str {
        &self.0.sentence
    }

    /// Where it went wrong.
    pub fn place(&self) -> &Place {
        &self.0.place
    }

    /// What would mend it, where that is known.
    pub fn fix(&self) -> Option<&str> {
        self.0.fix.as_deref()
    }

    /// Time, spring, points and limit of a run that blew up.
    pub fn blow_up(&self) -> Option<&BlowUp> {
        self.0.blow_up.as_ref()
    }

    /// The exit status of a command that ends with this error: 2 for bad input, 3 for a blow-up, 130 when interrupted.
    pub fn exit_status(&self) -> u8 {
        match self.0.code {
            Code::BlewUp => 3,
            Code::Interrupted => 130,
            _ => 2,
        }
    }
}

/// The sentence and its code: it is what a program prints whose `main` returns an error.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self} ({:?})", self.code())
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Parts { sentence, place, fix, .. } = &*self.0;
        if let Some(file) = &place.file {
            write!(f, "{}:", visible(file))?;
            if let Some((line, column)) = place.line_column {
                write!(f, "{line}:{column}:")?;
            }
            write!(f, " ")?;
        }
        if let Some(field) = &place.field {
            write!(f, "{}: ", visible(field))?;
        }
        write!(f, "{sentence}")?;
        if let Some(fix) = fix {
            write!(f, "; {fix}")?;
        }
        Ok(())
    }
}

/// With control characters escaped: a file's name may hold a line break, and a message stays one line.
fn visible(text: &str) -> String {
    let escape = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.to_string() };
    text.chars().map(escape).collect()
}

impl std::error::Error for Error {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_of_codes_has_each_at_its_place() {
        for (place, code) in Code::ALL.into_iter().enumerate() {
            assert_eq!(code as usize, place, "{code:?}");
        }
        assert_eq!(Code::Interrupted as usize + 1, Code::ALL.len(), "a code is missing");
    }
}
