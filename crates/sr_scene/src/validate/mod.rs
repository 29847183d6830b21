//! What makes a description impossible to render, or unlike what its author can have meant.
//!
//! In: a [`SceneDesc`], however it was made. Out: diagnostics. A description without errors can be compiled
//! without further checks: ids are in range, materials form a tree, every number is finite.

mod camera;
mod extent;
mod film;
mod hair;
mod light;
mod material;
mod mesh_color;
mod principled;
mod shape;
mod texture;

use crate::diagnostic::{Diagnostic, Span};
use crate::{ColorInput, MaterialId, Rgb, SceneDesc, TextureId};

pub use film::MAX_FILM_PIXELS;

/// Checks a whole description.
pub fn validate(scene: &SceneDesc) -> Vec<Diagnostic> {
    let asked = mesh_color::Asked::by_textures(scene);
    let mut check = Check { scene, asked, found: Vec::new() };
    check.camera(&scene.camera);
    check.textures();
    for index in 0..scene.materials.len() {
        let id = MaterialId(index as u32);
        let span = scene.material_span(id);
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
    check.instances();
    for light in &scene.lights {
        check.light(light);
    }
    check.missing_mesh_colors();
    check.negative_texels();
    check.found
}

/// The largest number in a color: its square, and that of a sum of many, is still one in single precision.
const BRIGHTEST: f32 = 1e18;

/// An angle in radians as people write it: in degrees, without what single precision added.
fn degrees(angle: f32) -> String {
    let rounded = (f64::from(angle).to_degrees() * 1e4).round() / 1e4;
    format!("{rounded}°")
}

struct Check<'a> {
    scene: &'a SceneDesc,
    /// For each texture, which colours of a mesh it asks for.
    asked: Vec<mesh_color::Asked>,
    found: Vec<Diagnostic>,
}

impl Check<'_> {
    fn error(&mut self, code: &'static str, span: &Span, message: impl Into<String>) {
        let error = Diagnostic::error(code, span, message);
        // Roughness along x and y is one number in most files: one is enough.
        let is_said = |last: &Diagnostic| {
            last.span == error.span && last.code == error.code && last.message == error.message
        };
        if !self.found.last().is_some_and(is_said) {
            self.found.push(error);
        }
    }

    fn texture_id(&mut self, id: TextureId, span: &Span) {
        if id.0 as usize >= self.scene.textures.len() {
            self.error("scene::bad-id", span, format!("there is no texture {}", id.0));
        }
    }

    fn color_input(&mut self, input: &ColorInput, what: &str, span: &Span) {
        match *input {
            ColorInput::Constant(color) => self.color(color, what, span),
            ColorInput::Texture(id) => self.texture_id(id, span),
        }
    }

    fn color(&mut self, color: Rgb, what: &str, span: &Span) {
        if !(color.min_element() >= 0.0 && color.max_element() <= BRIGHTEST) || color.is_nan() {
            let message = format!(
                "{what} is {}, {}, {}: a color has no negative parts, and none above {BRIGHTEST:e}",
                color.x, color.y, color.z
            );
            self.error("scene::bad-color", span, message);
        }
    }
}
