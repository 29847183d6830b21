//! The binary part of a PLY file, read into the mesh's arrays without a value of its own for each element.
//!
//! In: the bytes after the header, as they come, and an element's properties. Out: positions, normals, texture coordinates
//! and triangles, in a mesh. A scan has millions of them; a list allocated for each face would take longer than building
//! the tree. Where all elements are as long as the first (vertices without lists, faces that are all triangles), blocks of
//! them are read side by side.

use std::io::Read;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::{Vec2, Vec3};
use ply_rs_bw::ply::{ElementDef, PropertyType, ScalarType};
use rayon::prelude::*;
use sr_scene::MeshDesc;

use super::{Columns, Fans, NO_INDICES, color_slot, has_colors, index_list};
use crate::files;

/// Bytes that are looked at together.
const BLOCK: usize = 1 << 22;

/// Bytes that are still to be read.
pub struct Data<R> {
    source: R,
    /// Of the source, that were not read yet.
    left: u64,
    block: Vec<u8>,
    /// Where in the block reading is.
    at: usize,
    big_endian: bool,
}

impl<R: Read> Data<R> {
    /// - `source`: what follows the header's last line
    /// - `most`: bytes that it can have
    pub fn new(source: R, most: u64, big_endian: bool) -> Self {
        Self { source, left: most, block: Vec::new(), at: 0, big_endian }
    }

    /// Reads vertices into their arrays.
    pub fn vertices(&mut self, element: &ElementDef, mesh: &mut MeshDesc) -> Result<(), String> {
        let columns = Columns::of(element);
        let record = Record::of(element, self.big_endian, None);
        // Before memory is taken for them.
        self.expect(element.count, record.as_ref().map_or(1, |record| record.size))?;
        let wanted = |is_there: bool| if is_there { element.count } else { 0 };
        mesh.positions = vec![Vec3::ZERO; element.count];
        mesh.normals = vec![Vec3::ZERO; wanted(columns.normals)];
        mesh.uvs = vec![Vec2::ZERO; wanted(columns.uvs)];
        mesh.vertex_colors = vec![Vec3::ZERO; wanted(columns.colors)];
        let mut arrays = Arrays::of(mesh);
        match record {
            Some(record) => {
                let mut start = 0;
                while start < element.count {
                    let count = (element.count - start).min(record.a_block());
                    record.vertices(self.bytes(count * record.size)?, &mut arrays.part(start, count));
                    start += count;
                }
            }
            None => {
                for index in 0..element.count {
                    let v = self.vertex(element)?;
                    arrays.part(index, 1).set(0, &v);
                }
            }
        }
        Ok(())
    }

    fn vertex(&mut self, element: &ElementDef) -> Result<[f32; Columns::SLOTS], String> {
        let mut v = [0.0; Columns::SLOTS];
        for (name, property) in &element.properties {
            match (&property.data_type, Columns::slot(name)) {
                (PropertyType::Scalar(kind), Some(slot)) => {
                    v[slot] = scaled(self.number(kind)?, kind, slot);
                }
                (kind, _) => self.skip(kind)?,
            }
        }
        Ok(v)
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
        self.expect(element.count, 1)?;
        mesh.triangles.reserve_exact(element.count);
        let has_colors = has_colors(element);
        let record = Record::of(element, self.big_endian, Some(indices)).filter(|_| !has_colors);
        let mut number = 0;
        while number < element.count {
            let count = record.as_ref().map_or(1 << 12, Record::a_block).min(element.count - number);
            if let Some(record) = &record
                && let Ok(bytes) = self.peek(count * record.size)
                && record.triangles(bytes, &mut mesh.triangles)
            {
                self.at += count * record.size;
                fans.add_triangles(count);
            } else {
                for number in number..number + count {
                    self.face(element, indices, number, mesh, fans)?;
                }
            }
            number += count;
        }
        Ok(())
    }

    fn face(
        &mut self,
        element: &ElementDef,
        indices: &str,
        number: usize,
        mesh: &mut MeshDesc,
        fans: &mut Fans,
    ) -> Result<(), String> {
        let has_colors = has_colors(element);
        let mut color = [0.0; 3];
        let mut corners = Vec::new();
        for (name, property) in &element.properties {
            match &property.data_type {
                PropertyType::Scalar(kind) if has_colors && color_slot(name).is_some() => {
                    let part = scaled(self.number(kind)?, kind, Columns::FIRST_COLOR);
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
        let mut bytes = match kind {
            PropertyType::Scalar(kind) => size(kind),
            PropertyType::List(length, item) => {
                self.length(length)?.checked_mul(size(item)).ok_or(TOO_SHORT)?
            }
        };
        while bytes > 0 {
            let some = bytes.min(BLOCK);
            self.bytes(some)?;
            bytes -= some;
        }
        Ok(())
    }

    /// Of a list.
    fn length(&mut self, kind: &ScalarType) -> Result<usize, String> {
        let length = self.number(kind)?;
        if length < 0.0 || length.fract() != 0.0 {
            return Err(format!("a list has the length {length}"));
        }
        Ok(length as usize)
    }

    #[inline]
    fn number(&mut self, kind: &ScalarType) -> Result<f64, String> {
        let big_endian = self.big_endian;
        let bytes = self.bytes(size(kind))?;
        number(bytes, kind, big_endian).ok_or_else(|| TOO_SHORT.into())
    }

    /// Can so many elements of at least so many bytes be there?
    fn expect(&self, count: usize, bytes: usize) -> Result<(), String> {
        let there = self.left + (self.block.len() - self.at) as u64;
        if count as u64 * bytes as u64 > there { Err(TOO_SHORT.into()) } else { Ok(()) }
    }

    /// The next bytes, at most [`BLOCK`] or so, read.
    #[inline]
    fn bytes(&mut self, count: usize) -> Result<&[u8], String> {
        self.peek(count)?;
        self.at += count;
        Ok(&self.block[self.at - count..self.at])
    }

    /// The next bytes, not read yet.
    #[inline]
    fn peek(&mut self, count: usize) -> Result<&[u8], String> {
        if self.block.len() - self.at < count {
            self.fill(count)?;
        }
        Ok(&self.block[self.at..self.at + count])
    }

    #[cold]
    fn fill(&mut self, count: usize) -> Result<(), String> {
        self.block.drain(..self.at);
        self.at = 0;
        let mut filled = self.block.len();
        let missing = (count - filled).max(BLOCK).min(usize::try_from(self.left).unwrap_or(usize::MAX));
        self.block.resize(filled + missing, 0);
        while filled < self.block.len() {
            match self.source.read(&mut self.block[filled..]) {
                Ok(0) => break,
                Ok(read) => filled += read,
                Err(e) if e.kind() == std::io::ErrorKind::Interrupted => {}
                Err(e) => return Err(files::reason(&e)),
            }
        }
        self.left -= (filled + missing - self.block.len()) as u64;
        self.block.truncate(filled);
        if self.block.len() < count { Err(TOO_SHORT.into()) } else { Ok(()) }
    }
}

/// How an element of a known size lies in the bytes.
struct Record {
    size: usize,
    /// Of scalars that are asked for: where they begin, and where they go.
    fields: Vec<(usize, ScalarType, usize)>,
    /// Of a face: where the list of its corners begins, and the kinds of its length and of its items.
    corners: Option<(usize, ScalarType, ScalarType)>,
    big_endian: bool,
}

impl Record {
    /// `None` where elements differ in size: they have lists, other than that of the corners, of which three are taken for
    /// granted.
    fn of(element: &ElementDef, big_endian: bool, corners: Option<&str>) -> Option<Self> {
        let mut record = Self { size: 0, fields: Vec::new(), corners: None, big_endian };
        for (name, property) in &element.properties {
            match &property.data_type {
                PropertyType::Scalar(kind) => {
                    record.fields.extend(Columns::slot(name).map(|slot| (record.size, kind.clone(), slot)));
                    record.size += size(kind);
                }
                PropertyType::List(length, item) if corners == Some(name) => {
                    record.corners = Some((record.size, length.clone(), item.clone()));
                    record.size += size(length) + 3 * size(item);
                }
                PropertyType::List(..) => return None,
            }
        }
        (record.size > 0).then_some(record)
    }

    /// How many are looked at together.
    fn a_block(&self) -> usize {
        (BLOCK / self.size).max(1)
    }

    fn vertices(&self, bytes: &[u8], into: &mut Arrays) {
        const TOGETHER: usize = 1 << 14;
        let parts: Vec<Arrays> = into.parts(TOGETHER).collect();
        let all_floats =
            !self.big_endian && self.fields.iter().all(|(_, kind, _)| *kind == ScalarType::Float);
        bytes.par_chunks(TOGETHER * self.size).zip(parts).for_each(|(bytes, mut arrays)| {
            for (index, bytes) in bytes.chunks_exact(self.size).enumerate() {
                let mut v = [0.0; Columns::SLOTS];
                for &(start, ref kind, slot) in &self.fields {
                    let bytes = &bytes[start..];
                    v[slot] = match bytes.first_chunk() {
                        Some(&float) if all_floats => f32::from_le_bytes(float),
                        _ => scaled(number(bytes, kind, self.big_endian).unwrap_or_default(), kind, slot),
                    };
                }
                arrays.set(index, &v);
            }
        });
    }

    /// Adds triangles if all of these faces are triangles with indices that are whole numbers and fit.
    fn triangles(&self, bytes: &[u8], triangles: &mut Vec<[u32; 3]>) -> bool {
        let Some((start, length, item)) = &self.corners else { return false };
        let first = start + size(length);
        let is_usual = !self.big_endian && *length == ScalarType::UChar && *item == ScalarType::Int;
        let index = |face: &[u8], corner: usize| {
            let bytes = &face[first + corner * size(item)..];
            if is_usual {
                return u32::try_from(i32::from_le_bytes(*bytes.first_chunk()?)).ok();
            }
            let value = number(bytes, item, self.big_endian)?;
            (f64::from(value as u32) == value).then_some(value as u32)
        };
        let is_triangle = |face: &[u8]| match is_usual {
            true => face[*start] == 3,
            false => number(&face[*start..], length, self.big_endian) == Some(3.0),
        };
        let triangle = |face: &[u8]| {
            if is_triangle(face) { Some([index(face, 0)?, index(face, 1)?, index(face, 2)?]) } else { None }
        };
        let (before, sound) = (triangles.len(), AtomicBool::new(true));
        triangles.par_extend(bytes.par_chunks_exact(self.size).with_min_len(1 << 14).map(|face| {
            triangle(face).unwrap_or_else(|| {
                sound.store(false, Ordering::Relaxed);
                [0; 3]
            })
        }));
        let sound = sound.into_inner();
        if !sound {
            triangles.truncate(before);
        }
        sound
    }
}

/// Parts of a mesh's arrays, of the same vertices; those that the file does not have are empty.
struct Arrays<'a> {
    positions: &'a mut [Vec3],
    normals: &'a mut [Vec3],
    uvs: &'a mut [Vec2],
    colors: &'a mut [Vec3],
}

impl<'a> Arrays<'a> {
    fn of(mesh: &'a mut MeshDesc) -> Self {
        Self {
            positions: &mut mesh.positions,
            normals: &mut mesh.normals,
            uvs: &mut mesh.uvs,
            colors: &mut mesh.vertex_colors,
        }
    }

    fn part(&mut self, start: usize, count: usize) -> Arrays<'_> {
        fn part<T>(array: &mut [T], start: usize, count: usize) -> &mut [T] {
            if array.is_empty() { array } else { &mut array[start..start + count] }
        }
        Arrays {
            positions: part(self.positions, start, count),
            normals: part(self.normals, start, count),
            uvs: part(self.uvs, start, count),
            colors: part(self.colors, start, count),
        }
    }

    /// One after another, of so many vertices each.
    fn parts(&mut self, count: usize) -> impl Iterator<Item = Arrays<'_>> {
        let mut normals = self.normals.chunks_mut(count);
        let mut uvs = self.uvs.chunks_mut(count);
        let mut colors = self.colors.chunks_mut(count);
        self.positions.chunks_mut(count).map(move |positions| Arrays {
            positions,
            normals: normals.next().unwrap_or_default(),
            uvs: uvs.next().unwrap_or_default(),
            colors: colors.next().unwrap_or_default(),
        })
    }

    /// Sets a vertex from its numbers by [`Columns::slot`].
    #[inline]
    fn set(&mut self, index: usize, v: &[f32; Columns::SLOTS]) {
        self.positions[index] = Vec3::new(v[0], v[1], v[2]);
        if let Some(normal) = self.normals.get_mut(index) {
            *normal = Vec3::new(v[3], v[4], v[5]);
        }
        if let Some(uv) = self.uvs.get_mut(index) {
            *uv = Vec2::new(v[6], v[7]);
        }
        if let Some(color) = self.colors.get_mut(index) {
            *color = Vec3::new(v[8], v[9], v[10]);
        }
    }
}

/// A number of a kind; all kinds fit into an `f64`. `None` if there are too few bytes.
#[inline]
fn number(bytes: &[u8], kind: &ScalarType, big_endian: bool) -> Option<f64> {
    macro_rules! read {
        ($number:ty) => {{
            let &bytes = bytes.first_chunk()?;
            f64::from(if big_endian {
                <$number>::from_be_bytes(bytes)
            } else {
                <$number>::from_le_bytes(bytes)
            })
        }};
    }
    Some(match kind {
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

/// What goes to a slot: whole numbers of colors count to the largest of their kind.
#[inline]
fn scaled(value: f64, kind: &ScalarType, slot: usize) -> f32 {
    let most = match kind {
        ScalarType::UChar if slot >= Columns::FIRST_COLOR => 255.0,
        ScalarType::UShort if slot >= Columns::FIRST_COLOR => 65535.0,
        _ => return value as f32,
    };
    (value / most) as f32
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
    use super::super::parse_bytes as parse;
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
