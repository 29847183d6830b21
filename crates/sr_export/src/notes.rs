//! What an export does not say as the description has it.

use sr_scene::{Diagnostic, Span};

/// The list as it grows: what is the same is said once, with how often.
#[derive(Default)]
pub struct Notes {
    found: Vec<(Diagnostic, usize)>,
}

impl Notes {
    /// Something that is written otherwise.
    pub fn push(
        &mut self,
        code: &'static str,
        span: &Span,
        message: impl Into<String>,
        consequence: impl Into<String>,
    ) {
        let new = Diagnostic::warning(code, span, message).consequence(consequence);
        let is_same = |(old, _): &&mut (Diagnostic, usize)| {
            old.code == new.code && old.message == new.message && old.consequence == new.consequence
        };
        match self.found.iter_mut().find(is_same) {
            Some((_, count)) => *count += 1,
            None => self.found.push((new, 1)),
        }
    }

    /// All of them, in the order in which they were found.
    pub fn finish(self) -> Vec<Diagnostic> {
        let counted = |(mut note, count): (Diagnostic, usize)| {
            if count > 1 {
                note.message.push_str(&format!(" ({count} times)"));
            }
            note
        };
        self.found.into_iter().map(counted).collect()
    }
}
