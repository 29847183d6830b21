//! XML as it is written: elements, indented, with what Mitsuba calls properties.

use glam::{Affine2, Mat4, Vec3};
use sr_scene::Rgb;

/// A text of elements.
#[derive(Default)]
pub struct Xml {
    text: String,
    open: Vec<&'static str>,
}

impl Xml {
    /// Elements inside so many others.
    pub fn inside(depth: usize) -> Self {
        Self { text: String::new(), open: vec![""; depth] }
    }

    /// Begins an element.
    pub fn begin(&mut self, tag: &'static str, attributes: &[(&str, &str)]) {
        self.element(tag, attributes, ">");
        self.open.push(tag);
    }

    /// Ends the element that was begun last.
    pub fn end(&mut self) {
        if let Some(tag) = self.open.pop() {
            self.indent();
            self.text.push_str(&format!("</{tag}>\n"));
        }
    }

    /// An element without others in it.
    pub fn leaf(&mut self, tag: &str, attributes: &[(&str, &str)]) {
        self.element(tag, attributes, "/>");
    }

    pub fn float(&mut self, name: &str, value: f32) {
        self.leaf("float", &[("name", name), ("value", &value.to_string())]);
    }

    pub fn integer(&mut self, name: &str, value: i64) {
        self.leaf("integer", &[("name", name), ("value", &value.to_string())]);
    }

    pub fn boolean(&mut self, name: &str, value: bool) {
        self.leaf("boolean", &[("name", name), ("value", if value { "true" } else { "false" })]);
    }

    pub fn string(&mut self, name: &str, value: &str) {
        self.leaf("string", &[("name", name), ("value", value)]);
    }

    pub fn rgb(&mut self, name: &str, value: Rgb) {
        self.leaf("rgb", &[("name", name), ("value", &format!("{}, {}, {}", value.x, value.y, value.z))]);
    }

    pub fn vector(&mut self, tag: &str, name: &str, v: Vec3) {
        let [x, y, z] = v.to_array().map(|v| v.to_string());
        self.leaf(tag, &[("name", name), ("x", &x), ("y", &y), ("z", &z)]);
    }

    pub fn reference(&mut self, name: Option<&str>, id: &str) {
        match name {
            Some(name) => self.leaf("ref", &[("name", name), ("id", id)]),
            None => self.leaf("ref", &[("id", id)]),
        }
    }

    pub fn transform(&mut self, m: Mat4) {
        if m == Mat4::IDENTITY {
            return;
        }
        let rows = m.transpose().to_cols_array().map(|v| v.to_string());
        self.begin("transform", &[("name", "to_world")]);
        self.leaf("matrix", &[("value", &rows.join(" "))]);
        self.end();
    }

    pub fn uv_transform(&mut self, m: Affine2) {
        if m == Affine2::IDENTITY {
            return;
        }
        self.begin("transform", &[("name", "to_uv")]);
        let (x, y, t) = (m.matrix2.x_axis, m.matrix2.y_axis, m.translation);
        if x.y == 0.0 && y.x == 0.0 {
            self.leaf("scale", &[("x", &x.x.to_string()), ("y", &y.y.to_string()), ("z", "1")]);
            self.leaf("translate", &[("x", &t.x.to_string()), ("y", &t.y.to_string())]);
        } else {
            let rows = format!("{} {} 0 {} {} {} 0 {} 0 0 1 0 0 0 0 1", x.x, y.x, t.x, x.y, y.y, t.y);
            self.leaf("matrix", &[("value", &rows)]);
        }
        self.end();
    }

    /// More elements, at the same depth.
    pub fn append(&mut self, other: &Xml) {
        self.text.push_str(&other.text);
    }

    pub fn into_text(self) -> String {
        self.text
    }

    fn element(&mut self, tag: &str, attributes: &[(&str, &str)], end: &str) {
        self.indent();
        self.text.push('<');
        self.text.push_str(tag);
        for (name, value) in attributes {
            self.text.push_str(&format!(" {name}=\"{}\"", escaped(value)));
        }
        self.text.push_str(end);
        self.text.push('\n');
    }

    fn indent(&mut self) {
        self.text.push_str(&"    ".repeat(self.open.len()));
    }
}

fn escaped(value: &str) -> String {
    value.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_nested_and_values_escaped() {
        let mut xml = Xml::default();
        xml.begin("scene", &[("version", "3.0.0")]);
        xml.string("filename", "a \"<&>\".ply");
        xml.float("radius", 1e-7);
        xml.end();
        let expected = "<scene version=\"3.0.0\">\n    <string name=\"filename\" value=\"a &quot;&lt;&amp;>&quot;.ply\"/>\n    \
                        <float name=\"radius\" value=\"0.0000001\"/>\n</scene>\n";
        assert_eq!(xml.into_text(), expected);
    }
}
