//! Bytes to words, strings and numbers.

use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;

use super::text::Numbers;
use super::{Result, SyntaxError, Text, float, integer};
use crate::values::shown;

/// A place in a text, and what can be read there. Space and comments are passed over.
pub struct Scanner<'t> {
    text: &'t str,
    at: usize,
    /// See [`Text`]: those that were not asked for yet.
    lists: HashMap<usize, Numbers>,
}

impl<'t> Scanner<'t> {
    /// At the start of a text, whose lists it takes.
    pub fn new(text: &'t mut Text) -> Self {
        Self { text: &text.text, at: 0, lists: std::mem::take(&mut text.lists) }
    }

    /// The first byte of what comes next; `None` at the end.
    pub fn peek(&mut self) -> Option<u8> {
        let bytes = self.text.as_bytes();
        while let Some(&byte) = bytes.get(self.at) {
            match byte {
                b' ' | b'\t' | b'\n' | b'\r' => self.at += 1,
                // The mark that some editors begin a file with.
                0xEF if self.at == 0 && self.text.starts_with('\u{feff}') => self.at = 3,
                b'#' => {
                    let rest = &bytes[self.at..];
                    self.at += rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
                }
                _ => return Some(byte),
            }
        }
        None
    }

    /// Passes over `byte` if it comes next.
    pub fn skip(&mut self, byte: u8) -> bool {
        let is_next = self.peek() == Some(byte);
        self.at += usize::from(is_next);
        is_next
    }

    /// Is a string the first of the values that come next?
    pub fn is_string_next(&mut self) -> bool {
        let mut ahead = Self { text: self.text, at: self.at, lists: HashMap::new() };
        ahead.skip(b'[');
        ahead.peek() == Some(b'"')
    }

    /// What stands between delimiters, without quotes: a directive, a number, `true`. Empty where none is.
    pub fn word(&mut self) -> (&'t str, Range<usize>) {
        self.peek();
        let start = self.at;
        let rest = &self.text.as_bytes()[start..];
        let is_end = |b: &u8| matches!(b, b' ' | b'\t' | b'\n' | b'\r' | b'"' | b'[' | b']' | b'#');
        self.at += rest.iter().position(is_end).unwrap_or(rest.len());
        (&self.text[start..self.at], start..self.at)
    }

    /// A string in quotes. It ends on its line.
    pub fn string(&mut self) -> Result<(Cow<'t, str>, Range<usize>)> {
        if self.peek() != Some(b'"') {
            return Err(self.unexpected("a string in quotes"));
        }
        let start = self.at;
        let bytes = self.text.as_bytes();
        let mut end = start + 1;
        let mut escaped = false;
        loop {
            match bytes.get(end) {
                Some(b'"') => break,
                Some(b'\\') if bytes.get(end + 1).is_some() => {
                    escaped = true;
                    end += 2;
                }
                None | Some(b'\n') => return Err(error("this string has no end", start..end)),
                Some(_) => end += 1,
            }
        }
        self.at = end + 1;
        let inner = &self.text[start + 1..end];
        let inner = if escaped { Cow::Owned(unescaped(inner)) } else { Cow::Borrowed(inner) };
        Ok((inner, start..self.at))
    }

    /// A finite number.
    pub fn number(&mut self) -> Result<f64> {
        let (word, bytes) = self.word();
        match word.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(self.no_number(word, bytes)),
        }
    }

    /// As many numbers as there are places in `out`, in brackets or not.
    pub fn numbers(&mut self, out: &mut [f64]) -> Result<()> {
        let bracket = self.skip(b'[');
        for slot in out.iter_mut() {
            *slot = self.number()?;
        }
        if bracket && !self.skip(b']') {
            return Err(self.unexpected(&format!("a bracket after {} numbers", out.len())));
        }
        Ok(())
    }

    /// The numbers up to a closing bracket, or one. They are what parameters are mostly made of.
    pub fn floats(&mut self) -> Result<Vec<f32>> {
        match self.taken_out() {
            Some(Numbers::Floats(values)) => Ok(values),
            Some(Numbers::Integers(values)) => Ok(values.iter().map(|v| *v as f32).collect()),
            None => self.list(float),
        }
    }

    /// The whole numbers up to a closing bracket, or one.
    pub fn integers(&mut self) -> Result<Vec<i32>> {
        match self.taken_out() {
            Some(Numbers::Integers(values)) => Ok(values),
            Some(Numbers::Floats(_)) => Err(self.unexpected("a whole number")),
            None => self.list(integer),
        }
    }

    /// The list that comes next, if it was taken out of the text.
    fn taken_out(&mut self) -> Option<Numbers> {
        self.peek();
        let numbers = self.lists.remove(&self.at)?;
        self.skip(b'[');
        self.skip(b']');
        Some(numbers)
    }

    fn list<T>(&mut self, parse: impl Fn(&str) -> Option<T>) -> Result<Vec<T>> {
        let bracket = self.skip(b'[');
        let mut values = Vec::new();
        loop {
            if bracket && self.skip(b']') {
                return Ok(values);
            }
            let (word, bytes) = self.word();
            match parse(word) {
                Some(value) => values.push(value),
                None => return Err(self.no_number(word, bytes)),
            }
            if !bracket {
                return Ok(values);
            }
        }
    }

    fn no_number(&mut self, word: &str, bytes: Range<usize>) -> SyntaxError {
        if word.is_empty() {
            return self.unexpected("a number");
        }
        error(format!("\"{}\" is not a number that can be used here", shown(word)), bytes)
    }

    /// Something else stands here.
    pub fn unexpected(&mut self, expected: &str) -> SyntaxError {
        match self.peek() {
            None => error(format!("the file ends where {expected} was expected"), self.at..self.at),
            Some(_) => {
                let next = self.text[self.at..].chars().next().unwrap_or(' ');
                let message = format!("{expected} was expected here, not \"{next}\"");
                error(message, self.at..self.at + next.len_utf8())
            }
        }
    }
}

/// An error at a place.
fn error(message: impl Into<String>, bytes: Range<usize>) -> SyntaxError {
    SyntaxError { message: message.into(), bytes }
}

fn unescaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut chars = text.chars();
    while let Some(c) = chars.next() {
        out.push(match c {
            '\\' => match chars.next() {
                Some('n') => '\n',
                Some('t') => '\t',
                Some('r') => '\r',
                Some('b') => '\u{8}',
                Some('f') => '\u{c}',
                Some(other) => other,
                None => '\\',
            },
            other => other,
        });
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_strings_and_numbers() {
        let mut text = Text::of("# first\nShape\"a \\\"b\\\"\" [ 1 -2.5e0 ]#end\n3 true]".into());
        let mut s = Scanner::new(&mut text);
        assert_eq!(s.word(), ("Shape", 8..13));
        assert_eq!(s.string().unwrap(), (Cow::from("a \"b\""), 13..22));
        assert_eq!(s.floats().unwrap(), [1.0, -2.5]);
        assert_eq!(s.integers().unwrap(), [3]);
        assert_eq!(s.word().0, "true");
        assert!(s.skip(b']'));
        assert_eq!(s.peek(), None);
    }

    #[test]
    fn what_is_no_number_is_an_error_at_its_place() {
        for (text, bytes) in
            [("[1 x]", 3..4), ("[1 nan]", 3..6), ("[1e999]", 1..6), ("[1 2", 4..4), ("[\"a\"]", 1..2)]
        {
            assert_eq!(Scanner::new(&mut Text::of(text.into())).floats().unwrap_err().bytes, bytes, "{text}");
        }
        assert!(Scanner::new(&mut Text::of("[1.5]".into())).integers().is_err());
        assert!(Scanner::new(&mut Text::of("[99999999999]".into())).integers().is_err());
        assert_eq!(Scanner::new(&mut Text::of("\"a\nb\"".into())).string().unwrap_err().bytes, 0..2);
        assert!(Scanner::new(&mut Text::of("\"a\\".into())).string().is_err());
        let mut three = [0.0; 3];
        assert!(Scanner::new(&mut Text::of("[1 2 3 4]".into())).numbers(&mut three).is_err());
        assert!(Scanner::new(&mut Text::of("1 2 3 4".into())).numbers(&mut three).is_ok());
    }
}
