//! Scenes whose answer is known in closed form.
//!
//! In: nothing. Out: [`known_scenes`]: descriptions, each with the radiance that every pixel must show.

use std::f32::consts::{FRAC_PI_3, PI};
use std::sync::Arc;

use glam::{Mat3, Mat4, Vec2, Vec3};
use sr_scene::{
    CameraDesc, ColorInput, Emission, FilmDesc, FilterDesc, FovAxis, Geometry, Image, LightDesc,
    MaterialDesc, MaterialId, MeshDesc, Pixels, Projection, Rgb, SceneDesc, Settings, ShapeDesc, Span,
    SphereMapping, SpotFalloff,
};

/// A scene and its answer.
#[derive(Clone, Debug)]
pub struct KnownScene {
    /// What it is, and where the answer comes from.
    pub name: String,
    /// The scene; its film has one pixel.
    pub desc: SceneDesc,
    /// The radiance of that pixel.
    pub radiance: Rgb,
    /// Does `light` alone have a finite variance? Not where shining walls meet: sampled by area, they are
    /// ever closer to the points of a corner.
    pub light_alone_converges: bool,
    /// Is the light so large that a direction chosen without regard to it finds it often enough?
    pub found_by_chance: bool,
}

/// A camera at `from` that sees nothing but the point `at`.
pub fn camera_on_point(from: Vec3, at: Vec3) -> CameraDesc {
    let z = (at - from).normalize();
    let (x, y) = z.any_orthonormal_pair();
    CameraDesc {
        world_from_camera: Mat4::from_cols(x.extend(0.0), y.extend(0.0), z.extend(0.0), from.extend(1.0)),
        projection: Projection::Perspective {
            fov_axis: FovAxis::X,
            fov: 1e-4,
            principal_point_offset: Vec2::ZERO,
            lens: None,
        },
        near_clip: 1e-3,
        far_clip: 1e4,
        film: FilmDesc {
            width: 1,
            height: 1,
            crop: None,
            filter: FilterDesc::Box { radius: 0.5 },
            sample_border: false,
        },
        span: Span::default(),
    }
}

/// A scene of one gray, two-sided diffuse material of the given albedo.
pub fn diffuse_scene(camera: CameraDesc, albedo: f32) -> SceneDesc {
    SceneDesc {
        camera,
        settings: Settings::default(),
        images: Vec::new(),
        textures: Vec::new(),
        materials: vec![
            MaterialDesc::Diffuse { reflectance: ColorInput::Constant(Rgb::splat(albedo)) },
            MaterialDesc::TwoSided { front: MaterialId(0), back: MaterialId(0) },
        ],
        material_spans: Vec::new(),
        shapes: Vec::new(),
        groups: Vec::new(),
        instances: Vec::new(),
        lights: Vec::new(),
        variants: Vec::new(),
    }
}

/// A shape of that material.
pub fn shape(geometry: Geometry, radiance: Option<f32>) -> ShapeDesc {
    let emission = radiance.map(|le| Emission { radiance: ColorInput::Constant(Rgb::splat(le)) });
    ShapeDesc { geometry, material: MaterialId(1), emission, span: Span::default() }
}

/// A mesh of one polygon, a fan from its first vertex; it faces the side it is counter-clockwise from.
pub fn polygon(vertices: &[Vec3]) -> Geometry {
    let triangles = (2..vertices.len() as u32).map(|i| [0, i - 1, i]).collect();
    Geometry::Mesh(Arc::new(MeshDesc {
        name: "polygon".into(),
        positions: vertices.to_vec(),
        triangles,
        ..MeshDesc::default()
    }))
}

fn sphere(center: Vec3, radius: f32, flip_normals: bool) -> Geometry {
    Geometry::Sphere { center, radius, frame: Mat3::IDENTITY, flip_normals }
}

fn floor() -> ShapeDesc {
    let corner = |x, y| Vec3::new(x, y, 0.0);
    shape(polygon(&[corner(-9.0, -9.0), corner(9.0, -9.0), corner(9.0, 9.0), corner(-9.0, 9.0)]), None)
}

/// Of the floor in all scenes made by [`floor_under`].
const ALBEDO: f32 = 0.6;

/// A floor at z = 0, seen at the origin, under whatever `add` puts above it; direct light only.
pub(crate) fn floor_under(
    name: &str,
    irradiance: f64,
    albedo_of_lights: f32,
    add: impl FnOnce(&mut SceneDesc),
) -> KnownScene {
    let mut desc = diffuse_scene(camera_on_point(Vec3::new(0.25, -0.2, 0.15), Vec3::ZERO), ALBEDO);
    desc.settings.max_depth = Some(2);
    desc.shapes.push(floor());
    desc.materials
        .push(MaterialDesc::Diffuse { reflectance: ColorInput::Constant(Rgb::splat(albedo_of_lights)) });
    add(&mut desc);
    let radiance = f64::from(ALBEDO) / std::f64::consts::PI * irradiance;
    KnownScene {
        name: name.into(),
        desc,
        radiance: Rgb::splat(radiance as f32),
        light_alone_converges: true,
        found_by_chance: true,
    }
}

/// Irradiance at the origin, on a floor facing +Z, from a polygon of unit radiance: Lambert's formula,
/// E = ½ Σ Θᵢ cos γᵢ over the edges (Lambert 1760; Arvo 1994, eq. 3.3).
///
/// The polygon lies above the floor and turns its front to the origin.
pub fn lambert_irradiance(vertices: &[Vec3]) -> f64 {
    let directions: Vec<glam::DVec3> = vertices.iter().map(|v| v.as_dvec3().normalize()).collect();
    let edges = directions.iter().zip(directions.iter().cycle().skip(1));
    let sum: f64 = edges.map(|(a, b)| a.cross(*b).normalize().z * a.angle_between(*b)).sum();
    0.5 * sum.abs()
}

/// All scenes with a known answer.
pub fn known_scenes() -> Vec<KnownScene> {
    let mut all = vec![furnace_sphere(), furnace_box(), white_furnace()];
    all.extend(polygons());
    all.extend(spheres());
    all.extend(cylinders());
    all.push(white_patch());
    all.extend(skies());
    all.extend(crate::lights::known_lights());
    all.push(mirror_in_front_of_a_light());
    all
}

/// Inside a sphere that emits 1 and reflects a: 1 / (1 − a) everywhere.
fn furnace_sphere() -> KnownScene {
    let camera = camera_on_point(Vec3::new(0.1, 0.3, -0.2), Vec3::new(1.0, 2.0, 0.5));
    let mut desc = diffuse_scene(camera, 0.5);
    desc.shapes.push(shape(sphere(Vec3::ZERO, 2.0, true), Some(1.0)));
    KnownScene {
        name: "furnace, sphere".into(),
        desc,
        radiance: Rgb::splat(2.0),
        light_alone_converges: true,
        found_by_chance: true,
    }
}

/// The same inside a box, whose walls shine from many triangles.
fn furnace_box() -> KnownScene {
    let camera = camera_on_point(Vec3::new(0.1, 0.3, -0.2), Vec3::new(1.0, 0.4, 0.5));
    let mut desc = diffuse_scene(camera, 0.3);
    for (axis, up) in [(Vec3::X, Vec3::Y), (Vec3::Y, Vec3::Z), (Vec3::Z, Vec3::X)] {
        for n in [axis, -axis] {
            let (u, v) = (up, n.cross(up));
            // seen from inside, the normal is −n
            let corners = [n - u - v, n - u + v, n + u + v, n + u - v];
            let facing = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let inwards = facing.dot(n) < 0.0;
            let corners = if inwards { corners } else { [corners[3], corners[2], corners[1], corners[0]] };
            desc.shapes.push(shape(polygon(&corners), Some(1.0)));
        }
    }
    KnownScene {
        name: "furnace, box".into(),
        desc,
        radiance: Rgb::splat(1.0 / 0.7),
        light_alone_converges: false,
        found_by_chance: true,
    }
}

/// A convex body of albedo 1 under a sky of radiance 1 cannot be told from the sky.
fn white_furnace() -> KnownScene {
    let camera = camera_on_point(Vec3::new(0.0, -3.0, 0.5), Vec3::new(0.3, -0.5, 0.2));
    let mut desc = diffuse_scene(camera, 1.0);
    desc.shapes.push(shape(sphere(Vec3::ZERO, 1.0, false), None));
    desc.lights.push(LightDesc::Constant { radiance: Rgb::ONE, span: Span::default() });
    KnownScene {
        name: "white furnace, sphere under a constant sky".into(),
        desc,
        radiance: Rgb::ONE,
        light_alone_converges: true,
        found_by_chance: true,
    }
}

fn polygons() -> Vec<KnownScene> {
    let lights: [(&str, Vec<Vec3>); 4] = [
        ("a triangle", vec![Vec3::new(-1.0, -1.0, 1.5), Vec3::new(1.0, 1.5, 1.2), Vec3::new(1.5, -1.0, 1.0)]),
        (
            "a rectangle",
            vec![
                Vec3::new(-0.8, -0.5, 1.0),
                Vec3::new(-0.8, 0.5, 1.0),
                Vec3::new(0.8, 0.5, 1.0),
                Vec3::new(0.8, -0.5, 1.0),
            ],
        ),
        (
            "a grazing triangle",
            vec![Vec3::new(1.0, 0.0, 0.05), Vec3::new(1.1, 1.0, 1.9), Vec3::new(1.2, -0.9, 0.1)],
        ),
        (
            "a pentagon",
            (0..5)
                .map(|i| {
                    let phi = -2.0 * PI * i as f32 / 5.0;
                    Vec3::new(0.3 + phi.cos(), phi.sin() - 0.2, 0.8 + 0.3 * phi.sin())
                })
                .collect(),
        ),
    ];
    lights
        .into_iter()
        .map(|(name, vertices)| {
            let irradiance = 4.0 * lambert_irradiance(&vertices);
            let name = format!("floor under {name} (Lambert's formula)");
            floor_under(&name, irradiance, 0.0, |desc| {
                let normal = (vertices[1] - vertices[0]).cross(vertices[2] - vertices[0]);
                let mut facing = vertices.clone();
                if normal.dot(vertices[0]) > 0.0 {
                    facing.reverse();
                }
                let mut light = shape(polygon(&facing), Some(4.0));
                light.material = MaterialId(2);
                desc.shapes.push(light);
            })
        })
        .collect()
}

fn cylinder(base: Vec3, radius: f32, length: f32, flip_normals: bool) -> Geometry {
    Geometry::Cylinder { base, frame: Mat3::IDENTITY, radius, length, flip_normals }
}

fn cylinders() -> Vec<KnownScene> {
    // What is seen of an upright cylinder: the half towards the origin, between two upright lines.
    let (axis, radius, heights) = (Vec3::new(1.4, 0.5, 0.0), 0.4, [0.3, 1.5]);
    let half_angle = (radius / axis.length()).acos();
    let toward = (-axis.y).atan2(-axis.x);
    let steps = 500;
    let rim = |z: f32, i: i32| {
        let phi = toward + half_angle * (2.0 * i as f32 / steps as f32 - 1.0);
        axis + radius * Vec3::new(phi.cos(), phi.sin(), 0.0) + Vec3::Z * z
    };
    let outline: Vec<Vec3> = (0..=steps)
        .map(|i| rim(heights[0], i))
        .chain((0..=steps).rev().map(|i| rim(heights[1], i)))
        .collect();
    let outside = floor_under(
        "floor beside a cylinder (Lambert's formula)",
        4.0 * lambert_irradiance(&outline),
        0.0,
        |desc| {
            let form = cylinder(axis + heights[0] * Vec3::Z, radius, heights[1] - heights[0], false);
            let mut light = shape(form, Some(4.0));
            light.material = MaterialId(2);
            desc.shapes.push(light);
        },
    );
    // a can whose side and ends shine inwards
    let camera = camera_on_point(Vec3::new(0.1, 0.3, 0.2), Vec3::new(0.6, 0.8, 0.9));
    let mut desc = diffuse_scene(camera, 0.5);
    desc.shapes.push(shape(cylinder(Vec3::ZERO, 1.0, 1.5, true), Some(1.0)));
    for (z, flip_normals) in [(0.0, false), (1.5, true)] {
        let (u_axis, v_axis) = (Vec3::X, Vec3::Y);
        let end = Geometry::Disk { center: z * Vec3::Z, u_axis, v_axis, flip_normals };
        desc.shapes.push(shape(end, Some(1.0)));
    }
    let inside = KnownScene {
        name: "furnace, can".into(),
        desc,
        radiance: Rgb::splat(2.0),
        light_alone_converges: false,
        found_by_chance: true,
    };
    vec![outside, inside]
}

/// A saddle of albedo 1 under a sky of radiance 1 cannot be told from the sky, however often light bounces in it.
fn white_patch() -> KnownScene {
    let camera = camera_on_point(Vec3::new(0.1, -2.0, 1.5), Vec3::new(0.1, 0.05, 0.005));
    let mut desc = diffuse_scene(camera, 1.0);
    let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, x * y));
    desc.shapes.push(shape(Geometry::Patch { corners, flip_normals: false }, None));
    desc.lights.push(LightDesc::Constant { radiance: Rgb::ONE, span: Span::default() });
    KnownScene {
        name: "white furnace, bilinear patch under a constant sky".into(),
        desc,
        radiance: Rgb::ONE,
        light_alone_converges: true,
        found_by_chance: true,
    }
}

fn spheres() -> Vec<KnownScene> {
    // E = π L (R / d)² cos θ for a sphere wholly above the horizon
    let above = |name: &str, center: Vec3, radius: f32, le: f32| {
        let d = center.as_dvec3();
        let sin2 = f64::from(radius).powi(2) / d.length_squared();
        let irradiance = std::f64::consts::PI * f64::from(le) * sin2 * d.z / d.length();
        floor_under(name, irradiance, 0.0, |desc| {
            let mut light = shape(sphere(center, radius, false), Some(le));
            light.material = MaterialId(2);
            desc.shapes.push(light);
        })
    };
    vec![
        above("floor under a large sphere light", Vec3::new(0.2, 0.1, 1.5), 1.0, 2.0),
        above("floor beside a sphere light", Vec3::new(1.0, -0.5, 0.9), 0.5, 9.0),
    ]
}

fn skies() -> Vec<KnownScene> {
    let pi = std::f64::consts::PI;
    let environment = |pixels: [f32; 4]| Image {
        name: "two rows".into(),
        width: 2,
        height: 2,
        pixels: Pixels::F32 { channels: 1, data: pixels.to_vec() },
    };
    vec![
        floor_under("floor under a constant sky", pi * 3.0, 0.0, |desc| {
            desc.lights.push(LightDesc::Constant { radiance: Rgb::splat(3.0), span: Span::default() });
        }),
        // The rows are at the poles, and L is linear in θ between them. With the pole turned to the floor's normal:
        // E = 2π ∫ L(θ) cos θ sin θ dθ over [0, π/2], which is π (3 + ¼) / 4 for 1 above and ¼ below.
        floor_under("floor under a graded sky", pi * 3.25 / 4.0, 0.0, |desc| {
            desc.images.push(Arc::new(environment([1.0, 1.0, 0.25, 0.25])));
            desc.lights.push(LightDesc::Environment {
                image: 0,
                scale: 1.0,
                mapping: SphereMapping::LatLong,
                world_from_light: Mat3::from_rotation_x(PI / 2.0),
                mis_compensation: false,
                portals: Vec::new(),
                span: Span::default(),
            });
        }),
        floor_under("floor under a point light", 5.0 * 1.2 / 1.69_f64.powf(1.5), 0.0, |desc| {
            desc.lights.push(LightDesc::Point {
                position: Vec3::new(0.3, 0.4, 1.2),
                intensity: Rgb::splat(5.0),
                range: f32::INFINITY,
                span: Span::default(),
            });
        }),
        floor_under("floor in parallel light", 2.0 * 0.5, 0.0, |desc| {
            let direction = Vec3::new(FRAC_PI_3.sin(), 0.0, -FRAC_PI_3.cos());
            let irradiance = Rgb::splat(2.0);
            desc.lights.push(LightDesc::Directional { direction, irradiance, span: Span::default() });
        }),
        floor_under("floor under a sky and two lights", pi * 3.0 + 1.0 + 0.5, 0.0, |desc| {
            desc.lights.push(LightDesc::Constant { radiance: Rgb::splat(3.0), span: Span::default() });
            let irradiance = Rgb::ONE;
            let direction = -Vec3::Z;
            desc.lights.push(LightDesc::Directional { direction, irradiance, span: Span::default() });
            desc.lights.push(LightDesc::Spot {
                world_from_light: Mat4::from_translation(2.0 * Vec3::Z) * Mat4::from_rotation_x(PI),
                intensity: Rgb::splat(2.0),
                cutoff_angle: 0.4,
                beam_width: 0.3,
                falloff: SpotFalloff::Linear,
                range: f32::INFINITY,
                texture: None,
                span: Span::default(),
            });
        }),
    ]
}

/// A light seen in a perfect mirror shows its own radiance.
fn mirror_in_front_of_a_light() -> KnownScene {
    let mut known = floor_under("a sphere light in a mirror", 0.0, 0.0, |desc| {
        desc.materials[0] = MaterialDesc::Conductor {
            eta_k: None,
            specular_reflectance: ColorInput::Constant(Rgb::splat(0.9)),
        };
        let mut light = shape(sphere(Vec3::new(-1.0, 0.8, 0.6), 0.4, false), Some(7.0));
        light.material = MaterialId(2);
        desc.shapes.push(light);
    });
    known.radiance = Rgb::splat(0.9 * 7.0);
    known
}
