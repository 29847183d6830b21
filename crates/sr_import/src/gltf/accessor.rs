//! Accessors: numbers out of buffers, whatever kind they are stored as, with what sparse ones replace.

use super::document::Document;
use super::json::Value;

/// How numbers are stored.
#[derive(Clone, Copy)]
enum Stored {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Stored {
    fn of(code: usize) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// What whole numbers count to.
    fn largest(self) -> f64 {
        match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32767.0,
            Self::U16 => 65535.0,
            Self::U32 => f64::from(u32::MAX),
            Self::F32 => 1.0,
        }
    }

    /// Whole numbers count to the largest of their kind if `normalized`.
    fn read(self, b: &[u8], normalized: bool) -> f64 {
        let value = match self {
            Self::I8 => f64::from(b[0].cast_signed()),
            Self::U8 => f64::from(b[0]),
            Self::I16 => f64::from(i16::from_le_bytes([b[0], b[1]])),
            Self::U16 => f64::from(u16::from_le_bytes([b[0], b[1]])),
            Self::U32 => f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Self::F32 => return f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        };
        if normalized { (value / self.largest()).max(-1.0) } else { value }
    }
}

/// Numbers in rows.
pub struct Rows {
    pub width: usize,
    pub data: Vec<f64>,
}

impl Rows {
    pub fn len(&self) -> usize {
        self.data.len() / self.width
    }

    pub fn iter(&self) -> std::slice::ChunksExact<'_, f64> {
        self.data.chunks_exact(self.width)
    }

    /// Rows of `N`, of which the file may have more or fewer; what is missing is `filler`.
    pub fn of<const N: usize>(&self, filler: f32) -> impl Iterator<Item = [f32; N]> {
        self.iter().map(move |row| std::array::from_fn(|i| row.get(i).map_or(filler, |&v| v as f32)))
    }
}

impl Document<'_, '_> {
    /// The rows of the accessor that `index` means, if they are as wide as one of `widths`.
    pub fn rows(&mut self, index: &Value, widths: &[usize]) -> Option<Rows> {
        let accessor = self.item("accessors", index)?;
        match self.try_rows(accessor, widths) {
            Ok(rows) => rows,
            Err(reason) => {
                let message = format!("the accessor cannot be read: {reason}");
                self.error("gltf::bad-accessor", &accessor.span, message);
                None
            }
        }
    }

    /// Whole numbers, as indices are.
    pub fn indices(&mut self, index: &Value) -> Option<Vec<u32>> {
        self.rows(index, &[1]).map(|rows| rows.data.iter().map(|&v| v as u32).collect())
    }

    /// What the whole numbers of an accessor are divided by, if they are normalized.
    pub fn normalized_to(&self, accessor: &Value) -> Option<f64> {
        let stored = accessor.get("componentType").and_then(Value::index).and_then(Stored::of);
        stored.filter(|_| accessor.get("normalized").is_some_and(Value::is_true)).map(Stored::largest)
    }

    fn try_rows(&mut self, accessor: &Value, widths: &[usize]) -> Result<Option<Rows>, String> {
        let whole = |object: &Value, name: &str| object.get(name).and_then(Value::index);
        let kind = accessor.get("type").and_then(Value::text).unwrap_or("");
        let width = match kind {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            "MAT4" => 16,
            _ => 0,
        };
        if !widths.contains(&width) {
            return Err(format!("it has the type \"{}\"", crate::values::shown(kind)));
        }
        let stored = whole(accessor, "componentType").and_then(Stored::of);
        let stored = stored.ok_or("its \"componentType\" is none of glTF's")?;
        let count = whole(accessor, "count").ok_or("it has no \"count\"")?;
        let total = count.checked_mul(width).filter(|&total| total <= self.budget);
        let total = total.ok_or_else(|| {
            let what = format!("with it the file has too many numbers ({count} × {width})");
            self.out.limits.gltf_numbers.refusal(what)
        })?;
        let normalized = accessor.get("normalized").is_some_and(Value::is_true);
        let mut rows = match accessor.get("bufferView") {
            Some(view) => {
                let Some(view) = self.view(view) else { return Ok(None) };
                let offset = whole(accessor, "byteOffset").unwrap_or(0);
                let stride = view.stride;
                Rows { width, data: numbers(view.bytes(), offset, stride, stored, width, count, normalized)? }
            }
            None => Rows { width, data: vec![0.0; total] },
        };
        self.budget -= total;
        if let Some(sparse) = accessor.get("sparse") {
            self.replace(sparse, &mut rows, stored, normalized)?;
        }
        Ok(Some(rows))
    }

    /// Puts in what a sparse accessor has instead.
    fn replace(
        &mut self,
        sparse: &Value,
        rows: &mut Rows,
        stored: Stored,
        normalized: bool,
    ) -> Result<(), String> {
        let count = sparse.get("count").and_then(Value::index).ok_or("its sparse part has no \"count\"")?;
        let mut part = |name: &str, width: usize, stored: Option<Stored>| {
            let part = sparse.get(name).ok_or_else(|| format!("its sparse part has no \"{name}\""))?;
            let whole = |name: &str| part.get(name).and_then(Value::index);
            let stored = stored.or_else(|| whole("componentType").and_then(Stored::of));
            let stored = stored.ok_or("its sparse part has a bad \"componentType\"")?;
            let view = part.get("bufferView").and_then(|view| self.view(view));
            let view = view.ok_or("its sparse part has no buffer view")?;
            let offset = whole("byteOffset").unwrap_or(0);
            numbers(view.bytes(), offset, None, stored, width, count, normalized && name == "values")
        };
        let indices = part("indices", 1, None)?;
        let values = part("values", rows.width, Some(stored))?;
        let (length, width) = (rows.len(), rows.width);
        for (&index, row) in indices.iter().zip(values.chunks_exact(width)) {
            let index = index as usize;
            if index >= length {
                return Err(format!("its sparse part replaces row {index} of {length}"));
            }
            rows.data[index * width..(index + 1) * width].copy_from_slice(row);
        }
        Ok(())
    }
}

/// `count` rows out of a view; the error is half a sentence.
fn numbers(
    bytes: &[u8],
    offset: usize,
    stride: Option<usize>,
    stored: Stored,
    width: usize,
    count: usize,
    normalized: bool,
) -> Result<Vec<f64>, String> {
    let size = stored.size();
    let stride = stride.unwrap_or(size * width);
    if stride < size * width {
        return Err(format!("a stride of {stride} bytes is less than its {}", size * width));
    }
    let end = count.saturating_sub(1).checked_mul(stride).and_then(|n| n.checked_add(offset + size * width));
    if count > 0 && end.is_none_or(|end| end > bytes.len()) {
        return Err(format!("{count} elements go beyond the {} bytes of its view", bytes.len()));
    }
    let mut data = Vec::with_capacity(count * width);
    for row in 0..count {
        let start = offset + row * stride;
        let row = &bytes[start..start + size * width];
        data.extend(row.chunks_exact(size).map(|b| stored.read(b, normalized)));
    }
    Ok(data)
}
