//! A text as words, each with its line: for formats in which white space separates and nothing nests.

use sprung::{Code, Error, Result};

/// What is quoted of a word that was not expected.
const QUOTED: usize = 40;

/// The words of a text that have not been taken yet.
#[derive(Clone)]
pub(super) struct Words<'a> {
    rest: &'a [u8],
    line: usize,
}

impl<'a> Words<'a> {
    /// Those of a text whose first line is number `line`.
    pub fn new(text: &'a [u8], line: usize) -> Self {
        Self { rest: text, line }
    }

    /// The line that the last word was in, from 1.
    pub fn line(&self) -> usize {
        self.line
    }

    /// The bytes that are left.
    pub fn rest(&self) -> &'a [u8] {
        self.rest
    }

    /// The next word.
    pub fn next(&mut self) -> Option<&'a [u8]> {
        let blank = self.rest.iter().position(|byte| !byte.is_ascii_whitespace()).unwrap_or(self.rest.len());
        self.line += count_lines(&self.rest[..blank]);
        self.rest = &self.rest[blank..];
        let end = self.rest.iter().position(u8::is_ascii_whitespace).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        (!word.is_empty()).then_some(word)
    }

    /// The next word, which must be there.
    pub fn expect(&mut self, what: &str) -> Result<&'a [u8]> {
        self.next().ok_or_else(|| self.error(Code::Syntax, format!("ends where {what} must be")))
    }

    /// The rest of the line, without white space around it.
    pub fn rest_of_line(&mut self) -> &'a [u8] {
        let end = self.rest.iter().position(|&byte| byte == b'\n').unwrap_or(self.rest.len());
        let (line, rest) = self.rest.split_at(end);
        self.rest = rest;
        line.trim_ascii()
    }

    /// Takes the break at the end of this line, and so leaves the first byte of the next.
    pub fn end_line(&mut self) {
        self.rest_of_line();
        if let [b'\n', rest @ ..] = self.rest {
            self.rest = rest;
            self.line += 1;
        }
    }

    /// The next word as a number.
    pub fn float(&mut self, what: &str) -> Result<f64> {
        let word = self.expect(what)?;
        float(word).ok_or_else(|| self.not_a(word, what))
    }

    /// The next word as a whole number.
    pub fn integer<T: std::str::FromStr>(&mut self, what: &str) -> Result<T> {
        let word = self.expect(what)?;
        let number = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        number.ok_or_else(|| self.not_a(word, what))
    }

    /// What to say if the number that was taken last may not be whole: nothing stands behind it, not even the end of its line.
    /// Where numbers are counted, no other cut goes unnoticed.
    pub fn maybe_cut(&self) -> Option<String> {
        let line = self.line;
        let said = || format!("ends right after a number, in line {line}, and may be cut short there");
        self.rest.is_empty().then(said)
    }

    /// The error for a word that is something else than what must be there.
    pub fn not_a(&self, word: &[u8], what: &str) -> Error {
        self.error(Code::Syntax, format!("has \"{}\" where {what} must be", quoted(word)))
    }

    /// An error in this line.
    pub fn error(&self, code: Code, sentence: impl Into<String>) -> Error {
        Error::new(code, sentence).at_line(self.line, 1)
    }
}

/// Lines that end in a piece of text.
pub(super) fn count_lines(text: &[u8]) -> usize {
    text.iter().filter(|&&byte| byte == b'\n').count()
}

/// A finite number.
pub(super) fn float(word: &[u8]) -> Option<f64> {
    let number: f64 = std::str::from_utf8(word).ok()?.parse().ok()?;
    number.is_finite().then_some(number)
}

/// The beginning of a word, as it can be shown.
pub(super) fn quoted(word: &[u8]) -> String {
    // No more of it than can be shown: it may be as long as the file, and be asked for often.
    let text = String::from_utf8_lossy(&word[..word.len().min(4 * QUOTED + 4)]);
    let short: String = text.chars().take(QUOTED).collect();
    let short: String = short
        .chars()
        .flat_map(|letter| {
            let shown: Vec<char> =
                if letter.is_control() { letter.escape_default().collect() } else { vec![letter] };
            shown
        })
        .collect();
    if text.chars().nth(QUOTED).is_some() { short + "…" } else { short }
}

/// As [`quoted`], of a whole sentence.
pub(super) fn quoted_long(text: &[u8]) -> String {
    text.chunks(QUOTED).take(8).map(|piece| quoted(piece).replace('…', "")).collect()
}

/// The bytes that base64 stands for, with or without its padding; nothing for what is not base64.
pub(super) fn from_base64(text: &[u8]) -> Option<Vec<u8>> {
    let text = text.trim_ascii();
    let text = text.strip_suffix(b"==").or(text.strip_suffix(b"=")).unwrap_or(text);
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for four in text.chunks(4) {
        let mut bits = 0u32;
        for &letter in four {
            bits = bits << 6 | base64_value(letter)?;
        }
        let whole = match four.len() {
            4 => 3,
            3 => 2,
            2 => 1,
            _ => return None,
        };
        bits <<= 6 * (4 - four.len());
        bytes.extend_from_slice(&bits.to_be_bytes()[1..=whole]);
    }
    Some(bytes)
}

/// The six bits that a letter of base64 stands for.
pub(super) fn base64_value(letter: u8) -> Option<u32> {
    let value = match letter {
        b'A'..=b'Z' => letter - b'A',
        b'a'..=b'z' => letter - b'a' + 26,
        b'0'..=b'9' => letter - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        _ => return None,
    };
    Some(value.into())
}
