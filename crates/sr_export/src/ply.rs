//! Meshes as binary PLY files.

use std::io::{self, Write};

use sr_scene::MeshDesc;

/// Writes a mesh: what it has of normals, texture coordinates (u, v) and colors.
pub fn write(mesh: &MeshDesc, out: &mut impl Write) -> io::Result<()> {
    let columns: [(&[&str], bool); 4] = [
        (&["x", "y", "z"], true),
        (&["nx", "ny", "nz"], !mesh.normals.is_empty()),
        (&["u", "v"], !mesh.uvs.is_empty()),
        (&["r", "g", "b"], !mesh.vertex_colors.is_empty()),
    ];
    let mut header =
        format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", mesh.positions.len());
    for name in columns.iter().filter(|(_, is_there)| *is_there).flat_map(|(names, _)| *names) {
        header.push_str(&format!("property float {name}\n"));
    }
    header.push_str(&format!(
        "element face {}\nproperty list uchar int vertex_indices\n",
        mesh.triangles.len()
    ));
    if !mesh.face_colors.is_empty() {
        header.push_str("property float r\nproperty float g\nproperty float b\n");
    }
    header.push_str("end_header\n");
    out.write_all(header.as_bytes())?;
    let write_floats = |out: &mut dyn Write, values: &[f32]| -> io::Result<()> {
        values.iter().try_for_each(|v| out.write_all(&v.to_le_bytes()))
    };
    for (i, position) in mesh.positions.iter().enumerate() {
        write_floats(out, &position.to_array())?;
        if let Some(normal) = mesh.normals.get(i) {
            write_floats(out, &normal.to_array())?;
        }
        if let Some(uv) = mesh.uvs.get(i) {
            write_floats(out, &uv.to_array())?;
        }
        if let Some(color) = mesh.vertex_colors.get(i) {
            write_floats(out, &color.to_array())?;
        }
    }
    for (i, triangle) in mesh.triangles.iter().enumerate() {
        out.write_all(&[3])?;
        triangle.iter().try_for_each(|corner| out.write_all(&corner.to_le_bytes()))?;
        if let Some(color) = mesh.face_colors.get(i) {
            write_floats(out, &color.to_array())?;
        }
    }
    Ok(())
}
