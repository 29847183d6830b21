//! Every scattering model, with its parameters at both ends and in between, seen from several directions.
//!
//! [`bsdf_cases`] is for tests that integrate: no lobe is narrower than about 0.02 rad, so that quadrature
//! on a grid can follow it. [`bsdf_models`] has the models alone, for tests that choose harder directions.

use std::sync::LazyLock;

use glam::Vec3;
use sr_bsdf::{
    AnyBsdf, AnyModel, Bsdf, Conductor, Dielectric, Diffuse, DiffuseTransmission, Eon, Mask, Microfacet,
    MicrofacetKind, OrenNayar, Plastic, Rgb, RoughCoat, RoughConductor, RoughDielectric, RoughPlastic,
    SmoothCoat, ThinDielectric,
};

use crate::{blends, compensated, hair, principled};

/// A name that tells cases apart, a model, and a direction from which it reflects or transmits.
pub type BsdfCase = (String, AnyBsdf<'static>, Vec3);

const KINDS: [MicrofacetKind; 3] =
    [MicrofacetKind::Beckmann, MicrofacetKind::Ggx, MicrofacetKind::GgxCorrelated];
const ALPHAS: [[f32; 2]; 6] = [[0.01, 0.01], [0.1, 0.1], [0.5, 0.5], [1.0, 1.0], [0.05, 0.4], [0.6, 0.15]];
const COAT_ALPHAS: [f32; 3] = [0.05, 0.3, 1.0];

pub(crate) const GREEN: Rgb = Rgb::new(0.2, 0.8, 0.5);
pub(crate) const PINK: Rgb = Rgb::new(0.9, 0.7, 0.8);
/// η and k of copper at 630, 532 and 465 nm (Johnson & Christy 1972), rounded.
pub(crate) const COPPER: (Rgb, Rgb) = (Rgb::new(0.27, 1.09, 1.18), Rgb::new(3.41, 2.58, 2.40));

/// The coats of rough plastic, for each kind and each of `COAT_ALPHAS`.
static COATS: LazyLock<Vec<RoughCoat>> = LazyLock::new(|| {
    let new = |kind| COAT_ALPHAS.map(|alpha| RoughCoat::new(kind, alpha, 1.5));
    KINDS.into_iter().flat_map(new).collect()
});

/// All cases. Some have delta lobes only: [`Bsdf::lobes`] tells.
pub fn bsdf_cases() -> Vec<BsdfCase> {
    bsdf_models().into_iter().flat_map(seen_from_several_directions).collect()
}

/// A model from each direction: nearly along the normal to nearly grazing; from below too where it transmits.
fn seen_from_several_directions((name, bsdf): (String, AnyBsdf<'static>)) -> Vec<BsdfCase> {
    let above = [(0.97, 0.0), (0.8, 0.4), (0.5, 2.0), (0.1, 4.0)];
    let below = [(-0.9, 1.0), (-0.4, 3.0)];
    let transmits = bsdf.lobes().transmission || bsdf.sample(-Vec3::Z, 0.5, glam::Vec2::splat(0.5)).is_some();
    let below = if transmits { &below[..] } else { &[] };
    let case = |&(z, azimuth): &(f32, f32)| {
        let wo = (Vec3::new(azimuth.cos(), azimuth.sin(), 0.0) * (1.0 - z * z).sqrt()).with_z(z);
        (format!("{name}, wo.z = {z}"), bsdf, wo)
    };
    above.iter().chain(below).map(case).collect()
}

/// Models that return all light that they receive, from any direction: a furnace has to be white.
pub fn lossless_models() -> Vec<(String, AnyBsdf<'static>)> {
    let mut models = vec![
        ("white mirror".to_owned(), Conductor::new(None, Rgb::ONE).into()),
        ("white dielectric".to_owned(), Dielectric::new(1.5, Rgb::ONE, Rgb::ONE).into()),
        ("white diffuse".to_owned(), Diffuse::new(Rgb::ONE).into()),
        ("white plastic".to_owned(), Plastic::new(SmoothCoat::new(1.5), Rgb::ONE, Rgb::ONE, true).into()),
    ];
    for roughness in [1e-4, 0.3, 1.0] {
        models.push((format!("white EON {roughness}"), Eon::new(Rgb::ONE, roughness).into()));
    }
    models.extend(compensated::white_models());
    models.extend(hair::white_models());
    models
}

/// Is the model of this name the same with directions exchanged? A tilted normal is not: it weighs light by the cosine
/// with one normal, and receives it by that with another (Veach 1997, §5.3). Mitsuba's thin principled model leaves out
/// transmission by facets that the transmitted direction meets again, but not by those that the other one does. Hair lets
/// light out where it came in, as if that were where the viewer looks.
pub fn is_reciprocal(name: &str) -> bool {
    !["tilted", "two sides", "thin principled", "hair"].iter().any(|start| name.starts_with(start))
}

/// The most light that a model of this name may return for each unit that it receives. Burley's models add lobes without
/// taking from others what these reflect; glTF's takes by Fresnel's factor at the half vector, which is too little at
/// grazing angles.
pub fn energy_limit(name: &str) -> f64 {
    if name.contains("principled") || name.starts_with("glTF") { 1.7 } else { 1.0 }
}

/// All models, named.
pub fn bsdf_models() -> Vec<(String, AnyBsdf<'static>)> {
    let mut models: Vec<(String, AnyBsdf<'static>)> = vec![
        ("diffuse".into(), Diffuse::new(GREEN).into()),
        ("diffuse, black".into(), Diffuse::new(Rgb::ZERO).into()),
        ("mirror".into(), Conductor::new(None, PINK).into()),
        ("conductor".into(), Conductor::new(Some(COPPER), Rgb::ONE).into()),
        ("thin dielectric".into(), ThinDielectric::new(1.5, Rgb::ONE, PINK).into()),
        ("masked diffuse".into(), masked(0.4, Diffuse::new(GREEN))),
        ("masked dielectric".into(), masked(0.9, Dielectric::new(1.5, Rgb::ONE, PINK))),
        ("fully masked".into(), masked(0.0, Diffuse::new(GREEN))),
    ];
    for eta in [1.5, 1.0 / 1.33, 1.0] {
        models.push((format!("dielectric {eta}"), Dielectric::new(eta, Rgb::ONE, Rgb::ONE).into()));
    }
    for kind in KINDS {
        for [x, y] in ALPHAS {
            models.extend(rough(&format!("{kind:?} {x} {y}"), Microfacet::new(kind, x, y)));
        }
    }
    for nonlinear in [false, true] {
        let plastic = |eta, diffuse| Plastic::new(SmoothCoat::new(eta), diffuse, PINK, nonlinear).into();
        models.push((format!("plastic, nonlinear: {nonlinear}"), plastic(1.5, GREEN)));
        models.push((format!("plastic 1.9 white, nonlinear: {nonlinear}"), plastic(1.9, Rgb::ONE)));
        models.push((format!("plastic black, nonlinear: {nonlinear}"), plastic(1.3, Rgb::ZERO)));
    }
    for roughness in [0.0, 1e-4, 0.5, 1.0] {
        models.push((format!("EON {roughness}"), Eon::new(GREEN, roughness).into()));
        models.push((format!("Oren-Nayar {roughness}"), OrenNayar::new(GREEN, roughness).into()));
    }
    models.push(("EON 1 white".into(), Eon::new(Rgb::ONE, 1.0).into()));
    for (reflectance, transmittance) in [(0.3 * GREEN, 0.6 * PINK), (Rgb::ZERO, GREEN), (GREEN, Rgb::ZERO)] {
        let name = format!("diffuse transmission, {} and {}", reflectance.y, transmittance.y);
        models.push((name, DiffuseTransmission::new(reflectance, transmittance).into()));
    }
    models.extend(blends::models());
    models.extend(hair::models());
    models.extend(principled::models());
    models.extend(compensated::models());
    for coat in COATS.iter() {
        let name =
            format!("rough plastic {:?} {}", coat.distribution().kind(), coat.distribution().alpha().x);
        models.push((name.clone(), RoughPlastic::new(coat, GREEN, PINK, false).into()));
        models.push((format!("{name} black base"), RoughPlastic::new(coat, Rgb::ZERO, PINK, true).into()));
        models.push((format!("{name} no gloss"), RoughPlastic::new(coat, Rgb::ONE, Rgb::ZERO, true).into()));
    }
    models
}

/// The models that a microfacet distribution alone makes rough.
fn rough(name: &str, distribution: Microfacet) -> Vec<(String, AnyBsdf<'static>)> {
    let copper = RoughConductor::new(distribution, Some(COPPER), PINK);
    let mut models = vec![
        (format!("rough conductor {name}"), copper.into()),
        (format!("masked rough conductor {name}"), masked(0.7, copper)),
    ];
    // Refracted lobes are narrower by |η − 1|.
    let lobe_width = |eta: f32| distribution.alpha().min_element() * (eta - 1.0).abs();
    for eta in [1.5, 1.1, 1.0 / 1.33].into_iter().filter(|&eta| lobe_width(eta) > 0.02) {
        models.push((
            format!("rough dielectric {eta} {name}"),
            RoughDielectric::new(distribution, eta, PINK, GREEN).into(),
        ));
    }
    models
}

fn masked(opacity: f32, model: impl Into<AnyModel<'static>>) -> AnyBsdf<'static> {
    AnyBsdf::Masked(Mask::new(opacity, model.into()))
}
