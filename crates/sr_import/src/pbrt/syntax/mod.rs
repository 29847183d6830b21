//! pbrt's text: words, strings, numbers, lists of parameters. Decides no meaning.
//!
//! - `text`: a file's bytes, lists of numbers apart from the rest.
//! - `scanner`: bytes to words, strings and numbers; numbers go straight into arrays.
//! - `parameters`: `"type name" value` pairs.

mod parameters;
mod scanner;
mod text;

use std::ops::Range;

pub use parameters::{Kind, Parameter, Values};
pub use scanner::Scanner;
pub use text::Text;

/// What is wrong with a text, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct SyntaxError {
    /// One sentence.
    pub message: String,
    /// Where.
    pub bytes: Range<usize>,
}

/// A finite number.
fn float(word: &str) -> Option<f32> {
    word.parse::<f32>().ok().filter(|v| v.is_finite())
}

/// A whole number; "3.0" is one, too.
fn integer(word: &str) -> Option<i32> {
    let as_float = || word.parse::<f64>().ok().filter(|v| v.fract() == 0.0 && v.abs() < 2e9);
    word.parse::<i32>().ok().or_else(|| as_float().map(|v| v as i32))
}

/// A result of reading text.
pub type Result<T> = std::result::Result<T, SyntaxError>;
