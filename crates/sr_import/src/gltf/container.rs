//! Files to JSON text and bytes: `.gltf`, `.glb`, files beside them, and data URIs.

use std::path::Path;

use crate::files;
use crate::limits::Limit;

/// A file taken apart.
pub struct Container {
    pub json: String,
    /// The binary chunk of a `.glb`.
    pub binary: Option<Vec<u8>>,
}

const MAGIC: &[u8] = b"glTF";
const JSON: u32 = 0x4e4f_534a;
const BINARY: u32 = 0x004e_4942;

/// Takes a file apart; the error is half a sentence.
pub fn read(bytes: Vec<u8>, limit: Limit) -> Result<Container, String> {
    let text = |bytes: &[u8]| {
        if bytes.len() as u64 > limit.most {
            return Err(limit.refusal(format!("its JSON has more than {limit} bytes")));
        }
        let text = std::str::from_utf8(bytes);
        let text = text.map_err(|e| format!("byte {} of its JSON is not UTF-8 text", e.valid_up_to()))?;
        Ok(text.strip_prefix('\u{feff}').unwrap_or(text).to_owned())
    };
    if !bytes.starts_with(MAGIC) {
        return Ok(Container { json: text(&bytes)?, binary: None });
    }
    let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    match word(4) {
        Some(2) => {}
        Some(version) => return Err(format!("it is of version {version} of glTF; version 2 is read")),
        None => return Err("it ends in its header".into()),
    }
    let mut container = Container { json: String::new(), binary: None };
    let mut at = 12;
    let mut first = true;
    while let (Some(length), Some(kind)) = (word(at), word(at + 4)) {
        let start = at + 8;
        let end = start + length as usize;
        let chunk = bytes.get(start..end).ok_or_else(|| {
            format!("it is cut off: a chunk of {length} bytes begins at byte {at} of {}", bytes.len())
        })?;
        match kind {
            JSON if first => container.json = text(chunk)?,
            BINARY if container.binary.is_none() => container.binary = Some(chunk.to_vec()),
            _ if first => return Err("its first chunk is not JSON".into()),
            // Chunks of other kinds are to be passed over, by the specification.
            _ => {}
        }
        first = false;
        at = end.next_multiple_of(4);
    }
    if first { Err("it has no JSON".into()) } else { Ok(container) }
}

/// The bytes that a URI stands for: a data URI, or a file of at most `limit` bytes.
pub fn fetch(uri: &str, find: impl Fn(&str) -> std::path::PathBuf, limit: Limit) -> Result<Vec<u8>, String> {
    if let Some(rest) = uri.strip_prefix("data:") {
        let (head, data) = rest.split_once(',').ok_or("its data URI has no comma")?;
        return if head.ends_with(";base64") { base64(data) } else { Ok(unescape(data)) };
    }
    if uri.contains("://") {
        return Err("only files and data URIs are read".into());
    }
    // Some exporters escape file names, some do not.
    let plain = find(uri);
    let path = if plain.exists() { plain } else { find(&String::from_utf8_lossy(&unescape(uri))) };
    files::read(Path::new(&path), limit)
}

/// `%20` and the like to bytes.
fn unescape(text: &str) -> Vec<u8> {
    let bytes = text.as_bytes();
    let mut out = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        let code = (byte == b'%').then(|| text.get(at + 1..at + 3)).flatten();
        match code.and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            Some(code) => {
                out.push(code);
                at += 3;
            }
            None => {
                out.push(byte);
                at += 1;
            }
        }
    }
    out
}

/// Base64 of RFC 4648, also with the letters for URLs, padded or not.
fn base64(text: &str) -> Result<Vec<u8>, String> {
    let mut out = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut count) = (0u32, 0);
    for (at, byte) in text.bytes().enumerate() {
        let six = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            b'=' | b'\n' | b'\r' => continue,
            _ => return Err(format!("character {at} of its data is not of Base64")),
        };
        bits = bits << 6 | u32::from(six);
        count += 6;
        if count >= 8 {
            count -= 8;
            out.push((bits >> count) as u8);
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_uris() {
        let fetch = |uri| fetch(uri, |name| name.into(), Limit::fixed(100));
        assert_eq!(fetch("data:application/octet-stream;base64,AAEC/w==").unwrap(), [0, 1, 2, 255]);
        assert_eq!(fetch("data:text/plain,a%20b").unwrap(), b"a b");
        assert!(fetch("data:;base64,A*").unwrap_err().contains("character 1"));
        assert!(fetch("https://a.b/c.bin").is_err());
    }

    #[test]
    fn broken_binaries() {
        let read = |bytes| read(bytes, Limit::fixed(100));
        let header = |length: u32| {
            let mut bytes = b"glTF".to_vec();
            [2, 20, length, JSON].iter().for_each(|w| bytes.extend(w.to_le_bytes()));
            bytes
        };
        assert!(read(header(u32::MAX)).err().unwrap().contains("cut off"));
        assert_eq!(read(header(0)).ok().unwrap().json, "");
        assert!(read(b"glTF".to_vec()).is_err());
        assert!(read(b"glTF\x01\0\0\0".to_vec()).err().unwrap().contains("version 1"));
    }
}
