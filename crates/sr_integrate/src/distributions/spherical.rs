//! Triangles and rectangles as they are seen from the origin: uniform by solid angle.

use glam::{DVec3, Vec3};
use sr_sampling::warp;

use super::directions::polygon_bounds;
use super::parameter::{ParameterError, finite};
use super::typed::Typed;

/// A coordinate in single precision, in which the two are computed.
fn single(argument: &'static str, vector: [f64; 3]) -> Result<Vec3, ParameterError> {
    for (axis, value) in ["x", "y", "z"].into_iter().zip(vector) {
        finite(&format!("{argument}.{axis}"), value)?;
        finite(&format!("{argument}.{axis}, in single precision,"), f64::from(value as f32))?;
    }
    Ok(DVec3::from(vector).as_vec3())
}

/// By how much rounding to single precision may leave a box of directions.
const ROUNDING: f64 = 2e-7;

/// Directions from the origin to a triangle, all equally likely; pdf = 1 / solid angle, in sr⁻¹. Directions
/// have the seven digits of single precision. See [`warp::SphericalTriangle`].
///
/// # Errors
/// If a coordinate is not finite, or the solid angle is 0 or below 10⁻¹⁰ sr.
pub fn spherical_triangle(
    a: [f64; 3],
    b: [f64; 3],
    c: [f64; 3],
) -> Result<Typed<warp::SphericalTriangle>, ParameterError> {
    let vertices = [single("a", a)?, single("b", b)?, single("c", c)?];
    let triangle = warp::SphericalTriangle::new(vertices, Vec3::ZERO).map_err(|_| ParameterError::Shape {
        argument: "a",
        what: format!("= {a:?}, b = {b:?} and c = {c:?} make a triangle that the origin sees as nothing"),
    })?;
    let corners = vertices.map(|v| v.as_dvec3().normalize());
    Ok(Typed::invertible(triangle, polygon_bounds(&corners, ROUNDING)))
}

/// Directions from a point to a rectangle, all equally likely; pdf = 1 / solid angle, in sr⁻¹. Directions
/// have the seven digits of single precision. See [`warp::SphericalRectangle`].
///
/// # Errors
/// If a coordinate is not finite, the edges are not perpendicular, the point lies in the plane of the
/// rectangle, or the solid angle is below 10⁻¹⁰ sr.
pub fn spherical_rectangle(
    corner: [f64; 3],
    edges: [[f64; 3]; 2],
    seen_from: [f64; 3],
) -> Result<Typed<warp::SphericalRectangle>, ParameterError> {
    // The difference in double precision: what is far from the origin may be near to the viewer.
    let from_viewer = (DVec3::from(corner) - DVec3::from(seen_from)).to_array();
    let (corner_32, e0, e1) =
        (single("corner", from_viewer)?, single("edge1", edges[0])?, single("edge2", edges[1])?);
    let rectangle =
        warp::SphericalRectangle::new(corner_32, [e0, e1], Vec3::ZERO).map_err(|_| ParameterError::Shape {
            argument: "corner",
            what: format!(
                "= {corner:?}, edge1 = {:?} and edge2 = {:?} make no rectangle, or one that is seen as nothing from \
                 {seen_from:?}",
                edges[0], edges[1]
            ),
        })?;
    let corners = [Vec3::ZERO, e0, e0 + e1, e1].map(|offset| (corner_32 + offset).as_dvec3().normalize());
    Ok(Typed::invertible(rectangle, polygon_bounds(&corners, ROUNDING)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::Columns;
    use crate::density::Density;

    #[test]
    fn an_octant_is_an_eighth_of_the_sphere() {
        let octant = spherical_triangle([2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 1.0]).unwrap();
        let mut pdf = [0.0; 2];
        let third = (1.0_f64 / 3.0).sqrt();
        octant.pdf(Columns::new(&[third, -third, third, third, third, third], 2), &mut pdf).unwrap();
        assert!((pdf[0] - 2.0 / std::f64::consts::PI).abs() < 1e-7 && pdf[1] == 0.0);
        let facet =
            spherical_rectangle([9.0, -1.0, 1.0], [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0]], [10.0, 0.0, 0.0])
                .unwrap();
        facet.pdf(Columns::new(&[0.0, 0.0, 0.0, 0.0, 1.0, -1.0], 2), &mut pdf).unwrap();
        assert!((pdf[0] - 1.5 / std::f64::consts::PI).abs() < 1e-7 && pdf[1] == 0.0);
    }

    #[test]
    fn errors_name_the_vertices() {
        let text =
            spherical_triangle([1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]).unwrap_err().to_string();
        assert!(text.starts_with("a = [1.0, 0.0, 0.0], b = [2.0"), "{text}");
        let text =
            spherical_triangle([1.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0], [0.0; 3]).unwrap_err().to_string();
        assert!(text.starts_with("b.x is NaN"), "{text}");
        assert!(spherical_rectangle([0.0; 3], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [0.5, 0.5, 0.0]).is_err());
    }
}
