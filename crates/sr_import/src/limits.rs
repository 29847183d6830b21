//! How much of a file is taken in: a bound for everything that a small or a broken file could make large.
//!
//! Every one can be set ([`Limits::set`]). What protects the stack, as how deep things are nested, cannot.

use std::fmt::{self, Display};

/// The most of one thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limit {
    /// By which it is set; empty if it cannot be.
    name: &'static str,
    /// More is refused.
    pub most: u64,
    /// It cannot be set to more: what is beyond has no index.
    ceiling: u64,
    /// What it bounds.
    about: &'static str,
}

impl Limit {
    const fn bytes(name: &'static str, most: u64, about: &'static str) -> Self {
        Self { name, most, ceiling: u64::MAX, about }
    }

    /// Of things that have an index of 32 bits.
    const fn count(name: &'static str, most: u64, about: &'static str) -> Self {
        Self { name, most, ceiling: u32::MAX as u64, about }
    }

    /// One that nobody sets.
    pub(crate) const fn fixed(most: u64) -> Self {
        Self { name: "", most, ceiling: most, about: "" }
    }

    /// As a length.
    pub(crate) fn len(self) -> usize {
        usize::try_from(self.most).unwrap_or(usize::MAX)
    }

    /// What is beyond it, and how to raise it.
    pub(crate) fn refusal(self, what: impl Display) -> String {
        let Self { name, .. } = self;
        match name {
            "" => what.to_string(),
            _ => format!("{what} (--limit {name}=N or limits={{\"{name}\": N}} raises this limit)"),
        }
    }
}

/// Its number.
impl Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.most.fmt(f)
    }
}

/// How much is taken in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "each says itself what it bounds, in `default`")]
pub struct Limits {
    pub file_bytes: Limit,
    pub scene_bytes: Limit,
    pub unpacked_bytes: Limit,
    pub included_bytes: Limit,
    pub mitsuba_includes: Limit,
    pub pbrt_includes: Limit,
    pub image_texels: Limit,
    pub mesh_elements: Limit,
    pub subdivided_faces: Limit,
    pub mitsuba_instances: Limit,
    pub pbrt_instances: Limit,
    pub xml_nodes: Limit,
    pub gltf_values: Limit,
    pub gltf_numbers: Limit,
    pub gltf_triangles: Limit,
    pub gltf_texels: Limit,
}

impl Default for Limits {
    fn default() -> Self {
        let (bytes, count) = (Limit::bytes, Limit::count);
        Self {
            file_bytes: bytes(
                "file_bytes",
                4 << 30,
                "bytes of a mesh, an image, a buffer, a `.gltf` or `.glb`",
            ),
            scene_bytes: bytes(
                "scene_bytes",
                256 << 20,
                "bytes of text: a Mitsuba or pbrt file (unpacked), a glTF file's JSON, a spectrum",
            ),
            unpacked_bytes: bytes(
                "unpacked_bytes",
                1 << 30,
                "bytes of a mesh that gzip has packed, unpacked",
            ),
            included_bytes: bytes("included_bytes", 1 << 30, "bytes of all texts that a pbrt file includes"),
            mitsuba_includes: count("mitsuba_includes", 256, "files that a Mitsuba file includes"),
            pbrt_includes: count("pbrt_includes", 4096, "files that a pbrt file includes"),
            image_texels: bytes("image_texels", 1 << 28, "texels of an image"),
            mesh_elements: count(
                "mesh_elements",
                1 << 28,
                "vertices of a mesh file, its triangles, and control points of a file of curves",
            ),
            subdivided_faces: Limit {
                // Every face has up to four corners.
                ceiling: 1 << 29,
                ..count("subdivided_faces", 1 << 20, "faces of all subdivided meshes")
            },
            mitsuba_instances: count(
                "mitsuba_instances",
                1 << 20,
                "instances of a Mitsuba file, those inside groups counted",
            ),
            pbrt_instances: count("pbrt_instances", 1 << 22, "instances of a pbrt file"),
            xml_nodes: count("xml_nodes", 16 << 20, "XML nodes of a Mitsuba file"),
            gltf_values: bytes("gltf_values", 1 << 23, "JSON values of a glTF file"),
            gltf_numbers: bytes("gltf_numbers", 1 << 28, "numbers that a glTF file's accessors read"),
            gltf_triangles: count("gltf_triangles", 1 << 27, "triangles that a glTF file places"),
            gltf_texels: bytes(
                "gltf_texels",
                1 << 29,
                "texels of a glTF file's images, and of what is made of them",
            ),
        }
    }
}

impl Limits {
    /// Sets one; the error is a sentence.
    pub fn set(&mut self, name: &str, most: u64) -> Result<(), String> {
        let Some(limit) = self.all_mut().into_iter().find(|limit| limit.name == name) else {
            let names = Self::default().all_mut().map(|limit| limit.name).join(", ");
            return Err(format!("there is no limit \"{name}\"; there are {names}"));
        };
        if most == 0 || most > limit.ceiling {
            return Err(format!("the limit {name} is from 1 to {}, not {most}", limit.ceiling));
        }
        limit.most = most;
        Ok(())
    }

    fn all_mut(&mut self) -> [&mut Limit; 16] {
        let Self {
            file_bytes,
            scene_bytes,
            unpacked_bytes,
            included_bytes,
            mitsuba_includes,
            pbrt_includes,
            image_texels,
            mesh_elements,
            subdivided_faces,
            mitsuba_instances,
            pbrt_instances,
            xml_nodes,
            gltf_values,
            gltf_numbers,
            gltf_triangles,
            gltf_texels,
        } = self;
        [
            file_bytes,
            scene_bytes,
            unpacked_bytes,
            included_bytes,
            mitsuba_includes,
            pbrt_includes,
            image_texels,
            mesh_elements,
            subdivided_faces,
            mitsuba_instances,
            pbrt_instances,
            xml_nodes,
            gltf_values,
            gltf_numbers,
            gltf_triangles,
            gltf_texels,
        ]
    }

    /// All of them with their defaults, as a table in Markdown.
    pub fn table() -> String {
        let lines = Self::default()
            .all_mut()
            .map(|limit| format!("| `{}` | {} | {} |", limit.name, short(limit.most), limit.about));
        format!("| limit | default | of |\n| --- | --- | --- |\n{}", lines.join("\n"))
    }
}

/// With the suffix that the command line takes.
fn short(number: u64) -> String {
    let suffix =
        [(30, "G"), (20, "M"), (10, "K")].into_iter().find(|(bits, _)| number.trailing_zeros() >= *bits);
    suffix.map_or(number.to_string(), |(bits, suffix)| format!("{}{suffix}", number >> bits))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_is_set_by_its_own_name() {
        let mut limits = Limits::default();
        let names = Limits::default().all_mut().map(|limit| limit.name);
        for (index, name) in names.into_iter().enumerate() {
            limits.set(name, index as u64 + 1).unwrap();
        }
        assert_eq!(limits.all_mut().map(|limit| limit.most), std::array::from_fn(|i| i as u64 + 1));
        assert_eq!((limits.file_bytes.most, limits.gltf_texels.most), (1, 16));
        assert_eq!(limits.all_mut().map(|limit| limit.name), names);
    }

    #[test]
    fn what_cannot_be_is_said() {
        let mut limits = Limits::default();
        let unknown = limits.set("texels", 1).unwrap_err();
        assert!(unknown.starts_with("there is no limit \"texels\"; there are file_bytes, "), "{unknown}");
        for value in [0, 1 << 32] {
            let error = limits.set("mesh_elements", value).unwrap_err();
            assert_eq!(error, format!("the limit mesh_elements is from 1 to 4294967295, not {value}"));
        }
        assert_eq!(limits, Limits::default());
    }
}
