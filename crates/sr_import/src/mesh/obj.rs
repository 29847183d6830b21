//! Wavefront OBJ: polygons of positions, texture coordinates and normals, and the names of their materials.
//! Groups are not read.

use std::collections::HashMap;

use glam::{Vec2, Vec3};
use sr_scene::MeshDesc;

use super::Fans;
use crate::limits::Limit;
use crate::values::shown;

/// Indices of a corner into the file's lists, from 0.
type Corner = (u32, Option<u32>, Option<u32>);

/// Parses a file. Corners that share all indices share a vertex, as in Mitsuba.
pub(super) fn parse(bytes: &[u8], fans: &mut Fans, limit: Limit) -> Result<MeshDesc, String> {
    Ok(read(bytes, fans, limit)?.finish())
}

/// A mesh, and what it says about its materials.
#[derive(Debug)]
pub struct Covered {
    /// All of the file.
    pub mesh: MeshDesc,
    /// The files that describe materials.
    pub libraries: Vec<String>,
    /// The names of materials, each once.
    pub materials: Vec<String>,
    /// From which triangle on which of the materials is used, in order.
    pub uses: Vec<(usize, usize)>,
    /// The colors of the vertices were left out, as not all of them have one.
    pub some_colors: bool,
    /// The first statement that is no mesh's, and its line: lines, points, curves, free-form surfaces.
    pub left_out: Option<(String, usize)>,
    /// Is it flat somewhere by its smoothing groups?
    pub has_flat: bool,
}

/// Parses a file with its materials' names and its vertices' colors.
pub fn parse_covered(bytes: &[u8], limit: Limit) -> Result<Covered, String> {
    let mut reader = read(bytes, &mut Fans::default(), limit)?;
    let has_colors = reader.colors.len() == reader.positions.len();
    let some_colors = !has_colors && !reader.colors.is_empty();
    let colors = if has_colors { std::mem::take(&mut reader.colors) } else { Vec::new() };
    let vertex_colors = match colors[..] {
        [] => Vec::new(),
        _ => reader.corners.iter().map(|c| colors[c.0 as usize]).collect(),
    };
    let (left_out, has_flat) = (reader.left_out.take(), reader.has_flat);
    let libraries = std::mem::take(&mut reader.libraries);
    let uses = std::mem::take(&mut reader.uses);
    let mut materials = vec![String::new(); reader.materials.len()];
    for (name, index) in reader.materials.drain() {
        materials[index] = name;
    }
    let mesh = MeshDesc { vertex_colors, ..reader.finish() };
    Ok(Covered { mesh, libraries, materials, uses, some_colors, left_out, has_flat })
}

fn read(bytes: &[u8], fans: &mut Fans, limit: Limit) -> Result<Reader, String> {
    let mut reader = Reader::default();
    // Some editors begin a file with a mark.
    let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    for (number, line) in bytes.split(|&b| b == b'\n').enumerate() {
        // Comments and names may be in any encoding; what is read is ASCII.
        let line = String::from_utf8_lossy(line);
        let is_known = reader.line(&line, fans).map_err(|reason| format!("line {}: {reason}", number + 1))?;
        if reader.elements() > limit.len() {
            return Err(limit.refusal(format!("line {}: more than {limit} elements", number + 1)));
        }
        if !is_known && reader.left_out.is_none() {
            let word = line.split_ascii_whitespace().next().unwrap_or("");
            reader.left_out = Some((word.to_owned(), number + 1));
        }
    }
    Ok(reader)
}

#[derive(Default)]
struct Reader {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    vertices: HashMap<Corner, u32>,
    corners: Vec<Corner>,
    triangles: Vec<[u32; 3]>,
    polygon: Vec<u32>,
    colors: Vec<Vec3>,
    libraries: Vec<String>,
    materials: HashMap<String, usize>,
    uses: Vec<(usize, usize)>,
    left_out: Option<(String, usize)>,
    has_flat: bool,
}

impl Reader {
    /// Reads a statement; is it one that is known?
    fn line(&mut self, line: &str, fans: &mut Fans) -> Result<bool, String> {
        let mut is_known = true;
        let mut words = line.split('#').next().unwrap_or("").split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                self.positions.push(Vec3::from(floats(&mut words)?));
                // Some programs write a color after the position.
                if let [Some(Ok(r)), Some(Ok(g)), Some(Ok(b))] =
                    std::array::from_fn(|_| words.next().map(str::parse))
                {
                    self.colors.push(Vec3::new(r, g, b));
                }
            }
            Some("vn") => self.normals.push(Vec3::from(floats(&mut words)?)),
            Some("vt") => {
                let u = words.next().ok_or("too few numbers")?;
                // A missing v is 0 by the format's definition.
                self.uvs.push(Vec2::new(float(u)?, words.next().map_or(Ok(0.0), float)?));
            }
            Some("f") => self.face(words, fans)?,
            // A name may have spaces, and a "#" of its own.
            Some(word @ ("usemtl" | "mtllib")) => {
                let name = line.trim_ascii_start().get(word.len()..).unwrap_or("").trim().to_owned();
                if word == "mtllib" {
                    self.libraries.push(name);
                } else {
                    let next = self.materials.len();
                    let material = *self.materials.entry(name).or_insert(next);
                    self.uses.push((self.triangles.len(), material));
                }
            }
            Some("s") => self.has_flat |= matches!(words.next(), Some("off" | "0")),
            // Groups and objects are names.
            Some("g" | "o") | None => {}
            Some(_) => is_known = false,
        }
        Ok(is_known)
    }

    /// The length of the longest list.
    fn elements(&self) -> usize {
        self.positions.len().max(self.normals.len()).max(self.uvs.len()).max(self.triangles.len())
    }

    fn face<'a>(&mut self, words: impl Iterator<Item = &'a str>, fans: &mut Fans) -> Result<(), String> {
        self.polygon.clear();
        for word in words {
            let mut parts = word.split('/');
            let position = index(parts.next().unwrap_or(""), self.positions.len(), "vertex")?
                .ok_or_else(|| format!("\"{}\" is not a corner", shown(word)))?;
            let uv = index(parts.next().unwrap_or(""), self.uvs.len(), "texture coordinate")?;
            let normal = index(parts.next().unwrap_or(""), self.normals.len(), "normal")?;
            let corner = (position, uv, normal);
            let next = self.corners.len() as u32;
            let vertex = *self.vertices.entry(corner).or_insert(next);
            if vertex == next {
                self.corners.push(corner);
            }
            self.polygon.push(vertex);
        }
        if self.polygon.len() < 3 {
            return Err(format!("a face needs three corners, not {}", self.polygon.len()));
        }
        fans.add(&self.polygon, &mut self.triangles);
        Ok(())
    }

    fn finish(self) -> MeshDesc {
        let Self { positions, normals, uvs, corners, triangles, .. } = self;
        let positions = corners.iter().map(|c| positions[c.0 as usize]).collect();
        // Corners without a coordinate get 0; corners without a normal get one from their faces later.
        let uvs = if corners.iter().any(|c| c.1.is_some()) {
            corners.iter().map(|c| c.1.map_or(Vec2::ZERO, |i| uvs[i as usize])).collect()
        } else {
            Vec::new()
        };
        let normals = if corners.iter().any(|c| c.2.is_some()) {
            corners.iter().map(|c| c.2.map_or(Vec3::ZERO, |i| normals[i as usize])).collect()
        } else {
            Vec::new()
        };
        MeshDesc { positions, normals, uvs, triangles, ..MeshDesc::default() }
    }
}

fn float(word: &str) -> Result<f32, String> {
    word.parse().map_err(|_| format!("\"{}\" is not a number", shown(word)))
}

fn floats<'a>(words: &mut impl Iterator<Item = &'a str>) -> Result<[f32; 3], String> {
    let mut next = || float(words.next().ok_or("too few numbers")?);
    Ok([next()?, next()?, next()?])
}

/// A one-based index, or a negative one that counts from the end; `None` for an empty text.
fn index(text: &str, len: usize, what: &str) -> Result<Option<u32>, String> {
    if text.is_empty() {
        return Ok(None);
    }
    let given: i64 = text.parse().map_err(|_| format!("\"{}\" is not an index", shown(text)))?;
    let zero_based = if given < 0 { given.checked_add(len as i64) } else { given.checked_sub(1) };
    match zero_based {
        Some(i) if i >= 0 && i < len as i64 => Ok(Some(i as u32)),
        _ => Err(format!("{what} {given} does not exist: there are {len} so far")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_negative_indices_and_shared_positions() {
        let text =
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nf 1/1 2/1 3/1 4/1\nf -4/2 -3/1 -2/1\n";
        let mut fans = Fans::default();
        let mesh = parse(text.as_bytes(), &mut fans, Limit::fixed(100)).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [4, 1, 2]]);
        assert_eq!(fans.0, [2, 1]);
        assert_eq!(mesh.positions[4], mesh.positions[0]);
        assert_eq!(mesh.uvs[4], Vec2::ONE);
        assert!(mesh.normals.is_empty());
    }

    #[test]
    fn normals_without_texture_coordinates() {
        let mesh = parse(
            b"v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 0 0 1\nf 1//1 2//1 3//1",
            &mut Fans::default(),
            Limit::fixed(100),
        )
        .unwrap();
        assert_eq!(mesh.normals, [Vec3::Z; 3]);
        assert!(mesh.uvs.is_empty());
    }

    #[test]
    fn materials_and_colors() {
        let text = "mtllib a b.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nusemtl red #2\nf 1 2 3\nusemtl x\n\
            f 1 2 3\nusemtl red #2\nf 1 2 3 # usemtl x\n";
        let file = parse_covered(text.as_bytes(), Limit::fixed(100)).unwrap();
        assert_eq!(
            (file.libraries, file.materials),
            (vec!["a b.mtl".to_owned()], vec!["red #2".into(), "x".into()])
        );
        assert_eq!(file.uses, [(0, 0), (1, 1), (2, 0)]);
        assert_eq!(file.mesh.vertex_colors, Vec3::AXES);
        let some = parse_covered(b"v 0 0 0\nv 1 0 0 1 1 1\n", Limit::fixed(100)).unwrap();
        assert!(some.some_colors && some.mesh.vertex_colors.is_empty());
    }

    #[test]
    fn errors_name_the_line() {
        for (text, part) in [
            ("v 0 0 0\nf 1 2 3\n", "line 2: vertex 2 does not exist"),
            ("v 0 x 0\n", "line 1: \"x\" is not a number"),
            ("v 0 0\n", "too few"),
            ("v 0 0 0\nf 1 1\n", "three corners"),
            ("v 0 0 0\nf 0 1 1\n", "vertex 0"),
            ("v 0 0 0\nf -9223372036854775808 1 1\n", "does not exist"),
        ] {
            let error = parse(text.as_bytes(), &mut Fans::default(), Limit::fixed(100)).unwrap_err();
            assert!(error.contains(part), "{error}");
        }
    }
}
