//! The one buffer of a file: views of it, and accessors that say what is in them.

use glam::{Vec2, Vec3};

use super::json::Json;

const FLOAT: usize = 5126;
const UNSIGNED_INT: usize = 5125;
/// Of vertices, and of indices.
const ARRAY_BUFFER: usize = 34962;
const ELEMENT_ARRAY_BUFFER: usize = 34963;

/// Bytes, views and accessors as they grow. Everything begins at a multiple of four bytes.
#[derive(Default)]
pub struct Buffer {
    pub bytes: Vec<u8>,
    views: Vec<Json>,
    accessors: Vec<Json>,
}

impl Buffer {
    /// Positions, with their bounds, which the format asks for.
    pub fn positions(&mut self, values: &[Vec3]) -> usize {
        let bounds =
            values.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |b, p| (b.0.min(*p), b.1.max(*p)));
        let bounds =
            vec![("min", Json::numbers(&bounds.0.to_array())), ("max", Json::numbers(&bounds.1.to_array()))];
        self.floats(values.iter().flat_map(|v| v.to_array()), values.len(), "VEC3", bounds)
    }

    /// Vectors.
    pub fn vectors(&mut self, values: &[Vec3]) -> usize {
        self.floats(values.iter().flat_map(|v| v.to_array()), values.len(), "VEC3", Vec::new())
    }

    /// Texture coordinates, whose v is counted from the other end.
    pub fn uvs(&mut self, values: &[Vec2]) -> usize {
        self.floats(values.iter().flat_map(|uv| [uv.x, 1.0 - uv.y]), values.len(), "VEC2", Vec::new())
    }

    /// Corners of triangles.
    pub fn indices(&mut self, triangles: &[[u32; 3]]) -> usize {
        let bytes = triangles.iter().flatten().flat_map(|i| i.to_le_bytes());
        let view = self.view(bytes, Some(ELEMENT_ARRAY_BUFFER));
        self.accessor(view, UNSIGNED_INT, 3 * triangles.len(), "SCALAR", Vec::new())
    }

    /// A view of any bytes; `target` is what a graphics processor does with them.
    pub fn view(&mut self, bytes: impl IntoIterator<Item = u8>, target: Option<usize>) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let length = self.bytes.len() - start;
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = vec![
            ("buffer", Json::Integer(0)),
            ("byteOffset", Json::Integer(start)),
            ("byteLength", Json::Integer(length)),
        ];
        view.extend(target.map(|target| ("target", Json::Integer(target))));
        self.views.push(Json::Object(view));
        self.views.len() - 1
    }

    /// The views and the accessors, to be written.
    pub fn take_lists(&mut self) -> (Vec<Json>, Vec<Json>) {
        (std::mem::take(&mut self.views), std::mem::take(&mut self.accessors))
    }

    fn floats(
        &mut self,
        values: impl Iterator<Item = f32>,
        count: usize,
        kind: &str,
        bounds: Vec<(&'static str, Json)>,
    ) -> usize {
        let view = self.view(values.flat_map(f32::to_le_bytes), Some(ARRAY_BUFFER));
        self.accessor(view, FLOAT, count, kind, bounds)
    }

    fn accessor(
        &mut self,
        view: usize,
        component: usize,
        count: usize,
        kind: &str,
        bounds: Vec<(&'static str, Json)>,
    ) -> usize {
        let mut accessor = vec![
            ("bufferView", Json::Integer(view)),
            ("componentType", Json::Integer(component)),
            ("count", Json::Integer(count)),
            ("type", Json::text(kind)),
        ];
        accessor.extend(bounds);
        self.accessors.push(Json::Object(accessor));
        self.accessors.len() - 1
    }
}
