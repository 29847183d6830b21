//! Lights of every kind above a floor: some with their answers, all of them to be tested as densities.

use std::f32::consts::PI;
use std::sync::Arc;

use glam::{Affine2, Mat3, Mat4, Vec2, Vec3};
use sr_scene::{
    ColorInput, Emission, FovAxis, Geometry, Image, IntensityProfile, LightDesc, MaterialId, MeshDesc,
    Pixels, Portal, Rgb, SceneDesc, ShapeDesc, Span, SphereMapping, TextureDesc, TextureId,
};

use crate::scenes::{KnownScene, floor_under, lambert_irradiance, polygon, shape};

/// A rectangle that faces the floor, from the middle of it and half its sides.
fn rectangle(center: Vec3, half: Vec2) -> [Vec3; 4] {
    [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)]
        .map(|(x, y)| center + Vec3::new(x * half.x, y * half.y, 0.0))
}

/// Black, so that nothing but the light itself is seen in its place.
fn black(geometry: Geometry, radiance: Option<f32>) -> ShapeDesc {
    ShapeDesc { material: MaterialId(2), ..shape(geometry, radiance) }
}

fn image(width: u32, height: u32, value: impl Fn(u32, u32) -> f32) -> Arc<Image> {
    let data = (0..width * height).map(|i| value(i % width, i / width)).collect();
    Arc::new(Image { name: "test".into(), width, height, pixels: Pixels::F32 { channels: 1, data } })
}

/// An image around the scene whose +Z, if it is octahedral, or +Y is the floor's normal.
fn environment(desc: &mut SceneDesc, image: Arc<Image>, mapping: SphereMapping) -> &mut LightDesc {
    let world_from_light = match mapping {
        SphereMapping::LatLong => Mat3::from_rotation_x(PI / 2.0),
        SphereMapping::EqualAreaOctahedral => Mat3::IDENTITY,
    };
    desc.images.push(image);
    desc.lights.push(LightDesc::Environment {
        image: desc.images.len() as u32 - 1,
        mapping,
        scale: 1.0,
        world_from_light,
        mis_compensation: false,
        portals: Vec::new(),
        span: Span::default(),
    });
    desc.lights.last_mut().expect("just pushed")
}

/// A checkerboard of 2 × 2 squares over (u, v) in [0, 1]², bright at the origin and at the opposite corner, half as
/// bright elsewhere.
fn checkerboard(desc: &mut SceneDesc, bright: f32) -> ColorInput {
    desc.textures.push(TextureDesc::Checkerboard {
        color0: ColorInput::Constant(Rgb::splat(bright)),
        color1: ColorInput::Constant(Rgb::splat(0.5 * bright)),
        to_uv: Affine2::IDENTITY,
        span: Span::default(),
    });
    ColorInput::Texture(TextureId(desc.textures.len() as u32 - 1))
}

/// A checkered light: `cuts` rows of triangles, so that 1 is a rectangle and more are a mesh.
fn checkered_light(desc: &mut SceneDesc, center: Vec3, half: Vec2, cuts: u32, bright: f32) {
    let radiance = checkerboard(desc, bright);
    let [a, b, _, d] = rectangle(center, half);
    let mut mesh = MeshDesc { name: "checkered".into(), ..MeshDesc::default() };
    for i in 0..=cuts {
        let s = i as f32 / cuts as f32;
        for t in [0.0, 1.0] {
            mesh.positions.push(a + s * (d - a) + t * (b - a));
            mesh.uvs.push(Vec2::new(s, t));
        }
    }
    for i in 0..cuts {
        let k = 2 * i;
        mesh.triangles.extend([[k, k + 1, k + 3], [k, k + 3, k + 2]]);
    }
    let geometry = Geometry::Mesh(Arc::new(mesh));
    desc.shapes.push(ShapeDesc { emission: Some(Emission { radiance }), ..black(geometry, None) });
}

/// Placed at a point, with its +Z towards the floor.
fn pointing_down(at: Vec3) -> Mat4 {
    Mat4::from_translation(at) * Mat4::from_rotation_x(PI)
}

/// Lights whose light on the floor's origin is known.
pub(crate) fn known_lights() -> Vec<KnownScene> {
    let mut all = area_lights();
    all.extend(environments());
    all.extend(points());
    for known in &mut all {
        // Some would be, after minutes.
        known.found_by_chance = false;
    }
    all
}

fn area_lights() -> Vec<KnownScene> {
    let lit_by = |name: &str, vertices: &[Vec3], le: f32| {
        floor_under(name, f64::from(le) * lambert_irradiance(vertices), 0.0, |desc| {
            desc.shapes.push(black(polygon(vertices), Some(le)));
        })
    };
    let checkered = |name: &str, cuts: u32| {
        let (center, half) = (Vec3::new(0.3, -0.1, 0.9), Vec2::new(0.8, 0.5));
        let bright = [-0.5_f32, 0.5].map(|s| {
            let quarter = rectangle(center + Vec3::new(s * half.x, s * half.y, 0.0), 0.5 * half);
            lambert_irradiance(&quarter)
        });
        let all = lambert_irradiance(&rectangle(center, half));
        floor_under(name, 2.5 * (all + bright[0] + bright[1]), 0.0, |desc| {
            checkered_light(desc, center, half, cuts, 5.0);
        })
    };
    vec![
        lit_by(
            "floor right under a rectangle",
            &rectangle(Vec3::new(0.2, 0.1, 0.6), Vec2::new(1.5, 1.0)),
            0.7,
        ),
        lit_by(
            "floor far under a rectangle",
            &rectangle(Vec3::new(2.0, 1.0, 7.0), Vec2::new(0.5, 0.3)),
            200.0,
        ),
        lit_by(
            "floor right under a triangle",
            &[Vec3::new(-1.0, -1.0, 0.7), Vec3::new(0.2, 1.5, 0.65), Vec3::new(1.5, -1.0, 0.6)],
            0.7,
        ),
        checkered("floor under a checkered rectangle", 1),
        checkered("floor under a checkered mesh", 3),
    ]
}

fn environments() -> Vec<KnownScene> {
    let pi = std::f64::consts::PI;
    // L = 1 + z / 2: E = π + π / 3; so many texels that what bilinear interpolation changes is out of sight
    let graded = |name: &str, mis_compensation: bool| {
        floor_under(name, pi * 4.0 / 3.0, 0.0, |desc| {
            let n = 256;
            let value = |x: u32, y: u32| {
                let at = 2.0 * (Vec2::new(x as f32, y as f32) + 0.5) / n as f32 - 1.0;
                let above = 1.0 - at.x.abs() - at.y.abs();
                let r = 1.0 - above.abs();
                1.0 + 0.5 * (1.0 - r * r).copysign(above)
            };
            let light = environment(desc, image(n, n, value), SphereMapping::EqualAreaOctahedral);
            if let LightDesc::Environment { mis_compensation: compensated, .. } = light {
                *compensated = mis_compensation;
            }
        })
    };
    // through the hole of a black ceiling that nearly reaches the horizon
    let hole = rectangle(Vec3::new(0.4, 0.1, 1.0), Vec2::new(0.5, 0.7));
    let window = floor_under("floor under a window", 3.0 * lambert_irradiance(&hole), 0.0, |desc| {
        let far = 5000.0;
        let [a, b, c, d] = hole;
        let strips = [
            [Vec2::new(-far, -far), Vec2::new(a.x, far)],
            [Vec2::new(d.x, -far), Vec2::new(far, far)],
            [Vec2::new(a.x, -far), Vec2::new(d.x, a.y)],
            [Vec2::new(b.x, b.y), Vec2::new(c.x, far)],
        ];
        for [low, high] in strips {
            let center = (0.5 * (low + high)).extend(1.0);
            desc.shapes.push(black(polygon(&rectangle(center, 0.5 * (high - low))), None));
        }
        if let LightDesc::Environment { portals, .. } =
            environment(desc, image(2, 2, |_, _| 3.0), SphereMapping::LatLong)
        {
            portals.push(Portal { corner: a, edges: [b - a, d - a] });
        }
    });
    // the disk of a sun of 2 α at the angle θ: E = L π sin² α cos θ; L as Mitsuba 3.9.1 has it, green
    let (theta, aperture) = (40_f32.to_radians(), 0.5358_f32.to_radians());
    let sin2 = f64::from((0.5 * aperture).sin().powi(2));
    let sun = floor_under("floor in the sun", 17_872.0 * pi * sin2 * f64::from(theta.cos()), 0.0, |desc| {
        desc.lights.push(LightDesc::Sun {
            turbidity: 3.0,
            direction: Vec3::new(theta.sin(), 0.0, theta.cos()),
            scale: 1.0,
            aperture,
            world_from_light: Mat3::IDENTITY,
            span: Span::default(),
        });
    });
    vec![
        graded("floor under a graded octahedral sky", false),
        graded("floor under a graded sky with MIS compensation", true),
        window,
        sun,
    ]
}

fn points() -> Vec<KnownScene> {
    let at = Vec3::new(0.3, 0.4, 1.2);
    let (d2, cos) = (at.as_dvec3().length_squared(), at.as_dvec3().normalize().z);
    let falloff = cos / d2;
    vec![
        // an even image makes a plane across the axis even: π times the image over the squared height
        floor_under(
            "floor under a projector",
            std::f64::consts::PI * 2.0 / f64::from(at.z).powi(2),
            0.0,
            |desc| {
                desc.lights.push(LightDesc::Projector {
                    world_from_light: pointing_down(at),
                    irradiance: ColorInput::Constant(Rgb::splat(2.0)),
                    scale: 1.0,
                    fov_axis: FovAxis::X,
                    fov: 1.2,
                    span: Span::default(),
                });
            },
        ),
        floor_under("floor under a goniometric light", 3.0 * falloff, 0.0, |desc| {
            desc.images.push(image(4, 4, |_, _| 1.5));
            desc.lights.push(LightDesc::Goniometric {
                world_from_light: pointing_down(at),
                intensity: Rgb::splat(2.0),
                image: 0,
                mapping: SphereMapping::EqualAreaOctahedral,
                span: Span::default(),
            });
        }),
        // 100 cd down, falling linearly with the angle to 0 at 90°
        floor_under(
            "floor under a measured luminaire",
            100.0 * (1.0 - cos.acos() / std::f64::consts::FRAC_PI_2) * falloff,
            0.0,
            |desc| {
                desc.lights.push(LightDesc::Profile {
                    world_from_light: pointing_down(at),
                    intensity: Rgb::ONE,
                    profile: Arc::new(IntensityProfile {
                        name: "test".into(),
                        vertical: vec![0.0, 0.5 * PI],
                        horizontal: vec![0.0],
                        candelas: vec![100.0, 0.0],
                    }),
                    span: Span::default(),
                });
            },
        ),
    ]
}

/// Scenes to test lights as densities in, with names: those with known answers, and harder ones without.
pub fn light_scenes() -> Vec<(String, SceneDesc)> {
    // Images of many texels have as many jumps, which to integrate over takes minutes.
    let is_coarse = |desc: &SceneDesc| desc.images.iter().all(|image| image.width <= 64);
    let known = crate::known_scenes().into_iter().map(|known| (known.name, known.desc));
    let mut all: Vec<(String, SceneDesc)> = known.filter(|(_, desc)| is_coarse(desc)).collect();
    let mut add = |name: &str, change: &dyn Fn(&mut SceneDesc)| {
        let known = floor_under(name, 0.0, 0.0, change);
        all.push((known.name, known.desc));
    };
    // a sun of one texel over a dim, uneven sky with black rows
    let sunny = |n: u32| {
        move |x: u32, y: u32| {
            if (x, y) == (n / 3, n / 5) { 500.0 } else { (x % 5) as f32 * f32::from(!(5..8).contains(&y)) }
        }
    };
    for mapping in [SphereMapping::LatLong, SphereMapping::EqualAreaOctahedral] {
        for compensated in [false, true] {
            add(&format!("sunny sky, {mapping:?}, compensated: {compensated}"), &|desc| {
                if let LightDesc::Environment { mis_compensation, .. } =
                    environment(desc, image(24, 24, sunny(24)), mapping)
                {
                    *mis_compensation = compensated;
                }
            });
        }
    }
    add("sunny sky through two portals", &|desc| {
        if let LightDesc::Environment { portals, .. } =
            environment(desc, image(24, 12, sunny(24)), SphereMapping::LatLong)
        {
            let corner = Vec3::new(-0.5, -0.5, 2.0);
            portals.push(Portal { corner, edges: [1.5 * Vec3::Y, Vec3::X] });
            portals.push(Portal { corner: Vec3::new(2.0, -1.0, 0.0), edges: [2.0 * Vec3::Z, 2.0 * Vec3::Y] });
        }
    });
    for (name, elevation) in [("high", 1.1_f32), ("low", 0.05)] {
        add(&format!("clear sky, sun {name}"), &|desc| {
            let direction = Vec3::new(elevation.cos() * 0.6, elevation.cos() * 0.8, elevation.sin());
            let world_from_light = Mat3::from_rotation_x(0.4);
            let (turbidity, scale, span) = (4.0, 1.0, Span::default());
            desc.lights.push(LightDesc::Sky {
                turbidity,
                albedo: Rgb::splat(0.2),
                sun_direction: direction,
                scale,
                world_from_light,
                span: span.clone(),
            });
            let aperture = 0.2;
            desc.lights.push(LightDesc::Sun {
                turbidity,
                direction,
                scale,
                aperture,
                world_from_light,
                span,
            });
        });
    }
    add("a disk, a ball, and the inside of one", &|desc| {
        desc.shapes.push(black(
            Geometry::Disk {
                center: Vec3::new(0.2, 0.1, 1.5),
                u_axis: 0.7 * Vec3::X,
                v_axis: -0.4 * Vec3::Y,
                flip_normals: false,
            },
            Some(2.0),
        ));
        for (center, radius, flip_normals) in
            [(Vec3::new(-1.5, 0.5, 0.8), 0.6, false), (Vec3::new(0.1, 0.2, 0.0), 4.0, true)]
        {
            let frame = Mat3::IDENTITY;
            desc.shapes.push(black(Geometry::Sphere { center, radius, frame, flip_normals }, Some(1.0)));
        }
    });
    add("a sliver and a strip nearby", &|desc| {
        let strip = rectangle(Vec3::new(0.5, 0.0, 0.45), Vec2::new(3.0, 0.02));
        desc.shapes.push(black(polygon(&strip), Some(3.0)));
        let sliver = [Vec3::new(-2.0, 0.3, 0.6), Vec3::new(2.0, 0.35, 0.6), Vec3::new(2.0, 0.3, 0.6)];
        desc.shapes.push(black(polygon(&sliver), Some(3.0)));
    });
    all
}
