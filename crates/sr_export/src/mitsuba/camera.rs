//! The integrator, the sensor and its film.

use sr_scene::{FilterDesc, FovAxis, Projection};

use super::Writer;
use super::xml::Xml;

impl Writer<'_> {
    pub(super) fn integrator(&mut self, xml: &mut Xml) {
        let settings = &self.scene.settings;
        let edges = |depth: Option<u32>, none: i64| depth.map_or(none, i64::from);
        xml.begin("integrator", &[("type", "path")]);
        xml.integer("max_depth", edges(settings.max_depth, -1));
        // Roulette that never begins begins late.
        xml.integer("rr_depth", edges(settings.roulette_depth, i32::MAX.into()));
        if settings.hide_emitters {
            xml.boolean("hide_emitters", true);
        }
        xml.end();
    }

    pub(super) fn sensor(&mut self, xml: &mut Xml) {
        let camera = &self.scene.camera;
        let (kind, projection) = match camera.projection {
            Projection::Perspective { lens: Some(_), .. } => ("thinlens", camera.projection),
            Projection::Perspective { lens: None, .. } => ("perspective", camera.projection),
            Projection::Orthographic => ("orthographic", camera.projection),
            Projection::Spherical => {
                let instead = "a perspective camera of 90° that looks along its middle is written";
                match self.own("camera that sees all around", &camera.span, instead) {
                    true => ("spherical", camera.projection),
                    false => (
                        "perspective",
                        Projection::Perspective {
                            fov_axis: FovAxis::X,
                            fov: std::f32::consts::FRAC_PI_2,
                            principal_point_offset: glam::Vec2::ZERO,
                            lens: None,
                        },
                    ),
                }
            }
        };
        xml.begin("sensor", &[("type", kind)]);
        if let Projection::Perspective { fov_axis, fov, principal_point_offset: offset, lens } = projection {
            let axis = match fov_axis {
                FovAxis::X => "x",
                FovAxis::Y => "y",
                FovAxis::Diagonal => "diagonal",
                FovAxis::Smaller => "smaller",
                FovAxis::Larger => "larger",
            };
            xml.string("fov_axis", axis);
            xml.float("fov", fov.to_degrees());
            if offset.x != 0.0 || offset.y != 0.0 {
                xml.float("principal_point_offset_x", offset.x);
                xml.float("principal_point_offset_y", offset.y);
            }
            if let Some(lens) = lens {
                xml.float("aperture_radius", lens.aperture_radius);
                xml.float("focus_distance", lens.focus_distance);
                if lens.blades > 0 && self.own("lens with blades", &camera.span, "a round one is written") {
                    xml.integer("blades", lens.blades.into());
                    xml.float("blade_rotation", lens.blade_rotation.to_degrees());
                }
            }
        }
        xml.float("near_clip", camera.near_clip);
        xml.float("far_clip", camera.far_clip);
        xml.transform(camera.world_from_camera);
        xml.begin("sampler", &[("type", "independent")]);
        xml.integer("sample_count", self.scene.settings.spp.into());
        xml.end();
        self.film(xml);
        xml.end();
    }

    fn film(&mut self, xml: &mut Xml) {
        let film = &self.scene.camera.film;
        xml.begin("film", &[("type", "hdrfilm")]);
        xml.integer("width", film.width.into());
        xml.integer("height", film.height.into());
        if let Some(crop) = film.crop {
            xml.integer("crop_offset_x", crop.x.into());
            xml.integer("crop_offset_y", crop.y.into());
            xml.integer("crop_width", crop.width.into());
            xml.integer("crop_height", crop.height.into());
        }
        if film.sample_border {
            xml.boolean("sample_border", true);
        }
        self.filter(xml, film.filter);
        xml.end();
    }

    fn filter(&mut self, xml: &mut Xml, filter: FilterDesc) {
        let span = &self.scene.camera.span;
        let mut filter = filter;
        if let FilterDesc::BlackmanHarris { radius } = filter {
            // Of the same variance.
            let stddev = (220.0 * radius).round() / 1000.0;
            let instead = format!("a Gaussian of standard deviation {stddev} is written");
            if !self.own("filter \"blackmanharris\"", span, &instead) {
                filter = FilterDesc::Gaussian { stddev, radius: 4.0 * stddev };
            }
        }
        xml.begin("rfilter", &[("type", filter.name())]);
        match filter {
            FilterDesc::Box { radius } => {
                if radius != 0.5 {
                    xml.float("radius", radius);
                }
            }
            FilterDesc::Tent { radius } | FilterDesc::BlackmanHarris { radius } => {
                xml.float("radius", radius)
            }
            FilterDesc::Gaussian { stddev, radius } => {
                if (radius / stddev - 4.0).abs() > 1e-3 {
                    self.notes.push(
                        "convert::filter",
                        span,
                        format!("a Gaussian filter that is cut at {radius} pixels"),
                        "Mitsuba cuts it at four standard deviations",
                    );
                }
                xml.float("stddev", stddev);
            }
            FilterDesc::Mitchell { b, c } => {
                xml.float("b", b);
                xml.float("c", c);
            }
            FilterDesc::CatmullRom => {}
            FilterDesc::Lanczos { lobes } => xml.integer("lobes", lobes.into()),
        }
        xml.end();
    }
}
