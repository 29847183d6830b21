//! The normals of a rough surface that are seen from a direction.

use std::f64::consts::PI;

use glam::DVec3;

use super::directions::{OnSphere, invert, normalized, pdf, sample};
use super::disk::{concentric, invert_concentric};
use super::parameter::{ParameterError, bad, positive};
use crate::columns::{Columns, ColumnsMut};
use crate::density::{Density, DensityError, Inverse};
use crate::space::Space;

/// Microfacet normals of GGX's distribution about +Z, as often as they are seen from `wo`;
/// pdf = max(0, wo · m) D(m) / σ(wo), in sr⁻¹ (Heitz & d'Eon 2014, eq. 2).
///
/// Seen through a frame squeezed by the roughness, the surface is a hemisphere, and its visible normals are
/// the halfway vectors of `wo` and a uniform spherical cap (Dupuy & Benyoub, "Sampling Visible GGX Normals
/// with Spherical Caps", 2023).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisibleNormals {
    wo: DVec3,
    alpha: [f64; 2],
    /// `wo` in the squeezed frame.
    squeezed: DVec3,
    /// The area of facets seen from `wo`, per area of surface.
    projected_area: f64,
}

impl VisibleNormals {
    /// - `wo`: towards the viewer, of any length, z > 0
    /// - `alpha`: roughness along x and y
    ///
    /// # Errors
    /// If `wo` is not finite, 0 or not above the surface, or a roughness is not in [10⁻⁶, 10³].
    pub fn new(wo: [f64; 3], alpha: [f64; 2]) -> Result<Self, ParameterError> {
        let unit = normalized("wo", wo)?;
        positive("wo.z", wo[2])?;
        for (axis, alpha) in ["alpha.x", "alpha.y"].into_iter().zip(alpha) {
            if !(1e-6..=1e3).contains(&alpha) {
                return Err(bad(axis, alpha, "from 1e-6 to 1000"));
            }
        }
        let spread = DVec3::new(alpha[0] * unit.x, alpha[1] * unit.y, unit.z);
        let projected_area = 0.5 * (unit.z + spread.length());
        Ok(Self { wo: unit, alpha, squeezed: spread.normalize(), projected_area })
    }
}

impl OnSphere for VisibleNormals {
    fn draw(&self, u: [f64; 2]) -> (DVec3, f64) {
        let [x, y] = concentric(u);
        let square = (x * x + y * y).min(1.0);
        let depth = (1.0 + self.squeezed.z) * square;
        let stretch = ((1.0 + self.squeezed.z) * (2.0 - depth)).max(0.0).sqrt();
        // z of the halfway vector: (1 + z)(1 − square), which does not cancel at the rim.
        let half = DVec3::new(
            x * stretch + self.squeezed.x,
            y * stretch + self.squeezed.y,
            (1.0 + self.squeezed.z) * (1.0 - square),
        );
        let m = DVec3::new(self.alpha[0] * half.x, self.alpha[1] * half.y, half.z).normalize_or_zero();
        (m, OnSphere::density(self, m))
    }

    fn density(&self, m: DVec3) -> f64 {
        if m.z <= 0.0 {
            return 0.0;
        }
        let [ax, ay] = self.alpha;
        let slope = DVec3::new(m.x / ax, m.y / ay, m.z).length_squared();
        self.wo.dot(m).max(0.0) / (PI * ax * ay * slope * slope * self.projected_area)
    }

    fn undraw(&self, m: DVec3) -> [f64; 2] {
        let n = DVec3::new(m.x / self.alpha[0], m.y / self.alpha[1], m.z).normalize();
        let c = 2.0 * self.squeezed.dot(n) * n - self.squeezed;
        let across = c.x * c.x + c.y * c.y;
        let depth = if c.z > 0.0 { across / (1.0 + c.z) } else { 1.0 - c.z };
        let (r, length) = ((depth / (1.0 + self.squeezed.z)).min(1.0).sqrt(), across.sqrt());
        invert_concentric(if length > 0.0 { [c.x / length * r, c.y / length * r] } else { [r, 0.0] })
    }
}

impl Density for VisibleNormals {
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

    /// The upper hemisphere.
    fn support(&self) -> Vec<[f64; 2]> {
        vec![[-1.0, 1.0], [-1.0, 1.0], [0.0, 1.0]]
    }

    fn inverse(&self) -> Option<&dyn Inverse> {
        Some(self)
    }
}

impl Inverse for VisibleNormals {
    fn invert(&self, x: Columns<'_>, u: ColumnsMut<'_>) -> Result<(), DensityError> {
        invert(self, x, u)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_drawn_is_undrawn() {
        for wo in [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [-3.0, 2.0, 0.1]] {
            for alpha in [[1e-4, 1e-4], [0.1, 0.5], [1.0, 1.0]] {
                let normals = VisibleNormals::new(wo, alpha).unwrap();
                for i in 1..40 {
                    for j in 1..40 {
                        let u = [f64::from(i) / 40.0, f64::from(j) / 40.0];
                        let (m, density) = normals.draw(u);
                        assert!((m.length() - 1.0).abs() < 1e-15 && density > 0.0, "{normals:?}: {u:?}");
                        let back = normals.undraw(m);
                        assert!((0..2).all(|k| (back[k] - u[k]).abs() < 1e-9), "{normals:?}: {u:?} {back:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn errors_name_the_argument() {
        let text = |wo, alpha| VisibleNormals::new(wo, alpha).unwrap_err().to_string();
        assert!(text([0.0, 0.0, -1.0], [0.1; 2]).starts_with("wo.z is -1"));
        assert!(text([0.0, 0.0, 1.0], [0.1, 0.0]).starts_with("alpha.y is 0"));
        assert!(text([f64::NAN, 0.0, 1.0], [0.1; 2]).starts_with("wo.x is NaN"));
    }
}
