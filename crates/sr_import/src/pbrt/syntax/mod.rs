//! pbrt's text: words, strings, numbers, lists of parameters. Decides no meaning.
//!
//! - `scanner`: bytes to words, strings and numbers; numbers go straight into arrays.
//! - `parameters`: `"type name" value` pairs.

mod parameters;
mod scanner;

use std::ops::Range;

pub use parameters::{Kind, Parameter, Values};
pub use scanner::Scanner;

/// What is wrong with a text, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct SyntaxError {
    /// One sentence.
    pub message: String,
    /// Where.
    pub bytes: Range<usize>,
}

/// A result of reading text.
pub type Result<T> = std::result::Result<T, SyntaxError>;
