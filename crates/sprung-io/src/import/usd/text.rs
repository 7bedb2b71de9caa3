//! Text USD (`.usda`).

use sprung::{Code, Error, Result};

use super::layer::{Layer, Prim, Value};
use crate::import::malformed;
use crate::import::words::{Words, quoted};

/// Prims within prims.
const DEEPEST: usize = 100;

/// A piece of the text.
#[derive(Debug, PartialEq)]
enum Token {
    /// A name, a number or a word.
    Word(String),
    /// Text in quotes, an asset or a path.
    Text(String),
    Sign(u8),
}

struct Tokens<'a> {
    rest: &'a [u8],
    line: usize,
    /// The line of the token that was taken last.
    last_line: usize,
    peeked: Option<(Token, usize)>,
}

impl Tokens<'_> {
    fn error(&self, code: Code, sentence: impl Into<String>) -> Error {
        Error::new(code, sentence).at_line(self.last_line, 1)
    }

    fn skip(&mut self, count: usize) {
        let (taken, rest) = self.rest.split_at(count.min(self.rest.len()));
        self.line += crate::import::words::count_lines(taken);
        self.rest = rest;
    }

    fn peek(&mut self) -> Result<Option<&(Token, usize)>> {
        if self.peeked.is_none() {
            self.peeked = self.scan()?;
        }
        Ok(self.peeked.as_ref())
    }

    fn is_next(&mut self, sign: u8) -> Result<bool> {
        Ok(self.peek()?.is_some_and(|(token, _)| *token == Token::Sign(sign)))
    }

    fn next(&mut self) -> Result<Option<Token>> {
        self.peek()?;
        let taken = self.peeked.take();
        if let Some((_, line)) = &taken {
            self.last_line = *line;
        }
        Ok(taken.map(|(token, _)| token))
    }

    fn scan(&mut self) -> Result<Option<(Token, usize)>> {
        loop {
            let blank = self.rest.iter().position(|byte| !byte.is_ascii_whitespace() && *byte != b';');
            self.skip(blank.unwrap_or(self.rest.len()));
            if self.rest.first() != Some(&b'#') {
                break;
            }
            let end = self.rest.iter().position(|&byte| byte == b'\n').unwrap_or(self.rest.len());
            self.skip(end);
        }
        let line = self.line;
        let Some(&first) = self.rest.first() else { return Ok(None) };
        let close: &[u8] = match first {
            b'"' | b'\'' if self.rest.starts_with(&[first; 3]) => &self.rest[..3],
            b'"' | b'\'' => &self.rest[..1],
            b'@' if self.rest.starts_with(b"@@@") => b"@@@",
            b'@' => b"@",
            b'<' => b">",
            b'(' | b')' | b'[' | b']' | b'{' | b'}' | b'=' | b',' => {
                self.skip(1);
                return Ok(Some((Token::Sign(first), line)));
            }
            _ => {
                let ends = |byte: &u8| byte.is_ascii_whitespace() || b"()[]{}=,;\"'@<#".contains(byte);
                let end = self.rest.iter().position(ends).unwrap_or(self.rest.len()).max(1);
                let word = super::shortened(&self.rest[..end]);
                self.skip(end);
                return Ok(Some((Token::Word(word), line)));
            }
        };
        let start = if first == b'<' { 1 } else { close.len() };
        let mut at = start;
        while at < self.rest.len() && !self.rest[at..].starts_with(close) {
            at += if self.rest[at] == b'\\' { 2 } else { 1 };
        }
        if at >= self.rest.len() {
            self.last_line = line;
            return Err(self.error(Code::Syntax, "has a text in quotes that does not end"));
        }
        let text = super::shortened(&self.rest[start..at]);
        self.skip(at + close.len());
        Ok(Some((Token::Text(text), line)))
    }

    /// Goes on after the sign that closes the one that was taken last; gives the words on the way that lie in no other brackets,
    /// up to a few: names of what a dictionary there holds are not meant.
    fn balanced(&mut self) -> Result<Vec<String>> {
        let (mut depth, mut words) = (1, Vec::new());
        while depth > 0 {
            match self.next()? {
                Some(Token::Sign(b'(' | b'[' | b'{')) => depth += 1,
                Some(Token::Sign(b')' | b']' | b'}')) => depth -= 1,
                Some(Token::Word(word) | Token::Text(word)) if depth == 1 && words.len() < 1000 => {
                    words.push(word);
                }
                Some(_) => {}
                None => return Err(self.error(Code::Syntax, "ends before its last bracket is closed")),
            }
        }
        Ok(words)
    }

    /// A value: all numbers in it, or all words.
    fn value(&mut self) -> Result<Option<Value>> {
        let (mut numbers, mut words, mut depth) = (Vec::new(), Vec::new(), 0);
        loop {
            match self.next()? {
                Some(Token::Sign(b'(' | b'[')) => depth += 1,
                Some(Token::Sign(b')' | b']')) if depth > 0 => depth -= 1,
                Some(Token::Sign(b',')) if depth > 0 => {}
                Some(Token::Sign(b'{')) if depth == 0 => {
                    self.balanced()?;
                    return Ok(None);
                }
                Some(Token::Word(word)) => match word.parse::<f64>() {
                    Ok(number) => numbers.push(number),
                    Err(_) => words.push(word),
                },
                Some(Token::Text(text)) => words.push(text),
                Some(Token::Sign(sign)) => {
                    return Err(
                        self.error(Code::Syntax, format!("has \"{}\" where a value must be", sign as char))
                    );
                }
                None => return Err(self.error(Code::Syntax, "ends where a value must be")),
            }
            if depth == 0 {
                break;
            }
        }
        Ok(Some(if numbers.is_empty() && !words.is_empty() {
            Value::Words(words)
        } else {
            Value::Numbers(numbers)
        }))
    }
}

pub(super) fn read(bytes: &[u8]) -> Result<Layer> {
    if !bytes.trim_ascii_start().starts_with(b"#usda") {
        return Err(malformed("does not begin with #usda; is it a text USD file?"));
    }
    let mut head = Words::new(bytes, 1);
    head.end_line();
    let mut tokens = Tokens { rest: head.rest(), line: head.line(), last_line: 1, peeked: None };
    let mut layer = Layer::default();
    if tokens.is_next(b'(')? {
        tokens.next()?;
        let words = tokens.balanced()?;
        let after = |name: &str| {
            let at = words.iter().position(|word| word == name)?;
            Some(words.get(at + 1).map_or("", String::as_str))
        };
        if let Some(word) = after("metersPerUnit") {
            let number = word.parse().map_err(|_| {
                let sentence = format!("is \"{}\", and must be a number", quoted(word.as_bytes()));
                Error::new(Code::WrongType, sentence).at_field("metersPerUnit")
            });
            layer.metres = Some(number?);
        }
        layer.up = after("upAxis").map(str::to_owned);
    }
    // The prims around the place that is read.
    let mut inside: Vec<usize> = Vec::new();
    while let Some(token) = tokens.next()? {
        let word = match token {
            Token::Sign(b'}') if inside.pop().is_some() => continue,
            Token::Word(word) => word,
            Token::Sign(sign) => {
                return Err(tokens.error(
                    Code::Syntax,
                    format!("has \"{}\" where a prim or property must be", sign as char),
                ));
            }
            Token::Text(text) => {
                let sentence =
                    format!("has \"{}\" where a prim or property must be", quoted(text.as_bytes()));
                return Err(tokens.error(Code::Syntax, sentence));
            }
        };
        match word.as_str() {
            "def" | "over" | "class" => {
                let prim = prim(&mut tokens, &word, inside.last().copied())?;
                inside.push(layer.prims.len());
                layer.prims.push(prim);
                if inside.len() > DEEPEST {
                    return Err(tokens.error(Code::TooLarge, "has prims that lie too deeply within others"));
                }
            }
            "variantSet" => {
                while let Some(token) = tokens.next()? {
                    if token == Token::Sign(b'{') {
                        tokens.balanced()?;
                        break;
                    }
                }
            }
            _ => property(&mut tokens, word, inside.last().and_then(|&prim| layer.prims.get_mut(prim)))?,
        }
    }
    if inside.is_empty() {
        Ok(layer)
    } else {
        Err(tokens.error(Code::Syntax, "ends before its last bracket is closed"))
    }
}

/// From the type of a prim to its opening bracket.
fn prim(tokens: &mut Tokens<'_>, word: &str, parent: Option<usize>) -> Result<Prim> {
    let mut prim = Prim { parent, ..Prim::default() };
    loop {
        match tokens.next()? {
            Some(Token::Word(kind)) => prim.kind = kind,
            Some(Token::Text(name)) => prim.name = name,
            Some(Token::Sign(b'(')) => {
                let words = tokens.balanced()?;
                let refers = ["references", "payload", "inherits", "specializes"];
                prim.refers = words.iter().any(|word| refers.contains(&word.as_str()));
            }
            Some(Token::Sign(b'{')) => break,
            _ => return Err(tokens.error(Code::Syntax, format!("has a {word} without a name and a bracket"))),
        }
    }
    // A class is a pattern for others, and not there itself.
    if word == "class" {
        prim.kind = "class".to_owned();
    }
    Ok(prim)
}

/// The rest of a property's line, after its first word, and its value.
fn property(tokens: &mut Tokens<'_>, first: String, prim: Option<&mut Prim>) -> Result<()> {
    let line = tokens.last_line;
    let mut name = first;
    loop {
        match tokens.peek()? {
            Some((Token::Word(_), found)) if *found == line => {
                if let Some(Token::Word(word)) = tokens.next()? {
                    name = word;
                }
            }
            // The type of a list: float3[].
            Some((Token::Sign(b'[' | b']'), found)) if *found == line => {
                tokens.next()?;
            }
            _ => break,
        }
    }
    if tokens.is_next(b'=')? {
        tokens.next()?;
        let value = tokens.value()?;
        if let (Some(prim), Some(mut value)) = (prim, value)
            && super::is_wanted(&name)
        {
            // A quaternion has its real part first in text, and last in binary.
            if let (Value::Numbers(numbers), true) = (&mut value, name.starts_with("xformOp:orient")) {
                let count = numbers.len();
                numbers.rotate_left(count.min(1));
            }
            prim.values.insert(name, value);
        }
    }
    if tokens.is_next(b'(')? {
        tokens.next()?;
        tokens.balanced()?;
    }
    Ok(())
}
