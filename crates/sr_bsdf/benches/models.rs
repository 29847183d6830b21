//! Nanoseconds of `sample`, `eval` and `pdf`, for each model seen along the normal, at 45° and at 80°.
//!
//! `cargo bench -p sr_bsdf --bench models`; a line for each: model, angle, function, nanoseconds. `benches/models.py` puts
//! them beside Mitsuba's.

use std::hint::black_box;
use std::io::Write;
use std::time::Instant;

use glam::{Vec2, Vec3};
use sr_bsdf::{
    AnyBsdf, Blend, Bsdf, Conductor, Dielectric, Diffuse, DiffuseTransmission, Eon, Mask, MetallicRoughness,
    MetallicRoughnessInputs, Microfacet, MicrofacetKind, OrenNayar, Part, Plastic, Principled,
    PrincipledInputs, PrincipledThin, PrincipledThinInputs, Rgb, RoughConductor, RoughDielectric,
    RoughPlastic, RoughPlasticTables, SmoothCoat, ThinDielectric,
};

/// η and k of copper at 630, 532 and 465 nm (Johnson & Christy 1972), rounded.
const COPPER: (Rgb, Rgb) = (Rgb::new(0.27, 1.09, 1.18), Rgb::new(3.41, 2.58, 2.40));

const ANGLES: [f32; 3] = [0.0, 45.0, 80.0];

/// Directions and uniforms are as many, so that no branch is learned by heart.
const INPUTS: usize = 1024;
/// The fastest of so many passes over the inputs counts: others were disturbed.
const PASSES: usize = 200;

fn main() {
    let mut out = std::io::stdout();
    let coat = RoughPlasticTables::new(MicrofacetKind::Ggx, 0.3, 1.5);
    for (name, bsdf) in models(&coat) {
        for angle in ANGLES {
            let wo = Vec3::new(angle.to_radians().sin(), 0.0, angle.to_radians().cos());
            let lobes: Vec<f32> = (0..INPUTS).map(|i| (i as f32 * 0.754_877_7) % 1.0).collect();
            let points: Vec<Vec2> = (0..INPUTS).map(uniforms).collect();
            let directions: Vec<Vec3> = points.iter().map(|&u| sphere(u)).collect();
            let sample = fastest(|i| bsdf.sample(wo, lobes[i], points[i]).map_or(0.0, |s| s.pdf));
            let eval = fastest(|i| bsdf.eval(wo, directions[i]).x);
            let pdf = fastest(|i| bsdf.pdf(wo, directions[i]));
            for (function, nanoseconds) in [("sample", sample), ("eval", eval), ("pdf", pdf)] {
                // A broken pipe is the reader's wish.
                let _ = writeln!(out, "{name}\t{angle}\t{function}\t{nanoseconds:.2}");
            }
        }
    }
}

/// The names are those of Mitsuba's plugins.
fn models(coat: &RoughPlasticTables) -> Vec<(&'static str, AnyBsdf<'_>)> {
    let half = Rgb::splat(0.5);
    let ggx = Microfacet::isotropic(MicrofacetKind::Ggx, 0.3);
    let beckmann = Microfacet::isotropic(MicrofacetKind::Beckmann, 0.3);
    let metal = PrincipledInputs { base_color: half, metallic: 1.0, roughness: 0.5, ..Default::default() };
    let all = PrincipledInputs { metallic: 0.3, spec_trans: 0.5, sheen: 0.5, clearcoat: 0.5, ..metal };
    let thin = PrincipledThinInputs { base_color: half, spec_trans: 0.5, ..Default::default() };
    let copper = RoughConductor::new(ggx, Some(COPPER), Rgb::ONE);
    let parts = vec![Part::new(0.4, [], Diffuse::new(half).into()), Part::new(0.6, [], copper.into())];
    vec![
        ("diffuse", Diffuse::new(half).into()),
        ("mask", AnyBsdf::Masked(Mask::new(0.5, Diffuse::new(half).into()))),
        ("dielectric", Dielectric::new(1.5, Rgb::ONE, Rgb::ONE).into()),
        ("thindielectric", ThinDielectric::new(1.5, Rgb::ONE, Rgb::ONE).into()),
        ("roughdielectric, ggx", RoughDielectric::new(ggx, 1.5, Rgb::ONE, Rgb::ONE).into()),
        ("roughdielectric, beckmann", RoughDielectric::new(beckmann, 1.5, Rgb::ONE, Rgb::ONE).into()),
        ("conductor", Conductor::new(Some(COPPER), Rgb::ONE).into()),
        ("roughconductor, ggx", RoughConductor::new(ggx, Some(COPPER), Rgb::ONE).into()),
        ("roughconductor, beckmann", RoughConductor::new(beckmann, Some(COPPER), Rgb::ONE).into()),
        ("plastic", Plastic::new(SmoothCoat::new(1.5), half, Rgb::ONE, false).into()),
        ("roughplastic, ggx", RoughPlastic::new(coat, half, Rgb::ONE, false).into()),
        ("roughdiffuse", OrenNayar::new(half, 0.5).into()),
        ("eon", Eon::new(half, 0.5).into()),
        ("diffusetransmission", DiffuseTransmission::new(half, half).into()),
        ("principled", Principled::new(metal).into()),
        ("principled, all lobes", Principled::new(all).into()),
        ("principledthin", PrincipledThin::new(thin).into()),
        ("metallicroughness", MetallicRoughness::new(MetallicRoughnessInputs::default()).into()),
        ("blendbsdf", AnyBsdf::Blended(Blend::new(parts, false))),
    ]
}

/// A point of a lattice.
fn uniforms(i: usize) -> Vec2 {
    Vec2::new((i as f32 + 0.5) / INPUTS as f32, (i as f32 * 0.618_034) % 1.0)
}

fn sphere(u: Vec2) -> Vec3 {
    let z = 1.0 - 2.0 * u.x;
    let (sin, cos) = (std::f32::consts::TAU * u.y).sin_cos();
    (Vec3::new(cos, sin, 0.0) * (1.0 - z * z).max(0.0).sqrt()).with_z(z)
}

/// Nanoseconds of a call.
fn fastest(call: impl Fn(usize) -> f32) -> f64 {
    let pass = || {
        let began = Instant::now();
        for i in 0..INPUTS {
            black_box(call(black_box(i)));
        }
        began.elapsed().as_secs_f64() * 1e9 / INPUTS as f64
    };
    (0..PASSES).map(|_| pass()).fold(f64::INFINITY, f64::min)
}
