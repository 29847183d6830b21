//! Text to a tree of elements, or one diagnostic that says why it is none.

use roxmltree::{Document, Error, ParsingOptions};
use sr_scene::{Diagnostic, SourceId, Span};

use crate::limits::Limit;

/// Parses a text. Document type definitions, and with them entities, are refused.
pub fn parse(source: SourceId, text: &str, limit: Limit) -> Result<Document<'_>, Diagnostic> {
    let nodes_limit = u32::try_from(limit.most).unwrap_or(u32::MAX);
    let options = ParsingOptions { allow_dtd: false, nodes_limit, entity_resolver: None };
    Document::parse_with_options(text, options).map_err(|error| syntax_error(source, text, &error, limit))
}

fn syntax_error(source: SourceId, text: &str, error: &Error, limit: Limit) -> Diagnostic {
    let whole = Span { source, bytes: 0..0 };
    match error {
        Error::UnexpectedEndOfStream | Error::UnclosedRootNode => truncated(source, text),
        Error::NoRootNode => Diagnostic::error("xml::syntax", &whole, "this is not XML: there is no element"),
        Error::DtdDetected => {
            let message = "a document type definition (<!DOCTYPE …>) is not accepted";
            Diagnostic::error("xml::dtd", &whole, message).consequence("remove it: scenes do not need one")
        }
        Error::NodesLimitReached | Error::AttributesLimitReached | Error::NamespacesLimitReached => {
            let message = limit.refusal(format!("more than {limit} XML nodes"));
            Diagnostic::error("xml::too-large", &whole, message)
        }
        other => {
            let position = other.pos();
            let start = offset(text, position.row as usize, position.col as usize);
            // The end of the text is where a cut shows first.
            if text[start..].trim().is_empty() {
                return truncated(source, text);
            }
            let bytes = start..text[start..].chars().next().map_or(start, |c| start + c.len_utf8());
            let message = format!("this is not well-formed XML: {other}");
            Diagnostic::error("xml::syntax", &Span { source, bytes }, message)
        }
    }
}

fn truncated(source: SourceId, text: &str) -> Diagnostic {
    let last_character = text.char_indices().last().map_or(0, |(at, _)| at);
    let end = Span { source, bytes: last_character..text.len() };
    Diagnostic::error("xml::truncated", &end, "the file ends in the middle of an element: it is truncated")
}

/// The byte at a one-based line and column (in characters).
fn offset(text: &str, row: usize, column: usize) -> usize {
    let line_start =
        if row <= 1 { 0 } else { text.match_indices('\n').nth(row - 2).map_or(text.len(), |(at, _)| at + 1) };
    text[line_start..]
        .char_indices()
        .nth(column.saturating_sub(1))
        .map_or(text.len(), |(at, _)| line_start + at)
}
