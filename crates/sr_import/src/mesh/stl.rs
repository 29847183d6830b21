//! STL: triangles without shared vertices, as text or binary. Vertices that coincide become one.

use std::collections::HashMap;

use glam::Vec3;
use sr_scene::MeshDesc;

use crate::limits::Limit;
use crate::values::shown;

/// Of a binary file: a text that means nothing, and the number of facets.
const HEADER: usize = 84;
/// Of a binary file: a normal, three vertices, and two bytes that some programs put a color into.
const FACET: usize = 50;

/// A file, and what is wrong with it and what happens instead, each a sentence.
#[derive(Debug)]
pub struct Stl {
    pub mesh: MeshDesc,
    pub notes: Vec<(String, &'static str)>,
}

/// Parses a file; the error is half a sentence. Normals are worked out from the corners, whatever the file says.
pub fn parse(bytes: &[u8], limit: Limit) -> Result<Stl, String> {
    // Some binary files begin with "solid" too; text has no length that its bytes 80 to 83 tell.
    let starts_as_text = bytes.trim_ascii_start().get(..5).is_some_and(|b| b.eq_ignore_ascii_case(b"solid"));
    let declared =
        bytes.get(80..HEADER).map_or(0, |b| b.iter().rev().fold(0, |n, &b| n << 8 | usize::from(b)));
    let fits = bytes.len() == HEADER + FACET * declared;
    let head = &bytes[..bytes.len().min(1024)];
    if starts_as_text && !fits && !head.contains(&0) {
        text(bytes, limit)
    } else {
        binary(bytes, declared, limit)
    }
}

fn binary(bytes: &[u8], declared: usize, limit: Limit) -> Result<Stl, String> {
    let Some((_, facets)) = bytes.split_at_checked(HEADER) else {
        return Err(format!("it has {} bytes, fewer than the header's {HEADER}", bytes.len()));
    };
    let there = facets.len() / FACET;
    let mut notes = Vec::new();
    let mut count = declared;
    if declared == 0 && there > 0 {
        // Programs that write as they go leave the number at 0.
        notes.push((format!("the header declares no facets, but {there} follow"), "all of them are read"));
        count = there;
    } else if declared > there {
        return Err(format!("its header declares {declared} facets, but it ends after {there}"));
    } else if facets.len() > declared * FACET {
        let rest = facets.len() - declared * FACET;
        notes.push((format!("{rest} bytes follow the {declared} facets of the header"), "they are not read"));
    }
    let mut welded = Welded::default();
    let mut has_colors = false;
    for facet in facets.chunks_exact(FACET).take(count) {
        let number = |at: usize| f32::from_le_bytes(std::array::from_fn(|i| facet[4 * at + i]));
        let corner = |c: usize| Vec3::new(number(3 * c), number(3 * c + 1), number(3 * c + 2));
        welded.add([corner(1), corner(2), corner(3)], limit)?;
        has_colors |= facet[FACET - 2..] != [0, 0];
    }
    if has_colors {
        notes.push(("facets have attributes, maybe colors".to_owned(), "they are ignored"));
    }
    Ok(Stl { mesh: welded.finish(), notes })
}

fn text(bytes: &[u8], limit: Limit) -> Result<Stl, String> {
    let mut welded = Welded::default();
    let mut corners: Vec<Vec3> = Vec::with_capacity(3);
    let mut is_open = false;
    for (number, line) in bytes.split(|&b| b == b'\n').enumerate() {
        let line = String::from_utf8_lossy(line);
        let fail = |reason: String| format!("line {}: {reason}", number + 1);
        let mut words = line.split_ascii_whitespace();
        let word = words.next().unwrap_or("").to_ascii_lowercase();
        match word.as_str() {
            "solid" => is_open = true,
            "endsolid" => is_open = false,
            "vertex" => {
                let mut next = || -> Result<f32, String> {
                    let word = words.next().ok_or("too few numbers")?;
                    word.parse().map_err(|_| format!("\"{}\" is not a number", shown(word)))
                };
                let corner = [next(), next(), next()];
                let [x, y, z] = corner;
                corners.push(Vec3::new(x.map_err(fail)?, y.map_err(fail)?, z.map_err(fail)?));
                if corners.len() > 3 {
                    return Err(fail("a facet has more than three vertices".into()));
                }
            }
            "endfacet" => {
                let corners = std::mem::take(&mut corners);
                let facet: [Vec3; 3] = corners
                    .try_into()
                    .map_err(|c: Vec<Vec3>| fail(format!("a facet has {} vertices, not three", c.len())))?;
                welded.add(facet, limit).map_err(fail)?;
            }
            "" | "facet" | "outer" | "endloop" => {}
            other => return Err(fail(format!("\"{}\" is no word of this format", shown(other)))),
        }
    }
    if is_open || !corners.is_empty() {
        return Err("it ends before its \"endsolid\"".into());
    }
    Ok(Stl { mesh: welded.finish(), notes: Vec::new() })
}

/// Triangles whose vertices are the same wherever their coordinates are.
#[derive(Default)]
struct Welded {
    known: HashMap<[u32; 3], u32>,
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Welded {
    fn add(&mut self, corners: [Vec3; 3], limit: Limit) -> Result<(), String> {
        if self.triangles.len().max(self.positions.len()) >= limit.len() {
            return Err(limit.refusal(format!("more than {limit} elements")));
        }
        let triangle = corners.map(|p| {
            // -0 and 0 are the same place.
            let key = p.to_array().map(|v| (v + 0.0).to_bits());
            *self.known.entry(key).or_insert_with(|| {
                self.positions.push(p);
                self.positions.len() as u32 - 1
            })
        });
        self.triangles.push(triangle);
        Ok(())
    }

    fn finish(self) -> MeshDesc {
        MeshDesc { positions: self.positions, triangles: self.triangles, ..MeshDesc::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(bytes: &[u8]) -> Result<Stl, String> {
        super::parse(bytes, Limit::fixed(100))
    }

    /// Two triangles that share an edge, after a header that declares `declared`.
    fn file(header: &[u8], declared: u32) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(80, b' ');
        bytes.extend(declared.to_le_bytes());
        for corners in
            [[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]], [[1., 0., -0.], [1., 1., 0.], [0., 1., 0.]]]
        {
            for v in [[0.0f32; 3]].iter().chain(&corners).flatten() {
                bytes.extend(v.to_le_bytes());
            }
            bytes.extend([0, 0]);
        }
        bytes
    }

    #[test]
    fn vertices_that_coincide_are_one() {
        for header in [&b"binary"[..], b"solid, says this binary file"] {
            let Stl { mesh, notes } = parse(&file(header, 2)).unwrap();
            assert_eq!(mesh.positions.len(), 4);
            assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 2]]);
            assert!(notes.is_empty());
        }
    }

    #[test]
    fn headers_lie() {
        assert!(parse(&file(b"", 3)).unwrap_err().contains("declares 3 facets, but it ends after 2"));
        assert!(parse(&file(b"", u32::MAX)).unwrap_err().contains("ends after 2"));
        let none = parse(&file(b"", 0)).unwrap();
        assert_eq!((none.mesh.triangles.len(), none.notes.len()), (2, 1));
        let fewer = parse(&file(b"", 1)).unwrap();
        assert_eq!((fewer.mesh.triangles.len(), fewer.notes.len()), (1, 1));
        let whole = file(b"", 2);
        for cut in 0..whole.len() {
            assert!(parse(&whole[..cut]).is_err() || cut == HEADER, "cut at {cut}");
        }
    }

    const TEXT: &str = "solid a\r\n FACET NORMAL 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1e0 0 0\nvertex 0 1 0\n\
        endloop\nendfacet\nendsolid a\n";

    #[test]
    fn texts() {
        assert_eq!(parse(TEXT.as_bytes()).unwrap().mesh.triangles, [[0, 1, 2]]);
        for (from, to, part) in [
            ("vertex 0 0 0\n", "", "line 7: a facet has 2 vertices"),
            ("vertex 0 0 0\n", "vertex 0 0\n", "line 4: too few"),
            ("1e0", "one", "\"one\" is not a number"),
            ("endsolid a\n", "", "endsolid"),
            ("outer", "inner", "\"inner\" is no word"),
        ] {
            let error = parse(TEXT.replace(from, to).as_bytes()).unwrap_err();
            assert!(error.contains(part), "{error}");
        }
    }
}
