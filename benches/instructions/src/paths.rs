//! Loading scenes and rendering them.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use sr_import::LoadOptions;
use sr_render::{Control, Film, RenderSettings, Scene, render};
use sr_scene::{Geometry, MeshDesc, SceneDesc, ShapeDesc, Span};

use crate::Work;
use crate::common::closed_box;

const SIDE: u32 = 32;
const SPP: u32 = 8;

/// A scene file of the repository.
fn scene_file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name)
}

fn describe(name: &str) -> SceneDesc {
    let path = scene_file(name);
    let (desc, diagnostics) = sr_import::load(&path, &LoadOptions::default());
    desc.unwrap_or_else(|| panic!("{}", diagnostics.render(false)))
}

fn compile(desc: &SceneDesc) -> Scene {
    Scene::compile(desc).expect("the scene is ours")
}

/// Rendering with the scene's own depth and Sobol' points.
fn rendering(scene: Scene, strategy: &str) -> Work {
    let settings = RenderSettings {
        width: SIDE,
        height: SIDE,
        strategy: strategy.parse().expect("the strategy is ours"),
        ..RenderSettings::from_scene(&scene)
    };
    let mut film = Film::new(SIDE, SIDE).expect("the film is small");
    Box::new(move || {
        let control = Control { cancel: &AtomicBool::new(false), deadline: None, on_pass: &|_, _| () };
        render(&scene, &settings, 0..SPP, &mut film, &control).expect("the film is empty");
        film.image().mean().iter().sum()
    })
}

/// Reading and compiling the Cornell box.
pub fn load() -> Work {
    Box::new(|| compile(&describe("scenes/cornell-box.xml")).memory_bytes() as f64)
}

/// The Cornell box.
pub fn cornell() -> Work {
    rendering(compile(&describe("scenes/cornell-box.xml")), "mis(bsdf, light)")
}

/// Glass, metal, plastic, a checkerboard, a lamp, a point light and a sky.
pub fn materials() -> Work {
    rendering(compile(&describe("benches/instructions/materials.xml")), "mis(bsdf, light)")
}

/// The Cornell box with a mesh of 19,200 triangles in it.
pub fn mesh() -> Work {
    let mut desc = describe("scenes/cornell-box.xml");
    let ball = closed_box(40).transformed(|p| {
        let d = p.normalize();
        let bumps = (9.0 * d.x).sin() * (11.0 * d.y).sin() * (7.0 * d.z).sin();
        glam::Vec3::new(2.78, 2.7, 2.8) + (1.0 + 0.2 * bumps) * d
    });
    desc.shapes.push(ShapeDesc {
        geometry: Geometry::Mesh(Arc::new(MeshDesc {
            name: "ball".into(),
            positions: ball.positions,
            triangles: ball.triangles,
            ..MeshDesc::default()
        })),
        material: desc.shapes[0].material,
        emission: None,
        span: Span::default(),
    });
    rendering(compile(&desc), "mis(bsdf, light)")
}

/// The Cornell box by a strategy that is not the default.
pub fn strategy() -> Work {
    rendering(compile(&describe("scenes/cornell-box.xml")), "0.5 cosine + 0.5 light")
}
