//! STL: one grey shape, its edges sharp where its facets meet at more than thirty degrees. Z is up, as in the programs
//! that write it.

use std::f64::consts::FRAC_PI_2;

use glam::DMat4;
use sr_scene::{ColorInput, Diagnostic};

use super::{GREY, MeshScene, as_it_is};
use crate::files;
use crate::limits::Limits;
use crate::mesh::{Placement, stl};

/// Facets that meet at less than this are one smooth surface, in degrees.
const SMOOTH_DEG: f32 = 30.0;

impl MeshScene<'_, '_> {
    pub(super) fn stl(&mut self) -> Result<(), String> {
        let Limits { file_bytes, unpacked_bytes, mesh_elements, .. } = self.out.limits;
        let bytes = files::read(self.path, file_bytes)?;
        let stl::Stl { mesh, notes } = stl::parse(&files::unpacked(bytes, unpacked_bytes)?, mesh_elements)?;
        for (message, consequence) in notes {
            let message = format!("{}: {message}", self.path.display());
            self.out.d.push(Diagnostic::warning("stl::header", &self.span, message).consequence(consequence));
        }
        let material = self.diffuse(ColorInput::Constant(GREY));
        let placement = Placement {
            to_world: DMat4::from_rotation_x(-FRAC_PI_2),
            max_smooth_angle: Some(SMOOTH_DEG.to_radians()),
            ..as_it_is()
        };
        self.add(mesh, material, None, placement);
        Ok(())
    }
}
