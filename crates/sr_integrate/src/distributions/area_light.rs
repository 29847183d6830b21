//! A flat light seen from a point: uniform by area, as a density per solid angle.

use glam::DVec3;

use super::directions::{OnSphere, invert, pdf, polygon_bounds, sample};
use super::parameter::{ParameterError, finite};
use crate::columns::{Columns, ColumnsMut};
use crate::density::{Density, DensityError, Inverse};
use crate::space::Space;

/// Directions towards points that are uniform over a parallelogram; P(ω) = distance² / (A |cos θ|), in sr⁻¹.
///
/// θ is the angle between the direction and the parallelogram's normal. Its sign does not matter: the
/// parallelogram is seen, and drawn, from both sides. Whether it shines on both is for the integrand to say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaLight {
    /// From the point of view.
    corner: DVec3,
    edges: [DVec3; 2],
    /// Cross product of the edges: along the normal, as long as the area.
    cross: DVec3,
    /// What the parallelogram and the point of view span.
    volume: f64,
}

impl AreaLight {
    /// - `corner`, `edges`: of the parallelogram
    /// - `seen_from`: the point of view
    ///
    /// # Errors
    /// If a coordinate is not finite, the parallelogram has no area, or the point of view lies in its plane.
    pub fn new(corner: [f64; 3], edges: [[f64; 3]; 2], seen_from: [f64; 3]) -> Result<Self, ParameterError> {
        let named = [("corner", corner), ("edge1", edges[0]), ("edge2", edges[1]), ("seen_from", seen_from)];
        for (name, vector) in named {
            for (axis, value) in ["x", "y", "z"].into_iter().zip(vector) {
                finite(&format!("{name}.{axis}"), value)?;
            }
        }
        let corner = DVec3::from(corner) - DVec3::from(seen_from);
        let edges = edges.map(DVec3::from);
        let cross = edges[0].cross(edges[1]);
        let (area, sides) = (cross.length(), edges[0].length() * edges[1].length());
        if !(area > 1e-12 * sides && area.is_normal() && area.recip().is_normal()) {
            let what = format!(
                "and edge2 = {:?} span no area with it: it is {:?}",
                edges[1].to_array(),
                edges[0].to_array()
            );
            return Err(ParameterError::Shape { argument: "edge1", what });
        }
        let volume = cross.dot(corner);
        let reach = corner.length().max(edges[0].length()).max(edges[1].length());
        if !(volume.abs() > 1e-12 * area * reach) {
            let what =
                format!("= {seen_from:?} lies in the plane of the light, which is seen edge-on from there");
            return Err(ParameterError::Shape { argument: "seen_from", what });
        }
        Ok(Self { corner, edges, cross, volume })
    }

    /// Where on the parallelogram a direction meets it, if it does up to rounding.
    fn locate(&self, w: DVec3) -> Option<[f64; 2]> {
        let distance = self.volume / self.cross.dot(w);
        // Not `<=`, so that NaN fails too.
        if !(distance > 0.0 && distance.is_finite()) {
            return None;
        }
        let (y, square) = (w * distance - self.corner, self.cross.length_squared());
        let at = [
            y.cross(self.edges[1]).dot(self.cross) / square,
            self.edges[0].cross(y).dot(self.cross) / square,
        ];
        // A direction is rounded by some 2⁻⁵³; on the plane, that is distance / cos θ as much.
        let inverse_cos = distance * square.sqrt() / self.volume.abs();
        let shortest = self.edges[0].length().min(self.edges[1].length());
        let slack =
            16.0 * f64::EPSILON * (1.0 + (distance + self.corner.length()) / shortest) * (1.0 + inverse_cos);
        at.iter().all(|&c| c >= -slack && c <= 1.0 + slack).then_some(at)
    }
}

impl OnSphere for AreaLight {
    fn draw(&self, u: [f64; 2]) -> (DVec3, f64) {
        let y = self.corner + u[0] * self.edges[0] + u[1] * self.edges[1];
        let distance = y.length();
        // With A cos θ = cross · y / distance.
        (y / distance, distance * distance * distance / self.volume.abs())
    }

    fn density(&self, w: DVec3) -> f64 {
        let distance = self.volume / self.cross.dot(w);
        if self.locate(w).is_some() { distance * distance * distance / self.volume.abs() } else { 0.0 }
    }

    fn undraw(&self, w: DVec3) -> [f64; 2] {
        self.locate(w).unwrap_or([f64::NAN; 2])
    }
}

impl Density for AreaLight {
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
        let [a, b] = self.edges;
        let corners = [DVec3::ZERO, a, a + b, b].map(|offset| (self.corner + offset).normalize());
        polygon_bounds(&corners, 4.0 * f64::EPSILON)
    }

    fn inverse(&self) -> Option<&dyn Inverse> {
        Some(self)
    }
}

impl Inverse for AreaLight {
    fn invert(&self, x: Columns<'_>, u: ColumnsMut<'_>) -> Result<(), DensityError> {
        invert(self, x, u)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_density_of_the_article() {
        let light = AreaLight::new([-1.0, -1.0, 2.0], [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0]], [0.0; 3]).unwrap();
        assert_eq!(light.draw([0.5, 0.5]), (DVec3::Z, 1.0), "2² / (4 · 1)");
        let (w, density) = light.draw([1.0, 0.5]);
        assert!((density - 5.0 / (4.0 * w.z)).abs() < 1e-14);
        for i in 0..=20 {
            for j in 0..=20 {
                let u = [f64::from(i) / 20.0, f64::from(j) / 20.0];
                let (w, density) = light.draw(u);
                assert!((OnSphere::density(&light, w) / density - 1.0).abs() < 1e-14, "{u:?}");
                assert!((0..2).all(|k| (light.undraw(w)[k] - u[k]).abs() < 1e-14));
            }
        }
        assert_eq!(OnSphere::density(&light, -DVec3::Z), 0.0);
        assert_eq!(OnSphere::density(&light, DVec3::X), 0.0);
        assert_eq!(light.support()[2][1], 1.0);
    }

    #[test]
    fn edge_on_there_is_nothing_to_see() {
        let edges = [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        let text = |corner, edges, at| AreaLight::new(corner, edges, at).unwrap_err().to_string();
        assert!(
            text([1.0, 1.0, 0.0], edges, [0.0; 3])
                .starts_with("seen_from = [0.0, 0.0, 0.0] lies in the plane")
        );
        assert!(text([0.0; 3], [[1.0, 0.0, 0.0]; 2], [0.0, 0.0, 1.0]).starts_with("edge1"));
        assert!(text([0.0, f64::NAN, 0.0], edges, [0.0; 3]).starts_with("corner.y is NaN"));
    }
}
