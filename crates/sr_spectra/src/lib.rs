//! Spectra to linear sRGB, by the integrals of the CIE 1931 standard observer.
//!
//! - `cie`: the observer and daylight. `metals`, `named`: spectra that have names. `upsampled`: from a color to a spectrum.

mod cie;
mod metals;
mod named;
mod upsampled;

use glam::{DMat3, DVec3};

pub use metals::named as named_metal;
pub use named::{GLASSES, glass, illuminant};
pub use upsampled::Smooth;

/// (wavelength in nm, value), wavelengths increasing.
pub type Samples = Vec<(f64, f64)>;

/// Integration covers these wavelengths, in nm.
const RANGE: (u32, u32) = (360, 830);

/// A reflectance, a transmittance or an index: seen under D65, so that 1 everywhere is white, (1, 1, 1).
pub fn reflectance(spectrum: impl Fn(f64) -> f64) -> DVec3 {
    let white = rgb_from_xyz(integrate(d65));
    rgb_from_xyz(integrate(|w| d65(w) * spectrum(w))) / white
}

/// An emission: 1 everywhere has the luminance 1 and the (reddish) color of equal energy.
pub fn emission(spectrum: impl Fn(f64) -> f64) -> DVec3 {
    rgb_from_xyz(integrate(spectrum) / integrate(|_| 1.0).y)
}

/// The color of a light, at luminance 1; `None` if it has none.
pub fn color_of_light(spectrum: impl Fn(f64) -> f64) -> Option<DVec3> {
    let xyz = integrate(spectrum);
    (xyz.y > 0.0).then(|| rgb_from_xyz(xyz / xyz.y))
}

/// η and k of a metal in linear RGB, so that it reflects what the spectra do where light meets it at a right angle from a
/// medium of the index `above`.
///
/// η is the mean as a reflectance's would be; k is what makes the reflectance right.
pub fn metal(eta: impl Fn(f64) -> f64, k: impl Fn(f64) -> f64, above: f64) -> (DVec3, DVec3) {
    let (eta, k) = (|w: f64| eta(w) / above, |w: f64| k(w) / above);
    let reflected = reflectance(|w| {
        let (n, k2) = (eta(w), k(w).powi(2));
        ((n - 1.0).powi(2) + k2) / ((n + 1.0).powi(2) + k2)
    });
    let reflected = reflected.clamp(DVec3::ZERO, DVec3::splat(0.9999));
    let n = reflectance(eta).max(DVec3::splat(1e-3));
    // An index beyond these reflects more than that, whatever it absorbs.
    let root = DVec3::new(reflected.x.sqrt(), reflected.y.sqrt(), reflected.z.sqrt());
    let most = (1.0 + root) / (1.0 - root);
    let n = n.clamp(1.0 / most, most);
    let k2 = (reflected * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - reflected);
    let k = DVec3::new(k2.x.max(0.0).sqrt(), k2.y.max(0.0).sqrt(), k2.z.max(0.0).sqrt());
    (n * above, k * above)
}

/// Spectra of η and k every 10 nm for a metal of these colors: the inverse of [`metal`].
///
/// η has its own smooth spectrum, and so has what is reflected at a right angle from a medium of the index `above`; k goes
/// with both.
pub fn metal_spectra(eta: DVec3, k: DVec3, above: f64) -> (Samples, Samples) {
    let (n, relative_k) = (eta / above, k / above);
    let reflected =
        ((n - 1.0) * (n - 1.0) + relative_k * relative_k) / ((n + 1.0) * (n + 1.0) + relative_k * relative_k);
    let (n, reflected) = (Smooth::unbounded(n), Smooth::reflectance(reflected.min(DVec3::splat(0.9999))));
    let at = |w: f64| {
        let r = reflected.at(w).clamp(0.0, 0.9999);
        let most = (1.0 + r.sqrt()) / (1.0 - r.sqrt());
        let n = n.at(w).clamp(1.0 / most, most);
        let k2 = (r * (n + 1.0).powi(2) - (n - 1.0).powi(2)) / (1.0 - r);
        (w, n * above, k2.max(0.0).sqrt() * above)
    };
    let samples = (RANGE.0..=RANGE.1).step_by(10).map(|nm| at(f64::from(nm)));
    samples.map(|(w, n, k)| ((w, n), (w, k))).unzip()
}

/// The value between samples (wavelength in nm, value), linearly; 0 outside.
pub fn interpolate(samples: &[(f64, f64)], wavelength: f64) -> f64 {
    let after = samples.partition_point(|&(w, _)| w < wavelength);
    match (after.checked_sub(1).map(|i| samples[i]), samples.get(after)) {
        (_, Some(&(w, v))) if w == wavelength => v,
        (Some((w0, v0)), Some(&(w1, v1))) => v0 + (v1 - v0) * (wavelength - w0) / (w1 - w0),
        _ => 0.0,
    }
}

/// Planck's law: the radiance of a black body, in W m⁻² sr⁻¹ nm⁻¹.
pub fn blackbody(temperature: f64, wavelength: f64) -> f64 {
    // 2 h c² and h c / k_B, in SI units (exact since 2019).
    const C1: f64 = 1.191_042_972e-16;
    const C2: f64 = 1.438_776_877e-2;
    let meters = wavelength * 1e-9;
    C1 / (meters.powi(5) * ((C2 / (meters * temperature)).exp() - 1.0)) * 1e-9
}

/// Linear sRGB (IEC 61966-2-1) from CIE XYZ.
pub fn rgb_from_xyz(xyz: DVec3) -> DVec3 {
    DMat3::from_cols(
        DVec3::new(3.240479, -0.969256, 0.055648),
        DVec3::new(-1.537150, 1.875991, -0.204043),
        DVec3::new(-0.498535, 0.041556, 1.057311),
    ) * xyz
}

fn d65(wavelength: f64) -> f64 {
    cie::at(&cie::D65, wavelength)
}

/// ∫ s(λ) (x̄, ȳ, z̄) dλ, by the midpoint rule at 1 nm.
fn integrate(spectrum: impl Fn(f64) -> f64) -> DVec3 {
    (RANGE.0..RANGE.1)
        .map(|nm| {
            let w = f64::from(nm) + 0.5;
            spectrum(w) * DVec3::new(cie::at(&cie::X, w), cie::at(&cie::Y, w), cie::at(&cie::Z, w))
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(got: DVec3, want: [f64; 3], tolerance: f64) {
        assert!((got - DVec3::from(want)).abs().max_element() < tolerance, "{got} is not {want:?}");
    }

    #[test]
    fn a_constant_reflectance_is_grey() {
        close(reflectance(|_| 0.25), [0.25; 3], 1e-12);
    }

    #[test]
    fn metals_come_back_from_their_spectra() {
        for (eta, k, above) in [
            ([0.143, 0.375, 1.442], [3.983, 2.386, 1.603], 1.0),
            ([1.657, 0.880, 0.521], [9.224, 6.270, 4.837], 1.5),
            ([0.2, 0.9, 1.1], [3.9, 2.4, 2.2], 1.0),
        ] {
            let (eta, k) = (DVec3::from(eta), DVec3::from(k));
            let (of_eta, of_k) = metal_spectra(eta, k, above);
            let (got_eta, got_k) = metal(|w| interpolate(&of_eta, w), |w| interpolate(&of_k, w), above);
            assert!((got_eta / eta - 1.0).abs().max_element() < 0.01, "{got_eta}, not {eta}");
            assert!((got_k / k - 1.0).abs().max_element() < 0.01, "{got_k}, not {k}");
        }
    }

    /// The figures are what Mitsuba 3.9.1 makes of the same spectra in `scalar_rgb`.
    #[test]
    fn spectra_agree_with_mitsuba() {
        let samples = [(400.0, 0.1), (500.0, 0.5), (600.0, 0.7), (700.0, 0.2)];
        close(reflectance(|w| interpolate(&samples, w)), [0.628604, 0.604581, 0.278625], 1e-3);
        let samples = [(400.0, 0.1), (500.0, 5.0), (600.0, 7.0), (700.0, 0.2)];
        close(emission(|w| interpolate(&samples, w)), [6.95935, 5.85791, 2.00009], 0.01);
        close(emission(|_| 1.0), [1.20479, 0.948291, 0.908916], 1e-3);
    }

    #[test]
    fn d65_is_white() {
        close(color_of_light(d65).unwrap(), [1.0; 3], 1e-3);
        assert_eq!(color_of_light(|_| 0.0), None);
    }

    /// The sun's luminance-weighted radiance in tables: 5778 K peaks at 501.5 nm (Wien).
    #[test]
    fn planck_peaks_where_wien_says() {
        let peak =
            (300..900).max_by(|&a, &b| blackbody(5778.0, a as f64).total_cmp(&blackbody(5778.0, b as f64)));
        assert!((501..=502).contains(&peak.unwrap()));
        assert!((blackbody(5000.0, 580.0) / 12745.0 - 1.0).abs() < 0.01, "{}", blackbody(5000.0, 580.0));
    }

    #[test]
    fn metals_reflect_what_their_spectra_do() {
        for name in ["Ag", "Al", "Au", "Cu", "MgO", "TiO2"] {
            let (eta, k) = named_metal(name).unwrap();
            let (eta, k) = (|w| interpolate(&eta, w), |w| interpolate(&k, w));
            let normal = |n: f64, k: f64| ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
            let expected = reflectance(|w| normal(eta(w), k(w)));
            let (n, k) = metal(eta, k, 1.0);
            let got = DVec3::new(normal(n.x, k.x), normal(n.y, k.y), normal(n.z, k.z));
            // Gold is redder than sRGB can show.
            close(got, expected.min(DVec3::ONE).into(), 1e-3);
        }
    }
}
