//! A color as a smooth reflectance spectrum, where what becomes of it is not linear: light that meets it many times.
//!
//! S(c₀ x² + c₁ x + c₂) with S(t) = ½ + t / (2 √(1 + t²)), which is in [0, 1] for any wavelength, and has three numbers for the
//! three of a color (Jakob & Hanika 2019, "A Low-Dimensional Function Space for Efficient Spectral Upsampling", Eq. 2 to 5).
//! pbrt-v4 has these in tables; here they are solved for.

use std::sync::LazyLock;

use glam::{DMat3, DVec3};

use super::{cie, rgb_from_xyz};

/// Wavelengths that the spectra are known at: those of the CIE's tables.
const LEN: usize = cie::X.len();

/// Of each wavelength, its place in [-1, 1] and what a reflectance of 1 there adds to a color; all add up to white.
static WAVELENGTHS: LazyLock<[(f64, DVec3); LEN]> = LazyLock::new(|| {
    let seen = |i: usize| rgb_from_xyz(cie::D65[i] * DVec3::new(cie::X[i], cie::Y[i], cie::Z[i]));
    let white: DVec3 = (0..LEN).map(seen).sum();
    std::array::from_fn(|i| (2.0 * i as f64 / (LEN - 1) as f64 - 1.0, seen(i) / white))
});

/// The smooth spectrum of a color.
///
/// ```
/// use glam::DVec3;
/// let twice = sr_spectra::Smooth::reflectance(DVec3::new(0.8, 0.2, 0.05)).map(|rho| rho * rho);
/// assert!((twice.x - 0.64).abs() > 0.01); // light of red's wavelengths is not reflected by 80 % at each of them
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Smooth {
    /// Of greys: the same at all wavelengths.
    Grey(f64),
    /// `scale` S(c₀ x² + c₁ x + c₂), x in [-1, 1] from 360 to 830 nm.
    Color {
        /// c₀, c₁ and c₂.
        coefficients: DVec3,
        /// At least the largest value.
        scale: f64,
    },
}

impl Smooth {
    /// Of a reflectance: its color is in [0, 1]; one that no smooth spectrum has is seen as the nearest.
    pub fn reflectance(color: DVec3) -> Self {
        if color.min_element() == color.max_element() {
            return Self::Grey(color.x);
        }
        Self::Color { coefficients: coefficients(color), scale: 1.0 }
    }

    /// Of an index or a light: any color that is not negative. The spectrum is twice the largest number times a reflectance
    /// (so pbrt-v4 does it).
    pub fn unbounded(color: DVec3) -> Self {
        let scale = 2.0 * color.max_element();
        match Self::reflectance(if scale > 0.0 { color / scale } else { DVec3::ZERO }) {
            Self::Grey(_) => Self::Grey(color.x),
            Self::Color { coefficients, .. } => Self::Color { coefficients, scale },
        }
    }

    /// The color of a reflectance whose spectrum is `of` this one, a reflectance too.
    pub fn map(&self, of: impl Fn(f64) -> f64) -> DVec3 {
        match *self {
            Self::Grey(value) => DVec3::splat(of(value)),
            Self::Color { coefficients, scale } => {
                WAVELENGTHS.iter().map(|&(x, rgb)| rgb * of(scale * smooth(coefficients, x))).sum()
            }
        }
    }

    /// At a wavelength in nm.
    pub fn at(&self, wavelength: f64) -> f64 {
        match *self {
            Self::Grey(value) => value,
            Self::Color { coefficients, scale } => {
                let range = cie::STEP * (LEN - 1) as f64;
                scale * smooth(coefficients, 2.0 * (wavelength - cie::FIRST) / range - 1.0)
            }
        }
    }
}

fn smooth(c: DVec3, x: f64) -> f64 {
    let t = c.dot(DVec3::new(x * x, x, 1.0));
    0.5 + t / (2.0 * (1.0 + t * t).sqrt())
}

/// By Levenberg and Marquardt's method, from the grey of the mean.
fn coefficients(color: DVec3) -> DVec3 {
    /// Nearer to black or white, spectra are infinitely steep.
    const EDGE: f64 = 1e-4;
    const ITERATIONS: usize = 100;
    let color = color.clamp(DVec3::splat(EDGE), DVec3::splat(1.0 - EDGE));
    let mean = color.element_sum() / 3.0;
    let mut c = DVec3::new(0.0, 0.0, (mean - 0.5) / (mean * (1.0 - mean)).sqrt());
    let mut damping = 1e-4;
    let (mut rest, mut slope) = residual(c, color);
    for _ in 0..ITERATIONS {
        if rest.length_squared() < 1e-16 {
            break;
        }
        let square = slope.transpose() * slope;
        let trace = square.x_axis.x + square.y_axis.y + square.z_axis.z;
        let damped = square + DMat3::from_diagonal(DVec3::splat(damping * trace.max(1e-9)));
        let next = c - damped.inverse() * (slope.transpose() * rest);
        let (next_rest, next_slope) = residual(next, color);
        if next.is_finite() && next_rest.length_squared() < rest.length_squared() {
            (c, rest, slope) = (next, next_rest, next_slope);
            damping = (damping * 0.3).max(1e-12);
        } else {
            damping *= 4.0;
        }
    }
    c
}

/// What the color of coefficients is above the one that is wanted, and its derivatives.
fn residual(c: DVec3, color: DVec3) -> (DVec3, DMat3) {
    WAVELENGTHS.iter().fold((-color, DMat3::ZERO), |(sum, slope), &(x, rgb)| {
        let powers = DVec3::new(x * x, x, 1.0);
        let t = c.dot(powers);
        let root = (1.0 + t * t).sqrt();
        let outer = DMat3::from_cols(rgb * powers.x, rgb * powers.y, rgb * powers.z);
        (sum + rgb * (0.5 + t / (2.0 * root)), slope + outer * (0.5 / (root * root * root)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_spectra_have_their_colors() {
        let colors = [
            [0.63, 0.065, 0.05],
            [0.14, 0.45, 0.091],
            [1.0, 0.378676, 0.013473],
            [0.0, 0.0, 1.0],
            [0.999, 0.9, 0.9],
            [0.2, 0.2, 0.2],
            [1e-9, 1e-7, 0.0],
            [1.0, 0.0, 1.0],
        ];
        for color in colors.map(DVec3::from) {
            let got = Smooth::reflectance(color).map(|rho| rho);
            assert!((got - color).abs().max_element() < 1e-3, "{got}, not {color}");
        }
    }

    #[test]
    fn unbounded_spectra_have_their_colors() {
        for color in
            [[1.65746, 0.880369, 0.521229], [17.0, 12.0, 4.0], [3.0, 3.0, 3.0], [0.0; 3]].map(DVec3::from)
        {
            let spectrum = Smooth::unbounded(color);
            let got = crate::reflectance(|w| spectrum.at(w));
            assert!((got - color).abs().max_element() <= 2e-3 * color.max_element(), "{got}, not {color}");
        }
    }

    /// Two reflections off saturated red do not leave the square of its color.
    #[test]
    fn reflections_off_spectra_are_not_those_off_colors() {
        let color = DVec3::new(0.8, 0.2, 0.05);
        let twice = Smooth::reflectance(color).map(|rho| rho * rho);
        assert!((twice - color * color).abs().max_element() > 0.01, "{twice}");
        assert_eq!(Smooth::reflectance(DVec3::splat(0.3)).map(|rho| rho * rho), DVec3::splat(0.09));
    }
}
