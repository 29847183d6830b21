//! Lights with an extent, one by one and all together, seen from points in the scenes with known answers.

use std::sync::Arc;

use glam::Vec3;
use sr_render::Scene;
use sr_render::light::{LightId, SeenFrom};
use sr_testing::known_scenes;

use crate::directions;
use crate::picture::Picture;
use crate::subject::{Group, Subject};

/// A light, or all, of a scene, and a point.
#[derive(Clone)]
pub struct SeenLight {
    scene: Arc<Scene>,
    only: Option<LightId>,
    from: Vec3,
}

impl SeenLight {
    /// The density over directions.
    pub fn distribution(&self) -> SeenFrom<'_> {
        self.scene.lights().seen_from(self.from, self.only)
    }
}

/// Every light of every scene from every point, with what to call it.
pub fn cases() -> Vec<(String, SeenLight)> {
    // within the furnaces, above the floors
    let points = [Vec3::new(0.0, 0.0, 0.01), Vec3::new(0.6, -0.4, 0.2), Vec3::new(0.8, 0.8, 0.4)];
    let mut all = Vec::new();
    for known in known_scenes() {
        let scene = Arc::new(Scene::compile(&known.desc).expect("scenes with known answers compile"));
        if !scene.lights().has_extended() {
            continue;
        }
        for only in scene.lights().extended_ids().map(Some).chain([None]) {
            let what = match only {
                Some(id) => scene.lights().kind(id),
                None => "all lights",
            };
            let which = only.map_or(String::new(), |LightId(id)| format!(", number {id}"));
            for from in points {
                let case = format!("{what}: {}{which}, from {from}", known.name);
                all.push((case, SeenLight { scene: Arc::clone(&scene), only, from }));
            }
        }
    }
    all
}

pub fn subjects() -> Vec<Subject> {
    cases().into_iter().map(|(case, light)| subject(case, light)).collect()
}

fn subject(case: String, light: SeenLight) -> Subject {
    let (mass, picture) = (light.clone(), light.clone());
    Subject::new(Group::Light, case)
        .check("chi-square", move |seed| directions::chi_square(&light.distribution(), seed))
        .check("normalised", move |seed| directions::normalised(&mass.distribution(), seed))
        .picture(move |seed| Picture::of(&picture.distribution(), seed))
}
