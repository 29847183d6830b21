//! What pbrt's coats take away: they absorb, and light bounces below them a few times only.
//!
//! A coat of pbrt has `thickness` (0.01 by default) times the extinction 1, also where nothing scatters in it, and
//! `maxdepth` passages through it. Ours are clear, and light bounces until it leaves: the base gets the albedo with which
//! both reflect the same on average.

use sr_scene::{ColorInput, Rgb, TextureDesc};

use super::{FloatTexture, GREY, Params, Reader};

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

    /// Of diffuse light from the base, how much returns to it.
    fn returned(&self, depth: f32) -> f32 {
        /// Cosines at which it is summed up.
        const STEPS: usize = 512;
        let cosines = (0..STEPS).map(|i| (i as f32 + 0.5) / STEPS as f32);
        let sum: f32 =
            cosines.map(|cos| 2.0 * cos * reflectance(cos, self.eta) * (-2.0 * depth / cos).exp()).sum();
        sum / STEPS as f32
    }

    /// The albedo below a clear coat that comes to the same as `albedo` below this one.
    fn clear_albedo(&self, albedo: Rgb) -> Rgb {
        let (through, returned, clear) =
            (self.transmittance(), self.returned(self.depth), self.returned(0.0));
        albedo.map(|a| {
            let left = a * returned;
            let sum = through * a * (1.0 - left.powi(self.meetings)) / (1.0 - left);
            sum / (1.0 + sum * clear)
        })
    }
}

/// What an interface reflects of unpolarised light from the side of index `eta`, at least 1.
fn reflectance(cos: f32, eta: f32) -> f32 {
    let sin2_outside = eta * eta * (1.0 - cos * cos);
    if sin2_outside >= 1.0 {
        return 1.0;
    }
    let cos_outside = (1.0 - sin2_outside).sqrt();
    let across = (eta * cos - cos_outside) / (eta * cos + cos_outside);
    let along = (cos - eta * cos_outside) / (cos + eta * cos_outside);
    0.5 * (across * across + along * along)
}

impl Reader<'_> {
    /// The coat that a material describes.
    pub(super) fn layer(&mut self, params: &mut Params, eta: f32) -> Layer {
        let depth = match self.float_or_texture(params, "thickness") {
            None => 0.01,
            Some(FloatTexture::Constant(thickness)) => thickness.max(0.0),
            Some(_) => {
                let message = format!("\"thickness\" of {} cannot be a texture", params.title);
                self.warn("pbrt::texture-not-possible", &params.span, message, "0.01 is used");
                0.01
            }
        };
        let meetings = params.integer("maxdepth").unwrap_or(10).clamp(1, 1000);
        params.ignore(&["nsamples"]);
        params.unsupported(&["albedo", "g"], "nothing scatters inside the coat", &mut self.notes());
        params.unsupported(&["twosided"], "both sides are coated", &mut self.notes());
        Layer { eta: eta.max(1.0), depth, meetings: (meetings + 1) / 2 }
    }

    /// What the base reflects below a clear coat.
    pub(super) fn base_albedo(&mut self, params: &mut Params, layer: Layer) -> ColorInput {
        match self.albedo(params, "reflectance", GREY) {
            ColorInput::Constant(color) => ColorInput::Constant(layer.clear_albedo(color)),
            // As for a middle grey.
            input => {
                let factor = ColorInput::Constant(layer.clear_albedo(GREY) / GREY);
                self.out.add_texture(TextureDesc::Scale { input, factor, span: params.span.clone() })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Egan & Hilgeman 1973: 0.596 for an index of 1.5.
    #[test]
    fn interfaces_reflect_more_from_inside() {
        let layer = |eta| Layer { eta, depth: 0.0, meetings: 5 };
        assert!((layer(1.5).returned(0.0) - 0.596).abs() < 2e-3, "{}", layer(1.5).returned(0.0));
        assert!(layer(1.0).returned(0.0) < 1e-3);
    }

    #[test]
    fn clear_layers_of_many_bounces_change_nothing_and_others_darken() {
        let layer = |depth, meetings| Layer { eta: 1.5, depth, meetings };
        let albedo = Rgb::new(0.0, 0.5, 0.9);
        assert!((layer(0.0, 500).clear_albedo(albedo) - albedo).abs().max_element() < 1e-5);
        for other in [layer(0.01, 500), layer(0.0, 5)] {
            let darker = other.clear_albedo(albedo);
            assert!(darker.x == 0.0 && darker.y < 0.5 && darker.z < 0.9 && darker.z > 0.8, "{darker}");
        }
    }
}
