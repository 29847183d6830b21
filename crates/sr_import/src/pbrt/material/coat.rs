//! What pbrt's coats take away: they absorb, and light bounces below them a few times only.
//!
//! A coat of pbrt has `thickness` (0.01 by default) times the extinction 1, also where nothing scatters in it, and
//! `maxdepth` passages through it; and what bounces below it has a spectrum. Ours are clear, light bounces until it
//! leaves, and has a color: the base gets the albedo with which both reflect the same on average.

use sr_bsdf::interface::diffuse_reflectance;
use sr_bsdf::{MicrofacetKind, RoughCoat, rough_internal_reflectance};
use sr_scene::{ColorInput, Rgb, TextureDesc};

use super::{FloatTexture, GREY, Params, Reader};
use crate::images::BelowCoat;

/// A layer of pbrt's.
#[derive(Clone, Copy, Debug)]
pub struct Layer {
    /// Over that of its surroundings.
    eta: f32,
    /// Thickness times extinction.
    depth: f32,
    /// How often light meets the base.
    meetings: i32,
}

impl Layer {
    /// What is left of light that crosses it once each way: the mean over directions outside, bent.
    pub fn transmittance(&self) -> f32 {
        let eta2 = self.eta * self.eta;
        let path = 2.0 * eta2 * (1.0 - (1.0 - 1.0 / eta2).max(0.0).sqrt());
        (-2.0 * self.depth * path).exp()
    }

    /// How often light meets the base, in the range of materials.
    pub fn meetings(&self) -> u32 {
        self.meetings.clamp(1, sr_bsdf::MAX_BOUNCES_BELOW_COAT as i32) as u32
    }

    /// The base below this coat, if its surface has the roughness `alpha`; `None` is smooth.
    fn base(&self, alpha: Option<f32>) -> BelowCoat {
        /// As good as smooth.
        const NEARLY_SMOOTH: f32 = 1e-4;
        const GGX: MicrofacetKind = MicrofacetKind::GgxCorrelated;
        let returned =
            |depth| rough_internal_reflectance(GGX, alpha.unwrap_or(NEARLY_SMOOTH), self.eta, depth);
        let (returned, ours) = match alpha {
            None => {
                let clear = diffuse_reflectance(1.0 / self.eta);
                let kept =
                    if self.depth > 0.0 { returned(self.depth) / returned(0.0).max(1e-6) } else { 1.0 };
                (clear * kept, clear)
            }
            Some(alpha) => {
                let ours = RoughCoat::new(GGX, alpha, self.eta).internal_reflectance();
                (returned(self.depth), ours)
            }
        };
        BelowCoat { through: self.transmittance(), returned, returned_clear: ours, meetings: self.meetings }
    }
}

impl Reader<'_> {
    /// The index of a coat, at least 1.
    pub(super) fn coat_eta(&mut self, params: &mut Params, name: &'static str) -> f32 {
        let eta = self.eta(params, name, 1.5);
        if eta < 1.0 {
            let message = format!("an index of {eta} of a coat is below 1");
            self.warn("pbrt::bad-value", &params.span, message, "1 is used");
        }
        eta.max(1.0)
    }

    /// The coat that a material describes.
    pub(super) fn layer(&mut self, params: &mut Params, eta: f32) -> Layer {
        let depth = match self.float_or_texture(params, "thickness") {
            None => 0.01,
            Some(FloatTexture::Constant(thickness)) => {
                if thickness < 0.0 {
                    let message = format!("a \"thickness\" of {thickness} of {}", params.title);
                    self.warn("pbrt::bad-value", &params.span, message, "0 is used");
                }
                thickness.max(0.0)
            }
            Some(_) => {
                let message = format!("\"thickness\" of {} cannot be a texture", params.title);
                self.warn("pbrt::texture-not-possible", &params.span, message, "0.01 is used");
                0.01
            }
        };
        let passages = params.integer("maxdepth").unwrap_or(10);
        if passages < 1 {
            let message = format!("a \"maxdepth\" of {passages} of {}", params.title);
            self.warn("pbrt::bad-value", &params.span, message, "light crosses the coat and comes back once");
        }
        let meetings = passages.clamp(1, 1000);
        params.ignore(&["nsamples"]);
        params.unsupported(&["albedo", "g"], "nothing scatters inside the coat", &mut self.notes());
        params.unsupported(&["twosided"], "both sides are coated", &mut self.notes());
        Layer { eta, depth, meetings: (meetings + 1) / 2 }
    }

    /// Says that a coat that is not smooth, or lies on metal, is not walked through as in pbrt.
    pub(super) fn note_layers(&mut self, params: &Params) {
        let message = "pbrt walks at random through this coat, and weighs some of its walks by a density that is not theirs";
        self.note("pbrt::layers", &params.span, message, "the sums are used: 2 to 15 % darker than in pbrt");
    }

    /// What the base reflects below a clear coat of roughness `alpha`; `None` is smooth.
    pub(super) fn base_albedo(
        &mut self,
        params: &mut Params,
        layer: Layer,
        alpha: Option<f32>,
    ) -> ColorInput {
        let base = layer.base(alpha);
        let clear = |albedo: Rgb| base.clear_albedo(albedo.as_dvec3()).as_vec3();
        if let Some(image) = self.image_below_coat(params, "reflectance", base) {
            return image;
        }
        match self.albedo(params, "reflectance", GREY) {
            ColorInput::Constant(color) => ColorInput::Constant(clear(color)),
            // As for a middle grey.
            input => {
                let factor = ColorInput::Constant(clear(GREY) / GREY);
                self.out.add_texture(TextureDesc::Scale { input, factor, span: params.span.clone() })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clear_layers_of_many_bounces_change_nothing_and_others_darken() {
        let base = |depth, meetings| Layer { eta: 1.5, depth, meetings }.base(None);
        let albedo = glam::DVec3::new(0.0, 0.5, 0.9);
        let grey = glam::DVec3::splat(0.7);
        assert!((base(0.0, 500).clear_albedo(grey) - grey).abs().max_element() < 1e-5);
        for other in [base(0.01, 500), base(0.0, 5)] {
            let darker = other.clear_albedo(grey);
            assert!(darker.max_element() < 0.7 && darker.min_element() > 0.65, "{darker}");
            assert!((other.clear_albedo(albedo) - albedo).abs().max_element() < 0.05);
        }
    }

    /// By a walk of two million paths through pbrt's layers (thickness 0.01, ten passages), of light that comes along the normal:
    /// what such a base adds to the coat's reflection.
    #[test]
    fn bases_reflect_as_much_as_walks_below_coats() {
        for (alpha, albedo, reflected) in [
            (None, 0.9, 0.6735),
            (None, 0.2, 0.0856),
            (Some(0.1), 1.0, 0.7813),
            (Some(0.1), 0.5, 0.2595),
            (Some(0.4), 1.0, 0.5565),
            (Some(0.4), 0.2, 0.0791),
        ] {
            let base = Layer { eta: 1.5, depth: 0.01, meetings: 5 }.base(alpha);
            let clear = base.clear_albedo(glam::DVec3::splat(albedo)).x;
            let passes = f64::from(match alpha {
                None => 0.96,
                Some(alpha) => RoughCoat::new(MicrofacetKind::GgxCorrelated, alpha, 1.5).transmittance(1.0),
            });
            // What enters along the normal leaves in all directions.
            let mean = 1.0 - f64::from(diffuse_reflectance(1.5));
            let leaves = match alpha {
                None => mean / 2.25,
                Some(alpha) => {
                    let tables = RoughCoat::new(MicrofacetKind::GgxCorrelated, alpha, 1.5);
                    let cosines = (0..256).map(|i| ((i as f32 + 0.5) / 256.0).sqrt());
                    cosines.map(|cos| f64::from(tables.transmittance(cos))).sum::<f64>() / 256.0 / 2.25
                }
            };
            let got = passes * leaves * clear / (1.0 - clear * f64::from(base.returned_clear));
            assert!((got / reflected - 1.0).abs() < 0.01, "{alpha:?} {albedo}: {got}, not {reflected}");
        }
    }
}
