//! Spheres, disks and cylinders. Whole and round ones have forms of their own; others are swept.

use std::f32::consts::{PI, TAU};

use glam::{DMat3, DVec3, Vec2};
use sr_scene::Geometry;

use super::swept::ProfilePoint;
use super::{Form, Params, Reader};

/// Rows of a sphere from pole to pole.
const ROWS: f32 = 64.0;

/// Are the columns of unit length and perpendicular, to the precision that files are written with?
fn is_orthonormal(m: DMat3) -> bool {
    (m.transpose() * m - DMat3::IDENTITY).to_cols_array().iter().all(|v| v.abs() < 1e-3)
}

impl Reader<'_> {
    pub(super) fn sphere(&mut self, params: &mut Params) -> Vec<Form> {
        let radius = f64::from(params.float("radius").unwrap_or(1.0));
        let phi_max = phi_max(params);
        let [low, high] = ["zmin", "zmax"].map(|name| params.float(name));
        let r = radius as f32;
        // Not `clamp`: the radius may be anything.
        let within = |z: f32| z.max(-r.abs()).min(r.abs());
        let (low, high) = (within(low.unwrap_or(-r)), within(high.unwrap_or(r)));
        let (low, high) = (low.min(high), low.max(high));
        let (linear, _) = self.linear();
        let scale = linear.x_axis.length();
        let frame = DMat3::from_cols(linear.x_axis / scale, linear.y_axis / scale, linear.z_axis / scale);
        let is_whole = phi_max == TAU && low <= -r && high >= r;
        if r > 0.0 && !(is_whole && is_orthonormal(frame)) {
            // θ from −Z up, as v grows.
            let [from, to] = [low, high].map(|z| (-z / r).clamp(-1.0, 1.0).acos());
            let rows = (ROWS * (to - from) / PI).ceil().max(2.0) as usize;
            let profile: Vec<ProfilePoint> = (0..=rows)
                .map(|row| {
                    let v = row as f32 / rows as f32;
                    let theta = from + (to - from) * v;
                    let is_pole = theta == 0.0 || theta >= PI - 1e-6;
                    let normal = Vec2::new(if is_pole { 0.0 } else { theta.sin() }, -theta.cos());
                    ProfilePoint { at: r * normal, normal, v }
                })
                .collect();
            if let Some(forms) = self.swept(params, &profile, phi_max) {
                return forms;
            }
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
        let phi_max = phi_max(params);
        let (r, inner) = (radius as f32, params.float("innerradius").unwrap_or(0.0));
        let (linear, is_mirrored) = self.linear();
        let (u, v) = ((linear.x_axis * radius).as_vec3(), (linear.y_axis * radius).as_vec3());
        let is_sheared = u.dot(v).abs() > 1e-4 * u.length() * v.length();
        if r > 0.0 && (phi_max != TAU || inner > 0.0 || is_sheared) {
            let point = |at: f32, v| ProfilePoint { at: Vec2::new(at, height as f32), normal: Vec2::Y, v };
            let profile = [point(r, 0.0), point(inner.clamp(0.0, r), 1.0)];
            if let Some(forms) = self.swept(params, &profile, phi_max) {
                return forms;
            }
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
        let phi_max = phi_max(params);
        let (linear, _) = self.linear();
        let (across, along) = (linear.x_axis.length(), linear.z_axis.length());
        let frame = DMat3::from_cols(linear.x_axis / across, linear.y_axis / across, linear.z_axis / along);
        if radius > 0.0 && (phi_max != TAU || !is_orthonormal(frame)) {
            let point =
                |z: f64, v| ProfilePoint { at: Vec2::new(radius as f32, z as f32), normal: Vec2::X, v };
            let profile = [point(z_min.min(z_max), 0.0), point(z_min.max(z_max), 1.0)];
            if let Some(forms) = self.swept(params, &profile, phi_max) {
                return forms;
            }
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
}

/// `phimax` in radians, exactly a whole turn if it is one.
fn phi_max(params: &mut Params) -> f32 {
    let degrees = params.float("phimax").unwrap_or(360.0);
    if degrees >= 360.0 || !degrees.is_finite() { TAU } else { degrees.max(0.0).to_radians() }
}
