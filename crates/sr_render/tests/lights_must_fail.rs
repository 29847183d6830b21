//! Lights whose densities are wrong on purpose, each in a way that happens. The chi-square test has to reject them, also
//! where the wrong density integrates to 1.

use glam::{Vec2, Vec3};
use sr_render::Scene;
use sr_render::light::SeenFrom;
use sr_sampling::{Distribution, Independent, Sample, SampleId, Sequence, SolidAngle};
use sr_stats::chi2::{self, Chi2Settings};
use sr_testing::light_scenes;

/// No right light among a million would be rejected at this level.
const LEVEL: f64 = 1e-9;
const SETTINGS: Chi2Settings = Chi2Settings { samples: 1 << 17, bins: (8, 16), seed: 5 };

/// A light's samples, and what is claimed about them.
struct Claim<'a, P> {
    light: SeenFrom<'a>,
    pdf: P,
    scale: f32,
}

impl<P: Fn(Vec3) -> f32> Distribution for Claim<'_, P> {
    type Measure = SolidAngle;
    type Uniform = (f32, Vec2);

    fn sample(&self, u: (f32, Vec2)) -> Option<Sample<SolidAngle>> {
        let value = self.light.sample(u)?.value;
        Some(Sample { value, pdf: self.pdf(value) })
    }

    fn pdf(&self, wi: Vec3) -> f32 {
        self.scale * (self.pdf)(wi)
    }
}

fn scene(name: &str) -> Scene {
    let found = light_scenes().into_iter().find(|(n, _)| n.contains(name));
    Scene::compile(&found.unwrap_or_else(|| panic!("there is no scene \"{name}\"")).1).unwrap()
}

/// The true density times a factor of the direction, made to integrate to 1, must be rejected; without the factor it
/// must not.
fn rejects(scene: &Scene, from: Vec3, factor: impl Fn(Vec3) -> f32) {
    let light = scene.lights().seen_from(from, None);
    let sequence = Independent::new(2);
    let draw = |index| {
        let at = SampleId { pixel: 0, index };
        light.sample((sequence.get_1d(at, 0), sequence.get_2d(at, 1)))
    };
    let n = 1 << 15;
    let mean = (0..n).filter_map(draw).map(|s| f64::from(factor(s.value))).sum::<f64>() / f64::from(n);
    let honest = Claim { light, pdf: |wi| light.pdf(wi), scale: 1.0 };
    let report = chi2::sphere(&honest, SETTINGS);
    assert!(report.passes(1e-6), "{report}");
    let wrong = Claim { light, pdf: |wi| light.pdf(wi) * factor(wi), scale: (1.0 / mean) as f32 };
    let report = chi2::sphere(&wrong, SETTINGS);
    assert!(!report.passes(LEVEL), "not rejected: {report}");
}

const FLOOR: Vec3 = Vec3::new(0.1, -0.2, 0.01);

#[test]
fn area_as_solid_angle_without_the_cosine() {
    rejects(&scene("floor under a rectangle"), FLOOR, |wi| wi.z);
    rejects(&scene("floor under a checkered rectangle"), FLOOR, |wi| wi.z);
}

/// What is drawn by solid angle, with the density of drawing by area: r² / cos θ.
#[test]
fn solid_angles_with_the_density_of_areas() {
    for name in ["floor right under a rectangle", "floor right under a triangle"] {
        rejects(&scene(name), FLOOR, |wi| 1.0 / wi.z.max(1e-3).powi(3));
    }
}

/// sin θ is of the angle with the image's pole, which is the floor's normal.
#[test]
fn an_image_without_its_sine() {
    rejects(&scene("sunny sky, LatLong, compensated: false"), FLOOR, |wi| wi.truncate().length());
    rejects(&scene("sunny sky, EqualAreaOctahedral, compensated: false"), FLOOR, |wi| wi.truncate().length());
}

#[test]
fn an_image_with_its_axes_swapped() {
    for name in
        ["sunny sky, LatLong, compensated: false", "sunny sky, EqualAreaOctahedral, compensated: true"]
    {
        let scene = scene(name);
        let light = scene.lights().seen_from(FLOOR, None);
        let swapped = |wi: Vec3| Vec3::new(wi.y, wi.x, wi.z);
        let claim = Claim { light, pdf: |wi| light.pdf(swapped(wi)), scale: 1.0 };
        let report = chi2::sphere(&claim, SETTINGS);
        assert!(!report.passes(LEVEL), "not rejected: {report}");
    }
}

/// With the density of the same image without compensation.
#[test]
fn compensated_samples_that_claim_not_to_be() {
    let (plain, compensated) =
        (scene("sunny sky, LatLong, compensated: false"), scene("sunny sky, LatLong, compensated: true"));
    let other = plain.lights().seen_from(FLOOR, None);
    let claim =
        Claim { light: compensated.lights().seen_from(FLOOR, None), pdf: |wi| other.pdf(wi), scale: 1.0 };
    let report = chi2::sphere(&claim, SETTINGS);
    assert!(!report.passes(LEVEL), "not rejected: {report}");
}

/// The portals' angles taken for directions: (1 − x²) (1 − y²) / z is lost, with z the normal of the ceiling's portal.
#[test]
fn a_portal_without_its_jacobian() {
    let jacobian = |wi: Vec3| (1.0 - wi.x * wi.x) * (1.0 - wi.y * wi.y) / wi.z.max(1e-3);
    rejects(&scene("floor under a window"), FLOOR, jacobian);
}

#[test]
fn a_sky_without_its_horizon() {
    rejects(&scene("clear sky, sun high"), FLOOR, |wi| 1.0 + 0.1 * wi.x);
}
