//! Textures that depend on more than texture coordinates: the colours of meshes, and smaller copies of images.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use glam::{Affine2, Vec2, Vec3};
use sr_render::{Control, Film, RenderSettings, RenderedImage, Scene, render};
use sr_scene::{
    ColorInput, Emission, Filter, Geometry, Image, InstanceDesc, LightDesc, MaterialDesc, MaterialId,
    MeshColorOf, MeshDesc, Pixels, Rgb, SceneDesc, Span, TextureDesc, TextureId, Wrap,
};
use sr_testing::scenes::{camera_on_point, diffuse_scene, shape};

/// The fast path tracer, and the general one.
const STRATEGIES: [&str; 2] = ["mis(bsdf, light)", "mis(light, bsdf)"];

fn rendered(desc: &SceneDesc, strategy: &str, spp: u32) -> RenderedImage {
    let scene = Scene::compile(desc).unwrap();
    let strategy = strategy.parse().unwrap();
    let settings = RenderSettings { strategy, seed: 5, ..RenderSettings::from_scene(&scene) };
    let mut film = Film::new(settings.width, settings.height).unwrap();
    let cancel = AtomicBool::new(false);
    let control = Control { cancel: &cancel, deadline: None, on_pass: &|_, _| () };
    render(&scene, &settings, 0..spp, &mut film, &control).unwrap();
    assert_eq!(film.rejected_samples(), 0, "NaN or infinity");
    film.image()
}

/// The square [−100, 100]² at z = 0 under a white sky, with one texture as its reflectance.
fn textured_floor(from: Vec3, at: Vec3, texture: TextureDesc, mesh: MeshDesc) -> SceneDesc {
    let mut desc = diffuse_scene(camera_on_point(from, at), 0.0);
    desc.settings.max_depth = Some(6);
    desc.textures.push(texture);
    desc.materials[0] = MaterialDesc::Diffuse { reflectance: ColorInput::Texture(TextureId(0)) };
    let corner = |x, y| Vec3::new(x, y, 0.0);
    let mesh = MeshDesc {
        positions: vec![
            corner(-100.0, -100.0),
            corner(100.0, -100.0),
            corner(100.0, 100.0),
            corner(-100.0, 100.0),
        ],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..mesh
    };
    desc.shapes.push(shape(Geometry::Mesh(Arc::new(mesh)), None));
    desc.lights.push(LightDesc::Constant { radiance: Rgb::ONE, span: Span::default() });
    desc
}

#[test]
fn a_floor_shows_the_colors_of_its_mesh() {
    let colors = [Rgb::X, Rgb::Y, Rgb::new(-1.0, 1.0, 0.0) + Rgb::X + Rgb::Z, Rgb::Z].to_vec();
    let faces = vec![Rgb::new(0.1, 0.2, 0.3), Rgb::new(0.5, 0.6, 0.7)];
    for strategy in STRATEGIES {
        for (of, expected) in [
            // in the first triangle, at b = (0.5, 0.25, 0.25)
            (MeshColorOf::Vertices, 0.5 * colors[0] + 0.25 * colors[1] + 0.25 * colors[2]),
            (MeshColorOf::Faces, faces[0]),
        ] {
            let texture = TextureDesc::MeshColor { of, scale: 0.5, span: Span::default() };
            let mesh =
                MeshDesc { vertex_colors: colors.clone(), face_colors: faces.clone(), ..MeshDesc::default() };
            let mut desc =
                textured_floor(Vec3::new(0.0, -60.0, 9.0), Vec3::new(0.0, -50.0, 0.0), texture, mesh);
            for instanced in [false, true] {
                if instanced {
                    let shapes = std::mem::take(&mut desc.shapes);
                    desc.groups.push(sr_scene::GroupDesc { shapes });
                    desc.instances.push(InstanceDesc {
                        group: 0,
                        world_from_group: glam::Affine3A::IDENTITY,
                        span: Span::default(),
                    });
                }
                let image = rendered(&desc, strategy, 256);
                for c in 0..3 {
                    let off = (image.rgb[c] - 0.5 * expected[c]).abs();
                    assert!(
                        off < 5.0 * image.stderr[c] + 1e-4,
                        "{of:?}: {:?}, expected {}",
                        &image.rgb,
                        0.5 * expected
                    );
                }
            }
        }
    }
}

/// Red and green, each on one half of an image.
fn red_and_green() -> (Image, TextureDesc) {
    let pixels = Pixels::U8 { channels: 3, data: vec![255, 0, 0, 0, 255, 0] };
    let image = Image { name: "halves".into(), width: 2, height: 1, pixels };
    let texture = TextureDesc::Bitmap {
        image: 0,
        filter: Filter::Bilinear,
        wrap: Wrap::Clamp,
        srgb: false,
        to_uv: Affine2::IDENTITY,
        span: Span::default(),
    };
    (image, texture)
}

fn at_set(set: u32) -> TextureDesc {
    let input = ColorInput::Texture(TextureId(0));
    TextureDesc::OtherUvs { input, set, span: Span::default() }
}

#[test]
fn a_floor_shows_textures_at_further_coordinates() {
    let (left, right) = (vec![Vec2::new(0.1, 0.5); 4], vec![Vec2::new(0.9, 0.5); 4]);
    for strategy in STRATEGIES {
        // Of the third set there is nothing: the first is used.
        for (set, expected) in [(1, Rgb::X), (2, Rgb::Y), (3, Rgb::new(0.5, 0.5, 0.0))] {
            let mesh = MeshDesc { further_uvs: vec![left.clone(), right.clone()], ..MeshDesc::default() };
            let (image, texture) = red_and_green();
            let mut desc = textured_floor(Vec3::new(0.0, 0.0, 20.0), Vec3::ZERO, texture, mesh);
            desc.images.push(Arc::new(image));
            desc.textures.push(at_set(set));
            desc.materials[0] = MaterialDesc::Diffuse { reflectance: ColorInput::Texture(TextureId(1)) };
            let image = rendered(&desc, strategy, 64);
            for c in 0..3 {
                let off = (image.rgb[c] - expected[c]).abs();
                assert!(off < 5.0 * image.stderr[c] + 1e-3, "{strategy}, set {set}: {:?}", image.rgb);
            }
        }
    }
}

#[test]
fn lights_shine_by_their_further_coordinates() {
    let uvs = vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    let other = vec![Vec2::new(0.1, 0.5); 4];
    for strategy in STRATEGIES {
        let lit = |mesh: MeshDesc, radiance: u32| {
            let (image, texture) = red_and_green();
            let (from, at) = (Vec3::new(0.0, -20.0, 5.0), Vec3::new(0.0, 0.0, 5.0));
            let mut desc = textured_floor(from, at, texture, MeshDesc::default());
            desc.images.push(Arc::new(image));
            desc.textures.push(at_set(1));
            desc.materials[0] = MaterialDesc::Diffuse { reflectance: ColorInput::Constant(Rgb::splat(0.5)) };
            desc.lights.clear();
            let corner = |x, z| Vec3::new(x, 0.0, z);
            let positions = vec![corner(-5.0, 1.0), corner(5.0, 1.0), corner(5.0, 9.0), corner(-5.0, 9.0)];
            let mesh = MeshDesc { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..mesh };
            let radiance = ColorInput::Texture(TextureId(radiance));
            let mut lamp = shape(Geometry::Mesh(Arc::new(mesh)), None);
            lamp.emission = Some(Emission { radiance });
            desc.shapes.push(lamp);
            rendered(&desc, strategy, 64).rgb
        };
        let first = lit(MeshDesc { uvs: uvs.clone(), ..MeshDesc::default() }, 0);
        let further_uvs = vec![uvs.clone()];
        let further = lit(MeshDesc { uvs: other.clone(), further_uvs, ..MeshDesc::default() }, 1);
        assert_eq!(first, further, "{strategy:?}");
        assert!(first.iter().any(|v| *v > 0.0));
    }
}

/// Black and white texels, a hundred times over: far away, only their mean is seen.
fn stripes(filter: Filter) -> (Image, TextureDesc) {
    let data = (0..64 * 64).map(|i| if (i % 64 + i / 64) % 2 == 0 { 0 } else { 255 }).collect();
    let image =
        Image { name: "stripes".into(), width: 64, height: 64, pixels: Pixels::U8 { channels: 1, data } };
    let texture = TextureDesc::Bitmap {
        image: 0,
        filter,
        wrap: Wrap::Repeat,
        srgb: false,
        to_uv: Affine2::from_scale(Vec2::splat(100.0)),
        span: Span::default(),
    };
    (image, texture)
}

#[test]
fn distant_textures_are_smooth_also_in_mirrors() {
    for strategy in STRATEGIES {
        for in_mirror in [false, true] {
            let deviation = |filter| {
                let (image, texture) = stripes(filter);
                let (from, at) = match in_mirror {
                    false => (Vec3::new(0.0, -60.0, 20.0), Vec3::ZERO),
                    true => (Vec3::new(0.0, 0.0, 20.0), Vec3::new(0.0, 30.0, 10.0)),
                };
                let mut desc = textured_floor(from, at, texture, MeshDesc::default());
                if let sr_scene::Projection::Perspective { fov, .. } = &mut desc.camera.projection {
                    // so that a pixel sees many texels
                    *fov = 0.2;
                }
                desc.images.push(Arc::new(image));
                // from above, and always the same
                let (direction, irradiance) = (Vec3::NEG_Z, Rgb::splat(std::f32::consts::PI));
                desc.lights = vec![LightDesc::Directional { direction, irradiance, span: Span::default() }];
                if in_mirror {
                    let specular = ColorInput::Constant(Rgb::ONE);
                    desc.materials
                        .push(MaterialDesc::Conductor { eta_k: None, specular_reflectance: specular });
                    let corner = |x, z| Vec3::new(x, 30.0, z);
                    let upright =
                        [corner(-6.0, 5.0), corner(6.0, 5.0), corner(6.0, 15.0), corner(-6.0, 15.0)];
                    let mut mirror = shape(sr_testing::scenes::polygon(&upright), None);
                    mirror.material = MaterialId(desc.materials.len() as u32 - 1);
                    desc.shapes.push(mirror);
                }
                let image = rendered(&desc, strategy, 64);
                let off = (image.rgb[1] - 0.5).abs();
                assert!(off < 5.0 * image.stderr[1] + 0.02, "{}, {filter:?}", image.rgb[1]);
                image.stderr[1]
            };
            let (bilinear, mipmap) = (deviation(Filter::Bilinear), deviation(Filter::Mipmap));
            assert!(mipmap < 0.3 * bilinear, "{strategy}, mirror {in_mirror}: {mipmap} and {bilinear}");
        }
    }
}
