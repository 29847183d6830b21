//! Microfacets: how the normals of a rough surface are distributed, and which of them are seen.
//!
//! In: directions and unit normals m in the local frame. Out: densities. Everything is written with the
//! projected area σ(w) = |cos θ| (1 + Λ(w)) = ∫ max(0, w · m) D(m) dm rather than with the masking
//! G₁(w) = |cos θ| / σ(w): σ has no pole or 0/0 at grazing angles.
//!
//! Masking and shadowing are taken as independent, G = G₁(wo) G₁(wi), as Mitsuba does (its images then
//! agree with ours), or, with [`MicrofacetKind::GgxCorrelated`], as correlated by height, as pbrt does; a facet seen from
//! below its own face is masked.

use std::f32::consts::FRAC_1_PI;

use glam::{Vec2, Vec3};

use crate::{MicrofacetKind, MicrofacetShape};

/// A distribution of microfacet normals, with roughness along x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Microfacet<S = MicrofacetKind> {
    shape: S,
    alpha: Vec2,
    /// Of `alpha`: what divisions by it are done with.
    inverse: Vec2,
}

/// The normal of a facet, of any length: what a half vector is before it is normalised. Densities do not need more.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facet {
    normal: Vec3,
    length_squared: f32,
}

impl Facet {
    /// The mirror between two directions.
    #[inline(always)]
    pub fn between(wo: Vec3, wi: Vec3) -> Self {
        let normal = wo + wi;
        Self { normal, length_squared: normal.length_squared() }
    }

    /// Of a unit normal.
    #[inline(always)]
    pub fn of(m: Vec3) -> Self {
        Self { normal: m, length_squared: 1.0 }
    }

    /// Is `w` on the side of the normal?
    #[inline(always)]
    pub fn is_seen_from(&self, w: Vec3) -> bool {
        self.normal.dot(w) >= 0.0
    }

    /// The cosine between the normal and either of the two unit vectors that it is the half of.
    #[inline(always)]
    pub fn half_cos(&self) -> f32 {
        (0.5 * self.length_squared.sqrt()).min(1.0)
    }
}

impl Microfacet {
    /// The smallest roughness that is told from a smooth surface.
    pub const MIN_ALPHA: f32 = 1e-4;
    /// The largest roughness; the normals are all but horizontal.
    pub const MAX_ALPHA: f32 = 1e2;
}

impl<S: MicrofacetShape> Microfacet<S> {
    /// From roughness along x and y, brought into [`Microfacet::MIN_ALPHA`]`..=`[`Microfacet::MAX_ALPHA`].
    #[inline(always)]
    pub fn new(shape: S, alpha_x: f32, alpha_y: f32) -> Self {
        let (low, high) = (Vec2::splat(Microfacet::MIN_ALPHA), Vec2::splat(Microfacet::MAX_ALPHA));
        let alpha = Vec2::new(alpha_x, alpha_y).max(low).min(high);
        Self { shape, alpha, inverse: alpha.recip() }
    }

    /// The same roughness in all directions.
    #[inline(always)]
    pub fn isotropic(shape: S, alpha: f32) -> Self {
        Self::new(shape, alpha, alpha)
    }

    /// The shape.
    #[inline]
    pub fn kind(&self) -> MicrofacetKind {
        self.shape.kind()
    }

    /// The same distribution, of a shape that is known at run time.
    #[inline]
    pub fn of_any_shape(&self) -> Microfacet {
        Microfacet { shape: self.kind(), alpha: self.alpha, inverse: self.inverse }
    }

    /// Roughness along x and y.
    #[inline]
    pub fn alpha(&self) -> Vec2 {
        self.alpha
    }

    /// D(m): area of facets with normal `m`, per area of surface and solid angle, in sr⁻¹.
    #[inline(always)]
    pub fn d(&self, m: Vec3) -> f32 {
        self.facets(&Facet::of(m))
    }

    /// D of a facet.
    #[inline(always)]
    fn facets(&self, Facet { normal, length_squared }: &Facet) -> f32 {
        let slope = Vec2::new(normal.x, normal.y) * self.inverse;
        let d = self.shape.d(slope.length_squared(), normal.z * normal.z, *length_squared);
        if normal.z > 0.0 { d * (FRAC_1_PI * self.inverse.x * self.inverse.y) } else { 0.0 }
    }

    /// σ(w) = |cos θ| (1 + Λ(w)): the area of facets seen from `w`, per area of surface. Positive.
    #[inline(always)]
    pub fn projected_area(&self, w: Vec3) -> f32 {
        let spread = self.alpha * Vec2::new(w.x, w.y);
        self.shape.projected_area(w.z.abs(), spread.length_squared())
    }

    /// cos θₒ cos θᵢ / G(wo, wi): of a facet, what is common to all that it does. Positive.
    ///
    /// Smith's G depends on the directions only; that they see the facet from above is for the caller to know.
    #[inline(always)]
    pub(crate) fn joint_area(&self, wo: Vec3, wi: Vec3) -> f32 {
        let side = |w: Vec3| [w.z.abs(), self.projected_area(w)];
        self.shape.joint_area(side(wo), side(wi))
    }

    /// G(wo, wi) / (G₁(wo) cos θᵢ) = 1 / σ(wi), if masking and shadowing are independent: what makes the density of a
    /// direction sampled by visible normals into f.
    #[inline(always)]
    pub(crate) fn shadowing(&self, wo: Vec3, wi: Vec3) -> f32 {
        let side = |w: Vec3| [w.z.abs(), self.projected_area(w)];
        self.shape.shadowing(side(wo), side(wi))
    }

    /// G(wo, wi) / G₁(wo): of the facets that `wo` sees, the fraction that `wi` sees too.
    #[inline(always)]
    pub fn g2_over_g1(&self, wo: Vec3, wi: Vec3) -> f32 {
        (wi.z.abs() * self.shadowing(wo, wi)).min(1.0)
    }

    /// Draws a normal `m` of those seen from `wo`, with density [`Self::visible_pdf`]. wo.z > 0.
    #[inline(always)]
    pub fn sample_visible(&self, wo: Vec3, u: Vec2) -> Vec3 {
        // Seen through a frame squeezed by α, the surface has roughness 1 in all directions.
        let squeezed = (self.alpha.extend(1.0) * wo).normalize();
        let m = self.shape.sample_visible(squeezed, u);
        (self.alpha.extend(1.0) * m).normalize()
    }

    /// The density of visible normals, max(0, wo · m) D(m) / σ(wo), in sr⁻¹ (Heitz & d'Eon 2014, eq. 2).
    #[inline(always)]
    pub fn visible_pdf(&self, wo: Vec3, m: Vec3) -> f32 {
        wo.dot(m).max(0.0) * self.d(m) / self.projected_area(wo)
    }

    /// D G / (4 cos θₒ cos θᵢ), in sr⁻¹: the facets that are mirrors between `wo` and `wi`.
    #[inline(always)]
    pub(crate) fn reflection(&self, wo: Vec3, wi: Vec3, mirror: &Facet) -> f32 {
        self.facets(mirror) / (4.0 * self.joint_area(wo, wi))
    }

    /// The density in sr⁻¹ of `wo` mirrored about a visible normal, where that normal is the facet's.
    ///
    /// The visible normals' density over dwᵢ/dm = 4 wo · m.
    #[inline(always)]
    pub(crate) fn reflection_pdf(&self, wo: Vec3, mirror: &Facet) -> f32 {
        self.facets(mirror) / (4.0 * self.projected_area(wo))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KINDS: [MicrofacetKind; 3] =
        [MicrofacetKind::Beckmann, MicrofacetKind::Ggx, MicrofacetKind::GgxCorrelated];

    /// ∫ f(m) dm over the upper hemisphere, by the midpoint rule in (θ², φ): fine near the pole.
    fn hemisphere_integral(f: impl Fn(Vec3) -> f32) -> f64 {
        let (n, m) = (1500, 256);
        let mut sum = 0.0;
        for i in 0..n {
            let x = (f64::from(i) + 0.5) / f64::from(n);
            let theta = x * x * std::f64::consts::FRAC_PI_2;
            let d_theta = 2.0 * x * std::f64::consts::FRAC_PI_2 / f64::from(n);
            for j in 0..m {
                let phi = (f64::from(j) + 0.5) / f64::from(m) * std::f64::consts::TAU;
                let direction = Vec3::new(
                    (theta.sin() * phi.cos()) as f32,
                    (theta.sin() * phi.sin()) as f32,
                    theta.cos() as f32,
                );
                sum += f64::from(f(direction)) * theta.sin() * d_theta * std::f64::consts::TAU / f64::from(m);
            }
        }
        sum
    }

    /// ∫ D(m) m_z dm = 1: the facets cover the surface (Walter et al. 2007, eq. 4).
    #[test]
    fn facets_cover_the_surface() {
        for kind in KINDS {
            for (x, y) in [(0.02, 0.02), (0.1, 0.1), (0.5, 0.5), (1.0, 1.0), (0.1, 0.4)] {
                let distribution = Microfacet::new(kind, x, y);
                let area = hemisphere_integral(|m| distribution.d(m) * m.z);
                assert!((area - 1.0).abs() < 1e-3, "{distribution:?}: {area}");
            }
        }
    }

    /// ∫ max(0, w · m) D(m) dm = σ(w), what masking is defined by (Heitz 2014, eq. 14 and 20).
    #[test]
    fn projected_area_is_that_of_the_facets() {
        for kind in KINDS {
            for (x, y) in [(0.1, 0.1), (0.5, 0.5), (1.0, 1.0), (0.15, 0.4)] {
                let distribution = Microfacet::new(kind, x, y);
                for w in [
                    Vec3::Z,
                    Vec3::new(0.6, 0.0, 0.8),
                    Vec3::new(0.36, 0.9, 0.245_8),
                    Vec3::new(0.6, 0.8, 0.0),
                ] {
                    let area = hemisphere_integral(|m| distribution.d(m) * w.dot(m).max(0.0));
                    let got = f64::from(distribution.projected_area(w));
                    assert!((got / area - 1.0).abs() < 2e-3, "{distribution:?}, {w}: {got}, not {area}");
                }
            }
        }
    }

    /// A half vector needs no unit length: the density is that of its direction; without a length it is nowhere.
    #[test]
    fn facets_are_of_any_length() {
        let (wo, wi) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.36, 0.48, 0.8));
        let (mirror, m) = (Facet::between(wo, wi), (wo + wi).normalize());
        assert!((mirror.half_cos() - wo.dot(m)).abs() < 1e-6);
        for kind in KINDS {
            let distribution = Microfacet::new(kind, 0.2, 0.5);
            let (at_mirror, expected) = (distribution.facets(&mirror), distribution.d(m));
            assert!((at_mirror / expected - 1.0).abs() < 1e-5, "{kind:?}: {at_mirror}, not {expected}");
            for z in [0.0, 1e-30, 1e-20, 1e-10, 1e-5] {
                let grazing = Facet::between(Vec3::new(1.0, 0.0, z), Vec3::new(-1.0, 0.0, z));
                assert!(distribution.facets(&grazing).is_finite(), "{kind:?} {z}");
            }
        }
    }

    /// The mean of m_z over visible normals, by sampling and by the density.
    #[test]
    fn visible_normals_have_the_density_that_is_said() {
        let wo = Vec3::new(0.5, -0.7, 0.509_9);
        let n = 300;
        for kind in KINDS {
            let distribution = Microfacet::new(kind, 0.2, 0.5);
            for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                let by_density = hemisphere_integral(|m| distribution.visible_pdf(wo, m) * m.dot(axis));
                let at = |i: i32| (i as f32 + 0.5) / n as f32;
                let mean = (0..n * n)
                    .map(|i| distribution.sample_visible(wo, Vec2::new(at(i % n), at(i / n))).dot(axis))
                    .map(f64::from)
                    .sum::<f64>()
                    / f64::from(n * n);
                assert!((mean - by_density).abs() < 1e-3, "{kind:?} {axis}: {mean}, not {by_density}");
            }
        }
    }

    /// Smith's G of either kind, from σ by definition; correlated, no less than independent, and no more than either G₁.
    #[test]
    fn masking_and_shadowing() {
        let (wo, wi) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.36, 0.9, 0.245_8).normalize());
        for kind in KINDS {
            let d = Microfacet::new(kind, 0.5, 0.9);
            let lambda = |w: Vec3| d.projected_area(w) / w.z - 1.0;
            let expected = match kind {
                MicrofacetKind::GgxCorrelated => 1.0 / (1.0 + lambda(wo) + lambda(wi)),
                _ => 1.0 / ((1.0 + lambda(wo)) * (1.0 + lambda(wi))),
            };
            let got = wo.z * wi.z / d.joint_area(wo, wi);
            assert!((got / expected - 1.0).abs() < 1e-5, "{kind:?}: {got}, not {expected}");
            let ratio = d.g2_over_g1(wo, wi) / (1.0 + lambda(wo));
            assert!((ratio / expected - 1.0).abs() < 1e-5, "{kind:?}: {ratio}, not {expected}");
            let (grazing, opposite) = (Vec3::X, -Vec3::X);
            assert!(d.joint_area(grazing, opposite) > 0.0 && d.g2_over_g1(grazing, opposite) <= 1.0);
        }
    }

    #[test]
    fn visible_normals_are_visible() {
        for kind in KINDS {
            for alpha in [0.0, 1e-3, 0.3, 1.0, 1e3] {
                let distribution = Microfacet::isotropic(kind, alpha);
                for z in [1.0_f32, 0.5, 1e-3, 1e-20] {
                    let wo = Vec3::new((1.0 - z * z).sqrt(), 0.0, z);
                    for i in 0..100 {
                        let u = Vec2::new((i % 10) as f32, (i / 10) as f32) / 10.0;
                        let m = distribution.sample_visible(wo, u);
                        assert!(
                            (m.length() - 1.0).abs() < 1e-5 && m.z >= 0.0,
                            "{distribution:?} {wo} {u}: {m}"
                        );
                        assert!(wo.dot(m) > -1e-6, "{distribution:?} {wo} {u}: {m}");
                    }
                }
            }
        }
    }
}
