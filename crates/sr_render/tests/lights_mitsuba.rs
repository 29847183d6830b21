//! Single values of lights beside those that Mitsuba 3.9.1 computes (`scalar_rgb`, `eval` and `sample_direction`).

use std::sync::Arc;

use glam::{Affine2, Mat3, Mat4, Vec3};
use sr_render::Scene;
use sr_render::light::{Sky, Sun};
use sr_scene::{
    ColorInput, Filter, FovAxis, Image, LightDesc, Pixels, Rgb, SceneDesc, Span, SpotFalloff, TextureDesc,
    TextureId, Wrap,
};
use sr_testing::scenes::{camera_on_point, diffuse_scene};

/// A scene of one light, which may have a picture of 4 × 2 texels, 1 to 4 over 5 to 8.
fn lit(light: impl FnOnce(TextureId) -> LightDesc) -> Scene {
    let mut desc: SceneDesc = diffuse_scene(camera_on_point(Vec3::ZERO, Vec3::Z), 0.5);
    let data = (1..=8).map(|v| v as f32).collect();
    let pixels = Pixels::F32 { channels: 1, data };
    desc.images.push(Arc::new(Image { name: "counted".into(), width: 4, height: 2, pixels }));
    desc.textures.push(TextureDesc::Bitmap {
        image: 0,
        filter: Filter::Nearest,
        wrap: Wrap::Repeat,
        srgb: false,
        to_uv: Affine2::IDENTITY,
        span: Span::default(),
    });
    desc.lights.push(light(TextureId(0)));
    Scene::compile(&desc).unwrap()
}

/// What arrives at points from the one light without an extent.
fn agrees(scene: &Scene, cases: &[([f32; 3], f32)]) {
    for &(p, expected) in cases {
        let sample = scene.lights().sample_delta(Vec3::from(p), 0.5, scene.textures());
        let value = sample.map_or(0.0, |s| s.radiance.x);
        assert!((value - expected).abs() <= 1e-4 * expected, "at {p:?}: {value}, not {expected}");
    }
}

fn spot(texture: Option<TextureId>) -> LightDesc {
    LightDesc::Spot {
        world_from_light: Mat4::IDENTITY,
        intensity: Rgb::splat(2.0),
        cutoff_angle: 40_f32.to_radians(),
        beam_width: 20_f32.to_radians(),
        falloff: SpotFalloff::Linear,
        range: f32::INFINITY,
        texture,
        span: Span::default(),
    }
}

#[test]
fn spots() {
    let values = [
        ([0.3, 0.2, 1.0], 1.769_911),
        ([0.5, 0.0, 1.0], 1.074_797),
        ([0.7, 0.2, 1.0], 0.257_842),
        ([0.9, 0.9, 2.0], 0.133_941),
    ];
    agrees(&lit(|_| spot(None)), &values);
    let values = [
        ([0.3, 0.2, 1.0], 12.389_379),
        ([0.3, -0.2, 1.0], 5.309_735),
        ([-0.3, 0.2, 1.0], 10.619_469),
        ([-0.6, -0.2, 1.0], 0.549_177),
        ([0.9, 0.4, 2.0], 2.218_493),
    ];
    agrees(&lit(|texture| spot(Some(texture))), &values);
}

#[test]
fn projectors() {
    let projector = |fov_axis| {
        lit(|texture| LightDesc::Projector {
            world_from_light: Mat4::IDENTITY,
            irradiance: ColorInput::Texture(texture),
            scale: 2.0,
            fov_axis,
            fov: 60_f32.to_radians(),
            span: Span::default(),
        })
    };
    let values = [
        ([0.3, 0.1, 1.0], 6.589_86),
        ([0.3, -0.1, 1.0], 32.949_303),
        ([-0.3, 0.1, 1.0], 26.359_442),
        ([-0.1, -0.1, 1.0], 44.419_945),
        ([0.6, 0.2, 2.0], 1.647_465),
    ];
    agrees(&projector(FovAxis::X), &values);
    agrees(&projector(FovAxis::Y), &[([0.3, 0.1, 1.0], 13.179_721), ([1.1, -0.1, 1.0], 46.808_677)]);
}

#[test]
fn skies() {
    let cases = [
        (3.0, [0.3; 3], [0.6, 0.0, 0.8], [0.0, 0.0, 1.0], [0.029_080_1, 0.048_235_6, 0.095_586_7]),
        (3.0, [0.3; 3], [0.6, 0.0, 0.8], [0.6, 0.1, 0.8], [0.145_906, 0.173_261, 0.215_856]),
        (3.0, [0.3; 3], [0.6, 0.0, 0.8], [-1.0, 0.3, 0.02], [0.161_601, 0.209_927, 0.241_425]),
        (5.5, [0.9, 0.1, 0.5], [0.3, -0.9, 0.1], [0.2, 0.4, 0.5], [0.018_132_4, 0.024_477_1, 0.032_598_1]),
        (10.0, [1.0; 3], [0.0, 0.0, 1.0], [0.9, 0.0, 0.2], [0.236_031, 0.232_399, 0.246_653]),
    ];
    for (turbidity, albedo, sun, wi, expected) in cases {
        let sun = Vec3::from(sun).normalize();
        let sky = Sky::new(turbidity, Rgb::from(albedo), sun, 1.0, Mat3::IDENTITY);
        let (radiance, expected) = (sky.radiance(Vec3::from(wi).normalize()), Rgb::from(expected));
        let error = ((radiance - expected) / expected).abs().max_element();
        assert!(error < 1e-4, "turbidity {turbidity}, {wi:?}: {radiance}, not {expected}");
    }
}

#[test]
fn suns() {
    for (degrees, expected) in
        [(4.0_f32, [22_175.9, 18_777.48, 14_846.32]), (40.0, [21_580.83, 17_872.0, 13_411.88])]
    {
        let direction = Vec3::new(degrees.to_radians().sin(), 0.0, degrees.to_radians().cos());
        let sun = Sun::new(3.0, direction, 1.0, 0.5358_f32.to_radians(), Mat3::IDENTITY);
        let error = (sun.radiance(direction) / Rgb::from(expected) - 1.0).abs().max_element();
        assert!(error < 1e-5, "{degrees}: {}, not {expected:?}", sun.radiance(direction));
    }
}
