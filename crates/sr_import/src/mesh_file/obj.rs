//! OBJ: a shape for each material, in the order in which the file uses them.

use std::collections::HashMap;
use std::path::Path;

use glam::Vec3;
use sr_scene::{ColorInput, Diagnostic, MeshColorOf, MeshDesc, TextureDesc};

use super::mtl::{self, Mtl};
use super::{GREY, MeshScene, as_it_is};
use crate::files;
use crate::limits::{Limit, Limits};
use crate::mesh::{normals, obj};
use crate::values::shown;

/// More bytes of materials are refused, in all files together.
const MAX_MTL_BYTES: u64 = 64 << 20;

/// More files of materials are not read.
const MAX_LIBRARIES: usize = 256;

impl MeshScene<'_, '_> {
    pub(super) fn obj(&mut self) -> Result<(), String> {
        let Limits { file_bytes, unpacked_bytes, mesh_elements, .. } = self.out.limits;
        let bytes = files::read(self.path, file_bytes)?;
        let mut file = obj::parse_covered(&files::unpacked(bytes, unpacked_bytes)?, mesh_elements)?;
        if file.some_colors {
            let message = "some vertices have colors and some have none";
            let warning = Diagnostic::warning("obj::vertex-colors", &self.span, message);
            self.out.d.push(warning.consequence("no color of a vertex is shown"));
        }
        if let Some((word, line)) = &file.left_out {
            let message = format!("line {line}: \"{}\" is not read, nor what is like it", shown(word));
            let warning = Diagnostic::warning("obj::statement", &self.span, message);
            self.out.d.push(warning.consequence("polygons and their materials are shown"));
        }
        if file.has_flat && file.mesh.normals.is_empty() {
            let message = "smoothing groups are not read, and the file has no normals";
            let warning = Diagnostic::warning("obj::smoothing", &self.span, message);
            self.out.d.push(warning.consequence("all of it is smooth"));
        }
        let known = self.libraries(&file.libraries);
        let parts = parts(file.mesh.triangles.len(), &file.uses, file.materials.len());
        fill_normals(&mut file.mesh);
        let colors = file.mesh.vertex_colors.iter().all(|c| *c == Vec3::ZERO);
        let grey = match colors {
            true => ColorInput::Constant(GREY),
            false => {
                let (of, span) = (MeshColorOf::Vertices, self.span.clone());
                self.out.add_texture(TextureDesc::MeshColor { of, scale: 1.0, span })
            }
        };
        let mut bare = None;
        for (index, ranges) in parts.iter().enumerate().filter(|(_, ranges)| !ranges.is_empty()) {
            let name = file.materials.get(index).map_or("", String::as_str);
            let (material, emission) = match known.get(name) {
                Some(mtl) => self.cover(mtl),
                None => {
                    if !name.is_empty() {
                        self.unknown(name, &known);
                    }
                    (*bare.get_or_insert_with(|| self.diffuse(grey)), None)
                }
            };
            let mut mesh = cut(&file.mesh, ranges);
            mesh.name = format!("{} {}", self.path.display(), shown(name)).trim_end().to_owned();
            self.add(mesh, material, emission, as_it_is());
        }
        if parts.iter().all(Vec::is_empty) {
            return Err("it has no faces".into());
        }
        Ok(())
    }

    /// The materials of all libraries.
    fn libraries(&mut self, names: &[String]) -> HashMap<String, Mtl> {
        let mut known = HashMap::new();
        let mut left = MAX_MTL_BYTES;
        let mut done: Vec<&str> = Vec::new();
        for name in names {
            if done.contains(&name.as_str()) {
                continue;
            }
            if done.len() >= MAX_LIBRARIES {
                let message = format!(
                    "more than {MAX_LIBRARIES} files of materials are named, \"{}\" after these",
                    shown(name)
                );
                let warning = Diagnostic::warning("obj::no-library", &self.span, message);
                self.out.d.push(
                    warning.consequence("it is not read, nor what follows; what they would cover is grey"),
                );
                break;
            }
            done.push(name);
            let path = self.out.find(&name.replace('\\', "/"));
            match files::read(&path, Limit::fixed(left)) {
                Ok(bytes) => {
                    left -= bytes.len() as u64;
                    let text = String::from_utf8_lossy(&bytes).into_owned();
                    let source = self.out.d.sources.add(path.display().to_string(), text.as_str());
                    // Images lie beside the file that names them.
                    let directory = path.parent().unwrap_or(Path::new("")).to_owned();
                    if !self.out.directories.contains(&directory) {
                        self.out.directories.push(directory);
                    }
                    for (name, material) in mtl::parse(&text, source, self.out.d) {
                        known.entry(name).or_insert(material);
                    }
                }
                Err(reason) => {
                    let message = format!("cannot read the materials {}: {reason}", path.display());
                    let warning = Diagnostic::warning("obj::no-library", &self.span, message);
                    self.out.d.push(warning.consequence("what they would cover is grey"));
                }
            }
        }
        known
    }

    fn unknown(&mut self, name: &str, known: &HashMap<String, Mtl>) {
        let message = format!("there is no material \"{}\"", shown(name));
        let warning = Diagnostic::warning("obj::no-material", &self.span, message);
        let warning = warning.guess(name, known.keys().map(String::as_str));
        self.out.d.push(warning.consequence("what it would cover is grey"));
    }
}

/// Which triangles, as ranges, each material covers; those before the first use come last, without a material.
fn parts(triangles: usize, uses: &[(usize, usize)], materials: usize) -> Vec<Vec<(usize, usize)>> {
    let mut parts = vec![Vec::new(); materials + 1];
    let ends = uses.iter().skip(1).map(|(start, _)| *start).chain([triangles]);
    let first = uses.first().map_or(triangles, |(start, _)| *start);
    let ranges = uses.iter().zip(ends).map(|(&(start, material), end)| (start, end, material));
    for (start, end, material) in ranges.chain([(0, first, materials)]) {
        if end > start
            && let Some(part) = parts.get_mut(material)
        {
            part.push((start, end));
        }
    }
    parts
}

/// Makes normals where there are none, from all faces: where materials meet, the surface stays smooth.
fn fill_normals(mesh: &mut MeshDesc) {
    if !mesh.normals.is_empty() && mesh.normals.iter().all(|n| *n != Vec3::ZERO) {
        return;
    }
    let smooth = normals::smooth(&mesh.positions, &mesh.triangles);
    if mesh.normals.is_empty() {
        mesh.normals = smooth;
    } else {
        mesh.normals.iter_mut().zip(smooth).filter(|(n, _)| **n == Vec3::ZERO).for_each(|(n, s)| *n = s);
    }
}

/// Some of a mesh's triangles, and the vertices that these have.
fn cut(whole: &MeshDesc, ranges: &[(usize, usize)]) -> MeshDesc {
    let mut mesh = MeshDesc::default();
    let mut known: HashMap<u32, u32> = HashMap::new();
    for triangle in ranges.iter().filter_map(|&(start, end)| whole.triangles.get(start..end)).flatten() {
        mesh.triangles.push(triangle.map(|vertex| {
            *known.entry(vertex).or_insert_with(|| {
                let at = vertex as usize;
                mesh.positions.push(whole.positions[at]);
                mesh.normals.extend(whole.normals.get(at));
                mesh.uvs.extend(whole.uvs.get(at));
                mesh.vertex_colors.extend(whole.vertex_colors.get(at));
                mesh.positions.len() as u32 - 1
            })
        }));
    }
    mesh
}
