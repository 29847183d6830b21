//! Lights with an extent, one by one and all together, seen from points.

use std::sync::Arc;

use glam::Vec3;
use sr_render::Scene;
use sr_render::light::{LightId, SeenFrom};
use sr_scene::{LightDesc, SceneDesc};
use sr_testing::light_scenes;

use crate::directions;
use crate::picture::Picture;
use crate::subject::{Group, Subject};

/// A light, or all, of a scene, and a point.
#[derive(Clone)]
pub struct SeenLight {
    scene: Arc<Scene>,
    only: Option<LightId>,
    from: Vec3,
    /// Cells that do for its shape.
    pub bins: (usize, usize),
}

impl SeenLight {
    /// The density over directions.
    pub fn distribution(&self) -> SeenFrom<'_> {
        self.scene.lights().seen_from(self.from, self.only)
    }
}

/// Within the furnaces, above the floors.
const POINTS: [Vec3; 3] = [Vec3::new(0.0, 0.0, 0.01), Vec3::new(0.6, -0.4, 0.2), Vec3::new(0.8, 0.8, 0.4)];

/// Every light of every scene from every point, with what to call it.
pub fn cases() -> Vec<(String, SeenLight)> {
    let mut all = Vec::new();
    for (name, desc) in light_scenes() {
        let scene = Arc::new(Scene::compile(&desc).expect("scenes of lights compile"));
        let bins = if has_table(&desc) { (8, 16) } else { (16, 32) };
        let points = if is_far(&desc) { &POINTS[..1] } else { &POINTS[..] };
        for only in choices(&scene) {
            let (what, which) = match only {
                Some(LightId(id)) => (scene.lights().kind(LightId(id)), format!(", number {id}")),
                None if scene.lights().extended_ids().count() == 1 => {
                    (scene.lights().kind(LightId(0)), String::new())
                }
                None => ("all", ", together".to_owned()),
            };
            for &from in points {
                let case = format!("{what}: {name}{which}, from {from}");
                all.push((case, SeenLight { scene: Arc::clone(&scene), only, from, bins }));
            }
        }
    }
    all
}

/// Is there a light from a table? To integrate over its jumps takes long: fewer bins do for it.
fn has_table(desc: &SceneDesc) -> bool {
    desc.lights.iter().any(|light| matches!(light, LightDesc::Environment { .. } | LightDesc::Sky { .. }))
}

/// Is the density the same from all points?
fn is_far(desc: &SceneDesc) -> bool {
    let has_portal =
        |light: &LightDesc| matches!(light, LightDesc::Environment { portals, .. } if !portals.is_empty());
    desc.shapes.iter().all(|shape| shape.emission.is_none()) && !desc.lights.iter().any(has_portal)
}

/// All lights together, and if there are several, each of them.
fn choices(scene: &Scene) -> Vec<Option<LightId>> {
    let one_by_one: Vec<_> = scene.lights().extended_ids().map(Some).collect();
    match one_by_one.len() {
        0 => Vec::new(),
        1 => vec![None],
        _ => one_by_one.into_iter().chain([None]).collect(),
    }
}

pub fn subjects() -> Vec<Subject> {
    cases().into_iter().map(|(case, light)| subject(case, light)).collect()
}

fn subject(case: String, light: SeenLight) -> Subject {
    let (mass, picture) = (light.clone(), light.clone());
    Subject::new(Group::Light, case)
        .check("chi-square", move |seed| directions::chi_square(&light.distribution(), light.bins, seed))
        .check("normalised", move |seed| directions::normalised(&mass.distribution(), mass.bins, seed))
        .picture(move |seed| Picture::of(&picture.distribution(), seed))
}
