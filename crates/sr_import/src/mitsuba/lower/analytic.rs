//! Shapes that are no meshes: spheres, disks, cylinders, bilinear patches, curves.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use sr_scene::{CurveBasis, Diagnostic, Geometry};

use super::Lowering;
use crate::mitsuba::node::Node;
use crate::mitsuba::props::Props;
use crate::{curves, files};

impl<'a> Lowering<'a, '_> {
    pub(super) fn sphere(&mut self, node: &'a Node, props: &mut Props<'a>) -> Geometry {
        let center = props.vector("center", self.out.d).unwrap_or(DVec3::ZERO);
        let radius = f64::from(props.float("radius", self.out.d).unwrap_or(1.0));
        let to_world = props.transform("to_world", self.out.d);
        let flip_normals = props.boolean("flip_normals", self.out.d).unwrap_or(false);
        let linear = DMat3::from_mat4(to_world);
        let scale = linear.x_axis.length();
        let frame = DMat3::from_cols(linear.x_axis / scale, linear.y_axis / scale, linear.z_axis / scale);
        if !is_orthonormal(frame) {
            self.out.d.push(
                Diagnostic::warning(
                    "mitsuba::sphere-transform",
                    &node.span,
                    "the transform of a sphere is not a similarity",
                )
                .consequence(format!("it stays a sphere, scaled by {scale} as its x-axis is")),
            );
        }
        Geometry::Sphere {
            center: to_world.transform_point3(center).as_vec3(),
            radius: (radius * scale) as f32,
            frame: frame.as_mat3(),
            flip_normals: flip_normals ^ (linear.determinant() < 0.0),
        }
    }

    pub(super) fn disk(&mut self, node: &'a Node, props: &mut Props<'a>) -> Geometry {
        let to_world = props.transform("to_world", self.out.d);
        let flip_normals = props.boolean("flip_normals", self.out.d).unwrap_or(false);
        let linear = DMat3::from_mat4(to_world);
        let (u, v) = (linear.x_axis, linear.y_axis);
        if u.dot(v).abs() > 1e-4 * u.length() * v.length() {
            self.out.d.push(
                Diagnostic::warning(
                    "mitsuba::disk-transform",
                    &node.span,
                    "the transform of a disk is a shear",
                )
                .consequence("it is rendered with its axes as they are, which Mitsuba does not allow"),
            );
        }
        Geometry::Disk {
            center: to_world.w_axis.truncate().as_vec3(),
            u_axis: u.as_vec3(),
            v_axis: v.as_vec3(),
            flip_normals: flip_normals ^ (linear.determinant() < 0.0),
        }
    }

    pub(super) fn cylinder(&mut self, node: &'a Node, props: &mut Props<'a>) -> Geometry {
        let p0 = props.vector("p0", self.out.d).unwrap_or(DVec3::ZERO);
        let p1 = props.vector("p1", self.out.d).unwrap_or(DVec3::Z);
        let radius = f64::from(props.float("radius", self.out.d).unwrap_or(1.0));
        let to_world = props.transform("to_world", self.out.d);
        let flip_normals = props.boolean("flip_normals", self.out.d).unwrap_or(false);
        // A zero length stays one: it is refused when the scene is validated.
        let length = (p1 - p0).length();
        let axis = (p1 - p0).try_normalize().unwrap_or(DVec3::Z);
        let (across, up) = axis.any_orthonormal_pair();
        let linear = DMat3::from_mat4(to_world) * DMat3::from_cols(across, up, axis);
        let (across, along) = (linear.x_axis.length(), linear.z_axis.length());
        let frame = DMat3::from_cols(linear.x_axis / across, linear.y_axis / across, linear.z_axis / along);
        if !is_orthonormal(frame) {
            self.out.d.push(
                Diagnostic::warning(
                    "mitsuba::cylinder-transform",
                    &node.span,
                    "the transform of a cylinder shears it, or scales its radius by more than one factor",
                )
                .consequence(format!("it stays a round cylinder, its radius scaled by {across}")),
            );
        }
        Geometry::Cylinder {
            base: to_world.transform_point3(p0).as_vec3(),
            frame: orthonormalized(frame).as_mat3(),
            radius: (radius * across) as f32,
            length: (length * along) as f32,
            flip_normals,
        }
    }

    /// `p00`, `p10`, `p01`, `p11`: by default the square of `rectangle`.
    pub(super) fn patch(&mut self, props: &mut Props<'a>) -> Geometry {
        let to_world = props.transform("to_world", self.out.d);
        let flip_normals = props.boolean("flip_normals", self.out.d).unwrap_or(false);
        let corners = [("p00", -1.0, -1.0), ("p10", 1.0, -1.0), ("p01", -1.0, 1.0), ("p11", 1.0, 1.0)];
        let corners = corners.map(|(name, x, y)| {
            let corner = props.vector(name, self.out.d).unwrap_or(DVec3::new(x, y, 0.0));
            to_world.transform_point3(corner).as_vec3()
        });
        Geometry::Patch { corners, flip_normals }
    }

    pub(super) fn curves(&mut self, node: &'a Node, props: &mut Props<'a>) -> Option<Geometry> {
        let basis = if node.kind == "linearcurve" { CurveBasis::Linear } else { CurveBasis::BSpline };
        let to_world = props.transform("to_world", self.out.d);
        let Some((name, span)) = props.string("filename", self.out.d) else {
            let message = format!("{} needs a \"filename\"", node.title());
            self.out.d.push(Diagnostic::error("mitsuba::missing-property", &node.span, message));
            return None;
        };
        let path = self.out.find(name);
        match curves::load(&path, basis, &to_world, &self.out.limits) {
            Ok((curves, note)) => {
                if let Some(note) = note {
                    let message = format!("{}: {note}", path.display());
                    let warning = Diagnostic::warning("file::curves", span, message);
                    self.out.d.push(warning.consequence("those after the fourth are ignored"));
                }
                Some(Geometry::Curves(Arc::new(curves)))
            }
            Err(reason) => {
                self.out.d.push(files::error("file::bad-curves", span, "curves", &path, &reason));
                None
            }
        }
    }
}

/// The nearest frame with the same +Z and the same handedness.
fn orthonormalized(m: DMat3) -> DMat3 {
    let z = m.z_axis.normalize_or(DVec3::Z);
    let x = (m.x_axis - z * z.dot(m.x_axis)).try_normalize().unwrap_or_else(|| z.any_orthonormal_vector());
    let y = z.cross(x);
    DMat3::from_cols(x, if m.determinant() < 0.0 { -y } else { y }, z)
}

/// Are the columns of unit length and perpendicular, to the precision that files are written with?
pub(super) fn is_orthonormal(m: DMat3) -> bool {
    (m.transpose() * m - DMat3::IDENTITY).to_cols_array().iter().all(|v| v.abs() < 1e-3)
}
