//! The binary part of a PLY file, read into the mesh's arrays without a value of its own for each element.
//!
//! In: the bytes after the header, and an element's properties. Out: positions, normals, texture coordinates and
//! triangles, in a mesh. A scan has millions of them; a list allocated for each face would take longer than
//! building the tree.

use glam::{Vec2, Vec3};
use ply_rs_bw::ply::{ElementDef, PropertyType, ScalarType};
use sr_scene::MeshDesc;

use super::{Columns, Fans, NO_INDICES, color_slot, has_colors, index_list};

/// Bytes that are still to be read.
pub struct Data<'a> {
    rest: &'a [u8],
    big_endian: bool,
}

impl<'a> Data<'a> {
    /// What follows the header's last line; `None` if there is no such line.
    pub fn after_header(file: &'a [u8], big_endian: bool) -> Option<Self> {
        const END: &[u8] = b"\nend_header";
        let end = file.windows(END.len()).position(|line| line == END)? + END.len();
        let newline = file[end..].iter().position(|&byte| byte == b'\n')?;
        Some(Self { rest: &file[end + newline + 1..], big_endian })
    }

    /// Reads vertices into their arrays.
    pub fn vertices(&mut self, element: &ElementDef, mesh: &mut MeshDesc) -> Result<(), String> {
        let columns = Columns::of(element);
        let properties: Vec<(&PropertyType, Option<usize>)> =
            element.properties.iter().map(|(name, p)| (&p.data_type, Columns::slot(name))).collect();
        mesh.positions.reserve_exact(element.count);
        mesh.normals.reserve_exact(if columns.normals { element.count } else { 0 });
        mesh.uvs.reserve_exact(if columns.uvs { element.count } else { 0 });
        for _ in 0..element.count {
            let mut v = [0.0; Columns::SLOTS];
            for &(kind, slot) in &properties {
                match (kind, slot) {
                    (PropertyType::Scalar(kind), Some(slot)) if slot >= Columns::FIRST_COLOR => {
                        v[slot] = self.color_part(kind)?;
                    }
                    (PropertyType::Scalar(kind), Some(slot)) => v[slot] = self.number(kind)? as f32,
                    _ => self.skip(kind)?,
                }
            }
            mesh.positions.push(Vec3::new(v[0], v[1], v[2]));
            if columns.normals {
                mesh.normals.push(Vec3::new(v[3], v[4], v[5]));
            }
            if columns.uvs {
                mesh.uvs.push(Vec2::new(v[6], v[7]));
            }
            if columns.colors {
                mesh.vertex_colors.push(Vec3::new(v[8], v[9], v[10]));
            }
        }
        Ok(())
    }

    /// Reads faces into triangles.
    pub fn faces(
        &mut self,
        element: &ElementDef,
        mesh: &mut MeshDesc,
        fans: &mut Fans,
    ) -> Result<(), String> {
        let Some((indices, _)) = index_list(element) else {
            return if element.count > 0 { Err(NO_INDICES.into()) } else { Ok(()) };
        };
        mesh.triangles.reserve(element.count);
        let mut corners = Vec::new();
        let has_colors = has_colors(element);
        for number in 0..element.count {
            let mut color = [0.0; 3];
            for (name, property) in &element.properties {
                match &property.data_type {
                    PropertyType::Scalar(kind) if has_colors && color_slot(name).is_some() => {
                        let part = self.color_part(kind)?;
                        color_slot(name).into_iter().for_each(|slot| color[slot] = part);
                    }
                    PropertyType::List(length, item) if name == indices => {
                        corners.clear();
                        for _ in 0..self.length(length)? {
                            let index = self.number(item)?;
                            // A whole number that fits, or it would not come back.
                            if f64::from(index as u32) != index {
                                return Err(format!("face {number} uses the vertex {index}"));
                            }
                            corners.push(index as u32);
                        }
                        fans.add(&corners, &mut mesh.triangles);
                    }
                    other => self.skip(other)?,
                }
            }
            if has_colors {
                mesh.face_colors.resize(mesh.triangles.len(), Vec3::from(color));
            }
        }
        Ok(())
    }

    /// Gets past an element.
    pub fn skip_element(&mut self, element: &ElementDef) -> Result<(), String> {
        for _ in 0..element.count {
            for property in element.properties.values() {
                self.skip(&property.data_type)?;
            }
        }
        Ok(())
    }

    fn skip(&mut self, kind: &PropertyType) -> Result<(), String> {
        match kind {
            PropertyType::Scalar(kind) => self.take(size(kind)).map(|_| ()),
            PropertyType::List(length, item) => {
                let length = self.length(length)?;
                let bytes = length.checked_mul(size(item)).ok_or(TOO_SHORT)?;
                self.take(bytes).map(|_| ())
            }
        }
    }

    /// Of a list.
    fn length(&mut self, kind: &ScalarType) -> Result<usize, String> {
        let length = self.number(kind)?;
        if length < 0.0 || length.fract() != 0.0 {
            return Err(format!("a list has the length {length}"));
        }
        Ok(length as usize)
    }

    /// Any number; all kinds fit into an `f64`.
    #[inline]
    fn number(&mut self, kind: &ScalarType) -> Result<f64, String> {
        let big = self.big_endian;
        macro_rules! read {
            ($number:ty) => {{
                let bytes = self.array()?;
                f64::from(if big { <$number>::from_be_bytes(bytes) } else { <$number>::from_le_bytes(bytes) })
            }};
        }
        Ok(match kind {
            ScalarType::Char => read!(i8),
            ScalarType::UChar => read!(u8),
            ScalarType::Short => read!(i16),
            ScalarType::UShort => read!(u16),
            ScalarType::Int => read!(i32),
            ScalarType::UInt => read!(u32),
            ScalarType::Float => read!(f32),
            ScalarType::Double => read!(f64),
        })
    }

    /// A part of a color in [0, 1]: whole numbers count to the largest of their kind.
    fn color_part(&mut self, kind: &ScalarType) -> Result<f32, String> {
        let most = match kind {
            ScalarType::UChar => 255.0,
            ScalarType::UShort => 65535.0,
            _ => 1.0,
        };
        Ok((self.number(kind)? / most) as f32)
    }

    #[inline]
    fn array<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let (bytes, rest) = self.rest.split_first_chunk().ok_or(TOO_SHORT)?;
        self.rest = rest;
        Ok(*bytes)
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], String> {
        let (bytes, rest) = self.rest.split_at_checked(count).ok_or(TOO_SHORT)?;
        self.rest = rest;
        Ok(bytes)
    }
}

const TOO_SHORT: &str = "it ends too early";

fn size(kind: &ScalarType) -> usize {
    match kind {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    }
}

#[cfg(test)]
mod tests {
    use super::super::parse;
    use super::*;

    /// Two vertices and a triangle among properties and elements that nobody asks for.
    fn crowded() -> Vec<u8> {
        let mut bytes = b"ply\r\nformat binary_little_endian 1.0\r\ncomment end_header\r\n\
            element tag 2\r\nproperty list uchar short tags\r\n\
            element vertex 3\r\nproperty double x\r\nproperty uchar red\r\nproperty float y\r\n\
            property list ushort double weights\r\nproperty short z\r\n\
            element face 1\r\nproperty uchar flag\r\nproperty list int uchar vertex_index\r\n\
            property list uchar float texcoord\r\nend_header\r\n"
            .to_vec();
        bytes.extend([2, 1, 0, 2, 0, 0]);
        for (x, y, z) in [(0.5f64, 1.5f32, -2i16), (3.0, 4.0, 5), (6.0, 7.0, 9)] {
            bytes.extend(x.to_le_bytes());
            bytes.push(200);
            bytes.extend(y.to_le_bytes());
            bytes.extend(1u16.to_le_bytes());
            bytes.extend(0.25f64.to_le_bytes());
            bytes.extend(z.to_le_bytes());
        }
        bytes.push(1);
        bytes.extend(3i32.to_le_bytes());
        bytes.extend([2, 1, 0, 1]);
        bytes.extend(1f32.to_le_bytes());
        bytes
    }

    #[test]
    fn what_nobody_asks_for_is_passed_over() {
        let mesh = parse(&crowded(), &mut Fans::default()).unwrap();
        assert_eq!(mesh.positions[0], Vec3::new(0.5, 1.5, -2.0));
        assert_eq!(mesh.positions[2], Vec3::new(6.0, 7.0, 9.0));
        assert_eq!(mesh.triangles, [[2, 1, 0]]);
        assert!(mesh.normals.is_empty() && mesh.uvs.is_empty());
    }

    #[test]
    fn every_truncation_is_an_error() {
        let whole = crowded();
        for cut in 0..whole.len() {
            assert!(parse(&whole[..cut], &mut Fans::default()).is_err(), "cut at {cut}");
        }
    }

    #[test]
    fn indices_and_lengths_are_whole_numbers_that_fit() {
        let file = |length: &str, item: &str, data: &[u8]| {
            let mut bytes = format!(
                "ply\nformat binary_big_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\n\
                 property float z\nelement face 1\nproperty list {length} {item} vertex_indices\nend_header\n"
            )
            .into_bytes();
            bytes.extend(data);
            bytes
        };
        let negative =
            parse(&file("uchar", "int", &[1, 255, 255, 255, 255]), &mut Fans::default()).unwrap_err();
        assert!(negative.contains("face 0 uses the vertex -1"), "{negative}");
        assert!(parse(&file("uchar", "float", &[1, 0x3f, 0, 0, 0]), &mut Fans::default()).is_err());
        assert!(parse(&file("char", "uchar", &[255, 0, 0]), &mut Fans::default()).is_err());
        assert!(parse(&file("uint", "uchar", &[255, 255, 255, 255, 0]), &mut Fans::default()).is_err());
    }
}
