//! Shapes: form, material, light.
//!
//! - `quadric`: spheres, disks, cylinders; `swept`: parts of them. `mesh`: triangles, in the file or in others. `patch`: bilinear patches.
//!   `curve`: curves.

mod curve;
mod mesh;
mod patch;
mod quadric;
mod swept;

use std::sync::Arc;

use glam::DMat3;
use sr_scene::{Emission, Geometry, MaterialDesc, MaterialId, ScalarInput, ShapeDesc, Span};

use super::Reader;
use super::params::Params;
use super::support::{SHAPES, unsupported};
use crate::assembly::MeshSource;
use crate::mesh::{Convention, Placement};

/// How far the back of a two-sided light is from its front, as a part of its size: pbrt's have no thickness.
const THICKNESS: f32 = 1e-4;

/// One form of a shape.
struct Form {
    geometry: Geometry,
    mesh: Option<(MeshSource, Placement)>,
    /// The area of one of pbrt's lights, if it is known.
    area: Option<f32>,
}

impl Form {
    fn ready(geometry: Geometry, area: f32) -> Self {
        Self { geometry, mesh: None, area: Some(area) }
    }

    fn of_mesh(source: MeshSource, placement: Placement, area: Option<f32>) -> Self {
        Self { geometry: Geometry::Mesh(Arc::default()), mesh: Some((source, placement)), area }
    }

    /// The same, facing the other way, a little behind itself; `None` where that cannot be made.
    fn back(&self) -> Option<Self> {
        let geometry = match (&self.geometry, &self.mesh) {
            (_, Some((MeshSource::Memory(mesh), placement))) => {
                let source = MeshSource::Memory(Arc::new(mesh::behind(mesh, placement, THICKNESS)));
                let placement = Placement { flip_normals: !placement.flip_normals, ..placement.clone() };
                return Some(Self::of_mesh(source, placement, self.area));
            }
            (Geometry::Sphere { center, radius, frame, flip_normals }, _) => Geometry::Sphere {
                center: *center,
                radius: radius * (1.0 - THICKNESS),
                frame: *frame,
                flip_normals: !flip_normals,
            },
            (Geometry::Cylinder { base, frame, radius, length, flip_normals }, _) => Geometry::Cylinder {
                base: *base,
                frame: *frame,
                radius: radius * (1.0 - THICKNESS),
                length: *length,
                flip_normals: !flip_normals,
            },
            (Geometry::Disk { center, u_axis, v_axis, flip_normals }, _) => {
                let normal =
                    u_axis.cross(*v_axis).normalize_or_zero() * if *flip_normals { -1.0 } else { 1.0 };
                Geometry::Disk {
                    center: *center - normal * (THICKNESS * u_axis.length()),
                    u_axis: *u_axis,
                    v_axis: *v_axis,
                    flip_normals: !flip_normals,
                }
            }
            _ => return None,
        };
        Some(Self { geometry, mesh: None, area: self.area })
    }
}

impl Reader<'_> {
    /// `Shape "sphere"` and parameters.
    pub(super) fn shape(&mut self, kind: &str, mut params: Params) {
        let span = params.span.clone();
        let emits = self.state.area_light.is_some();
        if kind == "curve" {
            self.add_curve(params);
            return;
        }
        let forms = match kind {
            "sphere" => self.sphere(&mut params),
            "disk" => self.disk(&mut params),
            "cylinder" => self.cylinder(&mut params),
            "trianglemesh" => self.triangle_mesh(&mut params),
            "plymesh" => self.ply_mesh(&mut params),
            "loopsubdiv" => self.loop_subdivision(&mut params),
            "bilinearmesh" => self.bilinear_mesh(&mut params, emits),
            _ => {
                params.use_all();
                let note =
                    unsupported(SHAPES, "pbrt::unsupported-shape", &span, "a shape", kind, "it is left out");
                self.notes().push(note);
                Vec::new()
            }
        };
        let material = self.shape_material(&mut params);
        params.finish(&mut self.notes());
        for form in forms {
            self.add_form(form, material, &span);
        }
    }

    /// Hair is many curves: those of one material that follow one another are one shape.
    fn add_curve(&mut self, mut params: Params) {
        let span = params.span.clone();
        let curve = self.bezier_curve(&mut params);
        let material = self.shape_material(&mut params);
        params.finish(&mut self.notes());
        let Some(curve) = curve else { return };
        if self.state.area_light.is_some() {
            let message = "curves cannot emit";
            self.warn("pbrt::emitting-curves", &span, message, "they are rendered without their light");
        }
        self.out.add_curve(self.object, curve, material, &span);
    }

    /// The material in force, with holes where `alpha` is below 1.
    fn shape_material(&mut self, params: &mut Params) -> MaterialId {
        let span = params.span.clone();
        let material = match self.state.material {
            Some(material) => material,
            None => self.fallback(&span),
        };
        params.unsupported(&["shadowalpha"], "shadows have no holes of their own", &mut self.notes());
        match self.float_or_texture(params, "alpha").map(|texture| self.as_share(texture)) {
            None | Some(ScalarInput::Constant(1.0)) => material,
            Some(opacity) => self.out.add_material(MaterialDesc::Mask { opacity, inner: material }, &span),
        }
    }

    fn add_form(&mut self, form: Form, material: MaterialId, span: &Span) {
        if let Some(group) = self.object {
            if self.state.area_light.is_some() {
                let message = "a shape of an object cannot emit";
                self.warn("pbrt::light-in-object", span, message, "it is rendered without its light");
            }
            let shape = ShapeDesc { geometry: form.geometry, material, emission: None, span: span.clone() };
            self.out.add_shape_to_group(group, shape, form.mesh);
            return;
        }
        let emission = self.area_emission(form.area);
        if emission.as_ref().is_some_and(|light| light.is_two_sided) {
            match form.back() {
                Some(back) => self.push(back, material, emission.as_ref().map(|light| light.radiance), span),
                None => {
                    let message =
                        "a light on both sides of a mesh that is a file, or of a patch, is not supported";
                    self.warn("pbrt::two-sided-light", span, message, "only its front emits");
                }
            }
        }
        self.push(form, material, emission.map(|light| light.radiance), span);
    }

    fn push(
        &mut self,
        form: Form,
        material: MaterialId,
        radiance: Option<sr_scene::ColorInput>,
        span: &Span,
    ) {
        let emission = radiance.map(|radiance| Emission { radiance });
        self.out.add_shape(
            ShapeDesc { geometry: form.geometry, material, emission, span: span.clone() },
            form.mesh,
        );
    }

    fn placement(&self) -> Placement {
        Placement {
            to_world: self.state.ctm,
            face_normals: false,
            flip_normals: self.state.reverse_orientation,
            max_smooth_angle: None,
            flat: false,
            subdivision: None,
            convention: Convention::Flat,
            // Nothing in pbrt uses them.
            colors: false,
        }
    }

    /// The linear part of the current transform, and whether it mirrors.
    fn linear(&self) -> (DMat3, bool) {
        let linear = DMat3::from_mat4(self.state.ctm);
        (linear, linear.determinant() < 0.0)
    }
}
