//! Hair.

use sr_scene::{HairAbsorption, HairDesc, MaterialDesc, Rgb, ScalarInput};

use super::{FloatTexture, Params, Reader};

impl Reader<'_> {
    pub(super) fn hair(&mut self, params: &mut Params) -> MaterialDesc {
        let rough = [("beta_m", 0.3), ("beta_n", 0.3)].map(|(name, default)| {
            let texture = self.float_or_texture(params, name).unwrap_or(FloatTexture::Constant(default));
            self.as_scalar(texture)
        });
        let alpha = match self.float_or_texture(params, "alpha") {
            None => 2.0,
            Some(FloatTexture::Constant(degrees)) => degrees,
            Some(_) => {
                let message = "\"alpha\" of hair cannot be a texture";
                self.warn("pbrt::texture-not-possible", &params.span, message, "2 is used");
                2.0
            }
        };
        let [beta_m, beta_n] = rough;
        MaterialDesc::Hair(HairDesc {
            absorption: self.hair_absorption(params),
            eta: self.eta(params, "eta", 1.55),
            beta_m,
            beta_n,
            alpha: alpha.to_radians(),
            along_u: true,
        })
    }

    /// The first of `sigma_a`, `color` (or `reflectance`) and pigments that is given, as in pbrt.
    fn hair_absorption(&mut self, params: &mut Params) -> HairAbsorption {
        let sigma_a = self.color_or_texture(params, "sigma_a");
        let color = ["color", "reflectance"]
            .map(|name| if params.has(name) { Some(self.albedo(params, name, Rgb::ONE)) } else { None });
        let color = color[1].or(color[0]);
        let pigments = ["eumelanin", "pheomelanin"].map(|name| {
            let texture = self.float_or_texture(params, name)?;
            Some(self.as_scalar(texture))
        });
        let has_pigments = pigments.iter().any(Option::is_some);
        let ways = [sigma_a.is_some(), color.is_some(), has_pigments];
        if ways.into_iter().filter(|&is_given| is_given).count() > 1 {
            let message = "hair is given more than one of \"sigma_a\", \"reflectance\" and pigments";
            let used = if sigma_a.is_some() { "\"sigma_a\" is used" } else { "\"reflectance\" is used" };
            self.warn("pbrt::conflict", &params.span, message, used);
        }
        let none = ScalarInput::Constant(0.0);
        let [eumelanin, pheomelanin] = pigments;
        match (sigma_a, color) {
            (Some(sigma_a), _) => HairAbsorption::Coefficient(sigma_a),
            (None, Some(color)) => HairAbsorption::Color(color),
            (None, None) if has_pigments => HairAbsorption::Pigments {
                eumelanin: eumelanin.unwrap_or(none),
                pheomelanin: pheomelanin.unwrap_or(none),
            },
            (None, None) => {
                HairAbsorption::Pigments { eumelanin: ScalarInput::Constant(1.3), pheomelanin: none }
            }
        }
    }
}
