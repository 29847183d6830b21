//! Stanford PLY: headers and text by a library, binary of both byte orders by [`binary`]. Files are read from their
//! beginning to their end, never held as a whole.

mod binary;

use std::io::{BufRead, BufReader, Cursor, Read};

use glam::{Vec2, Vec3};
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyDef, PropertyType,
};
use sr_scene::MeshDesc;

use super::Fans;
use crate::files::{self, Content};
use crate::limits::Limit;

/// A mesh, and the images that comments in its header name: `TextureFile NAME`, as MeshLab writes them.
pub struct Ply {
    pub mesh: MeshDesc,
    pub textures: Vec<String>,
}

/// Parses a file.
pub fn parse(Content { reader, length }: Content, fans: &mut Fans, limit: Limit) -> Result<Ply, String> {
    let mut stream = BufReader::with_capacity(1 << 16, reader);
    let mut text = Reader::new(Cursor::new(header_of(&mut stream)?));
    let header = Parser::<Ignored>::new().read_header(&mut text).map_err(|e| one_line(&e))?;
    let mut mesh = MeshDesc::default();
    let (mut reader, mut data) = match header.encoding {
        Encoding::Ascii => (Reader::new(Box::new(stream) as Box<dyn BufRead>), None),
        order => {
            let nothing = Reader::new(Box::new(std::io::empty()) as Box<dyn BufRead>);
            (nothing, Some(binary::Data::new(stream, length, order == Encoding::BinaryBigEndian)))
        }
    };
    for (name, element) in &header.elements {
        // An element takes at least a byte: a count beyond the file's size is a lie that would cost time and memory.
        if element.count as u64 > limit.most {
            let (count, what) = (element.count, format!("elements \"{name}\""));
            return Err(limit.refusal(format!("{count} {what}; at most {limit} are read")));
        }
        if element.count as u64 > length {
            return Err(format!("{} elements \"{name}\" do not fit into the file", element.count));
        }
        if name == "vertex" && !Columns::of(element).positions {
            return Err("its vertices have no x, y, z".into());
        }
        match (name.as_str(), &mut data) {
            ("vertex", Some(data)) => data.vertices(element, &mut mesh)?,
            ("vertex", None) => vertices(&mut reader, element, &header, &mut mesh)?,
            ("face", Some(data)) => data.faces(element, &mut mesh, fans)?,
            ("face", None) => faces(&mut reader, element, &header, &mut mesh, fans)?,
            (_, Some(data)) => data.skip_element(element)?,
            (_, None) => {
                read::<Ignored>(&mut reader, element, &header)?;
            }
        }
    }
    if !header.elements.contains_key("vertex") {
        return Err("it has no vertices".into());
    }
    let textures = header.comments.iter().filter_map(|comment| comment.trim().strip_prefix("TextureFile"));
    let textures = textures.map(|name| name.trim().to_owned()).filter(|name| !name.is_empty()).collect();
    Ok(Ply { mesh, textures })
}

/// All lines to that which ends the header.
fn header_of(stream: &mut impl BufRead) -> Result<Vec<u8>, String> {
    const MAX_HEADER: u64 = 1 << 20;
    let mut header = Vec::new();
    let mut stream = stream.take(MAX_HEADER);
    loop {
        let before = header.len();
        stream.read_until(b'\n', &mut header).map_err(|e| files::reason(&e))?;
        let line = header[before..].trim_ascii_end();
        if line == b"end_header" {
            return Ok(header);
        }
        if line.len() == header.len() - before {
            // There is no further line: the parser says what is missing.
            return Ok(header);
        }
    }
}

fn read<E: PropertyAccess>(
    reader: &mut Reader<impl BufRead>,
    element: &ElementDef,
    header: &Header,
) -> Result<Vec<E>, String> {
    Parser::<E>::new().read_payload_for_element(reader, element, header).map_err(|e| one_line(&e))
}

fn vertices(
    reader: &mut Reader<impl BufRead>,
    element: &ElementDef,
    header: &Header,
    mesh: &mut MeshDesc,
) -> Result<(), String> {
    let columns = Columns::of(element);
    let vertices: Vec<Vertex> = read(reader, element, header)?;
    mesh.positions = vertices.iter().map(|Vertex(v)| Vec3::new(v[0], v[1], v[2])).collect();
    if columns.normals {
        mesh.normals = vertices.iter().map(|Vertex(v)| Vec3::new(v[3], v[4], v[5])).collect();
    }
    if columns.uvs {
        mesh.uvs = vertices.iter().map(|Vertex(v)| Vec2::new(v[6], v[7])).collect();
    }
    if columns.colors {
        mesh.vertex_colors = vertices.iter().map(|Vertex(v)| Vec3::new(v[8], v[9], v[10])).collect();
    }
    Ok(())
}

fn faces(
    reader: &mut Reader<impl BufRead>,
    element: &ElementDef,
    header: &Header,
    mesh: &mut MeshDesc,
    fans: &mut Fans,
) -> Result<(), String> {
    if element.count > 0 && index_list(element).is_none() {
        return Err(NO_INDICES.into());
    }
    mesh.triangles.reserve(element.count);
    for (number, face) in read::<Face>(reader, element, header)?.into_iter().enumerate() {
        if let Some(bad) = face.bad {
            return Err(format!("face {number} uses the vertex {bad}"));
        }
        fans.add(&face.indices, &mut mesh.triangles);
        if has_colors(element) {
            mesh.face_colors.resize(mesh.triangles.len(), Vec3::from(face.color));
        }
    }
    Ok(())
}

/// The parser's errors quote whole lines; the first line of the message says enough.
fn one_line(error: &dyn std::fmt::Display) -> String {
    crate::values::shown(error.to_string().lines().next().unwrap_or("it cannot be read")).replace('\t', " ")
}

const NO_INDICES: &str = "its faces have no list of vertex indices";

/// The property that holds a face's vertices.
fn index_list(element: &ElementDef) -> Option<(&String, &PropertyDef)> {
    let found =
        ["vertex_indices", "vertex_index"].iter().find_map(|&n| element.properties.get_key_value(n))?;
    matches!(found.1.data_type, PropertyType::List(..)).then_some(found)
}

/// Which of a vertex's properties there are.
struct Columns {
    positions: bool,
    normals: bool,
    uvs: bool,
    colors: bool,
}

impl Columns {
    /// Position, normal, texture coordinates, color, one after another.
    const SLOTS: usize = 11;
    const FIRST_COLOR: usize = 8;

    fn of(element: &ElementDef) -> Self {
        let has = |name: &str| element.properties.contains_key(name);
        let pairs = [("u", "v"), ("s", "t"), ("texture_u", "texture_v"), ("texture_s", "texture_t")];
        Self {
            positions: has("x") && has("y") && has("z"),
            normals: has("nx") && has("ny") && has("nz"),
            uvs: pairs.iter().any(|(u, v)| has(u) && has(v)),
            colors: has_colors(element),
        }
    }

    /// Where a property goes.
    fn slot(name: &str) -> Option<usize> {
        Some(match name {
            "x" => 0,
            "y" => 1,
            "z" => 2,
            "nx" => 3,
            "ny" => 4,
            "nz" => 5,
            "u" | "s" | "texture_u" | "texture_s" => 6,
            "v" | "t" | "texture_v" | "texture_t" => 7,
            _ => return color_slot(name).map(|slot| Self::FIRST_COLOR + slot),
        })
    }
}

fn has_colors(element: &ElementDef) -> bool {
    let has = |name: &str| element.properties.contains_key(name);
    // The last are Mitsuba's own.
    let triples = [["r", "g", "b"], ["red", "green", "blue"], ["color_0", "color_1", "color_2"]];
    triples.iter().any(|triple| triple.iter().all(|name| has(name)))
}

/// Which part of a color a property is.
fn color_slot(name: &str) -> Option<usize> {
    Some(match name {
        "r" | "red" | "color_0" => 0,
        "g" | "green" | "color_1" => 1,
        "b" | "blue" | "color_2" => 2,
        _ => return None,
    })
}

/// A part of a color as a number in [0, 1]: whole numbers count to the largest of their kind.
fn color_part(value: &Property) -> Option<f32> {
    Some(match *value {
        Property::Float(v) => v,
        Property::Double(v) => v as f32,
        Property::UChar(v) => f32::from(v) / 255.0,
        Property::UShort(v) => f32::from(v) / 65535.0,
        _ => return None,
    })
}

/// A vertex of a text file, by [`Columns::slot`].
#[derive(Default)]
struct Vertex([f32; Columns::SLOTS]);

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_float(&mut self, name: &str, value: f32) -> PropertyAccessResult {
        let Some(slot) = Columns::slot(name) else { return PropertyAccessResult::Ignored };
        self.0[slot] = value;
        PropertyAccessResult::Set
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        if let (Some(slot), Some(part)) = (color_slot(name), color_part(&value)) {
            self.0[Columns::FIRST_COLOR + slot] = part;
            return PropertyAccessResult::Set;
        }
        match value {
            Property::Double(v) => self.set_float(name, v as f32),
            Property::Char(v) => self.set_float(name, v.into()),
            Property::UChar(v) => self.set_float(name, v.into()),
            Property::Short(v) => self.set_float(name, v.into()),
            Property::UShort(v) => self.set_float(name, v.into()),
            Property::Int(v) => self.set_float(name, v as f32),
            Property::UInt(v) => self.set_float(name, v as f32),
            _ => PropertyAccessResult::Ignored,
        }
    }
}

#[derive(Default)]
struct Face {
    indices: Vec<u32>,
    color: [f32; 3],
    bad: Option<i64>,
}

impl Face {
    fn set<T: Into<i64>>(&mut self, list: Vec<T>) {
        self.indices.reserve_exact(list.len());
        for value in list {
            let value = value.into();
            match u32::try_from(value) {
                Ok(index) => self.indices.push(index),
                Err(_) => self.bad = Some(value),
            }
        }
    }
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        if let (Some(slot), Some(part)) = (color_slot(name), color_part(&value)) {
            self.color[slot] = part;
            return PropertyAccessResult::Set;
        }
        if name != "vertex_indices" && name != "vertex_index" {
            return PropertyAccessResult::Ignored;
        }
        match value {
            Property::ListInt(v) => self.set(v),
            Property::ListUInt(v) => self.set(v),
            Property::ListShort(v) => self.set(v),
            Property::ListUShort(v) => self.set(v),
            Property::ListChar(v) => self.set(v),
            Property::ListUChar(v) => self.set(v),
            _ => return PropertyAccessResult::UnsupportedType,
        }
        PropertyAccessResult::Set
    }
}

/// An element that is read only to get past it.
struct Ignored;

impl PropertyAccess for Ignored {
    fn new() -> Self {
        Self
    }
}

#[cfg(test)]
fn parse_bytes(bytes: &[u8], fans: &mut Fans) -> Result<MeshDesc, String> {
    let reader = Box::new(Cursor::new(bytes.to_vec()));
    parse(Content { reader, length: bytes.len() as u64 }, fans, Limit::fixed(1 << 20)).map(|file| file.mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(format: &str, vertex: &str) -> Vec<u8> {
        let mut text = format!("ply\nformat {format} 1.0\ncomment a test\nelement vertex 4\n");
        for name in vertex.split(' ') {
            text.push_str(&format!("property float {name}\n"));
        }
        text.push_str("element face 1\nproperty list uchar int vertex_indices\nend_header\n");
        text.into_bytes()
    }

    fn binary(big: bool) -> Vec<u8> {
        let mut bytes = header(if big { "binary_big_endian" } else { "binary_little_endian" }, "x y z u v");
        let number = |v: f32| if big { v.to_be_bytes() } else { v.to_le_bytes() };
        for (x, y) in [(0., 0.), (1., 0.), (1., 1.), (0., 1.)] {
            [x, y, 0.5, x, y].iter().for_each(|&v| bytes.extend(number(v)));
        }
        bytes.push(4);
        (0..4).for_each(|i: i32| bytes.extend(if big { i.to_be_bytes() } else { i.to_le_bytes() }));
        bytes
    }

    #[test]
    fn text_and_both_byte_orders_give_the_same_mesh() {
        let mut ascii = header("ascii", "x y z u v");
        ascii.extend(b"0 0 0.5 0 0\n1 0 0.5 1 0\n1 1 0.5 1 1\n0 1 5e-1 0 1\n4 0 1 2 3\n");
        let mesh = parse_bytes(&ascii, &mut Fans::default()).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.positions[2], Vec3::new(1.0, 1.0, 0.5));
        assert_eq!(mesh.uvs[3], Vec2::new(0.0, 1.0));
        assert!(mesh.normals.is_empty());
        assert_eq!(parse_bytes(&binary(false), &mut Fans::default()).unwrap(), mesh);
        assert_eq!(parse_bytes(&binary(true), &mut Fans::default()).unwrap(), mesh);
    }

    #[test]
    fn every_truncation_is_an_error() {
        let whole = binary(false);
        for cut in 0..whole.len() {
            assert!(parse_bytes(&whole[..cut], &mut Fans::default()).is_err(), "cut at {cut}");
        }
    }

    #[test]
    fn counts_that_lie_are_refused_at_once() {
        for count in ["4000000000", "18446744073709551615"] {
            let text = format!(
                "ply\nformat ascii 1.0\nelement junk {count}\nelement vertex 0\nproperty float x\n\
                 property float y\nproperty float z\nend_header\n"
            );
            assert!(parse_bytes(text.as_bytes(), &mut Fans::default()).is_err());
        }
    }

    #[test]
    fn colors_of_vertices_and_faces() {
        let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                    property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n\
                    property list uchar int vertex_indices\nproperty float r\nproperty float g\nproperty float b\n\
                    end_header\n0 0 0 255 0 51\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2 0.5 0.25 2\n";
        let mesh = parse_bytes(text.as_bytes(), &mut Fans::default()).unwrap();
        assert_eq!(mesh.vertex_colors[0], Vec3::new(1.0, 0.0, 0.2));
        assert_eq!(mesh.face_colors, [Vec3::new(0.5, 0.25, 2.0)]);
        let header = text.split_inclusive("end_header\n").next().unwrap();
        let mut bytes = header.replace("ascii", "binary_little_endian").into_bytes();
        for (place, color) in
            [([0.0f32, 0.0], [255u8, 0, 51]), ([1.0, 0.0], [0, 255, 0]), ([0.0, 1.0], [0, 0, 255])]
        {
            [place[0], place[1], 0.0].iter().for_each(|v| bytes.extend(v.to_le_bytes()));
            bytes.extend(color);
        }
        bytes.push(3);
        (0..3i32).for_each(|i| bytes.extend(i.to_le_bytes()));
        [0.5f32, 0.25, 2.0].iter().for_each(|v| bytes.extend(v.to_le_bytes()));
        assert_eq!(parse_bytes(&bytes, &mut Fans::default()).unwrap(), mesh);
    }
}
