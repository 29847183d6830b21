//! Integrators and samplers: what the file asks the renderer for.

use sr_scene::{Diagnostic, Settings};

use super::Lowering;
use crate::mitsuba::node::Node;
use crate::mitsuba::plugins;
use crate::mitsuba::props::Props;

impl<'a> Lowering<'a, '_> {
    pub(super) fn integrators(&mut self, nodes: &[&'a Node]) {
        let Some((&first, more)) = nodes.split_first() else { return };
        if let Some(second) = more.first() {
            self.out.d.push(
                Diagnostic::warning(
                    "mitsuba::several-integrators",
                    &second.span,
                    "the scene has more than one integrator",
                )
                .consequence("the first one is used"),
            );
        }
        self.integrator(first);
    }

    fn integrator(&mut self, node: &'a Node) {
        let mut props = Props::new(node);
        self.out.settings.span = node.span.clone();
        if let Some(hide) = props.boolean("hide_emitters", self.out.d) {
            self.out.settings.hide_emitters = hide;
        }
        match node.kind.as_str() {
            "direct" => {
                self.out.settings.max_depth = Some(2);
                // How direct light is sampled changes the noise only.
                props.ignore(&["emitter_samples", "bsdf_samples", "shading_samples", "strict_normals"]);
            }
            // These wrap another integrator and add outputs.
            "moment" | "aov" | "stokes" => {
                let nested = self.nested(&mut props, "integrator");
                props.use_all();
                let used = nested.first().map_or("the integrator \"path\"".into(), |inner| inner.title());
                let message = format!("the further outputs of {} are not made", node.title());
                self.out.d.push(
                    Diagnostic::warning("mitsuba::unsupported-output", &node.span, message)
                        .consequence(format!("the image of {used} is, with its errors")),
                );
                if let Some(inner) = nested.first() {
                    self.integrator(inner);
                }
            }
            kind => {
                self.depths(&mut props, node);
                props.ignore(&["strict_normals", "samples_per_pass", "block_size", "timeout"]);
                if !plugins::is_read("integrator", kind) {
                    self.unknown_plugin(node, "the integrator \"path\" is used");
                }
                // What others have besides is about how they sample.
                if kind != "path" {
                    props.use_all();
                }
            }
        }
        props.finish(self.out.d);
    }

    fn depths(&mut self, props: &mut Props<'a>, node: &Node) {
        let Settings { roulette_depth, .. } = Settings::default();
        let max_depth = props.integer("max_depth", self.out.d).unwrap_or(-1);
        let rr_depth = props.integer("rr_depth", self.out.d);
        self.out.settings.max_depth = match max_depth {
            -1 => None,
            depth => match u32::try_from(depth) {
                Ok(depth) => Some(depth),
                Err(_) => {
                    let message = format!("a maximum depth of {depth}: -1 (unbounded) or more is possible");
                    self.out.d.push(Diagnostic::error("mitsuba::bad-value", &node.span, message));
                    None
                }
            },
        };
        self.out.settings.roulette_depth = match rr_depth.map(u32::try_from) {
            None => roulette_depth,
            Some(Ok(depth)) => Some(depth),
            Some(Err(_)) => {
                let message = "the depth of Russian roulette cannot be negative";
                self.out.d.push(Diagnostic::error("mitsuba::bad-value", &node.span, message));
                roulette_depth
            }
        };
    }

    /// A sensor's sampler: only how many samples it takes matters here.
    pub(super) fn sampler(&mut self, node: &'a Node) {
        if !plugins::is_read("sampler", &node.kind) {
            self.unknown_plugin(node, "its number of samples is used");
        }
        let mut props = Props::new(node);
        if let Some(count) = props.integer("sample_count", self.out.d) {
            match u32::try_from(count) {
                Ok(spp) if spp > 0 => self.out.settings.spp = spp,
                _ => {
                    let message = format!("a sample count of {count}: at least 1 is needed");
                    self.out.d.push(Diagnostic::error("mitsuba::bad-value", &node.span, message));
                }
            }
        }
        props.ignore(&["seed", "dimension", "jitter", "scramble", "strength"]);
        props.finish(self.out.d);
    }
}
