//! What pbrt-v4 has, and what becomes of it here: for guesses at misspelt names, for what is said, and for
//! `docs/import.md`.

use sr_scene::{Diagnostic, Span};

use crate::support::{self, consequence};
use crate::values::shown;

pub use crate::support::{Known, Support, names};
use Support::{Done, Near, Reported};

pub const DIRECTIVES: &Known = &[
    ("Accelerator", Done),
    ("ActiveTransform", Reported("everything is where it is at the first of the two times")),
    ("AreaLightSource", Done),
    ("Attribute", Done),
    ("AttributeBegin", Done),
    ("AttributeEnd", Done),
    ("Camera", Done),
    ("ColorSpace", Near("colors become linear sRGB, and the picture is linear sRGB")),
    ("ConcatTransform", Done),
    ("CoordSysTransform", Done),
    ("CoordinateSystem", Done),
    ("Film", Done),
    ("Identity", Done),
    ("Import", Done),
    ("Include", Done),
    ("Integrator", Done),
    ("LightSource", Done),
    ("LookAt", Done),
    ("MakeNamedMaterial", Done),
    ("MakeNamedMedium", Reported("its inside is rendered as empty space")),
    ("Material", Done),
    ("MediumInterface", Near("media are not rendered: they are said where they are described")),
    ("NamedMaterial", Done),
    ("ObjectBegin", Done),
    ("ObjectEnd", Done),
    ("ObjectInstance", Done),
    ("Option", Near("those that change the picture are said and ignored")),
    ("PixelFilter", Done),
    ("ReverseOrientation", Done),
    ("Rotate", Done),
    ("Sampler", Near("the number of samples is used; they are Sobol' points")),
    ("Scale", Done),
    ("Shape", Done),
    ("Texture", Done),
    ("Transform", Done),
    ("TransformBegin", Done),
    ("TransformEnd", Done),
    ("TransformTimes", Near("nothing moves: what would is said at ActiveTransform's transforms")),
    ("Translate", Done),
    ("WorldBegin", Done),
    ("WorldEnd", Done),
];

pub const SHAPES: &Known = &[
    ("trianglemesh", Done),
    ("plymesh", Near("displacement is said and ignored; quadrilaterals are two triangles each")),
    ("bilinearmesh", Near("lights, and those with normals or uv, are triangles")),
    ("loopsubdiv", Done),
    ("sphere", Near("parts of it, and stretched ones, are triangles")),
    (
        "disk",
        Near("parts of it, and sheared ones, are triangles; u and v of others are swapped and mirrored"),
    ),
    ("cylinder", Near("parts of it, and stretched ones, are triangles")),
    ("curve", Near("flat ones and ribbons are round; v runs around")),
];

pub const MATERIALS: &Known = &[
    ("diffuse", Done),
    ("coateddiffuse", Near("the coat's own scattering is ignored, its roughness is constant")),
    ("coatedconductor", Near("the coat's own scattering is ignored, roughness is constant")),
    ("conductor", Done),
    ("dielectric", Near("one index for all colors")),
    ("thindielectric", Near("one index for all colors")),
    ("diffusetransmission", Done),
    ("mix", Done),
    ("interface", Done),
    ("measured", Reported("a diffuse one of reflectance 0.5 is shown instead")),
    ("hair", Done),
    ("subsurface", Reported("a coated diffuse one of its \"reflectance\" (0.5 without) is shown instead")),
];

pub const TEXTURES: &Known = &[
    ("constant", Done),
    ("scale", Done),
    ("mix", Done),
    ("bilerp", Near("clamped outside of [0, 1]²")),
    ("imagemap", Near("mappings other than uv are said; \"ewa\" is isotropic")),
    ("checkerboard", Near("in space it is reported: its colors are mixed half and half")),
    ("directionmix", Reported("its two textures are mixed half and half")),
    ("dots", Reported("what is between the dots is everywhere")),
    ("marble", Reported("its mean color is everywhere")),
    ("fbm", Reported("the constant 0.5 is used")),
    ("wrinkled", Reported("the constant 0.5 is used")),
    ("windy", Reported("the constant 0.5 is used")),
    ("ptex", Reported("the constant 0.5 is used")),
];

pub const LIGHTS: &Known = &[
    ("point", Done),
    ("spot", Done),
    ("distant", Done),
    ("infinite", Near("a portal shuts nothing out")),
    ("goniometric", Done),
    ("projection", Near("evenly bright on a plane, not on a sphere")),
    ("diffuse", Near("the back of a two-sided one is 10⁻⁴ of its size behind its front")),
];

pub const CAMERAS: &Known = &[
    ("perspective", Done),
    ("orthographic", Near("without a lens")),
    ("spherical", Near("\"equirectangular\" alone")),
    ("realistic", Reported("a perspective camera at the same place is used")),
];

pub const FILMS: &Known = &[
    ("rgb", Near("sensors other than cie1931 and white balance are said and ignored")),
    ("gbuffer", Reported("an RGB image is made")),
    ("spectral", Reported("an RGB image is made")),
];

pub const FILTERS: &Known = &[
    ("box", Done),
    ("triangle", Done),
    ("gaussian", Done),
    ("mitchell", Near("of radius 2 alone")),
    ("sinc", Near("of as many lobes as its window has")),
];

pub const INTEGRATORS: &Known = &[
    ("path", Done),
    ("volpath", Done),
    ("bdpt", Near("paths are traced, which converges to the same")),
    ("mlt", Near("paths are traced, which converges to the same")),
    ("sppm", Near("paths are traced, without the blur")),
    ("simplepath", Done),
    ("simplevolpath", Done),
    ("lightpath", Near("paths are traced, which converges to the same")),
    ("randomwalk", Near("paths are traced, which converges to the same")),
    ("ao", Reported("paths are traced")),
    ("function", Reported("paths are traced")),
];

/// What is said of `what` of a kind that is not done, or not known: then `unknown` happens.
pub fn unsupported(
    list: &'static Known,
    code: &'static str,
    span: &Span,
    what: &str,
    kind: &str,
    unknown: &str,
) -> Diagnostic {
    Diagnostic::warning(code, span, format!("{what} \"{}\" is not supported", shown(kind)))
        .guess(kind, names(list))
        .consequence(consequence(list, kind).unwrap_or(unknown))
}

/// All lists, and what they are of.
const LISTS: [(&str, &Known); 9] = [
    ("directive", DIRECTIVES),
    ("shape", SHAPES),
    ("material", MATERIALS),
    ("texture", TEXTURES),
    ("light", LIGHTS),
    ("camera", CAMERAS),
    ("film", FILMS),
    ("filter", FILTERS),
    ("integrator", INTEGRATORS),
];

/// What becomes of all that pbrt-v4 has, as a table in Markdown.
pub fn table() -> String {
    support::table(LISTS.map(|(what, list)| (what.to_owned(), list)))
}
