//! `<transform>` elements: translate, rotate, scale, matrix, lookat; later ones are applied after earlier ones.

use glam::{DMat4, DVec3};
use roxmltree::Node as Element;

use crate::look_at::look_at;
use crate::mitsuba::attributes::Attributes;

/// One step of a transform; `Err` is a sentence.
pub fn step(element: Element<'_, '_>, attributes: &mut Attributes<'_, '_>) -> Result<DMat4, String> {
    match element.tag_name().name() {
        "translate" => Ok(DMat4::from_translation(attributes.vector(0.0)?)),
        "scale" => {
            let scale = attributes.vector(1.0)?;
            Ok(DMat4::from_scale(scale))
        }
        "rotate" => {
            let angle = attributes.number("angle")?.ok_or("a rotation needs an angle")?;
            let axis = attributes.vector(0.0)?;
            let axis = axis.try_normalize().ok_or("the axis of a rotation cannot be zero")?;
            Ok(DMat4::from_axis_angle(axis, angle.to_radians()))
        }
        "matrix" => matrix(&attributes.numbers("value")?.ok_or("a matrix needs a value")?),
        "lookat" | "lookAt" | "look_at" => {
            let point = |v: Option<Vec<f64>>, name: &str| match v.as_deref() {
                Some(&[x, y, z]) => Ok(DVec3::new(x, y, z)),
                Some(_) => Err(format!("{name} needs three numbers")),
                None => Err(format!("a lookat needs {name}")),
            };
            let origin = point(attributes.numbers("origin")?, "origin")?;
            let target = point(attributes.numbers("target")?, "target")?;
            let up = match attributes.numbers("up")? {
                Some(v) => point(Some(v), "up")?,
                None => DVec3::ZERO,
            };
            look_at(origin, target, up)
        }
        other => Err(format!("a transform has no step \"{other}\"")),
    }
}

/// Row-major 4×4, or 3×3 without a translation.
fn matrix(values: &[f64]) -> Result<DMat4, String> {
    let m = match values.len() {
        16 => DMat4::from_cols_slice(values).transpose(),
        9 => {
            let rows: Vec<DVec3> = values.chunks_exact(3).map(DVec3::from_slice).collect();
            DMat4::from_mat3(glam::DMat3::from_cols(rows[0], rows[1], rows[2]).transpose())
        }
        n => return Err(format!("a matrix has 16 (or 9) numbers, not {n}")),
    };
    let last = m.row(3);
    if (last - glam::DVec4::W).abs().max_element() > 1e-6 {
        return Err("the last row of a matrix has to be 0 0 0 1".into());
    }
    Ok(m)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse_matrix(text: &str) -> Result<DMat4, String> {
        matrix(&crate::values::numbers(text)?)
    }

    #[test]
    fn a_matrix_is_row_major_and_affine() {
        let m = parse_matrix("1 0 0 5, 0 1 0 6  0 0 1 7 0 0 0 1").unwrap();
        assert_eq!(m.transform_point3(DVec3::ZERO), DVec3::new(5., 6., 7.));
        assert!(parse_matrix("1 0 0 5 0 1 0 6 0 0 1 7 0 0 1 1").is_err());
        assert!(parse_matrix("1 2 3").is_err());
        assert_eq!(parse_matrix("0 1 0 1 0 0 0 0 1").unwrap().transform_vector3(DVec3::X), DVec3::Y);
    }
}
