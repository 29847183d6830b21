//! Frames within the frame: a normal that a bump or normal map tilts, and the side that faces the viewer.
//!
//! In: directions in the surface's frame. Out: the same directions as a model inside sees them. A model in a tilted
//! frame reflects only where a direction is on the same side of both normals; nothing else is reflected there, so a
//! strong tilt loses energy, as everywhere that this is done.

use glam::Vec3;

/// A step from a frame into one inside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// z changes its sign: a model for the front is used behind.
    Mirror,
    /// The normal is another one.
    Tilt(Tilt),
}

/// A frame about a perturbed normal, its x axis as near as can be to that of the outer frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tilt {
    s: Vec3,
    t: Vec3,
    n: Vec3,
    /// Squared roughness of the microfacets that stand for the bumps' shadows; 0: no shadows.
    shadow: f32,
}

impl Tilt {
    /// - `normal`: the perturbed normal in the outer frame, of any length
    pub fn about(normal: Vec3) -> Self {
        let n = normal.try_normalize().unwrap_or(Vec3::Z);
        let s = (Vec3::X - n.x * n).try_normalize().unwrap_or(Vec3::Y);
        Self { s, t: n.cross(s), n, shadow: 0.0 }
    }

    /// The same, dimming light that comes in at grazing angles as bumps of this slope would.
    ///
    /// Smith's masking of GGX with α² = tan²θₙ / 8, at most 1 (Estevez, Lecocq & Stein 2019, "A Microfacet-Based
    /// Shadowing Function to Solve the Bump Terminator Problem").
    #[must_use]
    pub fn with_shadows(self) -> Self {
        let z2 = self.n.z * self.n.z;
        // Where tan² is ∞ the minimum is 1; never 0/0.
        Self { shadow: (0.125 * (1.0 - z2).max(0.0) / z2.max(f32::MIN_POSITIVE)).min(1.0), ..self }
    }

    /// The perturbed normal.
    pub fn normal(&self) -> Vec3 {
        self.n
    }
}

impl Step {
    /// A direction as it is seen inside.
    #[inline]
    pub fn inward(&self, w: Vec3) -> Vec3 {
        match self {
            Step::Mirror => Vec3::new(w.x, w.y, -w.z),
            Step::Tilt(tilt) => Vec3::new(w.dot(tilt.s), w.dot(tilt.t), w.dot(tilt.n)),
        }
    }

    /// The inverse of [`Step::inward`].
    #[inline]
    pub fn outward(&self, w: Vec3) -> Vec3 {
        match self {
            Step::Mirror => Vec3::new(w.x, w.y, -w.z),
            Step::Tilt(tilt) => tilt.s * w.x + tilt.t * w.y + tilt.n * w.z,
        }
    }

    /// What is left of the light from `wi`, which is `inside` seen from inside; 0 on different sides, and in the surface
    /// itself, where f would be infinite.
    #[inline]
    pub fn dimming(&self, wi: Vec3, inside: Vec3) -> f32 {
        let Step::Tilt(tilt) = self else { return 1.0 };
        if !(wi.z * inside.z > 0.0 && wi.z.abs() > 1e-7) {
            return 0.0;
        }
        // 2 / (1 + √(1 + α² tan²θ)), free of poles.
        let z = wi.z.abs();
        2.0 * z / (z + (z * z + tilt.shadow * (1.0 - z * z).max(0.0)).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inward_and_back() {
        let steps = [
            Step::Mirror,
            Step::Tilt(Tilt::about(Vec3::new(0.3, -0.5, 2.0))),
            Step::Tilt(Tilt::about(Vec3::X)),
        ];
        for step in steps {
            for w in [Vec3::X, Vec3::new(0.6, 0.0, -0.8), Vec3::new(0.36, 0.48, 0.8)] {
                assert!((step.outward(step.inward(w)) - w).length() < 1e-6, "{step:?}");
            }
        }
    }

    #[test]
    fn the_normal_is_up_inside() {
        let tilt = Tilt::about(Vec3::new(0.3, -0.5, 2.0));
        assert!((Step::Tilt(tilt).inward(tilt.normal()) - Vec3::Z).length() < 1e-6);
    }

    #[test]
    fn degenerate_normals_leave_things_as_they_are() {
        for normal in [Vec3::ZERO, Vec3::NAN, Vec3::splat(f32::INFINITY)] {
            assert_eq!(Tilt::about(normal), Tilt::about(Vec3::Z));
        }
        let flat = Step::Tilt(Tilt::about(Vec3::Z).with_shadows());
        assert_eq!(flat.dimming(Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.6, 0.0, 0.8)), 1.0);
        assert_eq!(flat.dimming(Vec3::X, Vec3::X), 0.0);
        let edge_on = Step::Tilt(Tilt::about(Vec3::X).with_shadows());
        assert!(edge_on.dimming(Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, 0.8, 0.6)).is_finite());
    }
}
