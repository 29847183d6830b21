//! Rough diffuse reflection that preserves energy: EON (Portsmouth, Kutz & Hill 2025, "EON: A Practical
//! Energy-Preserving Rough Diffuse BRDF").

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use glam::{Vec2, Vec3};
use sr_sampling::Distribution;
use sr_sampling::warp::UniformHemisphere;

use crate::{Bsdf, BsdfSample, Lobes, Rgb};

/// Oren and Nayar's rough diffuse surface in Fujii's form, with the light that bounces between its facets, on the side
/// of +Z. A white one returns all light.
///
/// Sampled by the paper's clipped linearly transformed cosine, mixed with uniform directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eon {
    albedo: Rgb,
    roughness: f32,
}

/// The albedo of Fujii's model, A (1 + c₁ r) = 1, and its mean over the hemisphere, A (1 + c₂ r) (eqs. 12 and 26).
const C1: f32 = 0.5 - 2.0 / (3.0 * PI);
const C2: f32 = 2.0 / 3.0 - 28.0 / (15.0 * PI);

impl Eon {
    /// - `albedo`: the colour ρ of the facets, per channel in [0, 1]; what is reflected is a little darker
    /// - `roughness`: brought into [0, 1]; 0 is Lambertian
    pub fn new(albedo: Rgb, roughness: f32) -> Self {
        Self { albedo: albedo.clamp(Rgb::ZERO, Rgb::ONE), roughness: roughness.clamp(0.0, 1.0) }
    }

    #[inline(always)]
    fn a(&self) -> f32 {
        1.0 / (1.0 + C1 * self.roughness)
    }

    /// The fraction that one bounce returns of light at an angle, for ρ = 1 (eq. 20, without its poles).
    #[inline(always)]
    fn single_albedo(&self, mu: f32) -> f32 {
        let si = (1.0 - mu * mu).max(0.0).sqrt();
        // (1 − s³) / μ = μ (1 + s + s²) / (1 + s), as 1 − s² = μ².
        let rest = si * mu * (1.0 + si + si * si) / (1.0 + si);
        let g = si * (mu.clamp(0.0, 1.0).acos() - si * mu) + 2.0 / 3.0 * (rest - si);
        self.a() * (1.0 + self.roughness * FRAC_1_PI * g)
    }

    /// All that the surface reflects of light at an angle.
    #[inline(always)]
    fn albedo_at(&self, mu: f32) -> Rgb {
        let single = self.single_albedo(mu);
        self.albedo * single + self.many_bounces() * (1.0 - single)
    }

    /// How much comes back of light that has bounced once without leaving.
    #[inline(always)]
    fn many_bounces(&self) -> Rgb {
        let mean = self.a() * (1.0 + C2 * self.roughness);
        self.albedo * self.albedo * mean / (Rgb::ONE - self.albedo * (1.0 - mean))
    }

    /// The probability of a uniform direction (listing 3).
    #[inline(always)]
    fn p_uniform(&self, mu: f32) -> f32 {
        self.roughness.powf(0.1) * (0.162_925 + mu * (-0.372_058 + (0.538_233 - 0.290_822 * mu) * mu))
    }
}

/// A cosine lobe, linearly transformed, of which only what stays above the horizon is sampled (listing 2). In the frame
/// where `wo` has no y.
struct ClippedCosine {
    a: f32,
    b: f32,
    c: f32,
    d: f32,
    /// The share of the unit disk that is sampled.
    s: f32,
}

impl ClippedCosine {
    fn new(mu: f32, r: f32) -> Self {
        let a =
            1.0 + r * (0.303_392 + (-0.518_982 + 0.111_709 * mu) * mu + (-0.276_266 + 0.335_918 * mu) * r);
        let b =
            r * (-1.164_07 + 1.158_59 * mu + (0.150_815 - 0.150_105 * mu) * r) / (mu * mu * mu - 1.435_45);
        let c = 1.0 + (0.200_13 + (-0.506_373 + 0.261_777 * mu) * mu) * r;
        let d = (0.540_852 + (-1.016_25 + 0.475_392 * mu) * mu) * r / (-1.0743 + mu * (0.072_562_8 + mu));
        Self { a, b, c, d, s: 0.5 * (1.0 + 1.0 / (d * d + 1.0).sqrt()) }
    }

    #[inline(always)]
    fn determinant(&self) -> f32 {
        self.c * (self.a - self.b * self.d)
    }

    fn sample(&self, u: Vec2) -> Vec3 {
        let (sin, cos) = (TAU * u.y).sin_cos();
        let (r, y) = (u.x.sqrt(), u.x.sqrt() * sin);
        let edge = (1.0 - y * y).max(0.0).sqrt();
        let x = -(edge + (r * cos - edge) * self.s);
        let z = (1.0 - x * x - y * y).max(0.0).sqrt();
        Vec3::new(self.a * x + self.b * z, self.c * y, self.d * x + z).normalize_or_zero()
    }

    #[inline(always)]
    fn pdf(&self, w: Vec3) -> f32 {
        let Self { a, b, c, d, s } = self;
        // Up to the determinant, the inverse of the transformation.
        let h = Vec3::new(c * (w.x - b * w.z), (a - b * d) * w.y, -c * (d * w.x - a * w.z));
        let det = self.determinant();
        let length2 = h.length_squared();
        det * det / (length2 * length2) * h.z.max(0.0) * FRAC_1_PI / s
    }
}

/// The azimuth of `wo` as the x axis.
#[inline(always)]
fn azimuth(wo: Vec3) -> Vec2 {
    wo.truncate().try_normalize().unwrap_or(Vec2::X)
}

impl Bsdf for Eon {
    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return Rgb::ZERO;
        }
        let s = wo.truncate().dot(wi.truncate());
        let s_over_t = if s > 0.0 { s / wo.z.max(wi.z) } else { s };
        let single = self.albedo * (self.a() * (1.0 + self.roughness * s_over_t));
        let left = |mu: f32| (1.0 - self.single_albedo(mu)).max(0.0);
        let mean_left = 1.0 - self.a() * (1.0 + C2 * self.roughness);
        let share = if mean_left > 0.0 { left(wo.z) * left(wi.z) / mean_left } else { 0.0 };
        (single + self.many_bounces() * share) * FRAC_1_PI
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        let wi = if u_lobe < self.p_uniform(wo.z) {
            UniformHemisphere.sample(u)?.value
        } else {
            let local = ClippedCosine::new(wo.z, self.roughness).sample(u);
            azimuth(wo).rotate(local.truncate()).extend(local.z)
        };
        let pdf = self.pdf(wo, wi);
        (wi.z > 0.0 && pdf > 0.0).then(|| BsdfSample {
            wi,
            weight: self.eval(wo, wi) * (wi.z / pdf),
            pdf,
            delta: false,
            eta: 1.0,
        })
    }

    #[inline(always)]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return 0.0;
        }
        let p_uniform = self.p_uniform(wo.z);
        let local = (azimuth(wo) * Vec2::new(1.0, -1.0)).rotate(wi.truncate()).extend(wi.z);
        let lobe = ClippedCosine::new(wo.z, self.roughness).pdf(local);
        p_uniform / TAU + (1.0 - p_uniform) * lobe
    }

    fn lobes(&self) -> Lobes {
        Lobes { reflection: true, transmission: false, delta: false }
    }

    fn albedo(&self) -> Rgb {
        self.albedo_at(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ f cos θᵢ dωᵢ, by the midpoint rule in (cos² θ, φ).
    fn albedo(bsdf: &impl Bsdf, wo: Vec3) -> f64 {
        let n = 400;
        let mut sum = 0.0;
        for i in 0..n {
            let mu = ((i as f32 + 0.5) / n as f32).sqrt();
            for j in 0..n {
                let (sin, cos) = (TAU * (j as f32 + 0.5) / n as f32).sin_cos();
                let wi = (Vec3::new(cos, sin, 0.0) * (1.0 - mu * mu).sqrt()).with_z(mu);
                sum += f64::from(bsdf.eval(wo, wi).y) * std::f64::consts::PI;
            }
        }
        sum / f64::from(n * n)
    }

    /// A furnace: a white surface is white from everywhere; a grey one reflects what is said.
    #[test]
    fn no_energy_is_lost() {
        for roughness in [0.0, 1e-4, 0.3, 1.0] {
            for z in [1.0_f32, 0.6, 0.1, 0.03] {
                let wo = Vec3::new((1.0 - z * z).sqrt(), 0.0, z);
                let white = albedo(&Eon::new(Rgb::ONE, roughness), wo);
                assert!((white - 1.0).abs() < 1e-3, "{roughness} {z}: {white}");
                let grey = Eon::new(Rgb::splat(0.4), roughness);
                let expected = f64::from(grey.albedo_at(z).y);
                assert!((albedo(&grey, wo) - expected).abs() < 1e-3, "{roughness} {z}");
            }
        }
    }

    #[test]
    fn without_roughness_it_is_lambertian() {
        let (wo, wi) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.36, 0.48, 0.8));
        let (eon, diffuse) = (Eon::new(Rgb::splat(0.3), 0.0), crate::Diffuse::new(Rgb::splat(0.3)));
        assert!((eon.eval(wo, wi) - diffuse.eval(wo, wi)).length() < 1e-6);
        assert!((eon.pdf(wo, wi) - diffuse.pdf(wo, wi)).abs() < 1e-6);
    }
}
