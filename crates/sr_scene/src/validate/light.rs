//! Lights that are not shapes.

use std::f32::consts::PI;

use glam::Vec3;

use super::{BRIGHTEST, Check, degrees, extent};
use crate::diagnostic::{Diagnostic, Span};
use crate::{IntensityProfile, LightDesc, MAX_PORTALS, Pixels, Portal, SphereMapping};

/// Of the sun's disk, in radians (0.01°): smaller, single precision does not tell its directions apart.
const SMALLEST_SUN: f32 = 1.745e-4;

impl Check<'_> {
    pub(super) fn light(&mut self, light: &LightDesc) {
        match light {
            LightDesc::Constant { radiance, span } => self.color(*radiance, "radiance", span),
            LightDesc::Environment { image, mapping, scale, world_from_light, portals, span, .. } => {
                self.sphere_image(*image, *mapping, span);
                self.scale(*scale, "an environment's scale", span);
                self.placement(world_from_light.determinant(), "the environment", span);
                portals.iter().for_each(|portal| self.portal(portal, span));
                if portals.len() > MAX_PORTALS {
                    let message = format!("{} portals; at most {MAX_PORTALS} are used", portals.len());
                    self.found.push(
                        Diagnostic::warning("scene::portal", span, message)
                            .consequence("what comes through the others is noisier"),
                    );
                }
            }
            LightDesc::Point { position, intensity, range, span } => {
                self.color(*intensity, "intensity", span);
                self.range(*range, span);
                self.position(*position, span);
            }
            LightDesc::Directional { direction, irradiance, span } => {
                self.color(*irradiance, "irradiance", span);
                if !direction.is_normalized() {
                    self.error("scene::direction", span, "the direction is not of unit length");
                }
            }
            LightDesc::Spot {
                world_from_light,
                intensity,
                cutoff_angle,
                beam_width,
                texture,
                range,
                span,
                ..
            } => {
                self.color(*intensity, "intensity", span);
                self.range(*range, span);
                if let Some(id) = texture {
                    self.texture_id(*id, span);
                }
                if !(*cutoff_angle > 0.0 && *cutoff_angle <= PI && (0.0..=*cutoff_angle).contains(beam_width))
                {
                    let (cutoff, beam) = (degrees(*cutoff_angle), degrees(*beam_width));
                    let message = format!(
                        "cutoff angle {cutoff}, beam width {beam}: 0 ≤ beam ≤ cutoff ≤ 180° is needed"
                    );
                    self.error("scene::spot", span, message);
                }
                self.placement(world_from_light.determinant(), "the spot light", span);
                self.position(world_from_light.w_axis.truncate(), span);
            }
            LightDesc::Projector { world_from_light, irradiance, scale, fov, span, .. } => {
                self.color_input(irradiance, "irradiance", span);
                self.scale(*scale, "a projector's scale", span);
                self.placement(world_from_light.determinant(), "the projector", span);
                self.position(world_from_light.w_axis.truncate(), span);
                self.field_of_view(*fov, span);
            }
            LightDesc::Goniometric { world_from_light, intensity, image, mapping, span } => {
                self.color(*intensity, "intensity", span);
                self.sphere_image(*image, *mapping, span);
                self.placement(world_from_light.determinant(), "the light", span);
                self.position(world_from_light.w_axis.truncate(), span);
            }
            LightDesc::Profile { world_from_light, intensity, profile, span } => {
                self.color(*intensity, "intensity", span);
                self.placement(world_from_light.determinant(), "the light", span);
                self.position(world_from_light.w_axis.truncate(), span);
                self.profile(profile, span);
            }
            LightDesc::Sky { turbidity, albedo, sun_direction, scale, world_from_light, span } => {
                self.color(*albedo, "albedo", span);
                if albedo.max_element() > 1.0 {
                    self.error("scene::bad-color", span, "the ground's albedo is above 1");
                }
                self.sky(*turbidity, *sun_direction, *scale, span);
                self.placement(world_from_light.determinant(), "the sky", span);
            }
            LightDesc::Sun { turbidity, direction, scale, aperture, world_from_light, span } => {
                self.sky(*turbidity, *direction, *scale, span);
                self.placement(world_from_light.determinant(), "the sun", span);
                if !(SMALLEST_SUN..PI).contains(aperture) {
                    let message = format!(
                        "the sun fills an angle of {}: at least {} and less than 180° is possible",
                        degrees(*aperture),
                        degrees(SMALLEST_SUN)
                    );
                    self.error("scene::sun", span, message);
                }
            }
        }
    }

    fn range(&mut self, range: f32, span: &Span) {
        if !(range > 0.0) {
            self.error("scene::range", span, format!("a light that shines {range} far"));
        }
    }

    fn scale(&mut self, scale: f32, what: &str, span: &Span) {
        if !(0.0..=BRIGHTEST).contains(&scale) {
            let message = format!("{what} of {scale}: 0 to {BRIGHTEST:e} is possible");
            self.error("scene::bad-color", span, message);
        }
    }

    fn position(&mut self, position: Vec3, span: &Span) {
        let farthest = extent::FARTHEST;
        if !(f64::from(position.abs().max_element()) <= farthest && position.is_finite()) {
            let message = format!("a light at {position}: coordinates up to {farthest:e} are possible");
            self.error("scene::extent", span, message);
        }
    }

    /// NaN and infinite entries make the determinant not finite.
    fn placement(&mut self, determinant: f32, what: &str, span: &Span) {
        if !determinant.is_finite() || determinant == 0.0 {
            self.error("scene::bad-transform", span, format!("{what}'s placement is not invertible"));
        }
    }

    /// An image of all directions, with what light cannot be.
    fn sphere_image(&mut self, index: u32, mapping: SphereMapping, span: &Span) {
        let Some(image) = self.scene.images.get(index as usize) else {
            self.error("scene::bad-id", span, format!("there is no image {index}"));
            return;
        };
        let (width, height) = (image.width, image.height);
        if mapping == SphereMapping::EqualAreaOctahedral && width != height {
            let message =
                format!("an octahedral map is square; {} has {width} × {height} texels", image.name);
            self.error("scene::bad-image", span, message);
        }
        let Pixels::F32 { channels, data } = &image.pixels else { return };
        let is_color = |i: usize| *channels < 4 || i % 4 != 3;
        if data.iter().enumerate().all(|(i, v)| !is_color(i) || *v == 0.0) {
            self.found.push(
                Diagnostic::warning("scene::black-image", span, format!("{} is all black", image.name))
                    .consequence("so is the light"),
            );
        }
        let bad =
            data.iter().enumerate().filter(|&(i, v)| is_color(i) && !(*v >= 0.0 && v.is_finite())).count();
        if bad > 0 {
            let message = format!("{bad} values of {} are negative, infinite or not numbers", image.name);
            self.found.push(
                Diagnostic::warning("scene::bad-radiance", span, message)
                    .consequence("infinite ones are very bright, the others black"),
            );
        }
    }

    fn portal(&mut self, Portal { corner, edges: [a, b] }: &Portal, span: &Span) {
        let lengths = a.length() * b.length();
        if !(corner.is_finite() && lengths > 0.0 && lengths.is_finite()) {
            self.error("scene::portal", span, "a portal has no area, or is not finite");
        } else if a.dot(*b).abs() > 1e-4 * lengths {
            self.error("scene::portal", span, "a portal has to be a rectangle");
        }
    }

    fn profile(&mut self, profile: &IntensityProfile, span: &Span) {
        let IntensityProfile { name, vertical, horizontal, candelas } = profile;
        let rises = |angles: &[f32], end: f32| {
            angles.windows(2).all(|pair| pair[0] < pair[1])
                && angles.iter().all(|a| (0.0..=end).contains(a))
                && !angles.is_empty()
        };
        if !rises(vertical, 1.00001 * PI) || !rises(horizontal, 2.00001 * PI) {
            self.error(
                "scene::profile",
                span,
                format!("the angles of {name} do not rise within their bounds"),
            );
        }
        if candelas.len() != vertical.len() * horizontal.len()
            || !candelas.iter().all(|c| *c >= 0.0 && c.is_finite())
        {
            self.error("scene::profile", span, format!("{name} lacks intensities, or some are negative"));
        } else if candelas.iter().all(|&c| c == 0.0) {
            self.found.push(
                Diagnostic::warning("scene::profile", span, format!("all intensities of {name} are 0"))
                    .consequence("the light is black"),
            );
        }
    }

    fn sky(&mut self, turbidity: f32, sun_direction: Vec3, scale: f32, span: &Span) {
        if !(1.0..=10.0).contains(&turbidity) {
            self.error("scene::sky", span, format!("a turbidity of {turbidity}: 1 to 10 is known"));
        }
        if !sun_direction.is_normalized() {
            self.error("scene::direction", span, "the direction of the sun is not of unit length");
        }
        self.scale(scale, "a scale of sky or sun", span);
    }
}
