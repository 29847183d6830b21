//! How much light a rough dielectric interface lets through, at any angle.
//!
//! In: a microfacet distribution and an index. Out: numbers that are the same at every point of the material.

use std::f64::consts::PI;

use glam::{Vec2, Vec3};

use crate::interface::{dielectric, reflect_about, refract_about};
use crate::{Microfacet, MicrofacetKind};

/// Terms of the polynomial that tells how much a coating lets through.
const TERMS: usize = 16;
/// Cosines, equally spaced from 0 to 1, at which the reflectance of diffuse light is asked for (as many as Mitsuba asks).
const COSINES: usize = 64;
/// Points of the rule that integrates over visible normals, per dimension.
const QUADRATURE: usize = 48;

/// What is the same at every point of a rough coating; made once per material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughCoat {
    distribution: Microfacet,
    eta: f32,
    internal_reflectance: f32,
    transmittance: Curve,
}

impl RoughCoat {
    /// Integrates over the visible normals of a coating; takes about 2 · 10⁵ evaluations.
    ///
    /// - `alpha`: roughness, the same in all directions
    /// - `eta`: index of the coating over that of its surroundings, positive
    pub fn new(kind: MicrofacetKind, alpha: f32, eta: f32) -> Self {
        let distribution = Microfacet::isotropic(kind, alpha);
        let transmittance = Curve::through(alpha, |cos| {
            mean_over_visible_normals(&distribution, cos, |wo, m| {
                let split = dielectric(wo.dot(m), eta);
                let wi = refract_about(wo, m, split);
                if wi.z < 0.0 { split.transmittance * distribution.g2_over_g1(wo, wi) } else { 0.0 }
            })
        });
        let cosine = |i: usize| (i as f32 / (COSINES - 1) as f32).max(1e-6);
        let internal_reflectance = (0..COSINES)
            .map(|i| 2.0 * cosine(i) * reflectance(&distribution, 1.0 / eta, cosine(i)))
            .sum::<f32>()
            / COSINES as f32;
        Self { distribution, eta, internal_reflectance, transmittance }
    }

    /// A coating that loses nothing: what it does not reflect in one bounce it lets in, and the same is so from
    /// inside. A white base below is then white from everywhere.
    pub fn lossless(kind: MicrofacetKind, alpha: f32, eta: f32) -> Self {
        let distribution = Microfacet::isotropic(kind, alpha);
        let transmittance = Curve::through(alpha, |cos| 1.0 - reflectance(&distribution, eta, cos));
        // Light may travel either way: the diffuse light that leaves is that which enters, over η².
        let internal_reflectance = 1.0 - transmittance.mean() / (eta * eta);
        Self { distribution, eta, internal_reflectance, transmittance }
    }

    /// The distribution of the coating's normals.
    #[inline(always)]
    pub fn distribution(&self) -> &Microfacet {
        &self.distribution
    }

    /// The index of the coating over that of its surroundings.
    #[inline(always)]
    pub fn eta(&self) -> f32 {
        self.eta
    }

    /// The fraction of diffuse light from inside that the coating reflects, 2 ∫ R(μ) μ dμ.
    ///
    /// It is the plain mean of 2 R(μ) μ over 64 cosines from 0 to 1, as in Mitsuba. That is below the integral
    /// by up to 0.009 and makes the base up to 2 % darker (η = 1.5), but images agree with Mitsuba's. (Of a lossless
    /// coating it is exact.)
    #[inline(always)]
    pub fn internal_reflectance(&self) -> f32 {
        self.internal_reflectance
    }

    /// The fraction of light from outside that the coating lets in, at cos θ in [0, 1].
    #[inline(always)]
    pub fn transmittance(&self, cos: f32) -> f32 {
        self.transmittance.at(cos)
    }

    /// The same at any angle.
    #[inline(always)]
    pub(crate) fn transmittances(&self) -> Curve {
        self.transmittance
    }
}

/// The fraction of light that an interface reflects in one bounce.
fn reflectance(d: &Microfacet, eta: f32, cos: f32) -> f32 {
    mean_over_visible_normals(d, cos, |wo, m| {
        let wi = reflect_about(wo, m);
        let f = dielectric(wo.dot(m), eta).reflectance;
        if wi.z > 0.0 { f * d.g2_over_g1(wo, wi) } else { 0.0 }
    })
}

/// A fraction as a function of μ = cos θ in [0, 1]: a polynomial in μ / (μ + √α), for what a coating lets through changes
/// fastest at grazing angles, the more so the smoother it is. Within 10⁻³ for α ≥ 0.01, and 6 · 10⁻³ for less; 64 equally spaced entries of a table, as
/// Mitsuba has them, are off by up to 5 · 10⁻². And a loop over many points has nothing to look up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Curve {
    /// √α.
    bend: f32,
    /// Of the powers of t = (μ (1 + 2 √α) − √α) / (μ + √α), which goes from −1 to 1, the lowest first.
    coefficients: [f32; TERMS],
}

impl Curve {
    /// Interpolates at Chebyshev's nodes.
    fn through(alpha: f32, at_cosine: impl Fn(f32) -> f32) -> Self {
        let bend = alpha.sqrt().max(0.02);
        let angle = |k: usize| PI * (k as f64 + 0.5) / TERMS as f64;
        let values: [f64; TERMS] = std::array::from_fn(|k| {
            let (t, bend) = (angle(k).cos(), f64::from(bend));
            f64::from(at_cosine((bend * (1.0 + t) / (1.0 + 2.0 * bend - t)) as f32))
        });
        // Σ c_j T_j, where T_0 = 1, T_1 = t and T_j = 2 t T_j₋₁ − T_j₋₂, as a sum of powers.
        let mut sum = [0.0; TERMS];
        let (mut before, mut chebyshev) = ([0.0; TERMS], [0.0; TERMS]);
        chebyshev[0] = 1.0;
        for j in 0..TERMS {
            let factor = if j == 0 { 1.0 } else { 2.0 };
            let c = (0..TERMS).map(|k| values[k] * (j as f64 * angle(k)).cos()).sum::<f64>() * factor;
            for (sum, power) in sum.iter_mut().zip(chebyshev) {
                *sum += c / TERMS as f64 * power;
            }
            let raised = |i: usize| if i == 0 { 0.0 } else { factor * chebyshev[i - 1] };
            let next = std::array::from_fn(|i| raised(i) - before[i]);
            (before, chebyshev) = (chebyshev, next);
        }
        Self { bend, coefficients: sum.map(|c| c as f32) }
    }

    /// At a cosine; between 0 and 1.
    #[inline(always)]
    pub fn at(&self, cos: f32) -> f32 {
        let cos = cos.clamp(0.0, 1.0);
        let t = (cos * (1.0 + 2.0 * self.bend) - self.bend) / (cos + self.bend);
        // Even and odd powers by themselves, for they need not wait for each other.
        let square = t * t;
        let [mut even, mut odd] = [self.coefficients[TERMS - 2], self.coefficients[TERMS - 1]];
        for j in (0..TERMS / 2 - 1).rev() {
            even = even * square + self.coefficients[2 * j];
            odd = odd * square + self.coefficients[2 * j + 1];
        }
        (even + t * odd).clamp(0.0, 1.0)
    }

    /// Of diffuse light: 2 ∫ T μ dμ = 4 ∫ T s³ ds where μ = s², by the midpoint rule.
    fn mean(&self) -> f32 {
        const POINTS: usize = 4096;
        let at = |i: usize| {
            let s = (i as f64 + 0.5) / POINTS as f64;
            4.0 * s * s * s * f64::from(self.at((s * s) as f32))
        };
        ((0..POINTS).map(at).sum::<f64>() / POINTS as f64) as f32
    }
}

/// The mean of `f(wo, m)` over the normals `m` that `wo`, at cos θ = `cos`, sees: on a grid of the unit square, see
/// [`at_tails`].
pub(crate) fn mean_over_visible_normals(d: &Microfacet, cos: f32, f: impl Fn(Vec3, Vec3) -> f32) -> f32 {
    let wo = seen_from(cos);
    let rule: [(f32, f32); QUADRATURE] =
        std::array::from_fn(|i| at_tails((i as f32 + 0.5) / QUADRATURE as f32));
    let slope = |u: Vec2| {
        let m = d.sample_visible(wo, u);
        m.truncate() / m.z
    };
    // Beckmann's slopes along the azimuth of `wo` come from one number, those across from the other.
    let slopes = (d.kind() == MicrofacetKind::Beckmann)
        .then(|| rule.map(|(u, _)| [slope(Vec2::new(u, 0.5)).x, slope(Vec2::new(0.5, u)).y]));
    let normal = |i: usize, j: usize| match &slopes {
        Some(slopes) => Vec3::new(slopes[i][0], slopes[j][1], 1.0).normalize(),
        None => d.sample_visible(wo, Vec2::new(rule[i].0, rule[j].0)),
    };
    let (mut sum, mut total) = (0.0, 0.0);
    for (i, j) in (0..QUADRATURE).flat_map(|i| (0..QUADRATURE).map(move |j| (i, j))) {
        let weight = f64::from(rule[i].1 * rule[j].1);
        sum += weight * f64::from(f(wo, normal(i, j)));
        total += weight;
    }
    (sum / total) as f32
}

/// The same where `f` jumps, so that a grid would be a thousandth off and more: at a Fibonacci lattice of 17711 points
/// (Zaremba 1966), whose rows are not along any axis.
pub(crate) fn mean_where_it_jumps(d: &Microfacet, cos: f32, f: impl Fn(Vec3, Vec3) -> f32) -> f32 {
    let wo = seen_from(cos);
    lattice_of_normals(d, wo, [10_946, 17_711]).map(|(weight, m)| weight * f64::from(f(wo, m))).sum::<f64>()
        as f32
}

/// Normals that `wo` sees, and their weights, which add up to 1: a Fibonacci lattice of `points`, of which the one before in
/// the sequence is `turn`.
pub(crate) fn lattice_of_normals(
    d: &Microfacet,
    wo: Vec3,
    [turn, points]: [u32; 2],
) -> impl Iterator<Item = (f64, Vec3)> {
    let shared = move |i: u32| at_tails((i as f32 + 0.5) / points as f32);
    // u (1 − u) has the mean 1/6 along either axis.
    let total = f64::from(points) / 36.0;
    (0..points).map(move |i| {
        let at = (u64::from(i) * u64::from(turn) % u64::from(points)) as u32;
        let ((u, along), (v, across)) = (shared(i), shared(at));
        (f64::from(along * across) / total, d.sample_visible(wo, Vec2::new(u, v)))
    })
}

/// Of diffuse light from inside, how much an interface of roughness `alpha` reflects in one bounce, 2 ∫ R(μ) μ dμ, to 10⁻³: by
/// 16384 points of the additive recurrence of the generalized golden ratio (Roberts 2018), in the cosine and the normal.
///
/// - `depth`: optical depth of what lies between the light's source and the interface, crossed twice; 0 is clear
///
/// [`RoughCoat::new`] has a little less, see [`RoughCoat::internal_reflectance`].
///
/// ```
/// let smooth = sr_bsdf::interface::diffuse_reflectance(1.0 / 1.5);
/// let rough = sr_bsdf::rough_internal_reflectance(sr_bsdf::MicrofacetKind::Ggx, 0.1, 1.5, 0.0);
/// assert!((smooth - 0.596).abs() < 1e-3 && (rough - 0.560).abs() < 2e-3);
/// ```
pub fn rough_internal_reflectance(kind: MicrofacetKind, alpha: f32, eta: f32, depth: f32) -> f32 {
    const POINTS: u32 = 16_384;
    /// Solves x⁴ = x + 1.
    const RATIO: f64 = 1.220_744_084_605_759_5;
    let d = Microfacet::isotropic(kind, alpha);
    let [a, b, c] = [1, 2, 3].map(|power| RATIO.powi(-power));
    let (mut sum, mut total) = (0.0, 0.0);
    for i in 0..POINTS {
        let [square, u, v] = [a, b, c].map(|step| (0.5 + f64::from(i) * step).fract() as f32);
        let ((u, along), (v, across)) = (at_tails(u), at_tails(v));
        let wo = seen_from(square.sqrt());
        let m = d.sample_visible(wo, Vec2::new(u, v));
        let wi = reflect_about(wo, m);
        let weight = f64::from(along * across);
        total += weight;
        if wi.z > 0.0 {
            let f = dielectric(wo.dot(m), 1.0 / eta).reflectance;
            let passes = (-depth * (1.0 / wo.z + 1.0 / wi.z)).exp();
            sum += weight * f64::from(f * d.g2_over_g1(wo, wi) * passes);
        }
    }
    (sum / total) as f32
}

pub(crate) fn seen_from(cos: f32) -> Vec3 {
    Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos)
}

/// A uniform number from an evenly spread one, and its weight: u = 3t² − 2t³, whose weight, in proportion to t (1 − t),
/// vanishes where the normals' tails, at the edges of the unit square, are singular.
fn at_tails(t: f32) -> (f32, f32) {
    (t * t * (3.0 - 2.0 * t), t * (1.0 - t))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Away from grazing angles, a coating that is hardly rough lets through what a smooth one does.
    #[test]
    fn a_nearly_smooth_coating_is_smooth() {
        for kind in [MicrofacetKind::Beckmann, MicrofacetKind::Ggx] {
            let coat = RoughCoat::new(kind, 1e-3, 1.5);
            for cos in [0.4, 0.6, 0.8, 1.0] {
                let smooth = dielectric(cos, 1.5).transmittance;
                assert!((coat.transmittance(cos) - smooth).abs() < 1e-3, "{kind:?} {cos}");
            }
        }
    }

    /// Between the nodes, too, a curve is what the integral is.
    #[test]
    fn the_curve_is_the_integral() {
        for kind in [MicrofacetKind::Beckmann, MicrofacetKind::Ggx, MicrofacetKind::GgxCorrelated] {
            for (alpha, tolerance) in [(1e-3, 6e-3), (0.01, 1e-3), (0.1, 5e-4), (0.4, 2e-4), (1.0, 3e-4)] {
                let coat = RoughCoat::lossless(kind, alpha, 1.5);
                for i in 0..=40 {
                    let cos = (i as f32 / 40.0).powi(2);
                    let exact = 1.0 - reflectance(coat.distribution(), 1.5, cos.max(1e-6));
                    let got = coat.transmittance(cos);
                    assert!((got - exact).abs() < tolerance, "{kind:?} {alpha} {cos}: {got}, not {exact}");
                }
            }
        }
    }

    #[test]
    fn no_coating_lets_through_more_than_all() {
        let coat = RoughCoat::new(MicrofacetKind::Ggx, 1e-3, 1.0001);
        for cos in [-1.0, 0.0, 1e-5, 0.3, 1.0, 1.001] {
            assert!((0.0..=1.0).contains(&coat.transmittance(cos)), "{cos}");
        }
    }

    /// The mean over the grid of Beckmann's slopes, each drawn once, is that over its normals.
    #[test]
    fn slopes_of_a_grid_are_independent() {
        let d = Microfacet::isotropic(MicrofacetKind::Beckmann, 0.4);
        let f = |wo: Vec3, m: Vec3| wo.dot(m) + m.x * m.y * m.y;
        for cos in [1e-6, 0.1, 0.7, 1.0] {
            let (grid, lattice) = (mean_over_visible_normals(&d, cos, f), mean_where_it_jumps(&d, cos, f));
            assert!((grid - lattice).abs() < 3e-4, "{cos}: {grid}, not {lattice}");
        }
    }

    /// Coats have the plain mean of 64 cosines from 0 to 1: the trapezoidal rule and one 64th of half of both ends more, of
    /// 63 steps instead of 64.
    #[test]
    fn internal_reflectances_are_the_integral_but_for_their_rule() {
        for (alpha, eta) in [(1e-3, 1.5), (0.1, 1.5), (0.4, 1.3), (1.0, 2.0)] {
            let exact = rough_internal_reflectance(MicrofacetKind::Ggx, alpha, eta, 0.0);
            let coat = RoughCoat::new(MicrofacetKind::Ggx, alpha, eta);
            let d = coat.distribution();
            let same = (63.0 * exact + reflectance(d, 1.0 / eta, 1.0)) / 64.0;
            let got = coat.internal_reflectance();
            assert!((got - same).abs() < 2e-3, "{alpha} {eta}: {got}, not {same}");
        }
    }

    /// Recovered from values of Mitsuba 3.9.1's `roughplastic` (η = 1.5) with linear and nonlinear base:
    /// R, and T at cosines 8/63, 32/63 and 63/63. Mitsuba's Beckmann masking is a fit, off by 0.3 %.
    #[test]
    fn coats_are_those_of_mitsuba() {
        use MicrofacetKind::{Beckmann, Ggx};
        let golden = [
            (Ggx, 0.1, 0.55189, [0.63701, 0.90896, 0.95956], 1e-3),
            (Ggx, 0.3, 0.41486, [0.73111, 0.88856, 0.95316], 1e-3),
            (Ggx, 1.0, 0.11742, [0.38481, 0.65617, 0.88081], 1e-3),
            (Beckmann, 0.1, 0.58096, [0.56781, 0.91163, 0.96000], 2e-3),
            (Beckmann, 0.3, 0.52997, [0.74576, 0.90362, 0.95977], 2e-3),
            (Beckmann, 1.0, 0.23378, [0.69134, 0.86808, 0.94743], 2e-3),
        ];
        for (kind, alpha, r, t, tolerance) in golden {
            let coat = RoughCoat::new(kind, alpha, 1.5);
            assert!((coat.internal_reflectance() - r).abs() < 1e-3, "{kind:?} {alpha}: {coat:?}");
            for (i, t) in [8, 32, 63].into_iter().zip(t) {
                let got = coat.transmittance(i as f32 / 63.0);
                assert!((got - t).abs() < tolerance, "{kind:?} {alpha} at {i}: {got}, not {t}");
            }
        }
    }
}
