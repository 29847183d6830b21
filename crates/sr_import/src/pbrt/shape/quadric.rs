//! Spheres, disks and cylinders: whole ones.

use std::f32::consts::{PI, TAU};

use glam::{DMat3, DVec3};
use sr_scene::Geometry;

use super::{Form, Params, Reader};

/// Are the columns of unit length and perpendicular, to the precision that files are written with?
fn is_orthonormal(m: DMat3) -> bool {
    (m.transpose() * m - DMat3::IDENTITY).to_cols_array().iter().all(|v| v.abs() < 1e-3)
}

impl Reader<'_> {
    pub(super) fn sphere(&mut self, params: &mut Params) -> Vec<Form> {
        let radius = f64::from(params.float("radius").unwrap_or(1.0));
        self.partial(params, &["zmin", "zmax", "phimax"]);
        let (linear, _) = self.linear();
        let scale = linear.x_axis.length();
        let frame = DMat3::from_cols(linear.x_axis / scale, linear.y_axis / scale, linear.z_axis / scale);
        if !is_orthonormal(frame) {
            let message = "a sphere whose transform is not a similarity is not supported";
            let consequence = format!("it stays a sphere, scaled by {scale} as its x-axis is");
            self.warn("pbrt::sphere-transform", &params.span, message, &consequence);
        }
        // pbrt's v grows from −Z to +Z, and ours the other way: the frame is mirrored.
        let frame = DMat3::from_cols(frame.x_axis, frame.y_axis, -frame.z_axis);
        let radius = (radius * scale) as f32;
        let geometry = Geometry::Sphere {
            center: self.state.ctm.w_axis.truncate().as_vec3(),
            radius,
            frame: frame.as_mat3(),
            flip_normals: self.state.reverse_orientation,
        };
        vec![Form::ready(geometry, 4.0 * PI * radius * radius)]
    }

    pub(super) fn disk(&mut self, params: &mut Params) -> Vec<Form> {
        let height = f64::from(params.float("height").unwrap_or(0.0));
        let radius = f64::from(params.float("radius").unwrap_or(1.0));
        self.partial(params, &["innerradius", "phimax"]);
        let (linear, is_mirrored) = self.linear();
        let (u, v) = ((linear.x_axis * radius).as_vec3(), (linear.y_axis * radius).as_vec3());
        if u.dot(v).abs() > 1e-4 * u.length() * v.length() {
            let message = "a disk whose transform is a shear is not supported";
            self.warn("pbrt::disk-transform", &params.span, message, "its axes stay as they are");
        }
        let geometry = Geometry::Disk {
            center: self.state.ctm.transform_point3(DVec3::new(0.0, 0.0, height)).as_vec3(),
            u_axis: u,
            v_axis: v,
            flip_normals: self.state.reverse_orientation ^ is_mirrored,
        };
        vec![Form::ready(geometry, PI * u.cross(v).length())]
    }

    pub(super) fn cylinder(&mut self, params: &mut Params) -> Vec<Form> {
        let radius = f64::from(params.float("radius").unwrap_or(1.0));
        let z_min = f64::from(params.float("zmin").unwrap_or(-1.0));
        let z_max = f64::from(params.float("zmax").unwrap_or(1.0));
        self.partial(params, &["phimax"]);
        let (linear, _) = self.linear();
        let (across, along) = (linear.x_axis.length(), linear.z_axis.length());
        let frame = DMat3::from_cols(linear.x_axis / across, linear.y_axis / across, linear.z_axis / along);
        if !is_orthonormal(frame) {
            let message = "a cylinder whose transform shears it, or makes it oval, is not supported";
            let consequence = format!("it stays a round cylinder, its radius scaled by {across}");
            self.warn("pbrt::cylinder-transform", &params.span, message, &consequence);
        }
        let length = ((z_max - z_min).abs() * along) as f32;
        let radius = (radius * across) as f32;
        let geometry = Geometry::Cylinder {
            base: self.state.ctm.transform_point3(DVec3::new(0.0, 0.0, z_min.min(z_max))).as_vec3(),
            frame: frame.as_mat3(),
            radius,
            length,
            flip_normals: self.state.reverse_orientation,
        };
        vec![Form::ready(geometry, TAU * radius * length)]
    }

    /// Parameters that leave a part of a shape out.
    fn partial(&mut self, params: &mut Params, names: &[&'static str]) {
        params.unsupported(names, "the whole of it is shown", &mut self.notes());
    }
}
