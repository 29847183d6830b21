//! Curves as text: Mitsuba's files, and pbrt's shapes.

use glam::{DVec4, Vec4};
use sr_scene::{CurveBasis, CurvesDesc};

/// A file for Mitsuba: `linearcurve` for linear curves, else `bsplinecurve`.
pub fn file(curves: &CurvesDesc) -> Vec<u8> {
    let mut text = String::new();
    let mut write = |points: &[Vec4]| {
        for [x, y, z, radius] in points.iter().map(Vec4::to_array) {
            text.push_str(&format!("{x} {y} {z} {radius}\n"));
        }
        text.push('\n');
    };
    for curve in curves.curves() {
        match curves.basis {
            CurveBasis::Linear | CurveBasis::BSpline => write(curve),
            // A segment of a B-spline has its own control points, whatever is beside it.
            CurveBasis::Bezier => {
                curves.basis.cubics(curve).for_each(|cubic| write(&b_spline(cubic).map(|p| p.as_vec4())));
            }
        }
    }
    text.into_bytes()
}

/// The control points of the uniform B-spline whose one segment is this cubic.
fn b_spline([a, b, c, d]: [DVec4; 4]) -> [DVec4; 4] {
    [6.0 * a - 7.0 * b + 2.0 * c, 2.0 * b - c, 2.0 * c - b, 2.0 * b - 7.0 * c + 6.0 * d]
}

/// A cubic Bézier spline of pbrt: points, and widths at its ends, between which the width is linear.
pub struct Spline {
    pub points: Vec<f32>,
    pub widths: [f32; 2],
}

/// Radii may be off by this part of the largest.
const SAME_RADIUS: f64 = 1e-3;

/// All curves as splines, and whether every width is linear: as few splines as have about their widths.
pub fn splines(curves: &CurvesDesc) -> (Vec<Spline>, bool) {
    let mut is_linear = true;
    let mut splines = Vec::new();
    for curve in curves.curves() {
        let cubics: Vec<[DVec4; 4]> = curves.basis.cubics(curve).collect();
        if is_even(&cubics) {
            splines.push(spline(&cubics));
            continue;
        }
        for cubic in cubics.chunks(1) {
            is_linear &= is_even(cubic);
            splines.push(spline(cubic));
        }
    }
    (splines, is_linear)
}

/// Is the radius linear from end to end?
fn is_even(cubics: &[[DVec4; 4]]) -> bool {
    let (Some([first, ..]), Some([.., last])) = (cubics.first(), cubics.last()) else { return true };
    let steps = (3 * cubics.len()) as f64;
    let largest = cubics.iter().flatten().fold(0.0_f64, |r, p| r.max(p.w));
    let radii = cubics
        .iter()
        .enumerate()
        .flat_map(|(i, cubic)| cubic.iter().enumerate().map(move |(k, p)| (p.w, (3 * i + k) as f64 / steps)));
    radii.into_iter().all(|(radius, u)| {
        let linear = first.w + (last.w - first.w) * u;
        (radius - linear).abs() <= SAME_RADIUS * largest
    })
}

fn spline(cubics: &[[DVec4; 4]]) -> Spline {
    let mut points: Vec<f32> = Vec::with_capacity(9 * cubics.len() + 3);
    for (i, cubic) in cubics.iter().enumerate() {
        let new = cubic.iter().skip(usize::from(i > 0));
        points.extend(new.flat_map(|p| p.truncate().as_vec3().to_array()));
    }
    let width = |p: Option<&DVec4>| p.map_or(0.0, |p| (2.0 * p.w.max(0.0)) as f32);
    let ends = (cubics.first().and_then(|c| c.first()), cubics.last().and_then(|c| c.last()));
    Spline { points, widths: [width(ends.0), width(ends.1)] }
}

#[cfg(test)]
mod tests {
    use sr_scene::CurveUv;

    use super::*;

    fn of(basis: CurveBasis, points: Vec<Vec4>) -> CurvesDesc {
        CurvesDesc { name: String::new(), basis, uv: CurveUv::AroundAlong, points, firsts: vec![0] }
    }

    /// x, and a radius.
    fn along(points: &[(f32, f32)]) -> Vec<Vec4> {
        points.iter().map(|&(x, r)| Vec4::new(x, 1.0, 0.0, r)).collect()
    }

    #[test]
    fn a_bezier_spline_is_b_splines() {
        let curves = of(CurveBasis::Bezier, along(&[(0.0, 0.5), (1.0, 0.5), (2.0, 0.25), (5.0, 0.0)]));
        let text = String::from_utf8(file(&curves)).unwrap();
        let points: Vec<Vec4> = text
            .lines()
            .filter(|line| !line.is_empty())
            .map(|line| {
                let numbers: Vec<f32> = line.split(' ').map(|word| word.parse().unwrap()).collect();
                Vec4::from_slice(&numbers)
            })
            .collect();
        let [cubic] = CurveBasis::BSpline.cubics(&points).collect::<Vec<_>>()[..] else { panic!("{text}") };
        for (a, b) in cubic.iter().zip(&curves.points) {
            assert!((*a - b.as_dvec4()).length() < 1e-5, "{a} {b}");
        }
        let linear = of(CurveBasis::Linear, along(&[(0.0, 0.5), (1.0, 0.5)]));
        assert_eq!(file(&linear), b"0 1 0 0.5\n1 1 0 0.5\n\n");
    }

    #[test]
    fn widths_are_linear_where_they_can_be() {
        let even = of(CurveBasis::Linear, along(&[(0.0, 0.5), (1.0, 0.375), (2.0, 0.25)]));
        let (one, is_linear) = splines(&even);
        assert_eq!((one.len(), one[0].points.len(), one[0].widths, is_linear), (1, 21, [1.0, 0.5], true));
        let bent = of(CurveBasis::Linear, along(&[(0.0, 0.5), (1.0, 0.5), (2.0, 0.25)]));
        let (two, is_linear) = splines(&bent);
        assert_eq!((two.len(), two[1].widths, is_linear), (2, [1.0, 0.5], true));
        let bulge = of(CurveBasis::Bezier, along(&[(0.0, 0.1), (1.0, 0.5), (2.0, 0.5), (3.0, 0.1)]));
        assert!(!splines(&bulge).1);
    }
}
