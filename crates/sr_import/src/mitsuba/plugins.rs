//! The plugins that Mitsuba has, by class, and what becomes of them here: for guesses at misspelt names, for what is
//! said, and for `docs/import.md`. Files say the class by an element's name, dictionaries do not.

use super::xml::names_without_plugins;
use crate::support::{self, Known, Support};
use Support::{Done, Near, Reported};

/// A class of plugins.
struct Class {
    name: &'static str,
    /// Mitsuba 3's.
    today: &'static Known,
    /// Those of Mitsuba 0.5 and 0.6 that are gone.
    old: &'static Known,
    /// Our own.
    own: &'static Known,
}

const STAND_IN: Support = Reported("a two-sided diffuse surface is shown instead");
const FIRST_INSIDE: Support = Reported("the first BSDF inside it is shown instead");
const ATTENUATES: Support = Near("half of the light passes: nothing is polarized");
const LEFT_OUT: Support = Reported("the shape is left out");
const OTHER_CAMERA: Support = Reported("a perspective camera at the same place is used");
const SAME_PATHS: Support = Near("paths are traced, which converges to the same");
const SAME_IMAGE: Support = Near("paths are traced, which gives the same image; nothing is differentiated");
const NO_MEDIA: Support = Near("media are not rendered: they are said where they are described");
const NO_MORE_OUTPUTS: Support =
    Near("the integrator inside it is used, and its further outputs are not made");
const SAMPLER: Support = Near("the number of samples is used; they are Sobol' points");
const EMPTY: Support = Reported("the inside of its medium is rendered as empty space");
const HALF: Support = Reported("the constant 0.5 is used instead, and nothing in it is read");

/// Of two classes with one name, a dictionary means the first.
const CLASSES: &[Class] = &[
    Class {
        name: "bsdf",
        today: &[
            ("diffuse", Done),
            ("dielectric", Done),
            ("thindielectric", Done),
            ("roughdielectric", Done),
            ("conductor", Done),
            ("roughconductor", Done),
            ("plastic", Done),
            ("roughplastic", Near("its roughness is constant")),
            ("principled", Done),
            ("principledthin", Done),
            ("twosided", Done),
            ("mask", Done),
            ("blendbsdf", Done),
            ("bumpmap", Done),
            ("normalmap", Done),
            ("null", Done),
            ("pplastic", Near("as roughplastic, which is 6 to 9 % brighter; nothing is polarized")),
            ("polarizer", ATTENUATES),
            ("circular", ATTENUATES),
            ("retarder", Near("all light passes: nothing is polarized")),
            ("hair", Done),
            ("measured", STAND_IN),
            ("measured_polarized", STAND_IN),
        ],
        old: &[
            ("roughdiffuse", Done),
            ("coating", FIRST_INSIDE),
            ("roughcoating", FIRST_INSIDE),
            ("mixturebsdf", FIRST_INSIDE),
            ("phong", STAND_IN),
            ("ward", STAND_IN),
            ("difftrans", STAND_IN),
            ("hk", STAND_IN),
            ("irawan", STAND_IN),
        ],
        own: &[
            ("coateddiffuse", Done),
            ("coatedconductor", Done),
            ("eon", Done),
            ("diffusetransmission", Done),
            ("metallicroughness", Done),
        ],
    },
    Class {
        name: "shape",
        today: &[
            ("obj", Done),
            ("ply", Near("of the attributes of vertices and faces, \"color\" is read")),
            ("serialized", Done),
            ("rectangle", Done),
            ("cube", Done),
            ("sphere", Done),
            ("disk", Done),
            ("cylinder", Done),
            ("shapegroup", Near("its shapes do not emit")),
            ("instance", Done),
            ("merge", Done),
            ("blender", LEFT_OUT),
            ("bsplinecurve", Done),
            ("linearcurve", Done),
            ("sdfgrid", LEFT_OUT),
            ("ellipsoids", LEFT_OUT),
            ("ellipsoidsmesh", LEFT_OUT),
        ],
        old: &[("hair", LEFT_OUT), ("heightfield", LEFT_OUT), ("deformable", LEFT_OUT)],
        own: &[("mesh", Done), ("bilinearpatch", Done)],
    },
    Class {
        name: "emitter",
        today: &[
            ("area", Done),
            ("constant", Done),
            ("envmap", Done),
            ("point", Done),
            ("directional", Done),
            ("spot", Done),
            ("projector", Done),
            ("sunsky", Done),
            ("directionalarea", Reported("the shape does not emit")),
            ("timed_sunsky", Reported("this light is left out, and the picture is darker")),
        ],
        old: &[
            ("sky", Done),
            ("sun", Done),
            ("collimated", Reported("this light is left out, and the picture is darker")),
        ],
        own: &[("goniometric", Done), ("ies", Done)],
    },
    Class {
        name: "sensor",
        today: &[
            ("perspective", Done),
            ("thinlens", Done),
            ("orthographic", Done),
            ("radiancemeter", OTHER_CAMERA),
            ("irradiancemeter", OTHER_CAMERA),
            ("distant", OTHER_CAMERA),
            ("batch", OTHER_CAMERA),
        ],
        old: &[("spherical", Done), ("telecentric", OTHER_CAMERA), ("fluencemeter", OTHER_CAMERA)],
        own: &[],
    },
    Class {
        name: "texture",
        today: &[
            ("bitmap", Near("all of its channels are used")),
            ("checkerboard", Done),
            ("mesh_attribute", Near("\"vertex_color\" and \"face_color\" alone")),
            ("volume", HALF),
            ("uniform", Done),
            ("srgb", Done),
            ("rawconstant", Done),
            ("d65", Near("white: light is RGB here")),
            ("blackbody", Near("its color: light is RGB here")),
            ("regular", Near("its color: light is RGB here")),
            ("irregular", Near("its color: light is RGB here")),
        ],
        old: &[("scale", Done)],
        own: &[("mix", Done), ("constant", Done), ("rgb", Done)],
    },
    Class {
        name: "integrator",
        today: &[
            ("path", Done),
            ("direct", Done),
            ("volpath", NO_MEDIA),
            ("volpathmis", NO_MEDIA),
            ("ptracer", SAME_PATHS),
            ("prb", SAME_IMAGE),
            ("prb_basic", SAME_IMAGE),
            ("prb_projective", SAME_IMAGE),
            ("direct_projective", SAME_IMAGE),
            ("prbvolpath", NO_MEDIA),
            ("moment", NO_MORE_OUTPUTS),
            ("aov", NO_MORE_OUTPUTS),
            ("stokes", NO_MORE_OUTPUTS),
            ("depth", Reported("the integrator \"path\" is used")),
            ("volprim_rf_basic", Reported("the integrator \"path\" is used")),
        ],
        old: &[
            ("bdpt", SAME_PATHS),
            ("pssmlt", SAME_PATHS),
            ("mlt", SAME_PATHS),
            ("erpt", SAME_PATHS),
            ("volpath_simple", NO_MEDIA),
        ],
        own: &[],
    },
    Class {
        name: "film",
        today: &[("hdrfilm", Done), ("specfilm", Reported("an RGB image of its size and filter is made"))],
        old: &[("ldrfilm", Done), ("mfilm", Reported("an RGB image of its size and filter is made"))],
        own: &[],
    },
    Class {
        name: "sampler",
        today: &[
            ("independent", SAMPLER),
            ("stratified", SAMPLER),
            ("multijitter", SAMPLER),
            ("orthogonal", SAMPLER),
            ("ldsampler", SAMPLER),
        ],
        old: &[("sobol", SAMPLER), ("halton", SAMPLER), ("hammersley", SAMPLER)],
        own: &[],
    },
    Class {
        name: "rfilter",
        today: &[
            ("box", Done),
            ("tent", Done),
            ("gaussian", Done),
            ("mitchell", Done),
            ("catmullrom", Done),
            ("lanczos", Done),
        ],
        old: &[],
        own: &[("blackmanharris", Done)],
    },
    Class { name: "medium", today: &[("homogeneous", EMPTY), ("heterogeneous", EMPTY)], old: &[], own: &[] },
    Class {
        name: "phase",
        today: &[
            ("isotropic", EMPTY),
            ("hg", EMPTY),
            ("rayleigh", EMPTY),
            ("sggx", EMPTY),
            ("tabphase", EMPTY),
            ("blendphase", EMPTY),
        ],
        old: &[],
        own: &[],
    },
    Class { name: "volume", today: &[("constvolume", EMPTY), ("gridvolume", EMPTY)], old: &[], own: &[] },
];

/// Textures and spectra are one class here: each may stand where the other may.
fn lists(class: &str) -> Option<[&'static Known; 3]> {
    let name = if class == "spectrum" { "texture" } else { class };
    let class = CLASSES.iter().find(|class| class.name == name)?;
    Some([class.today, class.old, class.own])
}

/// What becomes of a type of a class, if it is known.
pub fn support(class: &str, kind: &str) -> Option<Support> {
    lists(class)?.into_iter().find_map(|list| support::of(list, kind))
}

/// Is a type of a class read, if only nearly?
pub fn is_read(class: &str, kind: &str) -> bool {
    matches!(support(class, kind), Some(Done | Near(_)))
}

/// The types of a class.
pub fn of(class: &str) -> impl Iterator<Item = &'static str> {
    lists(class).into_iter().flatten().flat_map(support::names)
}

/// The class of a type.
pub fn class_of(kind: &str) -> Option<&'static str> {
    CLASSES.iter().map(|class| class.name).find(|class| support(class, kind).is_some())
}

/// Every type.
pub fn all() -> impl Iterator<Item = &'static str> {
    CLASSES.iter().flat_map(|class| of(class.name))
}

/// What becomes of all that Mitsuba has, as a table in Markdown.
pub fn table() -> String {
    let elements: Vec<String> = names_without_plugins().map(|name| format!("`{name}`")).collect();
    let elements = format!("| element | {} | done | |", elements.join(", "));
    let of = |named: fn(&str) -> String, list: fn(&Class) -> &'static Known| {
        CLASSES.iter().map(move |class| (named(class.name), list(class)))
    };
    let lists = of(str::to_owned, |class| class.today)
        .chain(of(|name| format!("{name} of 0.6"), |class| class.old))
        .chain(of(|name| format!("our own {name}"), |class| class.own));
    format!("{}\n{elements}", support::table(lists))
}
