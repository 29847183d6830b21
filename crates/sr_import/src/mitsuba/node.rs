//! The tree between a front end and the lowering: objects with typed properties, each with its place.
//!
//! In: XML or a Python dict. Out: what [`crate::from_node`] reads. Names keep the spelling of
//! their source; both generations (`toWorld`, `to_world`) are understood when they are looked up.

use std::sync::Arc;

use glam::{DMat4, DVec3};
use sr_scene::{Image, MeshDesc, Span};

/// An object: a BSDF, a shape, a film, …
#[derive(Clone, Debug)]
pub struct Node {
    /// What it is: `scene`, `bsdf`, `texture`, `shape`, `emitter`, `sensor`, `film`, `sampler`, `rfilter`, …
    pub class: String,
    /// Its plugin, such as `roughconductor`.
    pub kind: String,
    /// What references call it.
    pub id: Option<String>,
    /// What references may call it as well.
    pub other_names: Vec<OtherName>,
    /// Which property of its parent it is, such as `reflectance`.
    pub name: Option<String>,
    /// Its values.
    pub properties: Vec<Property>,
    /// Its nested objects and references, in order.
    pub children: Vec<Child>,
    /// Where it is described.
    pub span: Span,
}

/// A second name of an object.
#[derive(Clone, Debug)]
pub struct OtherName {
    /// The name.
    pub id: String,
    /// Where it is given.
    pub span: Span,
}

/// A named value.
#[derive(Clone, Debug)]
pub struct Property {
    /// The name as it was written.
    pub name: String,
    /// The value.
    pub value: Value,
    /// Where it is written.
    pub span: Span,
}

/// A typed value.
#[derive(Clone, Debug)]
pub enum Value {
    /// A number.
    Float(f64),
    /// A whole number.
    Integer(i64),
    /// True or false.
    Boolean(bool),
    /// Text.
    String(String),
    /// A point or a vector.
    Vector(DVec3),
    /// Linear RGB.
    Rgb(DVec3),
    /// A spectrum.
    Spectrum(SpectrumValue),
    /// An affine transform.
    Transform(DMat4),
    /// A mesh in memory. Its v counts from the top row of an image.
    Mesh(Arc<MeshDesc>),
    /// An image in memory.
    Image(Arc<Image>),
}

/// A spectrum as files write it.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumValue {
    /// The same for every wavelength.
    Uniform(f64),
    /// (wavelength in nm, value), in increasing order.
    Samples(Vec<(f64, f64)>),
    /// A text file of such pairs.
    File(String),
    /// Planck's law.
    Blackbody {
        /// In kelvin.
        temperature: f64,
        /// A factor.
        scale: f64,
    },
}

/// A nested object, or the name of one.
#[derive(Clone, Debug)]
pub enum Child {
    /// The object itself.
    Node(Node),
    /// An object that is described elsewhere.
    Reference(Reference),
}

/// The use of an object by its id.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The object's id.
    pub id: String,
    /// Which property of the parent it is.
    pub name: Option<String>,
    /// Where it is written.
    pub span: Span,
}

impl Node {
    /// An object without properties.
    pub fn new(class: impl Into<String>, kind: impl Into<String>, span: Span) -> Self {
        Self {
            class: class.into(),
            kind: kind.into(),
            id: None,
            other_names: Vec::new(),
            name: None,
            properties: Vec::new(),
            children: Vec::new(),
            span,
        }
    }

    /// `bsdf "diffuse"`, for messages.
    pub fn title(&self) -> String {
        if self.kind.is_empty() { self.class.clone() } else { format!("{} \"{}\"", self.class, self.kind) }
    }
}

impl Value {
    /// What it is, for messages.
    pub fn type_name(&self) -> &'static str {
        match self {
            Value::Float(_) => "a float",
            Value::Integer(_) => "an integer",
            Value::Boolean(_) => "a boolean",
            Value::String(_) => "a string",
            Value::Vector(_) => "a vector",
            Value::Rgb(_) => "an RGB color",
            Value::Spectrum(_) => "a spectrum",
            Value::Transform(_) => "a transform",
            Value::Mesh(_) => "a mesh",
            Value::Image(_) => "an image",
        }
    }
}

/// The spelling of today for a name of any generation: `toWorld` → `to_world`, `intIOR` → `int_ior`.
pub fn canonical_name(name: &str) -> String {
    let mut out = String::with_capacity(name.len() + 4);
    let mut after_lower = false;
    for c in name.chars() {
        if c.is_ascii_uppercase() && after_lower {
            out.push('_');
        }
        after_lower = c.is_ascii_lowercase() || c.is_ascii_digit();
        out.push(c.to_ascii_lowercase());
    }
    out
}

#[cfg(test)]
mod tests {
    use super::canonical_name;

    #[test]
    fn both_generations_of_names_meet() {
        for (old, new) in [
            ("toWorld", "to_world"),
            ("intIOR", "int_ior"),
            ("diffuseReflectance", "diffuse_reflectance"),
            ("maxSmoothAngle", "max_smooth_angle"),
            ("color0", "color0"),
            ("to_uv", "to_uv"),
            ("lookAt", "look_at"),
        ] {
            assert_eq!(canonical_name(old), new);
        }
    }
}
