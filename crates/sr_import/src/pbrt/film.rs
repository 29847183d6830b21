//! Films and pixel filters.

use sr_scene::{Crop, FilmDesc, FilterDesc};

use super::Reader;
use super::params::Params;
use super::support::{FILMS, FILTERS, unsupported};
use super::syntax::Kind;

/// What a film makes of light: pbrt's imaging ratio.
pub struct Exposure(pub f32);

impl Reader<'_> {
    /// `shutter`: for how long it is open.
    pub(super) fn film(
        &mut self,
        film: Option<(String, Params)>,
        filter: FilterDesc,
        shutter: f32,
    ) -> (FilmDesc, Exposure) {
        let mut desc = FilmDesc { width: 1280, height: 720, crop: None, filter, sample_border: true };
        let Some((kind, mut params)) = film else { return (desc, Exposure(1.0)) };
        if kind != "rgb" {
            let usual = "an RGB image is made";
            let note = unsupported(FILMS, "pbrt::unsupported-film", &params.span, "a film", &kind, usual);
            self.notes().push(note);
        }
        desc.width = self.size(&mut params, "xresolution", desc.width);
        desc.height = self.size(&mut params, "yresolution", desc.height);
        desc.crop = self.crop(&mut params, &desc);
        let exposure = self.exposure(&mut params, shutter);
        params.unsupported(&["maxcomponentvalue"], "no sample is made darker", &mut self.notes());
        // Where and how the file is written, and what a lens system alone depends on.
        params.ignore(&[
            "filename",
            "savefp16",
            "diagonal",
            "coordinatesystem",
            "nbuckets",
            "lambdamin",
            "lambdamax",
        ]);
        params.finish(&mut self.notes());
        (desc, Exposure(exposure))
    }

    fn size(&mut self, params: &mut Params, name: &'static str, default: u32) -> u32 {
        let Some(value) = params.integer(name) else { return default };
        u32::try_from(value).unwrap_or_else(|_| {
            let message = format!("\"{name}\" is {value}; 0 or more is possible");
            self.error("scene::film-size", &params.span, message);
            default
        })
    }

    /// `cropwindow` goes before `pixelbounds`; both are x from, x to, y from, y to.
    fn crop(&mut self, params: &mut Params, film: &FilmDesc) -> Option<Crop> {
        let size = [film.width, film.height];
        let bounds = params.take_integers("pixelbounds").map(|(span, v)| {
            let fits = |v: i32, limit: u32| i64::from(v).clamp(0, limit.into()) as u32;
            (span, v.iter().enumerate().map(|(i, &v)| fits(v, size[i / 2 % 2])).collect::<Vec<u32>>())
        });
        let window = params.take_floats("cropwindow", &[Kind::Float]).map(|(span, v)| {
            let pixel = |v: f32, of: u32| (v.clamp(0.0, 1.0) * of as f32).ceil() as u32;
            (span, v.iter().enumerate().map(|(i, &v)| pixel(v, size[i / 2 % 2])).collect())
        });
        let (span, edges) = window.or(bounds)?;
        let [x0, x1, y0, y1] = edges[..] else {
            let message = format!("a part of a film has 4 bounds, not {}", edges.len());
            self.warn("pbrt::bad-value", &span, message, "the whole film is rendered");
            return None;
        };
        let (x0, x1, y0, y1) = (x0.min(x1), x0.max(x1), y0.min(y1), y0.max(y1));
        Some(Crop { x: x0, y: y0, width: x1 - x0, height: y1 - y0 })
    }

    /// Time times ISO over 100.
    fn exposure(&mut self, params: &mut Params, shutter: f32) -> f32 {
        if params.string("sensor").is_some_and(|(_, name)| name != "cie1931") {
            let message = "the sensor of a camera is not supported";
            self.warn("pbrt::sensor", &params.span, message, "colors are those that the CIE's observer sees");
        }
        if params.float("whitebalance").is_some_and(|kelvin| kelvin != 0.0) {
            let message = "white balance is not supported";
            self.warn("pbrt::sensor", &params.span, message, "colors stay as they are");
        }
        let time = params.float("exposuretime").unwrap_or(shutter);
        let exposure = time * params.float("iso").unwrap_or(100.0) / 100.0;
        if exposure > 0.0 && exposure.is_finite() {
            return exposure;
        }
        let message = format!("an exposure of {exposure}");
        self.warn("pbrt::bad-value", &params.span, message, "1 is used");
        1.0
    }

    pub(super) fn filter(&mut self, filter: Option<(String, Params)>) -> FilterDesc {
        let usual = FilterDesc::Gaussian { stddev: 0.5, radius: 1.5 };
        let Some((kind, mut params)) = filter else { return usual };
        let filter = match &*kind {
            "box" => FilterDesc::Box { radius: self.radius(&mut params, 0.5) },
            "triangle" => FilterDesc::Tent { radius: self.radius(&mut params, 2.0) },
            "gaussian" => FilterDesc::Gaussian {
                stddev: params.float("sigma").unwrap_or(0.5),
                radius: self.radius(&mut params, 1.5),
            },
            "mitchell" => {
                let radius = self.radius(&mut params, 2.0);
                if radius != 2.0 {
                    let message = "a Mitchell filter of a radius other than 2 is not supported";
                    self.warn("pbrt::filter", &params.span, message, "the radius is 2");
                }
                let mut share = |name| params.float(name).unwrap_or(1.0 / 3.0);
                FilterDesc::Mitchell { b: share("B"), c: share("C") }
            }
            "sinc" => {
                let radius = self.radius(&mut params, 4.0);
                let tau = params.float("tau").unwrap_or(3.0);
                let lobes = (tau.round() as u32).max(1);
                if radius != tau || tau != lobes as f32 {
                    let message =
                        format!("a windowed sinc of radius {radius} and tau {tau} is not supported");
                    let consequence = format!("radius and tau are {lobes}");
                    self.warn("pbrt::filter", &params.span, message, &consequence);
                }
                FilterDesc::Lanczos { lobes }
            }
            _ => {
                params.use_all();
                let consequence = "a Gaussian is used";
                let note = unsupported(FILTERS, "pbrt::filter", &params.span, "a filter", &kind, consequence);
                self.notes().push(note);
                usual
            }
        };
        params.finish(&mut self.notes());
        filter
    }

    fn radius(&mut self, params: &mut Params, default: f32) -> f32 {
        let mut along = |name| params.float(name).unwrap_or(default);
        let (x, y) = (along("xradius"), along("yradius"));
        if x != y {
            let message = format!("a filter of the radii {x} and {y} is not supported");
            self.warn("pbrt::filter", &params.span, message, "the first one is used in both directions");
        }
        x
    }
}
