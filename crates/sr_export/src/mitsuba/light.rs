//! Lights that are not shapes.

use glam::{Mat3, Mat4, Vec3};
use sr_render::light::Probe;
use sr_scene::{FovAxis, LightDesc, Rgb, Span, SphereMapping, SpotFalloff};

use super::Writer;
use super::xml::Xml;
use crate::directions;

impl Writer<'_> {
    pub(super) fn lights(&mut self, xml: &mut Xml) {
        for light in &self.scene.lights {
            self.light(xml, light);
        }
    }

    fn light(&mut self, xml: &mut Xml, light: &LightDesc) {
        let scene = self.scene;
        match light {
            LightDesc::Constant { radiance, .. } => {
                xml.begin("emitter", &[("type", "constant")]);
                xml.rgb("radiance", *radiance);
                xml.end();
            }
            LightDesc::Environment { .. } => self.environment(xml, light),
            LightDesc::Point { position, intensity, range, span } => {
                self.notes_on_range(*range, span);
                point(xml, *position, *intensity);
            }
            LightDesc::Directional { direction, irradiance, .. } => {
                xml.begin("emitter", &[("type", "directional")]);
                xml.vector("vector", "direction", *direction);
                xml.rgb("irradiance", *irradiance);
                xml.end();
            }
            LightDesc::Spot {
                world_from_light,
                intensity,
                cutoff_angle,
                beam_width,
                falloff,
                range,
                texture,
                span,
            } => {
                self.notes_on_range(*range, span);
                if *falloff == SpotFalloff::SquaredCosine && beam_width < cutoff_angle {
                    let message = "Mitsuba's spot lights fall off linearly with the angle";
                    self.notes.push("convert::light", span, message, "it does so within the same angles");
                }
                let texture = texture.and_then(|id| self.texture(id));
                xml.begin("emitter", &[("type", "spot")]);
                xml.rgb("intensity", *intensity);
                xml.float("cutoff_angle", cutoff_angle.to_degrees());
                xml.float("beam_width", beam_width.to_degrees());
                if let Some(texture) = texture {
                    xml.reference(Some("texture"), &texture);
                }
                xml.transform(*world_from_light);
                xml.end();
            }
            LightDesc::Projector { world_from_light, irradiance, scale, fov_axis, fov, .. } => {
                let irradiance = self.prepared(*irradiance);
                let axis = match fov_axis {
                    FovAxis::X => "x",
                    FovAxis::Y => "y",
                    FovAxis::Diagonal => "diagonal",
                    FovAxis::Smaller => "smaller",
                    FovAxis::Larger => "larger",
                };
                xml.begin("emitter", &[("type", "projector")]);
                irradiance.write(xml, "irradiance");
                xml.float("scale", *scale);
                xml.string("fov_axis", axis);
                xml.float("fov", fov.to_degrees());
                xml.transform(*world_from_light);
                xml.end();
            }
            LightDesc::Goniometric { world_from_light, intensity, image, mapping, span } => {
                if self.own("light \"goniometric\"", span, "a point of its mean intensity is written") {
                    let Some(image) = scene.images.get(*image as usize) else { return };
                    let file = self.files.image(image);
                    xml.begin("emitter", &[("type", "goniometric")]);
                    xml.string("filename", &file);
                    xml.string("mapping", mapping_name(*mapping));
                    xml.rgb("intensity", *intensity);
                    xml.transform(*world_from_light);
                    xml.end();
                } else {
                    self.mean_point(xml, light, world_from_light);
                }
            }
            LightDesc::Profile { world_from_light, intensity, profile, span } => {
                if self.own("measured light", span, "a point of its mean intensity is written") {
                    let text = ies(profile);
                    let file = self.files.bytes_in_folder("profile", &profile.name, "ies", text.into_bytes());
                    xml.begin("emitter", &[("type", "ies")]);
                    xml.string("filename", &file);
                    xml.rgb("intensity", *intensity);
                    xml.transform(*world_from_light);
                    xml.end();
                } else {
                    self.mean_point(xml, light, world_from_light);
                }
            }
            LightDesc::Sky { turbidity, albedo, sun_direction, scale, world_from_light, .. } => {
                xml.begin("emitter", &[("type", "sunsky")]);
                xml.rgb("albedo", *albedo);
                sky(xml, *turbidity, *sun_direction, *world_from_light);
                xml.float("sky_scale", *scale);
                xml.float("sun_scale", 0.0);
                xml.end();
            }
            LightDesc::Sun { turbidity, direction, scale, aperture, world_from_light, .. } => {
                xml.begin("emitter", &[("type", "sunsky")]);
                sky(xml, *turbidity, *direction, *world_from_light);
                xml.float("sky_scale", 0.0);
                xml.float("sun_scale", *scale);
                xml.float("sun_aperture", aperture.to_degrees());
                xml.end();
            }
        }
    }

    /// Mitsuba's lights have no range.
    fn notes_on_range(&mut self, range: f32, span: &Span) {
        if range.is_finite() {
            let message = "Mitsuba's lights have no range";
            self.notes.push("convert::light", span, message, "it falls off with the square of the distance");
        }
    }

    fn environment(&mut self, xml: &mut Xml, light: &LightDesc) {
        let LightDesc::Environment {
            image,
            mapping,
            scale,
            world_from_light,
            mis_compensation,
            portals,
            span,
        } = light
        else {
            return;
        };
        let Some(image) = self.scene.images.get(*image as usize) else { return };
        let is_octahedral = *mapping == SphereMapping::EqualAreaOctahedral;
        let (mut image, mut scale, mut frame) = (image.clone(), *scale, *world_from_light);
        let mut written = *mapping;
        let instead = "it is resampled by latitude and longitude";
        if is_octahedral && !self.own("octahedral environment map", span, instead) {
            let probe = Probe::new(light, self.scene, self.baker.textures());
            // Twice as wide: about as many texels.
            let height = directions::square_side(&image) * 3 / 4;
            written = SphereMapping::LatLong;
            image = directions::image(&image.name, (2 * height, height), written, |w| probe.radiance(w));
            (scale, frame) = (1.0, Mat3::IDENTITY);
        }
        let file = self.files.image(&image);
        xml.begin("emitter", &[("type", "envmap")]);
        xml.string("filename", &file);
        xml.float("scale", scale);
        if written != SphereMapping::LatLong {
            xml.string("mapping", mapping_name(written));
        }
        if *mis_compensation {
            xml.boolean("mis_compensation", true);
        }
        xml.transform(Mat4::from_mat3(frame));
        // Where light is looked for is nothing that a picture shows.
        for portal in portals.iter().filter(|_| self.own_plugins) {
            let [a, b] = portal.edges.map(|edge| 0.5 * edge);
            let normal = a.cross(b).normalize_or(Vec3::Z);
            let middle = portal.corner + a + b;
            xml.begin("shape", &[("type", "rectangle")]);
            xml.transform(Mat4::from_cols(
                a.extend(0.0),
                b.extend(0.0),
                normal.extend(0.0),
                middle.extend(1.0),
            ));
            xml.end();
        }
        xml.end();
    }

    /// A point that shines evenly, with the same power as a light has.
    fn mean_point(&mut self, xml: &mut Xml, light: &LightDesc, placement: &Mat4) {
        let position = placement.w_axis.truncate();
        point(xml, position, directions::mean_intensity(self.scene, &self.baker, light, position));
    }
}

fn point(xml: &mut Xml, position: Vec3, intensity: Rgb) {
    xml.begin("emitter", &[("type", "point")]);
    xml.vector("point", "position", position);
    xml.rgb("intensity", intensity);
    xml.end();
}

fn sky(xml: &mut Xml, turbidity: f32, sun_direction: Vec3, world_from_light: Mat3) {
    xml.float("turbidity", turbidity);
    xml.vector("vector", "sun_direction", world_from_light * sun_direction);
    xml.transform(Mat4::from_mat3(world_from_light));
}

fn mapping_name(mapping: SphereMapping) -> &'static str {
    match mapping {
        SphereMapping::LatLong => "latlong",
        SphereMapping::EqualAreaOctahedral => "octahedral",
    }
}

/// A measured luminaire as an IES file (LM-63-2002).
fn ies(profile: &sr_scene::IntensityProfile) -> String {
    let line = |values: &mut dyn Iterator<Item = f32>| {
        values.map(|v| v.to_string()).collect::<Vec<_>>().join("\n") + "\n"
    };
    let (vertical, horizontal) = (&profile.vertical, &profile.horizontal);
    // Whole degrees say how the rest is to be found: they are not missed by a rounding.
    let degrees = |angle: &f32| {
        let exact = f64::from(*angle).to_degrees();
        if (exact - exact.round()).abs() < 1e-4 { exact.round() as f32 } else { exact as f32 }
    };
    format!(
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 {} {} 1 2 0 0 0\n1 1 0\n{}{}{}",
        vertical.len(),
        horizontal.len(),
        line(&mut vertical.iter().map(degrees)),
        line(&mut horizontal.iter().map(degrees)),
        line(&mut profile.candelas.iter().copied()),
    )
}
