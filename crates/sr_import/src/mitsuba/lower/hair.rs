//! Hair.

use sr_scene::{ColorInput, Diagnostic, HairAbsorption, HairDesc, MaterialDesc, Rgb, TextureDesc};

use super::Lowering;
use super::color::Role;
use crate::mitsuba::props::Props;

impl<'a> Lowering<'a, '_> {
    pub(super) fn hair(&mut self, props: &mut Props<'a>) -> MaterialDesc {
        MaterialDesc::Hair(HairDesc {
            absorption: self.hair_absorption(props),
            eta: self.eta(props, "amber"),
            beta_m: self.scalar(props, "longitudinal_roughness", 0.3),
            beta_n: self.scalar(props, "azimuthal_roughness", 0.3),
            alpha: props.float("scale_tilt", self.out.d).unwrap_or(2.0).to_radians(),
            along_u: false,
        })
    }

    /// `sigma_a`, our own `color`, or pigments.
    fn hair_absorption(&mut self, props: &mut Props<'a>) -> HairAbsorption {
        let scale = props.float("scale", self.out.d).unwrap_or(1.0);
        let given = ["sigma_a", "color", "eumelanin", "pheomelanin"].map(|name| props.get(name).is_some());
        let [has_sigma_a, has_color, has_eumelanin, has_pheomelanin] = given;
        let ways = [has_sigma_a, has_color, has_eumelanin || has_pheomelanin];
        if ways.into_iter().filter(|&is_given| is_given).count() > 1 {
            let message = format!(
                "{} is given more than one of \"sigma_a\", \"color\" and pigments",
                props.node.title()
            );
            let used = if has_sigma_a { "\"sigma_a\" is used" } else { "\"color\" is used" };
            self.out
                .d
                .push(Diagnostic::warning("mitsuba::conflict", &props.node.span, message).consequence(used));
        }
        if scale != 1.0 && !has_sigma_a {
            let message = format!("\"scale\" of {} belongs to \"sigma_a\"", props.node.title());
            let diagnostic = Diagnostic::warning("mitsuba::conflict", &props.node.span, message);
            self.out.d.push(diagnostic.consequence("it is ignored"));
        }
        if let Some(sigma_a) = self.color_if_given(props, "sigma_a", Role::Factor) {
            props.ignore(&["color", "eumelanin", "pheomelanin"]);
            return HairAbsorption::Coefficient(match sigma_a {
                ColorInput::Constant(color) => ColorInput::Constant(color * scale),
                texture if scale == 1.0 => texture,
                input => {
                    let factor = ColorInput::Constant(Rgb::splat(scale));
                    self.out.add_texture(TextureDesc::Scale { input, factor, span: props.node.span.clone() })
                }
            });
        }
        if let Some(color) = self.color_if_given(props, "color", Role::Factor) {
            props.ignore(&["eumelanin", "pheomelanin"]);
            return HairAbsorption::Color(color);
        }
        HairAbsorption::Pigments {
            eumelanin: self.scalar(props, "eumelanin", 1.3),
            pheomelanin: self.scalar(props, "pheomelanin", 0.2),
        }
    }
}
