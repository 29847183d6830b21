//! BSDFs that are about polarization: what they do to light that has none.

use sr_scene::{ColorInput, Diagnostic, MaterialDesc, Rgb, TextureDesc};

use super::Lowering;
use super::material::GREY;
use crate::mitsuba::node::Node;
use crate::mitsuba::props::Props;

impl<'a> Lowering<'a, '_> {
    /// A rough plastic; Mitsuba's has no light that bounces inside it, and is darker by it.
    pub(super) fn polarizing_plastic(&mut self, node: &'a Node, props: &mut Props<'a>) -> MaterialDesc {
        self.unpolarized(node, "a roughplastic is shown instead, which is 6 to 9 % brighter");
        let kind = self.distribution(props);
        let names = if props.has("alpha_u") { ["alpha_u", "alpha_v"] } else { ["alpha"; 2] };
        let [alpha_u, alpha_v] = names.map(|name| self.constant_alpha(props, name, 0.1));
        if alpha_u != alpha_v {
            let message = format!("{} is as rough along u as along v here", node.title());
            self.out.d.push(
                Diagnostic::warning("mitsuba::unsupported-property", &node.span, message)
                    .consequence("the mean of \"alpha_u\" and \"alpha_v\" is used"),
            );
        }
        MaterialDesc::RoughPlastic {
            kind,
            alpha: 0.5 * (alpha_u + alpha_v),
            eta: self.eta(props, "polypropylene"),
            diffuse_reflectance: self.factor(props, "diffuse_reflectance", GREY),
            specular_reflectance: self.factor(props, "specular_reflectance", Rgb::ONE),
            nonlinear: false,
            multiscatter: false,
        }
    }

    /// A sheet that lets light pass straight, as much as it lets pass of light without polarization.
    pub(super) fn polarizing_filter(&mut self, node: &'a Node, props: &mut Props<'a>) -> MaterialDesc {
        let (share, consequence) = match node.kind.as_str() {
            "retarder" => (1.0, "all light passes"),
            _ => (0.5, "half of the light passes"),
        };
        self.unpolarized(node, consequence);
        // How it is turned, and what it delays.
        props.ignore(&["theta", "delta", "left_handed", "polarizing"]);
        let transmittance = self.factor(props, "transmittance", Rgb::ONE);
        let specular_transmittance = match transmittance {
            ColorInput::Constant(color) => ColorInput::Constant(share * color),
            textured if share == 1.0 => textured,
            input => self.out.add_texture(TextureDesc::Scale {
                input,
                factor: ColorInput::Constant(Rgb::splat(share)),
                span: node.span.clone(),
            }),
        };
        let specular_reflectance = ColorInput::Constant(Rgb::ZERO);
        MaterialDesc::ThinDielectric { eta: 1.0, specular_reflectance, specular_transmittance }
    }

    fn unpolarized(&mut self, node: &Node, consequence: &str) {
        let message = format!("{}: polarization is not rendered", node.title());
        self.out.d.push(
            Diagnostic::warning("mitsuba::no-polarization", &node.span, message).consequence(consequence),
        );
    }
}
