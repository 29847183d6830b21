//! Densities over directions that depend on the angle from an axis alone: hemispheres, the sphere, cones,
//! lobes.

use std::f64::consts::{FRAC_1_PI, PI, TAU};
use std::fmt;

use glam::DVec3;

use super::directions::{OnSphere, cap_bounds, frame, invert, normalized, pdf, sample};
use super::disk::{concentric, invert_concentric};
use super::parameter::{ParameterError, bad};
use crate::columns::{Columns, ColumnsMut};
use crate::density::{Density, DensityError, Inverse};
use crate::space::Space;

/// How a density falls with the depth below the pole, 1 − cos θ: accurate also where cos θ rounds to 1.
pub trait Profile: Send + Sync + fmt::Debug {
    /// The depth above which a share in [0, 1] of the probability lies.
    fn depth(&self, share: f64) -> f64;

    /// The share of the probability above a depth.
    fn share(&self, depth: f64) -> f64;

    /// The density at a depth up to the greatest, in sr⁻¹.
    fn density(&self, depth: f64) -> f64;

    /// The greatest depth, in (0, 2].
    fn greatest(&self) -> f64;

    /// The mean of cos θ.
    fn mean_cos(&self) -> f64;
}

/// A [`Profile`] about an axis.
///
/// The unit square becomes a disk by the concentric map, whose circles become circles about the axis:
/// neighbours stay neighbours, and strata survive.
#[derive(Clone, Copy, Debug)]
pub struct Zonal<P> {
    profile: P,
    /// Unit vectors; the last is the axis.
    frame: [DVec3; 3],
    /// The greatest depth, and what rounding adds to it.
    rim: f64,
}

impl<P: Profile> Zonal<P> {
    /// - `axis`: of any length
    ///
    /// # Errors
    /// If the axis is 0 or not finite.
    pub fn new(profile: P, axis: [f64; 3]) -> Result<Self, ParameterError> {
        let frame = frame(normalized("axis", axis)?);
        // A direction is rounded by some 2⁻⁵³ in angle.
        let greatest = profile.greatest();
        let rim = greatest + 8.0 * f64::EPSILON * (greatest + greatest.sqrt());
        Ok(Self { profile, frame, rim })
    }

    /// x and y in the frame, and the depth below the pole.
    fn local(&self, w: DVec3) -> ([f64; 2], f64) {
        let [x, y, z] = self.frame.map(|axis| axis.dot(w));
        ([x, y], if z > 0.0 { (x * x + y * y) / (1.0 + z) } else { 1.0 - z })
    }
}

impl<P: Profile> OnSphere for Zonal<P> {
    #[inline]
    fn draw(&self, u: [f64; 2]) -> (DVec3, f64) {
        let [x, y] = concentric(u);
        let square = (x * x + y * y).min(1.0 - 0.5 * f64::EPSILON);
        let depth = self.profile.depth(square).clamp(0.0, self.profile.greatest());
        let stretch = if square > 0.0 { (depth * (2.0 - depth) / square).max(0.0).sqrt() } else { 0.0 };
        let [tangent, bitangent, axis] = self.frame;
        let w = tangent * (x * stretch) + bitangent * (y * stretch) + axis * (1.0 - depth);
        (w, self.profile.density(depth))
    }

    #[inline]
    fn density(&self, w: DVec3) -> f64 {
        let (_, depth) = self.local(w);
        if depth <= self.rim { self.profile.density(depth.min(self.profile.greatest())) } else { 0.0 }
    }

    fn undraw(&self, w: DVec3) -> [f64; 2] {
        let ([x, y], depth) = self.local(w);
        let (r, length) =
            (self.profile.share(depth.min(self.profile.greatest())).min(1.0).sqrt(), x.hypot(y));
        invert_concentric(if length > 0.0 { [x / length * r, y / length * r] } else { [r, 0.0] })
    }
}

impl<P: Profile> Density for Zonal<P> {
    fn space(&self) -> Space {
        Space::SolidAngle
    }

    fn uniforms(&self) -> usize {
        2
    }

    fn sample(&self, u: Columns<'_>, x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        sample(self, u, x, pdf);
        Ok(())
    }

    fn pdf(&self, x: Columns<'_>, density: &mut [f64]) -> Result<(), DensityError> {
        pdf(self, x, density);
        Ok(())
    }

    fn support(&self) -> Vec<[f64; 2]> {
        cap_bounds(self.frame[2], 2.0 * (0.5 * self.profile.greatest()).sqrt().min(1.0).asin())
    }

    fn mean(&self) -> Option<Vec<f64>> {
        Some((self.frame[2] * self.profile.mean_cos()).to_array().to_vec())
    }

    fn inverse(&self) -> Option<&dyn Inverse> {
        Some(self)
    }
}

impl<P: Profile> Inverse for Zonal<P> {
    fn invert(&self, x: Columns<'_>, u: ColumnsMut<'_>) -> Result<(), DensityError> {
        invert(self, x, u)
    }
}

/// All directions within an angle of the axis, equally likely; pdf = 1 / 2π(1 − cos θ), in sr⁻¹.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    height: f64,
}

impl Cone {
    /// Every direction; pdf = 1 / 4π.
    pub const SPHERE: Self = Self { height: 2.0 };
    /// Directions on one side; pdf = 1 / 2π.
    pub const HEMISPHERE: Self = Self { height: 1.0 };

    /// - `angle`: half the opening, in radians
    ///
    /// # Errors
    /// If the angle is not in [10⁻⁷, π]: directions in a narrower cone could not be told apart well.
    pub fn new(angle: f64) -> Result<Self, ParameterError> {
        if !(1e-7..=PI).contains(&angle) {
            return Err(bad("angle", angle, "from 1e-7 to pi, in radians"));
        }
        let sin = (0.5 * angle).sin();
        Ok(Self { height: 2.0 * sin * sin })
    }
}

impl Profile for Cone {
    #[inline]
    fn depth(&self, share: f64) -> f64 {
        share * self.height
    }

    fn share(&self, depth: f64) -> f64 {
        depth / self.height
    }

    #[inline]
    fn density(&self, _: f64) -> f64 {
        1.0 / (TAU * self.height)
    }

    fn greatest(&self) -> f64 {
        self.height
    }

    fn mean_cos(&self) -> f64 {
        1.0 - 0.5 * self.height
    }
}

/// Directions on one side with a density proportional to the cosine; pdf = cos θ / π, in sr⁻¹.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cosine;

impl Profile for Cosine {
    #[inline]
    fn depth(&self, share: f64) -> f64 {
        share / (1.0 + (1.0 - share).sqrt())
    }

    fn share(&self, depth: f64) -> f64 {
        depth * (2.0 - depth)
    }

    #[inline]
    fn density(&self, depth: f64) -> f64 {
        (1.0 - depth).max(0.0) * FRAC_1_PI
    }

    fn greatest(&self) -> f64 {
        1.0
    }

    fn mean_cos(&self) -> f64 {
        2.0 / 3.0
    }
}

/// A lobe: von Mises and Fisher's distribution, pdf ∝ exp(κ cos θ), in sr⁻¹; the normal distribution of
/// directions.
///
/// Wenzel Jakob, "Numerically stable sampling of the von Mises Fisher distribution on S²", 2012, here written
/// with the depth 1 − cos θ, so that it holds for any κ: 0 is uniform, and 10⁶ has a width of a thousandth of
/// a radian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VonMisesFisher {
    kappa: f64,
    /// exp(−2κ) − 1.
    fall: f64,
    /// The density at the pole.
    top: f64,
}

impl VonMisesFisher {
    /// # Errors
    /// If κ is not in [0, 10¹²]: directions in a narrower lobe could not be told apart well.
    pub fn new(kappa: f64) -> Result<Self, ParameterError> {
        if !(0.0..=1e12).contains(&kappa) {
            return Err(bad("kappa", kappa, "from 0 to 1e12"));
        }
        let kappa = if kappa < 1e-200 { 0.0 } else { kappa };
        let fall = (-2.0 * kappa).exp_m1();
        let top = if kappa == 0.0 { 0.25 * FRAC_1_PI } else { kappa / (TAU * -fall) };
        Ok(Self { kappa, fall, top })
    }
}

impl Profile for VonMisesFisher {
    #[inline]
    fn depth(&self, share: f64) -> f64 {
        if self.kappa == 0.0 { 2.0 * share } else { -(share * self.fall).ln_1p() / self.kappa }
    }

    fn share(&self, depth: f64) -> f64 {
        if self.kappa == 0.0 { 0.5 * depth } else { (-self.kappa * depth).exp_m1() / self.fall }
    }

    #[inline]
    fn density(&self, depth: f64) -> f64 {
        self.top * (-self.kappa * depth).exp()
    }

    fn greatest(&self) -> f64 {
        2.0
    }

    fn mean_cos(&self) -> f64 {
        let k = self.kappa;
        if k < 0.05 {
            // coth κ − 1/κ, whose terms cancel.
            let k2 = k * k;
            return k / 3.0 * (1.0 - k2 / 15.0 * (1.0 - 2.0 * k2 / 21.0 * (1.0 - k2 / 10.0)));
        }
        1.0 / k.tanh() - 1.0 / k
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(profile: impl Profile, axis: [f64; 3]) {
        let zonal = Zonal::new(profile, axis).unwrap();
        for i in 0..=40 {
            for j in 0..=40 {
                let u = [f64::from(i) / 40.0, f64::from(j) / 40.0].map(super::super::line::below_one);
                let (w, density) = zonal.draw(u);
                assert!((w.length() - 1.0).abs() < 1e-15, "{zonal:?}: {u:?}");
                assert!(density >= 0.0 && density.is_finite());
                if density > 0.0 {
                    let again = OnSphere::density(&zonal, w);
                    assert!(
                        (again / density - 1.0).abs() < 1e-6 || density < 1e-300,
                        "{zonal:?}, {u:?}: {density} {again}"
                    );
                }
            }
        }
    }

    #[test]
    fn samples_are_unit_vectors_of_the_density_that_they_carry() {
        for axis in [[0.0, 0.0, 1.0], [0.0, -2.0, 0.0], [1.0, 2.0, -3.0]] {
            check(Cone::SPHERE, axis);
            check(Cone::HEMISPHERE, axis);
            check(Cosine, axis);
            for angle in [1e-7, 0.01, 1.0, 3.0, PI] {
                check(Cone::new(angle).unwrap(), axis);
            }
            for kappa in [0.0, 1e-250, 1e-9, 1.0, 30.0, 1e6, 1e9] {
                check(VonMisesFisher::new(kappa).unwrap(), axis);
            }
        }
    }

    #[test]
    fn shares_and_depths_are_inverse() {
        for kappa in [0.0, 1e-9, 0.3, 20.0, 1e6, 1e12] {
            let p = VonMisesFisher::new(kappa).unwrap();
            for share in [0.0, 1e-9, 0.2, 0.7, 0.999] {
                assert!((p.share(p.depth(share)) - share).abs() < 1e-14, "{kappa}, {share}");
            }
        }
        for (kappa, mean) in [(0.0, 0.0), (0.01, 0.003_333_311_111_322_751), (1.0, 0.313_035_285_499_331_3)] {
            assert!((VonMisesFisher::new(kappa).unwrap().mean_cos() - mean).abs() < 2e-15);
        }
    }

    #[test]
    fn errors_name_the_argument() {
        assert!(Cone::new(4.0).unwrap_err().to_string().starts_with("angle is 4"));
        assert!(VonMisesFisher::new(-1.0).unwrap_err().to_string().starts_with("kappa is -1"));
        assert!(VonMisesFisher::new(f64::NAN).is_err());
        assert!(Zonal::new(Cosine, [0.0; 3]).unwrap_err().to_string().contains("axis"));
    }
}
