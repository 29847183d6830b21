//! Opening what a scene file names: only regular files, only up to a size, found along search paths.

use std::fs::File;
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

use sr_scene::{Diagnostic, Span};

use crate::limits::Limit;

/// The whole content of a regular file of at most `limit` bytes; the error is half a sentence.
pub fn read(path: &Path, limit: Limit) -> Result<Vec<u8>, String> {
    let (file, length) = regular(path, limit)?;
    let mut bytes = Vec::with_capacity(length as usize);
    file.take(limit.most.saturating_add(1)).read_to_end(&mut bytes).map_err(|e| reason(&e))?;
    if bytes.len() as u64 > limit.most {
        return Err(limit.refusal(format!("it grew beyond {limit} bytes while being read")));
    }
    Ok(bytes)
}

/// A regular file of at most `limit` bytes, and how many it has.
fn regular(path: &Path, limit: Limit) -> Result<(File, u64), String> {
    // Looked at before it is opened: opening a FIFO would wait for a writer.
    let metadata = std::fs::metadata(path).map_err(|e| reason(&e))?;
    if metadata.is_dir() {
        return Err("it is a directory".into());
    }
    if !metadata.is_file() {
        return Err("it is not a regular file".into());
    }
    if metadata.len() > limit.most {
        let length = metadata.len();
        return Err(limit.refusal(format!("it has {length} bytes; at most {limit} are read")));
    }
    let file = File::open(path).map_err(|e| reason(&e))?;
    Ok((file, metadata.len()))
}

/// What a file holds, to be read from its beginning to its end.
pub struct Content {
    /// At most [`Content::length`] bytes.
    pub reader: Box<dyn Read>,
    /// Of the content in bytes.
    pub length: u64,
}

/// Opens a regular file that is not read at once, of at most `limit` bytes. What gzip has packed is unpacked in memory, to at most
/// `unpacked_limit` bytes.
pub fn open(path: &Path, limit: Limit, unpacked_limit: Limit) -> Result<Content, String> {
    let (mut file, length) = regular(path, limit)?;
    let mut start = Vec::new();
    file.by_ref().take(GZIP.len() as u64).read_to_end(&mut start).map_err(|e| reason(&e))?;
    if start == GZIP {
        let bytes = unpacked(read(path, limit)?, unpacked_limit)?;
        return Ok(Content { length: bytes.len() as u64, reader: Box::new(Cursor::new(bytes)) });
    }
    Ok(Content { reader: Box::new(Cursor::new(start).chain(file).take(length)), length })
}

/// How files begin that gzip has packed.
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// The text of a scene file.
pub fn read_text(path: &Path, limit: Limit) -> Result<String, String> {
    let bytes = read(path, limit)?;
    let text = String::from_utf8(bytes)
        .map_err(|e| format!("byte {} is not UTF-8 text", e.utf8_error().valid_up_to()))?;
    Ok(text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text))
}

/// What gzip has packed into `bytes`, or `bytes` themselves if it has not packed them; the error is half a sentence.
pub fn unpacked(bytes: Vec<u8>, limit: Limit) -> Result<Vec<u8>, String> {
    if !bytes.starts_with(&GZIP) {
        return Ok(bytes);
    }
    let mut out = Vec::new();
    let reader = flate2::read::MultiGzDecoder::new(&bytes[..]);
    let mut reader = reader.take(limit.most.saturating_add(1));
    reader.read_to_end(&mut out).map_err(|e| format!("it cannot be unpacked: {e}"))?;
    if out.len() as u64 > limit.most {
        return Err(limit.refusal(format!("unpacked it has more than {limit} bytes")));
    }
    Ok(out)
}

/// Half a sentence.
pub fn reason(error: &std::io::Error) -> String {
    match error.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".into(),
        std::io::ErrorKind::PermissionDenied => "permission denied".into(),
        _ => error.to_string(),
    }
}

/// Where files are looked for: beside the scene and where it says, then where the user says.
#[derive(Clone, Debug, Default)]
pub struct Directories {
    list: Vec<PathBuf>,
    /// How many of them are the scene's; the others are the user's.
    scene: usize,
}

impl Directories {
    /// The scene's own directory, and the user's.
    pub fn new(own: PathBuf, search_paths: &[PathBuf]) -> Self {
        Self { list: std::iter::once(own).chain(search_paths.iter().cloned()).collect(), scene: 1 }
    }

    /// Adds one of the scene's, unless it is one of them: after its others, before the user's.
    pub fn add(&mut self, directory: PathBuf) {
        if !self.list.iter().take(self.scene).any(|known| *known == directory) {
            self.list.insert(self.scene, directory);
            self.scene += 1;
        }
    }

    /// Where a file is: [`find`].
    pub fn find(&self, name: &str) -> PathBuf {
        find(name, &self.list)
    }

    /// All of them, in the order of looking.
    pub fn into_list(self) -> Vec<PathBuf> {
        self.list
    }
}

/// The first directory's `name` that exists, or the first candidate if none does.
pub fn find(name: &str, directories: &[PathBuf]) -> PathBuf {
    let path = Path::new(name);
    if path.is_absolute() {
        return path.to_owned();
    }
    let mut candidates = directories.iter().map(|d| d.join(path));
    let found = candidates.clone().find(|c| c.exists());
    found.or_else(|| candidates.next()).unwrap_or_else(|| path.to_owned())
}

/// A file that could not be used, with a guess at its name if it is missing.
pub fn error(code: &'static str, span: &Span, what: &str, path: &Path, reason: &str) -> Diagnostic {
    let error = Diagnostic::error(code, span, format!("cannot read the {what} {}: {reason}", path.display()));
    if path.exists() {
        return error;
    }
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let siblings = siblings(path);
    error.guess(&name, siblings.iter().map(String::as_str))
}

/// The names in the directory where `path` was expected, for a guess at a misspelt file name.
fn siblings(path: &Path) -> Vec<String> {
    const ENOUGH: usize = 4096;
    let Some(directory) = path.parent() else { return Vec::new() };
    let Ok(entries) = std::fs::read_dir(directory) else { return Vec::new() };
    entries.flatten().take(ENOUGH).map(|e| e.file_name().to_string_lossy().into_owned()).collect()
}
