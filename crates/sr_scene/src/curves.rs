//! Curves with thickness: hair, fur, grass, wires.

use glam::{DVec4, Vec4};

/// What the control points of curves mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveBasis {
    /// They are joined by cones, with spheres at all points, also at the ends.
    Linear,
    /// Those of uniform cubic B-splines. The curves are open at their ends.
    BSpline,
    /// Those of cubic Bézier splines: three for each segment, and one more. The curves are open at their ends.
    Bezier,
}

impl CurveBasis {
    /// Control points of a segment: the fewest that a curve can have.
    pub fn order(self) -> usize {
        match self {
            CurveBasis::Linear => 2,
            CurveBasis::BSpline | CurveBasis::Bezier => 4,
        }
    }

    /// How many control points a segment begins after the one before.
    pub fn stride(self) -> usize {
        match self {
            CurveBasis::Linear | CurveBasis::BSpline => 1,
            CurveBasis::Bezier => 3,
        }
    }

    /// Segments of a curve of so many control points; `None` if it cannot have so many.
    pub fn segments(self, points: usize) -> Option<usize> {
        let after_first = points.checked_sub(self.order())?;
        after_first.is_multiple_of(self.stride()).then_some(after_first / self.stride() + 1)
    }

    /// The cubic Bézier control points of each segment of a curve.
    pub fn cubics(self, curve: &[Vec4]) -> impl Iterator<Item = [DVec4; 4]> {
        let third = 1.0 / 3.0;
        curve.windows(self.order()).step_by(self.stride()).map(move |segment| {
            let p = |i: usize| segment.get(i).map_or(DVec4::ZERO, |p| p.as_dvec4());
            match self {
                CurveBasis::Linear => [p(0), p(0).lerp(p(1), third), p(0).lerp(p(1), 2.0 * third), p(1)],
                CurveBasis::Bezier => [p(0), p(1), p(2), p(3)],
                CurveBasis::BSpline => {
                    let (before, after) = (p(0).lerp(p(1), 2.0 * third), p(2).lerp(p(3), third));
                    let inner = [p(1).lerp(p(2), third), p(1).lerp(p(2), 2.0 * third)];
                    [before.midpoint(inner[0]), inner[0], inner[1], inner[1].midpoint(after)]
                }
            }
        })
    }
}

/// A radius that is less than 0 by this part of those next to it is 0, but for rounding.
const ROUNDING: f64 = 1e-4;

/// What (u, v) are on curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveUv {
    /// u: the angle around, from the direction that is perpendicular to +Z; v: the place along all segments of all
    /// curves, one after another. Mitsuba's.
    AroundAlong,
    /// u: the place along each segment; v: the angle around. Nearly pbrt's.
    AlongAround,
}

/// Round curves of one kind: discs, of linear curves spheres, swept along them. Rays from inside do not meet them. They
/// cannot emit.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvesDesc {
    /// What to call them in messages.
    pub name: String,
    /// What the control points mean.
    pub basis: CurveBasis,
    /// What (u, v) are.
    pub uv: CurveUv,
    /// Control points of all curves, one curve after another: position, and radius. No curve has a radius below 0
    /// anywhere, though control points of B-splines may.
    pub points: Vec<Vec4>,
    /// At which control point each curve begins: from 0, and growing.
    pub firsts: Vec<u32>,
}

impl CurvesDesc {
    /// The control points of each curve. Empty where [`CurvesDesc::firsts`] is wrong.
    pub fn curves(&self) -> impl Iterator<Item = &[Vec4]> {
        let ends = self.firsts.iter().skip(1).map(|&next| next as usize).chain([self.points.len()]);
        let ranges = self.firsts.iter().zip(ends).map(|(&first, end)| first as usize..end);
        ranges.map(|range| self.points.get(range).unwrap_or_default())
    }

    /// What is wrong with them, if anything is: half a sentence.
    pub fn fault(&self) -> Option<String> {
        let is_spline = self.basis == CurveBasis::BSpline;
        let is_bad = |p: &&Vec4| !(p.is_finite() && (p.w >= 0.0 || is_spline));
        if let Some(bad) = self.points.iter().find(is_bad) {
            return Some(format!("a control point at {} of radius {}", bad.truncate(), bad.w));
        }
        if self.points.is_empty() || self.firsts.first() != Some(&0) {
            return Some("they have no control points".into());
        }
        for (index, curve) in self.curves().enumerate() {
            if self.basis.segments(curve.len()).is_none() {
                return Some(format!("curve {} has {} control points", index + 1, curve.len()));
            }
            let largest = |cubic: &[DVec4; 4]| cubic.iter().fold(0.0_f64, |r, p| r.max(p.w.abs()));
            let is_bad = |cubic: &[DVec4; 4]| cubic.iter().any(|p| p.w < -ROUNDING * largest(cubic));
            if is_spline && self.basis.cubics(curve).any(|cubic| is_bad(&cubic)) {
                return Some(format!("curve {} has a radius below 0", index + 1));
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(basis: CurveBasis, points: usize, firsts: &[u32]) -> CurvesDesc {
        let points = vec![Vec4::ONE; points];
        CurvesDesc { name: String::new(), basis, uv: CurveUv::AroundAlong, points, firsts: firsts.into() }
    }

    #[test]
    fn curves_have_as_many_points_as_their_basis_needs() {
        for (basis, points, firsts, fault) in [
            (CurveBasis::Linear, 2, &[0][..], None),
            (CurveBasis::Linear, 3, &[0, 2], Some("curve 2 has 1 control points")),
            (CurveBasis::BSpline, 9, &[0, 4], None),
            (CurveBasis::BSpline, 9, &[0, 6], Some("curve 2 has 3 control points")),
            (CurveBasis::Bezier, 11, &[0, 4], None),
            (CurveBasis::Bezier, 10, &[0, 4], Some("curve 2 has 6 control points")),
            (CurveBasis::BSpline, 0, &[], Some("they have no control points")),
            (CurveBasis::BSpline, 4, &[1], Some("they have no control points")),
            (CurveBasis::BSpline, 8, &[0, 9], Some("curve 1 has 0 control points")),
            (CurveBasis::BSpline, 8, &[0, 4, 4], Some("curve 2 has 0 control points")),
        ] {
            assert_eq!(of(basis, points, firsts).fault().as_deref(), fault);
        }
        let mut bad = of(CurveBasis::Linear, 2, &[0]);
        bad.points[1].w = -1.0;
        assert_eq!(bad.fault().unwrap(), "a control point at [1, 1, 1] of radius -1");
    }
    /// A taper from 1 to 0 has a control point of radius −1 behind its end.
    #[test]
    fn radii_of_b_splines_may_be_below_0_where_the_curve_is_not() {
        let mut taper = of(CurveBasis::BSpline, 4, &[0]);
        for (p, radius) in taper.points.iter_mut().zip([2.0, 1.0, 0.0, -1.0]) {
            p.w = radius;
        }
        assert_eq!(taper.fault(), None);
        taper.points[3].w = -2.0;
        assert_eq!(taper.fault().unwrap(), "curve 1 has a radius below 0");
    }
}
