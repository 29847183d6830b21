//! What is described before the world, besides the camera: integrator, sampler, and what they come to.

use glam::DMat4;
use sr_scene::{Diagnostic, Settings, Span};

use super::Reader;
use super::film::Exposure;
use super::params::Params;
use super::support::{INTEGRATORS, Support, unsupported};
use super::syntax::{Result, Scanner};
use crate::values::shown;

/// What waits for the end of the options, as they may come in any order.
pub struct Options {
    /// Kind, parameters, and the transform to camera space.
    pub camera: Option<(String, Params, DMat4)>,
    pub film: Option<(String, Params)>,
    pub filter: Option<(String, Params)>,
    /// What the film makes of light.
    pub exposure: f32,
    /// Were the options carried out?
    is_done: bool,
    /// Was there an integrator?
    has_integrator: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { camera: None, film: None, filter: None, exposure: 1.0, is_done: false, has_integrator: false }
    }
}

/// All samplers of pbrt-v4, and their usual numbers of samples.
const SAMPLERS: &[(&str, i32)] = &[
    ("zsobol", 16),
    ("halton", 16),
    ("sobol", 16),
    ("paddedsobol", 16),
    ("independent", 4),
    ("pmj02bn", 16),
    ("stratified", 16),
];

impl Reader<'_> {
    /// Camera and film, once everything about them was read: at `WorldBegin`, or at the end of a file without.
    pub(super) fn options_end(&mut self, span: &Span) {
        if std::mem::replace(&mut self.options.is_done, true) {
            return;
        }
        if !self.options.has_integrator {
            // What pbrt-v4 takes is a path tracer of this depth.
            self.out.settings =
                Settings { max_depth: Some(6), span: span.clone(), ..self.out.settings.clone() };
        }
        let filter = self.options.filter.take();
        let filter = self.filter(filter);
        let camera = self.options.camera.take();
        let shutter = match &camera {
            Some((_, params, _)) => {
                let mut params = params.clone();
                let mut time = |name, default| params.float(name).unwrap_or(default);
                time("shutterclose", 1.0) - time("shutteropen", 0.0)
            }
            None => 1.0,
        };
        let film = self.options.film.take();
        let (film, Exposure(exposure)) = self.film(film, filter, shutter);
        self.options.exposure = exposure;
        self.camera_end(camera, film, span);
    }

    /// `Integrator "path"` and parameters.
    pub(super) fn integrator(&mut self, kind: &str, mut params: Params) {
        self.options.has_integrator = true;
        self.out.settings.span = params.span.clone();
        let is_path =
            |&(name, support): &(&str, Support)| name == kind && !matches!(support, Support::Reported(_));
        if !INTEGRATORS.iter().any(is_path) {
            let code = "pbrt::unsupported-integrator";
            let note =
                unsupported(INTEGRATORS, code, &params.span, "an integrator", kind, "paths are traced");
            self.notes().push(note);
        }
        // pbrt counts the bounces, and we the edges of a path.
        let bounces = params.integer("maxdepth").unwrap_or(5);
        self.out.settings.max_depth = match u32::try_from(bounces) {
            Ok(bounces) => Some(bounces + 1),
            Err(_) => {
                let message = format!("a \"maxdepth\" of {bounces}");
                self.warn("pbrt::bad-value", &params.span, message, "paths may have any length");
                None
            }
        };
        if params.boolean("regularize").unwrap_or(false) {
            let message = "regularized materials are not supported";
            self.warn(
                "pbrt::unsupported-parameter",
                &params.span,
                message,
                "nothing is blurred, as without it",
            );
        }
        // How fast it is, not what is seen.
        params.use_all();
    }

    /// `Sampler "halton"` and parameters: only how many samples it takes matters here.
    pub(super) fn sampler(&mut self, kind: &str, mut params: Params) {
        let usual = match SAMPLERS.iter().find(|(name, _)| *name == kind) {
            Some(&(_, usual)) => usual,
            None => {
                let message = format!("a sampler \"{}\" is not known", shown(kind));
                let note = Diagnostic::warning("pbrt::unknown-value", &params.span, message)
                    .guess(kind, SAMPLERS.iter().map(|(name, _)| *name))
                    .consequence("its number of samples is used");
                self.notes().push(note);
                16
            }
        };
        let count = if kind == "stratified" {
            let mut side = |name| params.integer(name).unwrap_or(4);
            side("xsamples").saturating_mul(side("ysamples"))
        } else {
            params.integer("pixelsamples").unwrap_or(usual)
        };
        match u32::try_from(count) {
            Ok(spp) if spp > 0 => self.out.settings.spp = spp,
            _ => {
                let message = format!("{count} samples for each pixel: at least 1 is needed");
                self.error("pbrt::bad-value", &params.span, message);
            }
        }
        params.ignore(&["seed", "randomization", "jitter"]);
        params.finish(&mut self.notes());
    }

    /// `Option "bool disablepixeljitter" true`: for debugging, and none changes a converged picture but few.
    pub(super) fn option(&mut self, s: &mut Scanner<'_>, span: &Span) -> Result<()> {
        for parameter in s.parameters()? {
            let changes =
                ["disablepixeljitter", "disabletexturefiltering", "disablewavelengthjitter", "forcediffuse"];
            if changes.contains(&&*parameter.name) {
                let span = Span { source: span.source, bytes: parameter.bytes };
                let message = format!("the option \"{}\" is not supported", parameter.name);
                self.warn("pbrt::unsupported-option", &span, message, "the scene is rendered without it");
            }
        }
        Ok(())
    }

    /// `MakeNamedMedium "fog"` and parameters.
    pub(super) fn medium(&mut self, name: &str, params: Params) {
        let message = format!("the medium \"{}\" is not supported", shown(name));
        self.warn("pbrt::unsupported-medium", &params.span, message, "its inside is rendered as empty space");
    }
}
