//! Shapes, objects and their instances.

use std::sync::Arc;

use glam::{Mat3, Mat4, Vec3};
use sr_scene::{CurveBasis, CurveUv, CurvesDesc, Geometry, MeshDesc, ShapeDesc};

use super::Writer;
use super::text::{Params, Text};
use crate::curves::Spline;
use crate::{surfaces, tessellate};

impl Writer<'_> {
    pub(super) fn groups(&mut self, text: &mut Text) {
        let scene = self.scene;
        for (index, group) in scene.groups.iter().enumerate() {
            if !scene.instances.iter().any(|instance| instance.group as usize == index) {
                continue;
            }
            text.line(&format!("ObjectBegin \"group{index}\""));
            for shape in &group.shapes {
                self.shape(text, shape);
            }
            text.line("ObjectEnd");
        }
    }

    pub(super) fn instances(&mut self, text: &mut Text) {
        for instance in &self.scene.instances {
            text.line("AttributeBegin");
            text.concat(Mat4::from(instance.world_from_group));
            text.line(&format!("ObjectInstance \"group{}\"", instance.group));
            text.line("AttributeEnd");
        }
    }

    pub(super) fn shape(&mut self, text: &mut Text, shape: &ShapeDesc) {
        let (material, alpha) = self.surface(shape.material);
        let light = shape.emission.map(|emission| self.area_light(emission.radiance, &shape.span));
        let is_textured = surfaces::has_texture(self.scene, shape.material)
            || shape
                .emission
                .is_some_and(|emission| !matches!(emission.radiance, sr_scene::ColorInput::Constant(_)));
        text.line("AttributeBegin");
        text.directive("NamedMaterial", &material, &Params::default());
        if let Some(light) = light {
            text.directive("AreaLightSource", "diffuse", &light);
        }
        match &shape.geometry {
            Geometry::Mesh(mesh) => self.mesh(text, mesh, is_textured, alpha),
            Geometry::Sphere { center, radius, frame, flip_normals } => {
                reverse(text, *flip_normals);
                // pbrt's v grows from −Z to +Z, and ours the other way.
                let frame = Mat3::from_cols(frame.x_axis, frame.y_axis, -frame.z_axis);
                text.concat(placed(frame, *center));
                text.directive("Shape", "sphere", &alpha.float("radius", *radius));
            }
            // pbrt's disks have other texture coordinates.
            Geometry::Disk { .. } if is_textured => {
                let message = "the texture coordinates of pbrt's disks are not ours";
                self.notes.push("convert::tessellated", &shape.span, message, "triangles are written");
                let (mesh, _) = tessellate::mesh(&shape.geometry);
                self.mesh(text, &mesh, true, alpha);
            }
            Geometry::Disk { center, u_axis, v_axis, flip_normals } => {
                reverse(text, *flip_normals);
                let normal = u_axis.cross(*v_axis).normalize_or(Vec3::Z);
                text.concat(placed(Mat3::from_cols(*u_axis, *v_axis, normal), *center));
                text.directive("Shape", "disk", &alpha.float("radius", 1.0));
            }
            Geometry::Cylinder { base, frame, radius, length, flip_normals } => {
                reverse(text, *flip_normals);
                text.concat(placed(*frame, *base));
                let params = alpha.float("radius", *radius).float("zmin", 0.0).float("zmax", *length);
                text.directive("Shape", "cylinder", &params);
            }
            Geometry::Curves(curves) => self.curves(text, curves, (shape, is_textured), &alpha),
            Geometry::Patch { corners, flip_normals } => {
                reverse(text, *flip_normals);
                let numbers: Vec<f32> = corners.iter().flat_map(|p| p.to_array()).collect();
                let params = alpha.floats("point3 P", &numbers).integers("indices", &[0, 1, 2, 3]);
                text.directive("Shape", "bilinearmesh", &params);
            }
        }
        text.line("AttributeEnd");
    }

    fn curves(
        &mut self,
        text: &mut Text,
        curves: &CurvesDesc,
        (shape, is_textured): (&ShapeDesc, bool),
        params: &Params,
    ) {
        let mut say = |message: &str, instead: &str| {
            self.notes.push("convert::curves", &shape.span, message, instead);
        };
        say("pbrt's curves are flat", "flat ones with the normals of round ones are written");
        if curves.basis == CurveBasis::Linear {
            say("pbrt's curves have no spheres at their joints and ends", "they are cut off there");
        }
        if curves.uv == CurveUv::AroundAlong && is_textured {
            say("the texture coordinates of pbrt's curves are not ours", "u runs along, and v across");
        }
        let (splines, is_linear) = crate::curves::splines(curves);
        if !is_linear {
            say("the widths of pbrt's curves are linear", "they are so within each segment");
        }
        for Spline { points, widths } in splines {
            let params = params.clone().string("type", "cylinder").floats("point3 P", &points);
            let params = params.float("width0", widths[0]).float("width1", widths[1]);
            text.directive("Shape", "curve", &params);
        }
    }

    fn mesh(&mut self, text: &mut Text, mesh: &Arc<MeshDesc>, is_textured: bool, params: Params) {
        // Without texture coordinates pbrt's are other ones than ours.
        let mesh = if is_textured { tessellate::with_uvs(mesh) } else { mesh.clone() };
        let file = self.files.mesh(&mesh);
        text.directive("Shape", "plymesh", &params.string("filename", &file));
    }
}

fn reverse(text: &mut Text, flip_normals: bool) {
    if flip_normals {
        text.line("ReverseOrientation");
    }
}

fn placed(linear: Mat3, origin: Vec3) -> Mat4 {
    Mat4::from_cols(
        linear.x_axis.extend(0.0),
        linear.y_axis.extend(0.0),
        linear.z_axis.extend(0.0),
        origin.extend(1.0),
    )
}
