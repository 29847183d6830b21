//! Shapes, groups and instances.

use std::sync::Arc;

use glam::{Mat3, Mat4, Vec3};
use sr_scene::{CurveBasis, CurveUv, CurvesDesc, Geometry, MeshDesc, ShapeDesc};

use super::Writer;
use super::xml::Xml;
use crate::{curves, surfaces, tessellate};

impl Writer<'_> {
    pub(super) fn groups(&mut self, xml: &mut Xml) {
        let scene = self.scene;
        for (index, group) in scene.groups.iter().enumerate() {
            if !scene.instances.iter().any(|instance| instance.group as usize == index) {
                continue;
            }
            xml.begin("shape", &[("type", "shapegroup"), ("id", &format!("group{index}"))]);
            for shape in &group.shapes {
                self.shape(xml, shape);
            }
            xml.end();
        }
    }

    pub(super) fn instances(&mut self, xml: &mut Xml) {
        for instance in &self.scene.instances {
            xml.begin("shape", &[("type", "instance")]);
            xml.reference(None, &format!("group{}", instance.group));
            xml.transform(Mat4::from(instance.world_from_group));
            xml.end();
        }
    }

    pub(super) fn shape(&mut self, xml: &mut Xml, shape: &ShapeDesc) {
        let material = self.material(shape.material);
        let radiance = shape.emission.map(|emission| self.prepared(emission.radiance));
        match &shape.geometry {
            Geometry::Mesh(mesh) => self.mesh(xml, mesh),
            Geometry::Sphere { center, radius, frame, flip_normals } => {
                xml.begin("shape", &[("type", "sphere")]);
                if *frame == Mat3::IDENTITY {
                    xml.vector("point", "center", *center);
                    xml.float("radius", *radius);
                } else {
                    xml.transform(placed(*frame * *radius, *center));
                }
                // Mitsuba's normals turn with a mirrored sphere.
                xml.boolean("flip_normals", flip_normals ^ (frame.determinant() < 0.0));
            }
            Geometry::Disk { center, u_axis, v_axis, flip_normals } => {
                xml.begin("shape", &[("type", "disk")]);
                let normal = u_axis.cross(*v_axis).normalize_or(Vec3::Z);
                xml.transform(placed(Mat3::from_cols(*u_axis, *v_axis, normal), *center));
                xml.boolean("flip_normals", *flip_normals);
            }
            Geometry::Cylinder { base, frame, radius, length, flip_normals } => {
                xml.begin("shape", &[("type", "cylinder")]);
                let size = Mat3::from_diagonal(Vec3::new(*radius, *radius, *length));
                xml.transform(placed(*frame * size, *base));
                xml.boolean("flip_normals", *flip_normals);
            }
            Geometry::Curves(curves) => self.curves(xml, curves, shape),
            Geometry::Patch { corners, flip_normals } => {
                if self.own("bilinear patch", &shape.span, "triangles are written") {
                    xml.begin("shape", &[("type", "bilinearpatch")]);
                    for (corner, name) in corners.iter().zip(["p00", "p10", "p01", "p11"]) {
                        xml.vector("point", name, *corner);
                    }
                    xml.boolean("flip_normals", *flip_normals);
                } else {
                    let (mesh, _) = tessellate::mesh(&shape.geometry);
                    self.mesh(xml, &mesh);
                }
            }
        }
        xml.reference(None, &material);
        if let Some(radiance) = radiance {
            xml.begin("emitter", &[("type", "area")]);
            radiance.write(xml, "radiance");
            xml.end();
        }
        xml.end();
    }

    /// Begins a shape of curves.
    fn curves(&mut self, xml: &mut Xml, curves: &CurvesDesc, shape: &ShapeDesc) {
        let kind = if curves.basis == CurveBasis::Linear { "linearcurve" } else { "bsplinecurve" };
        if curves.uv == CurveUv::AlongAround && surfaces::has_texture(self.scene, shape.material) {
            let message = "the texture coordinates of Mitsuba's curves are not pbrt's";
            self.notes.push(
                "convert::curves",
                &shape.span,
                message,
                "u runs around them, and v along all of them",
            );
        }
        let file = self.files.bytes_in_folder("curves", &curves.name, "txt", curves::file(curves));
        xml.begin("shape", &[("type", kind)]);
        xml.string("filename", &file);
    }

    /// Begins a shape of triangles.
    fn mesh(&mut self, xml: &mut Xml, mesh: &Arc<MeshDesc>) {
        xml.begin("shape", &[("type", "ply")]);
        xml.string("filename", &self.files.mesh(mesh));
        if mesh.normals.is_empty() {
            xml.boolean("face_normals", true);
        }
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
