//! The elements there are, by name.

/// What an element is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The outermost element.
    Scene,
    /// An object with a plugin type.
    Object,
    /// A property of the object around it. A spectrum with a plugin type is an object all the same.
    Value(ValueKind),
    /// A property that is made of steps.
    Transform,
    /// An object that is described elsewhere.
    Reference,
    /// The content of another file.
    Include,
    /// The value of a parameter that nobody gave.
    Default,
    /// A directory to look for files in.
    Path,
    /// Another name of an object.
    Alias,
}

/// How the value of a property is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueKind {
    /// A number.
    Float,
    /// A whole number.
    Integer,
    /// `true` or `false`.
    Boolean,
    /// Text.
    String,
    /// Three numbers, by `x`, `y`, `z` or by `value`.
    Vector,
    /// Linear RGB, or sRGB in hexadecimal.
    Rgb,
    /// sRGB.
    Srgb,
    /// A number, pairs of wavelength and value, or a file of them.
    Spectrum,
    /// A temperature.
    Blackbody,
}

/// All of them; of two that are equally close, guesses prefer the first.
const ELEMENTS: &[(&str, Kind)] = &[
    ("scene", Kind::Scene),
    ("bsdf", Kind::Object),
    ("texture", Kind::Object),
    ("shape", Kind::Object),
    ("emitter", Kind::Object),
    ("sensor", Kind::Object),
    ("film", Kind::Object),
    ("sampler", Kind::Object),
    ("rfilter", Kind::Object),
    ("integrator", Kind::Object),
    ("medium", Kind::Object),
    ("phase", Kind::Object),
    ("volume", Kind::Object),
    ("subsurface", Kind::Object),
    ("spectrum", Kind::Value(ValueKind::Spectrum)),
    ("float", Kind::Value(ValueKind::Float)),
    ("integer", Kind::Value(ValueKind::Integer)),
    ("boolean", Kind::Value(ValueKind::Boolean)),
    ("string", Kind::Value(ValueKind::String)),
    ("point", Kind::Value(ValueKind::Vector)),
    ("vector", Kind::Value(ValueKind::Vector)),
    ("rgb", Kind::Value(ValueKind::Rgb)),
    ("srgb", Kind::Value(ValueKind::Srgb)),
    ("color", Kind::Value(ValueKind::Rgb)),
    ("blackbody", Kind::Value(ValueKind::Blackbody)),
    ("transform", Kind::Transform),
    ("ref", Kind::Reference),
    ("include", Kind::Include),
    ("default", Kind::Default),
    ("path", Kind::Path),
    ("alias", Kind::Alias),
];

/// What the element of a name is.
pub fn kind(tag: &str) -> Option<Kind> {
    ELEMENTS.iter().find(|(name, _)| *name == tag).map(|&(_, kind)| kind)
}

/// All names, for guesses.
pub fn names() -> impl Iterator<Item = &'static str> {
    ELEMENTS.iter().map(|&(name, _)| name)
}

/// Those that are no objects, whose plugins say what becomes of them.
pub fn names_without_plugins() -> impl Iterator<Item = &'static str> {
    ELEMENTS.iter().filter(|(_, kind)| *kind != Kind::Object).map(|&(name, _)| name)
}
