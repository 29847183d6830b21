//! EXT_meshopt_compression: buffer views whose bytes are packed as vertices, triangles or indices, and what turns packed
//! directions, rotations and exponents back into numbers.

use super::document::Document;
use super::json::Value;

/// Elements of 16 bytes of one kind are packed together.
const GROUP: usize = 16;

/// A vertex has at most so many bytes.
const MAX_STRIDE: usize = 256;

impl Document<'_, '_> {
    /// The bytes that a view's extension packs; the error is half a sentence.
    pub fn meshopt(&mut self, packed: &Value) -> Result<Vec<u8>, String> {
        let whole = |name: &str| {
            packed.get(name).map_or(Ok(0), |v| v.index().ok_or(format!("its \"{name}\" is bad")))
        };
        let text = |name: &str, default| packed.get(name).and_then(Value::text).unwrap_or(default);
        let buffer = packed.get("buffer").ok_or("it names no buffer")?;
        let bytes = self.buffer(buffer).ok_or("its buffer cannot be read")?;
        let (start, length) = (whole("byteOffset")?, whole("byteLength")?);
        let part = start.checked_add(length).and_then(|end| bytes.get(start..end));
        let part = part.ok_or_else(|| format!("it goes beyond the {} bytes of its buffer", bytes.len()))?;
        let (count, stride) = (whole("count")?, whole("byteStride")?);
        let total = count.checked_mul(stride).filter(|total| total / 4 <= self.budget);
        let total = total
            .ok_or_else(|| format!("with it the file has too many numbers ({count} × {stride} bytes)"))?;
        self.budget -= total / 4;
        let mode = text("mode", "");
        let mut out = match mode {
            "ATTRIBUTES" => attributes(part, count, stride)?,
            "TRIANGLES" => stored(&triangles(part, count)?, stride)?,
            "INDICES" => stored(&indices(part, count)?, stride)?,
            _ => {
                return Err(format!(
                    "its mode \"{}\" is none of the extension's",
                    crate::values::shown(mode)
                ));
            }
        };
        match (text("filter", "NONE"), stride) {
            ("NONE", _) => {}
            ("OCTAHEDRAL", 4) => out.chunks_exact_mut(4).for_each(octahedral_8),
            ("OCTAHEDRAL", 8) => out.chunks_exact_mut(8).for_each(octahedral_16),
            ("QUATERNION", 8) => out.chunks_exact_mut(8).for_each(quaternion),
            ("EXPONENTIAL", _) => out.chunks_exact_mut(4).for_each(exponential),
            (filter, _) => {
                let filter = crate::values::shown(filter);
                return Err(format!("its filter \"{filter}\" is none of the extension's for {stride} bytes"));
            }
        }
        Ok(out)
    }
}

/// Bytes that are read in order.
struct Reader<'a> {
    bytes: &'a [u8],
}

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], String> {
        let (taken, rest) = self.bytes.split_at_checked(count).ok_or("it is cut off")?;
        self.bytes = rest;
        Ok(taken)
    }

    fn byte(&mut self) -> Result<u8, String> {
        Ok(self.take(1)?[0])
    }

    /// Seven bits a byte, the lowest first.
    fn number(&mut self) -> Result<u32, String> {
        let mut value = 0;
        for shift in [0, 7, 14, 21, 28] {
            let byte = self.byte()?;
            value |= u32::from(byte & 127) << shift;
            if byte < 128 {
                break;
            }
        }
        Ok(value)
    }

    /// A number that is stored as what it differs from another by.
    fn next_to(&mut self, last: u32) -> Result<u32, String> {
        Ok(last.wrapping_add(unzigzag(self.number()?)))
    }

    fn end(&self) -> Result<(), String> {
        if self.bytes.is_empty() { Ok(()) } else { Err(format!("{} bytes are left over", self.bytes.len())) }
    }
}

/// The sign is stored in the lowest bit.
fn unzigzag(v: u32) -> u32 {
    (v >> 1) ^ (v & 1).wrapping_neg()
}

/// What follows the first byte, which says the kind and the version, and is before the last `tail` bytes; and these.
fn open(bytes: &[u8], kind: u8, newest: u8, tail: usize) -> Result<(Reader<'_>, &[u8]), String> {
    let (&first, rest) = bytes.split_first().ok_or("it is empty")?;
    if first & 0xf0 != kind {
        return Err(format!("it begins with the byte {first:#04x} and not with {:#04x}", kind | newest));
    }
    if first & 15 > newest {
        return Err(format!("it is of version {} of the codec, and {newest} is read", first & 15));
    }
    let at = rest.len().checked_sub(tail).ok_or("it is cut off")?;
    let (body, tail) = rest.split_at(at);
    Ok((Reader { bytes: body }, tail))
}

/// Vertices: each byte of them as what it differs from the byte before by, in groups of 16 that are as wide as they need be.
fn attributes(bytes: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, String> {
    if stride == 0 || stride > MAX_STRIDE || !stride.is_multiple_of(4) {
        return Err(format!("a stride of {stride} bytes is not between 4 and {MAX_STRIDE}, in fours"));
    }
    // Four groups have a byte of widths at least for each byte of a vertex: this bounds what a short stream can ask for.
    if count.div_ceil(4 * GROUP).saturating_mul(stride) > bytes.len() {
        return Err(format!("{} bytes are too few for {count} elements", bytes.len()));
    }
    let (mut reader, tail) = open(bytes, 0xa0, 0, stride.max(32))?;
    let mut last = tail[tail.len() - stride..].to_vec();
    let mut out = vec![0; count * stride];
    let block = ((8192 / stride) & !(GROUP - 1)).min(256);
    for block in out.chunks_mut(block * stride) {
        let groups = (block.len() / stride).div_ceil(GROUP);
        for (at, last) in last.iter_mut().enumerate() {
            let widths = reader.take(groups.div_ceil(4))?;
            for group in 0..groups {
                let width = widths[group / 4] >> (2 * (group % 4)) & 3;
                let rows = block.chunks_exact_mut(stride).skip(group * GROUP);
                for (row, delta) in rows.zip(differences(&mut reader, width)?) {
                    *last = last.wrapping_add(unzigzag(delta.into()) as u8);
                    row[at] = *last;
                }
            }
        }
    }
    reader.end()?;
    Ok(out)
}

/// A group of numbers of 0, 2, 4 or 8 bits; those that have all bits set follow as bytes.
fn differences(reader: &mut Reader<'_>, width: u8) -> Result<[u8; GROUP], String> {
    let mut out = [0; GROUP];
    let bits = match width {
        0 => return Ok(out),
        3 => {
            out.copy_from_slice(reader.take(GROUP)?);
            return Ok(out);
        }
        width => 2 * usize::from(width),
    };
    let packed = reader.take(2 * bits)?;
    let (all, each) = ((1 << bits) - 1, 8 / bits);
    for (at, value) in out.iter_mut().enumerate() {
        let small = packed[at / each] >> (8 - bits * (at % each + 1)) & all;
        *value = if small == all { reader.byte()? } else { small };
    }
    Ok(out)
}

/// The last 16 vertices or edges.
struct Recent<T> {
    items: [T; 16],
    next: usize,
}

impl<T: Copy> Recent<T> {
    fn new(item: T) -> Self {
        Self { items: [item; 16], next: 0 }
    }

    fn push(&mut self, item: T) {
        self.items[self.next & 15] = item;
        self.next = self.next.wrapping_add(1);
    }

    /// The one that was pushed `back` ago, 1 being the last.
    fn back(&self, back: u8) -> T {
        self.items[self.next.wrapping_sub(back.into()) & 15]
    }
}

/// What is known while triangles are unpacked.
struct Strip<'a> {
    data: Reader<'a>,
    edges: Recent<(u32, u32)>,
    vertices: Recent<u32>,
    /// The next vertex that no triangle has had.
    next: u32,
    /// The last vertex that was stored as a number.
    last: u32,
}

impl Strip<'_> {
    fn new_vertex(&mut self) -> u32 {
        self.next = self.next.wrapping_add(1);
        self.next.wrapping_sub(1)
    }

    fn numbered(&mut self) -> Result<u32, String> {
        self.last = self.data.next_to(self.last)?;
        Ok(self.last)
    }

    /// A new vertex, or a recent one.
    fn known(&mut self, back: u8) -> u32 {
        if back == 0 { self.new_vertex() } else { self.vertices.back(back) }
    }
}

/// Triangles: each by an edge of one before it and a vertex, or by three vertices; a vertex is the next new one, a recent
/// one, or a number.
fn triangles(bytes: &[u8], count: usize) -> Result<Vec<u32>, String> {
    if !count.is_multiple_of(3) {
        return Err(format!("{count} indices are no triangles"));
    }
    let (mut data, usual) = open(bytes, 0xe0, 1, 16)?;
    let is_old = bytes[0] & 15 == 0;
    let codes = data.take(count / 3)?;
    let (edges, vertices) = (Recent::new((u32::MAX, u32::MAX)), Recent::new(u32::MAX));
    let mut s = Strip { data, edges, vertices, next: 0, last: 0 };
    let mut out = Vec::with_capacity(count);
    for &code in codes {
        let (high, low) = (code >> 4, code & 15);
        let (a, b, c) = if high < 15 {
            let (a, b) = s.edges.back(high + 1);
            let is_recent = (1..13).contains(&low) || (is_old && low < 15 && low > 0);
            let c = match low {
                _ if is_recent => s.vertices.back(low + 1),
                0 => s.new_vertex(),
                13 | 14 => {
                    s.last = if low == 13 { s.last.wrapping_sub(1) } else { s.last.wrapping_add(1) };
                    s.last
                }
                _ => s.numbered()?,
            };
            if !is_recent {
                s.vertices.push(c);
            }
            (a, b, c)
        } else {
            let pair = if low < 14 { usual[usize::from(low)] } else { s.data.byte()? };
            let (second, third) = (pair >> 4, pair & 15);
            if low >= 14 && pair == 0 {
                s.next = 0;
            }
            let is_numbered = |code| low >= 14 && code == 15;
            let a = if low == 15 { s.numbered()? } else { s.new_vertex() };
            let b = if is_numbered(second) { s.numbered()? } else { s.known(second) };
            let c = if is_numbered(third) { s.numbered()? } else { s.known(third) };
            s.vertices.push(a);
            for (code, vertex) in [(second, b), (third, c)] {
                if code == 0 || is_numbered(code) {
                    s.vertices.push(vertex);
                }
            }
            s.edges.push((b, a));
            (a, b, c)
        };
        s.edges.push((c, b));
        s.edges.push((a, c));
        out.extend([a, b, c]);
    }
    s.data.end()?;
    Ok(out)
}

/// Indices: each by what it differs by from the last of one of two sequences.
fn indices(bytes: &[u8], count: usize) -> Result<Vec<u32>, String> {
    if count > bytes.len() {
        return Err(format!("{} bytes are too few for {count} indices", bytes.len()));
    }
    let (mut reader, _) = open(bytes, 0xd0, 1, 4)?;
    let mut last = [0u32; 2];
    let mut out = Vec::with_capacity(count);
    for _ in 0..count {
        let value = reader.number()?;
        let last = &mut last[(value & 1) as usize];
        *last = last.wrapping_add(unzigzag(value >> 1));
        out.push(*last);
    }
    reader.end()?;
    Ok(out)
}

/// Indices as bytes.
fn stored(indices: &[u32], stride: usize) -> Result<Vec<u8>, String> {
    match stride {
        2 => Ok(indices.iter().flat_map(|&index| (index as u16).to_le_bytes()).collect()),
        4 => Ok(indices.iter().flat_map(|index| index.to_le_bytes()).collect()),
        _ => Err(format!("indices of {stride} bytes are not 2 or 4 bytes long")),
    }
}

/// A unit vector whose z is what x and y leave of a third number, which stands for 1; how long its numbers may be.
fn unfold(x: f32, y: f32, one: f32, largest: f32) -> [f32; 3] {
    let z = one - x.abs() - y.abs();
    let fold = z.min(0.0);
    let side = |v: f32| if v >= 0.0 { v + fold } else { v - fold };
    let (x, y) = (side(x), side(y));
    let scale = largest / (x * x + y * y + z * z).sqrt();
    [x, y, z].map(|v| (v * scale).round())
}

fn octahedral_8(b: &mut [u8]) {
    let number = |at: usize| f32::from(b[at].cast_signed());
    let unit = unfold(number(0), number(1), number(2), 127.0);
    for (byte, v) in b.iter_mut().zip(unit) {
        *byte = (v as i8).cast_unsigned();
    }
}

/// The four 16-bit numbers of eight bytes.
fn four(b: &[u8]) -> [i16; 4] {
    std::array::from_fn(|at| i16::from_le_bytes([b[2 * at], b[2 * at + 1]]))
}

fn octahedral_16(b: &mut [u8]) {
    let [x, y, one, _] = four(b).map(f32::from);
    for (bytes, v) in b.chunks_exact_mut(2).zip(unfold(x, y, one, 32767.0)) {
        bytes.copy_from_slice(&(v as i16).to_le_bytes());
    }
}

/// A rotation by three numbers of four, and which one of them is left out because it is the largest.
fn quaternion(b: &mut [u8]) {
    let [x, y, z, last] = four(b);
    let scale = std::f32::consts::FRAC_1_SQRT_2 / f32::from(last | 3);
    let [x, y, z] = [x, y, z].map(|v| f32::from(v) * scale);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let largest = (last & 3) as usize;
    for (at, v) in [w, x, y, z].into_iter().enumerate() {
        let to = 2 * ((largest + at) & 3);
        b[to..to + 2].copy_from_slice(&((v * 32767.0).round() as i16).to_le_bytes());
    }
}

/// A number by 24 bits and the power of two that they are multiplied by, both signed.
fn exponential(b: &mut [u8]) {
    let mantissa = i32::from_le_bytes([0, b[0], b[1], b[2]]) >> 8;
    let exponent = b[3].cast_signed();
    let value = f64::from(mantissa) * f64::from(exponent).exp2();
    b.copy_from_slice(&(value as f32).to_le_bytes());
}
