//! What all densities over directions share: unit vectors, frames, and the least boxes that hold a part of
//! the sphere.

use glam::DVec3;

use super::parameter::{ParameterError, bad};
use crate::columns::{Columns, ColumnsMut};
use crate::density::DensityError;

/// Densities per solid angle, point by point.
pub(crate) trait OnSphere {
    /// A direction from two uniforms, and its density.
    fn draw(&self, u: [f64; 2]) -> (DVec3, f64);

    /// The density at a unit vector.
    fn density(&self, w: DVec3) -> f64;

    /// The uniforms that are drawn as a unit vector of the support.
    fn undraw(&self, w: DVec3) -> [f64; 2];
}

/// [`Density::sample`](crate::Density::sample) of a density over directions.
pub(crate) fn sample(of: &impl OnSphere, u: Columns<'_>, mut x: ColumnsMut<'_>, pdf: &mut [f64]) {
    for (i, pdf) in pdf.iter_mut().enumerate() {
        let (w, density) = of.draw([u.get(i, 0), u.get(i, 1)]);
        x.write(i, &w.to_array());
        *pdf = density;
    }
}

/// [`Density::pdf`](crate::Density::pdf) of a density over directions.
pub(crate) fn pdf(of: &impl OnSphere, x: Columns<'_>, pdf: &mut [f64]) {
    for (i, pdf) in pdf.iter_mut().enumerate() {
        *pdf = direction(x, i).map_or(0.0, |w| of.density(w));
    }
}

/// [`Inverse::invert`](crate::Inverse::invert) of a density over directions.
pub(crate) fn invert(of: &impl OnSphere, x: Columns<'_>, mut u: ColumnsMut<'_>) -> Result<(), DensityError> {
    for i in 0..x.len() {
        let inside = direction(x, i).filter(|&w| of.density(w) > 0.0);
        u.write(i, &inside.map_or([f64::NAN; 2], |w| of.undraw(w).map(super::line::below_one)));
    }
    Ok(())
}

/// How far the squared length of a direction may be from 1.
const SLACK: f64 = 1e-4;

/// Point `i` as a unit vector. `None` if it is not one, not even in single precision.
#[inline]
fn direction(x: Columns<'_>, i: usize) -> Option<DVec3> {
    let w = DVec3::new(x.get(i, 0), x.get(i, 1), x.get(i, 2));
    let square = w.length_squared();
    ((square - 1.0).abs() <= SLACK).then(|| w / square.sqrt())
}

/// A vector of any length as a direction.
pub(crate) fn normalized(argument: &str, [x, y, z]: [f64; 3]) -> Result<DVec3, ParameterError> {
    for (axis, value) in ["x", "y", "z"].into_iter().zip([x, y, z]) {
        if !value.is_finite() {
            return Err(bad(format!("{argument}.{axis}"), value, "finite"));
        }
    }
    let v = DVec3::new(x, y, z);
    let largest = v.abs().max_element();
    if largest == 0.0 {
        return Err(bad(format!("the length of {argument}"), 0.0, "positive"));
    }
    Ok((v / largest).normalize())
}

/// Right-handed unit vectors of which the third is given: +X, +Y for +Z.
///
/// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017.
pub(crate) fn frame(n: DVec3) -> [DVec3; 3] {
    let sign = 1.0_f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    [
        DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
        DVec3::new(b, sign + n.y * n.y * a, -n.y),
        n,
    ]
}

/// By how much rounding may leave a box.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

fn widened([low, high]: [f64; 2], by: f64) -> [f64; 2] {
    [(low - by).max(-1.0), (high + by).min(1.0)]
}

/// The least box that holds all directions within an angle of an axis.
pub(crate) fn cap_bounds(axis: DVec3, angle: f64) -> Vec<[f64; 2]> {
    let side = |x: f64| {
        let from = x.clamp(-1.0, 1.0).acos();
        widened([(from + angle).min(std::f64::consts::PI).cos(), (from - angle).max(0.0).cos()], ROUNDING)
    };
    axis.to_array().map(side).to_vec()
}

/// The least box that holds a convex polygon on the sphere, widened by `slack`.
///
/// Along each axis the extremes are at corners, within edges, or where the axis itself pierces the polygon.
pub(crate) fn polygon_bounds(corners: &[DVec3], slack: f64) -> Vec<[f64; 2]> {
    let edges = || (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()]));
    let greatest = |axis: DVec3| {
        let sides: Vec<f64> = edges().map(|(p, q)| p.cross(q).dot(axis)).collect();
        let centre: DVec3 = corners.iter().sum();
        let around = sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0);
        if around && centre.dot(axis) > 0.0 {
            return 1.0;
        }
        let on_edge = |(p, q): (DVec3, DVec3)| {
            let n = p.cross(q);
            let nearest = (axis - n * (n.dot(axis) / n.length_squared())).normalize_or_zero();
            let between = p.cross(nearest).dot(n) >= 0.0 && nearest.cross(q).dot(n) >= 0.0;
            p.dot(axis).max(q.dot(axis)).max(if between { nearest.dot(axis) } else { -1.0 })
        };
        edges().map(on_edge).fold(-1.0, f64::max)
    };
    [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| widened([-greatest(-axis), greatest(axis)], slack)).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_right_handed() {
        for n in [DVec3::Z, -DVec3::Z, DVec3::X, DVec3::new(0.6, -0.48, 0.64), DVec3::new(0.0, 0.6, -0.8)] {
            let [t, b, n] = frame(n);
            assert!(
                (t.cross(b) - n).length() < 1e-15
                    && t.dot(n).abs() < 1e-15
                    && (t.length() - 1.0).abs() < 1e-15
            );
        }
        assert_eq!(frame(DVec3::Z), [DVec3::X, DVec3::Y, DVec3::Z]);
    }

    #[test]
    fn boxes_hold_their_parts_of_the_sphere() {
        let octant = polygon_bounds(&[DVec3::X, DVec3::Y, DVec3::Z], 0.0);
        assert_eq!(octant, [[0.0, 1.0]; 3]);
        // A square about +Z bulges: its edges rise above its corners.
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let square = polygon_bounds(&corners.map(|(x, y)| DVec3::new(x, y, 1.0).normalize()), 0.0);
        let (edge, corner) = (0.5_f64.sqrt(), (1.0_f64 / 3.0).sqrt());
        for (side, exact) in square.iter().zip([[-edge, edge], [-edge, edge], [corner, 1.0]]) {
            assert!((side[0] - exact[0]).abs() < 1e-15 && (side[1] - exact[1]).abs() < 1e-15, "{square:?}");
        }
        let cap = cap_bounds(DVec3::Z, 0.5);
        assert!((cap[0][1] - 0.5_f64.sin()).abs() < 1e-14 && (cap[2][0] - 0.5_f64.cos()).abs() < 1e-14);
        assert_eq!(cap[2][1], 1.0);
    }

    #[test]
    fn only_unit_vectors_are_directions() {
        let x = [1.0, 2.0, f64::NAN, 0.0];
        let numbers = [x, [0.0; 4], [0.0; 4]].concat();
        let found: Vec<bool> = (0..4).map(|i| direction(Columns::new(&numbers, 4), i).is_some()).collect();
        assert_eq!(found, [true, false, false, false]);
        assert!(normalized("axis", [0.0; 3]).unwrap_err().to_string().contains("the length of axis is 0"));
        assert!(
            normalized("axis", [0.0, f64::NAN, 1.0]).unwrap_err().to_string().starts_with("axis.y is NaN")
        );
    }
}
