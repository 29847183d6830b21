//! Diagnostics as text: with the lines they speak of, or one line each.

use codespan_reporting::diagnostic::{Diagnostic as Report, Label, LabelStyle, Severity as Level};
use codespan_reporting::files::SimpleFiles;
use codespan_reporting::term::{self, Config, termcolor};

use crate::diagnostic::{Diagnostic, Diagnostics, Severity, Span};

/// More than this many are not shown one by one.
const MAX_SHOWN: usize = 100;
/// Lines longer than this, in bytes, are not quoted.
const MAX_LINE: usize = 400;

impl Diagnostics {
    /// Every diagnostic with the source lines it speaks of, its hint and its consequence; `color` adds ANSI
    /// escapes. After the first hundred only a count follows.
    pub fn render(&self, color: bool) -> String {
        let mut files = SimpleFiles::new();
        for index in 0..self.sources.len() {
            let (name, text) = self.sources.get(crate::SourceId(u32::try_from(index).unwrap_or(u32::MAX)));
            files.add(name, text);
        }
        let mut buffer = if color { termcolor::Buffer::ansi() } else { termcolor::Buffer::no_color() };
        let config = Config::default();
        let mut text = String::new();
        for diagnostic in self.list.iter().take(MAX_SHOWN) {
            buffer.clear();
            match term::emit_to_write_style(&mut buffer, &config, &files, &self.report(diagnostic)) {
                Ok(()) => text.push_str(&String::from_utf8_lossy(buffer.as_slice())),
                Err(_) => {
                    text.push_str(&self.one_line(diagnostic));
                    text.push('\n');
                }
            }
        }
        if self.list.len() > MAX_SHOWN {
            text.push_str(&format!("… and {} more\n", self.list.len() - MAX_SHOWN));
        }
        text
    }

    /// `file:line:column: error[code]: message; consequence`, for logs and editors.
    pub fn one_line(&self, diagnostic: &Diagnostic) -> String {
        let Diagnostic { severity, code, message, span, hint, consequence } = diagnostic;
        let mut line = String::new();
        let (name, _) = self.sources.get(span.source);
        if self.has_place(span) {
            let (row, column) = self.sources.line_column(span);
            line.push_str(&format!("{name}:{row}:{column}: "));
        } else if !name.is_empty() {
            line.push_str(&format!("{name}: "));
        }
        line.push_str(&format!("{severity}[{code}]: {message}"));
        for part in [hint, consequence].into_iter().flatten() {
            line.push_str("; ");
            line.push_str(part);
        }
        line
    }

    /// An empty span at the very start says "the file as a whole".
    fn has_place(&self, span: &Span) -> bool {
        let text = self.sources.get(span.source).1;
        span.bytes.end > 0
            && span.bytes.start <= span.bytes.end
            && span.bytes.end <= text.len()
            && text.is_char_boundary(span.bytes.start)
            && text.is_char_boundary(span.bytes.end)
    }

    fn report(&self, diagnostic: &Diagnostic) -> Report<usize> {
        let level = match diagnostic.severity {
            Severity::Note => Level::Note,
            Severity::Warning => Level::Warning,
            Severity::Error => Level::Error,
        };
        let span = &diagnostic.span;
        let (name, text) = self.sources.get(span.source);
        let quotable = self.has_place(span) && line_length(text, span.bytes.start) <= MAX_LINE;
        let mut notes = Vec::new();
        let mut labels = Vec::new();
        if quotable {
            let range = span.bytes.start..first_line_end(text, span);
            labels.push(Label {
                style: LabelStyle::Primary,
                file_id: span.source.0 as usize,
                range,
                message: diagnostic.hint.clone().unwrap_or_default(),
            });
        } else {
            if self.has_place(span) {
                let (line, column) = self.sources.line_column(span);
                notes.push(format!("in {name}, line {line}, column {column}"));
            } else if !name.is_empty() {
                notes.push(format!("in {name}"));
            }
            notes.extend(diagnostic.hint.clone());
        }
        notes.extend(diagnostic.consequence.clone());
        Report::new(level)
            .with_code(diagnostic.code)
            .with_message(&diagnostic.message)
            .with_labels(labels)
            .with_notes(notes)
    }
}

/// The end of the span, or of its first line: an element of a thousand lines is shown by its first.
fn first_line_end(text: &str, span: &Span) -> usize {
    text[span.bytes.clone()].find('\n').map_or(span.bytes.end, |at| span.bytes.start + at)
}

fn line_length(text: &str, at: usize) -> usize {
    let start = text[..at].rfind('\n').map_or(0, |i| i + 1);
    let end = text[at..].find('\n').map_or(text.len(), |i| at + i);
    end - start
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Diagnostics {
        let mut all = Diagnostics::default();
        let text = "<scene>\n  <float name=\"rougness\" value=\"0.15\"/>\n</scene>\n";
        let source = all.sources.add("kitchen.xml", text);
        let start = text.find("rougness").unwrap();
        let span = Span { source, bytes: start..start + 8 };
        all.push(
            Diagnostic::warning(
                "mitsuba::unknown-property",
                &span,
                "bsdf \"conductor\" has no property \"rougness\"",
            )
            .guess("rougness", ["alpha", "roughness"])
            .consequence("it is ignored"),
        );
        all
    }

    #[test]
    fn a_report_shows_place_guess_and_consequence() {
        let text = example().render(false);
        let expected = "\
warning[mitsuba::unknown-property]: bsdf \"conductor\" has no property \"rougness\"
  ┌─ kitchen.xml:2:16
  │
2 │   <float name=\"rougness\" value=\"0.15\"/>
  │                ^^^^^^^^ did you mean \"roughness\"?
  │
  = it is ignored

";
        assert_eq!(text, expected);
    }

    #[test]
    fn color_adds_escapes_only() {
        let all = example();
        let colored = all.render(true);
        assert!(colored.contains("\u{1b}["));
        assert!(!all.render(false).contains('\u{1b}'));
    }

    #[test]
    fn one_line_has_file_line_and_column() {
        let all = example();
        assert_eq!(
            all.one_line(&all.list[0]),
            "kitchen.xml:2:16: warning[mitsuba::unknown-property]: bsdf \"conductor\" has no property \"rougness\"; \
             did you mean \"roughness\"?; it is ignored"
        );
    }

    #[test]
    fn spans_outside_the_text_or_inside_a_character_do_not_panic() {
        let mut all = Diagnostics::default();
        let source = all.sources.add("a.xml", "é");
        for bytes in [0..0, 1..1, 1..2, 0..9, 7..9, 0..2] {
            all.push(Diagnostic::error("test::span", &Span { source, bytes }, "message"));
        }
        all.push(Diagnostic::error(
            "test::span",
            &Span { source: crate::SourceId(9), bytes: 0..1 },
            "message",
        ));
        assert_eq!(all.render(false).matches("test::span").count(), 7);
    }

    #[test]
    fn very_long_lines_are_not_quoted() {
        let mut all = Diagnostics::default();
        let source = all.sources.add("a.xml", "x".repeat(10_000));
        all.push(Diagnostic::error("test::long", &Span { source, bytes: 5000..5001 }, "message"));
        assert!(all.render(false).len() < 200);
    }
}
