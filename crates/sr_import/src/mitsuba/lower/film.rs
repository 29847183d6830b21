//! Films and pixel filters.

use std::ops::RangeInclusive;

use sr_scene::{Crop, Diagnostic, FilmDesc, FilterDesc, MAX_FILM_PIXELS};

use super::Lowering;
use crate::assembly::default_film;
use crate::mitsuba::node::Node;
use crate::mitsuba::plugins;
use crate::mitsuba::props::Props;

/// Mitsuba's default filter, cut at four standard deviations.
const DEFAULT_FILTER: FilterDesc = FilterDesc::Gaussian { stddev: 0.5, radius: 2.0 };

impl<'a> Lowering<'a, '_> {
    pub(super) fn film(&mut self, props: &mut Props<'a>) -> FilmDesc {
        let mut film = default_film();
        let [node, ..] = self.nested(props, "film")[..] else { return film };
        let mut props = Props::new(node);
        let is_read = plugins::is_read("film", &node.kind);
        if !is_read {
            self.unknown_plugin(node, "its size and filter are used, the rest is ignored");
        }
        film.width = self.count(&mut props, node, "width", film.width);
        film.height = self.count(&mut props, node, "height", film.height);
        film.sample_border = props
            .boolean("sample_border", self.out.d)
            .or(props.boolean("high_quality_edges", self.out.d))
            .unwrap_or(false);
        film.crop = self.crop(&mut props, node, &film);
        props.unsupported(&["size"], "the whole film is rendered", self.out.d);
        // How a file is written is decided when it is written.
        props.ignore(&[
            "banner",
            "pixel_format",
            "component_format",
            "file_format",
            "compensate",
            "attach_log",
            "gamma",
            "exposure",
            "tonemap_method",
            "key",
            "burn",
        ]);
        let filters = self.nested(&mut props, "rfilter");
        if let [filter, more @ ..] = &filters[..] {
            film.filter = self.filter(filter);
            if let [second, ..] = more {
                self.out.d.push(
                    Diagnostic::warning("mitsuba::wrong-nesting", &second.span, "a film has one rfilter")
                        .consequence("the first one is used"),
                );
            }
        }
        if !is_read {
            props.use_all();
        }
        props.finish(self.out.d);
        film
    }

    fn crop(&mut self, props: &mut Props<'a>, node: &Node, film: &FilmDesc) -> Option<Crop> {
        let is_given = ["crop_width", "crop_height", "crop_offset_x", "crop_offset_y"];
        let is_given = is_given.into_iter().any(|name| props.has(name));
        let x = self.count(props, node, "crop_offset_x", 0);
        let y = self.count(props, node, "crop_offset_y", 0);
        let width = self.count(props, node, "crop_width", film.width.saturating_sub(x));
        let height = self.count(props, node, "crop_height", film.height.saturating_sub(y));
        is_given.then_some(Crop { x, y, width, height })
    }

    /// A number of something, at least 0.
    pub(super) fn count(
        &mut self,
        props: &mut Props<'a>,
        node: &Node,
        name: &'static str,
        default: u32,
    ) -> u32 {
        let Some(count) = props.integer(name, self.out.d) else { return default };
        u32::try_from(count).unwrap_or_else(|_| {
            let (code, limit) = match node.class.as_str() {
                "film" => ("scene::film-size", MAX_FILM_PIXELS),
                _ => ("mitsuba::bad-value", u32::MAX.into()),
            };
            let message = format!("\"{name}\" is {count}; 0 to {limit} is possible");
            self.out.d.push(Diagnostic::error(code, &node.span, message));
            default
        })
    }

    /// The value, or the nearest that is possible after an error.
    pub(super) fn in_range(
        &mut self,
        name: &str,
        value: f64,
        possible: RangeInclusive<f64>,
        node: &Node,
    ) -> f64 {
        if !possible.contains(&value) {
            let (low, high) = (possible.start(), possible.end());
            let message = format!("\"{name}\" of {} is {value}; {low} to {high} is possible", node.title());
            self.out.d.push(Diagnostic::error("mitsuba::bad-value", &node.span, message));
        }
        value.clamp(*possible.start(), *possible.end())
    }

    fn filter(&mut self, node: &'a Node) -> FilterDesc {
        let mut props = Props::new(node);
        let filter = match node.kind.as_str() {
            "box" => FilterDesc::Box { radius: props.float("radius", self.out.d).unwrap_or(0.5) },
            "tent" => FilterDesc::Tent { radius: props.float("radius", self.out.d).unwrap_or(1.0) },
            "gaussian" => {
                let stddev = props.float("stddev", self.out.d).unwrap_or(0.5);
                FilterDesc::Gaussian { stddev, radius: 4.0 * stddev }
            }
            "mitchell" => FilterDesc::Mitchell {
                b: props.float("b", self.out.d).unwrap_or(1.0 / 3.0),
                c: props.float("c", self.out.d).unwrap_or(1.0 / 3.0),
            },
            "catmullrom" => FilterDesc::CatmullRom,
            "lanczos" => FilterDesc::Lanczos { lobes: self.count(&mut props, node, "lobes", 3) },
            "blackmanharris" => {
                FilterDesc::BlackmanHarris { radius: props.float("radius", self.out.d).unwrap_or(1.5) }
            }
            _ => {
                self.unknown_plugin(node, "a Gaussian of standard deviation 0.5 pixels is used");
                props.use_all();
                DEFAULT_FILTER
            }
        };
        props.finish(self.out.d);
        filter
    }
}
