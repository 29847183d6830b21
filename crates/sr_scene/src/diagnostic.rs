//! Diagnostics as data: what is wrong, where, a guess, and the consequence.

use std::fmt;
use std::ops::Range;

use crate::places::Places;

/// A source text: a file, or a Python object's path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, PartialOrd, Ord)]
pub struct SourceId(pub u32);

/// A range of bytes in a source.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Span {
    /// The source.
    pub source: SourceId,
    /// The bytes.
    pub bytes: Range<usize>,
}

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The scene is rendered as the file asks, as far as one renderer can agree with another.
    Note,
    /// The scene is rendered, but not quite as the file asks.
    Warning,
    /// There is no scene.
    Error,
}

/// What becomes of what a note or a warning is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Something else, or nearly the same, is shown instead.
    Approximated,
    /// It is as if the file did not ask for it.
    Ignored,
}

/// One thing to tell the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// How bad.
    pub severity: Severity,
    /// A stable name, such as `mitsuba::unknown-property`.
    pub code: &'static str,
    /// One sentence.
    pub message: String,
    /// Where.
    pub span: Span,
    /// A guess, shown at the place: `did you mean "roughness"?`
    pub hint: Option<String>,
    /// What happens instead. Its words tell the [`Effect`].
    pub consequence: Option<String>,
}

/// In the consequence of a warning that something is ignored.
const IGNORED: &[&str] = &[
    "ignored",
    "left out",
    "without",
    "not used",
    "not read",
    "not shown",
    "not emit",
    "not rendered",
    "cannot be read",
    "no effect",
    "no file is looked for",
    "no color of a vertex",
    "no portal",
    "is lost",
    "lights nothing",
    "nothing is shown",
    "nothing is seen",
    "nothing is blurred",
    "shuts nothing out",
    "as empty space",
    "stay as they are",
    "stays as it is",
    "the rest stays",
    "light is black",
];

impl Diagnostic {
    /// An error: there will be no scene.
    pub fn error(code: &'static str, span: &Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, code, span, message.into())
    }

    /// A warning: the scene is rendered, but not quite as asked.
    pub fn warning(code: &'static str, span: &Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, code, span, message.into())
    }

    /// A note: the scene is rendered as asked, but its pictures differ from those of the renderer that it was made for.
    pub fn note(code: &'static str, span: &Span, message: impl Into<String>) -> Self {
        Self::new(Severity::Note, code, span, message.into())
    }

    /// What becomes of what a note or a warning is about, by its consequence; `None` for an error.
    pub fn effect(&self) -> Option<Effect> {
        let consequence = self.consequence.as_deref().unwrap_or("");
        let is_ignored = IGNORED.iter().any(|words| consequence.contains(words));
        match self.severity {
            Severity::Error => None,
            Severity::Warning if is_ignored => Some(Effect::Ignored),
            Severity::Note | Severity::Warning => Some(Effect::Approximated),
        }
    }

    fn new(severity: Severity, code: &'static str, span: &Span, message: String) -> Self {
        Self { severity, code, message, span: span.clone(), hint: None, consequence: None }
    }

    /// Adds what is shown at the place.
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// Adds the name among `candidates` that `name` was probably meant to be, if one is close.
    pub fn guess<'a>(mut self, name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Self {
        // The very name is known, but not as what it is used for: no slip of the keyboard.
        if let Some(best) = nearest_name(name, candidates).filter(|&best| best != name) {
            self.hint = Some(format!("did you mean \"{best}\"?"));
        }
        self
    }

    /// Adds what happens instead.
    pub fn consequence(mut self, consequence: impl Into<String>) -> Self {
        self.consequence = Some(consequence.into());
        self
    }
}

/// The candidate nearest to `name`, unless all are too far to be a slip of the keyboard.
fn nearest_name<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // Names of hundreds of characters are not typing errors; comparing them costs their product.
    if name.len() > 64 {
        return None;
    }
    candidates
        .into_iter()
        .filter(|c| c.len() <= 64)
        .map(|c| (strsim::normalized_damerau_levenshtein(&name.to_lowercase(), &c.to_lowercase()), c))
        .filter(|&(score, _)| score >= 0.6)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, c)| c)
}

/// The texts that spans point into.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    files: Vec<Source>,
}

#[derive(Clone, Debug)]
struct Source {
    name: String,
    text: String,
    places: Places,
}

impl Sources {
    /// Adds a text under a name.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<String>) -> SourceId {
        let (name, text) = (name.into(), text.into());
        let places = Places::new(&text);
        self.files.push(Source { name, text, places });
        SourceId(u32::try_from(self.files.len() - 1).expect("fewer than 2³² sources"))
    }

    /// Gives a source another text, usually one that was added empty: so that a long text can be read and then given
    /// away, not copied.
    pub fn set_text(&mut self, id: SourceId, text: impl Into<String>) {
        if let Some(source) = self.files.get_mut(id.0 as usize) {
            source.text = text.into();
            source.places = Places::new(&source.text);
        }
    }

    /// The name and the text of a source; empty for one that is not known.
    pub fn get(&self, id: SourceId) -> (&str, &str) {
        self.files.get(id.0 as usize).map_or(("", ""), |source| (&source.name, &source.text))
    }

    /// The number of sources.
    pub fn len(&self) -> usize {
        self.files.len()
    }

    /// Is there no source?
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// One-based line and column of the start of a span. Its cost does not grow with the text.
    pub fn line_column(&self, span: &Span) -> (usize, usize) {
        self.files
            .get(span.source.0 as usize)
            .map_or((1, 1), |source| source.places.line_column(&source.text, span.bytes.start))
    }
}

/// Everything an import has to say, with the sources it speaks about.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    /// The texts.
    pub sources: Sources,
    /// In the order they were found.
    pub list: Vec<Diagnostic>,
}

impl Diagnostics {
    /// Adds one.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.list.push(diagnostic);
    }

    /// Is there an error among them?
    pub fn has_errors(&self) -> bool {
        self.list.iter().any(|d| d.severity == Severity::Error)
    }
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Severity::Note => "note",
            Severity::Warning => "warning",
            Severity::Error => "error",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn consequences_tell_approximations_from_what_is_ignored() {
        let effect = |consequence: &str| {
            Diagnostic::warning("a::b", &Span::default(), "c").consequence(consequence).effect()
        };
        for ignored in
            ["it is ignored", "they are left out", "the rest stays", "it is rendered without its emitter"]
        {
            assert_eq!(effect(ignored), Some(Effect::Ignored), "{ignored}");
        }
        for shown in ["a diffuse one is used", "its mean is used", "1.5 is used", "it is lit by both, added"]
        {
            assert_eq!(effect(shown), Some(Effect::Approximated), "{shown}");
        }
        let said = |new: fn(&'static str, &Span, &'static str) -> Diagnostic| {
            new("a::b", &Span::default(), "c").effect()
        };
        assert_eq!((said(Diagnostic::warning), said(Diagnostic::error)), (Some(Effect::Approximated), None));
    }

    #[test]
    fn texts_can_be_given_later() {
        let mut sources = Sources::default();
        let source = sources.add("a", "");
        sources.set_text(source, "1\n23");
        assert_eq!(sources.get(source), ("a", "1\n23"));
        assert_eq!(sources.line_column(&Span { source, bytes: 3..4 }), (2, 2));
        sources.set_text(SourceId(7), "nobody's");
    }

    #[test]
    fn guesses_are_names_that_were_not_given() {
        let hint = |name: &str| {
            Diagnostic::warning("test", &Span::default(), "?").guess(name, ["bitmap", "filename"]).hint
        };
        assert_eq!(hint("bitmpa").as_deref(), Some("did you mean \"bitmap\"?"));
        assert_eq!(hint("filenam").as_deref(), Some("did you mean \"filename\"?"));
        assert_eq!(hint("bitmap"), None);
        assert_eq!(hint("roughness"), None);
    }
}
