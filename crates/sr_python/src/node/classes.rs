//! Which class a type belongs to: files say it by the element's name, dictionaries do not.

/// (class, its types), spelt as in Mitsuba 3.
const CLASSES: &[(&str, &[&str])] = &[
    (
        "bsdf",
        &[
            "diffuse",
            "dielectric",
            "thindielectric",
            "roughdielectric",
            "conductor",
            "roughconductor",
            "plastic",
            "roughplastic",
            "twosided",
            "mask",
            "coateddiffuse",
            "coatedconductor",
            "eon",
            "roughdiffuse",
            "diffusetransmission",
            "principled",
            "principledthin",
            "metallicroughness",
            "blendbsdf",
            "bumpmap",
            "normalmap",
            "null",
        ],
    ),
    (
        "shape",
        &[
            "mesh",
            "obj",
            "ply",
            "serialized",
            "rectangle",
            "cube",
            "sphere",
            "disk",
            "shapegroup",
            "instance",
        ],
    ),
    ("emitter", &["area", "constant", "envmap", "point", "directional", "spot"]),
    ("sensor", &["perspective", "thinlens"]),
    ("texture", &["bitmap", "checkerboard", "d65"]),
    ("integrator", &["path", "direct"]),
    ("film", &["hdrfilm"]),
    ("sampler", &["independent", "stratified", "multijitter", "orthogonal", "ldsampler"]),
    ("rfilter", &["box", "tent", "gaussian"]),
];

/// The class of a type.
pub fn of(kind: &str) -> Option<&'static str> {
    CLASSES.iter().find(|(_, kinds)| kinds.contains(&kind)).map(|&(class, _)| class)
}

/// Every type.
pub fn kinds() -> impl Iterator<Item = &'static str> {
    CLASSES.iter().flat_map(|(_, kinds)| kinds.iter().copied())
}
