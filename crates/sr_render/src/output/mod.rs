//! Images to files: OpenEXR with every layer, PNG for looking at.
//!
//! In: a [`RenderedImage`], [`Metadata`] and, for PNG, a [`Display`]. Out: a complete file, or none: data goes
//! to a temporary name in the same folder, which is renamed at the end and removed on failure.

mod atomic;
mod exr;
mod metadata;
mod png;
mod tone;

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::image::RenderedImage;

pub use self::atomic::write_then_rename;
pub use self::exr::write_exr;
pub use self::png::{encode_png, write_png};
pub use metadata::{Metadata, Value};
pub use tone::{Display, Tone, UnknownTone};

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// OpenEXR: all layers, 32-bit float, linear.
    Exr,
    /// PNG: 8 bits, for display.
    Png,
}

impl Format {
    /// The format that a file name's extension asks for.
    ///
    /// # Errors
    /// If there is none, or one that is not written.
    pub fn of(path: &Path) -> Result<Self, OutputError> {
        match path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("exr") => Ok(Self::Exr),
            Some("png") => Ok(Self::Png),
            _ => Err(OutputError::UnknownFormat { path: path.to_owned() }),
        }
    }
}

/// Why a file was not written. Nothing is left behind.
#[derive(Debug, Error)]
pub enum OutputError {
    /// The extension says nothing.
    #[error("cannot tell the format of {}: the name must end in .exr or .png", path.display())]
    UnknownFormat {
        /// The name asked for.
        path: PathBuf,
    },
    /// The system refused.
    #[error("cannot write {}: {source}", path.display())]
    Io {
        /// The name asked for.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
}

/// Writes an image in the format that the name asks for. `display` is for formats that are looked at.
///
/// # Errors
/// See [`OutputError`].
pub fn write(
    path: &Path,
    image: &RenderedImage,
    metadata: &Metadata,
    display: Display,
) -> Result<(), OutputError> {
    match Format::of(path)? {
        Format::Exr => write_exr(path, image, metadata),
        Format::Png => write_png(path, image, metadata, display),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_decides_whatever_its_case() {
        assert_eq!(Format::of(Path::new("a/b.EXR")).unwrap(), Format::Exr);
        assert_eq!(Format::of(Path::new("b.png")).unwrap(), Format::Png);
        for name in ["b", "b.jpg", ".exr", ""] {
            let message = Format::of(Path::new(name)).unwrap_err().to_string();
            assert!(message.contains(".exr or .png"), "{name}: {message}");
        }
    }
}
