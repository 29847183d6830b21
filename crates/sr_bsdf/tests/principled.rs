//! Agreement of the principled models with Mitsuba 3.9.1 (`scalar_rgb`, `BSDF.eval` and `BSDF.pdf`), for random
//! parameters and directions: a case a line. Mitsuba's `wi` is our `wo`, and its values include the cosine.

use glam::Vec3;
use sr_bsdf::{Bsdf, Principled, PrincipledInputs, PrincipledThin, PrincipledThinInputs, Rgb};

/// Calls `check` with the parameters, two directions, and f cos and the density there.
fn for_each_case<const N: usize>(text: &str, check: impl Fn([f32; N], [Vec3; 2], (Rgb, f32))) -> usize {
    let case = |line: &str| {
        let numbers: Vec<f32> = line.split(' ').map(|number| number.parse().unwrap()).collect();
        let (inputs, rest) = numbers.split_at(N);
        let directions = [Vec3::from_slice(rest), Vec3::from_slice(&rest[3..])];
        check(inputs.try_into().unwrap(), directions, (Rgb::from_slice(&rest[6..]), rest[9]));
    };
    text.lines().map(case).count()
}

/// Within what single precision allows in a narrow lobe, and for Fresnel's equations of media that are nearly alike.
fn agree(bsdf: &(impl Bsdf + std::fmt::Debug), [wo, wi]: [Vec3; 2], (f_cos, pdf): (Rgb, f32)) {
    let (got, got_pdf) = (bsdf.eval(wo, wi) * wi.z.abs(), bsdf.pdf(wo, wi));
    let error = (got - f_cos).abs().max_element();
    let is_near = error < 1e-3 * f_cos.max_element() + 1e-7 && (got_pdf - pdf).abs() < 1e-3 * pdf + 1e-7;
    assert!(is_near, "{bsdf:?}, {wo}, {wi}: {got} {got_pdf}, not {f_cos} {pdf}");
}

#[test]
fn principled_agrees() {
    let cases = for_each_case(include_str!("principled.txt"), |numbers: [f32; 14], directions, expected| {
        let [r, g, b, roughness, anisotropic, metallic, spec_trans, eta, spec_tint, sheen, ..] = numbers;
        let [.., sheen_tint, flatness, clearcoat, clearcoat_gloss] = numbers;
        let bsdf = Principled::new(PrincipledInputs {
            base_color: Rgb::new(r, g, b),
            roughness,
            anisotropic,
            metallic,
            spec_trans,
            eta,
            spec_tint,
            sheen,
            sheen_tint,
            flatness,
            clearcoat,
            clearcoat_gloss,
            ..PrincipledInputs::default()
        });
        agree(&bsdf, directions, expected);
    });
    assert_eq!(cases, 300);
}

#[test]
fn principled_thin_agrees() {
    let cases =
        for_each_case(include_str!("principled_thin.txt"), |numbers: [f32; 12], directions, expected| {
            let [r, g, b, roughness, anisotropic, spec_trans, eta, spec_tint, ..] = numbers;
            let [.., sheen, sheen_tint, flatness, diff_trans] = numbers;
            let bsdf = PrincipledThin::new(PrincipledThinInputs {
                base_color: Rgb::new(r, g, b),
                roughness,
                anisotropic,
                spec_trans,
                eta,
                spec_tint,
                sheen,
                sheen_tint,
                flatness,
                diff_trans,
                ..PrincipledThinInputs::default()
            });
            agree(&bsdf, directions, expected);
        });
    assert_eq!(cases, 200);
}
