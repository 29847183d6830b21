//! Nodes: the camera, the lights, and shapes as meshes.

use std::sync::Arc;

use glam::{Mat4, Quat, Vec3};
use sr_scene::{LightDesc, MeshDesc, Projection, Rgb, ShapeDesc, Span, SpotFalloff, TextureDesc};

use super::json::Json;
use super::{Attributes, MIRROR, Writer, emission_key};
use crate::{surfaces, tessellate};

impl Writer<'_> {
    pub(super) fn camera(&mut self) {
        let camera = &self.scene.camera;
        let aspect = camera.film.width as f32 / camera.film.height.max(1) as f32;
        let span = &camera.span;
        let message = "glTF has no film, no samples and no depth of paths";
        let instead = "the aspect ratio is written, all else is up to what reads the file";
        self.notes.push("convert::settings", span, message, instead);
        let clip = |list: &mut Vec<(&'static str, Json)>| {
            list.push(("znear", Json::Number(camera.near_clip)));
            list.push(("zfar", Json::Number(camera.far_clip)));
        };
        let m = match self.is_mirrored {
            true => Mat4::from_scale(MIRROR) * camera.world_from_camera,
            false => camera.world_from_camera,
        };
        let (kind, lens) = match camera.projection {
            Projection::Perspective { fov_axis, fov, principal_point_offset: offset, lens } => {
                if offset.x != 0.0 || offset.y != 0.0 {
                    let message = "glTF's cameras look along their middle";
                    self.notes.push("convert::camera", span, message, "the picture is not shifted");
                }
                if lens.is_some_and(|lens| lens.aperture_radius > 0.0) {
                    let message = "glTF's cameras have no lens";
                    self.notes.push("convert::camera", span, message, "all is in focus");
                }
                let tan_x = (0.5 * fov_axis.horizontal(fov, aspect)).tan();
                let mut list = vec![
                    ("aspectRatio", Json::Number(aspect)),
                    ("yfov", Json::Number(2.0 * (tan_x / aspect).atan())),
                ];
                clip(&mut list);
                ("perspective", list)
            }
            Projection::Orthographic => {
                let (x, y) = (m.x_axis.truncate().length(), m.y_axis.truncate().length() / aspect);
                let mut list = vec![("xmag", Json::Number(x)), ("ymag", Json::Number(y))];
                clip(&mut list);
                ("orthographic", list)
            }
            Projection::Spherical => {
                let message = "glTF has no camera that sees all around";
                let instead = "a perspective one of 90° that looks along its middle is written";
                self.notes.push("convert::camera", span, message, instead);
                let yfov = 2.0 * (1.0 / aspect).atan();
                let mut list = vec![("aspectRatio", Json::Number(aspect)), ("yfov", Json::Number(yfov))];
                clip(&mut list);
                ("perspective", list)
            }
        };
        if camera.film.crop.is_some() {
            self.notes.push("convert::camera", span, "glTF cannot show a part of a film", "all is shown");
        }
        self.cameras.push(Json::Object(vec![("type", Json::text(kind)), (kind, Json::Object(lens))]));
        // glTF's look along −Z, with +X to the right.
        let unit = |axis: glam::Vec4| axis.truncate().normalize_or_zero();
        let turned = glam::Mat3::from_cols(-unit(m.x_axis), unit(m.y_axis), -unit(m.z_axis));
        let rotation = Quat::from_mat3(&turned).normalize();
        let place = m.w_axis.truncate();
        self.nodes.push(node(vec![("camera", Json::Integer(0))], rotation, place));
    }

    pub(super) fn all_lights(&mut self) {
        for light in &self.scene.lights {
            self.light(light);
        }
    }

    fn light(&mut self, light: &LightDesc) {
        let lost = |writer: &mut Self, what: &str, span: &Span| {
            writer.notes.push(
                "convert::light",
                span,
                format!("glTF has no {what}"),
                "it is left out, and the picture is darker",
            );
        };
        match light {
            LightDesc::Constant { span, .. } | LightDesc::Environment { span, .. } => {
                lost(self, "light around the scene", span);
            }
            LightDesc::Sky { span, .. } => lost(self, "sky", span),
            LightDesc::Point { position, intensity, range, .. } => {
                self.punctual("point", *intensity, ranged(*range), (Quat::IDENTITY, *position));
            }
            LightDesc::Directional { direction, irradiance, .. } => {
                self.punctual("directional", *irradiance, Vec::new(), (along(*direction), Vec3::ZERO));
            }
            LightDesc::Sun { direction, aperture, world_from_light, span, .. } => {
                let message = "glTF has no sun";
                let instead = "parallel light of the same irradiance is written";
                self.notes.push("convert::light", span, message, instead);
                let towards = *world_from_light * *direction;
                let probe = sr_render::light::Probe::new(light, self.scene, self.baker.textures());
                let solid_angle = std::f32::consts::TAU * (1.0 - (0.5 * aperture).cos());
                let irradiance = probe.radiance(towards) * solid_angle;
                self.punctual("directional", irradiance, Vec::new(), (along(-towards), Vec3::ZERO));
            }
            LightDesc::Spot {
                world_from_light,
                intensity,
                cutoff_angle,
                beam_width,
                falloff,
                range,
                texture,
                span,
            } => {
                if *falloff == SpotFalloff::Linear && beam_width < cutoff_angle {
                    let message = "glTF's spot lights fall off by the square of a cosine";
                    self.notes.push("convert::light", span, message, "it does so within the same angles");
                }
                if texture.is_some() {
                    let message = "glTF's spot lights have no texture";
                    self.notes.push("convert::light", span, message, "it is evenly bright");
                }
                let most = std::f32::consts::FRAC_PI_2;
                if *cutoff_angle > most {
                    let message = "glTF's spot lights are no wider than a half space";
                    self.notes.push("convert::light", span, message, "it is as wide as that");
                }
                let outer = cutoff_angle.min(most);
                // The inner angle has to be smaller.
                let inner = beam_width.min(outer * (1.0 - 1e-4));
                let spot = Json::Object(vec![
                    ("innerConeAngle", Json::Number(inner)),
                    ("outerConeAngle", Json::Number(outer)),
                ]);
                let axis = world_from_light.transform_vector3(Vec3::Z).normalize_or(Vec3::Z);
                let place = world_from_light.w_axis.truncate();
                let members = ranged(*range).into_iter().chain([("spot", spot)]).collect();
                self.punctual("spot", *intensity, members, (along(axis), place));
            }
            LightDesc::Projector { world_from_light, span, .. }
            | LightDesc::Goniometric { world_from_light, span, .. }
            | LightDesc::Profile { world_from_light, span, .. } => {
                let message = "glTF has no light whose intensity an image or a measurement tells";
                self.notes.push("convert::light", span, message, "a point of its mean intensity is written");
                let position = world_from_light.w_axis.truncate();
                let mean = crate::directions::mean_intensity(self.scene, &self.baker, light, position);
                self.punctual("point", mean, Vec::new(), (Quat::IDENTITY, position));
            }
        }
    }

    /// A light of KHR_lights_punctual: its color is at most 1, its intensity all else.
    fn punctual(
        &mut self,
        kind: &str,
        intensity: Rgb,
        more: Vec<(&'static str, Json)>,
        (rotation, place): (Quat, Vec3),
    ) {
        let most = intensity.max_element();
        if !(most > 0.0) {
            return;
        }
        self.extensions.insert("KHR_lights_punctual");
        let mut light = vec![
            ("type", Json::text(kind)),
            ("color", Json::numbers(&(intensity / most).to_array())),
            ("intensity", Json::Number(most)),
        ];
        light.extend(more);
        self.lights.push(Json::Object(light));
        let reference = Json::Object(vec![("light", Json::Integer(self.lights.len() - 1))]);
        let extension = Json::Object(vec![("KHR_lights_punctual", reference)]);
        self.nodes.push(node(vec![("extensions", extension)], rotation, place));
    }

    pub(super) fn shapes(&mut self) {
        let scene = self.scene;
        for shape in &scene.shapes {
            if let Some(mesh) = self.mesh(std::slice::from_ref(shape)) {
                self.nodes.push(Json::Object(vec![("mesh", Json::Integer(mesh))]));
            }
        }
        let mut groups: Vec<Option<Option<usize>>> = vec![None; scene.groups.len()];
        for instance in &scene.instances {
            let index = instance.group as usize;
            let Some(group) = scene.groups.get(index) else { continue };
            let mesh = match groups.get(index).copied().flatten() {
                Some(known) => known,
                None => {
                    let made = self.mesh(&group.shapes);
                    if let Some(slot) = groups.get_mut(index) {
                        *slot = Some(made);
                    }
                    made
                }
            };
            let Some(mesh) = mesh else { continue };
            let mut members = vec![("mesh", Json::Integer(mesh))];
            let m = Mat4::from(instance.world_from_group);
            if m != Mat4::IDENTITY {
                members.push(("matrix", Json::numbers(&m.to_cols_array())));
            }
            self.nodes.push(Json::Object(members));
        }
    }

    /// A mesh of a primitive for each shape.
    fn mesh(&mut self, shapes: &[ShapeDesc]) -> Option<usize> {
        let mut primitives = Vec::new();
        for shape in shapes {
            primitives.extend(self.primitive(shape));
        }
        if primitives.is_empty() {
            return None;
        }
        self.meshes.push(Json::Object(vec![("primitives", Json::List(primitives))]));
        Some(self.meshes.len() - 1)
    }

    fn primitive(&mut self, shape: &ShapeDesc) -> Option<Json> {
        let (mut mesh, was) = tessellate::mesh(&shape.geometry);
        if let Some(name) = was {
            let message = format!("glTF has no {name}");
            self.notes.push("convert::tessellated", &shape.span, message, "triangles are written");
        }
        let emission = shape.emission.map(|emission| emission.radiance);
        let is_textured = surfaces::has_texture(self.scene, shape.material)
            || matches!(emission, Some(sr_scene::ColorInput::Texture(_)));
        if is_textured && mesh.uvs.is_empty() {
            mesh = tessellate::with_uvs(&mesh);
        }
        if mesh.triangles.is_empty() {
            return None;
        }
        let key = (shape.material, emission_key(emission));
        let material = match self.known_materials.get(&key) {
            Some(&known) => known,
            None => {
                let made = self.material(shape.material, emission, &shape.span);
                self.materials.push(made);
                self.known_materials.insert(key, self.materials.len() - 1);
                self.materials.len() - 1
            }
        };
        let Attributes { positions, normals, uvs, further_uvs, colors, indices } = self.attributes(&mesh);
        let mut attributes = vec![("POSITION", Json::Integer(positions))];
        attributes.extend(normals.map(|at| ("NORMAL", Json::Integer(at))));
        attributes.extend(uvs.map(|at| ("TEXCOORD_0", Json::Integer(at))));
        let names = ["TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3"];
        attributes.extend(names.into_iter().zip(further_uvs).map(|(name, at)| (name, Json::Integer(at))));
        // Colors multiply the base: only where a texture asks for them.
        let wants_colors = self.colored.contains(&shape.material);
        attributes.extend(colors.filter(|_| wants_colors).map(|at| ("COLOR_0", Json::Integer(at))));
        Some(Json::Object(vec![
            ("attributes", Json::Object(attributes)),
            ("indices", Json::Integer(indices)),
            ("material", Json::Integer(material)),
        ]))
    }

    /// The accessors of positions, normals, texture coordinates, colors and corners.
    fn attributes(&mut self, mesh: &Arc<MeshDesc>) -> Attributes {
        let key = Arc::as_ptr(mesh).addr();
        if let Some(known) = self.known_meshes.get(&key) {
            return known.clone();
        }
        let positions = self.buffer.positions(&mesh.positions);
        // Unit length is asked for.
        let unit: Vec<Vec3> = mesh.normals.iter().map(|n| n.normalize_or(Vec3::Z)).collect();
        let normals = (!unit.is_empty()).then(|| self.buffer.vectors(&unit));
        let uvs = (!mesh.uvs.is_empty()).then(|| self.buffer.uvs(&mesh.uvs));
        // A set that the mesh does not have is its first one, if a texture of the scene asks for it.
        let asked = self.scene.textures.iter().map(|texture| match texture {
            TextureDesc::OtherUvs { set, .. } => *set as usize,
            _ => 0,
        });
        let further = asked.max().unwrap_or(0).max(mesh.further_uvs.len());
        let of_set = |set: usize| mesh.further_uvs.get(set).filter(|set| !set.is_empty());
        let mut further_uvs = Vec::new();
        if let Some(first) = uvs {
            further_uvs.extend((0..further).map(|set| of_set(set).map_or(first, |set| self.buffer.uvs(set))));
        }
        let colors = (!mesh.vertex_colors.is_empty()).then(|| {
            let colors: Vec<Vec3> =
                mesh.vertex_colors.iter().map(|c| c.clamp(Vec3::ZERO, Vec3::ONE)).collect();
            self.buffer.vectors(&colors)
        });
        let indices = self.buffer.indices(&mesh.triangles);
        let known = Attributes { positions, normals, uvs, further_uvs, colors, indices };
        self.known_meshes.insert(key, known.clone());
        self.made.push(mesh.clone());
        known
    }
}

/// How far a light shines, if not for ever.
fn ranged(range: f32) -> Vec<(&'static str, Json)> {
    if range.is_finite() { vec![("range", Json::Number(range))] } else { Vec::new() }
}

/// A rotation of −Z to a direction.
fn along(direction: Vec3) -> Quat {
    Quat::from_rotation_arc(Vec3::NEG_Z, direction.normalize_or(Vec3::NEG_Z))
}

fn node(mut members: Vec<(&'static str, Json)>, rotation: Quat, place: Vec3) -> Json {
    if rotation != Quat::IDENTITY {
        members.push(("rotation", Json::numbers(&rotation.to_array())));
    }
    if place != Vec3::ZERO {
        members.push(("translation", Json::numbers(&place.to_array())));
    }
    Json::Object(members)
}
