//! A file's text, with the lists of numbers read out of it as it comes.
//!
//! In: a file. Out: its text, in which nothing but line ends is left of these lists, and their numbers. A mesh written as
//! text is three to four times as large as its arrays: it need not be in memory beside them. Line ends stay so that
//! diagnostics find their lines. What is not plain enough (a comment between numbers, a word) is read as it stands.

use std::collections::HashMap;
use std::io::Read;
use std::path::Path;

use rayon::prelude::*;

use crate::files::{self, Content};
use crate::limits::Limit;

/// Bytes that are looked at together.
const BLOCK: usize = 1 << 22;
/// Bytes of numbers that are read one after another.
const PIECE: usize = 1 << 16;
/// No number has more bytes.
const LONGEST_NUMBER: usize = 64;

/// A text, and the lists that were taken out of it.
#[derive(Debug, Default, PartialEq)]
pub struct Text {
    /// What is left.
    pub text: String,
    /// By the place in the text of the bracket that opens them.
    pub lists: HashMap<usize, Numbers>,
    /// Of the whole file.
    pub bytes: usize,
}

/// The numbers of a list.
#[derive(Clone, Debug, PartialEq)]
pub enum Numbers {
    /// Of a parameter of type `integer`.
    Integers(Vec<i32>),
    /// Of others.
    Floats(Vec<f32>),
}

impl Numbers {
    /// Adds those of a text; `None` if there is anything else.
    fn add(&mut self, text: &str) -> Option<()> {
        match self {
            Numbers::Integers(values) => add_all(values, text, super::integer),
            Numbers::Floats(values) => add_all(values, text, super::float),
        }
    }
}

/// Reads pieces of a text side by side.
fn add_all<T: Send>(values: &mut Vec<T>, text: &str, one: impl Fn(&str) -> Option<T> + Sync) -> Option<()> {
    let mut pieces = Vec::new();
    let mut rest = text;
    // Bytes of other characters than ASCII's are none of the spaces.
    while let Some(space) =
        rest.as_bytes().get(PIECE..).and_then(|bytes| bytes.iter().position(u8::is_ascii_whitespace))
    {
        let (piece, after) = rest.split_at(PIECE + space);
        pieces.push(piece);
        rest = after;
    }
    pieces.push(rest);
    let read = |piece: &&str| piece.split_ascii_whitespace().map(&one).collect::<Option<Vec<T>>>();
    if let [piece] = pieces[..] {
        values.extend(read(&piece)?);
        return Some(());
    }
    let read: Option<Vec<Vec<T>>> = pieces.par_iter().map(read).collect();
    read?.into_iter().for_each(|piece| values.extend(piece));
    Some(())
}

fn is_space(c: char) -> bool {
    c.is_ascii_whitespace()
}

impl Text {
    /// A text that is in memory.
    pub fn of(text: String) -> Self {
        Self { bytes: text.len(), text, lists: HashMap::new() }
    }

    /// Reads a file of at most `limit` bytes, unpacked, as UTF-8; what is none becomes `\u{fffd}`, which no keyword has. The error is half a sentence.
    pub fn read(path: &Path, limit: Limit) -> Result<Self, String> {
        let content = files::open(path, limit, limit)?;
        if let Some(text) = Sieve::of(content)? {
            return Ok(text);
        }
        let bytes = files::unpacked(files::read(path, limit)?, limit)?;
        let text = String::from_utf8(bytes);
        Ok(Self::of(text.unwrap_or_else(|e| String::from_utf8_lossy(e.as_bytes()).into_owned())))
    }
}

/// Where in the syntax a byte is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    Outside,
    Comment,
    /// In a string; was the last byte a backslash?
    String(bool),
    /// In a list of numbers.
    List,
}

/// Sorts bytes into text and numbers.
struct Sieve {
    state: State,
    kept: Vec<u8>,
    lists: HashMap<usize, Numbers>,
    /// Where in `kept` the last string begins, if nothing but space has followed it.
    declared: Option<usize>,
    /// The list that is being read, and where in `kept` it begins.
    list: (usize, Numbers),
    /// A number at the end of a block, whose other half comes with the next.
    half: String,
}

impl Sieve {
    /// `None` if the text is not plain enough.
    fn of(Content { mut reader, length }: Content) -> Result<Option<Text>, String> {
        let mut sieve = Self {
            state: State::Outside,
            kept: Vec::new(),
            lists: HashMap::new(),
            declared: None,
            list: (0, Numbers::Floats(Vec::new())),
            half: String::new(),
        };
        let mut block = Vec::new();
        loop {
            block.clear();
            reader.by_ref().take(BLOCK as u64).read_to_end(&mut block).map_err(|e| files::reason(&e))?;
            if block.is_empty() {
                break;
            }
            if sieve.take(&block).is_none() {
                return Ok(None);
            }
        }
        let is_whole = sieve.state != State::List;
        let text = String::from_utf8(sieve.kept).ok().filter(|_| is_whole);
        Ok(text.map(|text| Text { text, lists: sieve.lists, bytes: length as usize }))
    }

    fn take(&mut self, block: &[u8]) -> Option<()> {
        let mut at = 0;
        while at < block.len() {
            if self.state == State::List {
                at += self.numbers(&block[at..])?;
                continue;
            }
            let byte = block[at];
            self.state = match (self.state, byte) {
                (State::Outside, b'#') => State::Comment,
                (State::Outside, b'"') => {
                    self.declared = Some(self.kept.len());
                    State::String(false)
                }
                (State::Outside, b'[') if self.opens_list() => {
                    self.kept.push(byte);
                    at += 1;
                    self.state = State::List;
                    continue;
                }
                (State::Outside, byte) => {
                    if !byte.is_ascii_whitespace() {
                        self.declared = None;
                    }
                    State::Outside
                }
                (State::Comment, b'\n') => State::Outside,
                // A string ends on its line.
                (State::String(false), b'"') | (State::String(_), b'\n') => State::Outside,
                (State::String(escaped), byte) => State::String(byte == b'\\' && !escaped),
                (state, _) => state,
            };
            self.kept.push(byte);
            at += 1;
        }
        Some(())
    }

    /// Does a bracket here open the numbers of a parameter?
    fn opens_list(&mut self) -> bool {
        let Some(start) = self.declared.take() else { return false };
        let declaration = &self.kept[start + 1..];
        let kind = declaration.split(|byte| *byte == b' ').next().unwrap_or_default();
        let numbers = match kind {
            b"integer" => Numbers::Integers(Vec::new()),
            b"float" | b"point" | b"point2" | b"point3" | b"vector" | b"vector2" | b"vector3" | b"normal"
            | b"normal3" => Numbers::Floats(Vec::new()),
            _ => return false,
        };
        self.list = (self.kept.len(), numbers);
        true
    }

    /// Reads numbers; how many bytes they took. `None` if there is anything else.
    fn numbers(&mut self, bytes: &[u8]) -> Option<usize> {
        let end = bytes.iter().position(|byte| *byte == b']');
        let mut rest = std::str::from_utf8(&bytes[..end.unwrap_or(bytes.len())]).ok()?;
        let lines = rest.bytes().filter(|byte| *byte == b'\n').count();
        self.kept.extend(std::iter::repeat_n(b'\n', lines));
        if !self.half.is_empty() {
            let space = rest.find(is_space);
            let (other, after) = rest.split_at(space.unwrap_or(rest.len()));
            self.half.push_str(other);
            rest = after;
            if space.is_some() || end.is_some() {
                let number = std::mem::take(&mut self.half);
                self.list.1.add(&number)?;
            }
        }
        if end.is_none() && !rest.is_empty() {
            let (whole, half) = rest.split_at(rest.rfind(is_space).map_or(0, |space| space + 1));
            self.half.push_str(half);
            rest = whole;
        }
        self.list.1.add(rest)?;
        if end.is_some() {
            self.close();
        }
        (self.half.len() <= LONGEST_NUMBER).then(|| end.map_or(bytes.len(), |end| end + 1))
    }

    fn close(&mut self) {
        let (start, numbers) = std::mem::replace(&mut self.list, (0, Numbers::Floats(Vec::new())));
        self.lists.insert(start, numbers);
        self.kept.push(b']');
        self.state = State::Outside;
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    fn sieved(text: &str) -> Option<Text> {
        let reader = Box::new(Cursor::new(text.as_bytes().to_vec()));
        Sieve::of(Content { reader, length: text.len() as u64 }).unwrap()
    }

    #[test]
    fn lists_are_taken_out_and_lines_stay() {
        let text = "# \"float a\" [ 1 ]\nShape \"x\" \"integer indices\" [ 0 1\n2 ]\n \"point3 P\" [1 2.5\r\n-3e1]\nrest";
        let found = sieved(text).unwrap();
        assert_eq!(
            found.text,
            "# \"float a\" [ 1 ]\nShape \"x\" \"integer indices\" [\n]\n \"point3 P\" [\n]\nrest"
        );
        let at = |what: &str| found.text.find(what).unwrap() + what.len() - 1;
        assert_eq!(found.lists[&at("indices\" [")], Numbers::Integers(vec![0, 1, 2]));
        assert_eq!(found.lists[&at("P\" [")], Numbers::Floats(vec![1.0, 2.5, -30.0]));
    }

    #[test]
    fn numbers_across_blocks_are_whole() {
        let numbers: Vec<String> = (0..1_500_000).map(|i| format!("{}", i * 7)).collect();
        let text = format!("\"integer a\" [{}]", numbers.join(" "));
        assert!(text.len() > 2 * BLOCK);
        let expected: Vec<i32> = (0..1_500_000).map(|i| i * 7).collect();
        assert_eq!(sieved(&text).unwrap().lists[&12], Numbers::Integers(expected));
    }

    #[test]
    fn what_is_not_plain_is_left_to_others() {
        for text in
            ["\"float a\" [ 1 # one\n ]", "\"float a\" [ x ]", "\"integer a\" [ 1.5 ]", "\"float a\" [ 1"]
        {
            assert_eq!(sieved(text), None, "{text}");
        }
        for text in
            ["\"bool a\" [ true ]", "\"string a\" [ \"float b\" ]", "Transform [ 1 2 ]", "\"a\\\"[\" [ 1 ]"]
        {
            assert_eq!(sieved(text).unwrap().text, text);
        }
    }
}
