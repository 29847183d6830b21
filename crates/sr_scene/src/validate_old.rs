//! What makes a description impossible to render, or unlike what its author can have meant.
//!
//! In: a [`SceneDesc`], however it was made. Out: diagnostics. A description without errors can be compiled
//! without further checks: ids are in range, materials form a tree, every number is finite.

use crate::diagnostic::{Diagnostic, Span};
use crate::{
    CameraDesc, ColorInput, Emission, FilterDesc, Geometry, LightDesc, MaterialDesc, MaterialId, Rgb,
    ScalarInput, SceneDesc, ShapeDesc, TextureDesc, TextureId,
};

/// A film of more pixels than this is an error: its accumulators alone would not fit in memory.
pub const MAX_FILM_PIXELS: u64 = 1 << 27;

/// Materials nested deeper than this are an error.
const MAX_MATERIAL_DEPTH: usize = 8;

/// Checks a whole description. `span_of` says where a material was described.
pub fn validate(scene: &SceneDesc, span_of: impl Fn(MaterialId) -> Span) -> Vec<Diagnostic> {
    let mut check = Check { scene, found: Vec::new() };
    check.camera(&scene.camera);
    for texture in &scene.textures {
        check.texture(texture);
    }
    for index in 0..scene.materials.len() {
        let id = MaterialId(index as u32);
        let span = span_of(id);
        if check.nesting(id, &span, 0) {
            check.material(&scene.materials[index], &span);
        }
    }
    for shape in &scene.shapes {
        check.shape(shape);
    }
    for group in &scene.groups {
        for shape in &group.shapes {
            check.shape(shape);
            if shape.emission.is_some() {
                check.error("scene::emitter-in-group", &shape.span, "a shape of a group cannot emit");
            }
        }
    }
    for instance in &scene.instances {
        if instance.group as usize >= scene.groups.len() {
            check.error("scene::bad-id", &instance.span, format!("there is no group {}", instance.group));
        }
        let m = instance.world_from_group;
        if !m.is_finite() || m.matrix3.determinant() == 0.0 {
            check.error(
                "scene::bad-transform",
                &instance.span,
                "the placement of an instance is not invertible",
            );
        }
    }
    for light in &scene.lights {
        check.light(light);
    }
    check.found
}

struct Check<'a> {
    scene: &'a SceneDesc,
    found: Vec<Diagnostic>,
}

impl Check<'_> {
    fn error(&mut self, code: &'static str, span: &Span, message: impl Into<String>) {
        self.found.push(Diagnostic::error(code, span, message));
    }

    fn camera(&mut self, camera: &CameraDesc) {
        let span = &camera.span;
        let film = &camera.film;
        let pixels = u64::from(film.width) * u64::from(film.height);
        if pixels == 0 || pixels > MAX_FILM_PIXELS {
            let size = format!("a film of {} × {} pixels", film.width, film.height);
            let limit = format!("at least 1 and at most {MAX_FILM_PIXELS} pixels are possible");
            self.found.push(Diagnostic::error("scene::film-size", span, size).hint(limit));
        }
        if !(camera.fov > 0.0 && camera.fov < std::f32::consts::PI) {
            let fov = camera.fov.to_degrees();
            self.error(
                "scene::field-of-view",
                span,
                format!("an angle of view of {fov}° is not between 0° and 180°"),
            );
        }
        let m = camera.world_from_camera;
        if !m.is_finite() || m.determinant() == 0.0 {
            self.error("scene::bad-transform", span, "the placement of the camera is not invertible");
        }
        if !(camera.near_clip > 0.0 && camera.far_clip > camera.near_clip) {
            let (near, far) = (camera.near_clip, camera.far_clip);
            self.error(
                "scene::clip",
                span,
                format!("clipping distances {near} and {far}: 0 < near < far is needed"),
            );
        }
        if !(camera.aperture_radius >= 0.0 && camera.aperture_radius.is_finite()) {
            self.error("scene::aperture", span, format!("an aperture radius of {}", camera.aperture_radius));
        }
        if camera.aperture_radius > 0.0 && !(camera.focus_distance > 0.0 && camera.focus_distance.is_finite())
        {
            self.error("scene::focus", span, format!("a focus distance of {}", camera.focus_distance));
        }
        if !camera.principal_point_offset.is_finite() {
            self.error("scene::not-finite", span, "the principal point is not finite");
        }
        let radius = match film.filter {
            FilterDesc::Box { radius } | FilterDesc::Tent { radius } => radius,
            FilterDesc::Gaussian { stddev, radius } if stddev > 0.0 => radius,
            FilterDesc::Gaussian { .. } => f32::NAN,
        };
        if !(radius > 0.0 && radius <= 32.0) {
            self.error(
                "scene::filter",
                span,
                format!("a pixel filter of radius {radius}: (0, 32] is possible"),
            );
        }
    }

    fn texture(&mut self, texture: &TextureDesc) {
        let (to_uv, span) = match texture {
            TextureDesc::Bitmap { image, to_uv, span, .. } => {
                if *image as usize >= self.scene.images.len() {
                    self.error("scene::bad-id", span, format!("there is no image {image}"));
                }
                (to_uv, span)
            }
            TextureDesc::Checkerboard { color0, color1, to_uv, span } => {
                self.color(*color0, "color0", span);
                self.color(*color1, "color1", span);
                (to_uv, span)
            }
        };
        if !to_uv.is_finite() {
            self.error("scene::bad-transform", span, "the transform of texture coordinates is not finite");
        }
    }

    fn color(&mut self, color: Rgb, what: &str, span: &Span) -> bool {
        let good = color.is_finite() && color.min_element() >= 0.0;
        if !good {
            let message = format!(
                "{what} is {}, {}, {}: a color has no negative or infinite parts",
                color.x, color.y, color.z
            );
            self.error("scene::bad-color", span, message);
        }
        good
    }

    fn texture_id(&mut self, id: TextureId, span: &Span) {
        if id.0 as usize >= self.scene.textures.len() {
            self.error("scene::bad-id", span, format!("there is no texture {}", id.0));
        }
    }

    fn color_input(&mut self, input: &ColorInput, what: &str, span: &Span) {
        match *input {
            ColorInput::Constant(color) => {
                self.color(color, what, span);
            }
            ColorInput::Texture(id) => self.texture_id(id, span),
        }
    }

    fn albedo(&mut self, input: &ColorInput, what: &str, span: &Span) {
        self.color_input(input, what, span);
        if let ColorInput::Constant(color) = *input
            && color.max_element() > 1.0
            && color.is_finite()
        {
            let message =
                format!("{what} is {}, {}, {}: more than 1 creates energy", color.x, color.y, color.z);
            self.found.push(
                Diagnostic::warning("scene::energy", span, message)
                    .consequence("it is rendered as it is; paths may not end without a depth limit"),
            );
        }
    }

    fn alpha(&mut self, input: &ScalarInput, span: &Span) {
        match *input {
            ScalarInput::Constant(alpha) if !(alpha > 0.0 && alpha.is_finite()) => {
                self.error("scene::alpha", span, format!("a roughness alpha of {alpha} is not positive"));
            }
            ScalarInput::Constant(_) => {}
            ScalarInput::Texture(id) => self.texture_id(id, span),
        }
    }

    fn eta(&mut self, eta: f32, span: &Span) {
        if !(eta > 0.0 && eta.is_finite()) {
            self.error(
                "scene::index",
                span,
                format!("a relative index of refraction of {eta} is not positive"),
            );
        }
    }

    /// Ids in range, no cycle, nothing where it cannot be. False if the material cannot be looked into.
    fn nesting(&mut self, id: MaterialId, span: &Span, depth: usize) -> bool {
        let Some(material) = self.scene.materials.get(id.0 as usize) else {
            self.error("scene::bad-id", span, format!("there is no material {}", id.0));
            return false;
        };
        if depth > MAX_MATERIAL_DEPTH {
            self.error(
                "scene::material-cycle",
                span,
                "this material contains itself, or is nested too deeply",
            );
            return false;
        }
        match *material {
            MaterialDesc::TwoSided { front, back } => {
                let sides = if front == back { vec![front] } else { vec![front, back] };
                for side in sides {
                    if !self.nesting(side, span, depth + 1) {
                        return false;
                    }
                    if depth == 0 && self.transmits(side) {
                        let message = "a two-sided material cannot hold one that transmits light";
                        self.error("scene::twosided-transmission", span, message);
                    }
                }
                true
            }
            MaterialDesc::Mask { inner, .. } | MaterialDesc::BumpMap { inner, .. } => {
                self.nesting(inner, span, depth + 1)
            }
            _ => true,
        }
    }

    fn transmits(&self, id: MaterialId) -> bool {
        match self.scene.materials.get(id.0 as usize) {
            Some(
                MaterialDesc::Dielectric { .. }
                | MaterialDesc::ThinDielectric { .. }
                | MaterialDesc::RoughDielectric { .. }
                | MaterialDesc::Mask { .. },
            ) => true,
            Some(MaterialDesc::BumpMap { inner, .. }) => self.transmits(*inner),
            _ => false,
        }
    }

    fn material(&mut self, material: &MaterialDesc, span: &Span) {
        match material {
            MaterialDesc::Diffuse { reflectance } => self.albedo(reflectance, "reflectance", span),
            MaterialDesc::Dielectric { eta, specular_reflectance, specular_transmittance }
            | MaterialDesc::ThinDielectric { eta, specular_reflectance, specular_transmittance } => {
                self.eta(*eta, span);
                self.albedo(specular_reflectance, "specular_reflectance", span);
                self.albedo(specular_transmittance, "specular_transmittance", span);
            }
            MaterialDesc::RoughDielectric {
                alpha,
                eta,
                specular_reflectance,
                specular_transmittance,
                ..
            } => {
                alpha.iter().for_each(|a| self.alpha(a, span));
                self.eta(*eta, span);
                self.albedo(specular_reflectance, "specular_reflectance", span);
                self.albedo(specular_transmittance, "specular_transmittance", span);
            }
            MaterialDesc::Conductor { eta_k, specular_reflectance } => {
                self.complex_index(eta_k, span);
                self.albedo(specular_reflectance, "specular_reflectance", span);
            }
            MaterialDesc::RoughConductor { alpha, eta_k, specular_reflectance, .. } => {
                alpha.iter().for_each(|a| self.alpha(a, span));
                self.complex_index(eta_k, span);
                self.albedo(specular_reflectance, "specular_reflectance", span);
            }
            MaterialDesc::Plastic { eta, diffuse_reflectance, specular_reflectance, .. } => {
                self.eta(*eta, span);
                self.albedo(diffuse_reflectance, "diffuse_reflectance", span);
                self.albedo(specular_reflectance, "specular_reflectance", span);
            }
            MaterialDesc::RoughPlastic { alpha, eta, diffuse_reflectance, specular_reflectance, .. } => {
                self.alpha(&ScalarInput::Constant(*alpha), span);
                self.eta(*eta, span);
                self.albedo(diffuse_reflectance, "diffuse_reflectance", span);
                self.albedo(specular_reflectance, "specular_reflectance", span);
            }
            MaterialDesc::TwoSided { .. } => {}
            MaterialDesc::Mask { opacity, .. } => match *opacity {
                ScalarInput::Constant(value) if !(0.0..=1.0).contains(&value) => {
                    self.error(
                        "scene::opacity",
                        span,
                        format!("an opacity of {value} is not between 0 and 1"),
                    );
                }
                ScalarInput::Constant(_) => {}
                ScalarInput::Texture(id) => self.texture_id(id, span),
            },
            MaterialDesc::BumpMap { scale, texture, .. } => {
                self.texture_id(*texture, span);
                if !scale.is_finite() {
                    self.error("scene::not-finite", span, "the scale of a bump map is not finite");
                }
            }
        }
    }

    fn complex_index(&mut self, eta_k: &Option<(ColorInput, ColorInput)>, span: &Span) {
        if let Some((eta, k)) = eta_k {
            self.color_input(eta, "eta", span);
            self.color_input(k, "k", span);
        }
    }

    fn shape(&mut self, shape: &ShapeDesc) {
        let span = &shape.span;
        if shape.material.0 as usize >= self.scene.materials.len() {
            self.error("scene::bad-id", span, format!("there is no material {}", shape.material.0));
        }
        if let Some(Emission { radiance }) = &shape.emission {
            self.color_input(radiance, "radiance", span);
        }
        match &shape.geometry {
            Geometry::Sphere { center, radius, frame, .. } => {
                if !(*radius > 0.0 && radius.is_finite() && center.is_finite() && frame.is_finite()) {
                    self.error("scene::sphere", span, format!("a sphere of radius {radius} at {center}"));
                }
            }
            Geometry::Disk { center, u_axis, v_axis, .. } => {
                let area = u_axis.cross(*v_axis).length();
                if !(area > 0.0 && area.is_finite() && center.is_finite()) {
                    self.error("scene::disk", span, "a disk without area");
                }
            }
            Geometry::Mesh(mesh) => {
                let n = mesh.positions.len();
                if (!mesh.normals.is_empty() && mesh.normals.len() != n)
                    || (!mesh.uvs.is_empty() && mesh.uvs.len() != n)
                {
                    self.error(
                        "scene::mesh-arrays",
                        span,
                        format!("{}: arrays of unequal length", mesh.name),
                    );
                }
                if let Some(bad) = mesh.positions.iter().position(|p| !p.is_finite()) {
                    self.error(
                        "scene::not-finite",
                        span,
                        format!("{}: vertex {bad} is not finite", mesh.name),
                    );
                }
                if let Some(bad) = mesh.triangles.iter().position(|t| t.iter().any(|&i| i as usize >= n)) {
                    let message =
                        format!("{}: triangle {bad} uses a vertex that does not exist ({n} do)", mesh.name);
                    self.error("scene::mesh-index", span, message);
                }
            }
        }
    }

    fn light(&mut self, light: &LightDesc) {
        match light {
            LightDesc::Constant { radiance, span } => {
                self.color(*radiance, "radiance", span);
            }
            LightDesc::Environment { image, scale, world_from_light, span } => {
                if *image as usize >= self.scene.images.len() {
                    self.error("scene::bad-id", span, format!("there is no image {image}"));
                }
                if !(*scale >= 0.0 && scale.is_finite()) {
                    self.error("scene::bad-color", span, format!("an environment's scale of {scale}"));
                }
                if !world_from_light.is_finite() || world_from_light.determinant() == 0.0 {
                    self.error("scene::bad-transform", span, "the environment's placement is not invertible");
                }
            }
            LightDesc::Point { position, intensity, span } => {
                self.color(*intensity, "intensity", span);
                if !position.is_finite() {
                    self.error("scene::not-finite", span, "the position is not finite");
                }
            }
            LightDesc::Directional { direction, irradiance, span } => {
                self.color(*irradiance, "irradiance", span);
                if !direction.is_normalized() {
                    self.error("scene::direction", span, "the direction is not of unit length");
                }
            }
            LightDesc::Spot { world_from_light, intensity, cutoff_angle, beam_width, texture, span } => {
                self.color(*intensity, "intensity", span);
                if let Some(id) = texture {
                    self.texture_id(*id, span);
                }
                if !(*cutoff_angle > 0.0
                    && *cutoff_angle <= std::f32::consts::PI
                    && (0.0..=*cutoff_angle).contains(beam_width))
                {
                    let (cutoff, beam) = (cutoff_angle.to_degrees(), beam_width.to_degrees());
                    let message = format!(
                        "cutoff angle {cutoff}°, beam width {beam}°: 0 ≤ beam ≤ cutoff ≤ 180° is needed"
                    );
                    self.error("scene::spot", span, message);
                }
                if !world_from_light.is_finite() || world_from_light.determinant() == 0.0 {
                    self.error("scene::bad-transform", span, "the spot light's placement is not invertible");
                }
            }
        }
    }
}
