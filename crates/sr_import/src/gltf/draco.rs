//! KHR_draco_mesh_compression: a primitive's triangles and attributes out of a packed stream.

use std::collections::HashMap;
use std::panic::catch_unwind;

use draco_core::{DecodeLimits, DecoderBuffer, Mesh, MeshDecoder};

use super::accessor::Rows;
use super::document::Document;
use super::json::Value;

/// More vertices, or triangles, than these do not come out of one stream: a few bytes can stand for any number of equal ones.
const MAX_ELEMENTS: u64 = 1 << 24;

/// More bytes of attributes than these do not, either.
const MAX_BYTES: u64 = 1 << 29;

/// What a stream holds.
pub struct Unpacked {
    pub triangles: Vec<[u32; 3]>,
    mesh: Mesh,
    /// Names of attributes to their numbers in the stream.
    numbers: HashMap<String, u32>,
}

impl Document<'_, '_> {
    /// What a primitive's stream holds, if it has one: `Some(None)` if it cannot be unpacked, which is said.
    pub fn unpack(&mut self, primitive: &Value) -> Option<Option<Unpacked>> {
        let packed = primitive.extension("KHR_draco_mesh_compression")?;
        let Some(view) = packed.get("bufferView") else {
            self.error("gltf::draco", &packed.span, "the packed mesh names no buffer view");
            return Some(None);
        };
        let Some(view) = self.view(view) else { return Some(None) };
        let declared = primitive.get("indices").and_then(|index| self.item("accessors", index));
        let declared = declared.and_then(|accessor| accessor.get("count")).and_then(Value::index);
        let declared = declared.map_or(u64::MAX, |count| count as u64 / 3);
        let budget = self.budget as u64;
        let limits = DecodeLimits::default()
            .with_max_faces(MAX_ELEMENTS.min(declared).min(budget / 3))
            .with_max_points(MAX_ELEMENTS.min(budget))
            .with_max_decoded_bytes(MAX_BYTES.min(budget.saturating_mul(4)));
        match decode(view.bytes(), limits) {
            Ok(mesh) => {
                self.budget = self.budget.saturating_sub(3 * mesh.num_faces());
                let attributes = packed.get("attributes").map_or(&[][..], Value::members);
                let number =
                    |(name, number): &(String, Value)| Some((name.clone(), number.index()?.try_into().ok()?));
                let numbers = attributes.iter().filter_map(number).collect();
                let triangles = mesh.faces().iter().map(|face| face.map(|corner| corner.0)).collect();
                Some(Some(Unpacked { triangles, mesh, numbers }))
            }
            Err(reason) => {
                let message = format!("the mesh that Draco packed cannot be read: {reason}");
                self.error("gltf::draco", &packed.span, message);
                Some(None)
            }
        }
    }

    /// The rows of an attribute: out of the stream that holds it, or by its accessor.
    pub fn attribute(
        &mut self,
        packed: Option<&Unpacked>,
        name: &str,
        index: &Value,
        widths: &[usize],
    ) -> Option<Rows> {
        let Some((packed, &number)) = packed.and_then(|packed| Some((packed, packed.numbers.get(name)?)))
        else {
            return self.rows(index, widths);
        };
        let accessor = self.item("accessors", index)?;
        let Some(attribute) = packed.mesh.attribute_by_unique_id(number) else {
            let message = format!("the packed mesh has no attribute {number} for \"{name}\"");
            self.error("gltf::draco", &accessor.span, message);
            return None;
        };
        let (width, points) = (usize::from(attribute.num_components()), packed.mesh.num_points());
        if !widths.contains(&width) {
            let message = format!("\"{name}\" of the packed mesh has {width} numbers for each vertex");
            self.error("gltf::draco", &accessor.span, message);
            return None;
        }
        let Some(left) = width.checked_mul(points).and_then(|total| self.budget.checked_sub(total)) else {
            let message = format!("with it the file has too many numbers ({points} × {width})");
            self.error("gltf::bad-accessor", &accessor.span, message);
            return None;
        };
        self.budget = left;
        let largest = self.normalized_to(accessor);
        let value = |v| largest.map_or(f64::from(v), |largest| (f64::from(v) / largest).max(-1.0));
        let data = attribute.read_f32s(points, width).into_iter().map(value).collect();
        Some(Rows { width, data })
    }
}

/// The error is half a sentence.
fn decode(bytes: &[u8], limits: DecodeLimits) -> Result<Mesh, String> {
    // The decoder is made to end in errors; should it panic all the same, that is one of them.
    let decoded = catch_unwind(|| {
        let mut mesh = Mesh::new();
        let mut buffer = DecoderBuffer::new(bytes).with_limits(limits);
        MeshDecoder::new().decode(&mut buffer, &mut mesh).map(|()| mesh)
    });
    let mesh = decoded.map_err(|_| "it breaks the decoder")?.map_err(|e| e.to_string())?;
    let points = mesh.num_points();
    match mesh.faces().iter().flatten().find(|corner| corner.0 as usize >= points) {
        Some(corner) => Err(format!("a triangle has vertex {} of {points}", corner.0)),
        None => Ok(mesh),
    }
}
