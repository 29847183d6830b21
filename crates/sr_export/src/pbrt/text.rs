//! pbrt's syntax as it is written: directives, and parameters with their types.

use glam::Mat4;
use sr_scene::Rgb;

/// The parameters of a directive.
#[derive(Clone, Debug, Default)]
pub struct Params(String);

impl Params {
    pub fn float(mut self, name: &str, value: f32) -> Self {
        self.0.push_str(&format!(" \"float {name}\" {value}"));
        self
    }

    pub fn floats(mut self, kind: &str, values: &[f32]) -> Self {
        let list: Vec<String> = values.iter().map(f32::to_string).collect();
        self.0.push_str(&format!(" \"{kind}\" [ {} ]", list.join(" ")));
        self
    }

    pub fn integer(mut self, name: &str, value: i64) -> Self {
        self.0.push_str(&format!(" \"integer {name}\" {value}"));
        self
    }

    pub fn integers(mut self, name: &str, values: &[u32]) -> Self {
        let list: Vec<String> = values.iter().map(u32::to_string).collect();
        self.0.push_str(&format!(" \"integer {name}\" [ {} ]", list.join(" ")));
        self
    }

    pub fn boolean(mut self, name: &str, value: bool) -> Self {
        self.0.push_str(&format!(" \"bool {name}\" {value}"));
        self
    }

    pub fn string(mut self, name: &str, value: &str) -> Self {
        self.0.push_str(&format!(" \"string {name}\" \"{}\"", escaped(value)));
        self
    }

    pub fn strings(mut self, name: &str, values: &[&str]) -> Self {
        let list: Vec<String> = values.iter().map(|v| format!("\"{}\"", escaped(v))).collect();
        self.0.push_str(&format!(" \"string {name}\" [ {} ]", list.join(" ")));
        self
    }

    /// Values at wavelengths in nm.
    pub fn spectrum(self, name: &str, samples: &[(f64, f64)]) -> Self {
        let numbers: Vec<f32> = samples.iter().flat_map(|&(w, value)| [w as f32, value as f32]).collect();
        self.floats(&format!("spectrum {name}"), &numbers)
    }

    pub fn rgb(self, name: &str, color: Rgb) -> Self {
        self.floats(&format!("rgb {name}"), &color.to_array())
    }

    /// Is roughness not α yet? Said once.
    pub fn remapped(self, remapped: bool) -> Self {
        if self.0.contains("\"bool remaproughness\"") {
            self
        } else {
            self.boolean("remaproughness", remapped)
        }
    }

    /// More of them.
    pub fn extend(&mut self, other: &Params) {
        self.0.push_str(&other.0);
    }

    pub fn texture(mut self, name: &str, texture: &str) -> Self {
        self.0.push_str(&format!(" \"texture {name}\" \"{texture}\""));
        self
    }
}

/// A text of directives.
#[derive(Default)]
pub struct Text(String);

impl Text {
    /// A directive without parameters, or a comment.
    pub fn line(&mut self, line: &str) {
        self.0.push_str(line);
        self.0.push('\n');
    }

    /// A directive of a kind, such as `Shape "sphere"`.
    pub fn directive(&mut self, name: &str, kind: &str, params: &Params) {
        self.line(&format!("{name} \"{}\"{}", escaped(kind), params.0));
    }

    /// A texture: its type is "float" or "spectrum".
    pub fn texture(&mut self, name: &str, kind: &str, class: &str, params: &Params) {
        self.line(&format!("Texture \"{name}\" \"{kind}\" \"{class}\"{}", params.0));
    }

    /// Multiplies the current transform; columns are written one after another.
    pub fn concat(&mut self, m: Mat4) {
        if m != Mat4::IDENTITY {
            let list: Vec<String> = m.to_cols_array().iter().map(f32::to_string).collect();
            self.line(&format!("ConcatTransform [ {} ]", list.join(" ")));
        }
    }

    pub fn append(&mut self, other: &Text) {
        self.0.push_str(&other.0);
    }

    pub fn into_bytes(self) -> Vec<u8> {
        self.0.into_bytes()
    }
}

fn escaped(value: &str) -> String {
    value.replace('\\', "\\\\").replace('"', "\\\"")
}
