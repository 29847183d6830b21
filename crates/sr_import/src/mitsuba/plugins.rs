//! The plugins that are read, by class: files say the class by an element's name, dictionaries do not.

/// (class, its types), spelt as in Mitsuba 3; of two classes with one name, a dictionary means the first.
const PLUGINS: &[(&str, &[&str])] = &[
    (
        "bsdf",
        &[
            "diffuse",
            "dielectric",
            "thindielectric",
            "conductor",
            "roughconductor",
            "roughdielectric",
            "plastic",
            "roughplastic",
            "coateddiffuse",
            "coatedconductor",
            "eon",
            "roughdiffuse",
            "diffusetransmission",
            "principled",
            "principledthin",
            "metallicroughness",
            "twosided",
            "mask",
            "blendbsdf",
            "bumpmap",
            "normalmap",
            "null",
        ],
    ),
    (
        "shape",
        &[
            "obj",
            "ply",
            "serialized",
            "mesh",
            "rectangle",
            "cube",
            "sphere",
            "disk",
            "cylinder",
            "bilinearpatch",
            "shapegroup",
            "instance",
        ],
    ),
    (
        "emitter",
        &[
            "area",
            "constant",
            "envmap",
            "point",
            "directional",
            "spot",
            "projector",
            "goniometric",
            "ies",
            "sunsky",
            "sky",
            "sun",
        ],
    ),
    ("sensor", &["perspective", "thinlens", "orthographic", "spherical"]),
    (
        "texture",
        &[
            "bitmap",
            "checkerboard",
            "scale",
            "mix",
            "mesh_attribute",
            "uniform",
            "constant",
            "rgb",
            "srgb",
            "d65",
            "blackbody",
            "regular",
            "irregular",
        ],
    ),
    ("integrator", &["path", "direct"]),
    ("film", &["hdrfilm"]),
    ("sampler", &["independent", "stratified", "multijitter", "orthogonal", "ldsampler"]),
    ("rfilter", &["box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos", "blackmanharris"]),
];

/// The types of a class.
pub fn of(class: &str) -> &'static [&'static str] {
    PLUGINS.iter().find(|(name, _)| *name == class).map_or(&[], |(_, kinds)| kinds)
}

/// The class of a type.
pub fn class_of(kind: &str) -> Option<&'static str> {
    PLUGINS.iter().find(|(_, kinds)| kinds.contains(&kind)).map(|&(class, _)| class)
}

/// Every type.
pub fn all() -> impl Iterator<Item = &'static str> {
    PLUGINS.iter().flat_map(|(_, kinds)| kinds.iter().copied())
}
