//! Hair and fur: Chiang, Bitterli, Tappan & Burley 2016, "A Practical and Controllable Hair and Fur Model for Production
//! Path Tracing", in the notation of Pharr, Jakob & Humphreys, Physically Based Rendering, 4th edition, §9.9.

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use glam::{Vec2, Vec3};

use crate::interface::dielectric;
use crate::{Bsdf, BsdfSample, Lobes, Rgb};

/// What a [`Hair`] is made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HairInputs {
    /// Absorption on a way as long as the radius.
    pub sigma_a: Rgb,
    /// Index of refraction of the fibre over that around it.
    pub eta: f32,
    /// Roughness along the fibre, in [0, 1].
    pub beta_m: f32,
    /// Roughness around the fibre, in [0, 1].
    pub beta_n: f32,
    /// How far the scales on the fibre are tilted, in radians.
    pub alpha: f32,
    /// Does the fibre run along +X? Else along +Y.
    pub along_x: bool,
}

impl Default for HairInputs {
    fn default() -> Self {
        let sigma_a = pigments(1.3, 0.2);
        Self { sigma_a, eta: 1.55, beta_m: 0.3, beta_n: 0.3, alpha: 2_f32.to_radians(), along_x: false }
    }
}

/// Absorption by pigments of these concentrations (d'Eon et al. 2011, "An Energy-Conserving Hair Reflectance Model").
pub fn pigments(eumelanin: f32, pheomelanin: f32) -> Rgb {
    eumelanin * Rgb::new(0.419, 0.697, 1.37) + pheomelanin * Rgb::new(0.187, 0.4, 1.05)
}

/// The absorption with which hair of this azimuthal roughness is of this color, if light scatters often (Chiang et al., eq.
/// 9).
pub fn absorption_of_color(color: Rgb, beta_n: f32) -> Rgb {
    let root = |c: f32| c.clamp(DARKEST, 1.0).ln() / fit(beta_n);
    color.map(|c| root(c) * root(c))
}

/// The inverse of [`absorption_of_color`].
pub fn color_of_absorption(sigma_a: Rgb, beta_n: f32) -> Rgb {
    sigma_a.map(|s| (-fit(beta_n) * s.max(0.0).sqrt()).exp())
}

fn fit(b: f32) -> f32 {
    5.969 + b * (-0.215 + b * (2.532 + b * (-10.73 + b * (5.574 + b * 0.245))))
}

/// A color is at least this: black would take infinite absorption.
const DARKEST: f32 = 1e-6;

/// Smoother than this is as rough as this: single precision knows no narrower lobes.
const SMOOTHEST: f32 = 0.01;

/// Directions closer to the surface than this are as far from it, so that f is finite.
const GRAZING: f32 = 1e-25;

/// How bright the primaries are.
const LUMINANCE: Rgb = Rgb::new(0.212671, 0.715160, 0.072169);

/// The lobes: R, TT, TRT, and all that are longer.
const LOBES: usize = 4;

/// A fibre, seen from outside, close enough to tell where across it is seen: that is where the viewer is around it.
///
/// Light comes out of where it came in, on all sides. `sample` draws in proportion to f cos, but for color: lobes are drawn as
/// they are bright.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hair {
    sigma_a: Rgb,
    eta: f32,
    along_x: bool,
    /// Longitudinal variances.
    v: [f32; LOBES],
    /// Azimuthal scale of the logistic distribution.
    s: f32,
    /// sin and cos of the tilt of lobes, but for the last, which has none.
    tilts: [(f32, f32); LOBES - 1],
}

/// A direction as the model sees it: θ from the plane across the fibre, φ around it.
#[derive(Clone, Copy)]
struct Around {
    sin_theta: f32,
    cos_theta: f32,
    phi: f32,
}

/// All that depends on `wo` alone.
struct Seen {
    wo: Around,
    gamma_o: f32,
    gamma_t: f32,
    /// What each lobe passes on.
    attenuation: [Rgb; LOBES],
    /// With which probability each is drawn.
    pmf: [f32; LOBES],
}

impl Hair {
    /// From inputs at a point.
    pub fn new(inputs: HairInputs) -> Self {
        let rough = |beta: f32| beta.clamp(SMOOTHEST, 1.0);
        let (m, n) = (rough(inputs.beta_m), rough(inputs.beta_n));
        let v = (0.726 * m + 0.812 * m * m + 3.7 * m.powi(20)).powi(2);
        let s = (0.265 * n + 1.194 * n * n + 5.372 * n.powi(22)) * (PI / 8.0).sqrt();
        let alpha = inputs.alpha;
        Self {
            sigma_a: inputs.sigma_a.max(Rgb::ZERO),
            eta: inputs.eta,
            along_x: inputs.along_x,
            v: [v, 0.25 * v, 4.0 * v, 4.0 * v],
            s,
            tilts: [2.0 * alpha, -alpha, -4.0 * alpha].map(f32::sin_cos),
        }
    }

    fn around(&self, w: Vec3) -> Around {
        let (along, across) = if self.along_x { (w.x, -w.y) } else { (w.y, w.x) };
        let cos_theta = (across * across + w.z * w.z).sqrt().min(1.0);
        Around { sin_theta: along.clamp(-1.0, 1.0), cos_theta, phi: w.z.atan2(across) }
    }

    fn direction(&self, w: Around) -> Vec3 {
        let (sin, cos) = w.phi.sin_cos();
        let (across, z) = (w.cos_theta * cos, w.cos_theta * sin);
        if self.along_x { Vec3::new(w.sin_theta, -across, z) } else { Vec3::new(across, w.sin_theta, z) }
    }

    fn seen(&self, wo: Vec3) -> Seen {
        let wo = self.around(wo);
        // The normal is at φ = π / 2.
        let gamma_o = wo.phi - 0.5 * PI;
        let h = gamma_o.sin();
        let sin_theta_t = (wo.sin_theta / self.eta).clamp(-1.0, 1.0);
        let cos_theta_t = (1.0 - sin_theta_t * sin_theta_t).sqrt();
        // The index that refracts what is seen across the fibre (Bravais).
        let eta = (self.eta * self.eta - wo.sin_theta * wo.sin_theta).max(0.0).sqrt();
        let sin_gamma_t = (h * wo.cos_theta / eta.max(f32::MIN_POSITIVE)).clamp(-1.0, 1.0);
        let cos_gamma_t = (1.0 - sin_gamma_t * sin_gamma_t).sqrt();
        let way = 2.0 * cos_gamma_t / cos_theta_t.max(f32::MIN_POSITIVE);
        let transmittance = (-self.sigma_a * way).exp();
        let attenuation = self.attenuation(wo.cos_theta * gamma_o.cos().abs(), transmittance);
        let shares = attenuation.map(|a| a.dot(LUMINANCE));
        let sum: f32 = shares.iter().sum();
        let pmf = shares.map(|share| share / sum);
        Seen { wo, gamma_o, gamma_t: sin_gamma_t.asin(), attenuation, pmf }
    }

    /// A_p: of reflection, and of ways that pass the fibre once, twice, and more often.
    fn attenuation(&self, cos: f32, transmittance: Rgb) -> [Rgb; LOBES] {
        let f = 1.0 - dielectric(cos, self.eta).transmittance;
        let tt = (1.0 - f) * (1.0 - f) * transmittance;
        let trt = f * tt * transmittance;
        let again = (1.0 - f * transmittance).max(Rgb::splat(f32::MIN_POSITIVE));
        [Rgb::splat(f), tt, trt, f * trt * transmittance / again]
    }

    /// sin θ and cos θ of the viewer, for scales that are tilted.
    fn tilted(&self, wo: &Around, p: usize) -> (f32, f32) {
        let Some(&(sin, cos)) = self.tilts.get(p) else { return (wo.sin_theta, wo.cos_theta) };
        let (sin_theta, cos_theta) =
            (wo.sin_theta * cos - wo.cos_theta * sin, wo.cos_theta * cos + wo.sin_theta * sin);
        (sin_theta, cos_theta.abs())
    }

    /// f cos and the density of all lobes.
    fn f_cos_pdf(&self, seen: &Seen, wi: &Around) -> (Rgb, f32) {
        let (mut f_cos, mut pdf) = (Rgb::ZERO, 0.0);
        for p in 0..LOBES {
            let along = longitudinal(wi, self.tilted(&seen.wo, p), self.v[p]);
            let around = match p + 1 < LOBES {
                true => azimuthal(wi.phi - seen.wo.phi - seen.exit(p), self.s),
                false => 0.5 * FRAC_1_PI,
            };
            f_cos += seen.attenuation[p] * (along * around);
            pdf += seen.pmf[p] * (along * around);
        }
        (f_cos, pdf)
    }
}

impl Seen {
    /// Φ: how far around a smooth fibre turns what passes it `p` times.
    fn exit(&self, p: usize) -> f32 {
        let p = p as f32;
        2.0 * p * self.gamma_t - 2.0 * self.gamma_o + p * PI
    }
}

/// M_p: the density along sin θ of a direction, of variance v around the mirrored direction (d'Eon et al. 2011, eq. 7).
fn longitudinal(wi: &Around, (sin_o, cos_o): (f32, f32), v: f32) -> f32 {
    let (sin_i, cos_i) = (f64::from(wi.sin_theta), f64::from(wi.cos_theta));
    let (sin_o, cos_o, v) = (f64::from(sin_o), f64::from(cos_o), f64::from(v));
    let peak = (cos_i * cos_o - sin_i * sin_o - 1.0) / v;
    let scale = v * (1.0 - (-2.0 / v).exp());
    (bessel_i0_scaled(cos_i * cos_o / v) * peak.min(0.0).exp() / scale) as f32
}

/// exp(−x) I₀(x) for x ≥ 0, to 2 · 10⁻⁷ (Abramowitz & Stegun 1964, 9.8.1 and 9.8.2).
fn bessel_i0_scaled(x: f64) -> f64 {
    let polynomial = |coefficients: &[f64], t: f64| coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c);
    if x < 3.75 {
        const SMALL: [f64; 7] =
            [1.0, 3.515_622_9, 3.089_942_4, 1.206_749_2, 0.265_973_2, 0.036_076_8, 0.004_581_3];
        return (-x).exp() * polynomial(&SMALL, (x / 3.75).powi(2));
    }
    const LARGE: [f64; 9] = [
        0.398_942_28,
        0.013_285_92,
        0.002_253_19,
        -0.001_575_65,
        0.009_162_81,
        -0.020_577_06,
        0.026_355_37,
        -0.016_476_33,
        0.003_923_77,
    ];
    polynomial(&LARGE, 3.75 / x) / x.sqrt()
}

/// N_p: the density of an angle around, off that of a smooth fibre: a logistic distribution between −π and π.
fn azimuthal(phi: f32, s: f32) -> f32 {
    let off = (phi - TAU * (phi / TAU).round()).abs();
    let e = (-off / s).exp();
    e / (s * (1.0 + e) * (1.0 + e) * (0.5 * PI / s).tanh())
}

fn sample_azimuthal(u: f32, s: f32) -> f32 {
    let u = 0.5 + (u - 0.5) * (0.5 * PI / s).tanh();
    (s * (u / (1.0 - u)).ln()).clamp(-PI, PI)
}

impl Bsdf for Hair {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.f_cos_pdf(&self.seen(wo), &self.around(wi)).0 / wi.z.abs().max(GRAZING)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let seen = self.seen(wo);
        // What is left of the uniform that chose the lobe chooses φ.
        let (mut p, mut left) = (0, u_lobe);
        while p + 1 < LOBES && left >= seen.pmf[p] {
            left -= seen.pmf[p];
            p += 1;
        }
        let u_phi = (left / seen.pmf[p]).clamp(0.0, 1.0 - f32::EPSILON);
        let (sin_o, cos_o) = self.tilted(&seen.wo, p);
        let v = self.v[p];
        // Away from the mirrored direction, and in which direction away.
        let cos =
            (1.0 + v * (u.x + (1.0 - u.x) * (-2.0 / v).exp()).max(f32::MIN_POSITIVE).ln()).clamp(-1.0, 1.0);
        let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
        let sin_theta = (sin * (TAU * u.y).cos() * cos_o - cos * sin_o).clamp(-1.0, 1.0);
        let cos_theta = ((1.0 - sin_theta) * (1.0 + sin_theta)).sqrt();
        let turn = if p + 1 < LOBES { seen.exit(p) + sample_azimuthal(u_phi, self.s) } else { TAU * u_phi };
        let wi = self.direction(Around { sin_theta, cos_theta, phi: seen.wo.phi + turn }).normalize();
        let (f_cos, pdf) = self.f_cos_pdf(&seen, &self.around(wi));
        let weight = f_cos / pdf;
        (pdf > f32::MIN_POSITIVE && pdf.is_finite() && weight != Rgb::ZERO).then_some(BsdfSample {
            wi,
            weight,
            pdf,
            delta: false,
            eta: 1.0,
        })
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.f_cos_pdf(&self.seen(wo), &self.around(wi)).1
    }

    fn lobes(&self) -> Lobes {
        Lobes { reflection: true, transmission: true, delta: false }
    }

    /// Of light across the fibre, half way between its middle and its rim.
    fn albedo(&self) -> Rgb {
        self.seen(Vec3::new(0.5, 0.0, 0.75_f32.sqrt())).attenuation.iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bessel_function_is_its_series() {
        for x in [0.0_f64, 0.3, 2.0, 3.74, 3.76, 8.0, 20.0] {
            let (mut term, mut sum) = (1.0, 1.0);
            for k in 1..200 {
                term *= (0.5 * x / f64::from(k)).powi(2);
                sum += term;
            }
            assert!((bessel_i0_scaled(x) / (sum * (-x).exp()) - 1.0).abs() < 1e-6, "{x}");
        }
        assert!((bessel_i0_scaled(1e6) * (1e6 * std::f64::consts::TAU).sqrt() - 1.0).abs() < 1e-6);
    }

    /// Which axis the fibre runs along is a matter of the frame.
    #[test]
    fn a_turned_fibre_is_the_same() {
        let inputs = HairInputs { beta_m: 0.2, beta_n: 0.25, ..HairInputs::default() };
        let (y, x) = (Hair::new(inputs), Hair::new(HairInputs { along_x: true, ..inputs }));
        // From (across, along, normal) to (along, −across, normal).
        let turned = |w: Vec3| Vec3::new(w.y, -w.x, w.z);
        let (wo, wi) = (Vec3::new(0.3, -0.2, 0.8).normalize(), Vec3::new(-0.5, 0.7, -0.4).normalize());
        assert!((y.eval(wo, wi) / x.eval(turned(wo), turned(wi)) - 1.0).abs().max_element() < 1e-5);
        let (a, b) = (y.sample(wo, 0.4, Vec2::new(0.3, 0.6)), x.sample(turned(wo), 0.4, Vec2::new(0.3, 0.6)));
        let (a, b) = (a.unwrap(), b.unwrap());
        assert!((turned(a.wi) - b.wi).length() < 1e-5 && (a.pdf / b.pdf - 1.0).abs() < 1e-4);
    }

    /// Light that comes at the middle of a clear, smooth fibre goes mostly straight through.
    #[test]
    fn clear_hair_is_a_lens() {
        let clear =
            Hair::new(HairInputs { sigma_a: Rgb::ZERO, beta_m: 0.1, beta_n: 0.1, ..Default::default() });
        let ahead = clear.eval(Vec3::Z, -Vec3::Z).x;
        assert!(ahead > 10.0 * clear.eval(Vec3::Z, Vec3::Z).x, "{ahead}");
    }

    #[test]
    fn absorption_gives_the_color_back() {
        let color = Rgb::new(0.6, 0.3, 0.1);
        let sigma_a = absorption_of_color(color, 0.3);
        assert!(sigma_a.x < sigma_a.y && sigma_a.y < sigma_a.z);
        assert!((color_of_absorption(sigma_a, 0.3) - color).abs().max_element() < 1e-6);
        assert_eq!(absorption_of_color(Rgb::ONE, 0.3), Rgb::ZERO);
        assert!(absorption_of_color(Rgb::ZERO, 0.3).is_finite());
        assert!((pigments(1.3, 0.2) - Rgb::new(0.5821, 0.9861, 1.991)).abs().max_element() < 1e-5);
    }
}
