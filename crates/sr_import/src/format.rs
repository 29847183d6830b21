//! Which format a file has: by its name, and by its text where that does not tell.

use std::path::Path;

use crate::pbrt;

/// A format of scene files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Mitsuba's XML.
    Mitsuba,
    /// pbrt-v4's.
    Pbrt,
    /// glTF 2.0, text or binary.
    Gltf,
}

impl Format {
    /// By the extension; Mitsuba's where there is none that is known.
    pub fn of_name(name: &str) -> Self {
        Self::by_extension(name).unwrap_or(Self::Mitsuba)
    }

    /// By the extension, or else by how the text begins.
    pub fn of_text(name: &str, text: &str) -> Self {
        Self::by_extension(name).unwrap_or_else(|| {
            let mut lines = text.lines().map(str::trim_start).filter(|line| !line.is_empty());
            let is_pbrt = lines.next().is_some_and(|line| {
                let word = line.split(|c: char| !c.is_ascii_alphabetic()).next().unwrap_or("");
                line.starts_with('#') || pbrt::is_directive(word)
            });
            if is_pbrt { Self::Pbrt } else { Self::Mitsuba }
        })
    }

    fn by_extension(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        let name = name.strip_suffix(".gz").unwrap_or(&name);
        match Path::new(name).extension()?.to_str()? {
            "xml" => Some(Self::Mitsuba),
            "pbrt" => Some(Self::Pbrt),
            "gltf" | "glb" => Some(Self::Gltf),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_before_texts() {
        for (name, text, format) in [
            ("a.xml", "WorldBegin", Format::Mitsuba),
            ("a.PBRT", "<scene/>", Format::Pbrt),
            ("a.pbrt.gz", "", Format::Pbrt),
            ("text", "# a comment", Format::Pbrt),
            ("text", "\n  Shape\"sphere\"", Format::Pbrt),
            ("text", "<scene/>", Format::Mitsuba),
            ("text", "", Format::Mitsuba),
        ] {
            assert_eq!(Format::of_text(name, text), format, "{name} {text}");
        }
    }
}
