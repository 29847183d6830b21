//! Portable float maps: a header of three lines, then `f32`s, rows from the bottom.
//!
//! In: a file's bytes. Out: the size, and values as they are. The format: Debevec, "PFM portable floatmap".

use sr_scene::Pixels;

use crate::limits::Limit;

/// Does a file begin like a portable float map?
pub fn is_pfm(bytes: &[u8]) -> bool {
    matches!(bytes, [b'P', b'F' | b'f', b'\n' | b' ' | b'\r', ..])
}

/// Reads a file of at most `limit` texels; the error is half a sentence.
pub fn decode(bytes: &[u8], limit: Limit) -> Result<(u32, u32, Pixels), String> {
    let channels: u8 = if bytes[1] == b'F' { 3 } else { 1 };
    let mut rest = &bytes[2..];
    let [width, height, scale] = [word(&mut rest), word(&mut rest), word(&mut rest)];
    let size = |text: Option<&str>| text.and_then(|t| t.parse::<u32>().ok()).filter(|&n| n > 0);
    let (Some(width), Some(height)) = (size(width), size(height)) else {
        return Err("its header has no size".into());
    };
    // The sign of the scale tells the order of bytes; its value is left to whoever looks at the image.
    let scale = scale.and_then(|t| t.parse::<f32>().ok()).filter(|s| s.is_finite() && *s != 0.0);
    let is_little = scale.ok_or("its header has no scale")? < 0.0;
    let texels = u64::from(width) * u64::from(height);
    if texels > limit.most {
        return Err(limit.refusal(format!("it has {width} × {height} pixels; at most {limit} are read")));
    }
    let row = width as usize * usize::from(channels);
    let values = rest.get(1..).unwrap_or_default();
    if (values.len() as u64) < texels * u64::from(channels) * 4 {
        return Err("it is cut off".into());
    }
    let mut data = Vec::with_capacity(row * height as usize);
    for y in (0..height as usize).rev() {
        for value in values[4 * row * y..4 * row * (y + 1)].as_chunks().0 {
            data.push(if is_little { f32::from_le_bytes(*value) } else { f32::from_be_bytes(*value) });
        }
    }
    Ok((width, height, Pixels::F32 { channels, data }))
}

/// The next word; one byte of white space stays behind it.
fn word<'a>(rest: &mut &'a [u8]) -> Option<&'a str> {
    let start = rest.iter().position(|b| !b.is_ascii_whitespace())?;
    let length = rest[start..].iter().position(u8::is_ascii_whitespace)?;
    let found = &rest[start..start + length];
    *rest = &rest[start + length..];
    std::str::from_utf8(found).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(magic: &str, scale: &str, values: &[[u8; 4]]) -> Vec<u8> {
        let mut bytes = format!("{magic}\n2 2\n{scale}\n").into_bytes();
        values.iter().for_each(|v| bytes.extend(v));
        bytes
    }

    #[test]
    fn rows_come_from_the_bottom_in_both_orders_of_bytes() {
        let values = [1.0f32, 2.0, 3.0, 4.5];
        let expected = Pixels::F32 { channels: 1, data: vec![3.0, 4.5, 1.0, 2.0] };
        let little = file("Pf", "-1.0", &values.map(f32::to_le_bytes));
        let big = file("Pf", "1.0", &values.map(f32::to_be_bytes));
        assert!(is_pfm(&little));
        assert_eq!(decode(&little, Limit::fixed(4)).unwrap(), (2, 2, expected.clone()));
        assert_eq!(decode(&big, Limit::fixed(4)).unwrap(), (2, 2, expected));
        let color = file("PF", "-1", &[1.0f32; 12].map(f32::to_le_bytes));
        assert_eq!(
            decode(&color, Limit::fixed(4)).unwrap().2,
            Pixels::F32 { channels: 3, data: vec![1.0; 12] }
        );
    }

    #[test]
    fn every_truncation_and_false_size_is_an_error() {
        let whole = file("Pf", "-1.0", &[1.0f32; 4].map(f32::to_le_bytes));
        for cut in 3..whole.len() {
            assert!(decode(&whole[..cut], Limit::fixed(4)).is_err(), "cut at {cut}");
        }
        assert!(decode(&whole, Limit::fixed(3)).unwrap_err().contains("at most 3"));
        for header in
            ["PF\n0 2\n-1\n", "PF\n-1 2\n-1\n", "PF\n9 9999999999\n-1\n", "PF\n2 2\n0\n", "PF\n2 2\nnan\n"]
        {
            assert!(decode(header.as_bytes(), Limit::fixed(1 << 20)).is_err(), "{header}");
        }
    }
}
