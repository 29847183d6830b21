//! JSON text to values that know where they stand, so that whatever is wrong can be shown at its place.
//!
//! Our own and not a crate's: those keep no places, and bound neither depth nor count.

use sr_scene::{SourceId, Span};

use crate::limits::Limit;

/// Values nested deeper are refused.
const MAX_DEPTH: usize = 64;

/// A value and its place.
#[derive(Clone, Debug)]
pub struct Value {
    pub kind: Kind,
    pub span: Span,
}

#[derive(Clone, Debug)]
pub enum Kind {
    Null,
    Bool(bool),
    Number(f64),
    Text(String),
    List(Vec<Value>),
    Object(Vec<(String, Value)>),
}

impl Value {
    /// A member of an object.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.members().iter().find(|(n, _)| n == name).map(|(_, value)| value)
    }

    /// A member of a member.
    pub fn path(&self, names: &[&str]) -> Option<&Value> {
        names.iter().try_fold(self, |value, name| value.get(name))
    }

    /// What an extension adds to an object.
    pub fn extension(&self, name: &str) -> Option<&Value> {
        self.path(&["extensions", name])
    }

    pub fn members(&self) -> &[(String, Value)] {
        if let Kind::Object(members) = &self.kind { members } else { &[] }
    }

    pub fn list(&self) -> &[Value] {
        if let Kind::List(list) = &self.kind { list } else { &[] }
    }

    pub fn number(&self) -> Option<f64> {
        if let Kind::Number(number) = self.kind { Some(number) } else { None }
    }

    pub fn index(&self) -> Option<usize> {
        self.number().filter(|n| *n >= 0.0 && n.fract() == 0.0 && *n < 9e15).map(|n| n as usize)
    }

    pub fn text(&self) -> Option<&str> {
        if let Kind::Text(text) = &self.kind { Some(text) } else { None }
    }

    pub fn is_true(&self) -> bool {
        matches!(self.kind, Kind::Bool(true))
    }

    /// A list of exactly `N` numbers.
    pub fn numbers<const N: usize>(&self) -> Option<[f64; N]> {
        let numbers: Option<Vec<f64>> = self.list().iter().map(Value::number).collect();
        numbers?.try_into().ok()
    }
}

/// Parses a text of at most `limit` values, each of which takes some ten times the room of its text; the error is a byte and half a sentence.
pub fn parse(text: &str, source: SourceId, limit: Limit) -> Result<Value, (usize, String)> {
    let mut parser = Parser { text, source, at: 0, count: 0, limit };
    let value = parser.value(0);
    let done = value.and_then(|value| {
        parser.space();
        if parser.at == text.len() { Ok(value) } else { Err("nothing more was expected".into()) }
    });
    done.map_err(|reason| (parser.at, reason))
}

struct Parser<'t> {
    text: &'t str,
    source: SourceId,
    at: usize,
    count: usize,
    limit: Limit,
}

impl Parser<'_> {
    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn space(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\t' | b'\r' | b'\n')) {
            self.at += 1;
        }
    }

    fn take(&mut self, byte: u8) -> bool {
        self.space();
        let found = self.peek() == Some(byte);
        self.at += usize::from(found);
        found
    }

    fn expect(&mut self, byte: u8) -> Result<(), String> {
        if self.take(byte) { Ok(()) } else { Err(format!("\"{}\" was expected", char::from(byte))) }
    }

    fn value(&mut self, depth: usize) -> Result<Value, String> {
        self.space();
        self.count += 1;
        if depth > MAX_DEPTH {
            return Err(format!("values are nested more than {MAX_DEPTH} deep"));
        }
        if self.count > self.limit.len() {
            return Err(self.limit.refusal(format!("it has more than {} values", self.limit)));
        }
        let start = self.at;
        let kind = match self.peek() {
            Some(b'{') => self.object(depth)?,
            Some(b'[') => self.array(depth)?,
            Some(b'"') => Kind::Text(self.string()?),
            Some(b'-' | b'0'..=b'9') => Kind::Number(self.a_number()?),
            _ => self.word()?,
        };
        Ok(Value { kind, span: Span { source: self.source, bytes: start..self.at } })
    }

    fn object(&mut self, depth: usize) -> Result<Kind, String> {
        self.at += 1;
        let mut members = Vec::new();
        if self.take(b'}') {
            return Ok(Kind::Object(members));
        }
        loop {
            self.space();
            let name = self.string()?;
            self.expect(b':')?;
            members.push((name, self.value(depth + 1)?));
            if !self.take(b',') {
                break;
            }
        }
        self.expect(b'}')?;
        Ok(Kind::Object(members))
    }

    fn array(&mut self, depth: usize) -> Result<Kind, String> {
        self.at += 1;
        let mut list = Vec::new();
        if self.take(b']') {
            return Ok(Kind::List(list));
        }
        loop {
            list.push(self.value(depth + 1)?);
            if !self.take(b',') {
                break;
            }
        }
        self.expect(b']')?;
        Ok(Kind::List(list))
    }

    fn word(&mut self) -> Result<Kind, String> {
        for (word, kind) in [("true", Kind::Bool(true)), ("false", Kind::Bool(false)), ("null", Kind::Null)] {
            if self.text[self.at..].starts_with(word) {
                self.at += word.len();
                return Ok(kind);
            }
        }
        Err("a value was expected".into())
    }

    fn a_number(&mut self) -> Result<f64, String> {
        let rest = &self.text[self.at..];
        let end = rest.find(|c: char| !matches!(c, '0'..='9' | '+' | '-' | '.' | 'e' | 'E'));
        let word = &rest[..end.unwrap_or(rest.len())];
        let number = word.parse::<f64>().ok().filter(|n| n.is_finite());
        let number = number.ok_or_else(|| format!("\"{}\" is no number", crate::values::shown(word)))?;
        self.at += word.len();
        Ok(number)
    }

    fn string(&mut self) -> Result<String, String> {
        if self.peek() != Some(b'"') {
            return Err("a text in quotes was expected".into());
        }
        self.at += 1;
        let mut out = String::new();
        loop {
            let rest = &self.text[self.at..];
            let Some(end) = rest.find(['"', '\\']) else { return Err("a text has no end".into()) };
            out.push_str(&rest[..end]);
            self.at += end + 1;
            if rest.as_bytes()[end] == b'"' {
                return Ok(out);
            }
            self.escape(&mut out)?;
        }
    }

    fn escape(&mut self, out: &mut String) -> Result<(), String> {
        let escaped = self.peek().ok_or("a text has no end")?;
        let plain = match escaped {
            b'"' | b'\\' | b'/' => char::from(escaped),
            b'b' => '\u{8}',
            b'f' => '\u{c}',
            b'n' => '\n',
            b'r' => '\r',
            b't' => '\t',
            b'u' => {
                self.at += 1;
                let mut units = vec![self.unit()?];
                if (0xd800..0xdc00).contains(&units[0]) && self.text[self.at..].starts_with("\\u") {
                    self.at += 2;
                    units.push(self.unit()?);
                }
                out.push_str(&String::from_utf16_lossy(&units));
                return Ok(());
            }
            _ => return Err("an escape that is not known".into()),
        };
        self.at += 1;
        out.push(plain);
        Ok(())
    }

    /// Four hexadecimal digits.
    fn unit(&mut self) -> Result<u16, String> {
        let digits = self.text.get(self.at..self.at + 4).ok_or("four hexadecimal digits were expected")?;
        let unit = u16::from_str_radix(digits, 16).map_err(|e| e.to_string())?;
        self.at += 4;
        Ok(unit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_know_their_places() {
        let text = r#" {"a": [1, -2.5e1, true, null], "b\u00e9\ud83d\ude00\n": {"c": "x"}} "#;
        let value = parse(text, SourceId(0), Limit::fixed(100)).unwrap();
        assert_eq!(value.get("a").unwrap().list()[1].number(), Some(-25.0));
        assert_eq!(&text[value.get("a").unwrap().list()[1].span.bytes.clone()], "-2.5e1");
        assert_eq!(value.path(&["b\u{e9}\u{1f600}\n", "c"]).unwrap().text(), Some("x"));
    }

    #[test]
    fn what_is_no_json_is_refused_where_it_goes_wrong() {
        let deep = "[".repeat(100_000);
        for (text, at) in
            [("", 0), ("{\"a\" 1}", 5), ("[1,]", 3), ("\"a", 1), ("1 2", 2), ("[1e999]", 1), (&deep, 65)]
        {
            assert_eq!(
                parse(text, SourceId(0), Limit::fixed(100)).unwrap_err().0,
                at,
                "{}",
                &text[..text.len().min(20)]
            );
        }
    }
}
