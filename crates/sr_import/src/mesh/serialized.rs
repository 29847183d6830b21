//! Mitsuba's serialized meshes, versions 3 and 4: a zlib stream for each mesh, and a table of offsets at the end.

use std::io::{BufReader, Read};

use flate2::read::ZlibDecoder;
use glam::{DVec2, DVec3, Vec3};
use sr_scene::MeshDesc;

use crate::limits::Limit;

const MAGIC: u16 = 0x041C;
const HAS_NORMALS: u32 = 0x0001;
const HAS_UVS: u32 = 0x0002;
const HAS_COLORS: u32 = 0x0008;
const FACE_NORMALS: u32 = 0x0010;
const DOUBLE: u32 = 0x2000;

/// Reads the mesh `index` of a file.
pub fn parse(bytes: &[u8], index: u32, limit: Limit) -> Result<MeshDesc, String> {
    let version = header(bytes, 0)?;
    let count = u32_at(bytes, bytes.len().checked_sub(4).ok_or("it is truncated")?)?;
    if index >= count {
        return Err(format!("it has {count} meshes, none with the index {index}"));
    }
    let entry = if version == 4 { 8 } else { 4 };
    let back = u64::from(count - index) * entry + 4;
    let at = usize::try_from(back).ok().and_then(|b| bytes.len().checked_sub(b));
    let at = at.ok_or("its table of meshes is cut off")?;
    let offset = if version == 4 { u64_at(bytes, at)? } else { u64::from(u32_at(bytes, at)?) };
    let offset = usize::try_from(offset).map_err(|_| "an offset beyond its end")?;
    let version = header(bytes, offset)?;
    let stream = bytes.get(offset..).and_then(|b| b.get(4..)).ok_or("it is truncated")?;
    Stream { zlib: BufReader::new(ZlibDecoder::new(stream)), limit }.mesh(version)
}

fn header(bytes: &[u8], at: usize) -> Result<u16, String> {
    let start = bytes.get(at..).and_then(|b| b.first_chunk::<4>()).ok_or("it is truncated")?;
    if u16::from_le_bytes([start[0], start[1]]) != MAGIC {
        return Err("it is not a file of Mitsuba's serialized meshes".into());
    }
    match u16::from_le_bytes([start[2], start[3]]) {
        version @ (3 | 4) => Ok(version),
        other => Err(format!("version {other} is not supported (3 and 4 are)")),
    }
}

fn u32_at(bytes: &[u8], at: usize) -> Result<u32, String> {
    let chunk = bytes.get(at..).and_then(|b| b.first_chunk::<4>()).ok_or("it is truncated")?;
    Ok(u32::from_le_bytes(*chunk))
}

fn u64_at(bytes: &[u8], at: usize) -> Result<u64, String> {
    let chunk = bytes.get(at..).and_then(|b| b.first_chunk::<8>()).ok_or("it is truncated")?;
    Ok(u64::from_le_bytes(*chunk))
}

/// Grows arrays with what the stream really holds, so that a false count costs nothing.
struct Stream<'a> {
    zlib: BufReader<ZlibDecoder<&'a [u8]>>,
    limit: Limit,
}

impl Stream<'_> {
    fn mesh(&mut self, version: u16) -> Result<MeshDesc, String> {
        let flags = u32::from_le_bytes(self.array()?);
        if version == 4 {
            self.skip_name()?;
        }
        let vertices = self.count("vertices")?;
        let triangles = self.count("triangles")?;
        let double = flags & DOUBLE != 0;
        let positions = self.vec3s(vertices, double)?;
        let mut normals = if flags & HAS_NORMALS != 0 { self.vec3s(vertices, double)? } else { Vec::new() };
        let uvs = if flags & HAS_UVS != 0 { self.numbers::<2>(vertices, double)? } else { Vec::new() };
        let vertex_colors = if flags & HAS_COLORS != 0 { self.vec3s(vertices, double)? } else { Vec::new() };
        if flags & FACE_NORMALS != 0 {
            normals.clear();
        }
        let mut indices = Vec::new();
        for _ in 0..triangles {
            let mut triangle = [0; 3];
            for slot in &mut triangle {
                *slot = u32::from_le_bytes(self.array()?);
            }
            indices.push(triangle);
        }
        let uvs = uvs.into_iter().map(|v| DVec2::from(v).as_vec2()).collect();
        Ok(MeshDesc { positions, normals, uvs, triangles: indices, vertex_colors, ..MeshDesc::default() })
    }

    fn skip_name(&mut self) -> Result<(), String> {
        const LONGEST: usize = 4096;
        for _ in 0..LONGEST {
            if self.array()? == [0u8] {
                return Ok(());
            }
        }
        Err("a mesh has a name without end".into())
    }

    fn count(&mut self, what: &str) -> Result<usize, String> {
        let limit = self.limit;
        let count = u64::from_le_bytes(self.array()?);
        usize::try_from(count)
            .ok()
            .filter(|&n| n <= limit.len())
            .ok_or_else(|| limit.refusal(format!("{count} {what}; at most {limit} are read")))
    }

    fn vec3s(&mut self, count: usize, double: bool) -> Result<Vec<Vec3>, String> {
        Ok(self.numbers::<3>(count, double)?.into_iter().map(|v| DVec3::from(v).as_vec3()).collect())
    }

    fn numbers<const N: usize>(&mut self, count: usize, double: bool) -> Result<Vec<[f64; N]>, String> {
        let mut out = Vec::new();
        for _ in 0..count {
            let mut value = [0.0; N];
            for slot in &mut value {
                *slot = if double {
                    f64::from_le_bytes(self.array()?)
                } else {
                    f64::from(f32::from_le_bytes(self.array()?))
                };
            }
            out.push(value);
        }
        Ok(out)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let mut bytes = [0; N];
        self.zlib
            .read_exact(&mut bytes)
            .map_err(|e| format!("its compressed data ends early or is damaged ({e})"))?;
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::{Compression, write::ZlibEncoder};
    use glam::Vec2;

    use super::*;

    /// A file of two meshes of one triangle each, the second one unit up.
    fn file(version: u16, double: bool) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut offsets = Vec::new();
        for z in [0.0, 1.0] {
            offsets.push(bytes.len());
            bytes.extend(MAGIC.to_le_bytes());
            bytes.extend(version.to_le_bytes());
            let mut data = Vec::new();
            data.extend((HAS_UVS | if double { DOUBLE } else { 0x1000 }).to_le_bytes());
            if version == 4 {
                data.extend(b"name\0");
            }
            data.extend(3u64.to_le_bytes());
            data.extend(1u64.to_le_bytes());
            for v in [0.0, 0.0, z, 1.0, 0.0, z, 0.0, 1.0, z, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0f64] {
                if double { data.extend(v.to_le_bytes()) } else { data.extend((v as f32).to_le_bytes()) }
            }
            (0..3u32).for_each(|i| data.extend(i.to_le_bytes()));
            let mut zlib = ZlibEncoder::new(Vec::new(), Compression::default());
            zlib.write_all(&data).unwrap();
            bytes.extend(zlib.finish().unwrap());
        }
        for offset in offsets {
            let wide = (offset as u64).to_le_bytes();
            bytes.extend(if version == 4 { &wide[..] } else { &wide[..4] });
        }
        bytes.extend(2u32.to_le_bytes());
        bytes
    }

    #[test]
    fn versions_and_precisions() {
        for (version, double) in [(3, false), (3, true), (4, false), (4, true)] {
            let bytes = file(version, double);
            let mesh = parse(&bytes, 1, Limit::fixed(100)).unwrap();
            assert_eq!(mesh.positions, [Vec3::Z, Vec3::new(1.0, 0.0, 1.0), Vec3::new(0.0, 1.0, 1.0)]);
            assert_eq!(mesh.uvs, [Vec2::ZERO, Vec2::X, Vec2::Y]);
            assert_eq!(mesh.triangles, [[0, 1, 2]]);
            assert!(parse(&bytes, 2, Limit::fixed(100)).unwrap_err().contains("2 meshes"));
        }
    }

    #[test]
    fn truncations_and_changed_bytes_do_not_panic() {
        let whole = file(4, false);
        for at in 0..whole.len() {
            assert!(parse(&whole[..at], 0, Limit::fixed(100)).is_err());
            let mut changed = whole.clone();
            changed[at] ^= 0xff;
            let _ = parse(&changed, 1, Limit::fixed(100));
        }
    }
}
