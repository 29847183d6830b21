//! Cubics in Bézier form, with a radius along them.

use glam::{DVec3, DVec4};

use super::CurvePoint;

/// Bézier control points: position and radius.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cubic(pub [DVec4; 4]);

impl Cubic {
    /// One segment of a uniform B-spline.
    pub fn from_b_spline([a, b, c, d]: [DVec4; 4]) -> Self {
        let third = 1.0 / 3.0;
        let (ab, bc, cd) =
            ([a.lerp(b, 2.0 * third)], [b.lerp(c, third), b.lerp(c, 2.0 * third)], [c.lerp(d, third)]);
        Self([0.5 * (ab[0] + bc[0]), bc[0], bc[1], 0.5 * (bc[1] + cd[0])])
    }

    /// Position and radius at `u`.
    pub fn at(&self, u: f64) -> DVec4 {
        let [a, b, c, d] = self.0;
        let (ab, bc, cd) = (a.lerp(b, u), b.lerp(c, u), c.lerp(d, u));
        ab.lerp(bc, u).lerp(bc.lerp(cd, u), u)
    }

    /// Position, first and second derivative.
    pub fn derivatives(&self, u: f64) -> [DVec4; 3] {
        let [a, b, c, d] = self.0;
        let [e, f, g] = [b - a, c - b, d - c];
        let (ef, fg) = (e.lerp(f, u), f.lerp(g, u));
        [self.at(u), 3.0 * ef.lerp(fg, u), 6.0 * (f - e).lerp(g - f, u)]
    }

    /// The part between two parameters.
    pub fn between(&self, [u0, u1]: [f64; 2]) -> Self {
        if [u0, u1] == [0.0, 1.0] {
            return *self;
        }
        let [a, b, c, d] = self.0;
        // The polar form: each lerp has a parameter of its own (Ramshaw 1989, "Blossoms are polar forms").
        let blossom = |r: f64, s: f64, t: f64| {
            let (ab, bc, cd) = (a.lerp(b, r), b.lerp(c, r), c.lerp(d, r));
            ab.lerp(bc, s).lerp(bc.lerp(cd, s), t)
        };
        Self([blossom(u0, u0, u0), blossom(u0, u0, u1), blossom(u0, u1, u1), blossom(u1, u1, u1)])
    }

    /// Its two halves.
    pub fn halves(&self) -> [Self; 2] {
        let [a, b, c, d] = self.0;
        let (ab, bc, cd) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + d));
        let (abc, bcd) = (0.5 * (ab + bc), 0.5 * (bc + cd));
        let middle = 0.5 * (abc + bcd);
        [Self([a, ab, abc, middle]), Self([middle, bcd, cd, d])]
    }

    /// The point of the disc at `u` that is closest to `near` on its rim.
    pub fn point(&self, u: f64, near: DVec3) -> CurvePoint {
        let [at, first, second] = self.derivatives(u);
        let (center, radius) = (at.truncate(), at.w);
        let speed2 = first.truncate().length_squared();
        // Where control points coincide, the curve goes from one end to the other.
        let chord = || (self.0[3] - self.0[0]).truncate().normalize_or(DVec3::Z);
        let axis = first.truncate().try_normalize().unwrap_or_else(chord);
        let off = near - center;
        let out =
            (off - axis * axis.dot(off)).try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector());
        // How much faster or slower than the curve the surface goes, as it turns.
        let stretch = if speed2 > 0.0 { 1.0 - radius * out.dot(second.truncate()) / speed2 } else { 1.0 };
        let widening = if speed2 > 0.0 { first.w / speed2.sqrt() } else { 0.0 };
        CurvePoint {
            p: center + radius * out,
            radius,
            out,
            axis,
            normal: (stretch * out - widening * axis).try_normalize().unwrap_or(out),
            along: stretch * first.truncate() + first.w * out,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOME: [DVec4; 4] = [
        DVec4::new(0.0, 0.0, 1.0, 0.5),
        DVec4::new(1.0, -2.0, 0.5, 0.25),
        DVec4::new(3.0, 1.0, 0.0, 0.25),
        DVec4::new(4.0, 0.0, -3.0, 0.0),
    ];

    #[test]
    fn parts_are_the_same_curve() {
        let whole = Cubic(SOME);
        let part = whole.between([0.25, 0.75]);
        let [low, high] = whole.halves();
        for i in 0..=8 {
            let u = f64::from(i) / 8.0;
            assert!((part.at(u) - whole.at(0.25 + 0.5 * u)).length() < 1e-14);
            assert!((low.at(u) - whole.at(0.5 * u)).length() < 1e-14);
            assert!((high.at(u) - whole.at(0.5 + 0.5 * u)).length() < 1e-14);
        }
    }

    #[test]
    fn derivatives_are_differences() {
        let (curve, h) = (Cubic(SOME), 1e-4);
        let [_, first, second] = curve.derivatives(0.3);
        let (before, at, after) = (curve.at(0.3 - h), curve.at(0.3), curve.at(0.3 + h));
        assert!(((after - before) / (2.0 * h) - first).length() < 1e-6);
        assert!(((after - 2.0 * at + before) / (h * h) - second).length() < 1e-5);
    }

    /// B(0) = (a + 4 b + c) / 6.
    #[test]
    fn a_b_spline_begins_between_its_first_three_points() {
        let curve = Cubic::from_b_spline(SOME);
        let [a, b, c, d] = SOME;
        assert!((curve.at(0.0) - (a + 4.0 * b + c) / 6.0).length() < 1e-15);
        assert!((curve.at(1.0) - (b + 4.0 * c + d) / 6.0).length() < 1e-15);
        let [_, first, _] = curve.derivatives(0.0);
        assert!((first - (c - a) / 2.0).length() < 1e-15);
    }
}
