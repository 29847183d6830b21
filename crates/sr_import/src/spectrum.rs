//! Spectra to linear sRGB.
//!
//! The observer is the CIE 1931 one, in the multi-lobe fit of Wyman, Sloan & Shirley 2013 ("Simple Analytic
//! Approximations to the CIE XYZ Color Matching Functions", eq. 4), good to about 1 %.

use glam::{DMat3, DVec3};

/// Integration covers these wavelengths, in nm.
const RANGE: (u32, u32) = (360, 830);

/// The relative power of CIE standard illuminant D65 (ISO 11664-2) from 360 nm on, every 10 nm.
const D65: [f64; 48] = [
    46.6383, 52.0891, 49.9755, 54.6482, 82.7549, 91.486, 93.4318, 86.6823, 104.865, 117.008, 117.812,
    114.861, 115.923, 108.811, 109.354, 107.802, 104.79, 107.689, 104.405, 104.046, 100.0, 96.3342, 95.788,
    88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213,
    71.6091, 74.349, 61.604, 69.8856, 75.087, 63.5927, 46.4182, 66.8054, 63.3828, 64.304, 59.4519, 51.959,
    57.4406, 60.3125,
];

/// A reflectance, a transmittance or an index: seen under D65, so that 1 everywhere is white, (1, 1, 1).
pub fn reflectance(spectrum: impl Fn(f64) -> f64) -> DVec3 {
    let white = rgb_from_xyz(integrate(d65));
    rgb_from_xyz(integrate(|w| d65(w) * spectrum(w))) / white
}

/// An emission: 1 everywhere has the luminance 1 and the (reddish) color of equal energy.
pub fn emission(spectrum: impl Fn(f64) -> f64) -> DVec3 {
    rgb_from_xyz(integrate(spectrum) / integrate(|_| 1.0).y)
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

fn d65(wavelength: f64) -> f64 {
    let x = ((wavelength - f64::from(RANGE.0)) / 10.0).clamp(0.0, (D65.len() - 1) as f64);
    let i = (x as usize).min(D65.len() - 2);
    D65[i] + (D65[i + 1] - D65[i]) * (x - i as f64)
}

/// ∫ s(λ) (x̄, ȳ, z̄) dλ, by the midpoint rule at 1 nm.
fn integrate(spectrum: impl Fn(f64) -> f64) -> DVec3 {
    (RANGE.0..RANGE.1)
        .map(|nm| {
            let w = f64::from(nm) + 0.5;
            spectrum(w) * color_matching(w)
        })
        .sum()
}

fn color_matching(w: f64) -> DVec3 {
    let lobe = |mean: f64, left: f64, right: f64| {
        let t = (w - mean) * if w < mean { left } else { right };
        (-0.5 * t * t).exp()
    };
    DVec3::new(
        0.362 * lobe(442.0, 0.0624, 0.0374) + 1.056 * lobe(599.8, 0.0264, 0.0323)
            - 0.065 * lobe(501.1, 0.0490, 0.0382),
        0.821 * lobe(568.8, 0.0213, 0.0247) + 0.286 * lobe(530.9, 0.0613, 0.0322),
        1.217 * lobe(437.0, 0.0845, 0.0278) + 0.681 * lobe(459.0, 0.0385, 0.0725),
    )
}

/// Linear sRGB (IEC 61966-2-1) from CIE XYZ.
fn rgb_from_xyz(xyz: DVec3) -> DVec3 {
    DMat3::from_cols(
        DVec3::new(3.240479, -0.969256, 0.055648),
        DVec3::new(-1.537150, 1.875991, -0.204043),
        DVec3::new(-0.498535, 0.041556, 1.057311),
    ) * xyz
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

    /// The figures are what Mitsuba 3.9.1 makes of the same spectra in `scalar_rgb`, with the tabulated observer.
    #[test]
    fn spectra_agree_with_mitsuba() {
        let samples = [(400.0, 0.1), (500.0, 0.5), (600.0, 0.7), (700.0, 0.2)];
        close(reflectance(|w| interpolate(&samples, w)), [0.628604, 0.604581, 0.278625], 0.01);
        let samples = [(400.0, 0.1), (500.0, 5.0), (600.0, 7.0), (700.0, 0.2)];
        close(emission(|w| interpolate(&samples, w)), [6.95935, 5.85791, 2.00009], 0.1);
        close(emission(|_| 1.0), [1.20479, 0.948291, 0.908916], 0.01);
    }

    #[test]
    fn d65_is_white() {
        let rgb = rgb_from_xyz(integrate(d65));
        close(rgb / rgb.y, [1.0; 3], 0.02);
    }

    /// The sun's luminance-weighted radiance in tables: 5778 K peaks at 501.5 nm (Wien).
    #[test]
    fn planck_peaks_where_wien_says() {
        let peak =
            (300..900).max_by(|&a, &b| blackbody(5778.0, a as f64).total_cmp(&blackbody(5778.0, b as f64)));
        assert!((501..=502).contains(&peak.unwrap()));
        assert!((blackbody(5000.0, 580.0) / 12745.0 - 1.0).abs() < 0.01, "{}", blackbody(5000.0, 580.0));
    }
}
