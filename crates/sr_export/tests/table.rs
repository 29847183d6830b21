//! What each format can say: one of everything is exported, and docs/import.md has a table of what was said about it.

use std::sync::Arc;

use glam::{Affine2, Mat3, Mat4, Vec2, Vec3, Vec4};
use sr_export::{Target, export};
use sr_scene::{
    CameraDesc, ColorInput, CurveBasis, CurveUv, CurvesDesc, Emission, FilmDesc, Filter, FilterDesc, FovAxis,
    Geometry, HairAbsorption, HairDesc, Image, IntensityProfile, Lens, LightDesc, MaterialDesc, MaterialId,
    MeshColorOf, MeshDesc, MetallicRoughnessDesc, MicrofacetKind, Pixels, PrincipledDesc, PrincipledThinDesc,
    Projection, Rgb, ScalarInput, SceneDesc, Settings, ShapeDesc, Span, SphereMapping, SpotFalloff,
    TextureDesc, TextureId, Tilting, Wrap,
};

const GREY: ColorInput = ColorInput::Constant(Rgb::splat(0.5));
const WHITE: ColorInput = ColorInput::Constant(Rgb::ONE);
const NONE: ScalarInput = ScalarInput::Constant(0.0);
const SOME: ScalarInput = ScalarInput::Constant(0.3);

const TARGETS: [Target; 4] = [
    Target::Mitsuba { own_plugins: false },
    Target::Mitsuba { own_plugins: true },
    Target::Pbrt,
    Target::Gltf,
];

/// A scene about which every format has as little to say as about any.
fn scene() -> SceneDesc {
    let span = Span::default();
    let image = |width: u32| Image {
        name: "image".into(),
        width,
        height: 4,
        pixels: Pixels::U8 { channels: 3, data: vec![128; 12 * width as usize] },
    };
    let mesh = MeshDesc {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::Y],
        triangles: vec![[0, 1, 2]],
        ..MeshDesc::default()
    };
    SceneDesc {
        camera: CameraDesc {
            world_from_camera: Mat4::from_translation(Vec3::new(0.0, 0.0, -5.0)),
            projection: Projection::Perspective {
                fov_axis: FovAxis::X,
                fov: 1.0,
                principal_point_offset: Vec2::ZERO,
                lens: None,
            },
            near_clip: 0.01,
            far_clip: 100.0,
            film: FilmDesc {
                width: 12,
                height: 8,
                crop: None,
                filter: FilterDesc::Box { radius: 0.5 },
                sample_border: true,
            },
            span: span.clone(),
        },
        settings: Settings::default(),
        images: vec![Arc::new(image(8)), Arc::new(image(4))],
        textures: Vec::new(),
        materials: vec![
            MaterialDesc::Diffuse { reflectance: GREY },
            MaterialDesc::TwoSided { front: MaterialId(0), back: MaterialId(0) },
        ],
        material_spans: Vec::new(),
        shapes: vec![ShapeDesc {
            geometry: Geometry::Mesh(Arc::new(mesh)),
            material: MaterialId(1),
            emission: None,
            span,
        }],
        groups: Vec::new(),
        instances: Vec::new(),
        lights: Vec::new(),
        variants: Vec::new(),
    }
}

/// With the shape made of a material; what reflects only has two sides.
fn with_material(desc: MaterialDesc, two_sided: bool) -> SceneDesc {
    let mut scene = scene();
    scene.materials.push(desc);
    if two_sided {
        scene.materials.push(MaterialDesc::TwoSided { front: MaterialId(2), back: MaterialId(2) });
    }
    scene.shapes[0].material = MaterialId(scene.materials.len() as u32 - 1);
    scene
}

fn with_texture(desc: TextureDesc) -> SceneDesc {
    let mut scene = scene();
    scene.textures.push(bitmap(Affine2::IDENTITY, Wrap::Repeat));
    scene.textures.push(desc);
    scene.materials[0] = MaterialDesc::Diffuse { reflectance: ColorInput::Texture(TextureId(1)) };
    scene
}

fn bitmap(to_uv: Affine2, wrap: Wrap) -> TextureDesc {
    TextureDesc::Bitmap { image: 0, filter: Filter::Bilinear, wrap, srgb: true, to_uv, span: Span::default() }
}

fn with_light(light: LightDesc) -> SceneDesc {
    SceneDesc { lights: vec![light], ..scene() }
}

fn with_shape(geometry: Geometry) -> SceneDesc {
    let mut scene = scene();
    scene.shapes[0].geometry = geometry;
    scene
}

fn curves(basis: CurveBasis) -> Geometry {
    let points = [0.0, 1.0, 2.0, 3.0].map(|x| Vec4::new(x, 0.0, 0.0, 0.1)).to_vec();
    let (uv, firsts) = (CurveUv::AroundAlong, vec![0]);
    Geometry::Curves(Arc::new(CurvesDesc { name: "curves".into(), basis, uv, points, firsts }))
}

fn hair(absorption: HairAbsorption) -> MaterialDesc {
    let (beta_m, beta_n, along_u) = (SOME, SOME, false);
    MaterialDesc::Hair(HairDesc { absorption, eta: 1.55, beta_m, beta_n, alpha: 0.03, along_u })
}

fn with_projection(projection: Projection) -> SceneDesc {
    let mut scene = scene();
    scene.camera.projection = projection;
    scene
}

fn with_filter(filter: FilterDesc) -> SceneDesc {
    let mut scene = scene();
    scene.camera.film.filter = filter;
    scene
}

fn materials() -> Vec<(&'static str, SceneDesc)> {
    let metal = Some((ColorInput::Constant(Rgb::splat(0.2)), ColorInput::Constant(Rgb::splat(3.0))));
    let ggx = MicrofacetKind::Ggx;
    let alpha = [SOME; 2];
    let opaque = |desc| with_material(desc, true);
    let clear = |desc| with_material(desc, false);
    let inner = MaterialId(1);
    let tilting = Tilting::default();
    let textured = |desc: fn(TextureId) -> MaterialDesc| {
        let mut scene = with_material(desc(TextureId(0)), true);
        scene.textures.push(bitmap(Affine2::IDENTITY, Wrap::Repeat));
        scene
    };
    let principled = PrincipledDesc {
        base_color: GREY,
        roughness: SOME,
        anisotropic: NONE,
        metallic: NONE,
        spec_trans: NONE,
        eta: 1.5,
        spec_tint: NONE,
        sheen: NONE,
        sheen_tint: NONE,
        flatness: NONE,
        clearcoat: NONE,
        clearcoat_gloss: NONE,
        rates: [1.0; 3],
    };
    let thin = PrincipledThinDesc {
        base_color: GREY,
        roughness: SOME,
        anisotropic: NONE,
        spec_trans: SOME,
        eta: ScalarInput::Constant(1.5),
        spec_tint: NONE,
        sheen: NONE,
        sheen_tint: NONE,
        flatness: NONE,
        diff_trans: NONE,
        rates: [1.0; 4],
    };
    let metallic_roughness = MetallicRoughnessDesc {
        base_color: GREY,
        metallic: SOME,
        roughness: SOME,
        specular: ScalarInput::Constant(1.0),
        specular_color: WHITE,
        ior: 1.5,
        clearcoat: NONE,
        clearcoat_roughness: NONE,
        sheen_color: ColorInput::Constant(Rgb::ZERO),
        sheen_roughness: NONE,
        transmission: NONE,
        thin: true,
        diffuse_transmission: ScalarInput::Constant(0.0),
        diffuse_transmission_color: ColorInput::Constant(Rgb::ONE),
        anisotropy: NONE,
        anisotropy_rotation: 0.0,
    };
    let plastic = |multiscatter, nonlinear| MaterialDesc::RoughPlastic {
        kind: ggx,
        alpha: 0.2,
        eta: 1.5,
        diffuse_reflectance: GREY,
        specular_reflectance: WHITE,
        nonlinear,
        multiscatter,
    };
    let conductor = |kind, multiscatter| MaterialDesc::RoughConductor {
        kind,
        alpha,
        eta_k: metal,
        specular_reflectance: WHITE,
        multiscatter,
    };
    let dielectric = |multiscatter| MaterialDesc::RoughDielectric {
        kind: ggx,
        alpha,
        eta: 1.5,
        specular_reflectance: WHITE,
        specular_transmittance: WHITE,
        multiscatter,
    };
    vec![
        ("diffuse", opaque(MaterialDesc::Diffuse { reflectance: GREY })),
        ("diffuse, its back black", clear(MaterialDesc::Diffuse { reflectance: GREY })),
        ("eon", opaque(MaterialDesc::Eon { reflectance: GREY, roughness: SOME })),
        ("roughdiffuse", opaque(MaterialDesc::OrenNayar { reflectance: GREY, sigma: SOME })),
        (
            "diffusetransmission",
            clear(MaterialDesc::DiffuseTransmission { reflectance: GREY, transmittance: GREY }),
        ),
        (
            "dielectric",
            clear(MaterialDesc::Dielectric {
                eta: 1.5,
                specular_reflectance: WHITE,
                specular_transmittance: WHITE,
            }),
        ),
        (
            "dielectric, colored",
            clear(MaterialDesc::Dielectric {
                eta: 1.5,
                specular_reflectance: WHITE,
                specular_transmittance: GREY,
            }),
        ),
        (
            "thindielectric",
            clear(MaterialDesc::ThinDielectric {
                eta: 1.5,
                specular_reflectance: WHITE,
                specular_transmittance: WHITE,
            }),
        ),
        ("roughdielectric", clear(dielectric(false))),
        ("roughdielectric, multiscatter", clear(dielectric(true))),
        ("conductor", opaque(MaterialDesc::Conductor { eta_k: metal, specular_reflectance: WHITE })),
        ("conductor, colored", opaque(MaterialDesc::Conductor { eta_k: metal, specular_reflectance: GREY })),
        ("roughconductor", opaque(conductor(ggx, false))),
        ("roughconductor, beckmann", opaque(conductor(MicrofacetKind::Beckmann, false))),
        ("roughconductor, multiscatter", opaque(conductor(ggx, true))),
        (
            "plastic",
            opaque(MaterialDesc::Plastic {
                eta: 1.5,
                diffuse_reflectance: GREY,
                specular_reflectance: WHITE,
                nonlinear: false,
            }),
        ),
        ("roughplastic", opaque(plastic(false, false))),
        ("coateddiffuse", opaque(plastic(true, true))),
        (
            "coatedconductor",
            opaque(MaterialDesc::CoatedConductor {
                kind: ggx,
                coat_alpha: 0.1,
                eta: 1.5,
                alpha: 0.2,
                eta_k: metal,
                specular_reflectance: WHITE,
                bounces: None,
            }),
        ),
        ("principled", opaque(MaterialDesc::Principled(principled))),
        ("principledthin", clear(MaterialDesc::PrincipledThin(thin))),
        ("metallicroughness", opaque(MaterialDesc::MetallicRoughness(metallic_roughness))),
        ("hair", {
            let pigments = HairAbsorption::Pigments { eumelanin: SOME, pheomelanin: NONE };
            clear(hair(pigments))
        }),
        ("hair, of a color", clear(hair(HairAbsorption::Color(GREY)))),
        ("hair, textured", {
            let mut scene = clear(hair(HairAbsorption::Color(ColorInput::Texture(TextureId(0)))));
            scene.textures.push(bitmap(Affine2::IDENTITY, Wrap::Repeat));
            scene
        }),
        ("twosided, two materials", {
            let mut scene =
                with_material(MaterialDesc::TwoSided { front: MaterialId(0), back: MaterialId(0) }, false);
            scene.materials.push(MaterialDesc::Diffuse { reflectance: WHITE });
            scene.materials[2] = MaterialDesc::TwoSided { front: MaterialId(0), back: MaterialId(3) };
            scene
        }),
        ("mask", clear(MaterialDesc::Mask { opacity: SOME, inner })),
        ("null", clear(MaterialDesc::Mask { opacity: NONE, inner })),
        ("blendbsdf", opaque(MaterialDesc::Blend { weight: SOME, materials: [MaterialId(0); 2] })),
        (
            "bumpmap",
            textured(|texture| MaterialDesc::BumpMap {
                scale: 1.0,
                texture,
                tilting: Tilting::default(),
                inner: MaterialId(0),
            }),
        ),
        ("normalmap", {
            let mut scene = textured(|texture| MaterialDesc::NormalMap {
                normal: ColorInput::Texture(texture),
                tilting: Tilting::default(),
                inner: MaterialId(0),
            });
            let MaterialDesc::NormalMap { tilting: own, .. } = &mut scene.materials[2] else {
                unreachable!()
            };
            *own = tilting;
            scene
        }),
    ]
}

fn others() -> Vec<(&'static str, &'static str, SceneDesc)> {
    let span = Span::default;
    let id = ColorInput::Texture(TextureId(0));
    let to_uv = Affine2::IDENTITY;
    let frame = Mat3::IDENTITY;
    let place = Mat4::IDENTITY;
    let flip_normals = false;
    let perspective = |offset: Vec2, lens| Projection::Perspective {
        fov_axis: FovAxis::X,
        fov: 1.0,
        principal_point_offset: offset,
        lens,
    };
    let lens = |blades| Lens { aperture_radius: 0.1, focus_distance: 5.0, blades, blade_rotation: 0.0 };
    let environment = |image, mapping| LightDesc::Environment {
        image,
        mapping,
        scale: 1.0,
        world_from_light: frame,
        mis_compensation: false,
        portals: Vec::new(),
        span: span(),
    };
    let spot = |texture, beam_width| LightDesc::Spot {
        world_from_light: place,
        intensity: Rgb::ONE,
        cutoff_angle: 0.5,
        beam_width,
        falloff: SpotFalloff::Linear,
        range: f32::INFINITY,
        texture,
        span: span(),
    };
    let mut cosine_spot = with_light(spot(None, 0.4));
    if let LightDesc::Spot { falloff, .. } = &mut cosine_spot.lights[0] {
        *falloff = SpotFalloff::SquaredCosine;
    }
    let mut textured_spot = with_light(spot(Some(TextureId(0)), 0.4));
    textured_spot.textures.push(bitmap(to_uv, Wrap::Clamp));
    let profile = Arc::new(IntensityProfile {
        name: "profile".into(),
        vertical: vec![0.0, 1.0],
        horizontal: vec![0.0],
        candelas: vec![1.0, 1.0],
    });
    let emitting = |radiance| {
        let mut scene = scene();
        scene.textures.push(bitmap(to_uv, Wrap::Clamp));
        scene.shapes[0].emission = Some(Emission { radiance });
        scene
    };
    let mut hidden = scene();
    hidden.settings.hide_emitters = true;
    let mut border = scene();
    border.camera.film.sample_border = false;
    border.camera.film.filter = FilterDesc::Tent { radius: 1.0 };
    let mut clipped = scene();
    clipped.camera.far_clip = 1.0;
    vec![
        ("texture", "bitmap", with_texture(bitmap(to_uv, Wrap::Repeat))),
        ("texture", "bitmap, mirrored tiles", with_texture(bitmap(to_uv, Wrap::Mirror))),
        ("texture", "bitmap, rotated", with_texture(bitmap(Affine2::from_angle(0.5), Wrap::Repeat))),
        (
            "texture",
            "bitmap, mipmap",
            with_texture(TextureDesc::Bitmap {
                image: 0,
                filter: Filter::Mipmap,
                wrap: Wrap::Repeat,
                srgb: true,
                to_uv,
                span: span(),
            }),
        ),
        (
            "texture",
            "checkerboard",
            with_texture(TextureDesc::Checkerboard { color0: GREY, color1: WHITE, to_uv, span: span() }),
        ),
        ("texture", "scale", with_texture(TextureDesc::Scale { input: id, factor: GREY, span: span() })),
        (
            "texture",
            "scale, two textures",
            with_texture(TextureDesc::Scale { input: id, factor: id, span: span() }),
        ),
        (
            "texture",
            "mix",
            with_texture(TextureDesc::Mix { color0: id, color1: GREY, weight: SOME, span: span() }),
        ),
        (
            "texture",
            "mesh_attribute",
            with_texture(TextureDesc::MeshColor { of: MeshColorOf::Vertices, scale: 1.0, span: span() }),
        ),
        (
            "texture",
            "bitmap, further coordinates",
            with_texture(TextureDesc::OtherUvs { input: id, set: 1, span: span() }),
        ),
        ("shape", "meshes", scene()),
        (
            "shape",
            "sphere",
            with_shape(Geometry::Sphere { center: Vec3::ZERO, radius: 1.0, frame, flip_normals }),
        ),
        (
            "shape",
            "disk",
            with_shape(Geometry::Disk { center: Vec3::ZERO, u_axis: Vec3::X, v_axis: Vec3::Y, flip_normals }),
        ),
        (
            "shape",
            "cylinder",
            with_shape(Geometry::Cylinder {
                base: Vec3::ZERO,
                frame,
                radius: 1.0,
                length: 1.0,
                flip_normals,
            }),
        ),
        (
            "shape",
            "bilinearpatch",
            with_shape(Geometry::Patch { corners: [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE], flip_normals }),
        ),
        ("shape", "bsplinecurve", with_shape(curves(CurveBasis::BSpline))),
        ("shape", "linearcurve", with_shape(curves(CurveBasis::Linear))),
        ("light", "area", emitting(GREY)),
        ("light", "area, textured", emitting(id)),
        ("light", "constant", with_light(LightDesc::Constant { radiance: Rgb::ONE, span: span() })),
        ("light", "envmap", with_light(environment(0, SphereMapping::LatLong))),
        ("light", "envmap, octahedral", with_light(environment(1, SphereMapping::EqualAreaOctahedral))),
        (
            "light",
            "point",
            with_light(LightDesc::Point {
                position: Vec3::ZERO,
                intensity: Rgb::ONE,
                range: f32::INFINITY,
                span: span(),
            }),
        ),
        (
            "light",
            "point, range",
            with_light(LightDesc::Point {
                position: Vec3::ZERO,
                intensity: Rgb::ONE,
                range: 10.0,
                span: span(),
            }),
        ),
        (
            "light",
            "directional",
            with_light(LightDesc::Directional { direction: Vec3::Z, irradiance: Rgb::ONE, span: span() }),
        ),
        ("light", "spot", with_light(spot(None, 0.4))),
        ("light", "spot, squared cosine", cosine_spot),
        ("light", "spot, textured", textured_spot),
        (
            "light",
            "projector",
            with_light(LightDesc::Projector {
                world_from_light: place,
                irradiance: GREY,
                scale: 1.0,
                fov_axis: FovAxis::X,
                fov: 0.5,
                span: span(),
            }),
        ),
        (
            "light",
            "goniometric",
            with_light(LightDesc::Goniometric {
                world_from_light: place,
                intensity: Rgb::ONE,
                image: 0,
                mapping: SphereMapping::LatLong,
                span: span(),
            }),
        ),
        (
            "light",
            "ies",
            with_light(LightDesc::Profile {
                world_from_light: place,
                intensity: Rgb::ONE,
                profile,
                span: span(),
            }),
        ),
        (
            "light",
            "sky",
            with_light(LightDesc::Sky {
                turbidity: 3.0,
                albedo: Rgb::splat(0.3),
                sun_direction: Vec3::Z,
                scale: 1.0,
                world_from_light: frame,
                span: span(),
            }),
        ),
        (
            "light",
            "sun",
            with_light(LightDesc::Sun {
                turbidity: 3.0,
                direction: Vec3::Z,
                scale: 1.0,
                aperture: 0.01,
                world_from_light: frame,
                span: span(),
            }),
        ),
        ("camera", "perspective", scene()),
        ("camera", "perspective, shifted", with_projection(perspective(Vec2::splat(0.1), None))),
        ("camera", "perspective, clipped", clipped),
        ("camera", "thinlens", with_projection(perspective(Vec2::ZERO, Some(lens(0))))),
        ("camera", "thinlens, blades", with_projection(perspective(Vec2::ZERO, Some(lens(6))))),
        ("camera", "orthographic", with_projection(Projection::Orthographic)),
        ("camera", "spherical", with_projection(Projection::Spherical)),
        ("film", "box, tent, mitchell, lanczos", with_filter(FilterDesc::Mitchell { b: 0.3, c: 0.3 })),
        ("film", "gaussian", with_filter(FilterDesc::Gaussian { stddev: 0.5, radius: 2.0 })),
        ("film", "catmullrom", with_filter(FilterDesc::CatmullRom)),
        ("film", "blackmanharris", with_filter(FilterDesc::BlackmanHarris { radius: 1.5 })),
        ("film", "filter cut at the border", border),
        ("integrator", "hide_emitters", hidden),
    ]
}

/// What each format says about a scene, but for what it says about any.
fn said(scene: &SceneDesc, target: Target) -> String {
    let usual = export(&self::scene(), target, "a.x").diagnostics;
    let notes = export(scene, target, "a.x").diagnostics;
    let words: Vec<String> = notes
        .iter()
        .filter(|note| !usual.iter().any(|u| u.message == note.message))
        .filter_map(|note| note.consequence.clone())
        .collect();
    if words.is_empty() { "done".into() } else { words.join("; ") }
}

fn table() -> String {
    let rows = materials().into_iter().map(|(name, scene)| ("material", name, scene)).chain(others());
    let mut table = String::from(
        "| what | name | Mitsuba XML | with `--own-plugins` | pbrt-v4 | glTF 2.0 |\n| --- | --- | --- | --- | --- | --- |\n",
    );
    for (kind, name, scene) in rows {
        let problems = sr_scene::validate(&scene);
        assert!(problems.iter().all(|p| p.severity == sr_scene::Severity::Warning), "{name}: {problems:?}");
        let cells = TARGETS.map(|target| said(&scene, target));
        table.push_str(&format!("| {kind} | {name} | {} |\n", cells.join(" | ")));
    }
    table
}

#[test]
fn the_page_says_what_each_format_can_say() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/import.md");
    let page = std::fs::read_to_string(path).unwrap();
    let table = table();
    assert!(table.lines().count() > 60, "no table, no evidence");
    assert!(page.contains(&table), "docs/import.md lacks this:\n{table}");
}

/// Whatever a scene is made of, its files can be written, and have names of their own.
#[test]
fn files_have_names_of_their_own_and_can_be_written() {
    for (_, name, scene) in materials().into_iter().map(|(n, s)| ("", n, s)).chain(others()) {
        for target in TARGETS.into_iter().chain([Target::Glb]) {
            let files = export(&scene, target, "a \"b\".x").files;
            let mut names: Vec<&str> = files.iter().map(|file| file.name.as_str()).collect();
            assert_eq!(names.last(), Some(&"a \"b\".x"));
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), files.len(), "{name}");
            for file in &files {
                let mut bytes = std::io::Cursor::new(Vec::new());
                file.content.write_to(&mut bytes).unwrap();
                assert!(!bytes.into_inner().is_empty(), "{name}: {}", file.name);
            }
        }
    }
}
