//! What a file says about itself: how its image was made.

/// One value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Words.
    Text(String),
    /// A count or a seed.
    Integer(i64),
    /// A measurement.
    Real(f64),
}

/// Named values, in the order they were added. Names are written with the prefix `steradian.`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata {
    entries: Vec<(String, Value)>,
}

/// Who wrote the file.
pub(super) const SOFTWARE: &str = concat!("Steradian ", env!("CARGO_PKG_VERSION"));

impl Metadata {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a value; a later one of the same name replaces an earlier one.
    pub fn set(&mut self, name: &str, value: Value) {
        match self.entries.iter_mut().find(|(n, _)| n == name) {
            Some((_, old)) => *old = value,
            None => self.entries.push((name.to_owned(), value)),
        }
    }

    /// Full names and values.
    pub(super) fn entries(&self) -> impl Iterator<Item = (String, &Value)> {
        self.entries.iter().map(|(name, value)| (format!("steradian.{name}"), value))
    }
}

impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Value::Text(text) => f.write_str(text),
            Value::Integer(integer) => integer.fmt(f),
            Value::Real(real) => real.fmt(f),
        }
    }
}
