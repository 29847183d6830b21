//! Which extensions are done, and what is said about the others.

use std::collections::BTreeMap;
use std::fmt;

use sr_scene::{Diagnostic, Diagnostics, Span};

use super::json::{Kind, Value};

use Support::{Approximated, Done, Reported};

/// What becomes of an extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Support {
    /// As it is defined.
    Done,
    /// Something near it is shown; the words say what. What differs is said where it is used.
    Approximated(&'static str),
    /// It is said once that it is not shown; the words say what happens instead.
    Reported(&'static str),
}

impl fmt::Display for Support {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Done => write!(f, "done"),
            Approximated(how) => write!(f, "approximated: {how}"),
            Reported(instead) => write!(f, "reported: {instead}"),
        }
    }
}

/// Every extension that this crate has heard of.
pub const EXTENSIONS: &[(&str, Support)] = &[
    ("EXT_lights_image_based", Done),
    ("EXT_mesh_gpu_instancing", Done),
    ("EXT_meshopt_compression", Done),
    ("EXT_texture_webp", Done),
    ("KHR_animation_pointer", Reported("the scene is shown as it stands without animation")),
    ("KHR_draco_mesh_compression", Done),
    ("KHR_lights_punctual", Done),
    ("KHR_materials_anisotropy", Approximated("one direction for a whole texture, its mean")),
    (
        "KHR_materials_clearcoat",
        Approximated("the coat has the normals of the base; where its own differ, that is said"),
    ),
    ("KHR_materials_diffuse_transmission", Approximated("bodies are thin sheets; nothing scatters inside")),
    ("KHR_materials_dispersion", Reported("all wavelengths bend alike")),
    ("KHR_materials_emissive_strength", Done),
    ("KHR_materials_ior", Done),
    ("KHR_materials_iridescence", Reported("the surface is shown without thin films")),
    ("KHR_materials_pbrSpecularGlossiness", Approximated("as a dielectric with a colored reflection")),
    ("KHR_materials_sheen", Done),
    ("KHR_materials_specular", Done),
    ("KHR_materials_transmission", Done),
    ("KHR_materials_unlit", Approximated("as an emitter that reflects nothing")),
    ("KHR_materials_variants", Done),
    ("KHR_materials_volume", Approximated("attenuation colors the surface, by the stated thickness")),
    ("KHR_mesh_quantization", Done),
    ("KHR_texture_basisu", Reported("the other image of the texture is used, if there is one")),
    ("KHR_texture_transform", Done),
    ("KHR_xmp_json_ld", Done),
];

/// Says once for each extension that is used and not done what happens instead.
pub fn report(root: &Value, d: &mut Diagnostics) {
    let mut used: BTreeMap<&str, (usize, Span)> = BTreeMap::new();
    collect(root, &mut used);
    for required in root.get("extensionsRequired").map_or(&[][..], Value::list) {
        if let Some(name) = required.text() {
            used.entry(name).or_insert((0, required.span.clone()));
        }
    }
    for (name, (count, span)) in used {
        let known = EXTENSIONS.iter().find(|(known, _)| *known == name);
        let times = if count > 1 { format!(" ({count} times)") } else { String::new() };
        let name = crate::values::shown(name);
        match known {
            Some((_, Done | Approximated(_))) => {}
            Some((_, Reported(instead))) => d.push(
                Diagnostic::warning("gltf::extension", &span, format!("{name} is not shown yet{times}"))
                    .consequence(*instead),
            ),
            None => d.push(
                Diagnostic::warning(
                    "gltf::unknown-extension",
                    &span,
                    format!("the extension {name} is not known{times}"),
                )
                .guess(&name, EXTENSIONS.iter().map(|(known, _)| *known))
                .consequence("it is ignored"),
            ),
        }
    }
}

fn collect<'v>(value: &'v Value, used: &mut BTreeMap<&'v str, (usize, Span)>) {
    match &value.kind {
        Kind::List(list) => list.iter().for_each(|v| collect(v, used)),
        Kind::Object(members) => {
            for (name, member) in members {
                // `extras` are for applications; nothing in them is the format's.
                if name == "extras" {
                    continue;
                }
                if name == "extensions" {
                    for (extension, content) in member.members() {
                        used.entry(extension).or_insert_with(|| (0, content.span.clone())).0 += 1;
                    }
                }
                collect(member, used);
            }
        }
        _ => {}
    }
}
