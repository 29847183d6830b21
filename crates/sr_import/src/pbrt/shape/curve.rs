//! Curves: cubic Bézier splines, whatever they are written as, round.

use glam::{DVec3, Vec3, Vec4};
use sr_scene::{CurveBasis, CurveUv, CurvesDesc};

use super::super::syntax::Kind;
use super::{Params, Reader};

impl Reader<'_> {
    /// The points and radii of one curve; `None` if there is something wrong with it, which is said.
    pub(super) fn bezier_curve(&mut self, params: &mut Params) -> Option<CurvesDesc> {
        let points = params.take_floats("P", &[Kind::Point3]).map(|(_, floats)| floats).unwrap_or_default();
        let points: Vec<Vec3> = points.chunks_exact(3).map(Vec3::from_slice).collect();
        let width = params.float("width").unwrap_or(1.0);
        let widths = ["width0", "width1"].map(|name| params.float(name).unwrap_or(width));
        let degree = params.integer("degree").unwrap_or(3);
        let basis = params.choice("basis", &["bezier", "bspline"], &mut self.notes());
        let kind = params.choice("type", &["flat", "ribbon", "cylinder"], &mut self.notes());
        params.ignore(&["splitdepth"]);
        params.unsupported(&["N"], "its normals are those of a round curve", &mut self.notes());
        let segments = match (degree, basis, points.len()) {
            (2, "bezier", n) if n >= 3 && n % 2 == 1 => (n - 1) / 2,
            (3, "bezier", n) if n >= 4 && n % 3 == 1 => (n - 1) / 3,
            (2, "bspline", n) if n >= 3 => n - 2,
            (3, "bspline", n) if n >= 4 => n - 3,
            (2 | 3, _, n) => {
                let message = format!("{n} points \"P\" are no {basis} curve of degree {degree}");
                self.warn("pbrt::bad-value", &params.span, message, "the shape is left out");
                return None;
            }
            _ => {
                let message = format!("a curve of degree {degree}; 2 or 3 is possible");
                self.warn("pbrt::bad-value", &params.span, message, "the shape is left out");
                return None;
            }
        };
        if !widths.iter().all(|&width| width >= 0.0) {
            let message = format!("a curve of width {} to {}; 0 or more is possible", widths[0], widths[1]);
            self.warn("pbrt::bad-value", &params.span, message, "the shape is left out");
            return None;
        }
        if kind != "cylinder" {
            let message = format!("curves of type \"{kind}\" are not supported");
            self.warn("pbrt::flat-curve", &params.span, message, "they are round, and as wide");
        }
        let (linear, _) = self.linear();
        let scale = linear.determinant().abs().cbrt();
        let lengths = [linear.x_axis, linear.y_axis, linear.z_axis].map(DVec3::length);
        if lengths.iter().any(|length| (length - scale).abs() > 1e-3 * scale) {
            let message = "curves whose transform is not a similarity are not supported";
            let consequence = format!("they stay round, their widths scaled by {scale}");
            self.warn("pbrt::curve-transform", &params.span, message, &consequence);
        }
        let last = 3 * segments;
        let spline = bezier(&points, degree == 3, basis == "bspline", segments);
        let place = |(i, p): (usize, DVec3)| {
            let width = f64::from(widths[0]) + f64::from(widths[1] - widths[0]) * i as f64 / last as f64;
            self.state.ctm.transform_point3(p).as_vec3().extend((0.5 * scale * width) as f32)
        };
        let points: Vec<Vec4> = spline.into_iter().enumerate().map(place).collect();
        let (basis, uv) = (CurveBasis::Bezier, CurveUv::AlongAround);
        Some(CurvesDesc { name: "curves".into(), basis, uv, points, firsts: vec![0] })
    }
}

/// A cubic Bézier spline of the same shape. There are enough points for the segments.
fn bezier(points: &[Vec3], is_cubic: bool, is_b_spline: bool, segments: usize) -> Vec<DVec3> {
    let order = if is_cubic { 4 } else { 3 };
    let stride = if is_b_spline { 1 } else { order - 1 };
    let mut spline = Vec::with_capacity(3 * segments + 1);
    for segment in points.windows(order).step_by(stride).take(segments) {
        let p = |i: usize| segment.get(i).map_or(DVec3::ZERO, |p| p.as_dvec3());
        let third = 1.0 / 3.0;
        let cubic = match (is_cubic, is_b_spline) {
            (true, false) => [p(0), p(1), p(2), p(3)],
            (true, true) => {
                let (before, after) = (p(0).lerp(p(1), 2.0 * third), p(2).lerp(p(3), third));
                let inner = [p(1).lerp(p(2), third), p(1).lerp(p(2), 2.0 * third)];
                [before.midpoint(inner[0]), inner[0], inner[1], inner[1].midpoint(after)]
            }
            (false, _) => {
                let ends =
                    if is_b_spline { [p(0).midpoint(p(1)), p(1).midpoint(p(2))] } else { [p(0), p(2)] };
                [ends[0], ends[0].lerp(p(1), 2.0 * third), ends[1].lerp(p(1), 2.0 * third), ends[1]]
            }
        };
        // The end of one segment is the beginning of the next.
        spline.truncate(spline.len().saturating_sub(1));
        spline.extend(cubic);
    }
    spline
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_become_bezier_splines() {
        let line: Vec<Vec3> = (0..7).map(|x| Vec3::X * x as f32).collect();
        // Points at equal distances on a line stay so.
        for (count, is_cubic, is_b_spline, segments, from, to) in [
            (7, true, false, 2, 0.0, 6.0),
            (7, true, true, 4, 1.0, 5.0),
            (7, false, false, 3, 0.0, 6.0),
            (7, false, true, 5, 0.5, 5.5),
        ] {
            let spline = bezier(&line[..count], is_cubic, is_b_spline, segments);
            assert_eq!(spline.len(), 3 * segments + 1);
            for (i, p) in spline.iter().enumerate() {
                let x = from + (to - from) * i as f64 / (3 * segments) as f64;
                assert!((*p - DVec3::X * x).length() < 1e-12, "{i}: {p}");
            }
        }
        // The middle of a quadratic.
        let bow = [Vec3::ZERO, Vec3::new(1.0, 2.0, 0.0), Vec3::X * 2.0];
        let [a, b, c, d] = bezier(&bow, false, false, 1)[..] else { panic!() };
        assert!(((a + 3.0 * b + 3.0 * c + d) / 8.0 - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-12);
    }
}
