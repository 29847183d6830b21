//! Several models in one place, in frames of their own.

use glam::Vec3;
use sr_bsdf::{
    AnyBsdf, AnyModel, Blend, Dielectric, Diffuse, Microfacet, MicrofacetKind, Part, Rgb, RoughConductor,
    RoughDielectric, Step, Tilt,
};

use crate::bsdfs::{COPPER, GREEN, PINK};

pub(crate) fn models() -> Vec<(String, AnyBsdf<'static>)> {
    let ggx = |x, y| Microfacet::new(MicrofacetKind::Ggx, x, y);
    let diffuse: AnyModel = Diffuse::new(GREEN).into();
    let copper: AnyModel = RoughConductor::new(ggx(0.1, 0.3), Some(COPPER), Rgb::ONE).into();
    let glass: AnyModel = RoughDielectric::new(ggx(0.3, 0.3), 1.5, PINK, GREEN).into();
    let part = |share, model| Part::new(share, [], model);
    let tilt = Tilt::about(Vec3::new(0.4, -0.3, 1.0));
    let tilted = |model| Part::new(1.0, [Step::Tilt(tilt)], model);
    let shadowed = Part::new(0.6, [Step::Tilt(tilt.with_shadows())], copper);
    let mirrored = Part::new(0.5, [Step::Mirror, Step::Tilt(tilt)], copper);
    let named: [(&str, Vec<Part>, bool); 7] = [
        ("blend of diffuse and copper", vec![part(0.3, diffuse), part(0.7, copper)], false),
        ("blend of three with holes", vec![part(0.3, diffuse), part(0.2, copper), part(0.4, glass)], true),
        (
            "blend of glass and deltas",
            vec![part(0.5, glass), part(0.5, Dielectric::new(1.5, PINK, PINK).into())],
            false,
        ),
        ("tilted diffuse", vec![tilted(diffuse)], false),
        ("tilted glass", vec![tilted(glass)], false),
        ("tilted copper with shadows", vec![shadowed, part(0.4, diffuse)], false),
        ("two sides", vec![part(0.5, diffuse), mirrored], false),
    ];
    named
        .into_iter()
        .map(|(name, parts, holes)| {
            (name.into(), AnyBsdf::Blended(Box::leak(Box::new(Blend::new(parts, holes)))))
        })
        .collect()
}
