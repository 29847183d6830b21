//! `"type name" value` pairs.

use std::ops::Range;

use super::{Result, Scanner, SyntaxError};
use crate::values::shown;

/// The type that a parameter is declared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Integer,
    Float,
    Point2,
    Vector2,
    Point3,
    Vector3,
    Normal,
    Rgb,
    Spectrum,
    Blackbody,
    Bool,
    String,
    Texture,
}

impl Kind {
    /// All that there are, by the names of pbrt-v4 and of its predecessors.
    const NAMES: [(&str, Kind); 19] = [
        ("integer", Kind::Integer),
        ("float", Kind::Float),
        ("point2", Kind::Point2),
        ("vector2", Kind::Vector2),
        ("point3", Kind::Point3),
        ("vector3", Kind::Vector3),
        ("normal3", Kind::Normal),
        ("normal", Kind::Normal),
        ("rgb", Kind::Rgb),
        ("spectrum", Kind::Spectrum),
        ("blackbody", Kind::Blackbody),
        ("bool", Kind::Bool),
        ("string", Kind::String),
        ("texture", Kind::Texture),
        ("point", Kind::Point3),
        ("point4", Kind::Float),
        ("vector", Kind::Vector3),
        ("color", Kind::Rgb),
        ("int", Kind::Integer),
    ];

    /// What messages call it.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, kind)| *kind == self).map_or("", |(name, _)| name)
    }

    /// How many numbers one value has.
    fn arity(self) -> usize {
        match self {
            Kind::Point2 | Kind::Vector2 => 2,
            Kind::Point3 | Kind::Vector3 | Kind::Normal | Kind::Rgb => 3,
            _ => 1,
        }
    }
}

/// The values of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    Integers(Vec<i32>),
    Floats(Vec<f32>),
    Bools(Vec<bool>),
    Strings(Vec<String>),
}

impl Values {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Integers(values) => values.len(),
            Self::Floats(values) => values.len(),
            Self::Bools(values) => values.len(),
            Self::Strings(values) => values.len(),
        }
    }
}

/// A parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    pub kind: Kind,
    pub name: String,
    pub values: Values,
    /// The declaration, quotes included.
    pub bytes: Range<usize>,
}

impl<'t> Scanner<'t> {
    /// The parameters that come next.
    pub fn parameters(&mut self) -> Result<Vec<Parameter>> {
        let mut list = Vec::new();
        while self.peek() == Some(b'"') {
            list.push(self.parameter()?);
        }
        Ok(list)
    }

    fn parameter(&mut self) -> Result<Parameter> {
        let (declaration, bytes) = self.string()?;
        let wrong = |message: String| SyntaxError { message, bytes: bytes.clone() };
        let mut parts = declaration.split_whitespace();
        let (Some(type_name), Some(name), None) = (parts.next(), parts.next(), parts.next()) else {
            let declaration = shown(&declaration);
            return Err(wrong(format!("\"{declaration}\" is not the type and the name of a parameter")));
        };
        let Some(&(_, kind)) = Kind::NAMES.iter().find(|(known, _)| *known == type_name) else {
            return Err(wrong(format!("\"{}\" is not a type of parameters", shown(type_name))));
        };
        let values = self.values(kind)?;
        if let Values::Floats(floats) = &values
            && floats.len() % kind.arity() != 0
        {
            let (arity, found) = (kind.arity(), floats.len());
            return Err(wrong(format!("\"{}\" needs {arity} numbers a value, not {found}", shown(name))));
        }
        Ok(Parameter { kind, name: name.to_owned(), values, bytes })
    }

    fn values(&mut self, kind: Kind) -> Result<Values> {
        match kind {
            Kind::Integer => self.integers().map(Values::Integers),
            Kind::Bool => self.bools().map(Values::Bools),
            Kind::String | Kind::Texture => self.strings().map(Values::Strings),
            Kind::Spectrum if self.is_string_next() => self.strings().map(Values::Strings),
            _ => self.floats().map(Values::Floats),
        }
    }

    fn strings(&mut self) -> Result<Vec<String>> {
        let bracket = self.skip(b'[');
        let mut values = Vec::new();
        loop {
            if bracket && self.skip(b']') {
                return Ok(values);
            }
            values.push(self.string()?.0.into_owned());
            if !bracket {
                return Ok(values);
            }
        }
    }

    /// `true` or `false`, also in quotes as in older files.
    fn bools(&mut self) -> Result<Vec<bool>> {
        let bracket = self.skip(b'[');
        let mut values = Vec::new();
        loop {
            if bracket && self.skip(b']') {
                return Ok(values);
            }
            let is_quoted = self.peek() == Some(b'"');
            let (word, bytes) = if is_quoted {
                self.string()?
            } else {
                let (word, bytes) = self.word();
                (word.into(), bytes)
            };
            values.push(match &*word {
                "true" => true,
                "false" => false,
                "" if !is_quoted => return Err(self.unexpected("true or false")),
                other => {
                    let message = format!("\"{}\" is neither true nor false", shown(other));
                    return Err(SyntaxError { message, bytes });
                }
            });
            if !bracket {
                return Ok(values);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> Result<Vec<Parameter>> {
        Scanner::new(&mut super::super::Text::of(text.into())).parameters()
    }

    #[test]
    fn every_type() {
        let text = "\"integer a\" 1 \"float b\" [ 1 2 ] \"bool c\" \"true\" \"bool d\" [false true] \
                    \"spectrum e\" \"metal-Ag-eta\" \"spectrum f\" [ 400 1 700 2 ] \"string g\" [\"x\" \"y\"] \
                    \"point2 h\" [ 1 2 3 4 ] \"texture i\" \"t\" \"blackbody j\" 6500 WorldBegin";
        let list = all(text).unwrap();
        let expected = [
            Values::Integers(vec![1]),
            Values::Floats(vec![1.0, 2.0]),
            Values::Bools(vec![true]),
            Values::Bools(vec![false, true]),
            Values::Strings(vec!["metal-Ag-eta".into()]),
            Values::Floats(vec![400.0, 1.0, 700.0, 2.0]),
            Values::Strings(vec!["x".into(), "y".into()]),
            Values::Floats(vec![1.0, 2.0, 3.0, 4.0]),
            Values::Strings(vec!["t".into()]),
            Values::Floats(vec![6500.0]),
        ];
        assert_eq!(list.len(), expected.len());
        for (parameter, values) in list.iter().zip(expected) {
            assert_eq!(parameter.values, values, "{parameter:?}");
        }
        assert_eq!(list[0].bytes, 0..11);
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (text, part) in [
            ("\"integer\" 1", "type and the name"),
            ("\"flaot a\" 1", "not a type"),
            ("\"rgb a\" [1 2]", "needs 3 numbers"),
            ("\"bool a\" yes", "neither true nor false"),
            ("\"float a\"", "the file ends"),
            ("\"string a\" 3", "a string in quotes"),
            ("\"float a\" [1 2", "the file ends"),
            ("\"bool a\" [", "the file ends"),
        ] {
            let message = all(text).unwrap_err().message;
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
