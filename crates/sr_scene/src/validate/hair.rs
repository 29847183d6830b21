//! Hair: numbers that have a range.

use super::Check;
use crate::diagnostic::Span;
use crate::{ColorInput, HairAbsorption, HairDesc, ScalarInput};

/// More than this absorbs everything.
const DARKEST: f32 = 1e6;

impl Check<'_> {
    pub(super) fn hair(&mut self, hair: &HairDesc, span: &Span) {
        match &hair.absorption {
            HairAbsorption::Coefficient(sigma_a) => {
                self.color_input(sigma_a, "sigma_a", span);
                if let ColorInput::Constant(color) = sigma_a {
                    self.absorbs("sigma_a", color.max_element(), span);
                }
            }
            HairAbsorption::Color(color) => self.albedo(color, "color", span),
            HairAbsorption::Pigments { eumelanin, pheomelanin } => {
                for (input, what) in [(eumelanin, "eumelanin"), (pheomelanin, "pheomelanin")] {
                    match *input {
                        ScalarInput::Constant(amount) => self.absorbs(what, amount, span),
                        ScalarInput::Texture(id) => self.texture_id(id, span),
                    }
                }
            }
        }
        self.eta(hair.eta, span);
        self.within(&hair.beta_m, "longitudinal roughness", 1.0, span);
        self.within(&hair.beta_n, "azimuthal roughness", 1.0, span);
        if !(hair.alpha.abs() <= std::f32::consts::FRAC_PI_2) {
            let message = format!("scales tilted by {}°; -90° to 90° is possible", hair.alpha.to_degrees());
            self.error("scene::hair", span, message);
        }
    }

    fn absorbs(&mut self, what: &str, amount: f32, span: &Span) {
        if !(0.0..=DARKEST).contains(&amount) {
            self.error("scene::hair", span, format!("{what} of {amount}: 0 to {DARKEST:e} is possible"));
        }
    }
}
