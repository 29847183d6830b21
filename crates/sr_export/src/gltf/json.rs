//! JSON as it is written.

use std::fmt::Write;

/// A value.
#[derive(Clone, Debug)]
pub enum Json {
    Number(f32),
    Integer(usize),
    Text(String),
    Bool(bool),
    List(Vec<Json>),
    Object(Vec<(&'static str, Json)>),
}

impl Json {
    /// Numbers.
    pub fn numbers(values: &[f32]) -> Self {
        Self::List(values.iter().map(|v| Self::Number(*v)).collect())
    }

    /// A text.
    pub fn text(value: &str) -> Self {
        Self::Text(value.to_owned())
    }

    /// Indented by two for each level; lists of numbers on one line.
    pub fn write(&self, out: &mut String, depth: usize) {
        let indent = |out: &mut String, depth: usize| {
            out.push('\n');
            out.push_str(&"  ".repeat(depth));
        };
        match self {
            Self::Number(value) => out.push_str(&value.to_string()),
            Self::Integer(value) => out.push_str(&value.to_string()),
            Self::Text(value) => quoted(value, out),
            Self::Bool(value) => out.push_str(if *value { "true" } else { "false" }),
            Self::List(values) => {
                let is_flat = values.iter().all(|v| !matches!(v, Self::List(_) | Self::Object(_)));
                out.push('[');
                for (i, value) in values.iter().enumerate() {
                    out.push_str(if i > 0 { "," } else { "" });
                    match is_flat {
                        true => out.push_str(if i > 0 { " " } else { "" }),
                        false => indent(out, depth + 1),
                    }
                    value.write(out, depth + 1);
                }
                if !is_flat {
                    indent(out, depth);
                }
                out.push(']');
            }
            Self::Object(members) => {
                out.push('{');
                for (i, (name, value)) in members.iter().enumerate() {
                    out.push_str(if i > 0 { "," } else { "" });
                    indent(out, depth + 1);
                    quoted(name, out);
                    out.push_str(": ");
                    value.write(out, depth + 1);
                }
                if !members.is_empty() {
                    indent(out, depth);
                }
                out.push('}');
            }
        }
    }
}

fn quoted(value: &str, out: &mut String) {
    out.push('"');
    for c in value.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            // Writing to a string does not fail.
            c if (c as u32) < 0x20 => _ = write!(out, "\\u{:04x}", c as u32),
            c => out.push(c),
        }
    }
    out.push('"');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_escaped_and_numbers_on_one_line() {
        let value = Json::Object(vec![
            ("a", Json::text("\"\\\n")),
            ("b", Json::numbers(&[1.0, -0.5])),
            ("c", Json::List(vec![Json::Object(vec![])])),
        ]);
        let mut out = String::new();
        value.write(&mut out, 0);
        assert_eq!(out, "{\n  \"a\": \"\\\"\\\\\\u000a\",\n  \"b\": [1, -0.5],\n  \"c\": [\n    {}\n  ]\n}");
    }
}
